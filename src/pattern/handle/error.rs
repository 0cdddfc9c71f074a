//! Errors of changing a style by a handle.

use super::Handle;
use crate::seams::StyleError;

#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum HandleError {
    #[error("handle `{handle}`: {amount_mm:.1} mm; accepted: -{most_mm} to {most_mm} mm", handle = .handle.as_str())]
    Amount { handle: Handle, amount_mm: f64, most_mm: f64 },
    #[error("style `{style}`: there is no handle `{handle}`; there is: {accepted}", handle = .handle.as_str())]
    Absent { style: String, handle: Handle, accepted: String },
    /// The sides of a seam do not stay equally long, or a length cannot be kept.
    #[error(
        "handle `{handle}` by {amount_mm:.1} mm: {place}: {found}; accepted: a change within {within_mm} mm", handle = .handle.as_str()
    )]
    Length {
        handle: Handle,
        amount_mm: f64,
        /// Seam with its edges, or the edges of the condition.
        place: String,
        found: String,
        within_mm: f64,
    },
    #[error(
        "handle `{handle}` by {amount_mm:.1} mm: the outline of piece `{piece}` crosses itself at ({u_mm:.0}, {v_mm:.0}) mm; accepted: an \
         amount that leaves it free of crossings", handle = .handle.as_str()
    )]
    Crossing { handle: Handle, amount_mm: f64, piece: String, u_mm: f64, v_mm: f64 },
    /// A block serves for several pieces of the style, which would change it differently.
    #[error(
        "block `{block}` is worn in several ways, which change it differently by {apart_mm:.2} mm; accepted: a block each"
    )]
    Drawn { block: String, apart_mm: f64 },
    #[error(transparent)]
    Style(#[from] StyleError),
}

impl HandleError {
    /// `None` for an error about the block or the style.
    pub const fn handle(&self) -> Option<Handle> {
        match self {
            Self::Amount { handle, .. }
            | Self::Absent { handle, .. }
            | Self::Length { handle, .. }
            | Self::Crossing { handle, .. } => Some(*handle),
            Self::Drawn { .. } | Self::Style(_) => None,
        }
    }
}

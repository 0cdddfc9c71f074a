//! Errors of changing a style by a handle.

use super::Handle;
use crate::seams::StyleError;

/// Error of changing a style by a handle.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum HandleError {
    /// The amount is out of range.
    #[error("handle `{handle}`: {amount_mm:.1} mm; accepted: -{most_mm} to {most_mm} mm", handle = .handle.as_str())]
    Amount {
        /// Requested handle.
        handle: Handle,
        /// Requested amount, mm.
        amount_mm: f64,
        /// Greatest accepted amount either way, mm.
        most_mm: f64,
    },
    /// The style has no such handle.
    #[error("style `{style}`: there is no handle `{handle}`; there is: {accepted}", handle = .handle.as_str())]
    Absent {
        /// Name of the style.
        style: String,
        /// Requested handle.
        handle: Handle,
        /// Names of the style's handles.
        accepted: String,
    },
    /// The sides of a seam do not stay equally long, or a length cannot be kept.
    #[error(
        "handle `{handle}` by {amount_mm:.1} mm: {place}: {found}; accepted: a change within {within_mm} mm", handle = .handle.as_str()
    )]
    Length {
        /// Handle that was moved.
        handle: Handle,
        /// Requested amount, mm.
        amount_mm: f64,
        /// Seam with its edges, or the edges of the condition.
        place: String,
        /// Deviation as text.
        found: String,
        /// Accepted deviation, mm.
        within_mm: f64,
    },
    /// An outline would cross itself.
    #[error(
        "handle `{handle}` by {amount_mm:.1} mm: the outline of piece `{piece}` crosses itself at ({u_mm:.0}, {v_mm:.0}) mm; accepted: an \
         amount that leaves it free of crossings", handle = .handle.as_str()
    )]
    Crossing {
        /// Handle that was moved.
        handle: Handle,
        /// Requested amount, mm.
        amount_mm: f64,
        /// Identifier of the piece whose outline crosses itself.
        piece: String,
        /// First coordinate of the crossing in the plane of the piece, mm.
        u_mm: f64,
        /// Second coordinate of the crossing in the plane of the piece, mm.
        v_mm: f64,
    },
    /// A block serves for several pieces of the style, which would change it differently.
    #[error(
        "block `{block}` is worn in several ways, which change it differently by {apart_mm:.2} mm; accepted: a block each"
    )]
    Drawn {
        /// Name of the block in the pattern file.
        block: String,
        /// Greatest distance between the two displaced outlines, mm.
        apart_mm: f64,
    },
    /// Pieces and seam file do not make a style.
    #[error(transparent)]
    Style(#[from] StyleError),
}

impl HandleError {
    /// Handle that cannot be applied. `None` for an error about the block or the style.
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

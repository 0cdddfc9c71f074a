//! What can go wrong before there is a drape. Not converging is not among it: that is a result.

use crate::geom::V2;

/// Why a simulation gave no drape.
#[derive(Debug, thiserror::Error)]
pub enum SimError {
    /// A triangle of the pattern mesh has no area.
    #[error(
        "piece {piece:?} has a triangle without area at ({:.1}, {:.1}) mm; a finer or coarser mesh may avoid it",
        .at.x * 1e3, .at.y * 1e3
    )]
    Degenerate {
        /// Piece.
        piece: String,
        /// Its first corner in the piece's plane, m.
        at: V2,
    },
    /// No mesh was given.
    #[error("no garment mesh to simulate")]
    NoMesh,
    /// No place about the body is known for a piece of this role.
    #[error("piece {piece:?} has the role `other`, which has no place about the body; accepted: front, back, sleeves")]
    NoPlace {
        /// Piece.
        piece: String,
    },
    /// Positions stopped being numbers.
    #[error("the simulation of {garment:?} diverged at iteration {iteration}")]
    Diverged {
        /// Garment.
        garment: String,
        /// Iteration.
        iteration: u32,
    },
    /// Asked to stop.
    #[error("cancelled")]
    Cancelled,
}

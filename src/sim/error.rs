//! Errors that end a simulation without a drape. A drape that did not converge is a result and no error.

use super::Distortion;
use geom::V2;
use pattern::Role;

#[derive(Debug, thiserror::Error)]
pub enum SimError {
    /// A triangle of the pattern mesh has no area.
    #[error(
        "piece {piece:?} has a triangle without area at ({:.1}, {:.1}) mm; a finer or coarser mesh may avoid it",
        .at.x * 1e3, .at.y * 1e3
    )]
    Degenerate {
        piece: String,
        /// First corner in the piece's plane.
        at: V2,
    },
    /// Stiffness matrix of a drape without inverse.
    #[error("the stiffness of the drape is singular: part of the cloth is held by nothing; accepted: a drape at rest")]
    Singular,
    /// Mesh of body and worn layers that encloses no volume.
    #[error("{0}; accepted: a body and layers whose surface can be told inside from outside")]
    Solid(geom::surface::SurfaceError),
    #[error("no garment mesh to simulate")]
    NoMesh,
    /// The simulator has no placement for the role of a piece.
    #[error("piece {piece:?}: this simulator cannot place role {role:?} yet; it places: {accepted}")]
    CannotPlace { piece: String, role: Role, accepted: &'static str },
    #[error("piece {piece:?} cannot be mapped onto the body: {reason}")]
    CannotMap { piece: String, reason: &'static str },
    /// A position became NaN or infinite.
    #[error("the simulation of {garment:?} diverged at iteration {iteration}")]
    Diverged {
        garment: String,
        /// Counted over all mesh levels from 1.
        iteration: u32,
    },
    #[error(
        "{garment:?} slides off this body: it has come down by {:.0} mm, friction and all; a smaller size, a stiffer fabric or a \
         waistband ([[reinforce]] in the seam file) may hold it",
        .descent_m * 1e3
    )]
    SlidOff { garment: String, descent_m: f64 },
    /// The closing seams push the garment off the body upwards.
    #[error(
        "{garment:?} comes off this body upwards: as its seams close it rises by {:.0} mm, friction and all; a larger size would stay on",
        .rise_m * 1e3
    )]
    CameOff { garment: String, rise_m: f64 },
    /// The seams do not close, whatever the force of the sewing springs.
    #[error(
        "the seams of {garment:?} do not close on this body: {:?} and {:?} stay {:.0} mm apart, however hard they are drawn; a larger \
         size, or other seams, may close",
        .pieces[0], .pieces[1], .gap_m * 1e3
    )]
    Open {
        garment: String,
        /// Two sides of the seam with the widest gap.
        pieces: [String; 2],
        gap_m: f64,
    },
    /// The cloth is stretched beyond its tearing point.
    #[error(
        "much too small for this body: {distortion}, and cloth tears before that; a larger size would do, or, for cloth that is made to \
         stretch so far, a higher `fem.distortion_limit`"
    )]
    Torn { distortion: Distortion },
    /// The stretch exceeds a limit that the parameters set.
    #[error(
        "too small for this body: {distortion}, the limit is {:.1} %; a larger size, another fabric, or a higher `fem.distortion_limit` would do",
        100.0 * .limit
    )]
    Distorted {
        distortion: Distortion,
        /// Greatest stretch ratio allowed, less 1.
        limit: f64,
    },
    #[error("cancelled")]
    Cancelled,
}

//! Errors that end a simulation without a drape. A drape that did not converge is a result and no error.

use super::Distortion;
use geom::V2;
use pattern::Role;

/// Reason for which a simulation returned no drape.
#[derive(Debug, thiserror::Error)]
pub enum SimError {
    /// A triangle of the pattern mesh has no area.
    #[error(
        "piece {piece:?} has a triangle without area at ({:.1}, {:.1}) mm; a finer or coarser mesh may avoid it",
        .at.x * 1e3, .at.y * 1e3
    )]
    Degenerate {
        /// Name of the piece.
        piece: String,
        /// Its first corner in the piece's plane, m.
        at: V2,
    },
    /// The stiffness matrix of a drape has no inverse.
    #[error("the stiffness of the drape is singular: part of the cloth is held by nothing; accepted: a drape at rest")]
    Singular,
    /// The mesh of body and worn layers, on which the next layer is to lie, encloses no volume.
    #[error("{0}; accepted: a body and layers whose surface can be told inside from outside")]
    Solid(geom::surface::SurfaceError),
    /// No mesh was given.
    #[error("no garment mesh to simulate")]
    NoMesh,
    /// The simulator has no placement for the role of a piece.
    #[error("piece {piece:?}: this simulator cannot place role {role:?} yet; it places: {accepted}")]
    CannotPlace {
        /// Name of the piece.
        piece: String,
        /// Role of the piece.
        role: Role,
        /// Roles that can be placed.
        accepted: &'static str,
    },
    /// The outline of a piece cannot be mapped onto the body.
    #[error("piece {piece:?} cannot be mapped onto the body: {reason}")]
    CannotMap {
        /// Name of the piece.
        piece: String,
        /// Obstacle in words.
        reason: &'static str,
    },
    /// A position became NaN or infinite.
    #[error("the simulation of {garment:?} diverged at iteration {iteration}")]
    Diverged {
        /// Name of the garment.
        garment: String,
        /// Iteration at which that happened, counted over all mesh levels from 1.
        iteration: u32,
    },
    /// The garment slides off the body under its weight.
    #[error(
        "{garment:?} slides off this body: it has come down by {:.0} mm, friction and all; a smaller size, a stiffer fabric or a \
         waistband ([[reinforce]] in the seam file) may hold it",
        .descent_m * 1e3
    )]
    SlidOff {
        /// Name of the garment.
        garment: String,
        /// Descent at which the simulation was given up, m.
        descent_m: f64,
    },
    /// The closing seams push the garment off the body upwards.
    #[error(
        "{garment:?} comes off this body upwards: as its seams close it rises by {:.0} mm, friction and all; a larger size would stay on",
        .rise_m * 1e3
    )]
    CameOff {
        /// Name of the garment.
        garment: String,
        /// Rise of its highest point, m.
        rise_m: f64,
    },
    /// The seams do not close, whatever the force of the sewing springs.
    #[error(
        "the seams of {garment:?} do not close on this body: {:?} and {:?} stay {:.0} mm apart, however hard they are drawn; a larger \
         size, or other seams, may close",
        .pieces[0], .pieces[1], .gap_m * 1e3
    )]
    Open {
        /// Name of the garment.
        garment: String,
        /// Pieces on the two sides of the seam with the widest gap.
        pieces: [String; 2],
        /// Width of that gap, m.
        gap_m: f64,
    },
    /// The cloth is stretched beyond its tearing point.
    #[error(
        "much too small for this body: {distortion}, and cloth tears before that; a larger size would do, or, for cloth that is made to \
         stretch so far, a higher `fem.distortion_limit`"
    )]
    Torn {
        /// Stretch of the cloth, and its place on the pattern.
        distortion: Distortion,
    },
    /// The stretch exceeds a limit that the parameters set.
    #[error(
        "too small for this body: {distortion}, the limit is {:.1} %; a larger size, another fabric, or a higher `fem.distortion_limit` would do",
        100.0 * .limit
    )]
    Distorted {
        /// Stretch of the cloth, and its place on the pattern.
        distortion: Distortion,
        /// Greatest stretch allowed, as the stretch ratio less 1.
        limit: f64,
    },
    /// The caller asked the simulation to stop.
    #[error("cancelled")]
    Cancelled,
}

//! What can go wrong before there is a drape. Not converging is not among it: that is a result.

use super::Distortion;
use geom::V2;
use pattern::Role;

/// Why a simulation gave no drape.
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
    /// A stiffness without an inverse.
    #[error("the stiffness of the drape is singular: part of the cloth is held by nothing; accepted: a drape at rest")]
    Singular,
    /// What is to be worn over bounds no solid.
    #[error("{0}; accepted: a body and layers whose surface can be told inside from outside")]
    Solid(geom::surface::SurfaceError),
    /// No mesh was given.
    #[error("no garment mesh to simulate")]
    NoMesh,
    /// A piece that the simulator does not know how to place.
    #[error("piece {piece:?}: this simulator cannot place role {role:?} yet; it places: {accepted}")]
    CannotPlace {
        /// Name of the piece.
        piece: String,
        /// How it is worn.
        role: Role,
        /// Roles that can be placed.
        accepted: &'static str,
    },
    /// A piece whose outline has no counterpart on the body.
    #[error("piece {piece:?} cannot be mapped onto the body: {reason}")]
    CannotMap {
        /// Name of the piece.
        piece: String,
        /// What stands in the way.
        reason: &'static str,
    },
    /// Positions stopped being numbers.
    #[error("the simulation of {garment:?} diverged at iteration {iteration}")]
    Diverged {
        /// Name of the garment.
        garment: String,
        /// Iteration at which a position is no number, over all levels, from 1.
        iteration: u32,
    },
    /// Nothing holds it up.
    #[error(
        "{garment:?} slides off this body: it has come down by {:.0} mm, friction and all; a smaller size, a stiffer fabric or a \
         waistband ([[reinforce]] in the seam file) may hold it",
        .descent_m * 1e3
    )]
    SlidOff {
        /// Name of the garment.
        garment: String,
        /// How far it has come down when it was given up, m.
        descent_m: f64,
    },
    /// Its seams squeeze it off the body as they close.
    #[error(
        "{garment:?} comes off this body upwards: as its seams close it rises by {:.0} mm, friction and all; a larger size would stay on",
        .rise_m * 1e3
    )]
    CameOff {
        /// Name of the garment.
        garment: String,
        /// How far its top has come up, m.
        rise_m: f64,
    },
    /// Its seams cannot be drawn together.
    #[error(
        "the seams of {garment:?} do not close on this body: {:?} and {:?} stay {:.0} mm apart, however hard they are drawn; a larger \
         size, or other seams, may close",
        .pieces[0], .pieces[1], .gap_m * 1e3
    )]
    Open {
        /// Name of the garment.
        garment: String,
        /// Pieces that are farthest from each other where they are sewn together.
        pieces: [String; 2],
        /// How far, m.
        gap_m: f64,
    },
    /// Stretched farther than cloth can be.
    #[error(
        "much too small for this body: {distortion}, and cloth tears before that; a larger size would do, or, for cloth that is made to \
         stretch so far, a higher `fem.distortion_limit`"
    )]
    Torn {
        /// How far and where.
        distortion: Distortion,
    },
    /// Stretched too far, where that is to end a simulation.
    #[error(
        "too small for this body: {distortion}, the limit is {:.1} %; a larger size, another fabric, or a higher `fem.distortion_limit` would do",
        100.0 * .limit
    )]
    Distorted {
        /// How far and where.
        distortion: Distortion,
        /// Stretch beyond 1 that was allowed.
        limit: f64,
    },
    /// Asked to stop.
    #[error("cancelled")]
    Cancelled,
}

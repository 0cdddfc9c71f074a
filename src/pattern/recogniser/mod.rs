//! Recognition of seams by evidence: which stretch of an outline is sewn to which.
//!
//! Outlines are divided into [`stretch`]es at their corners. A network, fitted offline to garments of one program so far,
//! weighs the [`evidence`] of each pair among all others.

pub mod evidence;
pub mod facts;
mod joints;
pub mod network;
pub mod settle;
pub mod stretch;
pub mod symmetry;
#[cfg(test)]
mod tests;

pub use self::stretch::Part;
use crate::piece::Piece;
use crate::style::corners::corner_vertices;
pub use crate::trade::Named;

/// Parts of the pieces of one size, as drawn, each with what its name says.
pub fn parts(pieces: &[Piece], named: &[Named]) -> Vec<Part> {
    let part = |(piece, &said): (&Piece, &Named)| Part {
        outline: piece.seam_outline().to_vec(),
        corners: corners(piece),
        notches: piece.notches.iter().map(|notch| notch.at).collect(),
        said,
    };
    pieces.iter().zip(named).map(part).collect()
}

/// Vertex indices of the outline, increasing, at least two: an outline without corners is divided in the middle.
pub fn corners(piece: &Piece) -> Vec<usize> {
    let mut corners = corner_vertices(piece);
    if corners.is_empty() {
        corners.push(0);
    }
    if corners.len() == 1 {
        let count = piece.seam_outline().len();
        corners.push((corners[0] + count / 2) % count);
    }
    corners.sort_unstable();
    corners
}

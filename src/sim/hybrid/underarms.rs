//! Underarm points of tops: the upper ends of the side seams.

use super::features::face;
use pattern::garment::SeamMesh;
use pattern::{Garment, PieceMesh, Role};

/// Fronts and backs of a top with the upper ends of the side seams. Empty where one of them has no side.
pub fn underarms(garment: &Garment) -> Vec<(&PieceMesh, usize)> {
    let is_top = |p: &&PieceMesh| matches!(p.role, Role::Front | Role::Back | Role::BodiceFront | Role::BodiceBack);
    let tops: Vec<&PieceMesh> = garment.pieces.iter().filter(is_top).collect();
    let face_at = |v: usize| tops.iter().find(|p| p.vertices.contains(&v)).map(|p| face(p.role));
    // A side seam joins front and back, and runs upright.
    let is_side = |seam: &&SeamMesh| {
        let (Some(first), Some(last)) = (seam.pairs.first(), seam.pairs.last()) else { return false };
        let chord = garment.rest[last[0]] - garment.rest[first[0]];
        let faces = first.map(face_at);
        faces.iter().all(Option::is_some) && faces[0] != faces[1] && chord.y.abs() > chord.x.abs()
    };
    let sides: Vec<usize> =
        garment.seams.iter().filter(is_side).flat_map(|s| s.pairs.iter().flatten().copied()).collect();
    let underarm = |piece: &&PieceMesh| {
        let own = sides.iter().copied().filter(|v| piece.vertices.contains(v));
        own.max_by(|&a, &b| garment.rest[a].y.total_cmp(&garment.rest[b].y))
    };
    tops.iter().map(|piece| Some((*piece, underarm(piece)?))).collect::<Option<Vec<_>>>().unwrap_or_default()
}

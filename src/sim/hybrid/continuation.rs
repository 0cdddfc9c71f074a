//! Continuation of the mapped surface over its edge onto pieces that only hang on others: cuffs, collars, bands.

use crate::SimError;
use geom::{V2, V3};
use pattern::Garment;

/// Point of a seam with a tangent frame, from which a piece continues.
struct Anchor {
    /// Place of the piece's own vertex in its plane.
    rest: V2,
    /// Along the seam and into the piece, in its plane.
    axes: [V2; 2],
    place: V3,
    /// As `axes`, in space.
    ways: [V3; 2],
}

/// Places the pieces `followers` by the placed pieces that they are sewn to, those with the longest such seams first.
/// Fails where a piece is sewn to nothing that is placed.
pub fn place(garment: &Garment, followers: &[usize], positions: &mut [V3]) -> Result<(), SimError> {
    let mut open = followers.to_vec();
    while !open.is_empty() {
        let piece_of = |v: usize| garment.pieces.iter().position(|p| p.vertices.contains(&v)).unwrap_or(usize::MAX);
        let is_placed = |v: usize| !open.contains(&piece_of(v));
        let pairs = |piece: usize| -> Vec<[usize; 2]> {
            let both = garment.seams.iter().flat_map(|s| &s.pairs).flat_map(|&[a, b]| [[a, b], [b, a]]);
            both.filter(|&[own, other]| garment.pieces[piece].vertices.contains(&own) && is_placed(other)).collect()
        };
        let longest = open.iter().enumerate().map(|(k, &piece)| (k, piece, pairs(piece))).max_by_key(|p| p.2.len());
        let Some((k, piece, pairs)) = longest.filter(|(.., pairs)| pairs.len() > 1) else {
            let piece = &garment.pieces[open[0]];
            let accepted = "pieces of trunk, arms and legs, and any piece that is sewn to one of these";
            return Err(SimError::CannotPlace { piece: piece.id.clone(), role: piece.role, accepted });
        };
        let anchors = anchors(garment, &pairs, positions);
        for v in garment.pieces[piece].vertices.clone() {
            positions[v] = continued(&anchors, garment.rest[v]);
        }
        open.remove(k);
    }
    Ok(())
}

fn anchors(garment: &Garment, pairs: &[[usize; 2]], positions: &[V3]) -> Vec<Anchor> {
    let (rest, n) = (&garment.rest, pairs.len());
    let anchor = |k: usize| {
        let [own, other] = pairs[k];
        // Neighbours on the seam count where they lie near on the same piece.
        let far = 3.0 * garment.edge_length_m;
        let next_to = |j: usize| j < n && (rest[pairs[j][0]] - rest[own]).norm() < far && pairs[j][0] != own;
        let before = k.checked_sub(1).filter(|&j| next_to(j)).unwrap_or(k);
        let after = Some(k + 1).filter(|&j| next_to(j)).unwrap_or(k);
        let along = (rest[pairs[after][0]] - rest[pairs[before][0]]).try_normalize(0.0)?;
        let way = (positions[pairs[after][1]] - positions[pairs[before][1]]).try_normalize(0.0)?;
        let middle = |v: usize, place: &dyn Fn(usize) -> V3| {
            let around: Vec<V3> =
                garment.triangles.iter().filter(|t| t.contains(&v)).flatten().map(|&w| place(w)).collect();
            around.iter().sum::<V3>() / around.len().max(1) as f64
        };
        let flat = |w: usize| V3::new(rest[w].x, rest[w].y, 0.0);
        let into = (middle(own, &flat).xy() - rest[own]).dot(&V2::new(-along.y, along.x)).signum();
        let out = positions[other] - middle(other, &|w| positions[w]);
        let on = (out - way * out.dot(&way)).try_normalize(0.0)?;
        let axes = [along, V2::new(-along.y, along.x) * into];
        Some(Anchor { rest: rest[own], axes, place: positions[other], ways: [way, on] })
    };
    (0..n).filter_map(anchor).collect()
}

/// Mean of a point's places by all anchors, weighted by the inverse fourth power of their distance.
fn continued(anchors: &[Anchor], p: V2) -> V3 {
    let (mut sum, mut weights) = (V3::zeros(), 0.0);
    for anchor in anchors {
        let arm = p - anchor.rest;
        let place =
            anchor.place + anchor.ways[0] * arm.dot(&anchor.axes[0]) + anchor.ways[1] * arm.dot(&anchor.axes[1]);
        let weight = 1.0 / (arm.norm_squared() + 1e-9).powi(2);
        sum += place * weight;
        weights += weight;
    }
    sum / weights.max(f64::MIN_POSITIVE)
}

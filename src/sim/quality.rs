//! Checks on a finished drape, made on the meshes themselves and not on what the solver believed.

use crate::body::Body;
use crate::geom::{DistanceField, V3};
use crate::pattern::Garment;
use crate::sim::contact::tangle::edges_of;
use crate::sim::contact::{Skin, crossings};

/// Deepest point of the cloth inside the body, m: vertices, edge middles and triangle centres against the exact surface;
/// 0 when none is inside.
#[must_use]
pub fn penetration_m(body: &Body, garment: &Garment, positions: &[V3]) -> f64 {
    Skin::new(&body.mesh).map_or(f64::NAN, |skin| deepest_m(&skin, samples(garment, positions)))
}

/// [`penetration_m`], asked only where a distance field does not say that the cloth is clearly outside: much quicker. Not a number
/// without a skin, which a mesh that bounds no solid has not.
#[must_use]
pub fn penetration_by_field_m(skin: Option<&Skin>, field: &DistanceField, garment: &Garment, positions: &[V3]) -> f64 {
    let mut doubtful = samples(garment, positions).filter(|p| field.value_and_gradient(p).0 < CLEAR_M).peekable();
    match skin {
        _ if doubtful.peek().is_none() => 0.0,
        Some(skin) => deepest_m(skin, doubtful),
        None => f64::NAN,
    }
}

/// Farthest that a field may lie from the true surface, m: it is blurred, and so short of fingers and creases.
const CLEAR_M: f64 = 4e-3;

/// Every vertex, edge middle and triangle centre, once.
fn samples<'a>(garment: &'a Garment, positions: &'a [V3]) -> impl Iterator<Item = V3> + 'a {
    let edges = edges_of(&garment.triangles).pairs().to_vec();
    let middles = edges.into_iter().map(|[a, b]| (positions[a] + positions[b]) / 2.0);
    let centres = garment.triangles.iter().map(|t| t.iter().map(|v| positions[*v]).sum::<V3>() / 3.0);
    positions.iter().copied().chain(middles).chain(centres)
}

fn deepest_m(skin: &Skin, samples: impl Iterator<Item = V3>) -> f64 {
    let mut inside: Vec<(f64, V3)> = samples.filter_map(|p| Some((skin.quick_depth(&p)?, p))).collect();
    inside.sort_by(|a, b| b.0.total_cmp(&a.0));
    inside.iter().find(|(_, p)| skin.contains(p)).map_or(0.0, |(depth, _)| *depth)
}

/// Greatest distance between the two vertices of a seam pair, m.
#[must_use]
pub fn seam_gap_m(garment: &Garment, positions: &[V3]) -> f64 {
    widest_seam(garment, positions).map_or(0.0, |(gap_m, _)| gap_m)
}

/// The seam pair whose vertices are farthest from each other, and how far, m; `None` where nothing is sewn.
#[must_use]
pub fn widest_seam(garment: &Garment, positions: &[V3]) -> Option<(f64, [usize; 2])> {
    let pairs = garment.seams.iter().flat_map(|s| &s.pairs);
    let gaps = pairs.map(|&[a, b]| ((positions[a] - positions[b]).norm(), [a, b]));
    gaps.max_by(|one, other| one.0.total_cmp(&other.0))
}

/// Number of edges that pierce a triangle of the same cloth with which they share no vertex. `triangles` index sewn
/// vertices at `x`.
#[must_use]
pub fn self_crossings(x: &[V3], triangles: &[[usize; 3]]) -> usize {
    let edges = edges_of(triangles);
    crossings(x, edges.pairs(), triangles).count()
}

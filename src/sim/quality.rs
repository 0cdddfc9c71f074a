//! Checks on a finished drape, made on the meshes themselves and not on what the solver believed.

use crate::contact::intersections::edges_of;
use crate::contact::{Skin, intersections};
use crate::sewing;
use body::Body;
use geom::{DistanceField, V3};
use pattern::{Garment, Role, Spot};

/// A vertex, an edge middle or a triangle centre: the vertices that it lies between, some of them more than once, and its place.
type Sample = ([usize; 3], V3);

/// Deepest point of the cloth inside the body, m: vertices, edge middles and triangle centres against the exact surface;
/// 0 when none is inside.
#[must_use]
pub fn penetration_m(body: &Body, garment: &Garment, positions: &[V3]) -> f64 {
    Skin::new(&body.mesh).map_or(f64::NAN, |skin| depth_m(deepest(&skin, samples(garment, positions))))
}

/// [`penetration_m`], asked only where a distance field does not say that the cloth is clearly outside: much quicker. Not a number
/// without a skin, which a mesh that bounds no solid has not.
#[must_use]
pub fn penetration_by_field_m(skin: Option<&Skin>, field: &DistanceField, garment: &Garment, positions: &[V3]) -> f64 {
    let is_doubtful = |(_, p): &Sample| field.value_and_gradient(p).0 < CLEAR_M;
    let mut doubtful = samples(garment, positions).filter(is_doubtful).peekable();
    match skin {
        _ if doubtful.peek().is_none() => 0.0,
        Some(skin) => depth_m(deepest(skin, doubtful)),
        None => f64::NAN,
    }
}

/// Where on its pieces the cloth lies deepest inside the body; `None` where it is nowhere inside.
#[must_use]
pub fn deepest_spot(body: &Body, garment: &Garment, positions: &[V3]) -> Option<Spot> {
    let (_, vertices) = deepest(&Skin::new(&body.mesh).ok()?, samples(garment, positions))?;
    garment.spot(&vertices)
}

geom::constants! {
    "quality",
    /// Farthest that a field may lie from the true surface, m: it is blurred, and so short of fingers and creases.
    const CLEAR_M: f64 = 4e-3;
}

/// Every vertex, edge middle and triangle centre, once.
fn samples<'a>(garment: &'a Garment, positions: &'a [V3]) -> impl Iterator<Item = Sample> + 'a {
    let edges = edges_of(&garment.triangles).pairs().to_vec();
    let vertices = positions.iter().enumerate().map(|(v, p)| ([v; 3], *p));
    let middles = edges.into_iter().map(|[a, b]| ([a, b, b], (positions[a] + positions[b]) / 2.0));
    let centres = garment.triangles.iter().map(|t| (*t, t.iter().map(|v| positions[*v]).sum::<V3>() / 3.0));
    vertices.chain(middles).chain(centres)
}

/// How deep the deepest of some samples lies, m, and between which vertices.
fn deepest(skin: &Skin, samples: impl Iterator<Item = Sample>) -> Option<(f64, [usize; 3])> {
    let mut inside: Vec<(f64, Sample)> = samples.filter_map(|s| Some((skin.quick_depth(&s.1)?, s))).collect();
    inside.sort_by(|a, b| b.0.total_cmp(&a.0));
    inside.into_iter().find(|(_, (_, p))| skin.contains(p)).map(|(depth, (between, _))| (depth, between))
}

fn depth_m(deepest: Option<(f64, [usize; 3])>) -> f64 {
    deepest.map_or(0.0, |(depth, _)| depth)
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
    intersections(x, edges.pairs(), triangles).len()
}

/// Where on its pieces a sewn garment crosses itself; `None` where it does not.
#[must_use]
pub fn crossed_spot(garment: &Garment, positions: &[V3]) -> Option<Spot> {
    let group = sewing::welded(garment);
    let mut first = vec![usize::MAX; positions.len()];
    for (v, &group) in group.iter().enumerate().rev() {
        first[group] = v;
    }
    let sewn: Vec<[usize; 3]> = garment.triangles.iter().map(|t| t.map(|v| first[group[v]])).collect();
    let crossed: Vec<usize> = intersections(positions, edges_of(&sewn).pairs(), &sewn)
        .into_iter()
        .flat_map(|crossing| crossing.edge)
        .collect();
    garment.spot(&crossed)
}

/// Height of the highest vertex of what is worn on trunk or limbs, m: what flares comes down, but its top does not; a hood falls back.
pub fn top_m(garment: &Garment, positions: &[V3]) -> f64 {
    let height_m = |vertices: &[V3]| vertices.iter().map(|p| p.z).fold(f64::MIN, f64::max);
    let worn = garment.pieces.iter().filter(|piece| piece.role != Role::Other);
    let tops_m = worn.map(|piece| height_m(&positions[piece.vertices.clone()]));
    tops_m.reduce(f64::max).unwrap_or_else(|| height_m(positions))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laboratory::{self, sheets::sheet};
    use body::{self, Measurements, Sex};
    use geom::V2;
    use pattern::PieceMesh;

    #[test]
    fn what_is_inside_is_told_with_its_place_on_the_piece() {
        let body = body::build(&Measurements::of(Sex::Female, 1.65)).expect("a person that can be");
        let garment = laboratory::garment(sheet(20, 20, 0.01));
        let away = |p: &V2| V3::new(p.x, 2.0 + p.y, 1.0);
        let mut positions: Vec<V3> = garment.rest.iter().map(away).collect();
        assert_eq!(deepest_spot(&body, &garment, &positions), None);
        let centre = body.mesh.positions.iter().sum::<V3>() / body.mesh.positions.len() as f64;
        for v in [0, 7, 200] {
            positions[v] = V3::new(centre.x, centre.y, 1.2);
            let spot = deepest_spot(&body, &garment, &positions).expect("inside");
            assert!((spot.at - garment.rest[v]).norm() < 0.011, "{spot}, expected {}", garment.rest[v]);
            assert!(penetration_m(&body, &garment, &positions) > 0.03);
            positions[v] = away(&garment.rest[v]);
        }
    }

    #[test]
    fn what_crosses_is_told_with_its_place_on_the_piece() {
        let garment = laboratory::garment(sheet(20, 20, 0.01));
        let flat: Vec<V3> = garment.rest.iter().map(|p| V3::new(p.x, p.y, 0.0)).collect();
        assert_eq!(crossed_spot(&garment, &flat), None);
        // Folded over at 0.15 m, and back through the cloth beneath where 0.18 m lies on 0.12.
        let folded = |p: &V2| match p.y - 0.15 {
            over if over < 1e-9 => V3::new(p.x, p.y, 0.0),
            over => V3::new(p.x + 0.003, 0.152 - over, if over > 0.025 { -0.01 } else { 0.01 }),
        };
        let folded: Vec<V3> = garment.rest.iter().map(folded).collect();
        let spot = crossed_spot(&garment, &folded).expect("crossed");
        assert_eq!(spot.piece, garment.pieces[0].id);
        assert!((0.1..0.19).contains(&spot.at.y), "{spot}");
    }

    #[test]
    fn a_hood_that_falls_back_takes_no_garment_down() {
        let mut garment = laboratory::garment(sheet(1, 2, 0.1));
        let whole = garment.pieces[0].clone();
        let at = |heights_m: [f64; 6]| heights_m.map(|z| V3::new(0.0, 0.0, z));
        let check = |garment: &Garment, expect: f64| {
            assert_eq!(top_m(garment, &at([1.1, 1.4, 1.2, 1.3, 1.6, 1.7])), expect);
        };
        let trunk_and = |role: Role| {
            let trunk = PieceMesh { role: Role::Front, vertices: 0..4, ..whole.clone() };
            vec![trunk, PieceMesh { role, vertices: 4..6, ..whole.clone() }]
        };
        garment.pieces = trunk_and(Role::Other);
        check(&garment, 1.4);
        garment.pieces = trunk_and(Role::Back);
        check(&garment, 1.7);
        // Where it is not known what anything is worn as, all counts.
        garment.pieces.iter_mut().for_each(|piece| piece.role = Role::Other);
        check(&garment, 1.7);
    }
}

//! Checks of a finished drape. They are made on its mesh, and do not rely on the contact pairs of the solver.

use crate::contact::intersections::edges_of;
use crate::contact::{Skin, intersections};
use crate::sewing;
use body::Body;
use geom::{DistanceField, V3};
use pattern::{Garment, Role, Spot};

/// Vertex, middle of an edge or centroid of a triangle.
#[derive(Clone, Copy)]
struct Sample {
    /// A vertex is there three times, the second end of an edge twice.
    between: [usize; 3],
    place: V3,
}

struct Deepest {
    depth_m: f64,
    between: [usize; 3],
}

/// 0 where nothing is inside. Vertices, edge midpoints and triangle centroids are tested against the exact surface. NaN
/// for a body mesh that encloses no volume.
pub fn penetration_m(body: &Body, garment: &Garment, positions: &[V3]) -> f64 {
    Skin::new(&body.mesh).map_or(f64::NAN, |skin| depth_m(deepest(&skin, samples(garment, positions))))
}

/// As [`penetration_m`], with a distance field as a filter: only samples that it does not show clearly outside are
/// tested against the exact surface, which is much faster. NaN where a sample is in doubt and there is no `skin`, as
/// for a mesh that encloses no volume.
pub fn penetration_by_field_m(skin: Option<&Skin>, field: &DistanceField, garment: &Garment, positions: &[V3]) -> f64 {
    let is_doubtful = |sample: &Sample| field.value_and_gradient(&sample.place).0 < CLEAR_M;
    let mut doubtful = samples(garment, positions).filter(is_doubtful).peekable();
    match skin {
        _ if doubtful.peek().is_none() => 0.0,
        Some(skin) => depth_m(deepest(skin, doubtful)),
        None => f64::NAN,
    }
}

/// `None` where nothing penetrates the body.
pub fn deepest_spot(body: &Body, garment: &Garment, positions: &[V3]) -> Option<Spot> {
    let found = deepest(&Skin::new(&body.mesh).ok()?, samples(garment, positions))?;
    garment.spot(&found.between)
}

geom::constants! {
    "quality",
    /// Distance in the field beyond which a sample counts as outside: its greatest error, since it is blurred and
    /// misses fingers and creases.
    const CLEAR_M: f64 = 4e-3;
}

/// Every vertex, edge midpoint and triangle centroid, once.
fn samples<'a>(garment: &'a Garment, positions: &'a [V3]) -> impl Iterator<Item = Sample> + 'a {
    let edges = edges_of(&garment.triangles).pairs().to_vec();
    let vertex = |(v, p): (usize, &V3)| Sample { between: [v; 3], place: *p };
    let middle = |[a, b]: [usize; 2]| Sample { between: [a, b, b], place: (positions[a] + positions[b]) / 2.0 };
    let centroid = |t: &[usize; 3]| Sample { between: *t, place: t.iter().map(|v| positions[*v]).sum::<V3>() / 3.0 };
    let vertices = positions.iter().enumerate().map(vertex);
    vertices.chain(edges.into_iter().map(middle)).chain(garment.triangles.iter().map(centroid))
}

/// The quick depth sorts the candidates, and the winding number confirms the first.
fn deepest(skin: &Skin, samples: impl Iterator<Item = Sample>) -> Option<Deepest> {
    let mut inside: Vec<(f64, Sample)> = samples.filter_map(|s| Some((skin.quick_depth(&s.place)?, s))).collect();
    inside.sort_by(|a, b| b.0.total_cmp(&a.0));
    let (depth_m, sample) = inside.into_iter().find(|(_, sample)| skin.contains(&sample.place))?;
    Some(Deepest { depth_m, between: sample.between })
}

fn depth_m(deepest: Option<Deepest>) -> f64 {
    deepest.map_or(0.0, |deepest| deepest.depth_m)
}

/// Greatest gap of a seam pair; 0 where nothing is sewn.
pub fn seam_gap_m(garment: &Garment, positions: &[V3]) -> f64 {
    sewing::widest_seam(garment, positions).map_or(0.0, |seam| seam.gap_m)
}

/// Number of edges and triangles that intersect and share no vertex. `triangles` refer to sewn vertices at `x`.
pub fn self_crossings(x: &[V3], triangles: &[[usize; 3]]) -> usize {
    let edges = edges_of(triangles);
    intersections(x, edges.pairs(), triangles).len()
}

/// `None` where the garment does not intersect itself.
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

/// Height of the highest vertex of the pieces worn on trunk or limbs; of all pieces where no role is known. It shows a
/// garment that slides down: a flared hem may sink while the top stays, and a hood, whose role is another, may fall
/// back.
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
        let positions_at = |heights_m: [f64; 6]| heights_m.map(|z| V3::new(0.0, 0.0, z));
        let check = |garment: &Garment, expect: f64| {
            assert_eq!(top_m(garment, &positions_at([1.1, 1.4, 1.2, 1.3, 1.6, 1.7])), expect);
        };
        let trunk_and = |role: Role| {
            let trunk = PieceMesh { role: Role::Front, vertices: 0..4, ..whole.clone() };
            vec![trunk, PieceMesh { role, vertices: 4..6, ..whole.clone() }]
        };
        garment.pieces = trunk_and(Role::Other);
        check(&garment, 1.4);
        garment.pieces = trunk_and(Role::Back);
        check(&garment, 1.7);
        // Where no role is known, all pieces count.
        garment.pieces.iter_mut().for_each(|piece| piece.role = Role::Other);
        check(&garment, 1.7);
    }
}

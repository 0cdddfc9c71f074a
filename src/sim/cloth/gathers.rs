//! Gathers and ease: a seam that joins a longer side to a shorter one draws the longer side together along the
//! stitches.
//!
//! A mesh joins both sides vertex by vertex and cannot show the pleats between two stitches. Without a correction, the
//! cloth of the longer side resists the shortening as a plate would, and stretches the shorter side: by an eighth where
//! 1.3 times its length is gathered. So the triangles of the longer side near the seam have a rest shape that is
//! shorter along the seam. On the seam it is as long as the partner. From `ROWS` rows of vertices away, where the mesh
//! can show folds, it is as drawn in the pattern.

use std::collections::{BTreeMap, BTreeSet};

use geom::V2;
use geom::polyline::signed_area;
use pattern::Garment;

geom::constants! {
    "cloth.gathers",
    /// Number of rows of vertices over which the cloth passes from drawn together to its full length. Judgement, from
    /// seams gathered 1.1 to 1.7 times: one row left the shorter side up to 0.6 % too long, two rows 0.45 %, three and
    /// four 0.35 %, and no correction 22 %.
    const ROWS: u32 = 2;
    /// Least excess of the longer side, as a share of the shorter one, that counts as ease. Curves that are sampled to
    /// chords make a smaller difference.
    const LEAST_EASE: f64 = 0.01;
    /// Least area of a rest triangle, as a share of its area after uniform shortening. A thinner one gets the uniformly
    /// shortened shape.
    const LEAST_AREA: f64 = 0.3;
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Drawn {
    /// Ratio of the length along the seam to that in the pattern.
    share: f64,
    /// Unit vector along the seam.
    along: V2,
}

impl Drawn {
    fn apply(&self, share: f64, drawn: V2) -> V2 {
        drawn + self.along * ((share - 1.0) * drawn.dot(&self.along))
    }
}

/// Shortening of the cloth by gathered seams, at the vertices that it concerns.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Gathers {
    drawn: BTreeMap<usize, Drawn>,
}

impl Gathers {
    /// A vertex in several gathered seams takes the greatest shortening.
    pub fn of(garment: &Garment) -> Self {
        let mut drawn = BTreeMap::new();
        let edges = sewn_edges(garment);
        for seam in &garment.seams {
            let is_edge = |side: &[usize; 2]| edges.contains(&sorted(*side));
            let stitches = Vec::from_iter(seam.stitches().filter(|sides| sides.iter().all(is_edge)));
            let edge_vector = |[a, b]: [usize; 2]| garment.rest[b] - garment.rest[a];
            let [a, b] = [0, 1].map(|side| stitches.iter().map(|sides| edge_vector(sides[side]).norm()).sum::<f64>());
            let (longer, share) = if a < b { (1, a / b) } else { (0, b / a) };
            if share * (1.0 + LEAST_EASE) < 1.0 {
                let mut along: BTreeMap<usize, V2> = BTreeMap::new();
                for edge in stitches.iter().map(|sides| sides[longer]) {
                    edge.iter().for_each(|&v| *along.entry(v).or_default() += edge_vector(edge));
                }
                for (v, along) in along.into_iter().filter_map(|(v, sum)| Some((v, sum.try_normalize(0.0)?))) {
                    let new = Drawn { share, along };
                    let most = drawn.entry(v).or_insert(new);
                    *most = if share < most.share { new } else { *most };
                }
            }
        }
        Self { drawn: spread(garment, drawn) }
    }

    /// Rest length of a side that is the vector `drawn` in the pattern.
    pub fn length_m(&self, edge: [usize; 2], drawn: V2) -> f64 {
        let ends = sorted(edge).map(|v| self.drawn.get(&v));
        let share = ends.iter().map(|end| end.map_or(1.0, |d| d.share)).sum::<f64>() / 2.0;
        ends.into_iter().flatten().next().map_or(drawn, |d| d.apply(share, drawn)).norm()
    }

    /// Rest shape of a triangle of garment vertices, which is `rest` in the pattern.
    ///
    /// Triangles that share a side agree on its length, except for one that would become too thin: it is shortened
    /// uniformly. Corners are taken in the order of their indices, so that a mirrored garment has the mirrored shapes
    /// to the bit.
    pub fn shape(&self, corners: [usize; 3], rest: [V2; 3]) -> [V2; 3] {
        let mut order = [0, 1, 2];
        order.sort_unstable_by_key(|&k| corners[k]);
        let drawn = order.map(|k| self.drawn.get(&corners[k]));
        let Some(most) = drawn.iter().copied().flatten().min_by(|a, b| a.share.total_cmp(&b.share)) else {
            return rest;
        };
        let share = drawn.iter().map(|d| d.map_or(1.0, |d| d.share)).sum::<f64>() / 3.0;
        let first = rest[order[0]];
        let evenly = rest.map(|p| first + most.apply(share, p - first));
        let side = |a: usize, b: usize| self.length_m([corners[a], corners[b]], rest[b] - rest[a]);
        let [a, b, c] = order;
        let sides = [side(a, b), side(b, c), side(a, c)];
        let mut shape = rest;
        for (k, p) in order.into_iter().zip(with_sides(order.map(|k| evenly[k]), sides)) {
            shape[k] = p;
        }
        if signed_area(&shape) > LEAST_AREA * signed_area(&evenly) { shape } else { evenly }
    }
}

/// Constructs a triangle from its sides, m. First corner, direction of the first side and orientation are those of
/// `like`. Degenerate where the sides violate the triangle inequality.
fn with_sides(like: [V2; 3], [base, right, left]: [f64; 3]) -> [V2; 3] {
    let first = like[1] - like[0];
    let along = first.normalize();
    let foot = (base * base + left * left - right * right) / (2.0 * base);
    let height = (left * left - foot * foot).max(0.0).sqrt().copysign(first.perp(&(like[2] - like[0])));
    [like[0], like[0] + along * base, like[0] + along * foot + V2::new(-along.y, along.x) * height]
}

fn spread(garment: &Garment, mut drawn: BTreeMap<usize, Drawn>) -> BTreeMap<usize, Drawn> {
    let mut last = drawn.clone();
    for row in 1..ROWS {
        let sides = garment
            .triangles
            .iter()
            .flat_map(|t| [[0, 1], [1, 2], [2, 0], [1, 0], [2, 1], [0, 2]].map(|s| s.map(|k| t[k])));
        // In order, so that each vertex takes the value of its neighbour with the smallest index.
        let onwards: BTreeSet<[usize; 2]> =
            sides.filter(|[from, to]| last.contains_key(from) && !drawn.contains_key(to)).collect();
        let mut next: BTreeMap<usize, Drawn> = BTreeMap::new();
        for [from, to] in onwards {
            next.entry(to).or_insert(last[&from]);
        }
        let share = |at_seam: f64| at_seam + (1.0 - at_seam) * f64::from(row) / f64::from(ROWS);
        drawn.extend(next.iter().map(|(&v, d)| (v, Drawn { share: share(d.share), ..*d })));
        last = next;
    }
    drawn
}

fn sewn_edges(garment: &Garment) -> BTreeSet<[usize; 2]> {
    let mut is_sewn = vec![false; garment.rest.len()];
    garment.seams.iter().flat_map(|seam| &seam.pairs).flatten().for_each(|&v| is_sewn[v] = true);
    let sides = garment.triangles.iter().flat_map(|t| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]]);
    sides.filter(|side| side.iter().all(|&v| is_sewn[v])).map(sorted).collect()
}

fn sorted([a, b]: [usize; 2]) -> [usize; 2] {
    [a.min(b), a.max(b)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cloth::Cloth;
    use crate::contact::{BodyContact, ContactParams};
    use crate::fabric;
    use crate::laboratory::{self, sheets};
    use crate::sewing::welded;
    use crate::solver::System;
    use geom::V3;
    use linalg::LinearSolver;
    use pattern::{PieceMesh, Role, SeamMesh};

    /// Band 0.3 m long over a skirt whose upper edge is `ratio` times as long; then the lower vertices of the band and
    /// the upper ones of the skirt.
    fn skirt(ratio: f64, step: f64) -> (Garment, [Vec<usize>; 2]) {
        let columns = (0.3 / step).round() as usize;
        let mut garment = laboratory::garment(sheets::hexagonal_sheet(columns, 4, step));
        let (band, triangles) = (garment.rest.len(), garment.triangles.len());
        let rows = (0.24 / (ratio * step)) as usize / 2 * 2;
        let (rest, cloth) = sheets::hexagonal_sheet(columns, rows, ratio * step);
        let top = rest[rest.len() - 1].y;
        garment.rest.extend(rest.iter().map(|p| V2::new(p.x, p.y - top)));
        garment.triangles.extend(cloth.iter().map(|t| t.map(|v| v + band)));
        let [vertices, triangles] = [band..garment.rest.len(), triangles..garment.triangles.len()];
        garment.pieces[0].vertices.end = band;
        garment.pieces[0].triangles.end = triangles.start;
        let piece =
            PieceMesh { id: "skirt".into(), role: Role::SkirtFront, vertices, triangles, ..garment.pieces[0].clone() };
        garment.pieces.push(piece);
        let at_waist = |v: &usize| garment.rest[*v].y.abs() < 1e-9;
        let sides =
            [Vec::from_iter((0..band).filter(at_waist)), Vec::from_iter((band..garment.rest.len()).filter(at_waist))];
        let pairs = sides[0].iter().zip(&sides[1]).map(|(&a, &b)| [a, b]).collect();
        garment.seams.push(SeamMesh { name: "waist".into(), pairs });
        (garment, sides)
    }

    #[test]
    fn seams_of_equal_sides_leave_the_cloth_as_drawn() {
        let check = |ratio: f64, is_drawn: bool| {
            let gathers = Gathers::of(&skirt(ratio, 0.02).0);
            assert_eq!(!gathers.drawn.is_empty(), is_drawn, "{ratio}");
        };
        check(1.0, false);
        check(1.005, false);
        check(1.02, true);
        check(0.98, true);
    }

    #[test]
    fn the_longer_side_is_as_long_as_the_shorter_and_the_cloth_beyond_as_drawn() {
        let ratio = 1.5;
        let (garment, [_, upper]) = skirt(ratio, 0.02);
        let gathers = Gathers::of(&garment);
        let is_upper = |v: &usize| upper.contains(v);
        let is_next = |v: &usize| (garment.rest[*v].y + 0.03 * 0.75_f64.sqrt()).abs() < 1e-9;
        let side = |shape: &[V2; 3], k: usize| (shape[(k + 1) % 3] - shape[k]).norm();
        let mut seen = [0, 0, 0];
        for piece in &garment.pieces {
            for &t in &garment.triangles[piece.triangles.clone()] {
                let drawn = t.map(|v| garment.rest[v]);
                let shape = gathers.shape(t, drawn);
                let is_far =
                    drawn.iter().all(|p| p.y > -1e-9 || p.y < -(f64::from(ROWS) - 0.5) * 0.03 * 0.75_f64.sqrt());
                if is_far {
                    assert_eq!(shape, drawn);
                    seen[0] += 1;
                }
                for k in (0..3).filter(|&k| is_upper(&t[k]) && is_upper(&t[(k + 1) % 3])) {
                    assert!((side(&shape, k) - 0.02).abs() < 1e-12, "{}", side(&shape, k));
                    seen[1] += 1;
                }
                for k in (0..3).filter(|&k| is_next(&t[k]) && is_next(&t[(k + 1) % 3])) {
                    let share = 1.0 / ratio + (1.0 - 1.0 / ratio) / f64::from(ROWS);
                    assert!((side(&shape, k) - share * side(&drawn, k)).abs() < 1e-12, "{}", side(&shape, k));
                    seen[2] += 1;
                }
            }
        }
        assert!(seen[0] > 100 && seen[1] == 15 && seen[2] > 25, "{seen:?}");
    }

    #[test]
    fn triangles_keep_an_area_however_much_is_gathered() {
        for ratio in [1.1, 2.0, 5.0, 20.0] {
            let (garment, _) = skirt(ratio, 0.02);
            let gathers = Gathers::of(&garment);
            for t in &garment.triangles {
                let drawn = t.map(|v| garment.rest[v]);
                let share = signed_area(&gathers.shape(*t, drawn)) / signed_area(&drawn);
                assert!(share > LEAST_AREA / ratio && share < 1.0 + 1e-9, "{ratio}: {share}");
            }
        }
    }

    #[test]
    fn a_gathered_seam_keeps_the_length_of_its_shorter_side() {
        for (ratio, step) in [(1.1, 0.015), (1.3, 0.0075), (1.7, 0.015)] {
            let (garment, [lower, _]) = skirt(ratio, step);
            let cloth = Cloth::new(&garment, &fabric::library()[0], welded(&garment)).expect("sound");
            let noise = sheets::noise(garment.rest.len(), 5);
            let place = |(v, p): (usize, &V2)| match p.y < -1e-9 {
                true => V3::new(p.x / ratio, 0.003 * noise[v], p.y),
                false => V3::new(if v < garment.pieces[1].vertices.start { p.x } else { p.x / ratio }, 0.0, p.y),
            };
            let mut x = cloth.weld(&Vec::from_iter(garment.rest.iter().enumerate().map(place)));
            let field = laboratory::nowhere();
            let contact = BodyContact::new(&field, ContactParams::default(), &cloth.areas);
            let mut system = System::new(&cloth, contact, None);
            let top = garment.rest[garment.pieces[0].vertices.end - 1].y;
            system.held = (0..garment.rest.len())
                .filter(|&v| garment.rest[v].y > top - 1e-9)
                .map(|v| cloth.vertex_of[v])
                .collect();
            system.linear = LinearSolver::exact();
            laboratory::settle(&mut system, &mut x, 0.01, 600);
            let place = |v: usize| x[cloth.vertex_of[v]];
            let chi = lower.windows(2).map(|w| (place(w[1]) - place(w[0])).norm()).sum::<f64>() / 0.3;
            assert!((chi - 1.0).abs() < 0.01, "gathered {ratio}: chi {chi}");
        }
    }
}

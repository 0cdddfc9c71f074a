//! Girth lines: closed lines on the cloth round trunk, legs and arms. They are plane sections once, and then material
//! lines.

use std::collections::{BTreeMap, BTreeSet};

use super::underarms::underarms;
use super::welded_mesh::Sewn;
use body::{Body, Layer};
use geom::section::Plane;
use geom::{V2, V3};
use pattern::{Garment, Role};

geom::constants! {
    "hybrid.ring",
    /// Distance between the planes.
    const STEP_M: f64 = 0.02;
    /// Distance of the last line round the trunk below the underarms, in edges: both sides cross the same edge of the
    /// seam there.
    const BELOW_UNDERARM: f64 = 0.3;
}

/// Crossing of a ring with an edge: sewn vertices, and the share of the way from the first to the second.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Cut {
    edge: [usize; 2],
    share: f64,
}

#[derive(Clone, Debug)]
pub struct Ring {
    cuts: Vec<Cut>,
    /// Length in the pattern.
    pub rest_m: f64,
    /// Number of its plane; neighbouring planes have neighbouring numbers. Without meaning for the line below the
    /// underarms.
    level: i32,
}

struct Limb {
    triangles: Vec<usize>,
    axis: V3,
    /// True if it may have armholes.
    is_trunk: bool,
}

#[derive(Clone, Debug, Default)]
pub struct Rings {
    pub rings: Vec<Ring>,
    pub beside: Vec<[usize; 2]>,
}

pub fn rings(body: &Body, garment: &Garment, sewn: &Sewn, x: &[V3]) -> Rings {
    let (mut rings, mut beside) = (Vec::new(), Vec::new());
    for limb in limbs(body, garment) {
        let first = rings.len();
        rings.extend(cut(garment, sewn, x, &limb));
        beside.extend(neighbours(&rings, first));
        // The armholes do not lie level, so the planes miss the last stretch below them.
        if limb.is_trunk {
            let highest = (first..rings.len()).max_by_key(|&k| rings[k].level);
            for ring in at_underarm(garment, sewn) {
                beside.extend(highest.map(|highest| [highest, rings.len()]));
                rings.push(ring);
            }
        }
    }
    Rings { rings, beside }
}

/// Sleeves go round their arms, everything else round trunk and legs.
fn limbs(body: &Body, garment: &Garment) -> [Limb; 3] {
    use Layer::*;
    let arm = |[armscye, elbow]: [Layer; 2]| {
        (body.control.ring_centre(armscye) - body.control.ring_centre(elbow)).try_normalize(1e-9).unwrap_or_else(V3::z)
    };
    let triangles_of = |is_in: &dyn Fn(Role) -> bool| {
        let pieces = garment.pieces.iter().filter(|p| is_in(p.role));
        pieces.flat_map(|p| p.triangles.clone()).collect()
    };
    let is_sleeve = |role| matches!(role, Role::SleeveRight | Role::SleeveLeft);
    [
        Limb { triangles: triangles_of(&|role| !is_sleeve(role)), axis: V3::z(), is_trunk: true },
        Limb {
            triangles: triangles_of(&|role| role == Role::SleeveRight),
            axis: arm([ArmscyeRight, ElbowRight]),
            is_trunk: false,
        },
        Limb {
            triangles: triangles_of(&|role| role == Role::SleeveLeft),
            axis: arm([ArmscyeLeft, ElbowLeft]),
            is_trunk: false,
        },
    ]
}

/// Intersection of a plane with a triangle: the edges that it crosses, and its length in the pattern, m.
struct Segment {
    ends: [Cut; 2],
    rest_m: f64,
}

fn cut(garment: &Garment, sewn: &Sewn, x: &[V3], limb: &Limb) -> Vec<Ring> {
    let mut levels: BTreeMap<i32, Vec<Segment>> = BTreeMap::new();
    for &t in &limb.triangles {
        let corners = garment.triangles[t];
        let heights = corners.map(|v| x[sewn.vertex_of[v]].dot(&limb.axis) / STEP_M);
        let low = heights.iter().copied().fold(f64::MAX, f64::min).ceil() as i32;
        let high = heights.iter().copied().fold(f64::MIN, f64::max).ceil() as i32;
        for level in low..high {
            let segment = segment(garment, sewn, corners, heights, level);
            levels.entry(level).or_default().extend(segment);
        }
    }
    levels.iter().flat_map(|(&level, segments)| chained(level, segments)).collect()
}

/// Closed line round the trunk just below the underarms, level in each piece; empty where it does not close.
pub fn at_underarm(garment: &Garment, sewn: &Sewn) -> Vec<Ring> {
    let below_m = garment.edge_length_m * BELOW_UNDERARM;
    let mut segments = Vec::new();
    for (piece, underarm) in underarms(garment) {
        let v = garment.rest[underarm].y - below_m;
        for &corners in &garment.triangles[piece.triangles.clone()] {
            let heights = corners.map(|corner| garment.rest[corner].y - v);
            segments.extend(segment(garment, sewn, corners, heights, 0));
        }
    }
    chained(0, &segments)
}

fn segment(garment: &Garment, sewn: &Sewn, corners: [usize; 3], heights: [f64; 3], level: i32) -> Option<Segment> {
    let cuts: Vec<(Cut, V2)> = (0..3).filter_map(|k| crossing(garment, sewn, corners, heights, k, level)).collect();
    let [(a, from), (b, to)] = cuts.as_slice() else { return None };
    Some(Segment { ends: [*a, *b], rest_m: (to - from).norm() })
}

fn crossing(
    garment: &Garment,
    sewn: &Sewn,
    corners: [usize; 3],
    heights: [f64; 3],
    k: usize,
    level: i32,
) -> Option<(Cut, V2)> {
    let next = (k + 1) % 3;
    let [below, above] = [heights[k], heights[next]].map(|h| h - f64::from(level));
    if (below < 0.0) == (above < 0.0) {
        return None;
    }
    let share = below / (below - above);
    let [a, b] = [corners[k], corners[next]];
    let place = garment.rest[a].lerp(&garment.rest[b], share);
    let [a, b] = [a, b].map(|v| sewn.vertex_of[v]);
    let cut = if a < b { Cut { edge: [a, b], share } } else { Cut { edge: [b, a], share: 1.0 - share } };
    Some((cut, place))
}

fn chained(level: i32, segments: &[Segment]) -> Vec<Ring> {
    let mut at_edge: BTreeMap<[usize; 2], Vec<usize>> = BTreeMap::new();
    for (index, segment) in segments.iter().enumerate() {
        segment.ends.iter().for_each(|cut| at_edge.entry(cut.edge).or_default().push(index));
    }
    let mut used = vec![false; segments.len()];
    let mut rings = Vec::new();
    for start in 0..segments.len() {
        let mut ring = Ring { cuts: Vec::new(), rest_m: 0.0, level };
        let (mut index, mut edge) = (start, segments[start].ends[0].edge);
        while !std::mem::replace(&mut used[index], true) {
            let segment = &segments[index];
            let [from, to] =
                if segment.ends[0].edge == edge { segment.ends } else { [segment.ends[1], segment.ends[0]] };
            ring.cuts.push(from);
            ring.rest_m += segment.rest_m;
            edge = to.edge;
            let Some(&next) = at_edge[&edge].iter().find(|next| !used[**next]) else { break };
            index = next;
        }
        if ring.cuts.len() > 2 && edge == segments[start].ends[0].edge {
            rings.push(ring);
        }
    }
    rings
}

fn neighbours(rings: &[Ring], first: usize) -> Vec<[usize; 2]> {
    let mut pairs = Vec::new();
    for b in first..rings.len() {
        for a in first..b {
            if rings[b].level - rings[a].level == 1 && rings[a].is_beside(&rings[b]) {
                pairs.push([a, b]);
            }
        }
    }
    pairs
}

impl Ring {
    pub fn vertices(&self) -> impl Iterator<Item = usize> + '_ {
        self.cuts.iter().flat_map(|cut| cut.edge)
    }

    fn is_beside(&self, other: &Self) -> bool {
        let own: BTreeSet<usize> = self.vertices().collect();
        other.vertices().any(|v| own.contains(&v))
    }

    pub fn points<'a>(&'a self, x: &'a [V3]) -> impl Iterator<Item = V3> + 'a {
        self.cuts.iter().map(|cut| x[cut.edge[0]].lerp(&x[cut.edge[1]], cut.share))
    }

    pub fn length_m(&self, x: &[V3]) -> f64 {
        let points: Vec<V3> = self.points(x).collect();
        let next = points.iter().cycle().skip(1);
        points.iter().zip(next).map(|(a, b)| (b - a).norm()).sum()
    }

    /// Plane through the ring's middle, normal to its area vector; `None` for a line without area.
    pub fn plane(&self, x: &[V3]) -> Option<Plane> {
        let points: Vec<V3> = self.points(x).collect();
        let middle = points.iter().sum::<V3>() / points.len() as f64;
        let next = points.iter().cycle().skip(1);
        let area: V3 = points.iter().zip(next).map(|(a, b)| (a - middle).cross(&(b - middle))).sum();
        Some(Plane::normal_to(middle, area.try_normalize(1e-9)?))
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::super::inset::{Fit, Insets};
    use super::*;
    use geom::shapes::sphere;

    const COUNT: usize = 48;

    fn ring(rest_m: f64) -> Rings {
        let cuts = (0..COUNT).map(|v| Cut { edge: [v, v], share: 0.0 }).collect();
        Rings { rings: vec![Ring { cuts, rest_m, level: 0 }], beside: vec![] }
    }

    fn circle(radius: f64, z: f64) -> Vec<V3> {
        let direction = |k: usize| (k as f64 / COUNT as f64 * TAU).sin_cos();
        (0..COUNT).map(direction).map(|(sin, cos)| V3::new(radius * cos, radius * sin, z)).collect()
    }

    fn inset(insets: &Insets) -> f64 {
        insets.of_vertices(vec![0.0; COUNT], &[])[0]
    }

    #[test]
    fn a_ring_knows_its_length_and_its_plane() {
        let Rings { rings, .. } = ring(0.7);
        let x = circle(0.1, 0.15);
        assert!((rings[0].length_m(&x) - TAU * 0.1).abs() < 1e-3);
        let plane = rings[0].plane(&x).expect("it has an area");
        assert!((plane.normal().z.abs() - 1.0).abs() < 1e-9 && (plane.origin - V3::new(0.0, 0.0, 0.15)).norm() < 1e-9);
    }

    #[test]
    fn a_body_is_smaller_by_what_a_ring_lacks_over_a_turn_and_little_more() {
        let ball = sphere(0.2, 48);
        let [offset, share] = [2e-3, 2e-3];
        // The ball's girth 0.15 above its middle.
        let radius = (0.2_f64.powi(2) - 0.15_f64.powi(2)).sqrt();
        let x = circle(radius, 0.15);
        let fit = Fit { offset_m: offset, share };
        let mut insets = Insets::judged(ring(0.7), &ball, &x, fit, true);
        let lack = radius + offset - 0.7 * (1.0 + share) / TAU;
        assert!((inset(&insets) - lack).abs() < 1e-3, "{} instead of {lack}", inset(&insets));
        // The cloth is still as wide as the body: that must not make the body smaller and smaller.
        (0..50).for_each(|_| insets.correct(&x, share));
        assert!((inset(&insets) - lack - 20e-3).abs() < 1e-3, "{}", inset(&insets));
        // Once it has closed and is slack, the body takes its size again.
        let slack = circle(0.6 / TAU, 0.15);
        (0..50).for_each(|_| insets.correct(&slack, share));
        assert!(inset(&insets) < 1e-5, "{}", inset(&insets));
    }

    #[test]
    fn a_ring_that_is_large_enough_is_held_up_where_the_body_is_wider() {
        let ball = sphere(0.2, 48);
        let fit = Fit { offset_m: 2e-3, share: 2e-3 };
        let mut insets = Insets::judged(ring(0.9), &ball, &circle(0.14, 0.15), fit, false);
        assert_eq!(inset(&insets), 0.0);
        // Round the ball's middle it would lack 0.36.
        let below = circle(0.2, 0.0);
        insets.judge_again(&ball, &below, fit);
        insets.correct(&below, 2e-3);
        assert_eq!(inset(&insets), 0.0);
    }
}

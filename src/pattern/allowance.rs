//! Seam allowance: offsets the cut line of a piece inwards, which gives its sew line.

use crate::piece::Piece;
use crate::style::corners::corner_vertices;
use geom::V2;
use geom::polyline::{self_crossing, signed_area};
use geom::units::mm;

/// A wider margin is a facing.
const GREATEST_M: f64 = 0.1;
/// Extension of each offset edge beyond its ends, in allowances: edges meet at corners as sharp as 20 degrees.
const CARRIED_ON: f64 = 6.0;

#[derive(Clone, Debug, PartialEq)]
struct Inset {
    line: Vec<V2>,
    corners: Vec<V2>,
}

/// Offsets a counter-clockwise line inwards by one distance for each edge between neighbouring `corners`. `None` if the
/// result would cross itself or turn inside out.
fn inset(ring: &[V2], corners: &[usize], distance_m: &[f64]) -> Option<Inset> {
    let (n, count) = (ring.len(), corners.len());
    let carried_m = CARRIED_ON * distance_m.iter().map(|d| d.abs()).fold(0.0, f64::max);
    let moved = |edge: usize| {
        let (from, to) = (corners[edge], corners[(edge + 1) % count]);
        let steps = if count == 1 || from == to { n } else { (to + n - from) % n };
        let points: Vec<V2> = (0..=steps).map(|step| ring[(from + step) % n]).collect();
        moved_edge(&points, distance_m[edge], carried_m)
    };
    let edges: Vec<Vec<V2>> = (0..count).map(moved).collect::<Option<_>>()?;
    // Where neighbouring offset edges intersect.
    let meets: Vec<Meeting> =
        (0..count).map(|k| meeting(&edges[k], &edges[(k + 1) % count], carried_m)).collect::<Option<_>>()?;
    let mut line = Vec::new();
    for (k, edge) in edges.iter().enumerate() {
        let (start, end) = (&meets[(k + count - 1) % count], &meets[k]);
        let along = edge[start.next + 1] - edge[start.next];
        if start.next > end.edge || (start.next == end.edge && (end.at - start.at).dot(&along) < 0.0) {
            return None;
        }
        line.push(start.at);
        line.extend(edge.iter().take(end.edge + 1).skip(start.next + 1));
    }
    line.dedup_by(|a, b| (*a - *b).norm() < 1e-7);
    let corners = (0..count).map(|k| meets[(k + count - 1) % count].at).collect();
    (line.len() >= 3 && signed_area(&line) > 0.0 && self_crossing(&line).is_none()).then_some(Inset { line, corners })
}

/// Offsets an open line to its left, and extends it straight at both ends.
fn moved_edge(points: &[V2], distance_m: f64, carried_m: f64) -> Option<Vec<V2>> {
    let directions: Vec<V2> =
        points.windows(2).map(|ends| (ends[1] - ends[0]).try_normalize(0.0)).collect::<Option<_>>()?;
    let left = |d: V2| V2::new(-d.y, d.x);
    let last = directions.len() - 1;
    let offset = |vertex: usize| {
        let (u, v) = (directions[vertex.saturating_sub(1)], directions[vertex.min(last)]);
        let middle = (left(u) + left(v)).try_normalize(0.0).unwrap_or_else(|| left(v));
        // Miter: intersection of the two offset segments. Neighbouring segments of a curve turn little.
        points[vertex] + middle * (distance_m / middle.dot(&left(v)).max(0.5))
    };
    let mut line = vec![offset(0) - directions[0] * carried_m];
    line.extend((0..points.len()).map(offset));
    line.push(offset(points.len() - 1) + directions[last] * carried_m);
    Some(line)
}

struct Meeting {
    edge: usize,
    next: usize,
    at: V2,
}

/// If there are several, the intersection that cuts off least of both lines.
fn meeting(edge: &[V2], next: &[V2], carried_m: f64) -> Option<Meeting> {
    let mut best: Option<(f64, Meeting)> = None;
    let mut behind = 0.0;
    for i in (0..edge.len() - 1).rev() {
        let mut before = 0.0;
        for j in 0..next.len() - 1 {
            if let Some((t, u)) = crossing([edge[i], edge[i + 1]], [next[j], next[j + 1]]) {
                let length = [(edge[i + 1] - edge[i]).norm(), (next[j + 1] - next[j]).norm()];
                let cut = behind + (1.0 - t) * length[0] + before + u * length[1];
                if best.as_ref().is_none_or(|(least, _)| cut < *least) {
                    best = Some((cut, Meeting { edge: i, next: j, at: edge[i].lerp(&edge[i + 1], t) }));
                }
            }
            before += (next[j + 1] - next[j]).norm();
            if before > 3.0 * carried_m {
                break;
            }
        }
        behind += (edge[i + 1] - edge[i]).norm();
        if behind > 3.0 * carried_m {
            break;
        }
    }
    // Edges that continue each other straight do not cross: they meet at their ends.
    let straight = || {
        let (end, start) = (edge[edge.len() - 2], next[1]);
        Meeting { edge: edge.len() - 3, next: 1, at: end.lerp(&start, 0.5) }
    };
    best.map(|(_, meeting)| meeting)
        .or_else(|| ((edge[edge.len() - 2] - next[1]).norm() < 0.5 * carried_m).then(straight))
}

/// Parameters in 0..=1.
fn crossing([a, b]: [V2; 2], [c, d]: [V2; 2]) -> Option<(f64, f64)> {
    let (u, v) = (b - a, d - c);
    let turn = u.perp(&v);
    if turn.abs() < 1e-3 * u.norm() * v.norm() {
        return None;
    }
    let (t, s) = ((c - a).perp(&v) / turn, (c - a).perp(&u) / turn);
    ((0.0..=1.0).contains(&t) && (0.0..=1.0).contains(&s)).then_some((t, s))
}

fn nearest(ring: &[V2], point: V2) -> V2 {
    let on_side = |k: usize| {
        let (a, along) = (ring[k], ring[(k + 1) % ring.len()] - ring[k]);
        a + along * ((point - a).dot(&along) / along.norm_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0)
    };
    let distance = |p: &V2| (p - point).norm_squared();
    (0..ring.len()).map(on_side).min_by(|p, q| distance(p).total_cmp(&distance(q))).unwrap_or(point)
}

impl Piece {
    /// Returns the piece with a sew line inside its cut line, and with turn points and notches on the sew line. A piece
    /// that has a sew line stays as it is.
    pub fn with_allowance(mut self, allowance_m: f64) -> Result<Self, String> {
        if self.sew_line.is_some() || allowance_m == 0.0 {
            return Ok(self);
        }
        let corners = corner_vertices(&self);
        let corners = if corners.is_empty() { vec![0] } else { corners };
        let distances_m = vec![allowance_m; corners.len()];
        self.cut_at(&corners, &distances_m)?;
        let cut = |piece: &Self| piece.clone().with_allowance(allowance_m).ok();
        self.beside.sizes = self.beside.sizes.iter().filter_map(cut).collect();
        Ok(self)
    }

    /// Adds a sew line to a piece without one, by one distance for each edge between neighbouring vertices `corners`.
    /// The corners of the sew line become the turn points, and the notches move onto it.
    pub(crate) fn cut_at(&mut self, corners: &[usize], distances_m: &[f64]) -> Result<(), String> {
        if let Some(refused_m) = distances_m.iter().find(|distance| !(0.0..=GREATEST_M).contains(*distance)) {
            return Err(format!("found an allowance of {} mm; accepted: 0 to {} mm", mm(*refused_m), mm(GREATEST_M)));
        }
        let Some(inset) = inset(&self.outline, corners, distances_m) else {
            let most_mm = mm(distances_m.iter().copied().fold(0.0, f64::max));
            let found = format!("found piece `{}` too narrow for an allowance of {most_mm} mm", self.name);
            return Err(format!("{found}; accepted: less"));
        };
        self.notches.iter_mut().for_each(|notch| notch.at = nearest(&inset.line, notch.at));
        self.turn_points = inset.corners;
        self.sew_line = Some(inset.line);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draft::Model;

    #[test]
    fn a_square_and_a_ring_are_moved_inwards() {
        let square = [V2::zeros(), V2::new(1.0, 0.0), V2::new(1.0, 1.0), V2::new(0.0, 1.0)];
        let Inset { line: inner, corners } = inset(&square, &[0, 1, 2, 3], &[0.1, 0.2, 0.2, 0.2]).expect("room enough");
        let expect = [V2::new(0.2, 0.1), V2::new(0.8, 0.1), V2::new(0.8, 0.8), V2::new(0.2, 0.8)];
        assert!(inner.iter().zip(expect).all(|(a, b)| (a - b).norm() < 1e-12), "{inner:?}");
        assert_eq!(inner, corners);
        assert_eq!(inset(&square, &[0, 1, 2, 3], &[0.6; 4]), None);
        // A corner with vertices near it: what the next edge cuts off goes.
        let near = [&square[..1], &[V2::new(0.02, 0.0), V2::new(0.95, 0.0)], &square[1..]].concat();
        let Inset { line: inner, .. } = inset(&near, &[0, 3, 4, 5], &[0.1; 4]).expect("room enough");
        assert_eq!(inner.len(), 4, "{inner:?}");
        let half: Vec<V2> = (0..=180).map(|k| f64::from(k).to_radians()).map(|a| V2::new(a.cos(), a.sin())).collect();
        let Inset { line: inner, .. } = inset(&half, &[0, 180], &[0.25; 2]).expect("room enough");
        let area = |r: f64, d: f64| r * r * (d / r).acos() - d * (r * r - d * d).sqrt();
        assert!((signed_area(&inner) - area(0.75, 0.25)).abs() < 1e-3, "{}", signed_area(&inner));
    }

    #[test]
    fn the_sew_line_of_a_draft_is_so_far_inside_everywhere() {
        for net in Model::ALL.into_iter().flat_map(|model| model.drafts().swap_remove(0).pieces) {
            let piece = net.clone().with_allowance(10e-3).unwrap_or_else(|told| panic!("{told}"));
            let line = piece.sew_line.as_ref().expect("a sew line");
            let sides = |k: usize| [net.outline[k], net.outline[(k + 1) % net.outline.len()]];
            let to_cut = |p: &V2| {
                let all = (0..net.outline.len()).map(sides);
                all.map(|[a, b]| geom::polyline::segment_distance(&a, &b, p)).fold(f64::INFINITY, f64::min)
            };
            // A corner that turns into the piece lies further in.
            let is_corner = |p: &&V2| piece.turn_points.iter().any(|corner| (corner - *p).norm() < 1e-6);
            let along = line.iter().filter(|p| !is_corner(p));
            let (least, most) = along.map(to_cut).fold((f64::INFINITY, 0.0_f64), |(l, m), d| (l.min(d), m.max(d)));
            assert!(least > 9.9e-3 && most < 10.2e-3, "{}: {:.2} to {:.2} mm", net.name, mm(least), mm(most));
            assert_eq!(corner_vertices(&piece).len(), corner_vertices(&net).len(), "{}", net.name);
        }
    }

    #[test]
    fn a_piece_that_is_too_narrow_says_so() {
        let strip = vec![V2::zeros(), V2::new(0.5, 0.0), V2::new(0.5, 0.015), V2::new(0.0, 0.015)];
        let piece = Piece { name: "LOOP".to_owned(), outline: strip, ..Piece::default() };
        let told = piece.clone().with_allowance(10e-3).expect_err("too narrow");
        assert!(told.contains("`LOOP` too narrow"), "{told}");
        assert!(piece.clone().with_allowance(0.5).expect_err("too much").contains("0 to 100 mm"));
        assert_eq!(piece.clone().with_allowance(0.0), Ok(piece));
    }
}

//! Polylines and polygons of the plane. Lengths are in the unit of the points.

use super::V2;

#[derive(Clone, Debug, PartialEq)]
pub struct Polyline {
    points: Vec<V2>,
    /// Arc length from the first point to each point.
    arcs: Vec<f64>,
}

impl Polyline {
    /// `None` for fewer than two points.
    pub fn new(points: Vec<V2>) -> Option<Self> {
        if points.len() < 2 {
            return None;
        }
        let mut arcs = Vec::with_capacity(points.len());
        let mut arc = 0.0;
        arcs.push(arc);
        for ends in points.windows(2) {
            arc += (ends[1] - ends[0]).norm();
            arcs.push(arc);
        }
        Some(Self { points, arcs })
    }

    pub fn mapped(&self, map: impl Fn(V2) -> V2) -> Self {
        let points: Vec<V2> = self.points.iter().map(|&p| map(p)).collect();
        Self::new(points).unwrap_or_else(|| self.clone())
    }

    pub fn points(&self) -> &[V2] {
        &self.points
    }

    pub fn arcs(&self) -> &[f64] {
        &self.arcs
    }

    pub fn length(&self) -> f64 {
        self.arcs[self.arcs.len() - 1]
    }

    /// Point at `arc` from the start, clamped to the ends.
    pub fn at(&self, arc: f64) -> V2 {
        let last = self.points.len() - 1;
        let next = self.arcs.partition_point(|&a| a <= arc).clamp(1, last);
        let (low, high) = (self.arcs[next - 1], self.arcs[next]);
        let share = if high > low { ((arc - low) / (high - low)).clamp(0.0, 1.0) } else { 0.0 };
        self.points[next - 1].lerp(&self.points[next], share)
    }
}

fn sides(polygon: &[V2]) -> impl Iterator<Item = (V2, V2)> + '_ {
    polygon.iter().zip(polygon.iter().cycle().skip(1)).map(|(&a, &b)| (a, b))
}

/// Positive if counter-clockwise.
pub fn signed_area(polygon: &[V2]) -> f64 {
    0.5 * sides(polygon).map(|(a, b)| a.perp(&b)).sum::<f64>()
}

pub fn perimeter(polygon: &[V2]) -> f64 {
    sides(polygon).map(|(a, b)| (b - a).norm()).sum()
}

/// Even-odd rule.
pub fn contains(polygon: &[V2], point: &V2) -> bool {
    let crossings = sides(polygon)
        .filter(|(a, b)| (a.y > point.y) != (b.y > point.y))
        .filter(|(a, b)| point.x < a.x + (point.y - a.y) / (b.y - a.y) * (b.x - a.x))
        .count();
    crossings % 2 == 1
}

pub fn segment_distance(a: &V2, b: &V2, point: &V2) -> f64 {
    let along = b - a;
    let share = if along.norm_squared() > 0.0 { (point - a).dot(&along) / along.norm_squared() } else { 0.0 };
    (a + along * share.clamp(0.0, 1.0) - point).norm()
}

pub fn boundary_distance(polygon: &[V2], point: &V2) -> f64 {
    sides(polygon).map(|(a, b)| segment_distance(&a, &b, point)).fold(f64::INFINITY, f64::min)
}

/// Parameters of the intersection along each segment, 0..=1. `None` if they do not meet or are parallel.
pub fn segment_meeting(a: (V2, V2), b: (V2, V2)) -> Option<(f64, f64)> {
    let (da, db, offset) = (a.1 - a.0, b.1 - b.0, b.0 - a.0);
    let cross = da.perp(&db);
    if cross.abs() <= 1e-14 * da.norm() * db.norm() {
        return None;
    }
    let (s, t) = (offset.perp(&db) / cross, offset.perp(&da) / cross);
    ((0.0..=1.0).contains(&s) && (0.0..=1.0).contains(&t)).then_some((s, t))
}

/// First intersection of two sides of a closed polygon that are not neighbours.
pub fn self_crossing(polygon: &[V2]) -> Option<V2> {
    crossing_sides(polygon).map(|(_, place)| place)
}

/// First pair of sides that intersect without being neighbours, and the intersection. A side is named by its first
/// vertex, and the lesser comes first.
///
/// Sweeps over the least `x` of the sides, so that many sides cost little more than sorting them.
pub fn crossing_sides(polygon: &[V2]) -> Option<([usize; 2], V2)> {
    let all: Vec<(V2, V2)> = sides(polygon).collect();
    let n = all.len();
    let mut order: Vec<usize> = (0..n).collect();
    let left = |i: usize| all[i].0.x.min(all[i].1.x);
    order.sort_by(|&i, &j| left(i).total_cmp(&left(j)));
    for (k, &i) in order.iter().enumerate() {
        let right = all[i].0.x.max(all[i].1.x);
        for &j in order[k + 1..].iter().take_while(|&&j| left(j) <= right) {
            let are_neighbours = (i + 1) % n == j || (j + 1) % n == i;
            if are_neighbours {
                continue;
            }
            if let Some((s, _)) = segment_meeting(all[i], all[j]) {
                return Some(([i.min(j), i.max(j)], all[i].0.lerp(&all[i].1, s)));
            }
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(list: &[(f64, f64)]) -> Vec<V2> {
        list.iter().map(|&(x, y)| V2::new(x, y)).collect()
    }

    #[test]
    fn a_polyline_is_walked_by_arc_length() {
        let line = Polyline::new(points(&[(0.0, 0.0), (3.0, 0.0), (3.0, 4.0)])).expect("three points");
        assert_eq!(line.length(), 7.0);
        for (arc, expect) in
            [(-1.0, (0.0, 0.0)), (1.5, (1.5, 0.0)), (3.0, (3.0, 0.0)), (5.0, (3.0, 2.0)), (9.0, (3.0, 4.0))]
        {
            assert_eq!(line.at(arc), V2::new(expect.0, expect.1), "at {arc}");
        }
        assert!(Polyline::new(points(&[(0.0, 0.0)])).is_none());
    }

    #[test]
    fn polygons_have_area_perimeter_inside_and_crossings() {
        let square = points(&[(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)]);
        assert_eq!((signed_area(&square), perimeter(&square)), (4.0, 8.0));
        assert!(contains(&square, &V2::new(1.0, 0.1)) && !contains(&square, &V2::new(2.1, 1.0)));
        assert_eq!(boundary_distance(&square, &V2::new(1.0, 0.25)), 0.25);
        assert_eq!(self_crossing(&square), None);
        let bow = points(&[(0.0, 0.0), (2.0, 2.0), (2.0, 0.0), (0.0, 2.0)]);
        assert_eq!(self_crossing(&bow), Some(V2::new(1.0, 1.0)));
    }
}

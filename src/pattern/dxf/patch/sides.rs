//! Sides of drawn lines, and what becomes of them.

use geom::V2;
use geom::polyline::segment_distance;

/// Greatest distance of a drawn side from the line that it is carried to: what scissors follow.
pub const DRAWN_M: f64 = 0.2e-3;
/// Distance from one carried point of a side to the next.
const STEP_M: f64 = 5e-3;
const MOST_STEPS: f64 = 200.0;
/// Distance below which a point counts as on a side: the rounding of files.
const ON_SIDE_M: f64 = 0.05e-3;
const HALVINGS: usize = 12;

/// Side that is straight before the change.
#[derive(Clone, Debug)]
pub struct Side {
    ends: [V2; 2],
    /// Points after the change with both ends, each with its share of the side before.
    pub drawn: Vec<(f64, V2)>,
    pub departs_m: f64,
}

impl Side {
    /// Side whose ends go to `places`. If `is_divided`, it gets as few points as keep it within [`DRAWN_M`] of the
    /// carried line.
    pub fn new(ends: [V2; 2], places: [V2; 2], carried: impl Fn(V2) -> V2, is_divided: bool) -> Self {
        let steps = ((ends[1] - ends[0]).norm() / STEP_M).ceil().clamp(2.0, MOST_STEPS) as usize;
        let share = |k: usize| k as f64 / steps as f64;
        let between = (1..steps).map(|k| carried(ends[0].lerp(&ends[1], share(k))));
        let line: Vec<V2> = std::iter::once(places[0]).chain(between).chain([places[1]]).collect();
        let kept = if is_divided { evenly(&line) } else { vec![0, steps] };
        let departs_m = kept.windows(2).map(|pair| departs(&line, pair[0], pair[1])).fold(0.0, f64::max);
        let drawn = kept.into_iter().map(|k| (share(k), line[k])).collect();
        Self { ends, drawn, departs_m }
    }

    pub fn is_drawn_again_by(&self, other: &Self) -> bool {
        let are_near = |[a, b]: [V2; 2]| (self.ends[0] - a).norm().max((self.ends[1] - b).norm()) < ON_SIDE_M;
        are_near(other.ends) || are_near([other.ends[1], other.ends[0]])
    }

    pub fn between(&self) -> impl Iterator<Item = V2> + '_ {
        self.drawn[1..self.drawn.len() - 1].iter().map(|(_, point)| *point)
    }

    /// Maps a point by the side before. Its distance from the side stays.
    fn at(&self, point: V2) -> V2 {
        let along = self.ends[1] - self.ends[0];
        let share = ((point - self.ends[0]).dot(&along) / along.norm_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        let beside = point - self.ends[0].lerp(&self.ends[1], share);
        let next = self.drawn.partition_point(|(of, _)| *of <= share).clamp(1, self.drawn.len() - 1);
        let ((low, from), (high, to)) = (self.drawn[next - 1], self.drawn[next]);
        from.lerp(&to, (share - low) / (high - low)) + beside
    }
}

/// Place of a point after the change. `None` for a point off all sides.
pub fn on_sides(sides: &[Side], point: V2) -> Option<V2> {
    let distance = |side: &Side| segment_distance(&side.ends[0], &side.ends[1], &point);
    let nearest = sides.iter().map(|side| (distance(side), side)).min_by(|a, b| a.0.total_cmp(&b.0));
    nearest.filter(|(distance_m, _)| *distance_m < ON_SIDE_M).map(|(_, side)| side.at(point))
}

/// Greatest distance of the points between two from the straight way, m.
fn departs(line: &[V2], from: usize, to: usize) -> f64 {
    line[from..=to].iter().map(|p| segment_distance(&line[from], &line[to], p)).fold(0.0, f64::max)
}

/// Indices of the fewest points that keep within a distance of the line: each as far on as possible.
fn fewest(line: &[V2], within_m: f64) -> Vec<usize> {
    let last = line.len() - 1;
    let mut kept = vec![0];
    let mut from = 0;
    while from < last {
        let far = (from + 2..=last).take_while(|to| departs(line, from, *to) <= within_m).last();
        from = far.unwrap_or(from + 1);
        kept.push(from);
    }
    kept
}

/// As many points as [`fewest`] takes within [`DRAWN_M`], by the least distance for which so many suffice.
fn evenly(line: &[V2]) -> Vec<usize> {
    let mut best = fewest(line, DRAWN_M);
    let (mut low, mut high) = (0.0, DRAWN_M);
    if best.len() > 2 {
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            let tried = fewest(line, middle);
            if tried.len() == best.len() {
                (best, high) = (tried, middle);
            } else {
                low = middle;
            }
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_side_that_bends_gets_the_fewest_points() {
        let ends = [V2::zeros(), V2::new(0.4, 0.0)];
        let check = |bend_m: f64, is_divided: bool, points: usize| {
            let carried = |p: V2| V2::new(p.x, 0.02 + bend_m * (p.x / 0.4 * std::f64::consts::PI).sin());
            let side = Side::new(ends, ends.map(carried), carried, is_divided);
            assert_eq!(side.between().count(), points, "{bend_m}");
            assert!(side.departs_m <= DRAWN_M || !is_divided, "{}", side.departs_m);
            for share in [0.0, 0.1, 0.37, 0.5, 1.0] {
                let place = on_sides(std::slice::from_ref(&side), V2::new(0.4 * share, 0.0)).expect("on the side");
                let off_m = (place - carried(V2::new(0.4 * share, 0.0))).norm();
                assert!(off_m < 1.2 * side.departs_m.max(1e-12), "{bend_m} {share}: {off_m}");
            }
            assert_eq!(on_sides(&[side], V2::new(0.2, 0.001)), None);
        };
        check(0.0, true, 0);
        check(0.19e-3, true, 0);
        check(0.3e-3, true, 1);
        check(5e-3, true, 4);
        check(5e-3, false, 0);
    }
}

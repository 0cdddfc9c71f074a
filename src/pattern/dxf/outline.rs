//! Joining of drawn lines into closed outlines, and their repair.

use std::collections::{BTreeSet, HashMap};

use geom::V2;
use geom::polyline::{crossing_sides, self_crossing, signed_area};
use geom::units::mm;

/// Greatest gap between ends that join.
pub const JOIN_M: f64 = 0.05e-3;
const SAME_M: f64 = 1e-6;
/// A piece has some hundreds.
const MOST_VERTICES: usize = 20_000;
/// An outline that is drawn segment by segment has some hundreds.
pub const MOST_LINES: usize = 5_000;
/// Greatest area of the loops of a cut line, as a share of the piece. Trousers with pockets have a thousandth.
pub const LOOPS_SHARE: f64 = 0.01;
/// Greatest area of the loops of a sewn outline: a knot from grading, smaller than scissors could follow.
pub const TRIFLE_M2: f64 = 1e-5;
/// A cut line has at most a few at each inner corner.
const MOST_LOOPS: usize = 200;

/// Greatest width of a spike: each side may be off by half of a thousandth of an inch, the coarsest grid on which
/// programs write.
const SPIKE_M: f64 = 0.026e-3;

/// Greatest slope of one side of a spike relative to the other. A short sharp corner has a greater one.
const SPIKE_SLOPE: f64 = 1e-3;

const TOUCHING_M: f64 = 0.01e-3;

/// Distance by which touching corners are moved inwards.
const PARTED_M: f64 = 0.02e-3;

#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// At least one.
    pub points: Vec<V2>,
    pub is_closed: bool,
}

impl Line {
    /// Drops repeated points. `None` without points.
    pub fn new(mut points: Vec<V2>, is_closed: bool) -> Option<Self> {
        points.dedup_by(|later, earlier| (*later - *earlier).norm() < SAME_M);
        (!points.is_empty()).then_some(Self { points, is_closed })
    }

    pub fn ends(&self) -> [V2; 2] {
        [self.points[0], self.points[self.points.len() - 1]]
    }

    pub fn gap(&self) -> f64 {
        let [start, end] = self.ends();
        (end - start).norm()
    }

    /// True also for a line that ends where it begins.
    pub fn closes(&self) -> bool {
        self.is_closed || (self.points.len() > 2 && self.gap() < JOIN_M && !self.is_slit())
    }

    /// True if the line only runs out and back along itself. It ends where it begins, but the outline continues there.
    fn is_slit(&self) -> bool {
        let length: f64 = self.points.windows(2).map(|ends| (ends[1] - ends[0]).norm()).sum();
        signed_area(&self.points).abs() < JOIN_M * length
    }

    /// True for the same points in the same or the reverse order.
    pub fn is_drawn_again_by(&self, other: &Self) -> bool {
        let near = |(a, b): (&V2, &V2)| (a - b).norm() < SAME_M;
        self.points.len() == other.points.len()
            && (self.points.iter().zip(&other.points).all(near)
                || self.points.iter().zip(other.points.iter().rev()).all(near))
    }
}

pub fn without_copies(lines: Vec<Line>) -> (Vec<Line>, Vec<Line>) {
    let (mut kept, mut copies): (Vec<Line>, Vec<Line>) = (Vec::new(), Vec::new());
    let mut seen: HashMap<[i64; 2], Vec<usize>> = HashMap::new();
    for line in lines {
        // Duplicates have the same midpoint between their ends, up to rounding into a neighbouring cell.
        let [start, end] = line.ends();
        let key = cell(&((start + end) * 0.5));
        let is_copy = around(key)
            .filter_map(|key| seen.get(&key))
            .flatten()
            .any(|&other: &usize| kept[other].is_drawn_again_by(&line));
        if is_copy {
            copies.push(line);
        } else {
            seen.entry(key).or_default().push(kept.len());
            kept.push(line);
        }
    }
    (kept, copies)
}

/// Cell of a grid of width [`JOIN_M`].
fn cell(point: &V2) -> [i64; 2] {
    [point.x, point.y].map(|x| (x / JOIN_M).floor() as i64)
}

fn around([x, y]: [i64; 2]) -> impl Iterator<Item = [i64; 2]> {
    (-1..=1).flat_map(move |i: i64| (-1..=1).map(move |j: i64| [x.saturating_add(i), y.saturating_add(j)]))
}

/// Ends of unused lines, by grid cell.
struct Ends<'a> {
    lines: &'a [Line],
    by_cell: HashMap<[i64; 2], Vec<usize>>,
    left: BTreeSet<usize>,
}

impl<'a> Ends<'a> {
    fn of(lines: &'a [Line]) -> Self {
        let mut by_cell: HashMap<[i64; 2], Vec<usize>> = HashMap::new();
        for (index, line) in lines.iter().enumerate() {
            for end in line.ends() {
                by_cell.entry(cell(&end)).or_default().push(index);
            }
        }
        Self { lines, by_cell, left: (0..lines.len()).collect() }
    }

    /// Takes the first unused line at a point, in the order that leads away from there.
    fn take_at(&mut self, place: &V2) -> Option<Vec<V2>> {
        let touches = |index: &usize| self.lines[*index].ends().iter().any(|end| (end - place).norm() < JOIN_M);
        let near = around(cell(place)).filter_map(|key| self.by_cell.get(&key)).flatten().copied();
        let next = near.filter(|index| self.left.contains(index) && touches(index)).min()?;
        self.left.remove(&next);
        let mut points = self.lines[next].points.clone();
        if (points[0] - place).norm() >= JOIN_M {
            points.reverse();
        }
        Some(points)
    }
}

/// Joins lines end to end. Each chain begins with the first unused line of the file.
pub fn chains(lines: &[Line]) -> Vec<Line> {
    let mut ends = Ends::of(lines);
    let mut chains = Vec::new();
    while let Some(first) = ends.left.pop_first() {
        let mut chain = lines[first].clone();
        while !chain.closes() {
            let Some(next) = ends.take_at(&chain.ends()[1]) else { break };
            chain.points.extend(next.into_iter().skip(1));
        }
        // An open chain may also continue before its first line.
        while !chain.closes() {
            let Some(next) = ends.take_at(&chain.ends()[0]) else { break };
            let before = next.into_iter().skip(1).rev();
            chain.points = before.chain(chain.points.iter().copied()).collect();
        }
        chains.push(chain);
    }
    chains
}

/// Joins lines into one polygon, the first vertex not repeated.
pub fn joined(lines: &[Line], what: &str) -> Result<Vec<V2>, String> {
    let mut chains = chains(lines).into_iter();
    let Some(first) = chains.next() else {
        return Err(format!("no {what}; accepted: one closed polyline, or lines that join into one"));
    };
    let points = closed(first, what)?;
    match chains.next() {
        Some(other) => Err(format!("a second {what} at {}; accepted: one", text_mm(&other.points[0]))),
        None => Ok(points),
    }
}

/// Polygon of a chain, the first vertex not repeated.
pub fn closed(chain: Line, what: &str) -> Result<Vec<V2>, String> {
    let [start, end] = chain.ends();
    let gap = chain.gap();
    if !chain.closes() {
        return Err(format!(
            "the {what} does not close: {:.2} mm from {} to {}",
            mm(gap),
            text_mm(&end),
            text_mm(&start)
        ));
    }
    let mut points = chain.points;
    if points.len() > 1 && gap < JOIN_M {
        points.pop();
    }
    match points.len() {
        0..3 => Err(format!("the {what} has {} vertices; accepted: at least 3", points.len())),
        3..=MOST_VERTICES => Ok(points),
        count => Err(format!("the {what} has {count} vertices; accepted: at most {MOST_VERTICES}")),
    }
}

pub fn check_simple(outline: &[V2], what: &str) -> Result<(), String> {
    match self_crossing(outline) {
        Some(place) => Err(format!("the {what} crosses itself at {}", text_mm(&place))),
        None => Ok(()),
    }
}

/// Removes loops, and returns their places: a cut line has them at inner corners and pocket mouths. Fails where they
/// enclose more than `trifle_m2`.
pub fn cut_loops(outline: &mut Vec<V2>, what: &str, trifle_m2: f64) -> Result<Vec<V2>, String> {
    let (mut places, mut cut) = (Vec::new(), 0.0);
    while let Some(([first, second], at)) = crossing_sides(outline) {
        let between: Vec<V2> = outline.splice(first + 1..=second, [at]).chain([at]).collect();
        let (small, large) = if signed_area(&between).abs() < signed_area(outline).abs() {
            (between, std::mem::take(outline))
        } else {
            (std::mem::take(outline), between)
        };
        cut += signed_area(&small).abs();
        if cut > trifle_m2 || places.len() == MOST_LOOPS {
            return Err(format!("the {what} crosses itself at {}", text_mm(&at)));
        }
        *outline = large;
        places.push(at);
    }
    Ok(places)
}

/// Removes spikes, which run out and back along one line and enclose no area. Returns the tips.
pub fn cut_spikes(outline: &mut Vec<V2>) -> Vec<V2> {
    let (mut tips, mut at, mut passed) = (Vec::new(), 0, 0);
    while outline.len() > 3 && passed < outline.len() {
        let n = outline.len();
        let [before, tip, after] = [n - 1, 0, 1].map(|k| outline[(at + k) % n]);
        if !is_spike(&before, &tip, &after) {
            (at, passed) = ((at + 1) % n, passed + 1);
            continue;
        }
        // After a removal, the same vertex index is what remains of the same spike.
        if passed > 0 || tips.is_empty() {
            tips.push(tip);
        }
        outline.remove(at);
        at %= outline.len();
        if (before - after).norm() < SPIKE_M {
            outline.remove(at);
        }
        (at, passed) = ((at + outline.len() - 1) % outline.len(), 0);
    }
    tips
}

/// True if the nearer neighbour of a vertex lies on the segment to the farther one.
fn is_spike(before: &V2, tip: &V2, after: &V2) -> bool {
    let [mut short, mut long] = [before - tip, after - tip];
    if short.norm() > long.norm() {
        std::mem::swap(&mut short, &mut long);
    }
    let apart_m = short.perp(&long).abs() / long.norm();
    short.dot(&long) > 0.0 && apart_m < SPIKE_M.min(SPIKE_SLOPE * short.norm())
}

/// Moves touching corners inwards a little, and returns where they were. The edges of a dart that run on together to
/// the hem touch like this.
pub fn part_touching(outline: &mut [V2]) -> Vec<V2> {
    if self_crossing(outline).is_none() {
        return Vec::new();
    }
    let n = outline.len();
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|&i, &j| outline[i].x.total_cmp(&outline[j].x));
    let mut touches = vec![false; n];
    for (k, &i) in order.iter().enumerate() {
        for &j in order[k + 1..].iter().take_while(|&&j| outline[j].x - outline[i].x < TOUCHING_M) {
            let are_neighbours = (i + 1) % n == j || (j + 1) % n == i;
            if !are_neighbours && (outline[i] - outline[j]).norm() < TOUCHING_M {
                (touches[i], touches[j]) = (true, true);
            }
        }
    }
    let inwards = signed_area(outline).signum();
    let drawn = outline.to_vec();
    let touching: Vec<usize> = (0..n).filter(|&v| touches[v]).collect();
    for &v in &touching {
        let side = |a: usize, b: usize| (drawn[b % n] - drawn[a % n]).normalize();
        let along = side(v + n - 1, v) + side(v, v + 1);
        if let Some(along) = along.try_normalize(1e-6) {
            outline[v] += V2::new(-along.y, along.x) * (inwards * PARTED_M);
        }
    }
    touching.into_iter().map(|v| drawn[v]).collect()
}

/// Keeps the first vertex. Returns true if the polygon was reversed.
pub fn counter_clockwise(polygon: &mut [V2]) -> bool {
    let is_clockwise = signed_area(polygon) < 0.0;
    if is_clockwise {
        polygon.reverse();
        polygon.rotate_right(1);
    }
    is_clockwise
}

pub fn text_mm(point: &V2) -> String {
    format!("({:.2}, {:.2}) mm", mm(point.x), mm(point.y))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(points: &[(f64, f64)]) -> Line {
        let points = points.iter().map(|&(x, y)| V2::new(x, y) * 1e-3).collect();
        Line::new(points, false).expect("points")
    }

    #[test]
    fn lines_join_in_any_order_and_direction_over_tiny_gaps() {
        // A square of 100 mm whose sides miss each other by 0.01 mm, one turned round, one drawn twice.
        let sides = vec![
            line(&[(0.0, 0.0), (100.0, 0.0)]),
            line(&[(100.0, 100.0), (100.01, 0.0)]),
            line(&[(0.0, 100.0), (0.0, 0.01)]),
            line(&[(100.0, 0.0), (0.0, 0.0)]),
            line(&[(100.0, 100.01), (50.0, 100.0), (50.0, 100.0), (0.0, 100.0)]),
        ];
        let (sides, copies) = without_copies(sides);
        assert_eq!((sides.len(), copies.len()), (4, 1));
        let mut outline = joined(&sides, "outline").expect("it closes");
        assert_eq!(outline.len(), 5);
        assert!((signed_area(&outline) - 0.01).abs() < 1e-6, "{}", signed_area(&outline));
        assert!(!counter_clockwise(&mut outline));
    }

    #[test]
    fn what_does_not_close_says_where() {
        let open = [
            line(&[(10.0, 0.0), (100.0, 0.0)]),
            line(&[(100.0, 0.0), (100.0, 50.0)]),
            line(&[(0.0, 0.0), (10.0, 0.0)]),
        ];
        let reason = joined(&open, "outline").expect_err("a side is missing");
        assert_eq!(reason, "the outline does not close: 111.80 mm from (100.00, 50.00) mm to (0.00, 0.00) mm");
        let two = [
            line(&[(0.0, 0.0), (9.0, 0.0), (0.0, 9.0), (0.0, 0.0)]),
            line(&[(20.0, 0.0), (29.0, 0.0), (20.0, 9.0), (20.0, 0.0)]),
        ];
        let reason = joined(&two, "outline").expect_err("two");
        assert!(reason.contains("a second outline at (20.00, 0.00) mm"), "{reason}");
        assert!(joined(&[], "outline").expect_err("none").contains("no outline"));
    }

    #[test]
    fn loops_of_a_cut_line_are_cut_away() {
        // A square of 100 mm with a loop of 8 by 4 mm that is run through outside its lower side.
        let corners = [(0.0, 0.0), (40.0, 0.0), (48.0, -4.0), (40.0, -4.0), (48.0, 0.0), (100.0, 0.0), (100.0, 100.0)];
        let outline = |first: usize| {
            let mut points = line(&corners).points;
            points.push(V2::new(0.0, 0.1));
            points.rotate_left(first);
            points
        };
        for first in 0..8 {
            let mut cut = outline(first);
            let places = cut_loops(&mut cut, "cut line", 1e-4).expect("a trifle");
            assert_eq!(places.len(), 1, "{first}");
            assert!((places[0] - V2::new(0.044, -0.002)).norm() < 1e-9, "{first}: {:?}", places[0]);
            assert_eq!((cut.len(), self_crossing(&cut)), (7, None), "{first}");
            assert!((signed_area(&cut) - 0.01).abs() < 1e-5, "{first}: {}", signed_area(&cut));
        }
        let mut bow = line(&[(0.0, 0.0), (100.0, 100.0), (100.0, 0.0), (0.0, 80.0)]).points;
        let reason = cut_loops(&mut bow, "cut line", 1e-4).expect_err("two halves");
        assert_eq!(reason, "the cut line crosses itself at (44.44, 44.44) mm");
    }

    #[test]
    fn spikes_are_cut_away_and_sharp_corners_stay() {
        let check = |drawn: &[(f64, f64)], expect: &[(f64, f64)], tips: usize| {
            for first in 0..drawn.len() {
                let mut outline = line(drawn).points;
                outline.rotate_left(first);
                assert_eq!(cut_spikes(&mut outline).len(), tips, "{drawn:?} from {first}");
                let start = outline.iter().position(|p| (p - line(expect).points[0]).norm() < 1e-9);
                outline.rotate_left(start.expect("the first corner is left"));
                assert_eq!(outline, line(expect).points, "{drawn:?} from {first}");
                assert_eq!(self_crossing(&outline), None);
            }
        };
        let square = [(0.0, 0.0), (100.0, 0.0), (100.0, 100.0), (0.0, 100.0)];
        check(&square, &square, 0);
        // Out beyond a corner and back, a side walked three times, a slash inwards of two parts, and one of 0.001 mm.
        let overshot = [(0.0, 0.0), (140.0, 0.0), (100.0, 0.0), (100.0, 100.0), (0.0, 100.0)];
        check(&overshot, &square, 1);
        let again = [(0.0, 0.0), (50.0, 0.0), (100.0, 0.0), (50.0, 0.0), (100.0, 0.0), (100.0, 100.0), (0.0, 100.0)];
        check(&again, &[(0.0, 0.0), (50.0, 0.0), (100.0, 0.0), (100.0, 100.0), (0.0, 100.0)], 1);
        let slashed = [
            (0.0, 0.0),
            (50.0, 0.0),
            (50.0, 20.0),
            (60.0, 40.0),
            (50.0, 20.001),
            (50.0, 0.0),
            (100.0, 0.0),
            (100.0, 100.0),
            (0.0, 100.0),
        ];
        check(&slashed, &[(0.0, 0.0), (50.0, 0.0), (100.0, 0.0), (100.0, 100.0), (0.0, 100.0)], 1);
        // A dart, however narrow, is none.
        let dart = [(0.0, 0.0), (49.9, 0.0), (50.0, 60.0), (50.1, 0.0), (100.0, 0.0), (100.0, 100.0), (0.0, 100.0)];
        check(&dart, &dart, 0);
    }

    #[test]
    fn an_outline_that_touches_itself_is_parted() {
        let check = |drawn: &[(f64, f64)], places: usize| {
            let whole = line(drawn).points;
            let area = signed_area(&whole);
            for first in 0..drawn.len() {
                let mut outline = whole.clone();
                outline.rotate_left(first);
                assert_eq!(part_touching(&mut outline).len(), places, "{drawn:?} from {first}");
                assert_eq!(self_crossing(&outline), None, "{drawn:?} from {first}");
                let lost = 1.0 - signed_area(&outline) / area;
                assert!((-1e-12..2e-4).contains(&lost), "{lost}");
                let mut mirrored: Vec<V2> = outline.iter().rev().copied().collect();
                assert_eq!(part_touching(&mut mirrored).len(), 0, "once is enough");
            }
        };
        // A dart whose legs run on together for 6 mm to the lower side, either way round.
        let dart = [
            (0.0, 0.0),
            (50.0, 0.0),
            (50.0, 6.0),
            (48.0, 40.0),
            (50.0, 70.0),
            (52.0, 40.0),
            (50.0, 6.0),
            (50.0, 0.0),
            (100.0, 0.0),
            (100.0, 100.0),
            (0.0, 100.0),
        ];
        check(&dart, 4);
        let turned: Vec<(f64, f64)> = dart.iter().rev().copied().collect();
        check(&turned, 4);
        check(&dart[6..], 0);
        // What crosses itself at a corner still does.
        let bow = [(0.0, 0.0), (50.0, 50.0), (100.0, 100.0), (100.0, 0.0), (50.0, 50.0), (0.0, 80.0)];
        let mut outline = line(&bow).points;
        part_touching(&mut outline);
        assert!(self_crossing(&outline).is_some());
    }

    #[test]
    fn five_thousand_lines_join_at_once() {
        let corner = |k: usize| {
            let angle = std::f64::consts::TAU * k as f64 / 5_000.0;
            (500.0 * angle.cos(), 500.0 * angle.sin())
        };
        let mut sides: Vec<Line> = (0..5_000).map(|k| line(&[corner(k), corner(k + 1)])).collect();
        sides.reverse();
        assert_eq!(joined(&without_copies(sides).0, "outline").expect("it closes").len(), 5_000);
    }
}

//! Lengths that break the grading progression of the sizes.
//!
//! The steps between neighbouring sizes of a nest resemble each other. An outlier among the steps means that a corner
//! was found at a wrong place in one size, or that a size was drawn differently.

use std::collections::BTreeMap;

use crate::check::{Finding, FindingKind};
use crate::style::Style;
use geom::units::mm;

/// Greatest regular ratio of a step to the greater of its neighbouring steps of the same sign.
const GREATEST_RATIO: f64 = 3.0;
/// Least step to compare with, for lengths that hardly grow: the tolerance on both sides of a seam.
const LEAST_STEP_M: f64 = 1e-3;
/// Sizes from which steps alone tell an outlier. With three there are two steps, and either may be it.
const MANY_SIZES: usize = 4;
/// Least share of an edge's step that a neighbour must lose for the corner between them to count as slipped.
const PASSED_ON: f64 = 0.5;

#[derive(Clone, Debug, PartialEq)]
pub struct Leap {
    /// Name of the point of measure, or `piece.edge`.
    pub length: String,
    /// Indices of neighbouring sizes.
    pub sizes: [usize; 2],
    pub lengths_m: [f64; 2],
    /// Ratio of the step to the greater of its neighbouring steps of the same sign.
    pub ratio: f64,
}

impl Leap {
    pub fn told(&self) -> String {
        let [before_mm, after_mm] = self.lengths_m.map(mm);
        format!("{} {before_mm:.1} to {after_mm:.1} mm ({:.1} times the steps beside it)", self.length, self.ratio)
    }

    pub fn finding(&self, sizes: &[String]) -> Finding {
        let ([before, after], [before_mm, after_mm]) = (self.sizes.map(|size| &sizes[size]), self.lengths_m.map(mm));
        let found = format!(
            "{before_mm:.1} mm in size {before}, {after_mm:.1} mm in size {after}: {:.1} times the steps beside it",
            self.ratio
        );
        Finding { kind: FindingKind::Leap, place: self.length.clone(), found }
    }
}

/// Outliers among the grade steps of the points of measure and edges of a style, the greatest ratio first. `sizes` go
/// from the smallest. With three sizes, only edges count at which a corner slips: one edge gains what its neighbour
/// loses.
pub fn leaps(sizes: &[&Style]) -> Vec<Leap> {
    let mut lengths: BTreeMap<String, Vec<Option<f64>>> = BTreeMap::new();
    for (size, style) in sizes.iter().enumerate() {
        let points =
            style.points_of_measure().into_iter().map(|measure| (measure.point.as_str().to_owned(), measure.length_m));
        let edges = style.pieces.iter().flat_map(|piece| {
            piece
                .edges
                .iter()
                .filter_map(|edge| Some((format!("{}.{}", piece.id, edge.name.as_ref()?), edge.line.length())))
        });
        for (name, length_m) in points.chain(edges) {
            lengths.entry(name).or_insert_with(|| vec![None; sizes.len()])[size] = Some(length_m);
        }
    }
    let mut found: Vec<Leap> = lengths.iter().flat_map(|(name, lengths_m)| leaps_of(name, lengths_m)).collect();
    if sizes.len() < MANY_SIZES {
        found.retain(|leap| slips(sizes, leap));
    }
    found.sort_by(|a, b| b.ratio.total_cmp(&a.ratio).then_with(|| (&a.length, a.sizes).cmp(&(&b.length, b.sizes))));
    found
}

/// True if a neighbouring edge loses what the edge of the leap gains.
fn slips(sizes: &[&Style], leap: &Leap) -> bool {
    let Some((id, edge)) = leap.length.split_once('.') else { return false };
    let edges = leap.sizes.map(|size| sizes[size].pieces.iter().find(|piece| piece.id == id).map(|piece| &piece.edges));
    let [Some(before), Some(after)] = edges else { return false };
    let Some(k) = before.iter().position(|drawn| drawn.name.as_deref() == Some(edge)) else { return false };
    let step_m = |k: usize| after[k].line.length() - before[k].line.length();
    let count = before.len();
    let beside = [(k + 1) % count, (k + count - 1) % count];
    after.len() == count
        && beside.into_iter().any(|other| -step_m(other) * step_m(k).signum() > PASSED_ON * step_m(k).abs())
}

fn leaps_of(name: &str, lengths_m: &[Option<f64>]) -> Vec<Leap> {
    let known: Vec<(usize, f64)> =
        lengths_m.iter().enumerate().filter_map(|(size, length_m)| Some((size, (*length_m)?))).collect();
    let steps: Vec<f64> = known.windows(2).map(|pair| pair[1].1 - pair[0].1).collect();
    // After a length that is wrong in one size, the next step goes the other way. So only steps of the same sign are
    // compared.
    let ratio = |k: usize| {
        let beside = [k.checked_sub(1), Some(k + 1)].into_iter().flatten().filter_map(|other| steps.get(other));
        let same_way = beside.map(|other| other * steps[k].signum()).fold(LEAST_STEP_M, f64::max);
        steps[k].abs() / same_way
    };
    // A single step has no neighbours.
    let doubtful = (0..steps.len()).filter(|_| steps.len() > 1).map(|k| (k, ratio(k)));
    let leap = |(k, ratio): (usize, f64)| Leap {
        length: name.to_owned(),
        sizes: [known[k].0, known[k + 1].0],
        lengths_m: [known[k].1, known[k + 1].1],
        ratio,
    };
    doubtful.filter(|(_, ratio)| *ratio > GREATEST_RATIO).map(leap).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draft::Model;

    #[test]
    fn a_step_much_larger_than_those_beside_it_is_a_leap() {
        let check = |lengths_mm: &[f64], expect: &[[usize; 2]]| {
            let lengths_m: Vec<Option<f64>> = lengths_mm.iter().map(|mm| Some(mm * 1e-3)).collect();
            let found: Vec<[usize; 2]> = leaps_of("inseam", &lengths_m).iter().map(|leap| leap.sizes).collect();
            assert_eq!(found, expect, "{lengths_mm:?}");
        };
        check(&[761.6, 761.6, 830.7, 838.0, 846.0], &[[1, 2]]);
        // There and back again.
        check(&[500.0, 520.0, 540.0, 640.0, 580.0, 600.0, 620.0], &[[2, 3], [3, 4]]);
        // A grade that changes its step, stands still, falls, or has two sizes.
        check(&[500.0, 520.0, 540.0, 590.0, 640.0], &[]);
        check(&[300.0, 302.0, 302.0, 302.0, 300.0], &[]);
        check(&[500.0, 490.0, 480.0], &[]);
        check(&[500.0, 700.0], &[]);
    }

    #[test]
    fn a_corner_that_slips_in_one_of_three_sizes_is_found_and_a_grade_is_not() {
        let drafts = Model::Trousers.drafts();
        let styles = |slipped: Option<usize>| -> Vec<Style> {
            let style = |(number, pieces): (usize, &[crate::Piece])| {
                let mut style = Style::read(pieces, Model::Trousers.seams(), "trousers").expect("our own");
                if slipped == Some(number) {
                    let piece = style.pieces.iter_mut().find(|piece| piece.id == "leg_front_left").expect("a leg");
                    slip(piece);
                }
                style
            };
            drafts.iter().map(|draft| &draft.pieces[..]).enumerate().map(style).collect()
        };
        let found = |styles: &[Style]| leaps(&styles.iter().collect::<Vec<_>>());
        assert_eq!(found(&styles(None)), []);
        let slipped = found(&styles(Some(2)));
        assert!(slipped.iter().any(|leap| leap.length.starts_with("leg_front_left.")), "{slipped:?}");
        assert!(slipped.iter().all(|leap| leap.sizes == [1, 2]), "{slipped:?}");
    }

    /// Moves the corner by 40 mm along the second edge.
    fn slip(piece: &mut crate::style::StylePiece) {
        let second = piece.edges[1].line.clone();
        let at = second.at(0.04);
        let is_passed = |k: &usize| second.arcs()[*k] < 0.04;
        let point = |k: usize| second.points()[k];
        let (passed, left): (Vec<usize>, Vec<usize>) = (0..second.points().len()).partition(is_passed);
        let mut first = piece.edges[0].line.points().to_vec();
        first.extend(passed.into_iter().skip(1).map(point).chain([at]));
        let left = [at].into_iter().chain(left.into_iter().map(point)).collect();
        piece.edges[0].line = geom::polyline::Polyline::new(first).expect("a line");
        piece.edges[1].line = geom::polyline::Polyline::new(left).expect("a line");
    }
}

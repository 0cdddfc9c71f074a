//! Lengths that leave the progression of their sizes.
//!
//! A nest grows by grade steps, and a step is much like those beside it. A length that leaps says that a corner of it was
//! found at another place than in the size before, or that a size was drawn otherwise.

use std::collections::BTreeMap;

use crate::check::{Finding, FindingKind};
use crate::style::Style;
use geom::units::mm;

/// Greatest step, over the greater of those beside it that go the same way.
const GREATEST_RATIO: f64 = 3.0;
/// Step that counts beside where nothing grows, m: as much as the sides of a seam may differ.
const LEAST_STEP_M: f64 = 1e-3;

/// A length that leaps from one size to the next.
#[derive(Clone, Debug, PartialEq)]
pub struct Leap {
    /// Point of measure, or `piece.edge`.
    pub length: String,
    /// Both sizes, by their places.
    pub sizes: [usize; 2],
    /// Its length in both, m.
    pub lengths_m: [f64; 2],
    /// Step over the greater of those beside it.
    pub ratio: f64,
}

impl Leap {
    /// The length in both sizes, for messages.
    #[must_use]
    pub fn told(&self) -> String {
        let [before_mm, after_mm] = self.lengths_m.map(mm);
        format!("{} {before_mm:.1} to {after_mm:.1} mm ({:.1} times the steps beside it)", self.length, self.ratio)
    }

    /// The leap as a finding, where `sizes` are the names of all sizes.
    #[must_use]
    pub fn finding(&self, sizes: &[String]) -> Finding {
        let ([before, after], [before_mm, after_mm]) = (self.sizes.map(|size| &sizes[size]), self.lengths_m.map(mm));
        let found = format!(
            "{before_mm:.1} mm in size {before}, {after_mm:.1} mm in size {after}: {:.1} times the steps beside it",
            self.ratio
        );
        Finding { kind: FindingKind::Leap, place: self.length.clone(), found }
    }
}

/// Leaps of the points of measure and edges of a style from size to size, smallest first, the greatest ratio first.
#[must_use]
pub fn leaps(sizes: &[&Style]) -> Vec<Leap> {
    let mut lengths: BTreeMap<String, Vec<Option<f64>>> = BTreeMap::new();
    for (size, style) in sizes.iter().enumerate() {
        let points = style.points_of_measure().into_iter().map(|one| (one.point.as_str().to_owned(), one.length_m));
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
    found.sort_by(|a, b| b.ratio.total_cmp(&a.ratio).then_with(|| (&a.length, a.sizes).cmp(&(&b.length, b.sizes))));
    found
}

/// Leaps of one length, m.
fn leaps_of(name: &str, lengths_m: &[Option<f64>]) -> Vec<Leap> {
    let known: Vec<(usize, f64)> =
        lengths_m.iter().enumerate().filter_map(|(size, length_m)| Some((size, (*length_m)?))).collect();
    let steps: Vec<f64> = known.windows(2).map(|pair| pair[1].1 - pair[0].1).collect();
    // A length that leaps in one size leaps back in the next: what goes the other way bears nothing out.
    let ratio = |k: usize| {
        let beside = [k.checked_sub(1), Some(k + 1)].into_iter().flatten().filter_map(|other| steps.get(other));
        let same_way = beside.map(|other| other * steps[k].signum()).fold(LEAST_STEP_M, f64::max);
        steps[k].abs() / same_way
    };
    // One step alone has nothing beside it.
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
}

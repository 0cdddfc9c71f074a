//! Simulator to use for every garment and fit class: by the evidence if it suffices, otherwise by the rule of the
//! thesis.

use std::collections::BTreeMap;

use super::analysis::Analysis;
use super::class::{FitClass, Simulator};
use super::finding::{Basis, Finding};
use super::pair::{Pair, by_subject};
use super::statistics::{holm, mean};
use super::weigh::{LEAST, Verdict, Weighed};

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Cell {
    pub garment: String,
    pub class: FitClass,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    pub garment: String,
    pub class: FitClass,
    /// Verdict of the numbers alone.
    pub finding: Finding,
    pub analysis: Analysis,
    /// p of the sign-flip test, adjusted by Holm over all answers with enough subjects. `None` for too few subjects.
    pub p_holm: Option<f64>,
    /// Mean regret in EI on held-out subjects: of the choice from the other subjects of this garment and fit class, and
    /// of the one simulator that is best in the whole study. `None` if no subject can be held out.
    pub regret: Option<[f64; 2]>,
    pub reason: String,
    pub would_settle: String,
}

impl Answer {
    pub fn recommended(&self) -> Simulator {
        self.finding.simulator().unwrap_or_else(|| self.class.rule_says())
    }

    pub fn basis(&self) -> Basis {
        if self.finding.simulator().is_some() { Basis::Evidence } else { Basis::Rule }
    }
}

#[derive(Clone, Debug, PartialEq)]
pub struct Evidence {
    /// Answers in the order of the cells.
    pub answers: Vec<Answer>,
    pub garments: Vec<GarmentEvidence>,
}

#[derive(Clone, Debug, PartialEq)]
pub struct GarmentEvidence {
    pub garment: String,
    pub analysis: Analysis,
    /// p of the sign-flip test, adjusted by Holm over all garments with enough subjects. `None` for too few subjects.
    pub p_holm: Option<f64>,
}

pub fn judge(cells: &[Cell], pairs: &[Pair]) -> Evidence {
    let pairs_of = |cell: &Cell| -> Vec<&Pair> {
        pairs.iter().filter(|p| p.garment == cell.garment && p.class == cell.class).collect()
    };
    let analyses: Vec<Analysis> = cells.iter().map(|cell| Analysis::new(&pairs_of(cell))).collect();
    let adjusted = adjusted(&analyses);
    let family = adjusted.iter().flatten().count();
    let answers = cells.iter().zip(analyses).zip(adjusted).map(|((cell, analysis), p_holm)| {
        let regret = regret(&pairs_of(cell), pairs);
        let Verdict { finding, reason, would_settle } =
            Weighed { analysis: &analysis, p_holm, regret, family }.decide(cell.class);
        let (garment, class) = (cell.garment.clone(), cell.class);
        Answer { garment, class, finding, analysis, p_holm, regret, reason, would_settle }
    });
    Evidence { answers: answers.collect(), garments: garments(pairs) }
}

fn garments(pairs: &[Pair]) -> Vec<GarmentEvidence> {
    let mut names: Vec<&str> = Vec::new();
    for pair in pairs {
        if !names.contains(&pair.garment.as_str()) {
            names.push(&pair.garment);
        }
    }
    let pairs_of = |name: &str| -> Vec<&Pair> { pairs.iter().filter(|pair| pair.garment == name).collect() };
    let analyses: Vec<Analysis> = names.iter().map(|name| Analysis::new(&pairs_of(name))).collect();
    let adjusted = adjusted(&analyses);
    let garment = |((name, analysis), p_holm): ((&&str, Analysis), Option<f64>)| GarmentEvidence {
        garment: (*name).to_owned(),
        analysis,
        p_holm,
    };
    names.iter().zip(analyses).zip(adjusted).map(garment).collect()
}

/// Holm-adjusted p of each analysis with enough subjects for a verdict. The number of subjects is known before anything
/// is measured, so the others may be left out of the family.
fn adjusted(analyses: &[Analysis]) -> Vec<Option<f64>> {
    let testable = |a: &&Analysis| a.subjects.len() >= LEAST;
    let p: Vec<f64> = analyses.iter().filter(testable).filter_map(|a| a.estimate).map(|e| e.p).collect();
    let mut adjusted = holm(&p).into_iter();
    analyses.iter().map(|a| if testable(&a) { adjusted.next() } else { None }).collect()
}

fn regret(cell: &[&Pair], all: &[Pair]) -> Option<[f64; 2]> {
    let mut cases: BTreeMap<&str, Vec<&Pair>> = BTreeMap::new();
    for pair in cell {
        cases.entry(&pair.subject).or_default().push(pair);
    }
    let choice = |cases: &mut dyn Iterator<Item = &Pair>, held_out: &str| {
        let others: Vec<&Pair> = cases.filter(|pair| pair.subject != held_out).collect();
        let means = by_subject(&others, |_| true);
        let simulator = if mean(&means) < 0.0 { Simulator::Fem } else { Simulator::Hybrid };
        (!means.is_empty()).then_some(simulator)
    };
    let (mut sums, mut n) = ([0.0; 2], 0.0);
    for (subject, held_out) in &cases {
        let (Some(own), Some(constant)) =
            (choice(&mut cell.iter().copied(), subject), choice(&mut all.iter(), subject))
        else {
            continue;
        };
        for pair in held_out {
            let ei = |simulator| pair.ei(simulator, |_| true).unwrap_or_default();
            let best = ei(Simulator::Fem).min(ei(Simulator::Hybrid));
            sums = [sums[0] + ei(own) - best, sums[1] + ei(constant) - best];
            n += 1.0;
        }
    }
    (n > 0.0).then(|| sums.map(|sum| sum / n))
}

#[cfg(test)]
mod tests;

//! The answer to "which simulator?" for every garment and fit class: the evidence where it speaks, the thesis's rule
//! where it does not.

use std::collections::BTreeMap;

use super::analysis::Analysis;
use super::class::{FitClass, Simulator};
use super::pair::{Pair, by_subject};
use super::statistics::{holm, mean};
use super::weigh::{LEAST, Weighed};

/// What the evidence says of one garment and fit class.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Finding {
    /// FEM-GS is truer to the pattern.
    Fem,
    /// Hybrid-GS is truer to the pattern.
    Hybrid,
    /// The two differ by less than the margin.
    NoDifference,
    /// Too little data to tell.
    InsufficientEvidence,
}

impl Finding {
    /// Name in SQL (`v_recommendation.verdict`).
    #[must_use]
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Fem => "fem",
            Self::Hybrid => "hybrid",
            Self::NoDifference => "no_difference",
            Self::InsufficientEvidence => "insufficient_evidence",
        }
    }

    /// The finding of a name in SQL.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        let all = [Self::Fem, Self::Hybrid, Self::NoDifference, Self::InsufficientEvidence];
        all.into_iter().find(|finding| finding.as_str() == name)
    }

    /// The simulator it names, if it names one.
    #[must_use]
    pub fn simulator(self) -> Option<Simulator> {
        match self {
            Self::Fem => Some(Simulator::Fem),
            Self::Hybrid => Some(Simulator::Hybrid),
            Self::NoDifference | Self::InsufficientEvidence => None,
        }
    }
}

/// What a recommendation rests on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Basis {
    /// The thesis's rule.
    Rule,
    /// The study's own numbers.
    Evidence,
}

impl Basis {
    /// Name in SQL (`v_recommendation.basis`).
    #[must_use]
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Rule => "rule",
            Self::Evidence => "evidence",
        }
    }
}

/// A garment and fit class to be answered for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Cell {
    /// Name of the garment, as in [`Pair::garment`].
    pub garment: String,
    /// Fit class of its cases.
    pub class: FitClass,
}

/// The answer for one garment and fit class.
#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    /// Name of the garment.
    pub garment: String,
    /// Fit class that it is for.
    pub class: FitClass,
    /// What the numbers say by themselves.
    pub finding: Finding,
    /// Statistics of the cases that the finding rests on.
    pub analysis: Analysis,
    /// p of the sign-flip test after Holm over all answers with enough subjects; `None` with too few.
    pub p_holm: Option<f64>,
    /// Mean regret in EI on subjects held out: of the choice from the other subjects of this garment and fit, and of the
    /// one simulator that suits the whole study best.
    pub regret: Option<[f64; 2]>,
    /// Why, in one or two sentences.
    pub reason: String,
    /// What would settle or flip it.
    pub would_settle: String,
}

impl Answer {
    /// The simulator to use.
    #[must_use]
    pub fn recommended(&self) -> Simulator {
        self.finding.simulator().unwrap_or_else(|| self.class.rule_says())
    }

    /// What that rests on.
    #[must_use]
    pub fn basis(&self) -> Basis {
        if self.finding.simulator().is_some() { Basis::Evidence } else { Basis::Rule }
    }
}

/// Answers for every cell, and the garments over all fits.
#[derive(Clone, Debug, PartialEq)]
pub struct Evidence {
    /// One a cell, in the order given.
    pub answers: Vec<Answer>,
    /// Every garment over all its fits, with its p after Holm over the garments that have enough subjects.
    pub garments: Vec<(String, Analysis, Option<f64>)>,
}

/// Judges every cell from the study's pairs.
#[must_use]
pub fn judge(cells: &[Cell], pairs: &[Pair]) -> Evidence {
    let of = |cell: &Cell| -> Vec<&Pair> {
        pairs.iter().filter(|p| p.garment == cell.garment && p.class == cell.class).collect()
    };
    let analyses: Vec<Analysis> = cells.iter().map(|cell| Analysis::new(&of(cell))).collect();
    let adjusted = adjusted(&analyses);
    let family = adjusted.iter().flatten().count();
    let answers = cells.iter().zip(analyses).zip(adjusted).map(|((cell, analysis), p_holm)| {
        let regret = regret(&of(cell), pairs);
        let (finding, reason, would_settle) =
            Weighed { analysis: &analysis, p_holm, regret, family }.decide(cell.class);
        let (garment, class) = (cell.garment.clone(), cell.class);
        Answer { garment, class, finding, analysis, p_holm, regret, reason, would_settle }
    });
    Evidence { answers: answers.collect(), garments: garments(pairs) }
}

/// Every garment over all its fits, in the order of the pairs.
fn garments(pairs: &[Pair]) -> Vec<(String, Analysis, Option<f64>)> {
    let mut names: Vec<&str> = Vec::new();
    for pair in pairs {
        if !names.contains(&pair.garment.as_str()) {
            names.push(&pair.garment);
        }
    }
    let of = |name: &str| -> Vec<&Pair> { pairs.iter().filter(|pair| pair.garment == name).collect() };
    let analyses: Vec<Analysis> = names.iter().map(|name| Analysis::new(&of(name))).collect();
    let adjusted = adjusted(&analyses);
    names.iter().zip(analyses).zip(adjusted).map(|((name, analysis), p)| ((*name).to_owned(), analysis, p)).collect()
}

/// p after Holm over the analyses whose subjects suffice for any verdict; how many subjects there are was known before
/// anything was measured, so leaving the others out of the family costs nothing.
fn adjusted(analyses: &[Analysis]) -> Vec<Option<f64>> {
    let testable = |a: &&Analysis| a.subjects.len() >= LEAST;
    let p: Vec<f64> = analyses.iter().filter(testable).filter_map(|a| a.estimate).map(|e| e.p).collect();
    let mut adjusted = holm(&p).into_iter();
    analyses.iter().map(|a| if testable(&a) { adjusted.next() } else { None }).collect()
}

/// Held-out regret, see [`Answer::regret`]; `None` where no subject can be held out.
fn regret(cell: &[&Pair], all: &[Pair]) -> Option<[f64; 2]> {
    let mut cases: BTreeMap<&str, Vec<&Pair>> = BTreeMap::new();
    for pair in cell {
        cases.entry(&pair.subject).or_default().push(pair);
    }
    let choice = |of: &mut dyn Iterator<Item = &Pair>, held_out: &str| {
        let others: Vec<&Pair> = of.filter(|pair| pair.subject != held_out).collect();
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

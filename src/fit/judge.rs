//! The answer to "which simulator?" for every garment and fit class: the evidence where it speaks, the thesis's rule
//! where it does not.

use std::collections::BTreeMap;

use super::analysis::{Analysis, CONTROLLED, Estimate};
use super::class::{FitClass, Simulator};
use super::distribution::student_quantile;
use super::pair::{Pair, by_subject};
use super::statistics::{holm, mean};
use super::{ALPHA, MARGIN};

/// Fewest subjects of which the sign-flip test can reach [`ALPHA`]: 2^(1 - 6) = 0.031.
const LEAST: usize = 6;
/// Subjects beyond which nobody asks how many more it would take.
const MOST: usize = 200;

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
    /// Garment.
    pub garment: String,
    /// Fit class.
    pub class: FitClass,
}

/// The answer for one garment and fit class.
#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    /// Garment.
    pub garment: String,
    /// Fit class.
    pub class: FitClass,
    /// What the numbers say by themselves.
    pub finding: Finding,
    /// The numbers.
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

/// All that decides one answer.
struct Weighed<'a> {
    analysis: &'a Analysis,
    p_holm: Option<f64>,
    regret: Option<[f64; 2]>,
    /// Answers tested together.
    family: usize,
}

impl Weighed<'_> {
    /// The finding, why, and what would settle or flip it.
    fn decide(&self, class: FitClass) -> (Finding, String, String) {
        let n = self.analysis.subjects.len();
        let (Some(estimate), true) = (self.analysis.estimate, n >= LEAST) else { return self.too_few() };
        let (low, high) = estimate.interval.unwrap_or((f64::NEG_INFINITY, f64::INFINITY));
        if low > -MARGIN && high < MARGIN {
            return self.within(&estimate, class);
        }
        if !(low >= MARGIN || high <= -MARGIN) {
            let reason = format!(
                "The interval holds {}, so the rule stands.",
                if estimate.mean > 0.0 { "+0.01" } else { "-0.01" }
            );
            return self.abstain(format!("The mean EI difference is {}. {reason}", told(&estimate)));
        }
        self.beyond(&estimate, class)
    }

    fn abstain(&self, reason: String) -> (Finding, String, String) {
        (Finding::InsufficientEvidence, reason, self.more_subjects())
    }

    fn too_few(&self) -> (Finding, String, String) {
        let n = self.analysis.subjects.len();
        let reason = match (n, self.analysis.estimate) {
            (0, _) | (_, None) => "No subject has a converged result of both simulators with this fit".to_owned(),
            (1, Some(e)) => format!("One subject, mean EI difference {}", told(&e)),
            (_, Some(e)) => format!("{n} subjects, mean EI difference {}", told(&e)),
        };
        let least = format!("an exact test of fewer than {LEAST} cannot reach p = {ALPHA}");
        self.abstain(format!("{reason}; {least}, so the rule stands."))
    }

    /// The interval lies within the margin.
    fn within(&self, estimate: &Estimate, class: FitClass) -> (Finding, String, String) {
        let said = format!("The mean EI difference is {}", told(estimate));
        if estimate.p_equivalence.is_none_or(|p| p > ALPHA) {
            return self
                .abstain(format!("{said}, but equivalence is not shown (p {}).", p_words(estimate.p_equivalence)));
        }
        if let Some(rest) = self.analysis.without.iter().find(|rest| rest.mean.abs() >= MARGIN) {
            let reason = format!(
                "{said}, but without {} it is {}: one measurement hides a difference.",
                rest.what,
                ei(rest.mean)
            );
            return (Finding::InsufficientEvidence, reason, format!("Agreement on whether {} counts.", rest.what));
        }
        let rule = simulator_name(class.rule_says());
        let reason = format!(
            "{said}, all of it within {MARGIN} (equivalence p {}): no practical difference. {rule} by the rule.",
            p_words(estimate.p_equivalence)
        );
        (Finding::NoDifference, reason, format!("A margin below {:.4} would turn it.", self.reach(estimate)))
    }

    /// The greatest difference that the interval holds.
    fn reach(&self, estimate: &Estimate) -> f64 {
        estimate.interval.map_or(estimate.mean.abs(), |(low, high)| low.abs().max(high.abs()))
    }

    /// The interval lies beyond the margin.
    fn beyond(&self, estimate: &Estimate, class: FitClass) -> (Finding, String, String) {
        let said = format!("The mean EI difference is {}", told(estimate));
        if self.p_holm.is_none_or(|p| p > ALPHA) {
            let p = p_words(self.p_holm);
            return self.abstain(format!("{said}, but among {} answers tested p is {p} (Holm).", self.family));
        }
        if let Some(rest) = self.analysis.turned_by() {
            let reason = format!(
                "{said}, but without {} it is {}: the answer rests on one measurement.",
                rest.what,
                ei(rest.mean)
            );
            return (
                Finding::InsufficientEvidence,
                reason,
                format!("Agreement on whether {} counts; more subjects would not.", rest.what),
            );
        }
        if estimate.mean > 0.0
            && let Some(reason) = self.circular()
        {
            return (
                Finding::InsufficientEvidence,
                format!("{said}, but {reason}"),
                "Measurements that no simulator sets.".into(),
            );
        }
        if let Some([own, constant]) = self.regret.filter(|[own, constant]| *own > constant + 1e-12) {
            let reason =
                format!("{said}, but on subjects held out it costs {own:.4} EI, one simulator for all {constant:.4}.");
            return self.abstain(reason);
        }
        let (finding, truer) =
            if estimate.mean < 0.0 { (Finding::Fem, Simulator::Fem) } else { (Finding::Hybrid, Simulator::Hybrid) };
        let against = if truer == class.rule_says() { "supports" } else { "contradicts" };
        let p = p_words(self.p_holm);
        let reason = format!(
            "{} is truer: the mean EI difference is {} (p {p}, Holm), with every measurement left out in turn. \
            This {against} the rule.",
            simulator_name(truer),
            told(estimate)
        );
        (finding, reason, self.nearest_to_turning())
    }

    /// Why a verdict for Hybrid-GS would be circular: it rests on measurements that Hybrid-GS restores by construction.
    fn circular(&self) -> Option<String> {
        let controlled = self.analysis.controlled;
        let rest = self.analysis.told_apart.iter().find(|rest| rest.what == CONTROLLED);
        match rest {
            None if !self.analysis.is_circular() => None,
            None => {
                Some("every measurement is one that Hybrid-GS sets by construction: scoring it is circular.".into())
            }
            Some(rest) if rest.mean <= 0.0 => Some(format!(
                "without the {controlled} measurements that Hybrid-GS sets it is {}: scoring those is circular.",
                ei(rest.mean)
            )),
            Some(_) => None,
        }
    }

    /// What comes nearest to flipping a verdict.
    fn nearest_to_turning(&self) -> String {
        let nearest = self.analysis.without.iter().min_by(|a, b| a.mean.abs().total_cmp(&b.mean.abs()));
        nearest.map_or_else(String::new, |rest| {
            format!("Nothing left out flips it; nearest is without {} ({}).", rest.what, ei(rest.mean))
        })
    }

    /// How many subjects more it would take, if the difference stays as it is.
    fn more_subjects(&self) -> String {
        let have = self.analysis.subjects.len();
        let enough = |n: &usize| {
            let n = *n;
            let Some(Estimate { mean, sd: Some(sd), .. }) = self.analysis.estimate else { return n >= LEAST };
            let half_width = student_quantile(1.0 - ALPHA / 2.0, n - 1) * sd / (n as f64).sqrt();
            let family = self.family.max(1) as f64;
            let is_within = mean.abs() < MARGIN;
            (mean.abs() - MARGIN).abs() > half_width && (is_within || family * 0.5f64.powi(n as i32 - 1) <= ALPHA)
        };
        match (LEAST.max(have + 1)..=MOST).find(enough) {
            Some(n) => format!("{} more with this fit, if the difference stays as it is.", subjects(n - have)),
            None => format!(
                "More than {MOST} subjects, if the difference stays as it is: it is too near the margin of {MARGIN}."
            ),
        }
    }
}

fn subjects(n: usize) -> String {
    if n == 1 { "1 subject".into() } else { format!("{n} subjects") }
}

/// Name of a simulator in sentences.
fn simulator_name(simulator: Simulator) -> &'static str {
    match simulator {
        Simulator::Fem => "FEM-GS",
        Simulator::Hybrid => "Hybrid-GS",
    }
}

/// An EI difference with its sign.
fn ei(difference: f64) -> String {
    format!("{difference:+.4}")
}

/// A mean difference with its interval.
fn told(estimate: &Estimate) -> String {
    match estimate.interval {
        Some((low, high)) => format!("{} ({} to {})", ei(estimate.mean), ei(low), ei(high)),
        None => ei(estimate.mean),
    }
}

fn p_words(p: Option<f64>) -> String {
    match p {
        Some(p) if p < 0.001 => "below 0.001".into(),
        Some(p) => format!("{p:.3}"),
        None => "not known".into(),
    }
}

#[cfg(test)]
mod tests;

//! Decision on one answer: checks the conditions of a verdict in turn, and words the one that decides.

use super::analysis::{Analysis, CONTROLLED, Estimate};
use super::class::{FitClass, Simulator};
use super::distribution::student_quantile;
use super::finding::Finding;
use super::{ALPHA, MARGIN};

/// Fewest subjects for which the two-sided sign-flip test can reach [`ALPHA`]: the least p is then 2^(1 - 6) = 0.031.
pub(super) const LEAST: usize = 6;
/// Fewest subjects for which a one-sided test can reach it: p is 2^-5 = 0.031. The test of equivalence is two of these.
const LEAST_EQUAL: usize = 5;
/// Number of missing subjects beyond which the exact number does not matter.
const MOST: usize = 200;

pub(super) struct Verdict {
    pub finding: Finding,
    pub reason: String,
    pub would_settle: String,
}

pub(super) struct Weighed<'a> {
    pub analysis: &'a Analysis,
    /// `None` for too few subjects.
    pub p_holm: Option<f64>,
    /// Held-out regret of the choice of this answer, and of one simulator for the whole study.
    pub regret: Option<[f64; 2]>,
    /// Number of answers that are tested together.
    pub family: usize,
}

impl Weighed<'_> {
    pub fn decide(&self, class: FitClass) -> Verdict {
        let n = self.analysis.subjects.len();
        let Some(estimate) = self.analysis.estimate.filter(|estimate| n >= least(estimate)) else {
            return self.too_few();
        };
        let (low, high) = ends(&estimate);
        if low > -MARGIN && high < MARGIN {
            return self.within(&estimate, class);
        }
        if !(low >= MARGIN || high <= -MARGIN) {
            let said = format!("The mean EI difference is {}", told(&estimate));
            let end = if low <= -MARGIN { -MARGIN } else { MARGIN };
            return self.abstain(format!("{said}; the interval holds {end:+}, so the rule stands."));
        }
        self.beyond(&estimate, class)
    }

    fn abstain(&self, reason: String) -> Verdict {
        Verdict { finding: Finding::InsufficientEvidence, reason, would_settle: self.more_subjects() }
    }

    fn too_few(&self) -> Verdict {
        let n = self.analysis.subjects.len();
        let reason = match (n, self.analysis.estimate) {
            (0, _) | (_, None) => "No subject has a converged result of both simulators with this fit".to_owned(),
            (1, Some(e)) => format!("One subject, mean EI difference {}", told(&e)),
            (_, Some(e)) => format!("{n} subjects, mean EI difference {}", told(&e)),
        };
        let least = self.analysis.estimate.map_or(LEAST, |estimate| least(&estimate));
        self.abstain(format!("{reason}; a test of fewer than {least} cannot reach p = {ALPHA}, so the rule stands."))
    }

    fn within(&self, estimate: &Estimate, class: FitClass) -> Verdict {
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
            let would_settle = format!("Agreement on whether {} counts.", rest.what);
            return Verdict { finding: Finding::InsufficientEvidence, reason, would_settle };
        }
        let rule = simulator_name(class.rule_says());
        let reason = format!(
            "{said}, all of it within {MARGIN} (equivalence p {}): no practical difference. {rule} by the rule.",
            p_words(estimate.p_equivalence)
        );
        let would_settle = format!("A margin below {:.4} would turn it.", self.reach(estimate));
        Verdict { finding: Finding::NoDifference, reason, would_settle }
    }

    /// Greatest absolute difference that the interval contains.
    fn reach(&self, estimate: &Estimate) -> f64 {
        estimate.interval.map_or(estimate.mean.abs(), |(low, high)| low.abs().max(high.abs()))
    }

    fn beyond(&self, estimate: &Estimate, class: FitClass) -> Verdict {
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
            let would_settle = format!("Agreement on whether {} counts; more subjects would not.", rest.what);
            return Verdict { finding: Finding::InsufficientEvidence, reason, would_settle };
        }
        if estimate.mean > 0.0
            && let Some(reason) = self.circular()
        {
            return Verdict {
                finding: Finding::InsufficientEvidence,
                reason: format!("{said}, but {reason}"),
                would_settle: "Measurements that no simulator sets.".into(),
            };
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
        Verdict { finding, reason, would_settle: self.nearest_to_turning() }
    }

    /// Reason that a verdict for Hybrid-GS rests on measurements that it restores by construction. `None` if it does
    /// not.
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

    fn nearest_to_turning(&self) -> String {
        let nearest = self.analysis.without.iter().min_by(|a, b| a.mean.abs().total_cmp(&b.mean.abs()));
        nearest.map_or_else(String::new, |rest| {
            format!("Nothing left out flips it; nearest is without {} ({}).", rest.what, ei(rest.mean))
        })
    }

    /// In words, the number of further subjects that a verdict needs if mean and deviation stay the same.
    fn more_subjects(&self) -> String {
        let have = self.analysis.subjects.len();
        let enough = |n: &usize| {
            let n = *n;
            let Some(Estimate { mean, sd: Some(sd), .. }) = self.analysis.estimate else { return n >= LEAST };
            if n < if mean.abs() < MARGIN { LEAST_EQUAL } else { LEAST } {
                return false;
            }
            let half_width = student_quantile(1.0 - ALPHA / 2.0, n - 1) * sd / (n as f64).sqrt();
            let family = self.family.max(1) as f64;
            let is_within = mean.abs() < MARGIN;
            (mean.abs() - MARGIN).abs() > half_width && (is_within || family * 0.5f64.powi(n as i32 - 1) <= ALPHA)
        };
        match (LEAST_EQUAL.max(have + 1)..=MOST).find(enough) {
            Some(n) if have == 0 => format!("{} with this fit, dressed by both simulators.", subjects(n)),
            Some(n) => format!("{} more with this fit, if the difference stays as it is.", subjects(n - have)),
            None => format!(
                "More than {MOST} subjects, if the difference stays as it is: it is too near the margin of {MARGIN}."
            ),
        }
    }
}

/// Ends of the interval. Without an interval, infinite.
fn ends(estimate: &Estimate) -> (f64, f64) {
    estimate.interval.unwrap_or((f64::NEG_INFINITY, f64::INFINITY))
}

/// Fewest subjects for a verdict: of equivalence if the interval lies within the margin, otherwise of a difference.
fn least(estimate: &Estimate) -> usize {
    let (low, high) = ends(estimate);
    if low > -MARGIN && high < MARGIN { LEAST_EQUAL } else { LEAST }
}

fn subjects(n: usize) -> String {
    if n == 1 { "1 subject".into() } else { format!("{n} subjects") }
}

fn simulator_name(simulator: Simulator) -> &'static str {
    match simulator {
        Simulator::Fem => "FEM-GS",
        Simulator::Hybrid => "Hybrid-GS",
    }
}

fn ei(difference: f64) -> String {
    format!("{difference:+.4}")
}

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

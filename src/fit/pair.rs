//! What both simulators made of the same case: one garment in one size on one subject.

use std::collections::BTreeMap;

use super::class::{FitClass, Simulator};
use super::statistics::mean;

/// How far both simulators are off one measurement of a pattern.
#[derive(Clone, Debug, PartialEq)]
pub struct Errors {
    /// Number in the style.
    pub no: u32,
    /// Name of the measurement in the style.
    pub name: String,
    /// |chi - 1| of FEM-GS.
    pub fem: f64,
    /// |chi - 1| of Hybrid-GS.
    pub hybrid: f64,
    /// Whether it lies on an edge that nothing is sewn to.
    pub free_edge: bool,
    /// Whether one of the simulators restores it by construction: scoring it is circular.
    pub controlled: bool,
}

/// A case that both simulators drew.
#[derive(Clone, Debug, PartialEq)]
pub struct Pair {
    /// Name of the garment in the study.
    pub garment: String,
    /// Name of the size, such as `M`.
    pub size: String,
    /// Name of the subject in the study.
    pub subject: String,
    /// Fit class that the deciding ease falls in.
    pub class: FitClass,
    /// Ease that decides it, m.
    pub ease_m: f64,
    /// Every measurement that both have.
    pub errors: Vec<Errors>,
}

impl Pair {
    /// EI of a simulator, mean |chi - 1|, over the measurements that `keep` keeps; `None` when none are left.
    #[must_use]
    pub fn ei(&self, simulator: Simulator, keep: impl Fn(&Errors) -> bool) -> Option<f64> {
        let error = |e: &Errors| match simulator {
            Simulator::Fem => e.fem,
            Simulator::Hybrid => e.hybrid,
        };
        let errors: Vec<f64> = self.errors.iter().filter(|e| keep(e)).map(error).collect();
        (!errors.is_empty()).then(|| mean(&errors))
    }

    /// EI of FEM-GS less EI of Hybrid-GS over the same measurements: below 0 where FEM-GS is the truer.
    #[must_use]
    pub fn d_ei(&self, keep: impl Fn(&Errors) -> bool) -> Option<f64> {
        Some(self.ei(Simulator::Fem, &keep)? - self.ei(Simulator::Hybrid, &keep)?)
    }
}

/// The mean difference of every subject over its cases, by name of the subject.
pub(super) fn by_subject(pairs: &[&Pair], keep: impl Fn(&Errors) -> bool) -> Vec<f64> {
    let mut subjects: BTreeMap<&str, Vec<f64>> = BTreeMap::new();
    for pair in pairs {
        subjects.entry(&pair.subject).or_default().extend(pair.d_ei(&keep));
    }
    subjects.values().filter(|cases| !cases.is_empty()).map(|cases| mean(cases)).collect()
}

/// In how many cases FEM-GS and Hybrid-GS have the lower EI.
#[must_use]
pub fn wins(pairs: &[&Pair], keep: impl Fn(&Errors) -> bool) -> [usize; 2] {
    let differences: Vec<f64> = pairs.iter().filter_map(|pair| pair.d_ei(&keep)).collect();
    [differences.iter().filter(|d| **d < 0.0).count(), differences.iter().filter(|d| **d > 0.0).count()]
}

/// How often a rule named the simulator with the lower EI.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RuleScore {
    /// Cases in which it did.
    pub right: usize,
    /// Cases for which it names one.
    pub of: usize,
}

/// How often "FEM-GS for loose fits, Hybrid-GS for tight ones" names the simulator with the lower EI; just fits, for which
/// the thesis claims nothing of accuracy, do not count.
#[must_use]
pub fn rule_score(pairs: &[Pair]) -> RuleScore {
    let mut score = RuleScore::default();
    for pair in pairs.iter().filter(|pair| pair.class != FitClass::Just) {
        if let Some(difference) = pair.d_ei(|_| true) {
            let truer = if difference < 0.0 { Simulator::Fem } else { Simulator::Hybrid };
            score.of += 1;
            score.right += usize::from(truer == pair.class.rule_says());
        }
    }
    score
}

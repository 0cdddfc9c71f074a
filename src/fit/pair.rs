//! Errors of both simulators on the same case: one garment in one size on one subject.

use std::collections::BTreeMap;

use super::class::{FitClass, Simulator};
use super::statistics::mean;

/// Errors of both simulators at one measurement of a pattern.
#[derive(Clone, Debug, PartialEq)]
pub struct Errors {
    /// Number of the measurement in the style.
    pub no: u32,
    /// Name of the measurement in the style.
    pub name: String,
    /// |chi - 1| of FEM-GS.
    pub fem: f64,
    /// |chi - 1| of Hybrid-GS.
    pub hybrid: f64,
    /// True if it lies on an edge that nothing is sewn to.
    pub free_edge: bool,
    /// True if one of the simulators restores it by construction, which makes scoring it circular.
    pub controlled: bool,
}

/// A case that both simulators have draped.
#[derive(Clone, Debug, PartialEq)]
pub struct Pair {
    /// Name of the garment in the study.
    pub garment: String,
    /// Name of the size, such as `M`.
    pub size: String,
    /// Name of the subject in the study.
    pub subject: String,
    /// Fit class of the deciding ease.
    pub class: FitClass,
    /// Ease that decides it, m.
    pub ease_m: f64,
    /// Errors at every measurement that both drapes have.
    pub errors: Vec<Errors>,
}

impl Pair {
    /// EI of a simulator, mean |chi - 1|, over the measurements for which `keep` holds. `None` when there are none.
    #[must_use]
    pub fn ei(&self, simulator: Simulator, keep: impl Fn(&Errors) -> bool) -> Option<f64> {
        let error = |e: &Errors| match simulator {
            Simulator::Fem => e.fem,
            Simulator::Hybrid => e.hybrid,
        };
        let errors: Vec<f64> = self.errors.iter().filter(|e| keep(e)).map(error).collect();
        (!errors.is_empty()).then(|| mean(&errors))
    }

    /// EI of FEM-GS less EI of Hybrid-GS over the same measurements. It is below 0 where FEM-GS is truer.
    #[must_use]
    pub fn d_ei(&self, keep: impl Fn(&Errors) -> bool) -> Option<f64> {
        Some(self.ei(Simulator::Fem, &keep)? - self.ei(Simulator::Hybrid, &keep)?)
    }
}

/// Mean difference of every subject over its cases, in the order of the subjects' names.
pub(super) fn by_subject(pairs: &[&Pair], keep: impl Fn(&Errors) -> bool) -> Vec<f64> {
    let mut subjects: BTreeMap<&str, Vec<f64>> = BTreeMap::new();
    for pair in pairs {
        subjects.entry(&pair.subject).or_default().extend(pair.d_ei(&keep));
    }
    subjects.values().filter(|cases| !cases.is_empty()).map(|cases| mean(cases)).collect()
}

/// Numbers of cases in which FEM-GS and in which Hybrid-GS has the lower EI.
#[must_use]
pub fn wins(pairs: &[&Pair], keep: impl Fn(&Errors) -> bool) -> [usize; 2] {
    let differences: Vec<f64> = pairs.iter().filter_map(|pair| pair.d_ei(&keep)).collect();
    [differences.iter().filter(|d| **d < 0.0).count(), differences.iter().filter(|d| **d > 0.0).count()]
}

/// Score of a rule that names a simulator.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RuleScore {
    /// Cases in which it names the simulator with the lower EI.
    pub right: usize,
    /// Cases for which it names a simulator.
    pub of: usize,
}

/// Scores the rule "FEM-GS for loose fits, Hybrid-GS for tight ones" by the lower EI. The thesis claims nothing about
/// the accuracy of just fits, so they do not count.
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

//! Errors of both simulators on the same case: a garment in a size on a subject.

use std::collections::BTreeMap;

use super::class::{FitClass, Simulator};
use super::statistics::mean;

#[derive(Clone, Debug, PartialEq)]
pub struct Errors {
    pub no: u32,
    pub name: String,
    /// |chi - 1| of FEM-GS.
    pub fem: f64,
    /// |chi - 1| of Hybrid-GS.
    pub hybrid: f64,
    /// True if the measurement lies on an edge to which nothing is sewn.
    pub free_edge: bool,
    /// True if a simulator restores the measurement by construction, so that scoring it is circular.
    pub controlled: bool,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Pair {
    pub garment: String,
    pub size: String,
    pub subject: String,
    pub class: FitClass,
    /// Ease that decides the class.
    pub ease_m: f64,
    /// Errors at every measurement that both drapes have.
    pub errors: Vec<Errors>,
}

impl Pair {
    /// EI of a simulator over the measurements for which `keep` is true. `None` without such measurements.
    pub fn ei(&self, simulator: Simulator, keep: impl Fn(&Errors) -> bool) -> Option<f64> {
        let error = |e: &Errors| match simulator {
            Simulator::Fem => e.fem,
            Simulator::Hybrid => e.hybrid,
        };
        let errors: Vec<f64> = self.errors.iter().filter(|e| keep(e)).map(error).collect();
        (!errors.is_empty()).then(|| mean(&errors))
    }

    /// EI of FEM-GS minus that of Hybrid-GS over the measurements for which `keep` is true. Negative if FEM-GS is
    /// truer. `None` without such measurements.
    pub fn d_ei(&self, keep: impl Fn(&Errors) -> bool) -> Option<f64> {
        Some(self.ei(Simulator::Fem, &keep)? - self.ei(Simulator::Hybrid, &keep)?)
    }
}

/// Mean difference of every subject over its cases, in the order of the names of the subjects.
pub(super) fn by_subject(pairs: &[&Pair], keep: impl Fn(&Errors) -> bool) -> Vec<f64> {
    let mut subjects: BTreeMap<&str, Vec<f64>> = BTreeMap::new();
    for pair in pairs {
        subjects.entry(&pair.subject).or_default().extend(pair.d_ei(&keep));
    }
    subjects.values().filter(|cases| !cases.is_empty()).map(|cases| mean(cases)).collect()
}

/// Numbers of cases in which FEM-GS and in which Hybrid-GS has the lower EI.
pub fn wins(pairs: &[&Pair], keep: impl Fn(&Errors) -> bool) -> [usize; 2] {
    let differences: Vec<f64> = pairs.iter().filter_map(|pair| pair.d_ei(&keep)).collect();
    [differences.iter().filter(|d| **d < 0.0).count(), differences.iter().filter(|d| **d > 0.0).count()]
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RuleScore {
    /// Number of cases in which the named simulator has the lower EI.
    pub right: usize,
    /// Number of cases for which the rule names a simulator.
    pub of: usize,
}

/// Scores the rule "FEM-GS for loose fits, Hybrid-GS for tight ones" by the lower EI. Just fits do not count, because
/// the thesis claims nothing about their accuracy.
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

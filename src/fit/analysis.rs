//! Statistics of a set of pairs.

use std::collections::BTreeMap;

use super::pair::{Errors, Pair, by_subject, wins};
use super::resample::{interval, sign_flip};
use super::statistics::{effect_size, equivalence, mean, sd};
use super::{ALPHA, MARGIN};

/// Statistics of pairs of drapes by both simulators. Differences are the EI of FEM-GS minus that of Hybrid-GS.
#[derive(Clone, Debug, PartialEq)]
pub struct Analysis {
    /// Number of cases: sizes times subjects.
    pub cases: usize,
    /// Number of cases in which FEM-GS and in which Hybrid-GS has the lower EI.
    pub wins: [usize; 2],
    pub subjects: Vec<f64>,
    /// Estimate from these means. `None` without any subject.
    pub estimate: Option<Estimate>,
    /// Mean differences without each measurement in turn.
    pub without: Vec<Without>,
    /// Mean differences without free edges, and without the measurements that a simulator restores by construction.
    pub told_apart: Vec<Without>,
    /// Number of measurements that a simulator restores. If that is all, [`Analysis::told_apart`] has no mean without.
    pub controlled: usize,
}

/// [`Without::what`] for the measurements that a simulator restores by construction.
pub(super) const CONTROLLED: &str = "controlled measurements";

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    pub mean: f64,
    /// Bootstrap interval of the mean at 95 %. `None` for fewer than two subjects.
    pub interval: Option<(f64, f64)>,
    /// Paired effect size. `None` for fewer than three subjects, or equal differences.
    pub size: Option<f64>,
    /// Sample standard deviation over subjects.
    pub sd: Option<f64>,
    /// Two-sided p of the sign-flip test.
    pub p: f64,
    /// p of the two one-sided tests of equivalence: that the difference lies within the margin.
    pub p_equivalence: Option<f64>,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Without {
    /// Name of the measurements left out (`#6 Neck Opening`, `free edges`).
    pub what: String,
    pub mean: f64,
    /// Number of cases in which FEM-GS and in which Hybrid-GS has the lower EI by these.
    pub wins: [usize; 2],
}

impl Analysis {
    pub fn new(pairs: &[&Pair]) -> Self {
        let subjects = by_subject(pairs, |_| true);
        let mut names: BTreeMap<u32, (&str, bool)> = BTreeMap::new();
        for errors in pairs.iter().flat_map(|pair| &pair.errors) {
            names.entry(errors.no).or_insert((&errors.name, errors.controlled));
        }
        let each = names.iter().filter_map(|(no, (name, _))| without(pairs, format!("#{no} {name}"), |e| e.no != *no));
        let any = |is_kind: fn(&Errors) -> bool| pairs.iter().flat_map(|pair| &pair.errors).any(is_kind);
        let mut told_apart = Vec::new();
        if any(|e| e.free_edge) {
            told_apart.extend(without(pairs, "free edges".into(), |e| !e.free_edge));
        }
        if any(|e| e.controlled) {
            told_apart.extend(without(pairs, CONTROLLED.into(), |e| !e.controlled));
        }
        Self {
            cases: pairs.len(),
            wins: wins(pairs, |_| true),
            estimate: estimate(&subjects),
            without: each.collect(),
            subjects,
            told_apart,
            controlled: names.values().filter(|(_, controlled)| *controlled).count(),
        }
    }

    /// True if a simulator restores every measurement by construction, so that a comparison is circular.
    pub fn is_circular(&self) -> bool {
        self.controlled > 0 && !self.told_apart.iter().any(|rest| rest.what == CONTROLLED)
    }

    pub fn turned_by(&self) -> Option<&Without> {
        let mean = self.estimate?.mean;
        self.without.iter().find(|rest| rest.mean * mean <= 0.0)
    }
}

fn without(pairs: &[&Pair], what: String, keep: impl Fn(&Errors) -> bool) -> Option<Without> {
    let subjects = by_subject(pairs, &keep);
    (!subjects.is_empty()).then(|| Without { what, mean: mean(&subjects), wins: wins(pairs, &keep) })
}

fn estimate(subjects: &[f64]) -> Option<Estimate> {
    let n = subjects.len();
    let mean = (n > 0).then(|| mean(subjects))?;
    let sd = (n > 1).then(|| sd(subjects));
    Some(Estimate {
        mean,
        interval: interval(subjects, ALPHA),
        size: effect_size(subjects),
        sd,
        p: sign_flip(subjects),
        p_equivalence: sd.map(|sd| equivalence(mean, sd / (n as f64).sqrt(), n - 1, MARGIN)),
    })
}

//! Fit and evidence: ease at the levels of a body, its fit class [T 6.2.3], the simulator that the rule of the thesis
//! names for that class [T 6.4.2], and the verdict of the numbers of a study.
//!
//! The subject is the statistical unit: several sizes of one subject count once. [`judge()`] takes the errors of both
//! simulators on the same cases ([`Pair`]) and gives an [`Answer`] for every garment and fit class. [`Analysis`] is the
//! statistics of an answer, and [`crossover`] the ease at which the better simulator changes.

mod advice;
pub mod alter;
mod analysis;
pub mod chance;
mod class;
pub mod coverage;
mod distribution;
mod ease;
mod finding;
mod judge;
pub mod measure;
pub mod on_body;
mod pair;
pub mod reach;
mod resample;
mod statistics;
pub mod target;
mod threshold;
mod weigh;

pub use advice::{Shown, shown};
pub use analysis::{Analysis, Estimate, Without};
pub use class::{FitClass, Simulator};
pub use ease::{Cuts, Ease, ease};
pub use finding::{Basis, Finding};
pub use judge::{Answer, Cell, Evidence, GarmentEvidence, judge};
pub use pair::{Errors, Pair, RuleScore, rule_score, wins};
pub use resample::{Draw, interval, sign_flip};
pub use statistics::{effect_size, equivalence, holm};
pub use threshold::{Crossover, CrossoverEase, crossover};

/// Significance level of every test.
pub const ALPHA: f64 = 0.05;

/// EI difference below which the simulators count as equivalent: 1 % of the pattern's lengths. Judgement.
pub const MARGIN: f64 = 0.01;

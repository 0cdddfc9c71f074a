//! Fit and evidence: ease at a level and the fit class it means [T 6.2.3], the simulator that the thesis's rule then
//! names [T 6.4.2], and what a study's own numbers say of it.
//!
//! The subject is the unit: several sizes of one subject count once. [`judge()`] takes what both simulators made of the
//! same cases ([`Pair`]). It gives an [`Answer`] for every garment and fit class. [`Analysis`] holds the statistics
//! behind it, [`crossover`] the ease at which the simulators change places.

mod advice;
pub mod alter;
mod analysis;
pub mod chance;
mod class;
pub mod coverage;
mod distribution;
mod ease;
mod judge;
pub mod measure;
mod pair;
pub mod reach;
mod resample;
mod statistics;
pub mod target;
mod threshold;
mod weigh;
pub mod worn;

pub use advice::{Shown, shown};
pub use analysis::{Analysis, Estimate, Without};
pub use class::{FitClass, Simulator};
pub use ease::{Cuts, Ease, ease};
pub use judge::{Answer, Basis, Cell, Evidence, Finding, judge};
pub use pair::{Errors, Pair, RuleScore, rule_score, wins};
pub use resample::{Draw, interval, sign_flip};
pub use statistics::{effect_size, equivalence, holm};
pub use threshold::{Crossover, crossover};

/// Level of every test.
pub const ALPHA: f64 = 0.05;

/// EI below which a difference of the simulators means nothing in practice.
pub const MARGIN: f64 = 0.01;

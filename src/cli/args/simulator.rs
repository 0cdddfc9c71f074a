//! Simulators by name.

use clap::ValueEnum;

/// Simulator of a trial.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum TrySimulator {
    /// FEM-GS: physics alone.
    Fem,
    /// Hybrid-GS: the pattern's size first.
    Hybrid,
}

impl From<TrySimulator> for fit::Simulator {
    fn from(simulator: TrySimulator) -> Self {
        match simulator {
            TrySimulator::Fem => Self::Fem,
            TrySimulator::Hybrid => Self::Hybrid,
        }
    }
}

//! Simulators and fit classes.

/// A garment simulator, as a rule or the evidence can recommend it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Simulator {
    /// FEM-GS: physics alone.
    Fem,
    /// Hybrid-GS: geometry first, then physics.
    Hybrid,
}

impl Simulator {
    /// Both simulators, FEM-GS first.
    pub const ALL: [Self; 2] = [Self::Fem, Self::Hybrid];

    /// Name in the command line and in SQL.
    #[must_use]
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Fem => "fem",
            Self::Hybrid => "hybrid",
        }
    }
}

/// Fit class of a garment on a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum FitClass {
    /// Ease below the lower cut.
    Tight,
    /// Ease between the cuts, both included.
    Just,
    /// Ease above the upper cut.
    Loose,
}

impl FitClass {
    /// Name in SQL and on screens.
    #[must_use]
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Tight => "tight",
            Self::Just => "just",
            Self::Loose => "loose",
        }
    }

    /// Simulator that the rule of the thesis names for this class [T 6.4.2, 6.5]: FEM-GS for loose fits, Hybrid-GS
    /// otherwise.
    #[must_use]
    pub fn rule_says(self) -> Simulator {
        match self {
            Self::Loose => Simulator::Fem,
            Self::Tight | Self::Just => Simulator::Hybrid,
        }
    }
}

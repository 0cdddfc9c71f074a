//! Simulators and fit classes.

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Simulator {
    /// FEM-GS: physics alone.
    Fem,
    /// Hybrid-GS: geometry first, then physics.
    Hybrid,
}

impl Simulator {
    pub const ALL: [Self; 2] = [Self::Fem, Self::Hybrid];

    /// Name in the command line and in SQL.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Fem => "fem",
            Self::Hybrid => "hybrid",
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum FitClass {
    Tight,
    /// Includes both cuts.
    Just,
    Loose,
}

impl FitClass {
    /// Name in SQL and on screens.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Tight => "tight",
            Self::Just => "just",
            Self::Loose => "loose",
        }
    }

    /// Simulator that the rule of the thesis names [T 6.4.2, 6.5]: FEM-GS for loose fits, Hybrid-GS otherwise.
    pub fn rule_says(self) -> Simulator {
        match self {
            Self::Loose => Simulator::Fem,
            Self::Tight | Self::Just => Simulator::Hybrid,
        }
    }
}

//! Verdict of the evidence, and the basis of a recommendation.

use super::class::Simulator;

/// Verdict of the evidence on one garment and fit class.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Finding {
    /// FEM-GS is truer to the pattern.
    Fem,
    /// Hybrid-GS is truer to the pattern.
    Hybrid,
    /// Both are equivalent within the margin.
    NoDifference,
    /// The data do not suffice for a verdict.
    InsufficientEvidence,
}

impl Finding {
    /// Name in SQL (`v_recommendation.verdict`).
    #[must_use]
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Fem => "fem",
            Self::Hybrid => "hybrid",
            Self::NoDifference => "no_difference",
            Self::InsufficientEvidence => "insufficient_evidence",
        }
    }

    /// Finding with a name in SQL. `None` if there is none.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        let all = [Self::Fem, Self::Hybrid, Self::NoDifference, Self::InsufficientEvidence];
        all.into_iter().find(|finding| finding.as_str() == name)
    }

    /// Simulator that the finding names. `None` for one that names none.
    #[must_use]
    pub fn simulator(self) -> Option<Simulator> {
        match self {
            Self::Fem => Some(Simulator::Fem),
            Self::Hybrid => Some(Simulator::Hybrid),
            Self::NoDifference | Self::InsufficientEvidence => None,
        }
    }
}

/// Basis of a recommendation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Basis {
    /// Rule of the thesis.
    Rule,
    /// Numbers of the study.
    Evidence,
}

impl Basis {
    /// Name in SQL (`v_recommendation.basis`).
    #[must_use]
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Rule => "rule",
            Self::Evidence => "evidence",
        }
    }
}

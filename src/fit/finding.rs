//! Verdict of the evidence, and the basis of a recommendation.

use super::class::Simulator;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Finding {
    /// FEM-GS is truer to the pattern.
    Fem,
    /// Hybrid-GS is truer to the pattern.
    Hybrid,
    /// Both are equivalent within the margin.
    NoDifference,
    InsufficientEvidence,
}

impl Finding {
    /// Name in SQL (`v_recommendation.verdict`).
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Fem => "fem",
            Self::Hybrid => "hybrid",
            Self::NoDifference => "no_difference",
            Self::InsufficientEvidence => "insufficient_evidence",
        }
    }

    pub fn from_name(name: &str) -> Option<Self> {
        let all = [Self::Fem, Self::Hybrid, Self::NoDifference, Self::InsufficientEvidence];
        all.into_iter().find(|finding| finding.as_str() == name)
    }

    pub fn simulator(self) -> Option<Simulator> {
        match self {
            Self::Fem => Some(Simulator::Fem),
            Self::Hybrid => Some(Simulator::Hybrid),
            Self::NoDifference | Self::InsufficientEvidence => None,
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Basis {
    Rule,
    Evidence,
}

impl Basis {
    /// Name in SQL (`v_recommendation.basis`).
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Rule => "rule",
            Self::Evidence => "evidence",
        }
    }
}

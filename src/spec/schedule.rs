//! When a job is started, and the limits it is held to.

/// What a job may take; one that takes more is ended and has failed. Results do not depend on it.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Limits {
    /// Time from its start, s.
    pub time_s: Option<f64>,
    /// Memory, MB (10^6 bytes).
    pub memory_mb: Option<u32>,
}

impl Limits {
    /// Whether there is one.
    #[must_use]
    pub fn is_some(&self) -> bool {
        self.time_s.is_some() || self.memory_mb.is_some()
    }

    /// These limits, and others where these say nothing.
    #[must_use]
    pub fn or(self, others: Self) -> Self {
        Self { time_s: self.time_s.or(others.time_s), memory_mb: self.memory_mb.or(others.memory_mb) }
    }
}

/// When a job is started, and what it may take: nothing of this is an input of its result.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Schedule {
    /// Greater runs earlier.
    pub priority: i64,
    /// Garments whose jobs on the same subject, by the same simulator, must have results before.
    pub after: Vec<String>,
    /// What it may take.
    pub limits: Limits,
}

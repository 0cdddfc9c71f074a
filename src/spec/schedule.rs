//! Schedule of a job: its place in the queue and its limits.

/// Limits of a job. One that exceeds them is ended and has failed. Results do not depend on them.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Limits {
    /// Time from its start, s.
    pub time_s: Option<f64>,
    /// Memory, MB (10^6 bytes).
    pub memory_mb: Option<u32>,
}

impl Limits {
    /// True if there is a limit.
    #[must_use]
    pub fn is_some(&self) -> bool {
        self.time_s.is_some() || self.memory_mb.is_some()
    }

    /// These limits, with those of `others` where one is not set.
    #[must_use]
    pub fn or(self, others: Self) -> Self {
        Self { time_s: self.time_s.or(others.time_s), memory_mb: self.memory_mb.or(others.memory_mb) }
    }
}

/// Schedule of a job. Nothing of it is an input of the result.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Schedule {
    /// Priority in the queue; jobs of greater priority run earlier.
    pub priority: i64,
    /// Garments whose jobs on the same subject, by the same simulator, must have results before.
    pub after: Vec<String>,
    /// Limits of time and memory.
    pub limits: Limits,
}

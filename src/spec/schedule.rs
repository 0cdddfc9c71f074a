//! Schedule of a job: its place in the queue and its limits.

/// Limits of a job, which results do not depend on. A job that exceeds a limit is ended and has failed.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Limits {
    /// Greatest time from the start.
    pub time_s: Option<f64>,
    /// Megabytes of 10^6 bytes.
    pub memory_mb: Option<u32>,
}

impl Limits {
    pub fn is_some(&self) -> bool {
        self.time_s.is_some() || self.memory_mb.is_some()
    }

    pub fn or(self, others: Self) -> Self {
        Self { time_s: self.time_s.or(others.time_s), memory_mb: self.memory_mb.or(others.memory_mb) }
    }
}

/// Schedule of a job, which results do not depend on.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Schedule {
    /// Jobs of greater priority run earlier.
    pub priority: i64,
    /// Garments that must have results first: of their jobs on the same subject, by the same simulator.
    pub after: Vec<String>,
    pub limits: Limits,
}

//! A job in a process of its own, which keeps to its limits and prints its progress as lines on standard output.

use std::time::{Duration, Instant};

use rustix::process::{Resource, Rlimit, Signal, set_parent_process_death_signal, setrlimit};
use serde::{Deserialize, Serialize};

use crate::error::EngineError;
use sim::{Monitor, Progress, Step};
use spec::Limits;
use store::Result;

const LINES: Duration = Duration::from_millis(200);
const PHASES: [&str; 4] = ["sew", "popup", "settle", "drape"];
pub(crate) struct Clock {
    began: Instant,
    limit_s: Option<f64>,
}

impl Clock {
    pub fn start(limits: &Limits) -> Self {
        Self { began: Instant::now(), limit_s: limits.time_s }
    }

    pub fn is_over(&self) -> bool {
        self.limit_s.is_some_and(|limit_s| self.began.elapsed().as_secs_f64() > limit_s)
    }

    pub fn error(&self) -> EngineError {
        EngineError::OutOfTime { limit_s: self.limit_s.unwrap_or_default() }
    }
}

/// Applies a memory limit to this process.
pub(crate) fn keep_to(limits: &Limits) -> Result<()> {
    let Some(megabytes) = limits.memory_mb else { return Ok(()) };
    let most = Some(u64::from(megabytes) * 1_000_000);
    let set = setrlimit(Resource::Data, Rlimit { current: most, maximum: most });
    Ok(set.map_err(|reason| EngineError::MemoryLimit { megabytes, reason })?)
}

pub(crate) fn end_with_parent() {
    // Where the system cannot do this, the process ends with its job.
    let _ = set_parent_process_death_signal(Some(Signal::KILL));
}

/// Monitor of a job in a process of its own: checks its time, and prints progress for the parent.
pub(crate) struct Teller {
    pub clock: Clock,
    /// True if a parent reads the lines.
    pub is_heard: bool,
    pub last: Option<Instant>,
}

impl Monitor for Teller {
    fn progress(&mut self, progress: &Progress) {
        if !self.is_heard || self.last.is_some_and(|last| last.elapsed() < LINES) {
            return;
        }
        self.last = Some(Instant::now());
        let Progress { phase, fraction, step } = *progress;
        if let Ok(line) = serde_json::to_string(&Line { phase: phase.to_owned(), fraction, step }) {
            // The parent may have gone.
            let _ = std::io::Write::write_all(&mut std::io::stdout().lock(), format!("{line}\n").as_bytes());
        }
    }

    fn cancelled(&self) -> bool {
        self.clock.is_over()
    }
}

#[derive(Serialize, Deserialize)]
pub(crate) struct Line {
    phase: String,
    fraction: f64,
    step: Step,
}

impl Line {
    /// `None` for any line that tells no progress.
    pub fn read(text: &str) -> Option<Progress> {
        let Self { phase, fraction, step } = serde_json::from_str(text).ok()?;
        let phase = PHASES.into_iter().find(|known| *known == phase).unwrap_or("works");
        Some(Progress { phase, fraction, step })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_of_progress_are_read_and_others_are_not() {
        let step = Step { iteration: 3, level: 1, residual: 0.25, seam_gap_m: 0.0, e_chi: 1.0 };
        let line = serde_json::to_string(&Line { phase: "settle".into(), fraction: 0.5, step }).expect("finite");
        assert_eq!(Line::read(&line), Some(Progress { phase: "settle", fraction: 0.5, step }));
        assert_eq!(Line::read("jobs/1.result.json"), None);
    }
}

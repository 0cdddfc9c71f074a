//! A look at a running simulation: its garment as it is now, for one job at a time and only when somebody looks.

use std::sync::atomic::{AtomicI64, Ordering};
use std::sync::{Mutex, PoisonError};

use crate::rows::JobId;
use geom::V3;

/// Stands for no job; the database counts from 1.
const NOBODY: i64 = 0;

/// The garment of a running job at one moment.
#[derive(Clone, Debug, PartialEq)]
pub struct LiveFrame {
    /// Job whose simulation it is of.
    pub job: JobId,
    /// Place of every vertex of the mesh that is worked on, m; meshes grow finer as a simulation goes on.
    pub positions: Vec<V3>,
}

/// What passes between a run and whoever watches it. A frame is copied only after the one before was taken, so that
/// watching costs a simulation a copy of its vertices a few times a second, and its results nothing.
#[derive(Debug, Default)]
pub struct Live {
    watched: AtomicI64,
    frame: Mutex<Option<LiveFrame>>,
}

impl Live {
    /// Watches a job, or none.
    pub fn watch(&self, job: Option<JobId>) {
        self.watched.store(job.map_or(NOBODY, |job| job.0), Ordering::Relaxed);
        drop(self.take());
    }

    /// The frame that came since the last was taken.
    #[must_use]
    pub fn take(&self) -> Option<LiveFrame> {
        self.slot().take()
    }

    /// Whether a frame of a job is wanted now.
    pub fn wants(&self, job: JobId) -> bool {
        self.watched.load(Ordering::Relaxed) == job.0 && self.slot().is_none()
    }

    /// Shows a job's garment.
    pub fn show(&self, job: JobId, positions: &[V3]) {
        *self.slot() = Some(LiveFrame { job, positions: positions.to_vec() });
    }

    /// The frame; a plain value, whole even after a panic elsewhere.
    fn slot(&self) -> std::sync::MutexGuard<'_, Option<LiveFrame>> {
        self.frame.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_of_the_watched_job_and_one_at_a_time() {
        let (live, job) = (Live::default(), JobId(3));
        assert!(!live.wants(job), "nobody looks");
        live.watch(Some(job));
        assert!(live.wants(job) && !live.wants(JobId(4)));
        live.show(job, &[V3::new(1.0, 2.0, 3.0)]);
        assert!(!live.wants(job), "the last one was not taken yet");
        assert_eq!(live.take().map(|frame| frame.positions), Some(vec![V3::new(1.0, 2.0, 3.0)]));
        assert!(live.wants(job));
        live.show(job, &[]);
        live.watch(None);
        assert!(live.take().is_none() && !live.wants(job));
    }
}

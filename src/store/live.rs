//! Live frames of a running simulation: the present shape of one job's garment, kept only while a screen watches it.

use std::sync::atomic::{AtomicI64, Ordering};
use std::sync::{Mutex, PoisonError};

use crate::rows::JobId;
use geom::V3;

/// Number that stands for no job; the database counts from 1.
const NOBODY: i64 = 0;

/// The garment of a running job at one moment.
#[derive(Clone, Debug, PartialEq)]
pub struct LiveFrame {
    pub job: JobId,
    /// Position of every vertex of the present mesh, m; meshes grow finer as a simulation goes on.
    pub positions: Vec<V3>,
}

/// Exchange between a run and the screen that watches it. A frame is copied only after the one before was taken, so
/// watching costs a simulation a few copies of its vertices a second. Results do not depend on it.
#[derive(Debug, Default)]
pub struct Live {
    watched: AtomicI64,
    frame: Mutex<Option<LiveFrame>>,
}

impl Live {
    /// `None` ends watching.
    pub fn watch(&self, job: Option<JobId>) {
        self.watched.store(job.map_or(NOBODY, |job| job.0), Ordering::Relaxed);
        drop(self.take());
    }

    /// Takes the frame that arrived since the last call.
    pub fn take(&self) -> Option<LiveFrame> {
        self.slot().take()
    }

    /// True if the job is watched and its last frame was taken.
    pub fn wants(&self, job: JobId) -> bool {
        self.watched.load(Ordering::Relaxed) == job.0 && self.slot().is_none()
    }

    pub fn show(&self, job: JobId, positions: &[V3]) {
        *self.slot() = Some(LiveFrame { job, positions: positions.to_vec() });
    }

    /// A frame is a plain value, so it is whole even after a panic of another thread.
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

//! What a user may do to the queue.

use crate::error::Result;
use crate::rows::{JobId, Status};
use crate::store;
use crate::store::queue::{self, Event};
use crate::workspace::Workspace;

impl Workspace {
    /// Cancels queued or running jobs; returns how many were.
    ///
    /// # Errors
    /// When the workspace is read-only or a job does not exist.
    pub fn cancel(&mut self, ids: &[JobId]) -> Result<usize> {
        self.change(ids, &Event::Cancel, "cancelled")
    }

    /// Queues failed or cancelled jobs again, and those of which they need the result; returns how many were. A job with a
    /// result keeps it.
    ///
    /// # Errors
    /// When the workspace is read-only or a job does not exist.
    pub fn retry(&mut self, ids: &[JobId]) -> Result<usize> {
        let mut all = ids.to_vec();
        let mut next = 0;
        while let Some(&id) = all.get(next) {
            let needed = queue::needs(&self.reader, id)?;
            all.extend(needed.into_iter().filter(|needed| !all.contains(needed)).collect::<Vec<_>>());
            next += 1;
        }
        self.change(&all, &Event::Retry, "queued again")
    }

    /// Applies one event to several jobs, all or none.
    fn change(&mut self, ids: &[JobId], event: &Event<'_>, done: &str) -> Result<usize> {
        store::lightly(self.writer()?, |transaction| {
            let mut changed = 0;
            for &id in ids {
                if queue::apply(transaction, id, event, None)?.is_some() {
                    queue::log(transaction, id, "info", done)?;
                    changed += 1;
                }
            }
            Ok(changed)
        })
    }

    /// Sets the priority of jobs: greater runs earlier.
    ///
    /// # Errors
    /// When the workspace is read-only.
    pub fn set_priority(&mut self, ids: &[JobId], priority: i64) -> Result<()> {
        store::lightly(self.writer()?, |transaction| {
            let mut statement = transaction.prepare_cached("UPDATE job SET priority = ? WHERE job_id = ?")?;
            for id in ids {
                statement.execute((priority, id.0))?;
            }
            Ok(())
        })
    }

    /// Lets no new jobs of a study start; running ones go on.
    ///
    /// # Errors
    /// When the workspace is read-only or there is no such study.
    pub fn pause(&mut self, study: &str) -> Result<()> {
        self.set_paused(study, true)
    }

    /// Lets jobs of a paused study start again.
    ///
    /// # Errors
    /// When the workspace is read-only or there is no such study.
    pub fn resume(&mut self, study: &str) -> Result<()> {
        self.set_paused(study, false)
    }

    fn set_paused(&mut self, study: &str, paused: bool) -> Result<()> {
        self.study(study)?;
        store::lightly(self.writer()?, |transaction| {
            transaction.execute("UPDATE study SET paused = ? WHERE name = ?", (paused, study))?;
            Ok(())
        })
    }
}

/// Why a job cannot be retried, for messages.
#[must_use]
pub fn why_no_retry(status: Status) -> Option<&'static str> {
    match status {
        Status::Failed | Status::Cancelled => None,
        Status::Queued => Some("it waits already"),
        Status::Running => Some("it is running"),
        Status::Done => Some("it has a result, and the same inputs give the same result"),
        Status::NotConverged => Some("the same inputs give the same result; change an input, such as the edge length"),
    }
}

//! Actions of a user on the queue: cancel, retry, priority, pause.

use store::queue::{self, Event};
use store::{JobId, Result, Status, Store, read};

/// Cancels queued or running jobs; returns how many it cancelled.
pub fn cancel(store: &mut Store, ids: &[JobId]) -> Result<usize> {
    change(store, ids, &Event::Cancel, "cancelled")
}

/// Queues failed or cancelled jobs again, with the jobs whose results they need; returns the number of jobs queued. A
/// job that has a result keeps it.
pub fn retry(store: &mut Store, ids: &[JobId]) -> Result<usize> {
    let mut all = ids.to_vec();
    let mut next = 0;
    while let Some(&id) = all.get(next) {
        let needed = queue::needs(&store.reader, id)?;
        all.extend(needed.into_iter().filter(|needed| !all.contains(needed)).collect::<Vec<_>>());
        next += 1;
    }
    change(store, &all, &Event::Retry, "queued again")
}

/// Works in one transaction. Returns the number of jobs that the event applied to.
fn change(store: &mut Store, ids: &[JobId], event: &Event<'_>, done: &str) -> Result<usize> {
    store::lightly(store.writer()?, |transaction| {
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

/// A job of greater priority runs earlier.
pub fn set_priority(store: &mut Store, ids: &[JobId], priority: i64) -> Result<()> {
    store::lightly(store.writer()?, |transaction| {
        let mut statement = transaction.prepare_cached("UPDATE job SET priority = ? WHERE job_id = ?")?;
        for id in ids {
            statement.execute((priority, id.0))?;
        }
        Ok(())
    })
}

/// Running jobs go on, and no other starts.
pub fn pause(store: &mut Store, study: &str) -> Result<()> {
    set_paused(store, study, true)
}

pub fn resume(store: &mut Store, study: &str) -> Result<()> {
    set_paused(store, study, false)
}

fn set_paused(store: &mut Store, study: &str, paused: bool) -> Result<()> {
    read::study(store, study)?;
    store::lightly(store.writer()?, |transaction| {
        transaction.execute("UPDATE study SET paused = ? WHERE name = ?", (paused, study))?;
        Ok(())
    })
}

/// `None` where the job can be retried.
pub fn why_no_retry(status: Status) -> Option<&'static str> {
    match status {
        Status::Failed | Status::Cancelled => None,
        Status::Queued => Some("it waits already"),
        Status::Running => Some("it is running"),
        Status::Done => Some("it has a result, and the same inputs give the same result"),
        Status::NotConverged => Some("the same inputs give the same result; change an input, such as the edge length"),
    }
}

//! The job queue: a pure transition `(state, event) -> state`, and its application to the database.
//!
//! A running job has an owner (a run of a process) that renews its heartbeat. A report of the owner is accepted
//! only while it still is the owner. A job that was taken over or cancelled meanwhile is thus never finished twice.

use std::fmt;

use rusqlite::{Connection, OptionalExtension, Transaction, named_params};

use crate::columns::status;
use crate::database::Store;
use crate::error::{Result, StudyError};
use crate::owner::{self, Owner, Runner, Watch};
use crate::rows::{JobId, Status};
use crate::transaction::{lightly, now_ms};

/// Number of lost processes after which a job fails, since the job itself might be what ends them.
const MAX_LOST: u32 = 10;

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct State {
    pub status: Status,
    pub attempts: u32,
    /// Run that works on the job; `Some` exactly while the job runs.
    pub owner: Option<String>,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Event<'a> {
    /// Worker of the named run takes the job.
    Claim(&'a str),
    Finish {
        owner: &'a str,
        /// True where the cloth came to rest.
        converged: bool,
    },
    /// The owner, by name, met an error.
    Fail(&'a str),
    /// The owner, by name, stops before the end.
    Release(&'a str),
    /// The owner is dead.
    Lose,
    Cancel,
    Retry,
}

/// `None` where the event does not apply.
pub fn next(state: &State, event: &Event<'_>) -> Option<State> {
    use Status::{Cancelled, Done, Failed, NotConverged, Queued, Running};
    let ended = |status| Some(State { status, owner: None, ..state.clone() });
    let owned_by = |owner: &str| state.status == Running && state.owner.as_deref() == Some(owner);
    match *event {
        Event::Claim(owner) if state.status == Queued => {
            Some(State { status: Running, attempts: state.attempts + 1, owner: Some(owner.to_owned()) })
        }
        Event::Finish { owner, converged } if owned_by(owner) => ended(if converged { Done } else { NotConverged }),
        Event::Fail(owner) if owned_by(owner) => ended(Failed),
        Event::Release(owner) if owned_by(owner) => {
            Some(State { status: Queued, attempts: state.attempts.saturating_sub(1), owner: None })
        }
        Event::Lose if state.status == Running => ended(if state.attempts >= MAX_LOST { Failed } else { Queued }),
        Event::Cancel if !state.status.is_final() => ended(Cancelled),
        Event::Retry if matches!(state.status, Failed | Cancelled) => {
            Some(State { status: Queued, attempts: 0, owner: None })
        }
        _ => None,
    }
}

/// Returns the new state. Where the event does not apply, returns `None` and changes nothing.
pub fn apply(
    transaction: &Transaction<'_>,
    id: JobId,
    event: &Event<'_>,
    error: Option<&str>,
) -> Result<Option<State>> {
    let Some(after) = next(&load(transaction, id)?, event) else { return Ok(None) };
    transaction
        .prepare_cached(
            "UPDATE job SET status = :status, attempts = :attempts, owner = :owner, error = :error,
                heartbeat_at = CASE WHEN :status = 'running' THEN :now END,
                started_at = CASE WHEN :status = 'running' THEN :now WHEN :status = 'queued' THEN NULL ELSE started_at END,
                finished_at = CASE WHEN :status IN ('running', 'queued') THEN NULL ELSE :now END,
                wall_ms = CASE WHEN :status IN ('running', 'queued') THEN NULL ELSE max(0, :now - started_at) END
            WHERE job_id = :id",
        )?
        .execute(named_params! {
            ":id": id.0, ":status": after.status.as_str(), ":attempts": after.attempts, ":owner": after.owner,
            ":error": error, ":now": now_ms(),
        })?;
    if after.status != Status::Running {
        transaction.prepare_cached("DELETE FROM job_progress WHERE job_id = ?")?.execute([id.0])?;
    }
    if matches!(after.status, Status::Failed | Status::Cancelled) {
        cancel_dependents(transaction, id, after.status)?;
    }
    Ok(Some(after))
}

/// Cancels the queued jobs that wait for the result of a job that ended without one.
fn cancel_dependents(transaction: &Transaction<'_>, id: JobId, status: Status) -> Result<()> {
    let sql = "SELECT job_id FROM job_need JOIN job USING (job_id) WHERE needs = ? AND status = 'queued'";
    let mut statement = transaction.prepare_cached(sql)?;
    let waiting = statement.query_map([id.0], |row| row.get(0).map(JobId))?.collect::<rusqlite::Result<Vec<_>>>()?;
    for job in waiting {
        let text = format!("job {id}, which it waits for, is {}", status.as_str());
        if apply(transaction, job, &Event::Cancel, Some(&text))?.is_some() {
            log(transaction, job, "warn", &text)?;
        }
    }
    Ok(())
}

/// Sets the jobs whose results a job waits for, replacing those set before.
pub fn set_needs(transaction: &Transaction<'_>, id: JobId, needs: &[JobId]) -> Result<()> {
    transaction.prepare_cached("DELETE FROM job_need WHERE job_id = ?")?.execute([id.0])?;
    let mut statement = transaction.prepare_cached("INSERT INTO job_need (job_id, needs) VALUES (?, ?)")?;
    for needed in needs {
        statement.execute((id.0, needed.0))?;
    }
    Ok(())
}

fn load(connection: &Connection, id: JobId) -> Result<State> {
    let state = connection
        .prepare_cached("SELECT status, attempts, owner FROM job WHERE job_id = ?")?
        .query_row([id.0], |row| Ok(State { status: status(row, 0)?, attempts: row.get(1)?, owner: row.get(2)? }))
        .optional()?;
    state.ok_or_else(|| StudyError::NotFound { what: "job", name: id.to_string(), known: vec![] })
}

pub fn needs(connection: &Connection, id: JobId) -> Result<Vec<JobId>> {
    let mut statement = connection.prepare_cached("SELECT needs FROM job_need WHERE job_id = ? ORDER BY needs")?;
    let needs = statement.query_map([id.0], |row| row.get(0).map(JobId))?.collect::<rusqlite::Result<_>>()?;
    Ok(needs)
}

/// Names the jobs that this connection works on; [`claim`] and [`is_open`] see no others. A temporary table holds them,
/// since ten thousand are found faster there than in a list that goes with every query.
pub fn want(connection: &Connection, ids: &[JobId]) -> Result<()> {
    connection.execute_batch("CREATE TEMP TABLE wanted (job_id INTEGER PRIMARY KEY) STRICT")?;
    let all = serde_json::Value::from_iter(ids.iter().map(|id| id.0)).to_string();
    connection.execute("INSERT INTO wanted SELECT value FROM json_each(?)", [all])?;
    Ok(())
}

/// Takes the next job for `owner`: among those of [`want`] that are queued and wait for no other job, the one of
/// greatest priority, and at equal priority the one queued first.
pub fn claim(transaction: &Transaction<'_>, owner: &Owner, watch: &mut Watch) -> Result<Option<JobId>> {
    take_over(transaction, watch)?;
    let next = transaction
        .prepare_cached(
            "SELECT job_id FROM job
            WHERE status = 'queued' AND is_current AND job_id IN wanted
                AND (SELECT NOT paused FROM study WHERE study.study_id = job.study_id)
                AND NOT EXISTS (
                    SELECT 1 FROM job_need JOIN job AS needed ON needed.job_id = needs
                    WHERE job_need.job_id = job.job_id AND needed.status IN ('queued', 'running'))
            ORDER BY priority DESC, job_id LIMIT 1",
        )?
        .query_row([], |row| row.get(0).map(JobId))
        .optional()?;
    if let Some(id) = next {
        apply(transaction, id, &Event::Claim(owner.as_str()), None)?;
        log(transaction, id, "info", &format!("started by {owner}"))?;
    }
    Ok(next)
}

/// Running jobs of dead owners, with these owners.
fn lost(connection: &Connection, watch: &mut Watch) -> Result<Vec<(JobId, String)>> {
    let running: Vec<(JobId, String, i64)> = connection
        .prepare_cached("SELECT job_id, owner, heartbeat_at FROM job WHERE status = 'running'")?
        .query_map([], |row| Ok((JobId(row.get(0)?), row.get(1)?, row.get(2)?)))?
        .collect::<rusqlite::Result<_>>()?;
    let is_lost = |(id, owner, heartbeat): &(JobId, String, i64)| {
        owner::is_dead(owner).unwrap_or_else(|| watch.stands_still(*id, *heartbeat))
    };
    Ok(running.into_iter().filter(is_lost).map(|(id, owner, _)| (id, owner)).collect())
}

/// Puts jobs of dead owners back into the queue. Returns their number.
pub fn take_over(transaction: &Transaction<'_>, watch: &mut Watch) -> Result<usize> {
    let lost = lost(transaction, watch)?;
    for (id, owner) in &lost {
        let message = format!("{} ended before the job did", owner::describe(owner));
        if let Some(after) = apply(transaction, *id, &Event::Lose, Some(&message))? {
            let text =
                format!("{message}; {}", if after.status == Status::Failed { "given up" } else { "queued again" });
            log(transaction, *id, "warn", &text)?;
        }
    }
    Ok(lost.len())
}

/// Does as [`take_over`], but takes the lock for writing only where there are such jobs. Returns 0 where the database
/// is open for reading only.
pub fn recover(store: &mut Store, watch: &mut Watch) -> Result<usize> {
    if store.is_readonly() || lost(&store.reader, watch)?.is_empty() {
        return Ok(0);
    }
    lightly(store.writer()?, |transaction| take_over(transaction, watch))
}

/// A job that is stored as running and whose process has ended.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Interrupted {
    pub job: JobId,
    /// The process in words, with its machine.
    pub process: String,
}

impl fmt::Display for Interrupted {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "interrupted: {} ended before the job did", self.process)
    }
}

/// Jobs whose process has ended: [`recover`] puts them back into the queue, where the database may be written. Of
/// another machine's process nobody can tell at once.
pub fn interrupted(store: &Store) -> Result<Vec<Interrupted>> {
    let lost = lost(&store.reader, &mut Watch::default())?.into_iter();
    Ok(lost.map(|(job, owner)| Interrupted { job, process: owner::describe(&owner) }).collect())
}

pub fn runners(store: &Store, study: &str) -> Result<Vec<Runner>> {
    let sql = "SELECT owner, count(*) FROM job JOIN study USING (study_id)
        WHERE study.name = ? AND status = 'running' GROUP BY owner ORDER BY owner";
    let mut statement = store.reader.prepare_cached(sql)?;
    let rows = statement
        .query_map([study], |row| Ok(Runner::new(&row.get::<_, String>(0)?, row.get::<_, i64>(1)? as usize)))?;
    Ok(rows.collect::<rusqlite::Result<_>>()?)
}

/// True if one of the jobs of [`want`] is queued or runs in any process, so that a worker may still get it.
pub fn is_open(connection: &Connection) -> Result<bool> {
    let sql = "SELECT EXISTS (
        SELECT 1 FROM job WHERE status IN ('queued', 'running') AND is_current AND job_id IN wanted)";
    Ok(connection.prepare_cached(sql)?.query_row([], |row| row.get(0))?)
}

pub fn log(connection: &Connection, id: JobId, level: &str, text: &str) -> Result<()> {
    let sql = "INSERT INTO job_log (job_id, at, level, text) VALUES (?, ?, ?, ?)";
    connection.prepare_cached(sql)?.execute((id.0, now_ms(), level, text))?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn event() -> impl Strategy<Value = Event<'static>> {
        let owner = prop_oneof![Just("a"), Just("b")];
        prop_oneof![
            owner.clone().prop_map(Event::Claim),
            (owner.clone(), any::<bool>()).prop_map(|(owner, converged)| Event::Finish { owner, converged }),
            owner.clone().prop_map(Event::Fail),
            owner.prop_map(Event::Release),
            Just(Event::Lose),
            Just(Event::Cancel),
            Just(Event::Retry),
        ]
    }

    proptest! {
        #[test]
        fn whatever_happens_a_job_has_an_owner_exactly_while_it_runs(events in prop::collection::vec(event(), 0..60)) {
            let mut state = State { status: Status::Queued, attempts: 0, owner: None };
            let mut lost = 0;
            for event in &events {
                let Some(after) = next(&state, event) else { continue };
                prop_assert_eq!(after.status == Status::Running, after.owner.is_some());
                prop_assert!(!state.status.has_result(), "a result was given up by {:?}", event);
                match *event {
                    Event::Finish { owner, .. } | Event::Fail(owner) | Event::Release(owner) => {
                        prop_assert_eq!(state.owner.as_deref(), Some(owner), "only the owner may report");
                    }
                    Event::Claim(_) => prop_assert_eq!(state.status, Status::Queued, "claimed once"),
                    Event::Lose => lost += 1,
                    Event::Retry => lost = 0,
                    Event::Cancel => {}
                }
                prop_assert!(lost <= MAX_LOST, "a job that kills its processes is given up");
                state = after;
            }
        }
    }

    #[test]
    fn a_job_that_is_lost_too_often_is_failed() {
        let mut state = State { status: Status::Queued, attempts: 0, owner: None };
        for _ in 0..MAX_LOST {
            assert_eq!(state.status, Status::Queued);
            state = next(&state, &Event::Claim("a")).expect("queued");
            state = next(&state, &Event::Lose).expect("running");
        }
        assert_eq!(state.status, Status::Failed);
        assert_eq!(next(&state, &Event::Retry).expect("failed").attempts, 0);
    }
}

//! Worker threads that claim, run and finish jobs, and one thread (the pump) that writes their progress to the
//! database.
//!
//! Workers touch the database only to claim and to finish. The pump renews heartbeats and progress a few times a
//! second. It also notices a job that this process no longer holds, so that another process can cancel a running
//! simulation. Results do not depend on the number of workers: no job sees another.

use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use rusqlite::{Connection, named_params};

use crate::enqueue::Planned;
use crate::error::EngineError;
use crate::outcome::{self, Executor, Outcome, Provenance};
use geom::V3;
use geom::units::mm;
use sim::{Monitor, Progress};
use spec::{Cell, JobSpec, Study};
use store::owner::{Owner, Watch};
use store::{Access, JobId, JobProgress, Live as LiveView, Result, StudyError, evidence, now_ms, queue};

/// Time between two rounds of the pump, and between two tries of a worker to claim a job.
const TICK: Duration = Duration::from_millis(200);

#[derive(Default)]
struct Live {
    progress: Mutex<Option<JobProgress>>,
    /// Set when this process no longer holds the job.
    lost: AtomicBool,
}

/// Least time between two judgements of the evidence while results come, divided by the time that one takes: judging
/// takes less than 5 % of a run.
const JUDGED_SHARE: u32 = 20;

struct Run<'a> {
    database: &'a Path,
    study: &'a Study,
    cells: BTreeMap<JobId, Cell>,
    ids: Vec<JobId>,
    executor: &'a dyn Executor,
    owner: Owner,
    provenance: Provenance,
    stop: &'a AtomicBool,
    view: &'a LiveView,
    watch: Mutex<Watch>,
    live: Mutex<BTreeMap<JobId, Arc<Live>>>,
    busy_workers: AtomicUsize,
    /// True if a job has ended since the evidence was last judged.
    has_news: AtomicBool,
}

pub(crate) struct Work<'a> {
    pub study: &'a Study,
    /// Jobs in the order of the study's cells.
    pub jobs: &'a [Planned],
}

/// Runs jobs until none is queued or running, those of other processes included, or until `stop`, which puts running
/// jobs back into the queue. A job that fails is no error.
pub(crate) fn run(
    database: &Path,
    work: &Work,
    executor: &dyn Executor,
    workers: usize,
    provenance: Provenance,
    stop: &AtomicBool,
    view: &LiveView,
) -> Result<()> {
    let run = Run {
        database,
        study: work.study,
        cells: work.jobs.iter().map(|job| (job.id, job.cell)).collect(),
        ids: work.jobs.iter().map(|job| job.id).collect(),
        executor,
        owner: Owner::new(),
        provenance,
        stop,
        view,
        watch: Mutex::default(),
        live: Mutex::default(),
        busy_workers: AtomicUsize::new(workers.max(1)),
        has_news: AtomicBool::default(),
    };
    thread::scope(|scope| {
        let handles: Vec<_> = (0..workers.max(1)).map(|_| scope.spawn(|| run.work())).collect();
        let pumped = run.pump();
        if pumped.is_err() {
            run.stop.store(true, Ordering::Relaxed);
        }
        let worked = handles.into_iter().map(|handle| match handle.join() {
            Ok(result) => result,
            Err(panic) => std::panic::resume_unwind(panic),
        });
        worked.fold(pumped, Result::and)
    })?;
    evidence::update(&mut store::open(database, Access::Volatile)?, &work.study.name)
}

impl Run<'_> {
    /// Claims and runs jobs until none is left. An error of the database stops the other workers too.
    fn work(&self) -> Result<()> {
        let result = store::open(self.database, Access::Write).and_then(|mut connection| self.work_on(&mut connection));
        if result.is_err() {
            self.stop.store(true, Ordering::Relaxed);
        }
        self.busy_workers.fetch_sub(1, Ordering::Release);
        result
    }

    fn work_on(&self, connection: &mut Connection) -> Result<()> {
        queue::want(connection, &self.ids)?;
        while !self.stop.load(Ordering::Relaxed) {
            let (claimed, is_open) = store::lightly(connection, |transaction| {
                let claimed = queue::claim(transaction, &self.owner, &mut lock(&self.watch))?;
                Ok((claimed, claimed.is_some() || queue::is_open(transaction)?))
            })?;
            match claimed {
                Some(id) => self.execute(connection, id)?,
                None if is_open => thread::sleep(TICK),
                None => break,
            }
        }
        Ok(())
    }

    /// Runs one claimed job and stores its outcome. A panic of a stage fails the job. An error of the database does
    /// not: the job goes back into the queue, if that can still be written, and the run ends.
    fn execute(&self, connection: &mut Connection, id: JobId) -> Result<()> {
        let live = Arc::new(Live::default());
        lock(&self.live).insert(id, live.clone());
        let mut reporter = Reporter { id, live: &live, view: self.view, stop: self.stop };
        let spec = self.cells[&id].job(self.study);
        let result = catch_unwind(AssertUnwindSafe(|| self.executor.execute(&spec, &mut reporter)))
            .unwrap_or_else(|panic| Err(EngineError::Panic(panic_text(&*panic)).into()));
        let written = match result {
            Err(error @ (StudyError::Database(_) | StudyError::Open { .. })) => {
                // If this fails too, the next run puts the job back, since this owner is dead.
                let _ = self.finish(connection, id, &spec, &Err(StudyError::Interrupted));
                Err(error)
            }
            result => self.finish(connection, id, &spec, &result),
        };
        lock(&self.live).remove(&id);
        self.has_news.store(true, Ordering::Relaxed);
        written
    }

    /// A result that the schema refuses, for example with a NaN, fails the job.
    fn finish(&self, connection: &mut Connection, id: JobId, spec: &JobSpec, result: &Result<Outcome>) -> Result<()> {
        let owner = self.owner.as_str();
        match outcome::finish(connection, id, spec, owner, result, &self.provenance) {
            Err(StudyError::Database(error)) if result.is_ok() && is_constraint(&error) => {
                let failure = Err(EngineError::Unstorable(error).into());
                outcome::finish(connection, id, spec, owner, &failure, &self.provenance).map(drop)
            }
            written => written.map(drop),
        }
    }

    /// Writes the progress of running jobs to the database until the workers are done.
    fn pump(&self) -> Result<()> {
        let mut connection = store::open(self.database, Access::Volatile)?;
        let mut next_judged = Instant::now();
        while self.busy_workers.load(Ordering::Acquire) > 0 {
            thread::sleep(TICK);
            store::still_there(self.database)?;
            let live: Vec<(JobId, Arc<Live>)> = lock(&self.live).iter().map(|(id, live)| (*id, live.clone())).collect();
            if !live.is_empty() {
                self.report(&mut connection, &live)?;
            }
            let began = Instant::now();
            if began > next_judged && self.has_news.swap(false, Ordering::Relaxed) {
                evidence::update(&mut connection, &self.study.name)?;
                next_judged = Instant::now() + JUDGED_SHARE * began.elapsed();
            }
        }
        Ok(())
    }

    fn report(&self, connection: &mut Connection, live: &[(JobId, Arc<Live>)]) -> Result<()> {
        let transaction = store::write(connection)?;
        for (id, live) in live {
            let ours = transaction
                .prepare_cached(
                    "UPDATE job SET heartbeat_at = ? WHERE job_id = ? AND status = 'running' AND owner = ?",
                )?
                .execute((now_ms(), id.0, self.owner.as_str()))?;
            if ours == 0 {
                live.lost.store(true, Ordering::Relaxed);
            } else if let Some(progress) = lock(&live.progress).take() {
                write_progress(&transaction, *id, &progress)?;
            }
        }
        Ok(transaction.commit()?)
    }
}

/// True if SQLite refused a value, false if it failed to write.
fn is_constraint(error: &rusqlite::Error) -> bool {
    error.sqlite_error_code() == Some(rusqlite::ErrorCode::ConstraintViolation)
}

fn write_progress(connection: &Connection, id: JobId, progress: &JobProgress) -> Result<()> {
    let step = &progress.step;
    connection
        .prepare_cached(
            "INSERT OR REPLACE INTO job_progress (job_id, phase, fraction, iteration, level, residual, seam_gap_mm, e_chi,
                updated_at)
            VALUES (:id, :phase, :fraction, :iteration, :level, :residual, :gap, :e_chi, :now)",
        )?
        .execute(named_params! {
            ":id": id.0, ":phase": progress.phase, ":fraction": progress.fraction, ":iteration": step.iteration,
            ":level": step.level, ":residual": step.residual, ":gap": mm(step.seam_gap_m), ":e_chi": step.e_chi,
            ":now": now_ms(),
        })?;
    Ok(())
}

struct Reporter<'a> {
    id: JobId,
    live: &'a Live,
    view: &'a LiveView,
    stop: &'a AtomicBool,
}

impl Monitor for Reporter<'_> {
    fn progress(&mut self, progress: &Progress) {
        *lock(&self.live.progress) = Some(progress.into());
    }

    fn cancelled(&self) -> bool {
        self.stop.load(Ordering::Relaxed) || self.live.lost.load(Ordering::Relaxed)
    }

    fn wants_snapshot(&mut self) -> bool {
        self.view.wants(self.id)
    }

    fn snapshot(&mut self, positions: &[V3]) {
        self.view.show(self.id, positions);
    }
}

/// Locks a mutex. Its data is a plain value, so it is whole even after a panic of another thread.
fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

fn panic_text(panic: &(dyn std::any::Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
    text.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_else(|| "a panic without a message".into())
}

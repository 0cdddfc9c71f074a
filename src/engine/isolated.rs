//! Jobs with limits, each in a process of its own, so that other jobs of the run are not affected. The system enforces
//! the memory limit; this process kills a job whose time is over.

use std::io::{BufRead, BufReader, Read};
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::Duration;

use crate::error::EngineError;
use crate::job_files;
use crate::outcome::{Executor, Outcome};
use crate::own_process::{Clock, Line};
use crate::pipeline::Pipeline;
use sim::{Monitor, Progress};
use spec::{JobSpec, Limits};
use store::{Result, StudyError};

/// Time between two checks of a job's process.
const LOOK: Duration = Duration::from_millis(50);
/// Parts of messages that report a failed allocation.
const NO_MEMORY: [&str; 3] = ["memory allocation of", "out of memory", "Cannot allocate memory"];

/// Executor that gives jobs with limits a process of their own, and runs all others in this one.
pub(crate) struct Isolated {
    database: PathBuf,
    pipeline: std::sync::Arc<Pipeline>,
}

impl Isolated {
    pub fn new(database: &Path, pipeline: std::sync::Arc<Pipeline>) -> Self {
        Self { database: database.to_owned(), pipeline }
    }
}

impl Executor for Isolated {
    fn execute(&self, spec: &JobSpec, monitor: &mut dyn Monitor) -> Result<Outcome> {
        if !spec.schedule.limits.is_some() {
            return self.pipeline.execute(spec, monitor);
        }
        let folder = tempfile::tempdir().map_err(StudyError::io(std::env::temp_dir()))?;
        let [job, result] = ["job.json", "result.json"].map(|name| folder.path().join(name));
        job_files::write_job(&job, spec)?;
        let limits = spec.schedule.limits;
        let exit = watch(start(&job, &result, &self.database)?, &limits, monitor)?;
        if !result.exists() {
            return Err(exit.error(&limits).into());
        }
        job_files::read_outcome(&result)
            .map_err(|error| out_of_memory(&error.to_string(), &limits).map_or(error, StudyError::from))
    }
}

/// Starts this program on a job file, in a process group of its own so that the terminal's signals reach only the run.
fn start(job: &Path, result: &Path, database: &Path) -> Result<Child> {
    let program = std::env::current_exe().map_err(StudyError::io("toile"))?;
    let mut command = Command::new(&program);
    command.args(["job", "run"]).arg(job).arg("--output").arg(result).arg("--database").arg(database);
    command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped()).process_group(0);
    command.spawn().map_err(StudyError::io(program))
}

/// Kills the process when its time is over or the run is cancelled. Returns exit status and standard error.
fn watch(mut child: Child, limits: &Limits, monitor: &mut dyn Monitor) -> Result<Exit> {
    let (out, mut errors) = (child.stdout.take(), child.stderr.take());
    let latest: Mutex<Option<Progress>> = Mutex::new(None);
    let latest = &latest;
    thread::scope(|scope| {
        scope.spawn(move || {
            for line in out.into_iter().flat_map(|out| BufReader::new(out).lines()).map_while(std::io::Result::ok) {
                if let Some(progress) = Line::read(&line) {
                    *latest.lock().unwrap_or_else(PoisonError::into_inner) = Some(progress);
                }
            }
        });
        let said = scope.spawn(move || {
            let mut bytes = Vec::new();
            // Text before a broken pipe is kept.
            let _ = errors.as_mut().map(|errors| errors.read_to_end(&mut bytes));
            String::from_utf8_lossy(&bytes).into_owned()
        });
        let clock = Clock::start(limits);
        let ended = loop {
            match child.try_wait() {
                Ok(None) => {}
                Ok(Some(status)) => break Ok(status),
                Err(error) => break Err(StudyError::io("toile job run")(error)),
            }
            if clock.is_over() {
                break Err(clock.error().into());
            }
            if monitor.cancelled() {
                break Err(StudyError::Interrupted);
            }
            if let Some(progress) = latest.lock().unwrap_or_else(PoisonError::into_inner).take() {
                monitor.progress(&progress);
            }
            thread::sleep(LOOK);
        };
        if ended.is_err() {
            // Fails where the process has just ended, which is fine.
            let _ = child.kill();
            let _ = child.wait();
        }
        Ok(Exit { status: ended?, said: said.join().unwrap_or_default() })
    })
}

struct Exit {
    status: ExitStatus,
    /// Standard error.
    said: String,
}

impl Exit {
    fn error(&self, limits: &Limits) -> EngineError {
        let Self { status, said } = self;
        let last = said.lines().rfind(|line| !line.trim().is_empty()).unwrap_or("it said nothing");
        let other = || EngineError::ProcessEnded { status: *status, last_line: last.to_owned() };
        out_of_memory(said, limits).unwrap_or_else(other)
    }
}

fn out_of_memory(said: &str, limits: &Limits) -> Option<EngineError> {
    let megabytes = limits.memory_mb.filter(|_| NO_MEMORY.iter().any(|words| said.contains(words)))?;
    Some(EngineError::OutOfMemory { megabytes })
}

#[cfg(test)]
mod tests {
    use std::os::unix::process::ExitStatusExt;

    use super::*;

    #[test]
    fn an_end_is_put_down_to_memory_where_memory_was_not_given() {
        let check = |code: i32, said: &str, memory_mb: Option<u32>, expect: &str| {
            let exit = Exit { status: ExitStatus::from_raw(code), said: said.to_owned() };
            let error = exit.error(&Limits { memory_mb, time_s: None });
            assert_eq!(StudyError::from(error).to_string(), expect);
        };
        let aborted = "memory allocation of 4096 bytes failed\n";
        check(6, aborted, Some(80), "limit: needed more than its memory limit of 80 MB");
        check(
            6,
            aborted,
            None,
            "job: its process ended with signal: 6 (SIGABRT): memory allocation of 4096 bytes failed",
        );
        check(9, "", Some(80), "job: its process ended with signal: 9 (SIGKILL): it said nothing");
    }
}

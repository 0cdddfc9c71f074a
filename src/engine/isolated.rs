//! Jobs with limits, each in a process of its own: the system keeps it to its memory, and it is ended when its time is
//! over, whatever it is doing. Other jobs of the run do not notice.

use std::io::{BufRead, BufReader, Read};
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use rustix::process::{Resource, Rlimit, Signal, set_parent_process_death_signal, setrlimit};
use serde::{Deserialize, Serialize};

use crate::handout;
use crate::outcome::{Executor, Outcome};
use crate::pipeline::Pipeline;
use sim::{Monitor, Progress, Step};
use spec::{JobSpec, Limits};
use store::{Result, StudyError};

/// Time between two looks at a process.
const LOOK: Duration = Duration::from_millis(50);
/// Time between two lines in which a process says how far it is.
const LINES: Duration = Duration::from_millis(200);
/// What simulators call their phases.
const PHASES: [&str; 4] = ["sew", "popup", "settle", "drape"];
/// What is said where memory is not given.
const NO_MEMORY: [&str; 3] = ["memory allocation of", "out of memory", "Cannot allocate memory"];

/// The pipeline of a database; jobs with limits run apart.
pub(crate) struct Isolated {
    database: PathBuf,
    pipeline: std::sync::Arc<Pipeline>,
}

impl Isolated {
    /// Over the pipeline of a database.
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
        handout::write_job(&job, spec)?;
        let limits = spec.schedule.limits;
        let (status, said) = watch(start(&job, &result, &self.database)?, &limits, monitor)?;
        if !result.exists() {
            return Err(ended(status, &said, &limits));
        }
        handout::read_outcome(&result).map_err(|error| out_of_memory(&error.to_string(), &limits).unwrap_or(error))
    }
}

/// Starts this program on a job file. In a group of its own: what a terminal sends is for the run.
fn start(job: &Path, result: &Path, database: &Path) -> Result<Child> {
    let program = std::env::current_exe().map_err(StudyError::io("toile"))?;
    let mut command = Command::new(&program);
    command.args(["job", "run"]).arg(job).arg("--output").arg(result).arg("--database").arg(database);
    command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped()).process_group(0);
    command.spawn().map_err(StudyError::io(program))
}

/// Follows a process to its end, and makes that end when its time is over or the run does not want it any more; how it
/// ended, and what it said on standard error.
fn watch(mut child: Child, limits: &Limits, monitor: &mut dyn Monitor) -> Result<(ExitStatus, String)> {
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
            // What it said before the pipe broke is all there is.
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
                break Err(clock.error());
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
            // It may have ended just now.
            let _ = child.kill();
            let _ = child.wait();
        }
        Ok((ended?, said.join().unwrap_or_default()))
    })
}

/// Why a process left no result.
fn ended(status: ExitStatus, said: &str, limits: &Limits) -> StudyError {
    let last = said.lines().rfind(|line| !line.trim().is_empty()).unwrap_or("it said nothing");
    let other = || StudyError::stage("job")(format!("its process ended with {status}: {last}"));
    out_of_memory(said, limits).unwrap_or_else(other)
}

/// The error of a job with a memory limit that says in some words that it got no more.
fn out_of_memory(said: &str, limits: &Limits) -> Option<StudyError> {
    let megabytes = limits.memory_mb.filter(|_| NO_MEMORY.iter().any(|words| said.contains(words)))?;
    Some(StudyError::stage("limit")(format!("needed more than its memory limit of {megabytes} MB")))
}

/// Time that a job may take.
pub(crate) struct Clock {
    began: Instant,
    limit_s: Option<f64>,
}

impl Clock {
    /// Starts the clock of a job.
    pub fn start(limits: &Limits) -> Self {
        Self { began: Instant::now(), limit_s: limits.time_s }
    }

    /// Whether it has taken longer.
    pub fn is_over(&self) -> bool {
        self.limit_s.is_some_and(|limit_s| self.began.elapsed().as_secs_f64() > limit_s)
    }

    /// The error of a job that has.
    pub fn error(&self) -> StudyError {
        StudyError::stage("limit")(format!("took longer than its time limit of {} s", self.limit_s.unwrap_or_default()))
    }
}

/// Keeps this process to a memory limit.
///
/// # Errors
/// When the system refuses.
pub(crate) fn keep_to(limits: &Limits) -> Result<()> {
    let Some(megabytes) = limits.memory_mb else { return Ok(()) };
    let most = Some(u64::from(megabytes) * 1_000_000);
    setrlimit(Resource::Data, Rlimit { current: most, maximum: most })
        .map_err(|error| StudyError::stage("limit")(format!("memory_limit_mb = {megabytes}: {error}")))
}

/// Ends this process with the one that started it.
pub(crate) fn end_with_parent() {
    // Where the system cannot, it ends with its job.
    let _ = set_parent_process_death_signal(Some(Signal::KILL));
}

/// The monitor of a job in a process of its own: its time, and lines for whoever started it.
pub(crate) struct Teller {
    pub clock: Clock,
    /// Whether somebody reads the lines.
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
            // Nobody may listen any more.
            let _ = std::io::Write::write_all(&mut std::io::stdout().lock(), format!("{line}\n").as_bytes());
        }
    }

    fn cancelled(&self) -> bool {
        self.clock.is_over()
    }
}

/// How far a job is, as one line.
#[derive(Serialize, Deserialize)]
struct Line {
    phase: String,
    fraction: f64,
    step: Step,
}

impl Line {
    /// What a line says; `None` for any other line.
    fn read(text: &str) -> Option<Progress> {
        let Self { phase, fraction, step } = serde_json::from_str(text).ok()?;
        let phase = PHASES.into_iter().find(|known| *known == phase).unwrap_or("works");
        Some(Progress { phase, fraction, step })
    }
}

#[cfg(test)]
mod tests {
    use std::os::unix::process::ExitStatusExt;

    use super::*;

    #[test]
    fn an_end_is_put_down_to_memory_where_memory_was_not_given() {
        let check = |code: i32, said: &str, memory_mb: Option<u32>, expect: &str| {
            let error = ended(ExitStatus::from_raw(code), said, &Limits { memory_mb, time_s: None });
            assert_eq!(error.to_string(), expect);
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

    #[test]
    fn lines_of_progress_are_read_and_others_are_not() {
        let step = Step { iteration: 3, level: 1, residual: 0.25, seam_gap_m: 0.0, e_chi: 1.0 };
        let line = serde_json::to_string(&Line { phase: "settle".into(), fraction: 0.5, step }).expect("finite");
        assert_eq!(Line::read(&line), Some(Progress { phase: "settle", fraction: 0.5, step }));
        assert_eq!(Line::read("jobs/1.result.json"), None);
    }
}

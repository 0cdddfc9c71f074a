//! Runs in the background: a run that outlives its terminal, and progress of a run as another terminal sees it.

use std::collections::BTreeSet;
use std::ffi::OsString;
use std::fs::OpenOptions;
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use signal_hook::consts::SIGINT;

use super::context::Context;
use super::progress::{self, Progress};
use super::{End, Outcome, output};
use engine::Ending;
use store::{JobFilter, JobId, JobRow, Status, Store, StudyError, files, read};

const LOOK: Duration = Duration::from_millis(250);
/// Number of checks without a running job after which no process works on the study. A starting process needs a few.
const PATIENCE: u32 = 60;

/// Starts this command again without `--detach`, in a process group of its own, with its output in a file.
pub fn start(context: &Context, study: &str) -> Outcome {
    spawn(context, study, std::env::args_os().skip(1).filter(|argument| argument != "--detach").collect())
}

/// Goes on with the run of a study that the workbench began.
pub fn go_on(context: &Context, path: &Path) -> Outcome {
    let study = context.study_name(&context.store()?, path)?;
    let arguments = ["--db".as_ref(), context.db.as_os_str(), "run".as_ref(), path.as_os_str(), "--no-report".as_ref()];
    spawn(context, &study, arguments.map(ToOwned::to_owned).to_vec())
}

/// Starts this program in a process group of its own, with its output in a file.
fn spawn(context: &Context, study: &str, arguments: Vec<OsString>) -> Outcome {
    let log = log_file(&context.db, study);
    let io = |path: &Path| StudyError::io(path.to_owned());
    let out = OpenOptions::new().create(true).append(true).open(&log).map_err(io(&log))?;
    let errors = out.try_clone().map_err(io(&log))?;
    let program = std::env::current_exe()?;
    // A terminal that closes ends only processes of its own group.
    let child = Command::new(&program)
        .args(arguments)
        .stdin(Stdio::null())
        .stdout(out)
        .stderr(errors)
        .process_group(0)
        .spawn()
        .map_err(io(&program))?;
    output::text(&format!("{study} runs as process {}\n", child.id()))?;
    context.say(format_args!(
        "log: {}\nfollow it with `toile run {} --attach` or in the workbench; `kill {}` stops it, its unfinished jobs go \
         back into the queue",
        log.display(),
        files::word(study),
        child.id()
    ));
    Ok(End::Done)
}

/// Shows the progress of a study's jobs that other processes run, until none is left or no process works on them. An
/// interrupt ends this command, but not the run.
pub fn follow(context: &Context, store: &Store, study: &str) -> Outcome {
    let is_left = Arc::new(AtomicBool::new(false));
    signal_hook::flag::register(SIGINT, is_left.clone())?;
    let jobs = || read::jobs(store, &JobFilter { study: Some(study.to_owned()), ..JobFilter::default() });
    let open: BTreeSet<JobId> = jobs()?.iter().filter(|job| !job.status.is_final()).map(|job| job.id).collect();
    let mut progress = Progress::new(context, study, open.clone());
    let mut idle = 0;
    let last = loop {
        progress.show(store)?;
        let now: Vec<JobRow> = jobs()?.into_iter().filter(|job| open.contains(&job.id)).collect();
        let is_running = now.iter().any(|job| job.status == Status::Running);
        idle = if is_running { 0 } else { idle + 1 };
        let is_over = now.iter().all(|job| job.status.is_final());
        if is_over || idle > PATIENCE || is_left.load(Ordering::Relaxed) {
            break now;
        }
        std::thread::sleep(LOOK);
    };
    progress.finish();
    let count = |status: Status| last.iter().filter(|job| job.status == status).count();
    let (queued, failed) = (count(Status::Queued), count(Status::Failed));
    let ending = Ending::of_rows(study, last.iter());
    if !is_left.load(Ordering::Relaxed) && !open.is_empty() {
        progress::tell_end(context, &ending);
    }
    if is_left.load(Ordering::Relaxed) {
        context.say("left; the run goes on");
    } else if queued > 0 {
        context.say(format_args!("nobody works on the {queued} jobs that wait; `toile run` does"));
    }
    Ok(if failed > 0 { End::JobFailed } else { End::Done })
}

/// Log of a run in the background, beside the database.
fn log_file(database: &Path, study: &str) -> PathBuf {
    database.with_file_name(format!("{}.run.log", files::study_folder(study)))
}

//! A study on a Slurm cluster: its jobs run as job arrays, and their results are merged as they come.
//!
//! All state that must outlive this program lies in one folder that all nodes see: job files, result files, and the
//! numbers of submitted arrays. A run that is started again continues from there.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use crate::enqueue::Planned;
use crate::error::EngineError;
use crate::handout::{self, HandedOut, Merged};
use crate::job_files::result_of;
use spec::{Selection, Study};
use store::{JobId, Result, Store, StudyError};

/// Most tasks in one array. Slurm's default limit is 1001.
const ARRAY: usize = 1000;
/// Number of times that a task is submitted before the run gives it up.
const TRIES: u32 = 3;
/// File with the numbers of the arrays that were submitted.
const SUBMITTED: &str = "submitted";

/// Time without an answer of Slurm after which a run gives up. A restart of the controller takes less.
const SILENCE: Duration = Duration::from_secs(600);
/// Part of Slurm's message about jobs that ended long ago.
const FORGOTTEN: &str = "Invalid job id";

const ACTIVE: [&str; 9] = [
    "PENDING",
    "RUNNING",
    "CONFIGURING",
    "COMPLETING",
    "SUSPENDED",
    "REQUEUED",
    "REQUEUE_HOLD",
    "RESIZING",
    "STAGE_OUT",
];

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SlurmOptions {
    /// Folder that all nodes see.
    pub folder: PathBuf,
    /// Greatest number at once; `None` lets Slurm decide.
    pub tasks: Option<usize>,
    /// More options of `sbatch`: `--time=10`, `--mem=2G`, `--partition=short`.
    pub sbatch: Vec<String>,
}

pub struct SlurmRun {
    pub planned: Vec<Planned>,
    options: SlurmOptions,
    name: String,
    /// Jobs without a result.
    open: BTreeMap<JobId, OpenJob>,
    arrays: Vec<String>,
    /// Start of the time without an answer about the arrays; `None` while Slurm answers.
    silent_since: Option<Instant>,
}

struct OpenJob {
    file: PathBuf,
    tries: u32,
}

#[derive(Debug, PartialEq, Eq)]
enum Activity {
    Active,
    Ended,
    Unknown(String),
}

impl Activity {
    /// Reads the states that Slurm prints, one a line, such as `RUNNING` or `CANCELLED by 1000`.
    fn of(states: &str) -> Self {
        let is_active = |line: &str| line.split_whitespace().next().is_some_and(|state| ACTIVE.contains(&state));
        if states.lines().any(is_active) { Self::Active } else { Self::Ended }
    }
}

/// Writes job files; [`SlurmRun::step`] submits them.
pub fn start_slurm(
    store: &mut Store,
    study: &Study,
    selection: &Selection,
    options: &SlurmOptions,
) -> Result<SlurmRun> {
    let folder = std::path::absolute(&options.folder).map_err(StudyError::io(&options.folder))?;
    let handed = handout::hand_out(store, study, selection, &folder)?;
    let mut open = BTreeMap::new();
    for HandedOut { job, file } in &handed {
        open.extend(file.iter().map(|file| (job.id, OpenJob { file: file.clone(), tries: 0 })));
    }
    let arrays = std::fs::read_to_string(folder.join(SUBMITTED)).unwrap_or_default();
    Ok(SlurmRun {
        planned: handed.into_iter().map(|handed| handed.job).collect(),
        options: SlurmOptions { folder, ..options.clone() },
        name: study.name.clone(),
        open,
        arrays: arrays.lines().map(str::to_owned).collect(),
        silent_since: None,
    })
}

impl SlurmRun {
    /// Merges results, and submits jobs that have no result and are not at Slurm. Returns true once all jobs have
    /// ended, and fails when one was given up. Meant to be called about once a second.
    pub fn step(&mut self, store: &mut Store) -> Result<bool> {
        // Before the search for results: a task that ends in between is then found in the next step.
        let activity = self.activity();
        self.merge(store)?;
        if self.open.is_empty() {
            self.forget()?;
            return Ok(true);
        }
        match activity {
            Activity::Ended => self.submit()?,
            Activity::Active => self.silent_since = None,
            Activity::Unknown(why) => self.wait_for_an_answer(&why)?,
        }
        Ok(false)
    }

    /// Goes on while Slurm does not answer, up to [`SILENCE`]; then fails.
    fn wait_for_an_answer(&mut self, why: &str) -> Result<()> {
        let since = self.silent_since.get_or_insert_with(Instant::now);
        if since.elapsed() < SILENCE {
            return Ok(());
        }
        Err(EngineError::SlurmSilent { why: why.to_owned(), arrays: self.arrays.join(", ") }.into())
    }

    pub fn cancel(&mut self) -> Result<()> {
        if !self.arrays.is_empty() {
            slurm("scancel", &self.arrays, None)?;
        }
        self.forget()
    }

    pub fn arrays(&self) -> &[String] {
        &self.arrays
    }

    fn merge(&mut self, store: &mut Store) -> Result<()> {
        let there: Vec<PathBuf> =
            self.open.values().map(|job| result_of(&job.file)).filter(|file| file.exists()).collect();
        if there.is_empty() {
            return Ok(());
        }
        let Merged { stored, failed, known, running } = handout::merge(store, &there)?;
        for id in stored.iter().chain(&failed).chain(&known).chain(&running) {
            self.open.remove(id);
        }
        // The results are in the database now.
        for file in there {
            std::fs::remove_file(&file).map_err(StudyError::io(&file))?;
        }
        Ok(())
    }

    /// State of the arrays, from `squeue`, else from `sacct`, else from `scontrol` for each array. No answer does not
    /// mean that the arrays have ended: submitting them again could run them twice.
    fn activity(&self) -> Activity {
        if self.arrays.is_empty() {
            return Activity::Ended;
        }
        let jobs = format!("--jobs={}", self.arrays.join(","));
        let queue = slurm("squeue", &["--noheader".to_owned(), "--format=%T".to_owned(), jobs.clone()], None);
        let silent = match queue {
            Ok(states) => return Activity::of(&states),
            Err(error) => error.to_string(),
        };
        let accounts =
            ["--noheader", "--parsable2", "--allocations", "--format=State", jobs.as_str()].map(str::to_owned);
        if let Ok(states) = slurm("sacct", &accounts, None)
            && !states.trim().is_empty()
        {
            return Activity::of(&states);
        }
        let shown: Vec<String> = self.arrays.iter().filter_map(|array| states_of(array)).collect();
        if !shown.is_empty() {
            return Activity::of(&shown.join("\n"));
        }
        // Slurm forgets ended jobs after some minutes.
        if silent.contains(FORGOTTEN) { Activity::Ended } else { Activity::Unknown(silent) }
    }

    fn submit(&mut self) -> Result<()> {
        if let Some(OpenJob { file, .. }) = self.open.values().find(|job| job.tries >= TRIES) {
            let why = self.arrays.last().map(|array| last_words(array)).unwrap_or_default();
            return Err(EngineError::SlurmGaveUp { file: file.clone(), tries: TRIES, why }.into());
        }
        self.arrays.clear();
        let program = std::env::current_exe().map_err(StudyError::io("toile"))?;
        let folder = &self.options.folder;
        let open: Vec<&PathBuf> = self.open.values().map(|job| &job.file).collect();
        for (number, files) in open.chunks(ARRAY).enumerate() {
            let list = folder.join(format!("tasks-{number}"));
            let lines: String = files.iter().map(|file| format!("{}\n", file.display())).collect();
            std::fs::write(&list, lines).map_err(StudyError::io(&list))?;
            let at_once = self.options.tasks.map_or_else(String::new, |tasks| format!("%{tasks}"));
            let mut arguments = vec![
                "--parsable".to_owned(),
                format!("--job-name=toile-{}", self.name),
                format!("--array=1-{}{at_once}", files.len()),
                format!("--chdir={}", folder.display()),
                format!("--output={}", folder.join("task-%A_%a.log").display()),
            ];
            arguments.extend(self.options.sbatch.iter().cloned());
            let script = format!(
                "#!/bin/sh\nexec {} job run \"$(sed -n \"$SLURM_ARRAY_TASK_ID\"p {})\"\n",
                quoted(&program),
                quoted(&list)
            );
            let answer = slurm("sbatch", &arguments, Some(&script))?;
            // The answer is NUMBER, or NUMBER;CLUSTER.
            self.arrays.extend(answer.trim().split(';').next().map(str::to_owned));
        }
        let file = folder.join(SUBMITTED);
        std::fs::write(&file, self.arrays.join("\n")).map_err(StudyError::io(&file))?;
        self.open.values_mut().for_each(|job| job.tries += 1);
        Ok(())
    }

    fn forget(&mut self) -> Result<()> {
        self.arrays.clear();
        let file = self.options.folder.join(SUBMITTED);
        if file.exists() { std::fs::remove_file(&file).map_err(StudyError::io(&file)) } else { Ok(()) }
    }
}

/// State of the last task in Slurm's words: `JobState=FAILED Reason=NonZeroExitCode ExitCode=1:0`.
fn last_words(array: &str) -> String {
    let text = slurm("scontrol", &["show".to_owned(), "job".to_owned(), "-o".to_owned(), array.to_owned()], None);
    let text = text.unwrap_or_default();
    let told = text.lines().last().unwrap_or_default().split_whitespace();
    let words: Vec<&str> =
        told.filter(|word| ["JobState=", "Reason=", "ExitCode="].iter().any(|key| word.starts_with(key))).collect();
    words.join(" ")
}

/// States of the tasks, one a line, from `scontrol`.
fn states_of(array: &str) -> Option<String> {
    let text =
        slurm("scontrol", &["show".to_owned(), "job".to_owned(), "-o".to_owned(), array.to_owned()], None).ok()?;
    let states: Vec<&str> = text.split_whitespace().filter_map(|word| word.strip_prefix("JobState=")).collect();
    (!states.is_empty()).then(|| states.join("\n"))
}

fn slurm(program: &'static str, arguments: &[String], input: Option<&str>) -> Result<String> {
    let fail = |message: String| EngineError::SlurmProgram { program, message };
    let stdin = if input.is_some() { Stdio::piped() } else { Stdio::null() };
    let mut child = Command::new(program)
        .args(arguments)
        .stdin(stdin)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .map_err(|error| fail(format!("{error}; is Slurm installed here?")))?;
    if let Some((text, mut pipe)) = input.zip(child.stdin.take()) {
        std::io::Write::write_all(&mut pipe, text.as_bytes()).map_err(|error| fail(error.to_string()))?;
    }
    let output = child.wait_with_output().map_err(|error| fail(error.to_string()))?;
    if !output.status.success() {
        return Err(fail(String::from_utf8_lossy(&output.stderr).trim().to_owned()).into());
    }
    Ok(String::from_utf8_lossy(&output.stdout).into_owned())
}

/// A path quoted as one word of a shell.
fn quoted(path: &Path) -> String {
    format!("'{}'", path.to_string_lossy().replace('\'', "'\\''"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_is_one_word_of_a_shell() {
        let path = Path::new("/my disk/Anna's $HOME");
        let output = Command::new("sh").arg("-c").arg(format!("printf %s {}", quoted(path))).output();
        assert_eq!(String::from_utf8_lossy(&output.expect("a shell").stdout), path.to_string_lossy());
    }

    #[test]
    fn what_slurm_says_of_tasks_is_understood() {
        let check = |states: &str, expect: Activity| assert_eq!(Activity::of(states), expect, "{states:?}");
        check("", Activity::Ended);
        check("COMPLETED\nCANCELLED by 1000\n", Activity::Ended);
        check("COMPLETED\nRUNNING\n", Activity::Active);
        check("PENDING", Activity::Active);
    }

    #[test]
    fn without_slurm_that_is_said() {
        let error = slurm("no-such-program", &[], None).expect_err("it is not there").to_string();
        assert!(error.contains("is Slurm installed here?"), "{error}");
    }
}

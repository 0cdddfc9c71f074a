//! Runs of a study: it is checked and queued, and then worked on in the background.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, JoinHandle};

use crate::enqueue::{self, Planned};
use crate::isolated::Isolated;
use crate::outcome::{self, Executor, Provenance};
use crate::pipeline::Pipeline;
use crate::{ease, workers};
use body::Body;
use pattern::Style;
use spec::file::{GarmentEntry, SizeFile};
use spec::{Selection, Study, patterns};
use store::{Access, Live, Problem, Result, Store, StudyError, evidence};
use wardrobe::catalogue;

#[derive(Clone, Debug, Default)]
pub struct RunOptions {
    pub selection: Selection,
    /// Number of threads, with one simulation each; `None` for the number of cores.
    pub workers: Option<usize>,
    /// Exchange through which a screen watches the run.
    pub live: Arc<Live>,
}

/// A run in the background. Dropping it stops the run: running jobs go back into the queue.
pub struct Run {
    pub study: String,
    pub planned: Arc<Vec<Planned>>,
    stop: Arc<AtomicBool>,
    thread: Option<JoinHandle<Result<()>>>,
}

impl Run {
    /// Running jobs go back into the queue. Returns at once.
    pub fn stop(&self) {
        self.stop.store(true, Ordering::Relaxed);
    }

    pub fn is_finished(&self) -> bool {
        self.thread.as_ref().is_none_or(JoinHandle::is_finished)
    }

    /// Waits until the workers are done. Failed jobs are no error.
    pub fn join(mut self) -> Result<()> {
        self.wait()
    }

    fn wait(&mut self) -> Result<()> {
        match self.thread.take().map(JoinHandle::join) {
            None => Ok(()),
            Some(Ok(result)) => result,
            Some(Err(panic)) => std::panic::resume_unwind(panic),
        }
    }
}

impl Drop for Run {
    fn drop(&mut self) {
        self.stop();
        // Only [`Run::join`] reports an error.
        let _ = self.thread.take().map(JoinHandle::join);
    }
}

/// Reads and checks a study, by its file or folder, with its patterns and seam files. Reports all problems at once:
/// those of the study file, else those of the patterns.
pub fn load_study(store: &Store, path: &Path) -> Result<Study> {
    let study = Study::load(path, &catalogue::known(Some(&store.reader))?)?;
    check_patterns(&study)?;
    Ok(study)
}

/// Jobs that a run would queue. Writes nothing.
pub fn plan(store: &mut Store, study: &Study, selection: &Selection) -> Result<Vec<Planned>> {
    selection.check(study)?;
    let transaction = store::write(store.writer()?)?;
    let planned = enqueue::enqueue(&transaction, study, selection);
    transaction.rollback()?;
    planned
}

/// Queues a study and starts to work on it with the pipeline.
pub fn start(store: &mut Store, study: &Study, options: &RunOptions) -> Result<Run> {
    let pipeline = Arc::new(Pipeline::new(store.path()));
    let (database, of_study, stages) = (store.path().to_owned(), study.clone(), pipeline.clone());
    // Ease is stored long before the first drape. An error here is ignored: the jobs meet it too, and report it.
    let aside = move || drop(store_ease(&database, &of_study, &stages));
    let executor = Arc::new(Isolated::new(store.path(), pipeline));
    launch(store, study, options, executor, aside)
}

/// Computes the ease of every size of a study on every subject, and stores it.
pub fn update_ease(store: &mut Store, study: &Study) -> Result<()> {
    store.writer()?;
    store_ease(store.path(), study, &Pipeline::new(store.path()))
}

/// Starts a run as [`start`] does, with any executor.
pub fn start_with(
    store: &mut Store,
    study: &Study,
    options: &RunOptions,
    executor: Arc<dyn Executor + Send>,
) -> Result<Run> {
    launch(store, study, options, executor, || ())
}

/// Queues a study and works on it in a thread, while `aside` runs in another.
fn launch(
    store: &mut Store,
    study: &Study,
    options: &RunOptions,
    executor: Arc<dyn Executor + Send>,
    aside: impl FnOnce() + Send + 'static,
) -> Result<Run> {
    options.selection.check(study)?;
    let planned = Arc::new(enqueue::queue(store, study, &options.selection)?);

    let stop = Arc::new(AtomicBool::new(false));
    let workers = options.workers.unwrap_or_else(|| thread::available_parallelism().map_or(1, usize::from));
    let (database, jobs, stopped) = (store.path().to_owned(), planned.clone(), stop.clone());
    let live = options.live.clone();
    let folder = study.path.parent().map_or_else(|| PathBuf::from("."), Path::to_owned);
    // If all jobs had their results before, ease is stored as well, and only the evidence may be missing.
    let is_settled = planned.iter().all(|job| job.was_current && !job.why.will_run());
    let (name, study) = (study.name.clone(), study.clone());
    let of_run = name.clone();
    let work = move || {
        if is_settled {
            // A run that was killed may have stored results without judging them.
            return evidence::update(&mut store::open(&database, Access::Volatile)?, &name);
        }
        let provenance = Provenance::of(&folder);
        thread::scope(|scope| {
            scope.spawn(aside);
            let work = workers::Work { study: &study, jobs: &jobs };
            workers::run(&database, &work, &*executor, workers, provenance, &stopped, &live)
        })
    };
    let thread = thread::Builder::new().name("toile-run".into()).spawn(work).map_err(StudyError::io("thread"))?;
    Ok(Run { study: of_run, planned, stop, thread: Some(thread) })
}

/// Number of subjects whose eases are stored in one transaction.
const TOGETHER: usize = 100;

/// Builds each subject's body once for all garments.
fn store_ease(database: &Path, study: &Study, pipeline: &Pipeline) -> Result<()> {
    let mut connection = store::open(database, Access::Write)?;
    let transaction = store::write(&mut connection)?;
    let study_id = enqueue::store_study(&transaction, study)?;
    transaction.commit()?;
    let worn = worn_styles(study)?;
    for subjects in study.subjects.chunks(TOGETHER) {
        let models = subjects.iter().map(|subject| pipeline.worn_body(subject)).collect::<Result<Vec<_>>>()?;
        let mut found = Vec::new();
        for worn in &worn {
            let own = || {
                let all = subjects.iter().zip(&models);
                all.filter(|(subject, _)| worn.subjects.contains(subject.id.as_str()))
            };
            let bodies: Vec<&Body> = own().map(|(_, model)| &model.body).collect();
            let eases = ease::on_all(&worn.style, &bodies);
            found.extend(own().zip(eases).map(|((subject, _), eases)| (worn, subject, eases)));
        }
        let transaction = store::write(&mut connection)?;
        for (worn, subject, eases) in &found {
            outcome::write_ease(&transaction, study_id, [worn.garment, worn.size, &subject.id], eases)?;
        }
        transaction.commit()?;
    }
    let transaction = store::write(&mut connection)?;
    evidence::refresh(&transaction, &study.name)?;
    Ok(transaction.commit()?)
}

/// A size with the subjects who wear it.
struct WornStyle<'a> {
    garment: &'a str,
    size: &'a str,
    style: Style,
    subjects: BTreeSet<&'a str>,
}

fn worn_styles(study: &Study) -> Result<Vec<WornStyle<'_>>> {
    let mut worn = Vec::new();
    for garment in &study.garments {
        for size in &garment.sizes {
            let style = style_of(garment, size)?;
            let subjects = garment.subjects.iter().map(String::as_str).collect();
            worn.push(WornStyle { garment: &garment.name, size: &size.name, style, subjects });
        }
    }
    Ok(worn)
}

fn style_of(garment: &GarmentEntry, size: &SizeFile) -> Result<Style> {
    let unit = garment.unit.as_deref().and_then(patterns::unit_of);
    patterns::read_style(&size.pattern, garment.seams.as_ref(), Some(&size.name), unit)
}

/// Refuses a study with a pattern that cannot be sewn, before anything is written.
fn check_patterns(study: &Study) -> Result<()> {
    let mut problems = Vec::new();
    for garment in &study.garments {
        for size in &garment.sizes {
            if let Err(error) = style_of(garment, size) {
                let message = format!("garment {}, size {}: {error}", garment.name, size.name);
                problems.push(Problem::of(&study.path, message));
            }
        }
    }
    if problems.is_empty() { Ok(()) } else { Err(StudyError::File(problems)) }
}

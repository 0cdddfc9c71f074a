//! A workspace: one database and what screens and commands may ask of it. Each question is answered by the room of its
//! subject; this is the door.

mod catalogue;
mod sits;

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use image::RgbaImage;

use crate::answers::audit::{self, Audit};
use crate::answers::dressed::{self, Dressed};
use crate::answers::figure::{self, Figure};
use crate::answers::picture::{self, Look, Map, Order, Scenes};
use crate::answers::population::{self, Nearest};
use crate::answers::record::{self, Comparison, Record, Rerun};
use crate::answers::{reporting, reports, size_map};
use crate::error::Result;
use crate::rows::{ChiRow, Grid, JobId, JobRow, LogLine, MetricsRow, StageRow, StudyRow, SubjectId, Table};
use crate::run::compose::{self, NewStudy};
use crate::run::enqueue::{self, Planned, Why};
use crate::run::handout::{self, HandedOut, Merged};
use crate::run::outcome::Executor;
use crate::run::slurm::{self, SlurmOptions, SlurmRun};
use crate::run::{self, Run, RunOptions, actions};
use crate::seams::preview::{self, Mannequin};
use crate::spec::Selection;
use crate::spec::fields::Given;
use crate::spec::file::Study;
use crate::spec::inputs::Inputs;
use crate::store::browse::{self, Relation, SqlAnswer};
use crate::store::read::{self, JobFilter};
use crate::store::sql::{self, Interrupter};
use crate::store::{Store, evidence};
use fit::{Evidence, Pair, RuleScore};
use render::View;
use render::export::MeshFormat;
use report::Purpose;
use sim::Step;

/// An open database with its studies, jobs and results. `Send`, not `Sync`: one a thread.
///
/// Questions fail when the database cannot be read, actions when the workspace is read-only; `# Errors` says what else.
///
/// # Examples
/// ```
/// use study::{Selection, Workspace, write_quickstart};
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let folder = tempfile::tempdir()?;
/// write_quickstart(folder.path())?;
/// let mut workspace = Workspace::open(&folder.path().join("toile.sqlite"), false)?;
/// let study = workspace.load_study(folder.path())?;
///
/// // Nothing is simulated yet: `start` does that.
/// let fem = Selection { simulators: vec!["fem".into()], ..Selection::default() };
/// let planned = workspace.plan(&study, &fem)?;
/// assert_eq!(planned.len(), 6);
/// # Ok(())
/// # }
/// ```
pub struct Workspace {
    store: Store,
    scenes: Scenes,
}

impl Workspace {
    /// Opens a workspace; without `readonly` the database is created and brought up to date where needed.
    ///
    /// # Errors
    /// When the file cannot be opened, is no database, or was written by a newer program.
    pub fn open(path: &Path, readonly: bool) -> Result<Self> {
        let mut store = Store::open(path, readonly)?;
        if !readonly {
            crate::catalogue::add_builtin(store.writer()?)?;
        }
        Ok(Self { store, scenes: Scenes::default() })
    }

    /// The database file.
    #[must_use]
    pub fn path(&self) -> &Path {
        self.store.path()
    }

    /// Whether actions are refused.
    #[must_use]
    pub fn is_readonly(&self) -> bool {
        self.store.is_readonly()
    }

    /// A number that changes whenever anything was written by any process; costs microseconds.
    pub fn version(&self) -> Result<i64> {
        self.store.version()
    }

    /// Recomputes the thesis's printed tables.
    pub fn audit_thesis(&self) -> Result<Audit> {
        audit::audit_thesis(&self.store)
    }

    /// Measures the stored meshes of a study's results again and compares them with what the tables say.
    ///
    /// # Errors
    /// When there is no such study or the database cannot be read.
    pub fn audit_study(&self, study: &str) -> Result<Audit> {
        audit::audit_study(&self.store, study)
    }

    /// The body of a revision of a subject: from the cache, or built now and kept there unless the workspace is
    /// read-only.
    ///
    /// # Errors
    /// When there is none of that number, or no body can be built from its measurements.
    pub fn figure(&self, id: SubjectId) -> Result<Figure> {
        figure::figure(&self.store, id)
    }

    /// The same body, ready to be dressed again and again.
    ///
    /// # Errors
    /// Those of [`Self::figure`].
    pub fn mannequin(&self, id: SubjectId) -> Result<Mannequin> {
        preview::mannequin(&self.store, id)
    }

    /// A picture of a result. The result last shown is kept ready, so that other views of it come quickly.
    ///
    /// # Errors
    /// [`NotFound`](crate::StudyError::NotFound) while there is no result; [`Artefact`](crate::StudyError::Artefact) when it is no
    /// longer stored.
    pub fn picture(&self, id: JobId, view: View, width: u32, height: u32, map: Map) -> Result<RgbaImage> {
        picture::picture(&self.store, &self.scenes, id, view, width, height, map)
    }

    /// A result from any side, the garment as large as it can be times the look's own enlargement: the body is cut off
    /// where it goes beyond, and transparent where nothing is. For small pictures.
    ///
    /// # Errors
    /// As [`Workspace::picture`].
    pub fn look(&self, id: JobId, look: Look, width: u32, height: u32, map: Map) -> Result<RgbaImage> {
        picture::look(&self.store, &self.scenes, id, look, width, height, map)
    }

    /// A result's body and garment as a mesh file. The garment's texture coordinates are its places in the pattern, m; a
    /// map colours it and leaves its values in the formats that can hold them.
    ///
    /// # Errors
    /// As [`Workspace::picture`].
    pub fn mesh_file(&self, id: JobId, format: MeshFormat, map: Map) -> Result<Vec<u8>> {
        picture::mesh_file(&self.store, id, format, map)
    }

    /// Results as a PNG file: one shot of one result by itself, more of them on a sheet, all at one scale.
    ///
    /// # Errors
    /// [`NotFound`](crate::StudyError::NotFound) while there is no result, where its simulator keeps no such stage or a cloth
    /// names no piece; a file that is no image.
    pub fn pictures(&self, ids: &[JobId], order: &Order) -> Result<Vec<u8>> {
        picture::pictures(&self.store, ids, order)
    }

    /// A result turned once about the vertical, as an animated PNG file of so many pictures that repeats for ever.
    ///
    /// # Errors
    /// As [`Workspace::pictures`].
    pub fn turntable(&self, id: JobId, order: &Order, pictures: u32) -> Result<Vec<u8>> {
        picture::turntable(&self.store, id, order, pictures)
    }

    /// The subject of a study most like somebody, among those of the same sex.
    ///
    /// # Errors
    /// When a value is wrong, there is no such study, or it has nobody of that sex.
    pub fn nearest(&self, study: &str, given: &[Given]) -> Result<Nearest> {
        population::nearest(&self.store, study, given)
    }

    /// Everything that is stored of a run.
    ///
    /// # Errors
    /// When there is no such job.
    pub fn record(&self, id: JobId) -> Result<Record> {
        record::record(&self.store, id)
    }

    /// Two runs side by side.
    ///
    /// # Errors
    /// When one of the jobs does not exist.
    pub fn compare(&self, before: JobId, after: JobId) -> Result<Comparison> {
        record::compare(&self.store, before, after)
    }

    /// Makes a run again from its stored inputs, nothing of it from the cache. What is stored stays as it is.
    ///
    /// # Errors
    /// When it has no result yet, its body is a scan (which is not stored), or a stage refuses.
    pub fn rerun(&self, id: JobId) -> Result<Rerun> {
        record::rerun(&self.store, id)
    }

    /// Whether a study's report was last written from this database, as the page that has this time (ms since 1970).
    pub fn knows_report(&self, study: &str, page: &Path, written_ms: i64) -> Result<bool> {
        record::knows_report(&self.store, study, page, written_ms)
    }

    /// Remembers the page that a study's report was just written to, and its time (ms since 1970).
    pub fn remember_report(&mut self, study: &str, page: &Path, written_ms: i64) -> Result<()> {
        record::remember_report(&mut self.store, study, page, written_ms)
    }

    /// The files of a study's report by their relative paths: `index.html` for its purpose, pictures, charts, drawings, CSV. Without a
    /// purpose a study of both simulators opens with their comparison, of one with the fit.
    ///
    /// # Errors
    /// When there is no such study, or a stored result cannot be read.
    pub fn report(&self, study: &str, purpose: Option<Purpose>) -> Result<Vec<(String, Vec<u8>)>> {
        reporting::report(&self.store, study, purpose)
    }

    /// Builds the report of a study in a folder of its own below `folder`; returns its page.
    ///
    /// # Errors
    /// When there is no such study, a stored result cannot be read, or a file cannot be written.
    pub fn build_report(&self, study: &str, folder: &Path) -> Result<PathBuf> {
        reports::build_report(&self.store, study, folder)
    }

    /// An SVG picture of a study: one panel a garment, a dot a subject, in the colour of the size to wear; hollow where even that is
    /// tight or loose somewhere.
    ///
    /// # Errors
    /// When there is no such study.
    pub fn size_map(&self, study: &str) -> Result<String> {
        size_map::size_map(&self.store, study)
    }

    /// Cancels queued or running jobs; returns how many were.
    ///
    /// # Errors
    /// When the workspace is read-only or a job does not exist.
    pub fn cancel(&mut self, ids: &[JobId]) -> Result<usize> {
        actions::cancel(&mut self.store, ids)
    }

    /// Queues failed or cancelled jobs again, and those of which they need the result; returns how many were. A job with a
    /// result keeps it.
    ///
    /// # Errors
    /// When the workspace is read-only or a job does not exist.
    pub fn retry(&mut self, ids: &[JobId]) -> Result<usize> {
        actions::retry(&mut self.store, ids)
    }

    /// Sets the priority of jobs: greater runs earlier.
    pub fn set_priority(&mut self, ids: &[JobId], priority: i64) -> Result<()> {
        actions::set_priority(&mut self.store, ids, priority)
    }

    /// Lets no new jobs of a study start; running ones go on.
    ///
    /// # Errors
    /// When the workspace is read-only or there is no such study.
    pub fn pause(&mut self, study: &str) -> Result<()> {
        actions::pause(&mut self.store, study)
    }

    /// Lets jobs of a paused study start again.
    ///
    /// # Errors
    /// When the workspace is read-only or there is no such study.
    pub fn resume(&mut self, study: &str) -> Result<()> {
        actions::resume(&mut self.store, study)
    }

    /// Writes a new study into a folder of its own and queues its jobs, which then wait to be run; returns its file.
    ///
    /// # Errors
    /// When something is missing from it, its folder is there already, or a file cannot be written.
    pub fn create_study(&mut self, new: &NewStudy) -> Result<PathBuf> {
        compose::create_study(&mut self.store, new)
    }

    /// Queues the jobs of a study without working on them.
    pub fn queue(&mut self, study: &Study, selection: &Selection) -> Result<Vec<Planned>> {
        compose::queue(&mut self.store, study, selection)
    }

    /// Keeps the results of a study for its file in a new place from now on.
    ///
    /// # Errors
    /// When the workspace is read-only.
    pub fn move_study(&mut self, study: &Study) -> Result<()> {
        enqueue::move_home(&mut self.store, study)
    }

    /// Why a job was not found in the cache: what differs from the latest earlier job of the same cell.
    ///
    /// # Errors
    /// When there is no such job.
    pub fn why(&self, id: JobId) -> Result<Why> {
        enqueue::why(&self.store, id)
    }

    /// The inputs of a job, by name.
    pub fn inputs(&self, id: JobId) -> Result<Inputs> {
        enqueue::inputs(&self.store, id)
    }

    /// Queues a study and writes a file for each of its jobs that is to be run. The same job gets the same file.
    ///
    /// # Errors
    /// When the workspace is read-only, a selection names what the study does not have, or a file cannot be written.
    pub fn hand_out(&mut self, study: &Study, selection: &Selection, folder: &Path) -> Result<Vec<HandedOut>> {
        handout::hand_out(&mut self.store, study, selection, folder)
    }

    /// Merges result files, and those in folders, in one transaction. What has a result here keeps it.
    ///
    /// # Errors
    /// When the workspace is read-only, or a file is no result of a job of this database: nothing is then stored.
    pub fn merge(&mut self, paths: &[PathBuf]) -> Result<Merged> {
        handout::merge(&mut self.store, paths)
    }

    /// Reads and checks a study, its file or its folder, and the patterns and seam files it names.
    ///
    /// # Errors
    /// Everything that is wrong with the file, at once; else everything that is wrong with the patterns.
    pub fn load_study(&self, path: &Path) -> Result<Study> {
        run::load_study(&self.store, path)
    }

    /// What a run of a study would do; nothing is written.
    ///
    /// # Errors
    /// When the workspace is read-only or a selection names what the study does not have.
    pub fn plan(&mut self, study: &Study, selection: &Selection) -> Result<Vec<Planned>> {
        run::plan(&mut self.store, study, selection)
    }

    /// Queues a study and starts working on it with the real pipeline.
    ///
    /// # Errors
    /// When the workspace is read-only or a selection names what the study does not have.
    pub fn start(&mut self, study: &Study, options: &RunOptions) -> Result<Run> {
        run::start(&mut self.store, study, options)
    }

    /// Finds the ease of every size of a study on every subject, and stores it.
    ///
    /// # Errors
    /// When the workspace is read-only, or a body or a pattern cannot be made.
    pub fn update_ease(&mut self, study: &Study) -> Result<()> {
        run::update_ease(&mut self.store, study)
    }

    /// [`Workspace::start`] with any executor.
    ///
    /// # Errors
    /// When the workspace is read-only or a selection names what the study does not have.
    pub fn start_with(
        &mut self,
        study: &Study,
        options: &RunOptions,
        executor: Arc<dyn Executor + Send>,
    ) -> Result<Run> {
        run::start_with(&mut self.store, study, options, executor)
    }

    /// Hands the jobs of a study to Slurm; [`SlurmRun::step`] does the rest.
    ///
    /// # Errors
    /// Those of [`Workspace::hand_out`].
    pub fn start_slurm(&mut self, study: &Study, selection: &Selection, options: &SlurmOptions) -> Result<SlurmRun> {
        slurm::start_slurm(&mut self.store, study, selection, options)
    }

    /// Takes results of a study's jobs back from Slurm, and submits what has none and is with nobody; whether all jobs have
    /// ended. To be called every second or so.
    ///
    /// # Errors
    /// When Slurm cannot be asked, or a job was given up.
    pub fn step_slurm(&mut self, run: &mut SlurmRun) -> Result<bool> {
        run.step(&mut self.store)
    }

    /// Answers a query as [`Workspace::query`] does, with at most so many rows; `stop` ends it early.
    ///
    /// # Errors
    /// What SQLite says of the query; [`Interrupted`](crate::StudyError::Interrupted) when it was stopped.
    pub fn answer(&self, text: &str, most: usize, stop: &AtomicBool) -> Result<SqlAnswer> {
        browse::answer(&self.store, text, most, stop)
    }

    /// Writes all rows of a query into a file: JSON where its name ends so, CSV otherwise. Returns how many rows.
    ///
    /// # Errors
    /// What SQLite says of the query; when the file is there already or cannot be written; when it was stopped.
    pub fn export_query(&self, text: &str, path: &Path, stop: &AtomicBool) -> Result<usize> {
        browse::export_query(&self.store, text, path, stop)
    }

    /// The views and tables there are, views first, with their columns: what a query may name.
    pub fn relations(&self) -> Result<Vec<Relation>> {
        browse::relations(&self.store)
    }

    /// What the results of a study say now: an answer for every garment and fit class that is there.
    pub fn evidence(&self, study: &str) -> Result<Evidence> {
        evidence::evidence(&self.store, study)
    }

    /// The cases of a study that both simulators drew.
    pub fn pairs(&self, study: &str) -> Result<Vec<Pair>> {
        evidence::pairs(&self.store, study)
    }

    /// The ease at which the simulators change places, over all garments of a study or one, in words.
    pub fn crossover_words(&self, study: &str, garment: Option<&str>) -> Result<String> {
        evidence::crossover_words(&self.store, study, garment)
    }

    /// How often the thesis's rule names the simulator with the lower EI in a study, and of how many pairs.
    pub fn rule_score(&self, study: &str) -> Result<(RuleScore, usize)> {
        evidence::rule_score(&self.store, study)
    }

    /// Judges a study's results again and keeps that for `v_recommendation`; nothing happens in a read-only workspace.
    pub fn update_evidence(&mut self, study: &str) -> Result<()> {
        evidence::update_evidence(&mut self.store, study)
    }

    /// How the current jobs of a study ended.
    pub fn dressed(&self, study: &str) -> Result<Vec<Dressed>> {
        dressed::dressed(&self.store, study)
    }

    /// All studies, by name.
    pub fn studies(&self) -> Result<Vec<StudyRow>> {
        read::studies(&self.store)
    }

    /// A study by name.
    ///
    /// # Errors
    /// When there is none of that name.
    pub fn study(&self, name: &str) -> Result<StudyRow> {
        read::study(&self.store, name)
    }

    /// A garment of a study as a grid of sizes by subjects.
    ///
    /// # Errors
    /// When there is no such study.
    pub fn grid(&self, study: &str, garment: &str) -> Result<Grid> {
        read::grid(&self.store, study, garment)
    }

    /// Jobs in the order they will run or were queued.
    pub fn jobs(&self, filter: &JobFilter) -> Result<Vec<JobRow>> {
        read::jobs(&self.store, filter)
    }

    /// One job.
    ///
    /// # Errors
    /// When there is no job of that number.
    pub fn job(&self, id: JobId) -> Result<JobRow> {
        read::job(&self.store, id)
    }

    /// Every measurement of a result, by stage and number.
    pub fn chi(&self, id: JobId) -> Result<Vec<ChiRow>> {
        read::chi(&self.store, id)
    }

    /// The numbers of a result; `None` while there is none.
    pub fn metrics(&self, id: JobId) -> Result<Option<MetricsRow>> {
        read::metrics(&self.store, id)
    }

    /// The recorded steps of a finished job.
    pub fn history(&self, id: JobId) -> Result<Vec<Step>> {
        read::history(&self.store, id)
    }

    /// A job's log, oldest first.
    pub fn log(&self, id: JobId) -> Result<Vec<LogLine>> {
        read::log(&self.store, id)
    }

    /// The stages of a job with their content hashes.
    pub fn stages(&self, id: JobId) -> Result<Vec<StageRow>> {
        read::stages(&self.store, id)
    }

    /// A handle that stops a running [`Workspace::query`] from another thread.
    #[must_use]
    pub fn interrupter(&self) -> Interrupter {
        sql::interrupter(&self.store)
    }

    /// Answers a query, or several separated by `;` (the last one's rows). Nothing can be written this way.
    ///
    /// Besides SQLite's own functions there are `median(x)`, `stddev(x)` (sample, n-1) and `quantile(x, p)` (p in 0 to
    /// 1, linear between order statistics).
    ///
    /// # Errors
    /// What SQLite says of the query; [`Interrupted`](crate::StudyError::Interrupted) when an [`Interrupter`] stopped it.
    pub fn query(&self, sql: &str) -> Result<Table> {
        sql::query(&self.store, sql)
    }
}

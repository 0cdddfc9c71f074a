//! What the workbench knows and where the user is in it. Screens are pure functions of this.

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

use ratatui::layout::Size;

use super::action::{Binding, Screen};
use super::bindings::BINDINGS;
use super::clerk::Reports;
use super::entries::FabricOrder;
use super::feed::{Detail, Focus, Snapshot};
use super::message::Target;
use super::overlay::Overlay;
use super::picture::{Drawn, FRONT, Shot};
use super::sql::Sql;
use super::styles::Styles;
use super::text;
use super::theme::Theme;
use study::bodies::Girths;
use study::{
    Cell, ChiRow, EaseRow, FitCell, Grid, JobId, JobRow, LiveFrame, Look, MEASUREMENTS, Map, Status, Step, SubjectId,
    SubjectRow,
};

/// How jobs are ordered.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum JobOrder {
    /// As queued.
    #[default]
    Number,
    /// By state: what runs, what went wrong, what waits, what is done.
    Status,
    /// By EI, the worst first.
    Ei,
    /// By time taken, the longest first.
    Time,
}

impl JobOrder {
    /// The next one.
    #[must_use]
    pub fn next(self) -> Self {
        match self {
            Self::Number => Self::Status,
            Self::Status => Self::Ei,
            Self::Ei => Self::Time,
            Self::Time => Self::Number,
        }
    }
}

/// How subjects are ordered: by name, or by the measurement of a number in [`MEASUREMENTS`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum SubjectOrder {
    /// By name.
    #[default]
    Name,
    /// By sex.
    Sex,
    /// By a measurement, the smallest first.
    Measurement(usize),
}

impl SubjectOrder {
    /// The next one, of so many measurements.
    #[must_use]
    pub fn next(self, measurements: usize) -> Self {
        match self {
            Self::Name => Self::Sex,
            Self::Sex => Self::Measurement(0),
            Self::Measurement(k) if k + 1 < measurements => Self::Measurement(k + 1),
            Self::Measurement(_) => Self::Name,
        }
    }
}

/// How measurements are ordered.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum ChiOrder {
    /// By number.
    #[default]
    Number,
    /// By distance from 1, the greatest first.
    Error,
}

/// An order and whether it is reversed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Order<T> {
    /// By what.
    pub by: T,
    /// Whether it is reversed.
    pub reversed: bool,
}

/// Place in the grid: indices of size, simulator and subject.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Place {
    /// Size.
    pub size: usize,
    /// Simulator.
    pub simulator: usize,
    /// Subject.
    pub subject: usize,
}

/// A message to the user in the status line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Notice {
    /// What it says.
    pub text: String,
    /// Whether something went wrong.
    pub is_error: bool,
}

/// What this session of the workbench can do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Abilities {
    /// Studies can be run from here.
    pub run: bool,
    /// Pictures can be shown.
    pub pictures: bool,
    /// There is a study to start with.
    pub quickstart: bool,
}

/// The jobs shown, and of what they were found: data, filter, order.
#[derive(Clone, Debug, Default)]
pub struct Arranged {
    of: Option<(u64, String, Order<JobOrder>)>,
    rows: Vec<usize>,
}

/// Where new things are put.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Places {
    /// Folder of studies.
    pub studies: PathBuf,
    /// Folder of reports.
    pub reports: PathBuf,
}

/// Where the user is among jobs.
pub struct Jobs {
    /// The jobs shown, in order.
    pub arranged: Arranged,
    /// Order of jobs.
    pub order: Order<JobOrder>,
    /// Lines the log is scrolled up from its end.
    pub log_up: usize,
    /// Steps of running jobs, as they came.
    pub traces: BTreeMap<JobId, Vec<Step>>,
    /// How often data came.
    pub reads: u64,
}

/// The table of measurements that is shown.
pub struct ChiTable {
    /// Order of measurements.
    pub order: Order<ChiOrder>,
    /// Measurement selected, a row of the table shown.
    pub row: usize,
    /// Stage whose measurements are wanted.
    pub stage: Option<String>,
}

/// How drapes are seen.
pub struct Drapes {
    /// From where drapes are seen.
    pub look: Look,
    /// In which colours.
    pub map: Map,
    /// Whether the picture has all the room.
    pub enlarged: bool,
    /// The pictures asked for.
    pub shots: Vec<Shot>,
    /// The picture of each that came last.
    pub pictures: Vec<(Shot, Result<Drawn, String>)>,
}

/// Runs that are compared.
pub struct Compare {
    /// Runs selected for a comparison.
    pub marks: BTreeSet<JobId>,
    /// Whether only the measurements are shown in which compared runs differ.
    pub differences_only: bool,
    /// Whether those that differ most come first.
    pub sorts_contrasts: bool,
    /// Measurement selected in the comparison, a row of the table shown.
    pub contrast: usize,
}

/// Where the user is among subjects.
pub struct Subjects {
    /// Subject selected.
    pub chosen: Option<String>,
    /// Order of subjects.
    pub order: Order<SubjectOrder>,
    /// What was read on bodies that were built.
    pub measured: BTreeMap<SubjectId, Result<Box<Girths>, String>>,
}

/// Where the user is among fabrics.
pub struct Fabrics {
    /// Fabric selected.
    pub chosen: Option<String>,
    /// Order of fabrics.
    pub order: Order<FabricOrder>,
}

/// The run that was started here.
pub struct Running {
    /// The job of the run here that is watched.
    pub watched: Option<JobId>,
    /// Its garment as it was last seen.
    pub live: Option<LiveFrame>,
    /// The run started here, while it goes on.
    pub target: Option<Target>,
}

/// The terminal.
pub struct Terminal {
    /// Size of the terminal.
    pub size: Size,
    /// Whether the mouse is taken.
    pub has_mouse: bool,
    /// Whether the terminal is gone and only the run is waited for.
    pub detached: bool,
}

/// Which screen is shown, and what of it.
pub struct Navigation {
    /// Screen shown.
    pub screen: Screen,
    /// Screens to go back to, the last first.
    pub trail: Vec<Screen>,
    /// Whether the second pane of each screen has the focus.
    pub second_pane: [bool; Screen::ALL.len()],
    /// The filter of each screen.
    pub filters: [String; Screen::ALL.len()],
}

/// What this session was started with.
pub struct Setup {
    /// Keys.
    pub bindings: &'static [Binding],
    /// What can be done.
    pub abilities: Abilities,
    /// Where new things are put.
    pub places: Places,
}

/// Where the user is in the grid.
pub struct Cells {
    /// What is looked at.
    pub focus: Focus,
    /// Place in the grid.
    pub place: Place,
}

/// The state of the workbench.
pub struct State {
    /// Styles.
    pub theme: Theme,
    /// What was last read; `None` before the first time.
    pub data: Option<Box<Snapshot>>,
    /// Lines that the table of the selected subject or fabric is scrolled down.
    pub table_down: usize,
    /// Where the user is among the styles.
    pub styles: Styles,
    /// Where the user is among questions.
    pub sql: Sql,
    /// Where the user is among reports.
    pub reports: Reports,
    /// Whether the latest report comes first.
    pub reports_by_time: bool,
    /// What is open above the screen.
    pub overlay: Option<Overlay>,
    /// What the status line says.
    pub notice: Option<Notice>,
    /// Where the user is among jobs.
    pub jobs: Jobs,
    /// The table of measurements that is shown.
    pub chi: ChiTable,
    /// How drapes are seen.
    pub drapes: Drapes,
    /// Runs that are compared.
    pub compare: Compare,
    /// Where the user is among subjects.
    pub subjects: Subjects,
    /// Where the user is among fabrics.
    pub fabrics: Fabrics,
    /// The run that was started here.
    pub running: Running,
    /// The terminal.
    pub terminal: Terminal,
    /// Which screen is shown, and what of it.
    pub nav: Navigation,
    /// What this session was started with.
    pub setup: Setup,
    /// Where the user is in the grid.
    pub cells: Cells,
}

impl State {
    /// The state before anything was read.
    #[must_use]
    pub fn new(theme: Theme, abilities: Abilities, size: Size) -> Self {
        Self {
            theme,
            data: None,
            table_down: 0,
            styles: Styles::default(),
            sql: Sql::default(),
            reports: Reports::default(),
            reports_by_time: false,
            overlay: None,
            notice: None,
            jobs: Jobs {
                arranged: Arranged::default(),
                order: Order::default(),
                log_up: 0,
                traces: BTreeMap::new(),
                reads: 0,
            },
            chi: ChiTable { order: Order::default(), row: 0, stage: None },
            drapes: Drapes { look: FRONT, map: Map::Plain, enlarged: false, shots: vec![], pictures: vec![] },
            compare: Compare { marks: BTreeSet::new(), differences_only: false, sorts_contrasts: false, contrast: 0 },
            subjects: Subjects { chosen: None, order: Order::default(), measured: BTreeMap::new() },
            fabrics: Fabrics { chosen: None, order: Order::default() },
            running: Running { watched: None, live: None, target: None },
            terminal: Terminal { size, has_mouse: false, detached: false },
            nav: Navigation {
                screen: Screen::Study,
                trail: vec![],
                second_pane: [false; Screen::ALL.len()],
                filters: Default::default(),
            },
            setup: Setup { bindings: BINDINGS, abilities, places: Places::default() },
            cells: Cells { focus: Focus::default(), place: Place::default() },
        }
    }

    /// Whether the database was read and has no study.
    #[must_use]
    pub fn is_first_start(&self) -> bool {
        self.data.as_ref().is_some_and(|data| data.studies.is_empty())
    }

    /// The screen that is really there: without a study, those of studies show what may be done first.
    #[must_use]
    pub fn screen_shown(&self) -> Screen {
        let needs_study = matches!(self.nav.screen, Screen::Jobs | Screen::Results | Screen::Compare);
        if needs_study && self.is_first_start() { Screen::Study } else { self.nav.screen }
    }

    /// Whether the second pane of the screen has the focus.
    #[must_use]
    pub fn in_second_pane(&self) -> bool {
        self.nav.second_pane[self.nav.screen as usize]
    }

    /// The filter of the screen.
    #[must_use]
    pub fn filter(&self) -> &str {
        &self.nav.filters[self.nav.screen as usize]
    }

    /// The grid.
    #[must_use]
    pub fn grid(&self) -> Option<&Grid> {
        self.data.as_ref()?.grid.as_ref().filter(|grid| !grid.sizes.is_empty() && !grid.subjects.is_empty())
    }

    /// The cell at a place of the grid.
    #[must_use]
    pub fn cell_at(&self, place: Place) -> Option<&Cell> {
        self.grid()?.cells.get(place.size)?.get(place.subject)?.get(place.simulator)
    }

    /// The place of a job in the grid, where it is of its garment.
    #[must_use]
    pub fn place_of(&self, id: JobId) -> Option<Place> {
        let grid = self.grid()?;
        let job = self.data.as_ref()?.job(id).filter(|job| job.garment == grid.garment)?;
        Some(Place {
            size: grid.sizes.iter().position(|size| *size == job.size)?,
            simulator: grid.simulators.iter().position(|simulator| *simulator == job.simulator)?,
            subject: grid.subjects.iter().position(|subject| *subject == job.subject)?,
        })
    }

    /// The selected job.
    #[must_use]
    pub fn job(&self) -> Option<&JobRow> {
        self.data.as_ref()?.job(self.cells.focus.job?)
    }

    /// What is stored of the selected job, once it was read.
    #[must_use]
    pub fn detail(&self) -> Option<&Detail> {
        self.data.as_ref()?.detail.as_ref().filter(|detail| Some(detail.job) == self.cells.focus.job)
    }

    /// Jobs that pass the filter of the Jobs screen, in its order.
    #[must_use]
    pub fn jobs(&self) -> Vec<&JobRow> {
        let Some(data) = &self.data else { return vec![] };
        self.jobs.arranged.rows.iter().filter_map(|row| data.jobs.get(*row)).collect()
    }

    /// Finds which jobs pass the filter and in which order, where data, filter or order have changed since: with ten
    /// thousand jobs that takes too long for every frame.
    pub(super) fn arrange_jobs(&mut self) {
        let Some(data) = &self.data else { return };
        let filter = self.nav.filters[Screen::Jobs as usize].to_lowercase();
        let wanted = (self.jobs.reads, filter, self.jobs.order);
        if self.jobs.arranged.of.as_ref() == Some(&wanted) {
            return;
        }
        let jobs = &data.jobs;
        let passes = |row: &usize| wanted.1.is_empty() || words(&jobs[*row]).contains(&wanted.1);
        let mut rows: Vec<usize> = (0..jobs.len()).filter(passes).collect();
        let falling = |value: Option<f64>| value.map_or(f64::INFINITY, |v| -v);
        match self.jobs.order.by {
            JobOrder::Number => {}
            JobOrder::Status => rows.sort_by_key(|row| attention(jobs[*row].status)),
            JobOrder::Ei => rows.sort_by(|a, b| falling(jobs[*a].ei).total_cmp(&falling(jobs[*b].ei))),
            JobOrder::Time => rows.sort_by_key(|row| -jobs[*row].wall_ms.unwrap_or(i64::MIN + 1)),
        }
        if self.jobs.order.reversed {
            rows.reverse();
        }
        self.jobs.arranged = Arranged { of: Some(wanted), rows };
    }

    /// Subjects that pass the filter of the Subjects screen, in its order.
    #[must_use]
    pub fn subjects(&self) -> Vec<&SubjectRow> {
        let Some(data) = &self.data else { return vec![] };
        let filter = self.nav.filters[Screen::Subjects as usize].to_lowercase();
        let matches = |row: &&SubjectRow| format!("{} {}", row.name, text::sex(row)).to_lowercase().contains(&filter);
        let mut subjects: Vec<&SubjectRow> = data.subjects.iter().filter(matches).collect();
        match self.subjects.order.by {
            SubjectOrder::Name => {}
            SubjectOrder::Sex => subjects.sort_by_key(|row| text::sex(row)),
            SubjectOrder::Measurement(k) => {
                let value = |row: &SubjectRow| MEASUREMENTS[k].get(&row.measurements).unwrap_or(f64::INFINITY);
                subjects.sort_by(|a, b| value(a).total_cmp(&value(b)));
            }
        }
        if self.subjects.order.reversed {
            subjects.reverse();
        }
        subjects
    }

    /// The selected subject: the first, where the one wanted is not shown.
    #[must_use]
    pub fn subject(&self) -> Option<&SubjectRow> {
        let subjects = self.subjects();
        subjects.iter().find(|row| Some(&row.name) == self.subjects.chosen.as_ref()).or(subjects.first()).copied()
    }

    /// Stages of the selected result, in the order they are made.
    #[must_use]
    pub fn stages(&self) -> Vec<&str> {
        let Some(detail) = self.detail() else { return vec![] };
        ["sewn", "popup", "drape"]
            .into_iter()
            .filter(|stage| detail.chi.iter().any(|row| row.stage == *stage))
            .collect()
    }

    /// The stage whose measurements are shown: the one wanted, or the last there is.
    #[must_use]
    pub fn stage(&self) -> Option<&str> {
        let stages = self.stages();
        stages.iter().copied().find(|stage| Some(*stage) == self.chi.stage.as_deref()).or(stages.last().copied())
    }

    /// Measurements of the selected result that pass the filter of the Results screen, in its order.
    #[must_use]
    pub fn chi(&self) -> Vec<&ChiRow> {
        let (Some(detail), Some(stage)) = (self.detail(), self.stage()) else { return vec![] };
        let filter = self.nav.filters[Screen::Results as usize].to_lowercase();
        let matches = |row: &ChiRow| format!("#{} {}", row.no, row.name).to_lowercase().contains(&filter);
        let mut rows: Vec<&ChiRow> = detail.chi.iter().filter(|row| row.stage == stage && matches(row)).collect();
        if self.chi.order.by == ChiOrder::Error {
            let error = |row: &ChiRow| (row.chi() - 1.0).abs();
            rows.sort_by(|a, b| error(b).total_cmp(&error(a)));
        }
        if self.chi.order.reversed {
            rows.reverse();
        }
        rows
    }

    /// The ease that decides the fit of a job.
    #[must_use]
    pub fn ease(&self, job: &JobRow) -> Option<&EaseRow> {
        let of_job =
            |ease: &&EaseRow| ease.garment == job.garment && ease.size == job.size && ease.subject == job.subject;
        self.data.as_ref()?.ease.iter().filter(of_job).find(|ease| ease.decides)
    }

    /// The fit at a place of the grid.
    #[must_use]
    pub fn fit_at(&self, place: Place) -> Option<FitCell> {
        *self.grid()?.fits.get(place.size)?.get(place.subject)?
    }

    /// Steps of the selected job: those stored, or those seen while it runs.
    #[must_use]
    pub fn steps(&self) -> &[Step] {
        let stored = self.detail().map(|detail| detail.history.as_slice()).filter(|steps| !steps.is_empty());
        let seen = || self.cells.focus.job.and_then(|id| self.jobs.traces.get(&id)).map(Vec::as_slice);
        stored.or_else(seen).unwrap_or_default()
    }

    /// Whether a place of the grid contains the filter of the Study screen.
    #[must_use]
    pub fn is_match(&self, place: Place) -> bool {
        let filter = self.nav.filters[Screen::Study as usize].to_lowercase();
        let Some(grid) = self.grid() else { return false };
        let status = self.cell_at(place).and_then(|cell| cell.status).map_or("", text::status);
        let fit = self.fit_at(place).map_or("", |fit| fit.class.as_str());
        let sim = grid.simulators.get(place.simulator).map_or("", |sim| text::sim(*sim));
        let (size, subject) = (&grid.sizes[place.size], &grid.subjects[place.subject]);
        format!("{size} {subject} {sim} {status} {fit}").to_lowercase().contains(&filter)
    }

    /// Says something in the status line.
    pub fn say(&mut self, text: impl Into<String>) {
        self.notice = Some(Notice { text: text.into(), is_error: false });
    }

    /// Says in the status line that something went wrong.
    pub fn complain(&mut self, text: impl Into<String>) {
        self.notice = Some(Notice { text: text.into(), is_error: true });
    }
}

/// How soon a user wants to see jobs in a state; the least first.
fn attention(status: Status) -> u8 {
    match status {
        Status::Running => 0,
        Status::Failed => 1,
        Status::NotConverged => 2,
        Status::Queued => 3,
        Status::Done => 4,
        Status::Cancelled => 5,
    }
}

/// What a filter looks at in a job.
fn words(job: &JobRow) -> String {
    let error = job.error.as_deref().unwrap_or_default();
    format!(
        "{} {} {} {} {} {} {error}",
        job.id,
        text::status(job.status),
        job.garment,
        job.size,
        job.subject,
        text::sim(job.simulator)
    )
    .to_lowercase()
}

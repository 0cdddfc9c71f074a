//! What the workbench knows and where the user is in it: what screens share, and the state that each keeps.

use std::path::PathBuf;

use ratatui::layout::{Position, Rect, Size};

use crate::keys::binding::Binding;
use crate::keys::screen::Screen;
use crate::keys::table::BINDINGS;
use crate::messages::effect::Effect;
use crate::messages::requests::Target;
use crate::messages::snapshot::{Detail, Focus, Snapshot};
use crate::overlays::Overlay;
use crate::screens::compare::state::Compare;
use crate::screens::fabrics::state::Fabrics;
use crate::screens::fit::state::Fit;
use crate::screens::jobs::state::Jobs;
use crate::screens::movement::Movement;
use crate::screens::picture_pane::state::Pictures;
use crate::screens::reports::state::Reports;
use crate::screens::results::state::Results;
use crate::screens::sql::state::Sql;
use crate::screens::study::state::Study;
use crate::screens::styles::state::Styles;
use crate::screens::subjects::state::Subjects;
use crate::widgets::layout::rows;
use crate::widgets::theme::Theme;
use store::{EaseRow, JobId, JobRow, LiveFrame};

/// A message to the user in the status line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Notice {
    /// What it says.
    pub text: String,
    /// Whether something went wrong.
    pub is_error: bool,
}

/// What the user is told.
#[derive(Debug, Default)]
pub struct Told {
    /// What the status line says.
    pub notice: Option<Notice>,
    /// The commands that do what was done here, the latest last.
    pub commands: Vec<String>,
    /// The command of what a form waits for: it counts once that is done.
    pub awaited: Option<String>,
}

/// What this session of the workbench can do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Abilities {
    /// Studies can be run from here.
    pub run: bool,
    /// Pictures can be shown.
    pub pictures: bool,
}

/// Where new things are put.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Folders {
    /// Folder of studies.
    pub studies: PathBuf,
    /// Folder of reports.
    pub reports: PathBuf,
}

/// What this session was started with.
pub struct Setup {
    /// Actions with their keys: built in, and from a file of one's own.
    pub bindings: &'static [Binding],
    /// What can be done.
    pub abilities: Abilities,
    /// Where new things are put.
    pub folders: Folders,
    /// The database, where commands have to name it.
    pub database: Option<PathBuf>,
}

/// What is known of the terminal.
pub struct Terminal {
    /// Columns and rows of the terminal.
    pub size: Size,
    /// Whether the mouse is taken.
    pub has_mouse: bool,
    /// Plain ASCII or not, where somebody has chosen.
    pub chosen_ascii: Option<bool>,
    /// Whether it is gone and only the run is waited for.
    pub detached: bool,
}

/// The run that was started here.
#[derive(Default)]
pub struct Running {
    /// What it runs, while it goes on.
    pub target: Option<Target>,
    /// Its job that is watched.
    pub watched: Option<JobId>,
    /// The garment of that job as it was last seen.
    pub live: Option<LiveFrame>,
}

/// Which screen is shown, and what of it.
pub struct Navigation {
    /// Screen that is shown.
    pub screen: Screen,
    /// Screens to go back to, the last first.
    pub trail: Vec<Screen>,
    /// Whether the second pane of each screen has the focus.
    pub second_pane: [bool; Screen::ALL.len()],
    /// The filter of each screen.
    pub filters: [String; Screen::ALL.len()],
    /// Lines that the table of the selected subject or fabric is scrolled down.
    pub table_down: usize,
}

/// The state of the workbench: what screens share, and what each keeps.
pub struct State {
    /// Colours and signs.
    pub theme: Theme,
    /// What this session was started with.
    pub setup: Setup,
    /// What is known of the terminal.
    pub terminal: Terminal,
    /// What was last read; `None` before the first time.
    pub data: Option<Box<Snapshot>>,
    /// What is looked at.
    pub focus: Focus,
    /// Which screen is shown, and what of it.
    pub nav: Navigation,
    /// What is open above the screen.
    pub overlay: Option<Overlay>,
    /// What the user is told.
    pub told: Told,
    /// The run that was started here.
    pub running: Running,
    /// How drapes are seen.
    pub pictures: Pictures,
    pub study: Study,
    pub subjects: Subjects,
    pub styles: Styles,
    pub jobs: Jobs,
    pub results: Results,
    pub compare: Compare,
    pub sql: Sql,
    pub reports: Reports,
    pub fabrics: Fabrics,
    pub fit: Fit,
}

impl State {
    /// The state before anything was read.
    #[must_use]
    pub fn new(theme: Theme, abilities: Abilities, size: Size) -> Self {
        Self {
            theme,
            setup: Setup { bindings: BINDINGS, abilities, folders: Folders::default(), database: None },
            terminal: Terminal { size, has_mouse: false, chosen_ascii: None, detached: false },
            data: None,
            focus: Focus::default(),
            nav: Navigation {
                screen: Screen::Study,
                trail: vec![],
                second_pane: [false; Screen::ALL.len()],
                filters: Default::default(),
                table_down: 0,
            },
            overlay: None,
            told: Told::default(),
            running: Running::default(),
            pictures: Pictures::default(),
            study: Study::default(),
            subjects: Subjects::default(),
            styles: Styles::default(),
            jobs: Jobs::default(),
            results: Results::default(),
            compare: Compare::default(),
            sql: Sql::default(),
            reports: Reports::default(),
            fabrics: Fabrics::default(),
            fit: Fit::default(),
        }
    }

    /// Where the body of the screen lies.
    #[must_use]
    pub fn body(&self) -> Rect {
        rows(Rect::from((Position::ORIGIN, self.terminal.size)))[1]
    }

    /// Scrolls the table of the selected subject or fabric, of which so many lines are hidden.
    pub fn scroll_table(&mut self, movement: Movement, hidden: usize) {
        self.nav.table_down = movement.from(self.nav.table_down.min(hidden), hidden + 1);
    }

    /// Whether the database was read and has no study.
    #[must_use]
    pub fn is_first_start(&self) -> bool {
        self.data.as_ref().is_some_and(|data| data.studies.is_empty())
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

    /// The selected job.
    #[must_use]
    pub fn job(&self) -> Option<&JobRow> {
        self.data.as_ref()?.job(self.focus.job?)
    }

    /// What is stored of the selected job, once it was read.
    #[must_use]
    pub fn detail(&self) -> Option<&Detail> {
        self.data.as_ref()?.detail.as_ref().filter(|detail| Some(detail.job) == self.focus.job)
    }

    /// The ease that decides the fit of a job.
    #[must_use]
    pub fn ease(&self, job: &JobRow) -> Option<&EaseRow> {
        let of_job =
            |ease: &&EaseRow| ease.garment == job.garment && ease.size == job.size && ease.subject == job.subject;
        self.data.as_ref()?.ease.iter().filter(of_job).find(|ease| ease.decides)
    }

    /// Says something in the status line.
    pub fn say(&mut self, text: impl Into<String>) {
        self.told.notice = Some(Notice { text: text.into(), is_error: false });
    }

    /// Says in the status line that something went wrong.
    pub fn complain(&mut self, text: impl Into<String>) {
        self.told.notice = Some(Notice { text: text.into(), is_error: true });
    }

    /// Shows a screen; one that was shown before is gone back to.
    pub fn show(&mut self, screen: Screen) {
        if screen == self.nav.screen {
            return;
        }
        match self.nav.trail.iter().position(|seen| *seen == screen) {
            Some(at) => self.nav.trail.truncate(at),
            None => self.nav.trail.push(self.nav.screen),
        }
        self.nav.screen = screen;
    }

    /// Asks; the effects happen on yes.
    pub fn ask(&mut self, text: impl Into<String>, effects: Vec<Effect>) {
        self.overlay = Some(Overlay::Question { text: text.into(), effects });
    }

    /// Selects a job.
    pub fn select(&mut self, id: JobId) {
        self.focus.job = Some(id);
    }

    /// The same size and subject by the other simulator.
    #[must_use]
    pub fn same_by_other(&self, job: &JobRow) -> Option<&JobRow> {
        let is_other = |other: &&JobRow| {
            other.garment == job.garment
                && other.size == job.size
                && other.subject == job.subject
                && other.repeat == job.repeat
                && other.simulator != job.simulator
        };
        self.data.as_ref()?.jobs.iter().find(is_other)
    }

    /// The sign of a run that is selected for a comparison.
    #[must_use]
    pub fn mark_of(&self, job: Option<JobId>) -> &'static str {
        if job.is_some_and(|job| self.compare.marks.contains(&job)) { "•" } else { "" }
    }
}

//! State that the screens share: what was read, what is looked at, what is shown and told.

use std::collections::BTreeSet;
use std::path::PathBuf;

use ratatui::layout::{Position, Rect, Size};

use crate::keys::binding::Binding;
use crate::keys::screen::Screen;
use crate::keys::table::BINDINGS;
use crate::messages::effect::Effect;
use crate::messages::requests::Target;
use crate::messages::snapshot::{Detail, Focus, Place, Snapshot};
use crate::overlays::Overlay;
use crate::screens::measurements::state::Measurements;
use crate::screens::movement::Movement;
use crate::screens::picture_pane::state::Pictures;
use crate::widgets::layout::rows;
use crate::widgets::theme::Theme;
use store::{Grid, JobId, JobRow, LiveFrame, StudyRow, SubjectId};
use wardrobe::SubjectRow;

/// A message to the user in the status line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Notice {
    /// Its text.
    pub text: String,
    /// True where something went wrong.
    pub is_error: bool,
}

/// Messages to the user, and the commands that do the same as was done here.
#[derive(Debug, Default)]
pub struct Told {
    /// Message in the status line.
    pub notice: Option<Notice>,
    /// The commands that do what was done here, the latest last.
    pub commands: Vec<String>,
    /// The command of what a form waits for: it counts once that is done.
    pub awaited: Option<String>,
}

/// Abilities of this session of the workbench.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Abilities {
    /// Studies can be run from here.
    pub run: bool,
    /// Pictures can be shown.
    pub pictures: bool,
}

/// Folders for new files.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Folders {
    /// Folder of studies.
    pub studies: PathBuf,
    /// Folder of reports.
    pub reports: PathBuf,
}

/// Settings that this session was started with.
pub struct Setup {
    /// Actions with their keys: built in, and from a file of one's own.
    pub bindings: &'static [Binding],
    /// Abilities of this session.
    pub abilities: Abilities,
    /// Folders for new files.
    pub folders: Folders,
    /// The database, where commands have to name it.
    pub database: Option<PathBuf>,
}

/// Size and settings of the terminal.
pub struct Terminal {
    /// Columns and rows of the terminal.
    pub size: Size,
    /// True where the mouse is taken.
    pub has_mouse: bool,
    /// Plain ASCII or not, where somebody has chosen.
    pub chosen_ascii: Option<bool>,
    /// True where it is gone and only the run is waited for.
    pub detached: bool,
}

/// The run that was started here.
#[derive(Default)]
pub struct Running {
    /// Its target, while it goes on.
    pub target: Option<Target>,
    /// Its job that is watched.
    pub watched: Option<JobId>,
    /// The garment of that job as it was last seen.
    pub live: Option<LiveFrame>,
}

/// The screen that is shown, and the focus and the filter of each screen.
pub struct Navigation {
    /// Screen that is shown.
    pub screen: Screen,
    /// Screens to go back to, the last first.
    pub trail: Vec<Screen>,
    /// True for each screen whose second pane has the focus.
    pub second_pane: [bool; Screen::ALL.len()],
    /// The filter of each screen.
    pub filters: [String; Screen::ALL.len()],
    /// Lines that the table of the selected subject or fabric is scrolled down.
    pub table_down: usize,
}

/// Subject and fabric that a style is tried on with.
#[derive(Default)]
pub struct InHand {
    /// The subject selected on the Subjects screen.
    pub subject: Option<SubjectId>,
    /// Name of the fabric chosen on the Fabrics screen.
    pub fabric: Option<String>,
}

/// State that the screens share.
pub struct State {
    /// Colours and signs.
    pub theme: Theme,
    /// Settings that this session was started with.
    pub setup: Setup,
    /// Size and settings of the terminal.
    pub terminal: Terminal,
    /// Contents of the database as last read; `None` before the first time.
    pub data: Option<Box<Snapshot>>,
    /// Study, garment and jobs that are looked at.
    pub focus: Focus,
    /// Cell of the grid that is looked at.
    pub place: Place,
    /// Runs selected for a comparison.
    pub marks: BTreeSet<JobId>,
    /// Subject and fabric that a style is tried on with.
    pub in_hand: InHand,
    /// The screen that is shown, and the focus and the filter of each screen.
    pub nav: Navigation,
    /// List, form or question that is open above the screen.
    pub overlay: Option<Overlay>,
    /// Messages to the user.
    pub told: Told,
    /// The run that was started here.
    pub running: Running,
    /// View and pictures of drapes.
    pub pictures: Pictures,
    /// The table of measurements, which Study and Results show.
    pub measurements: Measurements,
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
            place: Place::default(),
            marks: BTreeSet::new(),
            in_hand: InHand::default(),
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
            measurements: Measurements::default(),
        }
    }

    /// Place of the body of the screen.
    #[must_use]
    pub fn body(&self) -> Rect {
        rows(Rect::from((Position::ORIGIN, self.terminal.size)))[1]
    }

    /// True if the database was read and has no study.
    #[must_use]
    pub fn is_first_start(&self) -> bool {
        self.data.as_ref().is_some_and(|data| data.studies.is_empty())
    }

    /// True if the second pane of the screen has the focus.
    #[must_use]
    pub fn in_second_pane(&self) -> bool {
        self.nav.second_pane[self.nav.screen as usize]
    }

    /// The filter of the screen that is shown.
    #[must_use]
    pub fn filter(&self) -> &str {
        &self.nav.filters[self.nav.screen as usize]
    }

    /// The filter of a screen, in lower case.
    #[must_use]
    pub fn filter_of(&self, screen: Screen) -> String {
        self.nav.filters[screen as usize].to_lowercase()
    }

    /// The study looked at.
    #[must_use]
    pub fn study(&self) -> Option<&StudyRow> {
        self.data.as_ref()?.study()
    }

    /// The grid looked at; `None` where it has no size or no subject.
    #[must_use]
    pub fn grid(&self) -> Option<&Grid> {
        self.data.as_ref()?.grid()
    }

    /// The selected job.
    #[must_use]
    pub fn job(&self) -> Option<&JobRow> {
        self.data.as_ref()?.job(self.focus.job?)
    }

    /// Stored results, steps and log of the selected job, once they were read.
    #[must_use]
    pub fn detail(&self) -> Option<&Detail> {
        self.data.as_ref()?.detail.as_ref().filter(|detail| Some(detail.job) == self.focus.job)
    }

    /// The subject that a style is tried on.
    #[must_use]
    pub fn subject_in_hand(&self) -> Option<&SubjectRow> {
        self.data.as_ref()?.subjects.iter().find(|row| Some(row.id) == self.in_hand.subject)
    }

    /// The sign of a run that is selected for a comparison.
    #[must_use]
    pub fn mark_of(&self, job: Option<JobId>) -> &'static str {
        if job.is_some_and(|job| self.marks.contains(&job)) { "•" } else { "" }
    }

    /// Looks at a study.
    pub fn open_study(&mut self, name: String) {
        self.focus.study = Some(name);
        (self.focus.garment, self.focus.job, self.place) = (None, None, Place::default());
    }

    /// Selects a cell of the grid and its job, if it has one.
    pub fn select_cell(&mut self, place: Place) {
        self.place = place;
        self.focus.job = self.data.as_ref().and_then(|data| data.cell_at(place)).and_then(|cell| cell.job);
    }

    /// Selects the cell so many subjects to the right, or to the left.
    pub fn step_subject(&mut self, step: isize) {
        let Some(grid) = self.grid() else { return };
        let last = grid.subjects.len().saturating_sub(1);
        let subject = self.place.subject.saturating_add_signed(step).min(last);
        self.select_cell(Place { subject, ..self.place });
    }

    /// Scrolls the table of the selected subject or fabric, of which so many lines are hidden.
    pub fn scroll_table(&mut self, movement: Movement, hidden: usize) {
        self.nav.table_down = movement.from(self.nav.table_down.min(hidden), hidden + 1);
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

    /// Says something in the status line.
    pub fn say(&mut self, text: impl Into<String>) {
        self.told.notice = Some(Notice { text: text.into(), is_error: false });
    }

    /// Says something in the status line, and nothing else follows.
    pub fn reply(&mut self, text: impl Into<String>) -> Vec<Effect> {
        self.say(text);
        vec![]
    }

    /// Says in the status line that something went wrong.
    pub fn complain(&mut self, text: impl Into<String>) {
        self.told.notice = Some(Notice { text: text.into(), is_error: true });
    }

    /// Asks; the effects happen on yes.
    pub fn ask(&mut self, text: impl Into<String>, effects: Vec<Effect>) {
        self.overlay = Some(Overlay::Question { text: text.into(), effects });
    }

    /// Runs a study, or says why that cannot be.
    pub fn run(&mut self, target: Target) -> Vec<Effect> {
        if !self.setup.abilities.run {
            self.complain("this workbench is read-only: start it without --readonly to run a study");
            return vec![];
        }
        if self.running.target.is_some() {
            return self.reply("a run goes on here already; X stops it");
        }
        self.running.target = Some(target.clone());
        self.say("run started; it goes on in the background");
        vec![Effect::Run(target)]
    }
}

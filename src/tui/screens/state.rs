//! State that the screens share: data that was read, selections, settings, messages.

use std::path::PathBuf;

use ratatui::layout::{Position, Rect, Size};

use crate::keys::binding::Binding;
use crate::keys::screen::Screen;
use crate::keys::table::BINDINGS;
use crate::messages::effect::Effect;
use crate::messages::requests::Target;
use crate::messages::snapshot::{Detail, Focus, Place, Snapshot};
use crate::overlays::{Answer, Overlay};
use crate::screens::marks::Marks;
use crate::screens::measurements::state::Measurements;
use crate::screens::movement::Movement;
use crate::screens::picture_pane::state::Pictures;
use crate::widgets::layout::rows;
use crate::widgets::theme::Theme;
use store::{Grid, JobId, JobRow, LiveFrame, StudyRow, SubjectId};
use wardrobe::SubjectRow;

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Notice {
    pub text: String,
    pub is_error: bool,
}

#[derive(Debug, Default)]
pub struct Told {
    pub notice: Option<Notice>,
    /// Commands that do the same as was done here, the latest last.
    pub commands: Vec<String>,
    /// Command of an effect whose outcome is awaited; it joins `commands` on success.
    pub awaited: Option<String>,
    pub copying: String,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Abilities {
    pub run: bool,
    pub pictures: bool,
}

#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Folders {
    pub studies: PathBuf,
    pub reports: PathBuf,
}

pub struct Setup {
    /// Actions with their keys, from the built-in table and the user's file.
    pub bindings: &'static [Binding],
    pub abilities: Abilities,
    pub folders: Folders,
    /// User and name of this machine, `USER@HOST`.
    pub login: String,
    /// Path of the database, if commands must name it.
    pub database: Option<PathBuf>,
}

pub struct Terminal {
    pub size: Size,
    pub has_mouse: bool,
    /// True or false for a captured or a free mouse, once the user has chosen.
    pub chosen_mouse: Option<bool>,
    /// True or false for ASCII or all signs, once the user has chosen.
    pub chosen_ascii: Option<bool>,
    /// True once the terminal is gone, and only the run is waited for.
    pub detached: bool,
}

#[derive(Default)]
pub struct Running {
    /// Target of the run; `None` where none goes on.
    pub target: Option<Target>,
    /// True from the end of a run here until the database was read without running jobs: those were of this run.
    pub is_settling: bool,
    pub watched: Option<JobId>,
    /// Latest shape of the watched job's garment.
    pub live: Option<LiveFrame>,
}

pub struct Navigation {
    pub screen: Screen,
    /// Screens to go back to, the last first.
    pub trail: Vec<Screen>,
    /// True for each screen whose second pane has the focus.
    pub second_pane: [bool; Screen::ALL.len()],
    /// Screen on which runs were marked. Results and comparisons of them keep the marks.
    pub marked_on: Screen,
    pub filters: [String; Screen::ALL.len()],
    /// Lines that the table of the selected subject or fabric is scrolled down.
    pub table_down: usize,
}

/// Subject and fabric for trying a style on.
#[derive(Default)]
pub struct InHand {
    /// Subject selected on the Subjects screen.
    pub subject: Option<SubjectId>,
    /// Name of the fabric that the user went to on the Fabrics screen; without one that of the study, if it has the
    /// style; `None` for the default.
    pub fabric: Option<String>,
}

pub struct State {
    pub theme: Theme,
    pub setup: Setup,
    pub terminal: Terminal,
    /// Contents of the database as last read; `None` before the first time.
    pub data: Option<Box<Snapshot>>,
    pub focus: Focus,
    /// Place of the selected cell in the grid.
    pub place: Place,
    /// Jobs marked for a comparison, or to be cancelled or queued again together.
    pub marks: Marks<JobId>,
    pub in_hand: InHand,
    pub nav: Navigation,
    pub overlay: Option<Overlay>,
    pub told: Told,
    pub running: Running,
    pub pictures: Pictures,
    /// The table of measurements, which Study and Results show.
    pub measurements: Measurements,
}

impl State {
    pub fn new(theme: Theme, abilities: Abilities, size: Size) -> Self {
        Self {
            theme,
            setup: Setup {
                bindings: BINDINGS,
                abilities,
                folders: Folders::default(),
                login: String::new(),
                database: None,
            },
            terminal: Terminal { size, has_mouse: false, chosen_mouse: None, chosen_ascii: None, detached: false },
            data: None,
            focus: Focus::default(),
            place: Place::default(),
            marks: Marks::default(),
            in_hand: InHand::default(),
            nav: Navigation {
                screen: Screen::Study,
                trail: vec![],
                second_pane: Screen::ALL.map(|screen| screen == Screen::Sql),
                marked_on: Screen::Study,
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

    pub fn body(&self) -> Rect {
        rows(Rect::from((Position::ORIGIN, self.terminal.size)))[1]
    }

    /// True if the database was read and has no study.
    pub fn is_first_start(&self) -> bool {
        self.data.as_ref().is_some_and(|data| data.studies.is_empty())
    }

    pub fn in_second_pane(&self) -> bool {
        self.nav.second_pane[self.nav.screen as usize]
    }

    pub fn filter(&self) -> &str {
        &self.nav.filters[self.nav.screen as usize]
    }

    /// Filter of a screen, in lower case.
    pub fn filter_of(&self, screen: Screen) -> String {
        self.nav.filters[screen as usize].to_lowercase()
    }

    pub fn study(&self) -> Option<&StudyRow> {
        self.data.as_ref()?.study()
    }

    /// Returns `None` where the grid has no size or no subject.
    pub fn grid(&self) -> Option<&Grid> {
        self.data.as_ref()?.grid()
    }

    /// Offset of local time from UTC.
    pub fn offset_ms(&self) -> i64 {
        self.data.as_ref().map_or(0, |data| data.offset_ms)
    }

    pub fn job(&self) -> Option<&JobRow> {
        self.data.as_ref()?.job(self.focus.job?)
    }

    /// Details of the selected job; `None` until they are read.
    pub fn detail(&self) -> Option<&Detail> {
        self.data.as_ref()?.detail.as_ref().filter(|detail| Some(detail.job) == self.focus.job)
    }

    pub fn subject_in_hand(&self) -> Option<&SubjectRow> {
        self.data.as_ref()?.subjects.iter().find(|row| Some(row.id) == self.in_hand.subject)
    }

    /// Sign of a marked job; empty for any other.
    pub fn mark_of(&self, job: Option<JobId>) -> &'static str {
        if job.is_some_and(|job| self.marks.has(&job)) { "•" } else { "" }
    }

    pub fn open_study(&mut self, name: String) {
        self.focus.study = Some(name);
        (self.focus.garment, self.focus.job, self.place) = (None, None, Place::default());
    }

    /// Selects a cell of the grid, and its job if it has one.
    pub fn select_cell(&mut self, place: Place) {
        self.place = place;
        self.focus.job = self.data.as_ref().and_then(|data| data.cell_at(place)).and_then(|cell| cell.job);
    }

    /// Selects a cell `step` subjects to the right, or to the left if negative.
    pub fn step_subject(&mut self, step: isize) {
        let Some(grid) = self.grid() else { return };
        let last = grid.subjects.len().saturating_sub(1);
        let subject = self.place.subject.saturating_add_signed(step).min(last);
        self.select_cell(Place { subject, ..self.place });
    }

    /// Scrolls the table of the selected subject or fabric, of which `hidden` lines do not fit.
    pub fn scroll_table(&mut self, movement: Movement, hidden: usize) {
        self.nav.table_down = movement.from(self.nav.table_down.min(hidden), hidden + 1);
    }

    /// Goes back to the screen if it is in the trail.
    pub fn show(&mut self, screen: Screen) {
        if screen == self.nav.screen {
            return;
        }
        match self.nav.trail.iter().position(|seen| *seen == screen) {
            Some(at) => self.nav.trail.truncate(at),
            None => self.nav.trail.push(self.nav.screen),
        }
        self.nav.screen = screen;
        // Keys are commands until the query is asked for.
        self.nav.second_pane[Screen::Sql as usize] = true;
    }

    pub fn say(&mut self, text: impl Into<String>) {
        self.told.notice = Some(Notice { text: text.into(), is_error: false });
    }

    /// Shows a message in the status line. Returns no effects.
    pub fn reply(&mut self, text: impl Into<String>) -> Vec<Effect> {
        self.say(text);
        vec![]
    }

    /// Shows an error in the status line.
    pub fn complain(&mut self, text: impl Into<String>) {
        self.told.notice = Some(Notice { text: text.into(), is_error: true });
    }

    /// Asks a question; a yes carries out the effects.
    pub fn ask(&mut self, text: impl Into<String>, effects: Vec<Effect>) {
        self.offer(text, vec![Answer { key: 'y', label: "yes", effects }]);
    }

    /// Asks a question with answers; any other key is none of them.
    pub fn offer(&mut self, text: impl Into<String>, answers: Vec<Answer>) {
        self.overlay = Some(Overlay::Question { text: text.into(), answers });
    }

    /// Copies a text, and tells its name once it is copied.
    pub fn copy(&mut self, name: impl Into<String>, text: String) -> Vec<Effect> {
        self.told.copying = name.into();
        vec![Effect::Copy(text)]
    }

    pub fn run(&mut self, target: Target) -> Vec<Effect> {
        if !self.setup.abilities.run {
            self.complain("this workbench is read-only: start it without --readonly to run a study");
            return vec![];
        }
        if self.running.target.is_some() {
            return self.reply("a run goes on here already; X stops it");
        }
        self.running.target = Some(target.clone());
        match self.study().filter(|study| study.paused) {
            Some(study) => {
                let text = format!("run started, but {} is paused: its jobs wait until p resumes it", study.name);
                self.say(text);
            }
            None => self.say("run started; it goes on in the background"),
        }
        vec![Effect::Run(target)]
    }
}

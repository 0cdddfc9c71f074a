//! What is filled in for a new study: its name, and what of the catalogue it is made of.

use std::path::PathBuf;

use crossterm::event::{KeyCode, KeyEvent};

use super::action::Screen;
use super::clerk::Errand;
use super::message::Effect;
use super::overlay::{Outcome, Overlay, edit};
use super::state::State;
use study::{NewStudy, Simulator, Wearable, wearables};

/// The cloth that a new study starts with, where the catalogue has it.
const USUAL_FABRIC: &str = "cotton_shirting_light";
/// Lines of a page.
const PAGE: usize = 10;

/// A line of the form.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FormLine {
    /// The name.
    Name,
    /// The fabric, one of a list.
    Fabric,
    /// A simulator, chosen or not.
    Simulator(usize),
    /// A size of a style, chosen or not.
    Size(usize),
    /// A subject, chosen or not.
    Subject(usize),
}

impl FormLine {
    /// The part of the form it belongs to.
    #[must_use]
    pub fn section(self) -> &'static str {
        match self {
            Self::Name => "name",
            Self::Fabric => "fabric",
            Self::Simulator(_) => "simulators",
            Self::Size(_) => "styles and sizes",
            Self::Subject(_) => "subjects",
        }
    }
}

/// A new study as it is filled in.
#[derive(Clone, Debug, PartialEq)]
pub struct StudyForm {
    /// Name.
    pub name: String,
    /// Folder of all studies.
    pub folder: PathBuf,
    /// Fabrics there are.
    pub fabrics: Vec<String>,
    /// The one chosen.
    pub fabric: usize,
    /// Simulators, each chosen or not.
    pub simulators: Vec<(Simulator, bool)>,
    /// Sizes, each chosen or not.
    pub sizes: Vec<(Wearable, bool)>,
    /// Subjects, each chosen or not.
    pub subjects: Vec<(String, bool)>,
    /// Line selected.
    pub at: usize,
    /// Whether it is being written.
    pub is_busy: bool,
    /// Why it could not be, or what is missing.
    pub problem: Option<String>,
}

impl StudyForm {
    /// Its lines, in order.
    #[must_use]
    pub fn lines(&self) -> Vec<FormLine> {
        let mut lines = vec![FormLine::Name];
        lines.extend((0..self.sizes.len()).map(FormLine::Size));
        lines.extend((0..self.subjects.len()).map(FormLine::Subject));
        lines.extend((0..self.simulators.len()).map(FormLine::Simulator));
        lines.push(FormLine::Fabric);
        lines
    }

    /// The line selected.
    #[must_use]
    pub fn line(&self) -> FormLine {
        self.lines().get(self.at).copied().unwrap_or(FormLine::Name)
    }

    /// Simulations that the study will have.
    #[must_use]
    pub fn jobs(&self) -> [usize; 3] {
        let sizes = self.sizes.iter().filter(|(_, is_chosen)| *is_chosen).count();
        let subjects = self.subjects.iter().filter(|(_, is_chosen)| *is_chosen).count();
        let simulators = self.simulators.iter().filter(|(_, is_chosen)| *is_chosen).count();
        [subjects, sizes, simulators]
    }

    /// Whether a line is chosen; `None` for those that are not chosen but filled in.
    #[must_use]
    pub fn choice(&self, line: FormLine) -> Option<bool> {
        match line {
            FormLine::Name | FormLine::Fabric => None,
            FormLine::Simulator(k) => Some(self.simulators[k].1),
            FormLine::Size(k) => Some(self.sizes[k].1),
            FormLine::Subject(k) => Some(self.subjects[k].1),
        }
    }

    fn choose(&mut self, line: FormLine, is_chosen: bool) {
        match line {
            FormLine::Name | FormLine::Fabric => {}
            FormLine::Simulator(k) => self.simulators[k].1 = is_chosen,
            FormLine::Size(k) => self.sizes[k].1 = is_chosen,
            FormLine::Subject(k) => self.subjects[k].1 = is_chosen,
        }
    }

    /// Handles a key.
    pub fn key(&mut self, event: &KeyEvent) -> Outcome {
        if self.is_busy {
            return Outcome::Open;
        }
        let (line, last) = (self.line(), self.lines().len() - 1);
        if event.code != KeyCode::Enter {
            self.problem = None;
        }
        match event.code {
            KeyCode::Enter => return self.save(),
            KeyCode::Down => self.at = (self.at + 1).min(last),
            KeyCode::Up => self.at = self.at.saturating_sub(1),
            KeyCode::PageDown => self.at = (self.at + PAGE).min(last),
            KeyCode::PageUp => self.at = self.at.saturating_sub(PAGE),
            KeyCode::Tab => self.go_to_section(1),
            KeyCode::BackTab => self.go_to_section(-1),
            KeyCode::Left if line == FormLine::Fabric => self.next_fabric(-1),
            KeyCode::Right | KeyCode::Char(' ') if line == FormLine::Fabric => self.next_fabric(1),
            _ if line == FormLine::Name => {
                edit(&mut self.name, event);
            }
            KeyCode::Char(' ' | 'x') => {
                if let Some(is_chosen) = self.choice(line) {
                    self.choose(line, !is_chosen);
                }
            }
            KeyCode::Char('a') => self.choose_section(line),
            _ => {}
        }
        Outcome::Open
    }

    /// Goes to the first line of the next part or the one before.
    fn go_to_section(&mut self, step: isize) {
        let lines = self.lines();
        let starts: Vec<usize> =
            (0..lines.len()).filter(|k| *k == 0 || lines[*k].section() != lines[*k - 1].section()).collect();
        let at = starts.iter().rposition(|start| *start <= self.at).unwrap_or(0);
        self.at = starts[(at as isize + step).rem_euclid(starts.len() as isize) as usize];
    }

    fn next_fabric(&mut self, step: isize) {
        let len = self.fabrics.len().max(1) as isize;
        self.fabric = (self.fabric as isize + step).rem_euclid(len) as usize;
    }

    /// Chooses the whole part of a line, or, where all of it is chosen, none.
    fn choose_section(&mut self, line: FormLine) {
        let lines: Vec<FormLine> = self.lines().into_iter().filter(|other| other.section() == line.section()).collect();
        let all = lines.iter().all(|other| self.choice(*other) != Some(false));
        for other in lines {
            self.choose(other, !all);
        }
    }

    /// Sends it off, or goes to what is missing.
    fn save(&mut self) -> Outcome {
        let [subjects, sizes, simulators] = self.jobs();
        let missing = [
            (self.name.trim().is_empty(), "name", "a study needs a name"),
            (sizes == 0, "styles and sizes", "choose a size of a style with Space; a chooses all"),
            (subjects == 0, "subjects", "choose a subject with Space; a chooses all"),
            (simulators == 0, "simulators", "choose a simulator with Space"),
            (self.fabrics.is_empty(), "fabric", "the catalogue has no fabric: screen 9 imports some"),
        ];
        if let Some((_, section, problem)) = missing.into_iter().find(|(is_missing, ..)| *is_missing) {
            self.at = self.lines().iter().position(|line| line.section() == section).unwrap_or(0);
            self.problem = Some(problem.to_owned());
            return Outcome::Open;
        }
        fn chosen<T: Clone>(all: &[(T, bool)]) -> Vec<T> {
            all.iter().filter(|(_, is_chosen)| *is_chosen).map(|(one, _)| one.clone()).collect()
        }
        let new = NewStudy {
            name: self.name.trim().to_owned(),
            folder: self.folder.clone(),
            subjects: chosen(&self.subjects),
            sizes: chosen(&self.sizes),
            fabric: self.fabrics[self.fabric].clone(),
            simulators: chosen(&self.simulators),
        };
        (self.is_busy, self.problem) = (true, None);
        Outcome::Sent(vec![Effect::Errand(Errand::CreateStudy(new))])
    }
}

impl State {
    /// Asks what a new study is made of.
    pub(super) fn new_study(&mut self) {
        let Some(data) = &self.data else { return };
        if !self.setup.abilities.run {
            self.complain("this workbench is read-only: start it without --readonly to make a study");
            return;
        }
        let names: Vec<&str> = data.studies.iter().map(|study| study.name.as_str()).collect();
        let name = (1..).map(|k| format!("study-{k}")).find(|name| !names.contains(&name.as_str())).unwrap_or_default();
        let fabrics: Vec<String> = data.fabrics.iter().map(|row| row.fabric.name.clone()).collect();
        let form = StudyForm {
            name,
            folder: self.setup.places.studies.clone(),
            fabric: fabrics.iter().position(|name| name == USUAL_FABRIC).unwrap_or(0),
            fabrics,
            simulators: study::SIMULATORS.map(|simulator| (simulator, true)).to_vec(),
            sizes: wearables(&data.sizes).into_iter().map(|wearable| (wearable, false)).collect(),
            subjects: data.subjects.iter().map(|row| (row.name.clone(), false)).collect(),
            at: 0,
            is_busy: false,
            problem: None,
        };
        self.overlay = Some(Overlay::StudyForm(Box::new(form)));
    }

    /// Opens a study that was made, or says in the form why it was not.
    pub(super) fn study_created(&mut self, name: &str, outcome: Result<PathBuf, String>) {
        match (outcome, &mut self.overlay) {
            (Ok(path), overlay) => {
                if matches!(overlay, Some(Overlay::StudyForm(_))) {
                    *overlay = None;
                }
                self.show(Screen::Study);
                (self.cells.focus.study, self.cells.focus.garment, self.cells.focus.job) =
                    (Some(name.to_owned()), None, None);
                self.say(format!("{} is written and its jobs are queued: R runs them", path.display()));
            }
            (Err(text), Some(Overlay::StudyForm(form))) => (form.is_busy, form.problem) = (false, Some(text)),
            (Err(text), _) => self.complain(text),
        }
    }
}

//! What is done to the entries of the catalogue that are filled in line by line: subjects and fabrics.

use super::action::Screen;
use super::form::{Form, PathPrompt};
use super::message::{Act, Effect};
use super::overlay::Overlay;
use super::state::State;
use study::{FABRIC_NUMBERS, FabricRow, Mode, Part};

/// Measurements in the list of subjects: stature, weight, chest, waist, hip.
pub const SHOWN: usize = 5;
/// Numbers in the list of fabrics, by their places in [`FABRIC_NUMBERS`].
pub const FABRIC_SHOWN: [usize; 7] = [0, 1, 2, 3, 5, 6, 7];

/// How fabrics are ordered.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum FabricOrder {
    /// By name.
    #[default]
    Name,
    /// By a number of [`FABRIC_SHOWN`], the smallest first.
    Number(usize),
}

impl FabricOrder {
    /// The next one.
    #[must_use]
    pub fn next(self) -> Self {
        match self {
            Self::Name => Self::Number(0),
            Self::Number(k) if k + 1 < FABRIC_SHOWN.len() => Self::Number(k + 1),
            Self::Number(_) => Self::Name,
        }
    }
}

/// The screen that shows a part of the catalogue.
fn screen_of(part: Part) -> Screen {
    match part {
        Part::Subject => Screen::Subjects,
        Part::Fabric => Screen::Fabrics,
        Part::Style | Part::Size => Screen::Styles,
    }
}

impl State {
    /// Fabrics that pass the filter of the Fabrics screen, in its order.
    #[must_use]
    pub fn fabrics(&self) -> Vec<&FabricRow> {
        let Some(data) = &self.data else { return vec![] };
        let filter = self.nav.filters[Screen::Fabrics as usize].to_lowercase();
        let words = |row: &FabricRow| format!("{} {}", row.fabric.name, row.fabric.source).to_lowercase();
        let mut fabrics: Vec<&FabricRow> = data.fabrics.iter().filter(|row| words(row).contains(&filter)).collect();
        if let FabricOrder::Number(k) = self.fabrics.order.by {
            let field = &FABRIC_NUMBERS[FABRIC_SHOWN[k]];
            let value = |row: &FabricRow| field.get(&row.fabric).unwrap_or(f64::INFINITY);
            fabrics.sort_by(|a, b| value(a).total_cmp(&value(b)));
        }
        if self.fabrics.order.reversed {
            fabrics.reverse();
        }
        fabrics
    }

    /// The selected fabric: the first, where the one wanted is not shown.
    #[must_use]
    pub fn fabric(&self) -> Option<&FabricRow> {
        let fabrics = self.fabrics();
        fabrics.iter().find(|row| Some(&row.fabric.name) == self.fabrics.chosen.as_ref()).or(fabrics.first()).copied()
    }

    /// Asks for the values of a new entry: a fabric starts as the selected one, a style with its files.
    pub(super) fn add_entry(&mut self, part: Part) {
        if !self.may_change(part) {
            return;
        }
        let all = self.data.as_ref().map_or(&[][..], |data| &data.fabrics);
        let form = match part {
            Part::Fabric => self.fabric().map(|row| Form::of_fabric(row, Mode::Add, all)),
            _ => Some(Form::new_subject()),
        };
        match form {
            Some(form) => self.overlay = Some(Overlay::Form(Box::new(form))),
            None => self.say("no fabric is selected that a new one could start with: Esc clears the filter"),
        }
    }

    /// Asks for other values of the selected entry.
    pub(super) fn edit_entry(&mut self, part: Part) {
        if !self.may_change(part) {
            return;
        }
        let all = self.data.as_ref().map_or(&[][..], |data| &data.fabrics);
        let form = match part {
            Part::Fabric => self.fabric().map(|row| Form::of_fabric(row, Mode::Edit, all)),
            _ => self.subject().map(Form::of_subject),
        };
        match form {
            Some(form) => self.overlay = Some(Overlay::Form(Box::new(form))),
            None => self.say(format!("no {part} is selected")),
        }
    }

    /// Asks for a file with entries.
    pub(super) fn import_entries(&mut self, part: Part) {
        if self.may_change(part) {
            self.overlay = Some(Overlay::Path(PathPrompt::import(part)));
        }
    }

    /// Removes the selected entry, once that is confirmed.
    pub(super) fn remove_entry(&mut self, part: Part) {
        if !self.may_change(part) {
            return;
        }
        let name = match part {
            Part::Fabric => self.fabric().map(|row| row.fabric.name.clone()),
            _ => self.subject().map(|row| row.name.clone()),
        };
        let Some(name) = name else { return self.say(format!("no {part} is selected")) };
        let text = format!("Remove {part} {name}? Results that use it stay as they are.");
        self.ask(text, vec![Effect::Do(Act::Remove(part, name))]);
    }

    /// Goes to the screen of a part; says why where nothing may be changed.
    pub(super) fn may_change(&mut self, part: Part) -> bool {
        let screen = screen_of(part);
        self.show(screen);
        if !self.setup.abilities.run {
            let what = screen.names()[0].to_lowercase();
            self.complain(format!("this workbench is read-only: start it without --readonly to change {what}"));
        }
        self.setup.abilities.run
    }

    /// Closes what was filled in once it is saved, or says in it why it is not.
    pub(super) fn saved(&mut self, outcome: Result<String, String>) {
        let waits = match &mut self.overlay {
            Some(Overlay::Form(form)) if form.is_busy => Some((&mut form.is_busy, &mut form.problem)),
            Some(Overlay::StyleForm(form)) if form.is_busy => {
                match outcome {
                    Err(text) => form.refused(text),
                    Ok(text) => {
                        self.styles.selected = Some((form.style(), form.size()));
                        self.overlay = None;
                        self.say(text);
                    }
                }
                return;
            }
            Some(Overlay::Path(prompt)) if prompt.is_busy => Some((&mut prompt.is_busy, &mut prompt.problem)),
            _ => None,
        };
        match (outcome, waits) {
            (Err(text), Some((is_busy, problem))) => {
                *is_busy = false;
                *problem = Some(text);
            }
            (Err(text), None) => self.complain(text),
            (Ok(text), waits) => {
                if waits.is_some()
                    && let Some(Overlay::Form(form)) = self.overlay.take()
                {
                    let selected =
                        if form.part == Part::Fabric { &mut self.fabrics.chosen } else { &mut self.subjects.chosen };
                    *selected = Some(form.name().to_owned());
                }
                self.say(text);
            }
        }
    }
}

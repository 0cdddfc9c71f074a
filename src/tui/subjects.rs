//! What is done to the subjects of the catalogue.

use super::action::Screen;
use super::form::{Form, PathPrompt};
use super::message::{Act, Effect};
use super::overlay::Overlay;
use super::state::State;

/// Measurements in the list of subjects: stature, weight, chest, waist, hip.
pub const SHOWN: usize = 5;

impl State {
    /// Asks for the values of a new subject.
    pub(super) fn add_subject(&mut self) {
        if self.may_change_subjects() {
            self.overlay = Some(Overlay::Form(Box::new(Form::empty())));
        }
    }

    /// Asks for other values of the selected subject.
    pub(super) fn edit_subject(&mut self) {
        if !self.may_change_subjects() {
            return;
        }
        match self.subject().map(Form::of) {
            Some(form) => self.overlay = Some(Overlay::Form(Box::new(form))),
            None => self.say("no subject is selected"),
        }
    }

    /// Asks for a file with subjects.
    pub(super) fn import_subjects(&mut self) {
        if self.may_change_subjects() {
            self.overlay = Some(Overlay::Path(PathPrompt::subjects()));
        }
    }

    /// Removes the selected subject, once that is confirmed.
    pub(super) fn remove_subject(&mut self) {
        if !self.may_change_subjects() {
            return;
        }
        let Some(name) = self.subject().map(|row| row.name.clone()) else {
            self.say("no subject is selected");
            return;
        };
        let text = format!("Remove subject {name}? Results that use it stay as they are.");
        self.ask(text, vec![Effect::Do(Act::RemoveSubject(name))]);
    }

    /// Goes to the Subjects screen; says why where nothing may be changed.
    fn may_change_subjects(&mut self) -> bool {
        self.show(Screen::Subjects);
        if !self.abilities.run {
            self.complain("this workbench is read-only: start it without --readonly to change subjects");
        }
        self.abilities.run
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
                    self.subject = Some(form.name().to_owned());
                }
                self.say(text);
            }
        }
    }
}

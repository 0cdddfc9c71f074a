//! What is done to the entries of the catalogue that are filled in line by line: subjects and fabrics.

use crate::keys::action::Action;
use crate::keys::screen::Screen;
use crate::messages::effect::Effect;
use crate::messages::requests::Command;
use crate::overlays::Overlay;
use crate::overlays::entry_form::Form;
use crate::overlays::path_prompt::PathPrompt;
use crate::screens::state::State;
use wardrobe::{Mode, Part};

/// The screen that shows a part of the catalogue.
fn screen_of(part: Part) -> Screen {
    match part {
        Part::Subject => Screen::Subjects,
        Part::Fabric => Screen::Fabrics,
        Part::Style | Part::Size => Screen::Styles,
    }
}

/// Does an action on the entries of a part; `None` where it is about none of them.
pub fn act(state: &mut State, own: Part, action: Action) -> Option<Vec<Effect>> {
    match action {
        Action::Add(part) if part == own => state.add_entry(part),
        Action::Edit(part) if part == own => state.edit_entry(part),
        Action::Import(part) if part == own => state.import_entries(part),
        Action::Remove(part) if part == own => state.remove_entry(part),
        _ => return None,
    }
    Some(vec![])
}

impl State {
    /// Asks for the values of a new entry: a fabric starts as the selected one, a style with its files.
    pub fn add_entry(&mut self, part: Part) {
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
    pub fn edit_entry(&mut self, part: Part) {
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
    pub fn import_entries(&mut self, part: Part) {
        if self.may_change(part) {
            self.overlay = Some(Overlay::Path(PathPrompt::import(part)));
        }
    }

    /// Removes the selected entry, once that is confirmed.
    pub fn remove_entry(&mut self, part: Part) {
        if !self.may_change(part) {
            return;
        }
        let name = match part {
            Part::Fabric => self.fabric().map(|row| row.fabric.name.clone()),
            _ => self.subject().map(|row| row.name.clone()),
        };
        let Some(name) = name else { return self.say(format!("no {part} is selected")) };
        let text = format!("Remove {part} {name}? Results that use it stay as they are.");
        self.ask(text, vec![Effect::Do(Command::Remove(part, name))]);
    }

    /// Goes to the screen of a part; says why where nothing may be changed.
    pub fn may_change(&mut self, part: Part) -> bool {
        let screen = screen_of(part);
        self.show(screen);
        if !self.setup.abilities.run {
            let what = screen.names()[0].to_lowercase();
            self.complain(format!("this workbench is read-only: start it without --readonly to change {what}"));
        }
        self.setup.abilities.run
    }

    /// Closes what was filled in once it is saved, or says in it why it is not.
    pub fn saved(&mut self, outcome: Result<String, String>) {
        let awaited = self.told.awaited.take();
        self.told.commands.extend(awaited.filter(|_| outcome.is_ok()));
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

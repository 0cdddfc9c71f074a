//! Adding, editing, importing and removing the entries of the catalogue that are filled in line by line: subjects and
//! fabrics.

use crate::keys::screen::Screen;
use crate::messages::effect::Effect;
use crate::messages::requests::Command;
use crate::overlays::Overlay;
use crate::overlays::entry_form::Form;
use crate::overlays::path_prompt::{PathPrompt, Purpose};
use crate::screens::state::State;
use wardrobe::Part;

/// The screen that shows a part of the catalogue.
fn screen_of(part: Part) -> Screen {
    match part {
        Part::Subject => Screen::Subjects,
        Part::Fabric => Screen::Fabrics,
        Part::Style | Part::Size => Screen::Styles,
    }
}

/// Goes to the screen of a part; returns true if it may be changed, and says why where it may not.
pub fn may_change(state: &mut State, part: Part) -> bool {
    let screen = screen_of(part);
    state.show(screen);
    if !state.setup.abilities.run {
        let entries = screen.names()[0].to_lowercase();
        state.complain(format!("this workbench is read-only: start it without --readonly to change {entries}"));
    }
    state.setup.abilities.run
}

/// Opens the form of an entry, or says why there is none.
pub fn fill_in(state: &mut State, form: Option<Form>, otherwise: &str) {
    match form {
        Some(form) => state.overlay = Some(Overlay::Form(Box::new(form))),
        None => state.say(otherwise),
    }
}

/// Asks for a file with entries.
pub fn import(state: &mut State, part: Part) {
    if may_change(state, part) {
        state.overlay = Some(Overlay::Path(PathPrompt::new(Purpose::Import(part), "")));
    }
}

/// Removes an entry by its name, once that is confirmed.
pub fn remove(state: &mut State, part: Part, name: Option<String>) {
    let Some(name) = name else { return state.say(format!("no {part} is selected")) };
    let text = format!("Remove {part} {name}? Results that use it stay as they are.");
    state.ask(text, vec![Effect::Do(Command::Remove(part, name))]);
}

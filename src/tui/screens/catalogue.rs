//! Adding, editing, importing and removing the entries of the catalogue that have forms: subjects and fabrics.

use crate::keys::screen::Screen;
use crate::messages::effect::Effect;
use crate::messages::requests::Command;
use crate::overlays::Overlay;
use crate::overlays::entry_form::Form;
use crate::overlays::path_prompt::{PathPrompt, Purpose};
use crate::screens::state::State;
use wardrobe::Part;

/// Screen of a part of the catalogue.
fn screen_of(part: Part) -> Screen {
    match part {
        Part::Subject => Screen::Subjects,
        Part::Fabric => Screen::Fabrics,
        Part::Style | Part::Size => Screen::Styles,
    }
}

/// Shows the screen of a part. Returns true if the part may be changed; else says why not.
pub fn may_change(state: &mut State, part: Part) -> bool {
    let screen = screen_of(part);
    state.show(screen);
    if !state.setup.abilities.run {
        let entries = screen.names()[0].to_lowercase();
        state.complain(format!("this workbench is read-only: start it without --readonly to change {entries}"));
    }
    state.setup.abilities.run
}

/// Opens a form; without one says `otherwise`.
pub fn fill_in(state: &mut State, form: Option<Form>, otherwise: &str) {
    match form {
        Some(form) => state.overlay = Some(Overlay::Form(Box::new(form))),
        None => state.say(otherwise),
    }
}

/// Opens the prompt for a file with entries.
pub fn import(state: &mut State, part: Part) {
    if may_change(state, part) {
        state.overlay = Some(Overlay::Path(PathPrompt::new(Purpose::Import(part), "")));
    }
}

/// Removes an entry by name, after a question.
pub fn remove(state: &mut State, part: Part, name: Option<String>) {
    let Some(name) = name else { return state.say(format!("no {part} is selected")) };
    let text = format!("Remove {part} {name}? Results that use it stay as they are.");
    state.ask(text, vec![Effect::Do(Command::Remove(part, name))]);
}

//! Adding, editing, importing and removing the entries of the catalogue that have forms: subjects and fabrics.

use crate::keys::action::Action;
use crate::keys::screen::Screen;
use crate::messages::effect::Effect;
use crate::messages::requests::Command;
use crate::overlays::Overlay;
use crate::overlays::entry_form::Form;
use crate::overlays::path_prompt::{PathPrompt, Purpose};
use crate::screens::marks::Marks;
use crate::screens::state::State;
use wardrobe::Part;

/// Most entries that a question names.
const NAMED: usize = 5;

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

/// Says `otherwise` without a form.
pub fn fill_in(state: &mut State, form: Option<Form>, otherwise: &str) {
    match form {
        Some(form) => state.overlay = Some(Overlay::Form(Box::new(form))),
        None => state.say(otherwise),
    }
}

pub fn import(state: &mut State, part: Part) {
    if may_change(state, part) {
        state.overlay = Some(Overlay::Path(PathPrompt::new(Purpose::Import(part), "")));
    }
}

/// Removes the marked entries of a list that are shown, after a question; without marks, the selected one.
pub fn remove_marked(state: &mut State, part: Part, marks: &Marks<String>, shown: &[String], selected: Option<String>) {
    if marks.is_empty() {
        return remove(state, part, selected.into_iter().collect());
    }
    match marks.seen(shown) {
        (seen, 0) => remove(state, part, seen),
        (seen, hidden) if seen.is_empty() => state.say(format!("{}: nothing is removed", hidden_words(hidden))),
        (seen, hidden) => {
            remove(state, part, seen);
            if let Some(Overlay::Question { text, .. }) = &mut state.overlay {
                text.push_str(&format!(" {}: not touched.", hidden_words(hidden)));
            }
        }
    }
}

/// Number of selected rows that are not on the screen, in words.
pub fn hidden_words(hidden: usize) -> String {
    match hidden {
        1 => "1 more is selected that is not seen here".to_owned(),
        hidden => format!("{hidden} more are selected that are not seen here"),
    }
}

/// Removes entries by name, after a question.
pub fn remove(state: &mut State, part: Part, names: Vec<String>) {
    let what = match &names[..] {
        [] => return state.say(format!("no {part} is selected")),
        [name] => format!("{part} {name}"),
        [names @ .., last] if names.len() < NAMED => {
            format!("{} {part}s: {} and {last}", names.len() + 1, names.join(", "))
        }
        names => {
            let (named, others) = names.split_at(NAMED);
            format!("{} {part}s: {} and {} others", names.len(), named.join(", "), others.len())
        }
    };
    let text = format!("Remove {what}? Results that use it stay as they are.");
    state.ask(text, names.into_iter().map(|name| Effect::Do(Command::Remove(part, name))).collect());
}

/// Returns `None` for an action that is not about marks. `selected` is the selected row.
pub fn mark(
    state: &mut State,
    marks: &mut Marks<String>,
    action: Action,
    shown: &[String],
    selected: Option<&String>,
) -> Option<Vec<Effect>> {
    match (action, selected) {
        (Action::Mark, Some(name)) => marks.toggle(name.clone()),
        (Action::MarkRange, Some(name)) => marks.extend_to(shown, name.clone()),
        (Action::MarkAll, _) => marks.toggle_all(shown),
        (Action::Unmark, _) => marks.clear(),
        _ => return None,
    }
    let told = match marks.len() {
        0 => "none is selected".to_owned(),
        1 => "1 is selected; d removes it, u takes it back".to_owned(),
        n => format!("{n} are selected; d removes them, u takes all back"),
    };
    state.say(told);
    Some(vec![])
}

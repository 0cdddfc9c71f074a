//! What opens above a screen: help, the palette, the filter line, questions. Each owns the keyboard while it is open.

use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};

use super::action::{Action, Binding, search};
use super::form::{Form, PathPrompt};
use super::message::Effect;
use super::sql::QueryList;
use super::study_form::StudyForm;
use super::style_form::StyleForm;

/// What is open.
#[derive(Clone, Debug, PartialEq)]
pub enum Overlay {
    /// The list of keys.
    Help(List),
    /// The list of actions.
    Palette(List),
    /// The filter line, with the filter to go back to.
    Filter(String),
    /// The values of a subject.
    Form(Box<Form>),
    /// The path of a file to import.
    Path(PathPrompt),
    /// The files of a style.
    StyleForm(Box<StyleForm>),
    /// What a new study is made of.
    StudyForm(Box<StudyForm>),
    /// Saved queries.
    Queries(QueryList),
    /// A question; `y` has the effects happen.
    Question {
        /// What is asked.
        text: String,
        /// What happens on yes.
        effects: Vec<Effect>,
    },
}

/// A list that what is typed narrows.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct List {
    /// All that can be in it.
    pub bindings: &'static [Binding],
    /// What is typed.
    pub text: String,
    /// Row selected.
    pub row: usize,
}

impl List {
    /// All of a table of keys.
    #[must_use]
    pub fn of(bindings: &'static [Binding]) -> Self {
        Self { bindings, text: String::new(), row: 0 }
    }

    /// Its rows: the keys of the table order where nothing is typed, the best match first otherwise.
    #[must_use]
    pub fn rows(&self) -> Vec<&'static Binding> {
        if self.text.is_empty() { self.bindings.iter().collect() } else { search(self.bindings, &self.text) }
    }

    fn edit(&mut self, event: &KeyEvent) {
        match event.code {
            KeyCode::Up => self.row = self.row.saturating_sub(1),
            KeyCode::Down => self.row += 1,
            KeyCode::PageUp => self.row = self.row.saturating_sub(10),
            KeyCode::PageDown => self.row += 10,
            _ => {
                if edit(&mut self.text, event) {
                    self.row = 0;
                }
            }
        }
        self.row = self.row.min(self.rows().len().saturating_sub(1));
    }
}

/// What a key did to an overlay.
#[derive(Debug, PartialEq)]
pub enum Outcome {
    /// It stays open.
    Open,
    /// It closes.
    Closed,
    /// It closes and an action follows.
    Act(Action),
    /// It closes and a query goes into the editor.
    Query(String),
    /// It closes and effects follow.
    Effects(Vec<Effect>),
    /// It stays open until what it asked for is done.
    Sent(Vec<Effect>),
}

impl Overlay {
    /// Handles a key; `filter` is the screen's filter.
    pub fn key(&mut self, event: &KeyEvent, filter: &mut String) -> Outcome {
        let leaves = event.code == KeyCode::Esc || is_ctrl_c(event);
        match self {
            Self::Help(_) | Self::Palette(_) if leaves => Outcome::Closed,
            Self::Help(list) | Self::Palette(list) if event.code == KeyCode::Enter => {
                list.rows().get(list.row).map_or(Outcome::Open, |binding| Outcome::Act(binding.action))
            }
            Self::Help(list) | Self::Palette(list) => {
                list.edit(event);
                Outcome::Open
            }
            Self::Form(_) | Self::Path(_) | Self::StyleForm(_) | Self::StudyForm(_) | Self::Queries(_) if leaves => {
                Outcome::Closed
            }
            Self::StudyForm(form) => form.key(event),
            Self::Queries(list) => list.key(event).map_or(Outcome::Open, Outcome::Query),
            Self::Form(form) => form.key(event),
            Self::Path(prompt) => prompt.key(event),
            Self::StyleForm(form) => form.key(event),
            Self::Filter(before) if leaves => {
                filter.clone_from(before);
                Outcome::Closed
            }
            Self::Filter(_) if event.code == KeyCode::Enter => Outcome::Closed,
            Self::Filter(_) => {
                edit(filter, event);
                Outcome::Open
            }
            Self::Question { effects, .. } => match event.code {
                KeyCode::Char('y' | 'Y') => Outcome::Effects(std::mem::take(effects)),
                _ => Outcome::Closed,
            },
        }
    }
}

fn is_ctrl_c(event: &KeyEvent) -> bool {
    event.code == KeyCode::Char('c') && event.modifiers.contains(KeyModifiers::CONTROL)
}

/// Edits a line at its end; returns whether it changed.
pub(super) fn edit(text: &mut String, event: &KeyEvent) -> bool {
    let ctrl = event.modifiers.contains(KeyModifiers::CONTROL);
    match event.code {
        KeyCode::Char('u') if ctrl => text.clear(),
        KeyCode::Char('w') if ctrl => text.truncate(text.trim_end().rfind(' ').map_or(0, |at| at + 1)),
        KeyCode::Char(letter) if !ctrl => text.push(letter),
        KeyCode::Backspace => return text.pop().is_some(),
        _ => return false,
    }
    true
}

#[cfg(test)]
mod tests {
    use super::super::bindings::BINDINGS;
    use super::*;

    fn press(code: KeyCode) -> KeyEvent {
        KeyEvent::new(code, KeyModifiers::NONE)
    }

    fn typed(overlay: &mut Overlay, filter: &mut String, text: &str) {
        for letter in text.chars() {
            assert_eq!(overlay.key(&press(KeyCode::Char(letter)), filter), Outcome::Open);
        }
    }

    #[test]
    fn the_palette_runs_what_is_typed() {
        let (mut palette, mut filter) = (Overlay::Palette(List::of(BINDINGS)), String::new());
        typed(&mut palette, &mut filter, "canx");
        palette.key(&press(KeyCode::Backspace), &mut filter);
        assert_eq!(palette.key(&press(KeyCode::Enter), &mut filter), Outcome::Act(Action::Cancel));
        typed(&mut palette, &mut filter, "zzz");
        assert_eq!(palette.key(&press(KeyCode::Enter), &mut filter), Outcome::Open, "nothing matches");
    }

    #[test]
    fn every_action_can_be_reached_from_the_palette() {
        for binding in BINDINGS {
            let (mut palette, mut filter) = (Overlay::Palette(List::of(BINDINGS)), String::new());
            typed(&mut palette, &mut filter, binding.name);
            assert_eq!(palette.key(&press(KeyCode::Enter), &mut filter), Outcome::Act(binding.action));
        }
    }

    #[test]
    fn the_filter_line_edits_and_gives_back() {
        let (mut line, mut filter) = (Overlay::Filter("old".into()), String::new());
        typed(&mut line, &mut filter, "tee fem");
        line.key(&KeyEvent::new(KeyCode::Char('w'), KeyModifiers::CONTROL), &mut filter);
        assert_eq!(filter, "tee ");
        assert_eq!(line.key(&press(KeyCode::Esc), &mut filter), Outcome::Closed);
        assert_eq!(filter, "old");
    }

    #[test]
    fn only_yes_is_yes() {
        let question = || Overlay::Question { text: "?".into(), effects: vec![Effect::Quit] };
        for code in [KeyCode::Enter, KeyCode::Esc, KeyCode::Char('n'), KeyCode::Char(' ')] {
            assert_eq!(question().key(&press(code), &mut String::new()), Outcome::Closed);
        }
        let yes = question().key(&press(KeyCode::Char('y')), &mut String::new());
        assert_eq!(yes, Outcome::Effects(vec![Effect::Quit]));
    }
}

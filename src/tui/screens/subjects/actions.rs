//! Choosing, adding, editing and removing a subject.

use crate::keys::screen::Screen;
use crate::overlays::entry_form::Form;
use crate::screens::catalogue;
use crate::screens::movement::Movement;
use crate::screens::state::State;
use crate::screens::subjects::state::{SHOWN, SubjectOrder, SubjectsScreen};
use crate::widgets::text;
use spec::bodies::Measurements;
use spec::{Field, MEASUREMENTS};
use wardrobe::{Part, SubjectRow};

impl SubjectsScreen {
    pub fn shown<'a>(&self, state: &'a State) -> Vec<&'a SubjectRow> {
        let Some(data) = &state.data else { return vec![] };
        let filter = state.filter_of(Screen::Subjects);
        let matches = |row: &&SubjectRow| words(row).to_lowercase().contains(&filter);
        let mut subjects: Vec<&SubjectRow> = data.subjects.iter().filter(matches).collect();
        match self.order.by {
            SubjectOrder::Name => {}
            SubjectOrder::Sex => subjects.sort_by_key(|row| text::sex(row)),
            SubjectOrder::Measurement(k) => {
                let value = |row: &SubjectRow| MEASUREMENTS[k].get(&row.measurements).unwrap_or(f64::INFINITY);
                subjects.sort_by(|a, b| value(a).total_cmp(&value(b)));
            }
        }
        if self.order.reversed {
            subjects.reverse();
        }
        subjects
    }

    /// Returns 0 where the chosen subject is not shown.
    pub fn index_in(&self, shown: &[&SubjectRow]) -> usize {
        shown.iter().position(|row| Some(&row.name) == self.chosen.as_ref()).unwrap_or(0)
    }

    pub fn selected<'a>(&self, state: &'a State) -> Option<&'a SubjectRow> {
        let shown = self.shown(state);
        shown.get(self.index_in(&shown)).copied()
    }

    pub fn go_in_list(&mut self, state: &State, movement: Movement) {
        let shown = self.shown(state);
        let next = shown.get(movement.from(self.index_in(&shown), shown.len()));
        self.chosen = next.map(|row| row.name.clone());
    }

    pub fn edit(&self, state: &mut State) {
        if catalogue::may_change(state, Part::Subject) {
            let form = self.selected(state).map(Form::of_subject);
            catalogue::fill_in(state, form, "no subject is selected");
        }
    }

    /// Removes the marked subjects or the selected one, after a question.
    pub fn remove(&self, state: &mut State) {
        if catalogue::may_change(state, Part::Subject) {
            let selected = self.selected(state).map(|row| row.name.clone());
            let shown: Vec<String> = self.shown(state).iter().map(|row| row.name.clone()).collect();
            catalogue::remove_marked(state, Part::Subject, &self.marks, &shown, selected);
        }
    }

    /// Selected subject as text, separated by tabs.
    pub fn line(&self, state: &State) -> Option<String> {
        let subject = self.selected(state)?;
        let value = |field: &Field<Measurements>| {
            field.get(&subject.measurements).map_or(String::new(), |value| value.to_string())
        };
        let values: Vec<String> = MEASUREMENTS.iter().map(value).collect();
        Some(format!("{}\t{}\t{}", subject.name, text::sex(subject), values.join("\t")))
    }
}

/// Text of a subject to which the filter applies: what its line shows.
fn words(row: &SubjectRow) -> String {
    let shown = MEASUREMENTS.iter().take(SHOWN).map(|field| number(field.get(&row.measurements), field.key));
    format!("{} {} {}", row.name, text::sex(row), shown.collect::<Vec<_>>().join(" "))
}

/// Text of a measurement: lengths in whole mm, weights with one decimal.
pub fn number(value: Option<f64>, key: &str) -> String {
    match value {
        None => "—".to_owned(),
        Some(value) if key.ends_with("_kg") => format!("{value:.1}"),
        Some(value) => format!("{value:.0}"),
    }
}

pub fn add(state: &mut State) {
    if catalogue::may_change(state, Part::Subject) {
        catalogue::fill_in(state, Some(Form::new_subject()), "");
    }
}

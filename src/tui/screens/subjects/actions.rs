//! Choosing a subject.

use crate::keys::screen::Screen;
use crate::screens::movement::Movement;
use crate::screens::state::State;
use crate::screens::subjects::state::SubjectOrder;
use crate::widgets::text;
use spec::bodies::Measurements;
use spec::{Field, MEASUREMENTS};
use wardrobe::SubjectRow;

impl State {
    /// Subjects that pass the filter of the Subjects screen, in its order.
    #[must_use]
    pub fn subjects(&self) -> Vec<&SubjectRow> {
        let Some(data) = &self.data else { return vec![] };
        let filter = self.nav.filters[Screen::Subjects as usize].to_lowercase();
        let matches = |row: &&SubjectRow| format!("{} {}", row.name, text::sex(row)).to_lowercase().contains(&filter);
        let mut subjects: Vec<&SubjectRow> = data.subjects.iter().filter(matches).collect();
        match self.subjects.order.by {
            SubjectOrder::Name => {}
            SubjectOrder::Sex => subjects.sort_by_key(|row| text::sex(row)),
            SubjectOrder::Measurement(k) => {
                let value = |row: &SubjectRow| MEASUREMENTS[k].get(&row.measurements).unwrap_or(f64::INFINITY);
                subjects.sort_by(|a, b| value(a).total_cmp(&value(b)));
            }
        }
        if self.subjects.order.reversed {
            subjects.reverse();
        }
        subjects
    }

    /// The selected subject: the first, where the one wanted is not shown.
    #[must_use]
    pub fn subject(&self) -> Option<&SubjectRow> {
        let subjects = self.subjects();
        subjects.iter().find(|row| Some(&row.name) == self.subjects.chosen.as_ref()).or(subjects.first()).copied()
    }

    /// Moves in the list of subjects.
    pub fn go_in_subjects(&mut self, movement: Movement) {
        let selected = self.subject().map(|row| row.id);
        let subjects = self.subjects();
        let at = subjects.iter().position(|row| Some(row.id) == selected).unwrap_or(0);
        self.subjects.chosen = subjects.get(movement.from(at, subjects.len())).map(|row| row.name.clone());
    }
}

/// The selected subject, tab-separated.
pub fn subject_line(state: &State) -> Option<String> {
    let subject = state.subject()?;
    let value = |field: &Field<Measurements>| field.get(&subject.measurements).map_or(String::new(), |v| v.to_string());
    let values: Vec<String> = MEASUREMENTS.iter().map(value).collect();
    Some(format!("{}\t{}\t{}", subject.name, text::sex(subject), values.join("\t")))
}

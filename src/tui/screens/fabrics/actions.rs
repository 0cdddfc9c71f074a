//! Choosing, adding, editing and removing a fabric.

use crate::keys::screen::Screen;
use crate::overlays::entry_form::Form;
use crate::screens::catalogue;
use crate::screens::fabrics::state::{FABRIC_SHOWN, FACTORS, FabricOrder, FabricsScreen};
use crate::screens::movement::Movement;
use crate::screens::state::State;
use spec::FABRIC_NUMBERS;
use wardrobe::{FabricRow, Mode, Part};

impl FabricsScreen {
    pub fn shown<'a>(&self, state: &'a State) -> Vec<&'a FabricRow> {
        let Some(data) = &state.data else { return vec![] };
        let filter = state.filter_of(Screen::Fabrics);
        let words = |row: &FabricRow| {
            let numbers = (0..FABRIC_SHOWN.len()).map(|k| number(row, k)).collect::<Vec<_>>().join(" ");
            format!("{} {} {numbers} {}", row.fabric.name, marks(row), row.fabric.source).to_lowercase()
        };
        let mut fabrics: Vec<&FabricRow> = data.fabrics.iter().filter(|row| words(row).contains(&filter)).collect();
        if let FabricOrder::Number(k) = self.order.by {
            let field = &FABRIC_NUMBERS[FABRIC_SHOWN[k]];
            let value = |row: &FabricRow| field.get(&row.fabric).unwrap_or(f64::INFINITY);
            fabrics.sort_by(|a, b| value(a).total_cmp(&value(b)));
        }
        if self.order.reversed {
            fabrics.reverse();
        }
        fabrics
    }

    /// Returns 0 where the chosen fabric is not shown.
    pub fn index_in(&self, shown: &[&FabricRow]) -> usize {
        shown.iter().position(|row| Some(&row.fabric.name) == self.chosen.as_ref()).unwrap_or(0)
    }

    pub fn selected<'a>(&self, state: &'a State) -> Option<&'a FabricRow> {
        let shown = self.shown(state);
        shown.get(self.index_in(&shown)).copied()
    }

    pub fn go_in_list(&mut self, state: &State, movement: Movement) {
        let shown = self.shown(state);
        let next = shown.get(movement.from(self.index_in(&shown), shown.len()));
        self.chosen = next.map(|row| row.fabric.name.clone());
        self.is_picked = true;
    }

    /// Opens the form for a new fabric, with the values of the selected one.
    pub fn add(&self, state: &mut State) {
        if catalogue::may_change(state, Part::Fabric) {
            let otherwise = "no fabric is selected that a new one could start with: Esc clears the filter";
            catalogue::fill_in(state, self.form(state, Mode::Add), otherwise);
        }
    }

    pub fn edit(&self, state: &mut State) {
        if catalogue::may_change(state, Part::Fabric) {
            catalogue::fill_in(state, self.form(state, Mode::Edit), "no fabric is selected");
        }
    }

    fn form(&self, state: &State, mode: Mode) -> Option<Form> {
        let all = state.data.as_ref().map_or(&[][..], |data| &data.fabrics);
        self.selected(state).map(|row| Form::of_fabric(row, mode, all))
    }

    /// Removes the marked fabrics or the selected one, after a question.
    pub fn remove(&self, state: &mut State) {
        if catalogue::may_change(state, Part::Fabric) {
            let selected = self.selected(state).map(|row| row.fabric.name.clone());
            let shown: Vec<String> = self.shown(state).iter().map(|row| row.fabric.name.clone()).collect();
            catalogue::remove_marked(state, Part::Fabric, &self.marks, &shown, selected);
        }
    }

    /// Selected fabric as text, separated by tabs.
    pub fn line(&self, state: &State) -> Option<String> {
        let fabric = &self.selected(state)?.fabric;
        let values =
            FABRIC_NUMBERS.iter().map(|field| field.get(fabric).map_or(String::new(), |value| value.to_string()));
        Some(format!("{}\t{}\t{}", fabric.name, values.collect::<Vec<_>>().join("\t"), fabric.source))
    }
}

/// Marks of a fabric: the user's own, stiffens, coupled, a class.
pub fn marks(row: &FabricRow) -> String {
    let mark = |is_on: bool, mark: char| if is_on { mark } else { ' ' };
    let (law, is_coupled) = (row.fabric.stretched, row.fabric.membrane_coupling_n_m != 0.0);
    [mark(row.is_own, '+'), mark(law.is_some(), 's'), mark(is_coupled, 'c'), mark(row.is_class(), '~')].iter().collect()
}

/// Number as the list shows it, by its index in [`FABRIC_SHOWN`].
pub fn number(row: &FabricRow, k: usize) -> String {
    let value = FABRIC_NUMBERS[FABRIC_SHOWN[k]].get(&row.fabric);
    value.map_or("—".to_owned(), |value| in_four(value * FACTORS[k]))
}

/// A number in at most six columns.
pub fn in_four(value: f64) -> String {
    match value.abs() {
        v if v >= 100.0 => format!("{value:.0}"),
        v if v >= 1.0 => format!("{value:.1}"),
        _ => format!("{value:.2}"),
    }
}

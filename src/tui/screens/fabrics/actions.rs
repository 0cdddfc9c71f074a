//! Choosing a fabric.

use crate::keys::screen::Screen;
use crate::screens::fabrics::state::{FABRIC_SHOWN, FabricOrder};
use crate::screens::movement::Movement;
use crate::screens::state::State;
use spec::FABRIC_NUMBERS;
use wardrobe::FabricRow;

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

    /// Moves in the list of fabrics.
    pub fn go_in_fabrics(&mut self, movement: Movement) {
        let selected = self.fabric().map(|row| row.fabric.name.clone());
        let fabrics = self.fabrics();
        let at = fabrics.iter().position(|row| Some(&row.fabric.name) == selected.as_ref()).unwrap_or(0);
        self.fabrics.chosen = fabrics.get(movement.from(at, fabrics.len())).map(|row| row.fabric.name.clone());
    }
}

/// The selected fabric, tab-separated.
pub fn fabric_line(state: &State) -> Option<String> {
    let fabric = &state.fabric()?.fabric;
    let values = FABRIC_NUMBERS.iter().map(|field| field.get(fabric).map_or(String::new(), |value| value.to_string()));
    Some(format!("{}\t{}\t{}", fabric.name, values.collect::<Vec<_>>().join("\t"), fabric.source))
}

//! The sizes side by side: a row for each quantity, a column for each size.

use ratatui::text::{Line, Span};

use crate::screens::fit::actions::{quantities_shown, worn};
use crate::screens::fit::card::headed;
use crate::screens::fit::state::FitScreen;
use crate::screens::state::State;
use crate::widgets::lists::{first_shown, listed};
use crate::widgets::text::{self, left, shortened};
use results::GarmentWorn;

pub const LEGEND: &str = " mm  → from flat to worn ";
/// Columns for a size.
const SIZE: usize = 17;
/// Fewest and most columns for the name of a quantity.
const NAME: [usize; 2] = [12, 24];

pub fn title(state: &State) -> String {
    let Some(worn) = worn(state) else { return "sizes".to_owned() };
    let simulator = worn.simulator.map_or(String::new(), |simulator| format!(" · {}", text::sim(simulator)));
    format!("sizes · {} on {}{simulator}", worn.card.garment, worn.card.subject)
}

impl FitScreen {
    pub fn size_lines(&self, state: &State, columns: usize, lines: usize, focused: bool) -> Vec<Line<'static>> {
        let Some(worn) = worn(state) else { return vec![Line::raw("reading…")] };
        let name = columns.saturating_sub(worn.sizes.len() * SIZE).clamp(NAME[0], NAME[1]);
        let shown = shown(worn, columns.saturating_sub(name) / SIZE);
        let rows = quantities_shown(state);
        let mut told = vec![header(state, worn, name, &shown)];
        let room = lines.saturating_sub(1);
        let at = self.row.min(rows.len().saturating_sub(1));
        told.extend(listed(&rows, at, room, state.theme.selection(focused), |row| {
            let cell = |size: usize| left(row.cells[size].as_deref().unwrap_or("—"), SIZE - 1) + " ";
            Line::raw(left(&shortened(&row.name, name - 1), name) + &shown.clone().map(cell).collect::<String>())
        }));
        if rows.is_empty() {
            told.push(Line::raw("no quantity matches the filter"));
        }
        told
    }
}

/// Sizes that fit, with the size to wear near the middle.
fn shown(worn: &GarmentWorn, room: usize) -> std::ops::Range<usize> {
    let room = room.max(1).min(worn.sizes.len());
    let to_wear = worn.card.to_wear();
    let at = to_wear.and_then(|wear| worn.sizes.iter().position(|size| size.size == wear.size)).unwrap_or(0);
    let first = first_shown(at, worn.sizes.len(), room);
    first..first + room
}

fn header(state: &State, worn: &GarmentWorn, name: usize, shown: &std::ops::Range<usize>) -> Line<'static> {
    let start = match worn.sizes.len() - shown.len() {
        0 => String::new(),
        more => format!("+ {more} more"),
    };
    let mut spans = vec![Span::styled(left(&start, name), state.theme.dim())];
    for size in &worn.sizes[shown.clone()] {
        let (title, style) = headed(state.theme, &worn.card, &size.size);
        spans.push(Span::styled(left(&title, SIZE), style));
    }
    Line::from(spans)
}

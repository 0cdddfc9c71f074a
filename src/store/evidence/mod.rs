//! Evidence of a study: which simulator has the lower error, judged from pairs of results and stored for
//! `v_recommendation`.

pub(crate) mod judge;
mod published;

use crate::database::Store;
use crate::error::Result;
use crate::evidence::judge::{cells, stored_pairs};
use fit::{self, Cell, Evidence, Pair};

pub use judge::{refresh, update};

/// Name of the study that stands for the printed tables of the thesis.
pub const PUBLISHED: &str = "thesis-published";

/// Evidence from the present results, with an answer for every garment and fit class.
pub fn evidence(store: &Store, study: &str) -> Result<Evidence> {
    let cells = if study == PUBLISHED { cells_of(&pairs(store, study)?) } else { cells(&store.reader, study)? };
    Ok(fit::judge(&cells, &pairs(store, study)?))
}

/// Cases that both simulators have draped.
pub fn pairs(store: &Store, study: &str) -> Result<Vec<Pair>> {
    if study == PUBLISHED { published::pairs(&store.reader) } else { stored_pairs(&store.reader, study) }
}

/// Ease at which both simulators have the same EI, in words; for all garments together where `garment` is `None`.
pub fn crossover_words(store: &Store, study: &str, garment: Option<&str>) -> Result<String> {
    let pairs = pairs(store, study)?;
    let chosen: Vec<&Pair> = pairs.iter().filter(|pair| garment.is_none_or(|name| name == pair.garment)).collect();
    Ok(fit::crossover(&chosen).map_or_else(|| "too few subjects, or one ease".to_owned(), |found| found.to_string()))
}

/// Judges the results of a study again and stores the evidence for `v_recommendation`. Does nothing in a read-only
/// store.
pub fn update_evidence(store: &mut Store, study: &str) -> Result<()> {
    store.writer.as_mut().map_or(Ok(()), |writer| update(writer, study))
}

fn cells_of(pairs: &[Pair]) -> Vec<Cell> {
    let mut cells: Vec<Cell> = Vec::new();
    for pair in pairs {
        let cell = Cell { garment: pair.garment.clone(), class: pair.class };
        if !cells.contains(&cell) {
            cells.push(cell);
        }
    }
    cells.sort_by(|a, b| (&a.garment, a.class).cmp(&(&b.garment, b.class)));
    cells
}

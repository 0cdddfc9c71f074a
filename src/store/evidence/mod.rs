//! The evidence of a study: its pairs from the store, judged, and kept for `v_recommendation`.

pub(crate) mod judge;
mod published;

use crate::database::Store;
use crate::error::Result;
use crate::evidence::judge::{cells, stored_pairs};
use fit::{self, Cell, Evidence, Pair, RuleScore};

pub use judge::{refresh, update};

/// Name under which the thesis's own printed numbers go as a study.
pub const PUBLISHED: &str = "thesis-published";

/// What the results of a study say now: an answer for every garment and fit class that is there.
///
/// # Errors
/// When the database cannot be read.
pub fn evidence(store: &Store, study: &str) -> Result<Evidence> {
    let cells = if study == PUBLISHED { cells_of(&pairs(store, study)?) } else { cells(&store.reader, study)? };
    Ok(fit::judge(&cells, &pairs(store, study)?))
}

/// The cases of a study that both simulators drew.
///
/// # Errors
/// When the database cannot be read.
pub fn pairs(store: &Store, study: &str) -> Result<Vec<Pair>> {
    if study == PUBLISHED { published::pairs(&store.reader) } else { stored_pairs(&store.reader, study) }
}

/// The ease at which the simulators change places, over all garments of a study or one, in words.
///
/// # Errors
/// When the database cannot be read.
pub fn crossover_words(store: &Store, study: &str, garment: Option<&str>) -> Result<String> {
    let pairs = pairs(store, study)?;
    let of: Vec<&Pair> = pairs.iter().filter(|pair| garment.is_none_or(|name| name == pair.garment)).collect();
    Ok(fit::crossover(&of).map_or_else(|| "too few subjects, or one ease".to_owned(), |found| found.to_string()))
}

/// How often the thesis's rule names the simulator with the lower EI in a study, and of how many pairs.
///
/// # Errors
/// When the database cannot be read.
pub fn rule_score(store: &Store, study: &str) -> Result<(RuleScore, usize)> {
    let pairs = pairs(store, study)?;
    Ok((fit::rule_score(&pairs), pairs.len()))
}

/// Judges a study's results again and keeps that for `v_recommendation`; nothing happens in a read-only store.
///
/// # Errors
/// When the database cannot be read or written.
pub fn update_evidence(store: &mut Store, study: &str) -> Result<()> {
    store.writer.as_mut().map_or(Ok(()), |writer| update(writer, study))
}

/// The garments and fit classes that pairs have.
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

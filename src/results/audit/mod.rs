//! Audits: every number recomputed from the ones it was made of, and what does not add up.
//!
//! [`audit_thesis`] does this for the thesis's own printed tables,
//! [`audit_study`] for the results of a study of ours.

mod claims;
mod equations;
mod metrics;
mod published;
mod ratios;
mod references;
mod results;
mod rounding;
mod structure;
mod tables;
#[cfg(test)]
mod tests;

use store::{Result, Store, Table, Value};

/// Something that does not add up.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Finding {
    /// Kind of finding (`ratio`, `metric`, `copy`, ...).
    pub kind: &'static str,
    /// Where it stands: table, row, subject; or the job.
    pub place: String,
    /// What is stated there.
    pub stated: String,
    /// What comes out when it is recomputed.
    pub recomputed: String,
    /// What is wrong with it, in words.
    pub says: String,
}

impl Finding {
    /// Findings as a table for reading or for programs.
    #[must_use]
    pub fn table(findings: &[Self]) -> Table {
        let text = |text: &str| Value::Text(text.to_owned());
        let row = |f: &Self| vec![text(f.kind), text(&f.place), text(&f.stated), text(&f.recomputed), text(&f.says)];
        Table {
            columns: ["kind", "place", "stated", "recomputed", "says"].map(str::to_owned).to_vec(),
            rows: findings.iter().map(row).collect(),
        }
    }
}

/// What an audit looked at and what it found.
#[derive(Clone, Debug, PartialEq)]
pub struct Audit {
    /// How many numbers were recomputed.
    pub recomputed: usize,
    /// What does not add up.
    pub findings: Vec<Finding>,
}

/// Recomputes the thesis's printed tables.
///
/// # Errors
/// When the database cannot be read.
pub fn audit_thesis(store: &Store) -> Result<Audit> {
    Ok(published::audit(&tables::Tables::read(&store.reader)?))
}

/// Measures the stored meshes of a study's results again and compares them with what the tables say.
///
/// # Errors
/// When there is no such study or the database cannot be read.
pub fn audit_study(store: &Store, study: &str) -> Result<Audit> {
    results::audit(store, study)
}

/// A number with three decimals, as the thesis prints ratios.
fn three(x: f64) -> String {
    format!("{x:.3}")
}

/// Numbers with three decimals, in a row.
fn threes(numbers: impl IntoIterator<Item = f64>) -> String {
    numbers.into_iter().map(three).collect::<Vec<_>>().join(" ")
}

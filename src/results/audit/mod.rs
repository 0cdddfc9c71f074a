//! Audits: every number is computed again from its parts, and contradictions are listed.
//!
//! [`audit_thesis`] audits the printed tables of the thesis, [`audit_study`] the results of a study.

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

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Finding {
    /// Such as `ratio`, `metric` or `copy`.
    pub kind: &'static str,
    /// Place of the number: table, row and subject; for a study, the job.
    pub place: String,
    /// As printed or stored.
    pub stated: String,
    pub recomputed: String,
    pub says: String,
}

impl Finding {
    pub fn table(findings: &[Self]) -> Table {
        let text = |text: &str| Value::Text(text.to_owned());
        let row = |f: &Self| vec![text(f.kind), text(&f.place), text(&f.stated), text(&f.recomputed), text(&f.says)];
        Table {
            columns: ["kind", "place", "stated", "recomputed", "says"].map(str::to_owned).to_vec(),
            rows: findings.iter().map(row).collect(),
        }
    }
}

#[derive(Clone, Debug, PartialEq)]
pub struct Audit {
    pub recomputed: usize,
    pub findings: Vec<Finding>,
}

pub fn audit_thesis(store: &Store) -> Result<Audit> {
    Ok(published::audit(&tables::Tables::read(&store.reader)?))
}

/// Measures the stored meshes of a study's results again, and compares the lengths with the stored ones.
pub fn audit_study(store: &Store, study: &str) -> Result<Audit> {
    results::audit(store, study)
}

/// Three decimals, as the thesis prints ratios.
fn three(x: f64) -> String {
    format!("{x:.3}")
}

fn threes(numbers: impl IntoIterator<Item = f64>) -> String {
    numbers.into_iter().map(three).collect::<Vec<_>>().join(" ")
}

//! `toile subject|style|size|fabric`: what is in the catalogue.

use super::args::Catalogue;
use super::context::Context;
use super::{CliError, End, Outcome};
use crate::study::{StudyError, Table, Value};

/// One part of the catalogue.
pub struct Part {
    /// What one entry is called.
    what: &'static str,
    /// Its view.
    view: &'static str,
    /// Columns that name an entry.
    key: &'static str,
}

/// Subjects.
pub const SUBJECTS: Part = Part { what: "subject", view: "v_subjects", key: "subject" };
/// Styles.
pub const STYLES: Part = Part { what: "style", view: "v_styles", key: "style" };
/// Sizes, named `STYLE/SIZE`.
pub const SIZES: Part = Part { what: "size", view: "v_sizes", key: "style || '/' || size" };
/// Fabrics.
pub const FABRICS: Part = Part { what: "fabric", view: "v_fabrics", key: "fabric" };

/// Columns that are of no use in a list.
const HIDDEN: [&str; 4] = ["hash", "is_latest", "source", "entry"];

/// Runs a catalogue command.
pub fn run(context: &Context, part: &Part, command: &Catalogue) -> Outcome {
    let workspace = context.workspace()?;
    let Part { view, key, .. } = part;
    let query = |what: &str| workspace.query(&format!("SELECT *, {key} AS entry FROM {view} {what}"));
    match command {
        Catalogue::Ls => {
            let entries = query("WHERE is_latest ORDER BY entry")?;
            context.print(&if context.json { entries } else { without(entries, &HIDDEN) })?;
        }
        Catalogue::Show { name } => {
            let all = query("ORDER BY entry, revision")?;
            let entry = all.columns.len() - 1;
            let of_name = |row: &&Vec<Value>| row[entry] == Value::Text(name.clone());
            let rows: Vec<_> = all.rows.iter().filter(of_name).cloned().collect();
            if rows.is_empty() {
                let mut known: Vec<String> = all.rows.iter().map(|row| row[entry].to_string()).collect();
                known.dedup();
                return Err(CliError::Study(StudyError::NotFound { what: part.what, name: name.clone(), known }));
            }
            let found = Table { columns: all.columns, rows };
            context.print(&if context.json { found } else { sideways(&without(found, &["entry"])) })?;
        }
    }
    Ok(End::Done)
}

/// A table without some columns.
fn without(table: Table, hidden: &[&str]) -> Table {
    let kept: Vec<usize> = (0..table.columns.len()).filter(|&k| !hidden.contains(&table.columns[k].as_str())).collect();
    let pick = |row: &Vec<Value>| kept.iter().map(|&k| row[k].clone()).collect();
    Table {
        columns: kept.iter().map(|&k| table.columns[k].clone()).collect(),
        rows: table.rows.iter().map(pick).collect(),
    }
}

/// One column a revision, one row a property.
fn sideways(table: &Table) -> Table {
    let mut columns = vec!["property".to_owned()];
    columns.extend((1..=table.rows.len()).map(|n| format!("revision {n}")));
    let row = |(k, name): (usize, &String)| {
        let values = table.rows.iter().map(|row| row[k].clone());
        std::iter::once(Value::Text(name.clone())).chain(values).collect()
    };
    Table { columns, rows: table.columns.iter().enumerate().map(row).collect() }
}

//! Values from columns of SQL that hold names.

use rusqlite::Row;

use crate::rows::Status;
use fit::{FitClass, Simulator};

/// The value that the name in a column stands for.
pub(crate) fn named<T>(row: &Row<'_>, column: usize, parse: impl Fn(&str) -> Option<T>) -> rusqlite::Result<T> {
    let name: String = row.get(column)?;
    parse(&name).ok_or_else(|| {
        let message = format!("unknown name `{name}`");
        rusqlite::Error::FromSqlConversionFailure(column, rusqlite::types::Type::Text, message.into())
    })
}

/// Status of a job from its name in a column.
///
/// # Errors
/// When no status has the name.
pub fn status(row: &Row<'_>, column: usize) -> rusqlite::Result<Status> {
    named(row, column, Status::from_name)
}

/// Simulator from its name in a column.
///
/// # Errors
/// When no simulator has the name.
pub fn simulator(row: &Row<'_>, column: usize) -> rusqlite::Result<Simulator> {
    named(row, column, |name| [Simulator::Fem, Simulator::Hybrid].into_iter().find(|sim| sim.as_str() == name))
}

/// Fit class from its name in a column.
pub(crate) fn fit_class(row: &Row<'_>, column: usize) -> rusqlite::Result<FitClass> {
    named(row, column, |name| {
        [FitClass::Tight, FitClass::Just, FitClass::Loose].into_iter().find(|class| class.as_str() == name)
    })
}

//! Values from columns of SQL that hold names.

use rusqlite::Row;

use crate::rows::Status;
use fit::{FitClass, Simulator};

pub(crate) fn named<T>(row: &Row<'_>, column: usize, parse: impl Fn(&str) -> Option<T>) -> rusqlite::Result<T> {
    let name: String = row.get(column)?;
    parse(&name).ok_or_else(|| {
        let message = format!("unknown name `{name}`");
        rusqlite::Error::FromSqlConversionFailure(column, rusqlite::types::Type::Text, message.into())
    })
}

pub fn status(row: &Row<'_>, column: usize) -> rusqlite::Result<Status> {
    named(row, column, Status::from_name)
}

pub fn simulator(row: &Row<'_>, column: usize) -> rusqlite::Result<Simulator> {
    named(row, column, |name| [Simulator::Fem, Simulator::Hybrid].into_iter().find(|sim| sim.as_str() == name))
}

pub(crate) fn fit_class(row: &Row<'_>, column: usize) -> rusqlite::Result<FitClass> {
    named(row, column, |name| {
        [FitClass::Tight, FitClass::Just, FitClass::Loose].into_iter().find(|class| class.as_str() == name)
    })
}

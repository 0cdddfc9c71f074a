//! Numbers of an entry as columns of SQL.

use rusqlite::Row;

use spec::entry::Field;

pub(super) fn columns<T>(fields: &[Field<T>]) -> String {
    fields.iter().map(|field| field.key).collect::<Vec<_>>().join(", ")
}

pub(super) fn read_numbers<T>(row: &Row<'_>, first: usize, fields: &[Field<T>], entry: &mut T) -> rusqlite::Result<()> {
    for (k, field) in fields.iter().enumerate() {
        field.set(entry, row.get(first + k)?);
    }
    Ok(())
}

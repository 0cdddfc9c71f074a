//! An open database.

use std::path::{Path, PathBuf};

use rusqlite::Connection;

use crate::connection::{Access, open};
use crate::error::{Result, StudyError};

/// An open database. Queries and changes use separate connections, since [`Store::version`] sees only the writes of
/// other connections. A store is `Send`, but not `Sync`: each thread opens its own.
pub struct Store {
    path: PathBuf,
    /// Connection for queries.
    pub reader: Connection,
    pub(crate) writer: Option<Connection>,
}

impl Store {
    /// Opens a database; without `readonly` it is created and brought up to date where needed.
    ///
    /// # Errors
    /// When the file cannot be opened, is no database, or was written by a newer program.
    pub fn open(path: &Path, readonly: bool) -> Result<Self> {
        let writer = if readonly { None } else { Some(open(path, Access::Create)?) };
        let reader = open(path, Access::Read)?;
        Ok(Self { path: path.to_owned(), reader, writer })
    }

    /// The database file.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// True if the database was opened for reading only.
    #[must_use]
    pub fn is_readonly(&self) -> bool {
        self.writer.is_none()
    }

    /// Number that changes whenever any process has written to the database. Reading it costs microseconds.
    ///
    /// # Errors
    /// When the database cannot be read.
    pub fn version(&self) -> Result<i64> {
        Ok(self.reader.pragma_query_value(None, "data_version", |row| row.get(0))?)
    }

    /// The connection for changes.
    ///
    /// # Errors
    /// When the database is open for reading only.
    pub fn writer(&mut self) -> Result<&mut Connection> {
        self.writer.as_mut().ok_or(StudyError::Readonly)
    }
}

//! An open database.

use std::path::{Path, PathBuf};

use rusqlite::Connection;

use crate::connection::{Access, open};
use crate::error::{Result, StudyError};

/// An open database. Queries and changes use separate connections, since [`Store::version`] sees only the writes of
/// other connections. A store is `Send`, but not `Sync`: each thread opens its own.
pub struct Store {
    path: PathBuf,
    pub reader: Connection,
    pub(crate) writer: Option<Connection>,
}

impl Store {
    /// Creates the database and brings it up to date where needed, unless `readonly`.
    pub fn open(path: &Path, readonly: bool) -> Result<Self> {
        let writer = if readonly { None } else { Some(open(path, Access::Create)?) };
        let reader = open(path, Access::Read)?;
        Ok(Self { path: path.to_owned(), reader, writer })
    }

    pub fn path(&self) -> &Path {
        &self.path
    }

    pub fn is_readonly(&self) -> bool {
        self.writer.is_none()
    }

    /// Number that changes whenever any process has written to the database. Reading it costs microseconds.
    pub fn version(&self) -> Result<i64> {
        Ok(self.reader.pragma_query_value(None, "data_version", |row| row.get(0))?)
    }

    /// Fails where the database is open for reading only.
    pub fn writer(&mut self) -> Result<&mut Connection> {
        self.writer.as_mut().ok_or(StudyError::Readonly)
    }
}

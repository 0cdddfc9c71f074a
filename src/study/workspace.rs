//! A workspace: one database and what screens and commands may ask of it.
//!
//! Reading and acting use separate connections, so that [`Workspace::version`] also notices this process's own writes.

use std::cell::RefCell;
use std::path::{Path, PathBuf};

use rusqlite::Connection;

use crate::answers::picture::{Map, Stage};
use crate::catalogue;
use crate::error::{Result, StudyError};
use crate::rows::JobId;
use crate::store::{self, Access};

/// An open database with its studies, jobs and results. `Send`, not `Sync`: one a thread.
pub struct Workspace {
    path: PathBuf,
    pub(crate) reader: Connection,
    pub(crate) writer: Option<Connection>,
    /// The results last shown, the latest last, ready for more pictures.
    pub(crate) scenes: RefCell<Vec<(JobId, Map, Stage)>>,
}

impl Workspace {
    /// Opens a workspace; without `readonly` the database is created and brought up to date where needed.
    ///
    /// # Errors
    /// When the file cannot be opened, is no database, or was written by a newer program.
    pub fn open(path: &Path, readonly: bool) -> Result<Self> {
        let mut writer = if readonly { None } else { Some(store::open(path, Access::Create)?) };
        if let Some(writer) = &mut writer {
            catalogue::add_builtin(writer)?;
        }
        let reader = store::open(path, Access::Read)?;
        Ok(Self { path: path.to_owned(), reader, writer, scenes: RefCell::default() })
    }

    /// The database file.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Whether actions are refused.
    #[must_use]
    pub fn is_readonly(&self) -> bool {
        self.writer.is_none()
    }

    /// A number that changes whenever anything was written by any process; costs microseconds.
    ///
    /// # Errors
    /// When the database cannot be read.
    pub fn version(&self) -> Result<i64> {
        Ok(self.reader.pragma_query_value(None, "data_version", |row| row.get(0))?)
    }

    /// The connection for actions.
    pub(crate) fn writer(&mut self) -> Result<&mut Connection> {
        self.writer.as_mut().ok_or(StudyError::Readonly)
    }
}

//! Context of a command: the global flags, and work common to all commands.

use std::path::{Path, PathBuf};

use super::CliError;
use super::args::{Format, Global};
use engine::run;
use spec::{QUICKSTART, Study, write_quickstart};
use store::owner::Watch;
use store::{PUBLISHED, Store, Table, files, queue, read};
use wardrobe::catalogue;

pub struct Context {
    pub db: PathBuf,
    /// True if a flag or the environment names the database.
    pub is_db_named: bool,
    pub readonly: bool,
    pub json: bool,
    /// True to print only errors.
    pub quiet: bool,
    pub verbose: bool,
    pub colour: bool,
}

impl Context {
    pub fn new(global: Global) -> Result<Self, CliError> {
        let is_db_named = global.db.is_some();
        let db = match global.db {
            Some(path) => path,
            None => default_database()?,
        };
        let no_color = std::env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty());
        Ok(Self {
            db,
            is_db_named,
            readonly: global.readonly,
            json: global.json,
            quiet: global.quiet,
            verbose: global.verbose,
            colour: !(global.no_color || no_color),
        })
    }

    /// Refuses a database that was named in a folder that is not there, for commands that only tell: a misspelt path
    /// would leave folders behind.
    pub fn must_have_folder(&self) -> Result<(), CliError> {
        let folder = self.db.parent().filter(|folder| !folder.as_os_str().is_empty());
        if self.is_db_named && folder.is_some_and(|folder| !folder.exists()) {
            catalogue::open(&self.db, true)?;
        }
        Ok(())
    }

    pub fn store(&self) -> Result<Store, CliError> {
        let is_new = !self.db.exists();
        let mut store = catalogue::open(&self.db, self.readonly)?;
        let lost = queue::recover(&mut store, &mut Watch::default())?;
        if lost > 0 {
            self.say(format_args!("a run was interrupted: {lost} of its jobs wait in the queue again"));
        }
        if is_new && self.db.exists() {
            self.say(format_args!("made a new database: {}", self.db.display()));
        }
        Ok(store)
    }

    /// Prints on standard error, unless `quiet`.
    pub fn say(&self, message: impl std::fmt::Display) {
        if !self.quiet {
            super::output::note(&message);
        }
    }

    /// Prints the paths on standard error.
    pub fn write_files(&self, folder: &Path, files: &[(String, Vec<u8>)]) -> Result<(), CliError> {
        for path in files::write_files(folder, files)? {
            self.say(format_args!("wrote {}", path.display()));
        }
        Ok(())
    }

    pub fn write(&self, path: &Path, bytes: Vec<u8>) -> Result<(), CliError> {
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        files::write_files(path.parent().unwrap_or(Path::new("")), &[(name, bytes)])?;
        self.say(format_args!("wrote {}", path.display()));
        Ok(())
    }

    pub fn print(&self, table: &Table) -> Result<(), CliError> {
        let format = if self.json { Format::Json } else { Format::Table };
        Ok(super::output::table(table, format)?)
    }

    /// Reads a study by the path of its folder or file. A bare name may also be that of a study of the project, or of
    /// the program's own study.
    pub fn study(&self, store: &Store, path: &Path) -> Result<Study, CliError> {
        let in_project = project_folder().map(|project| project.join("studies").join(path));
        let in_project = in_project.filter(|folder| !path.exists() && folder.is_dir());
        let path = match in_project {
            Some(folder) => folder,
            None if !path.exists() && path == Path::new(QUICKSTART) && !self.readonly => {
                let folder = quickstart(&self.db);
                write_quickstart(&folder)?;
                folder
            }
            None => path.to_owned(),
        };
        Ok(run::load_study(store, &path)?)
    }

    /// Updates the stored ease of a study, if its file exists and the database may be written. Returns the store and
    /// the name of the study.
    pub fn eased(&self, path: &Path) -> Result<(Store, String), CliError> {
        let mut store = self.store()?;
        if !path.exists() || self.readonly {
            let name = self.study_name(&store, path)?;
            return Ok((store, name));
        }
        let study = self.study(&store, path)?;
        run::update_ease(&mut store, &study)?;
        Ok((store, study.name))
    }

    /// Name of a study, given by its folder, file or name.
    pub fn study_name(&self, store: &Store, path: &Path) -> Result<String, CliError> {
        let name = path.to_string_lossy();
        if name == PUBLISHED {
            return Ok(name.into_owned());
        }
        if !name.contains('/') && read::studies(store)?.iter().any(|study| study.name == name) {
            return Ok(name.into_owned());
        }
        if path.exists() {
            return Ok(self.study(store, path)?.name);
        }
        Ok(read::study(store, &name)?.name)
    }
}

/// Folder for the program's own study: in the project, else beside the database.
pub fn quickstart(database: &Path) -> PathBuf {
    let home = project_folder().or_else(|| database.parent().map(Path::to_owned)).unwrap_or_default();
    home.join("studies").join(QUICKSTART)
}

/// Folder of the project: the nearest parent folder with a folder `studies`.
pub fn project_folder() -> Option<PathBuf> {
    let here = std::env::current_dir().ok()?;
    here.ancestors().find(|folder| folder.join("studies").is_dir()).map(Path::to_owned)
}

/// Path of the default database: `db/toile.sqlite` of the project, else in the user's data folder.
fn default_database() -> Result<PathBuf, CliError> {
    if let Some(project) = project_folder() {
        return Ok(project.join("db").join("toile.sqlite"));
    }
    let set = |name: &str| std::env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
    let data = set("XDG_DATA_HOME").or_else(|| set("HOME").map(|home| home.join(".local").join("share")));
    data.map(|data| data.join("toile").join("toile.sqlite")).ok_or_else(|| {
        CliError::Usage("no place for a database: HOME is not set; say --db PATH or run beside a studies folder".into())
    })
}

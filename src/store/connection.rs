//! Connections to a database file, and the settings that make `kill -9` harmless.

use std::path::Path;
use std::time::{Duration, Instant};

use rusqlite::hooks::{AuthAction, AuthContext, Authorization};
use rusqlite::{Connection, ErrorCode, OpenFlags};

use crate::error::{Result, StudyError, database_error};
use crate::functions::add_functions;
use crate::schema::{LATEST, check_version, migrate};

/// Time that a statement waits while another process writes, where `TOILE_PATIENCE_S` sets no other.
const PATIENCE_S: f64 = 20.0;

fn patience() -> Duration {
    let given = std::env::var("TOILE_PATIENCE_S").ok().and_then(|text| text.parse::<f64>().ok());
    Duration::try_from_secs_f64(given.unwrap_or(PATIENCE_S)).unwrap_or(Duration::from_secs_f64(PATIENCE_S))
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Access {
    /// File must exist.
    Read,
    /// Makes the file where there is none.
    Create,
    /// Commits are on disk when they return. The file must exist.
    Write,
    /// Lets a power cut undo whole transactions (progress, heartbeats). The file must exist.
    Volatile,
}

/// Opens a database, creating and migrating it where the access allows. Only [`Access::Create`] makes a file, so that
/// the workers of a run whose database was deleted do not go on in an empty one of the same name.
pub fn open(path: &Path, access: Access) -> Result<Connection> {
    let fail = |reason: String| StudyError::Open { path: path.to_owned(), reason };
    if access == Access::Read {
        let flags = OpenFlags::SQLITE_OPEN_READ_ONLY | OpenFlags::SQLITE_OPEN_NO_MUTEX | OpenFlags::SQLITE_OPEN_URI;
        if !path.exists() {
            return Err(fail("there is no such file; `toile run STUDY` makes one".into()));
        }
        let mut connection = open_to_read(path, flags).map_err(|e| fail(database_error(&e)))?;
        add_functions(&connection)?;
        check_version(&connection, LATEST)?;
        connection.authorizer(Some(no_other_files))?;
        return Ok(connection);
    }
    let mut flags = OpenFlags::default();
    if access == Access::Create {
        let folder = path.parent().unwrap_or(Path::new(""));
        std::fs::create_dir_all(folder).map_err(StudyError::io(folder))?;
        refuse_network(path)?;
    } else {
        still_there(path)?;
        flags.remove(OpenFlags::SQLITE_OPEN_CREATE);
    }
    let mut connection = Connection::open_with_flags(path, flags).map_err(|e| fail(database_error(&e)))?;
    connection.busy_timeout(patience())?;
    use_log(&connection).map_err(|e| fail(database_error(&e)))?;
    connection.pragma_update(None, "synchronous", if access == Access::Volatile { "normal" } else { "full" })?;
    connection.pragma_update(None, "foreign_keys", true)?;
    if access == Access::Create {
        migrate(&mut connection)?;
    } else {
        check_version(&connection, LATEST)?;
    }
    Ok(connection)
}

/// Opens a database for reading. SQLite needs files beside the database, which it cannot make on a read-only medium.
/// There the database is opened as immutable, if its write-ahead log is empty or missing.
fn open_to_read(path: &Path, flags: OpenFlags) -> rusqlite::Result<Connection> {
    let try_open = |name: &Path| -> rusqlite::Result<Connection> {
        let connection = Connection::open_with_flags(name, flags)?;
        connection.busy_timeout(patience())?;
        connection.query_row("SELECT count(*) FROM sqlite_schema", [], |_| Ok(()))?;
        Ok(connection)
    };
    match try_open(path) {
        Err(error) if matches!(error.sqlite_error_code(), Some(ErrorCode::CannotOpen | ErrorCode::ReadOnly)) => {
            let log = path.with_file_name(format!("{}-wal", path.file_name().unwrap_or_default().to_string_lossy()));
            let name = path.to_string_lossy().replace('%', "%25").replace('?', "%3f").replace('#', "%23");
            let is_whole = std::fs::metadata(log).map_or(true, |log| log.len() == 0);
            if is_whole { try_open(Path::new(&format!("file:{name}?immutable=1"))) } else { Err(error) }
        }
        opened => opened,
    }
}

/// Switches to write-ahead logging. The switch needs exclusive access, for which SQLite does not wait. Two programs may
/// make the same database at once, so the switch is tried again until [`patience`] ends.
fn use_log(connection: &Connection) -> rusqlite::Result<()> {
    let end = Instant::now() + patience();
    loop {
        match connection.pragma_update(None, "journal_mode", "wal") {
            Err(error) if error.sqlite_error_code() == Some(ErrorCode::DatabaseBusy) && Instant::now() < end => {
                std::thread::sleep(Duration::from_millis(10));
            }
            result => return result,
        }
    }
}

/// Returns an error where a database was deleted since this program opened it.
pub fn still_there(path: &Path) -> Result<()> {
    if path.exists() {
        return Ok(());
    }
    Err(StudyError::Open {
        path: path.to_owned(),
        reason: "the file is gone; it was there when this program opened it".into(),
    })
}

/// Network file systems, by their names in Linux. SQLite's locks do not hold there, and its write-ahead log needs
/// shared memory, which two machines do not have.
const NETWORK: [&str; 11] =
    ["nfs", "nfs4", "cifs", "smb3", "smbfs", "afs", "ceph", "lustre", "gpfs", "fuse.sshfs", "beegfs"];

/// Refuses a database on a network file system, where the system names it.
fn refuse_network(path: &Path) -> Result<()> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let folder = folder.canonicalize().map_err(StudyError::io(folder))?;
    let mounts = std::fs::read_to_string("/proc/self/mountinfo").unwrap_or_default();
    match file_system(&mounts, &folder) {
        Some(kind) if NETWORK.contains(&kind) => Err(StudyError::Open {
            path: path.to_owned(),
            reason: format!(
                "it would lie on a network file system ({kind}), where SQLite loses data; give a --db on a disk of this \
                machine, and hand jobs to other machines with `toile job run`"
            ),
        }),
        _ => Ok(()),
    }
}

/// Kind of the file system that a folder lies on, from the text of `/proc/self/mountinfo`. The longest mount point
/// above the folder counts, and of several mounts at one point the last.
fn file_system<'t>(mounts: &'t str, folder: &Path) -> Option<&'t str> {
    let mut best: Option<(usize, &str)> = None;
    for line in mounts.lines() {
        let (left, right) = line.split_once(" - ")?;
        let point = left.split(' ').nth(4)?.replace("\\040", " ");
        let length = point.len();
        if folder.starts_with(&point) && best.is_none_or(|(longest, _)| length >= longest) {
            best = Some((length, right.split(' ').next()?));
        }
    }
    best.map(|(_, kind)| kind)
}

/// Denies ATTACH to queries: ATTACH and VACUUM INTO could write other files.
fn no_other_files(context: AuthContext<'_>) -> Authorization {
    match context.action {
        AuthAction::Attach { .. } => Authorization::Deny,
        _ => Authorization::Allow,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_whoever_opens_a_workspace_makes_a_database() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("db").join("toile.sqlite");
        for access in [Access::Read, Access::Write, Access::Volatile] {
            assert!(matches!(open(&path, access), Err(StudyError::Open { .. })), "{access:?}");
        }
        assert!(!path.parent().expect("within the folder").exists());
        open(&path, Access::Create).expect("a new database");
        for access in [Access::Read, Access::Write, Access::Volatile] {
            open(&path, access).expect("there now");
        }
    }

    #[test]
    fn the_file_system_of_a_folder_is_that_of_the_nearest_mount() {
        let mounts = "22 1 0:20 / / rw,relatime - ext4 /dev/sda1 rw\n\
            30 22 0:30 / /data rw shared:1 - nfs4 server:/data rw\n\
            31 30 0:31 / /data/my\\040disk rw - xfs /dev/sdb1 rw\n";
        let check =
            |folder: &str, kind: &str| assert_eq!(file_system(mounts, Path::new(folder)), Some(kind), "{folder}");
        check("/var/lib", "ext4");
        check("/data/anna/db", "nfs4");
        check("/database", "ext4");
        check("/data/my disk/db", "xfs");
        assert_eq!(file_system("", Path::new("/")), None);
    }

    #[test]
    fn a_newer_database_is_refused() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("toile.sqlite");
        let connection = open(&path, Access::Create).expect("a new database");
        connection.pragma_update(None, "user_version", 99).expect("writable");
        drop(connection);
        for access in [Access::Read, Access::Create, Access::Write] {
            assert!(matches!(open(&path, access), Err(StudyError::TooNew { found: 99, .. })));
        }
    }
}

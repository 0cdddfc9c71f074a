//! The SQLite database: opening it, bringing its schema up to date, and the settings that make `kill -9` harmless.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use rusqlite::hooks::{AuthAction, AuthContext, Authorization};
use rusqlite::{Connection, ErrorCode, OpenFlags, Transaction, TransactionBehavior};

use crate::error::{Result, StudyError, database_error};
use crate::{evidence, sql};

/// Schema changes in order, never edited once released: `user_version` counts how many a database has.
const MIGRATIONS: [&str; 18] = [
    include_str!("../../db/migrations/0001_store.sql"),
    include_str!("../../db/migrations/0002_views.sql"),
    include_str!("../../db/migrations/0003_published.sql"),
    include_str!("../../db/migrations/0004_published_metrics.sql"),
    include_str!("../../db/migrations/0005_catalogue.sql"),
    include_str!("../../db/migrations/0006_stretched.sql"),
    include_str!("../../db/migrations/0007_hybrid_gap.sql"),
    include_str!("../../db/migrations/0008_engine.sql"),
    include_str!("../../db/migrations/0009_evidence.sql"),
    include_str!("../../db/migrations/0010_queue.sql"),
    include_str!("../../db/migrations/0011_distortion.sql"),
    include_str!("../../db/migrations/0012_levels.sql"),
    include_str!("../../db/migrations/0013_worn.sql"),
    include_str!("../../db/migrations/0014_queued.sql"),
    include_str!("../../db/migrations/0015_scans.sql"),
    include_str!("../../db/migrations/0016_outfits.sql"),
    include_str!("../../db/migrations/0017_drawn.sql"),
    include_str!("../../db/migrations/0018_sizes.sql"),
];

/// An open database. Reading and acting use separate connections, so that [`Store::version`] also notices this process's
/// own writes. `Send`, not `Sync`: one a thread.
pub struct Store {
    path: PathBuf,
    /// Connection for questions.
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
    ///
    /// # Errors
    /// When the database is open for reading only.
    pub fn writer(&mut self) -> Result<&mut Connection> {
        self.writer.as_mut().ok_or(StudyError::Readonly)
    }
}

/// How long a statement waits for another process's write, s, where `TOILE_PATIENCE_S` says nothing else.
const PATIENCE_S: f64 = 20.0;

/// How long a statement waits for another process's write.
fn patience() -> Duration {
    let given = std::env::var("TOILE_PATIENCE_S").ok().and_then(|text| text.parse::<f64>().ok());
    Duration::try_from_secs_f64(given.unwrap_or(PATIENCE_S)).unwrap_or(Duration::from_secs_f64(PATIENCE_S))
}

/// How a connection is used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Access {
    /// Reads only; the file must exist.
    Read,
    /// Reads and writes, and makes the file where there is none: for whoever opens a store.
    Create,
    /// Reads and writes; a commit is on disk when it returns. The file must exist.
    Write,
    /// Writes that may be lost with the power (progress, heartbeats); never torn. The file must exist.
    Volatile,
}

/// Opens a database, creating and migrating it where the access allows. Only [`Access::Create`] makes a file: were a
/// run's database deleted under it, its workers must not go on in an empty one of the same name.
pub fn open(path: &Path, access: Access) -> Result<Connection> {
    let fail = |reason: String| StudyError::Open { path: path.to_owned(), reason };
    if access == Access::Read {
        let flags = OpenFlags::SQLITE_OPEN_READ_ONLY | OpenFlags::SQLITE_OPEN_NO_MUTEX | OpenFlags::SQLITE_OPEN_URI;
        if !path.exists() {
            return Err(fail("there is no such file; `toile run STUDY` makes one".into()));
        }
        let mut connection = open_to_read(path, flags).map_err(|e| fail(database_error(&e)))?;
        sql::add_functions(&connection)?;
        check_version(&connection, MIGRATIONS.len() as i64)?;
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
        check_version(&connection, MIGRATIONS.len() as i64)?;
    }
    Ok(connection)
}

/// Opens a database for reading. On a medium that cannot be written SQLite has no place for its own bookkeeping; where
/// no log waits to be read back, the file is then read as it is.
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

/// Switches to write-ahead logging, where that is not so yet. The switch needs the file for itself, and SQLite does not
/// wait for that: two programs may make the same database at once.
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

/// Refuses a database that was deleted since this program opened it.
pub fn still_there(path: &Path) -> Result<()> {
    if path.exists() {
        return Ok(());
    }
    Err(StudyError::Open {
        path: path.to_owned(),
        reason: "the file is gone; it was there when this program opened it".into(),
    })
}

/// File systems of other machines, as Linux names them: locks of SQLite do not hold there, and its log needs shared
/// memory, which two machines do not have.
const NETWORK: [&str; 11] =
    ["nfs", "nfs4", "cifs", "smb3", "smbfs", "afs", "ceph", "lustre", "gpfs", "fuse.sshfs", "beegfs"];

/// Refuses a database on the file system of another machine, where this can be told.
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

/// Kind of the file system that a folder lies on, from the text of `/proc/self/mountinfo`: the longest mount point above
/// it, of several at one place the last.
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

/// Keeps questions to the one database: ATTACH, and with it VACUUM INTO, could write other files.
fn no_other_files(context: AuthContext<'_>) -> Authorization {
    match context.action {
        AuthAction::Attach { .. } => Authorization::Deny,
        _ => Authorization::Allow,
    }
}

/// Applies the migrations a database does not have yet, all or none.
fn migrate(connection: &mut Connection) -> Result<()> {
    if check_version(connection, 0)? == MIGRATIONS.len() {
        return Ok(());
    }
    let transaction = write(connection)?;
    let have = check_version(&transaction, 0)?;
    for sql in &MIGRATIONS[have..] {
        transaction.execute_batch(sql)?;
    }
    transaction.pragma_update(None, "user_version", MIGRATIONS.len() as i64)?;
    evidence::refresh_all(&transaction)?;
    Ok(transaction.commit()?)
}

/// Number of migrations a database has; an error when it has more than this program knows, or fewer than `least`.
fn check_version(connection: &Connection, least: i64) -> Result<usize> {
    let known = MIGRATIONS.len() as i64;
    let found: i64 = connection.pragma_query_value(None, "user_version", |row| row.get(0))?;
    if found > known {
        return Err(StudyError::TooNew { found, known });
    }
    if found < least {
        let path = connection.path().unwrap_or_default().into();
        let reason = format!("its schema version {found} is older than {least}; open it once without --readonly");
        return Err(StudyError::Open { path, reason });
    }
    Ok(found as usize)
}

/// A transaction that takes the write lock at once, so that what it read stays true until it commits.
pub fn write(connection: &mut Connection) -> rusqlite::Result<Transaction<'_>> {
    connection.transaction_with_behavior(TransactionBehavior::Immediate)
}

/// Does something in a transaction that a power cut may undo, though nothing else may: what a queue is told need not wait
/// for the disk. The next result that is stored makes it last, too.
pub fn lightly<T>(connection: &mut Connection, act: impl FnOnce(&Transaction<'_>) -> Result<T>) -> Result<T> {
    let usual: i64 = connection.pragma_query_value(None, "synchronous", |row| row.get(0))?;
    connection.pragma_update(None, "synchronous", "normal")?;
    let done = write(connection).map_err(StudyError::from).and_then(|transaction| {
        let done = act(&transaction)?;
        transaction.commit()?;
        Ok(done)
    });
    connection.pragma_update(None, "synchronous", usual)?;
    done
}

/// The clock, ms since 1970 (UTC). Only queue bookkeeping reads it; results never depend on it.
#[must_use]
pub fn now_ms() -> i64 {
    SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_millis() as i64)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCHEMA: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../db/schema.sql");

    /// The schema the migrations add up to, as SQLite keeps it.
    fn dump(connection: &Connection) -> String {
        let mut statement = connection
            .prepare("SELECT sql FROM sqlite_schema WHERE sql IS NOT NULL ORDER BY rowid")
            .expect("sqlite_schema exists");
        let sql: Vec<String> =
            statement.query_map([], |row| row.get(0)).expect("no parameters").map(|r| r.expect("text")).collect();
        format!(
            "-- What the migrations add up to. Written by `TOILE_BLESS=1 cargo test schema_file`.\n\n{};\n",
            sql.join(";\n\n")
        )
    }

    fn migrated() -> Connection {
        let mut connection = Connection::open_in_memory().expect("memory");
        migrate(&mut connection).expect("migrations apply");
        connection
    }

    #[test]
    fn schema_file_is_what_the_migrations_add_up_to() {
        let schema = dump(&migrated());
        if std::env::var_os("TOILE_BLESS").is_some() {
            std::fs::write(SCHEMA, &schema).expect("db/ is writable");
        }
        assert_eq!(std::fs::read_to_string(SCHEMA).expect("db/schema.sql"), schema);
    }

    /// The migrations as they were before crossings were counted and reports remembered: both came in without a version.
    fn of_the_first_days() -> [String; 9] {
        std::array::from_fn(|k| {
            let sql = MIGRATIONS[k];
            match k {
                0 => sql.replace(",\n    self_crossings INTEGER NOT NULL", ""),
                1 => sql.replace(" self_crossings,", ""),
                7 => sql.split("-- The page of a study's report").next().unwrap_or_default().to_owned(),
                _ => sql.to_owned(),
            }
        })
    }

    #[test]
    fn a_database_of_any_earlier_day_is_brought_up_to_date_with_its_results() {
        let fill = "INSERT INTO study VALUES (1, 'tops', 'p', 50, 100, 0, 0);
            INSERT INTO subject (subject_id, name, revision, hash, sex, stature_mm, created_at)
                VALUES (1, 'ii', 1, 'h', 'male', 1690, 0);
            INSERT INTO style VALUES (1, 'tee', 1, 'h', 's', '', 0);
            INSERT INTO size VALUES (1, 'tee', 's', 1, 'h', 'p', NULL, x'', 0);
            INSERT INTO fabric (fabric_id, name, revision, hash, density_kg_m2, thickness_mm, membrane_warp_n_m,
                    membrane_weft_n_m, membrane_coupling_n_m, shear_n_m, bending_warp_nm, bending_weft_nm, friction_body,
                    friction_self, source, created_at)
                VALUES (1, 'poplin', 1, 'h', 0.1, 0.2, 1, 1, 0, 1, 1, 1, 0, 0, '', 0);
            INSERT INTO job (job_id, study_id, garment, size, subject, simulator, input_hash, status, queued_at, subject_id,
                    style_id, size_id, fabric_id)
                VALUES (1, 1, 'tee', 's', 'ii', 'fem', 'h', 'done', 0, 1, 1, 1, 1);";
        let released = MIGRATIONS[..9].iter().map(ToString::to_string).collect::<Vec<_>>();
        let check = |migrations: &[String], result: &str, crossings: Option<i64>| {
            let folder = tempfile::tempdir().expect("a folder");
            let path = folder.path().join("toile.sqlite");
            let connection = Connection::open(&path).expect("a new database");
            connection.execute_batch(&migrations.concat()).expect("valid");
            connection.execute_batch(&format!("{fill} INSERT INTO metrics VALUES ({result})")).expect("valid");
            connection.pragma_update(None, "user_version", migrations.len() as i64).expect("writable");
            drop(connection);
            let connection = open(&path, Access::Create).expect("brought up to date");
            let row = |row: &rusqlite::Row<'_>| Ok((row.get::<_, f64>(0)?, row.get::<_, Option<i64>>(1)?));
            let found = connection.query_row("SELECT ei, self_crossings FROM v_metrics", [], row);
            assert_eq!(found.expect("one result"), (0.01, crossings));
            let names = "SELECT group_concat(name) FROM (SELECT name FROM sqlite_schema ORDER BY name)";
            let names = |of: &Connection| of.query_row(names, [], |row| row.get::<_, String>(0)).expect("some");
            assert_eq!(names(&connection), names(&migrated()));
        };
        check(&of_the_first_days(), "1, 9, 1, 0, 0.01, 0, 5, 5, 5, 0, 1, 0, 0", None);
        check(&released, "1, 9, 1, 0, 0.01, 0, 5, 5, 5, 0, 1, 0, 0, 7", Some(7));
    }

    #[test]
    fn results_that_sizes_shared_are_no_longer_current() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("toile.sqlite");
        let connection = Connection::open(&path).expect("a new database");
        connection.execute_batch(&MIGRATIONS[..17].concat()).expect("valid");
        let job = |id: i64, size: &str, hash: &str, status: &str| {
            format!(
                "INSERT INTO size (size_id, style, name, revision, hash, pattern_file, pattern, created_at)
                    VALUES ({id}, 'tee', '{size} {id}', 1, 'h', 'p', x'', 0);
                INSERT INTO job (job_id, study_id, garment, size, subject, simulator, input_hash, status, queued_at,
                    subject_id, style_id, size_id, fabric_id)
                VALUES ({id}, 1, 'tee {id}', '{size}', 'ii', 'fem', '{hash}', '{status}', 0, 1, 1, {id}, 1);"
            )
        };
        let fill = "INSERT INTO study (study_id, name, path, tight_below_mm, loose_above_mm, updated_at)
                VALUES (1, 'tops', 'p', 50, 100, 0);
            INSERT INTO subject (subject_id, name, revision, hash, sex, stature_mm, created_at)
                VALUES (1, 'ii', 1, 'h', 'male', 1690, 0);
            INSERT INTO style VALUES (1, 'tee', 1, 'h', 's', '', 0);
            INSERT INTO fabric (fabric_id, name, revision, hash, density_kg_m2, thickness_mm, membrane_warp_n_m,
                    membrane_weft_n_m, membrane_coupling_n_m, shear_n_m, bending_warp_nm, bending_weft_nm, friction_body,
                    friction_self, source, created_at)
                VALUES (1, 'poplin', 1, 'h', 0.1, 0.2, 1, 1, 0, 1, 1, 1, 0, 0, '', 0);";
        connection.execute_batch(fill).expect("valid");
        let jobs =
            [(1, "S", "a", "done"), (2, "M", "a", "not_converged"), (3, "S", "b", "done"), (4, "L", "a", "queued")];
        jobs.iter().for_each(|(id, size, hash, status)| {
            connection.execute_batch(&job(*id, size, hash, status)).expect("valid");
        });
        connection.pragma_update(None, "user_version", 17).expect("writable");
        drop(connection);
        let connection = open(&path, Access::Create).expect("brought up to date");
        let list = |sql: &str| connection.query_row(sql, [], |row| row.get::<_, String>(0)).expect("some");
        assert_eq!(list("SELECT group_concat(job_id) FROM job WHERE is_current"), "3,4");
        assert_eq!(list("SELECT group_concat(job_id) FROM job_log WHERE text LIKE '%another size%'"), "1,2");
    }

    #[test]
    fn published_tables_are_complete_and_show_the_sleeve_misprint() {
        let connection = migrated();
        let count = |sql: &str| connection.query_row(sql, [], |row| row.get::<_, i64>(0)).expect("a count");
        assert_eq!(count("SELECT count(*) FROM v_published"), 888);
        let wrong = "SELECT count(*) FROM v_published WHERE abs(chi - chi_printed) > 0.0006";
        assert_eq!(count(wrong), 48);
        assert_eq!(count(&format!("{wrong} AND measurement_no <> 9")), 0);
    }

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

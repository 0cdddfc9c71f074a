//! The SQLite database: opening it, bringing its schema up to date, and the settings that make `kill -9` harmless.

use std::path::Path;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use rusqlite::hooks::{AuthAction, AuthContext, Authorization};
use rusqlite::{Connection, OpenFlags, Transaction, TransactionBehavior};

use super::error::{Result, StudyError};
use super::{evidence, sql};

/// Schema changes in order, never edited once released: `user_version` counts how many a database has.
const MIGRATIONS: [&str; 8] = [
    include_str!("../../db/migrations/0001_store.sql"),
    include_str!("../../db/migrations/0002_views.sql"),
    include_str!("../../db/migrations/0003_published.sql"),
    include_str!("../../db/migrations/0004_published_metrics.sql"),
    include_str!("../../db/migrations/0005_catalogue.sql"),
    include_str!("../../db/migrations/0006_stretched.sql"),
    include_str!("../../db/migrations/0007_hybrid_gap.sql"),
    include_str!("../../db/migrations/0020_evidence.sql"),
];

/// How long a statement waits for another process's write.
const BUSY_TIMEOUT: Duration = Duration::from_secs(20);

/// How a connection is used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Access {
    /// Reads only; the file must exist.
    Read,
    /// Reads and writes, and makes the file where there is none: for whoever opens a workspace.
    Create,
    /// Reads and writes; a commit is on disk when it returns. The file must exist.
    Write,
    /// Writes that may be lost with the power (progress, heartbeats); never torn. The file must exist.
    Volatile,
}

/// Opens a database, creating and migrating it where the access allows. Only [`Access::Create`] makes a file: were a
/// run's database deleted under it, its workers must not go on in an empty one of the same name.
pub(crate) fn open(path: &Path, access: Access) -> Result<Connection> {
    let fail = |reason: String| StudyError::Open { path: path.to_owned(), reason };
    if access == Access::Read {
        let flags = OpenFlags::SQLITE_OPEN_READ_ONLY | OpenFlags::SQLITE_OPEN_NO_MUTEX | OpenFlags::SQLITE_OPEN_URI;
        if !path.exists() {
            return Err(fail("there is no such file; `toile run STUDY` makes one".into()));
        }
        let mut connection = Connection::open_with_flags(path, flags).map_err(|e| fail(e.to_string()))?;
        connection.busy_timeout(BUSY_TIMEOUT)?;
        sql::add_functions(&connection)?;
        check_version(&connection, MIGRATIONS.len() as i64)?;
        connection.authorizer(Some(no_other_files))?;
        return Ok(connection);
    }
    let mut flags = OpenFlags::default();
    if access == Access::Create {
        let folder = path.parent().unwrap_or(Path::new(""));
        std::fs::create_dir_all(folder).map_err(StudyError::io(folder))?;
    } else if path.exists() {
        flags.remove(OpenFlags::SQLITE_OPEN_CREATE);
    } else {
        return Err(fail("the file is gone; it was there when this program opened it".into()));
    }
    let mut connection = Connection::open_with_flags(path, flags).map_err(|e| fail(e.to_string()))?;
    connection.busy_timeout(BUSY_TIMEOUT)?;
    connection.pragma_update(None, "journal_mode", "wal").map_err(|e| fail(e.to_string()))?;
    connection.pragma_update(None, "synchronous", if access == Access::Volatile { "normal" } else { "full" })?;
    connection.pragma_update(None, "foreign_keys", true)?;
    if access == Access::Create {
        migrate(&mut connection)?;
    } else {
        check_version(&connection, MIGRATIONS.len() as i64)?;
    }
    Ok(connection)
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
pub(crate) fn write(connection: &mut Connection) -> rusqlite::Result<Transaction<'_>> {
    connection.transaction_with_behavior(TransactionBehavior::Immediate)
}

/// The clock, ms since 1970 (UTC). Only queue bookkeeping reads it; results never depend on it.
#[must_use]
pub fn now_ms() -> i64 {
    SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_millis() as i64)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCHEMA: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/db/schema.sql");

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

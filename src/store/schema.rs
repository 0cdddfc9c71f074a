//! Migrations of the schema, and their application to a database.

use rusqlite::Connection;

use crate::error::{Result, StudyError};
use crate::evidence::judge::refresh_all;
use crate::transaction::write;

/// Changes of the schema in order, never edited once released. A database's `user_version` counts those it has.
const MIGRATIONS: [&str; 22] = [
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
    include_str!("../../db/migrations/0019_figures.sql"),
    include_str!("../../db/migrations/0020_specifications.sql"),
    include_str!("../../db/migrations/0021_decides.sql"),
    include_str!("../../db/migrations/0022_comments.sql"),
];

pub(crate) const LATEST: i64 = MIGRATIONS.len() as i64;

/// Applies all migrations that a database lacks, or none.
pub(crate) fn migrate(connection: &mut Connection) -> Result<()> {
    if check_version(connection, 0)? == MIGRATIONS.len() {
        return Ok(());
    }
    let transaction = write(connection)?;
    let have = check_version(&transaction, 0)?;
    for sql in &MIGRATIONS[have..] {
        transaction.execute_batch(sql)?;
    }
    transaction.pragma_update(None, "user_version", LATEST)?;
    refresh_all(&transaction)?;
    Ok(transaction.commit()?)
}

/// Number of migrations that a database has; an error where this program knows fewer, or `least` asks for more.
pub(crate) fn check_version(connection: &Connection, least: i64) -> Result<usize> {
    let known = LATEST;
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::connection::{Access, open};

    const SCHEMA: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../db/schema.sql");

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

    /// The migrations as they were before two changes that came without a version: counts of crossings, stored reports.
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
}

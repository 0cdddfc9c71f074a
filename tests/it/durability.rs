//! What may happen to a run, and what must be left: kills, a full disk, locks, a clock that is set, a database deleted.
//!
//! `TOILE_KILLS=100 cargo test --release killed` kills more often.

use std::collections::BTreeMap;
use std::process::{Child, Command, Stdio};
use std::sync::OnceLock;
use std::time::{Duration, Instant};

use rusqlite::Connection;
use rusqlite::types::Value;

use super::program::{Kept, Place, Said};

/// Kills where `TOILE_KILLS` does not say how many.
const KILLS: usize = 12;

/// A small study of many quick jobs: three sizes on one man by Hybrid-GS, coarse, several times.
fn place(repeats: u32) -> Place {
    let place = Place::new();
    place.hybrid_study(&format!("repeats = {repeats}"), &[("tee", 0.1, &["s", "m", "l"])], "");
    place
}

const RUN: &str = "run . --workers 2 --no-report --quiet";

/// A study of six jobs that nothing disturbed, and its results.
struct Undisturbed {
    place: Kept,
    results: Vec<Vec<Vec<Value>>>,
    took: Duration,
}

fn undisturbed() -> &'static Undisturbed {
    static KEPT: OnceLock<Undisturbed> = OnceLock::new();
    KEPT.get_or_init(|| {
        let place = place(2);
        let began = Instant::now();
        let said = end(start(place.command(RUN))).ends_with(0);
        Undisturbed { took: began.elapsed(), results: results(&place), place: Kept::of(&place, said) }
    })
}

fn start(mut command: Command) -> Child {
    command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().expect("it starts")
}

/// Waits for a program that was started.
fn end(child: Child) -> Said {
    let output = child.wait_with_output().expect("ours");
    Said { code: output.status.code(), out: String::new(), err: String::from_utf8_lossy(&output.stderr).into() }
}

fn open(place: &Place) -> Connection {
    let connection = Connection::open(place.path("toile.sqlite")).expect("it opens");
    connection.busy_timeout(Duration::from_secs(20)).expect("a duration");
    connection
}

fn rows(connection: &Connection, sql: &str) -> Vec<Vec<Value>> {
    let mut statement = connection.prepare(sql).unwrap_or_else(|error| panic!("{sql}: {error}"));
    let width = statement.column_count();
    let row = |row: &rusqlite::Row<'_>| (0..width).map(|k| row.get(k)).collect();
    statement.query_map([], row).expect("no parameters").collect::<Result<_, _>>().expect("readable")
}

/// Everything that a study's results are, bit by bit; not when and where they were made.
pub fn results(place: &Place) -> Vec<Vec<Vec<Value>>> {
    let connection = open(place);
    let questions = [
        "SELECT job_id, garment, size, subject, simulator, repeat, input_hash, status FROM job ORDER BY job_id",
        "SELECT * FROM chi ORDER BY job_id, stage, measurement_no",
        "SELECT * FROM metrics ORDER BY job_id",
        "SELECT * FROM history ORDER BY job_id, step",
        "SELECT job_id, kind, hash FROM job_artefact ORDER BY job_id, kind",
        "SELECT hash, kind, bytes FROM artefact ORDER BY hash",
        "SELECT * FROM ease ORDER BY garment, size, subject, level",
    ];
    questions.map(|sql| rows(&connection, sql)).into()
}

/// Finished jobs with all that is known of them, by number; checks that the database is sound.
fn finished(place: &Place) -> BTreeMap<i64, Vec<Value>> {
    if !place.path("toile.sqlite").exists() {
        return BTreeMap::new();
    }
    let connection = open(place);
    let text = |value: &str| Value::Text(value.to_owned());
    assert_eq!(rows(&connection, "PRAGMA integrity_check"), [[text("ok")]]);
    assert!(rows(&connection, "PRAGMA foreign_key_check").is_empty());
    if rows(&connection, "PRAGMA user_version") == [[Value::Integer(0)]] {
        return BTreeMap::new(); // killed before there were tables
    }
    let twice = "SELECT job_id FROM job_log WHERE text LIKE 'done: %' GROUP BY job_id HAVING count(*) > 1";
    assert!(rows(&connection, twice).is_empty(), "done twice");
    let half = "SELECT job_id FROM job LEFT JOIN metrics USING (job_id) LEFT JOIN provenance USING (job_id)
        WHERE (status = 'done') <> (n IS NOT NULL) OR (status = 'done') <> (seed IS NOT NULL)
            OR (status = 'done') <> (9 = (SELECT count(*) FROM chi WHERE chi.job_id = job.job_id AND stage = 'drape'))";
    assert!(rows(&connection, half).is_empty(), "half a result");
    let done = rows(&connection, "SELECT * FROM job WHERE status = 'done'");
    let number = |row: &Vec<Value>| match row[0] {
        Value::Integer(number) => number,
        ref other => panic!("a number, not {other:?}"),
    };
    done.into_iter().map(|row| (number(&row), row)).collect()
}

/// Numbers that look random [Steele 2014: SplitMix64].
struct Random(u64);

impl Random {
    /// The next one, 0 to 1.
    fn share(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let x = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (x ^ (x >> 31)) as f64 / u64::MAX as f64
    }
}

#[test]
fn a_run_killed_at_any_moment_loses_nothing_and_ends_the_same() {
    let kills = std::env::var("TOILE_KILLS").ok().and_then(|text| text.parse().ok()).unwrap_or(KILLS);
    let Undisturbed { results: expect, took, .. } = undisturbed();
    let mut took = *took;
    let (mut random, mut done, mut rounds) = (Random(6), 0, 0);
    while done < kills {
        let place = place(2);
        let mut before = BTreeMap::new();
        rounds += 1;
        loop {
            let moment = took.mul_f64(random.share());
            let mut run = start(place.command(RUN));
            std::thread::sleep(moment);
            if done == kills || run.try_wait().expect("ours").is_some() {
                end(run).ends_with(0);
                took = took.mul_f64(0.7); // less was left to do, or the machine has become faster
                break;
            }
            run.kill().expect("SIGKILL");
            end(run);
            done += 1;
            let now = finished(&place);
            for (job, row) in &before {
                assert_eq!(now.get(job), Some(row), "kill {done}, {moment:?}: a finished job has changed");
            }
            if now.len() == before.len() {
                took = took.mul_f64(1.2); // or slower
            }
            before = now;
        }
        for (job, row) in before {
            assert_eq!(finished(&place).get(&job), Some(&row), "computed again");
        }
        assert_eq!(finished(&place).len(), 6);
        assert_eq!(results(&place), *expect, "bit by bit");
    }
    eprintln!("{done} kills in {rounds} runs");
}

/// A run that has done a job and has others to do.
fn started(place: &Place) -> Child {
    let before = finished(place).len();
    let mut run = start(place.command(RUN));
    let patience = Instant::now() + Duration::from_secs(60);
    while finished(place).len() == before {
        assert!(Instant::now() < patience && run.try_wait().expect("ours").is_none(), "no job was done");
        std::thread::sleep(Duration::from_millis(20));
    }
    run
}

#[test]
fn a_lost_job_is_told_as_interrupted_where_nothing_may_be_written() {
    let place = place(40);
    let running = || rows(&open(&place), "SELECT job_id FROM job WHERE status = 'running'").len();
    let mut lost = 0;
    // Between two jobs nothing is lost.
    while lost == 0 {
        let mut run = started(&place);
        run.kill().expect("SIGKILL");
        run.wait().expect("ours");
        lost = running();
    }
    let told = place.toile("queue ls --readonly").ends_with(0).out;
    assert_eq!(told.matches("interrupted: process").count(), lost, "{told}");
    assert_eq!(running(), lost, "nothing is written");
    let told = place.toile("queue ls").ends_with(0);
    let words = format!("a run was interrupted: {lost} of its jobs wait in the queue again");
    assert!(told.err.contains(&words) && !told.out.contains("interrupted: "), "{}", told.err);
    assert!(told.out.contains("ended before the job did"), "{}", told.out);
    assert_eq!(running(), 0);
    let again = place.sql("SELECT job_id FROM v_jobs WHERE status = 'queued' AND attempts = 1");
    assert_eq!(again.len(), lost);
    assert!(place.toile(&format!("queue log {}", again[0])).ends_with(0).out.contains("queued again"));
}

#[test]
fn two_runs_at_once_share_the_work() {
    let place = place(2);
    let both = [(), ()].map(|()| start(place.command(RUN)));
    for run in both {
        end(run).ends_with(0);
    }
    assert_eq!(finished(&place).len(), 6);
    assert_eq!(place.one("SELECT max(attempts) FROM v_jobs"), "1");
    assert_eq!(results(&place), undisturbed().results);
}

/// Runs the program with its files limited to some KiB, as a full disk would.
fn with_little_room(place: &Place, kib: u64) -> Said {
    let mut command = Command::new("sh");
    let script = format!("trap '' XFSZ; ulimit -f {}; exec \"$0\" \"$@\"", kib * 2);
    command.args(["-c", &script, env!("CARGO_BIN_EXE_toile")]).args(RUN.split_whitespace());
    command.current_dir(place.path("")).env("TOILE_DB", place.path("toile.sqlite"));
    end(start(command))
}

#[test]
fn a_full_disk_is_told_and_costs_nothing_that_was_done() {
    let place = place(2);
    end(start(place.command("run . --size s --no-report --quiet"))).ends_with(0);
    let before = finished(&place);
    assert_eq!(before.len(), 2);
    let said = with_little_room(&place, 200).ends_with(2);
    assert!(said.err.contains("make room and start again"), "{}", said.err);
    let now = finished(&place);
    assert!(before.iter().all(|(job, row)| now.get(job) == Some(row)) && now.len() < 6, "{}", now.len());
    assert_eq!(place.one("SELECT count(*) FROM v_jobs WHERE status = 'failed'"), "0", "no job's fault");
    end(start(place.command(RUN))).ends_with(0);
    assert_eq!(results(&place), undisturbed().results);
}

#[test]
fn a_locked_database_is_waited_for_and_then_told() {
    let place = place(1);
    place.toile("ease . --quiet").ends_with(0);
    let other = open(&place);
    other.execute_batch("BEGIN IMMEDIATE").expect("it is free");
    let mut command = place.command(RUN);
    command.env("TOILE_PATIENCE_S", "0.2");
    let said = end(start(command)).ends_with(2);
    assert!(said.err.contains("another process keeps it to itself"), "{}", said.err);
    assert_eq!(place.one("SELECT count(*) FROM v_ease WHERE decides"), "3", "reading goes on");
    let waiting = start(place.command(RUN));
    std::thread::sleep(Duration::from_millis(300));
    other.execute_batch("COMMIT").expect("ours");
    end(waiting).ends_with(0);
    assert_eq!(finished(&place).len(), 3);
}

/// Whom a program may be started as that may not write what this process may.
#[cfg(unix)]
const NOBODY: u32 = 65_534;

#[test]
#[cfg(unix)]
fn a_database_that_cannot_be_written_is_read_and_told_of() {
    use std::os::unix::fs::{MetadataExt, PermissionsExt};
    use std::os::unix::process::CommandExt;
    let place = undisturbed().place.copy();
    let mode = |name: &str, mode: u32| {
        std::fs::set_permissions(place.path(name), std::fs::Permissions::from_mode(mode)).expect("ours");
    };
    mode("toile.sqlite", 0o444);
    mode("", 0o555);
    let as_other = |arguments: &str| {
        let mut command = place.command(arguments);
        // Root may write anything, whatever the mode says.
        if std::fs::metadata(place.path("")).expect("there").uid() == 0 {
            command.uid(NOBODY).gid(NOBODY);
        }
        command.stdout(Stdio::piped()).stderr(Stdio::piped()).output()
    };
    let Ok(output) = as_other("--version") else {
        eprintln!("skipped: no other user may start the program here");
        mode("", 0o755);
        return;
    };
    assert!(output.status.success());
    let output = as_other(RUN).expect("it starts");
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.code() == Some(2) && said.contains("may not be written to"), "{said}");
    let output = as_other("queue ls --readonly").expect("it starts");
    let told = String::from_utf8_lossy(&output.stdout).into_owned();
    mode("", 0o755);
    assert!(output.status.success() && told.matches("done").count() >= 6, "{told}");
    assert_eq!(finished(&place).len(), 6);
}

#[test]
fn a_clock_that_is_set_back_changes_no_result() {
    let place = place(2);
    end(start(place.command("run . --size s --no-report --quiet"))).ends_with(0);
    // As if all of that had happened tomorrow, and a machine that is no more had a job.
    let later = "UPDATE job SET queued_at = queued_at + 86400000, started_at = started_at + 86400000,
        finished_at = finished_at + 86400000; UPDATE job_log SET at = at + 86400000";
    open(&place).execute_batch(later).expect("valid");
    let before = finished(&place);
    end(start(place.command(RUN))).ends_with(0);
    let now = finished(&place);
    assert_eq!(now.len(), 6);
    assert!(before.iter().all(|(job, row)| now.get(job) == Some(row)));
    assert_eq!(place.one("SELECT count(*) FROM v_jobs WHERE wall_ms < 0"), "0");
    assert!(place.toile("run . --why --no-report").ends_with(0).err.contains("6 jobs, 0 to run, 6 up to date"));
}

#[test]
fn a_database_deleted_under_a_run_is_told_and_not_made_anew() {
    let place = place(40);
    let run = started(&place);
    for name in ["toile.sqlite", "toile.sqlite-wal", "toile.sqlite-shm"] {
        std::fs::remove_file(place.path(name)).expect("there");
    }
    let said = end(run).ends_with(2);
    assert!(said.err.contains("the file is gone"), "{}", said.err);
    assert!(!place.path("toile.sqlite").exists());
    end(start(place.command("run . --size s --dry-run --quiet"))).ends_with(0);
}

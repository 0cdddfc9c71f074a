//! The workbench on ten thousand jobs and a million measurements: a key, a frame, a reading of the database.
//!
//! `cargo bench --bench workbench` measures; `cargo bench -- --test` runs each once.

use std::sync::LazyLock;

use crossterm::event::KeyCode;
use divan::Bencher;
use rusqlite::Connection;
use toile::tui::Headless;
use toile::wardrobe::catalogue;

fn main() {
    divan::main();
}

/// Fifty sizes on a hundred subjects by both simulators, a hundred measurements each.
const FILL: &str = "
    PRAGMA synchronous = OFF;
    BEGIN;
    CREATE TEMP TABLE n AS WITH RECURSIVE n(x) AS (SELECT 0 UNION ALL SELECT x + 1 FROM n WHERE x < 9999) SELECT x FROM n;
    INSERT INTO study VALUES (1, 'great', 'great/study.toml', 50, 100, 0, 0);
    INSERT INTO study_axis VALUES (1, 'garment', 'tshirt', 0);
    INSERT INTO study_axis SELECT 1, 'size', 'size ' || x, x FROM n WHERE x < 50;
    INSERT INTO study_axis SELECT 1, 'subject', 'subject ' || x, x FROM n WHERE x < 100;
    INSERT INTO style (style_id, name, revision, hash, seam_file, seams, created_at) VALUES (1, 'tshirt', 1, 'h', 's', '', 0);
    INSERT INTO size (size_id, style, name, revision, hash, pattern_file, pattern, created_at)
        VALUES (1, 'tshirt', 'S', 1, 'h', 'p', x'', 0);
    INSERT INTO job (job_id, study_id, garment, size, subject, simulator, input_hash, status, owner, heartbeat_at,
            queued_at, started_at, finished_at, wall_ms, subject_id, style_id, size_id, fabric_id)
        SELECT x + 1, 1, 'tshirt', 'size ' || (x / 200), 'subject ' || (x / 2 % 100), iif(x % 2, 'hybrid', 'fem'), x,
            iif(x % 50 = 7, 'queued', 'done'), NULL, NULL, 0, 1, 2, 9000 + x, (SELECT min(subject_id) FROM subject), 1, 1,
            (SELECT min(fabric_id) FROM fabric)
        FROM n;
    INSERT INTO metrics SELECT job_id, 100, 1.01, 0.02, 0.0001 * (job_id % 700), 0.05, 5000, 10000, 400, 0.009, 1, 0.1, 0, 0, 0.02
        FROM job WHERE status = 'done';
    INSERT INTO chi SELECT job_id, 'drape', n.x + 1, 'Measurement ' || n.x, 'open_length', 0, 0, 500, 500 + n.x
        FROM job JOIN n ON n.x < 100;
    INSERT INTO ease SELECT 1, 'tshirt', 'size ' || s.x, 'subject ' || p.x, 'chest', 1000 + 4 * s.x, 1000 + p.x, 1
        FROM n AS s JOIN n AS p ON s.x < 50 AND p.x < 100;
    COMMIT;";

/// The folder of the great study, and the database in it.
static GREAT: LazyLock<(tempfile::TempDir, std::path::PathBuf)> = LazyLock::new(|| {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("toile.sqlite");
    drop(catalogue::open(&path, false).expect("a new database"));
    let connection = Connection::open(&path).expect("it is there");
    connection.execute_batch(FILL).expect("the schema of this version");
    (folder, path)
});

/// The workbench on one of its screens.
fn on_screen(keys: &str) -> Headless {
    let mut workbench = Headless::new(&GREAT.1, 160, 50).expect("readable");
    for key in keys.chars() {
        workbench.press(KeyCode::Char(key));
    }
    workbench.draw();
    workbench
}

/// A key and the frame after it, on the screens with the longest lists.
#[divan::bench(args = ["1", "4", "5", "9", "4/subject 4"])]
fn key_and_frame(bencher: Bencher, keys: &str) {
    let mut workbench = on_screen(keys);
    let mut is_down = false;
    bencher.bench_local(|| {
        is_down = !is_down;
        workbench.press(if is_down { KeyCode::Down } else { KeyCode::Up });
        workbench.draw()
    });
}

/// A letter of a filter, for which all jobs are looked at, and the frame after it.
#[divan::bench]
fn filter_letter_and_frame(bencher: Bencher) {
    let mut workbench = on_screen("4/");
    let mut is_typed = false;
    bencher.bench_local(|| {
        is_typed = !is_typed;
        workbench.press(if is_typed { KeyCode::Char('7') } else { KeyCode::Backspace });
        workbench.draw()
    });
}

/// Everything the screens show, read anew; a thread does that while the screen goes on.
#[divan::bench(sample_count = 10)]
fn read(bencher: Bencher) {
    let mut workbench = on_screen("1");
    bencher.bench_local(|| workbench.read());
}

/// From opening the database to the first frame.
#[divan::bench(sample_count = 10)]
fn start(bencher: Bencher) {
    LazyLock::force(&GREAT);
    bencher.bench_local(|| Headless::new(&GREAT.1, 160, 50).map(|mut workbench| workbench.draw()));
}

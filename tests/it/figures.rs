//! How fast the real program is: start, keys, bytes, rest. Figures for docs/workbench.md, not a test: machines differ.
//!
//! `TOILE_DB=great.sqlite cargo test --release --test it figures -- --ignored --nocapture` prints them.

use std::time::{Duration, Instant};

use super::program::Place;
use super::seat::Seat;
use super::workbench::workbench;

/// Keys after each other, each with what it does.
const KEYS: [(&str, &str); 13] = [
    ("<Down>", "the next line of the grid"),
    ("4", "the queue"),
    ("<Down>", "the next job"),
    ("<PgDn>", "a page of jobs"),
    ("g", "the first job"),
    ("/", "the line of the filter"),
    ("7", "a letter of it, over all jobs"),
    ("<Enter>", "the filter kept"),
    ("5", "a result, and its picture"),
    ("<Right>", "the next one"),
    ("v", "its picture turned"),
    ("0", "how all sizes sit"),
    ("9", "the fabrics"),
];
/// Pause after which nothing more is taken as the answer to a key: longer than a picture takes.
const PAUSE: Duration = Duration::from_millis(1500);
/// How long the program is watched at rest.
const REST: Duration = Duration::from_secs(10);

#[test]
#[ignore = "prints figures of the workbench on the database of TOILE_DB"]
fn figures_of_the_workbench() {
    let database = std::env::var("TOILE_DB").expect("TOILE_DB names a database with results");
    for (columns, rows) in [(80, 24), (160, 50)] {
        let place = Place::new();
        let mut command = workbench(&place);
        command.env("TOILE_DB", std::path::absolute(&database).expect("a path"));
        let start = Instant::now();
        let Some(mut seat) = Seat::take(&command, columns, rows) else { return };
        let first = seat.first_byte(0, start);
        seat.wait_for("FEM");
        eprintln!("{columns}x{rows}: first byte {first:?}, data {:?} after the start", start.elapsed());
        seat.settle();
        for (key, what) in KEYS {
            let before = seat.bytes();
            let start = Instant::now();
            seat.press(key);
            let first = seat.first_byte(before, start);
            let last = seat.last_byte(start, PAUSE);
            let bytes = seat.bytes() - before;
            eprintln!("  {key:7} first byte {first:>9.1?}, last {last:>9.1?}, {bytes:6} bytes: {what}");
        }
        let before = seat.cpu();
        std::thread::sleep(REST);
        let share = 100.0 * (seat.cpu() - before).as_secs_f64() / REST.as_secs_f64();
        eprintln!("  {share:.2} % of a core at rest");
        seat.press("<C-c>");
        seat.end();
    }
}

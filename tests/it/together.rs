//! Several processes on one database at once: what one does, all show.

use std::time::{Duration, Instant};

use super::program::{DRAPED, Place};
use super::seat::Seat;
use super::workbench::workbench;

/// Time within which all see the same.
const SOON: Duration = Duration::from_secs(1);
/// Times that something is changed: a machine busy with other things may be late now and then.
const TRIALS: usize = 6;

/// Waits until both screens show something; returns how long that took.
#[track_caller]
fn seen_by_both(seats: &[Seat; 2], what: &str, holds: impl Fn(&str) -> bool + Copy) -> Duration {
    let start = Instant::now();
    seats.iter().for_each(|seat| drop(seat.wait_until(what, holds)));
    start.elapsed()
}

#[test]
fn two_workbenches_and_a_run_see_the_same_within_a_second() {
    let place = Place::new();
    place.hybrid_study("", &DRAPED, "");
    let mut command = workbench(&place);
    command.args(["--images", "off"]);
    let Some(first) = Seat::take(&command, 80, 24) else { return };
    let second = Seat::take(&command, 120, 40).expect("the first had a seat");
    let mut seats = [first, second];
    seen_by_both(&seats, "no study yet", |screen| screen.contains("no study yet"));

    // A run elsewhere: both follow it from its jobs in the queue to their end.
    let mut run =
        place.command("run . --no-report --workers 1").stdin(std::process::Stdio::null()).spawn().expect("it starts");
    seen_by_both(&seats, "the queue of the run", |screen| screen.contains("coarse"));
    seats.iter().for_each(|seat| seat.press("4"));
    seen_by_both(&seats, "its jobs", |screen| screen.contains("2 jobs"));

    // What one does, the other sees.
    let mut delays = Vec::new();
    for k in 0..TRIALS {
        let is_paused = k % 2 == 0;
        seats[k % 2].press("p");
        // The last line says it too, to the one who did it.
        let says_paused = |screen: &str| screen.lines().next().is_some_and(|line| line.contains(" paused"));
        delays.push(seen_by_both(&seats, "pause and resume", |screen| says_paused(screen) == is_paused));
    }
    delays.sort_unstable();
    assert!(delays[TRIALS / 2] < SOON, "{delays:?}");

    assert!(run.wait().expect("ours").success());
    let start = Instant::now();
    seen_by_both(&seats, "the end of the run", |screen| !screen.contains('▶') && !screen.contains("…1"));
    let states = "SELECT group_concat(status) FROM (SELECT status FROM v_jobs ORDER BY job_id)";
    let stored = place.one(states);
    assert!(!stored.contains("queued") && !stored.contains("running"), "{stored}");
    assert!(start.elapsed() < 10 * SOON, "{:?}", start.elapsed());
    for seat in &mut seats {
        seat.press("<C-c>");
        assert_eq!(seat.end().code(), Some(0));
        seat.is_sane();
    }
}

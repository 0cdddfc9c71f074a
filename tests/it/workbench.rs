//! The workbench as its users meet it: the real program in a pseudo-terminal, from a first start to a report.

use std::fs;
use std::process::Command;

use rustix::process::Signal;

use super::program::Place;
use super::seat::Seat;

/// The workbench in a folder of its own, with colours a plain terminal has.
pub fn workbench(place: &Place) -> Command {
    let mut command = place.command("");
    command.env("TERM", "xterm-256color").env("XDG_STATE_HOME", place.path("state"));
    for name in ["COLORTERM", "TMUX", "STY", "SSH_TTY", "DISPLAY", "WAYLAND_DISPLAY", "XDG_CONFIG_HOME", "TOILE_ASCII"]
    {
        command.env_remove(name);
    }
    command.env("HOME", place.path("home"));
    command
}

/// From a first start through a new study, run, cancel, retry, compare, SQL and report to the end, and a second start.
#[test]
fn a_session_from_first_start_to_report() {
    let place = Place::new();
    let Some(mut seat) = Seat::take(&workbench(&place), 80, 24) else { return };
    seat.wait_for("make a study of your own");

    // Sizes S and M of the drafted T-shirt on male-ii, by Hybrid-GS.
    seat.press("a");
    seat.wait_for("F5 make it");
    seat.press("<Tab>l<Down> <Down> <Tab><Down><Down><Down><Down><Down><Down><Down> <Tab> <Tab>");
    seat.wait_for("cotton_shirting_light");
    let form = seat.wait_for("1 subject × 2 sizes × 1 simulator = 2 simulations");
    assert!(form.contains("[x] male-ii"), "{form}");
    seat.press("<Enter>");
    seat.wait_for("…2");
    let file = place.path("studies/study-1/study.toml");
    let text = fs::read_to_string(&file).expect("the study was written");
    assert!(text.contains("like = \"male-ii\"") && text.contains("patterns/tshirt-s.dxf"), "{text}");
    fs::write(&file, text.replace("edge_length_mm = 15", "edge_length_mm = 60")).expect("writable");

    run_cancel_retry(&seat);
    seat.press("g <Down> ");
    seat.wait_for("2 runs are selected");
    seat.press("c");
    let compared = seat.wait_for("nearest to 1, of");
    assert!(compared.contains("Neck Opening") && compared.contains("differ in:"), "{compared}");

    seat.press("7eSELECT garment, size, simulator, status FROM v_jobs WHERE is_current ORDER BY size<F5>");
    let answer = seat.wait_for("2 rows in");
    assert!(answer.contains("tshirt") && answer.contains("hybrid"), "{answer}");
    seat.press("<Tab>8b");
    seat.wait_for("the report is in");
    let page = fs::read_to_string(place.path("reports/study-1/index.html")).expect("the report was written");
    assert!(page.contains("study-1") && page.contains("half chest") && page.contains("wear "));
    seat.press(":quit<Enter>");
    assert_eq!(seat.end().code(), Some(0));
    seat.is_sane();

    let Some(mut seat) = Seat::take(&workbench(&place), 80, 24) else { return };
    let again = seat.wait_for("reports/study-1/index.html");
    assert!(again.contains("8 Reports"), "it starts where it was left: {again}");
    seat.press("7");
    seat.wait_for("WHERE is_current");
    seat.press("<C-c>");
    assert_eq!(seat.end().code(), Some(0));
}

/// Runs the study while it is paused, so that a job can be cancelled and queued again before it is simulated.
fn run_cancel_retry(seat: &Seat) {
    seat.press("p");
    seat.wait_for("paused");
    seat.press("R");
    seat.wait_for("run started");
    seat.press("4");
    seat.wait_for("took");
    // The jobs of the finer mesh are no longer the study's own.
    seat.wait_until("two new jobs", |screen| screen.contains("3 …") && screen.contains("4 …"));
    seat.press("gx");
    seat.wait_for("Cancel job 3");
    seat.press("y");
    seat.wait_for("⊘1");
    seat.press("r");
    seat.wait_until("queued again", |screen| screen.contains("…2") && !screen.contains("⊘1"));
    seat.press("p");
    seat.wait_for("the run has ended: study-1: 2 done");
    seat.wait_until("two results", |screen| !screen.contains("…1") && !screen.contains("▶"));
}

#[test]
fn the_screen_follows_the_size_of_the_terminal() {
    let place = Place::new();
    let Some(mut seat) = Seat::take(&workbench(&place), 80, 24) else { return };
    seat.wait_for("1 Study 2 Sub");
    for (columns, rows, text) in
        [(160, 50, "2 Subjects  3 Styles"), (40, 10, " 1 Study 2 3 4 5 6 7 8"), (80, 24, "2 Sub 3 Sty")]
    {
        seat.resize(columns, rows);
        seat.wait_for(text);
    }
    seat.press("q");
    assert_eq!(seat.end().code(), Some(0));
    seat.is_sane();
}

#[test]
fn signals_leave_the_terminal_as_it_was() {
    for signal in [Signal::TERM, Signal::HUP, Signal::INT] {
        let place = Place::new();
        let Some(mut seat) = Seat::take(&workbench(&place), 80, 24) else { return };
        seat.wait_for("no study yet");
        seat.signal(signal);
        seat.end();
        seat.is_sane();
    }
}

#[test]
fn what_was_left_by_a_crash_is_there_again() {
    let place = Place::new();
    let Some(mut seat) = Seat::take(&workbench(&place), 80, 24) else { return };
    seat.wait_for("no study yet");
    seat.press("9<Down>");
    let kept = || {
        fs::read_dir(place.path("state/toile"))
            .into_iter()
            .flatten()
            .flatten()
            .any(|file| fs::read_to_string(file.path()).is_ok_and(|text| text.contains("\"screen\": 8")))
    };
    seat.wait_until("the session", |_| kept());
    seat.signal(Signal::KILL);
    seat.end();
    let Some(mut seat) = Seat::take(&workbench(&place), 80, 24) else { return };
    seat.wait_for("9 Fabrics");
    seat.press("<C-c>");
    seat.end();
}

#[test]
fn ctrl_z_gives_the_terminal_to_the_shell_and_fg_takes_it_again() {
    let place = Place::new();
    let inner = workbench(&place);
    let mut shell = Command::new("sh");
    let program = inner.get_program().to_string_lossy().into_owned();
    shell.arg("-c").arg(format!("set -m; '{program}'; echo back in the shell; read line; fg >&2; echo end"));
    shell.current_dir(inner.get_current_dir().expect("a folder"));
    for (name, value) in inner.get_envs() {
        match value {
            Some(value) => shell.env(name, value),
            None => shell.env_remove(name),
        };
    }
    let Some(mut seat) = Seat::take(&shell, 80, 24) else { return };
    seat.wait_for("no study yet");
    seat.press("9");
    seat.wait_for("30 fabrics");
    seat.press("\x1a");
    seat.wait_for("back in the shell");
    seat.is_sane();
    seat.press("go on\n");
    seat.wait_for("30 fabrics");
    seat.press("<C-c>");
    seat.wait_for("end");
    seat.end();
    seat.is_sane();
}

#[test]
fn a_copy_says_where_it_is() {
    let place = Place::new();
    place.write("bin/tmux", "#!/bin/sh\n[ \"$1 $2\" = 'load-buffer -w' ] && cat > buffer\n");
    let tmux = place.path("bin/tmux");
    fs::set_permissions(&tmux, std::os::unix::fs::PermissionsExt::from_mode(0o755)).expect("ours");
    let check = |set: &[(&str, String)], told: &str| {
        let mut command = workbench(&place);
        command.envs(set.iter().map(|(name, value)| (name, value)));
        let Some(mut seat) = Seat::take(&command, 160, 24) else { return };
        seat.wait_for("1 Study");
        seat.press("9");
        seat.wait_for("30 fabrics");
        seat.press("gy");
        seat.wait_for(told);
        seat.press("<C-c>");
        seat.end();
    };
    check(&[], "copied the fabric: sent to your terminal's clipboard (OSC 52)");
    let path = format!("{}:{}", place.path("bin").display(), std::env::var("PATH").unwrap_or_default());
    check(&[("TMUX", "/tmp/tmux,1,0".to_owned()), ("PATH", path)], "copied the fabric: in the buffer of tmux");
    let copied = fs::read_to_string(place.path("buffer")).expect("loaded");
    check(&[("TERM", "linux".to_owned())], "since no clipboard is in reach");
    let file = fs::read_to_string(place.path("state/toile/copied.txt")).expect("written");
    assert!(copied == file && file.starts_with("canvas\t"), "{copied} {file}");
}

#[test]
fn a_run_is_left_to_another_process() {
    let place = Place::new();
    place.hybrid_study("", &[("light", 0.1, &["s", "m", "l"])], "");
    // A pause lets the run be left before it ends.
    place.toile("run . --no-report --size s").ends_with(0);
    place.toile("queue pause coarse").ends_with(0);
    let Some(mut seat) = Seat::take(&workbench(&place), 80, 24) else { return };
    seat.wait_for("coarse");
    seat.press("R");
    seat.wait_for("its jobs wait until p resumes it");
    seat.press("q");
    seat.wait_for("l leave it running");
    seat.press("l");
    assert_eq!(seat.end().code(), Some(0));
    seat.is_sane();
    assert!(seat.screen().contains("coarse runs as process"), "{}", seat.screen());
    place.toile("queue resume coarse").ends_with(0);
    place.toile("run coarse --attach").ends_with(0);
    assert_eq!(place.one("SELECT count(*) FROM v_jobs WHERE status IN ('done', 'not_converged')"), "3");
}

#[test]
fn a_lost_connection_ends_the_workbench() {
    let place = Place::new();
    let Some(mut seat) = Seat::take(&workbench(&place), 80, 24) else { return };
    seat.wait_for("no study yet");
    seat.hang_up();
    seat.end();
}

/// Debug builds break where they are asked to, so that this can be seen.
#[cfg(debug_assertions)]
#[test]
fn a_panic_gives_the_terminal_back_and_is_told() {
    let place = Place::new();
    let mut command = workbench(&place);
    command.env("TOILE_BREAK", "1").env("RUST_BACKTRACE", "0");
    let Some(mut seat) = Seat::take(&command, 80, 24) else { return };
    seat.wait_for("no study yet");
    seat.press("j");
    assert_eq!(seat.end().code(), Some(101));
    seat.is_sane();
    assert!(seat.screen().contains("TOILE_BREAK"), "{}", seat.screen());
}

/// What normal use sends over a slow line, pictures aside: those come after it, at rest, and are left out here. A screen
/// that fills a large terminal anew takes two of them.
#[test]
fn a_key_costs_less_than_four_kilobytes() {
    let place = Place::new();
    let mut command = workbench(&place);
    command.args(["--images", "off"]);
    let Some(mut seat) = Seat::take(&command, 160, 50) else { return };
    seat.wait_for("no study yet");
    seat.settle();
    let check = |keys: &str, frames: usize| {
        let before = seat.bytes();
        seat.press(keys);
        seat.settle();
        let sent = seat.bytes() - before;
        assert!(sent < frames * 4096, "{keys} sends {sent} bytes:\n{}", seat.screen());
    };
    for (screen, keys) in [
        ("9", "<Down> G <Tab> e <C-c>"),
        ("2", "j j s"),
        ("8", "j"),
        (":", "q <C-c>"),
        ("?", "n <C-c>"),
        ("7", "e s l"),
    ] {
        check(screen, 2);
        keys.split(' ').for_each(|key| check(key, 1));
    }
    seat.press("<C-c>");
    seat.end();
}

/// Keys that come faster than frames share one: what a held key does neither queues up nor fills the line.
#[test]
fn a_held_key_does_not_queue_up() {
    let place = Place::new();
    let Some(mut seat) = Seat::take(&workbench(&place), 160, 50) else { return };
    seat.wait_for("no study yet");
    seat.press("9");
    seat.wait_for("30 fabrics");
    seat.settle();
    let before = seat.bytes();
    seat.press(&"<Down>".repeat(900));
    seat.press(&"<Up>".repeat(400));
    seat.press("<Down>");
    seat.wait_for("chiffon · revision");
    seat.settle();
    let sent = seat.bytes() - before;
    assert!(sent < 1301 * 20, "{sent} bytes for 1301 keys");
    seat.press("<C-c>");
    seat.end();
}

#[test]
fn a_run_in_the_background_is_followed_to_its_end() {
    let place = Place::new();
    place.hybrid_study("", &[("light", 0.1, &["m"])], "");
    let said = place.toile("run . --detach --no-report").ends_with(0);
    assert!(said.out.contains("coarse runs as process") && said.err.contains("--attach"), "{}{}", said.out, said.err);
    place.toile("run coarse --attach").ends_with(0);
    assert_eq!(place.one("SELECT count(*) FROM v_jobs WHERE status IN ('done', 'not_converged')"), "1");
    // What it had to say is in its log, once it has written all of it.
    let log = place.path("coarse.run.log");
    let start = std::time::Instant::now();
    while !fs::read_to_string(&log).is_ok_and(|text| text.contains("chi = L3D / L2D")) {
        assert!(start.elapsed().as_secs() < 60, "{:?}", fs::read_to_string(&log));
        std::thread::sleep(std::time::Duration::from_millis(50));
    }
}

/// The commands of the log that is shown.
fn commands(screen: &str) -> Vec<String> {
    let inside = |line: &str| Some(line.split('│').find(|part| part.trim().starts_with("toile "))?.trim().to_owned());
    screen.lines().filter_map(inside).collect()
}

#[test]
fn what_was_done_is_done_again_by_its_commands() {
    let place = Place::new();
    place.draft();
    let Some(mut seat) = Seat::take(&workbench(&place), 160, 50) else { return };
    seat.wait_for("make a study of your own");
    seat.press("3i");
    seat.wait_for("unit");
    seat.press("patterns/tshirt-s.dxf<F5>");
    seat.wait_for("to decide");
    seat.press("<Enter>");
    seat.wait_for("question 1 of");
    seat.press("A");
    seat.wait_for("no question is left");
    seat.press("w");
    seat.wait_for("has revision 2");
    seat.press("1a");
    seat.wait_for("F5 make it");
    seat.press("<Tab> <Tab><Down><Down><Down><Down><Down><Down><Down> <Tab> <Tab>");
    seat.wait_for("1 subject × 1 size × 1 simulator = 1 simulation");
    seat.press("<Enter>");
    seat.wait_for("…1");
    seat.press("R");
    seat.wait_for("the run has ended: study-1: 1 ");
    seat.press("L");
    let told = commands(&seat.wait_for("toile run "));
    seat.press("q:quit<Enter>");
    assert_eq!(seat.end().code(), Some(0));

    let again = Place::new();
    again.draft();
    for command in &told {
        again.toile(command.strip_prefix("toile ").expect("a command of the program")).ends_with(0);
    }
    let measured = "SELECT measurement_no, stage, l3d_mm, l2d_mm FROM v_chi ORDER BY measurement_no, stage";
    let rows = |place: &Place| {
        let output = place.command("sql").arg(measured).arg("--json").output().expect("it starts");
        String::from_utf8_lossy(&output.stdout).into_owned()
    };
    let (first, second) = (rows(&place), rows(&again));
    assert!(first.contains("l3d_mm") && told.len() >= 4, "{told:?}");
    assert_eq!(first, second, "{told:?}");
}

//! A user at a terminal: the real program in a pseudo-terminal, keys going in, the screen as a terminal would show it.

use std::fs::File;
use std::io::{Read, Write};
use std::num::NonZero;
use std::os::fd::AsFd;
use std::process::{Child, Command, ExitStatus};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::{Duration, Instant};

use rustix::fs::{Mode, OFlags};
use rustix::process::{Pid, Signal, kill_process};
use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
use rustix::termios::{LocalModes, Winsize, tcgetattr, tcsetwinsize};

/// Longest time until the screen shows what is waited for.
const PATIENCE: Duration = Duration::from_secs(240);
/// Time between two looks at the screen.
const LOOK: Duration = Duration::from_millis(30);

/// The program at a terminal. Dropping it kills the program.
pub struct Seat {
    child: Child,
    terminal: Option<File>,
    /// The program's side, kept open to see the terminal's modes after it has left.
    line: File,
    screen: Arc<Mutex<vt100::Parser>>,
    bytes: Arc<AtomicUsize>,
}

fn winsize(columns: u16, rows: u16) -> Winsize {
    Winsize { ws_row: rows, ws_col: columns, ws_xpixel: 0, ws_ypixel: 0 }
}

/// A size as the parser takes it.
fn some(size: u16) -> NonZero<u16> {
    NonZero::new(size).expect("terminals have rows and columns")
}

impl Seat {
    /// Starts a program at a terminal of a size, in a session of its own; `None`, said, where `setsid` is missing.
    pub fn take(program: &Command, columns: u16, rows: u16) -> Option<Self> {
        let ours = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY).expect("a pseudo-terminal");
        grantpt(&ours).expect("ours");
        unlockpt(&ours).expect("ours");
        let name = ptsname(&ours, vec![]).expect("it has a name");
        let line = rustix::fs::open(&*name, OFlags::RDWR | OFlags::NOCTTY | OFlags::CLOEXEC, Mode::empty());
        let line = File::from(line.expect("the other side"));
        tcsetwinsize(&line, winsize(columns, rows)).expect("a terminal");

        let mut command = Command::new("setsid");
        command.arg("-c").arg(program.get_program()).args(program.get_args());
        command.current_dir(program.get_current_dir().expect("the programs of tests have a folder"));
        for (name, value) in program.get_envs() {
            match value {
                Some(value) => command.env(name, value),
                None => command.env_remove(name),
            };
        }
        let side = || line.try_clone().expect("a descriptor");
        let Ok(child) = command.stdin(side()).stdout(side()).stderr(side()).spawn() else {
            eprintln!("skipped: setsid of util-linux is not here");
            return None;
        };
        let screen = Arc::new(Mutex::new(vt100::Parser::new(some(rows), some(columns), 0)));
        let bytes = Arc::new(AtomicUsize::new(0));
        let terminal = File::from(ours);
        let (reader, shown, counted) = (terminal.try_clone().expect("a descriptor"), screen.clone(), bytes.clone());
        thread::spawn(move || show(reader, &shown, &counted));
        Some(Self { child, terminal: Some(terminal), line, screen, bytes })
    }

    /// Presses keys: letters as they are, others by name between angle brackets.
    #[track_caller]
    pub fn press(&self, keys: &str) {
        let mut sent = keys.to_owned();
        for (name, code) in [
            ("<Enter>", "\r"),
            ("<Tab>", "\t"),
            ("<Down>", "\x1b[B"),
            ("<Up>", "\x1b[A"),
            ("<Right>", "\x1b[C"),
            ("<F5>", "\x1b[15~"),
            ("<PgDn>", "\x1b[6~"),
            ("<C-c>", "\x03"),
        ] {
            sent = sent.replace(name, code);
        }
        self.terminal.as_ref().expect("not hung up").write_all(sent.as_bytes()).expect("it listens");
    }

    /// The screen as text.
    pub fn screen(&self) -> String {
        self.screen.lock().expect("no panic").screen().contents()
    }

    /// Something made of the screen with its colours.
    pub fn shown<T>(&self, make: impl Fn(&vt100::Screen) -> T) -> T {
        make(self.screen.lock().expect("no panic").screen())
    }

    /// Bytes the program has sent.
    pub fn bytes(&self) -> usize {
        self.bytes.load(Ordering::Relaxed)
    }

    /// Time from a moment until more was sent than before it.
    #[track_caller]
    pub fn first_byte(&self, before: usize, start: Instant) -> Duration {
        while self.bytes() == before && start.elapsed() < PATIENCE {
            thread::sleep(Duration::from_micros(200));
        }
        start.elapsed()
    }

    /// Time that cores have worked for the program; none where the system does not tell.
    pub fn cpu(&self) -> Duration {
        let stat = std::fs::read_to_string(format!("/proc/{}/stat", self.child.id())).unwrap_or_default();
        let fields = stat.rsplit(')').next().unwrap_or_default().split_whitespace();
        // User and system time are the 14th and 15th field, the first two being before the bracket; ticks of 10 ms.
        let ticks: u64 = fields.skip(11).take(2).filter_map(|field| field.parse::<u64>().ok()).sum();
        Duration::from_millis(10 * ticks)
    }

    /// Waits until the screen contains a text; returns the screen.
    #[track_caller]
    pub fn wait_for(&self, text: &str) -> String {
        self.wait_until(text, |screen| screen.contains(text))
    }

    /// Waits until something holds of the screen.
    #[track_caller]
    pub fn wait_until(&self, what: &str, holds: impl Fn(&str) -> bool) -> String {
        let start = Instant::now();
        loop {
            let screen = self.screen();
            if holds(&screen) {
                return screen;
            }
            assert!(start.elapsed() < PATIENCE, "waited for `{what}`:\n{screen}");
            thread::sleep(LOOK);
        }
    }

    /// Waits until nothing is sent any more.
    pub fn settle(&self) {
        self.last_byte(Instant::now(), Duration::from_millis(400));
    }

    /// Time from a moment to the last that was sent before a pause.
    pub fn last_byte(&self, start: Instant, pause: Duration) -> Duration {
        let (mut seen, mut last) = (self.bytes(), start.elapsed());
        while start.elapsed() - last < pause {
            thread::sleep(Duration::from_millis(2));
            if self.bytes() != seen {
                (seen, last) = (self.bytes(), start.elapsed());
            }
        }
        last
    }

    /// Gives the terminal another size.
    pub fn resize(&self, columns: u16, rows: u16) {
        self.screen.lock().expect("no panic").screen_mut().set_size(some(rows), some(columns));
        tcsetwinsize(&self.line, winsize(columns, rows)).expect("a terminal");
    }

    /// Sends the program a signal.
    pub fn signal(&self, signal: Signal) {
        let pid = Pid::from_child(&self.child);
        kill_process(pid, signal).expect("it runs");
    }

    /// Takes the terminal away, as a lost connection does.
    pub fn hang_up(&mut self) {
        self.terminal = None;
        self.signal(Signal::HUP);
    }

    /// Waits for the program's end.
    #[track_caller]
    pub fn end(&mut self) -> ExitStatus {
        let start = Instant::now();
        loop {
            if let Some(status) = self.child.try_wait().expect("ours") {
                return status;
            }
            assert!(start.elapsed() < PATIENCE, "it does not end:\n{}", self.screen());
            thread::sleep(LOOK);
        }
    }

    /// Checks that the terminal is as it was: lines and echo on, the main screen, a cursor, no mouse.
    #[track_caller]
    pub fn is_sane(&self) {
        let modes = tcgetattr(self.line.as_fd()).expect("a terminal").local_modes;
        assert!(modes.contains(LocalModes::ICANON | LocalModes::ECHO | LocalModes::ISIG), "{modes:?}");
        self.settle();
        let parser = self.screen.lock().expect("no panic");
        let screen = parser.screen();
        assert!(!screen.alternate_screen() && !screen.hide_cursor(), "{}", screen.contents());
        assert_eq!(screen.mouse_protocol_mode(), vt100::MouseProtocolMode::None);
    }
}

impl Drop for Seat {
    fn drop(&mut self) {
        // It has ended already where a test went well.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Takes in what the program sends until it has closed its side.
fn show(mut terminal: File, screen: &Mutex<vt100::Parser>, bytes: &AtomicUsize) {
    let mut buffer = [0; 4096];
    while let Ok(n @ 1..) = terminal.read(&mut buffer) {
        screen.lock().expect("no panic").process(&buffer[..n]);
        bytes.fetch_add(n, Ordering::Relaxed);
    }
}

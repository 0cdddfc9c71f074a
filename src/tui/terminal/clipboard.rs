//! The user's clipboard: by the terminal, by tmux, or a file in its place.

use std::io::Write;
use std::path::Path;
use std::process::{Command, Stdio};

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;

use crate::config::Env;

/// Most bytes of a text that the terminal takes: xterm and those like it cut a sequence after 100,000 letters of base64.
const LONGEST: usize = 74_994;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Way {
    /// A control sequence for the terminal, OSC 52.
    Terminal,
    /// The buffer of tmux, which hands it to its own terminal. tmux ignores OSC 52 of programs in it by default.
    Tmux,
    /// A file, where neither is there.
    File,
}

impl Way {
    fn of(bytes: usize, env: &Env<'_>) -> Self {
        let set = |name: &str| env(name).filter(|value| !value.is_empty());
        let is_mute = set("STY").is_some() || set("TERM").is_none_or(|term| ["linux", "dumb"].contains(&term.as_str()));
        match set("TMUX") {
            Some(_) => Self::Tmux,
            None if is_mute || bytes > LONGEST => Self::File,
            None => Self::Terminal,
        }
    }
}

/// Copies a text. Returns where it is now, in words; `out` is the terminal, and `file` takes what has no clipboard.
pub fn copy(text: &str, env: &Env<'_>, out: &mut impl Write, file: Option<&Path>) -> Result<String, String> {
    match Way::of(text.len(), env) {
        Way::Tmux if loaded(&["-w"], text) => {
            return Ok("in the buffer of tmux, which hands it to your terminal's clipboard".to_owned());
        }
        Way::Tmux if loaded(&[], text) => {
            return Ok(
                "in the buffer of tmux: its key and ] paste it, and tmux from 3.2 on has the clipboard too".to_owned()
            );
        }
        Way::Terminal => {
            let sent = out.write_all(osc52(text).as_bytes()).and_then(|()| out.flush());
            return sent.map(|()| "sent to your terminal's clipboard (OSC 52)".to_owned()).map_err(|e| e.to_string());
        }
        Way::Tmux | Way::File => {}
    }
    let file = file.ok_or("no clipboard is in reach, and HOME names no folder for a file")?;
    let folder = file.parent().unwrap_or(Path::new(""));
    let written = std::fs::create_dir_all(folder).and_then(|()| std::fs::write(file, text));
    let told = |error: std::io::Error| format!("no clipboard is in reach, and {}: {error}", file.display());
    written.map(|()| format!("in {}, since no clipboard is in reach", file.display())).map_err(told)
}

/// Control sequence (OSC 52) that puts a text on the clipboard of the terminal, even over SSH.
fn osc52(text: &str) -> String {
    format!("\x1b]52;c;{}\x07", STANDARD.encode(text))
}

/// Loads a text into the buffer of tmux; `-w` of tmux 3.2 hands it to the terminal's clipboard as well. Returns false
/// where tmux refuses.
fn loaded(flags: &[&str], text: &str) -> bool {
    let quiet = Stdio::null;
    let mut command = Command::new("tmux");
    command.arg("load-buffer").args(flags).arg("-").stdin(Stdio::piped()).stdout(quiet()).stderr(quiet());
    let Ok(mut child) = command.spawn() else { return false };
    let written = child.stdin.take().is_some_and(|mut input| input.write_all(text.as_bytes()).is_ok());
    child.wait().is_ok_and(|status| status.success()) && written
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_way_is_one_that_arrives() {
        let check = |set: &[(&str, &str)], bytes: usize, expect: Way| {
            let env = |name: &str| set.iter().find(|(key, _)| *key == name).map(|(_, value)| (*value).to_owned());
            assert_eq!(Way::of(bytes, &env), expect, "{set:?} {bytes}");
        };
        let xterm = ("TERM", "xterm-256color");
        check(&[xterm], 10, Way::Terminal);
        check(&[xterm], LONGEST + 1, Way::File);
        check(&[xterm, ("TMUX", "/tmp/tmux-0/default,1,0")], LONGEST + 1, Way::Tmux);
        check(&[xterm, ("TMUX", "")], 10, Way::Terminal);
        check(&[("TERM", "screen"), ("STY", "1.pts")], 10, Way::File);
        check(&[("TERM", "linux")], 10, Way::File);
        check(&[], 10, Way::File);
    }

    #[test]
    fn what_is_said_is_where_it_is() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("state/copied.txt");
        let mut sent = vec![];
        let xterm = |name: &str| (name == "TERM").then(|| "xterm".to_owned());
        let told = copy("toile", &xterm, &mut sent, Some(&file)).expect("sent");
        assert!(told.contains("OSC 52") && !file.exists(), "{told}");
        assert_eq!(sent, b"\x1b]52;c;dG9pbGU=\x07");
        let told = copy("toile", &|_: &str| None, &mut sent, Some(&file)).expect("written");
        assert!(told.contains("copied.txt") && sent.len() == 16, "{told}");
        assert_eq!(std::fs::read_to_string(&file).expect("written"), "toile");
        assert!(copy("toile", &|_: &str| None, &mut sent, None).is_err());
    }
}

//! The user's own keys: `keys.toml` in the config folder assigns other keys to actions, by their names in the palette.
//!
//! ```toml
//! cancel = "D"
//! down = ["j", "Down", "C-e"]
//! editing = "vim"
//! ```

use std::path::Path;

use crossterm::event::KeyCode;
use toml::de::DeValue;

use crate::config::{self, ConfigError, Entry, Problems};
use crate::keys::binding::{Binding, Key};
use crate::keys::screen::Screen;
use crate::keys::table::BINDINGS;
use crate::widgets::editor::Editing;

/// Names of keys that are no characters.
const NAMES: [(&str, KeyCode); 15] = [
    ("Enter", KeyCode::Enter),
    ("Esc", KeyCode::Esc),
    ("Tab", KeyCode::Tab),
    ("S-Tab", KeyCode::BackTab),
    ("Space", KeyCode::Char(' ')),
    ("Up", KeyCode::Up),
    ("Down", KeyCode::Down),
    ("Left", KeyCode::Left),
    ("Right", KeyCode::Right),
    ("Home", KeyCode::Home),
    ("End", KeyCode::End),
    ("PgUp", KeyCode::PageUp),
    ("PgDn", KeyCode::PageDown),
    ("Backspace", KeyCode::Backspace),
    ("Delete", KeyCode::Delete),
];

/// Name in the config folder.
pub const FILE: &str = "keys.toml";

/// Name of the entry with the style of editing.
const EDITING: &str = "editing";

/// Letters that terminals, tmux and screen use together with Ctrl.
const TAKEN: &str = "absqhijm";

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Keys {
    pub bindings: &'static [Binding],
    pub editing: Editing,
}

impl Default for Keys {
    fn default() -> Self {
        Self { bindings: BINDINGS, editing: Editing::default() }
    }
}

/// Reads the keys of a file, which replace those of the built-in table. The table lives as long as the program.
pub fn read(path: Option<&Path>) -> Result<Keys, ConfigError> {
    config::read(path, taken)
}

fn taken(entries: &[Entry<'_>], problems: &mut Problems) -> Keys {
    let mut editing = Editing::default();
    let mut bindings = BINDINGS.to_vec();
    let mut changed = Vec::new();
    for entry in entries {
        if entry.name == EDITING {
            editing = problems.or_tell(entry, editing_of(entry.value)).unwrap_or_default();
            continue;
        }
        let Some(k) = bindings.iter().position(|binding| binding.name == entry.name) else {
            problems.tell(entry.line, format!("no action `{}`; ? and : list all by name", entry.name));
            continue;
        };
        if let Some(keys) = problems.or_tell(entry, keys(entry.value)) {
            bindings[k].keys = keys.leak();
            changed.push((k, entry.line));
        }
    }
    for (k, line) in changed {
        if let Some(problem) = clash(&bindings, k) {
            problems.tell(line, problem);
        }
    }
    Keys { bindings: bindings.leak(), editing }
}

fn editing_of(value: &DeValue<'_>) -> Result<Editing, String> {
    const ACCEPTED: &str = "accepted: \"readline\", \"vim\"";
    match value.as_str() {
        Some("readline") => Ok(Editing::Readline),
        Some("vim") => Ok(Editing::Vim),
        Some(other) => Err(format!("`{other}`; {ACCEPTED}")),
        None => Err(format!("{}; {ACCEPTED}", value.type_str())),
    }
}

/// In words, another action that has a key of a binding on one of the same screens; `None` without a clash.
fn clash(bindings: &[Binding], k: usize) -> Option<String> {
    let own = &bindings[k];
    let meets = |other: &&Binding| {
        other.name != own.name && Screen::ALL.iter().any(|screen| own.is_on(*screen) && other.is_on(*screen))
    };
    let (key, other) = bindings.iter().filter(meets).find_map(|other| {
        let key = own.keys.iter().find(|key| other.keys.contains(key))?;
        Some((key, other.name))
    })?;
    Some(format!("{}: key `{key}` already means {other}; give that one another key too", own.name))
}

/// Reads one key or a list of keys.
fn keys(value: &DeValue<'_>) -> Result<Vec<Key>, String> {
    let wanted = "accepted: a key in quotes, or a list of keys";
    let key_of = |value: &DeValue<'_>| key(value.as_str().ok_or_else(|| format!("{}; {wanted}", value.type_str()))?);
    match value.as_array() {
        Some(list) if list.is_empty() => Err(format!("no key; {wanted}")),
        Some(list) => list.iter().map(|item| key_of(item.get_ref())).collect(),
        None => Ok(vec![key_of(value)?]),
    }
}

fn key(name: &str) -> Result<Key, String> {
    let single = |text: &str| {
        let mut letters = text.chars();
        letters.next().filter(|letter| letters.next().is_none() && !letter.is_control() && *letter != ' ')
    };
    if let Some(letter) = name.strip_prefix("C-").and_then(single) {
        let letter = letter.to_ascii_lowercase();
        if TAKEN.contains(letter) {
            return Err(format!("`{name}` never arrives, or means something else: terminals and tmux use it"));
        }
        return Ok(Key::new(KeyCode::Char(letter), true));
    }
    let (plain, has_alt) = name.strip_prefix("A-").map_or((name, false), |plain| (plain, true));
    let named = NAMES.iter().find(|(known, _)| known.eq_ignore_ascii_case(plain)).map(|(_, code)| *code);
    let function = plain.strip_prefix(['F', 'f']).and_then(|n| n.parse().ok()).filter(|n| (1..=12).contains(n));
    let code = named.or(function.map(KeyCode::F)).or(single(plain).map(KeyCode::Char));
    code.map(|code| if has_alt { Key::alt(code) } else { Key::new(code, false) }).ok_or_else(|| {
        let names: Vec<&str> = NAMES.iter().map(|(name, _)| *name).collect();
        format!(
            "no key `{name}`; accepted: a character, C- and a letter, A- and a key, F1 to F12, {}",
            names.join(", ")
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::keys::action::Action;
    use crate::keys::binding::action_of;

    fn parse(text: &str) -> Result<Keys, ConfigError> {
        config::parse("keys.toml", text, taken)
    }

    fn told(text: &str) -> String {
        parse(text).expect_err("wrong").to_string()
    }

    #[test]
    fn actions_get_other_keys_and_the_rest_stays() {
        let text = "# mine\ncancel = \"D\"\ndown = [\"Down\", \"C-e\", \"A-x\", \"F7\"]\nnext-match = \"j\"\n";
        let Keys { bindings, editing } = parse(text).expect("right");
        assert_eq!(editing, Editing::Readline);
        assert_eq!(parse("editing = \"vim\"").expect("right").editing, Editing::Vim);
        let check = |name: &str, expect: Option<Action>| {
            assert_eq!(action_of(bindings, key(name).expect("a key"), Screen::Jobs), expect, "{name}");
        };
        check("D", Some(Action::Cancel));
        check("x", None);
        check("C-e", Some(Action::Down));
        check("A-x", Some(Action::Down));
        check("f7", Some(Action::Down));
        check("j", Some(Action::NextMatch));
        check("k", Some(Action::Up));
        assert_eq!(bindings.len(), BINDINGS.len());
    }

    #[test]
    fn problems_name_their_line_and_what_would_be_accepted() {
        let check = |text: &str, expect: &str| {
            let said = told(text);
            assert!(said.contains(expect), "{said}");
        };
        check("down = \"j\"\ncansel = \"D\"\n", "keys.toml:2: no action `cansel`; ? and : list all by name");
        check("down = \"Dwon\"", "keys.toml:1: down: no key `Dwon`; accepted: a character, C- and a letter");
        check("\n\ncancel = \"C-s\"", "keys.toml:3: cancel: `C-s` never arrives");
        check("cancel = 3", "keys.toml:1: cancel: integer; accepted: a key in quotes");
        check("cancel = []", "no key; accepted");
        check("cancel = \"r\"", "keys.toml:1: cancel: key `r` already means retry; give that one another key too");
        check("cancel = ", "keys.toml:1: ");
        check("editing = \"vi\"", "keys.toml:1: editing: `vi`; accepted: \"readline\", \"vim\"");
        check("editing = true", "keys.toml:1: editing: boolean; accepted: \"readline\"");
        assert_eq!(told("a = \"x\"\nb = \"y\"").lines().count(), 2, "all are told at once");
    }

    #[test]
    fn no_file_means_the_keys_of_the_table() {
        let folder = tempfile::tempdir().expect("a folder");
        let env = |name: &str| (name == "XDG_CONFIG_HOME").then(|| folder.path().display().to_string());
        let path = config::path(&env, FILE).expect("a place");
        assert_eq!(read(Some(&path)).expect("none"), Keys::default());
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("writable");
        std::fs::write(&path, "cancel = \"D\"").expect("writable");
        assert!(read(Some(&path)).is_ok());
    }
}

//! Keys and their actions.

use std::fmt;

use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};

use crate::keys::action::Action;
use crate::keys::screen::Screen;

/// Key with its modifiers. Shift is part of a letter, not a modifier.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Key {
    code: KeyCode,
    ctrl: bool,
    alt: bool,
}

impl Key {
    pub const fn new(code: KeyCode, ctrl: bool) -> Self {
        Self { code, ctrl, alt: false }
    }

    pub const fn alt(code: KeyCode) -> Self {
        Self { code, ctrl: false, alt: true }
    }

    pub fn of(event: &KeyEvent) -> Self {
        let is = |modifier| event.modifiers.contains(modifier);
        Self { code: event.code, ctrl: is(KeyModifiers::CONTROL), alt: is(KeyModifiers::ALT) }
    }
}

impl fmt::Display for Key {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.ctrl {
            f.write_str("C-")?;
        }
        if self.alt {
            f.write_str("A-")?;
        }
        match self.code {
            KeyCode::Char(' ') => f.write_str("Space"),
            KeyCode::Char(letter) => write!(f, "{letter}"),
            KeyCode::Up => f.write_str("↑"),
            KeyCode::Down => f.write_str("↓"),
            KeyCode::Left => f.write_str("←"),
            KeyCode::Right => f.write_str("→"),
            KeyCode::Enter => f.write_str("↵"),
            KeyCode::BackTab => f.write_str("S-Tab"),
            KeyCode::PageUp => f.write_str("PgUp"),
            KeyCode::PageDown => f.write_str("PgDn"),
            other => write!(f, "{other}"),
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Binding {
    pub action: Action,
    /// Name in the palette.
    pub name: &'static str,
    pub keys: &'static [Key],
    /// Screens on which the keys apply; empty for all.
    pub screens: &'static [Screen],
    /// Word in the status line; empty for an action that is not shown there.
    pub hint: &'static str,
    pub help: &'static str,
}

impl Binding {
    pub fn is_on(&self, screen: Screen) -> bool {
        self.screens.is_empty() || self.screens.contains(&screen)
    }

    /// The keys, as help shows them.
    pub fn keys_text(&self) -> String {
        self.keys.iter().map(Key::to_string).collect::<Vec<_>>().join(" ")
    }

    /// Searches name, keys and help, in upper or lower case.
    pub fn matches(&self, text: &str) -> bool {
        let text = text.to_lowercase();
        self.name.contains(&text)
            || self.help.to_lowercase().contains(&text)
            || self.keys.iter().any(|key| key.to_string().to_lowercase() == text)
    }
}

pub fn action_of(bindings: &[Binding], key: Key, screen: Screen) -> Option<Action> {
    bindings.iter().find(|binding| binding.is_on(screen) && binding.keys.contains(&key)).map(|binding| binding.action)
}

/// Bindings whose name, keys or help contain a text; those whose names begin with it come first.
pub fn search(bindings: &'static [Binding], text: &str) -> Vec<&'static Binding> {
    let text = text.trim().to_lowercase();
    let mut found: Vec<&Binding> = bindings.iter().filter(|binding| binding.matches(&text)).collect();
    found.sort_by_key(|binding| (binding.name != text, !binding.name.starts_with(&text)));
    found
}

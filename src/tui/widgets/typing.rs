//! Typing in one line.

use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};

/// Whether a key is Ctrl-C.
pub fn is_ctrl_c(event: &KeyEvent) -> bool {
    event.code == KeyCode::Char('c') && event.modifiers.contains(KeyModifiers::CONTROL)
}

/// Edits a line at its end; returns whether it changed.
pub fn edit(text: &mut String, event: &KeyEvent) -> bool {
    let ctrl = event.modifiers.contains(KeyModifiers::CONTROL);
    match event.code {
        KeyCode::Char('u') if ctrl => text.clear(),
        KeyCode::Char('w') if ctrl => text.truncate(text.trim_end().rfind(' ').map_or(0, |at| at + 1)),
        KeyCode::Char(letter) if !ctrl => text.push(letter),
        KeyCode::Backspace => return text.pop().is_some(),
        _ => return false,
    }
    true
}

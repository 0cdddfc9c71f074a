//! Typing in one line.

use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};

/// Rows of a page of a list.
const PAGE: usize = 10;

/// True if a key is Ctrl-C.
pub fn is_ctrl_c(event: &KeyEvent) -> bool {
    event.code == KeyCode::Char('c') && event.modifiers.contains(KeyModifiers::CONTROL)
}

/// Handles a key in a list that a text narrows: moves among the rows, or edits the text and selects the first row.
pub fn in_list(text: &mut String, row: &mut usize, event: &KeyEvent) {
    match event.code {
        KeyCode::Up => *row = row.saturating_sub(1),
        KeyCode::Down => *row += 1,
        KeyCode::PageUp => *row = row.saturating_sub(PAGE),
        KeyCode::PageDown => *row += PAGE,
        _ => {
            if edit(text, event) {
                *row = 0;
            }
        }
    }
}

/// Edits a line at its end. Returns true if the line changed.
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

//! Typing in one line, and moving in lists.

use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};

/// Rows of a page of a list.
const PAGE: isize = 10;

pub fn is_ctrl_c(event: &KeyEvent) -> bool {
    event.code == KeyCode::Char('c') && event.modifiers.contains(KeyModifiers::CONTROL)
}

/// Row that a key leads to from `row` of `rows`; `None` for a key that moves nothing. Letters move where none are typed.
pub fn moved(row: usize, rows: usize, event: &KeyEvent, has_letters: bool) -> Option<usize> {
    let ctrl = event.modifiers.contains(KeyModifiers::CONTROL);
    let last = rows.saturating_sub(1);
    let by = |step: isize| Some(row.saturating_add_signed(step).min(last));
    match event.code {
        KeyCode::Up => by(-1),
        KeyCode::Down => by(1),
        KeyCode::PageUp => by(-PAGE),
        KeyCode::PageDown => by(PAGE),
        KeyCode::Home => Some(0),
        KeyCode::End => Some(last),
        KeyCode::Char('u') if ctrl => by(-PAGE),
        KeyCode::Char('d') if ctrl => by(PAGE),
        KeyCode::Char('k') if has_letters && !ctrl => by(-1),
        KeyCode::Char('j') if has_letters && !ctrl => by(1),
        KeyCode::Char('g') if has_letters && !ctrl => Some(0),
        KeyCode::Char('G') if has_letters && !ctrl => Some(last),
        _ => None,
    }
}

/// Handles a key in a list of `rows` that a text narrows: moves among the rows, or edits the text and selects the first
/// row. Ctrl-U empties the text, and goes up by a page where there is none.
pub fn in_list(text: &mut String, row: &mut usize, rows: usize, event: &KeyEvent) {
    let empties = event.code == KeyCode::Char('u') && !text.is_empty();
    match moved(*row, rows, event, false).filter(|_| !empties) {
        Some(next) => *row = next,
        None if edit(text, event) => *row = 0,
        None => {}
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_know_the_same_keys() {
        let check = |code: KeyCode, ctrl: bool, has_letters: bool, expect: Option<usize>| {
            let modifiers = if ctrl { KeyModifiers::CONTROL } else { KeyModifiers::NONE };
            assert_eq!(moved(12, 30, &KeyEvent::new(code, modifiers), has_letters), expect, "{code:?}");
        };
        check(KeyCode::Down, false, false, Some(13));
        check(KeyCode::Char('j'), false, true, Some(13));
        check(KeyCode::Char('j'), false, false, None);
        check(KeyCode::Char('k'), false, true, Some(11));
        check(KeyCode::Char('g'), false, true, Some(0));
        check(KeyCode::Char('G'), false, true, Some(29));
        check(KeyCode::End, false, false, Some(29));
        check(KeyCode::Char('d'), true, false, Some(22));
        check(KeyCode::Char('u'), true, true, Some(2));
        check(KeyCode::Char('d'), false, true, None);
        assert_eq!(moved(0, 0, &KeyEvent::new(KeyCode::End, KeyModifiers::NONE), false), Some(0));
    }

    #[test]
    fn a_narrowed_list_keeps_its_line() {
        let press = |text: &mut String, row: &mut usize, code: KeyCode| {
            in_list(text, row, 30, &KeyEvent::new(code, KeyModifiers::CONTROL));
        };
        let (mut text, mut row) = ("rib".to_owned(), 12);
        press(&mut text, &mut row, KeyCode::Char('d'));
        assert_eq!((text.as_str(), row), ("rib", 22));
        press(&mut text, &mut row, KeyCode::Char('u'));
        assert_eq!((text.as_str(), row), ("", 0));
        row = 22;
        press(&mut text, &mut row, KeyCode::Char('u'));
        assert_eq!((text.as_str(), row), ("", 12));
    }
}

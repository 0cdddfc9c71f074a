//! The screen in plain ASCII, for terminals and fonts without other signs: every sign has a substitute.

use ratatui::buffer::Buffer;

/// Signs and their substitutes. Those of different states differ.
const STAND_INS: [(char, char); 66] = [
    ('─', '-'),
    ('━', '-'),
    ('│', '|'),
    ('┊', ':'),
    ('┌', '+'),
    ('┐', '+'),
    ('└', '+'),
    ('┘', '+'),
    ('├', '+'),
    ('┤', '+'),
    ('┬', '+'),
    ('┴', '+'),
    ('┼', '+'),
    ('▸', '>'),
    ('◂', '<'),
    ('▶', '>'),
    ('◀', '<'),
    ('▲', '^'),
    ('▼', 'v'),
    ('●', 'o'),
    ('○', 'o'),
    ('•', '*'),
    ('·', '.'),
    ('…', '.'),
    ('✓', '+'),
    ('✗', 'X'),
    ('≈', '~'),
    ('⊘', '0'),
    ('—', '-'),
    ('–', '-'),
    ('−', '-'),
    ('×', 'x'),
    ('→', '>'),
    ('←', '<'),
    ('↑', '^'),
    ('↓', 'v'),
    ('↕', '|'),
    ('↵', '<'),
    ('▏', '|'),
    ('▎', '|'),
    ('▍', '|'),
    ('▌', '|'),
    ('▋', '#'),
    ('▊', '#'),
    ('▉', '#'),
    ('█', '#'),
    ('▇', '#'),
    ('▆', '*'),
    ('▅', '*'),
    ('▄', '='),
    ('▃', '='),
    ('▂', '-'),
    ('▁', '_'),
    ('▀', '"'),
    ('░', '.'),
    ('▒', ':'),
    ('▓', '%'),
    ('°', 'd'),
    ('≤', '<'),
    ('≥', '>'),
    ('χ', 'x'),
    ('±', '~'),
    ('▕', '|'),
    ('²', '2'),
    ('µ', 'u'),
    ('◆', '#'),
];

/// Letters of growing density, for braille dots.
const DENSITY: [char; 9] = [' ', '.', '.', ':', ':', '+', '+', '#', '#'];

pub fn translate(buffer: &mut Buffer) {
    for cell in &mut buffer.content {
        let Some(sign) = cell.symbol().chars().next().filter(|sign| !sign.is_ascii()) else { continue };
        cell.set_char(stand_in(sign));
    }
}

/// Returns `?` for a sign without a substitute.
pub fn stand_in(sign: char) -> char {
    if ('\u{2800}'..='\u{28ff}').contains(&sign) {
        return DENSITY[(sign as u32 - 0x2800).count_ones() as usize];
    }
    STAND_INS.iter().find(|(known, _)| *known == sign).map_or('?', |(_, plain)| *plain)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::widgets::theme::glyph;
    use store::Status;

    #[test]
    fn states_stay_apart() {
        let mut plain: Vec<char> =
            Status::ALL.iter().filter_map(|status| glyph(*status).chars().next()).map(stand_in).collect();
        assert!(plain.iter().all(|sign| sign.is_ascii() && *sign != '?'));
        plain.sort_unstable();
        plain.dedup();
        assert_eq!(plain.len(), Status::ALL.len());
    }

    #[test]
    fn dots_become_denser() {
        assert_eq!([' ', '⠁', '⣿'].map(stand_in).to_vec(), vec!['?', '.', '#']);
        assert_eq!(stand_in('\u{2800}'), ' ');
    }
}

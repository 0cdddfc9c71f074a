//! Letters on places of the screen; typing the letters of a place goes there.

use crossterm::event::{KeyCode, KeyEvent};
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::style::{Modifier, Style};

use crate::overlays::outcome::Outcome;
use crate::widgets::jump::{Target, label};
use crate::widgets::theme::Theme;

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Jump {
    pub targets: Vec<Target>,
    pub typed: String,
}

impl Jump {
    /// Places whose labels begin with the typed letters, with these labels.
    fn open(&self) -> impl Iterator<Item = (&Target, String)> {
        let labelled = self.targets.iter().enumerate().map(|(k, target)| (target, label(k, self.targets.len())));
        labelled.filter(|(_, label)| label.starts_with(&self.typed))
    }

    /// Handles a key: a letter continues a label, any other key closes.
    pub fn key(&mut self, event: &KeyEvent) -> Outcome {
        let KeyCode::Char(letter) = event.code else { return Outcome::Closed };
        self.typed.push(letter.to_ascii_lowercase());
        let open: Vec<_> = self.open().collect();
        match open[..] {
            [] => Outcome::Closed,
            [(target, ref label)] if *label == self.typed => Outcome::Jump(target.goal),
            _ => Outcome::Open,
        }
    }
}

/// Draws the rest of each label behind the typed letters.
pub fn draw(frame: &mut Frame<'_>, area: Rect, jump: &Jump, theme: Theme) {
    let style = Style::reset().patch(theme.warn()).add_modifier(Modifier::BOLD | Modifier::REVERSED);
    for (target, label) in jump.open().filter(|(target, _)| area.contains(target.at)) {
        let rest = &label[jump.typed.len()..];
        let room = usize::from(area.right() - target.at.x);
        frame.buffer_mut().set_stringn(target.at.x, target.at.y, rest, room, style);
    }
}

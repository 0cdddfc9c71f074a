//! Log of commands that do the same as was done here.

use crossterm::event::{KeyCode, KeyEvent};
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::style::Style;
use ratatui::text::Line;
use ratatui::widgets::{Clear, Paragraph};

use crate::messages::effect::Effect;
use crate::overlays::outcome::Outcome;
use crate::widgets::layout::middle;
use crate::widgets::lists::pane;
use crate::widgets::text::wrapped;
use crate::widgets::theme::Theme;
use crate::widgets::typing::moved;

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CommandLog {
    /// Commands, the latest last.
    pub commands: Vec<String>,
    pub row: usize,
}

impl CommandLog {
    /// Selects the latest command.
    pub fn of(commands: &[String]) -> Self {
        Self { commands: commands.to_vec(), row: commands.len().saturating_sub(1) }
    }

    /// Handles a key: `y` copies the selected command, `Y` all of them.
    pub fn key(&mut self, event: &KeyEvent) -> Outcome {
        match event.code {
            KeyCode::Char('y') | KeyCode::Enter => {
                return Outcome::Effects(self.commands.get(self.row).cloned().map(Effect::Copy).into_iter().collect());
            }
            KeyCode::Char('Y') => return Outcome::Effects(vec![Effect::Copy(self.commands.join("\n") + "\n")]),
            KeyCode::Char('q') => return Outcome::Closed,
            _ => self.row = moved(self.row, self.commands.len(), event, true).unwrap_or(self.row),
        }
        Outcome::Open
    }
}

/// Draws each command in full.
pub fn draw(frame: &mut Frame<'_>, area: Rect, log: &CommandLog, theme: Theme) {
    let place = middle(area, area.width.min(120), area.height);
    let block = pane(theme, "what was done here, as commands".to_owned(), true)
        .title_bottom(Line::styled(" y copies it  Y copies all  Esc closes ", theme.legend()));
    let inner = block.inner(place);
    let width = usize::from(inner.width).max(1);
    let mut lines: Vec<(usize, Line<'_>)> = vec![];
    for (k, command) in log.commands.iter().enumerate() {
        let style = if k == log.row { theme.selected() } else { Style::new() };
        lines.extend(wrapped(command, width).into_iter().map(|text| (k, Line::styled(text, style))));
    }
    if lines.is_empty() {
        let text = "nothing yet: imports, saved seams, runs and queries are told here as commands";
        lines.extend(wrapped(text, width).into_iter().map(|text| (0, Line::styled(text, theme.dim()))));
    }
    let last = lines.iter().rposition(|(k, _)| *k == log.row).unwrap_or(0);
    let skip = (last + 1).saturating_sub(usize::from(inner.height));
    let shown: Vec<Line<'_>> = lines.into_iter().skip(skip).map(|(_, line)| line).collect();
    frame.render_widget(Clear, place);
    frame.render_widget(Paragraph::new(shown).block(block), place);
}

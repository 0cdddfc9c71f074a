//! The frame of all forms.

use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::Line;
use ratatui::widgets::{Clear, Paragraph};

use crate::widgets::layout::middle;
use crate::widgets::lists::pane;
use crate::widgets::text::{shortened, wrapped};
use crate::widgets::theme::Theme;

#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Sending {
    pub is_busy: bool,
    /// Reason for a refusal, or problem of a line.
    pub problem: Option<String>,
}

impl Sending {
    pub fn start(&mut self) {
        *self = Self { is_busy: true, problem: None };
    }

    pub fn refuse(&mut self, problem: String) {
        *self = Self { is_busy: false, problem: Some(problem) };
    }

    pub fn lines(&self, work: &str, columns: usize, theme: Theme) -> Vec<Line<'static>> {
        let busy = self.is_busy.then(|| Line::styled(format!(" {work}"), theme.busy()));
        let problem = wrapped(self.problem.as_deref().unwrap_or_default(), columns.saturating_sub(3));
        let line = |(k, text): (usize, String)| {
            Line::styled(format!(" {} {text}", if k == 0 { "✗" } else { " " }), theme.bad())
        };
        busy.into_iter().chain(problem.into_iter().enumerate().map(line)).collect()
    }
}

/// True if a key completes a form: Enter on the last line, F5 or Alt-Enter on any. Enter on another line moves on.
pub fn is_done(event: &KeyEvent, is_last: bool) -> bool {
    match event.code {
        KeyCode::F(5) => true,
        KeyCode::Enter => is_last || event.modifiers.contains(KeyModifiers::ALT),
        _ => false,
    }
}

pub fn draw_frame(
    frame: &mut Frame<'_>,
    area: Rect,
    width: u16,
    title: String,
    keys: &'static str,
    lines: Vec<Line<'_>>,
    theme: Theme,
) {
    let place = middle(area, width, (lines.len() as u16 + 2).min(area.height));
    let block = pane(theme, title, true).title_bottom(Line::styled(keys, theme.legend()));
    frame.render_widget(Clear, place);
    frame.render_widget(Paragraph::new(lines).block(block), place);
}

/// Text in at most `columns` columns: its end while it is typed, else its beginning.
pub fn ended(text: &str, columns: usize, is_typed: bool) -> String {
    let letters: Vec<char> = text.chars().collect();
    if is_typed { letters[letters.len().saturating_sub(columns)..].iter().collect() } else { shortened(text, columns) }
}

//! The list of saved queries.

use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::Line;
use ratatui::widgets::{Clear, Paragraph};

use crate::overlays::outcome::Outcome;
use crate::widgets::layout::middle;
use crate::widgets::lists::{listed, pane};
use crate::widgets::text::{left, shortened};
use crate::widgets::theme::Theme;
use crate::widgets::typing::in_list;
use store::SavedQuery;

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct QueryList {
    pub queries: Vec<SavedQuery>,
    pub text: String,
    /// Index among the rows shown.
    pub row: usize,
}

impl QueryList {
    pub fn rows(&self) -> Vec<&SavedQuery> {
        let text = self.text.to_lowercase();
        self.queries
            .iter()
            .filter(|query| format!("{} {}", query.name, query.sql).to_lowercase().contains(&text))
            .collect()
    }

    /// Handles a key: Enter takes the selected query, Ctrl-R renames it.
    pub fn key(&mut self, event: &KeyEvent) -> Outcome {
        let rows = self.rows();
        let (selected, count) = (rows.get(self.row).copied(), rows.len());
        let is_rename = event.code == KeyCode::Char('r') && event.modifiers.contains(KeyModifiers::CONTROL);
        match selected {
            Some(query) if event.code == KeyCode::Enter => return Outcome::Query(query.sql.clone()),
            Some(query) if is_rename => return Outcome::Rename(query.name.clone()),
            _ => in_list(&mut self.text, &mut self.row, count, event),
        }
        self.row = self.row.min(self.rows().len().saturating_sub(1));
        Outcome::Open
    }
}

pub fn draw(frame: &mut Frame<'_>, area: Rect, list: &QueryList, theme: Theme) {
    let rows = list.rows();
    let place = middle(area, area.width.min(100), (rows.len() as u16 + 2).max(3).min(area.height));
    let title = format!("saved queries: /{}▏  ↵ takes it, C-r renames, Esc closes", list.text);
    let legend = Line::styled(" .sql files of the folder queries beside the database ", theme.legend());
    let block = pane(theme, title, true).title_bottom(legend);
    let inner = block.inner(place);
    let mut lines = listed(&rows, list.row, usize::from(inner.height), theme.selected(), |query| {
        Line::raw(shortened(&format!("{} {}", left(&query.name, 18), query.about), usize::from(inner.width)))
    });
    if lines.is_empty() {
        lines.push(Line::raw("no query of that name"));
    }
    frame.render_widget(Clear, place);
    frame.render_widget(Paragraph::new(lines).block(block), place);
}

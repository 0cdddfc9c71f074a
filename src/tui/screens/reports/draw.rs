//! Drawing the list of reports.

use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::text::Line;
use ratatui::widgets::{Paragraph, Wrap};

use crate::screens::page::Draw;
use crate::screens::reports::actions::{address, facts, fetching};
use crate::screens::reports::state::ReportsScreen;
use crate::screens::state::State;
use crate::widgets::jump::{self, Target};
use crate::widgets::lists::{listed, no_rows, pane};
use crate::widgets::text::{self, left, right, shortened};
use results::ReportRow;

impl Draw for ReportsScreen {
    fn draw(&self, frame: &mut Frame<'_>, area: Rect, state: &State) {
        let [list, facts] = panes(area);
        self.draw_list(frame, list, state);
        self.draw_facts(frame, facts, state);
    }

    fn targets(&self, state: &State, area: Rect) -> Vec<Target> {
        let rows = self.shown(state).len();
        jump::rows(0, jump::inside(panes(area)[0]), 1, rows, self.row.min(rows.saturating_sub(1)))
    }
}

impl ReportsScreen {
    fn draw_list(&self, frame: &mut Frame<'_>, area: Rect, state: &State) {
        let rows = self.shown(state);
        let title = match &self.building {
            Some(study) if self.part.is_empty() => format!("reports: building that of {study}…"),
            Some(study) => format!("reports: building that of {study}: {}…", self.part),
            None if rows.len() == 1 => "1 report".to_owned(),
            None => format!("{} reports", rows.len()),
        };
        let block = pane(state.theme, title, true);
        let inner = block.inner(area);
        let width = usize::from(inner.width);
        let name = width.saturating_sub(10 + 8 + 19).clamp(8, 32);
        let mark = if self.by_time { "▼" } else { "" };
        let zone = text::zone(state.offset_ms());
        let head = format!("{}{}{}  built ({zone}){mark}", left("study", name), right("page", 10), right("files", 8));
        let mut lines = vec![Line::styled(shortened(&head, width), state.theme.dim())];
        let room = usize::from(inner.height).saturating_sub(1);
        let at = self.row.min(rows.len().saturating_sub(1));
        lines.extend(listed(&rows, at, room, state.theme.selected(), |row| {
            Line::raw(shortened(&line(state, row, name), width))
        }));
        if rows.is_empty() {
            lines.push(no_rows(
                state.filter(),
                "no report matches the filter",
                "no report yet: b builds that of the study",
            ));
        }
        frame.render_widget(Paragraph::new(lines).block(block), area);
    }

    fn draw_facts(&self, frame: &mut Frame<'_>, area: Rect, state: &State) {
        let block = pane(state.theme, "where", false);
        let lines = match self.selected(state) {
            None => vec![Line::raw("A report is one page with its pictures and raw data: HTML, PNG, CSV.")],
            Some(row) => vec![
                Line::raw(address(&row.page)),
                Line::styled("↵ opens it where there is a display, else copies its address", state.theme.dim()),
                Line::styled("y copies the line for your own machine; then open index.html there:", state.theme.dim()),
                Line::raw(fetching(state, &row.page)),
            ],
        };
        frame.render_widget(Paragraph::new(lines).wrap(Wrap { trim: true }).block(block), area);
    }
}

fn panes(area: Rect) -> [Rect; 2] {
    Layout::vertical([Constraint::Fill(1), Constraint::Length(area.height.min(9) / 2 + 3)]).areas(area)
}

fn line(state: &State, row: &ReportRow, name: usize) -> String {
    let [page, files, built] = facts(state, row);
    format!("{}{}{}  {built}", left(&row.name, name), right(&page, 10), right(&files, 8))
}

//! Panes and the lists in them.

use ratatui::layout::Rect;
use ratatui::style::Style;
use ratatui::text::{Line, Span};
use ratatui::widgets::Block;

use crate::widgets::text;
use crate::widgets::theme::Theme;

/// A pane. The pane with the focus differs in colour, weight and a mark in its title.
pub fn pane<'a>(theme: Theme, title: impl Into<String>, focused: bool) -> Block<'a> {
    let title = title.into();
    let title = if focused { format!(" ▸{title} ") } else { format!(" {title} ") };
    let style = if focused { theme.bold() } else { Style::new() };
    Block::bordered().border_style(theme.border(focused)).title(Span::styled(title, style))
}

pub fn selected_line(line: Line<'static>, style: Style) -> Line<'static> {
    let text: String = line.spans.iter().map(|span| span.content.as_ref()).collect();
    Line::styled(text, style)
}

/// First line of a list to show, so that the selected one is near the middle.
pub fn first_shown(selected: usize, lines: usize, height: usize) -> usize {
    selected.saturating_sub(height / 2).min(lines.saturating_sub(height))
}

/// Lines of the rows that fit, around the selected row; without `style`, none is highlighted.
pub fn listed<T>(
    rows: &[T],
    selected: usize,
    room: usize,
    style: impl Into<Option<Style>>,
    line: impl Fn(&T) -> Line<'static>,
) -> Vec<Line<'static>> {
    let style = style.into();
    let shown = rows.iter().enumerate().skip(first_shown(selected, rows.len(), room)).take(room);
    let lines = shown.map(|(k, row)| match style.filter(|_| k == selected) {
        Some(style) => selected_line(line(row), style),
        None => line(row),
    });
    lines.collect()
}

/// Line for an empty list: `filtered` if a filter hides all rows, else `none`.
pub fn no_rows(filter: &str, filtered: &'static str, none: &'static str) -> Line<'static> {
    Line::raw(if filter.is_empty() { none } else { filtered })
}

/// Part of a table that fits: its header stays, and the lines below are scrolled. A mark at the end of the header shows
/// that there are more.
pub fn scrolled(mut table: Vec<Line<'static>>, down: usize, inner: Rect) -> Vec<Line<'static>> {
    let hidden = table.len().saturating_sub(usize::from(inner.height));
    if hidden == 0 || table.is_empty() {
        return table;
    }
    let down = down.min(hidden);
    table.drain(1..=down);
    let mark = match (down > 0, down < hidden) {
        (true, true) => "↕",
        (true, false) => "↑",
        _ => "↓",
    };
    let style = table[0].style;
    let head: String = table[0].spans.iter().map(|span| span.content.as_ref()).collect();
    table[0] = Line::styled(text::left(head.trim_end(), usize::from(inner.width).saturating_sub(1)) + mark, style);
    table
}

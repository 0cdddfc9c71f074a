//! The screens: pure functions of the state to a frame. Here the frame they share: tabs, panes, status line, overlays.

mod chi;
mod compare;
mod drape;
mod fabrics;
mod forms;
mod jobs;
mod overlays;
mod pieces;
mod reports;
mod results;
mod sql;
mod start;
mod study;
mod study_form;
mod styles;
mod subjects;

use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Position, Rect};
use ratatui::style::Style;
use ratatui::text::{Line, Span};
use ratatui::widgets::{Block, Paragraph};

use super::action::{Binding, Screen};
use super::ascii;
use super::overlay::Overlay;
use super::state::State;
use super::text;
use super::theme::{Theme, glyph};
use ::study::{MEASUREMENTS, Status};

pub use drape::picture_places;

/// Terminals with fewer columns or rows than this get lists instead of grids and panes.
const NARROW: (u16, u16) = (60, 16);
/// Terminals with at least so many columns have the names of all screens in the first line, if short ones.
const SHORT: u16 = 66;
/// Terminals with at least so many columns get panes side by side.
const WIDE: u16 = 120;

/// Draws the workbench.
pub fn draw(frame: &mut Frame<'_>, state: &State) {
    let [top, body, bottom] = rows(frame.area());
    frame.render_widget(tabs(state, top.width), top);
    match state.nav.screen {
        _ if state.data.is_none() => frame.render_widget(Paragraph::new(" reading the database…"), body),
        Screen::Subjects => subjects::draw(frame, body, state),
        Screen::Fabrics => fabrics::draw(frame, body, state),
        Screen::Styles => styles::draw(frame, body, state),
        Screen::Sql => sql::draw(frame, body, state),
        Screen::Reports => reports::draw(frame, body, state),
        _ if state.is_first_start() => start::draw(frame, body, state),
        Screen::Study => study::draw(frame, body, state),
        Screen::Jobs => jobs::draw(frame, body, state),
        Screen::Results => results::draw(frame, body, state),
        Screen::Compare => compare::draw(frame, body, state),
    }
    frame.render_widget(status_line(state, bottom.width), bottom);
    if let Some(overlay) = &state.overlay {
        overlays::draw(frame, body, overlay, state);
    }
    if state.theme.ascii {
        ascii::translate(frame.buffer_mut());
    }
}

/// Tabs, body, status line.
fn rows(area: Rect) -> [Rect; 3] {
    Layout::vertical([Constraint::Length(1), Constraint::Fill(1), Constraint::Length(1)]).areas(area)
}

/// Whether there is only room for lists.
fn is_narrow(area: Rect) -> bool {
    area.width < NARROW.0 || area.height < NARROW.1
}

/// A pane; the one with the focus stands out by colour, weight and a mark in its title.
fn pane<'a>(theme: Theme, title: impl Into<String>, focused: bool) -> Block<'a> {
    let title = title.into();
    let title = if focused { format!(" ▸{title} ") } else { format!(" {title} ") };
    let style = if focused { theme.bold() } else { Style::new() };
    Block::bordered().border_style(theme.border(focused)).title(Span::styled(title, style))
}

/// A line as the selected one: one colour all along, so that it reads as one row.
fn selected(line: Line<'static>, style: Style) -> Line<'static> {
    let text: String = line.spans.iter().map(|span| span.content.as_ref()).collect();
    Line::styled(text, style)
}

/// The first line shown of a list, such that the selected one is near the middle.
fn first_shown(selected: usize, lines: usize, height: usize) -> usize {
    selected.saturating_sub(height / 2).min(lines.saturating_sub(height))
}

/// A table of which there is no room for all lines: its header stays, the lines below it are scrolled; a mark at the end of
/// the header says that there is more.
fn scrolled(mut table: Vec<Line<'static>>, down: usize, inner: Rect) -> Vec<Line<'static>> {
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

/// Lines that the table of the selected subject or fabric can be scrolled down.
#[must_use]
pub fn table_hidden(state: &State) -> usize {
    let [_, body, _] = rows(Rect::from((Position::ORIGIN, state.terminal.size)));
    match state.nav.screen {
        Screen::Subjects => MEASUREMENTS.len().saturating_sub(subjects::table_rows(body)),
        Screen::Fabrics => fabrics::table_lines().saturating_sub(fabrics::table_rows(body)),
        _ => 0,
    }
}

/// The tabs with their texts: whole names where there is room, short ones, or, but for the screen shown, numbers.
fn tab_texts(state: &State, width: u16) -> Vec<(Screen, String)> {
    let text = |(k, screen): (usize, Screen)| {
        let [name, short] = screen.names();
        let text = match width {
            WIDE.. => format!(" {} {name} ", k + 1),
            SHORT.. => format!(" {} {}", k + 1, if screen == state.nav.screen { name } else { short }),
            _ if screen == state.nav.screen => format!(" {} {name}", k + 1),
            _ => format!(" {}", k + 1),
        };
        (screen, text)
    };
    Screen::ALL.into_iter().enumerate().map(text).collect()
}

/// The screen whose tab is at a column.
#[must_use]
pub fn tab_at(state: &State, column: u16) -> Option<Screen> {
    let mut end = 0;
    tab_texts(state, state.terminal.size.width).into_iter().find_map(|(screen, text)| {
        end += text::width(&text);
        (usize::from(column) < end).then_some(screen)
    })
}

fn tabs(state: &State, width: u16) -> Line<'static> {
    let mut spans = vec![];
    for (screen, text) in tab_texts(state, width) {
        let style = if screen == state.nav.screen { state.theme.selected() } else { Style::new() };
        spans.push(Span::styled(text, style));
    }
    let used: usize = spans.iter().map(Span::width).sum();
    let room = usize::from(width).saturating_sub(used);
    let columns = |spans: &[(u8, Span<'_>)]| spans.iter().map(|(_, span)| span.width()).sum::<usize>();
    let mut summary = summary(state, width);
    while columns(&summary) >= room && !summary.is_empty() {
        let least = (0..summary.len()).min_by_key(|k| summary[*k].0).unwrap_or(0);
        summary.remove(least);
    }
    spans.push(Span::raw(" ".repeat(room - columns(&summary).min(room))));
    spans.extend(summary.into_iter().map(|(_, span)| span));
    Line::from(spans)
}

/// The study and how far it has come, each part with its weight: the least is left out first where there is no room.
fn summary(state: &State, width: u16) -> Vec<(u8, Span<'static>)> {
    let Some(study) = state.data.as_ref().and_then(|data| data.study()) else { return vec![] };
    let mut spans = vec![(1, Span::styled(study.name.clone(), state.theme.bold()))];
    if study.paused {
        spans.push((9, Span::styled(" paused", state.theme.warn())));
    }
    if state.running.target.is_some() {
        let text = if width >= WIDE { " run here" } else { " run" };
        spans.push((5, Span::styled(text, state.theme.busy())));
    }
    spans.push((0, Span::raw(format!(" {} jobs", study.total()))));
    for status in Status::ALL.into_iter().filter(|status| study.count(*status) > 0) {
        let text = format!(" {}{}", glyph(status), study.count(status));
        spans.push((if status == Status::Cancelled { 6 } else { 7 }, Span::styled(text, state.theme.status(status))));
    }
    spans.push((10, Span::raw(" ")));
    spans
}

/// The filter while it is typed, a message, or the keys that matter here.
fn status_line(state: &State, width: u16) -> Line<'static> {
    if matches!(state.overlay, Some(Overlay::Filter(_))) {
        let hint = Span::styled("  ↵ keep  Esc undo", state.theme.dim());
        return Line::from(vec![Span::raw(format!("/{}▏", state.filter())), hint]);
    }
    if let Some(notice) = &state.notice {
        let (mark, style) = if notice.is_error { ("✗ ", state.theme.bad()) } else { ("", Style::new()) };
        let line = notice.text.lines().collect::<Vec<_>>().join("; ");
        return Line::styled(text::shortened(&format!(" {mark}{line}"), usize::from(width)), style);
    }
    if state.is_editing() {
        return editor_hints(state);
    }
    let filter = state.filter();
    let mut spans = vec![];
    let mut used = 0;
    if !filter.is_empty() {
        let text = format!(" filter /{filter}/ Esc clears");
        used += text::width(&text);
        spans.push(Span::styled(text, state.theme.warn()));
    }
    // What matters most stands first in the table, but help and palette must always be found.
    let hinted = state.setup.bindings.iter().filter(|b| !b.hint.is_empty() && b.is_on(state.screen_shown()));
    let is_start = state.is_first_start() && state.screen_shown() == Screen::Study;
    let hinted = hinted.filter(|b| !is_start || matches!(b.name, "open" | "run" | "new-study" | "help" | "palette"));
    let (last, first): (Vec<&Binding>, Vec<&Binding>) = hinted.partition(|b| matches!(b.name, "help" | "palette"));
    let columns = |b: &Binding| text::width(&b.keys[0].to_string()) + text::width(b.hint) + 3;
    let reserved: usize = last.iter().map(|b| columns(b)).sum();
    for binding in first.into_iter().chain(last) {
        let is_last = matches!(binding.name, "help" | "palette");
        let keep = if is_last { 0 } else { reserved };
        if used + columns(binding) + keep > usize::from(width) {
            continue;
        }
        used += columns(binding);
        spans.push(Span::styled(format!(" {}", binding.keys[0]), state.theme.bold()));
        spans.push(Span::raw(format!(" {} ", binding.hint)));
    }
    Line::from(spans)
}

/// The keys that matter while a query is typed.
fn editor_hints(state: &State) -> Line<'static> {
    let hints = [
        ("F5", "run"),
        ("Tab", "complete, or rows"),
        ("C-p", "history"),
        ("Esc", "rows and commands"),
        ("C-c", "cancel"),
    ];
    let spans = hints
        .iter()
        .flat_map(|(key, hint)| [Span::styled(format!(" {key}"), state.theme.bold()), Span::raw(format!(" {hint} "))]);
    Line::from(spans.collect::<Vec<_>>())
}

//! The frame that all screens share: tabs, body, status line, overlays.

use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::style::Style;
use ratatui::text::{Line, Span};
use ratatui::widgets::{Clear, Paragraph};

use crate::app::App;
use crate::keys::action::Action;
use crate::keys::binding::Binding;
use crate::keys::screen::Screen;
use crate::overlays::Overlay;
use crate::screens::start;
use crate::screens::state::State;
use crate::widgets::layout::{WIDE, rows};
use crate::widgets::theme::{Theme, glyph};
use crate::widgets::{ascii, text};
use store::Status;

/// Terminal width, columns, from which the first line has the names of all screens, at least short ones.
const SHORT: u16 = 66;

/// Fewest columns for the name of the study, if it has as many.
const LEAST_NAME: usize = 8;

pub fn draw(frame: &mut Frame<'_>, app: &App) {
    let App { state, screens } = app;
    let [top, body, bottom] = rows(frame.area());
    frame.render_widget(tabs(state, top.width), top);
    if state.data.is_none() {
        frame.render_widget(Paragraph::new(" reading the database…"), body);
    } else if is_start_shown(app) {
        start::draw(frame, body, state);
    } else {
        screens.page(state.nav.screen).draw(frame, body, state);
    }
    frame.render_widget(status_line(app, bottom.width), bottom);
    draw_notice(frame, state);
    if let Some(overlay) = &state.overlay {
        overlay.draw(frame, body, state.theme);
    }
    if state.theme.ascii {
        ascii::translate(frame.buffer_mut());
    }
}

/// True if the start screen is shown, because there is no study yet.
fn is_start_shown(app: &App) -> bool {
    app.state.is_first_start() && app.screens.page(app.state.nav.screen).needs_study()
}

/// Screen whose keys apply. Without a study those of Study apply on all screens that need one.
pub fn keys_of(app: &App) -> Screen {
    if is_start_shown(app) { Screen::Study } else { app.state.nav.screen }
}

/// Texts of the tabs: whole names where they fit, else short ones, close to their numbers where the study needs room,
/// else numbers for all but the shown screen.
fn tab_texts(state: &State, width: u16) -> Vec<(Screen, String)> {
    let parts = summary(state, width);
    let study = state.study().map_or(0, |study| text::width(&study.name));
    let told = study + parts.iter().map(|(_, span)| span.width()).sum::<usize>();
    let texts = |gap: &str| -> Vec<(Screen, String)> {
        let text = |screen: Screen| {
            let ([name, short], number) = (screen.names(), screen.number());
            let text = match width {
                WIDE.. => format!(" {number} {name} "),
                _ if screen == state.nav.screen => format!(" {number} {name}"),
                SHORT.. => format!(" {number}{gap}{short}"),
                _ => format!(" {number}"),
            };
            (screen, text)
        };
        Screen::ALL.into_iter().map(text).collect()
    };
    let loose = texts(" ");
    let columns: usize = loose.iter().map(|(_, text)| text::width(text)).sum();
    if columns + told < usize::from(width) { loose } else { texts("") }
}

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
    // A column stays free before the study.
    let room = usize::from(width).saturating_sub(used + 1);
    let summary = fitted(state, summary(state, width), room);
    let columns: usize = summary.iter().map(Span::width).sum();
    spans.push(Span::raw(" ".repeat(1 + room - columns.min(room))));
    spans.extend(summary);
    Line::from(spans)
}

/// Name of the study and as many parts of its progress as fit. The name is always there: long ones are shortened, but
/// parts of least weight are left out before a name has fewer than [`LEAST_NAME`] columns.
fn fitted(state: &State, mut parts: Vec<(u8, Span<'static>)>, room: usize) -> Vec<Span<'static>> {
    let Some(study) = state.study() else { return vec![] };
    let least = text::width(&study.name).min(LEAST_NAME);
    let columns = |parts: &[(u8, Span<'_>)]| parts.iter().map(|(_, span)| span.width()).sum::<usize>();
    while columns(&parts) + least > room && !parts.is_empty() {
        let lightest = (0..parts.len()).min_by_key(|k| parts[*k].0).unwrap_or(0);
        parts.remove(lightest);
    }
    let name = text::shortened(&study.name, room.saturating_sub(columns(&parts)));
    let name = Span::styled(name, state.theme.bold());
    std::iter::once(name).chain(parts.into_iter().map(|(_, span)| span)).collect()
}

/// Progress of the study, in parts with weights; where they do not fit, the part of least weight is left out first.
fn summary(state: &State, width: u16) -> Vec<(u8, Span<'static>)> {
    let Some(study) = state.study() else { return vec![] };
    let mut spans = vec![];
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
        let weight = match status {
            Status::Failed => 9,
            Status::Running => 8,
            Status::NotConverged => 7,
            Status::Done => 6,
            Status::Queued => 4,
            Status::Cancelled => 3,
        };
        spans.push((weight, Span::styled(text, state.theme.status(status))));
    }
    spans.push((10, Span::raw(" ")));
    spans
}

/// Draws a message in the last line, or in more lines if it is longer.
fn draw_notice(frame: &mut Frame<'_>, state: &State) {
    let Some(notice) = state.told.notice.as_ref().filter(|_| !matches!(state.overlay, Some(Overlay::Filter(_)))) else {
        return;
    };
    let (mark, style) = if notice.is_error { ("✗ ", state.theme.bad()) } else { ("", Style::new()) };
    let line = notice.text.lines().collect::<Vec<_>>().join("; ");
    let area = frame.area();
    let lines = text::wrapped(&format!("{mark}{line}"), usize::from(area.width.saturating_sub(1)).max(1));
    let height = (lines.len() as u16).min(area.height / 2).max(1).min(area.height);
    let place = Rect { y: area.bottom() - height, height, ..area };
    let lines: Vec<Line<'_>> = lines.into_iter().map(|line| Line::styled(format!(" {line}"), style)).collect();
    frame.render_widget(Clear, place);
    frame.render_widget(Paragraph::new(lines), place);
}

/// Status line: the filter while it is typed, else the keys of the present screen.
fn status_line(app: &App, width: u16) -> Line<'static> {
    let App { state, screens } = app;
    if matches!(state.overlay, Some(Overlay::Filter(_))) {
        let hint = Span::styled("  ↵ keep  Esc undo", state.theme.dim());
        return Line::from(vec![Span::raw(format!("/{}▏", state.filter())), hint]);
    }
    if let Some(hints) = screens.page(state.nav.screen).hints(state) {
        return hint_line(hints, state.theme);
    }
    let filter = state.filter();
    let mut spans = vec![];
    let mut used = 0;
    if !filter.is_empty() {
        let text = format!(" filter /{filter}/ Esc clears");
        used += text::width(&text);
        spans.push(Span::styled(text, state.theme.warn()));
    }
    // Hints come in the order of the table, the most important first; those for help and palette must always be shown.
    let hinted = state.setup.bindings.iter().filter(|b| !b.hint.is_empty() && b.is_on(keys_of(app)));
    // In the catalogue rows are seldom selected together, and `?` tells how.
    let is_catalogue = matches!(keys_of(app), Screen::Subjects | Screen::Fabrics);
    let hinted = hinted.filter(|b| b.action != Action::Mark || !is_catalogue);
    let hinted = hinted.filter(|b| b.action != Action::RetryFailed || keys_of(app) == Screen::Jobs);
    let is_start = is_start_shown(app);
    let mut hinted: Vec<&Binding> = hinted.collect();
    if keys_of(app) == Screen::Results {
        // From a result one goes on to how the garment fits.
        hinted.sort_by_key(|b| !matches!(b.action, Action::Enlarge | Action::Show(Screen::Fit)));
    }
    let hinted =
        hinted.into_iter().filter(|b| !is_start || matches!(b.name, "open" | "run" | "new-study" | "help" | "palette"));
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

fn hint_line(hints: &[(&'static str, &'static str)], theme: Theme) -> Line<'static> {
    let spans = hints
        .iter()
        .flat_map(|(key, hint)| [Span::styled(format!(" {key}"), theme.bold()), Span::raw(format!(" {hint} "))]);
    Line::from(spans.collect::<Vec<_>>())
}

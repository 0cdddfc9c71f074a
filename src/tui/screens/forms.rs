//! Forms above a screen: the values of a subject, the path of a file.

use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span};
use ratatui::widgets::{Clear, Paragraph};

use super::super::form::{Form, Note, PathPrompt};
use super::super::style_form::{self, StyleForm};
use super::super::text::{self, left, right, shortened};
use super::super::theme::Theme;
use super::chi::wrapped;
use super::overlays::middle;
use super::{first_shown, pane};
use study::{Mode, Part};

/// Columns of values in a form.
const VALUE: usize = 12;

/// Draws the values of a subject or a fabric.
pub(super) fn draw_form(frame: &mut Frame<'_>, area: Rect, form: &Form, theme: Theme) {
    let title = match form.mode {
        Mode::Edit => format!("edit {}: a new revision, results keep theirs", form.name()),
        _ => format!("new {}{}", form.part, form.like.as_ref().map_or(String::new(), |name| format!(", like {name}"))),
    };
    let width = area.width.min(if form.part == Part::Fabric { 100 } else { 76 });
    let columns = usize::from(width.saturating_sub(2));
    // The line has little room for what is wrong with its value.
    let wrong = match form.note(form.at) {
        Note::Problem(problem) => Some(problem),
        _ => form.problem.clone(),
    };
    let busy = if form.part == Part::Fabric { "saving…" } else { "building the body…" };
    let end = end(form.is_busy.then_some(busy), wrong.as_deref(), columns, theme);
    let room = usize::from(area.height.saturating_sub(2)).saturating_sub(end.len());
    let first = first_shown(form.at, form.texts.len(), room);
    let shown = (first..form.texts.len()).take(room);
    let mut lines: Vec<Line<'_>> = shown.map(|k| line(form, k, columns, theme)).collect();
    lines.extend(end);
    let keys = match form.part {
        Part::Fabric => " Tab ↑↓ line  C-u empties it  ↵ save  Esc cancel ",
        _ => " Tab ↑↓ line  ↵ save  Esc cancel  empty = not known ",
    };
    draw(frame, area, width, title, keys, lines, theme);
}

/// A line of a form: name, value, and what there is to say of it.
fn line(form: &Form, k: usize, columns: usize, theme: Theme) -> Line<'static> {
    let is_focused = k == form.at && !form.is_busy;
    let mark = if is_focused { "▸" } else { " " };
    let value = if is_focused { format!("{}▏", form.texts[k]) } else { form.texts[k].clone() };
    let (note, style) = match form.note(k) {
        Note::None => (String::new(), theme.dim()),
        Note::Place(words) => (words, theme.dim()),
        Note::Doubt(words) => (words, theme.warn()),
        Note::Problem(problem) => (format!("✗ {problem}"), theme.bad()),
    };
    let lines = 0..form.texts.len();
    let widest = |of: &dyn Fn(usize) -> &'static str| lines.clone().map(|k| text::width(of(k))).max().unwrap_or(0);
    let head = format!("{mark} {} ", left(form.label(k), widest(&|k| form.label(k))));
    let typed = match Form::is_number(k) {
        true => format!("{head}{} {} ", right(&value, VALUE), left(form.unit(k), widest(&|k| form.unit(k)))),
        // A long word takes the room of its note; its end is what is being typed.
        false => format!("{head}{} ", ended(&value, columns.saturating_sub(text::width(&head) + 1), is_focused)),
    };
    let room = columns.saturating_sub(text::width(&typed));
    let style_of_text = if is_focused { theme.bold() } else { ratatui::style::Style::new() };
    Line::from(vec![Span::styled(typed, style_of_text), Span::styled(shortened(&note, room), style)])
}

/// A text in at most so many columns: its end while it is typed, its beginning else.
fn ended(text: &str, columns: usize, is_typed: bool) -> String {
    let letters: Vec<char> = text.chars().collect();
    if is_typed { letters[letters.len().saturating_sub(columns)..].iter().collect() } else { shortened(text, columns) }
}

/// Draws the prompt for a file.
pub(super) fn draw_path(frame: &mut Frame<'_>, area: Rect, prompt: &PathPrompt, theme: Theme) {
    let width = area.width.min(100);
    let columns = usize::from(width.saturating_sub(2));
    // The end of a long path is what is being typed.
    let mut lines = vec![Line::styled(ended(&format!(" {}▏", prompt.text), columns, true), theme.bold())];
    lines.extend(end(prompt.is_busy.then_some(prompt.purpose.busy()), prompt.problem.as_deref(), columns, theme));
    if lines.len() == 1 {
        lines.push(Line::styled(format!(" {}; ~/ is home", prompt.purpose.hint()), theme.dim()));
    }
    draw(frame, area, width, prompt.purpose.title().to_owned(), prompt.purpose.keys(), lines, theme);
}

/// Draws the files of a style.
pub(super) fn draw_style(frame: &mut Frame<'_>, area: Rect, form: &StyleForm, theme: Theme) {
    let width = area.width.min(100);
    let columns = usize::from(width.saturating_sub(2));
    let line = |(k, text): (usize, &String)| {
        let is_focused = k == form.at && !form.is_busy;
        let (mark, end) = if is_focused { ("▸", "▏") } else { (" ", "") };
        let head = format!("{mark} {}", left(style_form::LABELS[k], 11));
        let room = columns.saturating_sub(text::width(&head));
        // The end of a long path is what tells it from others.
        let shown = ended(&format!("{text}{end}"), room, true);
        let style = if is_focused { theme.bold() } else { ratatui::style::Style::new() };
        let hint = if text.is_empty() { format!(" {}", form.hint(k)) } else { String::new() };
        let hint = shortened(&hint, room.saturating_sub(text::width(&shown)));
        Line::from(vec![Span::styled(head + &shown, style), Span::styled(hint, theme.dim())])
    };
    let mut lines: Vec<Line<'_>> = form.texts.iter().enumerate().map(line).collect();
    let busy = form.is_busy.then_some("reading, and sewing each size…");
    lines.extend(end(busy, form.problem.as_deref(), columns, theme));
    let keys = " Tab ↑↓ line  ↵ import all or none  Esc cancel  ~/ is home ";
    draw(frame, area, width, "import a style or sizes".to_owned(), keys, lines, theme);
}

/// What goes on, or what went wrong.
pub(super) fn end(busy: Option<&str>, problem: Option<&str>, columns: usize, theme: Theme) -> Vec<Line<'static>> {
    let mut lines: Vec<Line<'static>> =
        busy.iter().map(|text| Line::styled(format!(" {text}"), theme.busy())).collect();
    let problem = wrapped(problem.unwrap_or_default(), columns.saturating_sub(3));
    let mark = |k| if k == 0 { "✗" } else { " " };
    lines.extend(
        problem.into_iter().enumerate().map(|(k, text)| Line::styled(format!(" {} {text}", mark(k)), theme.bad())),
    );
    lines
}

pub(super) fn draw(
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

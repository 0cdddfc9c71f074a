//! The form of a new study, above a screen.

use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span};

use super::super::study_form::{FormLine, StudyForm};
use super::super::text::{self, left, shortened};
use super::super::theme::Theme;
use super::first_shown;
use super::forms::{draw as draw_frame, end};
use study::PatternSource;

/// Columns of the names of the parts.
const SECTION: usize = 17;

/// Draws the form.
pub(super) fn draw(frame: &mut Frame<'_>, area: Rect, form: &StudyForm, theme: Theme) {
    let width = area.width.min(90);
    let columns = usize::from(width.saturating_sub(2));
    let [subjects, sizes, simulators] = form.jobs();
    let counted = |n: usize, what: &str| format!("{n} {what}{}", if n == 1 { "" } else { "s" });
    let count = format!(
        " {} × {} × {} = {}",
        counted(subjects, "subject"),
        counted(sizes, "size"),
        counted(simulators, "simulator"),
        counted(subjects * sizes * simulators, "simulation")
    );
    let folder = format!(" into {}", form.folder.join(form.name.trim()).display());
    let mut below = vec![
        Line::styled(shortened(&count, columns), theme.bold()),
        Line::styled(shortened(&folder, columns), theme.dim()),
    ];
    below.extend(end(form.is_busy.then_some("writing and checking…"), form.problem.as_deref(), columns, theme));
    let lines = form.lines();
    let room = usize::from(area.height.saturating_sub(2)).saturating_sub(below.len());
    let first = first_shown(form.at, lines.len(), room);
    let mut shown: Vec<Line<'_>> =
        (first..lines.len()).take(room).map(|k| line(form, k, k == first, columns, theme)).collect();
    shown.extend(below);
    let keys = " Space choose  a all  Tab next part  ↵ make it  Esc cancel ";
    draw_frame(frame, area, width, "new study".to_owned(), keys, shown, theme);
}

/// A line: the part where one begins, and the choice.
fn line(form: &StudyForm, k: usize, is_first_shown: bool, columns: usize, theme: Theme) -> Line<'static> {
    let lines = form.lines();
    let line = lines[k];
    let is_focused = k == form.at && !form.is_busy;
    let begins = k == 0 || is_first_shown || lines[k - 1].section() != line.section();
    let section = if begins { line.section() } else { "" };
    let mark = match form.choice(line) {
        Some(true) => "[x] ",
        Some(false) => "[ ] ",
        None => "",
    };
    let value = match line {
        FormLine::Name => format!("{}{}", form.name, if is_focused { "▏" } else { "" }),
        FormLine::Fabric => match form.fabrics.get(form.fabric) {
            Some(name) => format!("◂ {name} ▸  {} of {}", form.fabric + 1, form.fabrics.len()),
            None => "none".to_owned(),
        },
        FormLine::Simulator(k) => text::sim(form.simulators[k].0).to_owned(),
        FormLine::Size(k) => {
            let wearable = &form.sizes[k].0;
            let origin =
                if matches!(wearable.source, PatternSource::Drafted(_)) { "  drafted by the program" } else { "" };
            format!("{} {}{origin}", wearable.style, wearable.size)
        }
        FormLine::Subject(k) => form.subjects[k].0.clone(),
    };
    let text = shortened(&format!("{mark}{value}"), columns.saturating_sub(SECTION + 2));
    let style = if is_focused { theme.selected() } else { ratatui::style::Style::new() };
    let pointer = if is_focused { "▸ " } else { "  " };
    Line::from(vec![
        Span::styled(format!("{pointer}{}", left(section, SECTION)), theme.dim()),
        Span::styled(text, style),
    ])
}

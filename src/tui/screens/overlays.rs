//! Help, the palette and questions, above the screen.

use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span};
use ratatui::widgets::{Clear, Paragraph, Wrap};

use super::super::action::Binding;
use super::super::overlay::{List, Overlay};
use super::super::state::State;
use super::super::text::left;
use super::super::theme::Theme;
use super::{first_shown, forms, pane, sql, study_form};

pub(super) fn draw(frame: &mut Frame<'_>, area: Rect, overlay: &Overlay, state: &State) {
    match overlay {
        Overlay::Help(list) => {
            let title = format!("keys: /{}▏  type to filter, ↵ does it, Esc closes", list.text);
            draw_list(frame, area, &title, list, state);
        }
        Overlay::Palette(list) => {
            let title = format!(":{}▏  ↑↓ choose, ↵ does it, Esc closes", list.text);
            draw_list(frame, area, &title, list, state);
        }
        Overlay::Form(form) => forms::draw_form(frame, area, form, state.theme),
        Overlay::Path(prompt) => forms::draw_path(frame, area, prompt, state.theme),
        Overlay::StyleForm(form) => forms::draw_style(frame, area, form, state.theme),
        Overlay::StudyForm(form) => study_form::draw(frame, area, form, state.theme),
        Overlay::Queries(list) => sql::draw_queries(frame, area, list, state),
        Overlay::Question { text, .. } => draw_question(frame, area, text, state.theme),
        Overlay::Filter(_) => {}
    }
}

fn draw_list(frame: &mut Frame<'_>, area: Rect, title: &str, list: &List, state: &State) {
    let rows = list.rows();
    let height = (rows.len() as u16 + 2).max(3).min(area.height);
    let place = middle(area, area.width.min(100), height);
    let place_of_keys = " other keys: toile/keys.toml in the config folder, like cancel = \"D\" ";
    let block = pane(state.theme, title, true).title_bottom(Line::styled(place_of_keys, state.theme.legend()));
    let inner = block.inner(place);
    let first = first_shown(list.row, rows.len(), usize::from(inner.height));
    let line = |(k, binding): (usize, &&Binding)| {
        let line = line(state, binding, usize::from(inner.width));
        if k == list.row { line.patch_style(state.theme.selected()) } else { line }
    };
    let mut lines: Vec<Line<'_>> =
        rows.iter().enumerate().skip(first).take(usize::from(inner.height)).map(line).collect();
    if lines.is_empty() {
        lines.push(Line::raw("no action of that name or key"));
    }
    frame.render_widget(Clear, place);
    frame.render_widget(Paragraph::new(lines).block(block), place);
}

/// Keys, name and help of an action; dim where it does nothing on this screen.
fn line(state: &State, binding: &Binding, columns: usize) -> Line<'static> {
    let longest = |field: fn(&Binding) -> usize| state.setup.bindings.iter().map(field).max().unwrap_or(0);
    let keys = longest(|b| super::super::text::width(&b.keys_text())) + 1;
    let name = longest(|b| b.name.len()) + 1;
    let help = super::super::text::shortened(binding.help, columns.saturating_sub(keys + name));
    let line = Line::from(vec![
        Span::styled(left(&binding.keys_text(), keys), state.theme.bold()),
        Span::raw(left(binding.name, name)),
        Span::raw(help),
    ]);
    if binding.is_on(state.nav.screen) { line } else { line.patch_style(state.theme.dim()) }
}

fn draw_question(frame: &mut Frame<'_>, area: Rect, text: &str, theme: Theme) {
    let width = area.width.min(60);
    let rows = text.chars().count() as u16 / width.saturating_sub(4).max(1) + 5;
    let place = middle(area, width, rows.min(area.height));
    let lines = vec![
        Line::raw(text.to_owned()),
        Line::raw(""),
        Line::from(vec![Span::styled("y", theme.bold()), Span::raw(" yes    any other key: no")]),
    ];
    let block = pane(theme, "sure?", true).border_style(theme.warn());
    frame.render_widget(Clear, place);
    frame.render_widget(Paragraph::new(lines).wrap(Wrap { trim: true }).block(block), place);
}

pub(super) fn middle(area: Rect, width: u16, height: u16) -> Rect {
    let x = area.x + area.width.saturating_sub(width) / 2;
    let y = area.y + area.height.saturating_sub(height) / 2;
    Rect::new(x, y, width, height).intersection(area)
}

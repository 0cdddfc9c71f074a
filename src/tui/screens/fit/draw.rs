//! Where the parts of the screen lie.

use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::text::Line;
use ratatui::widgets::Paragraph;

use crate::screens::fit::state::View;
use crate::screens::fit::{alteration, card, section, sizes};
use crate::screens::state::State;
use crate::widgets::layout::WIDE;
use crate::widgets::lists::pane;
use crate::widgets::text;

/// Bodies of at least so many rows have room for the card above the comparison.
const TALL: u16 = 34;
/// Columns of a card whose words are whole, with its borders.
const CARD: u16 = 94;
/// The fewest columns of a section beside the card.
const SECTION: u16 = 40;

/// Draws the screen: all parts where there is room, card or comparison beside the section, or one of them.
pub fn draw(frame: &mut Frame<'_>, area: Rect, state: &State) {
    if state.fit.alter.is_open {
        draw_alteration(frame, area, state);
        return;
    }
    if !has_drape(state) {
        draw_card(frame, area, state, true);
        return;
    }
    let view = state.fit.view;
    if area.width < WIDE {
        match view {
            View::Card => draw_card(frame, area, state, true),
            View::Section => section::draw(frame, area, state, true),
            View::Sizes => draw_sizes(frame, area, state, true),
        }
        return;
    }
    let [left, right] = beside(area);
    section::draw(frame, right, state, view == View::Section);
    if area.height >= TALL {
        let lines = card::lines(state, usize::from(left.width - 2), usize::from(area.height), false).len() as u16;
        let [card, sizes] = Layout::vertical([Constraint::Length(lines + 2), Constraint::Fill(1)]).areas(left);
        draw_card(frame, card, state, view == View::Card);
        draw_sizes(frame, sizes, state, view == View::Sizes);
    } else if view == View::Sizes {
        draw_sizes(frame, left, state, true);
    } else {
        draw_card(frame, left, state, view == View::Card);
    }
}

fn has_drape(state: &State) -> bool {
    state.worn().is_none_or(|worn| !worn.sizes.is_empty())
}

/// The card and the section in a wide area.
fn beside(area: Rect) -> [Rect; 2] {
    Layout::horizontal([Constraint::Length(CARD.min(area.width - SECTION)), Constraint::Fill(1)]).areas(area)
}

/// Where what to change lies, and beside it the section where there is room.
fn alteration_panes(area: Rect, state: &State) -> (Rect, Option<Rect>) {
    if area.width < WIDE || !has_drape(state) {
        return (area, None);
    }
    let [left, right] = beside(area);
    (left, Some(right))
}

/// How many lines of what to change there is no room for.
pub fn hidden_lines(state: &State) -> usize {
    alteration::hidden(state, alteration_panes(state.body(), state).0)
}

fn draw_alteration(frame: &mut Frame<'_>, area: Rect, state: &State) {
    let (pane_area, section_area) = alteration_panes(area, state);
    if let Some(area) = section_area {
        section::draw(frame, area, state, false);
    }
    let hidden = alteration::hidden(state, pane_area);
    let more = alteration::hidden_mark(state, hidden).unwrap_or_default();
    // Where there is room for one of both, that there is more matters more.
    let has_legend = text::width(&more) + text::width(card::LEGEND) + 2 < usize::from(pane_area.width);
    let legend = if has_legend || more.is_empty() { card::LEGEND } else { "" };
    let block = pane(state.theme, alteration::title(state), true)
        .title_bottom(Line::styled(more, state.theme.busy()))
        .title_bottom(Line::styled(legend, state.theme.legend()).right_aligned());
    let (columns, rows) = alteration::inner(pane_area);
    let lines = alteration::lines(state, columns, rows).into_iter().skip(state.fit.alter.down.min(hidden));
    frame.render_widget(Paragraph::new(lines.collect::<Vec<_>>()).block(block), pane_area);
}

fn draw_card(frame: &mut Frame<'_>, area: Rect, state: &State, focused: bool) {
    let block = pane(state.theme, card::title(state), focused)
        .title_bottom(Line::styled(card::LEGEND, state.theme.legend()).right_aligned());
    let inner = block.inner(area);
    let lines = card::lines(state, usize::from(inner.width), usize::from(inner.height), focused);
    frame.render_widget(Paragraph::new(lines).block(block), area);
}

fn draw_sizes(frame: &mut Frame<'_>, area: Rect, state: &State, focused: bool) {
    let block = pane(state.theme, sizes::title(state), focused)
        .title_bottom(Line::styled(sizes::LEGEND, state.theme.legend()).right_aligned());
    let inner = block.inner(area);
    let lines = sizes::lines(state, usize::from(inner.width), usize::from(inner.height), focused);
    frame.render_widget(Paragraph::new(lines).block(block), area);
}

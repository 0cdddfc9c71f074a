//! Where the parts of the screen lie.

use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::text::Line;
use ratatui::widgets::Paragraph;

use crate::screens::fit::state::View;
use crate::screens::fit::{card, section, sizes};
use crate::screens::state::State;
use crate::widgets::layout::WIDE;
use crate::widgets::lists::pane;

/// Bodies of at least so many rows have room for the card above the comparison.
const TALL: u16 = 34;
/// Columns of a card whose words are whole, with its borders.
const CARD: u16 = 94;
/// The fewest columns of a section beside the card.
const SECTION: u16 = 40;

/// Draws the screen: all parts where there is room, card or comparison beside the section, or one of them.
pub fn draw(frame: &mut Frame<'_>, area: Rect, state: &State) {
    let has_drape = state.worn().is_none_or(|worn| !worn.sizes.is_empty());
    if !has_drape {
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
    let [left, right] =
        Layout::horizontal([Constraint::Length(CARD.min(area.width - SECTION)), Constraint::Fill(1)]).areas(area);
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

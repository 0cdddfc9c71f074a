//! Layout of the screen, and drawing of its parts.

use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::text::Line;
use ratatui::widgets::Paragraph;

use crate::overlays::explanation::Selected;
use crate::screens::fit::actions::{quantities_shown, worn};
use crate::screens::fit::state::{FitScreen, View};
use crate::screens::fit::{alteration, card, sizes};
use crate::screens::page::Draw;
use crate::screens::state::State;
use crate::widgets::jump::{self, Target};
use crate::widgets::layout::WIDE;
use crate::widgets::lists::pane;
use crate::widgets::text::{self, words};

/// Least rows at which the card stands above the comparison of sizes.
const TALL: u16 = 34;
/// Columns for a card with whole words, its borders included.
const CARD: u16 = 94;
/// Fewest columns for a section beside the card.
const SECTION: u16 = 40;

/// Names of the quantities on the screen, as in the glossary.
const NAMES: [&str; 11] = [
    "ease",
    "target",
    "body",
    "wear",
    "level",
    "mean gap",
    "hem",
    "side seam lean",
    "greatest pressure",
    "folds",
    "drag lines",
];

/// Names of the columns of comments, as in the glossary.
const COMMENT_NAMES: [&str; 4] = ["severity", "round", "owner", "size"];

impl Draw for FitScreen {
    fn draw(&self, frame: &mut Frame<'_>, area: Rect, state: &State) {
        if self.alter.is_open {
            self.draw_alteration(frame, area, state);
            return;
        }
        let parts = self.parts(area, state);
        let is_alone = parts.len() == 1;
        for (part, area) in parts {
            let focused = is_alone || self.view == part;
            match part {
                View::Card => self.draw_card(frame, area, state, focused),
                View::Section => self.draw_section(frame, area, state, focused),
                View::Sizes => self.draw_sizes(frame, area, state, focused),
                View::Comments => self.comments.draw(frame, area, state, focused),
            }
        }
    }

    fn targets(&self, state: &State, area: Rect) -> Vec<Target> {
        if self.alter.is_open {
            return vec![];
        }
        let targets = |(part, area): (View, Rect)| {
            let inner = jump::inside(area);
            match part {
                View::Card => self.card_targets(state, inner),
                View::Section => vec![jump::pane(area, part as usize)],
                View::Sizes => jump::rows(part as usize, inner, 1, quantities_shown(state).len(), self.row),
                View::Comments => self.comments.targets(state, area),
            }
        };
        self.parts(area, state).into_iter().flat_map(targets).collect()
    }

    fn explained(&self, state: &State) -> Selected {
        if self.view == View::Comments {
            let what = self.comments.selected(state).map_or(String::new(), |one| one.remark.said.clone());
            return Selected::new(what, &["comment"], &COMMENT_NAMES);
        }
        let quantities = quantities_shown(state);
        let quantity = quantities.get(self.row).filter(|_| self.view == View::Sizes);
        let (what, name) = match quantity {
            Some(quantity) => {
                let cells: Vec<&str> = quantity.cells.iter().flatten().map(String::as_str).collect();
                (format!("{}: {}", quantity.name, cells.join("; ")), quantity.name.clone())
            }
            None => {
                let level = words(self.level(state).unwrap_or_default());
                (level.clone(), level)
            }
        };
        Selected::new(what, &[&name], &NAMES)
    }
}

impl FitScreen {
    fn parts(&self, area: Rect, state: &State) -> Vec<(View, Rect)> {
        let view = self.view;
        if !has_drape(state) {
            return vec![(if view == View::Comments { view } else { View::Card }, area)];
        }
        if area.width < WIDE {
            return vec![(view, area)];
        }
        // What is below the card, or in its place.
        let other = if view == View::Comments { view } else { View::Sizes };
        let [left, right] = beside(area);
        let section = (View::Section, right);
        if area.height >= TALL {
            let lines =
                self.card_lines(state, usize::from(left.width - 2), usize::from(area.height), false).len() as u16;
            let [card, sizes] = Layout::vertical([Constraint::Length(lines + 2), Constraint::Fill(1)]).areas(left);
            return vec![section, (View::Card, card), (other, sizes)];
        }
        vec![section, (if view == other { other } else { View::Card }, left)]
    }

    pub fn hidden_lines(&self, state: &State) -> usize {
        self.alter.hidden(state, alteration_panes(state.body(), state).0)
    }

    fn draw_alteration(&self, frame: &mut Frame<'_>, area: Rect, state: &State) {
        let (pane_area, section_area) = alteration_panes(area, state);
        if let Some(area) = section_area {
            self.draw_section(frame, area, state, false);
        }
        let hidden = self.alter.hidden(state, pane_area);
        let more = self.alter.hidden_mark(hidden).unwrap_or_default();
        // Where only one of both fits, the mark for hidden lines goes before the legend.
        let has_legend = text::width(&more) + text::width(card::LEGEND) + 2 < usize::from(pane_area.width);
        let legend = if has_legend || more.is_empty() { card::LEGEND } else { "" };
        let block = pane(state.theme, self.alter.title(), true)
            .title_bottom(Line::styled(more, state.theme.busy()))
            .title_bottom(Line::styled(legend, state.theme.legend()).right_aligned());
        let (columns, rows) = alteration::inner(pane_area);
        let lines = self.alter.lines(state, columns, rows).into_iter().skip(self.alter.down.min(hidden));
        frame.render_widget(Paragraph::new(lines.collect::<Vec<_>>()).block(block), pane_area);
    }

    fn draw_card(&self, frame: &mut Frame<'_>, area: Rect, state: &State, focused: bool) {
        let block = pane(state.theme, card::title(state), focused)
            .title_bottom(Line::styled(card::LEGEND, state.theme.legend()).right_aligned());
        let inner = block.inner(area);
        let lines = self.card_lines(state, usize::from(inner.width), usize::from(inner.height), focused);
        frame.render_widget(Paragraph::new(lines).block(block), area);
    }

    fn draw_sizes(&self, frame: &mut Frame<'_>, area: Rect, state: &State, focused: bool) {
        let block = pane(state.theme, sizes::title(state), focused)
            .title_bottom(Line::styled(sizes::LEGEND, state.theme.legend()).right_aligned());
        let inner = block.inner(area);
        let lines = self.size_lines(state, usize::from(inner.width), usize::from(inner.height), focused);
        frame.render_widget(Paragraph::new(lines).block(block), area);
    }
}

fn has_drape(state: &State) -> bool {
    worn(state).is_none_or(|worn| !worn.sizes.is_empty())
}

fn beside(area: Rect) -> [Rect; 2] {
    Layout::horizontal([Constraint::Length(CARD.min(area.width - SECTION)), Constraint::Fill(1)]).areas(area)
}

fn alteration_panes(area: Rect, state: &State) -> (Rect, Option<Rect>) {
    if area.width < WIDE || !has_drape(state) {
        return (area, None);
    }
    let [left, right] = beside(area);
    (left, Some(right))
}

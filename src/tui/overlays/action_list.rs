//! The list of actions that what is typed narrows: help and palette.

use crossterm::event::{KeyCode, KeyEvent};
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span};
use ratatui::widgets::{Clear, Paragraph};

use crate::keys::binding::{Binding, search};
use crate::keys::screen::Screen;
use crate::overlays::things::Thing;
use crate::widgets::layout::middle;
use crate::widgets::lists::{first_shown, pane};
use crate::widgets::text::{self, left};
use crate::widgets::theme::Theme;
use crate::widgets::typing::edit;

/// A row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Row<'a> {
    /// An action.
    Action(&'static Binding),
    /// Something to go to.
    Thing(&'a Thing),
}

/// A list that what is typed narrows.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct List {
    /// The actions.
    pub bindings: &'static [Binding],
    /// What can be gone to.
    pub things: Vec<Thing>,
    /// What is typed.
    pub text: String,
    /// Row selected.
    pub row: usize,
}

impl List {
    /// All of a table of keys.
    #[must_use]
    pub fn of(bindings: &'static [Binding]) -> Self {
        Self { bindings, things: vec![], text: String::new(), row: 0 }
    }

    /// The same with what can be gone to.
    #[must_use]
    pub fn and(self, things: Vec<Thing>) -> Self {
        Self { things, ..self }
    }

    /// Its rows: the keys in the order of the table where nothing is typed; otherwise actions whose names begin with it, what has such a
    /// name, and actions that have it anywhere.
    #[must_use]
    pub fn rows(&self) -> Vec<Row<'_>> {
        let text = self.text.trim();
        if text.is_empty() {
            return self.bindings.iter().map(Row::Action).collect();
        }
        let begins = |binding: &&Binding| binding.name.starts_with(&text.to_lowercase());
        let (named, others): (Vec<_>, Vec<_>) = search(self.bindings, text).into_iter().partition(begins);
        let mut things: Vec<(usize, &Thing)> =
            self.things.iter().filter_map(|thing| Some((thing.distance(text)?, thing))).collect();
        things.sort_by_key(|(distance, _)| *distance);
        let things = things.into_iter().map(|(_, thing)| Row::Thing(thing));
        named.into_iter().map(Row::Action).chain(things).chain(others.into_iter().map(Row::Action)).collect()
    }

    /// Edits what is typed, or goes through the rows.
    pub fn edit(&mut self, event: &KeyEvent) {
        match event.code {
            KeyCode::Up => self.row = self.row.saturating_sub(1),
            KeyCode::Down => self.row += 1,
            KeyCode::PageUp => self.row = self.row.saturating_sub(10),
            KeyCode::PageDown => self.row += 10,
            _ => {
                if edit(&mut self.text, event) {
                    self.row = 0;
                }
            }
        }
        self.row = self.row.min(self.rows().len().saturating_sub(1));
    }
}

/// Draws it over a screen.
pub fn draw(frame: &mut Frame<'_>, area: Rect, title: &str, list: &List, theme: Theme, screen: Screen) {
    let rows = list.rows();
    let height = (rows.len() as u16 + 2).max(3).min(area.height);
    let place = middle(area, area.width.min(100), height);
    let place_of_keys = " other keys: toile/keys.toml in the config folder, like cancel = \"D\" ";
    let block = pane(theme, title, true).title_bottom(Line::styled(place_of_keys, theme.legend()));
    let inner = block.inner(place);
    let first = first_shown(list.row, rows.len(), usize::from(inner.height));
    let line = |(k, row): (usize, &Row<'_>)| {
        let line = line(list, theme, screen, *row, usize::from(inner.width));
        if k == list.row { line.patch_style(theme.selected()) } else { line }
    };
    let mut lines: Vec<Line<'_>> =
        rows.iter().enumerate().skip(first).take(usize::from(inner.height)).map(line).collect();
    if lines.is_empty() {
        lines.push(Line::raw("nothing of that name or key"));
    }
    frame.render_widget(Clear, place);
    frame.render_widget(Paragraph::new(lines).block(block), place);
}

/// Keys, name and help of an action, dim where it does nothing on this screen; or what something is, and its name.
fn line(list: &List, theme: Theme, screen: Screen, row: Row<'_>, columns: usize) -> Line<'static> {
    let longest = |field: fn(&Binding) -> usize| list.bindings.iter().map(field).max().unwrap_or(0);
    let keys = longest(|b| text::width(&b.keys_text())) + 1;
    let name = longest(|b| b.name.len()) + 1;
    let binding = match row {
        Row::Action(binding) => binding,
        Row::Thing(thing) => {
            let (what, name) = thing.words();
            let name = text::shortened(&name, columns.saturating_sub(keys));
            return Line::from(vec![Span::styled(left(what, keys), theme.good()), Span::raw(name)]);
        }
    };
    let help = text::shortened(binding.help, columns.saturating_sub(keys + name));
    let line = Line::from(vec![
        Span::styled(left(&binding.keys_text(), keys), theme.bold()),
        Span::raw(left(binding.name, name)),
        Span::raw(help),
    ]);
    if binding.is_on(screen) { line } else { line.patch_style(theme.dim()) }
}

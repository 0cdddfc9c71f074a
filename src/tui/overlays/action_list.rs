//! The list of actions, narrowed by a text: for help and palette.

use crossterm::event::KeyEvent;
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
use crate::widgets::typing::in_list;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Row<'a> {
    Action(&'static Binding),
    Thing(&'a Thing),
}

/// Most lines of the list. A typed letter may change all of them, and a frame should stay small.
const MOST: u16 = 40;

/// Screens on which an action can be done, in the order in which the list has them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Reach {
    /// On the present screen, but not on all.
    Here,
    Everywhere,
    Elsewhere,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct List {
    pub bindings: &'static [Binding],
    pub screen: Screen,
    pub things: Vec<Thing>,
    pub text: String,
    /// Index among the rows shown.
    pub row: usize,
}

impl List {
    pub fn of(bindings: &'static [Binding], screen: Screen) -> Self {
        Self { bindings, screen, things: vec![], text: String::new(), row: 0 }
    }

    pub fn and(self, things: Vec<Thing>) -> Self {
        Self { things, ..self }
    }

    /// Rows that are shown. Without a text: actions in the order of the table, first those of the screen, then those of
    /// all screens, then others. With a text: actions of whose names a word begins with it, then studies and entries
    /// whose names match, then actions that contain it.
    pub fn rows(&self) -> Vec<Row<'_>> {
        let text = self.text.trim();
        if text.is_empty() {
            let mut rows: Vec<&Binding> = self.bindings.iter().collect();
            rows.sort_by_key(|binding| self.reach(binding));
            return rows.into_iter().map(Row::Action).collect();
        }
        let typed = text.to_lowercase();
        let begins = |binding: &&Binding| {
            binding.name.starts_with(&typed) || binding.name.split('-').any(|word| word.starts_with(&typed))
        };
        let (named, others): (Vec<_>, Vec<_>) = search(self.bindings, text).into_iter().partition(begins);
        let mut things: Vec<(usize, &Thing)> =
            self.things.iter().filter_map(|thing| Some((thing.distance(text)?, thing))).collect();
        things.sort_by_key(|(distance, _)| *distance);
        let things = things.into_iter().map(|(_, thing)| Row::Thing(thing));
        named.into_iter().map(Row::Action).chain(things).chain(others.into_iter().map(Row::Action)).collect()
    }

    fn reach(&self, binding: &Binding) -> Reach {
        match binding.is_on(self.screen) {
            true if binding.screens.is_empty() => Reach::Everywhere,
            true => Reach::Here,
            false => Reach::Elsewhere,
        }
    }

    /// Heading above a row: above the first of each group while no text is typed.
    fn heading(&self, rows: &[Row<'_>], k: usize) -> Option<String> {
        let reach = |row: &Row<'_>| match row {
            Row::Action(binding) => Some(self.reach(binding)),
            Row::Thing(_) => None,
        };
        let own = reach(&rows[k]).filter(|_| self.text.trim().is_empty())?;
        let is_first = k == 0 || reach(&rows[k - 1]) != Some(own);
        is_first.then(|| match own {
            Reach::Here => format!("on this screen, {}", self.screen.names()[0]),
            Reach::Everywhere => "everywhere".to_owned(),
            Reach::Elsewhere => "on other screens".to_owned(),
        })
    }

    pub fn edit(&mut self, event: &KeyEvent) {
        let rows = self.rows().len();
        in_list(&mut self.text, &mut self.row, rows, event);
        self.row = self.row.min(self.rows().len().saturating_sub(1));
    }
}

pub fn draw(frame: &mut Frame<'_>, area: Rect, title: &str, list: &List, theme: Theme) {
    let rows = list.rows();
    // Lines: index of a row and its text, or a heading, which has no row.
    let all: Vec<(Option<usize>, String)> = (0..rows.len())
        .flat_map(|k| list.heading(&rows, k).map(|text| (None, text)).into_iter().chain([(Some(k), String::new())]))
        .collect();
    let height = (all.len() as u16 + 2).clamp(3, MOST).min(area.height);
    let place = middle(area, area.width.min(100), height);
    let place_of_keys = " other keys: toile/keys.toml in the config folder, like cancel = \"D\" ";
    let block = pane(theme, title, true).title_bottom(Line::styled(place_of_keys, theme.legend()));
    let inner = block.inner(place);
    let at = all.iter().position(|(row, _)| *row == Some(list.row)).unwrap_or(0);
    let first = first_shown(at, all.len(), usize::from(inner.height));
    let line = |(row, heading): &(Option<usize>, String)| match row {
        None => Line::styled(heading.clone(), theme.busy().patch(theme.bold())),
        Some(k) => {
            let line = line(list, theme, rows[*k], usize::from(inner.width));
            if *k == list.row { line.patch_style(theme.selected()) } else { line }
        }
    };
    let mut lines: Vec<Line<'_>> = all.iter().skip(first).take(usize::from(inner.height)).map(line).collect();
    if lines.is_empty() {
        lines.push(Line::raw("nothing of that name or key"));
    }
    frame.render_widget(Clear, place);
    frame.render_widget(Paragraph::new(lines).block(block), place);
}

/// Line of an action: keys, name and help, dim where it does nothing on this screen. Line of another row: kind and
/// name.
fn line(list: &List, theme: Theme, row: Row<'_>, columns: usize) -> Line<'static> {
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
    if binding.is_on(list.screen) { line } else { line.patch_style(theme.dim()) }
}

//! Explanation of the numbers on a screen: first those selected, then its other headings, then the whole glossary.

use crossterm::event::KeyEvent;
use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::style::Style;
use ratatui::text::Line;
use ratatui::widgets::{Clear, Paragraph};

use crate::glossary::{TERMS, Term, term};
use crate::widgets::layout::{is_narrow, middle};
use crate::widgets::lists::{listed, pane};
use crate::widgets::text::{shortened, wrapped};
use crate::widgets::theme::Theme;
use crate::widgets::typing::in_list;

/// Columns for names beside the texts.
const NAMES: u16 = 26;
/// Lines for names above the texts, where they do not fit beside.
const FEW: u16 = 4;

/// The selection of a screen, with the names of its quantities.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Selected {
    /// Description of the selection with its numbers; empty where nothing is selected.
    pub what: String,
    /// Names in the glossary, most relevant to the selection first. Names that the glossary lacks are left out.
    pub names: Vec<String>,
}

impl Selected {
    pub fn new(what: String, names: &[&str], headings: &[&str]) -> Self {
        Self { what, names: names.iter().chain(headings).map(|name| (*name).to_owned()).collect() }
    }
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Explanation {
    what: String,
    terms: Vec<&'static Term>,
    text: String,
    row: usize,
}

impl Explanation {
    /// Puts the terms of the selection first.
    pub fn of(selected: Selected) -> Self {
        let mut terms: Vec<&Term> = vec![];
        for next in selected.names.iter().filter_map(|name| term(name)).chain(TERMS.iter()) {
            if !terms.contains(&next) {
                terms.push(next);
            }
        }
        Self { what: selected.what, terms, text: String::new(), row: 0 }
    }

    /// Terms that contain the text; a term with that name comes first.
    fn rows(&self) -> Vec<&'static Term> {
        let text = self.text.trim().to_lowercase();
        let mut rows: Vec<&Term> = self.terms.iter().copied().filter(|term| term.contains(&text)).collect();
        rows.sort_by_key(|term| !text.is_empty() && !term.names.iter().any(|name| name.to_lowercase() == text));
        rows
    }

    pub fn key(&mut self, event: &KeyEvent) {
        let rows = self.rows().len();
        in_list(&mut self.text, &mut self.row, rows, event);
        self.row = self.row.min(self.rows().len().saturating_sub(1));
    }
}

pub fn draw(frame: &mut Frame<'_>, area: Rect, explanation: &Explanation, theme: Theme) {
    let place = middle(area, area.width.min(100), area.height.min(24));
    let title = format!("what is this: /{}▏", explanation.text);
    let block =
        pane(theme, title, true).title_bottom(Line::styled(" ↑↓ choose  type to search  Esc closes ", theme.legend()));
    let inner = block.inner(place);
    frame.render_widget(Clear, place);
    frame.render_widget(block, place);
    let head = u16::from(!explanation.what.is_empty());
    let [top, below] = Layout::vertical([Constraint::Length(head), Constraint::Fill(1)]).areas(inner);
    let what = shortened(&explanation.what, usize::from(top.width));
    frame.render_widget(Line::styled(what, theme.bold()), top);
    let parts = [Constraint::Length(if is_narrow(area) { FEW } else { NAMES }), Constraint::Fill(1)];
    let [list, words] =
        if is_narrow(area) { Layout::vertical(parts) } else { Layout::horizontal(parts).spacing(1) }.areas(below);
    let rows = explanation.rows();
    let names = listed(&rows, explanation.row, usize::from(list.height), theme.selected(), |term| {
        Line::raw(shortened(&format!(" {} ", term.name()), usize::from(list.width)))
    });
    frame.render_widget(Paragraph::new(names), list);
    let told = rows
        .get(explanation.row)
        .map_or_else(|| vec![Line::raw("nothing of that name")], |term| told(term, theme, usize::from(words.width)));
    frame.render_widget(Paragraph::new(told), words);
}

fn told(term: &Term, theme: Theme, columns: usize) -> Vec<Line<'static>> {
    let unit = match term.unit.as_str() {
        "" => String::new(),
        "1" => ", a number without unit".to_owned(),
        unit => format!(", in {unit}"),
    };
    let also = term.names[1..].join(", ");
    let parts = [
        (format!("{}{unit}", term.name()), theme.bold()),
        (term.about.clone(), Style::new()),
        (labelled("good or bad: ", &term.good), theme.good()),
        (labelled("also: ", &also), theme.dim()),
        (labelled("more: ", &term.more), theme.dim()),
    ];
    let lines =
        |(text, style): (String, Style)| wrapped(&text, columns).into_iter().map(move |line| Line::styled(line, style));
    parts.into_iter().filter(|(text, _)| !text.is_empty()).flat_map(lines).collect()
}

/// Text below its heading; empty for an empty text.
fn labelled(name: &str, text: &str) -> String {
    if text.is_empty() { String::new() } else { format!("{name}{text}") }
}

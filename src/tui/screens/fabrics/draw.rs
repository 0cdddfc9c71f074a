//! Drawing the fabrics.

use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::symbols::Marker;
use ratatui::text::{Line, Span};
use ratatui::widgets::{Axis, Chart, Dataset, GraphType, Paragraph};

use crate::overlays::entry_form::{fabric_label, unit_of};
use crate::overlays::explanation::Selected;
use crate::screens::fabrics::actions::{in_four, marks, number};
use crate::screens::fabrics::state::{FABRIC_SHOWN, FabricOrder, FabricsScreen};
use crate::screens::page::Draw;
use crate::screens::state::State;
use crate::widgets::jump::{self, Target};
use crate::widgets::layout::{WIDE, is_narrow};
use crate::widgets::lists::{listed, pane, scrolled};
use crate::widgets::text::{self, left, place_bar, right, shortened, wrapped};
use spec::FABRIC_NUMBERS;
use wardrobe::FabricRow;

/// Columns of numbers in the list: heading and width.
const HEADINGS: [(&str, usize); FABRIC_SHOWN.len()] =
    [("g/m²", 6), ("mm", 6), ("warp", 7), ("weft", 7), ("shear", 7), ("b.warp", 7), ("b.weft", 7)];

/// Columns for marks after a name, and fewest for a name.
const MARKS: usize = 5;
const LEAST_NAME: usize = 14;
/// Columns of quantities that follow from the numbers, where they fit: heading and width.
const FOLLOWS: [(&str, usize); 2] = [("bends mm", 12), ("of weight", 11)];
const LEGEND: &str = "warp weft shear N/m, bending µN m  + own  s stiffens  c coupled  ~ class";

/// Number of lines in the table of a fabric: its numbers, and two bending lengths.
pub fn table_lines() -> usize {
    FABRIC_NUMBERS.len() + 2
}

/// Columns for a value in the table.
const VALUE: usize = 10;
/// Lines of the pane with the source, without its curves.
const FACTS: u16 = 8;
/// Most columns of the bar that shows the rank of a number among all fabrics.
const BAR: usize = 12;
/// Greatest stretch on the curves of a woven; and, for a knit, the factor on the stretch that its law reaches.
const WOVEN: f64 = 0.05;
const BEYOND: f64 = 1.25;

/// The panes: list, table of the selected fabric, source with curves.
fn panes(area: Rect) -> [Rect; 3] {
    let lines = (table_lines() + 3) as u16;
    let below = lines.min(area.height.saturating_sub(10)).max(area.height / 2);
    let [list, below] = Layout::vertical([Constraint::Fill(1), Constraint::Length(below)]).areas(area);
    let table = if area.width >= WIDE { area.width / 2 } else { area.width * 3 / 5 };
    let [table, facts] = Layout::horizontal([Constraint::Length(table), Constraint::Fill(1)]).areas(below);
    [list, table, facts]
}

pub fn table_rows(area: Rect) -> usize {
    usize::from(panes(area)[1].height).saturating_sub(3)
}

impl Draw for FabricsScreen {
    fn draw(&self, frame: &mut Frame<'_>, area: Rect, state: &State) {
        if is_narrow(area) {
            frame.render_widget(Paragraph::new(self.list(state, area.width, area.height, true)), area);
            return;
        }
        let [list_area, table_area, facts_area] = panes(area);
        let (shown, all) = (self.shown(state).len(), state.data.as_ref().map_or(0, |data| data.fabrics.len()));
        let title = if shown == all { format!("{all} fabrics") } else { format!("{shown} of {all} fabrics") };
        let focused = !state.in_second_pane();
        let block = pane(state.theme, title, focused);
        let block = block.title_bottom(Line::styled(LEGEND, state.theme.legend()).right_aligned());
        let inner = block.inner(list_area);
        frame.render_widget(
            Paragraph::new(self.list(state, inner.width, inner.height, focused)).block(block),
            list_area,
        );
        let fabric = self.selected(state);
        let name = fabric.map_or(String::new(), |row| row.fabric.name.clone());
        let title = fabric.map_or(String::new(), |row| format!("{name} · revision {}", row.revision));
        let block = pane(state.theme, title, !focused);
        let inner = block.inner(table_area);
        let lines = fabric.map_or_else(Vec::new, |row| table(state, row, usize::from(inner.width)));
        let lines = scrolled(lines, state.nav.table_down, inner);
        frame.render_widget(Paragraph::new(lines).block(block), table_area);
        draw_facts(frame, facts_area, state, fabric);
    }

    fn targets(&self, state: &State, area: Rect) -> Vec<Target> {
        let fabrics = self.shown(state);
        let at = self.index_in(&fabrics);
        if is_narrow(area) {
            return jump::rows(0, area, 1, fabrics.len(), at);
        }
        let [list, table, _] = panes(area);
        let mut targets = jump::rows(0, jump::inside(list), 1, fabrics.len(), at);
        targets.push(jump::pane(table, 1));
        targets
    }

    fn explained(&self, state: &State) -> Selected {
        let Some(row) = self.selected(state) else { return Selected::default() };
        let bends = row.fabric.bending_lengths_m().map(text::mm).join(" and ");
        let what = format!("{}: {:.0} g/m², bends at {bends} mm", row.fabric.name, row.fabric.density_kg_m2 * 1e3);
        let sorted = match self.order.by {
            FabricOrder::Name => "fabric",
            FabricOrder::Number(k) => fabric_label(FABRIC_SHOWN[k]),
        };
        let headings = FABRIC_SHOWN.into_iter().map(fabric_label).chain(FOLLOWS.iter().map(|(title, _)| *title));
        let numbers = (0..FABRIC_NUMBERS.len()).map(fabric_label);
        let names: Vec<&str> = headings.chain(numbers).chain(["fabric", "value", "among"]).collect();
        Selected::new(what, &[sorted], &names)
    }
}

impl FabricsScreen {
    /// List with its header; the name takes what the numbers leave.
    fn list(&self, state: &State, width: u16, height: u16, focused: bool) -> Vec<Line<'static>> {
        let fabrics = self.shown(state);
        let width = usize::from(width);
        let numbers = |shown: usize| HEADINGS.iter().take(shown).map(|(_, columns)| columns).sum::<usize>();
        let shown = (0..=HEADINGS.len()).rev().find(|n| LEAST_NAME + MARKS + numbers(*n) <= width).unwrap_or(0);
        let longest = fabrics.iter().map(|row| text::width(&row.fabric.name)).max().unwrap_or(0);
        let name = width.saturating_sub(MARKS + numbers(shown)).min(longest.max(LEAST_NAME));
        let at = self.index_in(&fabrics);
        let left_over = width.saturating_sub(name + MARKS + numbers(HEADINGS.len()));
        let follows = FOLLOWS.iter().map(|(_, columns)| columns).sum::<usize>() <= left_over;
        let mut head = self.header(name, shown);
        if follows {
            head.extend(FOLLOWS.iter().map(|(title, columns)| right(title, *columns)));
        }
        let mut lines = vec![Line::styled(shortened(&head, width), state.theme.dim())];
        lines.extend(listed(
            &fabrics,
            at,
            usize::from(height).saturating_sub(1),
            state.theme.selection(focused),
            |row| {
                let tail = if follows { tail(row) } else { String::new() };
                let line = list_line(row, self.marks.has(&row.fabric.name), name, shown);
                Line::raw(shortened(&(line + &tail), width))
            },
        ));
        if fabrics.is_empty() {
            lines.push(Line::raw("no fabric matches the filter"));
        }
        lines
    }

    fn header(&self, name: usize, shown: usize) -> String {
        let mut text = left(&self.order.titled("fabric", FabricOrder::Name), name + MARKS);
        for (k, (title, columns)) in HEADINGS.iter().take(shown).enumerate() {
            text += &right(&self.order.titled(title, FabricOrder::Number(k)), *columns);
        }
        text
    }
}

fn list_line(row: &FabricRow, is_marked: bool, name: usize, shown: usize) -> String {
    let mark = if is_marked { "•" } else { " " };
    let mut text = format!("{}{mark}{}", left(&row.fabric.name, name), marks(row));
    for (k, (_, columns)) in HEADINGS.into_iter().enumerate().take(shown) {
        text += &right(&number(row, k), columns);
    }
    text
}

/// Quantities that follow from the numbers of a fabric, along and across the grain, or once where both are the same:
/// bending lengths, and their ranks among the known cloths of its weight.
fn tail(row: &FabricRow) -> String {
    let lengths = row.fabric.bending_lengths_m().map(text::mm);
    let ranks = row.fabric.standings().map(|standing| standing.to_string());
    let both = |[along, across]: [String; 2]| if along == across { along } else { format!("{along}/{across}") };
    [lengths, ranks].into_iter().zip(FOLLOWS).map(|(values, (_, columns))| right(&both(values), columns)).collect()
}

/// All numbers with units and their ranks in the catalogue; then the quantities that follow from them.
fn table(state: &State, row: &FabricRow, columns: usize) -> Vec<Line<'static>> {
    let all = state.data.as_ref().map_or(&[][..], |data| &data.fabrics);
    let label = columns.saturating_sub(VALUE + 7).min(34);
    let bar = columns.saturating_sub(label + VALUE + 7 + 1).min(BAR);
    let head = format!("{}{}  {}", left("", label), right("value", VALUE), left("unit", 5));
    let among = if bar >= 5 { format!(" among {}", all.len()) } else { String::new() };
    let mut lines = vec![Line::styled(shortened(&(head + &among), columns), state.theme.dim())];
    for (k, field) in FABRIC_NUMBERS.iter().enumerate() {
        let value = field.get(&row.fabric);
        let shown = value.map_or("—".to_owned(), text::exact);
        let text = format!("{}{}  {}", left(fabric_label(k), label), right(&shown, VALUE), left(unit_of(field.key), 5));
        let stands = value.and_then(|value| rank(value, all.iter().filter_map(|row| field.get(&row.fabric))));
        let place = stands.map_or(String::new(), |share| place_bar(share, bar));
        lines.push(Line::from(vec![Span::raw(text), Span::styled(format!(" {place}"), state.theme.dim())]));
    }
    let bends = row.fabric.bending_lengths_m().into_iter().zip(row.fabric.standings());
    for (name, (length, standing)) in ["along", "across"].into_iter().zip(bends) {
        let name = format!("bending length {name} the grain");
        let text = format!("{}{}  {}", left(&name, label), right(&text::mm(length), VALUE), left("mm", 5));
        let among = if bar >= BAR { format!(" {standing} of its weight") } else { format!(" {standing}") };
        lines.push(Line::styled(shortened(&(text + &among), columns), state.theme.dim()));
    }
    lines
}

/// Share of other values that are less than a value, %; `None` where all are the same.
fn rank(value: f64, all: impl Iterator<Item = f64>) -> Option<f64> {
    let (mut below, mut above) = (0, 0);
    for other in all {
        below += usize::from(other < value);
        above += usize::from(other > value);
    }
    (below + above > 0).then(|| 100.0 * below as f64 / (below + above) as f64)
}

/// Draws source and users of the fabric and, where they fit, its curves of force against stretch.
fn draw_facts(frame: &mut Frame<'_>, area: Rect, state: &State, fabric: Option<&FabricRow>) {
    let block = pane(state.theme, "source", false);
    let inner = block.inner(area);
    frame.render_widget(block, area);
    let Some(row) = fabric else { return };
    let columns = usize::from(inner.width);
    let origin = if row.is_own { "your own: added or changed here" } else { "of the library" };
    let used = match row.jobs {
        0 => "no job uses it".to_owned(),
        1 => "1 job uses it".to_owned(),
        n => format!("{n} jobs use it"),
    };
    let mut lines = vec![Line::styled(shortened(&format!("{origin}; {used}"), columns), state.theme.bold())];
    lines.extend(row.stands_for().into_iter().flat_map(|text| wrapped(&text, columns)).map(Line::raw));
    // Where the whole table fits, it has the bending lengths.
    if usize::from(area.height) < table_lines() + 3 {
        let [along, across] = row.fabric.bending_lengths_m().map(text::mm);
        let [rank_along, rank_across] = row.fabric.standings();
        let bends = format!("bends at {along} mm, {rank_along}; across {across} mm, {rank_across} of its weight");
        lines.extend(wrapped(&bends, columns).into_iter().map(|line| Line::styled(line, state.theme.dim())));
    }
    lines.extend(wrapped(&row.fabric.source, columns).into_iter().map(Line::raw));
    let height = (lines.len() as u16).max(FACTS).min(inner.height);
    let [words, curves] = Layout::vertical([Constraint::Length(height), Constraint::Fill(1)]).areas(inner);
    frame.render_widget(Paragraph::new(lines), words);
    if curves.height >= 9 && curves.width >= 30 {
        draw_curves(frame, curves, state, row);
    }
}

/// Draws force per width against stretch, for strips along and across the grain.
fn draw_curves(frame: &mut Frame<'_>, area: Rect, state: &State, row: &FabricRow) {
    const POINTS: usize = 40;
    let most = row.fabric.stretched.map_or(WOVEN, |law| law.stretch * BEYOND);
    let stretch_at = |k: usize| most * k as f64 / POINTS as f64;
    let curve = |side: usize| -> Vec<(f64, f64)> {
        (0..=POINTS).map(|k| (100.0 * stretch_at(k), row.tensions_n_m(stretch_at(k))[side])).collect()
    };
    let (warp, weft) = (curve(0), curve(1));
    let top = warp.iter().chain(&weft).map(|(_, force)| *force).fold(0.0, f64::max);
    let along = Dataset::default().marker(Marker::Braille).graph_type(GraphType::Line).style(state.theme.good());
    let across = Dataset::default().marker(Marker::Dot).graph_type(GraphType::Scatter).style(state.theme.warn());
    let labels = |top: f64, unit: &str| vec![Line::raw("0"), Line::raw(format!("{} {unit}", in_four(top)))];
    let chart = Chart::new(vec![along.data(&warp), across.data(&weft)]);
    let x = Axis::default().bounds([0.0, 100.0 * most]).labels(labels(100.0 * most, "%")).title("stretch");
    let y = Axis::default().bounds([0.0, top]).labels(labels(top, "N/m"));
    let (x, y) = (x.style(state.theme.dim()), y.style(state.theme.dim()));
    let [caption, area] = Layout::vertical([Constraint::Length(1), Constraint::Fill(1)]).areas(area);
    let words = "force per width: a line along the grain, dots across it";
    frame.render_widget(Line::styled(shortened(words, usize::from(area.width)), state.theme.dim()), caption);
    frame.render_widget(chart.x_axis(x).y_axis(y), area);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranks_are_shares_of_the_others() {
        let check = |value, expect| assert_eq!(rank(value, [1.0, 2.0, 2.0, 4.0].into_iter()), expect, "{value}");
        check(1.0, Some(0.0));
        check(2.0, Some(50.0));
        check(4.0, Some(100.0));
        assert_eq!(rank(3.0, [3.0, 3.0].into_iter()), None);
    }
}

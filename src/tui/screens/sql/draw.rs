//! Drawing a query and its answer.

use std::ops::Range;

use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::style::{Modifier, Style};
use ratatui::text::{Line, Span};
use ratatui::widgets::{Clear, Paragraph};

use crate::overlays::explanation::Selected;
use crate::screens::page::Draw;
use crate::screens::sql::actions::is_editing;
use crate::screens::sql::state::SqlScreen;
use crate::screens::state::State;
use crate::widgets::editor::{Mode, Offer};
use crate::widgets::jump::{self, Target};
use crate::widgets::layout::{WIDE, is_narrow};
use crate::widgets::lists::{first_shown, pane};
use crate::widgets::result_table::{Column, ResultTable, cell_text};
use crate::widgets::text::{self, left, right, shortened, wrapped};

const KEYWORDS: [&str; 34] = [
    "select", "from", "where", "join", "left", "using", "on", "group", "by", "order", "having", "limit", "as", "and",
    "or", "not", "in", "is", "null", "distinct", "case", "when", "then", "else", "end", "with", "union", "all", "desc",
    "asc", "like", "glob", "between", "over",
];

/// Most words offered at once.
const OFFERED: usize = 6;

/// Columns of the catalogue.
const CATALOGUE: u16 = 30;

struct Panes {
    editor: Rect,
    result: Rect,
    catalogue: Option<Rect>,
}

impl Draw for SqlScreen {
    fn draw(&self, frame: &mut Frame<'_>, area: Rect, state: &State) {
        let Panes { editor, result, catalogue } = self.panes(area, state);
        self.draw_result(frame, result, state, catalogue.is_none());
        if let Some(catalogue) = catalogue {
            self.draw_catalogue(frame, catalogue, state);
        }
        self.draw_editor(frame, editor, area, state);
    }

    fn targets(&self, state: &State, area: Rect) -> Vec<Target> {
        let Panes { editor, result, .. } = self.panes(area, state);
        let inner = jump::inside(result);
        let head = 1 + self.refusal(state, inner.width).len();
        let rows = self.table.as_ref().map_or(vec![], |table| jump::rows(1, inner, head, table.len(), table.row));
        rows.into_iter().chain([jump::pane(editor, 0)]).collect()
    }

    fn explained(&self, _state: &State) -> Selected {
        let Some(table) = &self.table else { return Selected::default() };
        let names: Vec<&str> = table.names().iter().map(String::as_str).collect();
        let Some(column) = names.get(table.column) else { return Selected::default() };
        let value = table.values(table.row).map_or(String::new(), |values| cell_text(&values[table.column]));
        Selected::new(format!("{column}: {value}"), &[column], &names)
    }
}

impl SqlScreen {
    /// Panes of editor and answer, and of the catalogue beside the answer: always where there is room, else while the
    /// query is typed. Before there is anything to stand beside, the answer's pane has all views with their columns.
    fn panes(&self, area: Rect, state: &State) -> Panes {
        let lines = editor_rows(self.editor.text(), jump::inside(area).width).len() as u16;
        let height = (lines + 2).clamp(if area.height < 16 { 3 } else { 6 }, (area.height / 2).max(3));
        let [editor, below] = Layout::vertical([Constraint::Length(height), Constraint::Fill(1)]).areas(area);
        let is_bare = self.table.is_none() && self.named().is_empty();
        if is_bare || is_narrow(area) || area.width < WIDE && !is_editing(state) {
            return Panes { editor, result: below, catalogue: None };
        }
        let [result, catalogue] = Layout::horizontal([Constraint::Fill(1), Constraint::Length(CATALOGUE)]).areas(below);
        Panes { editor, result, catalogue: Some(catalogue) }
    }

    /// Draws the columns of the relations that the query names; where it names none, the views.
    fn draw_catalogue(&self, frame: &mut Frame<'_>, area: Rect, state: &State) {
        let named = self.named();
        let title = if named.is_empty() { "views" } else { "columns" };
        let block = pane(state.theme, title, false);
        let inner = block.inner(area);
        let (width, room) = (usize::from(inner.width), usize::from(inner.height));
        let mut lines: Vec<Line<'_>> = vec![];
        for relation in &named {
            lines.push(Line::styled(shortened(&relation.name, width), state.theme.bold()));
            lines.extend(columns(&relation.columns, width).into_iter().map(Line::raw));
        }
        if named.is_empty() {
            let views = self.relations.iter().flatten().filter(|relation| relation.name.starts_with("v_"));
            lines.extend(views.map(|view| Line::raw(shortened(&view.name, width))));
        }
        if lines.len() > room {
            lines.truncate(room.saturating_sub(1));
            lines.push(Line::styled("… Tab completes all", state.theme.dim()));
        }
        frame.render_widget(Paragraph::new(lines).block(block), area);
    }

    fn draw_editor(&self, frame: &mut Frame<'_>, area: Rect, screen: Rect, state: &State) {
        let focused = is_editing(state);
        let keys = match self.editor.mode() {
            _ if !focused => ": e edits, F5 runs",
            None => ": F5 runs, Tab completes, Esc leaves",
            Some(Mode::Insert) => ", insert: F5 runs, Tab completes, Esc to normal mode",
            Some(Mode::Normal) => ", normal: F5 runs, i a o type, Esc leaves",
        };
        let which = match self.queries().texts.len() {
            0 | 1 => String::new(),
            n => format!(" {} of {n}", self.queries.at + 1),
        };
        let block = pane(state.theme, format!("query{which}{keys}"), focused);
        let inner = block.inner(area);
        let editor = &self.editor;
        let (line, column) = editor.place();
        let room = usize::from(inner.height);
        let rows = editor_rows(editor.text(), inner.width);
        let at = rows.iter().rposition(|row| row.line == line && row.letters.start <= column).unwrap_or(0);
        let first = first_shown(at, rows.len(), room);
        let texts: Vec<&str> = editor.text().split('\n').collect();
        let mut lines: Vec<Line<'_>> = (first..rows.len())
            .take(room)
            .map(|k| query_line(state, texts[rows[k].line], &rows[k].letters, (focused && k == at).then_some(column)))
            .collect();
        if editor.text().is_empty() {
            let hint = "SELECT study, garment, size, subject, simulator, ei FROM v_metrics ORDER BY ei DESC";
            let cursor = Span::styled(" ", if focused { state.theme.selected() } else { Style::new() });
            lines = vec![Line::from(vec![cursor, Span::styled(format!(" like {hint}"), state.theme.dim())])];
        }
        frame.render_widget(Paragraph::new(lines).block(block), area);
        if let Some(offer) = editor.offer().filter(|_| focused) {
            let from = rows.get(at).map_or(0, |row| row.letters.start);
            let x = inner.x + ((column.saturating_sub(from)) as u16).min(inner.width.saturating_sub(24));
            let y = inner.y + (at - first) as u16 + 1;
            draw_offer(frame, Rect::new(x, y, 24, OFFERED as u16).intersection(screen), offer, state);
        }
    }

    fn draw_result(&self, frame: &mut Frame<'_>, area: Rect, state: &State, has_names: bool) {
        let title = match (&self.running, &self.outcome) {
            (Some(_), _) => "asking… C-c cancels".to_owned(),
            (None, Some(Ok(told))) => told.clone(),
            (None, Some(Err(_))) => "the query was refused".to_owned(),
            (None, None) => "rows".to_owned(),
        };
        let legend = match &self.table {
            Some(table) if !table.names().is_empty() => {
                let row = if table.len() == 0 { 0 } else { table.row + 1 };
                format!(" row {row} of {}, column {} of {} ", table.len(), table.column + 1, table.names().len())
            }
            _ => " o saved queries  C-p history ".to_owned(),
        };
        let block = pane(state.theme, title, !is_editing(state))
            .title_bottom(Line::styled(legend, state.theme.legend()).right_aligned());
        let inner = block.inner(area);
        let mut lines = self.refusal(state, inner.width);
        let room = usize::from(inner.height).saturating_sub(lines.len());
        match &self.table {
            Some(table) if !table.names().is_empty() => {
                lines.extend(rows(state, table, usize::from(inner.width), room))
            }
            Some(_) => lines.push(Line::raw("nothing was asked")),
            None if lines.is_empty() && has_names => lines.extend(self.names(state, usize::from(inner.width))),
            None => {}
        }
        frame.render_widget(Paragraph::new(lines).block(block), area);
    }

    /// Returns no lines if the query was not refused.
    fn refusal(&self, state: &State, width: u16) -> Vec<Line<'static>> {
        let Some(Err(error)) = &self.outcome else { return vec![] };
        let wrapped = wrapped(error, usize::from(width).saturating_sub(2));
        wrapped.into_iter().map(|line| Line::styled(format!("✗ {line}"), state.theme.bad())).collect()
    }

    /// Names of the views, shown before the first query.
    fn names(&self, state: &State, width: usize) -> Vec<Line<'static>> {
        let relations = self.relations.as_deref().unwrap_or_default();
        let views = relations.iter().filter(|relation| relation.name.starts_with("v_"));
        let longest = relations.iter().map(|relation| text::width(&relation.name)).max().unwrap_or(0) + 2;
        let line = |relation: &store::Relation| {
            let columns = shortened(&relation.columns.join(", "), width.saturating_sub(longest));
            let name = Span::styled(left(&relation.name, longest), state.theme.bold());
            Line::from(vec![name, Span::styled(columns, state.theme.dim())])
        };
        views.map(line).collect()
    }
}

fn columns(names: &[String], width: usize) -> Vec<String> {
    let widest = names.iter().map(|name| text::width(name)).max().unwrap_or(0) + 1;
    let across = (width.saturating_sub(1) / widest).max(1);
    let line = |names: &[String]| names.iter().map(|name| left(name, widest)).collect::<String>();
    names.chunks(across).map(|names| shortened(format!(" {}", line(names)).trim_end(), width)).collect()
}

/// A row of the editor: a line of the query, or the part of a long one that fits.
#[derive(Clone, Debug, PartialEq, Eq)]
struct EditorRow {
    line: usize,
    letters: Range<usize>,
}

/// Rows of a query in some columns, of which the last is for the cursor. Long lines break after a space, if one is there.
fn editor_rows(text: &str, columns: u16) -> Vec<EditorRow> {
    let room = usize::from(columns.saturating_sub(1)).max(1);
    let mut rows = vec![];
    for (line, text) in text.split('\n').enumerate() {
        let letters: Vec<char> = text.chars().collect();
        let mut from = 0;
        while letters.len() - from > room {
            let space = (from + 1..=from + room).rev().find(|end| letters[end - 1] == ' ');
            let end = space.unwrap_or(from + room);
            rows.push(EditorRow { line, letters: from..end });
            from = end;
        }
        // The cursor may stand after the last letter.
        rows.push(EditorRow { line, letters: from..letters.len() + 1 });
    }
    rows
}

fn query_line(state: &State, text: &str, shown: &Range<usize>, cursor: Option<usize>) -> Line<'static> {
    let letters: Vec<char> = text.chars().chain(cursor.map(|_| ' ')).collect();
    let is_comment = text.trim_start().starts_with("--");
    let mut spans: Vec<Span<'static>> = vec![];
    let mut k = 0;
    while k < letters.len() {
        let is_word = |c: char| c.is_alphanumeric() || c == '_';
        let end = (k..letters.len()).find(|j| is_word(letters[*j]) != is_word(letters[k])).unwrap_or(letters.len());
        let word: String = letters[k..end].iter().collect();
        let style = match () {
            () if is_comment => state.theme.dim(),
            () if KEYWORDS.contains(&word.to_lowercase().as_str()) => state.theme.bold(),
            () => Style::new(),
        };
        for (at, letter) in (k..end).zip(word.chars()) {
            let style = if cursor == Some(at) { style.patch(state.theme.selected()) } else { style };
            match spans.last_mut().filter(|last| at > shown.start && last.style == style) {
                _ if at >= shown.end => {}
                Some(last) => last.content.to_mut().push(letter),
                None if at >= shown.start => spans.push(Span::styled(letter.to_string(), style)),
                None => {}
            }
        }
        k = end;
    }
    Line::from(spans)
}

fn draw_offer(frame: &mut Frame<'_>, area: Rect, offer: &Offer, state: &State) {
    let taken = offer.taken.unwrap_or(0);
    let first = first_shown(taken, offer.words.len(), OFFERED);
    let shown: Vec<&String> = offer.words.iter().skip(first).take(OFFERED).collect();
    let width = shown.iter().map(|word| text::width(word)).max().unwrap_or(0).min(22) + 2;
    let place = Rect::new(area.x, area.y, width as u16, shown.len() as u16).intersection(area);
    let line = |(k, word): (usize, &&String)| {
        let is_taken = offer.taken == Some(first + k);
        let style =
            if is_taken { state.theme.selected() } else { state.theme.busy().add_modifier(Modifier::UNDERLINED) };
        Line::styled(format!(" {} ", left(word, width - 2)), style)
    };
    frame.render_widget(Clear, place);
    frame.render_widget(Paragraph::new(shown.iter().enumerate().map(line).collect::<Vec<_>>()), place);
}

/// Header, and the rows around the selected one.
pub fn rows(state: &State, table: &ResultTable, width: usize, height: usize) -> Vec<Line<'static>> {
    let shown = table.columns_shown(width);
    let head = |k: usize| {
        let mark = match table.order {
            Some((by, true)) if by == k => "▼",
            Some((by, false)) if by == k => "▲",
            _ => "",
        };
        let Column { width: room, is_number } = table.column_of(k);
        let name = format!("{}{mark}", shortened(&table.names()[k], room - text::width(mark)));
        if is_number { right(&name, room) } else { left(&name, room) }
    };
    let mut spans = vec![];
    let mut used = 0;
    for (n, &k) in shown.iter().enumerate() {
        let gap = gap(n, k);
        let style = if k == table.column { state.theme.bold() } else { state.theme.dim() };
        spans.push(Span::styled(gap, state.theme.dim()));
        let name = head(k);
        used += text::width(&name) + gap.chars().count();
        spans.push(Span::styled(name, style));
    }
    if shown.last().is_some_and(|last| last + 1 < table.names().len()) && used < width {
        spans.push(Span::styled("▸", state.theme.dim()));
    }
    let mut lines = vec![Line::from(spans)];
    let room = height.saturating_sub(1);
    let first = first_shown(table.row, table.len(), room);
    for row in (first..table.len()).take(room) {
        lines.push(row_line(state, table, row, &shown));
    }
    if table.len() == 0 {
        let none = if state.filter().is_empty() { "no rows" } else { "no row matches the filter" };
        lines.push(Line::styled(none, state.theme.dim()));
    }
    lines
}

/// Gap before a column. The first column stays in place; a line follows it while others are scrolled away.
fn gap(place: usize, column: usize) -> &'static str {
    match place {
        0 => "",
        1 if column > 1 => "┊ ",
        _ => "  ",
    }
}

fn row_line(state: &State, table: &ResultTable, row: usize, shown: &[usize]) -> Line<'static> {
    let Some(values) = table.values(row) else { return Line::default() };
    let is_selected = row == table.row;
    let selection = state.theme.selection(!is_editing(state));
    let mut spans = vec![];
    for (n, &k) in shown.iter().enumerate() {
        let Column { width: room, is_number } = table.column_of(k);
        let cell = cell_text(&values[k]);
        let cell = if is_number { right(&cell, room) } else { left(&cell, room) };
        let gap = gap(n, k);
        let style = match (is_selected, k == table.column) {
            (true, true) => selection.add_modifier(Modifier::BOLD | Modifier::UNDERLINED),
            (true, false) => selection,
            (false, _) => Style::new(),
        };
        spans.push(Span::styled(gap, if is_selected { selection } else { state.theme.dim() }));
        spans.push(Span::styled(cell, style));
    }
    Line::from(spans)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_lines_of_a_query_break_after_spaces() {
        let check = |text: &str, columns: u16, expect: &[&str]| {
            let lines: Vec<Vec<char>> = text.split('\n').map(|line| line.chars().collect()).collect();
            let shown = |row: &EditorRow| lines[row.line][row.letters.start..].iter().take(row.letters.len()).collect();
            let rows: Vec<String> = editor_rows(text, columns).iter().map(shown).collect();
            assert_eq!(rows, expect, "{text} in {columns}");
        };
        check("select 1", 20, &["select 1"]);
        check("select ei from v_metrics", 12, &["select ei ", "from ", "v_metrics"]);
        check("a\n\nselect ei", 8, &["a", "", "select ", "ei"]);
        check("abcdefghij", 5, &["abcd", "efgh", "ij"]);
        check("", 5, &[""]);
    }
}

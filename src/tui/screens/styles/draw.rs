//! Drawing the list of sizes and the table of the selected one.

use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::style::Style;
use ratatui::text::Line;
use ratatui::widgets::{Block, Paragraph};

use crate::messages::seams::SizeLayout;
use crate::overlays::explanation::Selected;
use crate::screens::page::Draw;
use crate::screens::picture_pane::actions::requests;
use crate::screens::state::State;
use crate::screens::styles::actions::{outfit_lines, outfit_marks, revisions};
use crate::screens::styles::pieces;
use crate::screens::styles::state::{EdgeAt, StylesScreen, TableLine, letter, short_name};
use crate::widgets::jump::{self, Goal, Target};
use crate::widgets::layout::{WIDE, is_narrow};
use crate::widgets::lists::{first_shown, listed, no_rows, pane, selected_line};
use crate::widgets::picture::PictureRequest;
use crate::widgets::text::{self, left, right, shortened, whole, width, wrapped};
use wardrobe::SizeRow;
use wardrobe::seams::{Desk, DeskSeam};

/// Least columns of a small terminal for the pieces to stand beside the table.
const BESIDE: u16 = 56;

/// Names of the quantities on the screen, as in the glossary.
pub const HEADINGS: [&str; 8] = ["seam", "a mm", "ease", "ratio", "sure", "rev", "pattern", "measurement"];

/// Least columns of a table with names of seams and both lengths.
const FULL: usize = 66;
/// Fewest columns for the file of a size beside its outfit.
const LEAST_FILE: usize = 8;
/// Columns for the name of a seam in such a table, and for all but the seam's edges.
const NAME: usize = 14;
const FIXED: usize = 3 + NAME + 1 + 2 * 8 + 2 * 6 + 5;

/// The panes: list; table of the selected size, or question; pieces. `None` where one does not fit.
#[derive(Default)]
struct Panes {
    list: Option<Rect>,
    table: Option<Rect>,
    pieces: Option<Rect>,
}

impl Draw for StylesScreen {
    fn draw(&self, frame: &mut Frame<'_>, area: Rect, state: &State) {
        let (on_desk, is_bare) = (state.in_second_pane(), is_narrow(area));
        let panes = self.panes(area, state);
        if let Some(area) = panes.list {
            self.draw_list(frame, area, state, is_bare);
        }
        if let Some(area) = panes.table {
            match (self.asked(state), self.layout(state)) {
                (Some(asked), _) => self.draw_question(frame, area, state, &asked),
                (None, Some(Ok(layout))) if is_bare => {
                    frame.render_widget(Paragraph::new(self.table(state, layout, area.width, area.height)), area);
                }
                (None, _) => self.draw_table(frame, area, state, on_desk),
            }
        }
        if let Some(area) = panes.pieces {
            let is_alone = panes.table.is_none();
            self.draw_pieces(frame, area, state, is_alone || on_desk && self.asking.is_none());
        }
    }

    fn targets(&self, state: &State, area: Rect) -> Vec<Target> {
        let Panes { list, table, pieces } = self.panes(area, state);
        let is_bare = is_narrow(area);
        let inner = |area: Rect| if is_bare { area } else { jump::inside(area) };
        let sizes = self.sizes(state);
        let key = self.size_row(state).map(|row| row.key);
        let at = sizes.iter().position(|row| Some(row.key) == key).unwrap_or(0);
        let mut targets = list.map_or(vec![], |area| jump::rows(0, inner(area), 1, sizes.len(), at));
        if let Some(layout) = self.laid_out(state) {
            let lines = table.filter(|_| self.asked(state).is_none());
            targets.extend(lines.into_iter().flat_map(|area| self.line_targets(state, layout, inner(area))));
            let pieces = pieces.map(|area| self.beside_preview(state, area)).filter(|area| area.width > 0);
            targets.extend(pieces.into_iter().flat_map(|area| pieces::targets(layout, area)));
        }
        targets
    }

    fn explained(&self, _state: &State) -> Selected {
        Selected::new(String::new(), &HEADINGS, &[])
    }

    fn pictures(&self, state: &State, area: Rect) -> Vec<PictureRequest> {
        let panes = self.pieces_area(state, area).map_or(vec![], |area| self.previewed(state, area));
        requests(state, panes)
    }
}

impl StylesScreen {
    fn panes(&self, area: Rect, state: &State) -> Panes {
        // The question must be seen while one is asked.
        if self.enlarged && self.asking.is_none() {
            return Panes { pieces: Some(area), ..Panes::default() };
        }
        if is_narrow(area) {
            if !state.in_second_pane() || !matches!(self.layout(state), Some(Ok(_))) {
                return Panes { list: Some(area), ..Panes::default() };
            }
            if area.width < BESIDE {
                return Panes { table: Some(area), ..Panes::default() };
            }
            let [table, pieces] = Layout::horizontal([Constraint::Fill(1), Constraint::Fill(1)]).areas(area);
            return Panes { table: Some(table), pieces: Some(pieces), ..Panes::default() };
        }
        let share = if area.width >= WIDE { area.width * 9 / 20 } else { area.width / 2 };
        let [left, pieces] = Layout::horizontal([Constraint::Length(share), Constraint::Fill(1)]).areas(area);
        let list = (self.sizes(state).len().max(1) as u16).saturating_add(3).min((area.height / 3).max(5));
        let [list, table] = Layout::vertical([Constraint::Length(list), Constraint::Fill(1)]).areas(left);
        Panes { list: Some(list), table: Some(table), pieces: Some(pieces) }
    }

    /// Places of the table's lines, for a jump. A selected question takes several lines.
    fn line_targets(&self, state: &State, layout: &SizeLayout, area: Rect) -> Vec<Target> {
        let items = layout.lines();
        let at = self.line.min(items.len().saturating_sub(1));
        let head = 1 + self.outfit_lines(state, area.width, area.height).len();
        let mut targets = jump::rows(1, area, head, items.len(), at);
        let below = match items.get(at) {
            Some(TableLine::Question(_)) => {
                item_lines(state, layout, items[at], usize::from(area.width), true).0.len().saturating_sub(1) as u16
            }
            _ => 0,
        };
        for target in &mut targets {
            target.at.y += if matches!(target.goal, Goal::Row(_, step) if step > 0) { below } else { 0 };
        }
        targets.retain(|target| area.contains(target.at));
        targets
    }

    /// Area for the pieces and the preview of the garment; `None` where only lists fit.
    pub fn pieces_area(&self, state: &State, area: Rect) -> Option<Rect> {
        self.panes(area, state).pieces
    }

    fn beside_preview(&self, state: &State, area: Rect) -> Rect {
        self.preview_place(state, area).map_or(area, |garment| Rect { width: area.width - garment.width, ..area })
    }

    fn draw_list(&self, frame: &mut Frame<'_>, area: Rect, state: &State, is_bare: bool) {
        if is_bare {
            frame.render_widget(Paragraph::new(self.list(state, area.width, area.height)), area);
            return;
        }
        let sizes = self.sizes(state);
        let mut styles: Vec<&str> = sizes.iter().map(|row| row.style.as_str()).collect();
        styles.dedup();
        let counted = |n: usize, what: &str| format!("{n} {what}{}", if n == 1 { "" } else { "s" });
        let title = format!("{}, {}", counted(styles.len(), "style"), counted(sizes.len(), "size"));
        let legend = "• study  * not saved  ? proposed";
        let block = pane(state.theme, title, !state.in_second_pane());
        let block = block.title_bottom(Line::styled(legend, state.theme.legend()));
        let inner = block.inner(area);
        frame.render_widget(Paragraph::new(self.list(state, inner.width, inner.height)).block(block), area);
    }

    fn draw_pieces(&self, frame: &mut Frame<'_>, area: Rect, state: &State, on_desk: bool) {
        let garment = self.preview_place(state, area);
        let left = self.beside_preview(state, area);
        if left.width > 0 {
            self.draw_piece_pane(frame, left, state, on_desk);
        }
        if let Some(garment) = garment {
            self.draw_preview(frame, garment, state);
        }
    }

    fn list(&self, state: &State, width: u16, height: u16) -> Vec<Line<'static>> {
        let sizes = self.sizes(state);
        let (width, height) = (usize::from(width), usize::from(height).saturating_sub(1));
        let key = self.size_row(state).map(|row| row.key);
        let at = sizes.iter().position(|row| Some(row.key) == key).unwrap_or(0);
        let widest = |of: fn(&SizeRow) -> &String| sizes.iter().map(|row| text::width(of(row))).max().unwrap_or(0);
        let style = widest(|row| &row.style).clamp(14, (width / 3).max(14));
        let names = [style, widest(|row| &row.size).clamp(6, (width / 6).max(6))];
        let head = format!("  {} {} {} {}", left("style", names[0]), left("size", names[1]), left("rev", 4), "pattern");
        let mut lines = vec![Line::styled(shortened(&head, width), state.theme.dim())];
        let selection = state.theme.selection(!state.in_second_pane());
        lines.extend(listed(&sizes, at, height, selection, |row| Line::raw(self.list_line(state, row, names, width))));
        if sizes.is_empty() {
            lines.push(no_rows(state.filter(), "no size matches the filter", "no styles yet: i imports one"));
        }
        lines
    }

    fn list_line(&self, state: &State, row: &SizeRow, names: [usize; 2], width: usize) -> String {
        let [used, edited, unsure] = self.marks_of(state, row);
        let (style, size) = (left(&row.style, names[0]), left(&row.size, names[1]));
        let start = format!("{used}{edited}{style} {size} {} {unsure}", left(&revisions(row), 4));
        let room = width.saturating_sub(text::width(&start));
        let [whole, short] = outfit_marks(state, &row.style);
        let fits = |mark: &String| text::width(mark) + 2 + LEAST_FILE <= room;
        // The file gives way to the outfit, which is to be seen in the list.
        let end = match [&whole, &short].into_iter().find(|mark| fits(mark)) {
            _ if whole.is_empty() => shortened(&row.pattern_file, room),
            Some(mark) => format!("{}  {mark}", shortened(&row.pattern_file, room - text::width(mark) - 2)),
            None => left(&short, room).trim_end().to_owned(),
        };
        shortened(&(start + &end), width)
    }

    fn draw_table(&self, frame: &mut Frame<'_>, area: Rect, state: &State, focused: bool) {
        let Some(row) = self.size_row(state) else {
            frame.render_widget(Block::bordered().border_style(state.theme.dim()), area);
            return;
        };
        let name = format!("{} {}", row.style, row.size);
        let columns = usize::from(area.width.saturating_sub(2));
        match self.layout(state) {
            None => {
                let block = pane(state.theme, name, focused);
                frame.render_widget(Paragraph::new("reading the pattern…").block(block), area);
            }
            Some(Err(error)) => {
                let lines = wrapped(&format!("✗ {error}"), columns);
                let lines: Vec<Line<'_>> =
                    lines.into_iter().map(|line| Line::styled(line, state.theme.bad())).collect();
                frame.render_widget(Paragraph::new(lines).block(pane(state.theme, name, focused)), area);
            }
            Some(Ok(layout)) => {
                let title = {
                    let counts = format!(" · {} seams, {} to decide", layout.out.desk.seams.len(), to_decide(layout));
                    // Border and mark of the focus take four columns.
                    let room = columns.saturating_sub(width(&counts) + 4);
                    shortened(&name, room) + &counts
                };
                let below = shortened(&self.selection(layout), columns);
                let block = pane(state.theme, title, focused).title_bottom(Line::styled(below, state.theme.legend()));
                let inner = block.inner(area);
                frame.render_widget(
                    Paragraph::new(self.table(state, layout, inner.width, inner.height)).block(block),
                    area,
                );
            }
        }
    }

    fn selection(&self, layout: &SizeLayout) -> String {
        let (piece, edge) = self.edge;
        let Some(piece) = layout.out.desk.pieces.get(piece) else { return String::new() };
        let Some(edge) = piece.edges.get(edge) else { return String::new() };
        let edge = format!("{}.{} {:.1} mm", piece.id, edge.number, edge.length_mm);
        match layout.seam_at(self.edge) {
            Some(k) => {
                let seam = &layout.out.desk.seams[k];
                let turned = if seam.same_direction { ", turned" } else { "" };
                format!("{} {} · {edge}{turned}", letter(k), seam.name)
            }
            None => format!("in no seam · {edge}"),
        }
    }

    fn table(&self, state: &State, layout: &SizeLayout, width: u16, height: u16) -> Vec<Line<'static>> {
        let worn = self.outfit_lines(state, width, height);
        let (width, height) = (usize::from(width), usize::from(height).saturating_sub(1 + worn.len()));
        let items = layout.lines();
        let at = self.line.min(items.len().saturating_sub(1));
        let first = first_shown(at, items.len(), height);
        let mut lines: Vec<Line<'_>> = worn.iter().map(|line| Line::styled(line.clone(), state.theme.busy())).collect();
        lines.push(Line::styled(head(width), state.theme.dim()));
        for (k, item) in items.iter().enumerate().skip(first) {
            // If the selected edge is in no seam, the selected line is that of another edge.
            let is_selected = k == at
                && match item {
                    TableLine::Seam(seam) => layout.seam_at(self.edge) == Some(*seam),
                    _ => true,
                };
            let (texts, style) = item_lines(state, layout, *item, width, is_selected);
            for text in texts {
                let line = Line::styled(text, style);
                lines.push(if is_selected {
                    selected_line(line, state.theme.selection(state.in_second_pane()))
                } else {
                    line
                });
            }
        }
        lines.truncate(worn.len() + height + 1);
        lines
    }

    /// Lines about the outfits of the selected style that fit above a table of some rows: at most a fourth of them.
    fn outfit_lines(&self, state: &State, columns: u16, rows: u16) -> Vec<String> {
        let told = self.size_row(state).map_or(vec![], |row| outfit_lines(state, &row.style));
        told.iter().flat_map(|line| wrapped(line, usize::from(columns))).take(usize::from(rows / 4)).collect()
    }
}

fn to_decide(layout: &SizeLayout) -> usize {
    layout.out.undecided.len()
}

/// Lines of an item of the table; a selected question in full.
fn item_lines(
    state: &State,
    layout: &SizeLayout,
    item: TableLine,
    width: usize,
    is_selected: bool,
) -> (Vec<String>, Style) {
    match item {
        TableLine::Seam(k) => {
            let seam = &layout.out.desk.seams[k];
            let colour = Style::new().fg(state.theme.lettered(k));
            (vec![seam_line(&layout.out.desk, k, seam, width)], colour)
        }
        TableLine::Question(k) => {
            let text = format!("? {}", layout.out.undecided[k].text);
            let texts = if is_selected { wrapped(&text, width) } else { vec![shortened(&text, width)] };
            (texts, state.theme.warn())
        }
        TableLine::Length(k) => {
            let length = &layout.out.lengths[k];
            let value = format!("{:.1}", length.l2d_mm);
            let name = left(&format!("#{} {}", length.no, length.name), width.saturating_sub(9));
            (vec![shortened(&format!("{name} {}", right(&value, 7)), width)], Style::new())
        }
    }
}

fn head(width: usize) -> String {
    let text = if width >= FULL {
        let edges = left("edges", width - FIXED);
        let columns = [("a mm", 8), ("b mm", 8), ("ratio", 6), ("ease", 6), ("sure", 5)];
        let columns = columns.map(|(title, columns)| right(title, columns)).concat();
        format!("   {} {edges}{columns}", left("seam", NAME))
    } else {
        let edges = left("edges", width.saturating_sub(3 + 7 + 6 + 5));
        format!("   {edges}{}{}{}", right("a mm", 7), right("ease", 6), right("sure", 5))
    };
    shortened(&text, width)
}

/// Line of a seam: letter, edges by number, lengths, and confidence if it is only proposed.
fn seam_line(desk: &Desk, k: usize, seam: &DeskSeam, width: usize) -> String {
    let (mark, sure) = match seam.confidence {
        Some(confidence) => ("?", format!("{:.0}%", confidence * 100.0)),
        None => (" ", "✓".to_owned()),
    };
    let turned = if seam.same_direction { "↻" } else { "" };
    // Names of pieces are shortened before numbers of edges.
    let fitted = |columns: usize| {
        let edges = |letters| format!("{}={}{turned}", chain(desk, &seam.a, letters), chain(desk, &seam.b, letters));
        let fits = |edges: &String| text::width(edges) <= columns;
        left(&(1..=12).rev().map(edges).find(fits).unwrap_or_else(|| edges(1)), columns)
    };
    let ease = seam.a_mm - seam.b_mm;
    let ease = if ease.abs() < 0.05 { "0".to_owned() } else { whole_or_tenth(ease) };
    let start = format!("{}{mark} ", letter(k));
    let text = if width >= FULL {
        let numbers = [seam.a_mm, seam.b_mm].map(|mm| right(&format!("{mm:.1}"), 8)).concat();
        let ratio = right(&format!("{:.3}", seam.a_mm / seam.b_mm), 6);
        let edges = fitted(width - FIXED);
        format!("{start}{} {edges}{numbers}{ratio}{}{}", left(&seam.name, NAME), right(&ease, 6), right(&sure, 5))
    } else {
        let edges = fitted(width.saturating_sub(3 + 7 + 6 + 5));
        format!("{start}{edges}{}{}{}", right(&format!("{:.1}", seam.a_mm), 7), right(&ease, 6), right(&sure, 5))
    };
    shortened(&text, width)
}

/// Ease with its sign, in whole mm; small ones in tenths.
fn whole_or_tenth(ease: f64) -> String {
    let sign = if ease > 0.0 { "+" } else { "" };
    if ease.abs() < 10.0 { format!("{sign}{ease:.1}").replace('-', "−") } else { format!("{sign}{}", whole(ease)) }
}

/// Edges on one side of a seam, by number: `front.3`, `sleeve.2+3`. `letters` is the number of letters of each word.
fn chain(desk: &Desk, edges: &[EdgeAt], letters: usize) -> String {
    let short = |id: &str| short_name(id, letters);
    let mut text = String::new();
    let mut before = None;
    for (piece, edge) in edges {
        let drawn = &desk.pieces[*piece];
        let number = drawn.edges[*edge].number;
        text += &match before {
            Some(same) if same == piece => format!("+{number}"),
            Some(_) => format!("+{}.{number}", short(&drawn.id)),
            None => format!("{}.{number}", short(&drawn.id)),
        };
        before = Some(piece);
    }
    text
}

//! Drawing a comparison.

use std::ops::Range;

use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::style::Style;
use ratatui::text::{Line, Span};
use ratatui::widgets::Paragraph;

use crate::messages::snapshot::Compared;
use crate::overlays::explanation::Selected;
use crate::screens::compare::actions::{compared, recommended, to_compare};
use crate::screens::compare::comparison::{ComparisonRow, differing_inputs, labels, of_study, verdict};
use crate::screens::compare::state::CompareScreen;
use crate::screens::page::Draw;
use crate::screens::picture_pane::actions::requests;
use crate::screens::picture_pane::draw::{draw_legend, draw_shot, parts};
use crate::screens::state::State;
use crate::widgets::jump::{self, Target};
use crate::widgets::layout::{WIDE, is_narrow};
use crate::widgets::lists::{listed, pane};
use crate::widgets::picture::{PictureRequest, Pictured};
use crate::widgets::text::{self, left, mm, right, wrapped};
use crate::widgets::theme::glyph;
use store::{JobRow, MetricsRow};

/// Columns for one run.
const RUN: usize = 12;
/// Columns for number and pattern length.
const FIXED: usize = 3 + 8;
/// Lines above the measurements.
const HEAD: usize = 3;
/// Fewest columns for a name.
const LEAST_NAME: usize = 12;
/// Columns for the difference of two runs.
const DELTA: usize = 9;

/// Names of the quantities on the screen, as in the glossary.
const NAMES: [&str; 8] = ["chi", "diff", "L2D", "E(chi)", "EI", "measurement", "FEM", "HYB"];

impl Draw for CompareScreen {
    fn draw(&self, frame: &mut Frame<'_>, area: Rect, state: &State) {
        let runs = compared(state);
        if runs.is_empty() {
            let text = if to_compare(state).is_empty() {
                " Nothing to compare: select a job on screen 1 or 4, or several with Space, and press c."
            } else {
                " reading…"
            };
            frame.render_widget(Paragraph::new(text), area);
            return;
        }
        let panes = panes(area, state);
        if let Some(area) = panes.table {
            self.draw_table(frame, area, state, runs);
        }
        if let Some(area) = panes.verdict {
            let block = pane(state.theme, "verdict", false);
            let inner = block.inner(area);
            let lines = said(state, runs, usize::from(inner.width));
            frame.render_widget(Paragraph::new(lines).block(block), area);
        }
        let jobs: Vec<&JobRow> = runs.iter().map(|run| &run.job).collect();
        for ((run, name), area) in runs.iter().zip(labels(&jobs)).zip(panes.pictures) {
            draw_picture(frame, area, state, &run.job, &name);
        }
    }

    fn targets(&self, state: &State, area: Rect) -> Vec<Target> {
        if compared(state).is_empty() {
            return vec![];
        }
        let panes = panes(area, state);
        let rows = panes
            .table
            .map_or(vec![], |table| jump::rows(0, jump::inside(table), HEAD, self.rows(state).len(), self.row));
        rows.into_iter().chain(panes.pictures.first().map(|picture| jump::pane(*picture, 1))).collect()
    }

    fn explained(&self, state: &State) -> Selected {
        let rows = self.rows(state);
        let what = rows.get(self.row).map_or(String::new(), |row| {
            let chi: Vec<String> =
                row.chi.iter().map(|chi| chi.map_or("—".to_owned(), |chi| format!("{chi:.3}"))).collect();
            format!("{}: L2D {} mm, chi {}", row.name, mm(row.l2d_m), chi.join(" and "))
        });
        Selected::new(what, &NAMES, &[])
    }

    fn pictures(&self, state: &State, area: Rect) -> Vec<PictureRequest> {
        requests(state, picture_panes(area, state))
    }
}

impl CompareScreen {
    fn draw_table(&self, frame: &mut Frame<'_>, area: Rect, state: &State, runs: &[Compared]) {
        let rows = self.rows(state);
        let legend = if self.differences_only {
            " differences only, d shows all "
        } else {
            " d differences only  ◂ nearest to 1 "
        };
        let columns = Columns::new(&rows, runs.len(), self.left_of, usize::from(jump::inside(area).width));
        let Range { start, end } = columns.runs;
        let part = if end - start < runs.len() {
            format!(", {} to {end} shown, h l others", start + 1)
        } else {
            String::new()
        };
        let block = pane(state.theme, title(runs) + &part, !state.in_second_pane())
            .title_bottom(Line::styled(legend, state.theme.legend()).right_aligned());
        let inner = block.inner(area);
        let mut lines = self.header(state, runs, &columns).to_vec();
        let room = usize::from(inner.height).saturating_sub(lines.len());
        let selection = state.theme.selection(!state.in_second_pane());
        lines.extend(listed(&rows, self.row, room, selection, |row| line(state, row, &columns)));
        if rows.is_empty() {
            let is_cut = self.differences_only || !state.filter().is_empty();
            let text = if is_cut { "no measurement differs or matches the filter" } else { "no measurements yet" };
            lines.push(Line::raw(text));
        }
        frame.render_widget(Paragraph::new(lines).block(block), area);
    }

    /// Names of the runs, and below them E and EI.
    fn header(&self, state: &State, runs: &[Compared], columns: &Columns) -> [Line<'static>; HEAD] {
        let jobs: Vec<&JobRow> = runs.iter().map(|run| &run.job).collect();
        let names = labels(&jobs);
        let start = format!("{} {}{}", right("#", 2), left("measurement", columns.name), right("L2D mm", 8));
        let over = |cells: Vec<String>| cells.iter().map(|cell| right(cell, RUN)).collect::<String>();
        let names = names[columns.runs.clone()].iter().map(|name| format!("{name}  ")).collect();
        let mark = if self.sorts_by_difference { "▼" } else { "" };
        let delta = if columns.delta { right(&format!("diff{mark}"), DELTA - 2) } else { String::new() };
        let head = format!("{start}{}{delta}", over(names));
        let numbers = |number: fn(&MetricsRow) -> f64| -> Vec<String> {
            let value = |run: &Compared| {
                run.metrics.as_ref().map_or("—  ".to_owned(), |metrics| format!("{:.4}  ", number(metrics)))
            };
            runs[columns.runs.clone()].iter().map(value).collect()
        };
        let blank = 3 + columns.name + 8;
        [
            Line::styled(head, state.theme.dim()),
            Line::styled(
                format!("{}{}", left("   E(chi)", blank), over(numbers(|metrics| metrics.e_chi))),
                state.theme.bold(),
            ),
            Line::styled(
                format!("{}{}", left("   EI", blank), over(numbers(|metrics| metrics.ei))),
                state.theme.bold(),
            ),
        ]
    }
}

struct Panes {
    table: Option<Rect>,
    verdict: Option<Rect>,
    pictures: Vec<Rect>,
}

fn panes(area: Rect, state: &State) -> Panes {
    let runs = compared(state).len();
    let pictures = |area: Rect, most: usize| {
        let n = runs.min(most);
        Layout::horizontal(vec![Constraint::Fill(1); n]).split(area).to_vec()
    };
    if state.pictures.enlarged {
        return Panes { table: None, verdict: None, pictures: pictures(area, (usize::from(area.width) / 24).max(1)) };
    }
    if is_narrow(area) {
        return Panes { table: Some(area), verdict: None, pictures: vec![] };
    }
    let wide = area.width >= WIDE;
    let [left, right] = if wide {
        Layout::horizontal([Constraint::Length(area.width * 9 / 20), Constraint::Fill(1)]).areas(area)
    } else {
        [area, Rect::ZERO]
    };
    // The verdict is shown whole, as long as half of the lines are left for the measurements.
    let least = if area.height >= 30 { 10 } else { 8 };
    let verdict = said(state, compared(state), usize::from(jump::inside(left).width)).len() as u16 + 2;
    let height = verdict.max(least).min((area.height / 2).max(least));
    let [table, verdict] = Layout::vertical([Constraint::Fill(1), Constraint::Length(height)]).areas(left);
    let pictures = if wide { pictures(right, 3) } else { vec![] };
    Panes { table: Some(table), verdict: Some(verdict), pictures }
}

/// Panes of the pictures, for as many runs as fit.
pub fn picture_panes(area: Rect, state: &State) -> Vec<(Pictured, Rect)> {
    let drapes = compared(state).iter().map(|run| Pictured::Drape(run.job.id));
    drapes.zip(panes(area, state).pictures).collect()
}

/// Truest run, inputs that differ, then other conclusions: a small pane cuts the last.
fn said(state: &State, runs: &[Compared], width: usize) -> Vec<Line<'static>> {
    let inputs = differing_inputs(runs).join(", ");
    let inputs = if inputs.is_empty() { "all inputs are the same".to_owned() } else { format!("differ in: {inputs}") };
    let mut lines = vec![];
    let study = state.data.as_ref().zip(runs.first()).and_then(|(data, run)| of_study(&data.jobs, &run.job));
    for (k, sentence) in verdict(runs, recommended(state)).into_iter().chain(study).enumerate() {
        let style = if k == 0 { state.theme.bold() } else { Style::new() };
        lines.extend(wrapped(&sentence, width).into_iter().map(|line| Line::styled(line, style)));
        if k == 0 {
            lines.extend(wrapped(&inputs, width).into_iter().map(|line| Line::styled(line, state.theme.dim())));
        }
    }
    lines
}

fn draw_picture(frame: &mut Frame<'_>, area: Rect, state: &State, job: &JobRow, name: &str) {
    let ei = job.ei.map_or(String::new(), |ei| format!(" · EI {ei:.4}"));
    let block = pane(state.theme, format!("{name}{ei}"), state.in_second_pane() || state.pictures.enlarged);
    let (inner, legend) = parts(block.inner(area));
    frame.render_widget(block, area);
    if let Some(legend) = legend {
        draw_legend(frame, legend, state);
    }
    let otherwise = format!("{} {}", glyph(job.status), text::status(job.status));
    let drape = job.status.has_result().then_some(Pictured::Drape(job.id));
    draw_shot(frame, inner, state, drape, &otherwise);
}

/// Title of the table: garment, size and subject that all runs share.
fn title(runs: &[Compared]) -> String {
    let first = &runs[0].job;
    let parts: [fn(&JobRow) -> &str; 3] = [|job| &job.garment, |job| &job.size, |job| &job.subject];
    let shared: Vec<&str> = parts
        .iter()
        .filter(|part| runs.iter().all(|run| part(&run.job) == part(first)))
        .map(|part| part(first))
        .collect();
    format!("{} runs{}{}", runs.len(), if shared.is_empty() { "" } else { " · " }, shared.join(" "))
}

/// Widths of columns; the name takes what the runs leave.
struct Columns {
    name: usize,
    runs: Range<usize>,
    delta: bool,
}

/// Number of runs that fit into the table.
pub fn runs_shown(area: Rect, state: &State) -> usize {
    let width = panes(area, state).table.map_or(0, |table| jump::inside(table).width);
    Columns::new(&[], compared(state).len(), 0, usize::from(width)).runs.len()
}

impl Columns {
    fn new(rows: &[ComparisonRow], runs: usize, left_of: usize, width: usize) -> Self {
        let longest = rows.iter().map(|row| text::width(&row.name)).max().unwrap_or(0).max(11) + 1;
        // Runs matter more than their difference, which is left out first.
        let delta = runs == 2 && width >= FIXED + LEAST_NAME + 2 * RUN + DELTA;
        let taken = FIXED + if delta { DELTA } else { 0 };
        let shown = runs.min((width.saturating_sub(taken + LEAST_NAME) / RUN).max(1));
        let first = left_of.min(runs - shown);
        Self { name: width.saturating_sub(taken + shown * RUN).clamp(6, longest), runs: first..first + shown, delta }
    }
}

fn line(state: &State, row: &ComparisonRow, columns: &Columns) -> Line<'static> {
    let start =
        format!("{} {}{}", right(&row.no.to_string(), 2), left(&row.name, columns.name), right(&mm(row.l2d_m), 8));
    let mut spans = vec![Span::raw(start)];
    for (k, chi) in row.chi.iter().enumerate().take(columns.runs.end).skip(columns.runs.start) {
        let mark = if row.nearest() == Some(k) { " ◂" } else { "  " };
        let (text, style) = match chi {
            Some(chi) => (format!("{chi:.3}{mark}"), state.theme.chi(*chi)),
            None => ("—  ".to_owned(), state.theme.dim()),
        };
        spans.push(Span::styled(right(&text, RUN), style));
    }
    if let ([Some(a), Some(b)], true) = (row.chi.as_slice(), columns.delta) {
        // Adding zero removes the sign of a difference that rounds to zero.
        let difference = ((b - a) * 1e3).round() / 1e3 + 0.0;
        spans.push(Span::raw(right(&format!("{difference:+.3}").replace('-', "−"), DELTA - 2)));
    }
    Line::from(spans)
}

//! The table of measurements and the numbers of a result, as Study and Results show them.

use ratatui::text::{Line, Span};

use super::super::state::{ChiOrder, State};
use super::super::text::{self, chi_bar, left, mm, right};
use super::super::theme::{fit_glyph, glyph};
use super::first_shown;
use crate::study::{ChiRow, FitCell};

/// What the marks after names mean.
pub(super) const LEGEND: &str = "○ girth  ~ free edge  = controlled";

/// Columns beside name and bar: number, two lengths, chi, the gaps between them and the marks.
const FIXED: usize = 3 + 8 + 8 + 7 + 4;

/// The table of measurements in so many columns and lines, with the selected row marked where there is one.
pub(super) fn table(state: &State, columns: usize, lines: usize, selected: Option<bool>) -> Vec<Line<'static>> {
    let rows = state.chi();
    let side = if columns >= 70 { 8 } else if columns >= 50 { 4 } else { 2 };
    let name = columns.saturating_sub(FIXED + 2 * side + 1).max(6);
    let order = match (state.chi_order.by, state.chi_order.reversed) {
        (ChiOrder::Number, _) => ("", ""),
        (ChiOrder::Error, false) => ("", "▼"),
        (ChiOrder::Error, true) => ("", "▲"),
    };
    let header = format!(
        "{}{} {}{}{}{} {}",
        right("#", 3),
        order.0,
        left("measurement", name + 3),
        right("L2D mm", 8),
        right("L3D mm", 8),
        right(&format!("chi{}", order.1), 7),
        if side >= 4 { left("−5%", side) + "1" + &right("+5%", side) } else { String::new() }
    );
    let mut table = vec![Line::styled(header, state.theme.dim())];
    let height = lines.saturating_sub(1);
    let first = first_shown(state.chi_row, rows.len(), height);
    for (k, row) in rows.iter().enumerate().skip(first).take(height) {
        let line = line(state, row, name, side);
        let style = selected.filter(|_| k == state.chi_row).map(|focused| state.theme.selection(focused));
        table.push(style.map_or(line.clone(), |style| line.patch_style(style)));
    }
    table
}

fn line(state: &State, row: &ChiRow, name: usize, side: usize) -> Line<'static> {
    let chi = row.chi();
    let style = state.theme.chi(chi);
    let marks = [(row.is_girth, '○'), (row.is_free_edge, '~'), (row.is_controlled, '=')];
    let marks: String = marks.iter().filter(|(is_set, _)| *is_set).map(|(_, mark)| *mark).collect();
    Line::from(vec![
        Span::raw(format!(
            "{} {}{}{}{}",
            right(&row.no.to_string(), 3),
            left(&row.name, name),
            left(&marks, 3),
            right(&mm(row.l2d_m), 8),
            right(&mm(row.l3d_m), 8)
        )),
        Span::styled(format!("{} {}", right(&format!("{chi:.3}"), 7), chi_bar(chi, side)), style),
    ])
}

/// The state of the selected job and the numbers of its result, one fact a line, the most important first.
pub(super) fn numbers(state: &State, columns: usize) -> Vec<Line<'static>> {
    let Some(job) = state.job() else { return vec![] };
    let wall = job.wall_ms.map_or(String::new(), |ms| format!(" in {}", text::duration(ms)));
    let share = job.progress.as_ref().map_or(String::new(), |p| format!(" {} {:.0}%", p.phase, p.fraction * 100.0));
    let status = format!("{} {}{share}{wall}", glyph(job.status), text::status(job.status));
    let mut facts = vec![Line::styled(status, state.theme.status(job.status))];
    if let Some(ease) = state.ease(job) {
        let text = format!("{} {} mm {}", ease.level, text::ease_mm(ease.fit.ease_m), fit_words(&ease.fit));
        facts.push(fact("ease", text));
    }
    if let Some(error) = job.error.as_ref() {
        for line in wrapped(error, columns) {
            facts.push(Line::styled(line, state.theme.bad()));
        }
    }
    let Some(detail) = state.detail() else { return facts };
    if let Some(m) = detail.metrics {
        facts.push(fact("EI", format!("{:.4}  max {:.4}  n {}", m.ei, m.max_abs_error, m.n)));
        facts.push(fact("E", format!("{:.4}  SD {:.4}", m.e_chi, m.sd_chi)));
        facts.push(fact("gap", format!("{} mm  inside body {} mm", mm(m.seam_gap_max_m), mm(m.penetration_max_m))));
        facts.push(fact("mesh", format!("{} vertices, {} faces", m.vertices, m.faces)));
        facts.push(fact("ended", format!("step {}, residual {:.1e}", m.iterations, m.residual)));
    }
    if !detail.stages.is_empty() {
        let part = |is_cached: bool| -> String {
            let stages = detail.stages.iter().filter(|stage| stage.was_cached == is_cached);
            stages.map(|stage| stage.stage.as_str()).collect::<Vec<_>>().join(", ")
        };
        for (word, stages) in [("cached", part(true)), ("made", part(false))] {
            if !stages.is_empty() {
                facts.push(fact(word, stages));
            }
        }
    }
    facts.into_iter().map(|line| shortened(line, columns)).collect()
}

fn fact(name: &str, value: String) -> Line<'static> {
    Line::raw(format!("{}{value}", left(name, 7)))
}

fn shortened(line: Line<'static>, columns: usize) -> Line<'static> {
    let text: String = line.spans.iter().map(|span| span.content.as_ref()).collect();
    Line::styled(text::shortened(&text, columns), line.style)
}

/// A fit in words and its glyph.
fn fit_words(fit: &FitCell) -> String {
    let mark = match (fit.undersized, fit.borderline) {
        (true, _) => ", undersized",
        (_, true) => ", borderline",
        _ => "",
    };
    format!("{} {}{mark}", fit_glyph(fit).trim(), fit.class.as_str())
}

/// A text in lines of at most so many columns, broken at spaces where there are any.
pub(super) fn wrapped(text: &str, columns: usize) -> Vec<String> {
    let mut lines = vec![];
    for paragraph in text.lines() {
        let mut line = String::new();
        for word in paragraph.split_whitespace() {
            if !line.is_empty() && text::width(&line) + 1 + text::width(word) > columns {
                lines.push(std::mem::take(&mut line));
            }
            if !line.is_empty() {
                line.push(' ');
            }
            line.push_str(word);
        }
        lines.push(line);
    }
    lines
}

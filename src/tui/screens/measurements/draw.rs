//! Drawing the table of measurements, and the metrics of a result.

use ratatui::text::{Line, Span};

use crate::overlays::explanation::Selected;
use crate::screens::measurements::rows;
use crate::screens::measurements::state::{ChiOrder, marks};
use crate::screens::state::State;
use crate::widgets::lists::listed;
use crate::widgets::text::{self, chi_bar, chi_mark, ease_mm, left, mm, right, wrapped};
use crate::widgets::theme::sign;
use store::{ChiRow, FitCell, MetricsRow};

pub const LEGEND: &str = "○ girth  ~ free edge  = controlled";
/// Columns for number, two lengths, chi, and gaps.
const FIXED: usize = 3 + 7 + 7 + 6 + 1;

struct Columns {
    name: usize,
    marks: usize,
    /// Columns for each half of the bar; 0 for a mark instead of a bar.
    side: usize,
}

impl Columns {
    fn new(rows: &[&ChiRow], columns: usize) -> Self {
        let side = match columns {
            70.. => 8,
            56.. => 4,
            _ => 0,
        };
        let widest = |columns_of: &dyn Fn(&ChiRow) -> usize| rows.iter().map(|row| columns_of(row)).max().unwrap_or(0);
        let marks = widest(&|row| marks(row).chars().count());
        let name = widest(&|row| text::width(&row.name)).max(14) + 2;
        Self { name: columns.saturating_sub(FIXED + marks + 2 * side + 1).min(name).max(6), marks, side }
    }
}

/// Lines of the table, with the selected row in style where `selected` says so.
pub fn table(state: &State, columns: usize, lines: usize, selected: Option<bool>) -> Vec<Line<'static>> {
    let rows = rows(state);
    let columns = Columns::new(&rows, columns);
    let mut table = vec![header(state, &columns)];
    let selection = selected.map(|focused| state.theme.selection(focused));
    let room = lines.saturating_sub(1);
    table.extend(listed(&rows, state.measurements.row, room, selection, |row| line(state, row, &columns)));
    table
}

fn header(state: &State, columns: &Columns) -> Line<'static> {
    let (by_number, by_error) = match (state.measurements.order.by, state.measurements.order.reversed) {
        (ChiOrder::Number, false) => ("▲", ""),
        (ChiOrder::Number, true) => ("▼", ""),
        (ChiOrder::Error, false) => ("", "▼"),
        (ChiOrder::Error, true) => ("", "▲"),
    };
    let scale = if columns.side > 0 {
        format!("{}1{}", left("−5%", columns.side), right("+5%", columns.side))
    } else {
        String::new()
    };
    let text = format!(
        "{} {}{}{}{} {scale}",
        right(&format!("#{by_number}"), 2),
        left("measurement", columns.name + columns.marks),
        right("L2D mm", 7),
        right("L3D mm", 7),
        right(&format!("chi{by_error}"), 6),
    );
    Line::styled(text, state.theme.dim())
}

fn line(state: &State, row: &ChiRow, columns: &Columns) -> Line<'static> {
    let chi = row.chi();
    let bar = if columns.side > 0 { chi_bar(chi, columns.side) } else { chi_mark(chi).to_owned() };
    Line::from(vec![
        Span::raw(format!(
            "{} {}{}{}{}",
            right(&row.no.to_string(), 2),
            left(&row.name, columns.name),
            left(&marks(row), columns.marks),
            right(&mm(row.l2d_m), 7),
            right(&mm(row.l3d_m), 7)
        )),
        Span::styled(format!("{} {bar}", right(&format!("{chi:.3}"), 6)), state.theme.chi(chi)),
    ])
}

/// State of the selected job and metrics of its result, the most important first, side by side where they fit.
pub fn numbers(state: &State, columns: usize) -> Vec<Line<'static>> {
    let Some(job) = state.job() else { return vec![] };
    let wall = job.wall_ms.map_or(String::new(), |ms| format!(" in {}", text::duration(ms)));
    let share = job.progress.as_ref().map_or(String::new(), |p| format!(" {} {:.0}%", p.phase, p.fraction * 100.0));
    let inside = job.inside();
    let style = state.theme.result(job.status, inside.is_some());
    let sign = sign(job.status, inside.is_some());
    let inside = inside.map_or(String::new(), |words| format!(", {words}"));
    let status = format!("{sign} {}{share}{wall}{inside}", text::status(job.status));
    let mut lines = vec![Line::styled(text::shortened(&status, columns), style)];
    if let Some(ease) = state.data.as_ref().and_then(|data| data.ease_of(job)) {
        lines.push(fact(
            "ease mm",
            &format!("{} {} {}", ease.level, ease_mm(ease.fit.ease_m), fit_words(&ease.fit)),
            columns,
        ));
    }
    let error = job.error.as_deref().unwrap_or_default();
    lines.extend(wrapped(error, columns).into_iter().map(|line| Line::styled(line, state.theme.bad())));
    let Some(detail) = state.detail() else { return lines };
    let facts: Vec<_> = detail.metrics.as_ref().map_or(vec![], facts);
    let across = (columns / FACT_COLUMNS).max(1);
    let down = facts.len().div_ceil(across);
    for row in 0..down {
        let text: String = (row..facts.len())
            .step_by(down)
            .map(|k| format!("{}{}", left(facts[k].0, NAME_COLUMNS), left(&facts[k].1, FACT_COLUMNS - NAME_COLUMNS)))
            .collect();
        lines.push(Line::raw(text.trim_end().to_owned()));
    }
    lines
}

/// Names of the quantities of table and metrics, as in the glossary.
const NAMES: [&str; 19] = [
    "chi",
    "L2D",
    "L3D",
    "measurement",
    "−5% 1 +5%",
    "EI",
    "E(chi)",
    "SD(chi)",
    "max err",
    "n",
    "seam gap",
    "in body",
    "residual",
    "steps",
    "vertices",
    "faces",
    "ease mm",
    "why",
    "cached",
];

pub fn explained(state: &State) -> Selected {
    let rows = rows(state);
    let Some(row) = rows.get(state.measurements.row) else { return Selected::new(String::new(), &NAMES, &[]) };
    let (l2d, l3d) = (mm(row.l2d_m), mm(row.l3d_m));
    let what = format!("{}: L2D {l2d} mm, L3D {l3d} mm, chi {:.3}", row.name, row.chi());
    let kinds = [(row.is_controlled, "controlled"), (row.is_free_edge, "free edge"), (row.is_girth, "girth")];
    let kinds: Vec<&str> = kinds.iter().filter(|(is_set, _)| *is_set).map(|(_, name)| *name).collect();
    Selected::new(what, &[&NAMES[..3], kinds.as_slice()].concat(), &NAMES)
}

/// Reason why the selected job ran, and its stages that came from the cache.
pub fn provenance(state: &State) -> Vec<(&'static str, String)> {
    let Some(detail) = state.detail() else { return vec![] };
    let stages = |is_cached: bool| {
        let stages = detail.stages.iter().filter(|stage| stage.was_cached == is_cached);
        stages.map(|stage| stage.stage.as_str()).collect::<Vec<_>>().join(", ")
    };
    let facts = [("why", detail.why.to_string()), ("cached", stages(true)), ("made", stages(false))];
    facts.into_iter().filter(|(_, value)| !value.is_empty()).collect()
}

/// Columns for the name of a metric, and for name and value.
const NAME_COLUMNS: usize = 9;
const FACT_COLUMNS: usize = 21;

fn facts(m: &MetricsRow) -> Vec<(&'static str, String)> {
    vec![
        ("EI", format!("{:.4}", m.ei)),
        ("E(chi)", format!("{:.4}", m.e_chi)),
        ("SD(chi)", format!("{:.4}", m.sd_chi)),
        ("max err", format!("{:.4}", m.max_abs_error)),
        ("n", m.n.to_string()),
        ("seam gap", format!("{} mm", mm(m.seam_gap_max_m))),
        ("in body", format!("{} mm", mm(m.penetration_max_m))),
        ("residual", format!("{:.1e}", m.residual)),
        ("steps", m.iterations.to_string()),
        ("vertices", m.vertices.to_string()),
        ("faces", m.faces.to_string()),
    ]
}

pub fn fact(name: &str, value: &str, columns: usize) -> Line<'static> {
    Line::raw(text::shortened(&format!("{}{value}", left(name, NAME_COLUMNS)), columns))
}

/// Fit in words, with `!` and `~` as in the grid.
fn fit_words(fit: &FitCell) -> String {
    let mark = match (fit.undersized, fit.borderline) {
        (true, _) => "!",
        (_, true) => "~",
        _ => "",
    };
    format!("{}{mark}", fit.class.as_str())
}

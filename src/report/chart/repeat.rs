//! Chart of the range of chi between repeated simulations of a case, by measurement.

use super::super::spread::Repeats;
use super::super::text::simulator_name;
use super::super::{ReportError, theme};
use super::canvas::{Align, Axis, ROW, TYPE, WIDTH, draw};
use super::{Chart, row_label};
use fit::Simulator;

const LEFT: i32 = 560;
const TOP: i32 = 80;
/// Least range of the axis, in chi. Smaller differences do not matter.
const LEAST: f64 = 1e-4;

/// Draws a row for each measurement of a garment. For each simulator it has a dot at the mean over the cases of the
/// range of chi, and a line to the greatest range.
pub(crate) fn repeat_chart(title: &str, cases: &[&Repeats]) -> Result<Chart, ReportError> {
    let mut rows: Vec<(u32, &str)> =
        cases.iter().flat_map(|case| &case.spreads).map(|spread| (spread.no, spread.name.as_str())).collect();
    rows.sort_unstable();
    rows.dedup_by_key(|row| row.0);
    let spreads = |no: u32, simulator: Simulator| -> Vec<f64> {
        let own = cases.iter().filter(|case| case.simulator == simulator).flat_map(|case| &case.spreads);
        own.filter(|spread| spread.no == no).map(|spread| spread.chi).collect()
    };
    let most = cases.iter().flat_map(|case| &case.spreads).map(|spread| spread.chi).fold(0.0, f64::max);
    let axis = Axis { low: 0.0, high: 1.08 * most.max(LEAST), left: LEFT, right: WIDTH - 60 };
    let bottom = TOP + ROW * rows.len() as i32;
    let shown: Vec<Simulator> =
        Simulator::ALL.into_iter().filter(|simulator| cases.iter().any(|case| case.simulator == *simulator)).collect();
    let svg = draw(bottom + 3 * TYPE + 30, |canvas| {
        axis.grid(canvas, TOP, bottom)?;
        for (k, simulator) in (0..).zip(&shown) {
            canvas.dot((LEFT + 14 + 300 * k, 32), theme::simulator(*simulator))?;
            canvas.text((LEFT + 38 + 300 * k, 32), simulator_name(*simulator), theme::INK, Align::Left, false)?;
        }
        for (k, (no, name)) in (0..).zip(&rows) {
            let y = TOP + ROW * k + ROW / 2;
            canvas.text((LEFT - 24, y), &row_label(*no, name), theme::INK, Align::Right, false)?;
            for (row, simulator) in (0..).zip(&shown) {
                let (spreads, ink) = (spreads(*no, *simulator), theme::simulator(*simulator));
                let y = y + if shown.len() > 1 { 24 * row - 12 } else { 0 };
                let greatest = spreads.iter().copied().fold(0.0, f64::max);
                if !spreads.is_empty() {
                    let mean = spreads.iter().sum::<f64>() / spreads.len() as f64;
                    canvas.line(vec![(axis.at(mean), y), (axis.at(greatest), y)], ink, 5)?;
                    canvas.dot((axis.at(mean), y), ink)?;
                }
            }
        }
        let caption =
            "greatest less least chi over the repeats of a case   (dot: mean over cases, line: to the greatest)";
        canvas.text((WIDTH / 2, bottom + 2 * TYPE + 18), caption, theme::MUTED, Align::Middle, false)
    })?;
    let alt = format!("{title}: spread of chi over repeated simulations of {} cases, at most {most:.4}.", cases.len());
    Ok(Chart::new("repeats", title, svg, alt))
}

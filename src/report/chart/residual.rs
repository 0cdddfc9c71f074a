//! Chart of the convergence of runs: residual by iteration.

use super::super::data::TryOn;
use super::super::{ReportError, theme};
use super::Chart;
use super::canvas::{Align, Axis, TYPE, WIDTH, draw};

/// Greatest number of points of a curve; more would not be visible.
const POINTS: usize = 300;

/// Draws the residual on a logarithmic scale against the iteration, one line for each run, named at its end.
pub fn residual_chart(title: &str, runs: &[&TryOn], labels: &[String]) -> Result<Chart, ReportError> {
    let curves: Vec<Vec<(f64, f64)>> = runs.iter().map(|r| thin(&r.residuals)).collect();
    let points = || curves.iter().flatten();
    let last = points().map(|p| p.0).fold(1.0, f64::max);
    let (low, high) = points().fold((0.0_f64, 0.0_f64), |(l, h), p| (l.min(p.1), h.max(p.1)));
    let (low, high) = (low.floor(), high.ceil().max(low.floor() + 1.0));
    let (top, step) = (80, TYPE + 8);
    let bottom = (top + 520).max(top + step * runs.len() as i32);
    let height_of = |v: f64| bottom - ((v - low) / (high - low) * f64::from(bottom - top)).round() as i32;
    let svg = draw(bottom + 3 * TYPE + 30, |canvas| {
        let widest = labels.iter().map(|l| canvas.text_width(l)).max().unwrap_or(0);
        let axis = Axis { low: 0.0, high: last, left: 150, right: WIDTH - widest - 60 };
        axis.grid(canvas, top, bottom)?;
        let decades = low as i32..=high as i32;
        let every = ((high - low) as usize / 7).max(1);
        for decade in decades.step_by(every) {
            let y = height_of(f64::from(decade));
            canvas.line(vec![(axis.left, y), (axis.right, y)], theme::GRID, 2)?;
            canvas.text((axis.left - 16, y), &decade_name(decade), theme::MUTED, Align::Right, false)?;
        }
        let caption = "residual: rms force over the mean weight of a vertex (logarithmic)";
        canvas.text((axis.left, top - 48), caption, theme::MUTED, Align::Left, false)?;
        let mut ends = Vec::new();
        for (series, curve) in curves.iter().enumerate() {
            let line: Vec<(i32, i32)> = curve.iter().map(|p| (axis.at(p.0), height_of(p.1))).collect();
            if let Some(&end) = line.last() {
                ends.push((end.1, end.0, series));
                canvas.line(line, theme::SUBJECTS[series % theme::SUBJECTS.len()], 4)?;
            }
        }
        // Names at the ends of curves are moved apart where curves end together.
        ends.sort_unstable();
        let mut free = top;
        let mut room = ends.len() as i32;
        for (y, x, series) in ends {
            let place = y.min(bottom - step * (room - 1)).max(free);
            (free, room) = (place + step, room - 1);
            let ink = theme::SUBJECTS[series % theme::SUBJECTS.len()];
            canvas.line(vec![(x, y), (axis.right + 18, place)], ink, 1)?;
            canvas.text(
                (axis.right + 26, place),
                labels.get(series).map_or("", |l| l),
                theme::INK,
                Align::Left,
                false,
            )?;
        }
        canvas.text(
            ((axis.left + axis.right) / 2, bottom + 2 * TYPE + 18),
            "iteration",
            theme::MUTED,
            Align::Middle,
            false,
        )
    })?;
    let alt = format!("{title}: residual by iteration of {} runs.", runs.len());
    Ok(Chart::new("residual", title, svg, alt))
}

/// Iteration and decimal logarithm of the residual, thinned to about [`POINTS`] values. Keeps the last.
fn thin(history: &[(u32, f64)]) -> Vec<(f64, f64)> {
    let usable: Vec<(f64, f64)> =
        history.iter().filter(|(_, r)| *r > 0.0 && r.is_finite()).map(|&(i, r)| (f64::from(i), r.log10())).collect();
    let every = usable.len().div_ceil(POINTS).max(1);
    let last = usable.len().saturating_sub(1);
    usable.into_iter().enumerate().filter(|(k, _)| k % every == 0 || *k == last).map(|(_, p)| p).collect()
}

fn decade_name(decade: i32) -> String {
    match decade {
        -3..=0 => format!("{}", 10f64.powi(decade)),
        1..=4 => format!("{}", 10i64.pow(decade as u32)),
        _ => format!("1e{decade}"),
    }
}

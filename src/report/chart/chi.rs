//! Charts of chi by measurement: a mark for every run, or the mean and standard deviation over the runs.

use super::super::data::{Measured, TryOn, measurements};
use super::super::{ReportError, theme};
use super::canvas::{Align, Axis, Canvas, ROW, TYPE, WIDTH, draw};
use super::{Chart, row_label};

const LEFT: i32 = 520;

/// An axis that contains a range around 1 and all values.
fn axis(values: impl Iterator<Item = f64>) -> Axis {
    let ends = |(low, high): (f64, f64), v: f64| (low.min(v), high.max(v));
    let (low, high) = values.filter(|v| v.is_finite()).fold((0.98, 1.02), ends);
    let margin = 0.05 * (high - low);
    Axis { low: low - margin, high: high + margin, left: LEFT, right: WIDTH - 50 }
}

fn frame(canvas: &Canvas<'_>, axis: &Axis, rows: &[&Measured], top: i32, row: i32) -> Result<(), ReportError> {
    let bottom = top + row * rows.len() as i32;
    for (k, m) in (0..).zip(rows) {
        let y = top + row * k;
        if k % 2 == 0 {
            canvas.bar((0, y), (WIDTH, y + row), theme::BAND)?;
        }
        canvas.text((LEFT - 30, y + row / 2), &row_label(m.chi.no, &m.name), theme::INK, Align::Right, false)?;
    }
    axis.grid(canvas, top, bottom)?;
    canvas.line(vec![(axis.at(1.0), top), (axis.at(1.0), bottom)], theme::INK, 4)?;
    let caption = "chi = L3D / L2D   (left of 1: shorter than the pattern, right: longer)";
    canvas.text(((LEFT + WIDTH) / 2, bottom + 2 * TYPE + 18), caption, theme::MUTED, Align::Middle, false)
}

/// Published values are hollow marks, failed runs have none. A run's place in `runs` determines its mark; `labels`
/// names the runs.
pub fn chi_chart(title: &str, runs: &[&TryOn], labels: &[String]) -> Result<Chart, ReportError> {
    let rows = measurements(runs);
    let published = runs.iter().flat_map(|r| &r.measured).filter_map(|m| m.published_chi);
    let axis = axis(runs.iter().flat_map(|r| &r.measured).map(|m| m.chi.chi()).chain(published));
    let top = 100 + (TYPE + 20) * (labels.iter().map(|l| l.chars().count() + 5).sum::<usize>() as i32 / 80);
    let row = ROW.max(14 * runs.len() as i32 + 10);
    let svg = draw(top + row * rows.len() as i32 + 3 * TYPE + 30, |canvas| {
        canvas.key(labels, 20, 10)?;
        frame(canvas, &axis, &rows, top, row)?;
        for (k, m) in (0..).zip(&rows) {
            for (series, run) in runs.iter().enumerate() {
                let Some(measured) = run.measurement(m.chi.no) else { continue };
                // Series are offset vertically, so that equal values do not hide each other.
                let spread = (row - 26) as f64 * ((series as f64 + 0.5) / runs.len() as f64 - 0.5);
                let y = top + row * k + row / 2 + spread.round() as i32;
                if let Some(published) = measured.published_chi {
                    canvas.mark((axis.at(published), y), series, true)?;
                }
                canvas.mark((axis.at(measured.chi.chi()), y), series, false)?;
            }
        }
        Ok(())
    })?;
    let alt =
        format!("{title}: chi of {} measurements in {} runs, marks around the line at 1.", rows.len(), runs.len());
    Ok(Chart::new("chi", title, svg, alt))
}

/// Draws the mean of chi over the runs for each measurement, as a bar from 1 with whiskers of one sample standard
/// deviation.
pub fn mean_sd_chart(title: &str, runs: &[&TryOn]) -> Result<Chart, ReportError> {
    let rows = measurements(runs);
    let statistics: Vec<(f64, f64)> = rows
        .iter()
        .map(|m| runs.iter().filter_map(|r| r.measurement(m.chi.no)))
        .map(|row| super::super::text::mean_sd(row.map(|m| m.chi.chi())))
        .collect();
    let axis = axis(statistics.iter().flat_map(|(mean, sd)| [mean - sd, mean + sd]));
    let top = 20;
    let fill = runs.first().map_or(theme::MUTED, |r| theme::simulator(r.simulator));
    let svg = draw(top + ROW * rows.len() as i32 + 3 * TYPE + 30, |canvas| {
        frame(canvas, &axis, &rows, top, ROW)?;
        for (k, (mean, sd)) in (0..).zip(&statistics) {
            let y = top + ROW * k + ROW / 2;
            let (base, end) = (axis.at(1.0), axis.at(*mean));
            canvas.bar((base.min(end), y - 13), (base.max(end).max(base.min(end) + 2), y + 13), fill)?;
            let (low, high) = (axis.at(mean - sd), axis.at(mean + sd));
            canvas.line(vec![(low, y), (high, y)], theme::INK, 4)?;
            for x in [low, high] {
                canvas.line(vec![(x, y - 9), (x, y + 9)], theme::INK, 4)?;
            }
        }
        Ok(())
    })?;
    let alt =
        format!("{title}: mean chi and standard deviation of {} measurements over {} runs.", rows.len(), runs.len());
    Ok(Chart::new("mean", title, svg, alt))
}

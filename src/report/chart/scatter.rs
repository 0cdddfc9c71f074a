//! Scatter charts of EI of every run against ease, and against time.

use super::super::data::TryOn;
use super::super::text::simulator_name;
use super::super::{ReportError, theme};
use super::Chart;
use super::canvas::{Align, Axis, Canvas, TYPE, WIDTH, draw};
use fit::Cuts;
use fit::Simulator;

const LEFT: i32 = 170;
const TOP: i32 = 120;
const BOTTOM: i32 = 620;
/// Greatest number of runs whose dots have names beside them.
const NAMED: usize = 18;

struct Dot {
    x: f64,
    ei: f64,
    simulator: Simulator,
    name: String,
}

/// Draws EI against the ease that decides the fit, with lines at the limits of the fit classes; `None` if no run has
/// both values.
pub fn ease_chart(runs: &[TryOn], cuts: &Cuts) -> Result<Option<Chart>, ReportError> {
    let lines = [(cuts.tight_below_m * 1e3, "tight | just"), (cuts.loose_above_m * 1e3, "just | loose")];
    let dots = dots(runs, |run| run.ease.as_ref().map(|ease| ease.ease_m() * 1e3));
    let ends = lines.map(|(x, _)| x);
    scatter("EI against ease", "ease", "ease, mm   (left: tight, right: loose)", &dots, &ends, &lines)
}

/// Draws EI against wall-clock time; `None` if no run has both values.
pub fn time_chart(runs: &[TryOn]) -> Result<Option<Chart>, ReportError> {
    let dots = dots(runs, |run| (run.wall_s > 0.0).then_some(run.wall_s));
    scatter("EI against time", "time", "wall-clock time of the run, s", &dots, &[0.0], &[])
}

fn dots(runs: &[TryOn], x: impl Fn(&TryOn) -> Option<f64>) -> Vec<Dot> {
    let dot = |run: &TryOn| {
        let name = format!("{} {}", run.size, run.subject);
        Some(Dot { x: x(run)?, ei: run.metrics(|_| true)?.ei, simulator: run.simulator, name })
    };
    runs.iter().filter_map(dot).filter(|dot| dot.x.is_finite() && dot.ei.is_finite()).collect()
}

/// Draws a dot for each run in the colour of its simulator, and vertical `lines` with their names. The horizontal axis
/// contains `ends` too.
fn scatter(
    title: &str,
    kind: &str,
    caption: &str,
    dots: &[Dot],
    ends: &[f64],
    lines: &[(f64, &str)],
) -> Result<Option<Chart>, ReportError> {
    if dots.is_empty() {
        return Ok(None);
    }
    let (low, high) = dots
        .iter()
        .map(|d| d.x)
        .chain(ends.iter().copied())
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
    let margin = 0.06 * (high - low).max(1e-3);
    let low = if low == 0.0 { 0.0 } else { low - margin };
    let across = Axis { low, high: high + margin, left: LEFT, right: WIDTH - 60 };
    let most = dots.iter().map(|d| d.ei).fold(0.01, f64::max);
    let up = Axis { low: 0.0, high: 1.1 * most, left: BOTTOM, right: TOP };
    let svg = draw(BOTTOM + 3 * TYPE + 30, |canvas| {
        across.grid(canvas, TOP, BOTTOM)?;
        frame(canvas, &up, &across, caption)?;
        key(canvas, dots)?;
        for &(x, name) in lines {
            canvas.line(vec![(across.at(x), TOP), (across.at(x), BOTTOM)], theme::MUTED, 3)?;
            canvas.text((across.at(x), TOP - 20), name, theme::MUTED, Align::Middle, false)?;
        }
        for dot in dots {
            canvas.dot((across.at(dot.x), up.at(dot.ei)), theme::simulator(dot.simulator))?;
        }
        if dots.len() <= NAMED { names(canvas, dots, &across, &up) } else { Ok(()) }
    })?;
    let alt = format!("{title} of {} runs, the greatest EI {most:.3}.", dots.len());
    Ok(Some(Chart::new(kind, "ei against", svg, alt)))
}

/// Writes names beside the dots, each moved up until it covers no other name.
fn names(canvas: &Canvas<'_>, dots: &[Dot], across: &Axis, up: &Axis) -> Result<(), ReportError> {
    let mut taken: Vec<(i32, i32, i32)> = Vec::new();
    for dot in dots {
        let (x, mut y, width) = (across.at(dot.x), up.at(dot.ei), canvas.text_width(&dot.name));
        let left = if x + 20 + width > WIDTH { x - 20 - width } else { x + 20 };
        let covers = |y: i32| taken.iter().any(|t| left < t.0 + t.2 && t.0 < left + width && (y - t.1).abs() < TYPE);
        while covers(y) {
            y -= TYPE / 3;
        }
        taken.push((left, y, width));
        canvas.text((left, y), &dot.name, theme::INK, Align::Left, false)?;
    }
    Ok(())
}

fn key(canvas: &Canvas<'_>, dots: &[Dot]) -> Result<(), ReportError> {
    let mut x = LEFT;
    for simulator in [Simulator::Fem, Simulator::Hybrid].into_iter().filter(|s| dots.iter().any(|d| d.simulator == *s))
    {
        canvas.dot((x + 14, 32), theme::simulator(simulator))?;
        let name = simulator_name(simulator);
        canvas.text((x + 38, 32), name, theme::INK, Align::Left, false)?;
        x += 90 + canvas.text_width(name);
    }
    Ok(())
}

fn frame(canvas: &Canvas<'_>, up: &Axis, across: &Axis, caption: &str) -> Result<(), ReportError> {
    let (ticks, decimals) = up.ticks();
    for tick in ticks {
        let y = up.at(tick);
        canvas.line(vec![(across.left, y), (across.right, y)], theme::GRID, 2)?;
        canvas.text((across.left - 16, y), &format!("{tick:.decimals$}"), theme::MUTED, Align::Right, false)?;
    }
    canvas.text((across.left - 16, TOP - 20), "EI", theme::MUTED, Align::Right, false)?;
    let middle = (across.left + across.right) / 2;
    canvas.text((middle, BOTTOM + 2 * TYPE + 18), caption, theme::MUTED, Align::Middle, false)
}

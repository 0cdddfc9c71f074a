//! Chart of E, SD or EI by run, with the two simulators of a subject side by side.

use super::super::data::TryOn;
use super::super::text::simulator_name;
use super::super::{ReportError, theme};
use super::canvas::{Align, Axis, Canvas, ROW, TYPE, WIDTH, draw};
use super::{Chart, shorten};
use fit::Simulator;

const LEFT: i32 = 420;
const TOP: i32 = 70;
const BAR: i32 = 38;
const GAP: i32 = ROW - BAR;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Metric {
    /// Mean chi.
    E,
    /// Sample standard deviation of chi.
    Sd,
    /// Mean |chi - 1|.
    Ei,
}

impl Metric {
    /// Order is that of the thesis.
    pub const ALL: [Self; 3] = [Self::E, Self::Sd, Self::Ei];

    pub fn name(self) -> &'static str {
        match self {
            Self::E => "E",
            Self::Sd => "SD",
            Self::Ei => "EI",
        }
    }

    /// `None` without measurements.
    fn value(self, run: &TryOn) -> Option<f64> {
        let metrics = run.metrics(|_| true)?;
        Some(match self {
            Self::E => metrics.e_chi,
            Self::Sd => metrics.sd_chi,
            Self::Ei => metrics.ei,
        })
        .filter(|value| value.is_finite())
    }

    /// Value for a drape that agrees with its pattern; bars begin there.
    fn base(self) -> f64 {
        if self == Self::E { 1.0 } else { 0.0 }
    }

    fn caption(self) -> &'static str {
        match self {
            Self::E => "E = mean chi   (nearer to 1 is truer; what stretches and what shrinks cancel)",
            Self::Sd => "SD of chi over the measurements   (shorter is more even)",
            Self::Ei => "EI = mean |chi − 1|   (shorter is truer to the pattern)",
        }
    }

    /// An axis that contains the base and all values: symmetric about 1, or from 0.
    fn axis(self, values: impl Iterator<Item = f64>) -> Axis {
        let most = values.map(|value| (value - self.base()).abs()).fold(0.01, f64::max);
        let (low, high) = if self == Self::E { (1.0 - 1.25 * most, 1.0 + 1.25 * most) } else { (0.0, 1.12 * most) };
        Axis { low, high, left: LEFT, right: WIDTH - 60 }
    }
}

/// Draws one bar for each run, in the colour of its simulator and with its value. `labels` names subject and fabric of
/// each run; runs with the same label are adjacent.
pub fn metric_chart(title: &str, metric: Metric, runs: &[&TryOn], labels: &[String]) -> Result<Chart, ReportError> {
    let mut groups: Vec<(&String, Vec<&TryOn>)> = Vec::new();
    for (run, label) in runs.iter().zip(labels) {
        match groups.iter_mut().find(|(l, _)| *l == label) {
            Some((_, members)) => members.push(run),
            None => groups.push((label, vec![run])),
        }
    }
    let values = || runs.iter().filter_map(|run| metric.value(run));
    let axis = metric.axis(values());
    let height = |members: usize| BAR * members as i32 + GAP;
    let bottom = TOP + groups.iter().map(|(_, members)| height(members.len())).sum::<i32>();
    let svg = draw(bottom + 3 * TYPE + 30, |canvas| {
        key(canvas, runs)?;
        axis.grid(canvas, TOP, bottom)?;
        let mut y = TOP;
        for (label, members) in &groups {
            let middle = y + height(members.len()) / 2;
            canvas.text((LEFT - 24, middle), &shorten(label, 26), theme::INK, Align::Right, false)?;
            for (k, run) in (0..).zip(members) {
                bar(canvas, metric, &axis, run, y + GAP / 2 + BAR * k)?;
            }
            y += height(members.len());
        }
        let base = axis.at(metric.base());
        canvas.line(vec![(base, TOP), (base, bottom)], theme::INK, 3)?;
        let middle = (LEFT + WIDTH) / 2;
        canvas.text((middle, bottom + 2 * TYPE + 18), metric.caption(), theme::MUTED, Align::Middle, false)
    })?;
    let name = metric.name();
    let farthest = values().max_by(|a, b| (a - metric.base()).abs().total_cmp(&(b - metric.base()).abs()));
    let farthest = farthest.map_or_else(String::new, |value| format!(", the longest {value:.3}"));
    let alt = format!("{title}: {name} of {} runs as bars{farthest}.", runs.len());
    Ok(Chart::new(&name.to_lowercase(), title, svg, alt))
}

fn bar(canvas: &Canvas<'_>, metric: Metric, axis: &Axis, run: &TryOn, upper: i32) -> Result<(), ReportError> {
    let (base, middle) = (axis.at(metric.base()), upper + BAR / 2);
    let Some(value) = metric.value(run) else {
        return canvas.text((LEFT + 14, middle), "failed", theme::MUTED, Align::Left, false);
    };
    let end = axis.at(value);
    let (left, right) = (base.min(end), base.max(end));
    canvas.bar((left, upper + 2), (right.max(left + 2), upper + BAR - 2), theme::simulator(run.simulator))?;
    let (x, align) = if end < base { (end - 14, Align::Right) } else { (end + 14, Align::Left) };
    canvas.text((x, middle), &format!("{value:.3}"), theme::INK, align, false)
}

fn key(canvas: &Canvas<'_>, runs: &[&TryOn]) -> Result<(), ReportError> {
    let mut x = LEFT;
    for simulator in Simulator::ALL {
        if runs.iter().any(|run| run.simulator == simulator) {
            canvas.bar((x, 18), (x + 28, 46), theme::simulator(simulator))?;
            let name = simulator_name(simulator);
            canvas.text((x + 42, 32), name, theme::INK, Align::Left, false)?;
            x += 110 + canvas.text_width(name);
        }
    }
    Ok(())
}

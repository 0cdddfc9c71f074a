//! EI by run, the two simulators of a subject beside each other.

use super::super::data::Run;
use super::super::{ReportError, theme};
use super::canvas::{Align, Axis, ROW, TYPE, WIDTH, draw};
use super::{Chart, shorten};
use crate::fit::Simulator;

const LEFT: i32 = 420;

/// One bar a run, in the colour of its simulator and with its value; runs of one label share a row group.
///
/// `labels` names what the runs are of (subject, fabric); runs with the same label stand together.
///
/// # Errors
/// [`ReportError::Chart`] where plotters refuses to draw.
pub fn ei_chart(title: &str, runs: &[&Run], labels: &[String]) -> Result<Chart, ReportError> {
    let mut groups: Vec<(&String, Vec<&Run>)> = Vec::new();
    for (run, label) in runs.iter().zip(labels) {
        match groups.iter_mut().find(|(l, _)| *l == label) {
            Some((_, members)) => members.push(run),
            None => groups.push((label, vec![run])),
        }
    }
    let ei = |run: &Run| run.metrics(|_| true).map(|m| m.ei);
    let most = runs.iter().filter_map(|r| ei(r)).fold(0.01, f64::max);
    let axis = Axis { low: 0.0, high: most * 1.12, left: LEFT, right: WIDTH - 60 };
    let simulators: Vec<Simulator> =
        [Simulator::Fem, Simulator::Hybrid].into_iter().filter(|s| runs.iter().any(|r| r.simulator == *s)).collect();
    let (bar, gap, top) = (38, ROW - 38, 70);
    let height = |members: usize| bar * members as i32 + gap;
    let bottom = top + groups.iter().map(|(_, m)| height(m.len())).sum::<i32>();
    let svg = draw(bottom + 3 * TYPE + 30, |canvas| {
        let mut x = LEFT;
        for simulator in simulators {
            canvas.bar((x, 18), (x + 28, 46), theme::simulator(simulator))?;
            let name = super::super::text::simulator_name(simulator);
            canvas.text((x + 42, 32), name, theme::INK, Align::Left, false)?;
            x += 110 + canvas.text_width(name);
        }
        axis.grid(canvas, top, bottom)?;
        let mut y = top;
        for (label, members) in &groups {
            let middle = y + height(members.len()) / 2;
            canvas.text((LEFT - 24, middle), &shorten(label, 26), theme::INK, Align::Right, false)?;
            for (k, run) in (0..).zip(members) {
                let upper = y + gap / 2 + bar * k;
                let Some(ei) = ei(run) else {
                    canvas.text((LEFT + 14, upper + bar / 2), "failed", theme::MUTED, Align::Left, false)?;
                    continue;
                };
                let end = axis.at(ei);
                canvas.bar((LEFT, upper + 2), (end.max(LEFT + 2), upper + bar - 2), theme::simulator(run.simulator))?;
                let value = format!("{ei:.3}");
                canvas.text((end + 14, upper + bar / 2), &value, theme::INK, Align::Left, false)?;
            }
            y += height(members.len());
        }
        canvas.line(vec![(LEFT, top), (LEFT, bottom)], theme::INK, 3)?;
        let caption = "EI = mean |chi − 1|   (shorter is truer to the pattern)";
        canvas.text(((LEFT + WIDTH) / 2, bottom + 2 * TYPE + 18), caption, theme::MUTED, Align::Middle, false)
    })?;
    let alt = format!("{title}: EI of {} runs as bars, the longest {most:.3}.", runs.len());
    Ok(Chart::new("ei", title, svg, alt))
}

//! Charts of EI of FEM-GS less EI of Hybrid-GS: means with intervals by row, and every case against its ease.

use super::super::text::{number, signed};
use super::super::{ReportError, theme};
use super::canvas::{Align, Axis, Canvas, ROW, TYPE, WIDTH, draw};
use super::{Chart, shorten};
use fit::{Crossover, Cuts, MARGIN, Pair};

const LEFT: i32 = 560;
const UNDER: i32 = 3 * TYPE + 30;

pub struct Difference {
    pub label: String,
    /// Mean over subjects.
    pub mean: f64,
    /// Confidence interval of the mean.
    pub interval: Option<(f64, f64)>,
}

/// Half range of an axis around 0 that contains all values and the margin of equivalence.
fn reach(values: impl Iterator<Item = f64>) -> f64 {
    1.08 * values.filter(|v| v.is_finite()).fold(1.3 * MARGIN, |most, v| most.max(v.abs()))
}

/// Draws a row for each difference: a dot with its interval, the margin of equivalence as a band around 0, and a line
/// at `whole`. `kind` becomes part of the file name.
pub fn difference_chart(
    title: &str,
    kind: &str,
    rows: &[Difference],
    whole: Option<f64>,
) -> Result<Chart, ReportError> {
    let ends = rows.iter().flat_map(|row| {
        let (low, high) = row.interval.unwrap_or((row.mean, row.mean));
        [row.mean, low, high]
    });
    let reach = reach(ends.chain(whole));
    let axis = Axis { low: -reach, high: reach, left: LEFT, right: WIDTH - 190 };
    let (top, bottom) = (60, 60 + ROW * rows.len() as i32);
    let svg = draw(bottom + UNDER, |canvas| {
        canvas.bar((axis.at(-MARGIN), top), (axis.at(MARGIN), bottom), theme::BAND)?;
        axis.grid(canvas, top, bottom)?;
        sides(canvas, (axis.left, axis.right), top - 30)?;
        canvas.line(vec![(axis.at(0.0), top), (axis.at(0.0), bottom)], theme::INK, 4)?;
        if let Some(whole) = whole {
            canvas.line(vec![(axis.at(whole), top), (axis.at(whole), bottom)], theme::MUTED, 3)?;
        }
        for (k, row) in (0..).zip(rows) {
            let y = top + ROW * k + ROW / 2;
            canvas.text((LEFT - 24, y), &shorten(&row.label, 36), theme::INK, Align::Right, false)?;
            if let Some((low, high)) = row.interval {
                canvas.line(vec![(axis.at(low), y), (axis.at(high), y)], theme::INK, 4)?;
            }
            canvas.dot((axis.at(row.mean), y), side(row.mean))?;
            canvas.text((WIDTH - 20, y), &signed(row.mean, 4), theme::INK, Align::Right, false)?;
        }
        let caption = "EI of FEM-GS less EI of Hybrid-GS, mean over subjects   (band: no practical difference)";
        canvas.text((WIDTH / 2, bottom + 2 * TYPE + 18), caption, theme::MUTED, Align::Middle, false)
    })?;
    let said: Vec<String> = rows.iter().map(|row| format!("{} {}", row.label, signed(row.mean, 4))).collect();
    Ok(Chart::new(kind, title, svg, format!("{title}: EI difference of {}.", said.join(", "))))
}

/// Labels the ends of the axis with the simulator that they favour.
fn sides(canvas: &Canvas<'_>, (left, right): (i32, i32), y: i32) -> Result<(), ReportError> {
    canvas.text((left, y), "← FEM-GS truer", theme::MUTED, Align::Left, false)?;
    canvas.text((right, y), "Hybrid-GS truer →", theme::MUTED, Align::Right, false)
}

/// Colour of the simulator that a difference favours.
fn side(difference: f64) -> render::Rgb {
    theme::simulator(if difference < 0.0 { fit::Simulator::Fem } else { fit::Simulator::Hybrid })
}

struct Dot {
    ease_mm: f64,
    /// EI of FEM-GS less EI of Hybrid-GS.
    difference: f64,
    garment: String,
}

/// Draws the EI difference of every case against its ease, and the regression line. A band shows the interval in which
/// the line crosses 0, where it is known. `None` without cases.
pub fn crossover_chart(
    title: &str,
    pairs: &[&Pair],
    crossover: Option<&Crossover>,
    cuts: &Cuts,
) -> Result<Option<Chart>, ReportError> {
    let dot = |pair: &&Pair| {
        Some(Dot { ease_mm: pair.ease_m * 1e3, difference: pair.d_ei(|_| true)?, garment: pair.garment.clone() })
    };
    let dots: Vec<Dot> = pairs.iter().filter_map(dot).collect();
    if dots.is_empty() {
        return Ok(None);
    }
    let lines = [(cuts.tight_below_m * 1e3, "tight | just"), (cuts.loose_above_m * 1e3, "just | loose")];
    let eases = || dots.iter().map(|dot| dot.ease_mm).chain(lines.map(|line| line.0));
    let (low, high) = (eases().fold(f64::INFINITY, f64::min), eases().fold(f64::NEG_INFINITY, f64::max));
    let margin = 0.06 * (high - low);
    let (top, bottom) = (190, 740);
    let across = Axis { low: low - margin, high: high + margin, left: 190, right: WIDTH - 50 };
    let reach = reach(dots.iter().map(|dot| dot.difference));
    let up = Axis { low: -reach, high: reach, left: bottom, right: top };
    let garments = super::super::text::distinct(dots.iter().map(|dot| dot.garment.as_str()));
    let names: Vec<String> = garments.iter().map(|name| (*name).to_owned()).collect();
    let svg = draw(bottom + UNDER, |canvas| {
        canvas.key(&names, 20, 10)?;
        canvas.text(
            (20, top - 70),
            "above 0: Hybrid-GS truer; below: FEM-GS truer",
            theme::MUTED,
            Align::Left,
            false,
        )?;
        if let Some(ease) = crossover.and_then(|found| found.ease) {
            let left = across.at(ease.low_m * 1e3);
            canvas.bar((left, top), (across.at(ease.high_m * 1e3).max(left + 3), bottom), theme::BAND)?;
        }
        across.grid(canvas, top, bottom)?;
        let (ticks, decimals) = up.ticks();
        for tick in ticks {
            canvas.line(vec![(across.left, up.at(tick)), (across.right, up.at(tick))], theme::GRID, 2)?;
            canvas.text((across.left - 16, up.at(tick)), &number(tick, decimals), theme::MUTED, Align::Right, false)?;
        }
        canvas.line(vec![(across.left, up.at(0.0)), (across.right, up.at(0.0))], theme::INK, 4)?;
        for (x, name) in lines {
            canvas.line(vec![(across.at(x), top), (across.at(x), bottom)], theme::MUTED, 3)?;
            canvas.text((across.at(x), top - 20), name, theme::MUTED, Align::Middle, false)?;
        }
        if let Some(found) = crossover {
            let point = |ease_m: f64| (across.at(ease_m * 1e3), up.at(found.at_zero + found.slope_per_m * ease_m));
            canvas.line(vec![point(found.range_m.0), point(found.range_m.1)], theme::MUTED, 4)?;
        }
        for Dot { ease_mm, difference, garment } in &dots {
            let series = garments.iter().position(|name| name == garment).unwrap_or_default();
            canvas.mark((across.at(*ease_mm), up.at(*difference)), series, false)?;
        }
        let caption = "ease, mm   (left: tight, right: loose); EI of FEM-GS less EI of Hybrid-GS upwards";
        canvas.text(
            ((across.left + across.right) / 2, bottom + 2 * TYPE + 18),
            caption,
            theme::MUTED,
            Align::Middle,
            false,
        )
    })?;
    let words = crossover.map_or_else(String::new, |found| format!(" Crossover: {found}."));
    let alt = format!("{title}: EI difference of {} cases against ease.{words}", dots.len());
    Ok(Some(Chart::new("crossover", title, svg, alt)))
}

//! Chart of a cross section: the body with the cloth of several sizes, and the gap around the body.

use super::super::text::number;
use super::super::{ReportError, theme};
use super::Chart;
use super::canvas::{Align, Axis, Canvas, TYPE, draw};
use fit::on_body::{Angle, DIRECTIONS, Section};
use geom::V2;
use geom::units::mm;
use render::Rgb;

/// Number of directions in which the curves of the gap are drawn.
const FINE: usize = 120;
/// Number of sectors around the body for each of which the greatest gap is written.
const WRITTEN: usize = 8;
/// Distance of the numbers from the cloth.
const WRITTEN_OFF: f64 = 34.0;
/// Left and right side of the square in which the section is drawn.
const SQUARE: (i32, i32) = (40, 700);
const CURVES_LEFT: i32 = 880;
const KEY_LEFT: i32 = 790;

#[derive(Clone, Debug)]
pub struct Worn<'a> {
    pub label: String,
    /// True if the gaps of this size are written beside the section, as those of the recommended size are.
    pub is_written: bool,
    pub section: &'a Section,
}

/// Draws sizes of one garment on one body, cut at one level.
pub fn section_chart(title: &str, sizes: &[Worn<'_>]) -> Result<Chart, ReportError> {
    let (top, key) = (70, sizes.len() as i32 * (TYPE + 14));
    let bottom = top + SQUARE.1 - SQUARE.0;
    let svg = draw(bottom + 10, |canvas| {
        canvas.text((SQUARE.0, 36), title, theme::INK, Align::Left, true)?;
        plan(canvas, sizes, top)?;
        curves(canvas, sizes, top + 30, bottom - 70 - key)?;
        for (series, size) in sizes.iter().enumerate() {
            let y = bottom + 16 - key + series as i32 * (TYPE + 14);
            canvas.line(vec![(KEY_LEFT, y), (KEY_LEFT + 50, y)], colour(series), 6)?;
            let text = format!("{}: {}", size.label, gaps_in_words(size.section));
            canvas.text((KEY_LEFT + 70, y), &text, theme::INK, Align::Left, false)?;
        }
        Ok(())
    })?;
    let words: Vec<String> =
        sizes.iter().map(|size| format!("{}: {}", size.label, gaps_in_words(size.section))).collect();
    Ok(Chart::new("section", title, svg, format!("{title}. {}.", words.join("; "))))
}

fn colour(series: usize) -> Rgb {
    theme::SUBJECTS[series % theme::SUBJECTS.len()]
}

/// Mean, least and greatest gap in words.
fn gaps_in_words(section: &Section) -> String {
    let gaps: Vec<f64> = section.gaps(DIRECTIONS).into_iter().filter_map(|angle| angle.gap_m).map(mm).collect();
    let (Some(least), Some(greatest)) = (gaps.iter().copied().reduce(f64::min), gaps.iter().copied().reduce(f64::max))
    else {
        return "no cloth here".to_owned();
    };
    let mean = gaps.iter().sum::<f64>() / gaps.len() as f64;
    format!("gap {} mm on average, from {} to {}", number(mean, 0), number(least, 0), number(greatest, 0))
}

/// Direction of the greatest gap in each sector. Sectors are centred at the front, the back and the sides, and between
/// them.
fn greatest(section: &Section) -> Vec<Angle> {
    let sector_of = |angle: &Angle| (angle.deg * WRITTEN as f64 / 360.0).round() as usize % WRITTEN;
    let angles = section.gaps(FINE);
    let sectors = (0..WRITTEN).filter_map(|sector| {
        let own = angles.iter().filter(|angle| sector_of(angle) == sector && angle.gap_m.is_some());
        own.copied().max_by(|a, b| a.gap_m.unwrap_or(f64::MIN).total_cmp(&b.gap_m.unwrap_or(f64::MIN)))
    });
    sectors.collect()
}

/// Draws the section from above, the front upwards.
fn plan(canvas: &Canvas<'_>, sizes: &[Worn<'_>], top: i32) -> Result<(), ReportError> {
    let Some(first) = sizes.first() else { return Ok(()) };
    let centre = first.section.centre;
    let angles = || sizes.iter().flat_map(|size| size.section.gaps(FINE));
    let reach = angles().map(|angle| angle.skin_m + angle.gap_m.unwrap_or(0.0)).fold(0.05, f64::max);
    let half = f64::from(SQUARE.1 - SQUARE.0) / 2.0;
    let (scale, middle) = (0.86 * half / reach, (f64::from(SQUARE.0) + half, f64::from(top) + half));
    let place = |p: &V2| {
        let away = (p - centre) * scale;
        ((middle.0 + away.x).round() as i32, (middle.1 - away.y).round() as i32)
    };
    let is_within = |p: &V2| ((p - centre) * scale).amax() < half;
    for limb in first.section.others.iter().chain([&first.section.skin]) {
        if limb.points.iter().all(is_within) {
            canvas.area(limb.points.iter().map(place).collect(), theme::GRID)?;
        }
    }
    for (series, size) in sizes.iter().enumerate() {
        for line in &size.section.cloth {
            let ring: Vec<&V2> = line.points.iter().chain(line.points.first().filter(|_| line.closed)).collect();
            for run in ring.split(|p| !is_within(p)).filter(|run| run.len() > 1) {
                canvas.line(run.iter().map(|p| place(p)).collect(), colour(series), 4)?;
            }
        }
    }
    for size in sizes.iter().filter(|size| size.is_written) {
        for angle in greatest(size.section) {
            let Some(gap_m) = angle.gap_m else { continue };
            let (sin, cos) = angle.deg.to_radians().sin_cos();
            let away = V2::new(sin, cos) * (angle.skin_m + gap_m.max(0.0) + WRITTEN_OFF / scale);
            canvas.text(place(&(centre + away)), &number(mm(gap_m), 0), theme::INK, Align::Middle, true)?;
        }
    }
    let (left, low) = (SQUARE.0, top + SQUARE.1 - SQUARE.0);
    canvas.text((left, top + TYPE), "front", theme::MUTED, Align::Left, false)?;
    canvas.text((left, low - TYPE), "back", theme::MUTED, Align::Left, false)?;
    let bar = (0.1 * scale).round() as i32;
    canvas.line(vec![(SQUARE.1 - bar, low - 12), (SQUARE.1, low - 12)], theme::MUTED, 3)?;
    canvas.text((SQUARE.1, low - 12 - TYPE), "100 mm", theme::MUTED, Align::Right, false)
}

/// Draws the gap around the body, from the front via the subject's right.
fn curves(canvas: &Canvas<'_>, sizes: &[Worn<'_>], top: i32, bottom: i32) -> Result<(), ReportError> {
    let rounds: Vec<Vec<(f64, Option<f64>)>> = sizes
        .iter()
        .map(|size| size.section.gaps(FINE).into_iter().map(|angle| (angle.deg, angle.gap_m.map(mm))).collect())
        .collect();
    let all = || rounds.iter().flatten().filter_map(|(_, gap)| *gap);
    let (low, high) = all().fold((0.0_f64, 20.0_f64), |(low, high), gap| (low.min(gap), high.max(gap)));
    let axis = Axis { low: 0.0, high: 360.0, left: CURVES_LEFT, right: super::canvas::WIDTH - 60 };
    let (ticks, _) = Axis { low, high, left: 0, right: 1 }.ticks();
    let height = |gap: f64| bottom - ((gap - low) / (high - low) * f64::from(bottom - top)).round() as i32;
    canvas.text((axis.left - 90, top - 54), "gap, mm", theme::MUTED, Align::Left, false)?;
    for tick in ticks {
        let y = height(tick);
        let ink = if tick == 0.0 { theme::MUTED } else { theme::GRID };
        canvas.line(vec![(axis.left, y), (axis.right, y)], ink, 2)?;
        canvas.text((axis.left - 16, y), &number(tick, 0), theme::MUTED, Align::Right, false)?;
    }
    for (deg, side) in [(0.0, "front"), (90.0, "right"), (180.0, "back"), (270.0, "left"), (360.0, "front")] {
        let x = axis.at(deg);
        canvas.line(vec![(x, top), (x, bottom)], theme::GRID, 2)?;
        canvas.text((x, bottom + TYPE), side, theme::MUTED, Align::Middle, false)?;
    }
    for (series, round) in rounds.iter().enumerate() {
        let closed: Vec<(f64, Option<f64>)> =
            round.iter().copied().chain(round.first().map(|(_, gap)| (360.0, *gap))).collect();
        for run in closed.split(|(_, gap)| gap.is_none()).filter(|run| run.len() > 1) {
            let line = run.iter().filter_map(|(deg, gap)| Some((axis.at(*deg), height((*gap)?)))).collect();
            canvas.line(line, colour(series), 4)?;
        }
    }
    Ok(())
}

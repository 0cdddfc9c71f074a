//! Chart of the probable ease of each size at each level, beside its target.

use super::super::text::number;
use super::super::{ReportError, theme};
use super::Chart;
use super::canvas::{Align, Axis, ROW, TYPE, WIDTH, draw};
use geom::units::mm;

const LEFT: i32 = 330;
const TOP: i32 = 110;
/// Width of the column for the probabilities.
const SHARES: i32 = 150;

/// Distribution of the ease of a size at a level.
#[derive(Clone, Debug, PartialEq)]
pub struct Probable {
    pub size: String,
    pub level: String,
    /// Lower and upper end; `None` without a target.
    pub target_m: Option<[f64; 2]>,
    /// Lower end, median and upper end of the 80 % interval.
    pub ease_m: [f64; 3],
    /// Probability that the ease is within its target; `None` without a target.
    pub share: Option<f64>,
}

/// Draws a group of rows for each level, with a row for each size: a bar for the target, a line for the 80 % interval,
/// a mark at the median, and the probability of the target.
pub fn chance_chart(title: &str, rows: &[Probable]) -> Result<Chart, ReportError> {
    let (sizes, levels) = (names(rows, |row| &row.size), names(rows, |row| &row.level));
    let height = ROW.max((TYPE + 10) * sizes.len() as i32 + 14);
    let ends = rows.iter().flat_map(|row| row.ease_m.into_iter().chain(row.target_m.into_iter().flatten()));
    // A band without an upper end reaches to the end of the axis.
    let (low, high) = ends
        .map(mm)
        .filter(|end| end.is_finite())
        .fold((0.0_f64, 0.0_f64), |(low, high), end| (low.min(end), high.max(end)));
    let margin = 0.04 * (high - low).max(1.0);
    let axis = Axis { low: low - margin, high: high + margin, left: LEFT, right: WIDTH - SHARES };
    let bottom = TOP + height * levels.len() as i32;
    let svg = draw(bottom + 3 * TYPE + 30, |canvas| {
        canvas.text((30, 28), title, theme::INK, Align::Left, true)?;
        canvas.key(&sizes, LEFT, 46)?;
        canvas.text((WIDTH - 20, 74), "as meant", theme::MUTED, Align::Right, false)?;
        for (k, level) in (0..).zip(&levels) {
            let top = TOP + height * k;
            if k % 2 == 0 {
                canvas.bar((0, top), (WIDTH, top + height), theme::BAND)?;
            }
            canvas.text((LEFT - 24, top + height / 2), level, theme::INK, Align::Right, false)?;
            let target = rows.iter().find(|row| row.level == *level).and_then(|row| row.target_m);
            if let Some([least, most]) = target.map(|band| band.map(mm)) {
                canvas.bar((axis.at(least), top + 6), (axis.at(most.min(axis.high)), top + height - 6), theme::GRID)?;
            }
        }
        axis.grid(canvas, TOP, bottom)?;
        for row in rows {
            let place = |names: &[String], name: &str| names.iter().position(|known| known == name).unwrap_or(0);
            let (series, level) = (place(&sizes, &row.size), place(&levels, &row.level));
            let step = height / sizes.len().max(1) as i32;
            let y = TOP + height * level as i32 + step * series as i32 + step / 2;
            let ink = theme::SUBJECTS[series % theme::SUBJECTS.len()];
            let [low, middle, high] = row.ease_m.map(|end| axis.at(mm(end)));
            canvas.line(vec![(low, y), (high, y)], ink, 6)?;
            canvas.mark((middle, y), series, false)?;
            if let Some(share) = row.share {
                let text = format!("{} %", number(100.0 * share, 0));
                canvas.text((WIDTH - 20, y), &text, theme::INK, Align::Right, false)?;
            }
        }
        let caption = "ease, mm   (grey: meant; line: 80 % interval)";
        canvas.text((WIDTH / 2, bottom + 2 * TYPE + 18), caption, theme::MUTED, Align::Middle, false)
    })?;
    let words: Vec<String> = rows.iter().map(words).collect();
    Ok(Chart::new("chance", title, svg, format!("{title}: 80 % intervals of the ease. {}.", words.join("; "))))
}

fn words(row: &Probable) -> String {
    let [low, _, high] = row.ease_m.map(|end| number(mm(end), 0));
    format!("{} {} {low} to {high} mm", row.size, row.level)
}

/// Distinct, in the order of their first appearance.
fn names(rows: &[Probable], name: impl Fn(&Probable) -> &String) -> Vec<String> {
    let mut found: Vec<String> = Vec::new();
    for row in rows {
        if !found.contains(name(row)) {
            found.push(name(row).clone());
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_level_of_every_size_is_drawn_with_its_share() {
        let row = |size: &str, level: &str, middle: f64, share: f64| Probable {
            size: size.to_owned(),
            level: level.to_owned(),
            target_m: Some([0.050, 0.120]),
            ease_m: [middle - 0.012, middle, middle + 0.012],
            share: Some(share),
        };
        let rows = [row("S", "chest", 0.020, 0.01), row("M", "chest", 0.080, 0.97), row("M", "hip", 0.060, 0.83)];
        let chart = chance_chart("shirt on her", &rows).expect("it is drawn");
        for text in ["shirt on her", "chest", "hip", "1 %", "97 %", "83 %", "as meant"] {
            assert!(chart.svg().contains(text), "{text}");
        }
        assert!(chart.alt().contains("M hip 48 to 72 mm"), "{}", chart.alt());
        assert!(chart.png().is_ok());
    }
}

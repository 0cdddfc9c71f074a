//! Scatter plot of people by two girths, with a box for each size: the pattern's own sizes beside the new ones.

use std::fmt::Write;

use crate::grading::Judged;
use crate::grading::knobs::Band;
use crate::grading::people::Figure;
use crate::grading::tally::order;
use geom::units::mm;
use pattern::Style;
use results::scatter::{self, COLOURS, Panel, axis, escaped};

/// Side of a panel, and its margins, px.
const PANEL: f64 = 460.0;
const MARGIN: f64 = 60.0;
/// Greatest number of people in the picture.
const MOST: usize = 800;

/// Draws people held out by the first and the last trunk girth that has a band: in the colour of the size that fits,
/// grey where none does. A box shows the girths that a size fits at both levels.
pub(super) fn svg(figures: &[Figure], bands: &[Band], sets: &[Judged<'_>], garment: &str) -> String {
    let girths: Vec<&Band> = bands.iter().filter(|band| order(&band.level) < GIRTHS).collect();
    let across = girths.first().copied().or(bands.first());
    let up = girths.last().copied().or(bands.last());
    let (Some(across), Some(up)) = (across, up) else { return String::new() };
    let shown: Vec<(usize, [f64; 2])> = figures
        .iter()
        .enumerate()
        .filter_map(|(person, figure)| {
            Some((person, [mm(figure.girth_m(&across.level)?), mm(figure.girth_m(&up.level)?)]))
        })
        .take(MOST)
        .collect();
    let x = axis(shown.iter().map(|(_, at)| at[0]));
    let y = axis(shown.iter().map(|(_, at)| at[1]));
    let (width, height) = (2.0 * (PANEL + MARGIN) + MARGIN, PANEL + 2.2 * MARGIN);
    let mut svg = scatter::head(width, height);
    let named = |level: &str| format!("{}, mm", escaped(&level.replace('_', " ")));
    let labels = [named(&across.level), named(&up.level)];
    let middle = crate::grading::in_the_middle(figures, &across.level);
    for (which, set) in sets.iter().enumerate() {
        let panel = Panel { left: MARGIN + which as f64 * (PANEL + MARGIN), side: PANEL, margin: MARGIN, x, y };
        let title = escaped(&format!("{garment}: {}", set.title));
        panel.frame(&mut svg, &title, labels.each_ref().map(String::as_str));
        let tally = set.tally;
        for (person, at) in &shown {
            draw_dot(&mut svg, &panel, *at, tally.is_fitted(*person).then(|| tally.wears(*person)));
        }
        for (size, style) in set.styles.iter().enumerate() {
            let girths = middle.and_then(|middle| fitted_mm(middle, style, [across, up]));
            girths.into_iter().for_each(|girths| draw_box(&mut svg, &panel, girths, size));
        }
        draw_legend(&mut svg, &panel, set, figures.len());
    }
    svg.push_str("</svg>\n");
    svg
}

/// Number of levels that are girths of the trunk, the first in their order.
const GIRTHS: usize = 5;

/// Least and greatest body girth that a style fits at two levels, for a person of the stature of `somebody`.
fn fitted_mm(somebody: &Figure, style: &Style, bands: [&Band; 2]) -> Option<[[f64; 2]; 2]> {
    let levels = bands.map(|band| band.level.clone());
    let eases = somebody.eases(style, &levels);
    let fitted = |k: usize| {
        let length_m = eases[k]? + somebody.girth_m(&levels[k])?;
        let [least, most] = bands[k].band_m;
        Some([mm(length_m - most), mm(length_m - least)])
    };
    Some([fitted(0)?, fitted(1)?])
}

/// Grey for `None`.
fn colour(size: Option<usize>) -> &'static str {
    size.map_or("#cccccc", |size| COLOURS[size % COLOURS.len()])
}

fn draw_dot(svg: &mut String, panel: &Panel, [x, y]: [f64; 2], size: Option<usize>) {
    let (x, y, colour) = (panel.across(x), panel.up(y), colour(size));
    // Writing to a `String` does not fail, here and below.
    let _ = writeln!(svg, "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"2.6\" fill=\"{colour}\"/>");
}

fn draw_box(svg: &mut String, panel: &Panel, [across, up]: [[f64; 2]; 2], size: usize) {
    let right = panel.left + PANEL;
    let [from, to] = across.map(|x| panel.across(x).clamp(panel.left, right));
    let [below, above] = up.map(|y| panel.up(y).clamp(MARGIN, MARGIN + PANEL));
    let _ = writeln!(
        svg,
        "<rect x=\"{from:.1}\" y=\"{above:.1}\" width=\"{:.1}\" height=\"{:.1}\" fill=\"none\" stroke=\"{}\" \
        stroke-width=\"2\"/>",
        to - from,
        below - above,
        colour(Some(size))
    );
}

fn draw_legend(svg: &mut String, panel: &Panel, set: &Judged<'_>, people: usize) {
    let tally = set.tally;
    let share = |size: Option<usize>| {
        let wears = |person: &usize| tally.is_fitted(*person).then(|| tally.wears(*person)) == size;
        100.0 * (0..people).filter(wears).count() as f64 / people.max(1) as f64
    };
    let sizes = set.names.iter().enumerate().map(|(size, name)| (name.as_str(), Some(size)));
    for (number, (name, size)) in sizes.chain([("none", None)]).enumerate() {
        panel.legend(svg, number, colour(size), &format!("{}: {:.1} %", escaped(name), share(size)));
    }
}

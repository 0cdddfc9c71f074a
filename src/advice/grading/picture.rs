//! Scatter plot of people by two girths with the boxes of the sizes: the pattern's own beside the new ones.

use std::fmt::Write;

use crate::grading::Judged;
use crate::grading::knobs::Band;
use crate::grading::people::Figure;
use crate::grading::tally::{Tally, order};
use geom::units::mm;
use pattern::Style;
use results::size_map::{COLOURS, axis, escaped};

/// Side of a panel, and its margins, px.
const PANEL: f64 = 460.0;
const MARGIN: f64 = 60.0;
/// Greatest number of people that are drawn.
const MOST: usize = 800;

/// Draws people held out by the first and the last girth that has a band, in the colour of the size that fits, grey
/// where none does. A box is the range of girths that a size fits at both levels.
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
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" height=\"{height}\" \
        font-family=\"DejaVu Sans, sans-serif\" font-size=\"12\" fill=\"#222\">\n<rect width=\"100%\" height=\"100%\" \
        fill=\"white\"/>\n"
    );
    let middle = crate::grading::in_the_middle(figures, &across.level);
    for (which, set) in sets.iter().enumerate() {
        let panel = Panel { left: MARGIN + which as f64 * (PANEL + MARGIN), x, y };
        panel.frame(&mut svg, &format!("{garment}: {}", set.title), [&across.level, &up.level]);
        let tally = set.tally;
        for (person, at) in &shown {
            panel.dot(&mut svg, *at, tally.is_fitted(*person).then(|| tally.wears(*person)));
        }
        for (size, style) in set.styles.iter().enumerate() {
            let girths = middle.and_then(|middle| fitted_mm(middle, style, [across, up]));
            girths.into_iter().for_each(|girths| panel.size(&mut svg, girths, size));
        }
        panel.legend(&mut svg, set.names, tally, figures.len());
    }
    svg.push_str("</svg>\n");
    svg
}

/// Number of levels that are girths of the trunk.
const GIRTHS: usize = 5;

/// Least and greatest girth of a body that a style fits at two levels, for somebody of that stature, mm.
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

/// Position of a panel, and its axes.
struct Panel {
    left: f64,
    x: (f64, f64),
    y: (f64, f64),
}

impl Panel {
    fn across(&self, x: f64) -> f64 {
        self.left + (x - self.x.0) / (self.x.1 - self.x.0) * PANEL
    }

    fn up(&self, y: f64) -> f64 {
        MARGIN + PANEL - (y - self.y.0) / (self.y.1 - self.y.0) * PANEL
    }

    /// Frame, title and axes.
    fn frame(&self, svg: &mut String, title: &str, [across, up]: [&str; 2]) {
        let Self { left, x, y } = self;
        let bottom = MARGIN + PANEL;
        // Writing into a text does not fail, here and below.
        let _ = writeln!(svg, "<text x=\"{left}\" y=\"24\" font-size=\"16\">{}</text>", escaped(title));
        let _ = writeln!(
            svg,
            "<rect x=\"{left}\" y=\"{MARGIN}\" width=\"{PANEL}\" height=\"{PANEL}\" fill=\"none\" stroke=\"#999\"/>"
        );
        for k in 0..=4 {
            let share = f64::from(k) / 4.0;
            let (at_x, at_y) = (x.0 + (x.1 - x.0) * share, y.0 + (y.1 - y.0) * share);
            let (place, below) = (self.across(at_x), bottom + 16.0);
            let _ = writeln!(svg, "<text x=\"{place:.1}\" y=\"{below}\" text-anchor=\"middle\">{at_x:.0}</text>");
            let (place, beside) = (self.up(at_y) + 4.0, left - 5.0);
            let _ = writeln!(svg, "<text x=\"{beside}\" y=\"{place:.1}\" text-anchor=\"end\">{at_y:.0}</text>");
        }
        let (middle, below) = (left + PANEL / 2.0, bottom + 36.0);
        let named = |level: &str| escaped(&level.replace('_', " "));
        let _ = writeln!(svg, "<text x=\"{middle}\" y=\"{below}\" text-anchor=\"middle\">{}, mm</text>", named(across));
        let _ = writeln!(svg, "<text x=\"{left}\" y=\"{}\">{}, mm</text>", MARGIN - 8.0, named(up));
    }

    /// Draws a person in the colour of a size.
    fn dot(&self, svg: &mut String, at: [f64; 2], size: Option<usize>) {
        let (x, y) = (self.across(at[0]), self.up(at[1]));
        let colour = size.map_or("#cccccc", |size| COLOURS[size % COLOURS.len()]);
        let _ = writeln!(svg, "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"2.6\" fill=\"{colour}\"/>");
    }

    /// Draws the range of girths that a size fits.
    fn size(&self, svg: &mut String, [across, up]: [[f64; 2]; 2], size: usize) {
        let right = self.left + PANEL;
        let [from, to] = across.map(|x| self.across(x).clamp(self.left, right));
        let [below, above] = up.map(|y| self.up(y).clamp(MARGIN, MARGIN + PANEL));
        let colour = COLOURS[size % COLOURS.len()];
        let _ = writeln!(
            svg,
            "<rect x=\"{from:.1}\" y=\"{above:.1}\" width=\"{:.1}\" height=\"{:.1}\" fill=\"none\" stroke=\"{colour}\" \
            stroke-width=\"2\"/>",
            to - from,
            below - above
        );
    }

    /// Draws the legend of the colours, with shares.
    fn legend(&self, svg: &mut String, names: &[String], tally: &Tally, people: usize) {
        let share = |size: Option<usize>| {
            let wears = |person: &usize| tally.is_fitted(*person).then(|| tally.wears(*person)) == size;
            100.0 * (0..people).filter(wears).count() as f64 / people.max(1) as f64
        };
        let sizes = names.iter().enumerate().map(|(size, name)| (name.as_str(), Some(size)));
        for (k, (name, size)) in sizes.chain([("none", None)]).enumerate() {
            let y = MARGIN + 18.0 + 18.0 * k as f64;
            let colour = size.map_or("#cccccc", |size| COLOURS[size % COLOURS.len()]);
            let _ = writeln!(svg, "<circle cx=\"{}\" cy=\"{}\" r=\"5\" fill=\"{colour}\"/>", self.left + 14.0, y - 4.0);
            let text = format!("{}: {:.1} %", escaped(name), share(size));
            let _ = writeln!(svg, "<text x=\"{}\" y=\"{y}\">{text}</text>", self.left + 24.0);
        }
    }
}

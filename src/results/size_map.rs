//! Scatter plot of the subjects of a study by stature and girth, in the colour of the size to wear.

use std::fmt::Write;

use pattern::size_order;
use store::{Result, Store, read};

/// Colours that differ in lightness too [Okabe & Ito 2008].
pub const COLOURS: [&str; 7] = ["#0072b2", "#e69f00", "#009e73", "#cc79a7", "#56b4e9", "#d55e00", "#f0e442"];
/// Side of a panel, and its margins, px.
const PANEL: f64 = 420.0;
const MARGIN: f64 = 56.0;

/// A subject in one garment, with its size to wear.
struct Dot {
    garment: String,
    subject: String,
    stature_mm: f64,
    girth_mm: f64,
    level: String,
    size: String,
    fit: String,
}

/// Draws an SVG picture of a study with a panel for each garment and a dot for each subject, in the colour of the size
/// to wear. A dot is hollow where even that size is tight or loose at some level.
///
/// # Errors
/// When there is no such study.
pub fn size_map(store: &Store, study: &str) -> Result<String> {
    read::study(store, study)?;
    let dots = dots(store, study)?;
    let mut garments: Vec<&str> = dots.iter().map(|dot| dot.garment.as_str()).collect();
    garments.dedup();
    let width = (PANEL + MARGIN) * garments.len().max(1) as f64 + MARGIN;
    let height = PANEL + 2.0 * MARGIN;
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" height=\"{height}\" \
        font-family=\"DejaVu Sans, sans-serif\" font-size=\"12\" fill=\"#222\">\n<rect width=\"100%\" height=\"100%\" \
        fill=\"white\"/>\n"
    );
    for (number, garment) in garments.into_iter().enumerate() {
        let of_garment: Vec<&Dot> = dots.iter().filter(|dot| dot.garment == garment).collect();
        panel(&mut svg, garment, &of_garment, MARGIN + number as f64 * (PANEL + MARGIN));
    }
    svg.push_str("</svg>\n");
    Ok(svg)
}

/// Every subject in every garment with its size to wear, by garment.
fn dots(store: &Store, study: &str) -> Result<Vec<Dot>> {
    let sql = "WITH known AS (
            SELECT DISTINCT job.subject, stature_mm FROM job JOIN subject USING (subject_id) JOIN study USING (study_id)
            WHERE study.name = :study AND is_current
        )
        SELECT garment, best.subject, stature_mm, body_girth_mm, level, size, verdict
        FROM v_size AS best JOIN known USING (subject) JOIN v_ease USING (study, garment, size, subject)
        WHERE study = :study AND place = 1 AND decides ORDER BY garment, subject";
    let mut statement = store.reader.prepare_cached(sql)?;
    let dots = statement.query_map(rusqlite::named_params! { ":study": study }, |row| {
        Ok(Dot {
            garment: row.get(0)?,
            subject: row.get(1)?,
            stature_mm: row.get(2)?,
            girth_mm: row.get(3)?,
            level: row.get(4)?,
            size: row.get(5)?,
            fit: row.get(6)?,
        })
    })?;
    Ok(dots.collect::<rusqlite::Result<_>>()?)
}

/// Draws one garment: axes, dots, and the legend of the colours.
fn panel(svg: &mut String, garment: &str, dots: &[&Dot], left: f64) {
    let (x, y) = (axis(dots.iter().map(|dot| dot.stature_mm)), axis(dots.iter().map(|dot| dot.girth_mm)));
    let across = |stature_mm: f64| left + (stature_mm - x.0) / (x.1 - x.0) * PANEL;
    let up = |girth_mm: f64| MARGIN + PANEL - (girth_mm - y.0) / (y.1 - y.0) * PANEL;
    let mut sizes: Vec<&str> = dots.iter().map(|dot| dot.size.as_str()).collect();
    sizes.sort_unstable();
    sizes.dedup();
    size_order::sort(&mut sizes, |size| size);
    let colour = |size: &str| COLOURS[sizes.iter().position(|known| *known == size).unwrap_or(0) % COLOURS.len()];
    let (bottom, middle) = (MARGIN + PANEL, left + PANEL / 2.0);
    // Writing into a text does not fail, here and below.
    let _ = writeln!(svg, "<text x=\"{left}\" y=\"24\" font-size=\"16\">{}</text>", escaped(garment));
    let _ = writeln!(
        svg,
        "<rect x=\"{left}\" y=\"{MARGIN}\" width=\"{PANEL}\" height=\"{PANEL}\" fill=\"none\" stroke=\"#999\"/>"
    );
    for k in 0..=4 {
        let (at_x, at_y) = (x.0 + (x.1 - x.0) * f64::from(k) / 4.0, y.0 + (y.1 - y.0) * f64::from(k) / 4.0);
        let _ = writeln!(
            svg,
            "<text x=\"{:.1}\" y=\"{}\" text-anchor=\"middle\">{at_x:.0}</text>",
            across(at_x),
            bottom + 16.0
        );
        let _ = writeln!(
            svg,
            "<text x=\"{}\" y=\"{:.1}\" text-anchor=\"end\">{at_y:.0}</text>",
            left - 5.0,
            up(at_y) + 4.0
        );
    }
    let _ = writeln!(svg, "<text x=\"{middle}\" y=\"{}\" text-anchor=\"middle\">stature, mm</text>", bottom + 36.0);
    let level = dots.first().map_or("", |dot| dot.level.as_str());
    let _ = writeln!(svg, "<text x=\"{left}\" y=\"{}\">{} girth, mm</text>", MARGIN - 8.0, escaped(level));
    for dot in dots {
        let (x, y, colour) = (across(dot.stature_mm), up(dot.girth_mm), colour(&dot.size));
        let fill = if dot.fit == "as_meant" { colour } else { "white" };
        let _ = writeln!(
            svg,
            "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"6\" fill=\"{fill}\" stroke=\"{colour}\" stroke-width=\"2\"><title>{}: {} \
            ({})</title></circle>",
            escaped(&dot.subject),
            escaped(&dot.size),
            dot.fit
        );
    }
    for (k, size) in sizes.iter().enumerate() {
        let count = dots.iter().filter(|dot| dot.size == *size).count();
        let meant = dots.iter().filter(|dot| dot.size == *size && dot.fit == "as_meant").count();
        let at = MARGIN + 18.0 + 18.0 * k as f64;
        let colour = colour(size);
        let _ = writeln!(svg, "<circle cx=\"{}\" cy=\"{}\" r=\"5\" fill=\"{colour}\"/>", left + 14.0, at - 4.0);
        let text = format!("{}: {count}, as meant for {meant}", escaped(size));
        let _ = writeln!(svg, "<text x=\"{}\" y=\"{at}\">{text}</text>", left + 24.0);
    }
}

/// Limits around some values, rounded outwards to hundreds.
pub fn axis(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let (low, high) = values.fold((f64::MAX, f64::MIN), |(low, high), value| (low.min(value), high.max(value)));
    if low > high {
        return (0.0, 100.0);
    }
    (((low - 10.0) / 100.0).floor() * 100.0, ((high + 10.0) / 100.0).ceil() * 100.0)
}

/// Text with the characters escaped that XML reserves.
pub fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

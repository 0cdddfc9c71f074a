//! Scatter plot of a study's subjects by stature and girth, coloured by the size to wear.

use std::fmt::Write;

use crate::scatter::{self, COLOURS, Panel, axis, escaped};
use pattern::size_order;
use store::{Result, Store, read};

/// Side of a panel, and its margins, px.
const PANEL: f64 = 420.0;
const MARGIN: f64 = 56.0;

struct Dot {
    garment: String,
    subject: String,
    stature_mm: f64,
    girth_mm: f64,
    level: String,
    size: String,
    fit: String,
}

/// Draws an SVG picture of a study: a panel for each garment, a dot for each subject in the colour of the size to wear.
/// A dot is hollow where that size is tight or loose at some level.
pub fn size_map(store: &Store, study: &str) -> Result<String> {
    read::study(store, study)?;
    let dots = dots(store, study)?;
    let mut garments: Vec<&str> = dots.iter().map(|dot| dot.garment.as_str()).collect();
    garments.dedup();
    let width = (PANEL + MARGIN) * garments.len().max(1) as f64 + MARGIN;
    let height = PANEL + 2.0 * MARGIN;
    let mut svg = scatter::head(width, height);
    for (number, garment) in garments.into_iter().enumerate() {
        let of_garment: Vec<&Dot> = dots.iter().filter(|dot| dot.garment == garment).collect();
        panel(&mut svg, garment, &of_garment, MARGIN + number as f64 * (PANEL + MARGIN));
    }
    svg.push_str("</svg>\n");
    Ok(svg)
}

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

fn panel(svg: &mut String, garment: &str, dots: &[&Dot], left: f64) {
    let (x, y) = (axis(dots.iter().map(|dot| dot.stature_mm)), axis(dots.iter().map(|dot| dot.girth_mm)));
    let panel = Panel { left, side: PANEL, margin: MARGIN, x, y };
    let mut sizes: Vec<&str> = dots.iter().map(|dot| dot.size.as_str()).collect();
    sizes.sort_unstable();
    sizes.dedup();
    size_order::sort(&mut sizes, |size| size);
    let colour = |size: &str| COLOURS[sizes.iter().position(|known| *known == size).unwrap_or(0) % COLOURS.len()];
    let level = dots.first().map_or("", |dot| dot.level.as_str());
    panel.frame(svg, &escaped(garment), ["stature, mm", &format!("{} girth, mm", escaped(level))]);
    for dot in dots {
        let (x, y, colour) = (panel.across(dot.stature_mm), panel.up(dot.girth_mm), colour(&dot.size));
        let fill = if dot.fit == "as_meant" { colour } else { "white" };
        // Writing to a `String` does not fail.
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
        panel.legend(svg, k, colour(size), &format!("{}: {count}, as meant for {meant}", escaped(size)));
    }
}

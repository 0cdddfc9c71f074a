//! Drawing of all pieces of a style, seen from outside, as SVG in millimetres. It has numbered corners and edges, grain
//! lines, notches and numbered measurements. `changed` draws a style before and after a change.

mod changed;

pub use self::changed::changed_svg;

use std::fmt::Write as _;

use super::MeasurementKind;
use super::arrange::{arranged, hung};
use super::pom::PointOfMeasure;
use super::style::{PathPart, Style, StyleMeasurement, StylePiece};
use geom::V2;
use geom::polyline::Polyline;
use geom::units::{from_mm, mm};

const MARGIN_MM: f64 = 45.0;
const TITLE_MM: f64 = 30.0;
const NOTCH_MM: f64 = 9.0;
/// Distance of corner and measurement numbers from the outline.
const LABEL_MM: f64 = 17.0;
/// Not at the middle of the edge, where lines across the piece end.
const EDGE_LABEL_SHARE: f64 = 0.4;
const EDGE_NUMBER_SHARE: f64 = 0.6;
/// The accent colour marks measured lines.
const CSS: &str = "\
text{font-family:'DejaVu Sans',sans-serif;fill:#3a3a3a}\
.piece{fill:#f6f3ec;stroke:#3a3a3a;stroke-width:1.4;stroke-linejoin:round}\
.free{fill:none;stroke:#3a3a3a;stroke-width:1.4;stroke-dasharray:7 4}\
.before{fill:none;stroke:#c0392b;stroke-width:1.2;stroke-dasharray:5 4}\
.way{fill:none;stroke:#c0392b;stroke-width:1.6;stroke-linecap:round;stroke-linejoin:round}\
.under{fill:#fff;fill-opacity:.85}\
.by{font-size:14px;font-weight:bold;fill:#c0392b;text-anchor:middle}\
.thin{fill:none;stroke:#8a8a8a;stroke-width:1}\
.measured{fill:none;stroke:#0a6a8a;stroke-width:2.6;stroke-linecap:round;opacity:.75}\
.across{fill:none;stroke:#0a6a8a;stroke-width:1.4;stroke-dasharray:9 5}\
.disc{fill:#0a6a8a}\
.no{fill:#fff;font-size:13px;font-weight:bold;text-anchor:middle}\
.corner{font-size:11px;fill:#8a8a8a;text-anchor:middle}\
.edge{font-size:13px;font-style:italic;fill:#a04a1a;text-anchor:middle}\
.title{font-size:19px;font-weight:bold}\
.note{font-size:15px}";

/// Draws all pieces of a style about the head (see [`arrange`](super::arrange)), with a legend of the measurements below.
pub fn svg(style: &Style) -> String {
    drawn(&arranged(style))
}

fn drawn(style: &Style) -> String {
    let all: Vec<V2> = style.pieces.iter().flat_map(StylePiece::outline).collect();
    let (low, high) = bounds_mm(&all);
    let sheet = high - low + V2::repeat(2.0 * MARGIN_MM) + V2::new(0.0, TITLE_MM);
    let pen = Pen { origin: V2::new(MARGIN_MM - low.x, MARGIN_MM + TITLE_MM + high.y) };
    let rows = style.measurements.len().div_ceil(legend_columns(style, sheet.x)).max(1);
    let (width, height) = (sheet.x, sheet.y + MARGIN_MM + 24.0 * rows as f64);
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width:.0} {height:.0}\" width=\"{width:.0}\" height=\"{height:.0}\">\n\
         <style>{CSS}</style>\n<rect width=\"{width:.0}\" height=\"{height:.0}\" fill=\"#fff\"/>\n"
    );
    for (index, piece) in style.pieces.iter().enumerate() {
        pen.piece(&mut out, &style.size, piece);
        pen.numbers(&mut out, piece);
        pen.measurements(&mut out, style, index);
    }
    legend(&mut out, style, sheet, rows);
    out.push_str("</svg>\n");
    out
}

/// Draws as [`svg`] does, with all pieces head up, and with points of measure in place of measurements.
pub fn points_svg(style: &Style) -> String {
    let points = style.points_of_measure().into_iter().zip(1..);
    let measurement = |(measure, no): (PointOfMeasure, u32)| StyleMeasurement {
        no,
        name: measure.point.as_str().replace('_', " "),
        kind: MeasurementKind::OpenLength,
        path: measure.path,
        l2d_m: measure.length_m,
        is_free_edge: false,
    };
    drawn(&hung(&Style { measurements: points.map(measurement).collect(), ..style.clone() }))
}

fn bounds_mm(points: &[V2]) -> (V2, V2) {
    let first = points.first().copied().unwrap_or_default();
    let (low, high) = points.iter().fold((first, first), |(low, high), p| (low.inf(p), high.sup(p)));
    (low.map(mm), high.map(mm))
}

/// Maps the layout in metres, `y` up, to the sheet in millimetres, `y` down.
struct Pen {
    origin: V2,
}

impl Pen {
    fn at(&self, point: V2) -> V2 {
        V2::new(self.origin.x + mm(point.x), self.origin.y - mm(point.y))
    }

    fn path(&self, out: &mut String, class: &str, points: impl IntoIterator<Item = V2>, is_closed: bool) {
        let _ = write!(out, "<path class=\"{class}\" d=\"");
        for (k, point) in points.into_iter().enumerate() {
            let p = self.at(point);
            let _ = write!(out, "{}{:.2} {:.2}", if k == 0 { 'M' } else { 'L' }, p.x, p.y);
        }
        out.push_str(if is_closed { "Z\"/>\n" } else { "\"/>\n" });
    }

    fn piece(&self, out: &mut String, size: &str, piece: &StylePiece) {
        let outline = piece.outline();
        self.path(out, "piece", outline.iter().copied(), true);
        for notch in &piece.notches {
            let angle = notch.angle_deg.unwrap_or(90.0).to_radians();
            let inner = notch.at + V2::new(angle.cos(), angle.sin()) * from_mm(NOTCH_MM);
            self.path(out, "free", [notch.at, inner], false);
        }
        self.grain(out, piece, &outline);
        let at = self.title_at(&outline);
        let title = escaped(&title(piece, size));
        let _ = writeln!(out, "<text class=\"title\" x=\"{:.1}\" y=\"{:.1}\">{title}</text>", at.x, at.y);
    }

    /// Lower left corner on the sheet.
    fn title_at(&self, outline: &[V2]) -> V2 {
        let (low, high) = bounds_mm(outline);
        V2::new(self.origin.x + low.x, self.origin.y - high.y - 14.0)
    }

    fn numbers(&self, out: &mut String, piece: &StylePiece) {
        let outline = piece.outline();
        for (number, &corner) in piece.corners.iter().enumerate() {
            let p = self.at(corner) + outwards(&outline, corner) * (0.7 * LABEL_MM) + V2::new(0.0, 4.0);
            let _ = writeln!(out, "<text class=\"corner\" x=\"{:.1}\" y=\"{:.1}\">{number}</text>", p.x, p.y);
        }
        self.edge_numbers(out, piece);
    }

    /// Numbers run counter-clockwise from 1. Edits of seams name edges by them.
    fn edge_numbers(&self, out: &mut String, piece: &StylePiece) {
        for (index, edge) in piece.edges.iter().enumerate() {
            let p = self.beside(&edge.line, EDGE_NUMBER_SHARE, 0.8 * LABEL_MM) + V2::new(0.0, 4.5);
            let _ = writeln!(out, "<text class=\"edge\" x=\"{:.1}\" y=\"{:.1}\">{}</text>", p.x, p.y, index + 1);
        }
    }

    /// Point on the sheet beside an edge, inside its piece.
    fn beside(&self, line: &Polyline, share: f64, distance_mm: f64) -> V2 {
        let arc = share * line.length();
        let along = line.at(arc + 1e-3) - line.at(arc - 1e-3);
        let inwards = V2::new(-along.y, along.x).try_normalize(0.0).unwrap_or_else(V2::zeros);
        self.at(line.at(arc) + inwards * from_mm(distance_mm))
    }

    fn grain(&self, out: &mut String, piece: &StylePiece, outline: &[V2]) {
        let (low, high) = bounds_mm(outline);
        let middle = V2::new(0.72 * low.x + 0.28 * high.x, 0.5 * (low.y + high.y)) * 1e-3;
        let half = piece.grain * (0.12e-3 * (high.y - low.y));
        let side = V2::new(-piece.grain.y, piece.grain.x) * 0.005;
        let barb = piece.grain * 0.012;
        for (tip, sign) in [(middle + half, 1.0), (middle - half, -1.0)] {
            self.path(out, "thin", [tip - barb * sign + side, tip, tip - barb * sign - side], false);
        }
        self.path(out, "thin", [middle - half, middle + half], false);
    }

    fn measurements(&self, out: &mut String, style: &Style, index: usize) {
        let mut labels = Vec::new();
        for measurement in &style.measurements {
            for part in &measurement.path {
                match *part {
                    PathPart::Edge(edge) if edge.piece == index => {
                        let line = &style.edge(edge).line;
                        self.path(out, "measured", line.points().iter().copied(), false);
                        labels.push((self.beside(line, EDGE_LABEL_SHARE, LABEL_MM), measurement.no));
                    }
                    PathPart::Line(ends) if ends[0].edge.piece == index => {
                        let [from, to] = ends.map(|end| style.place(end));
                        self.path(out, "across", [from, to], false);
                        labels.push((self.at(from.lerp(&to, 0.45)), measurement.no));
                    }
                    _ => {}
                }
            }
        }
        labels.into_iter().for_each(|(place, no)| numbered_disc(out, place, no));
    }
}

fn title(piece: &StylePiece, size: &str) -> String {
    format!("{} {size}", piece.id.replace('_', " "))
}

/// Direction on the sheet, longer at a reflex corner, where the gap is narrow.
fn outwards(outline: &[V2], corner: V2) -> V2 {
    let n = outline.len();
    let distance = |i: usize| (outline[i] - corner).norm();
    let nearest = (0..n).min_by(|&i, &j| distance(i).total_cmp(&distance(j))).unwrap_or(0);
    let before = (outline[nearest] - outline[(nearest + n - 1) % n]).normalize();
    let after = (outline[(nearest + 1) % n] - outline[nearest]).normalize();
    // The right side of a counter-clockwise outline is outside.
    let right = |along: V2| V2::new(along.y, -along.x);
    let sum = right(before) + right(after);
    let normal = sum.try_normalize(1e-9).unwrap_or_else(|| right(after));
    let is_reflex = before.perp(&after) < 0.0;
    let reach = if is_reflex { (2.0 / sum.norm()).clamp(1.0, 3.0) } else { 1.0 };
    V2::new(normal.x, -normal.y) * reach
}

fn numbered_disc(out: &mut String, place: V2, no: u32) {
    let _ = writeln!(
        out,
        "<circle class=\"disc\" cx=\"{:.1}\" cy=\"{:.1}\" r=\"10.5\"/><text class=\"no\" x=\"{:.1}\" y=\"{:.1}\">{no}</text>",
        place.x,
        place.y,
        place.x,
        place.y + 4.8
    );
}

/// Three, or fewer where a sheet is too narrow for the longest name.
fn legend_columns(style: &Style, width: f64) -> usize {
    let letters = style.measurements.iter().map(|m| m.name.chars().count()).max().unwrap_or(0);
    // Letters of 15 mm are 9 mm wide. The row also holds a numbered disc and a length.
    let widest = 9.0 * letters as f64 + 130.0;
    ((width - 2.0 * MARGIN_MM) / widest).clamp(1.0, 3.0) as usize
}

fn legend(out: &mut String, style: &Style, sheet: V2, rows: usize) {
    let columns = style.measurements.len().div_ceil(rows).max(1) as f64;
    for (k, measurement) in style.measurements.iter().enumerate() {
        let x = MARGIN_MM + 10.0 + (sheet.x - 2.0 * MARGIN_MM) * (k / rows) as f64 / columns;
        let y = sheet.y + 24.0 * (k % rows) as f64 + 10.0;
        numbered_disc(out, V2::new(x, y), measurement.no);
        let name = escaped(&measurement.name);
        let length = mm(measurement.l2d_m);
        let _ = writeln!(
            out,
            "<text class=\"note\" x=\"{:.1}\" y=\"{:.1}\">{name} {length:.1} mm</text>",
            x + 18.0,
            y + 5.5
        );
    }
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draft::{TSHIRT_SEAMS, TshirtSize, tshirt};

    #[test]
    fn the_sheet_shows_every_piece_corner_and_measurement() {
        let mut style = Style::read(&tshirt(TshirtSize::M).pieces, TSHIRT_SEAMS, "a.toml").expect("it is a style");
        style.pieces[0].id = "back <&>".to_owned();
        let sheet = svg(&style);
        let count = |what: &str| sheet.matches(what).count();
        assert_eq!(count("class=\"piece\""), 4);
        assert_eq!(count("class=\"edge\""), style.pieces.iter().map(|piece| piece.edges.len()).sum::<usize>());
        assert_eq!(count("class=\"corner\""), style.pieces.iter().map(|piece| piece.corners.len()).sum::<usize>());
        assert_eq!(count("class=\"no\""), 9 + style.measurements.iter().map(|m| m.path.len()).sum::<usize>());
        assert!(sheet.contains("back &lt;&amp;&gt; M") && sheet.contains("Sleeve Length 130.7 mm"));
        assert!(!sheet.contains("NaN"));
        let points = points_svg(&style);
        assert!(points.contains("half chest 517.0 mm") && points.contains("centre back length 720.0 mm"), "{points}");
    }
}

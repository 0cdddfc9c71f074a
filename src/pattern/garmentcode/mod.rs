//! GarmentCode JSON, read and written: panels with curved edges and stitches, converted to and from a [`Style`].
//!
//! A panel whose loop runs clockwise is drawn as seen from inside the garment, because `pygarment` orients loops by the
//! normal that points away from the body. Such a panel is mirrored here, so that all pieces are seen from outside.
//! Edges keep the order of the file, and edge `k` is named `e<k>`.
//!
//! The format has no sizes, notches and grain lines. The grain is the `y` axis of the panel. The [`Role`]s come from
//! the panel names, by the words that seam proposals know, else from the places of the panels (`worn`). Several panels
//! may have the same role.

mod export;
pub mod format;
pub mod worn;

use std::collections::BTreeSet;

pub use self::export::document;
use self::format::{Curvature, Curve, Document, Panel, StitchItem};
use self::worn::{Part, Place};
use super::curve::{arc, bezier};
use super::garment::Role;
use super::inspect::{FileReport, PieceReport};
use super::piece::Piece;
use super::propose::{roles, said};
use super::style::shrinkage::Shrinkage;
use super::style::{Edge, EdgeRef, Seam, Style, StylePiece};
use super::table::unmarked;
use geom::polyline::{Polyline, self_crossing, signed_area};
use geom::units::mm;
use geom::{V2, V3};
use nalgebra::{Rotation3, Unit};

/// Limit of coordinates and radii.
const GREATEST_M: f64 = 100.0;
/// Flag of a stitch whose sides run in the same direction.
const RIGHT_WRONG: &str = "right_wrong";

#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{file}: {place}: found {found}; accepted: {accepted}")]
pub struct GarmentCodeError {
    pub file: String,
    pub place: String,
    pub found: String,
    pub accepted: String,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Specification {
    pub file: String,
    pub mm_per_unit: f64,
    /// Panels seen from outside, in the order of their names. [`Piece::is_clockwise_in_file`] is true for mirrored
    /// ones.
    pub pieces: Vec<Piece>,
    pub places: Vec<Place>,
    /// Edges of each piece, in the order of the file.
    pub edges: Vec<Vec<Polyline>>,
    pub stitches: Vec<Stitch>,
}

/// A dart if both edges belong to one panel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stitch {
    pub sides: [EdgeRef; 2],
    /// True if start meets start (`right_wrong`). Otherwise start meets end.
    pub same_direction: bool,
}

pub fn read(bytes: &[u8], file: &str) -> Result<Specification, GarmentCodeError> {
    let reader = Reader { file };
    let document: Document = serde_json::from_slice(unmarked(bytes)).map_err(|error| {
        reader.error(
            "the file",
            error.to_string(),
            "a GarmentCode specification (JSON with `pattern` and `properties`)",
        )
    })?;
    reader.specification(&document)
}

struct Reader<'a> {
    file: &'a str,
}

impl Reader<'_> {
    fn error(&self, place: &str, found: String, accepted: &str) -> GarmentCodeError {
        let (place, accepted) = (place.to_owned(), accepted.to_owned());
        GarmentCodeError { file: self.file.to_owned(), place, found, accepted }
    }

    fn specification(&self, document: &Document) -> Result<Specification, GarmentCodeError> {
        let properties = &document.properties;
        if properties.curvature_coords != "relative" {
            return Err(self.error("curvature_coords", format!("`{}`", properties.curvature_coords), "`relative`"));
        }
        let unit_m = 1.0 / properties.units_in_meter;
        if !(1e-6..=1e3).contains(&unit_m) {
            return Err(self.error("units_in_meter", properties.units_in_meter.to_string(), "100 for centimetres"));
        }
        let panels = &document.pattern.panels;
        let mut all = Specification {
            file: self.file.to_owned(),
            mm_per_unit: mm(unit_m),
            pieces: Vec::new(),
            places: Vec::new(),
            edges: Vec::new(),
            stitches: Vec::new(),
        };
        for (name, panel) in panels {
            let (piece, edges) = self.panel(name, panel, unit_m)?;
            all.places.push(place(panel, unit_m, &piece));
            all.pieces.push(piece);
            all.edges.push(edges);
        }
        let mut sewn = BTreeSet::new();
        for (k, items) in document.pattern.stitches.iter().enumerate() {
            let place = format!("stitch {k}");
            let stitch = self.stitch(&place, items, &all)?;
            for side in stitch.sides {
                if !sewn.insert(side) {
                    let found = format!("edge {} of panel `{}` again", side.edge, all.pieces[side.piece].block);
                    return Err(self.error(&place, found, "each edge in at most one stitch"));
                }
            }
            all.stitches.push(stitch);
        }
        Ok(all)
    }

    /// Piece seen from outside, and its edges.
    fn panel(&self, name: &str, panel: &Panel, unit_m: f64) -> Result<(Piece, Vec<Polyline>), GarmentCodeError> {
        let place = format!("panel `{name}`");
        let vertices: Vec<V2> = panel.vertices.iter().map(|&[x, y]| V2::new(x, y) * unit_m).collect();
        if let Some(vertex) = vertices.iter().find(|vertex| vertex.norm() > GREATEST_M) {
            let found = format!("a vertex at ({:.0}, {:.0}) m", vertex.x, vertex.y);
            return Err(self.error(&place, found, "coordinates of at most 100 m"));
        }
        let mut edges = Vec::new();
        for (k, edge) in panel.edges.iter().enumerate() {
            let place = format!("panel `{name}`, edge {k}");
            let next = &panel.edges[(k + 1) % panel.edges.len()];
            let [from, to] = edge.endpoints;
            if to != next.endpoints[0] {
                let found = format!("end {to} before start {}", next.endpoints[0]);
                return Err(self.error(&place, found, "edges in loop order, each beginning where the last one ends"));
            }
            let (Some(&start), Some(&end)) = (vertices.get(from), vertices.get(to)) else {
                let found = format!("endpoints {from} and {to}");
                return Err(self.error(&place, found, &format!("numbers below {}", vertices.len())));
            };
            edges.push(self.curve(&place, start, end, edge.curvature.as_ref(), unit_m)?);
        }
        let outline: Vec<V2> =
            edges.iter().flat_map(|edge| edge.points()[..edge.points().len() - 1].to_vec()).collect();
        let area = signed_area(&outline);
        if outline.len() < 3 || area == 0.0 {
            return Err(self.error(&place, format!("{} edges without area", edges.len()), "a loop round an area"));
        }
        if let Some(at) = self_crossing(&outline) {
            let found = format!("an outline that crosses itself at ({:.1}, {:.1}) mm", mm(at.x), mm(at.y));
            return Err(self.error(&place, found, "an outline free of crossings"));
        }
        let is_clockwise = area < 0.0;
        if is_clockwise {
            edges = edges.iter().map(mirrored).collect();
        }
        Ok((piece(name, &edges, is_clockwise), edges))
    }

    fn curve(
        &self,
        place: &str,
        start: V2,
        end: V2,
        curvature: Option<&Curvature>,
        unit_m: f64,
    ) -> Result<Polyline, GarmentCodeError> {
        let chord = end - start;
        let left = V2::new(-chord.y, chord.x);
        let relative = |[u, v]: [f64; 2]| start + chord * u + left * v;
        // The cubic Bezier curve with these control points is the quadratic one.
        let quadratic = |control: [f64; 2]| {
            let control = relative(control);
            bezier([start, start.lerp(&control, 2.0 / 3.0), end.lerp(&control, 2.0 / 3.0), end])
        };
        let points = match curvature {
            None => vec![start, end],
            Some(Curvature::Old(control) | Curvature::Typed(Curve::Quadratic([control]))) => quadratic(*control),
            Some(Curvature::Typed(Curve::Cubic([a, b]))) => bezier([start, relative(*a), relative(*b), end]),
            Some(Curvature::Typed(Curve::Circle(radius, is_long, is_left))) => {
                let radius_m = radius * unit_m;
                let half_turn = (0.5 * chord.norm() / radius_m).min(1.0).asin();
                if !(radius_m <= GREATEST_M && radius_m >= 0.5 * chord.norm() * (1.0 - 1e-6) && half_turn > 0.0) {
                    let found = format!("radius {radius} for a chord of {:.3}", chord.norm() / unit_m);
                    return Err(self.error(place, found, "a radius of at least half the chord, at most 100 m"));
                }
                let turn = if *is_long > 0 { std::f64::consts::TAU - 2.0 * half_turn } else { 2.0 * half_turn };
                circle(start, end, radius_m, if *is_left > 0 { turn } else { -turn })
            }
        };
        let is_near = |point: &V2| point.norm() <= 10.0 * GREATEST_M;
        if start == end || !points.iter().all(is_near) {
            return Err(self.error(
                place,
                "no length, or an end out of reach".to_owned(),
                "a curve between two points",
            ));
        }
        Polyline::new(points).ok_or_else(|| self.error(place, "no points".to_owned(), "a curve between two points"))
    }

    fn stitch(&self, place: &str, items: &[StitchItem], all: &Specification) -> Result<Stitch, GarmentCodeError> {
        let (sides, same_direction) = match items {
            [a, b] => ([a, b], false),
            [a, b, StitchItem::Flag(flag)] if flag == RIGHT_WRONG => ([a, b], true),
            _ => {
                let found = format!("{} items", items.len());
                return Err(self.error(place, found, "two sides and, where both run the same way, `right_wrong`"));
            }
        };
        let resolve = |item: &StitchItem| {
            let StitchItem::Side { panel, edge } = item else {
                return Err(self.error(place, "a flag for a side".to_owned(), "`panel` and `edge`"));
            };
            let piece = all.pieces.iter().position(|piece| piece.block == *panel);
            let edges = piece.map_or(0, |piece| all.edges[piece].len());
            match piece {
                Some(piece) if *edge < edges => Ok(EdgeRef { piece, edge: *edge }),
                _ => {
                    let found = format!("edge {edge} of panel `{panel}`");
                    Err(self.error(place, found, "an edge of a panel of the file"))
                }
            }
        };
        Ok(Stitch { sides: [resolve(sides[0])?, resolve(sides[1])?], same_direction })
    }
}

fn place(panel: &Panel, unit_m: f64, piece: &Piece) -> Place {
    let low = piece.outline.iter().fold(V2::repeat(f64::MAX), |low, p| low.inf(p));
    let high = piece.outline.iter().fold(V2::repeat(f64::MIN), |high, p| high.sup(p));
    let centre = (low + high) * 0.5;
    let in_file = if piece.is_clockwise_in_file { V2::new(-centre.x, centre.y) } else { centre };
    let about = |axis: Unit<V3>, angle: f64| Rotation3::from_axis_angle(&axis, angle.to_radians());
    let [x, y, z] = panel.rotation;
    let turn = about(V3::x_axis(), x) * about(V3::y_axis(), y) * about(V3::z_axis(), z);
    Place {
        middle: turn * V3::new(in_file.x, in_file.y, 0.0) + V3::from(panel.translation) * unit_m,
        normal: turn * V3::z(),
        centre,
        size: high - low,
        part: Part::of_label(&panel.label),
    }
}

/// Arc with the turning angle `turn`, radians, positive to the left.
fn circle(start: V2, end: V2, radius: f64, turn: f64) -> Vec<V2> {
    let chord = end - start;
    let heading = chord.y.atan2(chord.x) - 0.5 * turn;
    let along = V2::new(heading.cos(), heading.sin());
    let left = V2::new(-along.y, along.x);
    let mut points: Vec<V2> =
        arc(radius * turn.abs(), turn).into_iter().map(|p| start + along * p.x + left * p.y).collect();
    if let Some(last) = points.last_mut() {
        *last = end;
    }
    points
}

/// Keeps the direction, so that a clockwise loop becomes counter-clockwise.
fn mirrored(edge: &Polyline) -> Polyline {
    let points = edge.points().iter().map(|p| V2::new(-p.x, p.y)).collect();
    Polyline::new(points).expect("as many points as before")
}

fn piece(name: &str, edges: &[Polyline], is_clockwise_in_file: bool) -> Piece {
    let inner = |edge: &Polyline| edge.points()[1..edge.points().len() - 1].to_vec();
    Piece {
        block: name.to_owned(),
        name: name.to_owned(),
        quantity: Some("1".to_owned()),
        outline: edges.iter().flat_map(|edge| edge.points()[..edge.points().len() - 1].to_vec()).collect(),
        is_clockwise_in_file,
        turn_points: edges.iter().map(|edge| edge.points()[0]).collect(),
        curve_points: edges.iter().flat_map(inner).collect(),
        ..Piece::default()
    }
}

impl Specification {
    /// Sewn by the stitches, without measurements.
    pub fn style(&self) -> Style {
        let edge = |(k, line): (usize, &Polyline)| Edge {
            name: Some(format!("e{k}")),
            line: line.clone(),
            corners: Vec::new(),
        };
        let named: Vec<_> = self.pieces.iter().map(|piece| said(&piece.block)).collect();
        let roles = roles(&worn::told(self, &named));
        let style_piece = |((piece, edges), role): ((&Piece, &Vec<Polyline>), Role)| StylePiece {
            id: piece.block.clone(),
            role,
            edges: edges.iter().enumerate().map(edge).collect(),
            grain: V2::y(),
            notches: Vec::new(),
            corners: piece.turn_points.clone(),
        };
        let seam = |(k, stitch): (usize, &Stitch)| Seam {
            name: format!("stitch_{k}"),
            a: vec![stitch.sides[0]],
            b: vec![stitch.sides[1]],
            b_forwards: stitch.same_direction,
        };
        let name = self.file.rsplit('/').next().unwrap_or_default();
        let stem = name.rsplit_once('.').map_or(name, |(stem, _)| stem);
        Style {
            name: stem.strip_suffix("_specification").unwrap_or(stem).to_owned(),
            size: String::new(),
            pieces: self.pieces.iter().zip(&self.edges).zip(roles).map(style_piece).collect(),
            seams: self.stitches.iter().enumerate().map(seam).collect(),
            measurements: Vec::new(),
            reinforcements: Vec::new(),
            fit_levels: Vec::new(),
            shrinkage: Shrinkage::default(),
        }
    }
}

impl From<&Specification> for FileReport {
    fn from(specification: &Specification) -> Self {
        Self {
            file: specification.file.clone(),
            format: "GarmentCode JSON".to_owned(),
            units: format!("{} mm", specification.mm_per_unit),
            mm_per_unit: Some(specification.mm_per_unit),
            pieces: specification.pieces.iter().map(PieceReport::from).collect(),
            refused: Vec::new(),
            warnings: Vec::new(),
            unused: Default::default(),
            error: None,
            written: Default::default(),
        }
    }
}

#[cfg(test)]
mod tests;

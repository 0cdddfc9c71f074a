//! Features of pattern pieces as JSON [Lei, 3.3.2]: outline with corners and edges in drawing order, grain, reference
//! points, notches, reference lines and piece information.
//!
//! Lengths are in millimetres, angles in degrees counter-clockwise from `+x`, points are `[x, y]`. Derived values
//! (`corners`, `edges`) are written for the reader and ignored when read.

use serde::{Deserialize, Serialize};

use super::dxf::{CodePage, PatternFile, Unit, UnitSource};
use super::piece::{Beside, GradePoint, Notch, Piece};
use super::style::corners::corner_vertices;
use super::table::unmarked;
use geom::V2;
use geom::polyline::{self_crossing, signed_area};
use geom::units::{from_mm, mm};

const FORMAT: &str = "toile pattern features";
const VERSION: u32 = 1;
/// Rounds written lengths to 1 nm.
const PER_MM: f64 = 1e6;
const GREATEST_MM: f64 = 100_000.0;

#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{file}: {place}: found {found}; accepted: {accepted}")]
pub struct FeaturesError {
    pub file: String,
    /// Piece, or place in the JSON.
    pub place: String,
    pub found: String,
    pub accepted: String,
}

/// `[x, y]` in the plane of the piece, mm.
type Place = [f64; 2];

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Features {
    format: String,
    version: u32,
    /// Always `mm`.
    unit: String,
    #[serde(default)]
    source: String,
    /// `[key, value]`.
    #[serde(default)]
    style: Vec<[String; 2]>,
    pieces: Vec<PieceFeatures>,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct PieceFeatures {
    information: Information,
    /// Counter-clockwise in drawing order. The first is not repeated.
    outline: Vec<Place>,
    #[serde(default)]
    drawn_clockwise: bool,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    sew_line: Option<Vec<Place>>,
    /// Vertices of the sewn line, numbered as in the seam file.
    #[serde(default)]
    corners: Vec<usize>,
    #[serde(default)]
    edges: Vec<EdgeFeature>,
    #[serde(default)]
    grain: Option<[Place; 2]>,
    reference_points: ReferencePoints,
    #[serde(default)]
    notches: Vec<NotchFeature>,
    reference_lines: ReferenceLines,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Information {
    block: String,
    name: String,
    #[serde(default)]
    size: Option<String>,
    #[serde(default)]
    quantity: Option<String>,
    /// `[key, value]`.
    #[serde(default)]
    texts: Vec<[String; 2]>,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct EdgeFeature {
    /// Indices of its ends in `corners`.
    corners: [usize; 2],
    length_mm: f64,
}

#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct ReferencePoints {
    #[serde(default)]
    turn_points: Vec<Place>,
    #[serde(default)]
    curve_points: Vec<Place>,
    #[serde(default)]
    drill_holes: Vec<Place>,
    /// On the outline.
    #[serde(default)]
    grade_points: Vec<(Place, u32)>,
    /// On internal lines, cut-outs and drill holes.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    inner_grade_points: Vec<(Place, u32)>,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct NotchFeature {
    at: Place,
    #[serde(default)]
    depth_mm: Option<f64>,
    #[serde(default)]
    angle_deg: Option<f64>,
}

#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct ReferenceLines {
    #[serde(default)]
    mirror: Option<[Place; 2]>,
    #[serde(default)]
    grade_reference: Option<[Place; 2]>,
    #[serde(default)]
    internal: Vec<Vec<Place>>,
    #[serde(default)]
    cut_outs: Vec<Vec<Place>>,
}

impl Features {
    pub fn of(pieces: &[Piece], source: &str, style: &[(String, String)]) -> Self {
        Self {
            format: FORMAT.to_owned(),
            version: VERSION,
            unit: "mm".to_owned(),
            source: source.to_owned(),
            style: pairs(style),
            pieces: pieces.iter().map(PieceFeatures::of).collect(),
        }
    }
}

fn pairs(texts: &[(String, String)]) -> Vec<[String; 2]> {
    texts.iter().map(|(key, value)| [key.clone(), value.clone()]).collect()
}

fn rounded(length_m: f64) -> f64 {
    // `-0.0` becomes `0.0`.
    (mm(length_m) * PER_MM).round() / PER_MM + 0.0
}

fn place(point: &V2) -> Place {
    [rounded(point.x), rounded(point.y)]
}

fn places(points: &[V2]) -> Vec<Place> {
    points.iter().map(place).collect()
}

fn ends(line: Option<[V2; 2]>) -> Option<[Place; 2]> {
    line.map(|ends| ends.map(|end| place(&end)))
}

fn point([x, y]: Place) -> V2 {
    V2::new(from_mm(x), from_mm(y))
}

fn points(places: &[Place]) -> Vec<V2> {
    places.iter().copied().map(point).collect()
}

impl PieceFeatures {
    fn of(piece: &Piece) -> Self {
        let corners = corner_vertices(piece);
        Self {
            information: Information {
                block: piece.block.clone(),
                name: piece.name.clone(),
                size: piece.size.clone(),
                quantity: piece.quantity.clone(),
                texts: pairs(&piece.texts),
            },
            outline: places(&piece.outline),
            drawn_clockwise: piece.is_clockwise_in_file,
            sew_line: piece.sew_line.as_deref().map(places),
            edges: edges(piece.seam_outline(), &corners),
            corners,
            grain: ends(piece.grain),
            reference_points: ReferencePoints {
                turn_points: places(&piece.turn_points),
                curve_points: places(&piece.curve_points),
                drill_holes: places(&piece.drill_holes),
                grade_points: graded_places(piece, false),
                inner_grade_points: graded_places(piece, true),
            },
            notches: piece.notches.iter().map(NotchFeature::of).collect(),
            reference_lines: ReferenceLines {
                mirror: ends(piece.mirror_line),
                grade_reference: ends(piece.grade_reference),
                internal: piece.internal_lines.iter().map(|line| places(line)).collect(),
                cut_outs: piece.cut_outs.iter().map(|line| places(line)).collect(),
            },
        }
    }

    fn into_piece(self) -> Piece {
        let texts = self.information.texts.into_iter().map(|[key, value]| (key, value)).collect();
        let line = |ends: Option<[Place; 2]>| ends.map(|ends| ends.map(point));
        let lines = |lines: &[Vec<Place>]| lines.iter().map(|line| points(line)).collect();
        let marks = &self.reference_points;
        let graded = [(&marks.grade_points, false), (&marks.inner_grade_points, true)];
        let graded = graded.into_iter().flat_map(|(points, is_inner)| {
            points.iter().map(move |&(at, rule)| GradePoint { at: point(at), rule, is_inner })
        });
        Piece {
            block: self.information.block,
            name: self.information.name,
            beside: Beside::default(),
            size: self.information.size,
            quantity: self.information.quantity,
            texts,
            outline: points(&self.outline),
            drawn_perimeter_m: None,
            is_clockwise_in_file: self.drawn_clockwise,
            turn_points: points(&self.reference_points.turn_points),
            curve_points: points(&self.reference_points.curve_points),
            notches: self.notches.iter().map(NotchFeature::notch).collect(),
            grain: line(self.grain),
            mirror_line: line(self.reference_lines.mirror),
            grade_reference: line(self.reference_lines.grade_reference),
            grade_points: graded.collect(),
            internal_lines: lines(&self.reference_lines.internal),
            cut_outs: lines(&self.reference_lines.cut_outs),
            drill_holes: points(&self.reference_points.drill_holes),
            sew_line: self.sew_line.as_deref().map(points),
        }
    }

    fn all_places(&self) -> impl Iterator<Item = &Place> {
        let marks = &self.reference_points;
        let lines = &self.reference_lines;
        let of_ends = [&self.grain, &lines.mirror, &lines.grade_reference].into_iter().flatten().flatten();
        self.outline
            .iter()
            .chain(self.sew_line.iter().flatten())
            .chain(of_ends)
            .chain(&marks.turn_points)
            .chain(&marks.curve_points)
            .chain(&marks.drill_holes)
            .chain(marks.grade_points.iter().chain(&marks.inner_grade_points).map(|(at, _)| at))
            .chain(self.notches.iter().map(|notch| &notch.at))
            .chain(lines.internal.iter().chain(&lines.cut_outs).flatten())
    }
}

fn graded_places(piece: &Piece, is_inner: bool) -> Vec<(Place, u32)> {
    let graded = piece.grade_points.iter().filter(|graded| graded.is_inner == is_inner);
    graded.map(|graded| (place(&graded.at), graded.rule)).collect()
}

impl NotchFeature {
    fn of(notch: &Notch) -> Self {
        Self { at: place(&notch.at), depth_mm: notch.depth_m.map(rounded), angle_deg: notch.angle_deg }
    }

    fn notch(&self) -> Notch {
        Notch { at: point(self.at), depth_m: self.depth_mm.map(from_mm), angle_deg: self.angle_deg }
    }
}

fn edges(outline: &[V2], corners: &[usize]) -> Vec<EdgeFeature> {
    let n = outline.len();
    let length = |from: usize, to: usize| -> f64 {
        let steps = match (to + n - from) % n {
            0 => n,
            steps => steps,
        };
        (0..steps).map(|k| (outline[(from + k + 1) % n] - outline[(from + k) % n]).norm()).sum()
    };
    let edge = |k: usize| {
        let next = (k + 1) % corners.len();
        EdgeFeature { corners: [k, next], length_mm: rounded(length(corners[k], corners[next])) }
    };
    (0..corners.len()).map(edge).collect()
}

pub fn is_features(json: &[u8]) -> bool {
    #[derive(Deserialize)]
    struct Head {
        format: String,
    }
    serde_json::from_slice::<Head>(unmarked(json)).is_ok_and(|head| head.format == FORMAT)
}

pub fn read(bytes: &[u8], file: &str) -> Result<PatternFile, FeaturesError> {
    let fail = |place: &str, found: String, accepted: &str| FeaturesError {
        file: file.to_owned(),
        place: place.to_owned(),
        found,
        accepted: accepted.to_owned(),
    };
    let features: Features = serde_json::from_slice(unmarked(bytes))
        .map_err(|error| fail("the file", error.to_string(), "JSON of pattern features"))?;
    if (features.format.as_str(), features.version, features.unit.as_str()) != (FORMAT, VERSION, "mm") {
        let found = format!("format `{}`, version {}, unit `{}`", features.format, features.version, features.unit);
        return Err(fail("the file", found, &format!("`{FORMAT}`, {VERSION}, `mm`")));
    }
    let mut pieces = Vec::new();
    for (k, piece) in features.pieces.into_iter().enumerate() {
        let at = format!("piece {k} (`{}`)", piece.information.name);
        if let Some([x, y]) = piece.all_places().find(|place| place.iter().any(|x| x.abs() > GREATEST_MM)) {
            return Err(fail(&at, format!("a place at ({x}, {y}) mm"), "places within 100 m"));
        }
        let piece = piece.into_piece();
        for outline in [Some(&piece.outline), piece.sew_line.as_ref()].into_iter().flatten() {
            if outline.len() < 3 || signed_area(outline) <= 0.0 {
                let found = format!("an outline of {} vertices that encloses no area", outline.len());
                return Err(fail(&at, found, "a counter-clockwise outline"));
            }
        }
        if let Some(crossing) = self_crossing(&piece.outline) {
            let [x, y] = place(&crossing);
            return Err(fail(&at, format!("an outline that crosses itself at ({x:.2}, {y:.2}) mm"), "no crossings"));
        }
        pieces.push(piece);
    }
    Ok(PatternFile {
        file: file.to_owned(),
        format: "pattern features (JSON)".to_owned(),
        unit: Unit::Mm,
        unit_source: UnitSource::File,
        texts: features.style.into_iter().map(|[key, value]| (key, value)).collect(),
        pieces,
        refused: Vec::new(),
        warnings: Vec::new(),
        unit_remark: None,
        unused: Default::default(),
        encoding: CodePage::Web(encoding_rs::UTF_8),
    })
}

#[cfg(test)]
mod tests;

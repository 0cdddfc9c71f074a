//! A style: the pieces of one size, named, sewn and measured as its seam file says.

use std::collections::BTreeSet;

use super::garment::{MeasurementKind, Role};
use super::piece::{Notch, Piece};
use super::seams::{PieceEntry, SeamEntry, SeamFile, Stretch};
use crate::geom::V2;
use crate::geom::polyline::Polyline;
use crate::units::{from_mm, mm};

/// Distance within which a turn point is taken to lie on a vertex of the outline, m.
const ON_OUTLINE_M: f64 = 0.5e-3;
/// Turn of an outline at which a vertex is a corner where the file marks none, degrees.
const CORNER_TURN_DEG: f64 = 30.0;

/// Why pieces and a seam file do not make a style.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum StyleError {
    /// The seam file is not the TOML it should be.
    #[error("{file}: not a seam file: {reason}")]
    Syntax {
        /// Seam file.
        file: String,
        /// What the TOML reader found, with the line.
        reason: String,
    },
    /// A name that is not there.
    #[error("{file}: {place}: there is no {what} `{found}`; there is: {accepted}")]
    Unknown {
        /// Seam file.
        file: String,
        /// Entry of the seam file.
        place: String,
        /// Kind of thing named.
        what: &'static str,
        /// Name found.
        found: String,
        /// Names that exist.
        accepted: String,
    },
    /// An entry that contradicts the pieces or another entry.
    #[error("{file}: {place}: {found}; accepted: {accepted}")]
    Contradiction {
        /// Seam file.
        file: String,
        /// Entry of the seam file.
        place: String,
        /// What is wrong.
        found: String,
        /// What would be accepted.
        accepted: String,
    },
}

/// An edge of a piece, counter-clockwise as worn.
#[derive(Clone, Debug, PartialEq)]
pub struct Edge {
    /// Name, unique within the piece; `None` for a stretch of outline that the seam file does not name.
    pub name: Option<String>,
    /// The drawn curve.
    pub line: Polyline,
    /// Arc lengths of the corners passed between its ends.
    pub corners: Vec<f64>,
}

/// A piece as worn.
#[derive(Clone, Debug, PartialEq)]
pub struct StylePiece {
    /// Identifier.
    pub id: String,
    /// How it is worn.
    pub role: Role,
    /// Its edges in counter-clockwise order; together they are the closed outline.
    pub edges: Vec<Edge>,
    /// Unit vector of the grain.
    pub grain: V2,
    /// Notches.
    pub notches: Vec<Notch>,
    /// Corners as worn, by their number in the seam file.
    pub corners: Vec<V2>,
}

impl StylePiece {
    /// Closed outline, counter-clockwise.
    #[must_use]
    pub fn outline(&self) -> Vec<V2> {
        self.edges
            .iter()
            .flat_map(|edge| edge.line.points().split_last().map_or(&[][..], |(_, rest)| rest))
            .copied()
            .collect()
    }
}

/// Reference to an edge: piece index, edge index.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct EdgeRef {
    /// Index into [`Style::pieces`].
    pub piece: usize,
    /// Index into [`StylePiece::edges`].
    pub edge: usize,
}

/// A point of an edge, by arc length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EdgePoint {
    /// Edge.
    pub edge: EdgeRef,
    /// Arc length from the edge's start, m.
    pub arc_m: f64,
}

/// One stretch of a measurement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PathPart {
    /// A whole edge.
    Edge(EdgeRef),
    /// Straight across one piece.
    Line([EdgePoint; 2]),
}

/// A seam: `a` walked forwards meets `b` walked as `b_forwards` says.
#[derive(Clone, Debug, PartialEq)]
pub struct Seam {
    /// Name.
    pub name: String,
    /// One side.
    pub a: Vec<EdgeRef>,
    /// The other side.
    pub b: Vec<EdgeRef>,
    /// Whether `b` runs counter-clockwise too.
    pub b_forwards: bool,
}

/// A measurement on the pieces.
#[derive(Clone, Debug, PartialEq)]
pub struct StyleMeasurement {
    /// Number.
    pub no: u32,
    /// Name.
    pub name: String,
    /// Loop or length.
    pub kind: MeasurementKind,
    /// Where it runs.
    pub path: Vec<PathPart>,
    /// Pattern length L2D, m.
    pub l2d_m: f64,
    /// Whether it runs only along edges that no seam holds.
    pub is_free_edge: bool,
}

/// The pieces of one size with their seams and measurements.
#[derive(Clone, Debug, PartialEq)]
pub struct Style {
    /// Style name.
    pub name: String,
    /// Size name, empty where the file names none.
    pub size: String,
    /// Pieces, in the alphabetical order of their ids.
    pub pieces: Vec<StylePiece>,
    /// Seams.
    pub seams: Vec<Seam>,
    /// Measurements.
    pub measurements: Vec<StyleMeasurement>,
    /// Body level and pattern path.
    pub fit_levels: Vec<(String, Vec<PathPart>)>,
}

impl Style {
    /// Makes a style of the pieces of one size and the bytes of a seam file; `file` is its name for messages.
    ///
    /// # Errors
    /// [`StyleError`] when the bytes are not a seam file, a name is not there, an edge is used twice, or the two sides of
    /// a seam differ in length by more than the stated ease and tolerance.
    pub fn read(pieces: &[Piece], seam_bytes: &[u8], file: &str) -> Result<Self, StyleError> {
        let syntax = |reason: String| StyleError::Syntax { file: file.to_owned(), reason };
        let text =
            std::str::from_utf8(seam_bytes).map_err(|error| syntax(format!("{error}; UTF-8 text is accepted")))?;
        let entries: SeamFile = toml::from_str(text).map_err(|error| syntax(error.to_string()))?;
        Reader { file, entries: &entries }.style(pieces)
    }

    /// The curve of an edge.
    #[must_use]
    pub fn edge(&self, edge: EdgeRef) -> &Edge {
        &self.pieces[edge.piece].edges[edge.edge]
    }

    /// `piece.edge`, for messages.
    pub(super) fn edge_name(&self, edge: EdgeRef) -> String {
        format!("{}.{}", self.pieces[edge.piece].id, self.edge(edge).name.as_deref().unwrap_or("(unnamed)"))
    }

    /// Place of an edge point in its piece's plane.
    #[must_use]
    pub fn place(&self, point: EdgePoint) -> V2 {
        self.edge(point.edge).line.at(point.arc_m)
    }

    /// Pattern length of a path, m.
    #[must_use]
    pub fn path_length_m(&self, path: &[PathPart]) -> f64 {
        path.iter()
            .map(|part| match *part {
                PathPart::Edge(edge) => self.edge(edge).line.length(),
                PathPart::Line([from, to]) => (self.place(to) - self.place(from)).norm(),
            })
            .sum()
    }
}

/// Resolves the names of one seam file.
struct Reader<'a> {
    file: &'a str,
    entries: &'a SeamFile,
}

impl Reader<'_> {
    fn style(&self, pieces: &[Piece]) -> Result<Style, StyleError> {
        let mut style = Style {
            name: self.entries.name.clone(),
            size: String::new(),
            pieces: Vec::new(),
            seams: Vec::new(),
            measurements: Vec::new(),
            fit_levels: Vec::new(),
        };
        for (id, entry) in &self.entries.piece {
            let drawn = self.drawn(id, entry, pieces)?;
            if let Some(size) = &drawn.size {
                style.size.clone_from(size);
            }
            style.pieces.push(self.piece(id, entry, drawn)?);
        }
        let mut sewn = BTreeSet::new();
        for entry in &self.entries.seam {
            let seam = self.seam(entry, &style)?;
            for &edge in seam.a.iter().chain(&seam.b) {
                if !sewn.insert(edge) {
                    let name = style.edge_name(edge);
                    return Err(self.contradiction(
                        format!("seam `{}`", entry.name),
                        format!("edge `{name}` is sewn twice"),
                        "each edge in at most one seam".to_owned(),
                    ));
                }
            }
            style.seams.push(seam);
        }
        for entry in &self.entries.measurement {
            let path = self.path(&format!("measurement {}", entry.no), &entry.path, &style)?;
            style.measurements.push(StyleMeasurement {
                no: entry.no,
                name: entry.name.clone(),
                kind: entry.kind,
                l2d_m: style.path_length_m(&path),
                is_free_edge: path.iter().all(|part| matches!(part, PathPart::Edge(edge) if !sewn.contains(edge))),
                path,
            });
        }
        for (level, entry) in &self.entries.fit {
            let path = self.path(&format!("fit level `{level}`"), &entry.path, &style)?;
            style.fit_levels.push((level.clone(), path));
        }
        Ok(style)
    }

    /// The drawn piece that an entry names by its block, or else by its piece name.
    fn drawn<'p>(&self, id: &str, entry: &PieceEntry, pieces: &'p [Piece]) -> Result<&'p Piece, StyleError> {
        let by_block = pieces.iter().find(|piece| piece.block == entry.block);
        by_block.or_else(|| pieces.iter().find(|piece| piece.name == entry.block)).ok_or_else(|| {
            let blocks: Vec<&str> = pieces.iter().map(|piece| piece.block.as_str()).collect();
            self.unknown(format!("piece `{id}`"), "block", &entry.block, &blocks)
        })
    }

    fn piece(&self, id: &str, entry: &PieceEntry, drawn: &Piece) -> Result<StylePiece, StyleError> {
        let outline = drawn.seam_outline();
        let corners = corner_vertices(drawn);
        let place = format!("piece `{id}`");
        // Corner ranges sorted by their first corner; gaps between them become unnamed edges.
        let mut ranges: Vec<(usize, usize, String)> = Vec::new();
        for (name, &[from, to]) in &entry.edges {
            if from >= corners.len() || to >= corners.len() || from == to {
                return Err(self.contradiction(
                    place,
                    format!("edge `{name}` runs from corner {from} to corner {to}"),
                    format!("two different corners of 0 to {}", corners.len().saturating_sub(1)),
                ));
            }
            ranges.push((from, (to + corners.len() - from) % corners.len(), name.clone()));
        }
        ranges.sort();
        let ranges = self.without_gaps(&place, ranges, corners.len())?;
        let mut edges: Vec<Edge> =
            ranges.into_iter().map(|(from, span, name)| cut_edge(outline, &corners, from, span, name)).collect();
        let mut corner_places: Vec<V2> = corners.iter().map(|&vertex| outline[vertex]).collect();
        let mut grain = drawn.grain.and_then(|[from, to]| (to - from).try_normalize(0.0)).unwrap_or_else(V2::y);
        let mut notches = drawn.notches.clone();
        if entry.mirror {
            edges.reverse();
            edges.iter_mut().for_each(mirror_edge);
            grain = mirrored(grain);
            corner_places.iter_mut().for_each(|corner| *corner = mirrored(*corner));
            for notch in &mut notches {
                notch.at = mirrored(notch.at);
                notch.angle_deg = notch.angle_deg.map(|angle| (180.0 - angle).rem_euclid(360.0));
            }
        }
        Ok(StylePiece { id: id.to_owned(), role: entry.role, edges, grain, notches, corners: corner_places })
    }

    /// Fills the gaps between corner ranges `(from, span, name)` that are sorted by their first corner.
    fn without_gaps(
        &self,
        place: &str,
        ranges: Vec<(usize, usize, String)>,
        corners: usize,
    ) -> Result<Vec<(usize, usize, Option<String>)>, StyleError> {
        let Some(first) = ranges.first().map(|range| range.0) else {
            return Err(self.contradiction(
                place.to_owned(),
                "no edges".to_owned(),
                "at least one named edge".to_owned(),
            ));
        };
        let mut complete = Vec::new();
        for (k, (from, span, name)) in ranges.iter().enumerate() {
            let next = ranges.get(k + 1).map_or(first + corners, |range| range.0);
            let end = from + span;
            if end > next {
                return Err(self.contradiction(
                    place.to_owned(),
                    format!("edge `{name}` (corners {from} to {}) overlaps the edge after it", end % corners),
                    "edges that share at most their end corners".to_owned(),
                ));
            }
            complete.push((*from, *span, Some(name.clone())));
            if end < next {
                complete.push((end % corners, next - end, None));
            }
        }
        Ok(complete)
    }

    fn seam(&self, entry: &SeamEntry, style: &Style) -> Result<Seam, StyleError> {
        let place = format!("seam `{}`", entry.name);
        let resolve =
            |names: &[String]| names.iter().map(|name| self.edge(&place, name, style)).collect::<Result<Vec<_>, _>>();
        let (a, b) = (resolve(&entry.a)?, resolve(&entry.b)?);
        let length = |chain: &[EdgeRef]| chain.iter().map(|&edge| style.edge(edge).line.length()).sum::<f64>();
        let (length_a, length_b) = (length(&a), length(&b));
        if a.is_empty() || b.is_empty() {
            return Err(self.contradiction(
                place,
                "a side without edges".to_owned(),
                "at least one edge a side".to_owned(),
            ));
        }
        let excess = length_a - length_b - from_mm(entry.ease_mm);
        if excess.abs() > from_mm(self.entries.length_tolerance_mm) {
            return Err(self.contradiction(
                place,
                format!("a is {:.1} mm long and b {:.1} mm", mm(length_a), mm(length_b)),
                format!(
                    "a longer than b by ease_mm = {} within length_tolerance_mm = {}",
                    entry.ease_mm, self.entries.length_tolerance_mm
                ),
            ));
        }
        Ok(Seam { name: entry.name.clone(), a, b, b_forwards: entry.same_direction })
    }

    fn path(&self, place: &str, stretches: &[Stretch], style: &Style) -> Result<Vec<PathPart>, StyleError> {
        if stretches.is_empty() {
            return Err(self.contradiction(place.to_owned(), "an empty path".to_owned(), "edges or lines".to_owned()));
        }
        stretches
            .iter()
            .map(|stretch| match stretch {
                Stretch::Edge(name) => self.edge(place, name, style).map(PathPart::Edge),
                Stretch::Line { line: [from, to] } => {
                    let ends = [self.point(place, from, style)?, self.point(place, to, style)?];
                    if ends[0].edge.piece != ends[1].edge.piece || style.place(ends[0]) == style.place(ends[1]) {
                        return Err(self.contradiction(
                            place.to_owned(),
                            format!("a line from `{from}` to `{to}`"),
                            "two different points of one piece".to_owned(),
                        ));
                    }
                    Ok(PathPart::Line(ends))
                }
            })
            .collect()
    }

    /// Resolves `piece.edge`.
    fn edge(&self, place: &str, name: &str, style: &Style) -> Result<EdgeRef, StyleError> {
        let (piece_id, edge_name) = name.split_once('.').unwrap_or((name, ""));
        let ids: Vec<&str> = style.pieces.iter().map(|piece| piece.id.as_str()).collect();
        let piece = ids.iter().position(|&id| id == piece_id);
        let piece = piece.ok_or_else(|| self.unknown(place.to_owned(), "piece", piece_id, &ids))?;
        let edges = &style.pieces[piece].edges;
        let edge = edges.iter().position(|edge| edge.name.as_deref() == Some(edge_name));
        let edge = edge.ok_or_else(|| {
            let names = edges.iter().filter_map(|edge| edge.name.as_ref()).map(|n| format!("{piece_id}.{n}"));
            self.unknown(place.to_owned(), "edge", name, &names.collect::<Vec<_>>())
        })?;
        Ok(EdgeRef { piece, edge })
    }

    /// Resolves `piece.edge.start`, `.mid` or `.end`.
    fn point(&self, place: &str, name: &str, style: &Style) -> Result<EdgePoint, StyleError> {
        let (edge_name, which) = name.rsplit_once('.').unwrap_or((name, ""));
        let share = match which {
            "start" => 0.0,
            "mid" => 0.5,
            "end" => 1.0,
            _ => return Err(self.unknown(place.to_owned(), "point", name, &["EDGE.start", "EDGE.mid", "EDGE.end"])),
        };
        let edge = self.edge(place, edge_name, style)?;
        Ok(EdgePoint { edge, arc_m: share * style.edge(edge).line.length() })
    }

    fn unknown<S: AsRef<str>>(&self, place: String, what: &'static str, found: &str, existing: &[S]) -> StyleError {
        let accepted = existing.iter().map(AsRef::as_ref).collect::<Vec<_>>().join(", ");
        StyleError::Unknown { file: self.file.to_owned(), place, what, found: found.to_owned(), accepted }
    }

    fn contradiction(&self, place: String, found: String, accepted: String) -> StyleError {
        StyleError::Contradiction { file: self.file.to_owned(), place, found, accepted }
    }
}

/// Outline vertices that are corners, counter-clockwise from the first turn point in the file.
fn corner_vertices(piece: &Piece) -> Vec<usize> {
    let outline = piece.seam_outline();
    let nearest = |point: &V2| {
        let distance = |i: &usize| (outline[*i] - point).norm();
        (0..outline.len()).min_by(|i, j| distance(i).total_cmp(&distance(j))).filter(|i| distance(i) < ON_OUTLINE_M)
    };
    let marked: Vec<usize> = piece.turn_points.iter().filter_map(nearest).collect();
    let distinct: BTreeSet<usize> = marked.iter().copied().collect();
    // Some writers mark every vertex as a turn point; then the marks say nothing.
    if distinct.len() >= 2 && (distinct.len() < outline.len() || outline.len() <= 8) {
        let mut corners: Vec<usize> = distinct.into_iter().collect();
        let start = corners.iter().position(|&vertex| vertex == marked[0]).unwrap_or(0);
        corners.rotate_left(start);
        return corners;
    }
    let n = outline.len();
    let turn = |i: usize| (outline[i] - outline[(i + n - 1) % n]).angle(&(outline[(i + 1) % n] - outline[i]));
    (0..n).filter(|&i| turn(i).to_degrees() >= CORNER_TURN_DEG).collect()
}

/// The stretch of an outline from one corner over `span` corners, counter-clockwise.
fn cut_edge(outline: &[V2], corners: &[usize], from: usize, span: usize, name: Option<String>) -> Edge {
    let n = outline.len();
    let corner = |k: usize| corners[(from + k) % corners.len()];
    let steps = |vertex: usize| match (vertex + n - corner(0)) % n {
        0 => n,
        steps => steps,
    };
    let points = (0..=steps(corner(span))).map(|k| outline[(corner(0) + k) % n]).collect();
    let line = Polyline::new(points).expect("different corners are at least one side apart");
    let corners = (1..span).map(|k| line.arcs()[steps(corner(k))]).collect();
    Edge { name, line, corners }
}

fn mirrored(point: V2) -> V2 {
    V2::new(-point.x, point.y)
}

/// Mirrors an edge and turns it round, so that it is counter-clockwise again.
fn mirror_edge(edge: &mut Edge) {
    let length = edge.line.length();
    let points = edge.line.points().iter().rev().map(|&p| mirrored(p)).collect();
    edge.line = Polyline::new(points).expect("as many points as before");
    edge.corners = edge.corners.iter().rev().map(|arc| length - arc).collect();
}

#[cfg(test)]
#[path = "style_tests.rs"]
mod tests;

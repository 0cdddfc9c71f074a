//! Style: the pieces of one size, named, sewn and measured by a seam file.

pub(super) mod corners;
pub(super) mod correspond;
pub(super) mod named;
pub(super) mod nest_corners;
pub(super) mod openings;
mod pieces;
mod read;
pub mod shrinkage;
mod upright;

pub use self::pieces::{Edge, StylePiece};
use self::read::Reader;
use self::shrinkage::Shrinkage;
use super::garment::{Band, MeasurementKind};
use super::piece::Piece;
use super::seams::{SeamFile, StyleError};
use geom::V2;

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
    /// Edge that it lies on.
    pub edge: EdgeRef,
    /// Arc length from the start of the edge, m.
    pub arc_m: f64,
}

/// One part of a measurement path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PathPart {
    /// A whole edge.
    Edge(EdgeRef),
    /// A straight line between two points of one piece.
    Line([EdgePoint; 2]),
}

/// A seam: `a`, walked forwards, is sewn to `b`, walked forwards if `b_forwards` and backwards otherwise.
#[derive(Clone, Debug, PartialEq)]
pub struct Seam {
    /// Name in the seam file, for messages.
    pub name: String,
    /// Edges of one side, in order along the seam.
    pub a: Vec<EdgeRef>,
    /// Edges of the other side, in order along the seam.
    pub b: Vec<EdgeRef>,
    /// True if `b` is walked counter-clockwise round its piece, as `a` is.
    pub b_forwards: bool,
}

/// A measurement on the pieces.
#[derive(Clone, Debug, PartialEq)]
pub struct StyleMeasurement {
    /// Number by which tables and drawings name it (`#1`).
    pub no: u32,
    /// Name for people to read, such as `Neck Opening`.
    pub name: String,
    /// Closed girth or open length.
    pub kind: MeasurementKind,
    /// Parts of the path, in order.
    pub path: Vec<PathPart>,
    /// Pattern length L2D, m.
    pub l2d_m: f64,
    /// True if the path runs only along edges that are in no seam.
    pub is_free_edge: bool,
}

/// Reinforcement of an edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StyleReinforcement {
    /// Edge that is reinforced.
    pub edge: EdgeRef,
    /// Kind of the reinforcement.
    pub band: Band,
    /// Force per relative elongation, N.
    pub stiffness_n: f64,
    /// Ratio of the length of the band to that of the edge.
    pub length_factor: f64,
}

/// The pieces of one size with their seams and measurements.
#[derive(Clone, Debug, PartialEq)]
pub struct Style {
    /// Name of the style, from its seam file.
    pub name: String,
    /// Name of the size. Empty if the file names none.
    pub size: String,
    /// Pieces, in the alphabetical order of their identifiers.
    pub pieces: Vec<StylePiece>,
    /// Seams between edges of the pieces.
    pub seams: Vec<Seam>,
    /// Measurements of the seam file. Without any, one for each opening and seam.
    pub measurements: Vec<StyleMeasurement>,
    /// Reinforced edges.
    pub reinforcements: Vec<StyleReinforcement>,
    /// Levels of the body, each with the path of the girth of the pattern there.
    pub fit_levels: Vec<(String, Vec<PathPart>)>,
    /// Shrinkage of the cloth. The pieces have the lengths after it.
    pub shrinkage: Shrinkage,
}

impl Style {
    /// Makes a style of the pieces of one size and the bytes of a seam file. `file` is the name of the seam file for
    /// messages.
    ///
    /// # Errors
    /// [`StyleError`] if the bytes are no seam file, a name does not exist, an edge is used twice, or the lengths of
    /// both sides of a seam differ by more than ease and tolerance.
    ///
    /// # Examples
    /// ```
    /// use pattern::{Style, draft::Model};
    ///
    /// let medium = &Model::Tshirt.drafts()[1];
    /// let style = Style::read(&medium.pieces, Model::Tshirt.seams(), "tshirt.seams.toml")?;
    /// let pieces: Vec<&str> = style.pieces.iter().map(|piece| piece.id.as_str()).collect();
    /// assert_eq!(pieces, ["back", "front", "sleeve_left", "sleeve_right"]);
    ///
    /// let garment = style.mesh(0.03)?;
    /// assert_eq!((garment.seams.len(), garment.measurements.len()), (8, 9));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn read(pieces: &[Piece], seam_bytes: &[u8], file: &str) -> Result<Self, StyleError> {
        Self::of(pieces, &SeamFile::parse(seam_bytes, file)?, file)
    }

    /// Makes a style as [`Style::read`] does, from a parsed seam file.
    pub(super) fn of(pieces: &[Piece], entries: &SeamFile, file: &str) -> Result<Self, StyleError> {
        Reader { file, entries }.style(pieces)
    }

    /// Replaces measurements and fit levels by those of a seam file that has nothing else, for a style whose pieces and
    /// seams come from elsewhere. The file names edges by [`Edge::name`].
    ///
    /// # Errors
    /// [`StyleError`] if the bytes are no such file or a name does not exist.
    pub fn measure(&mut self, seam_bytes: &[u8], file: &str) -> Result<(), StyleError> {
        let entries = SeamFile::parse(seam_bytes, file)?;
        let reader = Reader { file, entries: &entries };
        reader.only_measures()?;
        reader.shrink(self)?;
        reader.measure(self)
    }

    /// Edge that a reference names.
    #[must_use]
    pub fn edge(&self, edge: EdgeRef) -> &Edge {
        &self.pieces[edge.piece].edges[edge.edge]
    }

    /// Name of an edge as `piece.edge`, for messages.
    pub(super) fn edge_name(&self, edge: EdgeRef) -> String {
        format!("{}.{}", self.pieces[edge.piece].id, self.edge(edge).name.as_deref().unwrap_or("(unnamed)"))
    }

    /// Position of an edge point in the plane of its piece.
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

#[cfg(test)]
mod tests;

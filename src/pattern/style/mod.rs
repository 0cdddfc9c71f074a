//! A style: the pieces of one size, named, sewn and measured as its seam file says.

pub(super) mod corners;
pub(super) mod correspond;
pub(super) mod follow;
pub(super) mod named;
pub(super) mod openings;
mod pieces;
mod read;
mod upright;

pub use self::pieces::{Edge, StylePiece};
use self::read::Reader;
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
    /// Name in the seam file, for messages.
    pub name: String,
    /// Edges of one side, in order along the seam.
    pub a: Vec<EdgeRef>,
    /// Edges of the other side, in order along the seam.
    pub b: Vec<EdgeRef>,
    /// Whether `b` runs counter-clockwise too.
    pub b_forwards: bool,
}

/// A measurement on the pieces.
#[derive(Clone, Debug, PartialEq)]
pub struct StyleMeasurement {
    /// Number by which tables and drawings name it (`#1`).
    pub no: u32,
    /// Name for people to read, such as `Neck Opening`.
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

/// An edge with a stiffness of its own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StyleReinforcement {
    /// Edge that is strengthened.
    pub edge: EdgeRef,
    /// What strengthens it.
    pub band: Band,
    /// Force per relative elongation, N.
    pub stiffness_n: f64,
    /// Length of the band over that of the edge.
    pub length_factor: f64,
}

/// The pieces of one size with their seams and measurements.
#[derive(Clone, Debug, PartialEq)]
pub struct Style {
    /// Name of the style, from its seam file.
    pub name: String,
    /// Size name, empty where the file names none.
    pub size: String,
    /// Pieces, in the alphabetical order of their ids.
    pub pieces: Vec<StylePiece>,
    /// Seams between edges of the pieces.
    pub seams: Vec<Seam>,
    /// Measurements of the seam file, or those found on openings and seams.
    pub measurements: Vec<StyleMeasurement>,
    /// Edges that a band strengthens.
    pub reinforcements: Vec<StyleReinforcement>,
    /// Body level and pattern path.
    pub fit_levels: Vec<(String, Vec<PathPart>)>,
}

impl Style {
    /// Makes a style of the pieces of one size and the bytes of a seam file; `file` is its name for messages.
    ///
    /// # Errors
    /// [`StyleError`] when the bytes are not a seam file, a name is not there, an edge is used twice, or the two sides of
    /// a seam differ in length by more than the stated ease and tolerance.
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

    /// [`Style::read`] from entries that were parsed.
    pub(super) fn of(pieces: &[Piece], entries: &SeamFile, file: &str) -> Result<Self, StyleError> {
        Reader { file, entries }.style(pieces)
    }

    /// Replaces measurements and fit levels by those of a seam file that names no piece: for a style whose pieces and
    /// seams come from elsewhere. Edges are called as [`Edge::name`] says.
    ///
    /// # Errors
    /// [`StyleError`] when the bytes are no such file or a name is not there.
    pub fn measure(&mut self, seam_bytes: &[u8], file: &str) -> Result<(), StyleError> {
        let entries = SeamFile::parse(seam_bytes, file)?;
        let reader = Reader { file, entries: &entries };
        reader.only_measures()?;
        reader.measure(self)
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

#[cfg(test)]
mod tests;

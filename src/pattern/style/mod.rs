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

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct EdgeRef {
    /// Index into [`Style::pieces`].
    pub piece: usize,
    /// Index into [`StylePiece::edges`].
    pub edge: usize,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EdgePoint {
    pub edge: EdgeRef,
    pub arc_m: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PathPart {
    Edge(EdgeRef),
    Line([EdgePoint; 2]),
}

/// A seam: `a`, walked forwards, is sewn to `b`, walked forwards if `b_forwards` and backwards otherwise.
#[derive(Clone, Debug, PartialEq)]
pub struct Seam {
    /// Name in the seam file, for messages.
    pub name: String,
    /// In order along the seam.
    pub a: Vec<EdgeRef>,
    /// In order along the seam.
    pub b: Vec<EdgeRef>,
    /// True if `b` is walked counter-clockwise round its piece, as `a` is.
    pub b_forwards: bool,
}

#[derive(Clone, Debug, PartialEq)]
pub struct StyleMeasurement {
    /// Number by which tables and drawings name it (`#1`).
    pub no: u32,
    /// Name for people to read, such as `Neck Opening`.
    pub name: String,
    pub kind: MeasurementKind,
    pub path: Vec<PathPart>,
    /// Pattern length L2D.
    pub l2d_m: f64,
    /// True if the path runs only along edges that are in no seam.
    pub is_free_edge: bool,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StyleReinforcement {
    pub edge: EdgeRef,
    pub band: Band,
    /// Force per relative elongation.
    pub stiffness_n: f64,
    /// Ratio of the length of the band to that of the edge.
    pub length_factor: f64,
}

/// Pieces of one size with their seams and measurements.
#[derive(Clone, Debug, PartialEq)]
pub struct Style {
    pub name: String,
    /// Empty if the file names none.
    pub size: String,
    /// In the alphabetical order of their identifiers.
    pub pieces: Vec<StylePiece>,
    pub seams: Vec<Seam>,
    /// From the seam file. Without any, one for each opening and seam.
    pub measurements: Vec<StyleMeasurement>,
    pub reinforcements: Vec<StyleReinforcement>,
    /// Levels of the body, each with the path of the pattern's girth there.
    pub fit_levels: Vec<(String, Vec<PathPart>)>,
    /// Pieces have the lengths after it.
    pub shrinkage: Shrinkage,
}

impl Style {
    /// Makes a style of the pieces of one size and the bytes of a seam file. `file` is the name of the seam file for
    /// messages.
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

    pub(super) fn of(pieces: &[Piece], entries: &SeamFile, file: &str) -> Result<Self, StyleError> {
        Reader { file, entries }.style(pieces)
    }

    /// Replaces measurements and fit levels by those of a seam file that has nothing else, for a style whose pieces and
    /// seams come from elsewhere. The file names edges by [`Edge::name`].
    pub fn measure(&mut self, seam_bytes: &[u8], file: &str) -> Result<(), StyleError> {
        let entries = SeamFile::parse(seam_bytes, file)?;
        let reader = Reader { file, entries: &entries };
        reader.only_measures()?;
        reader.shrink(self)?;
        reader.measure(self)
    }

    pub fn edge(&self, edge: EdgeRef) -> &Edge {
        &self.pieces[edge.piece].edges[edge.edge]
    }

    /// Writes `piece.edge`, for messages.
    pub(super) fn edge_name(&self, edge: EdgeRef) -> String {
        format!("{}.{}", self.pieces[edge.piece].id, self.edge(edge).name.as_deref().unwrap_or("(unnamed)"))
    }

    pub fn place(&self, point: EdgePoint) -> V2 {
        self.edge(point.edge).line.at(point.arc_m)
    }

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

//! Seam file: names, roles, seams and measurements of the pieces of a style. It is TOML, one file for all sizes.
//!
//! `docs/reference.md` lists its keys, and a test compares that page with this module. `docs/patterns.md` has an
//! example.
//!
//! **Corners** are the turn points of the piece, numbered from 0 counter-clockwise along the outline as drawn. Corner 0
//! is the first turn point in the file. Without usable turn points, corners are the vertices at which the outline turns
//! by 30 degrees or more, from its first vertex on. As sizes may differ in turn points and angles, an entry may list
//! its corners in `corners_at`: its edges refer to these, and each is found on the outline of a size by its relative
//! position.
//!
//! **Directions.** Pieces are drawn as seen from outside, so every edge runs counter-clockwise round its piece *as
//! worn*. The edges of a mirrored piece are reversed. The two sides of a seam therefore run against each other: `a` is
//! walked forwards, `b` backwards, each chain in the order written. **Points** of an edge are `start`, `mid` (half its
//! length) and `end`, in the direction of the edge as worn.

use std::collections::BTreeMap;
use std::fmt;

use serde::{Deserialize, Serialize};

use super::garment::{Band, MeasurementKind, Role};

/// Error of making a style from pieces and a seam file.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum StyleError {
    /// The seam file is not valid TOML of the expected form.
    #[error("{file}: not a seam file: {reason}")]
    Syntax {
        /// Name of the seam file.
        file: String,
        /// Message of the TOML reader, with the line.
        reason: String,
    },
    /// A name refers to nothing.
    #[error("{file}: {place}: there is no {what} `{found}`; there is: {accepted}")]
    Unknown {
        /// Name of the seam file.
        file: String,
        /// Entry of the seam file.
        place: String,
        /// Kind of thing that the name should refer to.
        what: &'static str,
        /// Name in the entry.
        found: String,
        /// Names that exist.
        accepted: String,
    },
    /// An entry contradicts the pieces or another entry.
    #[error("{file}: {place}: {found}; accepted: {accepted}")]
    Contradiction {
        /// Name of the seam file.
        file: String,
        /// Entry of the seam file.
        place: String,
        /// Description of the contradiction.
        found: String,
        /// Description of what is accepted.
        accepted: String,
    },
}

/// Default of the greatest accepted length difference between both sides of a seam, mm.
pub const DEFAULT_LENGTH_TOLERANCE_MM: f64 = 1.0;

/// A seam file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SeamFile {
    /// Name of the style.
    pub name: String,
    /// Size that the file was made on, if it holds for several.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub size: Option<String>,
    /// Greatest accepted length difference between both sides of a seam, besides ease, mm.
    #[serde(default = "default_tolerance")]
    pub length_tolerance_mm: f64,
    /// Seam allowance of pieces for which the pattern file has only the cut line, mm.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub allowance_mm: f64,
    /// Shrinkage of the cloth along the grain line from cutting to wearing, percent of the cut length.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub shrinkage_warp_pct: f64,
    /// Shrinkage across the grain line, percent.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub shrinkage_weft_pct: f64,
    /// Edges, `piece.edge`, that are in no seam on purpose. Edges with a measurement along them need no entry.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub open: Vec<String>,
    /// Pieces by identifier. Empty in a file that only adds measurements to a pattern with seams.
    #[serde(default)]
    pub piece: BTreeMap<String, PieceEntry>,
    /// Seams between edges.
    #[serde(default)]
    pub seam: Vec<SeamEntry>,
    /// Measurements: lengths on the pattern that are compared with the drape.
    #[serde(default)]
    pub measurement: Vec<MeasurementEntry>,
    /// Edges reinforced by a rib, a tape, a hem or a band.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub reinforce: Vec<ReinforceEntry>,
    /// Girths of the pattern, by level of the body.
    #[serde(default)]
    pub fit: BTreeMap<String, FitEntry>,
}

impl SeamFile {
    /// Parses the bytes of a seam file. `file` is its name for messages.
    ///
    /// # Errors
    /// [`StyleError::Syntax`] if they are not UTF-8 or not valid TOML of this form.
    pub fn parse(bytes: &[u8], file: &str) -> Result<Self, StyleError> {
        let syntax = |reason: String| StyleError::Syntax { file: file.to_owned(), reason };
        let text = std::str::from_utf8(bytes).map_err(|error| syntax(format!("{error}; UTF-8 text is accepted")))?;
        toml::from_str(text).map_err(|error| syntax(error.to_string()))
    }
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes references")]
fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

fn default_tolerance() -> f64 {
    DEFAULT_LENGTH_TOLERANCE_MM
}

/// A piece of the style.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PieceEntry {
    /// Name of the block or piece in the pattern file.
    pub block: String,
    /// Role of the piece.
    pub role: Role,
    /// True if the piece is worn as the mirror image of the drawing.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub mirror: bool,
    /// Corners, counter-clockwise, as shares of the width and height of the piece as drawn, in the size that the file
    /// was made on. If empty, each size has the corners of its outline.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub corners_at: Vec<[f64; 2]>,
    /// Seam allowances by edge, mm, where they differ from that of the file.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub allowance_mm: BTreeMap<String, f64>,
    /// Edges by name, as first and last corner, counter-clockwise as drawn.
    pub edges: BTreeMap<String, [usize; 2]>,
}

/// Relative difference between sizes, in the length ratio of both sides of a seam, from which the user is asked.
pub(crate) const RATIO_DOUBT: f64 = 0.05;
/// Difference up to which the eases of sizes count as equal, as a share of the length tolerance.
pub(crate) const SAME_EASE: f64 = 0.5;

/// A seam between two chains of edges.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SeamEntry {
    /// Name of the seam, for messages.
    pub name: String,
    /// Edges of one side, as `piece.edge`, in order along the seam.
    pub a: Vec<String>,
    /// Edges of the other side.
    pub b: Vec<String>,
    /// True if both sides run counter-clockwise round their pieces.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub same_direction: bool,
    /// Ease, mm: length of `a` minus length of `b`.
    #[serde(default, skip_serializing_if = "Ease::is_none")]
    pub ease_mm: Ease,
}

/// Ease of a seam, mm: length of `a` minus length of `b`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Ease {
    /// Equal in every size.
    Same(f64),
    /// Different by size, by the name of the size.
    BySize(BTreeMap<String, f64>),
}

impl Default for Ease {
    fn default() -> Self {
        Self::Same(0.0)
    }
}

impl Ease {
    /// True if the ease is zero in every size.
    #[must_use]
    pub fn is_none(&self) -> bool {
        *self == Self::default()
    }

    /// Ease of a size, mm, whose name matches in upper or lower case. `None` for a size without an entry.
    #[must_use]
    pub fn of_size(&self, size: &str) -> Option<f64> {
        match self {
            Self::Same(ease) => Some(*ease),
            Self::BySize(eases) => {
                eases.iter().find(|(name, _)| name.eq_ignore_ascii_case(size)).map(|(_, &ease)| ease)
            }
        }
    }
}

impl fmt::Display for Ease {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Same(ease) => write!(f, "{ease}"),
            Self::BySize(eases) => {
                let each: Vec<String> = eases.iter().map(|(size, ease)| format!("{size} = {ease}")).collect();
                write!(f, "{{ {} }}", each.join(", "))
            }
        }
    }
}

/// A measurement of the style.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MeasurementEntry {
    /// Number by which tables and drawings name it (`#1`).
    pub no: u32,
    /// Name for people to read, such as `Neck Opening`.
    pub name: String,
    /// Closed girth or open length.
    pub kind: MeasurementKind,
    /// Parts of the path, in order.
    pub path: Vec<Stretch>,
}

/// Reinforcement of edges.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ReinforceEntry {
    /// Edges as `piece.edge`.
    pub edges: Vec<String>,
    /// Kind of the reinforcement.
    pub kind: Band,
    /// Force per relative elongation, N.
    pub stiffness_n: f64,
    /// Ratio of the length of the band to that of the edge.
    #[serde(default = "unstretched")]
    pub length_factor: f64,
}

fn unstretched() -> f64 {
    1.0
}

/// Girth of the pattern at a level of the body.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FitEntry {
    /// Parts of the path, in order.
    pub path: Vec<Stretch>,
}

/// One part of a path.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Stretch {
    /// Along an edge, `piece.edge`.
    Edge(String),
    /// Straight line across a piece between two points, each written `piece.edge.start`, `.mid` or `.end`.
    Line {
        /// Both ends.
        line: [String; 2],
    },
}

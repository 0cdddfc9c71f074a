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

#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum StyleError {
    /// Seam file that is no TOML, or TOML of another form.
    #[error("{file}: not a seam file: {reason}")]
    Syntax {
        file: String,
        /// Message of the TOML reader, with the line.
        reason: String,
    },
    #[error("{file}: {place}: there is no {what} `{found}`; there is: {accepted}")]
    Unknown {
        file: String,
        /// Entry of the seam file.
        place: String,
        /// Kind of thing that the name should refer to.
        what: &'static str,
        found: String,
        accepted: String,
    },
    /// Entry that contradicts the pieces or another entry.
    #[error("{file}: {place}: {found}; accepted: {accepted}")]
    Contradiction {
        file: String,
        /// Entry of the seam file.
        place: String,
        found: String,
        accepted: String,
    },
}

pub const DEFAULT_LENGTH_TOLERANCE_MM: f64 = 1.0;

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SeamFile {
    pub name: String,
    /// Size that the file was made on, if it holds for several.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub size: Option<String>,
    /// Greatest accepted length difference between both sides of a seam, besides ease.
    #[serde(default = "default_tolerance")]
    pub length_tolerance_mm: f64,
    /// Seam allowance of pieces for which the pattern file has only the cut line.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub allowance_mm: f64,
    /// Shrinkage of the cloth along the grain line from cutting to wearing, percent of the cut length.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub shrinkage_warp_pct: f64,
    /// Shrinkage across the grain line.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub shrinkage_weft_pct: f64,
    /// Edges, `piece.edge`, that are in no seam on purpose. Edges with a measurement along them need no entry.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub open: Vec<String>,
    /// Pieces by identifier. Empty in a file that only adds measurements to a pattern with seams.
    #[serde(default)]
    pub piece: BTreeMap<String, PieceEntry>,
    #[serde(default)]
    pub seam: Vec<SeamEntry>,
    /// Lengths on the pattern that are compared with the drape.
    #[serde(default)]
    pub measurement: Vec<MeasurementEntry>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub reinforce: Vec<ReinforceEntry>,
    /// Girths of the pattern, by level of the body.
    #[serde(default)]
    pub fit: BTreeMap<String, FitEntry>,
}

impl SeamFile {
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

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PieceEntry {
    /// Name of the block or piece in the pattern file.
    pub block: String,
    pub role: Role,
    /// True if the piece is worn as the mirror image of the drawing.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub mirror: bool,
    /// Corners, counter-clockwise, as shares of the width and height of the piece as drawn, in the size that the file
    /// was made on. If empty, each size has the corners of its outline.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub corners_at: Vec<[f64; 2]>,
    /// Allowances by edge, where they differ from that of the file.
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
    pub name: String,
    /// As `piece.edge`, in order along the seam.
    pub a: Vec<String>,
    pub b: Vec<String>,
    /// True if both sides run counter-clockwise round their pieces.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub same_direction: bool,
    /// Length of `a` minus length of `b`.
    #[serde(default, skip_serializing_if = "Ease::is_none")]
    pub ease_mm: Ease,
}

/// Ease of a seam, mm: length of `a` minus length of `b`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Ease {
    Same(f64),
    /// By the name of the size.
    BySize(BTreeMap<String, f64>),
}

impl Default for Ease {
    fn default() -> Self {
        Self::Same(0.0)
    }
}

impl Ease {
    /// True if zero in every size.
    pub fn is_none(&self) -> bool {
        *self == Self::default()
    }

    /// In mm, matched in upper or lower case. `None` for a size without an entry.
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

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MeasurementEntry {
    /// Number by which tables and drawings name it (`#1`).
    pub no: u32,
    /// Name for people to read, such as `Neck Opening`.
    pub name: String,
    pub kind: MeasurementKind,
    pub path: Vec<Stretch>,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ReinforceEntry {
    /// As `piece.edge`.
    pub edges: Vec<String>,
    pub kind: Band,
    /// Force per relative elongation.
    pub stiffness_n: f64,
    /// Ratio of the length of the band to that of the edge.
    #[serde(default = "unstretched")]
    pub length_factor: f64,
}

fn unstretched() -> f64 {
    1.0
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FitEntry {
    pub path: Vec<Stretch>,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Stretch {
    /// Edge `piece.edge`.
    Edge(String),
    /// Straight across a piece between two points, each `piece.edge.start`, `.mid` or `.end`.
    Line { line: [String; 2] },
}

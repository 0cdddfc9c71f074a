//! The seam file: how the pieces of a style are named, sewn and measured. TOML, one file for all sizes.
//!
//! `docs/reference.md` lists its keys, and a test holds that page to what is read here. `docs/patterns.md` has an example.
//!
//! **Corners** are the turn points of the piece, numbered from 0 counter-clockwise along the outline as drawn, starting
//! at the first turn point in the file. Where a file has no usable turn points, corners are the vertices at which the
//! outline turns by 30 degrees or more, starting at its first vertex. Sizes may differ in what is marked and in what turns
//! enough: where the entry has `corners_at`, edges count its corners, and each is found on the outline of a size by its
//! place beside the others.
//!
//! **Directions.** Pieces are drawn seen from outside, so every edge runs counter-clockwise round its piece *as worn*
//! (a mirrored piece's edges are turned round). The two sides of a seam therefore run against each other: `a` is walked
//! forwards, `b` backwards, each chain in the order written. **Points** of an edge are `start`, `mid` (half its length)
//! and `end`, in the direction of the edge as worn.

use std::collections::BTreeMap;
use std::fmt;

use serde::{Deserialize, Serialize};

use super::garment::{Band, MeasurementKind, Role};

/// Why pieces and a seam file do not make a style.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum StyleError {
    /// The seam file is not the TOML it should be.
    #[error("{file}: not a seam file: {reason}")]
    Syntax {
        /// Name of the seam file, for the message.
        file: String,
        /// What the TOML reader found, with the line.
        reason: String,
    },
    /// A name that is not there.
    #[error("{file}: {place}: there is no {what} `{found}`; there is: {accepted}")]
    Unknown {
        /// Name of the seam file, for the message.
        file: String,
        /// Entry of the seam file.
        place: String,
        /// Kind of thing named.
        what: &'static str,
        /// Name that the entry has.
        found: String,
        /// Names that exist.
        accepted: String,
    },
    /// An entry that contradicts the pieces or another entry.
    #[error("{file}: {place}: {found}; accepted: {accepted}")]
    Contradiction {
        /// Name of the seam file, for the message.
        file: String,
        /// Entry of the seam file.
        place: String,
        /// What is wrong.
        found: String,
        /// What would be accepted.
        accepted: String,
    },
}

/// Greatest difference of length between the two sides of a seam where the file names none, mm.
pub const DEFAULT_LENGTH_TOLERANCE_MM: f64 = 1.0;

/// A seam file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SeamFile {
    /// Name of the style.
    pub name: String,
    /// Size that it was made on, where it holds for several.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub size: Option<String>,
    /// Greatest difference of length between the two sides of a seam, mm.
    #[serde(default = "default_tolerance")]
    pub length_tolerance_mm: f64,
    /// Seam allowance of pieces whose file has only the cut line, mm.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub allowance_mm: f64,
    /// Edges, `piece.edge`, that are meant to be in no seam; those that a measurement runs along need not be named.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub open: Vec<String>,
    /// Pieces by id; none in a file that only measures a pattern with its own seams.
    #[serde(default)]
    pub piece: BTreeMap<String, PieceEntry>,
    /// Which edges are sewn together.
    #[serde(default)]
    pub seam: Vec<SeamEntry>,
    /// Lengths along the pattern that are compared with the drape.
    #[serde(default)]
    pub measurement: Vec<MeasurementEntry>,
    /// Edges that a rib, a tape, a hem or a band strengthens.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub reinforce: Vec<ReinforceEntry>,
    /// Pattern girths at body levels, by level.
    #[serde(default)]
    pub fit: BTreeMap<String, FitEntry>,
}

impl SeamFile {
    /// Reads the bytes of a seam file; `file` is its name for messages.
    ///
    /// # Errors
    /// [`StyleError::Syntax`] when they are not UTF-8 or not such TOML.
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
    /// Block, or piece name, in the DXF file.
    pub block: String,
    /// How it is worn.
    pub role: Role,
    /// Worn as the mirror image of what is drawn.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub mirror: bool,
    /// Corners that the edges count, counter-clockwise, as shares of the width and the height of the piece as drawn, on
    /// the size that the file was made on; where there are none, the corners of each size count.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub corners_at: Vec<[f64; 2]>,
    /// Seam allowance of edges by name, mm, where it is not that of the file.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub allowance_mm: BTreeMap<String, f64>,
    /// Edges by name: first and last corner, counter-clockwise as drawn.
    pub edges: BTreeMap<String, [usize; 2]>,
}

/// Difference of the ratio of two sides between sizes that is asked about.
pub(crate) const RATIO_DOUBT: f64 = 0.05;
/// Share of the tolerance within which the ease of all sizes counts as one.
pub(crate) const SAME_EASE: f64 = 0.5;

/// A seam between two chains of edges.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SeamEntry {
    /// Name of the seam, for messages.
    pub name: String,
    /// One side, `piece.edge` each, in order along the seam.
    pub a: Vec<String>,
    /// The other side.
    pub b: Vec<String>,
    /// Both sides run counter-clockwise round their pieces.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub same_direction: bool,
    /// Length of `a` less length of `b`.
    #[serde(default, skip_serializing_if = "Ease::is_none")]
    pub ease_mm: Ease,
}

/// Length of one side of a seam less that of the other, mm.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Ease {
    /// The same in every size.
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
    /// Whether the sides are equally long in every size.
    #[must_use]
    pub fn is_none(&self) -> bool {
        *self == Self::default()
    }

    /// The ease of a size, mm, whose name counts in upper and lower case alike; `None` of a size that is not named.
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
    /// Loop or length.
    pub kind: MeasurementKind,
    /// Where it runs.
    pub path: Vec<Stretch>,
}

/// Edges with a stiffness of their own.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ReinforceEntry {
    /// Edges, `piece.edge` each.
    pub edges: Vec<String>,
    /// What strengthens them.
    pub kind: Band,
    /// Force per relative elongation, N.
    pub stiffness_n: f64,
    /// Length of the band over that of the edge.
    #[serde(default = "one")]
    pub length_factor: f64,
}

fn one() -> f64 {
    1.0
}

/// The girth of the pattern at a body level.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FitEntry {
    /// Where it runs.
    pub path: Vec<Stretch>,
}

/// One stretch of a path.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Stretch {
    /// Along an edge, `piece.edge`.
    Edge(String),
    /// Straight across a piece between two points, `piece.edge.start|mid|end`.
    Line {
        /// Both ends, as `piece.edge.start`, `.mid` or `.end`.
        line: [String; 2],
    },
}

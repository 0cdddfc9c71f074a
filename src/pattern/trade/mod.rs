//! Words of the trade: what names of pieces say, in the languages of pattern files.

mod names;
mod words;

use std::fmt;

pub use self::names::{Named, read, read_words, word_of, words};

/// Kind of a piece.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Class {
    /// Front or back of the trunk.
    Body,
    /// Side panel of a front or back, between the princess seam and the side, or between front and back.
    SidePanel,
    /// Front or back of a leg.
    Leg,
    /// Sleeve, or front or back of one.
    Sleeve,
    /// Front or back of a skirt.
    Skirt,
    /// Yoke: separately cut part of a front or back over the shoulder, or of a leg or skirt below the waist.
    Yoke,
    /// Band round the waist of a skirt or trousers.
    Waistband,
    /// Band at the end of a sleeve.
    Cuff,
    /// Collar or stand that is sewn to the neckline.
    Collar,
    /// Anything else, in no proposed seam.
    Other,
}

impl Class {
    pub(crate) fn as_str(self) -> &'static str {
        match self {
            Self::Body => "trunk",
            Self::SidePanel => "side panel",
            Self::Leg => "leg",
            Self::Sleeve => "sleeve",
            Self::Skirt => "skirt",
            Self::Yoke => "yoke",
            Self::Waistband => "waistband",
            Self::Cuff => "cuff",
            Self::Collar => "collar",
            Self::Other => "part",
        }
    }
}

/// Front or back.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Face {
    /// Front of the wearer.
    Front,
    /// Back of the wearer.
    Back,
}

/// Side of the wearer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Hand {
    /// The wearer's right.
    Right,
    /// The wearer's left.
    Left,
}

impl Hand {
    /// Both hands, the right first.
    pub const BOTH: [Self; 2] = [Self::Right, Self::Left];

    pub(crate) fn other(self) -> Self {
        match self {
            Self::Right => Self::Left,
            Self::Left => Self::Right,
        }
    }

    pub(crate) fn as_str(self) -> &'static str {
        match self {
            Self::Right => "right",
            Self::Left => "left",
        }
    }
}

impl fmt::Display for Hand {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.as_str())
    }
}

impl Face {
    /// Both faces, the front first.
    pub const BOTH: [Self; 2] = [Self::Front, Self::Back];

    pub(crate) fn other(self) -> Self {
        match self {
            Self::Front => Self::Back,
            Self::Back => Self::Front,
        }
    }

    pub(crate) fn as_str(self) -> &'static str {
        match self {
            Self::Front => "front",
            Self::Back => "back",
        }
    }
}

impl fmt::Display for Face {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.as_str())
    }
}

/// Part of a kind of piece that names tell apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PartName {
    /// Under sleeve: the piece below the arm of a sleeve in two.
    Under,
    /// Gore of a skirt: one of several equal parts.
    Gore,
    /// Collar, hood or neckband: goes with a trunk.
    Neck,
    /// Side of a garment: between front and back.
    Side,
    /// Any panel of a garment.
    Panel,
}

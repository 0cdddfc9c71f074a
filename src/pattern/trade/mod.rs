//! Words of the trade: what names of pieces say, in the languages of pattern files.

mod names;
mod words;

use std::fmt;

pub use self::names::{Named, read, read_words, word_of, words};

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Class {
    /// Front or back of the trunk.
    Body,
    /// Side panel of a front or back, between the princess seam and the side, or between front and back.
    SidePanel,
    Leg,
    Sleeve,
    Skirt,
    /// Separately cut part of a front or back over the shoulder, or of a leg or skirt below the waist.
    Yoke,
    Waistband,
    Cuff,
    /// Collar or stand that is sewn to the neckline.
    Collar,
    /// In no proposed seam.
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

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Face {
    Front,
    Back,
}

/// Side of the wearer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Hand {
    Right,
    Left,
}

impl Hand {
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
    /// Piece below the arm of a sleeve in two.
    Under,
    /// One of several equal parts of a skirt.
    Gore,
    /// Collar, hood or neckband: goes with a trunk.
    Neck,
    /// Between front and back.
    Side,
    Panel,
}

//! Arguments of patterns that are sewn as proposed.

use clap::{Args, ValueEnum};

use geom::units::from_mm;
use spec::patterns::Unit;
use wardrobe::seams::Asking;

/// Unit of a pattern whose file names none.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum PatternUnit {
    /// Coordinates in millimetres.
    Mm,
    /// Coordinates in centimetres.
    Cm,
    /// Coordinates in inches.
    In,
    /// Coordinates in metres.
    M,
}

impl From<PatternUnit> for Unit {
    fn from(unit: PatternUnit) -> Self {
        match unit {
            PatternUnit::Mm => Self::Mm,
            PatternUnit::Cm => Self::Cm,
            PatternUnit::In => Self::In,
            PatternUnit::M => Self::M,
        }
    }
}

/// What is said about a pattern that is to be sewn as proposed.
#[derive(Debug, Args)]
pub struct CutFiles {
    /// Size, where a file holds several.
    #[arg(long, value_name = "NAME")]
    pub size: Option<String>,
    /// Unit of the files, where they name none.
    #[arg(long, value_enum)]
    pub unit: Option<PatternUnit>,
    /// Seam allowance of pieces that have no sew line.
    #[arg(long, value_name = "MM", default_value_t = 0.0)]
    pub allowance_mm: f64,
}

impl CutFiles {
    /// Options of a proposal, with answers to its questions.
    pub fn asking<'a>(&'a self, answers: &'a [(usize, char)]) -> Asking<'a> {
        let (size, unit) = (self.size.as_deref(), self.unit.map(Unit::from));
        Asking { size, unit, allowance_m: from_mm(self.allowance_mm), answers }
    }
}

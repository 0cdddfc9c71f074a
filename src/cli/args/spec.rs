//! Arguments of specification sheets.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::CutFiles;
use spec::patterns::Unit;
use wardrobe::seams::spec_sheet::{Answer, SheetAsked};

/// Unit of a specification sheet.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum SheetUnit {
    /// Inches.
    In,
    /// Centimetres.
    Cm,
    /// Millimetres.
    Mm,
}

impl From<SheetUnit> for Unit {
    fn from(unit: SheetUnit) -> Self {
        match unit {
            SheetUnit::In => Self::In,
            SheetUnit::Cm => Self::Cm,
            SheetUnit::Mm => Self::Mm,
        }
    }
}

/// What is said about a sheet beside its file.
#[derive(Debug, Args)]
pub struct SheetFlags {
    /// Point of a row that is asked for: CODE=POINT, CODE=2*POINT of a whole girth, CODE=none; may be given several times.
    #[arg(long = "match", value_name = "CODE=POINT")]
    pub answers: Vec<Answer>,
    /// Sheet of the workbook, where several have tables.
    #[arg(long, value_name = "NAME")]
    pub tab: Option<String>,
    /// Unit of the sheet, where it says none.
    #[arg(long, value_enum)]
    pub sheet_unit: Option<SheetUnit>,
}

impl SheetFlags {
    /// Sheet and unit that are said.
    pub fn asked(&self) -> SheetAsked<'_> {
        SheetAsked { sheet: self.tab.as_deref(), unit: self.sheet_unit.map(Unit::from) }
    }
}

/// A pattern with a buyer's specification sheet.
#[derive(Debug, Args)]
pub struct PatternSpec {
    /// DXF file, folder of them, or GarmentCode JSON.
    pub path: PathBuf,
    /// Specification sheet (CSV, XLSX): code, description, tolerance, a column for each size.
    #[arg(long, value_name = "FILE")]
    pub sheet: PathBuf,
    /// Seam file; without it the pattern is sewn as `propose` says.
    #[arg(long, value_name = "FILE")]
    pub seams: Option<PathBuf>,
    #[command(flatten)]
    pub cut: CutFiles,
    #[command(flatten)]
    pub flags: SheetFlags,
    /// Sheet to write (X.xlsx or X.csv); standard output without it.
    #[arg(long, short, value_name = "FILE")]
    pub output: Option<PathBuf>,
}

/// A style with its specification sheet.
#[derive(Debug, Args)]
pub struct StyleSpec {
    /// Name of the style.
    pub name: String,
    /// Specification sheet to keep (CSV, XLSX): code, description, tolerance, a column for each size.
    #[arg(long, value_name = "FILE")]
    pub sheet: Option<PathBuf>,
    #[command(flatten)]
    pub flags: SheetFlags,
    /// Subject whose worn lengths are shown.
    #[arg(long, value_name = "ID")]
    pub subject: Option<String>,
    /// Sheet to write (X.xlsx or X.csv); standard output without it.
    #[arg(long, short, value_name = "FILE")]
    pub output: Option<PathBuf>,
}

//! Arguments of `toile pattern`.

use std::path::PathBuf;

use clap::{Args, Subcommand, ValueEnum};

use super::{CutFiles, PatternSpec, PatternUnit, SeamCommand, SewFiles};
use wardrobe::seams::pattern_files::Standard;

/// Standard by which a DXF file is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum DxfStandard {
    /// As ANSI/AAMA-292 has it.
    Aama,
    /// As ASTM D6673 has it.
    Astm,
}

impl From<DxfStandard> for Standard {
    fn from(standard: DxfStandard) -> Self {
        match standard {
            DxfStandard::Aama => Self::Aama,
            DxfStandard::Astm => Self::Astm,
        }
    }
}

/// Style that can be drafted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum DraftStyle {
    /// Men's V-neck T-shirt, sizes S, M and L.
    Tshirt,
    /// Men's trousers, sizes S, M and L.
    Trousers,
    /// Women's tee-top, sizes M and L.
    Teetop,
    /// Women's dress, one size.
    Dress,
}

/// An answer: the number of the question and the letter of the choice.
///
/// # Errors
/// The values that are accepted.
pub fn answer(text: &str) -> Result<(usize, char), String> {
    let accepted = || "accepted: the number of a question and the letter of a choice, such as 2=b".to_owned();
    let (number, letter) = text.split_once('=').ok_or_else(accepted)?;
    let mut letters = letter.trim().chars();
    match (number.trim().parse(), letters.next(), letters.next()) {
        (Ok(number), Some(letter), None) if letter.is_ascii_alphabetic() => Ok((number, letter.to_ascii_lowercase())),
        _ => Err(accepted()),
    }
}

/// A pattern with its seam file.
#[derive(Debug, Args)]
pub struct StyleFiles {
    /// DXF file, folder of them, or GarmentCode JSON with its seams; `check` also takes a study.
    pub file: PathBuf,
    /// Seam file; a DXF file needs one.
    #[arg(long, value_name = "FILE")]
    pub seams: Option<PathBuf>,
    /// Size, where the file holds several.
    #[arg(long, value_name = "NAME")]
    pub size: Option<String>,
    /// Unit of the file, where it names none.
    #[arg(long, value_enum)]
    pub unit: Option<PatternUnit>,
}

/// Commands on patterns.
#[derive(Debug, Subcommand)]
pub enum Pattern {
    /// What is in a pattern file (DXF, GarmentCode JSON, features), or in every one of a folder.
    Inspect {
        /// File or folder.
        path: PathBuf,
        #[command(flatten)]
        files: BesideFiles,
        /// One row for each file: how many blocks are pieces, how many are refused and why.
        #[arg(long)]
        by_file: bool,
    },
    /// Propose a seam file: what each piece is and what is sewn to what, with confidences.
    Propose {
        /// DXF file, or a folder of them.
        path: PathBuf,
        #[command(flatten)]
        cut: CutFiles,
        /// Answer to a question, by its number and the letter of the choice; may be given several times.
        #[arg(long, value_name = "N=x", value_parser = answer)]
        answer: Vec<(usize, char)>,
        /// Ask at the terminal what has choices.
        #[arg(long)]
        ask: bool,
        /// Seam file to write, to be read and edited.
        #[arg(long, short, value_name = "FILE")]
        output: Option<PathBuf>,
    },
    /// Whether a pattern and its seam file fit together: seams, measurements, meshes; of a study, every size.
    Check(StyleFiles),
    /// Work on a seam file: add, open or turn a seam, confirm, answer, leave out.
    #[command(subcommand)]
    Seam(SeamCommand),
    /// Sew a pattern coarsely on a body while its seam file is edited: a picture from four sides, and what is to be decided.
    Sew(SewFiles),
    /// Draft a built-in style in all its sizes, with its seam file.
    Draft {
        /// Style to draft.
        #[arg(value_enum, default_value = "tshirt")]
        style: DraftStyle,
        /// Folder to write to.
        #[arg(long, short, value_name = "DIR")]
        output: PathBuf,
    },
    /// Mesh a pattern; says how good the triangles are.
    Mesh {
        #[command(flatten)]
        files: StyleFiles,
        /// Edge length, mm.
        #[arg(long, default_value_t = 15.0, value_name = "MM")]
        edge_length_mm: f64,
    },
    /// Draw the pieces with their numbered measurements as SVG.
    Sheet {
        #[command(flatten)]
        files: StyleFiles,
        /// SVG file to write.
        #[arg(long, short, value_name = "FILE")]
        output: PathBuf,
    },
    /// Points of measure in all sizes with their grade steps: the specification sheet.
    Pom {
        /// DXF file, folder of them, or GarmentCode JSON.
        path: PathBuf,
        /// Seam file; without it the pattern is sewn as `propose` says.
        #[arg(long, value_name = "FILE")]
        seams: Option<PathBuf>,
        #[command(flatten)]
        cut: CutFiles,
        /// Sheet to write (X.csv or X.xlsx), or a drawing of where the points lie (X.svg); standard output without it.
        #[arg(long, short, value_name = "FILE")]
        output: Option<PathBuf>,
    },
    /// A buyer's specification sheet beside the pattern: the point of measure of each row, its deviation, in or out.
    Spec(PatternSpec),
    /// The features of the pieces as JSON: outline, corners, edges, grain, notches, points, lines, information.
    Features {
        /// DXF file, GarmentCode JSON, or features.
        path: PathBuf,
        #[command(flatten)]
        files: BesideFiles,
        /// File to write (X.features.json); standard output without it.
        #[arg(long, short, value_name = "FILE")]
        output: Option<PathBuf>,
    },
    /// Write a pattern as AAMA or ASTM DXF (X.dxf) or, with its seams, as GarmentCode (X.json).
    Convert {
        /// DXF file, GarmentCode JSON, or features.
        path: PathBuf,
        #[command(flatten)]
        files: BesideFiles,
        /// Seam file; GarmentCode needs one unless the pattern holds its seams.
        #[arg(long, value_name = "FILE")]
        seams: Option<PathBuf>,
        /// Standard of a DXF file.
        #[arg(long, value_enum, default_value_t = DxfStandard::Aama)]
        standard: DxfStandard,
        /// Write the sample size (or --size) alone, and beside it X.rul with the rules that make the other sizes.
        #[arg(long)]
        with_rul: bool,
        /// File to write.
        #[arg(long, short, value_name = "FILE")]
        output: PathBuf,
    },
}

/// What is said about a pattern beside its file.
#[derive(Debug, Args)]
pub struct BesideFiles {
    /// Only pieces of this size.
    #[arg(long, value_name = "NAME")]
    pub size: Option<String>,
    /// Unit of DXF files, where they name none.
    #[arg(long, value_enum)]
    pub unit: Option<PatternUnit>,
    /// Grade rule table (.rul) of a file that holds the sample size: makes all sizes.
    #[arg(long, value_name = "FILE")]
    pub rul: Option<PathBuf>,
    /// Unit of the numbers of the table, whatever it says: METRIC is mm, and some programs write cm under it.
    #[arg(long, value_enum, requires = "rul")]
    pub rul_unit: Option<PatternUnit>,
    /// Table of piece information (CSV, XLSX) with a column `piece`: quantity, material, grain_deg, role ...
    #[arg(long, value_name = "FILE")]
    pub info: Option<PathBuf>,
}

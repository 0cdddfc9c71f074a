//! Errors of patterns, seam files and tables of bodies.

use std::path::PathBuf;

use store::{Origin, StudyError};

/// Reason why a pattern, a seam file or a folder of bodies is refused.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum WardrobeError {
    /// No garment or no body that can be used.
    #[error("nothing to dress: {reasons}")]
    NothingToDress {
        /// Files that were refused, each with its reason.
        reasons: String,
    },
    /// A folder without bodies.
    #[error("{}: found no body; accepted: files ending in {accepted}", folder.display())]
    NoBody {
        /// Folder that was searched.
        folder: PathBuf,
        /// Endings that are accepted.
        accepted: String,
    },
    /// A table of the reference bodies that cannot be used.
    #[error("{}: {problem}; accepted: CSV tables manifest.csv and measurements.csv with a column id", path.display())]
    Table {
        /// Path of the table.
        path: PathBuf,
        /// Problem of the table.
        problem: TableProblem,
    },
    /// A pattern without points of measure.
    #[error("{}: no point of measure was found; accepted: pieces with roles, sewn together", pattern.display())]
    NoPoint {
        /// Path of the pattern.
        pattern: PathBuf,
    },
    /// A specification sheet with none of the pattern's sizes.
    #[error("{file}: found sizes {found}; accepted: those of the pattern, {accepted}")]
    NoSizeOfSheet {
        /// Name of the sheet's file.
        file: String,
        /// Sizes of the sheet.
        found: String,
        /// Sizes of the pattern.
        accepted: String,
    },
    /// A style without a specification sheet.
    #[error("style {style} has no specification sheet; give one with --sheet FILE")]
    NoSpecSheet {
        /// Name of the style.
        style: String,
    },
    /// A pattern without seams that is to become GarmentCode JSON.
    #[error("{pattern}: GarmentCode JSON holds seams: name a seam file (--seams FILE)")]
    NoSeams {
        /// Name of the pattern.
        pattern: String,
    },
    /// An edit of a pattern that holds its own seams.
    #[error("{pattern}: holds its own seams, and needs no seam file; they are edited where it was drawn")]
    HoldsSeams {
        /// Name of the pattern.
        pattern: String,
    },
    /// An edit of a pattern without a seam file.
    #[error("{pattern}: has no seam file yet; propose one")]
    NoSeamFile {
        /// Name of the pattern.
        pattern: String,
    },
    /// A seam that is not in the seam file.
    #[error("{file}: there is no seam `{seam}`")]
    NoSeam {
        /// Name of the seam file.
        file: String,
        /// Name of the seam.
        seam: String,
    },
    /// A seam file in which no proposed seam is sure.
    #[error("{file}: no proposed seam is {percent:.0} % sure")]
    NoneSure {
        /// Name of the seam file.
        file: String,
        /// Confidence from which a seam counts as sure, %.
        percent: f64,
    },
    /// An answer to a finding of a check, which only an edit settles.
    #[error("{question}: the check finds it, nobody asks it; sew the edge, or name it in `open` of the seam file")]
    NotAsked {
        /// Text of the finding.
        question: String,
    },
    /// An answer to a question that is not asked, or by a letter that it does not have.
    #[error("{question}: answer {letter}: accepted: {accepted}")]
    Answer {
        /// Text of the question.
        question: String,
        /// Letter of the choice.
        letter: char,
        /// Questions with their choices.
        accepted: String,
    },
    /// A pattern for which no seams can be proposed.
    #[error("{pattern}: no piece was recognised; give its seam file")]
    NotRecognised {
        /// Name of the pattern.
        pattern: String,
    },
}

/// Problem of a table of the reference bodies.
#[derive(Debug, thiserror::Error)]
pub enum TableProblem {
    /// The table cannot be read.
    #[error(transparent)]
    Io(#[from] std::io::Error),
    /// A line is not UTF-8.
    #[error("line {0} is no UTF-8")]
    Encoding(usize),
    /// The table has no column of identifiers.
    #[error("it has no column id")]
    NoId,
    /// A line has more cells than the table has columns.
    #[error("line {line} has {cells} cells for {columns} columns")]
    Cells {
        /// Number of the line, from 1.
        line: usize,
        /// Number of cells in the line.
        cells: usize,
        /// Number of columns of the table.
        columns: usize,
    },
}

impl From<WardrobeError> for StudyError {
    fn from(error: WardrobeError) -> Self {
        let origin = match error {
            WardrobeError::NothingToDress { .. } => Origin::Audit,
            WardrobeError::NoBody { .. } | WardrobeError::Table { .. } => Origin::Body,
            _ => Origin::Pattern,
        };
        Self::refused(origin, error)
    }
}

//! Errors of patterns, seam files and tables of bodies.

use std::path::PathBuf;

use store::{Origin, StudyError};

#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum WardrobeError {
    #[error("nothing to dress: {reasons}")]
    NothingToDress { reasons: String },
    #[error("{}: found no body; accepted: files ending in {accepted}", folder.display())]
    NoBody { folder: PathBuf, accepted: String },
    #[error("{}: {problem}; accepted: CSV tables manifest.csv and measurements.csv with a column id", path.display())]
    Table { path: PathBuf, problem: TableProblem },
    #[error("{}: no point of measure was found; accepted: pieces with roles, sewn together", pattern.display())]
    NoPoint { pattern: PathBuf },
    #[error("{file}: found sizes {found}; accepted: those of the pattern, {accepted}")]
    NoSizeOfSheet { file: String, found: String, accepted: String },
    #[error("style {style} has no specification sheet; give one with --sheet FILE")]
    NoSpecSheet { style: String },
    #[error("{pattern}: GarmentCode JSON holds seams: name a seam file (--seams FILE)")]
    NoSeams { pattern: String },
    #[error("{pattern}: holds its own seams, and needs no seam file; they are edited where it was drawn")]
    HoldsSeams { pattern: String },
    #[error("{pattern}: has no seam file yet; propose one")]
    NoSeamFile { pattern: String },
    #[error("{file}: there is no seam `{seam}`")]
    NoSeam { file: String, seam: String },
    #[error("{file}: no proposed seam is {percent:.0} % sure")]
    NoneSure {
        file: String,
        /// Confidence from which a seam counts as sure.
        percent: f64,
    },
    #[error("{question}: the check finds it, nobody asks it; sew the edge, or name it in `open` of the seam file")]
    NotAsked {
        /// Text of the finding.
        question: String,
    },
    #[error("{question}: answer {letter}: accepted: {accepted}")]
    Answer { question: String, letter: char, accepted: String },
    #[error("{pattern}: no piece was recognised; give its seam file")]
    NotRecognised { pattern: String },
}

#[derive(Debug, thiserror::Error)]
pub enum TableProblem {
    #[error(transparent)]
    Io(#[from] std::io::Error),
    #[error("line {0} is no UTF-8")]
    Encoding(usize),
    #[error("it has no column id")]
    NoId,
    #[error("line {line} has {cells} cells for {columns} columns")]
    Cells {
        /// Counts from 1.
        line: usize,
        cells: usize,
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

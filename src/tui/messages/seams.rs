//! What is asked of the thread that works on seams, and what it answers.

use std::path::PathBuf;

use study::SizeKey;
use study::files::SourceFile;
use study::seams::{LaidOut, SeamStep};

/// A size to lay out.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LayoutRequest {
    /// Style.
    pub style: String,
    /// Its revision and the size.
    pub key: SizeKey,
    /// The seam file as edited and not saved; `None` where it is as stored.
    pub seams: Option<SourceFile>,
    /// File of the study that wears the style.
    pub study: Option<PathBuf>,
}

/// What the thread is asked for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SeamTask {
    /// Lay a size out.
    LayOut(LayoutRequest),
    /// Do a step of work on its seams.
    Sew(LayoutRequest, SeamStep),
}

/// A size laid out.
#[derive(Clone, Debug, PartialEq)]
pub struct SizeLayout {
    /// Pieces, seams, measurements, questions.
    pub out: LaidOut,
    /// The seam file as stored.
    pub stored: Option<SourceFile>,
    /// Where it lies in the folder of the study, if it says the same there.
    pub home: Option<PathBuf>,
}

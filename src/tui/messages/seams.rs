//! Requests to the threads that work on seams, and their answers.

use std::path::PathBuf;

use results::preview::{Care, Hung};
use store::files::SourceFile;
use store::{SizeKey, SubjectId};
use wardrobe::seams::{LaidOut, SeamStep};

/// A size to lay out.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LayoutRequest {
    /// Name of the style in the catalogue.
    pub style: String,
    /// Its revision and the size.
    pub key: SizeKey,
    /// The seam file as edited and not saved; `None` where it is as stored.
    pub seams: Option<SourceFile>,
    /// File of the study that wears the style.
    pub study: Option<PathBuf>,
}

/// A task for the thread that works on seams.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SeamTask {
    /// Lay a size out.
    LayOut(LayoutRequest),
    /// Do a step of work on its seams.
    Sew(SeamWork),
}

/// A step of work on the seams of a size.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SeamWork {
    /// The size, with its seam file as it is edited.
    pub size: LayoutRequest,
    /// The step.
    pub step: SeamStep,
}

/// A size to sew and drape on somebody.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PreviewRequest {
    /// Its number: later ones are greater.
    pub number: u64,
    /// The size, with its seam file as it is edited or stored.
    pub size: LayoutRequest,
    /// The subject that wears it.
    pub subject: SubjectId,
    /// Name of the cloth; none where nobody chose one.
    pub fabric: Option<String>,
    /// Care with which it is draped.
    pub care: Care,
}

impl PreviewRequest {
    /// True if a size on a subject in a cloth looks as what was asked for: saving its seams does not change it.
    #[must_use]
    pub fn is_of(&self, size: &LayoutRequest, subject: SubjectId, fabric: Option<&String>) -> bool {
        let LayoutRequest { style, key, seams, .. } = &self.size;
        (style, key.size, seams) == (&size.style, size.key.size, &size.seams)
            && self.subject == subject
            && self.fabric.as_ref() == fabric
    }
}

/// A size draped coarsely; its picture is asked for by the number of the request.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Previewed {
    /// The subject that wears it.
    pub subject: String,
    /// Name of the fabric that it is cut from.
    pub fabric: String,
    /// State that the drape came to.
    pub hung: Hung,
    /// Reasons why it came no farther, and remarks on the drape.
    pub remarks: Vec<String>,
    /// Time that it took, ms.
    pub took_ms: u64,
}

/// A size laid out.
#[derive(Clone, Debug, PartialEq)]
pub struct SizeLayout {
    /// Pieces, seams, measurements, questions.
    pub out: LaidOut,
    /// The seam file as stored.
    pub stored: Option<SourceFile>,
    /// Path of the seam file in the folder of the study, if it says the same there.
    pub home: Option<PathBuf>,
}

//! Requests to the threads that work on seams, and their answers.

use std::path::PathBuf;

use results::preview::{Care, Hung};
use store::files::SourceFile;
use store::{SizeKey, SubjectId};
use wardrobe::seams::{LaidOut, SeamStep};

/// A size to be laid out.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LayoutRequest {
    /// Name of the style in the catalogue.
    pub style: String,
    /// Numbers of the revisions of style and size.
    pub key: SizeKey,
    /// Seam file as edited; `None` for the stored one.
    pub seams: Option<SourceFile>,
    /// Path of the study file that uses the style.
    pub study: Option<PathBuf>,
}

/// A task for the thread that works on seams.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SeamTask {
    /// Lay a size out.
    LayOut(LayoutRequest),
    /// Do a step of work on the seams of a size.
    Sew(SeamWork),
}

/// A step of work on the seams of a size.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SeamWork {
    /// Size, with its seam file as edited.
    pub size: LayoutRequest,
    /// Step of work.
    pub step: SeamStep,
}

/// A size to be sewn and draped on a subject.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PreviewRequest {
    /// Number of the request; later requests have greater numbers.
    pub number: u64,
    /// Size, with its seam file as edited or stored.
    pub size: LayoutRequest,
    /// Subject who wears the size.
    pub subject: SubjectId,
    /// Name of the chosen fabric; `None` for the default.
    pub fabric: Option<String>,
    /// Accuracy of the drape.
    pub care: Care,
}

impl PreviewRequest {
    /// True if this request would look the same for a size, a subject and a fabric. Saving the seams does not change
    /// that.
    pub fn is_of(&self, size: &LayoutRequest, subject: SubjectId, fabric: Option<&String>) -> bool {
        let LayoutRequest { style, key, seams, .. } = &self.size;
        (style, key.size, seams) == (&size.style, size.key.size, &size.seams)
            && self.subject == subject
            && self.fabric.as_ref() == fabric
    }
}

/// Result of a preview. Its picture is requested by the number of the preview's request.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Previewed {
    /// Name of the subject who wears the size.
    pub subject: String,
    /// Name of the fabric that it is cut from.
    pub fabric: String,
    /// State that the drape came to.
    pub hung: Hung,
    /// Reasons why the drape is not complete, and remarks.
    pub remarks: Vec<String>,
    /// Time that it took, ms.
    pub took_ms: u64,
}

/// A size, laid out for the Styles screen.
#[derive(Clone, Debug, PartialEq)]
pub struct SizeLayout {
    /// Pieces, seams, measurements, questions.
    pub out: LaidOut,
    /// Seam file as stored.
    pub stored: Option<SourceFile>,
    /// Path of the seam file in the study's folder, if its contents are the stored ones.
    pub home: Option<PathBuf>,
}

//! Requests to the threads that work on seams, and their answers.

use std::path::PathBuf;

use results::preview::{Care, Hung};
use store::files::SourceFile;
use store::{SizeKey, SubjectId};
use wardrobe::seams::{LaidOut, SeamStep};

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LayoutRequest {
    pub style: String,
    /// Numbers of the revisions of style and size.
    pub key: SizeKey,
    /// Seam file as edited; `None` for the stored one.
    pub seams: Option<SourceFile>,
    /// Path of the study file that uses the style.
    pub study: Option<PathBuf>,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SeamTask {
    LayOut(LayoutRequest),
    Sew(SeamWork),
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SeamWork {
    pub size: LayoutRequest,
    pub step: SeamStep,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PreviewRequest {
    /// Number; greater for later requests.
    pub number: u64,
    pub size: LayoutRequest,
    pub subject: SubjectId,
    /// Name of the fabric; `None` for the default.
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
    pub subject: String,
    pub fabric: String,
    /// State that the drape came to.
    pub hung: Hung,
    /// Reasons why the drape is not complete, and remarks.
    pub remarks: Vec<String>,
    pub took_ms: u64,
}

#[derive(Clone, Debug, PartialEq)]
pub struct SizeLayout {
    pub out: LaidOut,
    /// Seam file as stored.
    pub stored: Option<SourceFile>,
    /// Path of the seam file in the study's folder, if its contents are the stored ones.
    pub home: Option<PathBuf>,
}

//! What is asked of the thread that works on seams, and what it answers.

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

/// What the thread is asked for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SeamTask {
    /// Lay a size out.
    LayOut(LayoutRequest),
    /// Do a step of work on its seams.
    Sew(LayoutRequest, SeamStep),
}

/// A size to sew and drape on somebody.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PreviewRequest {
    /// Its number: later ones are greater.
    pub number: u64,
    /// The size, with its seam file as it is edited or stored.
    pub size: LayoutRequest,
    /// Who wears it.
    pub subject: SubjectId,
    /// Name of the cloth; none where nobody chose one.
    pub fabric: Option<String>,
    /// How carefully it is draped.
    pub care: Care,
}

impl PreviewRequest {
    /// Whether a size on somebody in a cloth looks as what was asked for: saving its seams does not change it.
    #[must_use]
    pub fn is_of(&self, size: &LayoutRequest, subject: SubjectId, fabric: Option<&String>) -> bool {
        let LayoutRequest { style, key, seams, .. } = &self.size;
        (style, key.size, seams) == (&size.style, size.key.size, &size.seams)
            && self.subject == subject
            && self.fabric.as_ref() == fabric
    }
}

/// How a size hangs, coarsely; its picture is asked for by the number of the request.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Previewed {
    /// Who wears it.
    pub subject: String,
    /// Name of the fabric that it is cut from.
    pub fabric: String,
    /// How far it came.
    pub hung: Hung,
    /// Why no farther, and what is to be seen on it.
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
    /// Where it lies in the folder of the study, if it says the same there.
    pub home: Option<PathBuf>,
}

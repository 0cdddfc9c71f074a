//! State of the Styles screen.

use std::collections::BTreeMap;

use crate::messages::answered::Answered;
use crate::messages::seams::{LayoutRequest, PreviewRequest, Previewed, SizeLayout};
use store::files::SourceFile;
use wardrobe::seams::SeamStep;

/// An edge: index of the piece, and index of the edge on it.
pub type EdgeAt = (usize, usize);

/// The Styles screen.
#[derive(Default)]
pub struct StylesScreen {
    /// Selected style and size.
    pub selected: Option<(String, String)>,
    /// Unsaved edits by style, the latest last.
    pub edits: BTreeMap<String, Vec<Edited>>,
    /// Undone edits by style, the latest last.
    pub undone: BTreeMap<String, Vec<Edited>>,
    /// The present question; `None` while nothing is asked.
    pub asking: Option<Asking>,
    /// Preview of the garment.
    pub preview: Preview,
    /// Size of the latest request for a layout.
    pub requested: Option<LayoutRequest>,
    /// Latest layout, or the reason why there is none.
    pub layout: Option<Answered<LayoutRequest, Box<SizeLayout>>>,
    /// Selected edge.
    pub edge: EdgeAt,
    /// Index of the selected line of the table.
    pub line: usize,
    /// Marked edges, in the order of marking.
    pub marks: Vec<EdgeAt>,
    /// True while a step of work is in progress.
    pub is_busy: bool,
    /// True if the pieces are enlarged to all the room.
    pub enlarged: bool,
}

/// A seam file after a step of work.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Edited {
    /// Size that was edited, `STYLE/SIZE`.
    pub size: String,
    /// Step of work that was done.
    pub step: SeamStep,
    /// Seam file after the step.
    pub seams: SourceFile,
}

/// The present question about seams.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Asking {
    /// Index in the list of open questions.
    pub at: usize,
    /// Question of the user's own that is asked instead; `None` for the one of the list.
    pub own: Option<Own>,
    /// True if the next question of the list follows the answer.
    pub goes_on: bool,
}

/// A question of the user's own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Own {
    /// Asks what an edge is sewn to.
    Edge(EdgeAt),
    /// Asks for the role of the piece with this index.
    Piece(usize),
    /// Asks which of the pieces that are left out, from this index on, are worn too.
    LeftOut(usize),
}

/// Preview of a garment while its seams are edited.
#[derive(Debug, Default)]
pub struct Preview {
    /// Latest request.
    pub asked: Option<PreviewRequest>,
    /// Latest preview.
    pub seen: Option<Answered<PreviewRequest, Previewed>>,
    /// True to show the preview instead of the pieces, where only one fits.
    pub is_chosen: bool,
}

/// A line of the table beside the pieces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TableLine {
    /// A seam, by its index in [`wardrobe::seams::Desk`].
    Seam(usize),
    /// An open question, by its index.
    Question(usize),
    /// A measurement, by its index.
    Length(usize),
}

impl SizeLayout {
    /// Lines of the table: seams, questions about none of them, measurements.
    #[must_use]
    pub fn lines(&self) -> Vec<TableLine> {
        let seams = (0..self.out.desk.seams.len()).map(TableLine::Seam);
        let questions = self.out.undecided.iter().enumerate().filter(|(_, question)| question.seam.is_none());
        let questions = questions.map(|(k, _)| TableLine::Question(k));
        seams.chain(questions).chain((0..self.out.lengths.len()).map(TableLine::Length)).collect()
    }

    /// Index of the seam that an edge is in; `None` for an edge in no seam.
    #[must_use]
    pub fn seam_at(&self, edge: EdgeAt) -> Option<usize> {
        self.out.desk.seams.iter().position(|seam| seam.a.contains(&edge) || seam.b.contains(&edge))
    }

    /// All edges, piece by piece.
    pub fn edges(&self) -> Vec<EdgeAt> {
        let pieces = self.out.desk.pieces.iter().enumerate();
        pieces.flat_map(|(piece, drawn)| (0..drawn.edges.len()).map(move |edge| (piece, edge))).collect()
    }
}

//! State of the screen of styles.

use std::collections::BTreeMap;

use crate::messages::answered::Answered;
use crate::messages::seams::{LayoutRequest, PreviewRequest, Previewed, SizeLayout};
use store::files::SourceFile;
use wardrobe::seams::SeamStep;

/// An edge by its piece and its place on it.
pub type EdgeAt = (usize, usize);

/// The screen of styles.
#[derive(Default)]
pub struct StylesScreen {
    /// Style and size selected.
    pub selected: Option<(String, String)>,
    /// Edits of styles that are not saved, the latest last.
    pub edits: BTreeMap<String, Vec<Edited>>,
    /// Edits that were taken back, the latest last.
    pub undone: BTreeMap<String, Vec<Edited>>,
    /// Place among the questions, while they are answered.
    pub asking: Option<Asking>,
    /// The garment sewn coarsely.
    pub preview: Preview,
    /// The size whose layout was asked for.
    pub requested: Option<LayoutRequest>,
    /// The layout that came last, or why there is none.
    pub layout: Option<Answered<LayoutRequest, Box<SizeLayout>>>,
    /// Edge selected: its piece and its index there.
    pub edge: EdgeAt,
    /// Line of the table selected.
    pub line: usize,
    /// Edges marked, in order.
    pub marks: Vec<EdgeAt>,
    /// True while a step of work goes on.
    pub is_busy: bool,
    /// True where the pieces have all the room.
    pub enlarged: bool,
}

/// A seam file after a step of work.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Edited {
    /// The size that was worked on, `STYLE/SIZE`.
    pub size: String,
    /// Step of work that made it.
    pub step: SeamStep,
    /// The seam file then.
    pub seams: SourceFile,
}

/// Place among the questions to be decided.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Asking {
    /// Place in the list.
    pub at: usize,
    /// The question that is asked instead of that.
    pub own: Option<Own>,
    /// True where the list is gone on with once that is answered.
    pub goes_on: bool,
}

/// A question of the user's own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Own {
    /// The edges that an edge is sewn to.
    Edge(EdgeAt),
    /// The role of a piece.
    Piece(usize),
    /// The pieces that are worn too of those left out, from the first of some on.
    LeftOut(usize),
}

/// The garment sewn coarsely while its seams are edited.
#[derive(Debug, Default)]
pub struct Preview {
    /// The request made last.
    pub asked: Option<PreviewRequest>,
    /// The garment that came last.
    pub seen: Option<Answered<PreviewRequest, Previewed>>,
    /// True where it is shown instead of the pieces where there is no room for both.
    pub is_chosen: bool,
}

/// A line of the table beside the pieces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TableLine {
    /// A seam, by its index on the desk.
    Seam(usize),
    /// A question that a person must decide.
    Question(usize),
    /// A measurement, by its index among the lengths.
    Length(usize),
}

impl SizeLayout {
    /// The lines of the table: seams, questions, measurements.
    #[must_use]
    pub fn lines(&self) -> Vec<TableLine> {
        let seams = (0..self.out.desk.seams.len()).map(TableLine::Seam);
        let questions = self.out.undecided.iter().enumerate().filter(|(_, question)| question.seam.is_none());
        let questions = questions.map(|(k, _)| TableLine::Question(k));
        seams.chain(questions).chain((0..self.out.lengths.len()).map(TableLine::Length)).collect()
    }

    /// The seam that holds an edge.
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

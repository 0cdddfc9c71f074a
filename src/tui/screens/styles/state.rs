//! Where the user is among the styles.

use std::collections::BTreeMap;

use crate::messages::seams::{LayoutRequest, SizeLayout};
use study::files::SourceFile;

/// An edge by its piece and its place on it.
pub type EdgeAt = (usize, usize);

/// Where the user is among the styles.
#[derive(Debug, Default)]
pub struct Styles {
    /// Style and size selected.
    pub selected: Option<(String, String)>,
    /// Seam files of styles as edited and not saved, the latest last.
    pub edits: BTreeMap<String, Vec<SourceFile>>,
    /// The size whose layout was asked for.
    pub requested: Option<LayoutRequest>,
    /// What was laid out last, or why it could not be.
    pub layout: Option<(LayoutRequest, Result<Box<SizeLayout>, String>)>,
    /// Edge selected.
    pub edge: EdgeAt,
    /// Line of the table selected.
    pub line: usize,
    /// Edges marked, in order.
    pub marks: Vec<EdgeAt>,
    /// Whether a step of work goes on.
    pub is_busy: bool,
    /// Whether the pieces have all the room.
    pub enlarged: bool,
}

/// A line of the table beside the pieces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TableLine {
    /// A seam.
    Seam(usize),
    /// What a person must decide.
    Question(usize),
    /// A measurement.
    Length(usize),
}

impl SizeLayout {
    /// The lines of the table: seams, questions, measurements.
    #[must_use]
    pub fn lines(&self) -> Vec<TableLine> {
        let seams = (0..self.out.desk.seams.len()).map(TableLine::Seam);
        let questions = (0..self.out.questions.len()).map(TableLine::Question);
        seams.chain(questions).chain((0..self.out.lengths.len()).map(TableLine::Length)).collect()
    }

    /// The seam that holds an edge.
    #[must_use]
    pub fn seam_at(&self, edge: EdgeAt) -> Option<usize> {
        self.out.desk.seams.iter().position(|seam| seam.a.contains(&edge) || seam.b.contains(&edge))
    }

    /// An edge as the command line names it: `front.side_left`, or `front.3` where it has no name.
    pub fn edge_name(&self, (piece, edge): EdgeAt) -> String {
        let piece = &self.out.desk.pieces[piece];
        let edge = &piece.edges[edge];
        format!("{}.{}", piece.id, edge.name.clone().unwrap_or_else(|| edge.number.to_string()))
    }

    /// All edges, piece by piece.
    pub fn edges(&self) -> Vec<EdgeAt> {
        let pieces = self.out.desk.pieces.iter().enumerate();
        pieces.flat_map(|(piece, drawn)| (0..drawn.edges.len()).map(move |edge| (piece, edge))).collect()
    }
}

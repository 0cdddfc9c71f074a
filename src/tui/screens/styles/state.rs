//! State of the Styles screen.

use std::collections::BTreeMap;

use crate::messages::answered::Answered;
use crate::messages::seams::{LayoutRequest, PreviewRequest, Previewed, SizeLayout};
use store::files::SourceFile;
use wardrobe::seams::SeamStep;

pub fn letter(seam: usize) -> char {
    let small = || ('a'..='z').nth(seam.saturating_sub(26));
    ('A'..='Z').nth(seam).or_else(small).unwrap_or('+')
}

/// Identifier of a piece with some letters of each of its words: `sle_lef`.
pub fn short_name(id: &str, letters: usize) -> String {
    let words = id.split('_').map(|word| word.chars().take(letters).collect::<String>());
    words.collect::<Vec<_>>().join("_")
}

/// An edge: index of the piece, and index of the edge on it.
pub type EdgeAt = (usize, usize);

#[derive(Default)]
pub struct StylesScreen {
    pub selected: Option<(String, String)>,
    /// Unsaved edits by style, the latest last.
    pub edits: BTreeMap<String, Vec<Edited>>,
    /// Undone edits by style, the latest last.
    pub undone: BTreeMap<String, Vec<Edited>>,
    pub asking: Option<Asking>,
    pub preview: Preview,
    pub requested: Option<LayoutRequest>,
    pub layout: Option<Answered<LayoutRequest, Box<SizeLayout>>>,
    pub edge: EdgeAt,
    pub line: usize,
    /// Marked edges, in the order of marking.
    pub marks: Vec<EdgeAt>,
    pub is_busy: bool,
    pub enlarged: bool,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Edited {
    /// Size that was edited, `STYLE/SIZE`.
    pub size: String,
    pub step: SeamStep,
    pub seams: SourceFile,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Asking {
    /// Index in the list of open questions.
    pub at: usize,
    /// Question of the user's own that is asked instead; `None` for the one of the list.
    pub own: Option<Own>,
    /// True if the next question of the list follows the answer.
    pub goes_on: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Own {
    /// Asks what an edge is sewn to.
    Edge(EdgeAt),
    /// Asks for the role of the piece with this index.
    Piece(usize),
    /// Asks which of the pieces that are left out, from this index on, are worn too.
    LeftOut(usize),
}

#[derive(Debug, Default)]
pub struct Preview {
    pub asked: Option<PreviewRequest>,
    pub seen: Option<Answered<PreviewRequest, Previewed>>,
    /// True to show the preview instead of the pieces, where only one fits.
    pub is_chosen: bool,
}

/// Most names in a sentence.
const NAMED: usize = 6;

/// The first of some names, and the number of the others.
fn named_first(names: &[String]) -> String {
    let (named, others) = names.split_at(names.len().min(NAMED));
    let more = if others.is_empty() { String::new() } else { format!(" and {} more", others.len()) };
    named.join(", ") + &more
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TableLine {
    /// A seam, by its index in [`wardrobe::seams::Desk`].
    Seam(usize),
    Question(usize),
    /// A measurement, by its index.
    Length(usize),
}

impl SizeLayout {
    /// Lines of the table: seams, questions about none of them, measurements.
    pub fn lines(&self) -> Vec<TableLine> {
        let seams = (0..self.out.desk.seams.len()).map(TableLine::Seam);
        let questions = self.out.undecided.iter().enumerate().filter(|(_, question)| question.seam.is_none());
        let questions = questions.map(|(k, _)| TableLine::Question(k));
        seams.chain(questions).chain((0..self.out.lengths.len()).map(TableLine::Length)).collect()
    }

    /// Returns `None` for an edge in no seam.
    pub fn seam_at(&self, edge: EdgeAt) -> Option<usize> {
        self.out.desk.seams.iter().position(|seam| seam.a.contains(&edge) || seam.b.contains(&edge))
    }

    /// Label of an edge in the picture: its number, and the letter of its seam.
    pub fn label(&self, edge: EdgeAt) -> String {
        let seam = self.seam_at(edge).map_or(String::new(), |seam| letter(seam).to_string());
        format!("{}{seam}", self.out.desk.edge(edge).number)
    }

    /// Edges as the picture labels them, with their lengths; a piece all of whose edges are meant by its name.
    pub fn named(&self, edges: &[EdgeAt]) -> String {
        let pieces = self.out.desk.pieces.iter().enumerate();
        let of_piece = pieces.filter_map(|(piece, drawn)| {
            let own: Vec<EdgeAt> = edges.iter().copied().filter(|edge| edge.0 == piece).collect();
            let label =
                |edge: &EdgeAt| format!("{} ({:.0} mm)", self.label(*edge), self.out.desk.edge(*edge).length_mm);
            match own.len() {
                0 => None,
                all if all == drawn.edges.len() => Some(drawn.id.clone()),
                _ => Some(format!("{} {}", drawn.id, own.iter().map(label).collect::<Vec<_>>().join(" "))),
            }
        });
        of_piece.collect::<Vec<_>>().join(", ")
    }

    /// Sentences on what stays unsewn: edges in no seam, pieces without any seam, pieces that are left out.
    pub fn left_open(&self) -> String {
        let desk = &self.out.desk;
        let loose = desk.pieces.iter().filter(|piece| piece.edges.iter().all(|edge| edge.seam.is_none()));
        let loose: Vec<String> = loose.map(|piece| piece.id.clone()).collect();
        let sentences = [
            ("In no seam", "edge", desk.open_edges()),
            ("Sewn to nothing", "piece", loose),
            ("Left out", "piece", desk.left_out.clone()),
        ];
        let told = sentences.into_iter().filter(|(.., names)| !names.is_empty());
        let told = told.map(|(what, unit, names)| {
            let s = if names.len() == 1 { "" } else { "s" };
            format!("{what}: {} {unit}{s}, {}.", names.len(), named_first(&names))
        });
        told.collect::<Vec<_>>().join(" ")
    }

    pub fn edges(&self) -> Vec<EdgeAt> {
        let pieces = self.out.desk.pieces.iter().enumerate();
        pieces.flat_map(|(piece, drawn)| (0..drawn.edges.len()).map(move |edge| (piece, edge))).collect()
    }
}

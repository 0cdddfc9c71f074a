//! The desk: pieces laid out flat around the wearer's head, with numbered edges and seams, as pictures and edits of a
//! seam file need them. Also the proposal of seams, and its confidences in a seam file.

use std::path::Path;

use toml_edit::{DocumentMut, Item};

use crate::error::WardrobeError;
use geom::V2;
use geom::polyline::segment_distance;
use geom::units::mm;
use pattern::propose::{self, Proposal};
use pattern::seam_edit::Sizes;
use pattern::style::{EdgeRef, Style, StylePiece};
use pattern::{Piece, Role, arrange};
use spec::patterns::{Nest, SizePieces, Unit};
use store::files::SourceFile;
use store::{InOrigin, Origin, Result};

/// Greatest distance of a notch from the edge that it belongs to.
const NOTCH_M: f64 = 0.005;
/// Confidence from which a proposed seam counts as sure.
pub const SURE: f64 = 0.8;

#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct DeskEdge {
    /// Number in the picture, from 1 counter-clockwise.
    pub number: usize,
    /// `None` where the seam file does not name the edge.
    pub name: Option<String>,
    /// Points, counter-clockwise. `x` is to the wearer's right, `y` is positive for fronts, and the head is at the
    /// origin.
    pub line_mm: Vec<[f64; 2]>,
    /// Length of the sew line.
    pub length_mm: f64,
    pub seam: Option<String>,
    /// Places from the start of the edge.
    pub notches_mm: Vec<f64>,
}

impl DeskEdge {
    /// Midpoint, mm, and there the unit normal into the piece. This points to the left, since edges run
    /// counter-clockwise.
    pub fn middle(&self) -> [[f64; 2]; 2] {
        let mut rest_mm = self.length_mm / 2.0;
        for pair in self.line_mm.windows(2) {
            let [a, b] = [pair[0], pair[1]];
            let length = (b[0] - a[0]).hypot(b[1] - a[1]);
            if length > 0.0 && length >= rest_mm {
                let t = rest_mm / length;
                let along = [(b[0] - a[0]) / length, (b[1] - a[1]) / length];
                return [[a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])], [-along[1], along[0]]];
            }
            rest_mm -= length;
        }
        [self.line_mm.last().copied().unwrap_or_default(), [0.0, 0.0]]
    }
}

#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct DeskPiece {
    /// Identifier in the seam file.
    pub id: String,
    pub role: Role,
    /// Counter-clockwise rotation from the drawing in the pattern file.
    pub turned_deg: f64,
    /// Edges, counter-clockwise; together they are the outline.
    pub edges: Vec<DeskEdge>,
}

#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct DeskSeam {
    pub name: String,
    /// Edges of the one side, in order: (index of the piece, index of the edge).
    pub a: Vec<(usize, usize)>,
    /// Edges of the other side, likewise.
    pub b: Vec<(usize, usize)>,
    /// True where both sides are sewn in their counter-clockwise direction.
    pub same_direction: bool,
    pub a_mm: f64,
    pub b_mm: f64,
    /// Confidence of the proposal, 0 to 1; `None` where a person has confirmed or made the seam.
    pub confidence: Option<f64>,
}

/// Pieces and seams of a style, as they are drawn and edited.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize)]
pub struct Desk {
    pub pieces: Vec<DeskPiece>,
    pub seams: Vec<DeskSeam>,
    /// Names of the drawn pieces that the seam file leaves out.
    pub left_out: Vec<String>,
}

impl Desk {
    pub fn of(style: &Style) -> Self {
        let seam_of = |edge: EdgeRef| {
            let found = style.seams.iter().find(|seam| seam.a.contains(&edge) || seam.b.contains(&edge));
            found.map(|seam| seam.name.clone())
        };
        let placed = arrange::arrange(style);
        let pieces = style.pieces.iter().zip(&placed).enumerate().map(|(piece, (drawn, placed))| {
            let drawn_notches = notches(drawn);
            let edges = drawn.edges.iter().enumerate().map(|(edge, drawn)| DeskEdge {
                number: edge + 1,
                name: drawn.name.clone(),
                line_mm: drawn.line.points().iter().map(|&p| <[f64; 2]>::from(placed.at(p).map(mm))).collect(),
                length_mm: mm(drawn.line.length()),
                seam: seam_of(EdgeRef { piece, edge }),
                notches_mm: drawn_notches
                    .iter()
                    .filter(|notch| notch.edge == edge)
                    .map(|notch| notch.along_mm)
                    .collect(),
            });
            DeskPiece {
                id: drawn.id.clone(),
                role: drawn.role,
                turned_deg: placed.turn.to_degrees(),
                edges: edges.collect(),
            }
        });
        let refs = |chain: &[EdgeRef]| chain.iter().map(|edge| (edge.piece, edge.edge)).collect();
        let length = |chain: &[EdgeRef]| chain.iter().map(|&edge| mm(style.edge(edge).line.length())).sum();
        let seams = style.seams.iter().map(|seam| DeskSeam {
            name: seam.name.clone(),
            a: refs(&seam.a),
            b: refs(&seam.b),
            same_direction: seam.b_forwards,
            a_mm: length(&seam.a),
            b_mm: length(&seam.b),
            confidence: None,
        });
        Self { pieces: pieces.collect(), seams: seams.collect(), left_out: Vec::new() }
    }
}

struct EdgeNotch {
    edge: usize,
    /// Arc length from the start of the edge.
    along_mm: f64,
}

/// Notches of a piece, each on its nearest edge. Drops notches farther than [`NOTCH_M`] from every edge.
fn notches(piece: &StylePiece) -> Vec<EdgeNotch> {
    let nearest = |at: V2| {
        let mut best = (NOTCH_M, None);
        for (edge, drawn) in piece.edges.iter().enumerate() {
            for (pair, arc_m) in drawn.line.points().windows(2).zip(drawn.line.arcs()) {
                let away_m = segment_distance(&pair[0], &pair[1], &at);
                if away_m < best.0 {
                    let along = (pair[1] - pair[0]).normalize();
                    let along_mm = mm(arc_m + (at - pair[0]).dot(&along).max(0.0));
                    best = (away_m, Some(EdgeNotch { edge, along_mm }));
                }
            }
        }
        best.1
    };
    piece.notches.iter().filter_map(|notch| nearest(notch.at)).collect()
}

#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Proposed {
    #[serde(flatten)]
    pub proposal: Proposal,
    pub desk: Desk,
}

/// Options for proposing seams.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Asking<'a> {
    /// `None` for the sample size.
    pub size: Option<&'a str>,
    /// Unit of the files, where they name none.
    pub unit: Option<Unit>,
    /// Seam allowance of pieces without a sew line.
    pub allowance_m: f64,
    /// Number of the question, letter of the choice.
    pub answers: &'a [(usize, char)],
}

/// Proposes a seam file for the pieces of a pattern, on one size, and checks it on the others.
pub fn propose(path: &Path, how: &Asking<'_>) -> Result<Proposed> {
    let ProposalOnPieces { proposal, pieces } = proposal(&SourceFile::read_pattern(path)?, how)?;
    if proposal.is_empty() {
        return Ok(Proposed { proposal, desk: Desk::default() });
    }
    let text = proposal.toml("proposed");
    let style = Style::read(&pieces, text.as_bytes(), "proposed").origin(Origin::Pattern)?;
    let mut desk = Desk::of(&style);
    for (seam, proposed) in desk.seams.iter_mut().zip(&proposal.seams) {
        seam.confidence = Some(proposed.confidence);
    }
    Ok(Proposed { proposal, desk })
}

pub struct ProposalOnPieces {
    pub proposal: Proposal,
    pub pieces: Vec<Piece>,
}

/// Proposes seams as [`fn@propose`] does, for a pattern in memory.
pub fn proposal(pattern: &SourceFile, how: &Asking<'_>) -> Result<ProposalOnPieces> {
    if pattern.holds_seams() {
        return Err(WardrobeError::HoldsSeams { pattern: pattern.name.clone() }.into());
    }
    let nest = Nest::read(pattern, how.unit)?.with_allowance(how.allowance_m);
    let size = how.size.map_or(Ok(nest.sample_size()), |size| nest.size_named(size))?;
    let pieces = nest.pieces(size)?;
    let mut proposal = propose::propose_answered(&pieces, how.answers).origin(Origin::Pattern)?;
    proposal.allowance_m = how.allowance_m;
    proposal.notes.extend(nest.unit_remarks().map(str::to_owned));
    proposal.notes.push(nest.sewn_along());
    hold_for(&mut proposal, size, &pieces, nest.others(size));
    Ok(ProposalOnPieces { proposal, pieces })
}

/// Checks a proposal on the other sizes than `made_on`. A seam that cannot be sewn there becomes a question.
pub(crate) fn hold_for(proposal: &mut Proposal, made_on: &str, pieces: &[Piece], others: Vec<SizePieces>) {
    let mut sound = Vec::new();
    for SizePieces { size, pieces } in others {
        match pieces {
            Ok(pieces) => sound.push((size, pieces)),
            Err(error) => proposal.notes.push(format!("size {size} cannot be sewn: {error}")),
        }
    }
    if !sound.is_empty() {
        proposal.hold_for(&Sizes { name: made_on, pieces, others: &sound });
    }
}

/// Confidences of the seams in a seam file, in order, from the remarks `# confidence 0.83` beside their headers. `None`
/// for a seam that is confirmed or was not proposed.
pub(crate) fn confidences(text: &str) -> Vec<Option<f64>> {
    let Ok(document) = text.parse::<DocumentMut>() else { return vec![] };
    let seams = document.get("seam").and_then(Item::as_array_of_tables);
    let confidence_of = |seam: &toml_edit::Table| {
        let remark = seam.decor().suffix()?.as_str()?.split_once("confidence ")?.1;
        remark.split([',', ' ', '\n']).next()?.parse().ok()
    };
    seams.map_or(vec![], |seams| seams.iter().map(confidence_of).collect())
}

/// Text of a seam file without the confidences of the seams that `is_sure` accepts, by name and confidence. `None` if
/// it accepts none.
pub(crate) fn confirmed(text: &str, is_sure: impl Fn(&str, Option<f64>) -> bool) -> Option<String> {
    let mut document: DocumentMut = text.parse().ok()?;
    let seams = document.get_mut("seam")?.as_array_of_tables_mut()?;
    let mut found = false;
    for (seam, confidence) in seams.iter_mut().zip(confidences(text)) {
        let name = seam.get("name").and_then(Item::as_str).unwrap_or_default();
        if is_sure(name, confidence) {
            seam.decor_mut().set_suffix("");
            found = true;
        }
    }
    found.then(|| document.to_string())
}

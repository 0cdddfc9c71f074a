//! Working on seams: the pieces as they lie with their edges, what is sewn, and edits of a seam file.

use std::path::Path;

use toml_edit::{DocumentMut, Item};

use geom::V2;
use geom::polyline::segment_distance;
use geom::units::mm;
use pattern::propose::{self, Proposal};
use pattern::seam_edit::Sizes;
use pattern::style::{EdgeRef, Style, StylePiece};
use pattern::{Piece, Role, arrange};
use spec::patterns::{self, Nest, Unit};
use store::files::SourceFile;
use store::{InOrigin, Origin, Result};

/// Distance within which a notch lies at an edge, m.
const NOTCH_M: f64 = 0.005;
/// Confidence from which a proposed seam counts as sure.
pub const SURE: f64 = 0.8;

/// An edge of a piece where it lies in the arrangement.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct DeskEdge {
    /// Number in the picture, from 1 counter-clockwise.
    pub number: usize,
    /// Name in the seam file; `None` where it has none yet.
    pub name: Option<String>,
    /// Points, counter-clockwise, mm: `x` to the wearer's right, `y` positive for fronts, the head at the origin.
    pub line_mm: Vec<[f64; 2]>,
    /// Length of the sew line, mm.
    pub length_mm: f64,
    /// Name of the seam that holds it.
    pub seam: Option<String>,
    /// Notches along it, mm from its start.
    pub notches_mm: Vec<f64>,
}

impl DeskEdge {
    /// Its middle, mm, and the unit vector from there into the piece: to the left, since edges run counter-clockwise.
    #[must_use]
    pub fn middle(&self) -> [[f64; 2]; 2] {
        let mut left_mm = self.length_mm / 2.0;
        for pair in self.line_mm.windows(2) {
            let [a, b] = [pair[0], pair[1]];
            let length = (b[0] - a[0]).hypot(b[1] - a[1]);
            if length > 0.0 && length >= left_mm {
                let t = left_mm / length;
                let along = [(b[0] - a[0]) / length, (b[1] - a[1]) / length];
                return [[a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])], [-along[1], along[0]]];
            }
            left_mm -= length;
        }
        [self.line_mm.last().copied().unwrap_or_default(), [0.0, 0.0]]
    }
}

/// A piece where it lies in the arrangement.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct DeskPiece {
    /// Identifier of the piece in the seam file.
    pub id: String,
    /// What it is worn as.
    pub role: Role,
    /// How far it was turned counter-clockwise, degrees.
    pub turned_deg: f64,
    /// Edges, counter-clockwise; together they are the outline.
    pub edges: Vec<DeskEdge>,
}

/// A seam, with the lengths of its sides.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct DeskSeam {
    /// Name of the seam in the seam file.
    pub name: String,
    /// Edges of one side as (index of the piece, index of the edge), in order.
    pub a: Vec<(usize, usize)>,
    /// Edges of the other side.
    pub b: Vec<(usize, usize)>,
    /// Whether both sides run counter-clockwise.
    pub same_direction: bool,
    /// Length of `a`, mm.
    pub a_mm: f64,
    /// Length of `b`, mm.
    pub b_mm: f64,
    /// How sure a proposal is, 0 to 1; `None` where a person said so.
    pub confidence: Option<f64>,
}

/// All that is needed to draw and edit the seams of a style.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize)]
pub struct Desk {
    /// Pieces as they lie.
    pub pieces: Vec<DeskPiece>,
    /// Seams between edges of those pieces.
    pub seams: Vec<DeskSeam>,
    /// Names of pieces that are drawn and that the seams leave out.
    pub left_out: Vec<String>,
}

impl Desk {
    /// The pieces and seams of a style.
    #[must_use]
    pub fn of(style: &Style) -> Self {
        let held = |edge: EdgeRef| {
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
                seam: held(EdgeRef { piece, edge }),
                notches_mm: drawn_notches.iter().filter(|(of, _)| *of == edge).map(|(_, along_mm)| *along_mm).collect(),
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

/// Notches of a piece: the edge that each lies at, and how far along, mm; those away from all edges are left out.
fn notches(piece: &StylePiece) -> Vec<(usize, f64)> {
    let nearest = |at: V2| {
        let mut best = (NOTCH_M, None);
        for (edge, drawn) in piece.edges.iter().enumerate() {
            for (pair, arc_m) in drawn.line.points().windows(2).zip(drawn.line.arcs()) {
                let away_m = segment_distance(&pair[0], &pair[1], &at);
                if away_m < best.0 {
                    let along = (pair[1] - pair[0]).normalize();
                    best = (away_m, Some((edge, mm(arc_m + (at - pair[0]).dot(&along).max(0.0)))));
                }
            }
        }
        best.1
    };
    piece.notches.iter().filter_map(|notch| nearest(notch.at)).collect()
}

/// A proposal with the pieces as they lie.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Proposed {
    /// What is proposed.
    #[serde(flatten)]
    pub proposal: Proposal,
    /// The pieces that take part, arranged, and the seams between them.
    pub desk: Desk,
}

/// For what a proposal is asked.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Asking<'a> {
    /// Size that it is made on; by default the sample size.
    pub size: Option<&'a str>,
    /// Unit of the files, where they name none.
    pub unit: Option<Unit>,
    /// Seam allowance of pieces without a sew line, m.
    pub allowance_m: f64,
    /// Answers: number of the question and letter of the choice.
    pub answers: &'a [(usize, char)],
}

/// A seam file proposed for the pieces of a DXF file, or of all DXF files in a folder together: on one size, by default the
/// sample size, and held to the others.
///
/// # Errors
/// When a file cannot be read, or has no such size; or an answer, by the number of its question and the letter of the choice,
/// is to nothing that is asked.
pub fn propose(path: &Path, how: &Asking<'_>) -> Result<Proposed> {
    let (proposal, pieces) = proposal(&SourceFile::read_pattern(path)?, how)?;
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

/// What is proposed for a pattern, and the pieces of the size that it is made on.
pub fn proposal(pattern: &SourceFile, how: &Asking<'_>) -> Result<(Proposal, Vec<Piece>)> {
    let nest = Nest::read(pattern, how.unit)?.with_allowance(how.allowance_m);
    let size = how.size.unwrap_or(nest.sample_size());
    let pieces = nest.pieces(size)?;
    let mut proposal = propose::propose_answered(&pieces, how.answers).origin(Origin::Pattern)?;
    proposal.allowance_m = how.allowance_m;
    proposal.notes.extend(nest.unit_remarks().map(str::to_owned));
    proposal.notes.push(nest.sewn_along());
    hold_for(&mut proposal, size, &pieces, nest.others(size));
    Ok((proposal, pieces))
}

/// Holds a proposal to the sizes that it was not made on.
pub(crate) fn hold_for(
    proposal: &mut Proposal,
    made_on: &str,
    pieces: &[Piece],
    others: Vec<(String, Result<Vec<Piece>>)>,
) {
    let mut sound = Vec::new();
    for (size, pieces) in others {
        match pieces {
            Ok(pieces) => sound.push((size, pieces)),
            Err(error) => proposal.notes.push(format!("size {size} cannot be sewn: {error}")),
        }
    }
    if !sound.is_empty() {
        proposal.hold_for(&Sizes { name: made_on, pieces, others: &sound });
    }
}

/// The pieces and seams of a pattern with its seam file.
///
/// # Errors
/// When a file cannot be read or does not fit the other.
pub fn desk(pattern: &Path, seams: Option<&Path>, size: Option<&str>, unit: Option<Unit>) -> Result<Desk> {
    Ok(Desk::of(&patterns::style(pattern, seams, size, unit)?))
}

/// How sure the proposed seams of a seam file are that nobody has confirmed yet, by their places in it: what stands as
/// `# confidence 0.83` beside their headers.
pub(crate) fn confidences(text: &str) -> Vec<Option<f64>> {
    let Ok(document) = text.parse::<DocumentMut>() else { return vec![] };
    let seams = document.get("seam").and_then(Item::as_array_of_tables);
    let sure = |seam: &toml_edit::Table| {
        let remark = seam.decor().suffix()?.as_str()?.split_once("confidence ")?.1;
        remark.split([',', ' ', '\n']).next()?.parse().ok()
    };
    seams.map_or(vec![], |seams| seams.iter().map(sure).collect())
}

/// The text of a seam file without the doubt about those of its seams that `is_sure` by name and confidence; `None`
/// where there is no such seam.
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

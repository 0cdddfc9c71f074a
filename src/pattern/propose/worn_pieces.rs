//! Pieces as worn: copies of pieces that are cut twice, sides of the wearer, named edges.

use std::collections::BTreeMap;
use std::fmt;

use super::ask::Asker;
use super::gore::Cut;
use super::recognised::{Recognised, is_whole_leg, length_m};
use super::shape::Dart;
use super::{Class, Face, Hand, Label, pose, role_of};
use crate::Role;
use crate::piece::Piece;
use crate::seams::PieceEntry;
use crate::style::correspond::shares;
use crate::style::named::reference;
use geom::V2;
use geom::polyline::Polyline;

#[derive(Clone, Debug, PartialEq)]
pub struct WornEdge {
    /// Unique in the piece.
    pub name: String,
    /// `None` for an edge of a dart.
    pub label: Option<Label>,
    /// Side of the wearer, on which the piece has this edge. `None` if the piece has only one. For the front or back
    /// half of a sleeve, [`Hand::Right`] is the front of a right sleeve.
    pub hand: Option<Hand>,
    /// Length of the sew line, m.
    pub length: f64,
    /// Arc lengths of the notches as worn, m.
    pub notches: Vec<f64>,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Worn {
    pub piece: usize,
    /// Identifier in the seam file.
    pub id: String,
    pub class: Class,
    pub face: Option<Face>,
    /// `None` for a piece on both sides.
    pub hand: Option<Hand>,
    pub is_whole: bool,
    pub is_gore: bool,
    /// Counter-clockwise as worn.
    pub edges: Vec<WornEdge>,
    pub darts: Vec<[String; 2]>,
    pub entry: PieceEntry,
    /// 0 to 1.
    pub confidence: f64,
}

/// Edge in one side of a seam. `Display` writes it as in seam files.
#[derive(Clone, Copy, Debug)]
pub struct Along<'w> {
    pub piece: &'w Worn,
    pub edge: &'w WornEdge,
}

impl fmt::Display for Along<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}.{}", self.piece.id, self.edge.name)
    }
}

/// Greatest distance of a notch from the edge that it marks.
const ON_EDGE_M: f64 = 12e-3;

/// Leaves out a second piece for one place, with a question. `drawn` is the arm of a whole sleeve, if known.
pub fn worn(pieces: &[Piece], recognised: &[Recognised], drawn: Option<Hand>, asker: &mut Asker<'_>) -> Vec<Worn> {
    let backs_face_inwards = recognised.iter().any(|candidate| {
        candidate.face == Some(Face::Back)
            && candidate.hand.is_some_and(|hand| natural_hand(candidate).is_some_and(|n| n != hand))
    });
    // A trunk with a skirt, legs or a waistband is a bodice.
    let is_bodice =
        recognised.iter().any(|candidate| matches!(candidate.class, Class::Skirt | Class::Leg | Class::Waistband));
    let skirts = recognised.iter().filter(|candidate| candidate.class == Class::Skirt).count();
    let mut all: Vec<Worn> = Vec::new();
    for candidate in recognised {
        for is_mirror in candidate.gore.into_iter().flat_map(Cut::copies) {
            let id = format!("{}_{}", id_of(candidate, None), all.iter().filter(|worn| worn.is_gore).count() + 1);
            all.push(wear(pieces, candidate, id, None, is_mirror, Role::Other));
        }
        if candidate.gore.is_some() {
            continue;
        }
        let is_between = candidate.class == Class::SidePanel && candidate.alignment.template.is_whole;
        let needs_face = (matches!(candidate.class, Class::Body | Class::SidePanel | Class::Leg | Class::Yoke)
            && !is_between)
            || (candidate.class == Class::Skirt && skirts > 1);
        if needs_face && candidate.face.is_none() && !is_whole_leg(candidate) {
            continue;
        }
        let drawn = if is_between { Some(drawn_panel(candidate, recognised)) } else { drawn };
        for PieceCopy { hand, is_mirror } in copies(candidate, backs_face_inwards, drawn) {
            let id = id_of(candidate, hand);
            if let Some(other) = all.iter().find(|worn| worn.id == id) {
                if other.piece != candidate.piece {
                    asker.tell(format!(
                        "`{}` and `{}` are both {id}: the first is taken",
                        pieces[other.piece].name, pieces[candidate.piece].name
                    ));
                }
                break;
            }
            // A yoke over the shoulders is placed with the trunk. A yoke below the waist follows the pieces that carry
            // it.
            let is_trunk = candidate.class == Class::Yoke && candidate.alignment.template.has_shoulder();
            let class = if is_trunk { Class::Body } else { candidate.class };
            let role = role_of(Some(class), candidate.face, hand, is_bodice);
            all.push(wear(pieces, candidate, id, hand, is_mirror, role));
        }
    }
    all
}

/// `None` without a whole sleeve.
pub fn ask_drawn_sleeve(pieces: &[Piece], recognised: &[Recognised], asker: &mut Asker<'_>) -> Option<Hand> {
    let is_it = |candidate: &&Recognised| {
        candidate.class == Class::Sleeve && candidate.alignment.template.is_whole && candidate.hand.is_none()
    };
    let sleeve = recognised.iter().find(is_it)?;
    let text = format!("is piece `{}` as drawn the right or the left sleeve?", pieces[sleeve.piece].name);
    let choices = ["the right one: the front of its cap is on the right", "the left one"];
    asker.ask_of([sleeve.piece], text, choices, Some(0)).map(|choice| Hand::BOTH[choice])
}

/// Side as seen from outside. `None` for a whole piece.
fn natural_hand(candidate: &Recognised) -> Option<Hand> {
    let face = candidate.face.filter(|_| !candidate.alignment.template.is_whole)?;
    Some(pose::natural_hand(face, candidate.alignment.is_mirrored))
}

struct PieceCopy {
    /// `None` for a copy on both sides.
    hand: Option<Hand>,
    is_mirror: bool,
}

fn copies(candidate: &Recognised, backs_face_inwards: bool, drawn: Option<Hand>) -> Vec<PieceCopy> {
    let drawn = drawn.unwrap_or(Hand::Right);
    let copy = |hand, is_mirror| PieceCopy { hand: Some(hand), is_mirror };
    let both = |hand: Hand| vec![copy(hand, false), copy(hand.other(), true)];
    if candidate.alignment.template.is_whole {
        return match (candidate.class, candidate.hand) {
            (Class::Leg, None) => both(drawn_leg(candidate)),
            (Class::Leg, Some(hand)) => vec![copy(hand, hand != drawn_leg(candidate))],
            (Class::Sleeve | Class::SidePanel, None) => both(drawn),
            (Class::SidePanel, Some(hand)) => vec![copy(hand, false)],
            (Class::Sleeve | Class::Cuff, Some(hand)) => {
                vec![copy(hand, backs_face_inwards && candidate.face == Some(Face::Back))]
            }
            (Class::Waistband, Some(hand)) => vec![copy(hand, false)],
            (Class::Waistband, None) if candidate.is_pair => both(Hand::Right),
            (Class::Cuff, None) => both(Hand::Right),
            _ => vec![PieceCopy { hand: None, is_mirror: backs_face_inwards && candidate.face == Some(Face::Back) }],
        };
    }
    let natural = natural_hand(candidate).unwrap_or(Hand::Right);
    match candidate.hand {
        Some(hand) => vec![copy(hand, hand != natural)],
        None => both(natural),
    }
}

/// Side for which a panel between front and back is drawn, seen from outside: the one on which its edges are as long as
/// the sides that they are sewn to. The right one, if both fit as well.
fn drawn_panel(panel: &Recognised, recognised: &[Recognised]) -> Hand {
    let side_m = |face: Face| {
        let is_it = |other: &&Recognised| other.class == Class::Body && other.face == Some(face);
        let body = recognised.iter().find(is_it)?;
        let edges = body.alignment.parts.iter().filter(|part| part.label == Label::Side).count();
        Some(length_m(body, Label::Side) / edges.max(1) as f64)
    };
    let own_m = |is_right: bool| -> f64 {
        let parts = panel.alignment.parts.iter().filter(|part| part.label == Label::Side && part.is_right == is_right);
        parts.map(|part| panel.shape.sewn_length(part.from, part.span)).sum()
    };
    let Some((front, back)) = side_m(Face::Front).zip(side_m(Face::Back)) else { return Hand::Right };
    let apart = |front_is_right: bool| (own_m(front_is_right) - front).abs() + (own_m(!front_is_right) - back).abs();
    if apart(true) <= apart(false) { Hand::Right } else { Hand::Left }
}

/// Side as seen from outside: the back reaches further in under the seat than the front.
fn drawn_leg(candidate: &Recognised) -> Hand {
    let (framed, _) = candidate.shape.framed(candidate.alignment.quarter_turns);
    let reach = |is_right: bool| {
        let crotch =
            candidate.alignment.parts.iter().find(|part| part.label == Label::Crotch && part.is_right == is_right);
        crotch.map_or(0.0, |crotch| framed.section(crotch.from, crotch.span).chord.x.abs())
    };
    if reach(true) <= reach(false) { Hand::Right } else { Hand::Left }
}

pub fn id_of(candidate: &Recognised, hand: Option<Hand>) -> String {
    id_of_kind(candidate.class, candidate.face, hand)
}

pub fn id_of_kind(class: Class, face: Option<Face>, hand: Option<Hand>) -> String {
    // Half of a collar reaches from the back to the front.
    let face = face.filter(|_| class != Class::Collar);
    let class = match class {
        Class::Body | Class::Other => None,
        Class::SidePanel => Some("side"),
        Class::Leg => Some("leg"),
        Class::Sleeve => Some("sleeve"),
        Class::Skirt => Some("skirt"),
        Class::Yoke => Some("yoke"),
        Class::Waistband => Some("waistband"),
        Class::Cuff => Some("cuff"),
        Class::Collar => Some("collar"),
    };
    let parts = [class, face.map(Face::as_str), hand.map(Hand::as_str)];
    parts.into_iter().flatten().collect::<Vec<_>>().join("_")
}

fn wear(pieces: &[Piece], candidate: &Recognised, id: String, hand: Option<Hand>, is_mirror: bool, role: Role) -> Worn {
    let (shape, n) = (&candidate.shape, candidate.shape.len());
    let mut names: BTreeMap<String, usize> = BTreeMap::new();
    let mut unique = |base: String| {
        let count = names.entry(base.clone()).or_default();
        *count += 1;
        if *count == 1 { base } else { format!("{base}_{count}") }
    };
    let mut edges = Vec::new();
    let mut corners: BTreeMap<String, [usize; 2]> = BTreeMap::new();
    let mut legs: BTreeMap<usize, String> = BTreeMap::new();
    for part in &candidate.alignment.parts {
        let is_twice = candidate.alignment.parts.iter().filter(|other| other.label == part.label).count() == 2;
        let side = is_twice.then(|| side_of(candidate, part.is_right, hand, is_mirror));
        let base = match side {
            Some(side) => format!("{}_{}", part.label.as_str(), side.as_str()),
            None => part.label.as_str().to_owned(),
        };
        let mut k = 0;
        while k < part.span {
            let from = (part.from + k) % n;
            let dart = shape.dart_of(from);
            let is_leg = dart.is_some();
            let plain = (k..part.span).take_while(|&k| !shape.is_leg((part.from + k) % n)).count();
            let span = dart.map_or(plain, |dart| dart.span);
            let name = unique(if is_leg { "dart_leg".to_owned() } else { base.clone() });
            if is_leg {
                legs.insert(from, name.clone());
            }
            corners.insert(name.clone(), [from, (from + span) % n]);
            let length = (0..span).map(|k| shape.length((from + k) % n)).sum();
            let mut notches = notches_on(&pieces[candidate.piece], shape, from, span);
            if is_mirror {
                notches.iter_mut().for_each(|arc| *arc = length - *arc);
            }
            edges.push(WornEdge { name, label: (!is_leg).then_some(part.label), hand: side, length, notches });
            k += span;
        }
    }
    if is_mirror {
        edges.reverse();
    }
    let dart =
        |dart: &Dart| Some([legs.get(&((dart.apex + n - dart.span) % n))?.clone(), legs.get(&dart.apex)?.clone()]);
    Worn {
        piece: candidate.piece,
        id,
        class: candidate.class,
        face: candidate.face,
        hand,
        is_whole: candidate.alignment.template.is_whole,
        is_gore: candidate.gore.is_some(),
        darts: shape.darts().iter().filter_map(dart).collect(),
        entry: PieceEntry {
            block: reference(pieces, candidate.piece),
            role,
            mirror: is_mirror,
            corners_at: shares(pieces[candidate.piece].seam_outline(), shape.corners()),
            allowance_mm: BTreeMap::new(),
            edges: corners,
        },
        edges,
        confidence: candidate.confidence,
    }
}

/// Arc lengths along consecutive edges as drawn, m, without notches at their ends.
fn notches_on(piece: &Piece, shape: &super::shape::Shape, from: usize, span: usize) -> Vec<f64> {
    let mut points: Vec<V2> = (0..span).flat_map(|k| shape.points((from + k) % shape.len())).collect();
    points.dedup();
    let Some(line) = Polyline::new(points) else { return Vec::new() };
    let nearest = |at: V2| {
        let sides = line.points().windows(2).zip(line.arcs()).map(|(ends, arc)| {
            let along = ends[1] - ends[0];
            let share = ((at - ends[0]).dot(&along) / along.norm_squared().max(1e-18)).clamp(0.0, 1.0);
            ((ends[0] + along * share - at).norm(), arc + share * along.norm())
        });
        sides.min_by(|p, q| p.0.total_cmp(&q.0))
    };
    let is_inside = |arc: &f64| (ON_EDGE_M..line.length() - ON_EDGE_M).contains(arc);
    let found = piece.notches.iter().filter_map(|notch| nearest(notch.at));
    found.filter(|(distance, _)| *distance < ON_EDGE_M).map(|(_, arc)| arc).filter(is_inside).collect()
}

fn side_of(candidate: &Recognised, is_right: bool, hand: Option<Hand>, is_mirror: bool) -> Hand {
    let is_right_as_worn = is_right != is_mirror;
    let is_back = candidate.face == Some(Face::Back);
    // Seen from outside, the right of a front is the wearer's left. The edges of sleeves and bands are named as they
    // lie.
    match (candidate.class, hand) {
        (Class::Sleeve | Class::Cuff | Class::Leg | Class::SidePanel, _) => {
            if is_right_as_worn {
                Hand::Right
            } else {
                Hand::Left
            }
        }
        _ if is_right_as_worn == is_back => Hand::Right,
        _ => Hand::Left,
    }
}

impl Worn {
    pub fn has(&self, label: Label) -> bool {
        self.edges.iter().any(|edge| edge.label == Some(label))
    }

    /// Edges with a label, counter-clockwise as worn: those of `hand`, if the piece has them on both sides.
    pub fn chain(&self, label: Label, hand: Option<Hand>) -> Vec<Along<'_>> {
        let is_it = |edge: &&WornEdge| {
            edge.label == Some(label) && (hand.is_none() || edge.hand.is_none() || edge.hand == hand)
        };
        self.edges.iter().filter(is_it).map(|edge| Along { piece: self, edge }).collect()
    }

    /// Edges of [`Worn::chain`] in reverse order, clockwise, as the other side of a seam is written.
    pub fn chain_back(&self, label: Label, hand: Option<Hand>) -> Vec<Along<'_>> {
        self.chain(label, hand).into_iter().rev().collect()
    }
}

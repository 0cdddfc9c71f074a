//! Pieces as worn: which are cut twice, which side of the wearer they are for, and their edges by name.

use std::collections::BTreeMap;
use std::fmt;

use super::ask::Asker;
use super::gore::Cut;
use super::recognise::{Recognised, is_whole_leg};
use super::shape::Dart;
use super::{Class, Face, Hand, Label, pose, role_of};
use crate::Role;
use crate::piece::Piece;
use crate::seams::PieceEntry;
use crate::style::correspond::shares;
use geom::V2;
use geom::polyline::Polyline;

/// An edge of a piece as worn.
#[derive(Clone, Debug, PartialEq)]
pub struct WornEdge {
    /// Name within the piece.
    pub name: String,
    /// What it is; `None` for a leg of a dart.
    pub label: Option<Label>,
    /// Side of the wearer on which it is, where the piece has it on both; front or back half of a sleeve likewise by
    /// [`Hand::Right`] for the front of a right sleeve.
    pub hand: Option<Hand>,
    /// Length of the sew line, m.
    pub length: f64,
    /// Arc lengths of its notches, m, as worn.
    pub notches: Vec<f64>,
}

/// A piece as worn.
#[derive(Clone, Debug, PartialEq)]
pub struct Worn {
    /// Index of the drawn piece.
    pub piece: usize,
    /// Identifier in the seam file.
    pub id: String,
    /// Kind of piece.
    pub class: Class,
    /// Front or back.
    pub face: Option<Face>,
    /// Side of the wearer; `None` for both.
    pub hand: Option<Hand>,
    /// Whether the whole width is drawn.
    pub is_whole: bool,
    /// Whether it is a gore.
    pub is_gore: bool,
    /// Edges, counter-clockwise as worn.
    pub edges: Vec<WornEdge>,
    /// Names of the two legs of every dart.
    pub darts: Vec<[String; 2]>,
    /// Entry of the seam file.
    pub entry: PieceEntry,
    /// How sure the proposal is of it, 0 to 1.
    pub confidence: f64,
}

/// An edge of a piece, as one side of a seam runs along it; its text is that of seam files.
#[derive(Clone, Copy, Debug)]
pub struct Along<'w> {
    /// Piece that the seam joins.
    pub piece: &'w Worn,
    /// Edge of that piece.
    pub edge: &'w WornEdge,
}

impl fmt::Display for Along<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}.{}", self.piece.id, self.edge.name)
    }
}

/// Distance within which a notch belongs to an edge, m.
const ON_EDGE_M: f64 = 12e-3;

/// The pieces as worn. A second piece for the same place is left out and asked about. `drawn` is the sleeve that a whole
/// sleeve is drawn as, where that is known.
pub fn worn(pieces: &[Piece], recognised: &[Recognised], drawn: Option<Hand>, asker: &mut Asker<'_>) -> Vec<Worn> {
    let backs_face_inwards = recognised.iter().any(|one| {
        one.face == Some(Face::Back) && one.hand.is_some_and(|hand| natural_hand(one).is_some_and(|n| n != hand))
    });
    // What hangs from a bodice, or the band between them, makes it one.
    let is_bodice = recognised.iter().any(|one| matches!(one.class, Class::Skirt | Class::Leg | Class::Waistband));
    let skirts = recognised.iter().filter(|one| one.class == Class::Skirt).count();
    let mut all: Vec<Worn> = Vec::new();
    for one in recognised {
        for is_mirror in one.gore.into_iter().flat_map(Cut::copies) {
            let id = format!("{}_{}", id_of(one, None), all.iter().filter(|worn| worn.is_gore).count() + 1);
            all.push(wear(pieces, one, id, None, is_mirror, Role::Other));
        }
        if one.gore.is_some() {
            continue;
        }
        let needs_face = matches!(one.class, Class::Body | Class::SidePanel | Class::Leg | Class::Yoke)
            || (one.class == Class::Skirt && skirts > 1);
        if needs_face && one.face.is_none() && !is_whole_leg(one) {
            continue;
        }
        for (hand, is_mirror) in copies(one, backs_face_inwards, drawn) {
            let id = id_of(one, hand);
            if let Some(other) = all.iter().find(|worn| worn.id == id) {
                if other.piece != one.piece {
                    asker.tell(format!(
                        "`{}` and `{}` are both {id}: the first is taken",
                        pieces[other.piece].name, pieces[one.piece].name
                    ));
                }
                break;
            }
            // A yoke over the shoulders is placed with the trunk; one below the waist follows what it is sewn to.
            let is_trunk = one.class == Class::Yoke && one.alignment.template.has_shoulder();
            let class = if is_trunk { Class::Body } else { one.class };
            let role = role_of(Some(class), one.face, hand, is_bodice);
            all.push(wear(pieces, one, id, hand, is_mirror, role));
        }
    }
    all
}

/// Asks whether a whole sleeve is drawn as the right or the left one.
pub fn ask_drawn_sleeve(pieces: &[Piece], recognised: &[Recognised], asker: &mut Asker<'_>) -> Option<Hand> {
    let is_it = |one: &&Recognised| one.class == Class::Sleeve && one.alignment.template.is_whole && one.hand.is_none();
    let sleeve = recognised.iter().find(is_it)?;
    let text = format!("is piece `{}` as drawn the right or the left sleeve?", pieces[sleeve.piece].name);
    let choices = ["the right one: the front of its cap is on the right", "the left one"];
    asker.ask(text, choices, Some(0)).map(|choice| Hand::BOTH[choice])
}

/// Side of the wearer for which half a piece is drawn, seen from outside.
fn natural_hand(one: &Recognised) -> Option<Hand> {
    let face = one.face.filter(|_| !one.alignment.template.is_whole)?;
    Some(pose::natural_hand(face, one.alignment.is_mirrored))
}

/// Copies of a piece: the wearer's side and whether it is worn as the mirror image of what is drawn.
fn copies(one: &Recognised, backs_face_inwards: bool, drawn: Option<Hand>) -> Vec<(Option<Hand>, bool)> {
    let drawn = drawn.unwrap_or(Hand::Right);
    if one.alignment.template.is_whole {
        return match (one.class, one.hand) {
            (Class::Leg, None) => vec![(Some(drawn_leg(one)), false), (Some(drawn_leg(one).other()), true)],
            (Class::Leg, Some(hand)) => vec![(Some(hand), hand != drawn_leg(one))],
            (Class::Sleeve, None) => vec![(Some(drawn), false), (Some(drawn.other()), true)],
            (Class::Sleeve | Class::Cuff, Some(hand)) => {
                vec![(Some(hand), backs_face_inwards && one.face == Some(Face::Back))]
            }
            (Class::Waistband, Some(hand)) => vec![(Some(hand), false)],
            (Class::Waistband, None) if one.is_pair => vec![(Some(Hand::Right), false), (Some(Hand::Left), true)],
            (Class::Cuff, None) => vec![(Some(Hand::Right), false), (Some(Hand::Left), true)],
            _ => vec![(None, backs_face_inwards && one.face == Some(Face::Back))],
        };
    }
    let natural = natural_hand(one).unwrap_or(Hand::Right);
    match one.hand {
        Some(hand) => vec![(Some(hand), hand != natural)],
        None => vec![(Some(natural), false), (Some(natural.other()), true)],
    }
}

/// The leg that a leg in one piece is drawn as, seen from outside: its back reaches further in under the seat than its front.
fn drawn_leg(one: &Recognised) -> Hand {
    let (framed, _) = one.shape.framed(one.alignment.quarter_turns);
    let reach = |is_right: bool| {
        let crotch = one.alignment.parts.iter().find(|part| part.label == Label::Crotch && part.is_right == is_right);
        crotch.map_or(0.0, |crotch| framed.stretch(crotch.from, crotch.span).chord.x.abs())
    };
    if reach(true) <= reach(false) { Hand::Right } else { Hand::Left }
}

/// What a piece is called in the seam file, of one side of the wearer or of both.
pub fn id_of(one: &Recognised, hand: Option<Hand>) -> String {
    let class = match one.class {
        Class::Body | Class::Other => None,
        Class::SidePanel => Some("side"),
        Class::Leg => Some("leg"),
        Class::Sleeve => Some("sleeve"),
        Class::Skirt => Some("skirt"),
        Class::Yoke => Some("yoke"),
        Class::Waistband => Some("waistband"),
        Class::Cuff => Some("cuff"),
    };
    let parts = [class, one.face.map(Face::as_str), hand.map(Hand::as_str)];
    parts.into_iter().flatten().collect::<Vec<_>>().join("_")
}

/// A name that finds this piece alone: its piece name if nothing else has it, then its block's, then with its number. Blocks of
/// a nest hold the size in their names, so there the number among those of its name comes first.
pub fn reference(pieces: &[Piece], index: usize) -> String {
    let piece = &pieces[index];
    let is_only = |name: &str| pieces.iter().filter(|p| p.name == name || p.block == name).count() == 1;
    let number = |is: fn(&Piece) -> &str| pieces[..=index].iter().filter(|p| is(p) == is(piece)).count();
    if is_only(&piece.name) {
        piece.name.clone()
    } else if piece.size.is_some() && piece.name != piece.block {
        format!("{}#{}", piece.name, number(|piece| &piece.name))
    } else if is_only(&piece.block) {
        piece.block.clone()
    } else {
        format!("{}#{}", piece.block, number(|piece| &piece.block))
    }
}

fn wear(pieces: &[Piece], one: &Recognised, id: String, hand: Option<Hand>, is_mirror: bool, role: Role) -> Worn {
    let (shape, n) = (&one.shape, one.shape.len());
    let mut names: BTreeMap<String, usize> = BTreeMap::new();
    let mut unique = |base: String| {
        let count = names.entry(base.clone()).or_default();
        *count += 1;
        if *count == 1 { base } else { format!("{base}_{count}") }
    };
    let mut edges = Vec::new();
    let mut corners: BTreeMap<String, [usize; 2]> = BTreeMap::new();
    let mut legs: BTreeMap<usize, String> = BTreeMap::new();
    for part in &one.alignment.parts {
        let is_twice = one.alignment.parts.iter().filter(|other| other.label == part.label).count() == 2;
        let side = is_twice.then(|| side_of(one, part.is_right, hand, is_mirror));
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
            let mut notches = notches_on(&pieces[one.piece], shape, from, span);
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
        piece: one.piece,
        id,
        class: one.class,
        face: one.face,
        hand,
        is_whole: one.alignment.template.is_whole,
        is_gore: one.gore.is_some(),
        darts: shape.darts().iter().filter_map(dart).collect(),
        entry: PieceEntry {
            block: reference(pieces, one.piece),
            role,
            mirror: is_mirror,
            corners_at: shares(pieces[one.piece].seam_outline(), shape.corners()),
            allowance_mm: BTreeMap::new(),
            edges: corners,
        },
        edges,
        confidence: one.confidence,
    }
}

/// Arc lengths, m, of the notches along a stretch of outline as drawn; those at its ends mark nothing of it.
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

/// Side of the wearer on which one of two like edges lies.
fn side_of(one: &Recognised, is_right: bool, hand: Option<Hand>, is_mirror: bool) -> Hand {
    let is_right_as_worn = is_right != is_mirror;
    let is_back = one.face == Some(Face::Back);
    // Seen from outside the right of a front is the wearer's left; a sleeve's or band's is named as it lies.
    match (one.class, hand) {
        (Class::Sleeve | Class::Cuff | Class::Leg, _) => {
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
    /// Whether it has an edge of this kind.
    pub fn has(&self, label: Label) -> bool {
        self.edges.iter().any(|edge| edge.label == Some(label))
    }

    /// Edges with a label, counter-clockwise as worn, of one side where the piece has it on both.
    pub fn chain(&self, label: Label, hand: Option<Hand>) -> Vec<Along<'_>> {
        let is_it = |edge: &&WornEdge| {
            edge.label == Some(label) && (hand.is_none() || edge.hand.is_none() || edge.hand == hand)
        };
        self.edges.iter().filter(is_it).map(|edge| Along { piece: self, edge }).collect()
    }

    /// [`Worn::chain`] in the order in which the other side of a seam is written: clockwise.
    pub fn chain_back(&self, label: Label, hand: Option<Hand>) -> Vec<Along<'_>> {
        self.chain(label, hand).into_iter().rev().collect()
    }
}

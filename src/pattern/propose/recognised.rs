//! A piece with its recognised kind.

use super::align::Alignment;
use super::gore::Cut;
use super::shape::Shape;
use super::{Class, Face, Hand, Label, PartName};

/// A piece with its recognised kind.
#[derive(Clone, Debug, PartialEq)]
pub struct Recognised {
    /// Index of the piece.
    pub piece: usize,
    /// Recognised kind of piece.
    pub class: Class,
    /// Front or back.
    pub face: Option<Face>,
    /// Side of the wearer that the name gives. `None` if it gives none.
    pub hand: Option<Hand>,
    /// Outline as edges between corners.
    pub shape: Shape,
    /// Alignment of the outline with its best template.
    pub alignment: Alignment,
    /// Confidence, 0 to 1.
    pub confidence: f64,
    /// Second-best alignment. `None` if the name gives the kind.
    pub rival: Option<Alignment>,
    /// True if the piece is cut twice, for both sides of the wearer, without the outline showing it: half a waistband.
    pub is_pair: bool,
    /// Quantities of a gore. `None` for any other piece.
    pub gore: Option<Cut>,
    /// Part of a kind that the name gives. `None` if it gives none.
    pub part: Option<PartName>,
}

/// True for a leg in one piece, front and back.
pub fn is_whole_leg(candidate: &Recognised) -> bool {
    candidate.class == Class::Leg && candidate.alignment.template.is_limb()
}

/// Total length of the edges of a piece with a label, darts closed, m.
pub fn length_m(candidate: &Recognised, label: Label) -> f64 {
    let parts = candidate.alignment.parts.iter().filter(|part| part.label == label);
    parts.map(|part| candidate.shape.sewn_length(part.from, part.span)).sum()
}

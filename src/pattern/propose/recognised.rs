//! A piece with its recognised kind.

use super::align::Alignment;
use super::gore::Cut;
use super::shape::Shape;
use super::{Class, Face, Hand, Label, PartName};

#[derive(Clone, Debug, PartialEq)]
pub struct Recognised {
    pub piece: usize,
    pub class: Class,
    pub face: Option<Face>,
    /// `None` if the name gives none.
    pub hand: Option<Hand>,
    pub shape: Shape,
    pub alignment: Alignment,
    /// 0 to 1.
    pub confidence: f64,
    /// Second best. `None` if the name gives the kind.
    pub rival: Option<Alignment>,
    /// True if the piece is cut twice, for both sides of the wearer, without the outline showing it: half a waistband.
    pub is_pair: bool,
    pub gore: Option<Cut>,
    /// `None` if the name gives none.
    pub part: Option<PartName>,
}

pub fn is_whole_leg(candidate: &Recognised) -> bool {
    candidate.class == Class::Leg && candidate.alignment.template.is_limb()
}

/// Total length of the edges with a label, darts closed.
pub fn length_m(candidate: &Recognised, label: Label) -> f64 {
    let parts = candidate.alignment.parts.iter().filter(|part| part.label == label);
    parts.map(|part| candidate.shape.sewn_length(part.from, part.span)).sum()
}

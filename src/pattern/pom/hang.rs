//! The lines of a garment that hang level or plumb where it is in balance.

use super::anatomy::{Anatomy, Chain};
use super::legs::Legs;
use super::{Garb, Point, skirt};
use crate::propose::Hand;
use crate::style::{PathPart, Style};

/// Lines on the pieces by which balance is told; empty where a garment has none.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HangLines {
    /// The lower edge; of trousers that of one leg.
    pub hem: Vec<PathPart>,
    /// The upper edge of trousers and skirts.
    pub waist: Vec<PathPart>,
    /// Side seams and outseams of both sides, each from above.
    pub side_seams: Vec<Vec<PathPart>>,
}

impl Style {
    /// The lines by which the balance of the style is told.
    #[must_use]
    pub fn hang_lines(&self) -> HangLines {
        let anatomy = Anatomy::of(self);
        let garb = Garb::of(&anatomy);
        let points = garb.points();
        let path = |point: Point| points.iter().find(|one| one.point == point).map(|one| one.path.clone());
        let hem = path(Point::HalfHem).or_else(|| path(Point::HalfLegOpening));
        let waist = path(Point::HalfWaist).filter(|_| garb.trunk.is_none());
        let of_trunk = garb.trunk.iter().flat_map(|trunk| trunk.side_seams());
        let of_legs = Hand::BOTH.into_iter().filter_map(|hand| Legs::of(&anatomy, hand)?.side_seam());
        let side_seams = of_trunk
            .chain(skirt::side_seams(&anatomy).into_iter().map(|[front, _]| front))
            .chain(of_legs)
            .map(|chain| along(&chain))
            .collect();
        HangLines { hem: hem.unwrap_or_default(), waist: waist.unwrap_or_default(), side_seams }
    }
}

/// The whole edges of a chain.
pub fn along(chain: &Chain) -> Vec<PathPart> {
    chain.iter().map(|(edge, _)| PathPart::Edge(*edge)).collect()
}

//! Lines of a garment that hang level or plumb when it is in balance.

use super::anatomy::{Anatomy, path_along};
use super::legs::Legs;
use super::{Garb, Point, skirt};
use crate::propose::Hand;
use crate::style::{PathPart, Style};

/// Lines on the pieces by which balance is judged. A line that the garment lacks is empty.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HangLines {
    /// Lower edge. Of trousers, that of one leg.
    pub hem: Vec<PathPart>,
    /// Upper edge of trousers and skirts.
    pub waist: Vec<PathPart>,
    /// Side seams and outseams of both sides, each from its upper end.
    pub side_seams: Vec<Vec<PathPart>>,
    /// Height of the hem in front above that behind, as drawn from the shoulder down; 0 where the pieces tell nothing.
    pub drawn_hem_m: f64,
    /// Height of the upper edge of trousers at centre front above that at centre back, as drawn; 0 of others.
    pub drawn_waist_m: f64,
}

impl Style {
    pub fn hang_lines(&self) -> HangLines {
        let anatomy = Anatomy::of(self);
        let garb = Garb::of(&anatomy);
        let points = garb.points();
        let path =
            |point: Point| points.iter().find(|measure| measure.point == point).map(|measure| measure.path.clone());
        let hem = path(Point::HalfHem).or_else(|| path(Point::HalfLegOpening));
        let waist = path(Point::HalfWaist).filter(|_| garb.trunk.is_none());
        let of_trunk = garb.trunk.iter().flat_map(|trunk| trunk.side_seams());
        let of_legs = Hand::BOTH.into_iter().filter_map(|hand| Legs::of(&anatomy, hand)?.side_seam());
        let side_seams = of_trunk
            .chain(skirt::side_seams(&anatomy).into_iter().map(|[front, _]| front))
            .chain(of_legs)
            .map(|chain| path_along(&chain))
            .collect();
        let length_m =
            |point: Point| points.iter().find(|measure| measure.point == point).map(|measure| measure.length_m);
        let drawn_hem_m =
            length_m(Point::BackLength).zip(length_m(Point::FrontLength)).map_or(0.0, |(back, front)| back - front);
        let drawn_waist_m = garb.legs.as_ref().filter(|_| garb.trunk.is_none()).map_or(0.0, Legs::front_over_back_m);
        let (hem, waist) = (hem.unwrap_or_default(), waist.unwrap_or_default());
        HangLines { hem, waist, side_seams, drawn_hem_m, drawn_waist_m }
    }
}

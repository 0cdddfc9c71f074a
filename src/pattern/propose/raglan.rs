//! Raglan: sleeves that go up to the neck, and a trunk without shoulders.

use super::align::{TURNED, align};
use super::shape::Shape;
use super::templates::{TEMPLATES, Template};
use super::{Class, names};
use crate::pattern::piece::Piece;

/// Least fit of a sleeve's outline.
const LEAST_FIT: f64 = 0.35;

/// Whether fronts, backs and sleeves fit raglan templates better, all in all, than plain ones.
pub fn is_raglan(pieces: &[Piece]) -> bool {
    let mut gain = 0.0;
    let mut has_sleeve = false;
    for piece in pieces {
        let named = names::read(&piece.name);
        let class = match (named.class, named.face) {
            (Some(Class::Sleeve), None) => Class::Sleeve,
            (None, Some(_)) => Class::Body,
            _ => continue,
        };
        let Some(shape) = Shape::of(piece) else { continue };
        let [raglan, plain] = [true, false].map(|is_raglan| {
            let is_one = |template: &&Template| template.class == class && template.is_raglan() == is_raglan;
            let fits = |template: &&Template| is_one(template) && !template.is_panel();
            let cost = |quarter_turns| if quarter_turns == 0 { 0.0 } else { TURNED };
            align(&shape, TEMPLATES.iter().filter(fits), cost).map_or(0.0, |found| found.score.max(0.0))
        });
        has_sleeve |= class == Class::Sleeve && raglan >= LEAST_FIT;
        gain += raglan - plain;
    }
    has_sleeve && gain > 0.0
}

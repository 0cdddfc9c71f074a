//! Detection of raglan: sleeves that reach the neck, and a trunk without shoulders.

use super::Class;
use super::align::{LEAST_FIT, upright};
use super::shape::Shape;
use super::templates::Template;
use crate::piece::Piece;
use crate::trade::Named;

/// Possible values of `is_raglan`, the likelier first. True is likelier if fronts, backs and sleeves together fit
/// raglan templates better than plain ones. Without a sleeve that fits a raglan template, only false is possible.
pub fn ways(pieces: &[Piece], named: &[Named]) -> &'static [bool] {
    let mut gain = 0.0;
    let mut has_sleeve = false;
    for (piece, named) in pieces.iter().zip(named) {
        let class = match (named.class, named.face) {
            (Some(Class::Sleeve), None) => Class::Sleeve,
            (None, Some(_)) => Class::Body,
            _ => continue,
        };
        let Some(shape) = Shape::of(piece) else { continue };
        let [raglan, plain] = [true, false].map(|is_raglan| {
            let is_one = |template: &Template| {
                template.class == class && template.is_raglan() == is_raglan && !template.is_panel()
            };
            upright(&shape, is_one).map_or(0.0, |found| found.score.max(0.0))
        });
        has_sleeve |= class == Class::Sleeve && raglan >= LEAST_FIT;
        gain += raglan - plain;
    }
    match (has_sleeve, gain > 0.0) {
        (false, _) => &[false],
        (true, true) => &[true, false],
        (true, false) => &[false, true],
    }
}

//! Outfits: several garments on one body, the inner first.
//!
//! Each garment is draped alone over the body with the inner layers on, which then count as solid ([`dressed`]). An
//! outer garment may be tighter than the inner one hangs, as trousers over a shirt, and the inner one would stand in
//! its way. The outer garment is therefore first draped on a body that leaves room for the inner layers. These are
//! drawn within it ([`Cover`]), and then it is draped over them. At last all layers come to rest together, in contact
//! with the body and with each other.

mod solid;
mod tuck;

pub use solid::dressed;
pub use tuck::{parted, tucked};

use crate::cloth::Cloth;
use crate::cover::Cover;
pub use crate::dressing::{Layer, Wearer};
use crate::{Drape, Monitor, SimError, sewing};
use geom::V3;
use geom::constants::Constant;
use pattern::Garment;

pub struct Joined<'a> {
    pub garments: Vec<&'a Garment>,
    pub all: Garment,
    pub cloth: Cloth,
}

pub fn joined<'a>(layers: &[Layer<'a>]) -> Result<Joined<'a>, SimError> {
    let garments = layers.iter().map(Layer::finest).collect::<Result<Vec<_>, _>>()?;
    let all = Garment::beside(&garments);
    let fabrics: Vec<_> = layers.iter().zip(&garments).map(|(layer, own)| (own.pieces.len(), layer.fabric)).collect();
    let cloth = Cloth::of_layers(&all, &fabrics, sewing::welded(&all))?;
    Ok(Joined { garments, all, cloth })
}

/// Simulator that can dress a body in layers.
pub trait Wear {
    /// Drapes a garment with `room_m` more room to the body.
    fn alone(&self, wearer: Wearer, layer: Layer, room_m: f64, monitor: &mut dyn Monitor) -> Result<Drape, SimError>;

    /// Lets layers that lie over each other at `drapes` come to rest together.
    fn together(
        &self,
        wearer: Wearer,
        layers: &[Layer],
        drapes: Vec<Drape>,
        monitor: &mut dyn Monitor,
    ) -> Result<Vec<Drape>, SimError>;
}

geom::constants! {
    "outfit",
    /// Room for a layer between the body and the next layer: two thicknesses of contact.
    const ROOM_M: f64 = 4e-3;
}

/// Inmost layer first; returns a drape of each.
pub fn dress(
    wearer: Wearer,
    layers: &[Layer],
    wear: &dyn Wear,
    monitor: &mut dyn Monitor,
) -> Result<Vec<Drape>, SimError> {
    let mut drapes: Vec<Drape> = Vec::new();
    for (number, layer) in layers.iter().enumerate() {
        if number == 0 {
            drapes.push(wear.alone(wearer, *layer, 0.0, monitor)?);
            continue;
        }
        let under = &layers[..number];
        let over = wear.alone(wearer, *layer, number as f64 * ROOM_M, monitor)?;
        let inner: Vec<&[V3]> = drapes.iter().map(|drape| &drape.positions[..]).collect();
        let cover = Cover::new(layer.finest()?, &over.positions)?;
        let within = tucked(wearer.field, under, &inner, cover, monitor)?;
        let (body, field) = dressed(wearer, under, &within, wearer.field.spacing_m())?;
        let outer = wear.alone(Wearer { body: &body, field: &field }, *layer, 0.0, monitor)?;
        for (drape, positions) in drapes.iter_mut().zip(within) {
            drape.positions = positions;
        }
        drapes.push(outer);
        drapes = wear.together(wearer, &layers[..=number], drapes, monitor)?;
    }
    Ok(drapes)
}

pub(crate) fn constants() -> Vec<Constant> {
    [CONSTANTS, solid::CONSTANTS, tuck::CONSTANTS].concat()
}

#[cfg(test)]
mod tests;

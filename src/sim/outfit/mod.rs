//! Outfits: several garments on one body, the inner first.
//!
//! Each garment is draped alone over what lies under it, which is then a part of the body ([`dressed`]). Where an outer garment is tighter
//! than the inner one hangs, as trousers over a shirt, that would stand in its way. So the outer is first draped on a body that leaves
//! room for the inner's thickness; the inner is drawn within it ([`Cover`]); and then the outer is put on over both. At last all layers
//! come to rest together, in contact with the body and with each other.

mod solid;
mod tuck;

pub use solid::dressed;
pub use tuck::{parted, tucked};

use crate::cloth::Cloth;
use crate::cover::Cover;
use crate::{Drape, Fabric, Monitor, SimError, sewing};
use body::Body;
use geom::constants::Constant;
use geom::{DistanceField, V3};
use pattern::Garment;

/// A garment of an outfit.
#[derive(Clone, Copy)]
pub struct Layer<'a> {
    /// Its meshes, coarse to fine.
    pub garments: &'a [Garment],
    /// What it is made of.
    pub fabric: &'a Fabric,
}

impl<'a> Layer<'a> {
    /// The mesh that its drape is on.
    ///
    /// # Errors
    /// [`SimError::NoMesh`] where there is none.
    pub fn finest(&self) -> Result<&'a Garment, SimError> {
        self.garments.last().ok_or(SimError::NoMesh)
    }
}

/// The meshes of layers, and all of them sewn, as one garment and one cloth.
///
/// # Errors
/// When a layer has no mesh, or a triangle no area.
pub fn joined<'a>(layers: &[Layer<'a>]) -> Result<(Vec<&'a Garment>, Garment, Cloth), SimError> {
    let garments = layers.iter().map(Layer::finest).collect::<Result<Vec<_>, _>>()?;
    let all = Garment::beside(&garments);
    let fabrics: Vec<_> = layers.iter().zip(&garments).map(|(layer, own)| (own.pieces.len(), layer.fabric)).collect();
    let cloth = Cloth::of_layers(&all, &fabrics, sewing::welded(&all))?;
    Ok((garments, all, cloth))
}

/// How a simulator dresses a body in layers.
pub trait Wear {
    /// Drapes a garment alone, with so much more room to the body as is given, m.
    ///
    /// # Errors
    /// What the simulator refuses.
    fn alone(
        &self,
        on: (&Body, &DistanceField),
        layer: Layer,
        room_m: f64,
        monitor: &mut dyn Monitor,
    ) -> Result<Drape, SimError>;

    /// Lets layers that lie over each other at `drapes` come to rest together.
    ///
    /// # Errors
    /// What the simulator refuses.
    fn together(
        &self,
        on: (&Body, &DistanceField),
        layers: &[Layer],
        drapes: Vec<Drape>,
        monitor: &mut dyn Monitor,
    ) -> Result<Vec<Drape>, SimError>;
}

geom::constants! {
    "outfit",
    /// Room for a layer between the body and what is worn over it, m: two thicknesses of contact.
    const ROOM_M: f64 = 4e-3;
}

/// Dresses a body in layers, the inner first; a drape of each.
///
/// # Errors
/// What the simulator refuses of a layer, or when what is worn bounds no solid.
pub fn dress(
    on: (&Body, &DistanceField),
    layers: &[Layer],
    wear: &dyn Wear,
    monitor: &mut dyn Monitor,
) -> Result<Vec<Drape>, SimError> {
    let mut drapes: Vec<Drape> = Vec::new();
    for (number, layer) in layers.iter().enumerate() {
        if number == 0 {
            drapes.push(wear.alone(on, *layer, 0.0, monitor)?);
            continue;
        }
        let under = &layers[..number];
        let over = wear.alone(on, *layer, number as f64 * ROOM_M, monitor)?;
        let inner: Vec<&[V3]> = drapes.iter().map(|drape| &drape.positions[..]).collect();
        let cover = Cover::new(layer.finest()?, &over.positions)?;
        let within = tucked(on, under, &inner, cover, monitor)?;
        let (body, field) = dressed(on, under, &within, on.1.spacing_m())?;
        let outer = wear.alone((&body, &field), *layer, 0.0, monitor)?;
        for (drape, positions) in drapes.iter_mut().zip(within) {
            drape.positions = positions;
        }
        drapes.push(outer);
        drapes = wear.together(on, &layers[..=number], drapes, monitor)?;
    }
    Ok(drapes)
}

/// Constants of outfits that decide results.
pub(crate) fn constants() -> Vec<Constant> {
    [CONSTANTS, solid::CONSTANTS, tuck::CONSTANTS].concat()
}

#[cfg(test)]
mod tests;

//! A body and the garments that it is to wear, as both simulators take them.

use crate::contact::Skin;
use crate::{Fabric, SimError};
use body::Body;
use geom::DistanceField;
use pattern::Garment;

#[derive(Clone, Copy)]
pub struct Wearer<'a> {
    pub body: &'a Body,
    pub field: &'a DistanceField,
}

/// Garment that is to be worn: alone, or as a layer of an outfit.
#[derive(Clone, Copy)]
pub struct Layer<'a> {
    /// Meshes, coarse to fine.
    pub garments: &'a [Garment],
    pub fabric: &'a Fabric,
}

impl<'a> Layer<'a> {
    /// Mesh that is placed first.
    pub fn coarsest(&self) -> Result<&'a Garment, SimError> {
        self.garments.first().ok_or(SimError::NoMesh)
    }

    /// Mesh that the drape is on.
    pub fn finest(&self) -> Result<&'a Garment, SimError> {
        self.garments.last().ok_or(SimError::NoMesh)
    }
}

#[derive(Clone, Copy)]
pub struct Dressing<'a> {
    pub wearer: Wearer<'a>,
    /// `None` where the body's mesh bounds no solid.
    pub skin: Option<&'a Skin<'a>>,
    pub layer: Layer<'a>,
}

//! A body and the garments that it is to wear, as both simulators take them.

use crate::contact::Skin;
use crate::{Fabric, SimError};
use body::Body;
use geom::DistanceField;
use pattern::Garment;

/// A body that is to be dressed.
#[derive(Clone, Copy)]
pub struct Wearer<'a> {
    /// Its mesh with joints, landmarks and levels.
    pub body: &'a Body,
    /// Distance from its skin.
    pub field: &'a DistanceField,
}

/// A garment that is to be worn: alone, or as a layer of an outfit.
#[derive(Clone, Copy)]
pub struct Layer<'a> {
    /// Its meshes, coarse to fine.
    pub garments: &'a [Garment],
    /// Fabric that it is made of.
    pub fabric: &'a Fabric,
}

impl<'a> Layer<'a> {
    /// The mesh that is placed first.
    ///
    /// # Errors
    /// [`SimError::NoMesh`] where there is none.
    pub fn coarsest(&self) -> Result<&'a Garment, SimError> {
        self.garments.first().ok_or(SimError::NoMesh)
    }

    /// The mesh that its drape is on.
    ///
    /// # Errors
    /// [`SimError::NoMesh`] where there is none.
    pub fn finest(&self) -> Result<&'a Garment, SimError> {
        self.garments.last().ok_or(SimError::NoMesh)
    }
}

/// A garment and the body that is to wear it.
#[derive(Clone, Copy)]
pub struct Dressing<'a> {
    /// Body that wears it.
    pub wearer: Wearer<'a>,
    /// Exact surface of the body; `None` where its mesh bounds no solid.
    pub skin: Option<&'a Skin<'a>>,
    /// The garment.
    pub layer: Layer<'a>,
}

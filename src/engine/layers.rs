//! Layers of an outfit: draped together, and each measured on the layers beneath it.

use std::sync::Arc;

use crate::fitting::Fitting;
use crate::outcome::Outcome;
use crate::stages::{Meshes, style};
use body::Body;
use fit::Simulator;
use geom::DistanceField;
use pattern::Style;
use sim::outfit::{self, Layer};
use sim::{Drape, Fabric, Monitor};
use spec::{Inputs, JobSpec, Outfit, Parameters};
use store::{Origin, Result, StudyError};

/// Drapes of all layers, the inmost first, as the cache keeps them.
#[derive(serde::Serialize, serde::Deserialize)]
pub(crate) struct Drapes(pub Vec<Drape>);

store::json_artefact!(Drapes);

/// A garment that is worn with others.
pub(crate) struct Garb {
    /// Its pieces with their seams and measurements.
    pub style: Style,
    /// Meshes of the pieces, coarse to fine.
    pub meshes: Arc<Meshes>,
    /// What it is cut from.
    pub fabric: Fabric,
}

/// Garments over each other on one body, the inmost first.
#[derive(Clone, Copy)]
pub(crate) struct Wardrobe<'a> {
    /// The body and its field.
    pub on: (&'a Body, &'a DistanceField),
    /// What it wears.
    pub garbs: &'a [Garb],
    /// How it is draped.
    pub simulator: Simulator,
    /// The simulator's parameters that are not the default ones.
    pub parameters: &'a Parameters,
}

impl<'a> Wardrobe<'a> {
    fn layers(&self) -> Vec<Layer<'a>> {
        self.garbs.iter().map(|garb| Layer { garments: &garb.meshes.0, fabric: &garb.fabric }).collect()
    }

    fn fitting<'b>(&self, on: (&'b Body, &'b DistanceField), garb: &'b Garb) -> Fitting<'b>
    where
        'a: 'b,
    {
        Fitting {
            body: on.0,
            field: on.1,
            style: &garb.style,
            meshes: &garb.meshes,
            fabric: &garb.fabric,
            simulator: self.simulator,
            parameters: self.parameters,
        }
    }

    /// Drapes all layers.
    ///
    /// # Errors
    /// When the simulator refuses; [`StudyError::Interrupted`] when the monitor cancels.
    pub fn dress(&self, monitor: &mut dyn Monitor) -> Result<Vec<Drape>> {
        match (self.garbs, self.simulator) {
            ([garb], _) => Ok(vec![self.fitting(self.on, garb).simulate(monitor)?]),
            (_, Simulator::Fem) => {
                outfit::dress(self.on, &self.layers(), &self.parameters.fem()?, monitor).map_err(StudyError::sim)
            }
            (_, Simulator::Hybrid) => Err(StudyError::refused(
                Origin::Sim,
                "Hybrid-GS drapes one garment at a time; FEM-GS (fem) drapes outfits",
            )),
        }
    }

    /// Measures the drape of a layer on what lies under it.
    ///
    /// # Errors
    /// When the garment has no measurement, or what lies under it bounds no solid.
    pub fn outcome(&self, number: usize, drapes: &[Drape]) -> Result<Outcome> {
        let garb = &self.garbs[number];
        if number == 0 {
            return self.fitting(self.on, garb).outcome(&drapes[0]);
        }
        let under: Vec<_> = drapes[..number].iter().map(|drape| drape.positions.clone()).collect();
        let (body, field) = outfit::dressed(self.on, &self.layers()[..number], &under, 0.0).map_err(StudyError::sim)?;
        self.fitting((&body, &field), garb).outcome(&drapes[number])
    }
}

impl Garb {
    /// Reads the garment of a layer, which has these meshes.
    pub fn of(spec: &JobSpec, meshes: Arc<Meshes>) -> Result<Self> {
        Ok(Self { style: style(spec)?, meshes, fabric: spec.fabric.clone() })
    }
}

/// Inputs under which the drapes of an outfit are kept in the cache.
pub(crate) fn inputs(outfit: &Outfit) -> Inputs {
    let mut inputs = Inputs::default();
    inputs.set("outfit.id", outfit.id());
    inputs
}

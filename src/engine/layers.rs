//! Layers of an outfit: draped together, then each measured on the layers beneath it.

use crate::error::EngineError;
use crate::fitting::Fitting;
use crate::outcome::Outcome;
use crate::stages::Garb;
use fit::Simulator;
use sim::dressing::Wearer;
use sim::outfit::{self, Layer};
use sim::{Drape, Monitor};
use spec::{Inputs, Outfit, Parameters};
use store::{Result, StudyError};

/// Drapes of all layers, the inmost first, as a product of the cache.
#[derive(serde::Serialize, serde::Deserialize)]
pub(crate) struct Drapes(pub Vec<Drape>);

store::json_artefact!(Drapes);

/// Garments on top of each other on one body, the inmost first.
#[derive(Clone, Copy)]
pub(crate) struct Ensemble<'a> {
    pub wearer: Wearer<'a>,
    pub garbs: &'a [Garb],
    pub simulator: Simulator,
    pub parameters: &'a Parameters,
}

impl<'a> Ensemble<'a> {
    fn layers(&self) -> Vec<Layer<'a>> {
        self.garbs.iter().map(|garb| Layer { garments: &garb.meshes.0, fabric: &garb.fabric }).collect()
    }

    fn fitting<'b>(&self, wearer: Wearer<'b>, garb: &'b Garb) -> Fitting<'b>
    where
        'a: 'b,
    {
        Fitting { wearer, garb, simulator: self.simulator, parameters: self.parameters }
    }

    pub fn dress(&self, monitor: &mut dyn Monitor) -> Result<Vec<Drape>> {
        match (self.garbs, self.simulator) {
            ([garb], _) => Ok(vec![self.fitting(self.wearer, garb).simulate(monitor)?]),
            (_, Simulator::Fem) => {
                outfit::dress(self.wearer, &self.layers(), &self.parameters.fem()?, monitor).map_err(StudyError::sim)
            }
            (_, Simulator::Hybrid) => Err(EngineError::HybridOutfit.into()),
        }
    }

    /// Measures the drape of a layer on the body and the layers beneath it.
    pub fn outcome(&self, number: usize, drapes: &[Drape]) -> Result<Outcome> {
        let garb = &self.garbs[number];
        if number == 0 {
            return self.fitting(self.wearer, garb).outcome(&drapes[0]);
        }
        let under: Vec<_> = drapes[..number].iter().map(|drape| drape.positions.clone()).collect();
        let layers = &self.layers()[..number];
        let (body, field) = outfit::dressed(self.wearer, layers, &under, 0.0).map_err(StudyError::sim)?;
        self.fitting(Wearer { body: &body, field: &field }, garb).outcome(&drapes[number])
    }
}

/// Inputs whose hash keys the drapes of an outfit in the cache.
pub(crate) fn inputs(outfit: &Outfit) -> Inputs {
    let mut inputs = Inputs::default();
    inputs.set("outfit.id", outfit.id());
    inputs
}

//! Products of the stages before the drape: a body, the style of a size, its meshes.

use std::sync::Arc;

use crate::error::EngineError;
use body::Body;
use pattern::{Garment, Style};
use sim::Fabric;
use spec::{Inputs, JobSpec, Person, patterns, subject_inputs, versions};
use store::{InOrigin, Origin, Result};

/// Inputs that decide a subject's body; the jobs on that subject have the same ones.
pub fn body_inputs(name: &str, person: &Person) -> Inputs {
    let mut inputs = Inputs::default();
    subject_inputs(&mut inputs, name, person);
    for (name, version) in versions::VERSIONS {
        inputs.set(name, version);
    }
    inputs
}

#[derive(serde::Serialize, serde::Deserialize)]
pub struct Model {
    pub body: Body,
}

/// Meshes of one garment, coarse to fine.
#[derive(serde::Serialize, serde::Deserialize)]
pub struct Meshes(pub Vec<Garment>);

impl Meshes {
    /// Meshes at all levels. `edge_length_m` is that of the finest.
    pub fn of(style: &Style, edge_length_m: f64) -> Result<Self> {
        let edges = sim::fem::level_edges(edge_length_m).into_iter();
        let meshes = edges.map(|edge| style.mesh(edge).origin(Origin::Mesh));
        Ok(Self(meshes.collect::<Result<_>>()?))
    }

    /// Mesh on which results are measured.
    pub fn finest(&self) -> Result<&Garment> {
        Ok(self.0.last().ok_or(EngineError::NoMesh)?)
    }
}

store::json_artefact!(Model, Meshes);

/// A garment that is ready to be draped.
#[derive(Clone)]
pub struct Garb {
    pub style: Style,
    pub meshes: Arc<Meshes>,
    pub fabric: Fabric,
}

impl Garb {
    pub fn of(spec: &JobSpec, meshes: Arc<Meshes>) -> Result<Self> {
        Ok(Self { style: style(spec)?, meshes, fabric: spec.fabric.clone() })
    }
}

pub fn style(spec: &JobSpec) -> Result<Style> {
    let unit = spec.unit.as_deref().and_then(patterns::unit_of);
    patterns::read_style(&spec.pattern, spec.seams.as_ref(), Some(&spec.size), unit)
}

pub(crate) fn mesh(spec: &JobSpec) -> Result<Meshes> {
    let style = style(spec)?;
    Meshes::of(&style, spec.edge_length_m)
}

//! The laboratory: specimens of cloth in experiments with known answers, for tests and for `docs/mechanics.md`.
//!
//! The experiments use the solver that drapes garments, with a direct solver for the linear systems.

pub mod bench;
pub mod bending;
pub mod drape;
pub mod sheets;
pub mod stretch;
pub mod touch;

use crate::cloth::Cloth;
use crate::contact::{BodyContact, ContactParams};
use crate::sewing::unsewn;
use crate::solver::{StepParams, Stepper, System};
use crate::{Fabric, SimError};
use geom::constants::Constant;
use geom::{DistanceField, V2, V3, shapes};
use linalg::LinearSolver;
use pattern::{Garment, PieceMesh, Role};

use sheets::Flat;

/// Flat piece of cloth, its grain along v, of which some vertices are held.
pub struct Specimen {
    /// Without seams.
    pub garment: Garment,
    pub cloth: Cloth,
    pub positions: Vec<V3>,
    pub held: Vec<usize>,
}

impl Specimen {
    /// Deforms a flat piece by the map `place` from its plane to space.
    pub fn new(flat: Flat, fabric: &Fabric, place: impl Fn(&V2) -> V3) -> Result<Self, SimError> {
        let garment = garment(flat);
        let cloth = Cloth::new(&garment, fabric, unsewn(&garment))?;
        let positions = garment.rest.iter().map(place).collect();
        Ok(Self { garment, cloth, positions, held: Vec::new() })
    }

    pub fn hold(mut self, is_held: impl Fn(&V2) -> bool) -> Self {
        self.held = (0..self.garment.rest.len()).filter(|&v| is_held(&self.garment.rest[v])).collect();
        self
    }

    /// Brings the specimen to rest under `gravity` times its weight. Returns the residual.
    pub fn rest(&mut self, gravity: f64, tolerance: f64, steps: usize) -> f64 {
        let field = nowhere();
        let contact = BodyContact::new(&field, ContactParams::default(), &self.cloth.areas);
        let mut system = System::new(&self.cloth, contact, None);
        system.weights.iter_mut().for_each(|w| *w *= gravity);
        system.held.clone_from(&self.held);
        system.linear = LinearSolver::exact();
        settle(&mut system, &mut self.positions, tolerance, steps)
    }
}

/// Takes steps with accurate linear solves. Returns the residual.
pub fn settle(system: &mut System, x: &mut Vec<V3>, tolerance: f64, steps: usize) -> f64 {
    let exact = StepParams { linear_tolerance: 1e-4, h_max_s: 20.0, clamp_m: 0.05, ..StepParams::default() };
    let mut stepper = Stepper::new(exact);
    let mut residual = f64::MAX;
    for _ in 0..steps {
        residual = stepper.step(system, x, tolerance).residual;
        if residual <= tolerance {
            break;
        }
    }
    residual
}

/// Garment of one piece, its grain along v.
pub fn garment((rest, triangles): Flat) -> Garment {
    let edge_length_m = triangles.first().map_or(0.0, |t| (rest[t[1]] - rest[t[0]]).norm());
    let piece = PieceMesh {
        id: "sheet".into(),
        role: Role::Front,
        vertices: 0..rest.len(),
        triangles: 0..triangles.len(),
        grain: V2::y(),
        edges: Default::default(),
    };
    Garment {
        name: "sheet".into(),
        size: "one".into(),
        pieces: vec![piece],
        rest,
        triangles,
        seams: Vec::new(),
        measurements: Vec::new(),
        fit_levels: Vec::new(),
        reinforcements: Vec::new(),
        edge_length_m,
    }
}

/// Distance field of a body that is far from everything.
///
/// # Panics
/// Never: a sphere is closed.
pub fn nowhere() -> DistanceField {
    let mut mesh = shapes::sphere(0.05, 8);
    for p in &mut mesh.positions {
        p.x += 50.0;
    }
    DistanceField::build(&mesh, 0.02).expect("a closed sphere")
}

/// Membrane modulus `stiffness_n_m` without coupling, shear modulus half of it.
pub fn isotropic(density_kg_m2: f64, stiffness_n_m: f64, rigidity_nm: f64) -> Fabric {
    Fabric {
        name: "specimen".into(),
        density_kg_m2,
        thickness_m: 3e-4,
        membrane_warp_n_m: stiffness_n_m,
        membrane_weft_n_m: stiffness_n_m,
        membrane_coupling_n_m: 0.0,
        shear_n_m: 0.5 * stiffness_n_m,
        bending_warp_nm: rigidity_nm,
        bending_weft_nm: rigidity_nm,
        friction_body: 0.3,
        friction_self: 0.5,
        source: "made up".into(),
        stretched: None,
    }
}

pub(crate) fn constants() -> Vec<Constant> {
    [bench::CONSTANTS, drape::CONSTANTS].concat()
}

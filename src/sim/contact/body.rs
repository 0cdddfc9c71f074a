//! Contact of cloth with the body: a penalty in the distance field, and Coulomb friction by anchors.
//!
//! A vertex nearer than the offset `d0` is pushed out with the energy `k A (d0 - phi)^2 / 2`, `A` its rest area; the force runs
//! along the raw gradient of the field, so that it is exactly the energy's. Friction ties a touching vertex to an anchor by
//! a spring of stiffness `k_t`; beyond the Coulomb limit the anchor is dragged along [method 7].

use nalgebra::Matrix3;

use crate::geom::{DistanceField, V3};

/// Parameters of body contact.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct ContactParams {
    /// Distance from the skin at which cloth begins to be pushed, m.
    pub offset_m: f64,
    /// Penalty, N/m3 (pressure per depth).
    pub stiffness_n_m3: f64,
    /// Tangential over normal stiffness of a sticking contact.
    pub tangential_share: f64,
}

impl Default for ContactParams {
    fn default() -> Self {
        Self { offset_m: 1e-3, stiffness_n_m3: 1e7, tangential_share: 0.03 }
    }
}

/// Share of the sticking stiffness that a sliding contact keeps in the linear system, so that it stays regular.
const SLIDING_STIFFNESS_SHARE: f64 = 0.1;

/// A vertex in contact, as seen at the start of a step.
#[derive(Clone, Copy, Debug)]
struct Touch {
    vertex: usize,
    /// Gradient of the distance.
    gradient: V3,
    /// Normal force, N.
    force_n: f64,
}

/// Contact of one cloth with one body.
pub struct BodyContact<'a> {
    field: &'a DistanceField,
    params: ContactParams,
    /// Penalty stiffness of each vertex, N/m.
    stiffness: Vec<f64>,
    /// Coulomb coefficient; `None` while friction is off.
    friction: Option<f64>,
    anchors: Vec<Option<V3>>,
    touching: Vec<Touch>,
}

impl<'a> BodyContact<'a> {
    /// Contact for vertices with rest areas `areas` (m2), without friction.
    #[must_use]
    pub fn new(field: &'a DistanceField, params: ContactParams, areas: &[f64]) -> Self {
        Self {
            field,
            params,
            stiffness: areas.iter().map(|a| a * params.stiffness_n_m3).collect(),
            friction: None,
            anchors: vec![None; areas.len()],
            touching: Vec::new(),
        }
    }

    /// Switches friction on with a Coulomb coefficient, or off. Anchors are set where the cloth now lies.
    pub fn set_friction(&mut self, coefficient: Option<f64>) {
        self.friction = coefficient;
        self.anchors.fill(None);
    }

    /// Number of vertices in contact at the last [`BodyContact::assemble`].
    #[must_use]
    pub fn count(&self) -> usize {
        self.touching.len()
    }

    fn depth(&self, p: &V3) -> (f64, V3) {
        let (distance, gradient) = self.field.value_and_gradient(p);
        (self.params.offset_m - distance, gradient)
    }

    /// Contact and friction energy, J; friction's with the normal forces and anchors of the current step.
    #[must_use]
    pub fn energy(&self, x: &[V3]) -> f64 {
        let mut energy = 0.0;
        for (p, k) in x.iter().zip(&self.stiffness) {
            let (depth, _) = self.depth(p);
            if depth > 0.0 {
                energy += 0.5 * k * depth * depth;
            }
        }
        energy + self.touching.iter().filter_map(|t| self.friction_at(t, &x[t.vertex])).map(|f| f.energy).sum::<f64>()
    }

    /// Adds the contact forces at `x`; friction's with the normal forces and anchors of the current step.
    pub fn add_forces(&self, x: &[V3], forces: &mut [V3]) {
        for ((p, k), force) in x.iter().zip(&self.stiffness).zip(forces.iter_mut()) {
            let (depth, gradient) = self.depth(p);
            if depth > 0.0 {
                *force += gradient * (k * depth);
            }
        }
        for touch in &self.touching {
            if let Some(f) = self.friction_at(touch, &x[touch.vertex]) {
                forces[touch.vertex] += f.force;
            }
        }
    }

    /// Finds the touching vertices and adds their forces and stiffness.
    pub fn assemble(&mut self, x: &[V3], forces: &mut [V3], diagonal: &mut [Matrix3<f64>]) {
        self.touching.clear();
        for vertex in 0..x.len() {
            let (depth, gradient) = self.depth(&x[vertex]);
            if depth <= 0.0 {
                self.anchors[vertex] = None;
                continue;
            }
            let k = self.stiffness[vertex];
            forces[vertex] += gradient * (k * depth);
            diagonal[vertex] += gradient * gradient.transpose() * k;
            self.touching.push(Touch { vertex, gradient, force_n: k * depth * gradient.norm() });
            if self.friction.is_some() {
                self.anchors[vertex].get_or_insert(x[vertex]);
            }
        }
        for touch in &self.touching {
            if let Some(f) = self.friction_at(touch, &x[touch.vertex]) {
                forces[touch.vertex] += f.force;
                diagonal[touch.vertex] += f.stiffness;
            }
        }
    }

    fn friction_at(&self, touch: &Touch, p: &V3) -> Option<Friction> {
        let limit = self.friction? * touch.force_n;
        let anchor = self.anchors[touch.vertex]?;
        let normal = touch.gradient.try_normalize(0.0)?;
        let tangent_plane = Matrix3::identity() - normal * normal.transpose();
        let slip = tangent_plane * (p - anchor);
        let k = self.stiffness[touch.vertex] * self.params.tangential_share;
        let length = slip.norm();
        Some(if k * length <= limit {
            Friction {
                energy: 0.5 * k * length * length,
                force: slip * -k,
                stiffness: tangent_plane * k,
                excess: V3::zeros(),
            }
        } else {
            let direction = slip / length;
            Friction {
                energy: limit * (length - 0.5 * limit / k),
                force: direction * -limit,
                stiffness: tangent_plane * (k * SLIDING_STIFFNESS_SHARE),
                excess: direction * (length - limit / k),
            }
        })
    }

    /// Drags the anchors of sliding vertices along, after a step has been taken to `x`.
    pub fn drag_anchors(&mut self, x: &[V3]) {
        for k in 0..self.touching.len() {
            let touch = self.touching[k];
            let excess = self.friction_at(&touch, &x[touch.vertex]).map(|f| f.excess);
            if let (Some(anchor), Some(excess)) = (&mut self.anchors[touch.vertex], excess) {
                *anchor += excess;
            }
        }
    }
}

struct Friction {
    energy: f64,
    force: V3,
    stiffness: Matrix3<f64>,
    /// How far the anchor lags behind the Coulomb limit.
    excess: V3,
}

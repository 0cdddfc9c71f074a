//! Contact of cloth with the body: a penalty in the distance field, and Coulomb friction by anchors.
//!
//! A vertex nearer than the offset `d0` is pushed out by a pressure that grows with its depth `d = d0 - phi` as
//! `p0 (exp(d / l) - 1)` until its slope is the penalty `k`, and with slope `k` from there on; its force is that times its rest
//! area. So what only carries its weight lies softly (a hard contact of a few pascals is lost by a move of a micrometre, and
//! found again by the next), and what is drawn tight lies hard. The force runs along the raw gradient of the field, so
//! that it is exactly the energy's. Friction ties a touching vertex to an anchor by
//! a spring of stiffness `k_t`; beyond the Coulomb limit the anchor is dragged along [method 7].

use nalgebra::Matrix3;

use crate::geom::{DistanceField, V3};

/// Parameters of body contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactParams {
    /// Distance from the skin at which cloth begins to be pushed, m.
    pub offset_m: f64,
    /// Penalty, N/m3 (pressure per depth).
    pub stiffness_n_m3: f64,
    /// Depth over which the pressure of a light contact grows e-fold, m.
    pub softness_m: f64,
    /// Pressure at which that growth begins, N/m2: about the weight of cloth.
    pub light_n_m2: f64,
    /// Greatest displacement of a sticking contact, m: a light one is held no more stiffly than that takes.
    pub slip_m: f64,
    /// Greatest tangential stiffness of a sticking contact over the penalty.
    pub tangential_share: f64,
}

impl Default for ContactParams {
    fn default() -> Self {
        Self {
            offset_m: 1e-3,
            stiffness_n_m3: 1e7,
            softness_m: 5e-5,
            light_n_m2: 2.0,
            slip_m: 2e-4,
            tangential_share: 0.03,
        }
    }
}

/// What a contact does at some depth.
struct Push {
    /// Energy per area, N/m.
    energy_n_m: f64,
    pressure_n_m2: f64,
    /// Slope of the pressure, N/m3.
    stiffness_n_m3: f64,
}

impl ContactParams {
    fn push(&self, depth: f64) -> Push {
        let (l, p0, k) = (self.softness_m, self.light_n_m2, self.stiffness_n_m3);
        let knee = l * (k * l / p0).max(1.0).ln();
        let soft = depth.min(knee);
        let hard = depth - soft;
        let growth = (soft / l).exp();
        let pressure = p0 * (growth - 1.0);
        Push {
            energy_n_m: p0 * (l * (growth - 1.0) - soft) + hard * (pressure + 0.5 * k * hard),
            pressure_n_m2: pressure + k * hard,
            stiffness_n_m3: if hard > 0.0 { k } else { p0 / l * growth },
        }
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
    /// Normal stiffness, N/m.
    stiffness_n_m: f64,
}

/// Contact of one cloth with one body.
pub struct BodyContact<'a> {
    field: &'a DistanceField,
    params: ContactParams,
    /// Rest area of each vertex, m2.
    areas: Vec<f64>,
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
            areas: areas.to_vec(),
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
        for (p, area) in x.iter().zip(&self.areas) {
            let (depth, _) = self.depth(p);
            if depth > 0.0 {
                energy += area * self.params.push(depth).energy_n_m;
            }
        }
        energy + self.touching.iter().filter_map(|t| self.friction_at(t, &x[t.vertex])).map(|f| f.energy).sum::<f64>()
    }

    /// Adds the contact forces at `x`; friction's with the normal forces and anchors of the current step.
    pub fn add_forces(&self, x: &[V3], forces: &mut [V3]) {
        for ((p, area), force) in x.iter().zip(&self.areas).zip(forces.iter_mut()) {
            let (depth, gradient) = self.depth(p);
            if depth > 0.0 {
                *force += gradient * (area * self.params.push(depth).pressure_n_m2);
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
            let area = self.areas[vertex];
            let push = self.params.push(depth);
            forces[vertex] += gradient * (area * push.pressure_n_m2);
            let stiffness_n_m = area * push.stiffness_n_m3;
            diagonal[vertex] += gradient * gradient.transpose() * stiffness_n_m;
            let force_n = area * push.pressure_n_m2 * gradient.norm();
            self.touching.push(Touch { vertex, gradient, force_n, stiffness_n_m });
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

    /// Adds what vertices that touch at `x` lack of stiffness in `diagonal`, which [`BodyContact::assemble`] has filled for
    /// the start of the step: those that come to touch, and those that go deeper.
    pub fn stiffen(&self, x: &[V3], diagonal: &mut [Matrix3<f64>]) {
        let mut has = vec![0.0; x.len()];
        for touch in &self.touching {
            has[touch.vertex] = touch.stiffness_n_m;
        }
        for vertex in 0..x.len() {
            let (depth, gradient) = self.depth(&x[vertex]);
            if depth > 0.0 {
                let lacks = self.areas[vertex] * self.params.push(depth).stiffness_n_m3 - has[vertex];
                diagonal[vertex] += gradient * gradient.transpose() * lacks.max(0.0);
            }
        }
    }

    fn friction_at(&self, touch: &Touch, p: &V3) -> Option<Friction> {
        let limit = self.friction? * touch.force_n;
        let anchor = self.anchors[touch.vertex]?;
        let normal = touch.gradient.try_normalize(0.0)?;
        let tangent_plane = Matrix3::identity() - normal * normal.transpose();
        let slip = tangent_plane * (p - anchor);
        let stiffest = self.areas[touch.vertex] * self.params.stiffness_n_m3 * self.params.tangential_share;
        let k = stiffest.min(limit / self.params.slip_m);
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

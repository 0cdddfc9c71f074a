//! Friction between layers of cloth: a slip between two touching primitives is opposed by a spring, up to the Coulomb
//! limit.
//!
//! Normal forces, weights and normals are those at the start of a step, as for the body. Within a step the energy is
//! then a function of the positions alone. The slip of a pair from its anchor is remembered while the pair touches, and
//! forgotten when it parts.

use std::collections::BTreeMap;

use super::distance::Primitives;
use super::friction::{Friction, Hold, across};
use crate::cloth::part::Part;
use geom::V3;
use linalg::Contact4;

geom::constants! {
    "contact.rub",
    /// Greatest slip of two layers that stick. It limits the tangential stiffness of light contacts.
    const SLIP_M: f64 = 2e-4;
    /// Greatest tangential stiffness of a sticking contact over the stiffness of the normal contact.
    const TANGENTIAL_SHARE: f64 = 0.3;
}

pub struct Pressed {
    pub primitives: Primitives,
    /// At the closest points; they sum to zero.
    pub weights: [f64; 4],
    /// Unit vector from the second primitive to the first.
    pub normal: V3,
    pub force_n: f64,
    /// Penalty stiffness, without the barrier.
    pub stiffness_n_m: f64,
}

struct Touch {
    pressed: Pressed,
    hold: Hold,
    /// Slip at the start of the step less the separation there. The slip at `x` is the tangential part of `sum w x`
    /// plus this.
    before: V3,
}

/// Friction between the layers of one cloth.
pub struct Rub {
    /// Per vertex; that of a contact is the mean of two.
    coefficients: Vec<f64>,
    is_fast: bool,
    /// Slip of each touching pair from its anchor.
    held: BTreeMap<Primitives, V3>,
    touching: Vec<Touch>,
}

impl Rub {
    pub fn new(coefficients: Vec<f64>) -> Self {
        Self { coefficients, is_fast: false, held: BTreeMap::new(), touching: Vec::new() }
    }

    pub fn part(&self, part: &Part) -> Self {
        let renamed = |primitives: Primitives| primitives.renamed(|vertices| part.names(vertices));
        let held = self.held.iter().filter_map(|(primitives, held)| Some((renamed(*primitives)?, *held)));
        let coefficients = part.of(&self.coefficients);
        Self { coefficients, is_fast: self.is_fast, held: held.collect(), touching: Vec::new() }
    }

    /// Takes over the slips of a part. `renamed` maps its primitives to those of this cloth.
    pub fn take(&mut self, part: &Self, renamed: impl Fn(Primitives) -> Option<Primitives>) {
        self.held.extend(part.held.iter().filter_map(|(primitives, held)| Some((renamed(*primitives)?, *held))));
    }

    pub fn hold_fast(&mut self) {
        self.is_fast = true;
    }

    pub fn begin(&mut self, x: &[V3], pressed: impl Iterator<Item = Pressed>) {
        self.touching.clear();
        for pressed in pressed {
            // The first vertex belongs to the first primitive, and the last to the second.
            let [first, _, _, last] = pressed.primitives.vertices().map(|v| self.coefficients[v]);
            let limit_n = 0.5 * (first + last) * pressed.force_n;
            if limit_n <= 0.0 {
                continue;
            }
            let stiffness_n_m = (TANGENTIAL_SHARE * pressed.stiffness_n_m).min(limit_n / SLIP_M);
            let hold = Hold { limit_n, stiffness_n_m, is_fast: self.is_fast };
            let held = self.held.get(&pressed.primitives).copied().unwrap_or_default();
            let before = held - pressed.apart(x);
            self.touching.push(Touch { pressed, hold, before });
        }
        self.held = self.touching.iter().map(|touch| (touch.pressed.primitives, touch.slip(x))).collect();
    }

    /// Ends a step at `x`: the anchors of contacts that have slid are dragged along.
    pub fn end(&mut self, x: &[V3]) {
        for touch in &self.touching {
            self.held.insert(touch.pressed.primitives, touch.friction(x).held);
        }
    }

    /// J.
    pub fn energy(&self, x: &[V3]) -> f64 {
        self.touching.iter().map(|touch| touch.friction(x).energy_j).sum()
    }

    pub fn assemble(&self, x: &[V3], forces: &mut [V3], contacts: &mut Vec<Contact4>) {
        for touch in &self.touching {
            let Pressed { primitives, weights, normal, .. } = touch.pressed;
            let vertices = primitives.vertices();
            let friction = touch.friction(x);
            for (v, weight) in vertices.into_iter().zip(weights) {
                forces[v] += friction.force * weight;
            }
            let aside = if normal.x.abs() < 0.7 { V3::x() } else { V3::y() };
            let first = normal.cross(&aside).normalize();
            for tangent in [first, normal.cross(&first)] {
                contacts.push(Contact4 { vertices, weights, normal: tangent, stiffness: friction.stiffness_n_m });
            }
        }
    }
}

impl Pressed {
    fn apart(&self, x: &[V3]) -> V3 {
        self.primitives.vertices().iter().zip(self.weights).map(|(&v, weight)| x[v] * weight).sum()
    }
}

impl Touch {
    fn slip(&self, x: &[V3]) -> V3 {
        across(&(self.before + self.pressed.apart(x)), &self.pressed.normal)
    }

    fn friction(&self, x: &[V3]) -> Friction {
        self.hold.at(self.slip(x))
    }
}

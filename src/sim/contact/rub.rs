//! Friction of layers of cloth on each other: where two of their parts touch, what has slid between them pulls back, up to Coulomb's limit.
//!
//! Forces, weights and normals are those at the start of a step, as for the body: within a step the energy is then one of positions
//! alone. What is held between two primitives is remembered while they touch, and forgotten when they part.

use std::collections::BTreeMap;

use super::distance::Primitives;
use super::friction::{Friction, Hold, across};
use crate::cloth::part::Part;
use geom::V3;
use linalg::Contact4;

geom::constants! {
    "contact.rub",
    /// Greatest displacement of two layers that stick, m: a light contact is held no more stiffly than that takes.
    const SLIP_M: f64 = 2e-4;
    /// Greatest stiffness of a sticking contact over that of the layers' push.
    const TANGENTIAL_SHARE: f64 = 0.3;
}

/// Two primitives that push each other.
pub struct Pressed {
    /// A vertex and a triangle, or two edges.
    pub primitives: Primitives,
    /// Weights of their vertices; they sum to zero.
    pub weights: [f64; 4],
    /// Unit vector from the second to the first.
    pub normal: V3,
    /// With what they push, N.
    pub force_n: f64,
    /// Stiffness of the push over its softest, N/m.
    pub stiffness_n_m: f64,
}

/// A contact as seen at the start of a step.
struct Touch {
    pressed: Pressed,
    hold: Hold,
    /// What had slid by then, less where it was, m: the slip at `x` is `sum w x` and this, across the normal.
    before: V3,
}

/// Friction between layers of one cloth.
pub struct Rub {
    /// Coulomb coefficients of the vertices; that of two is their mean.
    coefficients: Vec<f64>,
    is_fast: bool,
    /// How far what touched is from where it is held, m.
    held: BTreeMap<Primitives, V3>,
    touching: Vec<Touch>,
}

impl Rub {
    /// Friction with a Coulomb coefficient of each vertex, from where the cloth now lies.
    #[must_use]
    pub fn new(coefficients: Vec<f64>) -> Self {
        Self { coefficients, is_fast: false, held: BTreeMap::new(), touching: Vec::new() }
    }

    /// The friction of a part of the cloth.
    #[must_use]
    pub fn part(&self, part: &Part) -> Self {
        let renamed = |primitives: Primitives| primitives.renamed(|vertices| part.names(vertices));
        let held = self.held.iter().filter_map(|(primitives, held)| Some((renamed(*primitives)?, *held)));
        let coefficients = part.of(&self.coefficients);
        Self { coefficients, is_fast: self.is_fast, held: held.collect(), touching: Vec::new() }
    }

    /// Takes over how a part has come to be held; `renamed` calls its primitives as they are called here.
    pub fn take(&mut self, part: &Self, renamed: impl Fn(Primitives) -> Option<Primitives>) {
        self.held.extend(part.held.iter().filter_map(|(primitives, held)| Some((renamed(*primitives)?, *held))));
    }

    /// From now on everything is held, whatever that takes.
    pub fn hold_fast(&mut self) {
        self.is_fast = true;
    }

    /// Begins a step from `x`, where these primitives push each other.
    pub fn begin(&mut self, x: &[V3], pressed: impl Iterator<Item = Pressed>) {
        self.touching.clear();
        for pressed in pressed {
            // The first vertex is of the one primitive, the last of the other.
            let [one, _, _, other] = pressed.primitives.vertices().map(|v| self.coefficients[v]);
            let limit_n = 0.5 * (one + other) * pressed.force_n;
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

    /// Ends a step at `x`: what has slid is held from there.
    pub fn end(&mut self, x: &[V3]) {
        for touch in &self.touching {
            self.held.insert(touch.pressed.primitives, touch.friction(x).held);
        }
    }

    /// Energy at `x`, J.
    #[must_use]
    pub fn energy(&self, x: &[V3]) -> f64 {
        self.touching.iter().map(|touch| touch.friction(x).energy_j).sum()
    }

    /// Adds the forces at `x` and the stiffness.
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
    /// The vector between its nearest points at the start of the step, as its vertices carry them to `x`.
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

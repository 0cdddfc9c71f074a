//! The forces on a cloth, their energy and their stiffness, gathered from every source.

use nalgebra::{Matrix2, Matrix3};

use super::linear::LinearSolver;
use super::operator::{Contact4, Operator};
use crate::geom::V3;
use crate::sim::cloth::Cloth;
use crate::sim::cloth::membrane::Foreseen;
use crate::sim::contact::{BodyContact, ClothContact};
use crate::sim::sewing::Springs;
use crate::sim::walls::Walls;

/// Standard gravity, m/s2.
const GRAVITY: f64 = 9.80665;

/// Stiffness that holds a vertex, N/m: beyond that of any fabric by six orders.
const HELD_STIFFNESS: f64 = 1e10;

/// Penalty of walls, N/m3.
const WALL_STIFFNESS: f64 = 1e5;

/// A cloth with everything that acts on it.
pub struct System<'a> {
    /// The cloth.
    pub cloth: &'a Cloth,
    /// Weight of each vertex, N.
    pub weights: Vec<f64>,
    /// Contact with the body.
    pub contact: BodyContact<'a>,
    /// Contact of the cloth with itself.
    pub self_contact: Option<ClothContact<'a>>,
    /// Seam springs, until the seams are welded.
    pub springs: Option<Springs>,
    /// Walls between the cloth of limbs, until the seams are welded.
    pub walls: Option<Walls>,
    /// Vertices that do not move.
    pub held: Vec<usize>,
    /// Solver of the linear systems; remembers factors from step to step.
    pub linear: LinearSolver,
}

impl<'a> System<'a> {
    /// A cloth under gravity and body contact. While seams are open it weighs nothing: a dress would fall off the shoulders
    /// before they are closed, or not, as the springs happen to pull.
    #[must_use]
    pub fn new(cloth: &'a Cloth, contact: BodyContact<'a>, springs: Option<Springs>) -> Self {
        let gravity = if springs.is_some() { 0.0 } else { GRAVITY };
        let weights = cloth.masses.iter().map(|m| m * gravity).collect();
        Self {
            cloth,
            weights,
            contact,
            self_contact: None,
            springs,
            walls: None,
            held: Vec::new(),
            linear: LinearSolver::default(),
        }
    }

    /// Mean weight of a vertex, N: the yardstick of the residual.
    #[must_use]
    pub fn mean_weight(&self) -> f64 {
        self.cloth.masses.iter().sum::<f64>() * GRAVITY / self.cloth.len() as f64
    }

    /// Potential energy, J.
    #[must_use]
    pub fn energy(&self, x: &[V3]) -> f64 {
        let height: f64 = self.weights.iter().zip(x).map(|(w, p)| w * p.z).sum();
        height
            + self.cloth.membrane.energy(x)
            + self.cloth.bending.energy(x)
            + self.cloth.bands.energy(x)
            + self.contact.energy(x)
            + self.self_contact.as_ref().map_or(0.0, |c| c.energy(x))
            + self.springs.as_ref().map_or(0.0, |s| s.energy(x))
            + self
                .trespasses(x)
                .map(|(v, depth, _)| 0.5 * WALL_STIFFNESS * self.cloth.areas[v] * depth * depth)
                .sum::<f64>()
    }

    /// Forces at `x`, N, with the contacts found at the last [`System::assemble`].
    #[must_use]
    pub fn forces(&self, x: &[V3]) -> Vec<V3> {
        let (mut forces, _) = self.contact_forces(x);
        forces.iter_mut().zip(&self.weights).for_each(|(f, w)| f.z -= w);
        self.cloth.membrane.add_forces(x, &mut forces);
        self.cloth.bending.add_forces(x, &mut forces);
        self.cloth.bands.add_forces(x, &mut forces);
        if let Some(springs) = &self.springs {
            springs.assemble(x, &mut forces);
        }
        self.held.iter().for_each(|&v| forces[v] = V3::zeros());
        forces
    }

    /// Forces (N) and stiffness (N/m) at `x`; `predicted` are the membrane stresses that stiffen the cloth geometrically,
    /// where they are not those at `x` ([`Membrane::assemble`](crate::sim::cloth::membrane::Membrane::assemble)).
    pub fn assemble(&mut self, x: &[V3], predicted: Option<&[Matrix2<f64>]>) -> (Vec<V3>, Operator<'a>) {
        let cloth = self.cloth;
        let mut forces: Vec<V3> = self.weights.iter().map(|w| V3::new(0.0, 0.0, -w)).collect();
        let mut diagonal = vec![Matrix3::zeros(); cloth.len()];
        let mut membrane = cloth.membrane.assemble(x, &mut forces, predicted);
        cloth.bending.add_forces(x, &mut forces);
        cloth.bands.add_forces(x, &mut forces);
        cloth.bands.add_stiffness(x, &cloth.membrane.pairs, &mut membrane);
        let mut contacts = self.contact.assemble(x, &mut forces, &mut diagonal);
        let springs = self.springs.as_ref().map_or_else(Vec::new, |s| s.assemble(x, &mut forces));
        if let Some(c) = &mut self.self_contact {
            c.update(x);
            contacts.extend(c.assemble(x, &mut forces));
        }
        for (v, depth, back) in self.trespasses(x) {
            let stiffness = WALL_STIFFNESS * cloth.areas[v];
            forces[v] += back * (stiffness * depth);
            diagonal[v] += back * back.transpose() * stiffness;
        }
        for &v in &self.held {
            forces[v] = V3::zeros();
            diagonal[v] += Matrix3::identity() * HELD_STIFFNESS;
        }
        let operator = Operator {
            diagonal,
            membrane_pairs: &cloth.membrane.pairs,
            membrane,
            bending_pairs: &cloth.bending.pairs,
            bending: &cloth.bending.entries,
            springs,
            contacts,
        };
        (forces, operator)
    }

    /// Forces (N) by which stretching and contact at the end of a step `d` from `x` differ from what a linear solve at `x`
    /// foresaw, and the stiffness (N/m) there, without the geometric part of stretching and with contacts at either end of the
    /// step: those that it makes would throw their vertices out by centimetres if they had a force there and no stiffness. Bending
    /// is foreseen exactly: it is linear. `operator` is that of [`System::assemble`] at `x`, `membrane` what it foresees.
    pub fn excess(&self, operator: Operator<'a>, x: &[V3], d: &[V3], membrane: &[Foreseen]) -> (Vec<V3>, Operator<'a>) {
        let end: Vec<V3> = x.iter().zip(d).map(|(p, d)| p + d).collect();
        let (mut excess, meeting) = self.contact_forces(&end);
        let foreseen = self.contact_forces(x).0.into_iter().zip(operator.contact_forces(d)).map(|(f, kd)| f - kd);
        excess.iter_mut().zip(foreseen).for_each(|(e, f)| *e -= f);
        let mut blocks = self.cloth.membrane.assemble_towards(&end, membrane, &mut excess);
        self.cloth.bands.assemble_towards(x, &end, operator.membrane_pairs, &mut excess, &mut blocks);
        for &v in &self.held {
            excess[v] = V3::zeros();
        }
        let Operator { mut diagonal, mut contacts, .. } = operator;
        contacts.extend(self.contact.stiffen(&end, &mut diagonal));
        contacts.extend(meeting);
        (excess, Operator { diagonal, contacts, membrane: blocks, ..operator })
    }

    /// Share of these displacements that may be gone in the step that was assembled last.
    #[must_use]
    pub fn free_share(&self, displacements: &[V3]) -> f64 {
        self.self_contact.as_ref().map_or(f64::INFINITY, |contact| contact.free_share(displacements))
    }

    /// Vertices on the wrong side of a wall, how far, m, and the way back.
    fn trespasses(&self, x: &[V3]) -> impl Iterator<Item = (usize, f64, V3)> {
        let walls = self.walls.iter();
        walls.flat_map(|walls| x.iter().enumerate().filter_map(|(v, p)| walls.trespass(v, p).map(|(d, n)| (v, d, n))))
    }

    /// Forces of contacts and walls, N, with the contacts found at the last [`System::assemble`], and the stiffness of those of the cloth
    /// with itself.
    fn contact_forces(&self, x: &[V3]) -> (Vec<V3>, Vec<Contact4>) {
        let mut forces = vec![V3::zeros(); x.len()];
        self.contact.add_forces(x, &mut forces);
        for (v, depth, back) in self.trespasses(x) {
            forces[v] += back * (WALL_STIFFNESS * self.cloth.areas[v] * depth);
        }
        let contacts = self.self_contact.as_ref().map_or_else(Vec::new, |contact| contact.assemble(x, &mut forces));
        (forces, contacts)
    }
}

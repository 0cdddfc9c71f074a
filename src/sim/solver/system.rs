//! The forces on a cloth, their energy and their stiffness, gathered from every source.

use nalgebra::Matrix3;
use wide::f32x4;

use super::braces::Braces;
use crate::cloth::Cloth;
use crate::cloth::bending::Bending;
use crate::cloth::law::Tensor;
use crate::cloth::membrane::{Bowed, Foreseen, Membrane};
use crate::cloth::part::Part;
use crate::contact::{BodyContact, ClothContact};
use crate::cover::Cover;
use crate::sewing::Springs;
use crate::walls::Walls;
use geom::V3;
use geom::units::GRAVITY;
use linalg::PairList;
use linalg::linear::LinearSolver;
use linalg::operator::{ArcStiffness, Operator};
use linalg::quad::Block;

geom::constants! {
    "solver.system",
    /// Stiffness that holds a vertex, N/m: beyond that of any fabric by six orders.
    const HELD_STIFFNESS: f64 = 1e10;
    /// Penalty of walls, N/m3.
    const WALL_STIFFNESS: f64 = 1e5;
}

/// What acts on a cloth somewhere.
pub struct Assembled<'a> {
    /// Potential energy, J.
    pub energy: f64,
    /// Force on each vertex, N.
    pub forces: Vec<V3>,
    /// What contacts and walls have of them, N.
    pub contact_forces: Vec<V3>,
    /// Stiffness, N/m.
    pub operator: Operator<'a>,
}

/// What a linear solve did not foresee of the end of a step.
pub struct Excess<'a> {
    /// Forces there that it did not foresee, N.
    pub forces: Vec<V3>,
    /// Stiffness there, N/m.
    pub operator: Operator<'a>,
    /// The stresses of the membrane that it foresaw.
    pub foreseen: Vec<Foreseen>,
}

/// A cloth with everything that acts on it.
pub struct System<'a> {
    /// Masses, areas and elastic energies of the cloth.
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
    /// What is worn over the cloth, which keeps within it.
    pub cover: Option<&'a Cover>,
    /// What holds the cloth up by its top edge.
    pub braces: Option<Braces>,
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
            cover: None,
            braces: None,
            held: Vec::new(),
            linear: LinearSolver::default(),
        }
    }

    /// Switches friction on with the coefficients of the cloth. Anchors are set where it now lies.
    pub fn set_friction(&mut self) {
        let frictions = &self.cloth.frictions;
        self.contact.set_friction(frictions.iter().map(|friction| friction.body));
        if let Some(contact) = &mut self.self_contact {
            contact.set_friction(frictions.iter().map(|friction| friction.cloth));
        }
    }

    /// From now on friction holds everything, whatever that takes. What has slid lies just at its limit: a small move the one way would be
    /// held there, and the other way not.
    pub fn hold_fast(&mut self) {
        self.contact.hold_fast();
        self.self_contact.iter_mut().for_each(ClothContact::hold_fast);
    }

    /// Sets where friction holds the cloth after a step has been taken to `x`: what has slid is held from there.
    pub fn drag_anchors(&mut self, x: &[V3]) {
        self.contact.drag_anchors(x);
        self.self_contact.iter_mut().for_each(|contact| contact.drag_anchors(x));
    }

    /// Takes over where friction has come to hold a part of the cloth.
    pub fn take_anchors(&mut self, part: &Part, alone: &System) {
        self.contact.take_anchors(part, &alone.contact);
        if let (Some(contact), Some(of_part)) = (&mut self.self_contact, &alone.self_contact) {
            contact.take_anchors(part, of_part);
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
        let (stretched_j, bent_j) = (self.cloth.membrane.energy(x), self.cloth.bending.energy(x));
        let pressed_j = self.self_contact.as_ref().map_or(0.0, |c| c.energy(x));
        self.energy_but(x, [stretched_j, bent_j, self.contact.energy(x), pressed_j])
    }

    /// Potential energy of which those of membrane, bending, body contact and self-contact are known, J.
    fn energy_but(&self, x: &[V3], [stretched_j, bent_j, touching_j, pressed_j]: [f64; 4]) -> f64 {
        let height: f64 = self.weights.iter().zip(x).map(|(w, p)| w * p.z).sum();
        let trespass = |(v, depth, _): (usize, f64, V3)| 0.5 * WALL_STIFFNESS * self.cloth.areas[v] * depth * depth;
        let sewn_j = self.springs.as_ref().map_or(0.0, |s| s.energy(x));
        let walls_j: f64 = self.trespasses(x).map(trespass).sum();
        let braced_j = self.braces.as_ref().map_or(0.0, |b| b.energy(x));
        height
            + stretched_j
            + bent_j
            + self.cloth.bands.energy(x)
            + touching_j
            + pressed_j
            + sewn_j
            + walls_j
            + braced_j
    }

    /// Forces at `x`, N, with the contacts found at the last [`System::assemble`].
    #[must_use]
    pub fn forces(&self, x: &[V3]) -> Vec<V3> {
        let mut forces = vec![V3::zeros(); x.len()];
        self.add_outer_forces(x, &mut forces);
        forces.iter_mut().zip(&self.weights).for_each(|(f, w)| f.z -= w);
        self.cloth.add_forces(x, &mut forces);
        if let Some(springs) = &self.springs {
            springs.assemble(x, &mut forces);
        }
        self.held.iter().for_each(|&v| forces[v] = V3::zeros());
        forces
    }

    /// Adds the forces of contacts, walls and braces at `x`, N, with the contacts found at the last [`System::assemble`].
    pub fn add_outer_forces(&self, x: &[V3], forces: &mut [V3]) {
        self.contact.add_forces(x, forces);
        if let Some(contact) = &self.self_contact {
            contact.assemble(x, forces);
        }
        self.add_walls(x, forces);
        self.braces.iter().for_each(|b| b.add_forces(x, forces));
    }

    /// What acts on the cloth at `x`; `predicted` are the membrane stresses that stiffen the cloth geometrically, where they are not
    /// those at `x` ([`Membrane::assemble`](crate::cloth::membrane::Membrane::assemble)).
    pub fn assemble(&mut self, x: &[V3], predicted: Option<&[Tensor]>) -> Assembled<'a> {
        let cloth = self.cloth;
        if let Some(c) = &mut self.self_contact {
            c.update(x);
        }
        let mut contact_forces = vec![V3::zeros(); x.len()];
        let mut diagonal = vec![Matrix3::zeros(); cloth.len()];
        let (touching_j, mut contacts) = self.contact.assemble(x, &mut contact_forces, &mut diagonal);
        contacts.extend(self.self_contact.iter().flat_map(|c| c.assemble(x, &mut contact_forces)));
        let pressed_j = self.self_contact.as_ref().map_or(0.0, |c| c.pressed_energy(x));
        for (v, depth, back) in self.trespasses(x) {
            let stiffness = WALL_STIFFNESS * cloth.areas[v];
            contact_forces[v] += back * (stiffness * depth);
            diagonal[v] += back * back.transpose() * stiffness;
        }
        if let Some(braces) = &self.braces {
            braces.add_forces(x, &mut contact_forces);
            braces.add_stiffness(&mut diagonal);
        }
        let mut forces = contact_forces.clone();
        forces.iter_mut().zip(&self.weights).for_each(|(f, w)| f.z -= w);
        let mut membrane = cloth.membrane.blocks();
        let (stretched_j, bowed) = cloth.membrane.assemble(x, &mut forces, predicted, &mut membrane);
        let bent_j = cloth.bending.assemble(x, &mut forces);
        let (bending_pairs, bending) = self.bending(&mut membrane);
        cloth.bands.add_forces(x, &mut forces);
        cloth.bands.add_stiffness(x, &cloth.membrane.pairs, &mut membrane);
        let springs = self.springs.as_ref().map_or_else(Vec::new, |s| s.assemble(x, &mut forces));
        for &v in &self.held {
            forces[v] = V3::zeros();
            diagonal[v] += Matrix3::identity() * HELD_STIFFNESS;
        }
        let energy = self.energy_but(x, [stretched_j, bent_j, touching_j, pressed_j]);
        let operator = Operator {
            diagonal,
            membrane_pairs: &cloth.membrane.pairs,
            membrane,
            bending_pairs,
            bending,
            springs,
            contacts,
            arcs: stiffness(cloth, x, bowed),
        };
        Assembled { energy, forces, contact_forces, operator }
    }

    /// What a linear solve at `x` did not foresee of stretching and contact at the end of a step `d`. The stiffness there is
    /// without the geometric part of stretching and with contacts at either end of the step: those that it makes would throw their
    /// vertices out by centimetres if they had a force there and no stiffness. Bending is left as foreseen: it is linear, and hinges one by one are near enough to it.
    /// `start` is what acts at `x`, without inertia.
    pub fn excess(&self, start: &Assembled<'a>, x: &[V3], d: &[V3]) -> Excess<'a> {
        let end: Vec<V3> = x.iter().zip(d).map(|(p, d)| p + d).collect();
        let operator = &start.operator;
        let foreseen = start.contact_forces.iter().zip(operator.contact_forces(d)).map(|(f, kd)| kd - f);
        let mut forces: Vec<V3> = foreseen.collect();
        let (mut diagonal, mut contacts) = (operator.diagonal.clone(), operator.contacts.clone());
        contacts.extend(self.contact.meet(&end, &mut forces, &mut diagonal));
        contacts.extend(self.self_contact.iter().flat_map(|contact| contact.assemble(&end, &mut forces)));
        self.add_walls(&end, &mut forces);
        self.braces.iter().for_each(|b| b.add_forces(&end, &mut forces));
        let mut membrane = self.cloth.membrane.blocks();
        let (foreseen, bowed) = self.cloth.membrane.assemble_towards(x, d, &mut forces, &mut membrane);
        self.cloth.bands.assemble_towards(x, &end, operator.membrane_pairs, &mut forces, &mut membrane);
        self.bending(&mut membrane);
        for &v in &self.held {
            forces[v] = V3::zeros();
        }
        let arcs = stiffness(self.cloth, &end, bowed);
        let springs = operator.springs.clone();
        let operator = Operator { diagonal, contacts, membrane, springs, arcs, ..*operator };
        Excess { forces, operator, foreseen }
    }

    /// Bending as linear solves take it: adds what it has in the membrane's blocks, and returns the pairs that it couples besides, with
    /// their entries, N/m. An exact solver takes it whole.
    fn bending(&self, membrane: &mut [Block<f32x4>]) -> (&'a PairList, &'a [f64]) {
        let Bending { pairs, entries, tangent } = &self.cloth.bending;
        if self.linear.is_exact() {
            return (pairs, entries);
        }
        tangent.add_along(membrane);
        (&tangent.pairs, &tangent.across)
    }

    /// Share of these displacements that may be gone in the step that was assembled last.
    #[must_use]
    pub fn free_share(&self, displacements: &[V3]) -> f64 {
        self.self_contact.as_ref().map_or(f64::INFINITY, |contact| contact.free_share(displacements))
    }

    /// Adds the forces of walls, N.
    fn add_walls(&self, x: &[V3], forces: &mut [V3]) {
        for (v, depth, back) in self.trespasses(x) {
            forces[v] += back * (WALL_STIFFNESS * self.cloth.areas[v] * depth);
        }
    }

    /// Vertices on the wrong side of a wall or of what covers them, how far, m, and the way back.
    fn trespasses(&self, x: &[V3]) -> impl Iterator<Item = (usize, f64, V3)> {
        let beyond = move |(v, p): (usize, &V3)| {
            let walls = self.walls.iter().filter_map(move |walls| walls.trespass(v, p));
            let covers = self.cover.iter().filter_map(move |cover| cover.trespass(v, p));
            walls.chain(covers).map(move |(depth, back)| (v, depth, back)).collect::<Vec<_>>()
        };
        let is_free = self.walls.is_none() && self.cover.is_none();
        x.iter().enumerate().filter(move |_| !is_free).flat_map(beyond)
    }
}

/// Stiffness of arcs at `x`.
fn stiffness<'a>(cloth: &'a Cloth, x: &[V3], bowed: Bowed) -> Option<ArcStiffness<'a>> {
    let Membrane { arcs, pairs, sides, .. } = &cloth.membrane;
    let Bowed { bent, tensions, couplings } = bowed;
    (!arcs.most.is_empty()).then(|| ArcStiffness {
        pairs,
        stencils: &arcs.stencils,
        triangles: sides,
        chords: pairs.pairs().iter().map(|&[i, j]| x[j] - x[i]).collect(),
        drawn: tensions.iter().zip(&bent.rates).map(|(tension, rate)| 0.5 * tension * rate).collect(),
        slopes: bent.slopes,
        couplings,
    })
}

/// Root mean square length of the vectors.
#[must_use]
pub fn rms(vectors: &[V3]) -> f64 {
    (vectors.iter().map(V3::norm_squared).sum::<f64>() / vectors.len().max(1) as f64).sqrt()
}

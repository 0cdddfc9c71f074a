//! Energy, forces and stiffness of a cloth with all its loads and contacts.

use nalgebra::Matrix3;
use wide::f32x4;

use super::braces::Braces;
use crate::cloth::Cloth;
use crate::cloth::bending::Bending;
use crate::cloth::element::Foreseen;
use crate::cloth::law::Tensor;
use crate::cloth::membrane::{Bowed, Membrane};
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
    /// Stiffness that holds a vertex, N/m. Six orders of magnitude above that of any fabric.
    const HELD_STIFFNESS: f64 = 1e10;
    /// Penalty stiffness `k` of walls and covers, N/m3. The energy of a vertex with the area `A` at the depth `d` is `k
    /// A d^2 / 2`, J.
    const WALL_STIFFNESS: f64 = 1e5;
}

pub struct Assembled<'a> {
    /// Potential energy, J.
    pub energy: f64,
    /// N.
    pub forces: Vec<V3>,
    /// Part of the forces that comes from contacts, walls and braces, N.
    pub contact_forces: Vec<V3>,
    /// Stiffness, N/m.
    pub operator: Operator<'a>,
}

/// Forces at the end of a step that its linear solve did not predict, with the stiffness there.
pub struct Excess<'a> {
    /// N.
    pub forces: Vec<V3>,
    /// Stiffness at the end, N/m.
    pub operator: Operator<'a>,
    pub foreseen: Vec<Foreseen>,
}

/// Cloth with its loads, contacts and constraints.
pub struct System<'a> {
    pub cloth: &'a Cloth,
    /// N.
    pub weights: Vec<f64>,
    pub contact: BodyContact<'a>,
    pub self_contact: Option<ClothContact<'a>>,
    /// Until the seams are welded.
    pub springs: Option<Springs>,
    /// Between the cloth of limbs, until the seams are welded.
    pub walls: Option<Walls>,
    /// Garment worn over the cloth, which keeps within it.
    pub cover: Option<&'a Cover>,
    /// Hold the cloth by its top edge.
    pub braces: Option<Braces>,
    pub held: Vec<usize>,
    /// Keeps factors from step to step.
    pub linear: LinearSolver,
}

struct KnownEnergies {
    membrane_j: f64,
    bending_j: f64,
    contact_j: f64,
    self_contact_j: f64,
}

struct Trespass {
    vertex: usize,
    depth_m: f64,
    /// Unit direction back.
    back: V3,
}

impl<'a> System<'a> {
    /// Cloth with open seams is weightless: a dress could fall off the shoulders before they are closed, depending on
    /// the pull of the springs.
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

    /// Switches friction on. Anchors are set at the present position.
    pub fn set_friction(&mut self) {
        let frictions = &self.cloth.frictions;
        self.contact.set_friction(frictions.iter().map(|friction| friction.body));
        if let Some(contact) = &mut self.self_contact {
            contact.set_friction(frictions.iter().map(|friction| friction.cloth));
        }
    }

    /// Makes friction hold all contacts from now on, whatever the force. Contacts that have slid are just at their
    /// Coulomb limit: they would be held in one direction only.
    pub fn hold_fast(&mut self) {
        self.contact.hold_fast();
        self.self_contact.iter_mut().for_each(ClothContact::hold_fast);
    }

    pub fn drag_anchors(&mut self, x: &[V3]) {
        self.contact.drag_anchors(x);
        self.self_contact.iter_mut().for_each(|contact| contact.drag_anchors(x));
    }

    pub fn take_anchors(&mut self, part: &Part, alone: &System) {
        self.contact.take_anchors(part, &alone.contact);
        if let (Some(contact), Some(of_part)) = (&mut self.self_contact, &alone.self_contact) {
            contact.take_anchors(part, of_part);
        }
    }

    /// N: the unit of the residual.
    pub fn mean_weight(&self) -> f64 {
        self.cloth.masses.iter().sum::<f64>() * GRAVITY / self.cloth.len() as f64
    }

    /// J.
    pub fn energy(&self, x: &[V3]) -> f64 {
        let (membrane_j, bending_j) = (self.cloth.membrane.energy(x), self.cloth.bending.energy(x));
        let self_contact_j = self.self_contact.as_ref().map_or(0.0, |c| c.energy(x));
        self.total_energy(x, KnownEnergies { membrane_j, bending_j, contact_j: self.contact.energy(x), self_contact_j })
    }

    /// J, given those of its parts that are known.
    fn total_energy(&self, x: &[V3], known: KnownEnergies) -> f64 {
        let KnownEnergies { membrane_j, bending_j, contact_j, self_contact_j } = known;
        let height: f64 = self.weights.iter().zip(x).map(|(w, p)| w * p.z).sum();
        let trespass =
            |Trespass { vertex, depth_m, .. }| 0.5 * WALL_STIFFNESS * self.cloth.areas[vertex] * depth_m * depth_m;
        let sewn_j = self.springs.as_ref().map_or(0.0, |s| s.energy(x));
        let walls_j: f64 = self.trespasses(x).map(trespass).sum();
        let braced_j = self.braces.as_ref().map_or(0.0, |b| b.energy(x));
        height
            + membrane_j
            + bending_j
            + self.cloth.bands.energy(x)
            + contact_j
            + self_contact_j
            + sewn_j
            + walls_j
            + braced_j
    }

    /// N, with the friction contacts and near pairs of the last [`System::assemble`].
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

    /// Adds the forces of contacts, walls and braces, N, with the friction contacts and near pairs of the last
    /// [`System::assemble`].
    pub fn add_outer_forces(&self, x: &[V3], forces: &mut [V3]) {
        self.contact.add_forces(x, forces);
        if let Some(contact) = &self.self_contact {
            contact.assemble(x, forces);
        }
        self.add_walls(x, forces);
        self.braces.iter().for_each(|b| b.add_forces(x, forces));
    }

    /// `predicted` are the membrane stresses of the geometric stiffness, if not those at `x`
    /// ([`Membrane::assemble`](crate::cloth::membrane::Membrane::assemble)).
    pub fn assemble(&mut self, x: &[V3], predicted: Option<&[Tensor]>) -> Assembled<'a> {
        let cloth = self.cloth;
        if let Some(c) = &mut self.self_contact {
            c.update(x);
        }
        let mut contact_forces = vec![V3::zeros(); x.len()];
        let mut diagonal = vec![Matrix3::zeros(); cloth.len()];
        let (contact_j, mut contacts) = self.contact.assemble(x, &mut contact_forces, &mut diagonal);
        contacts.extend(self.self_contact.iter().flat_map(|c| c.assemble(x, &mut contact_forces)));
        let self_contact_j = self.self_contact.as_ref().map_or(0.0, |c| c.pressed_energy(x));
        for Trespass { vertex, depth_m, back } in self.trespasses(x) {
            let stiffness = WALL_STIFFNESS * cloth.areas[vertex];
            contact_forces[vertex] += back * (stiffness * depth_m);
            diagonal[vertex] += back * back.transpose() * stiffness;
        }
        if let Some(braces) = &self.braces {
            braces.add_forces(x, &mut contact_forces);
            braces.add_stiffness(&mut diagonal);
        }
        let mut forces = contact_forces.clone();
        forces.iter_mut().zip(&self.weights).for_each(|(f, w)| f.z -= w);
        let mut membrane = cloth.membrane.blocks();
        let (membrane_j, bowed) = cloth.membrane.assemble(x, &mut forces, predicted, &mut membrane);
        let bending_j = cloth.bending.assemble(x, &mut forces);
        let (bending_pairs, bending) = self.bending(&mut membrane);
        cloth.bands.add_forces(x, &mut forces);
        cloth.bands.add_stiffness(x, &cloth.membrane.pairs, &mut membrane);
        let springs = self.springs.as_ref().map_or_else(Vec::new, |s| s.assemble(x, &mut forces));
        for &v in &self.held {
            forces[v] = V3::zeros();
            diagonal[v] += Matrix3::identity() * HELD_STIFFNESS;
        }
        let energy = self.total_energy(x, KnownEnergies { membrane_j, bending_j, contact_j, self_contact_j });
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

    /// Forces of stretching and contact at the end of a step `d` from `x`, in excess of those that the linear solve at
    /// `x` predicted. `start` is the system at `x`, without inertia.
    ///
    /// The stiffness is without the geometric part of stretching, and has the contacts at both ends of the step.
    /// Contacts that the step makes need their stiffness: with a force alone they would throw their vertices out by
    /// centimetres. Bending is left as predicted: it is linear, and the independent hinges of the linear solve are
    /// close enough to it.
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

    /// Adds the entries along sides to the blocks of the membrane, and returns the pairs coupled besides, with their
    /// entries, N/m. An exact solver takes the true stiffness of bending.
    fn bending(&self, membrane: &mut [Block<f32x4>]) -> (&'a PairList, &'a [f64]) {
        let Bending { pairs, entries, tangent } = &self.cloth.bending;
        if self.linear.is_exact() {
            return (pairs, entries);
        }
        tangent.add_along(membrane);
        (&tangent.pairs, &tangent.across)
    }

    /// Share of these displacements that the step assembled last may take before unknown pairs can meet.
    pub fn free_share(&self, displacements: &[V3]) -> f64 {
        self.self_contact.as_ref().map_or(f64::INFINITY, |contact| contact.free_share(displacements))
    }

    fn add_walls(&self, x: &[V3], forces: &mut [V3]) {
        for Trespass { vertex, depth_m, back } in self.trespasses(x) {
            forces[vertex] += back * (WALL_STIFFNESS * self.cloth.areas[vertex] * depth_m);
        }
    }

    fn trespasses(&self, x: &[V3]) -> impl Iterator<Item = Trespass> {
        let beyond = move |(v, p): (usize, &V3)| {
            let walls = self.walls.iter().filter_map(move |walls| walls.trespass(v, p));
            let covers = self.cover.iter().filter_map(move |cover| cover.trespass(v, p));
            walls.chain(covers).map(move |(depth_m, back)| Trespass { vertex: v, depth_m, back }).collect::<Vec<_>>()
        };
        let is_free = self.walls.is_none() && self.cover.is_none();
        x.iter().enumerate().filter(move |_| !is_free).flat_map(beyond)
    }
}

/// `None` where sides are chords.
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

pub fn rms(vectors: &[V3]) -> f64 {
    (vectors.iter().map(V3::norm_squared).sum::<f64>() / vectors.len().max(1) as f64).sqrt()
}

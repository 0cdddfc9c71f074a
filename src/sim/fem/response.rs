//! Sensitivity of a drape at rest to a small change of its pattern.
//!
//! In equilibrium the forces vanish, `f(x, X) = 0`, for every pattern `X`. By the implicit function theorem a change
//! `dX` moves the cloth by `dx` with `K dx = df/dX dX`. `K = -df/dx` is the tangent stiffness ([`Tangent`]). It is
//! factorised once, and each change takes one solve. The derivative of any measurement follows along `dx`. A pattern
//! has fewer handles than a drape has measurements, so this direct method takes fewer solves than the adjoint method,
//! and no derivative by hand.
//!
//! The active set of contacts is kept: the same layers touch, and friction that holds goes on holding. A change that
//! slides cloth or lifts it off the body needs another drape.

use super::dress::TIGHT_M;
use super::params::Params;
use super::run::Simulation;
use super::settle::{Around, Grip, Settling};
use crate::cloth::Cloth;
use crate::contact::Skin;
use crate::solver::System;
use crate::solver::system::rms;
use crate::{Fabric, Silent, SimError, sewing};
use geom::units::GRAVITY;
use geom::{DistanceField, V3};
use linalg::PairList;
use linalg::tangent::Tangent;
use pattern::Garment;

geom::constants! {
    "fem.response",
    /// Step of the differences by which the stiffness is found: contacts stiffen over tenths of a millimetre.
    const STEP_M: f64 = 1e-7;
    /// Residual at which a drape counts as wholly at rest.
    const AT_REST: f64 = 1e-8;
    /// Greatest number of Newton steps, and of shares of a step that are tried.
    const NEWTON_STEPS: usize = 30;
    const SHARES: [f64; 6] = [1.0, 0.5, 0.25, 0.1, 0.03, 0.01];
    /// Greatest number of steps that may leave a greater residual.
    const SETBACKS: usize = 5;
    /// Diagonal shift of an indefinite stiffness, which ties vertices to their places: the first that is tried, and the
    /// last. Twice the stiffness of the stiffest cloth is enough.
    const LEAST_TIE_N_M: f64 = 0.01;
    const MOST_TIE_N_M: f64 = 1e5;
}

#[derive(Clone, Copy)]
pub struct Lying<'a> {
    /// `None` where the body bounds no solid.
    pub skin: Option<&'a Skin<'a>>,
    pub field: &'a DistanceField,
    /// As [`floor_m`](super::floor_m).
    pub floor_m: f64,
    pub garment: &'a Garment,
    pub fabric: &'a Fabric,
    pub params: &'a Params,
    /// True if friction holds it; without friction it has slid to where it rests.
    pub is_held: bool,
}

/// Drape in equilibrium, with its tangent stiffness.
pub struct Response<'a> {
    fabric: &'a Fabric,
    system: System<'a>,
    tangent: Tangent,
    x: Vec<V3>,
    residual: f64,
}

impl<'a> Response<'a> {
    /// Brings a drape from `positions` into equilibrium. `cloth` is its garment, sewn ([`sewn`]).
    pub fn of(lying: Lying<'a>, cloth: &'a Cloth, positions: &[V3]) -> Result<Self, SimError> {
        let Lying { skin, field, floor_m, garment, fabric, params, is_held } = lying;
        let Params { contact, self_contact, .. } = *params;
        let around = Around { skin, field, floor_m, hands: None, contact, self_contact };
        let taken_up = |around| {
            let settling = Settling { around, garment, cloth, level: 0, grip: Grip::AtTheEnd };
            let mut x = cloth.weld(positions);
            let system = settling.taken_up(&mut x, is_held, &mut Simulation::new(params, &mut Silent, 0))?;
            Ok((system, x))
        };
        let (mut system, mut x) = taken_up(around)?;
        if system.contact.yields_m(&x) > TIGHT_M {
            (system, x) = taken_up(around.hardened())?;
        }
        system.assemble(&x, None);
        system.hold_fast();
        let (tangent, residual) = rest(&system, &mut x);
        Ok(Self { fabric, system, tangent, x, residual })
    }

    pub fn positions(&self) -> Vec<V3> {
        self.system.cloth.unweld(&self.x)
    }

    /// Rms force over mean vertex weight.
    pub fn residual(&self) -> f64 {
        self.residual
    }

    /// True if the tangent stiffness is positive definite. An unstable drape is about to fold in another way, and its
    /// derivatives mean little.
    pub fn is_stable(&self) -> bool {
        self.tangent.is_definite()
    }

    /// Displacements of the garment's vertices per unit of a change, from its mesh half a `unit` before and after.
    /// Fails where the stiffness is singular.
    pub fn rates(&self, [before, after]: [&Garment; 2], unit: f64) -> Result<Vec<V3>, SimError> {
        let forces = |garment: &Garment| Ok(pulls(&sewn(garment, self.fabric)?, &self.x));
        let (before, after) = (forces(before)?, forces(after)?);
        let pushed: Vec<V3> = after.iter().zip(&before).map(|(after, before)| (after - before) / unit).collect();
        let moved = self.tangent.solve(&pushed).ok_or(SimError::Singular)?;
        Ok(self.system.cloth.unweld(&moved))
    }

    /// Positions in which the vertices of a changed pattern come to rest with the contacts as they stand, and the
    /// residual there. Fails where the stiffness is singular.
    pub fn again(&self, garment: &Garment) -> Result<(Vec<V3>, f64), SimError> {
        let cloth = sewn(garment, self.fabric)?;
        let mut x = self.x.clone();
        let weight = self.system.mean_weight();
        for _ in 0..NEWTON_STEPS {
            let forces = forces(&self.system, &cloth, &x);
            let residual = rms(&forces) / weight;
            if residual < AT_REST {
                break;
            }
            let step = self.tangent.solve(&forces).ok_or(SimError::Singular)?;
            x.iter_mut().zip(step).for_each(|(p, d)| *p += d);
        }
        let residual = rms(&forces(&self.system, &cloth, &x)) / weight;
        Ok((self.system.cloth.unweld(&x), residual))
    }
}

pub fn sewn(garment: &Garment, fabric: &Fabric) -> Result<Cloth, SimError> {
    Cloth::new(garment, fabric, sewing::welded(garment))
}

fn pulls(cloth: &Cloth, x: &[V3]) -> Vec<V3> {
    let mut forces: Vec<V3> = cloth.masses.iter().map(|mass| V3::new(0.0, 0.0, -mass * GRAVITY)).collect();
    cloth.add_forces(x, &mut forces);
    forces
}

fn forces(system: &System, cloth: &Cloth, x: &[V3]) -> Vec<V3> {
    let mut forces = pulls(cloth, x);
    system.add_outer_forces(x, &mut forces);
    forces
}

fn couplings(system: &System, x: &[V3]) -> PairList {
    let cloth = system.cloth;
    let among = |vertices: Vec<usize>| {
        let after = |i: usize| vertices[i + 1..].iter().map(|w| [vertices[i], *w]).collect::<Vec<_>>();
        (0..vertices.len()).flat_map(after).filter(|[v, w]| v != w).collect::<Vec<_>>()
    };
    let arcs = &cloth.membrane.arcs;
    let patch = |(triangle, sides): (&[usize; 3], &[u32; 3])| {
        let mut vertices = triangle.to_vec();
        let bowed = sides.iter().filter(|side| (**side as usize) < arcs.most.len());
        vertices.extend(bowed.flat_map(|side| arcs.of(*side as usize).map(|(v, _)| v)));
        vertices.sort_unstable();
        vertices.dedup();
        among(vertices)
    };
    let patches = cloth.triangles.iter().zip(&cloth.membrane.sides).flat_map(patch);
    // Contact points with the body lie within triangles, whose vertices are coupled already.
    let mut unused = vec![V3::zeros(); x.len()];
    let layers = system.self_contact.iter().flat_map(|contact| contact.assemble(x, &mut unused)).collect::<Vec<_>>();
    let touching = layers.iter().flat_map(|contact| among(contact.vertices.to_vec()));
    PairList::new(patches.chain(cloth.bending.pairs.pairs().iter().copied()).chain(touching))
}

struct Iterate {
    x: Vec<V3>,
    forces: Vec<V3>,
    residual: f64,
    tangent: Tangent,
    is_tied: bool,
}

impl Iterate {
    fn at(system: &System, x: Vec<V3>) -> Self {
        let acting = |x: &[V3]| forces(system, system.cloth, x);
        let forces = acting(&x);
        let tangent = Tangent::of(&couplings(system, &x), &x, STEP_M, acting);
        Self { residual: rms(&forces) / system.mean_weight(), x, forces, tangent, is_tied: false }
    }

    /// Stable iterates come first, then the least residual.
    fn rank(&self) -> (bool, f64) {
        (!self.tangent.is_definite(), self.residual)
    }

    /// Positions after the next Newton step, and true where they are better. An indefinite stiffness is shifted until
    /// it is definite, and the energy decides; else the residual does.
    fn next(&mut self, system: &System) -> Option<(Vec<V3>, bool)> {
        let is_stable = self.tangent.is_definite();
        let mut tie = LEAST_TIE_N_M;
        while !self.tangent.is_definite() && tie < MOST_TIE_N_M {
            self.tangent.tie(tie);
            self.is_tied = true;
            tie *= 4.0;
        }
        let step = self.tangent.solve(&self.forces)?;
        let energy = system.energy(&self.x);
        let mut best: Option<(f64, Vec<V3>)> = None;
        for share in SHARES {
            let there: Vec<V3> = self.x.iter().zip(&step).map(|(p, d)| p + d * share).collect();
            let (worth, own) = if is_stable {
                (rms(&forces(system, system.cloth, &there)) / system.mean_weight(), self.residual)
            } else {
                (system.energy(&there), energy)
            };
            if worth < own {
                return Some((there, true));
            }
            if worth.is_finite() && best.as_ref().is_none_or(|(least, _)| worth < *least) {
                best = Some((worth, there));
            }
        }
        best.map(|(_, there)| (there, false))
    }
}

/// Brings cloth into equilibrium by Newton's method. Returns its tangent stiffness and the residual. Where layers come
/// to touch a step may raise the residual: a few such steps are taken, and the best iterate is kept.
fn rest(system: &System, x: &mut Vec<V3>) -> (Tangent, f64) {
    let mut now = Iterate::at(system, x.clone());
    let mut rank = now.rank();
    let mut setbacks = 0;
    for _ in 0..NEWTON_STEPS {
        if now.residual <= AT_REST && now.tangent.is_definite() {
            break;
        }
        let Some((next, is_nearer)) = now.next(system) else { break };
        setbacks += usize::from(!is_nearer);
        if setbacks > SETBACKS {
            break;
        }
        now = Iterate::at(system, next);
        if now.rank() < rank {
            rank = now.rank();
            x.clone_from(&now.x);
        }
    }
    let best = if now.x == *x && !now.is_tied { now } else { Iterate::at(system, x.clone()) };
    (best.tangent, best.residual)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fabric;
    use crate::fem::{level_edges, simulate};
    use body::{Measurements, Sex};
    use geom::V2;
    use pattern::draft::Model;
    use pattern::{Handle, Style};

    #[test]
    fn a_drape_answers_as_its_differences_do() {
        const TAKEN_M: f64 = 1e-4;
        const STEP: f64 = 1e-6;
        let body = body::build(&Measurements::of(Sex::Male, 1.76)).expect("a body");
        let field = DistanceField::build(&body.mesh, 0.01).expect("a solid");
        let medium = &Model::Tshirt.drafts()[1];
        let style = Style::read(&medium.pieces, Model::Tshirt.seams(), "tshirt.seams.toml").expect("sound");
        let meshes: Vec<Garment> =
            level_edges(0.05).into_iter().map(|edge_m| style.mesh(edge_m).expect("it meshes")).collect();
        let (cotton, params) = (&fabric::library()[0], Params::default());
        let drape = simulate(&body, &field, &meshes, cotton, &params, &mut Silent).expect("it drapes");
        let garment = &meshes[meshes.len() - 1];
        let cloth = sewn(garment, cotton).expect("sound");
        let skin = Skin::new(&body.mesh).ok();
        for is_held in [true, false] {
            let lying = Lying {
                skin: skin.as_ref(),
                field: &field,
                floor_m: 0.0,
                garment,
                fabric: cotton,
                params: &params,
                is_held,
            };
            let response = Response::of(lying, &cloth, &drape.positions).expect("it lies");
            assert!(response.is_stable() && response.residual() < 1e-7, "{is_held}: {}", response.residual());
            for handle in [Handle::Hem, Handle::FrontLength, Handle::ShoulderSlope] {
                let taken = |by_m: f64| style.moved_mesh(garment, handle, by_m).expect("it moves").rest;
                let (more, less) = (taken(TAKEN_M), taken(-TAKEN_M));
                let moved_by = |by: f64| {
                    let way = |v: usize| (more[v] - less[v]) / (2.0 * TAKEN_M);
                    garment.with_rest((0..more.len()).map(|v| garment.rest[v] + way(v) * by).collect::<Vec<V2>>())
                };
                let [before, after] = [-STEP, STEP].map(moved_by);
                let rates = response.rates([&before, &after], 2.0 * STEP).expect("regular");
                let [(before, _), (after, _)] = [&before, &after].map(|mesh| response.again(mesh).expect("regular"));
                let ways = || after.iter().zip(&before).map(|(after, before)| (after - before) / (2.0 * STEP));
                let off: Vec<V3> = rates.iter().zip(ways()).map(|(rate, way)| rate - way).collect();
                let way = rms(&ways().collect::<Vec<V3>>());
                assert!(rms(&off) < 1e-3 * way && way > 0.02, "{handle:?}, {is_held}: {} of {way}", rms(&off));
            }
        }
    }
}

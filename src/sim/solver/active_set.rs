//! Active set: steps of only that part of a cloth which still moves.
//!
//! Late in a drape folds snap one after another, while 99 vertices in 100 move by less than a tenth of a millimetre.
//! After a step that has moved a small part only, that part takes some steps by itself, held by the vertices around it.
//! Their cost is that of its size. The next step of the whole cloth takes up the change.

use super::proximal::{StepInfo, StepParams, Stepper};
use super::system::System;
use crate::cloth::Cloth;
use crate::cloth::law::Tensor;
use crate::cloth::part::Part;
use geom::V3;

geom::constants! {
    "solver.active_set",
    const MOVING_SHARE: f64 = 0.1;
    const MARGIN_EDGES: usize = 4;
    const MOST_SHARE: f64 = 0.25;
    const LEAST_VERTICES: usize = 1000;
    /// Steps of a part before the whole cloth steps again.
    const MOST_STEPS: usize = 6;
    /// Free path below which a part stops: near pairs can then be missing, and have to be searched in the whole cloth.
    const LEAST_PATH_M: f64 = 1e-3;
    /// Residual that ends the steps of a part, as a share of that which ends the drape.
    const TOLERANCE_SHARE: f64 = 0.5;
}

impl Stepper {
    /// Takes one step, unless the residual is already at most `tolerance`. If it has moved only a small part of the
    /// cloth, that part then takes some more. Returns the residual before the step and its length.
    pub fn step(&mut self, system: &mut System, x: &mut Vec<V3>, tolerance: f64) -> StepInfo {
        let info = self.step_whole(system, x, tolerance);
        let has_settled = info.residual > tolerance && self.h_s >= self.params.h_max_s;
        let moving = self.last.as_ref().filter(|_| has_settled).and_then(|moved| moving(system, moved));
        if let (Some(moving), Some(predicted)) = (moving, &mut self.predicted) {
            relax(system, x, &moving, predicted, self.params, tolerance);
            self.last = None;
        }
        info
    }
}

/// Marks the vertices that `moved`, with a margin; `None` unless they are few and can be stepped by themselves.
fn moving(system: &System, moved: &[V3]) -> Option<Vec<bool>> {
    let is_whole = moved.len() < LEAST_VERTICES
        || system.springs.is_some()
        || system.walls.is_some()
        || system.cover.is_some()
        || system.braces.is_some()
        || !system.held.is_empty()
        || system.linear.is_exact()
        || system.self_contact.as_ref().is_some_and(|contact| !contact.is_untangled());
    if is_whole {
        return None;
    }
    let farthest_m = moved.iter().map(V3::norm).fold(0.0, f64::max);
    let mut is_moving: Vec<bool> = moved.iter().map(|d| d.norm() > MOVING_SHARE * farthest_m).collect();
    for _ in 0..MARGIN_EDGES {
        let inner = is_moving.clone();
        for &[i, j] in system.cloth.membrane.pairs.pairs() {
            is_moving[i] |= inner[j];
            is_moving[j] |= inner[i];
        }
    }
    let count = is_moving.iter().filter(|moves| **moves).count();
    (0 < count && (count as f64) < MOST_SHARE * moved.len() as f64).then_some(is_moving)
}

/// Steps the `free` vertices until their residual would be low enough for the whole cloth, or for a few steps. Updates
/// the `predicted` stresses.
fn relax(
    system: &mut System,
    x: &mut [V3],
    free: &[bool],
    predicted: &mut [Tensor],
    params: StepParams,
    tolerance: f64,
) {
    if let Some(contact) = &mut system.self_contact {
        contact.update(x);
    }
    let partners: Vec<usize> = system.self_contact.iter().flat_map(|contact| contact.partners(free)).collect();
    let part = Part::new(system.cloth, free, &partners);
    let (cloth, elements) = system.cloth.part(&part);
    let mut own = part.of(x);
    let mut alone = alone(system, &part, &cloth, &own);
    let mut stepper = Stepper::going_on(params, elements.iter().map(|&t| predicted[t]).collect());
    // A force gives a greater root mean square among fewer vertices.
    let of_all = (x.len() as f64 / cloth.len() as f64).sqrt() * system.mean_weight() / alone.mean_weight();
    let enough = TOLERANCE_SHARE * tolerance * of_all;
    for _ in 0..MOST_STEPS {
        let info = stepper.step_whole(&mut alone, &mut own, enough);
        let must_be_seen = alone.self_contact.as_mut().is_some_and(|contact| {
            contact.update(&own);
            contact.touches() || contact.free_path_m() < LEAST_PATH_M
        });
        if info.residual <= enough || info.alpha == 0.0 || must_be_seen {
            break;
        }
    }
    for ((&v, p), _) in part.vertices.iter().zip(&own).zip(&part.is_free).filter(|(_, is_free)| **is_free) {
        x[v] = *p;
    }
    elements.iter().zip(stepper.predicted()).for_each(|(&t, stress)| predicted[t] = *stress);
    system.take_anchors(&part, &alone);
}

fn alone<'c>(system: &System<'c>, part: &Part, cloth: &'c Cloth, own: &[V3]) -> System<'c> {
    let mut alone = System::new(cloth, system.contact.part(part), None);
    alone.weights = part.of(&system.weights);
    alone.self_contact = system.self_contact.as_ref().map(|contact| contact.part(part, own));
    alone.held = (0..cloth.len()).filter(|&v| !part.is_free[v]).collect();
    alone
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::{BodyContact, ClothContact, ClothContactParams, ContactParams};
    use crate::laboratory::{self, sheets};
    use crate::sewing::unsewn;
    use crate::testing::fabric;
    use geom::{DistanceField, V2, shapes};
    use pattern::garment::{Band, Reinforcement};

    const EDGE_M: f64 = 0.01;

    fn folded() -> (Cloth, Vec<V3>) {
        let mut garment = laboratory::garment(sheets::sheet(40, 40, EDGE_M));
        let band =
            Reinforcement { band: Band::Rib, stiffness_n: 25.0, length_factor: 0.9, vertices: (0..41).collect() };
        garment.reinforcements.push(band);
        let fold = |p: &V2| {
            let over = p.y - 0.2;
            if over > 0.0 { V3::new(p.x, 0.2 - over, 1e-3_f64.min(over)) } else { V3::new(p.x, p.y, 0.0) }
        };
        let x = garment.rest.iter().map(|p| fold(p) - V3::new(0.2, 0.1, 0.0)).collect();
        (Cloth::new(&garment, &fabric(), unsewn(&garment)).expect("sound"), x)
    }

    fn near(x: &[V3], middle: V3, radius_m: f64) -> Vec<bool> {
        x.iter().map(|p| (p - middle).norm() < radius_m).collect()
    }

    #[test]
    fn a_part_has_the_forces_and_the_energy_of_the_whole() {
        let (cloth, flat) = folded();
        let ball = shapes::sphere(0.06, 24);
        let field = DistanceField::build(&ball, 0.006).expect("a closed ball");
        // Its top pokes 0.3 mm through the lower layer.
        let flat: Vec<V3> = flat.iter().map(|p| p + V3::new(0.0, 0.0, 0.0597)).collect();
        let mut system = System::new(&cloth, BodyContact::new(&field, ContactParams::default(), &cloth.areas), None);
        // A contact has areas of its own.
        let areas: Vec<f64> = cloth.areas.iter().map(|area| 0.3 * area).collect();
        system.self_contact = Some(ClothContact::new(ClothContactParams::default(), &cloth.triangles, &areas));
        system.contact.set_friction(std::iter::repeat_n(0.3, cloth.len()));
        system.assemble(&flat, None);
        for middle in [V3::new(0.0, 0.0, 0.06), V3::new(0.0, -0.1, 0.06)] {
            let free = near(&flat, middle, 0.04);
            let partners: Vec<usize> = system.self_contact.iter().flat_map(|contact| contact.partners(&free)).collect();
            let part = Part::new(&cloth, &free, &partners);
            let (own_cloth, _) = cloth.part(&part);
            let mut alone = alone(&system, &part, &own_cloth, &part.of(&flat));
            alone.assemble(&part.of(&flat), None);
            let shaken = sheets::shaken(&flat, 2e-4, 5);
            let x: Vec<V3> = (0..flat.len()).map(|v| if free[v] { shaken[v] } else { flat[v] }).collect();
            assert!(system.contact.count() > 0);
            let risen = system.energy(&x) - system.energy(&flat);
            let own_risen = alone.energy(&part.of(&x)) - alone.energy(&part.of(&flat));
            assert!((own_risen / risen - 1.0).abs() < 1e-9, "{own_risen} for {risen}");
            let (whole, own) = (system.forces(&x), alone.forces(&part.of(&x)));
            let greatest = whole.iter().map(V3::norm).fold(0.0, f64::max);
            for (name, &v) in part.vertices.iter().enumerate().filter(|(name, _)| part.is_free[*name]) {
                assert!((whole[v] - own[name]).norm() < 1e-9 * greatest, "{v}: {} for {}", own[name], whole[v]);
            }
        }
    }

    #[test]
    fn what_was_pulled_about_comes_to_rest_by_itself_and_nothing_else_moves() {
        let (cloth, flat) = folded();
        let field = laboratory::nowhere();
        let mut system = System::new(&cloth, BodyContact::new(&field, ContactParams::default(), &cloth.areas), None);
        system.self_contact = Some(ClothContact::new(ClothContactParams::default(), &cloth.triangles, &cloth.areas));
        system.weights.fill(0.0);
        let pulled = near(&flat, V3::zeros(), 0.02);
        let shaken = sheets::shaken(&flat, 1e-4, 5);
        let mut x: Vec<V3> = (0..flat.len()).map(|v| if pulled[v] { shaken[v] } else { flat[v] }).collect();
        let moved: Vec<V3> = x.iter().zip(&flat).map(|(p, q)| p - q).collect();
        system.assemble(&x, None);
        let free = moving(&system, &moved).expect("a small part");
        assert!(pulled.iter().zip(&free).all(|(pulled, free)| !pulled || *free));
        let (start, rest) = (x.clone(), system.energy(&flat));
        let before = system.energy(&x) - rest;
        let mut predicted = vec![Tensor::default(); cloth.triangles.len()];
        relax(&mut system, &mut x, &free, &mut predicted, StepParams::default(), 0.01);
        let after = system.energy(&x) - rest;
        assert!(after < 0.1 * before, "{after} after {before}");
        assert!((0..x.len()).all(|v| free[v] || x[v] == start[v]));
        // Where all of the cloth moves, or vertices are held, no part is stepped by itself.
        assert!(moving(&system, &vec![V3::x(); x.len()]).is_none());
        system.held.push(0);
        assert!(moving(&system, &moved).is_none());
    }
}

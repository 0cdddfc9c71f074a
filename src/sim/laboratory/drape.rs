//! Cusick's drape test, in which a round specimen hangs over a smaller disc, and a sheet over a sphere.

use super::Specimen;
use super::sheets::{Flat, disc, shaken, sheet};
use crate::cloth::slack;
use crate::contact::{BodyContact, ClothContact, ClothContactParams, ContactParams};
use crate::solver::{StepParams, Stepper, System};
use crate::{Fabric, SimError};
use geom::{DistanceField, V2, V3};

geom::constants! {
    "laboratory.drape",
    const SPECIMEN_M: f64 = 0.15;
    const DISC_M: f64 = 0.09;
}

pub struct Draped {
    /// Share of the overhanging ring that the shadow of the specimen covers, 0 to 1.
    pub coefficient: f64,
    /// Folds, counted as upward crossings of the mean height along the rim.
    pub nodes: usize,
    pub residual: f64,
    /// In order.
    pub rim: Vec<V3>,
}

/// The specimen is slack at first, as garments are. `number` selects the noise from which it starts.
pub fn cusick(fabric: &Fabric, rings: usize, number: u64) -> Result<Draped, SimError> {
    let seed = 17 + 100 * number;
    let (flat, carried_m) = carried(rings);
    let specimen = Specimen::new(flat, fabric, |p| V3::new(p.x, p.y, 0.0))?;
    let mut specimen = specimen.hold(|p| p.norm() < carried_m + 1e-9);
    // Folds need a perturbation to start from: noise of the height of a hundredth of a ring.
    let start = shaken(&specimen.positions, 0.01 * SPECIMEN_M / rings as f64, seed);
    for v in (0..start.len()).filter(|v| !specimen.held.contains(v)) {
        specimen.positions[v].z = start[v].z;
    }
    let stiff = specimen.cloth.clone();
    for share in slack::shares(fabric, SPECIMEN_M - DISC_M) {
        specimen.cloth = stiff.clone().slackened(share);
        specimen.rest(1.0, 0.1, 400);
    }
    specimen.cloth = stiff;
    let residual = specimen.rest(1.0, 0.02, 400);
    let rim: Vec<V3> = specimen.positions[specimen.positions.len() - 6 * rings..].to_vec();
    let shadow = 0.5 * (0..rim.len()).map(|i| cross(&rim[i].xy(), &rim[(i + 1) % rim.len()].xy())).sum::<f64>();
    let area = |radius: f64| std::f64::consts::PI * radius * radius;
    let mean = rim.iter().map(|p| p.z).sum::<f64>() / rim.len() as f64;
    let rises = |i: &usize| rim[*i].z < mean && rim[(i + 1) % rim.len()].z >= mean;
    Ok(Draped {
        coefficient: (shadow - area(DISC_M)) / (area(SPECIMEN_M) - area(DISC_M)),
        nodes: (0..rim.len()).filter(rises).count(),
        residual,
        rim,
    })
}

/// Mesh of a specimen, and the radius of the part that the disc holds, m. The last row of hinges in the held part
/// stands for half a row on either side, so it lies half a row beyond the disc.
fn carried(rings: usize) -> (Flat, f64) {
    let share = DISC_M / SPECIMEN_M;
    let held = (share * rings as f64 + 0.5).round();
    let row_m = (SPECIMEN_M - DISC_M) / (rings as f64 - held + 0.5);
    let carried_m = DISC_M + 0.5 * row_m;
    let (mut rest, triangles) = disc(rings, rings as f64);
    for p in &mut rest {
        let ring = p.norm();
        let radius_m = if ring <= held { ring * carried_m / held } else { carried_m + (ring - held) * row_m };
        *p *= radius_m / ring.max(1.0);
    }
    ((rest, triangles), carried_m)
}

pub struct OverSphere {
    pub residual: f64,
    pub steps: usize,
    pub positions: Vec<V3>,
}

/// Lays a square metre of a fabric, 71 x 71 vertices, flat on a sphere of radius 0.3 m and brings it to rest, with
/// friction and self-contact: to a residual of 1 % or for 600 steps. A scene on which other simulators are timed.
pub fn over_sphere(fabric: &Fabric, sphere: &DistanceField) -> Result<OverSphere, SimError> {
    let (cells, radius) = (70, 0.3);
    let params = ContactParams::default();
    let place = |p: &V2| V3::new(p.x - 0.5, p.y - 0.5, radius + params.offset_m);
    let Specimen { cloth, mut positions, .. } = Specimen::new(sheet(cells, cells, 1.0 / cells as f64), fabric, place)?;
    let mut contact = BodyContact::new(sphere, params, &cloth.areas);
    contact.set_friction(std::iter::repeat_n(fabric.friction_body, cloth.len()));
    let mut system = System::new(&cloth, contact, None);
    system.self_contact = Some(ClothContact::new(ClothContactParams::default(), &cloth.triangles, &cloth.areas));
    // It falls by half a metre. So steps are as long as contact allows, and their correction gets more iterations.
    let far = StepParams { clamp_m: 0.03, correction_iterations: 12, ..StepParams::default() };
    let mut stepper = Stepper::new(far);
    let (mut residual, mut steps) = (f64::MAX, 0);
    while residual > 0.01 && steps < 600 {
        residual = stepper.step(&mut system, &mut positions, 0.01).residual;
        steps += 1;
    }
    Ok(OverSphere { residual, steps, positions })
}

fn cross(a: &V2, b: &V2) -> f64 {
    a.perp(b)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fabric;

    #[test]
    fn a_specimen_hangs_alike_whatever_noise_it_starts_from() {
        let broad = fabric::library().into_iter().find(|f| f.name == "cotton_broad").expect("in the library");
        let found = [0, 1, 2].map(|number| cusick(&broad, 12, number).expect("a sound mesh"));
        for other in &found {
            assert!((other.coefficient - found[0].coefficient).abs() < 0.02 && other.nodes == found[0].nodes);
        }
    }
}

//! Phase 4: drape (5.5), short, on the fine mesh, keeping the restored size.
//!
//! Contact first pushes the cloth out of the body wherever it is inside. Then its pressure is capped at what a little
//! stretch of the cloth round a trunk can bear: where the pattern is large enough, far less is needed and nothing changes; where
//! it is too small the body wins no more, the cloth goes back to its size and into the body, and the gap map shows by how much.

use super::elastic::{Elastic, Pull};
use super::popup::{self, CONTROL_WIDTH_M};
use super::sewn::Sewn;
use crate::geom::{DistanceField, V3};
use crate::pattern::{Garment, Measurement};
use crate::sim::cloth::Cloth;
use crate::sim::{Fabric, SimError};

/// Parameters of the drape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DrapeParams {
    /// Steps in which contact pushes without limit.
    pub push_steps: u32,
    /// Steps in which its pressure is capped.
    pub yield_steps: u32,
    /// Distance from the skin at which cloth is pushed, m.
    pub offset_m: f64,
    /// Membrane stiffness that gravity and bending are set against, N/m. Higher than any cloth's at rest: size is kept.
    pub stiffness_n_m: f64,
    /// Weight of contact, per area and over the stiffness, 1/m2.
    pub contact: f64,
    /// Weight of a free vertex's last place, likewise: how far a step goes.
    pub hold: f64,
    /// Stretch that contact may cause where the pattern is too small.
    pub yield_stretch: f64,
    /// Radius of the body part at which that holds, m.
    pub yield_radius_m: f64,
    /// Bending rigidity at least, N m: keeps folds wider than the mesh.
    pub least_bending_nm: f64,
    /// Steps between two looks at who is in contact.
    pub refresh: u32,
}

impl Default for DrapeParams {
    fn default() -> Self {
        Self {
            push_steps: 20,
            yield_steps: 20,
            offset_m: 2e-3,
            stiffness_n_m: 500.0,
            contact: 100.0,
            hold: 1.0,
            yield_stretch: 5e-3,
            yield_radius_m: 0.15,
            least_bending_nm: 5e-5,
            refresh: 4,
        }
    }
}

/// Standard gravity, m/s2.
const GRAVITY: f64 = 9.80665;

/// Drapes a popped-up garment; calls `each` after every step with the positions and the rms movement of that step, m.
///
/// # Errors
/// [`SimError::Degenerate`], and those of `each`.
pub fn drape(
    field: &DistanceField,
    garment: &Garment,
    sewn: &Sewn,
    x: Vec<V3>,
    fabric: &Fabric,
    controls: &[&Measurement],
    params: &DrapeParams,
    mut each: impl FnMut(&[V3], f64) -> Result<(), SimError>,
) -> Result<Vec<V3>, SimError> {
    let stiff = Fabric {
        bending_warp_nm: fabric.bending_warp_nm.max(params.least_bending_nm),
        bending_weft_nm: fabric.bending_weft_nm.max(params.least_bending_nm),
        ..fabric.clone()
    };
    let cloth = Cloth::new(garment, &stiff, sewn.vertex_of.clone())?;
    let bending: Vec<([usize; 2], f64)> = cloth
        .bending
        .pairs
        .pairs()
        .iter()
        .zip(&cloth.bending.entries)
        .map(|(p, e)| (*p, e / params.stiffness_n_m))
        .collect();
    let areas = popup::areas(garment, sewn);
    let loads: Vec<V3> = cloth.masses.iter().map(|m| V3::new(0.0, 0.0, -m * GRAVITY / params.stiffness_n_m)).collect();
    let weights = |x: &[V3]| -> Vec<f64> {
        let touches = |p: &V3| field.value_and_gradient(p).0 < params.offset_m;
        let weight = |(p, a): (&V3, &f64)| a * if touches(p) { params.contact } else { params.hold };
        x.iter().zip(&areas).map(weight).collect()
    };
    let degenerate = || SimError::Degenerate { piece: garment.name.clone(), at: garment.rest[0] };
    let mut elastic = Elastic::new(garment, &sewn.vertex_of, &x, controls, CONTROL_WIDTH_M, &bending, weights(&x))
        .ok_or_else(degenerate)?;
    // The depth at which contact bears what the cloth may be stretched by: T / R = weight * depth.
    let cap_m = params.yield_stretch / params.yield_radius_m / params.contact;
    let mut x = x;
    for step in 0..params.push_steps + params.yield_steps {
        if step > 0 && step % params.refresh == 0 {
            elastic.set_weights(weights(&x));
        }
        let most_m = if step < params.push_steps { f64::MAX } else { cap_m };
        let targets: Vec<V3> = x
            .iter()
            .map(|p| {
                let (distance, gradient) = field.value_and_gradient(p);
                let depth = (params.offset_m - distance).max(0.0);
                p + gradient.try_normalize(1e-9).unwrap_or_else(V3::zeros) * depth.min(most_m)
            })
            .collect();
        let next = elastic.step(&x, &Pull { targets: &targets, loads: &loads, share: 1.0 });
        let moved = (next.iter().zip(&x).map(|(a, b)| (a - b).norm_squared()).sum::<f64>() / x.len() as f64).sqrt();
        x = next;
        each(&x, moved)?;
    }
    Ok(x)
}

//! Steps of a sewn garment against a body: its size, gravity, bending, contact.
//!
//! Contact pushes the cloth out of the body, but its pressure can be capped at what a little stretch of the cloth round a
//! trunk can bear. Where the pattern is large enough, far less is needed and nothing changes; where it is too small the body wins
//! no more: the cloth goes back to its size and into the body.

use super::elastic::{Elastic, Pull};
use super::sewn::Sewn;
use crate::geom::{DistanceField, V3};
use crate::pattern::{Garment, Measurement};
use crate::sim::cloth::Cloth;
use crate::sim::{Fabric, SimError};

/// Parameters of the steps of pop-up and drape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RelaxParams {
    /// Distance from the skin at which cloth is pushed, m.
    pub offset_m: f64,
    /// Membrane stiffness that gravity and bending are set against, N/m. Higher than any cloth's at rest: size is kept.
    pub stiffness_n_m: f64,
    /// Weight of contact, per area and over the stiffness, 1/m2.
    pub contact: f64,
    /// Weight of a free vertex's last place, likewise: how far a step goes.
    pub hold: f64,
    /// Weight of a control: that of a strip of cloth this wide along it, m.
    pub control_width_m: f64,
    /// Stretch that capped contact may cause where the pattern is too small.
    pub yield_stretch: f64,
    /// Radius of the body part at which that holds, m.
    pub yield_radius_m: f64,
    /// Bending rigidity at least, N m: keeps folds wider than the mesh.
    pub least_bending_nm: f64,
    /// Steps between two looks at who is in contact.
    pub refresh: u32,
}

impl Default for RelaxParams {
    fn default() -> Self {
        Self {
            offset_m: 2e-3,
            stiffness_n_m: 500.0,
            contact: 100.0,
            hold: 1.0,
            control_width_m: 0.5,
            yield_stretch: 5e-3,
            yield_radius_m: 0.15,
            least_bending_nm: 5e-5,
            refresh: 4,
        }
    }
}

/// Standard gravity, m/s2.
const GRAVITY: f64 = 9.80665;

/// A garment under way from the body's surface to its rest.
pub struct Relaxation<'a> {
    params: RelaxParams,
    field: &'a DistanceField,
    elastic: Elastic,
    /// Rest areas of the sewn vertices, m2.
    areas: Vec<f64>,
    /// Weight of each sewn vertex over the membrane's stiffness, m.
    weight: Vec<f64>,
    /// Position of each sewn vertex, m.
    pub x: Vec<V3>,
    steps: u32,
}

/// What a step does besides keeping size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Push {
    /// Whether contact pushes without limit.
    pub unlimited: bool,
    /// Share of its weight that the cloth has.
    pub gravity: f64,
    /// Size that it wants: 0 as it was sewn, 1 the pattern's.
    pub share: f64,
}

impl<'a> Relaxation<'a> {
    /// Starts from a sewn garment.
    ///
    /// # Errors
    /// [`SimError::Degenerate`].
    pub fn new(
        field: &'a DistanceField,
        garment: &Garment,
        sewn: &Sewn,
        fabric: &Fabric,
        controls: &[&Measurement],
        params: RelaxParams,
    ) -> Result<Self, SimError> {
        let stiff = Fabric {
            bending_warp_nm: fabric.bending_warp_nm.max(params.least_bending_nm),
            bending_weft_nm: fabric.bending_weft_nm.max(params.least_bending_nm),
            ..fabric.clone()
        };
        let cloth = Cloth::new(garment, &stiff, sewn.vertex_of.clone())?;
        let pairs = cloth.bending.pairs.pairs().iter().zip(&cloth.bending.entries);
        let bending: Vec<([usize; 2], f64)> =
            pairs.map(|(pair, entry)| (*pair, entry / params.stiffness_n_m)).collect();
        let weights = weights(field, &params, &cloth.areas, &sewn.x);
        let elastic =
            Elastic::new(garment, &sewn.vertex_of, &sewn.x, controls, params.control_width_m, &bending, weights)
                .ok_or_else(|| SimError::Degenerate { piece: garment.name.clone(), at: garment.rest[0] })?;
        let weight = cloth.masses.iter().map(|m| m * GRAVITY / params.stiffness_n_m).collect();
        Ok(Self { params, field, elastic, areas: cloth.areas, weight, x: sewn.x.clone(), steps: 0 })
    }

    /// Takes one step; returns the rms movement of the vertices, m.
    pub fn step(&mut self, push: Push) -> f64 {
        if self.steps > 0 && self.steps.is_multiple_of(self.params.refresh) {
            self.elastic.set_weights(weights(self.field, &self.params, &self.areas, &self.x));
        }
        self.steps += 1;
        // The depth at which contact bears what the cloth may be stretched by: T / R = weight * depth.
        let cap_m = self.params.yield_stretch / self.params.yield_radius_m / self.params.contact;
        let most_m = if push.unlimited { f64::MAX } else { cap_m };
        let target = |p: &V3| {
            let (distance, gradient) = self.field.value_and_gradient(p);
            let depth = (self.params.offset_m - distance).max(0.0);
            p + gradient.try_normalize(1e-9).unwrap_or_else(V3::zeros) * depth.min(most_m)
        };
        let targets: Vec<V3> = self.x.iter().map(target).collect();
        let loads: Vec<V3> = self.weight.iter().map(|w| V3::new(0.0, 0.0, -w * push.gravity)).collect();
        let next = self.elastic.step(&self.x, &Pull { targets: &targets, loads: &loads, share: push.share });
        let moved = next.iter().zip(&self.x).map(|(a, b)| (a - b).norm_squared()).sum::<f64>();
        self.x = next;
        (moved / self.x.len() as f64).sqrt()
    }
}

/// Weights of the vertices' targets: those in contact stay where contact wants them, the others may go.
fn weights(field: &DistanceField, params: &RelaxParams, areas: &[f64], x: &[V3]) -> Vec<f64> {
    let touches = |p: &V3| field.value_and_gradient(p).0 < params.offset_m;
    let weight = |(p, a): (&V3, &f64)| a * if touches(p) { params.contact } else { params.hold };
    x.iter().zip(areas).map(weight).collect()
}

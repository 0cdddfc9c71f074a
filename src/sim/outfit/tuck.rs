//! Layers that are drawn within the garment that is to be worn over them.

use super::{Joined, Layer, joined};
use crate::contact::{BodyContact, ClothContact, ClothContactParams, ContactParams, contact_areas};
use crate::cover::Cover;
use crate::solver::{StepParams, Stepper, System};
use crate::{Monitor, SimError};
use geom::{DistanceField, V3};
use pattern::Garment;

geom::constants! {
    "outfit.tuck",
    const STEPS: u32 = 120;
    /// Residual at which layers count as within the cover.
    const LIES: f64 = 1.0;
}

/// Draws layers within a cover. Layers of which nothing lies beyond it stay as they are.
pub fn tucked(
    field: &DistanceField,
    layers: &[Layer],
    positions: &[&[V3]],
    cover: Cover,
    monitor: &mut dyn Monitor,
) -> Result<Vec<Vec<V3>>, SimError> {
    let Joined { garments, all: garment, cloth } = joined(layers)?;
    let cover = cover.over(&garment, &cloth.vertex_of);
    let mut x = cloth.weld(&positions.concat());
    let between = ClothContactParams::default();
    let areas = contact_areas(&garment, &cloth.vertex_of, &cloth.areas, 2.0 * between.thickness_m);
    let contact = BodyContact::new(field, ContactParams::default(), &cloth.areas);
    let mut system = System::new(&cloth, contact, None);
    system.self_contact = Some(ClothContact::new(between, &cloth.triangles, areas));
    system.cover = Some(&cover);
    let mut stepper = Stepper::new(StepParams::default());
    let is_pierced = cover.is_pierced(&x);
    for _ in 0..if is_pierced { STEPS } else { 0 } {
        if monitor.cancelled() {
            return Err(SimError::Cancelled);
        }
        if stepper.step(&mut system, &mut x, 0.0).residual < LIES {
            break;
        }
    }
    Ok(parted(&garments, &cloth.unweld(&x)))
}

/// Splits values at the vertices of several garments beside each other.
pub fn parted<T: Copy>(garments: &[&Garment], all: &[T]) -> Vec<Vec<T>> {
    let mut rest = all;
    let own = |garment: &&Garment| {
        let (own, others) = rest.split_at(garment.rest.len());
        rest = others;
        own.to_vec()
    };
    garments.iter().map(own).collect()
}

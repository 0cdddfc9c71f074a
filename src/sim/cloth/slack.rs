//! Slack cloth: shares of its stiffness in the plane with which cloth comes to rest, one after the other, before it has all of it.

use crate::Fabric;
use geom::units::GRAVITY;

geom::constants! {
    "cloth.slack",
    /// By how much the weight that hangs from it stretches slack cloth.
    ///
    /// Cloth that stretches as easily as it bends has one way to lie, or few, and wherever it begins it finds that; stiffened by and by
    /// it goes on from there. Stiff from the start it stays in the folds that it happened to be sewn into.
    const STRETCHES: [f64; 3] = [0.025, 0.008, 0.0012];
}

/// Shares of a fabric's stiffness in the plane, growing, where so much of it hangs; none of 1 and more, as of cloth that stretches as
/// easily as it is.
#[must_use]
pub fn shares(fabric: &Fabric, hanging_m: f64) -> Vec<f64> {
    let Fabric { density_kg_m2, membrane_warp_n_m, membrane_weft_n_m, .. } = *fabric;
    let weight_n_m = density_kg_m2 * GRAVITY * hanging_m;
    let stiffness_n_m = (membrane_warp_n_m * membrane_weft_n_m).sqrt();
    let shares = STRETCHES.map(|stretch| weight_n_m / (stretch * stiffness_n_m));
    shares.into_iter().filter(|share| *share < 1.0).collect()
}

//! Slack cloth: a sequence of reduced membrane stiffnesses with which cloth comes to rest before it has its full
//! stiffness (a continuation method).

use crate::Fabric;
use geom::units::GRAVITY;

geom::constants! {
    "cloth.slack",
    /// Relative elongation of the slack cloth under the weight that hangs from it, for each stage.
    ///
    /// Cloth that stretches as easily as it bends has one equilibrium or few, and reaches it from any start. Stiffened
    /// in stages it follows that equilibrium. Cloth that is stiff from the start keeps the folds that it was sewn into
    /// by chance.
    const STRETCHES: [f64; 3] = [0.025, 0.008, 0.0012];
}

/// Shares of the membrane stiffness for the stages, increasing, for cloth of which a length `hanging_m` hangs. Shares
/// of 1 and more are left out: such a fabric stretches by as much with its full stiffness.
pub fn shares(fabric: &Fabric, hanging_m: f64) -> Vec<f64> {
    let Fabric { density_kg_m2, membrane_warp_n_m, membrane_weft_n_m, .. } = *fabric;
    let weight_n_m = density_kg_m2 * GRAVITY * hanging_m;
    let stiffness_n_m = (membrane_warp_n_m * membrane_weft_n_m).sqrt();
    let shares = STRETCHES.map(|stretch| weight_n_m / (stretch * stiffness_n_m));
    shares.into_iter().filter(|share| *share < 1.0).collect()
}

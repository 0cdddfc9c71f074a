//! Fabrics: areal density, orthotropic membrane, bending, friction.

/// A fabric as the simulators need it; SI units.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Fabric {
    /// Name (`cotton_shirting_light`).
    pub name: String,
    /// Areal density, kg/m2.
    pub density_kg_m2: f64,
    /// Thickness, m.
    pub thickness_m: f64,
    /// Strip modulus along the grain line, N/m.
    pub membrane_warp_n_m: f64,
    /// Strip modulus across the grain line, N/m.
    pub membrane_weft_n_m: f64,
    /// Coupling entry of the membrane matrix, N/m (0 where the moduli are strip moduli).
    #[serde(default)]
    pub membrane_coupling_n_m: f64,
    /// Shear modulus S in `W = S gamma^2 / 2` per area, gamma the full shear angle, N/m.
    pub shear_n_m: f64,
    /// Bending rigidity for a fold that curves the warp, N m.
    pub bending_warp_nm: f64,
    /// Bending rigidity for a fold that curves the weft, N m.
    pub bending_weft_nm: f64,
    /// Coulomb friction against the body.
    pub friction_body: f64,
    /// Coulomb friction of the cloth on itself.
    pub friction_self: f64,
    /// Where the numbers are from.
    pub source: String,
}

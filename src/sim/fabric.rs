//! Fabrics: areal density, orthotropic membrane, bending, friction.

use super::cloth::law::Fibre;

/// Moduli of a knit under stretch, where they differ from those at rest.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Stretched {
    /// Elongation over rest length at which they were measured.
    pub stretch: f64,
    /// Secant modulus along the grain line there, stress over Green strain, N/m.
    pub membrane_warp_n_m: f64,
    /// Secant modulus across the grain line there, N/m.
    pub membrane_weft_n_m: f64,
}

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
    /// Moduli under stretch; without them the law is linear.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stretched: Option<Stretched>,
}

impl Fabric {
    /// The law along the grain line.
    #[must_use]
    pub fn warp_law(&self) -> Fibre {
        let rest = self.membrane_warp_n_m;
        self.stretched.map_or(Fibre::linear(rest), |s| Fibre::stiffening(rest, s.membrane_warp_n_m, s.stretch))
    }

    /// The law across the grain line.
    #[must_use]
    pub fn weft_law(&self) -> Fibre {
        let rest = self.membrane_weft_n_m;
        self.stretched.map_or(Fibre::linear(rest), |s| Fibre::stiffening(rest, s.membrane_weft_n_m, s.stretch))
    }
}

/// The fabrics known by name.
///
/// # Panics
/// Never: the library is part of the program, and a test reads it.
#[must_use]
pub fn library() -> Vec<Fabric> {
    #[derive(serde::Deserialize)]
    struct Library {
        fabric: Vec<Fabric>,
    }
    toml::from_str::<Library>(include_str!("fabrics.toml")).expect("the built-in library is valid").fabric
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_library_is_sound() {
        let library = library();
        for name in ["cotton_shirting_light", "interlock_tshirt", "thesis_10"] {
            assert_eq!(library.iter().filter(|f| f.name == name).count(), 1, "{name}");
        }
        for f in &library {
            let numbers = [f.density_kg_m2, f.thickness_m, f.membrane_warp_n_m, f.membrane_weft_n_m, f.shear_n_m];
            assert!(numbers.iter().all(|n| *n > 0.0), "{}", f.name);
            assert!(f.membrane_coupling_n_m.powi(2) < f.membrane_warp_n_m * f.membrane_weft_n_m, "{}", f.name);
        }
    }
}

//! Fabrics: areal density, orthotropic membrane, bending, friction. The library of known fabrics, with the kind of data
//! behind each.

pub mod weights;

use std::fmt;
use std::sync::LazyLock;

use geom::units::GRAVITY;
use weights::Standing;

/// Secant moduli of a knit under stretch.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Stretched {
    /// Relative elongation at which they were measured.
    pub stretch: f64,
    /// Stress over Green strain along the grain line.
    pub membrane_warp_n_m: f64,
    /// Across the grain line.
    pub membrane_weft_n_m: f64,
}

/// Default fabric.
pub const USUAL: &str = "cotton_shirting_light";

#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Fabric {
    /// Name in the library or the study (`cotton_shirting_light`).
    pub name: String,
    pub density_kg_m2: f64,
    /// Single layer.
    pub thickness_m: f64,
    /// Strip modulus along the grain line.
    pub membrane_warp_n_m: f64,
    /// Strip modulus across the grain line.
    pub membrane_weft_n_m: f64,
    /// 0 where the moduli are strip moduli.
    #[serde(default)]
    pub membrane_coupling_n_m: f64,
    /// Modulus S in `W = S gamma^2 / 2` per area, gamma the full shear angle.
    pub shear_n_m: f64,
    /// Rigidity for a fold that curves the warp.
    pub bending_warp_nm: f64,
    /// Rigidity for a fold that curves the weft.
    pub bending_weft_nm: f64,
    /// Coulomb coefficient.
    pub friction_body: f64,
    pub friction_self: f64,
    pub source: String,
    /// Without them the law is linear.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stretched: Option<Stretched>,
}

impl Fabric {
    /// Along and across the grain line: `(B / (w g))^(1/3)`, half the length of a strip whose chord slopes by 41.5
    /// degrees when it bends under its own weight in a cantilever test [Peirce 1930].
    pub fn bending_lengths_m(&self) -> [f64; 2] {
        [self.bending_warp_nm, self.bending_weft_nm].map(|rigidity| self.bending_length_m(rigidity))
    }

    /// Along and across the grain line, among the known cloths of its weight.
    pub fn standings(&self) -> [Standing; 2] {
        weights::standings(self.density_kg_m2, [self.bending_warp_nm, self.bending_weft_nm])
    }

    /// Bending lengths of the known cloths of its weight: along the grain line from the lowest to the highest
    /// percentile of [`weights::ends`], then across it.
    pub fn scatter_m(&self) -> [[f64; 2]; 2] {
        let [least, most] = weights::ends().map(|end| weights::rigidities(self.density_kg_m2, end));
        [0, 1].map(|side| [least[side], most[side]].map(|rigidity| self.bending_length_m(rigidity)))
    }

    fn bending_length_m(&self, rigidity_nm: f64) -> f64 {
        (rigidity_nm / (self.density_kg_m2 * GRAVITY)).cbrt()
    }

    /// Weight, stretch and bending. Two fabrics that share them are one cloth.
    fn numbers(&self) -> [f64; 7] {
        [
            self.density_kg_m2,
            self.membrane_warp_n_m,
            self.membrane_weft_n_m,
            self.membrane_coupling_n_m,
            self.shear_n_m,
            self.bending_warp_nm,
            self.bending_weft_nm,
        ]
    }

    /// Entry of the library; `None` where the fabric is not in it or its properties were changed.
    pub fn known(&self) -> Option<&'static Known> {
        KNOWN.iter().find(|known| known.fabric.name == self.name && known.fabric.numbers() == self.numbers())
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Kind {
    /// One cloth, whose weight and bending were measured.
    Cloth,
    /// Sort of cloths: the bending is a percentile of the known cloths of that weight.
    Class,
    /// No real cloth: parameters of a computation.
    Model,
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Cloth => "one cloth",
            Self::Class => "class",
            Self::Model => "model",
        })
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Part {
    /// Moduli along and across the grain line.
    Membrane,
    Shear,
}

impl fmt::Display for Part {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Membrane => "membrane",
            Self::Shear => "shear",
        })
    }
}

/// Fabric of the library, with its origin.
#[derive(Clone, Debug)]
pub struct Known {
    pub fabric: Fabric,
    pub kind: Kind,
    /// Properties that were measured on another cloth than bending and weight were.
    pub of_another: Vec<Part>,
}

static KNOWN: LazyLock<Vec<Known>> = LazyLock::new(|| {
    #[derive(serde::Deserialize)]
    struct Library {
        fabric: Vec<Row>,
    }
    let library: Library = toml::from_str(include_str!("fabrics.toml")).expect("the built-in library is valid");
    library.fabric.into_iter().flat_map(Row::read).collect()
});

#[derive(serde::Deserialize)]
struct Row {
    kind: Kind,
    #[serde(default)]
    of_another: Vec<Part>,
    /// For a class: percentile of the rigidity among the cloths of its weight.
    bending_percentile: Option<f64>,
    also: Option<String>,
    #[serde(flatten)]
    numbers: toml::Table,
}

impl Row {
    fn read(self) -> Vec<Known> {
        let Self { kind, of_another, bending_percentile, also, mut numbers } = self;
        if let Some(percentile) = bending_percentile {
            let density = numbers.get("density_kg_m2").and_then(toml::Value::as_float).unwrap_or_default();
            let keys = ["bending_warp_nm", "bending_weft_nm"].into_iter();
            for (key, rigidity) in keys.zip(weights::rigidities(density, percentile)) {
                numbers.insert(key.to_owned(), toml::Value::Float(rigidity));
            }
        }
        let fabric: Fabric = numbers.try_into().expect("the built-in library is valid");
        let renamed = |name| Fabric { source: format!("another name of {}", fabric.name), name, ..fabric.clone() };
        let other = also.map(renamed);
        let known = |fabric| Known { fabric, kind, of_another: of_another.clone() };
        [Some(fabric), other].into_iter().flatten().map(known).collect()
    }
}

pub fn known() -> &'static [Known] {
    &KNOWN
}

pub fn library() -> Vec<Fabric> {
    KNOWN.iter().map(|known| known.fabric.clone()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn by_name(name: &str) -> &'static Known {
        known().iter().find(|known| known.fabric.name == name).unwrap_or_else(|| panic!("{name} is not in the library"))
    }

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
            assert!(!f.source.is_empty(), "{} has no source", f.name);
            assert_eq!(library.iter().filter(|other| other.name == f.name).count(), 1, "{} is there twice", f.name);
        }
    }

    #[test]
    fn a_class_bends_within_its_scatter_and_says_what_it_is() {
        for Known { fabric, kind, of_another } in known() {
            let name = &fabric.name;
            assert_eq!(fabric.known().map(|known| known.kind), Some(*kind), "{name}");
            let changed = Fabric { shear_n_m: 1.5 * fabric.shear_n_m, ..fabric.clone() };
            assert!(changed.known().is_none(), "{name} changed is not of the library");
            if *kind == Kind::Class {
                assert!(of_another.is_empty(), "{name}: a class is of many cloths anyway");
                for (length, [least, most]) in fabric.bending_lengths_m().into_iter().zip(fabric.scatter_m()) {
                    assert!(least < length && length < most, "{name}: {length} between {least} and {most}");
                }
            }
        }
    }

    #[test]
    fn what_a_source_says_of_the_quantile_is_so() {
        let check = |name: &str, warp: &str, weft: &str| {
            assert_eq!(by_name(name).fabric.standings().map(|s| s.to_string()), [warp, weft], "{name}");
        };
        check("cotton_shirting_light", "p50", "p50");
        check("denim_raw", "p75", "p75");
        check("denim_rigid", "p75", "p75");
        check("denim_washed", "p50", "p50");
        check("poplin", "p75", "p75");
        check("viscose", "p25", "p25");
        check("jersey", "p25", "p25");
        check("chiffon", "p25", "p25");
        // Measured cloths on which the percentiles of poplin and jersey are based.
        check("cotton_broad", "p81", ">p90");
        check("interlock_tshirt", "p21", "p17");
    }

    #[test]
    fn cloths_are_as_limp_and_as_stiff_as_each_other_as_they_should_be() {
        let along = |name: &str| 1e3 * by_name(name).fabric.bending_lengths_m()[0];
        for rising in [
            ["viscose", "cotton_shirting_light", "poplin"],
            ["jersey", "cotton_shirting_light", "denim_washed"],
            ["cotton_shirting_light", "denim_washed", "denim_raw"],
            ["silk", "canvas", "wool_coating"],
        ] {
            assert!(rising.windows(2).all(|two| along(two[0]) < along(two[1])), "{rising:?}: {:?}", rising.map(along));
        }
        // The classes lie within the middle eight tenths of all known cloths.
        for known in known().iter().filter(|known| known.kind == Kind::Class) {
            assert!((12.0..31.0).contains(&along(&known.fabric.name)), "{}", known.fabric.name);
        }
    }
}

//! The bench: results of the experiments beside known values, from theory or from a published measurement.

use super::bending::{Bent, Mesh, bent, cantilever, elastica, lateral_buckling};
use super::drape::cusick;
use super::isotropic;
use super::stretch::{hanging_strip, hanging_thread};
use super::touch::{Laid, layer_on_incline, on_incline, pressed_tube};
use crate::fabric::{Part, known, library};
use crate::{Fabric, SimError};

geom::constants! {
    "laboratory.bench",
    const RINGS: usize = 24;
}

/// Takes a friction coefficient and an angle in rad.
type Laying = fn(&Fabric, f64, f64) -> Result<Laid, SimError>;

/// Experiment with a known answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Experiment {
    /// Hangs and stretches under its own weight.
    Strip,
    /// Strip clamped horizontally at one end, which bends under its own weight.
    Cantilever,
    /// Strip clamped on its edge, which buckles laterally under its own weight.
    Buckling,
    /// Sheet bent to a cylinder or a cone.
    Bending,
    Incline,
    Tube,
    Drape,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    pub experiment: Experiment,
    pub case: String,
    /// Compared quantity, with its unit.
    pub quantity: &'static str,
    pub known: f64,
    pub found: f64,
    pub source: String,
}

impl Experiment {
    pub const ALL: [Self; 7] =
        [Self::Strip, Self::Cantilever, Self::Buckling, Self::Bending, Self::Incline, Self::Tube, Self::Drape];

    /// Name in the command line.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Strip => "strip",
            Self::Cantilever => "cantilever",
            Self::Buckling => "buckling",
            Self::Bending => "bending",
            Self::Incline => "incline",
            Self::Tube => "tube",
            Self::Drape => "drape",
        }
    }

    pub fn about(self) -> &'static str {
        match self {
            Self::Strip => "a strip of each fabric hangs by its own weight",
            Self::Cantilever => "a strip is clamped level and bends by its own weight",
            Self::Buckling => "a strip is clamped on edge and buckles sideways",
            Self::Bending => "a sheet is bent about few edges of its mesh",
            Self::Incline => "a sheet lies on a slope, and on another sheet",
            Self::Tube => "a tube is drawn over a cylinder",
            Self::Drape => "a disc of 30 cm hangs over one of 18 cm; no parameter is fitted",
        }
    }

    pub fn run(self) -> Result<Vec<Finding>, SimError> {
        match self {
            Self::Strip => strips(),
            Self::Cantilever => cantilevers(),
            Self::Buckling => buckling(),
            Self::Bending => bending(),
            Self::Incline => inclines(),
            Self::Tube => tubes(),
            Self::Drape => drapes(),
        }
    }

    fn finding(self, case: String, quantity: &'static str, [known, found]: [f64; 2], source: &str) -> Finding {
        Finding { experiment: self, case, quantity, known, found, source: source.to_owned() }
    }
}

impl Finding {
    /// Error with its unit: percentage points for the drape coefficient, degrees for the incline, else percent of the
    /// known value.
    pub fn error(&self) -> (f64, &'static str) {
        match self.experiment {
            Experiment::Drape => (self.found - self.known, "points"),
            Experiment::Incline => (self.found - self.known, "degrees"),
            _ => (100.0 * (self.found / self.known - 1.0), "%"),
        }
    }
}

fn strips() -> Result<Vec<Finding>, SimError> {
    let grown = |fabric: &Fabric| {
        // A strip contracts freely across, and a thread has no width: the coupling is left out.
        let strip = Fabric { membrane_coupling_n_m: 0.0, ..fabric.clone() };
        let lengths_mm = [hanging_thread(&strip, 1.5), hanging_strip(&strip, 1.5, 40)?].map(|m| 1e3 * m);
        let quantity = "growth of 1.5 m, mm";
        Ok(Experiment::Strip.finding(fabric.name.clone(), quantity, lengths_mm, "integral of the law over a thread"))
    };
    library().iter().map(grown).collect()
}

fn cantilevers() -> Result<Vec<Finding>, SimError> {
    let gammas = [0.1, 1.0, 10.0, 100.0, 1000.0];
    let mut findings = Vec::new();
    for mesh in [Mesh::Squares, Mesh::Hexagons, Mesh::Irregular] {
        for (gamma, (drop, _)) in gammas.iter().zip(cantilever(mesh, 96, &gammas)?) {
            let case = format!("{mesh:?}, w g L^3 / B = {gamma}").to_lowercase();
            let both = [elastica(*gamma), drop];
            findings.push(Experiment::Cantilever.finding(case, "drop over reach", both, "elastica"));
        }
    }
    Ok(findings)
}

fn buckling() -> Result<Vec<Finding>, SimError> {
    let both = [12.854 * 2.0_f64.sqrt(), lateral_buckling(3)?];
    Ok(vec![Experiment::Buckling.finding("strip of L / 20".into(), "critical w g L^3 / B", both, "beam theory")])
}

fn bending() -> Result<Vec<Finding>, SimError> {
    let shapes = [2.0, 3.0, 4.0, 8.0].map(Bent::Cylinder).into_iter().chain([Bent::Cone(4.0)]);
    let turned = |shape: Bent| {
        [0.0_f64, 45.0, 90.0].map(|degrees| {
            let energy = bent(shape, degrees.to_radians())?;
            let case = format!("{shape}, {degrees} degrees from the weft");
            Ok(Experiment::Bending.finding(case, "energy over the plate's", [1.0, energy], "thin plate"))
        })
    };
    shapes.flat_map(turned).collect()
}

fn inclines() -> Result<Vec<Finding>, SimError> {
    let sheet = isotropic(0.15, 1000.0, 1e-5);
    let laid: [(&str, Laying); 2] = [("on the body", on_incline), ("on another sheet", layer_on_incline)];
    let steepest = |(on, lay): (&str, Laying), friction: f64| {
        let known = friction.atan().to_degrees();
        let mut held = 0.0;
        for tenths in -20..=20 {
            let degrees = known + 0.1 * f64::from(tenths);
            if lay(&sheet, friction, degrees.to_radians())?.residual > 1e-3 {
                break;
            }
            held = degrees;
        }
        let case = format!("{on}, friction {friction}");
        Ok(Experiment::Incline.finding(case, "steepest slope that holds, degrees", [known, held], "Coulomb"))
    };
    laid.into_iter().flat_map(|on| [0.2, 0.3, 0.5].map(|friction| steepest(on, friction))).collect()
}

fn tubes() -> Result<Vec<Finding>, SimError> {
    let library = library();
    let mut findings = Vec::new();
    for name in ["interlock_tshirt", "rib_knit", "swim_knit", "cotton_shirting_light"] {
        for fabric in library.iter().filter(|f| f.name == name) {
            let shares = if fabric.stretched.is_some() { [0.9, 0.8] } else { [0.99, 0.98] };
            for share in shares {
                let tube = pressed_tube(fabric, 0.05, share, 0.015)?;
                let case = format!("{name}, {share} of a girth of 314 mm");
                let both = [tube.tension_over_radius_pa, tube.pressure_pa];
                findings.push(Experiment::Tube.finding(case, "pressure, Pa", both, "tension over radius [Laplace]"));
            }
        }
    }
    Ok(findings)
}

#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct Measured {
    name: String,
    fabric: String,
    drape_pct: f64,
    source: String,
}

fn published() -> Vec<Measured> {
    #[derive(serde::Deserialize)]
    struct Published {
        drape: Vec<Measured>,
    }
    toml::from_str::<Published>(include_str!("published.toml")).expect("the published numbers are valid").drape
}

/// Percent.
pub fn measured_drape(name: &str) -> Option<f64> {
    published().into_iter().find(|row| row.fabric == name).map(|row| row.drape_pct)
}

impl Measured {
    /// Properties that were not measured on this cloth are those of a light cotton, since freely hanging cloth is
    /// hardly stretched.
    fn fabric(&self) -> Option<Fabric> {
        let by_name = |name: &str| known().iter().find(|known| known.fabric.name == name);
        let (cloth, cotton) = (by_name(&self.fabric)?, by_name("cotton_shirting_light")?);
        let Fabric { density_kg_m2, bending_warp_nm, bending_weft_nm, .. } = cloth.fabric;
        let is_own = !cloth.of_another.contains(&Part::Shear);
        let shear_n_m = if is_own { cloth.fabric.shear_n_m } else { cotton.fabric.shear_n_m };
        let name = self.name.clone();
        Some(Fabric { name, density_kg_m2, bending_warp_nm, bending_weft_nm, shear_n_m, ..cotton.fabric.clone() })
    }
}

fn drapes() -> Result<Vec<Finding>, SimError> {
    let draped = |row: Measured| {
        let fabric = row.fabric().ok_or(SimError::NoMesh)?;
        let found = 100.0 * cusick(&fabric, RINGS, 0)?.coefficient;
        Ok(Experiment::Drape.finding(row.name, "drape coefficient, %", [row.drape_pct, found], &row.source))
    };
    published().into_iter().map(draped).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_published_is_sound_and_soft_cloth_drapes_least() {
        let published = published();
        let bends = |row: &Measured| {
            let fabric = row.fabric().unwrap_or_else(|| panic!("{} is not in the library", row.fabric));
            (fabric.bending_warp_nm + fabric.bending_weft_nm) / fabric.density_kg_m2
        };
        assert!(published.iter().all(|row| bends(row) > 0.0 && (0.0..100.0).contains(&row.drape_pct)));
        let stiffest = published.iter().max_by(|a, b| bends(a).total_cmp(&bends(b))).expect("some");
        assert!(published.iter().all(|row| row.drape_pct <= stiffest.drape_pct));
    }

    #[test]
    fn drape_coefficients_rank_as_they_were_measured() {
        let mut rows: Vec<Measured> = published().into_iter().filter(|row| row.source.contains("Matsudaira")).collect();
        rows.sort_by(|a, b| a.drape_pct.total_cmp(&b.drape_pct));
        let mut last = 0.0;
        for row in rows {
            let fabric = row.fabric().expect("in the library");
            let found = 100.0 * cusick(&fabric, 18, 0).expect("a sound mesh").coefficient;
            assert!(found > last, "{}: {found} after {last}", row.name);
            assert!((found - row.drape_pct).abs() < 15.0, "{}: {found} for {}", row.name, row.drape_pct);
            last = found;
        }
    }

    #[test]
    fn experiments_find_what_is_known() {
        for experiment in [Experiment::Strip, Experiment::Buckling, Experiment::Incline, Experiment::Tube] {
            for finding in experiment.run().expect("sound specimens") {
                let most = match experiment {
                    Experiment::Strip => 0.5,
                    Experiment::Buckling => 5.0,
                    // Cotton is stretched by 1 % at a radius of three edges.
                    Experiment::Tube => 2.0,
                    _ => 1.0,
                };
                assert!(finding.error().0.abs() <= most, "{finding:?}");
            }
        }
    }
}

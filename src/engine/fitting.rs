//! One garment on one body: draped and measured.

use crate::ease;
use crate::levels::WornOn;
use crate::outcome::{Measured, MeasuredPoint, Outcome};
use crate::stages::Meshes;
use body::Body;
use fit::{self, Ease, Simulator, measure};
use geom::DistanceField;
use geom::units::mm;
use pattern::pom::PointOfMeasure;
use pattern::style::PathPart;
use pattern::{Garment, MaterialLine, Style};
use sim::{self, Distortion, Drape, Fabric, Monitor};
use spec::Parameters;
use store::{InOrigin, Origin, Result, StudyError};

/// Greatest difference of two lengths that count as equal, m.
const SAME_LENGTH_M: f64 = 1e-6;

/// A garment and the body that is to wear it.
pub struct Fitting<'a> {
    /// The body that wears it.
    pub body: &'a Body,
    /// Distance from its skin.
    pub field: &'a DistanceField,
    /// The garment's pieces.
    pub style: &'a Style,
    /// Meshes of those pieces, coarse to fine.
    pub meshes: &'a Meshes,
    /// What it is cut from.
    pub fabric: &'a Fabric,
    /// How it is draped.
    pub simulator: Simulator,
    /// The simulator's parameters that are not the default ones.
    pub parameters: &'a Parameters,
}

impl Fitting<'_> {
    /// Drapes the garment.
    ///
    /// # Errors
    /// When the simulator refuses; [`StudyError::Interrupted`] when the monitor cancels.
    pub fn simulate(&self, monitor: &mut dyn Monitor) -> Result<Drape> {
        let Self { body, field, meshes, fabric, parameters, .. } = self;
        let drape = match self.simulator {
            Simulator::Fem => sim::fem::simulate(body, field, &meshes.0, fabric, &parameters.fem()?, monitor),
            Simulator::Hybrid => sim::hybrid::simulate(body, field, &meshes.0, fabric, &parameters.hybrid()?, monitor),
        };
        drape.map_err(StudyError::sim)
    }

    /// Measures a drape. The products that it was made of are left to the caller to name.
    ///
    /// # Errors
    /// When the garment has no measurement, or its mesh has other lengths than the pattern.
    pub fn outcome(&self, drape: &Drape) -> Result<Outcome> {
        let garment = self.meshes.finest()?;
        is_of(garment, self.style)?;
        let chis = measure::measure(garment, &drape.positions);
        let metrics =
            measure::metrics(&chis).ok_or_else(|| StudyError::refused(Origin::Measure, "nothing to measure"))?;
        let earlier = drape.earlier.iter().map(|staged| (staged.stage, measure::measure(garment, &staged.positions)));
        // Hybrid-GS sets a length unless the study leaves it free; FEM-GS sets none.
        let left_free = match self.simulator {
            Simulator::Fem => None,
            Simulator::Hybrid => Some(self.parameters.hybrid()?.uncontrolled),
        };
        let is_controlled = |no: u32| left_free.as_ref().is_some_and(|free| !free.contains(&no));
        let measured = earlier.chain([(drape.stage, chis)]).flat_map(|(stage, chis)| {
            let is_controlled = &is_controlled;
            garment.measurements.iter().zip(chis).map(move |(m, chi)| Measured {
                stage,
                name: m.name.clone(),
                kind: m.kind,
                is_free_edge: m.is_free_edge,
                is_controlled: is_controlled(m.no),
                chi,
            })
        });
        let (distorted, closures) = match self.simulator {
            Simulator::Fem => (Some(distorted(&self.parameters.fem()?, garment, drape)?), Vec::new()),
            Simulator::Hybrid => (None, sim::hybrid::closures(self.body, garment, &drape.positions)),
        };
        Ok(Outcome {
            converged: drape.converged,
            measured: measured.collect(),
            metrics,
            vertices: drape.welded_vertices,
            faces: garment.triangles.len(),
            iterations: drape.iterations,
            residual: drape.residual,
            penetration_max_m: drape.penetration_max_m,
            seam_gap_max_m: drape.seam_gap_max_m,
            self_crossings: drape.self_crossings,
            history: drape.history.clone(),
            eases: ease::on(self.style, self.body),
            points: self.points(garment, drape),
            worn: WornOn::of(self.body, self.style, (garment, self.fabric), drape, self.simulator)?,
            closures,
            distortion: distorted.as_ref().map(|(stretch, _)| *stretch),
            warnings: [distorted.and_then(|(_, told)| told), drape.braced_n.map(braced), stuck(drape)]
                .into_iter()
                .flatten()
                .collect(),
            used: Vec::new(),
        })
    }
}

impl Fitting<'_> {
    /// Points of measure, flat and on a drape. A draped length is the flat one times the stretch of the path along
    /// which it is taken.
    fn points(&self, garment: &Garment, drape: &Drape) -> Vec<MeasuredPoint> {
        let points = self.style.points_of_measure();
        let paths: Vec<&[PathPart]> = points.iter().map(|one| one.path.as_slice()).collect();
        let measured = |(one, stretch): (&PointOfMeasure, Option<f64>)| MeasuredPoint {
            point: one.point.as_str().to_owned(),
            flat_m: one.length_m,
            draped_m: stretch.map(|stretch| stretch * one.length_m),
        };
        points.iter().zip(self.stretches(garment, drape, &paths)).map(measured).collect()
    }

    /// Ratio of the draped to the flat length of paths of the style; `None` of a path that lies on no cloth.
    fn stretches(&self, garment: &Garment, drape: &Drape, paths: &[&[PathPart]]) -> Vec<Option<f64>> {
        let draped = |runs: &Vec<MaterialLine>| -> f64 {
            runs.iter().map(|run| run.length_m(&garment.rest, &drape.positions)).sum()
        };
        let stretch = |(path, runs): (&&[PathPart], Option<Vec<MaterialLine>>)| {
            let flat_m = self.style.path_length_m(path);
            runs.filter(|_| flat_m > 0.0).map(|runs| draped(&runs) / flat_m)
        };
        paths.iter().zip(self.style.laid(garment, paths)).map(stretch).collect()
    }

    /// Ease of a drape at every level that the style covers, m. The flat length at a level is multiplied by the
    /// stretch of the path along which it is taken.
    ///
    /// # Errors
    /// When there is no mesh.
    pub fn eases_on(&self, drape: &Drape) -> Result<Vec<(String, f64)>> {
        let lengths = ease::lengths(self.style, &ease::stand(self.body));
        let paths: Vec<&[PathPart]> = lengths.iter().map(|one| one.path.as_slice()).collect();
        let stretches = self.stretches(self.meshes.finest()?, drape, &paths);
        let flat = ease::on(self.style, self.body);
        let of = |ease: &Ease| {
            let index = lengths.iter().position(|one| one.level == ease.level)?;
            Some((ease.level.clone(), stretches[index]? * ease.pattern_girth_m - ease.body_girth_m))
        };
        Ok(flat.iter().filter_map(of).collect())
    }
}

/// Checks that a mesh has the lengths of its pattern: it may come from the cache, under a key that is wrong.
pub(crate) fn is_of(garment: &Garment, style: &Style) -> Result<()> {
    let fault = |what: String| {
        let text =
            format!("{what}: the mesh is not that of this pattern and size, a fault of Toile; nothing is stored");
        Err(StudyError::refused(Origin::Measure, text))
    };
    let (meshed, flat) = (&garment.measurements, &style.measurements);
    if meshed.len() != flat.len() {
        return fault(format!("{} measurements on the mesh, {} in the flat pattern", meshed.len(), flat.len()));
    }
    for (on_mesh, in_pattern) in meshed.iter().zip(flat) {
        let lengths_m = [on_mesh.l2d_m, in_pattern.l2d_m];
        if on_mesh.name != in_pattern.name || (lengths_m[0] - lengths_m[1]).abs() > SAME_LENGTH_M {
            let [found, wanted] = lengths_m.map(mm);
            let (name, other) = (&on_mesh.name, &in_pattern.name);
            return fault(format!(
                "`{name}` is {found:.2} mm on the mesh, `{other}` {wanted:.2} mm in the flat pattern"
            ));
        }
    }
    Ok(())
}

/// Distortion of a garment by FEM-GS, and a warning where it is beyond the limit.
fn distorted(params: &sim::fem::Params, garment: &Garment, drape: &Drape) -> Result<(f64, Option<String>)> {
    let distortion = Distortion::of(garment, &drape.positions).origin(Origin::Sim)?;
    let limit = params.distortion_limit;
    let told = (distortion.stretch > limit)
        .then(|| format!("distorted: {distortion}; the limit is {:.1} % (`fem.distortion_limit`)", 100.0 * limit));
    Ok((distortion.stretch, told))
}

/// Warning for a garment that would slide off.
fn braced(force_n: f64) -> String {
    format!(
        "braced: it would slide off by itself, friction and all, and hangs from its top edge, which is held up with {force_n:.1} N; \
         a smaller size, a stiffer fabric or a waistband ([[reinforce]] in the seam file) may hold it"
    )
}

/// Warning for a drape that ended before it was at rest, because no step could lower its residual.
fn stuck(drape: &Drape) -> Option<String> {
    drape.is_stuck.then(|| {
        format!(
            "stuck: forces of {:.2} times a vertex's weight are left that no step lowers any more; another `fem.seed` or mesh \
             (`edge_length_mm`) may come to rest",
            drape.residual
        )
    })
}

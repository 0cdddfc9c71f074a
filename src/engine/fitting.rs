//! One garment on one body: draped and measured.

use crate::assessment::Assessment;
use crate::ease;
use crate::error::EngineError;
use crate::outcome::{Measured, MeasuredPoint, Outcome};
use crate::stages::Garb;
use crate::tight;
use fit::{self, Simulator, measure};
use geom::units::mm;
use pattern::style::PathPart;
use pattern::{Garment, MaterialLine, Style};
use sim::dressing::Wearer;
use sim::{self, Distortion, Drape, Monitor};
use spec::Parameters;
use store::{InOrigin, Origin, Result, StudyError};

/// Greatest difference between lengths that count as equal.
const SAME_LENGTH_M: f64 = 1e-6;

#[derive(Clone, Copy)]
pub struct Fitting<'a> {
    pub wearer: Wearer<'a>,
    pub garb: &'a Garb,
    pub simulator: Simulator,
    /// Parameters of the simulator that differ from their defaults.
    pub parameters: &'a Parameters,
}

impl Fitting<'_> {
    /// Fails with [`StudyError::Interrupted`] when the monitor cancels.
    pub fn simulate(&self, monitor: &mut dyn Monitor) -> Result<Drape> {
        let Self { wearer: Wearer { body, field }, garb, parameters, .. } = *self;
        let (meshes, fabric) = (&garb.meshes.0, &garb.fabric);
        let drape = match self.simulator {
            Simulator::Fem => sim::fem::simulate(body, field, meshes, fabric, &parameters.fem()?, monitor),
            Simulator::Hybrid => sim::hybrid::simulate(body, field, meshes, fabric, &parameters.hybrid()?, monitor),
        };
        drape.map_err(StudyError::sim)
    }

    /// Leaves [`Outcome::used`] to the caller.
    pub fn outcome(&self, drape: &Drape) -> Result<Outcome> {
        let (body, garb) = (self.wearer.body, self.garb);
        let garment = garb.meshes.finest()?;
        check_lengths(garment, &garb.style)?;
        let chis = measure::measure(garment, &drape.positions);
        let metrics = measure::metrics(&chis).ok_or(EngineError::NothingToMeasure)?;
        let earlier = drape.earlier.iter().map(|staged| (staged.stage, measure::measure(garment, &staged.positions)));
        // Hybrid-GS sets every measurement that the study does not list as uncontrolled; FEM-GS sets none.
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
        let (distortion, closures) = match self.simulator {
            Simulator::Fem => (Some(Distortion::of(garment, &drape.positions).origin(Origin::Sim)?), Vec::new()),
            Simulator::Hybrid => (None, sim::hybrid::closures(body, garment, &drape.positions)),
        };
        let distorted = match &distortion {
            Some(distortion) => distorted(distortion, self.parameters.fem()?.distortion_limit),
            None => None,
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
            eases: ease::on(&garb.style, body),
            too_small: tight::too_small(body, garment, &garb.fabric, &drape.positions),
            points: self.points(garment, drape),
            worn: Assessment::of(body, garb, drape, self.simulator)?,
            closures,
            distortion: distortion.as_ref().map(|distortion| distortion.stretch),
            warnings: [distorted, drape.braced_n.map(braced), stuck(drape)].into_iter().flatten().collect(),
            used: Vec::new(),
        })
    }

    /// Draped lengths are the flat ones times the stretch of their paths.
    fn points(&self, garment: &Garment, drape: &Drape) -> Vec<MeasuredPoint> {
        let points = self.garb.style.points_of_measure();
        let paths: Vec<&[PathPart]> = points.iter().map(|found| found.path.as_slice()).collect();
        let stretches = self.stretches(garment, drape, &paths);
        let measured = points.iter().zip(stretches).map(|(found, stretch)| MeasuredPoint {
            point: found.point.as_str().to_owned(),
            flat_m: found.length_m,
            draped_m: stretch.map(|stretch| stretch * found.length_m),
        });
        measured.collect()
    }

    /// Draped length divided by flat length for paths of the style; `None` for a path that lies on no cloth.
    fn stretches(&self, garment: &Garment, drape: &Drape, paths: &[&[PathPart]]) -> Vec<Option<f64>> {
        let style = &self.garb.style;
        let draped_m = |runs: &Vec<MaterialLine>| -> f64 {
            runs.iter().map(|run| run.length_m(&garment.rest, &drape.positions)).sum()
        };
        let stretch = |(path, runs): (&&[PathPart], Option<Vec<MaterialLine>>)| {
            let flat_m = style.path_length_m(path);
            runs.filter(|_| flat_m > 0.0).map(|runs| draped_m(&runs) / flat_m)
        };
        paths.iter().zip(style.laid(garment, paths)).map(stretch).collect()
    }

    /// Ease at every level that the style covers, m. The draped girth is the flat one times the stretch of its path.
    pub fn eases_on(&self, drape: &Drape) -> Result<Vec<(String, f64)>> {
        let (body, garb) = (self.wearer.body, self.garb);
        let lengths = ease::lengths(&garb.style, &ease::stand(body));
        let paths: Vec<&[PathPart]> = lengths.iter().map(|length| length.path.as_slice()).collect();
        let stretches = self.stretches(garb.meshes.finest()?, drape, &paths);
        let eases = ease::on(&garb.style, body).into_iter().filter_map(|ease| {
            let index = lengths.iter().position(|length| length.level == ease.level)?;
            Some((ease.level, stretches[index]? * ease.pattern_girth_m - ease.body_girth_m))
        });
        Ok(eases.collect())
    }
}

/// Refuses a mesh with other lengths than its pattern: a mesh from the cache may be that of another pattern.
pub(crate) fn check_lengths(garment: &Garment, style: &Style) -> std::result::Result<(), EngineError> {
    let (meshed, flat) = (&garment.measurements, &style.measurements);
    if meshed.len() != flat.len() {
        return Err(EngineError::OtherCount { meshed: meshed.len(), flat: flat.len() });
    }
    let differ = meshed.iter().zip(flat).find(|(on_mesh, in_pattern)| {
        on_mesh.name != in_pattern.name || (on_mesh.l2d_m - in_pattern.l2d_m).abs() > SAME_LENGTH_M
    });
    match differ {
        None => Ok(()),
        Some((on_mesh, in_pattern)) => Err(EngineError::OtherLength {
            meshed: on_mesh.name.clone(),
            meshed_mm: mm(on_mesh.l2d_m),
            flat: in_pattern.name.clone(),
            flat_mm: mm(in_pattern.l2d_m),
        }),
    }
}

fn distorted(distortion: &Distortion, limit: f64) -> Option<String> {
    (distortion.stretch > limit)
        .then(|| format!("distorted: {distortion}; the limit is {:.1} % (`fem.distortion_limit`)", 100.0 * limit))
}

/// Warning for a garment that had to be held up by this force.
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

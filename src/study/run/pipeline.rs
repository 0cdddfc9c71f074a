//! The pipeline in earnest: body, distance field, garment meshes, simulation and measuring, each stage through the cache.

use std::path::Path;
use std::sync::Arc;

use crate::error::{Result, StudyError};
use crate::patterns;
use crate::rows::StageKind;
use crate::run::carry::carry;
use crate::run::ease;
use crate::run::layers::{self, Drapes, Garb, Wardrobe};
use crate::run::outcome::{Executor, Measured, MeasuredPoint, Outcome};
use crate::run::worn::WornOn;
use crate::spec::file::{Person, Subject};
use crate::spec::inputs::Inputs;
use crate::spec::parameters::Parameters;
use crate::spec::{JobSpec, Outfit, subject_inputs, versions};
use crate::store::cache::{Artefact, Cache, Used};
use body::Body;
use fit::{self, Ease, Simulator, measure};
use geom::DistanceField;
use geom::units::mm;
use pattern::pom::PointOfMeasure;
use pattern::style::PathPart;
use pattern::{Garment, MaterialLine, Style};
use sim::fem::carry::Worn;
use sim::{self, Distortion, Drape, Fabric, Monitor};

/// Difference of two lengths that are one, m.
const SAME_LENGTH_M: f64 = 1e-6;

/// The inputs of a subject's body, the same as among those of any job on it.
pub(crate) fn body_inputs(name: &str, person: &Person) -> Inputs {
    let mut inputs = Inputs::default();
    subject_inputs(&mut inputs, name, person);
    for (name, version) in versions::VERSIONS {
        inputs.set(name, version);
    }
    inputs
}

/// A body, as the cache keeps it.
#[derive(serde::Serialize, serde::Deserialize)]
pub(crate) struct Model {
    /// The human model.
    pub body: Body,
}

/// Meshes of one garment, coarse to fine.
#[derive(serde::Serialize, serde::Deserialize)]
pub(crate) struct Meshes(pub Vec<Garment>);

impl Meshes {
    /// Meshes of a style, the finest with edges of this length, m.
    ///
    /// # Errors
    /// When a piece cannot be meshed.
    pub fn of(style: &Style, edge_length_m: f64) -> Result<Self> {
        let edges = sim::fem::level_edges(edge_length_m).into_iter();
        let meshes = edges.map(|edge| style.mesh(edge).map_err(StudyError::stage("mesh")));
        Ok(Self(meshes.collect::<Result<_>>()?))
    }

    /// The mesh that results are on.
    pub fn finest(&self) -> Result<&Garment> {
        self.0.last().ok_or_else(|| StudyError::stage("mesh")("no mesh"))
    }
}

/// Stored as JSON: exact for finite numbers, readable by other programs.
macro_rules! json_artefact {
    ($($stored:ty),*) => {$(
        impl Artefact for $stored {
            fn encode(&self) -> Result<Vec<u8>> {
                serde_json::to_vec(self).map_err(StudyError::stage("store"))
            }

            fn decode(bytes: &[u8]) -> std::result::Result<Self, String> {
                serde_json::from_slice(bytes).map_err(|error| error.to_string())
            }
        }
    )*};
}

json_artefact!(Model, Meshes, Drape, Drapes);

impl Artefact for DistanceField {
    fn encode(&self) -> Result<Vec<u8>> {
        Ok(self.to_bytes())
    }

    fn decode(bytes: &[u8]) -> std::result::Result<Self, String> {
        Self::from_bytes(bytes).map_err(|error| error.to_string())
    }
}

/// The stages of one database.
pub struct Pipeline {
    cache: Cache,
}

impl Pipeline {
    /// Stages whose products are kept in a database.
    #[must_use]
    pub fn new(database: &Path) -> Self {
        Self::over(Cache::new(database.to_owned()))
    }

    /// Stages over a cache.
    pub(crate) fn over(cache: Cache) -> Self {
        Self { cache }
    }

    fn model(&self, spec: &JobSpec) -> Result<(Arc<Model>, Used)> {
        self.cache
            .get(StageKind::Body, &spec.inputs.stage_hash(StageKind::Body), || Ok(Model { body: spec.person.body()? }))
    }

    fn field(&self, spec: &JobSpec, model: &Model) -> Result<(Arc<DistanceField>, Used)> {
        self.cache.get(StageKind::Field, &spec.inputs.stage_hash(StageKind::Field), || {
            DistanceField::build(&model.body.mesh, versions::FIELD_SPACING_M).map_err(StudyError::stage("field"))
        })
    }

    fn meshes(&self, spec: &JobSpec) -> Result<(Arc<Meshes>, Used)> {
        self.cache.get(StageKind::Mesh, &spec.inputs.stage_hash(StageKind::Mesh), || mesh(spec))
    }

    /// The drape of a garment that is worn alone.
    fn drape(&self, spec: &JobSpec, monitor: &mut dyn Monitor) -> Result<(Arc<Drape>, Used)> {
        let hash = spec.inputs.stage_hash(StageKind::Drape);
        self.cache.get(StageKind::Drape, &hash, || match &spec.dressed {
            Some(before) => self.carried(spec, before, monitor),
            None => {
                let (model, meshes) = (self.model(spec)?.0, self.meshes(spec)?.0);
                let fitting = Fitting {
                    body: &model.body,
                    field: &self.field(spec, &model)?.0,
                    style: &style(spec)?,
                    meshes: &meshes,
                    fabric: &spec.fabric,
                    simulator: spec.simulator,
                    parameters: &spec.parameters,
                };
                fitting.simulate(monitor)
            }
        })
    }

    /// A garment that is put on as `before` says, and carried into the pose of `spec`.
    fn carried(&self, spec: &JobSpec, before: &JobSpec, monitor: &mut dyn Monitor) -> Result<Drape> {
        let (drape, _) = self.drape(before, monitor)?;
        let upright = Person { pose: None, ..spec.person.clone() }.body()?;
        let poses = [before, spec].map(|one| one.person.pose.unwrap_or_default());
        let meshes = self.meshes(spec)?.0;
        let worn = Worn { garment: meshes.finest()?, fabric: &spec.fabric, drape: &drape };
        carry(&upright, poses, worn, &spec.parameters, monitor).map(|(_, drape)| drape)
    }

    /// A layer of an outfit. The first of its layers drapes them all, for the others too.
    fn layer(&self, spec: &JobSpec, outfit: &Outfit, monitor: &mut dyn Monitor) -> Result<Outcome> {
        let (model, used_body) = self.model(spec)?;
        let (field, used_field) = self.field(spec, &model)?;
        let (_, used_mesh) = self.meshes(spec)?;
        let garb = |layer: &JobSpec| Garb::of(layer, self.meshes(layer)?.0);
        let garbs = outfit.layers.iter().map(garb).collect::<Result<Vec<_>>>()?;
        let on = (&model.body, &*field);
        let wardrobe =
            Wardrobe { on, garbs: &garbs, simulator: spec.simulator, parameters: &outfit.layers[0].parameters };
        let hash = layers::inputs(outfit).stage_hash(StageKind::Drape);
        let (all, _) = self.cache.get(StageKind::Drape, &hash, || wardrobe.dress(monitor).map(Drapes))?;
        let own = || Ok(all.0[outfit.layer].clone());
        let (_, used_drape) = self.cache.get(StageKind::Drape, &spec.inputs.stage_hash(StageKind::Drape), own)?;
        let used = vec![used_body, used_field, used_mesh, used_drape];
        Ok(Outcome { used, ..wardrobe.outcome(outfit.layer, &all.0)? })
    }

    /// The body of a subject, for its ease: a scan through the cache; one that is measured is built sooner than it is read.
    ///
    /// # Errors
    /// Those of the body.
    pub(crate) fn worn_body(&self, subject: &Subject) -> Result<Arc<Model>> {
        let Subject { id, person, .. } = subject;
        let make = || Ok(Model { body: person.body()? });
        if person.scan.is_none() {
            return make().map(Arc::new);
        }
        Ok(self.cache.get(StageKind::Body, &body_inputs(id, person).stage_hash(StageKind::Body), make)?.0)
    }
}

/// The style of a job's size.
pub(crate) fn style(spec: &JobSpec) -> Result<Style> {
    let unit = spec.unit.as_deref().and_then(patterns::unit_of);
    patterns::read_style(&spec.pattern, spec.seams.as_ref(), Some(&spec.size), unit)
}

/// Meshes of a job's garment, coarse to fine.
fn mesh(spec: &JobSpec) -> Result<Meshes> {
    let style = style(spec)?;
    Meshes::of(&style, spec.edge_length_m)
}

impl Executor for Pipeline {
    fn execute(&self, spec: &JobSpec, monitor: &mut dyn Monitor) -> Result<Outcome> {
        if let Some(outfit) = &spec.outfit {
            return self.layer(spec, outfit, monitor);
        }
        let (model, used_body) = self.model(spec)?;
        let (meshes, used_mesh) = self.meshes(spec)?;
        let (field, used_field) = self.field(spec, &model)?;
        let style = style(spec)?;
        let (drape, used_drape) = self.drape(spec, monitor)?;
        let fitting = Fitting {
            body: &model.body,
            field: &field,
            style: &style,
            meshes: &meshes,
            fabric: &spec.fabric,
            simulator: spec.simulator,
            parameters: &spec.parameters,
        };
        Ok(Outcome { used: vec![used_body, used_field, used_mesh, used_drape], ..fitting.outcome(&drape)? })
    }
}

/// A garment and the body that is to wear it.
pub(crate) struct Fitting<'a> {
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
    /// What the simulator refuses; [`StudyError::Interrupted`] when the monitor cancels.
    pub fn simulate(&self, monitor: &mut dyn Monitor) -> Result<Drape> {
        let Self { body, field, meshes, fabric, parameters, .. } = self;
        let drape = match self.simulator {
            Simulator::Fem => sim::fem::simulate(body, field, &meshes.0, fabric, &parameters.fem()?, monitor),
            Simulator::Hybrid => sim::hybrid::simulate(body, field, &meshes.0, fabric, &parameters.hybrid()?, monitor),
        };
        drape.map_err(StudyError::sim)
    }

    /// What a drape measures; no artefact is named as used.
    ///
    /// # Errors
    /// When the garment has no measurement, or other lengths than its pattern.
    pub fn outcome(&self, drape: &Drape) -> Result<Outcome> {
        let garment = self.meshes.finest()?;
        is_of(garment, self.style)?;
        let chis = measure::measure(garment, &drape.positions);
        let metrics = measure::metrics(&chis).ok_or_else(|| StudyError::stage("measure")("nothing to measure"))?;
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
    /// Points of measure flat and on a drape, where a length is stretched as the path that it is taken along.
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

    /// How long paths of the style are on a drape, over how long they are flat; `None` of what lies on no cloth.
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

    /// Ease of a drape at every level that the style covers, m: as on the flat pattern, each length stretched as the path that it is
    /// taken along.
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

/// Checks that a mesh measures what its pattern does: each stage may come from the cache, under a key that could be wrong.
fn is_of(garment: &Garment, style: &Style) -> Result<()> {
    let fault = |what: String| {
        let text =
            format!("{what}: the mesh is not that of this pattern and size, a fault of Toile; nothing is stored");
        Err(StudyError::stage("measure")(text))
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

/// How far FEM-GS stretched a garment, and what is to be said of it where that is too far.
fn distorted(params: &sim::fem::Params, garment: &Garment, drape: &Drape) -> Result<(f64, Option<String>)> {
    let distortion = Distortion::of(garment, &drape.positions).map_err(StudyError::stage("sim"))?;
    let limit = params.distortion_limit;
    let told = (distortion.stretch > limit)
        .then(|| format!("distorted: {distortion}; the limit is {:.1} % (`fem.distortion_limit`)", 100.0 * limit));
    Ok((distortion.stretch, told))
}

/// What is to be said of a garment that would slide off.
fn braced(force_n: f64) -> String {
    format!(
        "braced: it would slide off by itself, friction and all, and hangs from its top edge, which is held up with {force_n:.1} N; \
         a smaller size, a stiffer fabric or a waistband ([[reinforce]] in the seam file) may hold it"
    )
}

/// Reason of a drape that ended before it was at rest, where it could get no further.
fn stuck(drape: &Drape) -> Option<String> {
    drape.is_stuck.then(|| {
        format!(
            "stuck: forces of {:.2} times a vertex's weight are left that no step lowers any more; another `fem.seed` or mesh \
             (`edge_length_mm`) may come to rest",
            drape.residual
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spec::file::Study;
    use crate::store::{self, Access};
    use crate::{catalogue, spec};

    fn quickstart() -> Vec<JobSpec> {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studies/quickstart");
        let known = catalogue::known(None).expect("built in");
        let jobs = spec::jobs(&Study::load(&folder, &known).expect("a good study"));
        jobs.into_iter().filter(|job| job.simulator == Simulator::Fem).collect()
    }

    #[test]
    fn meshes_are_coarse_to_fine_and_survive_storage_exactly() {
        let meshes = mesh(&quickstart()[0]).expect("it meshes");
        assert_eq!(meshes.0.len(), 3);
        let lengths = |garment: &Garment| garment.measurements.iter().map(|m| m.l2d_m).collect::<Vec<_>>();
        for pair in meshes.0.windows(2) {
            assert!(pair[0].rest.len() < pair[1].rest.len());
            assert_eq!(lengths(&pair[0]), lengths(&pair[1]));
        }
        let stored = Meshes::decode(&meshes.encode().expect("finite")).expect("just written");
        assert_eq!(stored.0, meshes.0);
    }

    #[test]
    fn subjects_and_fabrics_are_the_inputs_that_a_reader_would_name() {
        let jobs = quickstart();
        let inputs: Vec<(&str, &str)> = jobs[0].inputs.iter().collect();
        for input in [
            ("subject.ii.chest_girth_mm", "863"),
            ("fabric.cotton_shirting_light.density_kg_m2", "0.1036"),
            ("mesh.edge_length_mm", "15"),
            ("sim.name", "fem"),
        ] {
            assert!(inputs.contains(&input), "{input:?} in {inputs:?}");
        }
        let body = body_inputs(&jobs[0].subject, &jobs[0].person).stage_hash(StageKind::Body);
        assert_eq!(body, jobs[0].inputs.stage_hash(StageKind::Body), "the catalogue's body is the job's");
        let differ = |a: usize, b: usize, stage| jobs[a].inputs.stage_hash(stage) != jobs[b].inputs.stage_hash(stage);
        assert!(!differ(0, 2, StageKind::Body) && differ(0, 1, StageKind::Body), "the body is the subject's");
        assert!(!differ(0, 1, StageKind::Mesh) && differ(0, 2, StageKind::Mesh), "the mesh is the size's");
    }

    #[test]
    fn ease_is_that_of_the_body_that_is_dressed() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("toile.sqlite");
        store::open(&path, Access::Create).expect("a new database");
        let pipeline = Pipeline::new(&path);
        let jobs = quickstart();
        let (mut girths_m, style) = (Vec::new(), style(&jobs[0]).expect("it can be read"));
        for job in &jobs[..2] {
            let subject = Subject { id: job.subject.clone(), person: job.person.clone(), carried_from: None };
            let worn = pipeline.worn_body(&subject).expect("it can be built");
            assert_eq!(worn.body, job.person.body().expect("it can be built"));
            girths_m.push(ease::on(&style, &worn.body).swap_remove(0));
        }
        assert_eq!(girths_m[0].level, "chest");
        assert!((girths_m[0].pattern_girth_m - 0.9741).abs() < 1e-4, "{}", girths_m[0].pattern_girth_m);
        for (ease, chest_m) in girths_m.iter().zip([0.863, 0.956]) {
            assert!((ease.body_girth_m - chest_m).abs() < 0.015 * chest_m, "{}", ease.body_girth_m);
        }
    }

    #[test]
    fn a_mesh_of_another_size_is_no_result() {
        let jobs = quickstart();
        let (own, other) = (mesh(&jobs[0]).expect("it meshes"), style(&jobs[2]).expect("it can be read"));
        let finest = own.finest().expect("it meshes");
        assert_ne!(jobs[0].size, jobs[2].size);
        assert!(is_of(finest, &style(&jobs[0]).expect("it can be read")).is_ok());
        let error = is_of(finest, &other).expect_err("another size").to_string();
        assert!(error.contains("974.10 mm on the mesh") && error.contains("1034.10 mm in the flat pattern"), "{error}");
    }

    #[test]
    fn a_file_without_a_unit_is_not_sewn() {
        let mut job = quickstart().swap_remove(0);
        let text = String::from_utf8_lossy(&job.pattern.bytes).replace("METRIC", "").replace("Units", "Notes");
        let text = text.replace("$INSUNITS", "$NOTHING").replace("$MEASUREMENT", "$NOTHING");
        job.pattern.bytes = text.into_bytes().into();
        let error = style(&job).expect_err("no unit").to_string();
        assert!(error.contains("no unit"), "{error}");
        job.unit = Some("mm".into());
        assert!(style(&job).is_ok());
    }
}

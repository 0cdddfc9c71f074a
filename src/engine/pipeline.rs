//! The pipeline of a job: body, distance field, garment meshes, simulation and measuring, each stage through the cache.

use std::path::Path;
use std::sync::Arc;

use crate::carry::Carry;
use crate::fitting::Fitting;
use crate::layers::{self, Drapes, Ensemble};
use crate::outcome::{Executor, Outcome};
use crate::stages::{Garb, Meshes, Model, body_inputs, mesh};
use geom::DistanceField;
use sim::dressing::Wearer;
use sim::{self, Drape, Monitor};
use spec::file::Subject;
use spec::{JobSpec, Outfit, Person, versions};
use store::cache::{Cache, Used};
use store::{InOrigin, Origin, Result, StageKind};

pub struct Pipeline {
    cache: Cache,
}

impl Pipeline {
    pub fn new(database: &Path) -> Self {
        Self::over(Cache::new(database.to_owned()))
    }

    pub fn over(cache: Cache) -> Self {
        Self { cache }
    }

    fn model(&self, spec: &JobSpec) -> Result<(Arc<Model>, Used)> {
        self.cache
            .get(StageKind::Body, &spec.inputs.stage_hash(StageKind::Body), || Ok(Model { body: spec.person.body()? }))
    }

    fn field(&self, spec: &JobSpec, model: &Model) -> Result<(Arc<DistanceField>, Used)> {
        self.cache.get(StageKind::Field, &spec.inputs.stage_hash(StageKind::Field), || {
            DistanceField::build(&model.body.mesh, versions::FIELD_SPACING_M).origin(Origin::Field)
        })
    }

    fn meshes(&self, spec: &JobSpec) -> Result<(Arc<Meshes>, Used)> {
        self.cache.get(StageKind::Mesh, &spec.inputs.stage_hash(StageKind::Mesh), || mesh(spec))
    }

    fn drape(&self, spec: &JobSpec, monitor: &mut dyn Monitor) -> Result<(Arc<Drape>, Used)> {
        let hash = spec.inputs.stage_hash(StageKind::Drape);
        self.cache.get(StageKind::Drape, &hash, || match &spec.dressed {
            Some(before) => self.carried(spec, before, monitor),
            None => {
                let (model, meshes) = (self.model(spec)?.0, self.meshes(spec)?.0);
                let wearer = Wearer { body: &model.body, field: &self.field(spec, &model)?.0 };
                fitting(spec, wearer, &Garb::of(spec, meshes)?).simulate(monitor)
            }
        })
    }

    /// Drape of a garment that is put on in the pose of `before` and carried into the pose of `spec`.
    fn carried(&self, spec: &JobSpec, before: &JobSpec, monitor: &mut dyn Monitor) -> Result<Drape> {
        let (drape, _) = self.drape(before, monitor)?;
        let upright = Person { pose: None, ..spec.person.clone() }.body()?;
        let meshes = self.meshes(spec)?.0;
        let carry = Carry {
            upright: &upright,
            poses: [before, spec].map(|job| job.person.pose.unwrap_or_default()),
            garment: meshes.finest()?,
            fabric: &spec.fabric,
            drape: &drape,
            parameters: &spec.parameters,
        };
        Ok(carry.run(monitor)?.drape)
    }

    /// Outcome of a layer of an outfit. The first layer to run drapes all of them; the others find their drapes in the
    /// cache.
    fn layer(&self, spec: &JobSpec, outfit: &Outfit, monitor: &mut dyn Monitor) -> Result<Outcome> {
        let (model, used_body) = self.model(spec)?;
        let (field, used_field) = self.field(spec, &model)?;
        let (_, used_mesh) = self.meshes(spec)?;
        let garb = |layer: &JobSpec| Garb::of(layer, self.meshes(layer)?.0);
        let garbs = outfit.layers.iter().map(garb).collect::<Result<Vec<_>>>()?;
        let ensemble = Ensemble {
            wearer: Wearer { body: &model.body, field: &field },
            garbs: &garbs,
            simulator: spec.simulator,
            parameters: &outfit.layers[0].parameters,
        };
        let hash = layers::inputs(outfit).stage_hash(StageKind::Drape);
        let (all, _) = self.cache.get(StageKind::Drape, &hash, || ensemble.dress(monitor).map(Drapes))?;
        let own = || Ok(all.0[outfit.layer].clone());
        let (_, used_drape) = self.cache.get(StageKind::Drape, &spec.inputs.stage_hash(StageKind::Drape), own)?;
        let used = vec![used_body, used_field, used_mesh, used_drape];
        Ok(Outcome { used, ..ensemble.outcome(outfit.layer, &all.0)? })
    }

    /// Takes a scan from the cache; a body from measurements is built faster than read.
    pub(crate) fn worn_body(&self, subject: &Subject) -> Result<Arc<Model>> {
        let Subject { id, person, .. } = subject;
        let make = || Ok(Model { body: person.body()? });
        if person.scan.is_none() {
            return make().map(Arc::new);
        }
        Ok(self.cache.get(StageKind::Body, &body_inputs(id, person).stage_hash(StageKind::Body), make)?.0)
    }
}

impl Executor for Pipeline {
    fn execute(&self, spec: &JobSpec, monitor: &mut dyn Monitor) -> Result<Outcome> {
        if let Some(outfit) = &spec.outfit {
            return self.layer(spec, outfit, monitor);
        }
        let (model, used_body) = self.model(spec)?;
        let (meshes, used_mesh) = self.meshes(spec)?;
        let (field, used_field) = self.field(spec, &model)?;
        let garb = Garb::of(spec, meshes)?;
        let (drape, used_drape) = self.drape(spec, monitor)?;
        let fitting = fitting(spec, Wearer { body: &model.body, field: &field }, &garb);
        Ok(Outcome { used: vec![used_body, used_field, used_mesh, used_drape], ..fitting.outcome(&drape)? })
    }
}

fn fitting<'a>(spec: &'a JobSpec, wearer: Wearer<'a>, garb: &'a Garb) -> Fitting<'a> {
    Fitting { wearer, garb, simulator: spec.simulator, parameters: &spec.parameters }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ease;
    use crate::fitting::check_lengths;
    use crate::stages::style;
    use fit::Simulator;
    use pattern::Garment;
    use spec::Study;
    use store::Access;
    use store::cache::Artefact;
    use wardrobe::catalogue;

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
        assert!(check_lengths(finest, &style(&jobs[0]).expect("it can be read")).is_ok());
        let error = check_lengths(finest, &other).expect_err("another size").to_string();
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

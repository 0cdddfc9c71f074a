//! The runs of a report, with their pictures.

use super::super::error::{Result, StudyError};
use super::super::inputs::StageKind;
use super::super::picture::{Dressed, Map};
use super::super::types::{JobRow, MetricsRow, Status, Value};
use super::super::workspace::Workspace;
use super::quoted;
use crate::measure::Chi;
use crate::render::{self, Camera, Frame, Scene, View};
use crate::report::data::{FieldMap, Measured, Outcome, Picture, Run};
use crate::units::mm;

/// Pixels of a picture on the page.
const PICTURE: (u32, u32) = (420, 620);

impl Workspace {
    /// All runs with their pictures, which share one frame; the pictures are also added to `files`.
    pub(super) fn report_runs(
        &self,
        study: &str,
        jobs: &[JobRow],
        files: &mut Vec<(String, Vec<u8>)>,
    ) -> Result<Vec<Run>> {
        let eases = self.ease_matrices(study)?;
        let mut dressed = Vec::new();
        for job in jobs {
            dressed.push(if job.status.has_result() { Some(self.dressed(job.id)?) } else { None });
        }
        let meshes = dressed.iter().flatten().flat_map(|worn: &Dressed| [&worn.body, &worn.cloth]);
        let frame = Frame::enclosing(meshes, f64::from(PICTURE.0) / f64::from(PICTURE.1));
        let mut runs = Vec::new();
        for (job, worn) in jobs.iter().zip(&dressed) {
            let outcome = match job.status {
                Status::Done => Outcome::Converged,
                Status::NotConverged => Outcome::NotConverged,
                status => Outcome::Failed(job.error.clone().unwrap_or_else(|| status.as_str().to_owned())),
            };
            let mut run = self.report_run(job, outcome)?;
            run.ease = eases.iter().find(|matrix| matrix.garment == job.garment).and_then(|matrix| {
                let size = matrix.sizes.iter().position(|size| *size == job.size)?;
                let subject = matrix.subjects.iter().position(|subject| *subject == job.subject)?;
                matrix.cells[size][subject].clone()
            });
            if let Some(worn) = worn {
                self.add_pictures(&mut run, job, worn, frame, files)?;
            }
            runs.push(run);
        }
        Ok(runs)
    }

    /// A run without ease and pictures.
    fn report_run(&self, job: &JobRow, outcome: Outcome) -> Result<Run> {
        let metrics = self.metrics(job.id)?;
        let number = |get: fn(&MetricsRow) -> f64| metrics.as_ref().map_or(0.0, get);
        let mut measured = Vec::new();
        for chi in self.chi(job.id)? {
            let published = format!(
                "SELECT chi FROM v_published WHERE simulator = '{}' AND lower(size) = lower({}) AND subject = {}
                AND measurement_no = {} AND abs(l2d_mm - {}) < 0.5
                AND garment GLOB (SELECT sex FROM subject JOIN job USING (subject_id) WHERE job_id = {}) || '_*'",
                job.simulator.as_str(),
                quoted(&job.size),
                quoted(&job.subject),
                chi.no,
                mm(chi.l2d_m),
                job.id
            );
            let published = self.query(&published)?.rows.into_iter().flatten().next();
            measured.push(Measured {
                name: chi.name.clone(),
                chi: Chi { no: chi.no, l2d_m: chi.l2d_m, l3d_m: chi.l3d_m },
                closed: chi.is_girth,
                free_edge: chi.is_free_edge,
                controlled: chi.is_controlled,
                published_chi: match published {
                    Some(Value::Real(chi)) => Some(chi),
                    _ => None,
                },
            });
        }
        Ok(Run {
            garment: job.garment.clone(),
            size: job.size.clone(),
            subject: job.subject.clone(),
            simulator: job.simulator,
            fabric: self
                .one(&format!("SELECT name FROM fabric JOIN job USING (fabric_id) WHERE job_id = {}", job.id))?,
            outcome,
            ease: None,
            measured,
            vertices: number(|m| f64::from(m.vertices)) as usize,
            faces: number(|m| f64::from(m.faces)) as usize,
            iterations: number(|m| f64::from(m.iterations)) as u32,
            residual: number(|m| m.residual),
            residuals: self.history(job.id)?.iter().map(|step| (step.iteration, step.residual)).collect(),
            penetration_max_m: number(|m| m.penetration_max_m),
            seam_gap_max_m: number(|m| m.seam_gap_max_m),
            wall_s: job.wall_ms.unwrap_or_default() as f64 / 1e3,
            views: Vec::new(),
            maps: Vec::new(),
        })
    }

    /// The four views and the maps of a run; as JPEG on the page, as PNG beside it.
    fn add_pictures(
        &self,
        run: &mut Run,
        job: &JobRow,
        worn: &Dressed,
        frame: Frame,
        files: &mut Vec<(String, Vec<u8>)>,
    ) -> Result<()> {
        let what = format!("{} {} on {}, {}", job.garment, job.size, job.subject, job.simulator.as_str());
        let mut take = |scene: &Scene, view: View, map: Map| -> Result<Picture> {
            let camera = Camera::new(view, frame);
            let shot = render::render(scene, &camera, PICTURE.0, PICTURE.1).map_err(StudyError::stage("render"))?;
            let png = render::png(&shot).map_err(StudyError::stage("render"))?;
            files.push((format!("pictures/job-{}-{}-{}.png", job.id, view.as_str(), map.as_str()), png));
            let bytes = render::jpeg(&shot).map_err(StudyError::stage("render"))?;
            let caption = if map == Map::Plain { view.as_str() } else { map.as_str() };
            Ok(Picture { bytes, alt: format!("{what}, {caption}"), caption: caption.to_owned() })
        };
        for map in Map::ALL {
            let (scene, scale) = worn.scene(map, || self.product(job.id, StageKind::Field))?;
            match scale {
                None => {
                    run.views = View::ALL.into_iter().map(|view| take(&scene, view, map)).collect::<Result<_>>()?;
                }
                Some(scale) => run.maps.push(FieldMap { picture: take(&scene, View::Quarter, map)?, scale }),
            }
        }
        Ok(())
    }
}

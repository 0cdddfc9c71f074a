//! Runs of a report, with their pictures.

use std::thread;

use image::{RgbaImage, imageops};

use crate::picture::{self, Dressed, Map};
use crate::reporting::sheets::{PICTURE, Sheets};
use crate::reporting::{self, Part, Tell, facts, quoted};
use fit::measure::Chi;
use geom::units::mm;
use render::{self, Camera, Cell, Frame, Scale, Scene, View};
use report::data::{EaseMatrix, FieldMap, Measured, Outcome, Picture, RawLink, TryOn};
use sim::Stage;
use store::{InOrigin, JobId, JobRow, MetricsRow, Origin, Result, Status, Store, Value, read, sql};

/// Height of the frame, divided by the least one that holds the garments: shoulders, neck and hips belong to a fit.
const ROOM: f64 = 1.12;
/// Number of runs whose pictures are at full size within the page's 3 MB. With more runs they are smaller on the page,
/// but not in the files beside it.
const FULL_SIZE: usize = 6;
/// Least scale of a picture on the page: less would show nothing. A page of 108 runs then has about 9 MB, which can
/// still be mailed.
const LEAST_SHRINK: f64 = 0.38;
/// Maps of a run. With the four views and one more picture they fill two rows of five.
const MAPS: [(Map, &[View]); 3] = [
    (Map::Stretch, &[View::Front, View::Back]),
    (Map::Tension, &[View::Front, View::Back]),
    (Map::Gap, &[View::Front]),
];

pub(super) struct Album {
    pub runs: Vec<TryOn>,
    pub sheets: Vec<RawLink>,
    /// Frame that all pictures share.
    pub frame: Frame,
}

/// Runs with pictures, which share one frame, and links to contact sheets. Adds the picture files to `files`.
pub(super) fn report_runs(
    store: &Store,
    study: &str,
    jobs: &[JobRow],
    files: &mut Vec<(String, Vec<u8>)>,
    tell: Tell<'_>,
) -> Result<Album> {
    let eases = facts::ease_matrices(store, study)?;
    let mut dressed = Vec::new();
    for job in jobs {
        dressed.push(if job.status.has_result() { Some(picture::dressed(store, job.id)?) } else { None });
    }
    let garments = dressed.iter().flatten().map(|worn: &Dressed| &worn.cloth);
    let least = Frame::enclosing(garments, f64::from(PICTURE.0) / f64::from(PICTURE.1));
    let frame = Frame { height_m: ROOM * least.height_m, ..least };
    let shown = dressed.iter().flatten().count().max(FULL_SIZE);
    let shrink = (FULL_SIZE as f64 / shown as f64).sqrt().max(LEAST_SHRINK);
    let (mut runs, mut links): (Vec<TryOn>, Vec<RawLink>) = (Vec::new(), Vec::new());
    let mut sheets = Sheets::of(study, jobs);
    let threads = threads();
    let all = jobs.len();
    for (jobs, dressed) in jobs.chunks(threads).zip(dressed.chunks(threads)) {
        tell(Part { name: "pictures", step: [runs.len() + 1, all] });
        let mut taken = report_runs_of(store, jobs, &eases)?;
        for (((run, worn), job), shots) in
            taken.iter_mut().zip(dressed).zip(jobs).zip(photograph(jobs, dressed, Format { frame, shrink }))
        {
            let Shots { views, maps, cells, files: kept } = shots?;
            if worn.is_some() {
                (run.views, run.maps) = (views, maps);
                if let Some(lacks) = lacks(store, job.id)? {
                    let gap = run.maps.iter_mut().map(|m| &mut m.picture).rfind(|picture| picture.file.contains("gap"));
                    gap.into_iter().for_each(|picture| picture.caption.push_str(&lacks));
                }
                files.extend(kept);
            }
            if let Some((link, sheet)) = sheets.add(job, cells)? {
                files.push((link.href.clone(), sheet));
                links.push(link);
            }
        }
        runs.extend(taken);
    }
    Ok(Album { runs, sheets: links, frame })
}

fn report_runs_of(store: &Store, jobs: &[JobRow], eases: &[EaseMatrix]) -> Result<Vec<TryOn>> {
    let run_of = |job: &JobRow| {
        let outcome = match job.status {
            Status::Done => Outcome::Converged,
            Status::NotConverged => Outcome::NotConverged,
            status => Outcome::Failed(job.error.clone().unwrap_or_else(|| status.as_str().to_owned())),
        };
        let mut run = report_run(store, job, outcome)?;
        run.ease = eases.iter().find(|matrix| matrix.garment == job.garment).and_then(|matrix| {
            let size = matrix.sizes.iter().position(|size| *size == job.size)?;
            let subject = matrix.subjects.iter().position(|subject| *subject == job.subject)?;
            matrix.cells[size][subject].clone()
        });
        Ok(run)
    };
    jobs.iter().map(run_of).collect()
}

/// Name of a job's garment, without the seed that a sweep gave it.
fn case(store: &Store, job: &JobRow) -> Result<String> {
    let swept = reporting::one(
        store,
        &format!(
            "SELECT style || coalesce(group_concat(' ' || parameter || '=' || value, '')
                FILTER (WHERE parameter NOT GLOB '*.seed'), '')
        FROM v_sweep WHERE study = {} AND garment = {} GROUP BY garment",
            quoted(&job.study),
            quoted(&job.garment)
        ),
    )?;
    Ok(if swept.is_empty() { job.garment.clone() } else { swept })
}

/// Shortfall by level of a garment by Hybrid-GS, for the caption of its gap map.
fn lacks(store: &Store, id: JobId) -> Result<Option<String>> {
    let sql = format!(
        "SELECT group_concat(printf('%.0f mm at the %s', body_girth_mm - garment_girth_mm, level), ', ')
        FROM gap WHERE job_id = {id} AND body_girth_mm - garment_girth_mm >= 0.5"
    );
    let lacks = sql::query(store, &sql)?.rows.into_iter().flatten().next();
    Ok(match lacks {
        Some(Value::Text(lacks)) => Some(format!("; does not close by {lacks}")),
        _ => None,
    })
}

fn report_run(store: &Store, job: &JobRow, outcome: Outcome) -> Result<TryOn> {
    let metrics = read::metrics(store, job.id)?;
    let number = |get: fn(&MetricsRow) -> f64| metrics.as_ref().map_or(0.0, get);
    let mut measured = Vec::new();
    for chi in read::chi(store, job.id)?.into_iter().filter(|chi| chi.stage == Stage::Drape.as_str()) {
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
        let published = sql::query(store, &published)?.rows.into_iter().flatten().next();
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
            misprint: None,
        });
    }
    Ok(TryOn {
        garment: job.garment.clone(),
        case: case(store, job)?,
        repeat: job.repeat,
        size: job.size.clone(),
        subject: job.subject.clone(),
        simulator: job.simulator,
        fabric: reporting::one(
            store,
            &format!("SELECT name FROM fabric JOIN job USING (fabric_id) WHERE job_id = {}", job.id),
        )?,
        outcome,
        ease: None,
        measured,
        vertices: number(|m| f64::from(m.vertices)) as usize,
        faces: number(|m| f64::from(m.faces)) as usize,
        iterations: number(|m| f64::from(m.iterations)) as u32,
        residual: number(|m| m.residual),
        residuals: read::history(store, job.id)?.iter().map(|step| (step.iteration, step.residual)).collect(),
        penetration_max_m: number(|m| m.penetration_max_m),
        seam_gap_max_m: number(|m| m.seam_gap_max_m),
        wall_s: job.wall_ms.unwrap_or_default() as f64 / 1e3,
        views: Vec::new(),
        maps: Vec::new(),
    })
}

/// Pictures of a run, its four views for a contact sheet, and the files beside the page.
#[derive(Default)]
struct Shots {
    views: Vec<Picture>,
    maps: Vec<FieldMap>,
    cells: Vec<Cell>,
    files: Vec<(String, Vec<u8>)>,
}

#[derive(Clone, Copy)]
struct Format {
    frame: Frame,
    /// Scale of the pictures on the page, relative to the files.
    shrink: f64,
}

pub(super) fn threads() -> usize {
    thread::available_parallelism().map_or(1, usize::from)
}

/// Results in order, with a thread for each item.
pub(super) fn side_by_side<T: Sync, R: Send>(items: &[T], work: impl Fn(&T) -> R + Sync) -> Vec<R> {
    thread::scope(|scope| {
        let threads: Vec<_> = items.iter().map(|item| scope.spawn(|| work(item))).collect();
        let join = |thread: thread::ScopedJoinHandle<_>| match thread.join() {
            Ok(done) => done,
            Err(panic) => std::panic::resume_unwind(panic),
        };
        threads.into_iter().map(join).collect()
    })
}

fn photograph(jobs: &[JobRow], dressed: &[Option<Dressed>], format: Format) -> Vec<Result<Shots>> {
    let pairs: Vec<(&JobRow, &Option<Dressed>)> = jobs.iter().zip(dressed).collect();
    side_by_side(&pairs, |(job, worn)| {
        worn.as_ref().map_or_else(|| Ok(Shots::default()), |worn| shots(job, worn, format))
    })
}

/// Makes the pictures of a run: reduced for the page, and at full size for the files.
struct Photographer<'a> {
    job: &'a JobRow,
    format: Format,
    files: Vec<(String, Vec<u8>)>,
}

impl Photographer<'_> {
    fn shot(&self, scene: &Scene, view: View) -> Result<RgbaImage> {
        render::render(scene, &Camera::new(view, self.format.frame), PICTURE.0, PICTURE.1).origin(Origin::Render)
    }

    /// Keeps a shot as a file, with the legend of `scale` drawn in, and returns the picture for the page.
    fn keep(&mut self, shot: RgbaImage, name: &str, caption: String, scale: Option<&Scale>) -> Result<Picture> {
        let on_page = [PICTURE.0, PICTURE.1].map(|side| (f64::from(side) * self.format.shrink).round() as u32);
        let small = imageops::resize(&shot, on_page[0], on_page[1], imageops::FilterType::CatmullRom);
        let bytes = render::jpeg(&small).origin(Origin::Render)?;
        let mut full = shot;
        if let Some(scale) = scale {
            render::draw_legend(&mut full, scale).origin(Origin::Render)?;
        }
        let job = self.job;
        let file = format!("pictures/job-{}-{name}.jpg", job.id);
        self.files.push((file.clone(), render::jpeg(&full).origin(Origin::Render)?));
        let alt = format!("{} {} on {}, {}, {caption}", job.garment, job.size, job.subject, job.simulator.as_str());
        Ok(Picture { bytes, file, alt, caption })
    }
}

/// Takes the pictures of a run: four views; the pop-up (Hybrid-GS) or a check of 20 mm (FEM-GS); the maps.
fn shots(job: &JobRow, worn: &Dressed, format: Format) -> Result<Shots> {
    let mut photographer = Photographer { job, format, files: Vec::new() };
    let mut scene = worn.scene(Map::Plain)?;
    let (mut views, mut field_maps, mut cells) = (Vec::new(), Vec::new(), Vec::new());
    for view in View::ALL {
        let picture = photographer.shot(&scene, view)?;
        let label = format!("{} {}, {}", job.subject, job.simulator.as_str(), view.as_str());
        cells.push(Cell { picture: picture.clone(), label });
        let name = format!("{}-plain", view.as_str());
        views.push(photographer.keep(picture, &name, view.as_str().to_owned(), None)?);
    }
    if let Some(popup) = worn.popup_scene() {
        let picture = photographer.shot(&popup?, View::Front)?;
        views.push(photographer.keep(picture, "popup", "pop-up".into(), None)?);
    } else {
        worn.repaint(&mut scene, Map::Check)?;
        let picture = photographer.shot(&scene, View::Front)?;
        views.push(photographer.keep(picture, "front-check", "check of 20 mm".into(), None)?);
    }
    for (map, sides) in &MAPS {
        let Some(scale) = map.scale() else { continue };
        worn.repaint(&mut scene, *map)?;
        for view in *sides {
            let shot = photographer.shot(&scene, *view)?;
            let name = format!("{}-{}", view.as_str(), map.as_str());
            let caption = format!("{}, {}", scale.label, view.as_str());
            let picture = photographer.keep(shot, &name, caption, Some(&scale))?;
            field_maps.push(FieldMap { picture, scale: scale.clone() });
        }
    }
    Ok(Shots { views, maps: field_maps, cells, files: photographer.files })
}

//! Reading the data of all screens at once.

use std::collections::BTreeMap;

use crate::messages::snapshot::{Compared, Detail, Focus, Snapshot};
use engine::enqueue;
use results::{FitCard, GarmentWorn, assessment};
use store::queue::Interrupted;
use store::{JobFilter, JobId, Result, Status, Store, StudyError, comments, now_ms, queue, read};
use wardrobe::catalogue;

pub fn snapshot(store: &Store, focus: &Focus) -> Result<Snapshot> {
    let studies = read::studies(store)?;
    let study = studies.iter().position(|study| Some(&study.name) == focus.study.as_ref()).unwrap_or(0);
    let subjects = catalogue::subjects(store)?;
    let fabrics = catalogue::fabrics(store)?;
    let sizes = catalogue::sizes(store)?;
    let outfits = read::outfits(store)?;
    let (jobs, ease) = (vec![], vec![]);
    let mut snapshot = Snapshot {
        now_ms: now_ms(),
        offset_ms: read::local_offset_ms(store, now_ms())?,
        subjects,
        fabrics,
        sizes,
        outfits,
        studies,
        study,
        runners: vec![],
        cloths: BTreeMap::new(),
        grid: None,
        jobs,
        ease,
        detail: None,
        compared: vec![],
        recommendations: vec![],
        worn: None,
        comments: vec![],
        rounds: vec![],
    };
    let Some(row) = snapshot.studies.get(study) else { return Ok(snapshot) };
    let garment = row.garments.iter().find(|name| Some(*name) == focus.garment.as_ref()).or(row.garments.first());
    let grid = garment.map(|garment| read::grid(store, &row.name, garment)).transpose()?;
    snapshot.jobs = read::jobs(store, &JobFilter { study: Some(row.name.clone()), ..JobFilter::default() })?;
    snapshot.ease = read::ease(store, &row.name)?;
    snapshot.grid = grid;
    snapshot.cloths = read::cloths(store, &snapshot.studies[study].name)?;
    snapshot.comments = comments::comments(store, &snapshot.studies[study].name)?;
    snapshot.rounds = comments::last_rounds(store, &snapshot.studies[study].name)?;
    snapshot.runners = queue::runners(store, &snapshot.studies[study].name)?;
    if let Some(job) = focus.job.filter(|id| snapshot.job(*id).is_some()) {
        snapshot.detail = Some(detail(store, job)?);
    }
    if store.is_readonly() {
        tell_interrupted(&mut snapshot, &queue::interrupted(store)?);
    }
    add_compared(store, &mut snapshot, focus)?;
    snapshot.worn = worn(store, &snapshot, focus)?;
    Ok(snapshot)
}

/// Shows running jobs whose process has ended as queued, with a line about it: where the database may be written, they
/// are back in the queue.
pub fn tell_interrupted(snapshot: &mut Snapshot, interrupted: &[Interrupted]) {
    for lost in interrupted {
        let Some(job) = snapshot.jobs.iter_mut().find(|job| job.id == lost.job) else { continue };
        (job.status, job.error, job.progress) = (Status::Queued, Some(lost.to_string()), None);
        let cells = snapshot.grid.iter_mut().flat_map(|grid| grid.cells.iter_mut().flatten().flatten());
        for cell in cells.filter(|cell| cell.job == Some(lost.job)) {
            (cell.status, cell.fraction) = (Some(Status::Queued), None);
        }
        if let Some(study) = snapshot.studies.get_mut(snapshot.study) {
            study.counts[Status::Running as usize] = study.count(Status::Running).saturating_sub(1);
            study.counts[Status::Queued as usize] = study.count(Status::Queued) + 1;
        }
    }
    snapshot.runners.retain(|runner| !interrupted.iter().any(|lost| lost.process == runner.name));
}

/// Adapts an earlier reading to another focus on jobs, if nothing was written since.
pub fn refocused(store: &Store, mut before: Snapshot, focus: &Focus) -> Result<Snapshot> {
    before.now_ms = now_ms();
    before.detail = focus.job.filter(|id| before.job(*id).is_some()).map(|job| detail(store, job)).transpose()?;
    add_compared(store, &mut before, focus)?;
    before.worn = worn(store, &before, focus)?;
    Ok(before)
}

fn add_compared(store: &Store, snapshot: &mut Snapshot, focus: &Focus) -> Result<()> {
    (snapshot.compared, snapshot.recommendations) = (vec![], vec![]);
    for id in &focus.compare {
        snapshot.compared.extend(compared(store, *id)?);
    }
    if let (false, Some(study)) = (snapshot.compared.is_empty(), snapshot.studies.get(snapshot.study)) {
        snapshot.recommendations = read::recommendations(store, &study.name)?;
    }
    Ok(())
}

/// Fit of the shown garment on the wearer. Where no ease is known, its card has no sizes.
fn worn(store: &Store, snapshot: &Snapshot, focus: &Focus) -> Result<Option<GarmentWorn>> {
    let (Some(grid), Some(subject)) = (&snapshot.grid, &focus.wearer) else { return Ok(None) };
    match assessment::worn(store, &grid.study, Some(&grid.garment), Some(subject)) {
        Err(StudyError::NotFound { .. }) => {
            let (garment, subject) = (grid.garment.clone(), subject.clone());
            let card = FitCard { garment, subject, intended: None, sizes: vec![] };
            Ok(Some(GarmentWorn { card, simulator: None, sizes: vec![] }))
        }
        found => Ok(found?.pop()),
    }
}

/// Returns `None` for a job that is gone.
fn compared(store: &Store, id: JobId) -> Result<Option<Compared>> {
    let job = match read::job(store, id) {
        Err(StudyError::NotFound { .. }) => return Ok(None),
        job => job?,
    };
    let (chi, metrics, inputs) = (read::chi(store, id)?, read::metrics(store, id)?, enqueue::inputs(store, id)?);
    Ok(Some(Compared { job, chi, metrics, inputs }))
}

fn detail(store: &Store, job: JobId) -> Result<Detail> {
    Ok(Detail {
        job,
        chi: read::chi(store, job)?,
        metrics: read::metrics(store, job)?,
        history: read::history(store, job)?,
        log: read::log(store, job)?,
        why: enqueue::why(store, job)?,
        stages: read::stages(store, job)?,
    })
}

//! Reading the contents that the screens show, in one go.

use crate::messages::snapshot::{Compared, Detail, Focus, Snapshot};
use study::{FitCard, GarmentWorn, JobFilter, JobId, Result, StudyError, Workspace, now_ms};

/// Reads what a focus needs.
///
/// # Errors
/// When the database cannot be read.
pub fn snapshot(workspace: &Workspace, focus: &Focus) -> Result<Snapshot> {
    let studies = workspace.studies()?;
    let study = studies.iter().position(|study| Some(&study.name) == focus.study.as_ref()).unwrap_or(0);
    let subjects = workspace.subjects()?;
    let fabrics = workspace.fabrics()?;
    let sizes = workspace.sizes()?;
    let (jobs, ease) = (vec![], vec![]);
    let mut snapshot = Snapshot {
        now_ms: now_ms(),
        subjects,
        fabrics,
        sizes,
        studies,
        study,
        grid: None,
        jobs,
        ease,
        detail: None,
        compared: vec![],
        recommendations: vec![],
        worn: None,
    };
    let Some(row) = snapshot.studies.get(study) else { return Ok(snapshot) };
    let garment = row.garments.iter().find(|name| Some(*name) == focus.garment.as_ref()).or(row.garments.first());
    let grid = garment.map(|garment| workspace.grid(&row.name, garment)).transpose()?;
    snapshot.jobs = workspace.jobs(&JobFilter { study: Some(row.name.clone()), ..JobFilter::default() })?;
    snapshot.ease = workspace.ease(&row.name)?;
    snapshot.grid = grid;
    if let Some(job) = focus.job.filter(|id| snapshot.job(*id).is_some()) {
        snapshot.detail = Some(detail(workspace, job)?);
    }
    add_compared(workspace, &mut snapshot, focus)?;
    snapshot.worn = worn(workspace, &snapshot, focus)?;
    Ok(snapshot)
}

/// Updates an earlier reading for another job or comparison, where nothing was written since.
///
/// # Errors
/// When the database cannot be read.
pub fn refocused(workspace: &Workspace, mut before: Snapshot, focus: &Focus) -> Result<Snapshot> {
    before.now_ms = now_ms();
    before.detail = focus.job.filter(|id| before.job(*id).is_some()).map(|job| detail(workspace, job)).transpose()?;
    add_compared(workspace, &mut before, focus)?;
    before.worn = worn(workspace, &before, focus)?;
    Ok(before)
}

/// Reads the runs that are compared.
fn add_compared(workspace: &Workspace, snapshot: &mut Snapshot, focus: &Focus) -> Result<()> {
    (snapshot.compared, snapshot.recommendations) = (vec![], vec![]);
    for id in &focus.compare {
        snapshot.compared.extend(compared(workspace, *id)?);
    }
    if let (false, Some(study)) = (snapshot.compared.is_empty(), snapshot.studies.get(snapshot.study)) {
        snapshot.recommendations = workspace.recommendations(&study.name)?;
    }
    Ok(())
}

/// Fit of the garment looked at on the wearer; a card without sizes where no ease is known of them.
fn worn(workspace: &Workspace, snapshot: &Snapshot, focus: &Focus) -> Result<Option<GarmentWorn>> {
    let (Some(grid), Some(subject)) = (&snapshot.grid, &focus.wearer) else { return Ok(None) };
    match workspace.worn(&grid.study, Some(&grid.garment), Some(subject)) {
        Err(StudyError::NotFound { .. }) => {
            let (garment, subject) = (grid.garment.clone(), subject.clone());
            let card = FitCard { garment, subject, intended: None, sizes: vec![] };
            Ok(Some(GarmentWorn { card, simulator: None, sizes: vec![] }))
        }
        found => Ok(found?.pop()),
    }
}

/// A run to compare; `None` where there is no such job any more.
fn compared(workspace: &Workspace, id: JobId) -> Result<Option<Compared>> {
    let job = match workspace.job(id) {
        Err(StudyError::NotFound { .. }) => return Ok(None),
        job => job?,
    };
    let (chi, metrics, inputs) = (workspace.chi(id)?, workspace.metrics(id)?, workspace.inputs(id)?);
    Ok(Some(Compared { job, chi, metrics, inputs }))
}

fn detail(workspace: &Workspace, job: JobId) -> Result<Detail> {
    Ok(Detail {
        job,
        chi: workspace.chi(job)?,
        metrics: workspace.metrics(job)?,
        history: workspace.history(job)?,
        log: workspace.log(job)?,
        why: workspace.why(job)?,
        stages: workspace.stages(job)?,
    })
}

//! What the screens show, read from the workspace in one go on a background thread.

use study::{
    ChiRow, EaseRow, FabricRow, Grid, Inputs, JobFilter, JobId, JobRow, LogLine, MetricsRow, RecommendationRow, Result,
    SizeRow, StageRow, Step, StudyError, StudyRow, SubjectRow, Why, Workspace, now_ms,
};

/// What the user looks at; whatever is `None` or gone is chosen by [`snapshot`].
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Focus {
    /// Study.
    pub study: Option<String>,
    /// Garment.
    pub garment: Option<String>,
    /// Job whose details are wanted.
    pub job: Option<JobId>,
    /// Jobs to compare.
    pub compare: Vec<JobId>,
}

/// Everything the screens show of the database at one moment.
#[derive(Clone, Debug)]
pub struct Snapshot {
    /// When it was read, ms since 1970 (UTC).
    pub now_ms: i64,
    /// The subjects of the catalogue, by name.
    pub subjects: Vec<SubjectRow>,
    /// The fabrics of the catalogue, by name.
    pub fabrics: Vec<FabricRow>,
    /// The sizes of the styles of the catalogue.
    pub sizes: Vec<SizeRow>,
    /// All studies.
    pub studies: Vec<StudyRow>,
    /// The study looked at, an index into `studies`.
    pub study: usize,
    /// The garment looked at as a grid.
    pub grid: Option<Grid>,
    /// All current jobs of the study.
    pub jobs: Vec<JobRow>,
    /// Ease of all sizes on all subjects of the study.
    pub ease: Vec<EaseRow>,
    /// The job looked at.
    pub detail: Option<Detail>,
    /// The jobs compared, those that are gone left out.
    pub compared: Vec<Compared>,
    /// Which simulator the study's garments are to be trusted to; read for comparisons only.
    pub recommendations: Vec<RecommendationRow>,
}

/// A run as it is compared.
#[derive(Clone, Debug)]
pub struct Compared {
    /// The job.
    pub job: JobRow,
    /// Measurements of all stages.
    pub chi: Vec<ChiRow>,
    /// Numbers of its result.
    pub metrics: Option<MetricsRow>,
    /// What it was made of.
    pub inputs: Inputs,
}

impl Snapshot {
    /// The study looked at; `None` where the database has none.
    #[must_use]
    pub fn study(&self) -> Option<&StudyRow> {
        self.studies.get(self.study)
    }

    /// A job by its number.
    #[must_use]
    pub fn job(&self, id: JobId) -> Option<&JobRow> {
        self.jobs.iter().find(|job| job.id == id)
    }
}

/// What is stored of one job.
#[derive(Clone, Debug)]
pub struct Detail {
    /// Its number.
    pub job: JobId,
    /// Measurements of all stages.
    pub chi: Vec<ChiRow>,
    /// Numbers of its result.
    pub metrics: Option<MetricsRow>,
    /// Steps of its simulation.
    pub history: Vec<Step>,
    /// Its log, oldest line first.
    pub log: Vec<LogLine>,
    /// Why the cache did not have it.
    pub why: Why,
    /// Where its inputs came from.
    pub stages: Vec<StageRow>,
}

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
    Ok(snapshot)
}

/// What was read before, with what another job or comparison needs; for when nothing was written since.
///
/// # Errors
/// When the database cannot be read.
pub fn refocused(workspace: &Workspace, mut before: Snapshot, focus: &Focus) -> Result<Snapshot> {
    before.now_ms = now_ms();
    before.detail = focus.job.filter(|id| before.job(*id).is_some()).map(|job| detail(workspace, job)).transpose()?;
    add_compared(workspace, &mut before, focus)?;
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

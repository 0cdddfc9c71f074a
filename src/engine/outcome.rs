//! Outcome of a job, and the transaction that stores the whole of it.

use rusqlite::{Connection, OptionalExtension, Transaction, params};

use crate::assessment::{self, Assessment};
use spec::JobSpec;
use store::{JobId, Result, Status, StudyError};

use crate::tight::TooSmall;
use fit::Ease;
use fit::measure::{Chi, Metrics};
use geom::units::mm;
use pattern::MeasurementKind;
use sim::hybrid::Closure;
use sim::{Monitor, Stage, Step};
use store::cache::Used;
use store::owner::host;
use store::queue::{self, Event};

#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Measured {
    pub stage: Stage,
    pub name: String,
    pub kind: MeasurementKind,
    /// True if the measurement runs along an edge that is in no seam.
    pub is_free_edge: bool,
    /// True if the simulator sets the length to that of the pattern by construction.
    pub is_controlled: bool,
    pub chi: Chi,
}

#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct MeasuredPoint {
    /// Name of the point of measure in tables and SQL.
    pub point: String,
    pub flat_m: f64,
    /// Length of this half, where half a girth is measured. `None` for a distance that runs across no cloth.
    pub draped_m: Option<f64>,
}

#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Outcome {
    /// True if the residual reached its tolerance with all seams closed.
    pub converged: bool,
    /// Measurements at every stage that the simulator tells apart.
    pub measured: Vec<Measured>,
    /// Summary of the last stage.
    pub metrics: Metrics,
    pub vertices: usize,
    pub faces: usize,
    /// Sum over all mesh levels.
    pub iterations: u32,
    /// Rms residual force divided by the mean weight of a vertex.
    pub residual: f64,
    pub penetration_max_m: f64,
    pub seam_gap_max_m: f64,
    /// Edges that pierce the garment's own cloth.
    pub self_crossings: usize,
    pub history: Vec<Step>,
    pub eases: Vec<Ease>,
    #[serde(default)]
    pub too_small: Vec<TooSmall>,
    #[serde(default)]
    pub points: Vec<MeasuredPoint>,
    #[serde(default)]
    pub worn: Assessment,
    /// Girths of garment and body at each fit level, by Hybrid-GS.
    pub closures: Vec<Closure>,
    /// FEM-GS: principal stretch less 1 that 1 % of the cloth exceeds.
    pub distortion: Option<f64>,
    /// Sentences for the reader; they go to the job's log.
    pub warnings: Vec<String>,
    pub used: Vec<Used>,
}

/// Turns the specification of a job into its outcome. Implemented by the pipeline, and by closures in tests.
pub trait Executor: Sync {
    /// Not converging is an [`Outcome`], not an error. Fails with [`StudyError::Interrupted`] when the monitor asked to
    /// stop.
    fn execute(&self, spec: &JobSpec, monitor: &mut dyn Monitor) -> Result<Outcome>;
}

impl<F: Fn(&JobSpec, &mut dyn Monitor) -> Result<Outcome> + Sync> Executor for F {
    fn execute(&self, spec: &JobSpec, monitor: &mut dyn Monitor) -> Result<Outcome> {
        self(spec, monitor)
    }
}

#[derive(Clone, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub(crate) struct Provenance {
    /// Commit of the repository that holds the study file, and true if it has uncommitted changes.
    pub git: Option<(String, bool)>,
    pub machine: String,
    pub program_version: String,
}

impl Provenance {
    /// Provenance of a study. No commit without a repository or git.
    pub fn of(folder: &std::path::Path) -> Self {
        let git = |arguments: &[&str]| {
            let output = std::process::Command::new("git").arg("-C").arg(folder).args(arguments).output().ok()?;
            output.status.success().then(|| String::from_utf8_lossy(&output.stdout).trim().to_owned())
        };
        let commit = git(&["rev-parse", "HEAD"]);
        let git =
            commit.map(|commit| (commit, git(&["status", "--porcelain"]).is_none_or(|changes| !changes.is_empty())));
        Self { git, ..Self::here() }
    }

    /// Provenance without a repository.
    pub fn here() -> Self {
        Self { git: None, machine: machine(), program_version: env!("CARGO_PKG_VERSION").to_owned() }
    }
}

/// Ends a job with its outcome, in one transaction. Returns the new state, or `None` if `owner` no longer holds the
/// job, which was cancelled or taken over meanwhile.
pub(crate) fn finish(
    connection: &mut Connection,
    id: JobId,
    spec: &JobSpec,
    owner: &str,
    outcome: &Result<Outcome>,
    provenance: &Provenance,
) -> Result<Option<Status>> {
    let transaction = store::write(connection)?;
    let status = finish_in(&transaction, id, spec, owner, outcome, provenance)?;
    transaction.commit()?;
    Ok(status)
}

pub(crate) fn finish_in(
    transaction: &Transaction<'_>,
    id: JobId,
    spec: &JobSpec,
    owner: &str,
    outcome: &Result<Outcome>,
    provenance: &Provenance,
) -> Result<Option<Status>> {
    let message = outcome.as_ref().err().map(StudyError::to_string);
    let event = match outcome {
        Ok(outcome) => Event::Finish { owner, converged: outcome.converged },
        Err(StudyError::Interrupted) => Event::Release(owner),
        Err(_) => Event::Fail(owner),
    };
    let error = message.as_deref().filter(|_| matches!(event, Event::Fail(_)));
    let Some(after) = queue::apply(transaction, id, &event, error)? else { return Ok(None) };
    match outcome {
        Ok(outcome) => {
            write_result(transaction, id, spec, outcome, provenance)?;
            let stages: Vec<String> = outcome.used.iter().map(Used::to_string).collect();
            queue::log(transaction, id, "info", &stages.join(", "))?;
            for found in &outcome.too_small {
                queue::log(transaction, id, "warn", &found.to_string())?;
            }
            for warning in &outcome.warnings {
                queue::log(transaction, id, "warn", warning)?;
            }
            let text = format!("{}: EI {:.4}", after.status.as_str().replace('_', " "), outcome.metrics.ei);
            queue::log(transaction, id, if outcome.converged { "info" } else { "warn" }, &text)?;
        }
        Err(StudyError::Interrupted) => queue::log(transaction, id, "info", "stopped; queued again")?,
        Err(error) => queue::log(transaction, id, "error", &error.to_string())?,
    }
    Ok(Some(after.status))
}

fn write_result(
    transaction: &Transaction<'_>,
    id: JobId,
    spec: &JobSpec,
    outcome: &Outcome,
    provenance: &Provenance,
) -> Result<()> {
    write_measured(transaction, id, outcome)?;
    write_closures(transaction, id, &outcome.closures)?;
    write_points(transaction, id, &outcome.points)?;
    assessment::write(transaction, id, &outcome.worn)?;
    let mut statement = transaction.prepare_cached(
        "INSERT INTO history (job_id, step, iteration, level, residual, seam_gap_mm, e_chi) VALUES (?, ?, ?, ?, ?, ?, ?)",
    )?;
    for (number, step) in outcome.history.iter().enumerate() {
        let gap_mm = mm(step.seam_gap_m);
        let number = number as i64;
        statement.execute(params![id.0, number, step.iteration, step.level, step.residual, gap_mm, step.e_chi])?;
    }
    let mut statement =
        transaction.prepare_cached("INSERT INTO job_artefact (job_id, kind, hash, was_cached) VALUES (?, ?, ?, ?)")?;
    for used in &outcome.used {
        statement.execute(params![id.0, used.stage.as_str(), used.hash, used.was_cached])?;
    }
    let is_current = "SELECT study_id FROM job WHERE job_id = ? AND is_current";
    let study_id: Option<i64> = transaction.query_row(is_current, [id.0], |row| row.get(0)).optional()?;
    if let Some(study_id) = study_id {
        write_ease(transaction, study_id, [&spec.garment, &spec.size, &spec.subject], &outcome.eases)?;
    }
    let (commit, dirty) = provenance.git.clone().unzip();
    transaction
        .prepare_cached(
            "INSERT INTO provenance (job_id, program_version, git_commit, git_dirty, machine, seed)
            SELECT job_id, ?, ?, ?, ?, repeat FROM job WHERE job_id = ?",
        )?
        .execute(params![provenance.program_version, commit, dirty, provenance.machine, id.0])?;
    Ok(())
}

fn write_measured(transaction: &Transaction<'_>, id: JobId, outcome: &Outcome) -> Result<()> {
    let mut statement = transaction.prepare_cached(
        "INSERT INTO chi (job_id, stage, measurement_no, measurement, kind, is_free_edge, is_controlled, l2d_mm, l3d_mm)
        VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?)",
    )?;
    for Measured { stage, name, kind, is_free_edge, is_controlled, chi } in &outcome.measured {
        let kind = match kind {
            MeasurementKind::ClosedGirth => "closed_girth",
            MeasurementKind::OpenLength => "open_length",
        };
        let (l2d_mm, l3d_mm) = (mm(chi.l2d_m), mm(chi.l3d_m));
        let row = params![id.0, stage.as_str(), chi.no, name, kind, is_free_edge, is_controlled, l2d_mm, l3d_mm];
        statement.execute(row)?;
    }
    let metrics = &outcome.metrics;
    transaction.prepare_cached("INSERT INTO metrics VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)")?.execute(
        params![
            id.0,
            metrics.n as i64,
            metrics.e_chi,
            metrics.sd_chi,
            metrics.ei,
            metrics.max_abs_error,
            outcome.vertices as i64,
            outcome.faces as i64,
            outcome.iterations,
            outcome.residual,
            outcome.converged,
            mm(outcome.penetration_max_m),
            mm(outcome.seam_gap_max_m),
            outcome.self_crossings as i64,
            outcome.distortion
        ],
    )?;
    Ok(())
}

fn write_points(transaction: &Transaction<'_>, id: JobId, points: &[MeasuredPoint]) -> Result<()> {
    let sql = "INSERT INTO pom (job_id, position, point, flat_mm, draped_mm) VALUES (?, ?, ?, ?, ?)";
    let mut statement = transaction.prepare_cached(sql)?;
    for (position, measured) in (1_i64..).zip(points) {
        let (flat_mm, draped_mm) = (mm(measured.flat_m), measured.draped_m.map(mm));
        statement.execute(params![id.0, position, measured.point, flat_mm, draped_mm])?;
    }
    Ok(())
}

fn write_closures(transaction: &Transaction<'_>, id: JobId, closures: &[Closure]) -> Result<()> {
    let mut statement = transaction.prepare_cached(
        "INSERT INTO gap (job_id, level, height_mm, body_girth_mm, garment_girth_mm) VALUES (?, ?, ?, ?, ?)",
    )?;
    for closure in closures {
        let [height_mm, body_mm, garment_mm] =
            [closure.height_m, closure.body_girth_m, closure.garment_girth_m].map(mm);
        statement.execute(params![id.0, closure.level, height_mm, body_mm, garment_mm])?;
    }
    Ok(())
}

pub(crate) fn write_ease(
    transaction: &Transaction<'_>,
    study_id: i64,
    [garment, size, subject]: [&str; 3],
    eases: &[Ease],
) -> Result<()> {
    // Removes levels that an earlier version found or an earlier seam file stated.
    transaction
        .prepare_cached("DELETE FROM ease WHERE study_id = ? AND garment = ? AND size = ? AND subject = ?")?
        .execute(params![study_id, garment, size, subject])?;
    let mut statement = transaction.prepare_cached(
        "INSERT INTO ease (study_id, garment, size, subject, level, pattern_girth_mm, body_girth_mm, is_held)
        VALUES (?, ?, ?, ?, ?, ?, ?, ?)",
    )?;
    for ease in eases {
        let (pattern_mm, body_mm) = (mm(ease.pattern_girth_m), mm(ease.body_girth_m));
        statement.execute(params![study_id, garment, size, subject, ease.level, pattern_mm, body_mm, ease.is_held])?;
    }
    Ok(())
}

/// Host, cores, system.
pub fn machine() -> String {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    format!("{}, {cores} cores, {} {}", host(), std::env::consts::OS, std::env::consts::ARCH)
}

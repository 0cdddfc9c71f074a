//! Records of jobs: provenance, inputs and numbers; two jobs side by side; a job repeated from its stored inputs.

use std::path::Path;

use rusqlite::{OptionalExtension, Row};

use crate::error::ResultsError;
use engine::{Executor, Outcome, Pipeline, enqueue};
use geom::units::{from_mm, mm};
use sim::Silent;
use spec::{CARRIED_FROM, Change, Inputs, JobSpec, Parameters, Schedule};
use store::cache::Cache;
use store::{Access, ChiRow, JobId, JobRow, MetricsRow, Result, SizeKey, StageRow, Store, StudyError, SubjectId, read};
use wardrobe::catalogue::{self, StyleFiles, read_fabric, read_style};

#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
pub struct ProvenanceRow {
    pub program_version: String,
    /// Commit of the repository that holds the study file.
    pub git_commit: Option<String>,
    /// True if that repository had uncommitted changes.
    pub git_dirty: Option<bool>,
    pub machine: String,
    pub seed: i64,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Record {
    pub job: JobRow,
    pub inputs: Inputs,
    pub stages: Vec<StageRow>,
    /// `None` without a result.
    pub provenance: Option<ProvenanceRow>,
    pub metrics: Option<MetricsRow>,
    /// Measurements at every stage; empty without a result.
    pub chi: Vec<ChiRow>,
}

#[derive(Clone, Debug, PartialEq)]
pub struct ChiPair {
    /// Number in the style (`#1`).
    pub no: u32,
    pub name: String,
    /// Pattern length and draped length in each result; `None` where a result lacks the measurement.
    pub lengths_m: [Option<(f64, f64)>; 2],
}

impl ChiPair {
    /// L3D / L2D in each result.
    pub fn chi(&self) -> [Option<f64>; 2] {
        self.lengths_m.map(|lengths| lengths.map(|(l2d, l3d)| l3d / l2d))
    }

    /// True if both results have the measurement, with lengths that are equal bit by bit.
    pub fn is_same(&self) -> bool {
        let bits = |lengths: Option<(f64, f64)>| lengths.map(|(l2d, l3d)| [l2d.to_bits(), l3d.to_bits()]);
        self.lengths_m[0].is_some() && bits(self.lengths_m[0]) == bits(self.lengths_m[1])
    }
}

#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    pub inputs: Vec<Change>,
    pub metrics: [Option<MetricsRow>; 2],
    /// Measurements of both, by number.
    pub chi: Vec<ChiPair>,
}

/// A stored result beside the same job run again.
#[derive(Clone, Debug, PartialEq)]
pub struct Rerun {
    /// Inputs that differ from the stored ones: versions of the program's stages.
    pub inputs: Vec<Change>,
    pub chi: Vec<ChiPair>,
    /// EI, as stored and as computed now.
    pub ei: [f64; 2],
}

pub fn record(store: &Store, id: JobId) -> Result<Record> {
    let sql = "SELECT program_version, git_commit, git_dirty, machine, seed FROM provenance WHERE job_id = ?";
    let row = |row: &Row<'_>| {
        Ok(ProvenanceRow {
            program_version: row.get(0)?,
            git_commit: row.get(1)?,
            git_dirty: row.get(2)?,
            machine: row.get(3)?,
            seed: row.get(4)?,
        })
    };
    Ok(Record {
        job: read::job(store, id)?,
        inputs: enqueue::inputs(store, id)?,
        stages: read::stages(store, id)?,
        provenance: store.reader.prepare_cached(sql)?.query_row([id.0], row).optional()?,
        metrics: read::metrics(store, id)?,
        chi: read::chi(store, id)?,
    })
}

pub fn compare(store: &Store, before: JobId, after: JobId) -> Result<Comparison> {
    let [a, b] = [record(store, before)?, record(store, after)?];
    Ok(Comparison {
        inputs: b.inputs.changes_since(&a.inputs),
        metrics: [a.metrics, b.metrics],
        chi: paired(&a.chi, &b.chi),
    })
}

/// Runs a job again from its stored inputs, without the cache. The stored result stays.
pub fn rerun(store: &Store, id: JobId) -> Result<Rerun> {
    let metrics = read::metrics(store, id)?.ok_or_else(|| StudyError::NotFound {
        what: "result of job",
        name: id.to_string(),
        known: vec![],
    })?;
    let spec = stored_spec(store, id)?;
    let folder = tempfile::tempdir().map_err(StudyError::io(std::env::temp_dir()))?;
    let scratch = folder.path().join("again.sqlite");
    drop(store::open(&scratch, Access::Create)?);
    let outcome = Pipeline::over(Cache::new(scratch)).execute(&spec, &mut Silent)?;
    Ok(Rerun {
        inputs: spec.inputs.changes_since(&enqueue::inputs(store, id)?),
        chi: paired(&read::chi(store, id)?, &rows_of(&outcome)),
        ei: [metrics.ei, outcome.metrics.ei],
    })
}

/// True if `page`, with its time `written_ms` (ms since 1970), is the report that this database last wrote of a study.
pub fn knows_report(store: &Store, study: &str, page: &Path, written_ms: i64) -> Result<bool> {
    let sql = "SELECT EXISTS (SELECT 1 FROM study_report JOIN study USING (study_id)
        WHERE name = ? AND page = ? AND written_at = ?)";
    let page = page.to_string_lossy();
    Ok(store.reader.prepare_cached(sql)?.query_row((study, page, written_ms), |row| row.get(0))?)
}

pub fn remember_report(store: &mut Store, study: &str, page: &Path, written_ms: i64) -> Result<()> {
    let sql = "INSERT OR REPLACE INTO study_report (study_id, page, written_at)
        SELECT study_id, ?, ? FROM study WHERE name = ?";
    store.writer()?.execute(sql, (page.to_string_lossy(), written_ms, study))?;
    Ok(())
}

pub(crate) fn stored_spec(store: &Store, id: JobId) -> Result<JobSpec> {
    let job = read::job(store, id)?;
    let inputs = enqueue::inputs(store, id)?;
    let edge_mm: f64 = inputs
        .iter()
        .find_map(|(name, value)| (name == "mesh.edge_length_mm").then(|| value.parse().ok())?)
        .ok_or(ResultsError::NoEdgeLength(id))?;
    let keys = "SELECT subject_id, style_id, size_id, fabric_id FROM job WHERE job_id = ?";
    let keys: [i64; 4] = store
        .reader
        .prepare_cached(keys)?
        .query_row([id.0], |row| Ok([row.get(0)?, row.get(1)?, row.get(2)?, row.get(3)?]))?;
    let StyleFiles { style, seams, pattern, unit } =
        read_style(&store.reader, SizeKey { style: keys[1], size: keys[2] })?;
    let person = catalogue::person(store, SubjectId(keys[0]))?;
    let is_scan = |(name, _): (&str, &str)| name.starts_with("subject.") && name.ends_with(".scan");
    if person.scan.is_none() && inputs.iter().any(is_scan) {
        return Err(ResultsError::ScanNotKept.into());
    }
    if inputs.iter().any(|(name, _)| name == "outfit.id") {
        return Err(ResultsError::Layer.into());
    }
    if inputs.iter().any(|(name, _)| name == CARRIED_FROM) {
        return Err(ResultsError::Carried.into());
    }
    let spec = JobSpec {
        garment: job.garment,
        style,
        size: job.size,
        subject: job.subject,
        simulator: job.simulator,
        repeat: job.repeat,
        person,
        pattern,
        unit,
        seams,
        fabric: read_fabric(&store.reader, keys[3])?,
        edge_length_m: from_mm(edge_mm),
        parameters: Parameters::of_inputs(&inputs).map_err(ResultsError::Parameters)?,
        schedule: Schedule::default(),
        outfit: None,
        dressed: None,
        inputs: Inputs::default(),
    };
    Ok(spec.with_inputs())
}

/// Measurements of an outcome as the database would return them, which stores millimetres.
fn rows_of(outcome: &Outcome) -> Vec<ChiRow> {
    let stored = |length_m: f64| from_mm(mm(length_m));
    let row = |m: &engine::Measured| ChiRow {
        stage: m.stage.as_str().to_owned(),
        no: m.chi.no,
        name: m.name.clone(),
        is_girth: m.kind == pattern::MeasurementKind::ClosedGirth,
        is_free_edge: m.is_free_edge,
        is_controlled: m.is_controlled,
        l2d_m: stored(m.chi.l2d_m),
        l3d_m: stored(m.chi.l3d_m),
    };
    outcome.measured.iter().map(row).collect()
}

/// Pairs the measurements of two results by number, each result at its last stage.
fn paired(a: &[ChiRow], b: &[ChiRow]) -> Vec<ChiPair> {
    let mut numbers: Vec<u32> = a.iter().chain(b).map(|row| row.no).collect();
    numbers.sort_unstable();
    numbers.dedup();
    let last_of = |rows: &[ChiRow], no: u32| rows.iter().rfind(|row| row.no == no).cloned();
    let pair = |no| {
        let both = [last_of(a, no), last_of(b, no)];
        let name = both.iter().flatten().next().map(|row| row.name.clone()).unwrap_or_default();
        ChiPair { no, name, lengths_m: both.map(|row| row.map(|row| (row.l2d_m, row.l3d_m))) }
    };
    numbers.into_iter().map(pair).collect()
}

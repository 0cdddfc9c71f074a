//! Files that hold jobs and results of jobs.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::error::EngineError;
use crate::outcome::{Outcome, Provenance};
use spec::JobSpec;
use store::{InOrigin, Origin, Result, StudyError};

pub(crate) const FORMAT: u32 = 1;
pub(crate) const JOB: &str = ".job.json";
pub(crate) const RESULT: &str = ".result.json";

#[derive(Serialize, Deserialize)]
pub(crate) struct JobFile {
    pub format: u32,
    pub study: String,
    pub provenance: Provenance,
    pub spec: JobSpec,
}

#[derive(Serialize, Deserialize)]
pub(crate) struct ResultFile {
    pub format: u32,
    pub study: String,
    pub input_hash: String,
    pub spec: JobSpec,
    pub provenance: Provenance,
    pub wall_ms: i64,
    pub outcome: std::result::Result<Outcome, String>,
    pub products: Vec<Product>,
}

/// A product of a stage in its compressed form, as base64.
#[derive(Serialize, Deserialize)]
pub(crate) struct Product {
    pub hash: String,
    pub kind: String,
    pub packed: String,
}

/// Leaves out the provenance, which the parent knows.
pub(crate) fn write_job(path: &Path, spec: &JobSpec) -> Result<()> {
    let (study, provenance) = (String::new(), Provenance::default());
    write_json(path, &JobFile { format: FORMAT, study, provenance, spec: spec.clone() })
}

pub(crate) fn read_outcome(path: &Path) -> Result<Outcome> {
    let result: ResultFile = read_json(path, Origin::Result)?;
    result.outcome.map_err(|message| StudyError::Elsewhere { message })
}

pub(crate) fn result_of(job: &Path) -> PathBuf {
    let name = job.file_name().unwrap_or_default().to_string_lossy().into_owned();
    job.with_file_name(format!("{}{RESULT}", name.strip_suffix(JOB).unwrap_or(&name)))
}

/// Result files, sorted by name.
pub(crate) fn results_in(folder: &Path) -> Result<Vec<PathBuf>> {
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(StudyError::io(folder))? {
        let path = entry.map_err(StudyError::io(folder))?.path();
        if path.file_name().is_some_and(|name| name.to_string_lossy().ends_with(RESULT)) {
            files.push(path);
        }
    }
    files.sort();
    Ok(files)
}

pub(crate) fn read_json<T: for<'de> Deserialize<'de>>(path: &Path, kind: Origin) -> Result<T> {
    #[derive(Deserialize)]
    struct Head {
        format: u32,
    }
    let bytes = std::fs::read(path).map_err(StudyError::io(path))?;
    let file = || path.to_owned();
    let other_file = |reason| EngineError::OtherFile { kind, file: file(), reason };
    let Head { format } = serde_json::from_slice(&bytes).map_err(other_file)?;
    if format != FORMAT {
        return Err(EngineError::Format { kind, file: file(), found: format, accepted: FORMAT }.into());
    }
    Ok(serde_json::from_slice(&bytes).map_err(|reason| EngineError::Content { kind, file: file(), reason })?)
}

/// Writes a file atomically: after a crash the whole file is there, or none of it.
pub(crate) fn write_json(path: &Path, value: &impl Serialize) -> Result<()> {
    let bytes = serde_json::to_vec(value).origin(Origin::Store)?;
    let part = path.with_file_name(format!(".{}.part", path.file_name().unwrap_or_default().to_string_lossy()));
    std::fs::write(&part, bytes).map_err(StudyError::io(&part))?;
    std::fs::File::open(&part).and_then(|file| file.sync_all()).map_err(StudyError::io(&part))?;
    std::fs::rename(&part, path).map_err(StudyError::io(path))
}

//! Jobs as files: handed out to run on any machine, and their results merged.
//!
//! A job file holds all inputs of a job, a result file all of its outputs. Neither needs a database. Results are merged
//! in one transaction, and merging them again changes nothing.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::time::Instant;

use base64::prelude::{BASE64_STANDARD, Engine};
use rusqlite::{Connection, OptionalExtension, Transaction, params};

use crate::enqueue::{self, Planned};
use crate::error::EngineError;
use crate::job_files::{FORMAT, JOB, JobFile, Product, ResultFile, read_json, result_of, results_in, write_json};
use crate::outcome::{self, Executor, Provenance};
use crate::own_process::{self, Clock, Teller};
use crate::pipeline::Pipeline;
use spec::{JobSpec, Selection, Study};
use store::cache::Cache;
use store::owner::Owner;
use store::queue::{self, Event};
use store::{Access, InOrigin, JobId, Origin, Result, Status, Store, StudyError, columns, evidence, now_ms};

#[derive(Clone, Debug, PartialEq)]
pub struct HandedOut {
    pub job: Planned,
    /// Job file; `None` where the job need not run.
    pub file: Option<PathBuf>,
}

#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Merged {
    pub stored: Vec<JobId>,
    /// Jobs that failed elsewhere and are now marked as failed.
    pub failed: Vec<JobId>,
    /// Jobs that had a result here before.
    pub known: Vec<JobId>,
    /// Jobs that a worker of this database is running, with the same result to come.
    pub running: Vec<JobId>,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Ran {
    /// The result file.
    pub file: PathBuf,
    pub error: Option<String>,
}

/// Queues a study and writes a file for each job that has to run. The same job always gets the same file name.
pub fn hand_out(store: &mut Store, study: &Study, selection: &Selection, folder: &Path) -> Result<Vec<HandedOut>> {
    selection.check(study)?;
    let planned = enqueue::queue(store, study, selection)?;
    std::fs::create_dir_all(folder).map_err(StudyError::io(folder))?;
    let provenance = Provenance::of(study.path.parent().unwrap_or(Path::new(".")));
    let mut handed = Vec::with_capacity(planned.len());
    for job in planned {
        let mut file = None;
        if job.why.will_run() {
            // Cells may share all inputs, such as variants of a sweep over a parameter that one simulator does not
            // have.
            let spec = job.cell.job(study);
            let path = folder.join(format!("{}-{}{JOB}", job.id, &spec.inputs.hash()[..16]));
            let study = study.name.clone();
            write_json(&path, &JobFile { format: FORMAT, study, provenance: provenance.clone(), spec })?;
            file = Some(path);
        }
        handed.push(HandedOut { job, file });
    }
    Ok(handed)
}

/// Merges result files, given singly or as folders, in one transaction: an unusable file leaves nothing stored. A job
/// that has a result here keeps it.
pub fn merge(store: &mut Store, paths: &[PathBuf]) -> Result<Merged> {
    let mut files = Vec::new();
    for path in paths {
        if path.is_dir() { files.extend(results_in(path)?) } else { files.push(path.clone()) }
    }
    let owner = Owner::new();
    let mut merged = Merged::default();
    let transaction = store::write(store.writer()?)?;
    let mut studies = BTreeSet::new();
    for path in &files {
        studies.insert(merge_one(&transaction, path, &owner, &mut merged)?);
    }
    transaction.commit()?;
    for study in &studies {
        evidence::update_evidence(store, study)?;
    }
    Ok(merged)
}

/// Runs a job file within its limits and writes its result to `output`, or beside the job file. The result of a job
/// that fails is the reason. With `database` the process belongs to a run: it keeps products there, ends with its
/// parent, and prints progress on standard output.
pub fn run_job(path: &Path, output: Option<&Path>, database: Option<&Path>) -> Result<Ran> {
    let job: JobFile = read_json(path, Origin::Job)?;
    if database.is_some() {
        own_process::end_with_parent();
    }
    own_process::keep_to(&job.spec.schedule.limits)?;
    let folder = tempfile::tempdir().map_err(StudyError::io(std::env::temp_dir()))?;
    let scratch = folder.path().join("job.sqlite");
    let connection = store::open(&scratch, Access::Create)?;
    let began = Instant::now();
    // Takes the versions of this program's stages; merging refuses a result of other versions.
    let spec = job.spec.with_inputs();
    let clock = Clock::start(&spec.schedule.limits);
    let mut teller = Teller { clock, is_heard: database.is_some(), last: None };
    let pipeline = Pipeline::over(Cache::new(database.map_or(scratch, Path::to_owned)));
    let outcome = match pipeline.execute(&spec, &mut teller) {
        Err(StudyError::Interrupted) => Err(teller.clock.error().into()),
        outcome => outcome,
    };
    let outcome = outcome.map_err(|error| error.to_string());
    let error = outcome.as_ref().err().cloned();
    let result = ResultFile {
        format: FORMAT,
        study: job.study,
        input_hash: spec.inputs.hash(),
        spec,
        provenance: Provenance { git: job.provenance.git, ..Provenance::here() },
        wall_ms: began.elapsed().as_millis() as i64,
        outcome,
        products: products(&connection)?,
    };
    let file = output.map_or_else(|| result_of(path), Path::to_owned);
    write_json(&file, &result)?;
    Ok(Ran { file, error })
}

fn products(connection: &Connection) -> Result<Vec<Product>> {
    let mut statement = connection.prepare("SELECT hash, kind, bytes FROM artefact ORDER BY hash")?;
    let product = |row: &rusqlite::Row<'_>| {
        let bytes: Vec<u8> = row.get(2)?;
        Ok(Product { hash: row.get(0)?, kind: row.get(1)?, packed: BASE64_STANDARD.encode(bytes) })
    };
    let products = statement.query_map([], product)?.collect::<rusqlite::Result<_>>()?;
    Ok(products)
}

/// Returns the name of the file's study.
fn merge_one(transaction: &Transaction<'_>, path: &Path, owner: &Owner, merged: &mut Merged) -> Result<String> {
    let result: ResultFile = read_json(path, Origin::Result)?;
    let spec = &result.spec;
    if spec.inputs.hash() != result.input_hash {
        return Err(EngineError::OtherInputs { file: path.to_owned() }.into());
    }
    let sql = "SELECT job_id, status FROM job JOIN study USING (study_id) WHERE study.name = ? AND garment = ?
        AND size = ? AND subject = ? AND simulator = ? AND repeat = ? AND input_hash = ?";
    let cell = params![
        result.study,
        spec.garment,
        spec.size,
        spec.subject,
        spec.simulator.as_str(),
        spec.repeat,
        result.input_hash
    ];
    let found = transaction
        .prepare_cached(sql)?
        .query_row(cell, |row| Ok((JobId(row.get(0)?), columns::status(row, 1)?)))
        .optional()?;
    let (id, status) = found.ok_or_else(|| {
        let JobSpec { garment, size, subject, .. } = spec;
        let [study, garment, size, subject] = [&result.study, garment, size, subject].map(String::clone);
        EngineError::UnknownJob { file: path.to_owned(), study, garment, size, subject }
    })?;
    match status {
        Status::Done | Status::NotConverged => merged.known.push(id),
        Status::Running => merged.running.push(id),
        Status::Failed if result.outcome.is_err() => merged.known.push(id),
        Status::Failed | Status::Cancelled | Status::Queued => {
            if status != Status::Queued {
                queue::apply(transaction, id, &Event::Retry, None)?;
            }
            queue::apply(transaction, id, &Event::Claim(owner.as_str()), None)?;
            take_products(transaction, &result.products)?;
            let outcome = result.outcome.map_err(|message| StudyError::Elsewhere { message });
            let is_failed = outcome.is_err();
            outcome::finish_in(transaction, id, spec, owner.as_str(), &outcome, &result.provenance)?;
            let sql = "UPDATE job SET wall_ms = ? WHERE job_id = ?";
            transaction.prepare_cached(sql)?.execute((result.wall_ms, id.0))?;
            queue::log(transaction, id, "info", &format!("merged; made on {}", result.provenance.machine))?;
            if is_failed { merged.failed.push(id) } else { merged.stored.push(id) }
        }
    }
    Ok(result.study)
}

/// Stores the products that the database does not have yet.
fn take_products(transaction: &Transaction<'_>, products: &[Product]) -> Result<()> {
    let sql = "INSERT OR IGNORE INTO artefact (hash, kind, bytes, created_at) VALUES (?, ?, ?, ?)";
    let mut statement = transaction.prepare_cached(sql)?;
    for product in products {
        let packed = BASE64_STANDARD.decode(&product.packed).origin(Origin::Merge)?;
        statement.execute(params![product.hash, product.kind, packed, now_ms()])?;
    }
    Ok(())
}

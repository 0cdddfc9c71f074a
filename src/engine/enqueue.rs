//! Keeps the queue in line with a study: a job for every cell (garment, size, subject, simulator, repeat) with new
//! inputs.

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

use rusqlite::{Connection, OptionalExtension, Transaction, params};

use crate::error::EngineError;
use fit::Simulator;
use fit::target::{TARGETS, is_girth};
use geom::units::mm;
use spec::{Cell, Change, Inputs, JobSpec, Limits, Selection, Study};
use store::owner::Watch;
use store::queue::{self, Event};
use store::{JobId, Result, Status, Store, StudyError, columns, now_ms, read};
use wardrobe::catalogue::revision::{self, By};

#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Why {
    New,
    /// An input differs from the latest earlier job of the cell.
    Changed {
        since: JobId,
        changes: Vec<Change>,
    },
    Waiting,
    /// The job failed or was cancelled before, with the same inputs.
    Again(Status),
    /// The job has a result for the same inputs.
    UpToDate(Status),
}

impl Why {
    pub fn will_run(&self) -> bool {
        !matches!(self, Self::UpToDate(_))
    }
}

impl std::fmt::Display for Why {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::New => f.write_str("new"),
            Self::Changed { since, changes } => {
                write!(f, "changed since job {since}: ")?;
                f.write_str(&changes.iter().map(Change::to_string).collect::<Vec<_>>().join("; "))
            }
            Self::Waiting => f.write_str("queued already"),
            Self::Again(status) => write!(f, "{} before, again", status.as_str().replace('_', " ")),
            Self::UpToDate(status) => write!(f, "up to date ({})", status.as_str().replace('_', " ")),
        }
    }
}

#[derive(Clone, Debug, PartialEq)]
pub struct Planned {
    pub id: JobId,
    pub cell: Cell,
    pub why: Why,
    /// True if the job was the current one of its cell before.
    pub was_current: bool,
}

pub fn queue(store: &mut Store, study: &Study, selection: &Selection) -> Result<Vec<Planned>> {
    let transaction = store::write(store.writer()?)?;
    let planned = enqueue(&transaction, study, selection)?;
    transaction.commit()?;
    Ok(planned)
}

/// Stores a study and queues those of its jobs that have to run, with those that failed or were cancelled. Cells that
/// the study no longer has lose their current job.
pub(crate) fn enqueue(transaction: &Transaction<'_>, study: &Study, selection: &Selection) -> Result<Vec<Planned>> {
    // Comes first: it may give up a job whose processes died too often, and who starts a run wants that job queued
    // again.
    queue::take_over(transaction, &mut Watch::default())?;
    let study_id = store_study(transaction, study)?;
    let cells = spec::cells(study);
    retire(transaction, study_id, study, &cells)?;
    let (mut keys, mut planned) = (SizeKeys::default(), Vec::new());
    for cell in cells {
        let spec = cell.job(study);
        keys.add(cell, study, &spec)?;
        if selection.takes(cell, study) {
            let (id, why, was_current) = enqueue_one(transaction, study_id, &spec)?;
            planned.push(Planned { id, cell, why, was_current });
        }
    }
    chain(transaction, study, &planned)?;
    Ok(planned)
}

/// Cells by the hashes of their inputs.
#[derive(Default)]
struct SizeKeys(BTreeMap<[u8; 32], Cell>);

impl SizeKeys {
    /// Checks that no two sizes have the same inputs, since one would then get the result of the other.
    fn add(&mut self, cell: Cell, study: &Study, spec: &JobSpec) -> Result<()> {
        let earlier = *self.0.entry(spec.inputs.digest()).or_insert(cell);
        let earlier = &earlier.size(study).name;
        if *earlier != spec.size {
            let JobSpec { garment, size, subject, .. } = spec;
            let [garment, earlier, size, subject] = [garment, earlier, size, subject].map(String::clone);
            return Err(EngineError::SameInputs { garment, earlier, size, subject }.into());
        }
        Ok(())
    }
}

/// Makes each job that has to run wait for the jobs of the same run which its garment comes `after`.
fn chain(transaction: &Transaction<'_>, study: &Study, planned: &[Planned]) -> Result<()> {
    if study.worn().all(|garment| garment.schedule.after.is_empty()) {
        return Ok(());
    }
    type Place<'a> = (&'a str, &'a str, Simulator);
    let mut places: BTreeMap<Place<'_>, Vec<JobId>> = BTreeMap::new();
    for Planned { id, cell, .. } in planned {
        let place = (&*cell.garment(study).name, &*cell.subject(study).id, cell.simulator);
        places.entry(place).or_default().push(*id);
    }
    for Planned { id, cell, why, .. } in planned.iter().filter(|job| job.why.will_run()) {
        let before = cell.garment(study).schedule.after.iter().filter_map(|garment| {
            let place: Place<'_> = (garment, &cell.subject(study).id, cell.simulator);
            places.get(&place)
        });
        let needs: Vec<JobId> = before.flatten().copied().collect();
        queue::set_needs(transaction, *id, &needs)?;
        if !needs.is_empty() && *why != Why::Waiting {
            let numbers: Vec<String> = needs.iter().map(ToString::to_string).collect();
            queue::log(transaction, *id, "info", &format!("waits for jobs {}", numbers.join(", ")))?;
        }
    }
    Ok(())
}

fn home_of(study: &Study) -> PathBuf {
    study.path.canonicalize().unwrap_or_else(|_| study.path.clone())
}

/// Path of the study file whose results are stored under this name.
fn stored_home(connection: &Connection, name: &str) -> Result<Option<PathBuf>> {
    let path = connection.query_row("SELECT path FROM study WHERE name = ?", [name], |row| row.get::<_, String>(0));
    Ok(path.optional()?.map(PathBuf::from))
}

/// Gives the stored results of a study to the file at its present place.
pub fn move_home(store: &mut Store, study: &Study) -> Result<()> {
    let path = home_of(study);
    store.writer()?.execute("UPDATE study SET path = ? WHERE name = ?", params![path.to_string_lossy(), study.name])?;
    Ok(())
}

/// Updates the study's own row and the order of its axes.
pub(crate) fn store_study(transaction: &Transaction<'_>, study: &Study) -> Result<i64> {
    let path = home_of(study);
    if let Some(stored) = stored_home(transaction, &study.name)?.filter(|stored| *stored != path && stored.exists()) {
        return Err(StudyError::HomeTaken { name: study.name.clone(), stored, found: path });
    }
    let study_id = transaction.query_row(
        "INSERT INTO study (name, path, tight_below_mm, loose_above_mm, updated_at) VALUES (?, ?, ?, ?, ?)
            ON CONFLICT (name) DO UPDATE SET path = excluded.path, tight_below_mm = excluded.tight_below_mm,
                loose_above_mm = excluded.loose_above_mm, updated_at = excluded.updated_at
            RETURNING study_id",
        params![
            study.name,
            path.to_string_lossy(),
            mm(study.cuts.tight_below_m),
            mm(study.cuts.loose_above_m),
            now_ms()
        ],
        |row| row.get(0),
    )?;
    transaction.execute("DELETE FROM study_axis WHERE study_id = ?", [study_id])?;
    let garments = study.worn().map(|garment| ("garment", &garment.name));
    let sizes = study.worn().flat_map(|garment| &garment.sizes).map(|size| ("size", &size.name));
    let subjects = study.subjects.iter().map(|subject| ("subject", &subject.id));
    for (position, (axis, name)) in garments.chain(sizes).chain(subjects).enumerate() {
        transaction
            .prepare_cached("INSERT OR IGNORE INTO study_axis (study_id, axis, name, position) VALUES (?, ?, ?, ?)")?
            .execute(params![study_id, axis, name, position as i64])?;
    }
    transaction.execute("DELETE FROM study_sweep WHERE study_id = ?", [study_id])?;
    for garment in &study.garments {
        for (name, value) in &garment.swept {
            transaction
                .prepare_cached(
                    "INSERT INTO study_sweep (study_id, garment, style, name, value) VALUES (?, ?, ?, ?, ?)",
                )?
                .execute(params![study_id, garment.name, garment.style, name, value])?;
        }
    }
    store_targets(transaction, study_id, study)?;
    Ok(study_id)
}

fn store_targets(transaction: &Transaction<'_>, study_id: i64, study: &Study) -> Result<()> {
    transaction.execute("DELETE FROM fit_target WHERE study_id = ?", [study_id])?;
    let mut statement = transaction.prepare_cached(
        "INSERT INTO fit_target (study_id, garment, level, is_top, intended, least_mm, most_mm, is_firm, must_close)
        VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?)",
    )?;
    for garment in study.worn() {
        let own = garment.target.own_m.keys().map(String::as_str);
        let levels: BTreeSet<&str> = TARGETS.iter().map(|row| row.level).chain(own).collect();
        for (level, is_top) in levels.into_iter().flat_map(|level| [(level, false), (level, true)]) {
            let Some([least, most]) = garment.target.meant_m(level, is_top).map(|band| band.map(mm)) else { continue };
            let intended = garment.target.intended.as_str();
            let is_firm = garment.target.is_firm(level);
            let must_close = garment.target.is_rigid && is_girth(level);
            statement.execute(params![
                study_id,
                garment.name,
                level,
                is_top,
                intended,
                least,
                most,
                is_firm,
                must_close
            ])?;
        }
    }
    Ok(())
}

/// Garment, size and subject; simulator; repeat.
type Names<'a> = ([&'a str; 3], Simulator, u32);

/// Removes cells that a study no longer has from its jobs and eases. Their results stay in the database.
fn retire(transaction: &Transaction<'_>, study_id: i64, study: &Study, cells: &[Cell]) -> Result<()> {
    let names = |cell: &Cell| -> Names<'_> {
        let worn = [&*cell.garment(study).name, &*cell.size(study).name, &*cell.subject(study).id];
        (worn, cell.simulator, cell.repeat)
    };
    let known: BTreeSet<Names<'_>> = cells.iter().map(names).collect();
    let mut gone = Vec::new();
    let mut statement = transaction.prepare_cached(
        "SELECT job_id, garment, size, subject, simulator, repeat FROM job WHERE study_id = ? AND is_current",
    )?;
    let mut rows = statement.query([study_id])?;
    while let Some(row) = rows.next()? {
        let [garment, size, subject]: [String; 3] = [row.get(1)?, row.get(2)?, row.get(3)?];
        let cell: Names<'_> = ([&garment, &size, &subject], columns::simulator(row, 4)?, row.get(5)?);
        if !known.contains(&cell) {
            gone.push(JobId(row.get(0)?));
        }
    }
    drop(rows);
    drop(statement);
    for id in gone {
        supersede(transaction, id)?;
    }
    let is_worn = |worn: [&str; 3]| {
        let first: Names<'_> = (worn, Simulator::ALL[0], 0);
        known.range(first..).next().is_some_and(|(found, ..)| *found == worn)
    };
    let mut unworn: Vec<[String; 3]> = Vec::new();
    let mut statement =
        transaction.prepare_cached("SELECT DISTINCT garment, size, subject FROM ease WHERE study_id = ?")?;
    let mut rows = statement.query([study_id])?;
    while let Some(row) = rows.next()? {
        let eased: [String; 3] = [row.get(0)?, row.get(1)?, row.get(2)?];
        if !is_worn(eased.each_ref().map(String::as_str)) {
            unworn.push(eased);
        }
    }
    for [garment, size, subject] in unworn {
        let sql = "DELETE FROM ease WHERE study_id = ? AND garment = ? AND size = ? AND subject = ?";
        transaction.prepare_cached(sql)?.execute(params![study_id, garment, size, subject])?;
    }
    Ok(())
}

/// Finds or inserts a job and makes it current. Returns why it runs, and true if it was the current one before.
fn enqueue_one(transaction: &Transaction<'_>, study_id: i64, spec: &JobSpec) -> Result<(JobId, Why, bool)> {
    let hash = spec.inputs.hash();
    let same = transaction
        .prepare_cached(
            "SELECT job_id, status FROM job WHERE study_id = ? AND garment = ? AND size = ? AND subject = ?
                AND simulator = ? AND repeat = ? AND input_hash = ?",
        )?
        .query_row(
            params![study_id, spec.garment, spec.size, spec.subject, spec.simulator.as_str(), spec.repeat, hash],
            |row| Ok((JobId(row.get(0)?), columns::status(row, 1)?)),
        )
        .optional()?;
    let earlier = latest_of_cell(transaction, study_id, spec)?;
    if let Some((id, status)) = same {
        make_current(transaction, id, earlier)?;
        set_limits(transaction, id, spec)?;
        let why = match status {
            Status::Done | Status::NotConverged => Why::UpToDate(status),
            Status::Queued | Status::Running => Why::Waiting,
            Status::Failed | Status::Cancelled => {
                queue::apply(transaction, id, &Event::Retry, None)?;
                Why::Again(status)
            }
        };
        return Ok((id, why, earlier == Some(id)));
    }
    let why = match earlier {
        Some(since) => Why::Changed { since, changes: spec.inputs.changes_since(&inputs_of(transaction, since)?) },
        None => Why::New,
    };
    if let Some(old) = earlier {
        supersede(transaction, old)?;
    }
    let id = insert(transaction, study_id, spec, &hash)?;
    queue::log(transaction, id, "info", &format!("queued: {why}"))?;
    Ok((id, why, false))
}

/// The current job of a specification's cell.
fn latest_of_cell(transaction: &Transaction<'_>, study_id: i64, spec: &JobSpec) -> Result<Option<JobId>> {
    let sql = "SELECT job_id FROM job WHERE study_id = ? AND garment = ? AND size = ? AND subject = ? AND simulator = ?
        AND repeat = ? AND is_current";
    let cell = params![study_id, spec.garment, spec.size, spec.subject, spec.simulator.as_str(), spec.repeat];
    Ok(transaction.prepare_cached(sql)?.query_row(cell, |row| row.get(0).map(JobId)).optional()?)
}

fn make_current(transaction: &Transaction<'_>, id: JobId, current: Option<JobId>) -> Result<()> {
    if let Some(old) = current.filter(|&old| old != id) {
        supersede(transaction, old)?;
    }
    transaction.prepare_cached("UPDATE job SET is_current = 1 WHERE job_id = ?")?.execute([id.0])?;
    Ok(())
}

fn set_limits(transaction: &Transaction<'_>, id: JobId, spec: &JobSpec) -> Result<()> {
    let Limits { time_s, memory_mb } = spec.schedule.limits;
    let sql = "UPDATE job SET time_limit_s = ?1, memory_limit_mb = ?2
        WHERE job_id = ?3 AND (time_limit_s IS NOT ?1 OR memory_limit_mb IS NOT ?2)";
    transaction.prepare_cached(sql)?.execute(params![time_s, memory_mb, id.0])?;
    Ok(())
}

/// Removes a job from its cell, and cancels it unless it has ended. No other job waits for it any more.
fn supersede(transaction: &Transaction<'_>, id: JobId) -> Result<()> {
    transaction.prepare_cached("DELETE FROM job_need WHERE needs = ?")?.execute([id.0])?;
    transaction.prepare_cached("UPDATE job SET is_current = 0 WHERE job_id = ?")?.execute([id.0])?;
    if queue::apply(transaction, id, &Event::Cancel, None)?.is_some() {
        queue::log(transaction, id, "info", "cancelled: an input of the study changed")?;
    }
    Ok(())
}

fn insert(transaction: &Transaction<'_>, study_id: i64, spec: &JobSpec, hash: &str) -> Result<JobId> {
    let (by, unit) = (By::Study, spec.unit.as_deref());
    let subject = revision::subject(transaction, &spec.subject, &spec.person, by)?.id;
    let style = revision::style(transaction, &spec.style, spec.seams.as_ref(), by)?.id;
    let size = revision::size(transaction, (&spec.style, &spec.size), &spec.pattern, unit, by)?.id;
    let fabric = revision::fabric(transaction, &spec.fabric, by)?.id;
    transaction
        .prepare_cached(
            "INSERT INTO job (study_id, garment, size, subject, simulator, repeat, input_hash, priority, status, queued_at,
                subject_id, style_id, size_id, fabric_id)
            VALUES (?, ?, ?, ?, ?, ?, ?, ?, 'queued', ?, ?, ?, ?, ?)",
        )?
        .execute(params![
            study_id,
            spec.garment,
            spec.size,
            spec.subject,
            spec.simulator.as_str(),
            spec.repeat,
            hash,
            spec.schedule.priority,
            now_ms(),
            subject,
            style,
            size,
            fabric
        ])?;
    let id = JobId(transaction.last_insert_rowid());
    set_limits(transaction, id, spec)?;
    let mut statement = transaction.prepare_cached("INSERT INTO job_input (job_id, name, value) VALUES (?, ?, ?)")?;
    for (name, value) in spec.inputs.iter() {
        statement.execute(params![id.0, name, value])?;
    }
    Ok(id)
}

/// Reason why a job had no result yet: the inputs that differ from the latest earlier job of its cell.
pub fn why(store: &Store, id: JobId) -> Result<Why> {
    read::job(store, id)?;
    let sql =
        "SELECT earlier.job_id FROM job JOIN job AS earlier USING (study_id, garment, size, subject, simulator, repeat)
        WHERE job.job_id = ?1 AND earlier.job_id < ?1 ORDER BY earlier.job_id DESC LIMIT 1";
    let earlier = store.reader.prepare_cached(sql)?.query_row([id.0], |row| row.get(0).map(JobId)).optional()?;
    let Some(since) = earlier else { return Ok(Why::New) };
    let changes = inputs_of(&store.reader, id)?.changes_since(&inputs_of(&store.reader, since)?);
    Ok(Why::Changed { since, changes })
}

pub fn inputs(store: &Store, id: JobId) -> Result<Inputs> {
    inputs_of(&store.reader, id)
}

pub(crate) fn inputs_of(connection: &Connection, id: JobId) -> Result<Inputs> {
    let mut statement = connection.prepare_cached("SELECT name, value FROM job_input WHERE job_id = ?")?;
    let inputs = statement.query_map([id.0], |row| Ok((row.get(0)?, row.get(1)?)))?;
    Ok(inputs.collect::<rusqlite::Result<_>>()?)
}

//! Queries for screens and reports, each beside the row that it fills.

use std::collections::BTreeMap;

use rusqlite::{OptionalExtension, Row, ToSql, named_params};

use crate::columns::{fit_class, simulator, status};
use crate::database::Store;
use crate::error::{Result, StudyError};
use crate::rows::{
    Cell, ChiRow, EaseRow, FitCell, Grid, INSIDE_M, JobId, JobProgress, JobRow, LogLine, MetricsRow, OutfitRow,
    RecommendationRow, StageRow, Status, StudyRow,
};
use fit::{Cuts, Simulator};
use geom::units::{from_mm, mm};
use sim::Step;

/// Selection of jobs; `None` in a field accepts all.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct JobFilter {
    pub study: Option<String>,
    pub status: Option<Status>,
    /// True to include jobs whose inputs are no longer those of the study.
    pub superseded: bool,
}

/// Sorted by name.
pub fn studies(store: &Store) -> Result<Vec<StudyRow>> {
    let sql = "SELECT name, path, paused, study_id FROM study ORDER BY name";
    let mut studies = rows(store, sql, &[], |row| {
        let path: String = row.get(1)?;
        let study =
            StudyRow { name: row.get(0)?, path: path.into(), paused: row.get(2)?, counts: [0; 6], garments: vec![] };
        Ok((study, row.get::<_, i64>(3)?))
    })?;
    let count = "SELECT status, count(*) FROM job WHERE study_id = ? AND is_current GROUP BY status";
    for (study, id) in &mut studies {
        for (status, n) in rows(store, count, &[id], |row| Ok((status(row, 0)?, row.get::<_, i64>(1)?)))? {
            study.counts[status as usize] = n as usize;
        }
        study.garments = axis(store, &study.name, "garment")?;
    }
    Ok(studies.into_iter().map(|(study, _)| study).collect())
}

pub fn study(store: &Store, name: &str) -> Result<StudyRow> {
    let studies = studies(store)?;
    let known = studies.iter().map(|s| s.name.clone()).collect();
    let found = studies.into_iter().find(|s| s.name == name);
    found.ok_or_else(|| StudyError::NotFound { what: "study", name: name.to_owned(), known })
}

/// Names on one axis (`size`, `subject`) of a study, in the order of its file.
fn axis(store: &Store, study: &str, axis: &str) -> Result<Vec<String>> {
    let sql = "SELECT study_axis.name FROM study_axis JOIN study USING (study_id)
        WHERE study.name = ? AND axis = ? ORDER BY position";
    rows(store, sql, &[&study, &axis], |row| row.get(0))
}

#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Place<'a> {
    size: &'a str,
    subject: &'a str,
    simulator: Simulator,
}

impl<'a> Place<'a> {
    fn of(job: &'a JobRow) -> Self {
        Self { size: &job.size, subject: &job.subject, simulator: job.simulator }
    }
}

pub fn grid(store: &Store, study: &str, garment: &str) -> Result<Grid> {
    self::study(store, study)?;
    let jobs: Vec<JobRow> = jobs(store, &JobFilter { study: Some(study.to_owned()), ..JobFilter::default() })?
        .into_iter()
        .filter(|job| job.garment == garment && job.repeat == 1)
        .collect();
    let eases: Vec<EaseRow> =
        ease(store, study)?.into_iter().filter(|ease| ease.garment == garment && ease.decides).collect();
    let mut subjects = axis(store, study, "subject")?;
    subjects.retain(|name| jobs.iter().any(|job| job.subject == *name) || eases.iter().any(|e| e.subject == *name));
    let mut sizes = axis(store, study, "size")?;
    sizes.retain(|name| jobs.iter().any(|job| job.size == *name) || eases.iter().any(|ease| ease.size == *name));
    let mut simulators: Vec<Simulator> = jobs.iter().map(|job| job.simulator).collect();
    simulators.sort();
    simulators.dedup();

    let by_place: BTreeMap<Place<'_>, &JobRow> = jobs.iter().map(|job| (Place::of(job), job)).collect();
    let fit_of: BTreeMap<(&str, &str), FitCell> =
        eases.iter().map(|ease| ((ease.size.as_str(), ease.subject.as_str()), ease.fit)).collect();
    let cell = |place: Place<'_>| {
        let job = by_place.get(&place);
        Cell {
            job: job.map(|job| job.id),
            status: job.map(|job| job.status),
            fraction: job.and_then(|job| job.progress.as_ref()).map(|progress| progress.fraction),
            ei: job.and_then(|job| job.ei),
            is_inside: job.is_some_and(|job| job.inside().is_some()),
        }
    };
    let cells_of_size = |size: &String| -> Vec<Vec<Cell>> {
        let cells_on =
            |subject: &String| simulators.iter().map(|&simulator| cell(Place { size, subject, simulator })).collect();
        subjects.iter().map(cells_on).collect()
    };
    let fits_of_size = |size: &String| -> Vec<Option<FitCell>> {
        subjects.iter().map(|subject| fit_of.get(&(size.as_str(), subject.as_str())).copied()).collect()
    };
    let cells = sizes.iter().map(cells_of_size).collect();
    let fits = sizes.iter().map(fits_of_size).collect();
    Ok(Grid { study: study.to_owned(), garment: garment.to_owned(), sizes, subjects, simulators, cells, fits })
}

/// Fabric of each garment of a study, by name: that of its first current job.
pub fn cloths(store: &Store, study: &str) -> Result<BTreeMap<String, String>> {
    let sql =
        "SELECT garment, fabric.name, min(job_id) FROM job JOIN study USING (study_id) JOIN fabric USING (fabric_id)
        WHERE study.name = ? AND is_current GROUP BY garment";
    Ok(rows(store, sql, &[&study], |row| Ok((row.get(0)?, row.get(1)?)))?.into_iter().collect())
}

/// Sorted by study, then in the order of queueing.
pub fn jobs(store: &Store, filter: &JobFilter) -> Result<Vec<JobRow>> {
    let sql = format!(
        "{SELECT_JOB} WHERE (:study IS NULL OR study.name = :study) AND (:status IS NULL OR status = :status)
            AND (is_current OR :superseded)
        ORDER BY study.name, job_id"
    );
    let mut statement = store.reader.prepare_cached(&sql)?;
    let parameters = named_params! {
        ":study": filter.study, ":status": filter.status.map(Status::as_str), ":superseded": filter.superseded,
    };
    let jobs = statement.query_map(parameters, job_row)?.collect::<rusqlite::Result<_>>()?;
    Ok(jobs)
}

pub fn job(store: &Store, id: JobId) -> Result<JobRow> {
    let sql = format!("{SELECT_JOB} WHERE job_id = ?");
    let found = store.reader.prepare_cached(&sql)?.query_row([id.0], job_row).optional()?;
    found.ok_or_else(|| StudyError::NotFound { what: "job", name: id.to_string(), known: vec![] })
}

/// Number of current results of a study that lie inside the body by more than [`INSIDE_M`].
pub fn inside(store: &Store, study: &str) -> Result<usize> {
    let sql = "SELECT count(*) FROM job JOIN study USING (study_id) JOIN metrics USING (job_id)
        WHERE study.name = ? AND is_current AND penetration_max_mm > ?";
    let count: i64 =
        store.reader.prepare_cached(sql)?.query_row(rusqlite::params![study, mm(INSIDE_M)], |row| row.get(0))?;
    Ok(count as usize)
}

/// Sorted by stage of measurement and by number.
pub fn chi(store: &Store, id: JobId) -> Result<Vec<ChiRow>> {
    let sql =
        "SELECT stage, measurement_no, measurement, kind = 'closed_girth', is_free_edge, is_controlled, l2d_mm, l3d_mm
        FROM chi WHERE job_id = ? ORDER BY stage = 'drape', stage = 'popup', measurement_no";
    rows(store, sql, &[&id.0], |row| {
        Ok(ChiRow {
            stage: row.get(0)?,
            no: row.get(1)?,
            name: row.get(2)?,
            is_girth: row.get(3)?,
            is_free_edge: row.get(4)?,
            is_controlled: row.get(5)?,
            l2d_m: from_mm(row.get(6)?),
            l3d_m: from_mm(row.get(7)?),
        })
    })
}

/// `None` while there is no result.
pub fn metrics(store: &Store, id: JobId) -> Result<Option<MetricsRow>> {
    let sql = "SELECT n, e_chi, sd_chi, ei, max_abs_error, vertices, faces, iterations, residual, converged,
            penetration_max_mm, seam_gap_max_mm, self_crossings, distortion
        FROM metrics WHERE job_id = ?";
    let row = |row: &Row<'_>| {
        Ok(MetricsRow {
            n: row.get(0)?,
            e_chi: row.get(1)?,
            sd_chi: row.get(2)?,
            ei: row.get(3)?,
            max_abs_error: row.get(4)?,
            vertices: row.get(5)?,
            faces: row.get(6)?,
            iterations: row.get(7)?,
            residual: row.get(8)?,
            converged: row.get(9)?,
            penetration_max_m: from_mm(row.get(10)?),
            seam_gap_max_m: from_mm(row.get(11)?),
            self_crossings: row.get(12)?,
            distortion: row.get(13)?,
        })
    };
    Ok(store.reader.prepare_cached(sql)?.query_row([id.0], row).optional()?)
}

pub fn history(store: &Store, id: JobId) -> Result<Vec<Step>> {
    let sql = "SELECT iteration, level, residual, seam_gap_mm, e_chi FROM history WHERE job_id = ? ORDER BY step";
    rows(store, sql, &[&id.0], |row| step(row, 0))
}

/// Oldest first.
pub fn log(store: &Store, id: JobId) -> Result<Vec<LogLine>> {
    rows(store, "SELECT at, level, text FROM job_log WHERE job_id = ? ORDER BY log_id", &[&id.0], |row| {
        Ok(LogLine { at_ms: row.get(0)?, level: row.get(1)?, text: row.get(2)? })
    })
}

pub fn stages(store: &Store, id: JobId) -> Result<Vec<StageRow>> {
    let sql = "SELECT kind, hash, was_cached FROM job_artefact WHERE job_id = ? ORDER BY kind";
    rows(store, sql, &[&id.0], |row| Ok(StageRow { stage: row.get(0)?, hash: row.get(1)?, was_cached: row.get(2)? }))
}

/// Jobs of the layers under a layer of an outfit, the inmost first; empty for a garment that is worn alone.
pub fn layers_under(store: &Store, id: JobId) -> Result<Vec<JobId>> {
    let sql = "SELECT under.job_id FROM v_outfit AS own JOIN v_outfit AS under USING (study, outfit, simulator, repeat)
        JOIN job_input AS of_own ON of_own.job_id = own.job_id AND of_own.name = 'outfit.id'
        JOIN job_input AS of_under ON of_under.job_id = under.job_id AND of_under.name = 'outfit.id'
        WHERE own.job_id = ? AND under.layer < own.layer AND of_own.value = of_under.value ORDER BY under.layer";
    rows(store, sql, &[&id.0], |row| Ok(JobId(row.get(0)?)))
}

pub fn outfits(store: &Store) -> Result<Vec<OutfitRow>> {
    // One job tells of which layer a garment is.
    let sql = "SELECT study.name, outfit.value, first.garment, style.name
        FROM (SELECT study_id, garment, min(job_id) AS job_id FROM job WHERE is_current GROUP BY study_id, garment) AS first
        JOIN study USING (study_id) JOIN job USING (job_id) JOIN style USING (style_id)
        JOIN job_input AS outfit ON outfit.job_id = first.job_id AND outfit.name = 'outfit.name'
        JOIN job_input AS layer ON layer.job_id = first.job_id AND layer.name = 'outfit.layer'
        ORDER BY study.name, outfit.value, CAST(layer.value AS INTEGER)";
    let mut outfits: Vec<OutfitRow> = vec![];
    let layer = |row: &Row<'_>| Ok((row.get(0)?, row.get(1)?, (row.get(2)?, row.get(3)?)));
    for (study, name, layer) in rows(store, sql, &[], layer)? {
        match outfits.last_mut().filter(|last| (&last.study, &last.name) == (&study, &name)) {
            Some(last) => last.layers.push(layer),
            None => outfits.push(OutfitRow { study, name, layers: vec![layer] }),
        }
    }
    Ok(outfits)
}

pub fn ease(store: &Store, study: &str) -> Result<Vec<EaseRow>> {
    let sql = "SELECT garment, size, subject, level, pattern_girth_mm, body_girth_mm, decides, fit_class, ease_mm,
            undersized, borderline
        FROM v_ease WHERE study = :study
        ORDER BY garment,
            (SELECT position FROM study_axis JOIN study USING (study_id)
                WHERE study.name = :study AND axis = 'size' AND study_axis.name = size),
            (SELECT position FROM study_axis JOIN study USING (study_id)
                WHERE study.name = :study AND axis = 'subject' AND study_axis.name = subject),
            level";
    rows(store, sql, &[&study], |row| {
        let fit = FitCell {
            class: fit_class(row, 7)?,
            ease_m: from_mm(row.get(8)?),
            undersized: row.get(9)?,
            borderline: row.get(10)?,
        };
        Ok(EaseRow {
            garment: row.get(0)?,
            size: row.get(1)?,
            subject: row.get(2)?,
            level: row.get(3)?,
            pattern_girth_m: from_mm(row.get(4)?),
            body_girth_m: from_mm(row.get(5)?),
            decides: row.get(6)?,
            fit,
        })
    })
}

pub fn recommendations(store: &Store, study: &str) -> Result<Vec<RecommendationRow>> {
    let sql = "SELECT garment, fit_class, recommended, basis, verdict, rule_says, effect, ci_low, ci_high, n_subjects, reason,
            p_holm, would_settle
        FROM v_recommendation WHERE study = ? ORDER BY garment, fit_class";
    rows(store, sql, &[&study], |row| {
        let bounds: (Option<f64>, Option<f64>) = (row.get(7)?, row.get(8)?);
        Ok(RecommendationRow {
            garment: row.get(0)?,
            class: fit_class(row, 1)?,
            recommended: simulator(row, 2)?,
            basis: row.get(3)?,
            verdict: row.get(4)?,
            rule_says: simulator(row, 5)?,
            effect: row.get(6)?,
            interval: bounds.0.zip(bounds.1),
            n_subjects: row.get(9)?,
            reason: row.get(10)?,
            p_holm: row.get(11)?,
            would_settle: row.get(12)?,
        })
    })
}

fn rows<T>(
    store: &Store,
    sql: &str,
    parameters: &[&dyn ToSql],
    row: impl FnMut(&Row<'_>) -> rusqlite::Result<T>,
) -> Result<Vec<T>> {
    let mut statement = store.reader.prepare_cached(sql)?;
    let rows = statement.query_map(parameters, row)?.collect::<rusqlite::Result<_>>()?;
    Ok(rows)
}

/// The columns that [`job_row`] reads.
const SELECT_JOB: &str =
    "SELECT job_id, study.name, garment, size, subject, simulator, repeat, status, is_current, priority,
        attempts, error, queued_at, started_at, finished_at, wall_ms, metrics.ei, metrics.penetration_max_mm,
        phase, fraction, p.iteration, p.level, p.residual, p.seam_gap_mm, p.e_chi
    FROM job JOIN study USING (study_id) LEFT JOIN metrics USING (job_id)
        LEFT JOIN job_progress AS p USING (job_id)";

fn job_row(row: &Row<'_>) -> rusqlite::Result<JobRow> {
    let status = status(row, 7)?;
    let phase: Option<String> = row.get(18)?;
    let progress = match phase {
        Some(phase) if status == Status::Running => {
            Some(JobProgress { phase, fraction: row.get(19)?, step: step(row, 20)? })
        }
        _ => None,
    };
    Ok(JobRow {
        id: JobId(row.get(0)?),
        study: row.get(1)?,
        garment: row.get(2)?,
        size: row.get(3)?,
        subject: row.get(4)?,
        simulator: simulator(row, 5)?,
        repeat: row.get(6)?,
        status,
        is_current: row.get(8)?,
        priority: row.get(9)?,
        attempts: row.get(10)?,
        error: row.get(11)?,
        queued_at_ms: row.get(12)?,
        started_at_ms: row.get(13)?,
        finished_at_ms: row.get(14)?,
        wall_ms: row.get(15)?,
        ei: row.get(16)?,
        penetration_max_m: row.get::<_, Option<f64>>(17)?.map(from_mm),
        progress,
    })
}

/// Offset of the machine's local time from UTC at a time in ms since 1970, ms. SQLite asks the system for its zone.
pub fn local_offset_ms(store: &Store, at_ms: i64) -> Result<i64> {
    let sql = "SELECT 1000 * (CAST(strftime('%s', ?1, 'unixepoch', 'localtime') AS INTEGER) - ?1)";
    Ok(store.reader.prepare_cached(sql)?.query_row([at_ms.div_euclid(1000)], |row| row.get(0))?)
}

/// Reads a step from five columns, from column `first` on. NULL stands for NaN, as SQLite stores it.
fn step(row: &Row<'_>, first: usize) -> rusqlite::Result<Step> {
    let number = |k: usize| row.get::<_, Option<f64>>(first + k).map(|x| x.unwrap_or(f64::NAN));
    Ok(Step {
        iteration: row.get(first)?,
        level: row.get(first + 1)?,
        residual: number(2)?,
        seam_gap_m: from_mm(number(3)?),
        e_chi: number(4)?,
    })
}

/// Eases at which the fit classes of a study meet; the default ones where the study is not stored.
pub fn cuts(store: &Store, study: &str) -> Result<Cuts> {
    let sql = "SELECT tight_below_mm / 1000, loose_above_mm / 1000 FROM study WHERE name = ?";
    let read = |row: &Row<'_>| Ok(Cuts { tight_below_m: row.get(0)?, loose_above_m: row.get(1)? });
    Ok(store.reader.query_row(sql, [study], read).optional()?.unwrap_or_default())
}

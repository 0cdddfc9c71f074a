//! Audit of the results of a study: the stored meshes measured again.

use std::collections::BTreeMap;

use crate::audit::{Audit, Finding};
use crate::picture;
use engine::stages::{Meshes, Model};
use fit::measure::{self, Chi, Metrics};
use geom::units::mm;
use sim::{Drape, quality};
use store::{ChiRow, JobFilter, JobRow, MetricsRow, Result, StageKind, Status, Store, Value, read, sql};

/// Greatest difference between a stored and a measured length that counts as none.
const SAME_M: f64 = 1e-9;
const SAME: f64 = 1e-9;
/// Deepest penetration that is no defect.
const PENETRATION_M: f64 = 0.5e-3;

pub(super) fn audit(store: &Store, study: &str) -> Result<Audit> {
    read::study(store, study)?;
    let jobs = read::jobs(store, &JobFilter { study: Some(study.to_owned()), ..JobFilter::default() })?;
    let mut audit = Audit { recomputed: 0, findings: Vec::new() };
    let mut patterns = BTreeMap::new();
    let mut lengths = BTreeMap::new();
    for job in &jobs {
        audit.findings.extend(state(job));
        if !job.status.has_result() {
            continue;
        }
        let chis = read::chi(store, job.id)?;
        audit.recomputed += remeasure(store, job, &chis, &mut audit.findings)?;
        audit.findings.extend(pattern(job, &chis, &mut patterns));
        audit.findings.extend(copy(job, &chis, &mut lengths));
    }
    audit.findings.extend(provenance(store, study)?);
    Ok(audit)
}

fn place(job: &JobRow) -> String {
    format!("job {}: {} {} on {}, {}", job.id, job.garment, job.size, job.subject, job.simulator.as_str())
}

fn state(job: &JobRow) -> Option<Finding> {
    let says = match job.status {
        Status::Done => return None,
        Status::NotConverged => "did not reach its tolerance: keep it out of comparisons",
        Status::Failed => "has no result",
        Status::Queued | Status::Running => "has no result yet",
        Status::Cancelled => "was cancelled",
    };
    let why = job.error.clone().unwrap_or_default();
    Some(Finding {
        kind: "job",
        place: place(job),
        stated: job.status.as_str().into(),
        recomputed: why,
        says: says.into(),
    })
}

/// Measures the mesh of a result again. Returns the count of numbers computed.
fn remeasure(store: &Store, job: &JobRow, chis: &[ChiRow], findings: &mut Vec<Finding>) -> Result<usize> {
    let stored = read::metrics(store, job.id)?;
    let read = || -> Result<_> {
        let model: Model = picture::product(store, job.id, StageKind::Body)?;
        let meshes: Meshes = picture::product(store, job.id, StageKind::Mesh)?;
        let drape: Drape = picture::product(store, job.id, StageKind::Drape)?;
        Ok((model, meshes, drape))
    };
    let (model, meshes, drape) = match read() {
        Ok(products) => products,
        Err(error) => {
            findings.push(finding("mesh", job, "a stored mesh", &error.to_string(), "cannot be measured again"));
            return Ok(0);
        }
    };
    let garment = meshes.finest()?;
    let again = measure::measure(garment, &drape.positions);
    // The mesh is stored for the last stage only.
    let last: Vec<&ChiRow> = chis.iter().filter(|chi| chi.stage == drape.stage.as_str()).collect();
    for (row, chi) in last.iter().zip(&again).filter(|(row, chi)| differs(row, chi)) {
        let stated = format!("#{} {}: {:.3} of {:.3} mm", row.no, row.name, mm(row.l3d_m), mm(row.l2d_m));
        let found = format!("{:.3} of {:.3} mm", mm(chi.l3d_m), mm(chi.l2d_m));
        findings.push(finding("length", job, &stated, &found, "the stored mesh measures otherwise"));
    }
    if last.len() != again.len() {
        let (stated, found) = (last.len().to_string(), again.len().to_string());
        findings.push(finding("length", job, &stated, &found, "number of measurements"));
    }
    if let (Some(stored), Some(again)) = (&stored, measure::metrics(&again)) {
        findings.extend(metrics(job, stored, &again));
    }
    let penetration_m = quality::penetration_m(&model.body, garment, &drape.positions);
    if penetration_m > PENETRATION_M {
        let (found, says) = (format!("{:.2} mm", mm(penetration_m)), "cloth inside the body");
        findings.push(finding("mesh", job, "no penetration", &found, says));
    }
    Ok(2 * again.len() + 5)
}

fn finding(kind: &'static str, job: &JobRow, stated: &str, recomputed: &str, says: &str) -> Finding {
    Finding { kind, place: place(job), stated: stated.into(), recomputed: recomputed.into(), says: says.into() }
}

fn differs(row: &ChiRow, chi: &Chi) -> bool {
    row.no != chi.no || (row.l3d_m - chi.l3d_m).abs() > SAME_M || (row.l2d_m - chi.l2d_m).abs() > SAME_M
}

fn metrics(job: &JobRow, stored: &MetricsRow, again: &Metrics) -> Vec<Finding> {
    let pairs = [
        ("n", f64::from(stored.n), again.n as f64),
        ("E", stored.e_chi, again.e_chi),
        ("SD", stored.sd_chi, again.sd_chi),
        ("EI", stored.ei, again.ei),
        ("greatest error", stored.max_abs_error, again.max_abs_error),
    ];
    let wrong = pairs.into_iter().filter(|(_, stored, again)| (stored - again).abs() > SAME);
    wrong
        .map(|(name, stored, again)| {
            let (stated, found) = (format!("{name} {stored:.6}"), format!("{again:.6}"));
            finding("metric", job, &stated, &found, "another number comes out of the lengths")
        })
        .collect()
}

/// Pattern lengths that differ from those of the same size in another job of the study.
fn pattern(job: &JobRow, chis: &[ChiRow], known: &mut BTreeMap<(String, String, u32), f64>) -> Vec<Finding> {
    let mut findings = Vec::new();
    for chi in chis {
        let first = *known.entry((job.garment.clone(), job.size.clone(), chi.no)).or_insert(chi.l2d_m);
        if (first - chi.l2d_m).abs() > SAME_M {
            let (stated, found) =
                (format!("L2D {:.3} mm", mm(chi.l2d_m)), format!("{:.3} mm in another job", mm(first)));
            findings.push(finding("pattern", job, &stated, &found, "one pattern has one length"));
        }
    }
    findings
}

/// Finding for lengths that all equal those of another subject.
fn copy(job: &JobRow, chis: &[ChiRow], known: &mut BTreeMap<Vec<u64>, (String, String)>) -> Option<Finding> {
    let key: Vec<u64> = chis.iter().map(|chi| chi.l3d_m.to_bits()).collect();
    let (subject, first) = known.entry(key).or_insert_with(|| (job.subject.clone(), place(job))).clone();
    (subject != job.subject).then(|| finding("copy", job, "two subjects", &first, "all lengths are equal"))
}

/// Results of a program with uncommitted changes, which nobody else can check out.
fn provenance(store: &Store, study: &str) -> Result<Vec<Finding>> {
    let table = sql::query(
        store,
        &format!(
            "SELECT coalesce(git_commit, ''), program_version, count(*) FROM v_provenance JOIN v_jobs USING (job_id)
        WHERE v_jobs.study = '{}' AND is_current AND git_dirty GROUP BY 1, 2 ORDER BY 1, 2",
            study.replace('\'', "''")
        ),
    )?;
    let text = |value: &Value| match value {
        Value::Text(text) => text.clone(),
        Value::Integer(number) => number.to_string(),
        _ => String::new(),
    };
    let row = |row: &Vec<Value>| Finding {
        kind: "provenance",
        place: format!("{} jobs", text(&row[2])),
        stated: format!("version {}, commit {}", text(&row[1]), text(&row[0])),
        recomputed: "changed files".into(),
        says: "made by a program with changes that are not committed".into(),
    };
    Ok(table.rows.iter().map(row).collect())
}

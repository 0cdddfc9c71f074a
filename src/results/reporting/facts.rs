//! Parts of a report other than runs: verdicts, audit, subjects, fabrics, patterns, ease.

use crate::reporting::quoted;
use crate::{picture, recommendation};
use body::Girths;
use engine::stages::Model;
use fit::{Basis, Ease, Finding, Simulator};
use pattern::Style;
use report::data::{
    Assumed, AuditNote, Column, Drawing, EaseMatrix, FabricFacts, Fact, Severity, SizeTip, Subject, SubjectTable,
    Verdict,
};
use spec::file::ScanFile;
use spec::{Person, bodies};
use store::{EaseRow, JobRow, RecommendationRow, Result, StageKind, Status, Store, SubjectId, Value, read, sql};
use wardrobe::catalogue;
use wardrobe::seams::{Assumed as Known, LeftOut};

/// Columns of `v_subjects` on the page: name, heading, unit, decimals.
const MEASUREMENTS: [(&str, &str, &str, usize); 7] = [
    ("stature_mm", "Stature", "mm", 0),
    ("weight_kg", "Body mass", "kg", 1),
    ("chest_girth_mm", "Chest girth", "mm", 0),
    ("waist_girth_mm", "Waist girth", "mm", 0),
    ("hip_girth_mm", "Hip girth", "mm", 0),
    ("neck_girth_mm", "Neck girth", "mm", 0),
    ("across_shoulder_mm", "Across shoulder", "mm", 0),
];

/// Relative difference between a body and its given measurements above which the report mentions it.
const BODY_TOLERANCE: f64 = 0.01;

/// A subject of a report: given measurements and, where a body was dressed, tape measurements of that body, both in the
/// order of [`MEASUREMENTS`].
pub(super) struct BodyFacts {
    name: String,
    sex: String,
    scan: Option<ScanFacts>,
    asked: Vec<Option<f64>>,
    measured: Option<Vec<Option<f64>>>,
}

struct ScanFacts {
    file: String,
    notes: Vec<String>,
}

impl BodyFacts {
    pub(super) fn is_scan(&self) -> bool {
        self.scan.is_some()
    }

    fn origin(&self) -> String {
        match &self.scan {
            Some(ScanFacts { file, notes }) if notes.is_empty() => format!("scan {file}"),
            Some(ScanFacts { file, notes }) => format!("scan {file} ({})", notes.join("; ")),
            None if self.measured.is_some() => "body built from measurements".to_owned(),
            None => "as given".to_owned(),
        }
    }
}

/// Order is that of [`MEASUREMENTS`]; `None` for mass.
fn readings(girths: &Girths) -> Vec<Option<f64>> {
    MEASUREMENTS.iter().map(|(key, ..)| girths.written(key)).collect()
}

/// Measurements of the bodies; where none was dressed, the given ones.
pub(super) fn subject_table(bodies: &[BodyFacts]) -> SubjectTable {
    let column = |(_, name, unit, decimals): (&str, &str, &str, usize)| Column {
        name: name.to_owned(),
        unit: unit.to_owned(),
        decimals,
    };
    let row = |body: &BodyFacts| {
        let read = body.measured.clone().unwrap_or_else(|| vec![None; MEASUREMENTS.len()]);
        Subject {
            name: body.name.clone(),
            note: format!("{}, {}", body.sex, body.origin()),
            values: read.iter().zip(&body.asked).map(|(read, asked)| read.or(*asked)).collect(),
        }
    };
    SubjectTable { columns: MEASUREMENTS.map(column).to_vec(), rows: bodies.iter().map(row).collect() }
}

fn mismatches(bodies: &[BodyFacts]) -> Vec<String> {
    let mut told = Vec::new();
    for body in bodies {
        let read = body.measured.iter().flatten();
        for ((read, asked), (_, name, unit, _)) in read.zip(&body.asked).zip(MEASUREMENTS) {
            if let (Some(read), Some(asked)) = (read, asked)
                && (read - asked).abs() > BODY_TOLERANCE * asked
            {
                let name = name.to_lowercase();
                told.push(format!("{}: {name} {read:.0} {unit}, asked {asked:.0}", body.name));
            }
        }
    }
    told
}

pub(super) fn verdicts(store: &Store, study: &str) -> Result<Vec<Verdict>> {
    let verdict = |row: RecommendationRow| Verdict {
        garment: row.garment,
        class: row.class,
        recommended: row.recommended,
        basis: if row.basis == "evidence" { Basis::Evidence } else { Basis::Rule },
        finding: Finding::from_name(&row.verdict).unwrap_or(Finding::InsufficientEvidence),
        effect: row.effect,
        interval: row.interval,
        p_holm: row.p_holm,
        subjects: row.n_subjects as usize,
        reason: row.reason,
        would_settle: row.would_settle,
    };
    Ok(read::recommendations(store, study)?.into_iter().map(verdict).collect())
}

pub(super) fn size_tips(store: &Store, study: &str, bodies: &[BodyFacts]) -> Result<Vec<SizeTip>> {
    let mut tips = Vec::new();
    let eased = read::ease(store, study)?;
    for body in bodies.iter().filter(|body| eased.iter().any(|ease| ease.subject == body.name)) {
        for answer in recommendation::size_advice(store, study, &body.name, None)? {
            let Some(size) = answer.sizes.iter().find(|size| size.size == answer.wear) else { continue };
            let pulls = size
                .levels
                .iter()
                .filter_map(|level| Some(format!("{} {:.0} N/m", level.ease.level, level.tension_n_m?)));
            let tension = pulls.collect::<Vec<_>>().join(", ");
            tips.push(SizeTip {
                garment: answer.garment,
                subject: answer.subject,
                size: size.size.clone(),
                reason: answer.reason,
                tension: if tension.is_empty() { "no FEM-GS drape yet".into() } else { tension },
                shown: size.shown.to_owned(),
            });
        }
    }
    Ok(tips)
}

pub(super) fn audit(store: &Store, study: &str, jobs: &[JobRow], bodies: &[BodyFacts]) -> Result<Vec<AuditNote>> {
    let mut notes = Vec::new();
    let mut note = |severity, text: String| notes.push(AuditNote { severity, text });
    let open = jobs.iter().filter(|job| !job.status.is_final()).count();
    if open > 0 {
        note(Severity::Warning, format!("{open} of {} jobs have not been run yet.", jobs.len()));
    }
    let cancelled = jobs.iter().filter(|job| job.status == Status::Cancelled).count();
    if cancelled > 0 {
        note(Severity::Warning, format!("{cancelled} jobs were cancelled."));
    }
    for (only, name) in [(Simulator::Fem, "FEM-GS"), (Simulator::Hybrid, "Hybrid-GS")] {
        if !jobs.is_empty() && jobs.iter().all(|job| job.simulator == only) {
            note(Severity::Note, format!("Only {name} was run: nothing here compares the two simulators."));
        }
    }
    let mismatches = mismatches(bodies);
    if !mismatches.is_empty() {
        let text = format!("Bodies differ by more than 1 % from what was asked. {}.", mismatches.join("; "));
        note(Severity::Warning, text);
    }
    let undersized: Vec<String> = read::ease(store, study)?
        .into_iter()
        .filter(|ease| ease.decides && ease.fit.undersized)
        .map(|ease| format!("{} {} on {}", ease.garment, ease.size, ease.subject))
        .collect();
    if !undersized.is_empty() {
        note(Severity::Note, format!("Smaller than the body: {}.", undersized.join(", ")));
    }
    Ok(notes)
}

pub(super) fn bodies(store: &Store, study: &str, jobs: &[JobRow]) -> Result<Vec<BodyFacts>> {
    let keys = MEASUREMENTS.map(|(key, ..)| format!("subject.{key}")).join(", ");
    let table = sql::query(
        store,
        &format!(
            "SELECT DISTINCT job.subject, subject.sex, subject_id, {keys}
        FROM job JOIN subject USING (subject_id) JOIN study USING (study_id)
        JOIN study_axis ON study_axis.study_id = study.study_id AND axis = 'subject' AND study_axis.name = job.subject
        WHERE study.name = {} AND is_current ORDER BY position",
            quoted(study)
        ),
    )?;
    let mut bodies = Vec::new();
    for row in &table.rows {
        let name = row[0].to_string();
        let dressed = jobs.iter().find(|job| job.subject == name && job.status.has_result());
        let measured = match dressed {
            Some(job) => Some(readings(&picture::product::<Model>(store, job.id, StageKind::Body)?.body.girths)),
            None => None,
        };
        let scan = match row[2] {
            Value::Integer(id) => scan_facts(&catalogue::person(store, SubjectId(id))?),
            _ => None,
        };
        bodies.push(BodyFacts {
            name,
            sex: row[1].to_string(),
            scan,
            asked: row[3..].iter().map(number).collect(),
            measured,
        });
    }
    Ok(bodies)
}

/// Scan of a person's body, read again for its notes.
fn scan_facts(person: &Person) -> Option<ScanFacts> {
    let ScanFile { file, unit } = person.scan.as_ref()?;
    let read = bodies::read_scan(file, *unit, Some(person.measurements.sex));
    let notes = read.map(|scan| scan.imported.notes).unwrap_or_default();
    Some(ScanFacts { file: file.name.clone(), notes })
}

pub(super) fn published_bodies(store: &Store) -> Result<Vec<BodyFacts>> {
    let keys = MEASUREMENTS.map(|(key, ..)| key).join(", ");
    let table = sql::query(
        store,
        &format!(
            "SELECT name, sex, {keys} FROM subject
        WHERE revision = 1 AND (name GLOB 'male-[iv]*' OR name GLOB 'female-[iv]*') ORDER BY sex DESC, name"
        ),
    )?;
    let body = |row: &Vec<Value>| BodyFacts {
        name: row[0].to_string(),
        sex: row[1].to_string(),
        scan: None,
        asked: row[2..].iter().map(number).collect(),
        measured: None,
    };
    Ok(table.rows.iter().map(body).collect())
}

pub(super) fn fabric_facts(store: &Store, study: &str) -> Result<Vec<FabricFacts>> {
    let table = sql::query(store, &format!(
        "SELECT DISTINCT fabric.name, source, round(1000 * density_kg_m2, 1) AS 'Areal density, g/m²', thickness_mm AS 'Thickness, mm',
            membrane_warp_n_m AS 'Strip modulus, warp, N/m', membrane_weft_n_m AS 'Strip modulus, weft, N/m',
            shear_n_m AS 'Shear modulus, N/m', round(1e6 * bending_warp_nm, 3) AS 'Bending rigidity, warp, µN·m',
            round(1e6 * bending_weft_nm, 3) AS 'Bending rigidity, weft, µN·m',
            friction_body AS 'Friction coefficient, on the body', friction_self AS 'Friction coefficient, on itself'
        FROM fabric JOIN job USING (fabric_id) JOIN study USING (study_id) WHERE study.name = {} AND is_current",
        quoted(study)
    ))?;
    let facts = |row: &Vec<Value>| FabricFacts {
        name: row[0].to_string(),
        source: row[1].to_string(),
        facts: table.columns.iter().zip(row).skip(2).map(fact).collect(),
    };
    Ok(table.rows.iter().map(facts).collect())
}

/// Assumptions on each garment's pattern, in the size of its first job.
pub(super) fn assumed(store: &Store, jobs: &[JobRow]) -> Result<Vec<Assumed>> {
    let mut found: Vec<Assumed> = Vec::new();
    for job in jobs {
        if found.iter().any(|assumed| assumed.garment == job.garment) {
            continue;
        }
        let Known { told, left_out } = catalogue::workpiece_of(store, job.id)?.assumed()?;
        let group = |group: LeftOut| Fact { name: group.pieces.join(", "), value: group.why };
        let left_out = left_out.into_iter().map(group).collect();
        found.push(Assumed { garment: job.garment.clone(), told, left_out });
    }
    Ok(found)
}

/// Drawing of the first size of each garment that is draped, else of its first, from the pattern of the job.
pub(super) fn drawings(store: &Store, jobs: &[JobRow], draw: fn(&Style) -> String) -> Result<Vec<Drawing>> {
    let mut drawings: Vec<Drawing> = Vec::new();
    for job in jobs {
        if drawings.iter().any(|drawing| drawing.garment == job.garment) {
            continue;
        }
        // A size that was draped rather than one that only stands in the queue.
        let is_draped = |other: &&JobRow| other.garment == job.garment && other.status == Status::Done;
        let job = jobs.iter().find(is_draped).unwrap_or(job);
        let style = catalogue::style_of(store, job.id)?;
        let svg = draw(&style);
        drawings.push(Drawing { garment: job.garment.clone(), size: job.size.clone(), svg });
    }
    Ok(drawings)
}

pub(super) fn ease_matrices(store: &Store, study: &str) -> Result<Vec<EaseMatrix>> {
    let eases: Vec<_> = read::ease(store, study)?.into_iter().filter(|ease| ease.decides).collect();
    let mut matrices = Vec::new();
    for garment in read::study(store, study)?.garments {
        let grid = read::grid(store, study, &garment)?;
        let cell = |size: &String, subject: &String| {
            let is_of = |ease: &&EaseRow| (&ease.garment, &ease.size, &ease.subject) == (&garment, size, subject);
            eases.iter().find(is_of).map(|row| Ease {
                level: row.level.clone(),
                pattern_girth_m: row.pattern_girth_m,
                body_girth_m: row.body_girth_m,
                class: row.fit.class,
                borderline: row.fit.borderline,
                // The level that decides the class holds the garment.
                is_held: true,
            })
        };
        let row = |size: &String| grid.subjects.iter().map(|subject| cell(size, subject)).collect();
        let cells = grid.sizes.iter().map(row).collect();
        matrices.push(EaseMatrix { garment, sizes: grid.sizes.clone(), subjects: grid.subjects.clone(), cells });
    }
    Ok(matrices)
}

pub(super) fn number(value: &Value) -> Option<f64> {
    match value {
        Value::Real(number) => Some(*number),
        Value::Integer(number) => Some(*number as f64),
        _ => None,
    }
}

fn fact((name, value): (&String, &Value)) -> Fact {
    let value = match value {
        Value::Real(number) if *number != 0.0 && number.abs() < 1e-3 => format!("{number:.3e}"),
        other => other.to_string(),
    };
    Fact { name: name.clone(), value }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    pub(in crate::reporting) fn body(scan: Option<&str>) -> BodyFacts {
        let scan = scan.map(|file| ScanFacts { file: file.to_owned(), notes: vec!["14 holes closed".to_owned()] });
        BodyFacts { name: "a".into(), sex: "male".into(), scan, asked: vec![Some(1750.0)], measured: Some(vec![None]) }
    }

    #[test]
    fn a_subject_is_told_by_where_its_body_is_from() {
        let check = |body: BodyFacts, expect: &str| assert_eq!(subject_table(&[body]).rows[0].note, expect);
        check(body(None), "male, body built from measurements");
        check(BodyFacts { measured: None, ..body(None) }, "male, as given");
        check(body(Some("anna.ply")), "male, scan anna.ply (14 holes closed)");
        check(BodyFacts { measured: None, ..body(Some("anna.ply")) }, "male, scan anna.ply (14 holes closed)");
        let plain = ScanFacts { file: "anna.ply".into(), notes: Vec::new() };
        check(BodyFacts { scan: Some(plain), ..body(None) }, "male, scan anna.ply");
    }
}

//! Report on the thesis's own printed numbers: the same page, with chi recomputed from the printed lengths, and
//! misprints marked.

use std::collections::BTreeMap;

use crate::audit::{self, Finding};
use crate::reporting::facts::{self, number};
use crate::reporting::{self, mm_value};
use fit::measure::Chi;
use fit::{Answer, Cuts, Ease, Simulator};
use report::data::{AuditNote, EaseMatrix, Fact, Measured, Outcome, RawLink, Severity, TryOn, Verdict};
use report::{self, Purpose, ReportData};
use store::{InOrigin, Origin, PUBLISHED, Result, Store, Value, evidence, sql};

/// Raw data: view, file, description.
const RAW: [(&str, &str, &str); 2] = [
    ("v_published", "published.csv", "L2D, L3D and chi as printed, and chi recomputed"),
    ("v_published_metrics", "published-metrics.csv", "E, SD and EI as printed"),
];

/// Difference between a printed chi and the ratio of the printed lengths above which it is a misprint: more than
/// rounding.
const ROUNDING: f64 = 6e-4;

const METHODS: [&str; 3] = [
    "All lengths are those of Tables 6-5 to 6-30 of the thesis, as printed. Every chi, E, SD and EI here is computed from them; \
     a chi that is printed otherwise stands beside it with a cross.",
    "No pattern girth at chest or hip is printed. The fit is therefore by a proxy: the hem's girth less the chest for tops and the \
     dress, the waist's girth less the hip for trousers.",
    "The subject is the unit: its sizes are averaged before anything is tested. Men i to vi wore T-shirts and trousers, women i to \
     vi tee-tops and the dress.",
];

const LIMITS: [&str; 3] = [
    "Six subjects a garment: the smallest p that an exact test of six can give is 0.031, 0.125 after Holm over four garments.",
    "Table 6-21 prints inseam plus outseam as the waist (#5); it is counted as printed. Of the tee-top L by Hybrid-GS two subjects \
     are one column twice.",
    "Pop-up sets the hem to its pattern length by construction; the hem counts as controlled.",
];

pub(super) fn report_published(store: &Store) -> Result<Vec<(String, Vec<u8>)>> {
    let eases = published_eases(store)?;
    let evidence = evidence::evidence(store, PUBLISHED)?;
    let bodies = facts::published_bodies(store)?;
    let data = ReportData {
        title: PUBLISHED.to_owned(),
        question: "What do the thesis's own tables say when every number is computed again?".into(),
        made: format!("{}, toile {}", reporting::one(store, "SELECT date('now')")?, env!("CARGO_PKG_VERSION")),
        verdicts: evidence.answers.iter().map(verdict).collect(),
        audit: misprints(store)?,
        provenance: vec![Fact { name: "Source".into(), value: "Tables 6-1 to 6-31 of the thesis, as printed".into() }],
        subjects: facts::subject_table(&bodies),
        cuts: Cuts::default(),
        ease: matrices(&eases),
        runs: published_runs(store, &eases)?,
        pairs: evidence::pairs(store, PUBLISHED)?,
        evidence: Some(evidence),
        methods: METHODS.map(str::to_owned).to_vec(),
        limits: LIMITS.map(str::to_owned).to_vec(),
        raw: RAW.map(|(_, href, label)| RawLink { href: href.into(), label: format!("{href}: {label}") }).to_vec(),
        ..ReportData::default()
    };
    let mut files = report::files(&data, Purpose::Compare).origin(Origin::Report)?;
    for (view, file, _) in RAW {
        files.push((file.to_owned(), sql::query(store, &format!("SELECT * FROM {view}"))?.csv().into_bytes()));
    }
    Ok(files)
}

fn misprints(store: &Store) -> Result<Vec<AuditNote>> {
    let note = |finding: Finding| AuditNote {
        severity: Severity::Warning,
        text: format!(
            "{}: stated {}, recomputed {}. {}",
            finding.place, finding.stated, finding.recomputed, finding.says
        ),
    };
    Ok(audit::audit_thesis(store)?.findings.into_iter().map(note).collect())
}

/// Substitute ease of every garment, size and subject ([`pairs`](store::evidence::pairs)).
fn published_eases(store: &Store) -> Result<BTreeMap<[String; 3], Ease>> {
    let table = sql::query(store,
        "SELECT garment, size, name, iif(garment = 'male_trousers', 'waist less hip', 'hem less chest'), l2d_mm,
            iif(garment = 'male_trousers', hip_girth_mm, chest_girth_mm)
        FROM published JOIN subject ON name GLOB substr(garment, 1, instr(garment, '_') - 1) || '-[iv]*' AND revision = 1
        WHERE simulator = 'fem' AND measurement_no = iif(garment = 'male_trousers', 5, 1)",
    )?;
    let mut eases = BTreeMap::new();
    for row in &table.rows {
        let (pattern_girth_m, body_girth_m) = (mm_value(&row[4]), mm_value(&row[5]));
        let ease_m = pattern_girth_m - body_girth_m;
        let (class, borderline) = (Cuts::default().classify(ease_m), Cuts::default().is_borderline(ease_m));
        let ease = Ease { level: row[3].to_string(), pattern_girth_m, body_girth_m, class, borderline, is_held: true };
        eases.insert([0, 1, 2].map(|k: usize| row[k].to_string()), ease);
    }
    Ok(eases)
}

fn published_runs(store: &Store, eases: &BTreeMap<[String; 3], Ease>) -> Result<Vec<TryOn>> {
    let table = sql::query(store,
        "SELECT garment, size, substr(garment, 1, instr(garment, '_') - 1) || '-' || subject, simulator, measurement_no,
            measurement, l2d_mm, l3d_mm, chi_printed, chi
        FROM v_published
        ORDER BY garment, instr('smlone', size), simulator, instr(' i ii iii iv v vi ', ' ' || subject || ' '),
            measurement_no",
    )?;
    let mut runs: Vec<TryOn> = Vec::new();
    for row in &table.rows {
        let place = [0, 1, 2].map(|k: usize| row[k].to_string());
        let simulator = if row[3] == Value::Text("fem".into()) { Simulator::Fem } else { Simulator::Hybrid };
        let is_of =
            |run: &TryOn| [&run.garment, &run.size, &run.subject] == place.each_ref() && run.simulator == simulator;
        if !runs.last().is_some_and(is_of) {
            runs.push(printed_run(&place, simulator, eases.get(&place).cloned()));
        }
        if let Some(run) = runs.last_mut() {
            run.measured.push(measured(row));
        }
    }
    Ok(runs)
}

fn printed_run([garment, size, subject]: &[String; 3], simulator: Simulator, ease: Option<Ease>) -> TryOn {
    TryOn {
        garment: garment.clone(),
        case: garment.clone(),
        repeat: 1,
        size: size.clone(),
        subject: subject.clone(),
        simulator,
        fabric: "fabric of the thesis".into(),
        outcome: Outcome::Printed,
        ease,
        measured: vec![],
        vertices: 0,
        faces: 0,
        iterations: 0,
        residual: 0.0,
        residuals: vec![],
        penetration_max_m: 0.0,
        seam_gap_max_m: 0.0,
        wall_s: 0.0,
        views: vec![],
        maps: vec![],
    }
}

fn measured(row: &[Value]) -> Measured {
    let name = row[5].to_string();
    let (printed, chi) = (number(&row[8]).unwrap_or(f64::NAN), number(&row[9]).unwrap_or(f64::NAN));
    let no = number(&row[4]).unwrap_or_default() as u32;
    Measured {
        chi: Chi { no, l2d_m: mm_value(&row[6]), l3d_m: mm_value(&row[7]) },
        closed: ["Hem", "Waist", "Armhole", "Neck", "Sleeve Opening"].iter().any(|girth| name.starts_with(girth)),
        free_edge: ["Hem", "Neck Opening", "Sleeve Opening"].iter().any(|edge| name.starts_with(edge)),
        controlled: name.starts_with("Hem"),
        name,
        published_chi: None,
        misprint: ((printed - chi).abs() > ROUNDING).then_some(printed),
    }
}

fn verdict(answer: &Answer) -> Verdict {
    let estimate = answer.analysis.estimate;
    Verdict {
        garment: answer.garment.clone(),
        class: answer.class,
        recommended: answer.recommended(),
        basis: answer.basis(),
        finding: answer.finding,
        effect: estimate.map(|e| e.mean),
        interval: estimate.and_then(|e| e.interval),
        p_holm: answer.p_holm,
        subjects: answer.analysis.subjects.len(),
        reason: answer.reason.clone(),
        would_settle: answer.would_settle.clone(),
    }
}

fn matrices(eases: &BTreeMap<[String; 3], Ease>) -> Vec<EaseMatrix> {
    let distinct = |axis: usize, garment: &str| {
        let mut names: Vec<String> = Vec::new();
        for place in eases.keys().filter(|place| place[0] == garment) {
            if !names.contains(&place[axis]) {
                names.push(place[axis].clone());
            }
        }
        names
    };
    let mut garments: Vec<&String> = eases.keys().map(|place| &place[0]).collect();
    garments.dedup();
    let matrix = |garment: &String| {
        let mut sizes = distinct(1, garment);
        sizes.sort_by_key(|size| "smlone".find(size.as_str()));
        let subjects = distinct(2, garment);
        let cell = |size: &String, subject: &String| eases.get(&[garment, size, subject].map(String::clone)).cloned();
        let cells = sizes.iter().map(|size| subjects.iter().map(|subject| cell(size, subject)).collect()).collect();
        EaseMatrix { garment: garment.clone(), sizes, subjects, cells }
    };
    garments.into_iter().map(matrix).collect()
}

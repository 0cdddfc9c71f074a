//! An example study: two sizes of a T-shirt on three subjects by both simulators, with jobs in all states.

use std::collections::BTreeMap;

use crate::messages::message::Message;
use crate::messages::seams::{SeamTask, SeamWork, SizeLayout};
use crate::messages::snapshot::{Compared, Detail, Snapshot};
use engine::Why;
use fit::{FitClass, Simulator};
use sim::fabric::Stretched;
use sim::{Fabric, Step};
use spec::bodies::{Figures, Girths, Measurements, Sex};
use spec::patterns::{Model, drafted};
use spec::{Change, MEASUREMENTS};
use store::comments::{Comment, Remark, Round, Severity, Side, State};
use store::files::SourceFile;
use store::{
    Cell, ChiRow, EaseRow, FitCell, Grid, JobId, JobProgress, JobRow, LogLine, MetricsRow, RecommendationRow, SizeKey,
    StageRow, Status, StudyRow, SubjectId,
};
use wardrobe::seams::Workpiece;
use wardrobe::{FabricRow, SizeRow, SubjectRow};

/// Present time: 2023-11-14 22:13:20 UTC.
const NOW_MS: i64 = 1_700_000_000_000;
const SIZES: [&str; 2] = ["S", "M"];
const SUBJECTS: [&str; 3] = ["i", "ii", "iii"];
const SIMULATORS: [Simulator; 2] = [Simulator::Fem, Simulator::Hybrid];

/// Ease of each size on each subject.
const EASE_M: [[f64; 3]; 2] = [[0.043, 0.111, -0.012], [0.089, 0.157, 0.066]];

/// States of jobs 1 to 12, by size, subject and simulator.
const STATES: [Status; 12] = [
    Status::Done,
    Status::Done,
    Status::NotConverged,
    Status::Done,
    Status::Failed,
    Status::Cancelled,
    Status::Running,
    Status::Running,
    Status::Queued,
    Status::Queued,
    Status::Queued,
    Status::Queued,
];

fn step(iteration: u32) -> Step {
    let t = f64::from(iteration) / 100.0;
    let residual = (-5.0 * t).exp();
    Step { iteration, level: 0, residual, seam_gap_m: 0.01 * (1.0 - t), e_chi: 1.01 - 0.008 * t }
}

fn job(index: usize) -> JobRow {
    let status = STATES[index];
    let started = status != Status::Queued;
    let wall_ms = (started && status != Status::Running).then_some(8_500 + 1_000 * index as i64);
    JobRow {
        id: JobId(index as i64 + 1),
        study: "men-tops".into(),
        garment: "tshirt".into(),
        size: SIZES[index / 6].into(),
        subject: SUBJECTS[index / 2 % 3].into(),
        simulator: SIMULATORS[index % 2],
        repeat: 1,
        status,
        is_current: true,
        priority: 0,
        attempts: u32::from(started),
        error: (status == Status::Failed)
            .then(|| "sim: diverged at level 2, residual 3.1e4 after 812 steps; a coarser mesh may converge".into()),
        queued_at_ms: NOW_MS - 60_000,
        started_at_ms: started.then_some(NOW_MS - 12_000),
        finished_at_ms: wall_ms.map(|_| NOW_MS - 1_000),
        wall_ms,
        progress: (status == Status::Running).then(|| JobProgress {
            phase: "drape".into(),
            fraction: 0.58,
            step: step(58),
        }),
        ei: status.has_result().then_some(0.0117 / (index + 1) as f64),
        // Job 2, by Hybrid-GS, lies inside the body.
        penetration_max_m: status.has_result().then_some(if index == 1 { 0.037 } else { 0.0002 }),
    }
}

fn fit(size: usize, subject: usize) -> FitCell {
    let ease_m = EASE_M[size][subject];
    let class = match ease_m {
        e if e < 0.05 => FitClass::Tight,
        e if e > 0.1 => FitClass::Loose,
        _ => FitClass::Just,
    };
    let borderline = (0.04..0.05).contains(&ease_m) || (ease_m > 0.1 && ease_m <= 0.12);
    FitCell { class, ease_m, undersized: ease_m < 0.0, borderline }
}

fn ease(size: usize, subject: usize) -> EaseRow {
    EaseRow {
        garment: "tshirt".into(),
        size: SIZES[size].into(),
        subject: SUBJECTS[subject].into(),
        level: "chest".into(),
        pattern_girth_m: 0.974,
        body_girth_m: 0.974 - EASE_M[size][subject],
        decides: true,
        fit: fit(size, subject),
    }
}

/// The example study, with job 1 shown.
pub fn snapshot() -> Snapshot {
    let jobs: Vec<JobRow> = (0..STATES.len()).map(job).collect();
    let cell = |job: &JobRow| Cell {
        job: Some(job.id),
        status: Some(job.status),
        fraction: job.progress.as_ref().map(|progress| progress.fraction),
        ei: job.ei,
        is_inside: job.inside().is_some(),
    };
    let cells = |size: usize| -> Vec<Vec<Cell>> {
        (0..3).map(|subject| (0..2).map(|sim| cell(&jobs[size * 6 + subject * 2 + sim])).collect()).collect()
    };
    let names = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect::<Vec<_>>();
    let grid = Grid {
        study: "men-tops".into(),
        garment: "tshirt".into(),
        sizes: names(&SIZES),
        subjects: names(&SUBJECTS),
        simulators: SIMULATORS.into(),
        cells: (0..2).map(cells).collect(),
        fits: (0..2).map(|size| (0..3).map(|subject| Some(fit(size, subject))).collect()).collect(),
    };
    let counts = Status::ALL.map(|status| STATES.iter().filter(|s| **s == status).count());
    let study = StudyRow {
        name: "men-tops".into(),
        path: "studies/men-tops/study.toml".into(),
        paused: false,
        counts,
        garments: names(&["tshirt"]),
    };
    Snapshot {
        now_ms: NOW_MS,
        offset_ms: 0,
        subjects: subjects(),
        fabrics: fabrics(),
        sizes: sizes(),
        outfits: vec![],
        studies: vec![study],
        study: 0,
        runners: vec![],
        cloths: [("tshirt".to_owned(), "jersey".to_owned())].into(),
        grid: Some(grid),
        ease: (0..6).map(|k| ease(k / 3, k % 3)).collect(),
        jobs,
        detail: None,
        compared: vec![],
        recommendations: vec![],
        worn: None,
        comments: comments(),
        rounds: vec![round("i", 2, None), round("ii", 1, Some("ann"))],
    }
}

/// Comments of two rounds of the T-shirt on subject i, and of one on ii.
fn comments() -> Vec<Comment> {
    let remark = |side, place: &str, said: &str, severity, action: &str, quantity: Option<&str>| Remark {
        side,
        place: place.into(),
        said: said.into(),
        severity,
        cause: if quantity.is_some() { "pattern too narrow there for this figure" } else { "" }.into(),
        action: action.into(),
        quantity: quantity.map(str::to_owned),
    };
    let comment =
        |subject: &str, (round, number): (i64, i64), remark: Remark, (status, owner): (State, &str)| Comment {
            garment: "tshirt".into(),
            subject: subject.into(),
            size: "M".into(),
            round,
            number,
            is_worded: remark.quantity.is_none(),
            remark,
            status,
            met_in: (status == State::Met).then_some(2),
            owner: owner.into(),
            signed_by: (subject == "ii").then(|| "ann".into()),
        };
    let chest = remark(
        Side::Front,
        "chest",
        "chest tight by 44 mm",
        Severity::Major,
        "chest +44.0 mm (widens front and back under the arm) on front, back",
        Some("chest tight"),
    );
    let hip = remark(Side::Front, "hip", "hip tight by 12 mm", Severity::Minor, "hem +12.0 mm", Some("hip tight"));
    let neck = remark(Side::Back, "neck", "gapes when the arms are raised", Severity::Critical, "darts", None);
    vec![
        comment("i", (1, 1), chest.clone(), (State::Open, "ben")),
        comment("i", (1, 2), hip, (State::Met, "")),
        comment("i", (2, 3), neck, (State::Open, "")),
        comment("ii", (1, 1), chest, (State::Closed, "")),
    ]
}

fn round(subject: &str, round: i64, signed_by: Option<&str>) -> Round {
    Round {
        garment: "tshirt".into(),
        subject: subject.into(),
        round,
        size: "M".into(),
        signed_by: signed_by.map(str::to_owned),
    }
}

/// Two sizes of the thesis's T-shirt.
fn sizes() -> Vec<SizeRow> {
    let row = |(k, size): (usize, &&str)| SizeRow {
        key: SizeKey { style: 1, size: k as i64 + 1 },
        style: "tshirt".into(),
        style_revision: 1,
        size: (*size).into(),
        revision: 1,
        pattern_file: format!("tshirt-{}.dxf", size.to_lowercase()),
        seam_file: Some("tshirt.seams.toml".into()),
        unit: None,
        unconfirmed: 0,
    };
    SIZES.iter().enumerate().map(row).collect()
}

fn tshirt_file(end: &str) -> SourceFile {
    let found = drafted(Model::Tshirt).into_iter().find(|(name, _)| name.ends_with(end));
    let (name, bytes) = found.unwrap_or_else(|| panic!("no file {end}"));
    SourceFile { name, bytes: bytes.into() }
}

/// Answer of the thread that works on seams.
pub fn work(task: SeamTask) -> Message {
    let (SeamTask::LayOut(request) | SeamTask::Sew(SeamWork { size: request, .. })) = &task;
    let size = SIZES[request.key.size as usize - 1];
    let stored = Some(tshirt_file(".toml"));
    let piece = Workpiece {
        pattern: tshirt_file(&format!("-{}.dxf", size.to_lowercase())),
        seams: request.seams.clone().or(stored.clone()),
        size: size.into(),
        unit: None,
    };
    match task {
        SeamTask::LayOut(request) => {
            let home = request.study.as_ref().map(|study| study.with_file_name("tshirt.seams.toml"));
            let layout = piece.laid_out().map(|out| Box::new(SizeLayout { out, stored, home }));
            Message::LaidOut(Box::new(request), layout.map_err(|error| error.to_string()))
        }
        SeamTask::Sew(work) => {
            let seams = piece.after(&work.step).map_err(|error| error.to_string());
            Message::Sewn(Box::new(work), seams)
        }
    }
}

/// Three fabrics: a built-in woven that jobs use, a knit, and one that a user added.
fn fabrics() -> Vec<FabricRow> {
    let cotton = Fabric {
        name: "cotton_shirting_light".into(),
        density_kg_m2: 0.1036,
        thickness_m: 0.18e-3,
        membrane_warp_n_m: 3801.0,
        membrane_weft_n_m: 2365.0,
        membrane_coupling_n_m: 0.0,
        shear_n_m: 96.84,
        bending_warp_nm: 7.204e-6,
        bending_weft_nm: 5.051e-6,
        friction_body: 0.31,
        friction_self: 0.5,
        source: "a light cotton, as it was measured; bending: the median of many of its weight".into(),
        stretched: None,
    };
    let stretched = Some(Stretched { stretch: 0.2, membrane_warp_n_m: 80.0, membrane_weft_n_m: 60.0 });
    let knit =
        Fabric { name: "jersey".into(), membrane_warp_n_m: 40.0, membrane_weft_n_m: 25.0, stretched, ..cotton.clone() };
    let own = Fabric { name: "stiff".into(), bending_warp_nm: 2e-5, membrane_coupling_n_m: 50.0, ..cotton.clone() };
    let row = |(k, fabric): (usize, Fabric)| FabricRow {
        fabric,
        revision: k as i64 + 1,
        is_own: k == 2,
        jobs: if k == 0 { 12 } else { 0 },
    };
    [cotton, knit, own].into_iter().enumerate().map(row).collect()
}

/// Three subjects: two men of the thesis, and a woman with few known measurements.
fn subjects() -> Vec<SubjectRow> {
    let subject = |id: i64, name: &str, sex: Sex, values: &[f64]| {
        let mut measurements = Measurements::of(sex, 0.0);
        for (field, value) in MEASUREMENTS.iter().zip(values) {
            field.set(&mut measurements, Some(*value));
        }
        SubjectRow {
            id: SubjectId(id),
            name: name.into(),
            revision: id,
            measurements,
            scan: None,
            pose: None,
            figures: Figures::default(),
        }
    };
    vec![
        subject(3, "anna", Sex::Female, &[1480.0]),
        subject(1, "male-i", Sex::Male, &[1690.0, 62.0, 931.0, 890.0, 975.0, 382.0, 424.0]),
        subject(2, "male-ii", Sex::Male, &[1690.0, 53.0, 863.0, 782.0, 914.0, 378.0, 429.0]),
    ]
}

pub fn girths() -> Girths {
    let read = serde_json::json!({
        "stature_mm": 1690.2,
        "neck_girth_mm": 382.4,
        "chest_girth_mm": 931.3,
        "underbust_girth_mm": 880.0,
        "waist_girth_mm": 890.1,
        "hip_girth_mm": 974.8,
        "thigh_girth_mm": 541.6,
        "calf_girth_mm": 365.2,
        "across_shoulder_mm": 424.9,
        "inseam_mm": 765.3,
        "volume_l": 60.0,
        "neck_level_mm": 1440.0,
        "chest_level_mm": 1230.0,
        "underbust_level_mm": 1160.0,
        "waist_level_mm": 1050.0,
        "hip_level_mm": 860.0,
        "thigh_level_mm": 715.0,
        "shoulder_level_mm": 1380.0,
        "crotch_level_mm": 765.0,
    });
    serde_json::from_value(read).expect("the keys of `body measure`")
}

pub fn empty() -> Snapshot {
    Snapshot {
        now_ms: NOW_MS,
        offset_ms: 0,
        subjects: vec![],
        fabrics: vec![],
        sizes: vec![],
        outfits: vec![],
        studies: vec![],
        study: 0,
        runners: vec![],
        cloths: BTreeMap::new(),
        grid: None,
        jobs: vec![],
        ease: vec![],
        detail: None,
        compared: vec![],
        recommendations: vec![],
        worn: None,
        comments: vec![],
        rounds: vec![],
    }
}

pub fn detail(id: JobId) -> Detail {
    let status = STATES[id.0 as usize - 1];
    let has_result = status.has_result();
    let log = |seconds: i64, level: &str, text: &str| LogLine {
        at_ms: NOW_MS + 1000 * seconds,
        level: level.into(),
        text: text.into(),
    };
    let stage = |stage: &str, was_cached| StageRow { stage: stage.into(), hash: "0".into(), was_cached };
    Detail {
        job: id,
        chi: if has_result { chi() } else { vec![] },
        metrics: has_result.then_some(MetricsRow {
            n: 6,
            e_chi: 1.0068,
            sd_chi: 0.0126,
            ei: 0.0117,
            max_abs_error: 0.0297,
            vertices: 5329,
            faces: 10_412,
            iterations: 368,
            residual: 7.9e-3,
            converged: status == Status::Done,
            penetration_max_m: 0.0002,
            self_crossings: Some(0),
            distortion: Some(0.012),
            seam_gap_max_m: 0.0001,
        }),
        history: if has_result { (1..=100).map(step).collect() } else { vec![] },
        log: vec![
            log(0, "info", "queued: changed since job 1: fabric.cotton.shear_n_m: 97 -> 120"),
            log(1, "info", "started by process 7"),
        ],
        why: Why::Changed {
            since: JobId(1),
            changes: vec![Change {
                name: "fabric.cotton.shear_n_m".into(),
                before: Some("97".into()),
                after: Some("120".into()),
            }],
        },
        stages: if has_result { vec![stage("body", true), stage("drape", false), stage("mesh", true)] } else { vec![] },
    }
}

/// A job of the example study in a comparison; Hybrid-GS is nearer to 1 by a half.
pub fn compared(id: JobId) -> Compared {
    let job = job(id.0 as usize - 1);
    let detail = detail(id);
    let is_hybrid = job.simulator == Simulator::Hybrid;
    let chi = detail.chi.into_iter().map(|row| match is_hybrid {
        true => ChiRow { l3d_m: (row.l3d_m + row.l2d_m) / 2.0, is_controlled: true, ..row },
        false => row,
    });
    let metrics =
        detail.metrics.map(|metrics| MetricsRow { ei: if is_hybrid { 0.0058 } else { metrics.ei }, ..metrics });
    let inputs = [("sim.name", job.simulator.as_str()), ("fabric.cotton.shear_n_m", "97")];
    let inputs = inputs.into_iter().map(|(name, value)| (name.to_owned(), value.to_owned())).collect();
    Compared { chi: chi.collect(), metrics, inputs, job }
}

pub fn recommendations() -> Vec<RecommendationRow> {
    vec![RecommendationRow {
        garment: "tshirt".into(),
        class: FitClass::Tight,
        recommended: Simulator::Hybrid,
        basis: "rule".into(),
        verdict: "insufficient_evidence".into(),
        rule_says: Simulator::Hybrid,
        effect: Some(0.0059),
        interval: None,
        n_subjects: 1,
        reason: "1 subject paired; the thesis's rule stands".into(),
        p_holm: None,
        would_settle: "5 more subjects".into(),
    }]
}

fn chi() -> Vec<ChiRow> {
    // Names, pattern lengths and chi are like those in the tables of the thesis.
    let rows = [
        ("Hem Circumference", true, true, false, 0.974, 0.9995),
        ("Sleeve Opening", true, true, false, 0.3565, 1.0221),
        ("Front Center Length", false, false, false, 0.5508, 1.0004),
        ("Armhole Circumference", true, false, true, 0.5037, 0.9889),
        ("Neck Opening", true, true, false, 0.5601, 1.0610),
        ("Shoulder Length", false, false, false, 0.1567, 0.9620),
    ];
    let row = |(k, (name, is_girth, is_free_edge, is_controlled, l2d_m, chi)): (
        usize,
        (&str, bool, bool, bool, f64, f64),
    )| {
        ChiRow {
            stage: "drape".into(),
            no: k as u32 + 1,
            name: name.into(),
            is_girth,
            is_free_edge,
            is_controlled,
            l2d_m,
            l3d_m: l2d_m * chi,
        }
    };
    rows.into_iter().enumerate().map(row).collect()
}

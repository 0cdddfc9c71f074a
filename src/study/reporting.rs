//! The report of a study: gathering what the page shows, and the raw files beside it.

use super::error::{Result, StudyError};
use super::inputs::StageKind;
use super::picture::{Dressed, Map};
use super::read::JobFilter;
use super::types::{JobRow, Status, Table, Value};
use super::workspace::Workspace;
use crate::fit::Ease;
use crate::measure::Chi;
use crate::render::{self, Camera, Frame, Scene, View};
use crate::report::data::{
    AuditNote, Basis, Column, Drawing, EaseMatrix, FabricFacts, Fact, FieldMap, Finding, Measured, Outcome, Picture,
    RawLink, Run, Severity, Subject, SubjectTable, Verdict,
};
use crate::report::{self, ReportData};
use crate::units::mm;

/// Pixels of a picture on the page.
const PICTURE: (u32, u32) = (420, 620);

/// Views of the raw data, their files, and what they hold.
const RAW: [(&str, &str, &str); 4] = [
    ("v_chi", "chi.csv", "L2D, L3D and chi of every measurement"),
    ("v_metrics", "metrics.csv", "E, SD, EI and the state of every drape"),
    ("v_ease", "ease.csv", "ease and fit class of every size and subject"),
    ("v_provenance", "provenance.csv", "hashes, versions and machine of every result"),
];

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

const METHODS: [&str; 4] = [
    "Each subject's body is built from the measurements given; each size is read from its DXF file, sewn as its seam file \
     says and meshed. FEM-GS drapes the sewn cloth on the body by its weight, membrane, bending, contact and friction until \
     the residual force is a small share of the weight.",
    "L2D is the length of a measurement on the pattern, L3D the length of the same line on the drape, chi = L3D / L2D. E is \
     the mean of chi over the measurements, SD its sample standard deviation (n - 1), EI the mean of |chi - 1|.",
    "Ease is the girth of the pattern at a level less the girth of the body there; the least ease of a garment decides its \
     fit class.",
    "Published values are those of the thesis for the same measurement, size and subject, recomputed from its printed \
     lengths where the pattern length agrees within 0.5 mm.",
];

const LIMITS: [&str; 2] = [
    "Bodies are shaped from a few measurements: where they differ from the person, so does the drape.",
    "A fabric of the library stands for a class of cloth; several of its numbers are estimates.",
];

impl Workspace {
    /// The files of a study's report by their relative paths: `index.html`, pictures, drawings, CSV.
    ///
    /// # Errors
    /// When there is no such study, or a stored result cannot be read.
    pub fn report(&self, study: &str) -> Result<Vec<(String, Vec<u8>)>> {
        self.study(study)?;
        let mut files = Vec::new();
        let data = self.report_data(study, &mut files)?;
        for (view, file, _) in RAW {
            files.push((file.to_owned(), csv_of(&self.of_study(view, study)?)?));
        }
        let page = report::html(&data).map_err(StudyError::stage("report"))?;
        files.insert(0, ("index.html".to_owned(), page.into_bytes()));
        Ok(files)
    }

    fn report_data(&self, study: &str, files: &mut Vec<(String, Vec<u8>)>) -> Result<ReportData> {
        let jobs = self.jobs(&JobFilter { study: Some(study.to_owned()), ..JobFilter::default() })?;
        let drawings = self.drawings(&jobs)?;
        for drawing in &drawings {
            let name = format!("pattern-{}-{}.svg", drawing.garment, drawing.size);
            files.push((name, drawing.svg.clone().into_bytes()));
        }
        let today = self.one("SELECT date('now')")?;
        Ok(ReportData {
            title: study.to_owned(),
            question: "How true does each drape stay to its pattern, and which simulator is to be trusted for which fit?".into(),
            made: format!("{today}, toile {}", env!("CARGO_PKG_VERSION")),
            verdicts: self.verdicts(study)?,
            audit: self.audit(study, &jobs)?,
            provenance: self.facts(&format!(
                "SELECT DISTINCT 'Program' AS name, 'toile ' || program_version AS value FROM v_provenance WHERE study = {0}
                UNION SELECT 'Commit of the study', git_commit || iif(git_dirty, ', with uncommitted changes', '')
                    FROM v_provenance WHERE study = {0} AND git_commit IS NOT NULL
                UNION SELECT 'Machine', machine FROM v_provenance WHERE study = {0}
                UNION SELECT job_input.name, value FROM job_input JOIN job USING (job_id) JOIN study USING (study_id)
                    WHERE study.name = {0} AND is_current AND (job_input.name GLOB '*.version' OR job_input.name GLOB 'mesh.*'
                        OR job_input.name GLOB 'field.*' OR job_input.name = 'sim.parameters')",
                quoted(study)
            ))?,
            inputs: self.facts(&format!(
                "SELECT DISTINCT substr(job_input.name, instr(job_input.name, '.') + 1), value
                FROM job_input JOIN job USING (job_id) JOIN study USING (study_id)
                WHERE study.name = {} AND is_current AND length(value) = 64 AND job_input.name NOT GLOB 'sim.*' ORDER BY 1",
                quoted(study)
            ))?,
            fabrics: self.fabric_facts(study)?,
            subjects: self.subject_table(study)?,
            drawings,
            ease: self.ease_matrices(study)?,
            runs: self.report_runs(study, &jobs, files)?,
            methods: METHODS.map(str::to_owned).to_vec(),
            limits: LIMITS.map(str::to_owned).to_vec(),
            raw: RAW.map(|(_, href, label)| RawLink { href: href.to_owned(), label: label.to_owned() }).to_vec(),
        })
    }

    fn verdicts(&self, study: &str) -> Result<Vec<Verdict>> {
        let verdict = |row: super::types::RecommendationRow| Verdict {
            garment: row.garment,
            class: row.class,
            recommended: row.recommended,
            basis: if row.basis == "evidence" { Basis::Evidence } else { Basis::Rule },
            finding: match row.verdict.as_str() {
                "fem" => Finding::Fem,
                "hybrid" => Finding::Hybrid,
                "no_difference" => Finding::NoDifference,
                _ => Finding::InsufficientEvidence,
            },
            effect: row.effect.zip(row.interval).map(|(effect, (low, high))| [effect, low, high]),
            subjects: row.n_subjects as usize,
            reason: row.reason,
            would_settle: "Converged results of both simulators on at least six subjects with this fit.".into(),
        };
        Ok(self.recommendations(study)?.into_iter().map(verdict).collect())
    }

    /// What a reader should know before believing the numbers.
    fn audit(&self, study: &str, jobs: &[JobRow]) -> Result<Vec<AuditNote>> {
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
        let mut simulators: Vec<&str> = jobs.iter().map(|job| job.simulator.as_str()).collect();
        simulators.sort_unstable();
        simulators.dedup();
        if simulators.len() < 2 {
            let text = format!("Only {} was run: nothing here compares the two simulators.", simulators.join(", "));
            note(Severity::Note, text);
        }
        let undersized: Vec<String> = self
            .ease(study)?
            .into_iter()
            .filter(|ease| ease.decides && ease.fit.undersized)
            .map(|ease| format!("{} {} on {}", ease.garment, ease.size, ease.subject))
            .collect();
        if !undersized.is_empty() {
            note(Severity::Note, format!("Smaller than the body: {}.", undersized.join(", ")));
        }
        Ok(notes)
    }

    fn subject_table(&self, study: &str) -> Result<SubjectTable> {
        let keys = MEASUREMENTS.map(|(key, ..)| format!("subject.{key}")).join(", ");
        let table = self.query(&format!(
            "SELECT DISTINCT job.subject, subject.sex, {keys} FROM job JOIN subject USING (subject_id) JOIN study USING (study_id)
            JOIN study_axis ON study_axis.study_id = study.study_id AND axis = 'subject' AND study_axis.name = job.subject
            WHERE study.name = {} AND is_current ORDER BY position",
            quoted(study)
        ))?;
        let number = |value: &Value| match value {
            Value::Real(number) => Some(*number),
            Value::Integer(number) => Some(*number as f64),
            _ => None,
        };
        let column = |(_, name, unit, decimals): (&str, &str, &str, usize)| Column {
            name: name.to_owned(),
            unit: unit.to_owned(),
            decimals,
        };
        let row = |row: &Vec<Value>| Subject {
            name: row[0].to_string(),
            note: format!("{}, built from these measurements", row[1]),
            values: row[2..].iter().map(number).collect(),
        };
        Ok(SubjectTable { columns: MEASUREMENTS.map(column).to_vec(), rows: table.rows.iter().map(row).collect() })
    }

    fn fabric_facts(&self, study: &str) -> Result<Vec<FabricFacts>> {
        let table = self.query(&format!(
            "SELECT DISTINCT fabric.name, source, density_kg_m2 AS 'Areal density, kg/m2', thickness_mm AS 'Thickness, mm',
                membrane_warp_n_m AS 'Strip modulus, warp, N/m', membrane_weft_n_m AS 'Strip modulus, weft, N/m',
                shear_n_m AS 'Shear modulus, N/m', bending_warp_nm AS 'Bending rigidity, warp, N m',
                bending_weft_nm AS 'Bending rigidity, weft, N m', friction_body AS 'Friction on the body',
                friction_self AS 'Friction on itself'
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

    /// The first size of each garment, drawn from what its job was made from.
    fn drawings(&self, jobs: &[JobRow]) -> Result<Vec<Drawing>> {
        let mut drawings: Vec<Drawing> = Vec::new();
        for job in jobs {
            if drawings.iter().any(|drawing| drawing.garment == job.garment) {
                continue;
            }
            let style = self.style_of(job.id)?;
            let svg = super::tools::sheet(&style);
            drawings.push(Drawing { garment: job.garment.clone(), size: job.size.clone(), svg });
        }
        Ok(drawings)
    }

    fn ease_matrices(&self, study: &str) -> Result<Vec<EaseMatrix>> {
        let eases: Vec<_> = self.ease(study)?.into_iter().filter(|ease| ease.decides).collect();
        let mut matrices = Vec::new();
        for garment in self.study(study)?.garments {
            let grid = self.grid(study, &garment)?;
            let cell = |size: &String, subject: &String| {
                let of = |ease: &&super::types::EaseRow| {
                    (&ease.garment, &ease.size, &ease.subject) == (&garment, size, subject)
                };
                eases.iter().find(of).map(|row| Ease {
                    level: row.level.clone(),
                    pattern_girth_m: row.pattern_girth_m,
                    body_girth_m: row.body_girth_m,
                    class: row.fit.class,
                    borderline: row.fit.borderline,
                })
            };
            let row = |size: &String| grid.subjects.iter().map(|subject| cell(size, subject)).collect();
            let cells = grid.sizes.iter().map(row).collect();
            matrices.push(EaseMatrix { garment, sizes: grid.sizes.clone(), subjects: grid.subjects.clone(), cells });
        }
        Ok(matrices)
    }

    /// All runs with their pictures, which share one frame; the pictures are also added to `files`.
    fn report_runs(&self, study: &str, jobs: &[JobRow], files: &mut Vec<(String, Vec<u8>)>) -> Result<Vec<Run>> {
        let eases = self.ease_matrices(study)?;
        let mut dressed = Vec::new();
        for job in jobs {
            dressed.push(if job.status.has_result() { Some(self.dressed(job.id)?) } else { None });
        }
        let meshes = dressed.iter().flatten().flat_map(|worn: &Dressed| [&worn.body, &worn.cloth]);
        let frame = Frame::enclosing(meshes, f64::from(PICTURE.0) / f64::from(PICTURE.1));
        let mut runs = Vec::new();
        for (job, worn) in jobs.iter().zip(&dressed) {
            let outcome = match job.status {
                Status::Done => Outcome::Converged,
                Status::NotConverged => Outcome::NotConverged,
                status => Outcome::Failed(job.error.clone().unwrap_or_else(|| status.as_str().to_owned())),
            };
            let mut run = self.report_run(job, outcome)?;
            run.ease = eases.iter().find(|matrix| matrix.garment == job.garment).and_then(|matrix| {
                let size = matrix.sizes.iter().position(|size| *size == job.size)?;
                let subject = matrix.subjects.iter().position(|subject| *subject == job.subject)?;
                matrix.cells[size][subject].clone()
            });
            if let Some(worn) = worn {
                self.add_pictures(&mut run, job, worn, frame, files)?;
            }
            runs.push(run);
        }
        Ok(runs)
    }

    /// A run without ease and pictures.
    fn report_run(&self, job: &JobRow, outcome: Outcome) -> Result<Run> {
        let metrics = self.metrics(job.id)?;
        let number = |get: fn(&super::types::MetricsRow) -> f64| metrics.as_ref().map_or(0.0, get);
        let mut measured = Vec::new();
        for chi in self.chi(job.id)? {
            let published = format!(
                "SELECT chi FROM v_published WHERE simulator = '{}' AND lower(size) = lower({}) AND subject = {}
                AND measurement_no = {} AND abs(l2d_mm - {}) < 0.5
                AND garment GLOB (SELECT sex FROM subject JOIN job USING (subject_id) WHERE job_id = {}) || '_*'",
                job.simulator.as_str(),
                quoted(&job.size),
                quoted(&job.subject),
                chi.no,
                mm(chi.l2d_m),
                job.id
            );
            let published = self.query(&published)?.rows.into_iter().flatten().next();
            measured.push(Measured {
                name: chi.name.clone(),
                chi: Chi { no: chi.no, l2d_m: chi.l2d_m, l3d_m: chi.l3d_m },
                closed: chi.is_girth,
                free_edge: chi.is_free_edge,
                controlled: chi.is_controlled,
                published_chi: match published {
                    Some(Value::Real(chi)) => Some(chi),
                    _ => None,
                },
            });
        }
        Ok(Run {
            garment: job.garment.clone(),
            size: job.size.clone(),
            subject: job.subject.clone(),
            simulator: job.simulator,
            fabric: self
                .one(&format!("SELECT name FROM fabric JOIN job USING (fabric_id) WHERE job_id = {}", job.id))?,
            outcome,
            ease: None,
            measured,
            vertices: number(|m| f64::from(m.vertices)) as usize,
            faces: number(|m| f64::from(m.faces)) as usize,
            iterations: number(|m| f64::from(m.iterations)) as u32,
            residual: number(|m| m.residual),
            residuals: self.history(job.id)?.iter().map(|step| (step.iteration, step.residual)).collect(),
            penetration_max_m: number(|m| m.penetration_max_m),
            seam_gap_max_m: number(|m| m.seam_gap_max_m),
            wall_s: job.wall_ms.unwrap_or_default() as f64 / 1e3,
            views: Vec::new(),
            maps: Vec::new(),
        })
    }

    /// The four views and the maps of a run; as JPEG on the page, as PNG beside it.
    fn add_pictures(
        &self,
        run: &mut Run,
        job: &JobRow,
        worn: &Dressed,
        frame: Frame,
        files: &mut Vec<(String, Vec<u8>)>,
    ) -> Result<()> {
        let what = format!("{} {} on {}, {}", job.garment, job.size, job.subject, job.simulator.as_str());
        let mut take = |scene: &Scene, view: View, map: Map| -> Result<Picture> {
            let camera = Camera::new(view, frame);
            let shot = render::render(scene, &camera, PICTURE.0, PICTURE.1).map_err(StudyError::stage("render"))?;
            let png = render::png(&shot).map_err(StudyError::stage("render"))?;
            files.push((format!("pictures/job-{}-{}-{}.png", job.id, view.as_str(), map.as_str()), png));
            let bytes = render::jpeg(&shot).map_err(StudyError::stage("render"))?;
            let caption = if map == Map::Plain { view.as_str() } else { map.as_str() };
            Ok(Picture { bytes, alt: format!("{what}, {caption}"), caption: caption.to_owned() })
        };
        for map in Map::ALL {
            let (scene, scale) = worn.scene(map, || self.product(job.id, StageKind::Field))?;
            match scale {
                None => {
                    run.views = View::ALL.into_iter().map(|view| take(&scene, view, map)).collect::<Result<_>>()?;
                }
                Some(scale) => run.maps.push(FieldMap { picture: take(&scene, View::Quarter, map)?, scale }),
            }
        }
        Ok(())
    }

    /// Rows of a contract view that belong to a study.
    fn of_study(&self, view: &str, study: &str) -> Result<Table> {
        self.query(&format!("SELECT * FROM {view} WHERE study = {}", quoted(study)))
    }

    /// Rows of two columns as named values.
    fn facts(&self, sql: &str) -> Result<Vec<Fact>> {
        let row = |row: &Vec<Value>| Fact { name: row[0].to_string(), value: row[1].to_string() };
        Ok(self.query(sql)?.rows.iter().map(row).collect())
    }

    /// The first value of a query as text.
    fn one(&self, sql: &str) -> Result<String> {
        Ok(self.query(sql)?.rows.first().and_then(|row| row.first()).map(Value::to_string).unwrap_or_default())
    }
}

/// A named value of a table.
fn fact((name, value): (&String, &Value)) -> Fact {
    let value = match value {
        Value::Real(number) if *number != 0.0 && number.abs() < 1e-3 => format!("{number:.3e}"),
        other => other.to_string(),
    };
    Fact { name: name.clone(), value }
}

/// A text as SQL literal.
fn quoted(text: &str) -> String {
    format!("'{}'", text.replace('\'', "''"))
}

/// A table as CSV bytes.
fn csv_of(table: &Table) -> Result<Vec<u8>> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(&table.columns).map_err(StudyError::stage("report"))?;
    for row in &table.rows {
        writer.write_record(row.iter().map(Value::to_string)).map_err(StudyError::stage("report"))?;
    }
    writer.into_inner().map_err(|error| StudyError::stage("report")(error.into_error()))
}

//! The report of a study: data of its pages, and raw files beside them.

mod callouts;
mod drapes;
mod facts;
mod fit_sheets;
mod published;
mod runs;
mod sheets;
mod spec_tables;

use crate::assessment;
use crate::reporting::facts::BodyFacts;
use crate::reporting::runs::Album;
use fit::Simulator;
use report::data::{Fact, FitData, RawLink};
use report::{self, FileNames, Purpose, ReportData};
use spec::patterns;
use std::fmt;
use store::{InOrigin, JobFilter, Origin, PUBLISHED, Result, Store, Table, Value, evidence, read, sql};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Part {
    /// Such as `pictures`.
    pub name: &'static str,
    /// Number of the present step, from 1, and number of steps; 0 of 0 where they are not counted.
    pub step: [usize; 2],
}

/// Listener that is told of each part before it is made.
pub type Tell<'a> = &'a dyn Fn(Part);

impl fmt::Display for Part {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.step {
            [_, 0] => f.write_str(self.name),
            [step, of] => write!(f, "{}, {step} of {of}", self.name),
        }
    }
}

fn part(name: &'static str) -> Part {
    Part { name, step: [0, 0] }
}

/// Raw data: view, file, description.
const RAW: [(&str, &str, &str); 14] = [
    ("v_chi", "chi.csv", "L2D, L3D and chi of every measurement at every stage"),
    ("v_gap", "gap.csv", "girths of garment and body where Hybrid-GS does not close"),
    ("v_metrics", "metrics.csv", "E, SD, EI and the state of every drape"),
    ("v_ease", "ease.csv", "ease and fit class of every size and subject"),
    ("v_pom", "pom.csv", "points of measure of every drape, flat and on the body, with their grade steps"),
    ("v_fit", "fit.csv", "ease of every size at every level beside what is meant"),
    ("v_section", "section.csv", "gap from skin to cloth all round, at the levels of the body"),
    ("v_section_level", "section-level.csv", "girth, cloth, areas and gaps at the levels of the body"),
    ("v_balance", "balance.csv", "heights of hem and waist edge, lean of side seams"),
    ("v_fold", "fold.csv", "folds and drag lines"),
    ("v_pressure", "pressure.csv", "pressure by region of the body"),
    ("v_comment", "comments.csv", "comments of fittings, with the rounds that asked and met them"),
    ("v_drawn", "drawn.csv", "how far hem, cuffs and neckline are drawn as the body moves"),
    ("v_provenance", "provenance.csv", "hashes, versions and machine of every result"),
];

const BUILT: &str = "A body is built from the measurements given.";
const SCANNED: &str = "The body of a scan is the scan itself, cleaned and closed, and measured there.";

const METHODS: [&str; 5] = [
    "Each size is read from its DXF file, sewn as its seam file says and meshed. FEM-GS drapes the sewn cloth on the body by its weight, membrane, bending, contact and friction until \
     the residual force is a small share of the weight.",
    "L2D is the length of a measurement on the pattern, L3D the length of the same line on the drape, chi = L3D / L2D. E is \
     the mean of chi over the measurements, SD its sample standard deviation (n - 1), EI the mean of |chi - 1|.",
    "Ease is the girth of the pattern at a level less the girth of the body there; the least ease at chest and hip decides the \
     fit class of a garment.",
    "Maps show values averaged at the vertices of the mesh. Stretch is the greatest principal stretch beyond the pattern's own \
     size, which shear raises too; tension the greatest principal force in the cloth per metre of width, from that strain and \
     the fabric's stiffness: 100 N/m is a strip 1 cm wide that carries about 100 g. Gap is the distance to the body.",
    "Published values are those of the thesis for the same measurement, size and subject, recomputed from its printed \
     lengths where the pattern length agrees within 0.5 mm.",
];

const BUILT_LIMIT: &str =
    "Bodies that are built are shaped from a few measurements: where they differ from the person, so does the drape.";
const SCANNED_LIMIT: &str =
    "A scan is a body as it stood: where it was smoothed or a hole closed, the skin is a guess.";

const LIMITS: [&str; 1] = [
    "A fabric of the library is one measured cloth or stands for a class of cloths; its source tells which of its numbers are of another cloth. Friction is an estimate throughout.",
];

/// Files of a study's report by their relative paths: `index.html`, the other page, pictures, charts, drawings, CSV.
/// Without a purpose, `index.html` compares the simulators where the study has both, and else shows the fit.
pub fn report(store: &Store, study: &str, purpose: Option<Purpose>, tell: Tell<'_>) -> Result<Vec<(String, Vec<u8>)>> {
    if study == PUBLISHED {
        return published::report_published(store);
    }
    read::study(store, study)?;
    let mut files = Vec::new();
    let data = report_data(store, study, &mut files, tell)?;
    tell(part("tables"));
    for (view, file, _) in RAW {
        files.push((file.to_owned(), of_study(store, view, study)?.csv().into_bytes()));
    }
    let simulators = data.runs.iter().map(|run| run.simulator);
    let compares = Simulator::ALL.iter().all(|simulator| simulators.clone().any(|of_run| of_run == *simulator));
    let by_default = if compares { Purpose::Compare } else { Purpose::Fit };
    tell(part("pages and charts"));
    files.extend(report::files(&data, purpose.unwrap_or(by_default)).origin(Origin::Report)?);
    Ok(files)
}

fn report_data(store: &Store, study: &str, files: &mut Vec<(String, Vec<u8>)>, tell: Tell<'_>) -> Result<ReportData> {
    tell(part("bodies and patterns"));
    let jobs = read::jobs(store, &JobFilter { study: Some(study.to_owned()), ..JobFilter::default() })?;
    let bodies = facts::bodies(store, study, &jobs)?;
    let drawings = facts::drawings(store, &jobs, patterns::sheet)?;
    let mut names = FileNames::default();
    for drawing in &drawings {
        let name = names.part(&format!("pattern-{}-{}", drawing.garment, drawing.size));
        files.push((format!("{name}.svg"), drawing.svg.clone().into_bytes()));
    }
    let Album { runs, sheets, frame } = runs::report_runs(store, study, &jobs, files, tell)?;
    let link = |(href, label): (&str, &str)| RawLink { href: href.to_owned(), label: label.to_owned() };
    let raw = RAW.iter().map(|(_, href, label)| link((href, &format!("{href}: {label}"))));
    tell(part("fit"));
    let worn = assessment::worn(store, study, None, None)?;
    let today = one(store, "SELECT date('now')")?;
    Ok(ReportData {
        title: study.to_owned(),
        question: "How true does each drape stay to its pattern, and which simulator is to be trusted for which fit?".into(),
        made: format!("{today}, toile {}", env!("CARGO_PKG_VERSION")),
        verdicts: facts::verdicts(store, study)?,
        audit: facts::audit(store, study, &jobs, &bodies)?,
        provenance: facts(store, &format!(
            "SELECT DISTINCT 'Program' AS name, 'toile ' || program_version AS value FROM v_provenance WHERE study = {0}
            UNION SELECT 'Commit of the study', git_commit || iif(git_dirty, ', with uncommitted changes', '')
                FROM v_provenance WHERE study = {0} AND git_commit IS NOT NULL
            UNION SELECT 'Machine', machine FROM v_provenance WHERE study = {0}
            UNION SELECT job_input.name, value FROM job_input JOIN job USING (job_id) JOIN study USING (study_id)
                WHERE study.name = {0} AND is_current AND (job_input.name GLOB '*.version' OR job_input.name GLOB 'mesh.*'
                    OR job_input.name GLOB 'field.*' OR job_input.name = 'sim.parameters')",
            quoted(study)
        ))?,
        inputs: facts(store, &format!(
            "SELECT DISTINCT substr(job_input.name, instr(job_input.name, '.') + 1), value
            FROM job_input JOIN job USING (job_id) JOIN study USING (study_id)
            WHERE study.name = {} AND is_current AND length(value) = 64 AND job_input.name NOT GLOB 'sim.*' ORDER BY 1",
            quoted(study)
        ))?,
        fabrics: facts::fabric_facts(store, study)?,
        subjects: facts::subject_table(&bodies),
        assumed: facts::assumed(store, &jobs)?,
        drawings,
        cuts: read::cuts(store, study)?,
        ease: facts::ease_matrices(store, study)?,
        sizes: facts::size_tips(store, study, &bodies)?,
        fit: FitData {
            sheets: fit_sheets::sheets(store, study, &worn, frame, tell)?,
            points: facts::drawings(store, &jobs, patterns::points_sheet)?,
            definitions: fit_sheets::definitions(&worn),
            drapes: drapes::drapes(store, &jobs, &worn, tell)?,
        },
        runs,
        pairs: evidence::pairs(store, study)?,
        evidence: Some(evidence::evidence(store, study)?),
        methods: methods(of_bodies(&bodies, [BUILT, SCANNED])),
        limits: of_bodies(&bodies, [BUILT_LIMIT, SCANNED_LIMIT]).chain(LIMITS).map(str::to_owned).collect(),
        raw: raw.chain(sheets).collect(),
    })
}

/// Chooses between texts for built bodies and for scans, or takes both.
fn of_bodies<'a>(bodies: &[BodyFacts], [built, scanned]: [&'a str; 2]) -> impl Iterator<Item = &'a str> {
    let built = (!bodies.iter().all(BodyFacts::is_scan)).then_some(built);
    let scanned = bodies.iter().any(BodyFacts::is_scan).then_some(scanned);
    built.into_iter().chain(scanned)
}

/// Paragraphs, the first on the origin of the bodies.
fn methods<'a>(of_bodies: impl Iterator<Item = &'a str>) -> Vec<String> {
    let [first, rest @ ..] = METHODS;
    let first = of_bodies.chain([first]).collect::<Vec<_>>().join(" ");
    [first].into_iter().chain(rest.map(str::to_owned)).collect()
}

fn of_study(store: &Store, view: &str, study: &str) -> Result<Table> {
    sql::query(store, &format!("SELECT * FROM {view} WHERE study = {}", quoted(study)))
}

/// Rows with two columns, as named values.
fn facts(store: &Store, sql: &str) -> Result<Vec<Fact>> {
    let row = |row: &Vec<Value>| Fact { name: row[0].to_string(), value: row[1].to_string() };
    Ok(sql::query(store, sql)?.rows.iter().map(row).collect())
}

/// First value of a query.
fn one(store: &Store, sql: &str) -> Result<String> {
    Ok(sql::query(store, sql)?.rows.first().and_then(|row| row.first()).map(Value::to_string).unwrap_or_default())
}

/// Length in m from a cell in mm.
fn mm_value(value: &Value) -> f64 {
    geom::units::from_mm(facts::number(value).unwrap_or(f64::NAN))
}

/// Text as an SQL literal.
fn quoted(text: &str) -> String {
    format!("'{}'", text.replace('\'', "''"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use facts::tests::body;

    #[test]
    fn methods_and_limits_are_those_of_the_bodies_that_there_are() {
        let check = |bodies: &[BodyFacts], methods_say: &str, limits: &[&str]| {
            let found = methods(of_bodies(bodies, [BUILT, SCANNED]));
            assert_eq!(found.len(), METHODS.len());
            assert_eq!(found[0], format!("{methods_say}{}", METHODS[0]));
            assert_eq!(of_bodies(bodies, [BUILT_LIMIT, SCANNED_LIMIT]).collect::<Vec<_>>(), limits);
        };
        let (built, scan) = (|| body(None), || body(Some("fit-model.ply")));
        check(&[built(), built()], &format!("{BUILT} "), &[BUILT_LIMIT]);
        check(&[scan()], &format!("{SCANNED} "), &[SCANNED_LIMIT]);
        check(&[built(), scan()], &format!("{BUILT} {SCANNED} "), &[BUILT_LIMIT, SCANNED_LIMIT]);
    }
}

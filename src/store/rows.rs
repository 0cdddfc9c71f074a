//! Plain values that the store returns: identifiers, states, and the rows that screens and reports show.

use std::fmt;
use std::str::FromStr;

use fit::{FitClass, Simulator};
use geom::units::mm;
use pattern::table;
use sim::{Progress, Step};

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Serialize)]
#[serde(transparent)]
pub struct JobId(pub i64);

impl fmt::Display for JobId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

impl FromStr for JobId {
    type Err = std::num::ParseIntError;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        text.parse().map(Self)
    }
}

/// Number of a subject's revision, whose measurements never change.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SubjectId(pub i64);

/// Revisions of a style and of one of its sizes, whose pattern and seam file never change.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SizeKey {
    pub style: i64,
    pub size: i64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Status {
    Queued,
    Running,
    /// Has a converged result.
    Done,
    /// Has a result whose residual did not reach its tolerance.
    NotConverged,
    Failed,
    Cancelled,
}

impl Status {
    /// Order is that of a job's life.
    pub const ALL: [Self; 6] =
        [Self::Queued, Self::Running, Self::Done, Self::NotConverged, Self::Failed, Self::Cancelled];

    /// Name in SQL.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Queued => "queued",
            Self::Running => "running",
            Self::Done => "done",
            Self::NotConverged => "not_converged",
            Self::Failed => "failed",
            Self::Cancelled => "cancelled",
        }
    }

    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|status| status.as_str() == name)
    }

    pub fn has_result(self) -> bool {
        matches!(self, Self::Done | Self::NotConverged)
    }

    /// True if the job has ended, and only a user can change its state.
    pub fn is_final(self) -> bool {
        !matches!(self, Self::Queued | Self::Running)
    }
}

#[derive(Clone, Debug, PartialEq)]
pub struct JobProgress {
    /// `sew`, `drape`, ...
    pub phase: String,
    /// Share done, 0 to 1.
    pub fraction: f64,
    pub step: Step,
}

impl From<&Progress> for JobProgress {
    fn from(progress: &Progress) -> Self {
        Self { phase: progress.phase.to_owned(), fraction: progress.fraction, step: progress.step }
    }
}

/// A study and the states of its current jobs.
#[derive(Clone, Debug, PartialEq)]
pub struct StudyRow {
    /// Unique in the database.
    pub name: String,
    /// Path of the study's `study.toml`.
    pub path: std::path::PathBuf,
    /// True while no job of the study may start.
    pub paused: bool,
    /// Jobs in each state, in the order of [`Status::ALL`].
    pub counts: [usize; 6],
    /// Order is that of the study file.
    pub garments: Vec<String>,
}

impl StudyRow {
    /// Number of current jobs.
    pub fn total(&self) -> usize {
        self.counts.iter().sum()
    }

    pub fn count(&self, status: Status) -> usize {
        self.counts[status as usize]
    }
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OutfitRow {
    pub study: String,
    pub name: String,
    /// Garment in the study and style in the catalogue of each layer, the inmost first.
    pub layers: Vec<(String, String)>,
}

/// A job as lists show it.
#[derive(Clone, Debug, PartialEq)]
pub struct JobRow {
    pub id: JobId,
    pub study: String,
    pub garment: String,
    pub size: String,
    pub subject: String,
    pub simulator: Simulator,
    /// Number of the repeat of the same simulation, from 1.
    pub repeat: u32,
    pub status: Status,
    /// True while the job's inputs are those of the study file.
    pub is_current: bool,
    /// Jobs of greater priority run earlier.
    pub priority: i64,
    pub attempts: u32,
    pub error: Option<String>,
    /// Since 1970 (UTC).
    pub queued_at_ms: i64,
    /// Last start, since 1970 (UTC).
    pub started_at_ms: Option<i64>,
    /// Since 1970 (UTC).
    pub finished_at_ms: Option<i64>,
    /// Time from the last start to the end; `None` until the job ends.
    pub wall_ms: Option<i64>,
    /// `None` unless the job runs.
    pub progress: Option<JobProgress>,
    pub ei: Option<f64>,
    pub penetration_max_m: Option<f64>,
}

/// Depth inside the body from which the state of a result tells it, m. Where a garment is large enough, both simulators
/// leave 0 to 1 mm (docs/hybrid.md): more than this is cloth that could not lie there.
pub const INSIDE_M: f64 = 5e-3;

/// Depth of a drape inside the body in words, `37 mm inside`; `None` up to [`INSIDE_M`].
pub fn inside_words(penetration_max_m: f64) -> Option<String> {
    (penetration_max_m > INSIDE_M).then(|| format!("{:.0} mm inside", mm(penetration_max_m)))
}

impl JobRow {
    /// `None` without a result, and up to [`INSIDE_M`].
    pub fn inside(&self) -> Option<String> {
        self.penetration_max_m.and_then(inside_words)
    }

    /// Estimated time left: (time since the start) * (1 - f) / f, where f is the share done.
    pub fn eta_ms(&self, now_ms: i64) -> Option<i64> {
        let fraction = self.progress.as_ref()?.fraction;
        let elapsed = (now_ms - self.started_at_ms?).max(0) as f64;
        (fraction > 0.0).then(|| (elapsed * (1.0 - fraction) / fraction) as i64)
    }
}

/// One cell of a study's grid: a size on a subject, by one simulator.
#[derive(Clone, Debug, PartialEq)]
pub struct Cell {
    /// Current job; `None` while the study is not queued.
    pub job: Option<JobId>,
    pub status: Option<Status>,
    /// Share done while it runs, 0 to 1.
    pub fraction: Option<f64>,
    pub ei: Option<f64>,
    /// True where the result lies inside the body by more than [`INSIDE_M`].
    pub is_inside: bool,
}

/// Fit of one size on one subject, from the ease of the level that decides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FitCell {
    pub class: FitClass,
    /// Pattern girth minus body girth.
    pub ease_m: f64,
    /// True where the pattern is smaller than the body.
    pub undersized: bool,
    /// True where the ease is in the range that two fit classes of the thesis share.
    pub borderline: bool,
}

/// A study's garment as a grid of sizes (rows) by subjects (columns).
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    pub study: String,
    pub garment: String,
    /// Order is that of the study file.
    pub sizes: Vec<String>,
    /// Order is that of the study file.
    pub subjects: Vec<String>,
    /// Simulators that have jobs, in the order of the innermost index of `cells`.
    pub simulators: Vec<Simulator>,
    /// `cells[size][subject][simulator]`, of the first repeat.
    pub cells: Vec<Vec<Vec<Cell>>>,
    /// `fits[size][subject]`; `None` where the ease is not known.
    pub fits: Vec<Vec<Option<FitCell>>>,
}

#[derive(Clone, Debug, PartialEq)]
pub struct ChiRow {
    /// `sewn`, `popup` or `drape`.
    pub stage: String,
    pub no: u32,
    pub name: String,
    /// True for a closed girth.
    pub is_girth: bool,
    /// True where the measurement runs along an edge that no seam holds.
    pub is_free_edge: bool,
    /// True where the simulator sets this length to that of the pattern by construction.
    pub is_controlled: bool,
    /// Pattern length.
    pub l2d_m: f64,
    /// Length on the drape.
    pub l3d_m: f64,
}

impl ChiRow {
    /// Evaluation ratio L3D / L2D.
    pub fn chi(&self) -> f64 {
        self.l3d_m / self.l2d_m
    }
}

/// Metrics of one result.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MetricsRow {
    /// Number of measurements.
    pub n: u32,
    /// Mean chi.
    pub e_chi: f64,
    /// Sample standard deviation of chi.
    pub sd_chi: f64,
    /// Mean |chi - 1|.
    pub ei: f64,
    /// Greatest |chi - 1| of a measurement.
    pub max_abs_error: f64,
    /// Vertices of the sewn mesh.
    pub vertices: u32,
    pub faces: u32,
    /// Sum over all mesh levels.
    pub iterations: u32,
    /// Rms residual force divided by the mean weight of a vertex.
    pub residual: f64,
    pub converged: bool,
    pub penetration_max_m: f64,
    pub seam_gap_max_m: f64,
    /// Edges that pierce the garment's own cloth; `None` for results of earlier programs, which did not count them.
    pub self_crossings: Option<u32>,
    /// FEM-GS: principal stretch less 1 that 1 % of the cloth exceeds; `None` for results of earlier programs, which
    /// did not measure it.
    pub distortion: Option<f64>,
}

#[derive(Clone, Debug, PartialEq)]
pub struct EaseRow {
    pub garment: String,
    pub size: String,
    pub subject: String,
    /// `chest`, `hip`, ...
    pub level: String,
    pub pattern_girth_m: f64,
    pub body_girth_m: f64,
    /// True where this level has the least ease and so decides the fit class.
    pub decides: bool,
    pub fit: FitCell,
}

#[derive(Clone, Debug, PartialEq)]
pub struct RecommendationRow {
    pub garment: String,
    pub class: FitClass,
    pub recommended: Simulator,
    /// `evidence` or `rule`.
    pub basis: String,
    /// `fem`, `hybrid`, `no_difference` or `insufficient_evidence`.
    pub verdict: String,
    /// Simulator that the thesis's rule names.
    pub rule_says: Simulator,
    /// Mean over subjects of EI by FEM-GS less EI by Hybrid-GS.
    pub effect: Option<f64>,
    /// Confidence interval of that mean.
    pub interval: Option<(f64, f64)>,
    /// Number of subjects with results of both simulators.
    pub n_subjects: u32,
    pub reason: String,
    /// Holm-adjusted p of the sign-flip test; `None` with too few subjects.
    pub p_holm: Option<f64>,
    /// Data that would settle the question or reverse the recommendation, in words.
    pub would_settle: String,
}

#[derive(Clone, Debug, PartialEq)]
pub struct LogLine {
    /// Since 1970 (UTC).
    pub at_ms: i64,
    /// `info`, `warn` or `error`.
    pub level: String,
    pub text: String,
}

#[derive(Clone, Debug, PartialEq)]
pub struct StageRow {
    /// `body`, `field`, `mesh` or `drape`.
    pub stage: String,
    /// Hash of the inputs, under which the cache keeps the product.
    pub hash: String,
    pub was_cached: bool,
}

/// Ending of a file, and the maker of its bytes from rows.
pub type Encoder = (&'static str, fn(&Table) -> std::io::Result<Vec<u8>>);

#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    pub columns: Vec<String>,
    pub rows: Vec<Vec<Value>>,
}

impl Table {
    pub fn new<'a>(columns: impl IntoIterator<Item = &'a str>, rows: impl IntoIterator<Item = Vec<Value>>) -> Self {
        Self { columns: columns.into_iter().map(str::to_owned).collect(), rows: rows.into_iter().collect() }
    }

    /// Guards texts that a spreadsheet would take for formulas.
    pub fn csv(&self) -> String {
        let rows = self.rows.iter().map(|row| csv_row(row));
        std::iter::once(csv_head(&self.columns)).chain(rows).collect()
    }
}

/// Headings of which none is twice, for formats that find values by them: `ei`, `ei_2`.
pub fn distinct(columns: &[String]) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for column in columns {
        let free = |name: &String| !names.contains(name) && (name == column || !columns.contains(name));
        let named = (2..).map(|n| format!("{column}_{n}"));
        names.extend(std::iter::once(column.clone()).chain(named).find(free));
    }
    names
}

pub(crate) fn csv_head(columns: &[String]) -> String {
    table::line(columns.iter().map(|name| table::guarded(name)))
}

pub(crate) fn csv_row(row: &[Value]) -> String {
    table::line(row.iter().map(|value| match value {
        Value::Text(text) => table::guarded(text),
        other => other.to_string().into(),
    }))
}

#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    Null,
    Integer(i64),
    Real(f64),
    Text(String),
    /// Number of bytes of a blob, whose contents are not kept.
    Blob(usize),
}

impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Null => Ok(()),
            Self::Integer(value) => value.fmt(f),
            Self::Real(value) => value.fmt(f),
            Self::Text(value) => value.fmt(f),
            Self::Blob(bytes) => write!(f, "<{bytes} bytes>"),
        }
    }
}

impl From<&Value> for serde_json::Value {
    fn from(value: &Value) -> Self {
        match value {
            Value::Null => Self::Null,
            Value::Integer(number) => (*number).into(),
            Value::Real(number) => (*number).into(),
            Value::Text(text) => text.as_str().into(),
            Value::Blob(_) => value.to_string().into(),
        }
    }
}

/// A cached stage of a job; each depends on some of the job's inputs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum StageKind {
    Body,
    /// Distance field of the body.
    Field,
    /// Mesh of the flat garment.
    Mesh,
    /// Drape: the garment sewn and at rest on the body.
    Drape,
}

impl StageKind {
    /// Order is that in which data flows.
    pub const ALL: [Self; 4] = [Self::Body, Self::Field, Self::Mesh, Self::Drape];

    pub fn as_str(self) -> &'static str {
        match self {
            Self::Body => "body",
            Self::Field => "field",
            Self::Mesh => "mesh",
            Self::Drape => "drape",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headings_are_told_apart() {
        let check = |columns: &[&str], expect: &[&str]| {
            let columns: Vec<String> = columns.iter().map(|name| (*name).to_owned()).collect();
            assert_eq!(distinct(&columns), expect);
        };
        check(&["a", "b"], &["a", "b"]);
        check(&["ei", "n", "ei", "ei"], &["ei", "n", "ei_2", "ei_3"]);
        check(&["ei", "ei_2", "ei"], &["ei", "ei_2", "ei_3"]);
    }
}

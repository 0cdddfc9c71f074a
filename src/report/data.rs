//! Data of a report: plain values, with lengths in metres and times in seconds. The pages format them.

use fit::measure::{Chi, Metrics, metrics};
use fit::{Basis, Cuts, Ease, Evidence, Finding, FitClass, Pair, Simulator};
use render::Scale;

use super::chart::Chart;
use super::viewer::Drapes;

/// All data of a report.
#[derive(Clone, Debug, Default)]
pub struct ReportData {
    /// Name of the study.
    pub title: String,
    /// Question of the study, one sentence.
    pub question: String,
    /// Date and program of the report (`2025-03-01, toile 0.1.0`).
    pub made: String,
    /// Recommended simulator for every garment and fit class.
    pub verdicts: Vec<Verdict>,
    /// Findings of the audit, such as exclusions and mismatches of inputs. The page adds failed and unconverged runs.
    pub audit: Vec<AuditNote>,
    /// Program version, git commit, machine, seeds and solver parameters, in the order of the page.
    pub provenance: Vec<Fact>,
    /// Input files and their hashes.
    pub inputs: Vec<Fact>,
    /// Properties of each fabric, with their source.
    pub fabrics: Vec<FabricFacts>,
    /// Measurements of the subjects, one subject to a row.
    pub subjects: SubjectTable,
    /// Pattern drawings with numbered measurements.
    pub drawings: Vec<Drawing>,
    /// Assumptions on the pattern of each garment, and pieces that are not sewn.
    pub assumed: Vec<Assumed>,
    /// Ease below which a fit is tight and above which it is loose, m.
    pub cuts: Cuts,
    /// Ease of every subject and size, garment by garment.
    pub ease: Vec<EaseMatrix>,
    /// Recommended size of each garment for each subject.
    pub sizes: Vec<SizeTip>,
    /// Fit of each garment on each subject.
    pub fit: FitData,
    /// All runs, including failed ones.
    pub runs: Vec<TryOn>,
    /// Cases that both simulators draped.
    pub pairs: Vec<Pair>,
    /// Statistics of these cases; `None` without cases.
    pub evidence: Option<Evidence>,
    /// Methods, one paragraph each.
    pub methods: Vec<String>,
    /// Limits of the study, one paragraph each.
    pub limits: Vec<String>,
    /// Files with the raw numbers, as addresses relative to the page.
    pub raw: Vec<RawLink>,
}

/// Recommendation of a simulator.
#[derive(Clone, Debug)]
pub struct Verdict {
    /// Name of the garment in the study.
    pub garment: String,
    /// Fit class of the recommendation.
    pub class: FitClass,
    /// Recommended simulator.
    pub recommended: Simulator,
    /// Basis of the recommendation.
    pub basis: Basis,
    /// Finding of the study.
    pub finding: Finding,
    /// Mean EI of FEM-GS less that of Hybrid-GS; `None` unless both ran.
    pub effect: Option<f64>,
    /// Ends of the confidence interval of that mean; `None` for fewer than two subjects.
    pub interval: Option<(f64, f64)>,
    /// p of the sign-flip test after Holm's correction; `None` for too few subjects.
    pub p_holm: Option<f64>,
    /// Number of subjects.
    pub subjects: usize,
    /// One sentence of explanation.
    pub reason: String,
    /// Evidence that would settle or reverse the recommendation.
    pub would_settle: String,
}

/// Severity of a note of the audit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    /// Results are missing or wrong.
    Failure,
    /// Results need care.
    Warning,
    /// Results are valid; the note is for information.
    Note,
}

impl Severity {
    /// Word and style class of the severity.
    #[must_use]
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Failure => "failure",
            Self::Warning => "warning",
            Self::Note => "note",
        }
    }

    /// Symbol before a note.
    #[must_use]
    pub fn glyph(self) -> &'static str {
        match self {
            Self::Failure => "✗",
            Self::Warning => "!",
            Self::Note => "i",
        }
    }
}

/// A note of the audit.
#[derive(Clone, Debug)]
pub struct AuditNote {
    /// Severity of the note.
    pub severity: Severity,
    /// The finding, one or two sentences.
    pub text: String,
}

/// A named value.
#[derive(Clone, Debug)]
pub struct Fact {
    /// Name of the value, as the page shows it.
    pub name: String,
    /// Value with its unit.
    pub value: String,
}

/// Properties of a fabric.
#[derive(Clone, Debug)]
pub struct FabricFacts {
    /// Name of the fabric, as the study has it.
    pub name: String,
    /// Properties with their units.
    pub facts: Vec<Fact>,
    /// Publication or measurement that the properties come from.
    pub source: String,
}

/// A column of the subject table.
#[derive(Clone, Debug)]
pub struct Column {
    /// Name of the measurement as in ISO 8559-1.
    pub name: String,
    /// Unit of the column's values (`mm`, `kg`), which the page does not convert.
    pub unit: String,
    /// Number of decimals of the values.
    pub decimals: usize,
}

/// Subjects and their measurements.
#[derive(Clone, Debug, Default)]
pub struct SubjectTable {
    /// Columns, one for each measurement.
    pub columns: Vec<Column>,
    /// Rows, one for each subject.
    pub rows: Vec<Subject>,
}

/// A row of the subject table.
#[derive(Clone, Debug)]
pub struct Subject {
    /// Name in the study.
    pub name: String,
    /// Words about the subject (sex, source of the body).
    pub note: String,
    /// A value for each column; `None` where it is not known.
    pub values: Vec<Option<f64>>,
}

/// A drawing of a garment's pattern.
#[derive(Clone, Debug)]
pub struct Drawing {
    /// Name of the garment in the study.
    pub garment: String,
    /// Name of the size that is drawn.
    pub size: String,
    /// Drawing as SVG. The page shows it as a picture, so that no script in it runs.
    pub svg: String,
}

/// Assumptions on the pattern of a garment.
#[derive(Clone, Debug)]
pub struct Assumed {
    /// Name of the garment in the study.
    pub garment: String,
    /// Assumptions, such as the line that is sewn.
    pub told: Vec<String>,
    /// Pieces that are drawn and not sewn, each group with its reason.
    pub left_out: Vec<Fact>,
}

/// Ease of one garment.
#[derive(Clone, Debug)]
pub struct EaseMatrix {
    /// Name of the garment in the study.
    pub garment: String,
    /// Sizes, one to a row.
    pub sizes: Vec<String>,
    /// Subjects, one to a column.
    pub subjects: Vec<String>,
    /// Ease that decides the fit, by size and then subject; `None` where a girth is not known.
    pub cells: Vec<Vec<Option<Ease>>>,
}

/// Recommended size of a garment for a subject.
#[derive(Clone, Debug)]
pub struct SizeTip {
    /// Name of the garment in the study.
    pub garment: String,
    /// Name of the subject in the study.
    pub subject: String,
    /// Name of the recommended size.
    pub size: String,
    /// Reason for that size, in words.
    pub reason: String,
    /// Tension at each level in the FEM-GS drape of that size; empty without a drape.
    pub tension: String,
    /// Picture of that size that a customer should see.
    pub shown: String,
}

/// Data of the fit report, besides the runs.
#[derive(Clone, Debug, Default)]
pub struct FitData {
    /// Fit of each garment on each subject.
    pub sheets: Vec<FitSheet>,
    /// Pattern drawings with numbered points of measure.
    pub points: Vec<Drawing>,
    /// Definition of each point of measure in these drawings.
    pub definitions: Vec<Fact>,
    /// Drapes for the three-dimensional viewer of the page.
    pub drapes: Drapes,
}

/// Fit of a garment on a subject, in the recommended size and its neighbours.
#[derive(Clone, Debug)]
pub struct FitSheet {
    /// Name of the garment in the study.
    pub garment: String,
    /// Name of the subject in the study.
    pub subject: String,
    /// Intended fit; empty if there is none.
    pub intended: String,
    /// Recommended size with its worst deviation, in words.
    pub verdict: String,
    /// Balance and pressure of the recommended size, in words; empty where it has no drape.
    pub drape: String,
    /// Recommended size and its neighbours, from the smallest.
    pub sizes: Vec<FitSize>,
    /// Simulator of the drapes that are measured; `None` without a drape.
    pub simulator: Option<Simulator>,
    /// Tables of ease by level, balance and pressure, and points of measure.
    pub tables: Vec<FitTable>,
    /// Cross sections of all sizes that have a drape.
    pub sections: Vec<Chart>,
    /// Comments of the rounds of fitting, by number.
    pub comments: Vec<FitComment>,
    /// Last round with its sign-off, in words; empty without a round.
    pub round: String,
    /// Size on whose pictures the callouts of open comments stand; empty without an open comment on a drape.
    pub called: String,
}

/// A comment of a fitting.
#[derive(Clone, Debug)]
pub struct FitComment {
    /// Number of the callout.
    pub number: i64,
    /// Side from which it is seen: `front`, `side` or `back`.
    pub side: &'static str,
    /// Place on the garment, such as `hip`.
    pub place: String,
    /// Place in the picture of the side, as shares of its width from the left and of its height from the top; `None`
    /// where no callout stands.
    pub spot: Option<[f64; 2]>,
    /// Finding, in words.
    pub said: String,
    /// `minor`, `major` or `critical`.
    pub severity: &'static str,
    /// Likely cause; empty if not known.
    pub cause: String,
    /// Action to take; empty if none is known.
    pub action: String,
    /// Name of who is to act; empty if nobody.
    pub owner: String,
    /// Round that asked and state, in words.
    pub state: String,
}

/// A size of a fit sheet.
#[derive(Clone, Debug)]
pub struct FitSize {
    /// Name of the size, such as `M`.
    pub size: String,
    /// True for the recommended size.
    pub is_to_wear: bool,
    /// True if the size fits. Where the recommended size does not fit, no size does.
    pub fits: bool,
    /// Worst deviation of the size, in words.
    pub words: String,
}

/// A table of a fit sheet.
#[derive(Clone, Debug)]
pub struct FitTable {
    /// Content of the table, with the unit.
    pub caption: String,
    /// Headings of the columns after that of the row names.
    pub columns: Vec<String>,
    /// Rows, from the top; each has a cell for every column.
    pub rows: Vec<FitRow>,
}

/// A row of a fit sheet's table.
#[derive(Clone, Debug)]
pub struct FitRow {
    /// Subject of the row, such as a level of the body.
    pub name: String,
    /// Cells, one for each column.
    pub cells: Vec<FitCell>,
}

/// A cell of a table of a fit sheet.
#[derive(Clone, Debug, Default)]
pub struct FitCell {
    /// Number as text, in the unit of the table.
    pub text: String,
    /// Remark on the number.
    pub note: String,
    /// Position relative to the target; `None` without a target.
    pub verdict: Option<FitVerdict>,
}

/// Position of an ease relative to its target.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FitVerdict {
    /// Below the target: too little ease.
    Tight,
    /// Within the target.
    AsMeant,
    /// Above the target: too much ease.
    Loose,
}

/// Outcome of a run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// Residual within tolerance, all seams closed.
    Converged,
    /// Stopped before convergence, but measured.
    NotConverged,
    /// No result, for this reason.
    Failed(String),
    /// Published numbers, of a computation whose course is not known.
    Printed,
}

/// One measurement of one run.
#[derive(Clone, Debug)]
pub struct Measured {
    /// Name, such as `neck girth`.
    pub name: String,
    /// Number, pattern length and draped length.
    pub chi: Chi,
    /// True for a closed girth, false for an open length.
    pub closed: bool,
    /// True if the measurement lies on a free edge, to which nothing is sewn.
    pub free_edge: bool,
    /// True if the simulator sets the length to that of the pattern by construction.
    pub controlled: bool,
    /// Chi that the thesis prints for the same case, if any.
    pub published_chi: Option<f64>,
    /// Printed chi, where it is not the ratio of the lengths printed beside it.
    pub misprint: Option<f64>,
}

/// A picture file.
#[derive(Clone, Debug)]
pub struct Picture {
    /// Bytes of a PNG or JPEG file; its first bytes tell which.
    pub bytes: Vec<u8>,
    /// Address of the full-size file relative to the page; empty without one.
    pub file: String,
    /// Alternative text.
    pub alt: String,
    /// Caption.
    pub caption: String,
}

/// A picture of a scalar field. The page draws the legend below it.
#[derive(Clone, Debug)]
pub struct FieldMap {
    /// Picture without a legend.
    pub picture: Picture,
    /// Scale of the picture's colours.
    pub scale: Scale,
}

/// One garment, in one size and fabric, on one subject, by one simulator.
#[derive(Clone, Debug)]
pub struct TryOn {
    /// Name of the garment in the study.
    pub garment: String,
    /// Name of the garment without the seed of its start: runs that differ only in the seed are repeats of one case.
    pub case: String,
    /// Number of the run among those with the same inputs, from 1.
    pub repeat: u32,
    /// Name of the size, such as `M`.
    pub size: String,
    /// Name of the subject in the study.
    pub subject: String,
    /// Simulator that draped the garment.
    pub simulator: Simulator,
    /// Name of the fabric, as the study has it.
    pub fabric: String,
    /// Outcome of the run.
    pub outcome: Outcome,
    /// Ease that decides the fit class; `None` where it is not known.
    pub ease: Option<Ease>,
    /// Measurements; empty for a failed run.
    pub measured: Vec<Measured>,
    /// Number of vertices after sewing.
    pub vertices: usize,
    /// Number of triangles of the draped mesh.
    pub faces: usize,
    /// Number of iterations, summed over all mesh levels.
    pub iterations: u32,
    /// Final root mean square residual force divided by the mean weight of a vertex.
    pub residual: f64,
    /// Residual by iteration.
    pub residuals: Vec<(u32, f64)>,
    /// Deepest penetration into the body, m.
    pub penetration_max_m: f64,
    /// Greatest seam gap, m.
    pub seam_gap_max_m: f64,
    /// Wall time, s.
    pub wall_s: f64,
    /// Pictures from the front, side, back and quarter.
    pub views: Vec<Picture>,
    /// Maps of strain, gap and other fields.
    pub maps: Vec<FieldMap>,
}

impl TryOn {
    /// E, SD and EI of the measurements that `keep` selects; `None` if it selects none.
    #[must_use]
    pub fn metrics(&self, keep: impl Fn(&Measured) -> bool) -> Option<Metrics> {
        let chis: Vec<Chi> = self.measured.iter().filter(|m| keep(m)).map(|m| m.chi.clone()).collect();
        metrics(&chis)
    }

    /// Returns the measurement of a number.
    #[must_use]
    pub fn measurement(&self, no: u32) -> Option<&Measured> {
        self.measured.iter().find(|m| m.chi.no == no)
    }
}

/// Measurements that any of the runs has, by number, each as the first run describes it.
pub(super) fn measurements<'a>(runs: &[&'a TryOn]) -> Vec<&'a Measured> {
    let mut all: Vec<&Measured> = runs.iter().flat_map(|r| &r.measured).collect();
    all.sort_by_key(|m| m.chi.no);
    all.dedup_by_key(|m| m.chi.no);
    all
}

/// A file beside the page.
#[derive(Clone, Debug)]
pub struct RawLink {
    /// Address of the file, relative to the page.
    pub href: String,
    /// Content of the file.
    pub label: String,
}

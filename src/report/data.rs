//! Data of a report: plain values, with lengths in metres and times in seconds. The pages format them.

use fit::measure::{Chi, Metrics, metrics};
use fit::{Basis, Cuts, Ease, Evidence, Finding, FitClass, Pair, Simulator};
use render::Scale;

use super::chart::Chart;
use super::viewer::Drapes;

#[derive(Clone, Debug, Default)]
pub struct ReportData {
    pub title: String,
    pub question: String,
    /// Date and program, such as `2025-03-01, toile 0.1.0`.
    pub made: String,
    /// One for every garment and fit class.
    pub verdicts: Vec<Verdict>,
    /// Findings of the audit, such as exclusions and mismatches of inputs. The page adds failed and unconverged runs.
    pub audit: Vec<AuditNote>,
    /// Program version, git commit, machine, seeds and solver parameters, in the order of the page.
    pub provenance: Vec<Fact>,
    pub inputs: Vec<Fact>,
    pub fabrics: Vec<FabricFacts>,
    pub subjects: SubjectTable,
    /// Pattern drawings with numbered measurements.
    pub drawings: Vec<Drawing>,
    pub assumed: Vec<Assumed>,
    pub cuts: Cuts,
    pub ease: Vec<EaseMatrix>,
    /// Recommended size of each garment for each subject.
    pub sizes: Vec<SizeTip>,
    pub fit: FitData,
    /// Includes failed runs.
    pub runs: Vec<TryOn>,
    /// Cases that both simulators draped.
    pub pairs: Vec<Pair>,
    /// Statistics of `pairs`; `None` without cases.
    pub evidence: Option<Evidence>,
    /// One paragraph each.
    pub methods: Vec<String>,
    /// One paragraph each.
    pub limits: Vec<String>,
    pub raw: Vec<RawLink>,
}

#[derive(Clone, Debug)]
pub struct Verdict {
    pub garment: String,
    pub class: FitClass,
    pub recommended: Simulator,
    pub basis: Basis,
    pub finding: Finding,
    /// Mean EI of FEM-GS less that of Hybrid-GS; `None` unless both ran.
    pub effect: Option<f64>,
    /// Ends of the confidence interval of `effect`; `None` for fewer than two subjects.
    pub interval: Option<(f64, f64)>,
    /// p of the sign-flip test after Holm's correction; `None` for too few subjects.
    pub p_holm: Option<f64>,
    pub subjects: usize,
    pub reason: String,
    /// Evidence that would settle or reverse the recommendation.
    pub would_settle: String,
}

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
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Failure => "failure",
            Self::Warning => "warning",
            Self::Note => "note",
        }
    }

    pub fn glyph(self) -> &'static str {
        match self {
            Self::Failure => "✗",
            Self::Warning => "!",
            Self::Note => "i",
        }
    }
}

#[derive(Clone, Debug)]
pub struct AuditNote {
    pub severity: Severity,
    pub text: String,
}

#[derive(Clone, Debug)]
pub struct Fact {
    pub name: String,
    /// Includes the unit.
    pub value: String,
}

#[derive(Clone, Debug)]
pub struct FabricFacts {
    pub name: String,
    pub facts: Vec<Fact>,
    pub source: String,
}

#[derive(Clone, Debug)]
pub struct Column {
    /// Name of the measurement as in ISO 8559-1.
    pub name: String,
    /// Unit of the column's values (`mm`, `kg`), which the page does not convert.
    pub unit: String,
    /// Number of decimals of the values.
    pub decimals: usize,
}

#[derive(Clone, Debug, Default)]
pub struct SubjectTable {
    pub columns: Vec<Column>,
    pub rows: Vec<Subject>,
}

#[derive(Clone, Debug)]
pub struct Subject {
    pub name: String,
    /// Words about the subject (sex, source of the body).
    pub note: String,
    /// A value for each column; `None` where it is not known.
    pub values: Vec<Option<f64>>,
}

#[derive(Clone, Debug)]
pub struct Drawing {
    pub garment: String,
    pub size: String,
    /// SVG. The page shows it as a picture, so that no script in it runs.
    pub svg: String,
}

#[derive(Clone, Debug)]
pub struct Assumed {
    pub garment: String,
    /// Assumptions, such as the line that is sewn.
    pub told: Vec<String>,
    /// Pieces that are drawn and not sewn, each group with its reason.
    pub left_out: Vec<Fact>,
}

#[derive(Clone, Debug)]
pub struct EaseMatrix {
    pub garment: String,
    pub sizes: Vec<String>,
    pub subjects: Vec<String>,
    /// Ease that decides the fit, by size and then subject; `None` where a girth is not known.
    pub cells: Vec<Vec<Option<Ease>>>,
}

#[derive(Clone, Debug)]
pub struct SizeTip {
    pub garment: String,
    pub subject: String,
    pub size: String,
    pub reason: String,
    /// Tension at each level in the FEM-GS drape of that size; empty without a drape.
    pub tension: String,
    /// Picture of that size that a customer should see.
    pub shown: String,
}

#[derive(Clone, Debug, Default)]
pub struct FitData {
    pub sheets: Vec<FitSheet>,
    /// Pattern drawings with numbered points of measure.
    pub points: Vec<Drawing>,
    pub definitions: Vec<Fact>,
    pub drapes: Drapes,
}

/// Fit of a garment on a subject, in the recommended size and its neighbours.
#[derive(Clone, Debug)]
pub struct FitSheet {
    pub garment: String,
    pub subject: String,
    /// Empty if there is none.
    pub intended: String,
    /// Recommended size with its worst deviation, in words.
    pub verdict: String,
    /// Balance and pressure of the recommended size, in words; empty where it has no drape.
    pub drape: String,
    /// Recommended size and its neighbours, from the smallest.
    pub sizes: Vec<FitSize>,
    /// Simulator of the drapes that are measured; `None` without a drape.
    pub simulator: Option<Simulator>,
    pub tables: Vec<FitTable>,
    pub sections: Vec<Chart>,
    /// Comments of all rounds of fitting, by number.
    pub comments: Vec<FitComment>,
    /// Last round with its sign-off, in words; empty without a round.
    pub round: String,
    /// Size on whose pictures the callouts of open comments stand; empty without an open comment on a drape.
    pub called: String,
}

#[derive(Clone, Debug)]
pub struct FitComment {
    pub number: i64,
    /// `front`, `side` or `back`.
    pub side: &'static str,
    /// Place on the garment, such as `hip`.
    pub place: String,
    /// Shares of the picture's width from the left and of its height from the top; `None` where no callout stands.
    pub spot: Option<[f64; 2]>,
    pub said: String,
    /// `minor`, `major` or `critical`.
    pub severity: &'static str,
    /// Empty if not known.
    pub cause: String,
    /// Empty if none is known.
    pub action: String,
    /// Empty if nobody is to act.
    pub owner: String,
    /// Round that asked and state, in words.
    pub state: String,
}

#[derive(Clone, Debug)]
pub struct FitSize {
    pub size: String,
    /// True for the recommended size.
    pub is_to_wear: bool,
    /// False for every size where the recommended one does not fit.
    pub fits: bool,
    /// Worst deviation of the size, in words.
    pub words: String,
}

#[derive(Clone, Debug)]
pub struct FitTable {
    /// Includes the unit.
    pub caption: String,
    /// Headings of the columns after that of the row names.
    pub columns: Vec<String>,
    pub rows: Vec<FitRow>,
}

#[derive(Clone, Debug)]
pub struct FitRow {
    pub name: String,
    pub cells: Vec<FitCell>,
}

#[derive(Clone, Debug, Default)]
pub struct FitCell {
    /// Number in the unit of the table.
    pub text: String,
    pub note: String,
    /// `None` without a target.
    pub verdict: Option<FitVerdict>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FitVerdict {
    Tight,
    AsMeant,
    Loose,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// Residual within tolerance, all seams closed.
    Converged,
    /// Stopped before convergence, but measured.
    NotConverged,
    Failed(String),
    /// Published numbers, of a computation whose course is not known.
    Printed,
}

#[derive(Clone, Debug)]
pub struct Measured {
    pub name: String,
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

#[derive(Clone, Debug)]
pub struct Picture {
    /// PNG or JPEG; the first bytes tell which.
    pub bytes: Vec<u8>,
    /// Address of the full-size file relative to the page; empty without one.
    pub file: String,
    pub alt: String,
    pub caption: String,
}

/// A picture of a scalar field. The page draws the legend below it.
#[derive(Clone, Debug)]
pub struct FieldMap {
    pub picture: Picture,
    pub scale: Scale,
}

/// One garment, in one size and fabric, on one subject, by one simulator.
#[derive(Clone, Debug)]
pub struct TryOn {
    pub garment: String,
    /// Name of the garment without the seed of its start: runs that differ only in the seed are repeats of one case.
    pub case: String,
    /// Number of the run among those with the same inputs, from 1.
    pub repeat: u32,
    pub size: String,
    pub subject: String,
    pub simulator: Simulator,
    pub fabric: String,
    pub outcome: Outcome,
    /// Ease that decides the fit class; `None` where it is not known.
    pub ease: Option<Ease>,
    /// Empty for a failed run.
    pub measured: Vec<Measured>,
    /// Number after sewing.
    pub vertices: usize,
    pub faces: usize,
    /// Sum over all mesh levels.
    pub iterations: u32,
    /// Final root mean square residual force divided by the mean weight of a vertex.
    pub residual: f64,
    pub residuals: Vec<(u32, f64)>,
    pub penetration_max_m: f64,
    pub seam_gap_max_m: f64,
    pub wall_s: f64,
    /// Front, side, back and quarter.
    pub views: Vec<Picture>,
    pub maps: Vec<FieldMap>,
}

impl TryOn {
    /// Takes the measurements that `keep` selects; `None` if it selects none.
    pub fn metrics(&self, keep: impl Fn(&Measured) -> bool) -> Option<Metrics> {
        let chis: Vec<Chi> = self.measured.iter().filter(|m| keep(m)).map(|m| m.chi.clone()).collect();
        metrics(&chis)
    }

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

#[derive(Clone, Debug)]
pub struct RawLink {
    /// Relative to the page.
    pub href: String,
    pub label: String,
}

//! What a report is made from: plain values, lengths in metres, times in seconds. The page formats them.

use fit::measure::{Chi, Metrics, metrics};
use fit::{Basis, Cuts, Ease, Evidence, Finding, FitClass, Pair, Simulator};
use render::Scale;

use super::chart::Chart;
use super::viewer::Drapes;

/// Everything one report shows.
#[derive(Clone, Debug, Default)]
pub struct ReportData {
    /// Name of the study.
    pub title: String,
    /// What the study asks, one sentence.
    pub question: String,
    /// When and by which program the report was made (`2025-03-01, toile 0.1.0`).
    pub made: String,
    /// The answer to "which simulator?" for every garment and fit class.
    pub verdicts: Vec<Verdict>,
    /// What does not add up: exclusions, mismatches of inputs. Failed and unconverged runs need not be listed.
    pub audit: Vec<AuditNote>,
    /// Program version, git commit, machine, seeds, solver parameters: in the order given.
    pub provenance: Vec<Fact>,
    /// Input files and their hashes.
    pub inputs: Vec<Fact>,
    /// Numbers of each fabric and where they are from.
    pub fabrics: Vec<FabricFacts>,
    /// Measurements of the subjects, one a row.
    pub subjects: SubjectTable,
    /// Pattern drawings with numbered measurements.
    pub drawings: Vec<Drawing>,
    /// Ease below which a fit is tight and above which it is loose, m.
    pub cuts: Cuts,
    /// Ease of every subject and size, garment by garment.
    pub ease: Vec<EaseMatrix>,
    /// Which size each subject should wear.
    pub sizes: Vec<SizeTip>,
    /// How each garment fits each subject.
    pub fit: FitData,
    /// All runs, failed ones too.
    pub runs: Vec<TryOn>,
    /// The cases that both simulators drew.
    pub pairs: Vec<Pair>,
    /// What they say.
    pub evidence: Option<Evidence>,
    /// How it was done, a paragraph each.
    pub methods: Vec<String>,
    /// What it does not show, a paragraph each.
    pub limits: Vec<String>,
    /// Files with the raw numbers, as addresses relative to the page.
    pub raw: Vec<RawLink>,
}

/// One answer to "which simulator?".
#[derive(Clone, Debug)]
pub struct Verdict {
    /// Name of the garment in the study.
    pub garment: String,
    /// Fit class that the answer is for.
    pub class: FitClass,
    /// The simulator to use.
    pub recommended: Simulator,
    /// Why this one.
    pub basis: Basis,
    /// What the study's numbers say by themselves.
    pub finding: Finding,
    /// Mean EI of FEM less that of Hybrid, where both ran.
    pub effect: Option<f64>,
    /// The ends of its interval, of two subjects or more.
    pub interval: Option<(f64, f64)>,
    /// p of the sign-flip test after Holm, where there are subjects enough.
    pub p_holm: Option<f64>,
    /// Subjects behind the numbers.
    pub subjects: usize,
    /// One sentence of explanation.
    pub reason: String,
    /// What would settle or flip it.
    pub would_settle: String,
}

/// How much a note of the audit weighs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    /// Results are missing or wrong.
    Failure,
    /// Results need care.
    Warning,
    /// Results stand; the reader should know.
    Note,
}

impl Severity {
    /// Word and style class of a note.
    #[must_use]
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Failure => "failure",
            Self::Warning => "warning",
            Self::Note => "note",
        }
    }

    /// Sign before a note.
    #[must_use]
    pub fn glyph(self) -> &'static str {
        match self {
            Self::Failure => "✗",
            Self::Warning => "!",
            Self::Note => "i",
        }
    }
}

/// One thing the audit found.
#[derive(Clone, Debug)]
pub struct AuditNote {
    /// How much it weighs with the results.
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

/// A fabric's numbers.
#[derive(Clone, Debug)]
pub struct FabricFacts {
    /// Name of the fabric, as the study has it.
    pub name: String,
    /// Its properties with units.
    pub facts: Vec<Fact>,
    /// Where they are from.
    pub source: String,
}

/// A column of the subject table.
#[derive(Clone, Debug)]
pub struct Column {
    /// Measurement by its ISO 8559-1 name.
    pub name: String,
    /// Unit of the values (`mm`, `kg`); they are shown as given.
    pub unit: String,
    /// Decimals to which its values are shown.
    pub decimals: usize,
}

/// The subjects and their measurements.
#[derive(Clone, Debug, Default)]
pub struct SubjectTable {
    /// What was measured.
    pub columns: Vec<Column>,
    /// Who was measured.
    pub rows: Vec<Subject>,
}

/// A row of the subject table.
#[derive(Clone, Debug)]
pub struct Subject {
    /// Name in the study.
    pub name: String,
    /// Words about the subject (sex, source of the body).
    pub note: String,
    /// One value a column; `None` where it is not known.
    pub values: Vec<Option<f64>>,
}

/// A drawing of a garment's pattern.
#[derive(Clone, Debug)]
pub struct Drawing {
    /// Name of the garment in the study.
    pub garment: String,
    /// Name of the size that is drawn.
    pub size: String,
    /// The drawing as SVG; shown as a picture, so that nothing in it can run.
    pub svg: String,
}

/// Ease of one garment.
#[derive(Clone, Debug)]
pub struct EaseMatrix {
    /// Name of the garment in the study.
    pub garment: String,
    /// Sizes, one a row.
    pub sizes: Vec<String>,
    /// Subjects, one a column.
    pub subjects: Vec<String>,
    /// Deciding ease by size, then subject; `None` where a girth is not known.
    pub cells: Vec<Vec<Option<Ease>>>,
}

/// Which size of a garment a subject should wear.
#[derive(Clone, Debug)]
pub struct SizeTip {
    /// Name of the garment in the study.
    pub garment: String,
    /// Name of the subject in the study.
    pub subject: String,
    /// Name of the size to wear.
    pub size: String,
    /// Why that size, in words.
    pub reason: String,
    /// Tension at each level in the FEM-GS drape of that size, where there is one.
    pub tension: String,
    /// Which picture of it a customer should see.
    pub shown: String,
}

/// What the fit report shows besides the runs.
#[derive(Clone, Debug, Default)]
pub struct FitData {
    /// How each garment fits each subject.
    pub sheets: Vec<FitSheet>,
    /// Pattern drawings with numbered points of measure.
    pub points: Vec<Drawing>,
    /// Each point of measure that any of them has, and how it is measured.
    pub definitions: Vec<Fact>,
    /// Drapes to turn in the page.
    pub drapes: Drapes,
}

/// How a garment fits a subject, in the size to wear and those beside it.
#[derive(Clone, Debug)]
pub struct FitSheet {
    /// Name of the garment in the study.
    pub garment: String,
    /// Name of the subject in the study.
    pub subject: String,
    /// Intended fit; empty where none is meant.
    pub intended: String,
    /// Which size to wear, and what is worst with it.
    pub verdict: String,
    /// How the size to wear hangs and presses, in words; empty without its drape.
    pub drape: String,
    /// The size to wear and those beside it, in order.
    pub sizes: Vec<FitSize>,
    /// Whose drapes are measured, where there are any.
    pub simulator: Option<Simulator>,
    /// Ease by level, what hangs and presses, points of measure.
    pub tables: Vec<FitTable>,
    /// Cross sections of all sizes that have a drape.
    pub sections: Vec<Chart>,
}

/// A size of a fit sheet.
#[derive(Clone, Debug)]
pub struct FitSize {
    /// Name of the size, such as `M`.
    pub size: String,
    /// Whether it is the one to wear.
    pub is_to_wear: bool,
    /// Whether it fits; where the one to wear does not, none does.
    pub fits: bool,
    /// What is worst with it.
    pub words: String,
}

/// A table of a fit sheet.
#[derive(Clone, Debug)]
pub struct FitTable {
    /// What it holds, and in which unit.
    pub caption: String,
    /// Heads of its columns besides the names of its rows.
    pub columns: Vec<String>,
    /// Rows, from the top; each has a cell for every column.
    pub rows: Vec<FitRow>,
}

/// A row of a fit sheet's table.
#[derive(Clone, Debug)]
pub struct FitRow {
    /// What the row is about, such as a level of the body.
    pub name: String,
    /// A cell a column.
    pub cells: Vec<FitCell>,
}

/// A number of a fit sheet in words.
#[derive(Clone, Debug, Default)]
pub struct FitCell {
    /// The number as text, in the unit of the table.
    pub text: String,
    /// What is to be said of it.
    pub note: String,
    /// Where it lies beside its target, where it has one.
    pub verdict: Option<FitVerdict>,
}

/// Where an ease lies beside its target.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FitVerdict {
    /// Below the target: too little ease.
    Tight,
    /// Within the target.
    AsMeant,
    /// Above the target: too much ease.
    Loose,
}

/// How a run ended.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// Residual within tolerance, seams closed.
    Converged,
    /// Stopped before that; measured all the same.
    NotConverged,
    /// No result, and why.
    Failed(String),
    /// Numbers that somebody printed; nothing is known of how they came to be.
    Printed,
}

/// One measurement of one run.
#[derive(Clone, Debug)]
pub struct Measured {
    /// Name (`neck girth`).
    pub name: String,
    /// Number, pattern and garment length.
    pub chi: Chi,
    /// Whether it is a closed girth; an open length otherwise.
    pub closed: bool,
    /// Whether it lies on an edge that nothing is sewn to.
    pub free_edge: bool,
    /// Whether the simulator restores it by construction.
    pub controlled: bool,
    /// The chi the thesis printed for the same case, where there is one.
    pub published_chi: Option<f64>,
    /// The chi that is printed where it is not the ratio of the lengths printed beside it.
    pub misprint: Option<f64>,
}

/// A picture file.
#[derive(Clone, Debug)]
pub struct Picture {
    /// PNG or JPEG; the page tells by the first bytes.
    pub bytes: Vec<u8>,
    /// The same at full size, a file at this address relative to the page; empty where there is none.
    pub file: String,
    /// Words in its place for those who cannot see it.
    pub alt: String,
    /// The line under it.
    pub caption: String,
}

/// A picture coloured by values; the page sets its legend below it.
#[derive(Clone, Debug)]
pub struct FieldMap {
    /// The picture, without a legend of its own.
    pub picture: Picture,
    /// What its colours mean.
    pub scale: Scale,
}

/// One garment, in one size and fabric, on one subject, by one simulator.
#[derive(Clone, Debug)]
pub struct TryOn {
    /// Name of the garment in the study.
    pub garment: String,
    /// The garment without the seed of its start: what is the same but for this is a repeat.
    pub case: String,
    /// Which of several simulations of the same inputs, from 1.
    pub repeat: u32,
    /// Name of the size, such as `M`.
    pub size: String,
    /// Name of the subject in the study.
    pub subject: String,
    /// Simulator that draped it.
    pub simulator: Simulator,
    /// Name of the fabric, as the study has it.
    pub fabric: String,
    /// How it ended.
    pub outcome: Outcome,
    /// Ease that decides its fit class.
    pub ease: Option<Ease>,
    /// Its measurements; empty when it failed.
    pub measured: Vec<Measured>,
    /// Vertices once sewn.
    pub vertices: usize,
    /// Triangles of the mesh that was draped.
    pub faces: usize,
    /// Iterations over all levels.
    pub iterations: u32,
    /// Final rms residual over the mean vertex weight.
    pub residual: f64,
    /// Residual by iteration.
    pub residuals: Vec<(u32, f64)>,
    /// Deepest penetration, m.
    pub penetration_max_m: f64,
    /// Greatest seam gap, m.
    pub seam_gap_max_m: f64,
    /// Wall time, s.
    pub wall_s: f64,
    /// Front, side, back, quarter.
    pub views: Vec<Picture>,
    /// Strain, gap or other maps.
    pub maps: Vec<FieldMap>,
}

impl TryOn {
    /// E, SD, EI over the measurements that `keep` keeps; `None` when none are left.
    #[must_use]
    pub fn metrics(&self, keep: impl Fn(&Measured) -> bool) -> Option<Metrics> {
        let chis: Vec<Chi> = self.measured.iter().filter(|m| keep(m)).map(|m| m.chi.clone()).collect();
        metrics(&chis)
    }

    /// Its measurement of a number.
    #[must_use]
    pub fn measurement(&self, no: u32) -> Option<&Measured> {
        self.measured.iter().find(|m| m.chi.no == no)
    }
}

/// The measurements that any of the runs has, by number; the first run's description of each.
pub(super) fn measurements<'a>(runs: &[&'a TryOn]) -> Vec<&'a Measured> {
    let mut all: Vec<&Measured> = runs.iter().flat_map(|r| &r.measured).collect();
    all.sort_by_key(|m| m.chi.no);
    all.dedup_by_key(|m| m.chi.no);
    all
}

/// A file beside the page.
#[derive(Clone, Debug)]
pub struct RawLink {
    /// Its relative address.
    pub href: String,
    /// What it holds.
    pub label: String,
}

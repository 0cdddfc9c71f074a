//! Alterations: the least movement of a pattern's handles (named lengths that can be changed, [`Handle`]) so that a
//! size fits somebody; and the changed pattern.
//!
//! Ease follows from the flat pattern (`bench`). Readings of a drape, such as the level of a hem or a pressure, are
//! predicted by its linear response to the handles, and checked by draping again (`fitting_room`, `readings`).

mod bench;
mod figure;
mod fitting_room;
mod readings;
mod signs;
mod tried;
mod written;

use std::collections::{BTreeMap, BTreeSet};

use serde::Serialize;

use crate::alteration::bench::Bench;
pub use crate::alteration::figure::ForFigure;
use crate::alteration::fitting_room::FittingRoom;
pub(crate) use crate::alteration::readings::{Reading, Readings};
pub use crate::alteration::signs::SignRead;
pub(crate) use crate::alteration::signs::read as signs;
use crate::alteration::tried::Tried;
use body::Body;
use engine::{Outcome, stages};
use fit::target::Target;
use geom::units::mm;
use pattern::dxf::Standard;
use pattern::{Handle, Style};
use report::FileNames;
use results::Sits;
use spec::{JobSpec, Study};
use store::{InOrigin, Origin, Result, StudyError};

/// Movement of a handle by which its effect is found.
const STEP_M: f64 = 0.002;
/// Departure of an ease from its target that counts as none: the step of drawn amounts.
const SLACK_MM: f64 = 0.5;
/// Greatest number of drapes in a search, the first of them of the unchanged pattern.
const MOST_DRAPES: usize = 3;

/// Derivative of every level (m per m) or reading (its unit per m) with respect to a handle.
type Sensitivity = BTreeMap<String, f64>;

#[derive(Clone, Debug, PartialEq)]
pub struct Wish {
    /// Needed where the study has several.
    pub garment: Option<String>,
    /// Needed where the study has several.
    pub subject: Option<String>,
    pub size: String,
    /// Least and greatest values: of ease at levels, mm, in place of the intended fit's; and of readings of the drape,
    /// in their units.
    pub targets: BTreeMap<String, [f64; 2]>,
    /// Greatest amount of every handle in either direction; `None` for [`Handle::most_mm`] of each.
    pub limit_mm: Option<f64>,
    pub without: Vec<Handle>,
    /// Given amounts of handles. If there are any, no other handle moves.
    pub moves_mm: Vec<(Handle, f64)>,
    /// True to drape the changed pattern even without a target for a reading.
    pub is_draped: bool,
    /// True to change all sizes of the garment alike and write them as a nest. The grade stays.
    pub is_nest: bool,
    pub standard: Standard,
}

impl Wish {
    /// Asks for the ease of the intended fit, by any handle and without a drape.
    pub fn of(garment: &str, subject: &str, size: &str) -> Self {
        Self {
            garment: Some(garment.to_owned()),
            subject: Some(subject.to_owned()),
            size: size.to_owned(),
            targets: BTreeMap::new(),
            limit_mm: None,
            without: vec![],
            moves_mm: vec![],
            is_draped: false,
            is_nest: false,
            standard: Standard::Aama,
        }
    }
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MovedHandle {
    pub handle: &'static str,
    pub amount_mm: f64,
    /// Effect of a positive amount, in words.
    pub does: &'static str,
    /// True if the amount is half of a girth, so that the girth changes by twice the amount.
    pub is_half_girth: bool,
    /// Pieces that it changes, as the seam file names them.
    pub pieces: Vec<String>,
    /// Figures and levels that it is for.
    pub serves: Vec<String>,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct AlteredLevel {
    pub level: String,
    /// Least and greatest; `None` without a target.
    pub target_mm: Option<[f64; 2]>,
    pub before_mm: f64,
    pub promised_mm: f64,
    /// Ease of the written pattern when it is read again.
    pub achieved_mm: f64,
}

impl AlteredLevel {
    /// `None` without a target.
    pub fn sits(&self, ease_mm: f64) -> Option<Sits> {
        self.target_mm.map(|[least, most]| match ease_mm {
            ease_mm if ease_mm < least - SLACK_MM => Sits::Tight,
            ease_mm if ease_mm > most + SLACK_MM => Sits::Loose,
            _ => Sits::AsMeant,
        })
    }

    /// True also for a level without a target.
    pub fn is_met(&self) -> bool {
        self.sits(self.achieved_mm).is_none_or(|sits| sits == Sits::AsMeant)
    }
}

/// A quantity that may have a target, with its present value.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Standing {
    /// Level or reading.
    pub name: String,
    /// `mm`, `deg` or `kPa`.
    pub unit: &'static str,
    pub value: f64,
    /// True for the ease of the flat pattern at a level, false for a reading of the drape.
    pub is_ease: bool,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct AlteredReading {
    /// Such as `off_neck_side`.
    pub reading: String,
    /// `mm`, `deg` or `kPa`.
    pub unit: &'static str,
    /// Least and greatest.
    pub target: [f64; 2],
    /// Value on the drape of the unchanged pattern.
    pub before: f64,
    pub promised: f64,
    /// Value on the drape of the changed pattern.
    pub achieved: f64,
}

impl AlteredReading {
    pub fn is_met(&self) -> bool {
        within(self.target, self.achieved)
    }
}

/// True if a value lies in a band, or outside by at most a twentieth of the band's width.
fn within([least, most]: [f64; 2], value: f64) -> bool {
    let near = 0.05 * (most - least);
    (least - near..=most + near).contains(&value)
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Redraped {
    pub converged: bool,
    pub ei: f64,
    pub penetration_max_mm: f64,
    pub hem_front_over_back_mm: Option<f64>,
    pub most_kpa: Option<f64>,
    pub drag_lines: usize,
}

impl Redraped {
    pub fn words(&self) -> String {
        let rest = if self.converged { "at rest" } else { "not at rest" };
        let hem = self.hem_front_over_back_mm.map_or(String::new(), |mm| format!(", hem {mm:+.0} mm in front"));
        let most = self.most_kpa.map_or(String::new(), |kpa| format!(", presses with at most {kpa:.2} kPa"));
        let drag = match self.drag_lines {
            0 => "no drag lines".to_owned(),
            count => format!("drag lines: {count}"),
        };
        format!("{rest}, EI {:.4}, {:.2} mm inside{hem}{most}, {drag}", self.ei, self.penetration_max_mm)
    }
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Alteration {
    pub garment: String,
    pub subject: String,
    pub size: String,
    /// Figures of the subject that no girth tells.
    pub figures: Vec<ForFigure>,
    pub moves: Vec<MovedHandle>,
    /// Levels from the neck down.
    pub levels: Vec<AlteredLevel>,
    /// Readings that have a target.
    pub readings: Vec<AlteredReading>,
    /// Number of times that the garment was draped.
    pub drapes: usize,
    /// Reasons for handles that cannot move and levels that are missed; other remarks.
    pub remarks: Vec<String>,
    /// Drape of the changed pattern, where the request has one.
    pub drape: Option<Redraped>,
    pub signs: Vec<SignRead>,
    /// True if the pattern is written in the files of the source, in which nothing but coordinates of what moves changes.
    /// False if it is written anew.
    pub keeps_source: bool,
    /// Changed pattern, its seam file, and a sheet of old and new outlines, by file name.
    #[serde(skip)]
    pub files: Vec<(String, Vec<u8>)>,
}

impl Alteration {
    pub fn is_met(&self) -> bool {
        self.levels.iter().all(AlteredLevel::is_met) && self.readings.iter().all(AlteredReading::is_met)
    }
}

/// Finds the least change that brings every level and reading with a target into it, or applies the given amounts.
pub fn alter(study: &Study, wish: &Wish) -> Result<Alteration> {
    let Asked { spec, others, target } = asked(study, wish)?;
    let body = spec.person.body()?;
    let style = stages::style(&spec)?;
    let figures = if wish.moves_mm.is_empty() { figure::of(&style, &spec.person, &body, wish)? } else { Vec::new() };
    let bench = Bench::new(&style, summed(&figures), (&body, &target, wish))?;
    let asks_drape = wish.targets.keys().any(|name| !bench.has_level(name));
    let room = (asks_drape || wish.is_draped).then(|| FittingRoom::new(&spec, &body)).transpose()?;
    let found = match &room {
        Some(room) if asks_drape => Tried::on(room, &bench)?,
        Some(room) => Tried::flat_and_draped(&bench, room)?,
        None => Tried::flat(&bench)?,
    };
    let moves = bench.moves(&found.amounts);
    let changed = style.moved(&moves).origin(Origin::Alter)?;
    let mut names = FileNames::default();
    let name = names.part(&format!("{}-{}-{}", spec.garment, spec.size, spec.subject));
    let mut written = written::written(&spec, [&style, &changed], &moves, wish.standard, &name)?;
    if wish.is_nest {
        let name = names.part(&format!("{}-nest-{}", spec.garment, spec.subject));
        written.files.extend(written::nest(&spec, &others, &moves, wish.standard, &name)?);
    }
    let levels = bench.levels(&changed, &written.again);
    let reasons = if wish.moves_mm.is_empty() { bench.reasons(&found.amounts, &levels) } else { Vec::new() };
    let moved = |(handle, amount_m): &(Handle, f64)| MovedHandle {
        handle: handle.as_str(),
        amount_mm: mm(*amount_m),
        does: handle.definition(),
        is_half_girth: handle.is_half_girth(),
        pieces: style
            .moved(&[(*handle, *amount_m)])
            .map_or_else(|_| Vec::new(), |alone| changed_pieces(&style, &alone)),
        serves: figures
            .iter()
            .filter(|(_, own)| own.is_some_and(|own| own.0 == *handle))
            .map(|(told, _)| told.figure.to_owned())
            .chain(bench.serves(*handle))
            .collect(),
    };
    Ok(Alteration {
        garment: spec.garment.clone(),
        subject: spec.subject.clone(),
        size: spec.size.clone(),
        moves: moves.iter().map(moved).collect(),
        figures: figures.iter().map(|(told, _)| told.clone()).collect(),
        levels,
        readings: found.readings(wish),
        drapes: found.drapes,
        remarks: bench.left_out.iter().chain(&found.remarks).chain(&reasons).chain(&written.remarks).cloned().collect(),
        signs: found.after.as_ref().map_or_else(Vec::new, |(_, read)| signs(read, &style)),
        drape: found.after.map(|(redraped, _)| redraped),
        keeps_source: written.keeps_source,
        files: written.files,
    })
}

/// Moves for all figures, each handle once.
fn summed(figures: &[figure::Asked]) -> Vec<(Handle, f64)> {
    let mut moves: BTreeMap<Handle, f64> = BTreeMap::new();
    for (handle, amount_m) in figures.iter().filter_map(|(_, own)| *own) {
        *moves.entry(handle).or_default() += amount_m;
    }
    moves.into_iter().filter(|(_, amount_m)| *amount_m != 0.0).collect()
}

fn changed_pieces(style: &Style, changed: &Style) -> Vec<String> {
    let pairs = style.pieces.iter().zip(&changed.pieces).filter(|(was, is)| was.outline() != is.outline());
    pairs.map(|(was, _)| was.id.clone()).collect()
}

/// Drapes by FEM-GS, as the study does. Returns the ease of the drape at every level too.
pub(crate) fn outcome(spec: &JobSpec, style: &Style, body: &Body) -> Result<(Outcome, Vec<(String, f64)>)> {
    FittingRoom::new(spec, body)?.outcome(style)
}

/// Ease at every level and readings of the drape, for a size on a subject.
pub fn standing(study: &Study, wish: &Wish) -> Result<Vec<Standing>> {
    let Asked { spec, target, .. } = asked(study, wish)?;
    let body = spec.person.body()?;
    let style = stages::style(&spec)?;
    let bench = Bench::new(&style, Vec::new(), (&body, &target, wish))?;
    let (_, readings) = FittingRoom::new(&spec, &body)?.drape(&style)?;
    let eases = bench.levels(&style, &style).into_iter();
    let ease = |level: AlteredLevel| Standing { name: level.level, unit: "mm", value: level.before_mm, is_ease: true };
    let read = |(name, reading): (String, Reading)| Standing {
        name,
        unit: reading.unit,
        value: reading.value,
        is_ease: false,
    };
    Ok(eases.map(ease).chain(readings.into_iter().map(read)).collect())
}

struct Asked {
    spec: JobSpec,
    /// Jobs of the garment's other sizes on the subject.
    others: Vec<JobSpec>,
    target: Target,
}

fn asked(study: &Study, wish: &Wish) -> Result<Asked> {
    let jobs = spec::jobs(study);
    let garments: Vec<String> = study.garments.iter().map(|garment| garment.name.clone()).collect();
    let garment = one("garment", wish.garment.as_deref(), garments)?;
    let of_garment = || jobs.iter().filter(|job| job.garment == garment);
    let subject = one("subject", wish.subject.as_deref(), of_garment().map(|job| job.subject.clone()).collect())?;
    let size = one("size", Some(&wish.size), of_garment().map(|job| job.size.clone()).collect())?;
    let mut on_subject: Vec<JobSpec> = of_garment().filter(|job| job.subject == subject).cloned().collect();
    // Takes each size once, by the first simulator.
    let mut seen = BTreeSet::new();
    on_subject.retain(|job| seen.insert(job.size.clone()));
    let Some(place) = on_subject.iter().position(|job| job.size == size) else {
        return Err(StudyError::NotFound {
            what: "job",
            name: format!("{garment} {size} on {subject}"),
            known: vec![],
        });
    };
    let spec = on_subject.remove(place);
    let entry = study.garments.iter().find(|entry| entry.name == garment);
    let target = entry.map_or_else(Target::default, |entry| entry.target.clone());
    Ok(Asked { spec, others: on_subject, target })
}

/// Returns the known name that equals `asked` without regard to case; without `asked`, the only known name. `what` is
/// the kind of thing, and its flag.
pub(crate) fn one(what: &'static str, asked: Option<&str>, mut known: Vec<String>) -> Result<String> {
    let mut seen = BTreeSet::new();
    known.retain(|name| seen.insert(name.clone()));
    let Some(asked) = asked else {
        return match known.len() {
            1 => Ok(known.remove(0)),
            _ => Err(StudyError::Unsaid { what, known }),
        };
    };
    let found = known.iter().find(|name| name.eq_ignore_ascii_case(asked)).cloned();
    found.ok_or_else(|| StudyError::NotFound { what, name: asked.to_owned(), known })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_of_several_is_asked_for_by_its_name() {
        let check = |asked: Option<&str>, known: &[&str], expect: &str| {
            let known = known.iter().map(|name| (*name).to_owned()).collect();
            let found = one("subject", asked, known).unwrap_or_else(|error| error.to_string());
            assert_eq!(found, expect);
        };
        check(None, &["v"], "v");
        check(None, &["v", "v"], "v");
        check(Some("V"), &["ii", "v"], "v");
        check(None, &["ii", "v"], "which subject? --subject says it; there are: ii, v");
        check(Some("x"), &["ii", "v"], "no subject `x`; there are: ii, v");
    }
}

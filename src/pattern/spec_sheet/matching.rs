//! Points of measure of the rows of a specification sheet.
//!
//! The words of a row name points. Its lengths beside those of the pattern decide between several, between half of a
//! girth and all of it, and contradict words that do not fit. A row that stays unsure is asked for.

use std::fmt;
use std::str::FromStr;

use super::rules::{Meant, meant};
use super::words::{self, Extent, Told};
use super::{SaidUnit, SheetRow, SpecSheet};
use crate::dxf::Unit;
use crate::pom::{Measure, Point};

/// Greatest share by which the lengths of a row may differ from those of its point: four steps of a size chart, which
/// are about 4 % of a girth each.
const PLAUSIBLE: f64 = 0.15;
/// Share by which lengths are near: a step of a size chart.
const NEAR: f64 = 0.04;
/// Least share by which the next point must differ more: half a step of a size chart.
const APART: f64 = 0.5 * NEAR;
/// Lengths that differ by less are the same.
const SAME_MM: f64 = 1.0;
const UNITS: [Unit; 3] = [Unit::In, Unit::Cm, Unit::Mm];
const CANDIDATES: usize = 4;

/// A specified girth is twice the point that is half of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Target {
    pub measure: Measure,
    /// Specified length for each length of the point: 2 for a girth whose half is the point, 0.5 for half of a round.
    pub times: f64,
}

impl fmt::Display for Target {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.times != 1.0 {
            write!(f, "{}*", self.times)?;
        }
        self.measure.fmt(f)
    }
}

#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    pub code: String,
    /// Point with its share if that was said. `None` if the row is no point.
    pub point: Option<(Measure, Option<f64>)>,
}

impl FromStr for Answer {
    type Err = String;

    /// Reads `CODE=POINT`, `CODE=2*POINT` or `CODE=none`. The error says what is accepted.
    fn from_str(text: &str) -> Result<Self, String> {
        let form = || "CODE=POINT, CODE=2*POINT or CODE=none, such as B1=half_chest".to_owned();
        let (code, point) = text.rsplit_once('=').ok_or_else(form)?;
        let (code, point) = (code.trim().to_owned(), point.trim());
        if code.is_empty() {
            return Err(form());
        }
        if point.eq_ignore_ascii_case("none") {
            return Ok(Self { code, point: None });
        }
        let (times, name) = point.split_once('*').map_or((None, point), |(times, name)| (Some(times.trim()), name));
        let times = match times {
            None => None,
            Some("1") => Some(1.0),
            Some("2") => Some(2.0),
            Some("0.5" | "1/2" | ".5") => Some(0.5),
            Some(_) => return Err("2* or 0.5* before the point".to_owned()),
        };
        Ok(Self { code, point: Some((name.parse()?, times)) })
    }
}

impl fmt::Display for Answer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}=", self.code)?;
        match self.point {
            None => f.write_str("none"),
            Some((measure, None)) => measure.fmt(f),
            Some((measure, Some(times))) => Target { measure, times }.fmt(f),
        }
    }
}

/// Reason for which a row has its point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum How {
    /// Words of the row name no other.
    Words,
    /// Words of the row name several, and its lengths fit one of them.
    Lengths,
    Answer,
}

impl How {
    /// Name in tables and SQL.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Words => "words",
            Self::Lengths => "lengths",
            Self::Answer => "answer",
        }
    }
}

#[derive(Clone, Debug, PartialEq)]
pub enum RowMatch {
    Is(Target, How),
    /// Row that was said to be no point.
    None,
    Asked {
        /// End of a sentence.
        why: String,
        candidates: Vec<Target>,
    },
}

#[derive(Clone, Debug, PartialEq)]
pub struct Matching {
    pub unit: SaidUnit,
    pub rows: Vec<RowMatch>,
    pub notes: Vec<String>,
}

#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum MatchError {
    /// Answer to no row.
    #[error("{file}: there is no row `{code}`; accepted: one of {codes}")]
    NoRow { file: String, code: String, codes: String },
    #[error(
        "{file}: found no unit, and its lengths do not tell it beside those of the pattern{tried}; accepted: in, cm or mm (--sheet-unit)"
    )]
    NoUnit {
        file: String,
        /// Units that were compared, with their differences.
        tried: String,
    },
}

/// Lengths in each size of a sheet, mm. `None` in a size, or for a point, that the pattern does not have.
pub type Lengths<'a> = dyn Fn(Measure) -> Vec<Option<f64>> + 'a;

/// Fails for an answer to no row, and where neither words nor lengths tell the unit.
pub fn matched(sheet: &SpecSheet, flat: &Lengths<'_>, answers: &[Answer]) -> Result<Matching, MatchError> {
    let has = |code: &str| sheet.rows.iter().any(|row| row.code.eq_ignore_ascii_case(code));
    if let Some(answer) = answers.iter().find(|answer| !has(&answer.code)) {
        let codes = sheet.rows.iter().map(|row| row.code.as_str()).collect::<Vec<_>>().join(", ");
        return Err(MatchError::NoRow { file: sheet.file.clone(), code: answer.code.clone(), codes });
    }
    let told: Vec<Told> = sheet.rows.iter().map(|row| words::read(&row.description)).collect();
    let mut notes = Vec::new();
    let unit = unit(sheet, &told, flat, &mut notes)?;
    let matcher = Matcher { flat, unit: unit.unit };
    let row = |(row, told): (&SheetRow, &Told)| {
        let answer = answers.iter().rev().find(|answer| row.code.eq_ignore_ascii_case(&answer.code));
        match answer.map(|answer| answer.point) {
            Some(None) => RowMatch::None,
            Some(Some((measure, times))) => matcher.answered(row, told, measure, times),
            None => matcher.row(row, told),
        }
    };
    let rows: Vec<RowMatch> = sheet.rows.iter().zip(&told).map(row).collect();
    notes.extend(twice(sheet, &rows));
    Ok(Matching { unit, rows, notes })
}

fn twice(sheet: &SpecSheet, rows: &[RowMatch]) -> Vec<String> {
    let points: Vec<(&str, Target)> = sheet
        .rows
        .iter()
        .zip(rows)
        .filter_map(|(row, found)| match found {
            RowMatch::Is(target, _) => Some((row.code.as_str(), *target)),
            _ => None,
        })
        .collect();
    let pairs = points.iter().enumerate().flat_map(|(k, (code, target))| {
        points[..k].iter().filter(move |(_, other)| other == target).map(move |(other, _)| (*other, *code, target))
    });
    pairs.map(|(other, code, target)| format!("rows {other} and {code} are both {target}")).collect()
}

fn shares(measure: Measure, extent: Option<Extent>) -> &'static [f64] {
    match (measure.is_half(), measure.is_round(), extent) {
        (true, _, None) => &[1.0, 2.0],
        (true, _, Some(Extent::Half)) | (_, true, Some(Extent::Whole)) => &[1.0],
        (true, _, Some(Extent::Whole)) => &[2.0],
        (_, true, None) => &[1.0, 0.5],
        (_, true, Some(Extent::Half)) => &[0.5],
        _ => &[1.0],
    }
}

/// Mean share by which lengths differ. `None` without a size in common.
fn difference(row: &SheetRow, mm_per_unit: f64, flat: &[Option<f64>], times: f64) -> Option<f64> {
    let pairs = row.lengths.iter().zip(flat).filter_map(|(length, flat)| Some(((*length)?, (*flat)?)));
    let ratios = pairs.map(|(length, flat)| (length * mm_per_unit / (times * flat)).ln().abs());
    let (count, sum) = ratios.fold((0, 0.0), |(count, sum), ratio| (count + 1, sum + ratio));
    (count > 0).then(|| sum / f64::from(count))
}

/// A row whose words name one point without a distance, for its unit.
struct Known<'a> {
    row: &'a SheetRow,
    flat: Vec<Option<f64>>,
    shares: &'static [f64],
}

impl<'a> Known<'a> {
    fn of(row: &'a SheetRow, told: &Told, flat: &Lengths<'_>) -> Option<Self> {
        if told.place.is_some() {
            return None;
        }
        let Meant { sure, .. } = meant(told, Unit::Mm);
        let [measure] = sure[..] else { return None };
        Some(Self { row, flat: flat(measure), shares: shares(measure, told.extent) })
    }

    /// Least share by which the lengths of the row differ from those of its point in a unit.
    fn off(&self, unit: Unit) -> Option<f64> {
        let each = self.shares.iter();
        let each = each.filter_map(|times| difference(self.row, unit.mm_per_unit(), &self.flat, *times));
        each.min_by(f64::total_cmp)
    }
}

/// Unit that the sheet says, or the one in which its lengths are nearest to those of the pattern.
fn unit(sheet: &SpecSheet, told: &[Told], flat: &Lengths<'_>, notes: &mut Vec<String>) -> Result<SaidUnit, MatchError> {
    let known = |(row, told)| Known::of(row, told, flat);
    let all: Vec<Known<'_>> = sheet.rows.iter().zip(told).filter_map(known).collect();
    // A row with one share says more: an inch and a half are nearly two of another unit.
    let is_single = all.iter().any(|known| known.shares.len() == 1);
    let off = |unit: Unit| {
        let used = all.iter().filter(|known| !is_single || known.shares.len() == 1);
        let mut offs: Vec<f64> = used.filter_map(|known| known.off(unit)).collect();
        offs.sort_by(f64::total_cmp);
        offs.get(offs.len() / 2).copied()
    };
    let mut tried: Vec<(Unit, f64)> = UNITS.into_iter().filter_map(|unit| Some((unit, off(unit)?))).collect();
    tried.sort_by(|one, other| one.1.total_cmp(&other.1));
    let near = tried.first().filter(|(_, off)| *off <= PLAUSIBLE).map(|(unit, _)| *unit);
    if let Some(said) = &sheet.unit {
        if let Some(near) = near.filter(|near| *near != said.unit && off(said.unit).is_some_and(|off| off > PLAUSIBLE))
        {
            notes.push(format!(
                "doubtful unit: {}, but its lengths are near the pattern's in {}",
                said.why,
                near.as_str()
            ));
        }
        return Ok(said.clone());
    }
    if let Some(unit) = near {
        let why = format!("no unit is written; in {} its lengths are near the pattern's", unit.as_str());
        notes.push(format!("unit assumed: {why}"));
        return Ok(SaidUnit { unit, why });
    }
    let told = tried.iter().map(|(unit, off)| format!("{} {:.0} %", unit.as_str(), 100.0 * off.exp_m1()));
    let told = told.collect::<Vec<_>>().join(", ");
    let tried = if told.is_empty() { String::new() } else { format!(" (off by: {told})") };
    Err(MatchError::NoUnit { file: sheet.file.clone(), tried })
}

struct Matcher<'a> {
    flat: &'a Lengths<'a>,
    unit: Unit,
}

struct Fit {
    target: Target,
    off: f64,
    flat: Vec<Option<f64>>,
}

impl Matcher<'_> {
    fn fits(&self, row: &SheetRow, measure: Measure, shares: &[f64]) -> Vec<Fit> {
        let flat = (self.flat)(measure);
        let fit = |times: &f64| {
            let off = difference(row, self.unit.mm_per_unit(), &flat, *times)?;
            Some(Fit { target: Target { measure, times: *times }, off, flat: flat.clone() })
        };
        shares.iter().filter_map(fit).collect()
    }

    fn answered(&self, row: &SheetRow, told: &Told, measure: Measure, times: Option<f64>) -> RowMatch {
        let by_length = || {
            let fits = self.fits(row, measure, shares(measure, None)).into_iter();
            fits.min_by(|one, other| one.off.total_cmp(&other.off)).map(|fit| fit.target.times)
        };
        let times = times.or_else(by_length).unwrap_or_else(|| shares(measure, told.extent)[0]);
        RowMatch::Is(Target { measure, times }, How::Answer)
    }

    fn row(&self, row: &SheetRow, told: &Told) -> RowMatch {
        let Meant { sure, partly } = meant(told, self.unit);
        let all: Vec<Fit> =
            sure.iter().flat_map(|measure| self.fits(row, *measure, shares(*measure, told.extent))).collect();
        let mut near: Vec<Fit> = all.into_iter().filter(|fit| fit.off <= PLAUSIBLE).collect();
        near.sort_by(|one, other| one.off.total_cmp(&other.off));
        let [best, rest @ ..] = &near[..] else {
            return self.asked(row, told, &sure, &partly);
        };
        let is_same = |fit: &Fit| {
            let mut pairs = best.flat.iter().zip(&fit.flat).filter_map(|(a, b)| Some(((*a)?, (*b)?)));
            pairs.all(|(a, b)| (a * best.target.times - b * fit.target.times).abs() < SAME_MM)
        };
        let how = if sure.len() == 1 { How::Words } else { How::Lengths };
        if rest.iter().all(|fit| fit.off - best.off >= APART) {
            return RowMatch::Is(best.target, how);
        }
        // Of points that are as long as each other in every size, the first serves.
        if rest.iter().all(|fit| is_same(fit) || fit.off - best.off >= APART) {
            let first = near.iter().filter(|fit| is_same(fit)).min_by_key(|fit| order(fit.target.measure));
            return RowMatch::Is(first.unwrap_or(best).target, how);
        }
        let candidates = near.iter().map(|fit| fit.target).take(CANDIDATES).collect();
        RowMatch::Asked { why: "its words and lengths fit several points".to_owned(), candidates }
    }

    fn asked(&self, row: &SheetRow, told: &Told, sure: &[Measure], partly: &[Measure]) -> RowMatch {
        let is_there = |measure: &&Measure| (self.flat)(**measure).iter().any(Option::is_some);
        let names = |measures: &[Measure]| measures.iter().map(ToString::to_string).collect::<Vec<_>>().join(" or ");
        let why = match (sure.iter().find(is_there), sure.is_empty(), partly.is_empty()) {
            (Some(there), ..) => format!("its words say {there}, and its lengths do not fit that"),
            (None, false, _) => format!("its words say {}, which the pattern does not have", names(sure)),
            (None, true, _) if told.has("stretched") => "a stretched length is not measured".to_owned(),
            (None, true, false) => format!("not all of its words say {}", names(partly)),
            (None, true, true) => "its words name no point that is measured".to_owned(),
        };
        let words = sure.iter().chain(partly);
        let of_words = words.flat_map(|measure| self.fits(row, *measure, shares(*measure, None)));
        let of_lengths = Point::ALL.into_iter().flat_map(|point| {
            let measure = Measure::Point(point);
            self.fits(row, measure, shares(measure, None)).into_iter().filter(|fit| fit.off < NEAR)
        });
        let mut by_words: Vec<Fit> = of_words.collect();
        by_words.sort_by(|one, other| one.off.total_cmp(&other.off));
        let mut by_lengths: Vec<Fit> = of_lengths.collect();
        by_lengths.sort_by(|one, other| one.off.total_cmp(&other.off));
        let mut candidates: Vec<Target> = Vec::new();
        for fit in by_words.iter().chain(&by_lengths) {
            if !candidates.contains(&fit.target) {
                candidates.push(fit.target);
            }
        }
        candidates.truncate(CANDIDATES);
        RowMatch::Asked { why, candidates }
    }
}

fn order(measure: Measure) -> usize {
    match measure {
        Measure::Point(point) => point as usize,
        Measure::Own { .. } => usize::MAX,
    }
}

//! Grading for a population: the sizes that fit the most people, as a nest with rules, a size chart and a specification
//! sheet. They are compared with the pattern's own sizes on people held out of the search.
//!
//! `people` draws and builds the people, `shares` says what grows with which girth, `knobs` makes the parameters of a
//! grade, and `fit::coverage` seeks them. `tally` counts the people whom the sizes fit, `nest` writes the sizes and reads
//! them again, `drape` dresses some of these people, and `picture` draws the people.

mod drape;
mod knobs;
mod nest;
mod people;
mod picture;
mod seek;
mod shares;
mod tally;

use serde::Serialize;

use crate::alteration::one;
use crate::error::AdviceError;
use crate::grading::knobs::{Band, Knobs, Run};
use crate::grading::people::{Covered, Figure};
use crate::grading::tally::Tally;
use body::Sex;
use engine::stages;
use fit::coverage::Turns;
use geom::units::mm;
use pattern::grade::{Growth, Imprint};
use pattern::{Handle, Style};
use report::file_part;
use spec::file::GarmentEntry;
use spec::{JobSpec, Study, patterns};
use store::{InOrigin, Origin, Result, StudyError};
use wardrobe::seams::Specification;

/// Greatest amount of a handle in either direction.
const LIMIT_M: f64 = 0.150;
/// Accepted counts of sizes and of people.
const SIZES: std::ops::RangeInclusive<usize> = 1..=40;
const PEOPLE: std::ops::RangeInclusive<usize> = 20..=20_000;

#[derive(Clone, Debug, PartialEq)]
pub struct GradeWish {
    /// Needed where the study has several.
    pub garment: Option<String>,
    /// `None` for the number of the pattern.
    pub sizes: Option<usize>,
    /// Number of people for whom the sizes are sought.
    pub people: usize,
    pub held_out: usize,
    pub seed: u64,
    /// Size from which the others are made; `None` for the middle one.
    pub base: Option<String>,
    /// True to make all steps between sizes equal.
    pub is_even: bool,
    /// Levels that need not fit.
    pub without: Vec<String>,
    /// Share to drape of the people whom a size fits.
    pub draped: f64,
}

impl Default for GradeWish {
    fn default() -> Self {
        Self {
            garment: None,
            sizes: None,
            people: 2000,
            held_out: 2000,
            seed: 1,
            base: None,
            is_even: false,
            without: Vec::new(),
            draped: 0.0,
        }
    }
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Turn {
    pub handle: &'static str,
    /// Amount relative to the base.
    pub amount_mm: f64,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Range {
    /// Such as `chest_girth_mm`.
    pub dimension: &'static str,
    /// 5th percentile, median and 95th percentile, in the unit of the key.
    pub values: [f64; 3],
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SizeShare {
    pub size: String,
    /// Share whom the size fits.
    pub fits_percent: f64,
    /// Share who wear the size, since it fits and no smaller one does.
    pub worn_percent: f64,
    /// Amounts relative to the base; empty for the pattern's own sizes.
    pub turns: Vec<Turn>,
    /// Empty where nobody wears the size.
    pub wearers: Vec<Range>,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SizeSet {
    /// `own` for the pattern's own sizes, or `new`.
    pub set: &'static str,
    /// Share of the people of the search whom a size fits.
    pub sought_percent: f64,
    /// Share of the people held out whom a size fits.
    pub held_out_percent: f64,
    /// Half of the 95 % interval of that share, in percentage points.
    pub within_percent: f64,
    /// Smallest first.
    pub sizes: Vec<SizeShare>,
}

/// Shares of both sets at a level: the pattern's own sizes, then the new ones.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LevelShare {
    pub level: String,
    /// Least and greatest.
    pub target_mm: [f64; 2],
    /// Share of the people held out whose size to wear is within the target here.
    pub within_percent: [f64; 2],
    /// Share of the people held out whom no size fits for whom this level is the worst.
    pub fails_percent: [f64; 2],
}

/// Shares of both sets in a part of the people held out: the pattern's own sizes, then the new ones.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PartShare {
    /// Least and greatest girth of the body at the first level.
    pub from_to_mm: [f64; 2],
    pub fits_percent: [f64; 2],
}

/// A length that grows with a girth from size to size.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Grown {
    pub handle: &'static str,
    pub with: &'static str,
    /// Growth in 40 mm of the girth; of a girth half of it.
    pub of_40_mm: f64,
    /// Growth from size to size; that of the second group last, where steps change.
    pub steps_mm: Vec<f64>,
}

/// Result of dressing some of the people whom a size fits.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DrapedAgain {
    pub people: usize,
    pub agree: usize,
    /// Objections of each other drape.
    pub against: Vec<String>,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Grading {
    pub garment: String,
    pub base: String,
    pub intended: &'static str,
    /// Sexes of the people, who are equally many of each.
    pub sexes: Vec<Sex>,
    /// People whose bodies could be built: of the search, and held out.
    pub people: [usize; 2],
    /// Handles by which the sample size departs from the base, one for each level; and girths that grow from size to
    /// size, each with lengths that grow with it.
    pub handles: [Vec<&'static str>; 2],
    /// Handles that the pattern has and that cannot move, with the reason: their lengths do not grow.
    pub refused: Vec<String>,
    pub split: Option<String>,
    pub growth: Vec<Grown>,
    pub rules: usize,
    /// Pattern's own sizes, then the new ones.
    pub sets: Vec<SizeSet>,
    pub levels: Vec<LevelShare>,
    /// Level by which the people held out are divided, and fifths of them by their girth there.
    pub parts: (String, Vec<PartShare>),
    /// Greatest distance between a size as drawn and as the rules make it.
    pub apart_mm: f64,
    /// `None` where none were asked for.
    pub drapes: Option<DrapedAgain>,
    /// Points of measure of the new sizes.
    pub sheet: Specification,
    /// Files by name: the pattern in all new sizes, and the picture.
    #[serde(skip)]
    pub files: Vec<(String, Vec<u8>)>,
}

/// Finds the sizes that fit the most people. Seams are tried before anybody is drawn.
pub fn grade(study: &Study, wish: &GradeWish) -> Result<Grading> {
    let asked = Asked::of(study, wish)?;
    let growth = asked.growth()?;
    let own = asked.own()?;
    let base = &own[asked.base];
    let drawn = people::drawn(&asked.sexes, [wish.people, wish.held_out], wish.seed);
    // One person is enough to tell the levels, and if one is measured at a height of its own.
    let first = people::figures(&drawn[0][..1], false);
    let somebody = first.first().ok_or(AdviceError::NoFirstPerson)?;
    let covered = somebody.covered(base);
    let bands = bands(asked.entry, &covered, &wish.without)?;
    let knobs = Knobs::of(growth, somebody, &bands, &asked.sexes, LIMIT_M)?;
    let even = Run { count: asked.count, split: None };
    knobs.check(even)?;
    let has_trunk = covered.iter().any(|level| level.has_own_height);
    let [sought, held_out] = drawn.map(|people| people::figures(&people, has_trunk));
    let crowd = Crowd { figures: &sought, bands: &bands };
    let (run, turns) = seek::sizes(&knobs, crowd, even, wish.is_even, wish.seed)?;
    let names = asked.names();
    let nest = nest::drawn(&asked, &names, &knobs, &turns, run)?;
    let new: Vec<Style> = nest.styles;
    let tallies =
        [&own, &new].map(|styles| [&sought, &held_out].map(|figures| Tally::of(styles, base, figures, &bands)));
    let own_names: Vec<String> = asked.entry.sizes.iter().map(|size| size.name.clone()).collect();
    let set = |which: usize| {
        let (set, names) = if which == 0 { ("own", &own_names) } else { ("new", &names) };
        let [sought, out] = &tallies[which];
        let mut set = out.set(set, names, sought, &held_out);
        if which == 1 {
            let sizes = set.sizes.iter_mut().enumerate();
            sizes.for_each(|(number, size)| size.turns = turned(&knobs.amounts(&turns, run, number)));
        }
        set
    };
    let judged = [&tallies[0][1], &tallies[1][1]];
    let pictured = [
        Judged { title: "own sizes", styles: &own, names: &own_names, tally: judged[0] },
        Judged { title: "new sizes", styles: &new, names: &names, tally: judged[1] },
    ];
    let picture = picture::svg(&held_out, &bands, &pictured, &asked.entry.name);
    let mut files = nest.files;
    files.push((format!("{}.svg", file_part(&asked.entry.name)), picture.into_bytes()));
    Ok(Grading {
        garment: asked.entry.name.clone(),
        base: asked.spec.size.clone(),
        intended: asked.entry.target.intended.as_str(),
        sexes: asked.sexes.clone(),
        people: [sought.len(), held_out.len()],
        handles: [
            knobs.handles.iter().map(|handle| handle.as_str()).collect(),
            knobs.leads.iter().map(|lead| lead.handle.as_str()).collect(),
        ],
        refused: knobs.growth.refused().iter().map(|(_, reason)| reason.to_string()).collect(),
        split: run.split.map(|split| names[split].clone()),
        growth: grown(&knobs, &turns, run),
        rules: nest.rules,
        sets: vec![set(0), set(1)],
        levels: tally::levels(&bands, judged),
        parts: tally::parts(&held_out, &bands, judged),
        apart_mm: mm(nest.apart_m),
        drapes: (wish.draped > 0.0)
            .then(|| drape::agree(&asked.spec, &pictured[1], Crowd { figures: &held_out, bands: &bands }, wish.draped))
            .transpose()?,
        sheet: Specification::of(asked.entry.name.clone(), names, &new),
        files,
    })
}

#[derive(Clone, Copy)]
struct Crowd<'a> {
    figures: &'a [Figure],
    bands: &'a [Band],
}

struct Judged<'a> {
    title: &'static str,
    styles: &'a [Style],
    names: &'a [String],
    tally: &'a Tally,
}

struct Asked<'a> {
    entry: &'a GarmentEntry,
    spec: JobSpec,
    /// Index among the pattern's own sizes.
    base: usize,
    count: usize,
    sexes: Vec<Sex>,
}

impl<'a> Asked<'a> {
    fn of(study: &'a Study, wish: &GradeWish) -> Result<Self> {
        let names = study.garments.iter().map(|garment| garment.name.clone()).collect();
        let name = one("garment", wish.garment.as_deref(), names)?;
        let missing = || AdviceError::NotWorn { garment: name.clone() };
        let entry = study.garments.iter().find(|entry| entry.name == name).ok_or_else(missing)?;
        let names: Vec<String> = entry.sizes.iter().map(|size| size.name.clone()).collect();
        // The lower one, where two are in the middle.
        let middle = names.len().saturating_sub(1) / 2;
        let base = match &wish.base {
            Some(base) => one("size", Some(base), names.clone())?,
            None => names.get(middle).cloned().ok_or_else(missing)?,
        };
        let worn = study.subjects.iter().filter(|subject| entry.subjects.contains(&subject.id));
        let worn: Vec<Sex> = worn.map(|subject| subject.person.measurements.sex).collect();
        let sexes: Vec<Sex> = [Sex::Female, Sex::Male].into_iter().filter(|sex| worn.contains(sex)).collect();
        if sexes.is_empty() {
            return Err(missing().into());
        }
        let count = wish.sizes.unwrap_or(names.len());
        if !SIZES.contains(&count) {
            return Err(AdviceError::Count { count, of: "sizes", accepted: SIZES }.into());
        }
        if let Some(count) = [wish.people, wish.held_out].into_iter().find(|people| !PEOPLE.contains(people)) {
            return Err(AdviceError::Count { count, of: "people", accepted: PEOPLE }.into());
        }
        if !(0.0..=1.0).contains(&wish.draped) {
            return Err(AdviceError::Share { share: wish.draped }.into());
        }
        let index = names.iter().position(|size| *size == base).unwrap_or(middle);
        let spec = spec::jobs(study).into_iter().find(|job| job.garment == name && job.size == base);
        Ok(Self { entry, spec: spec.ok_or_else(missing)?, base: index, count, sexes })
    }

    fn growth(&self) -> Result<Growth> {
        let spec = &self.spec;
        let without_seams = || AdviceError::GradeWithoutSeams { pattern: spec.pattern.name.clone() };
        let seams = spec.seams.as_ref().ok_or_else(without_seams)?;
        let unit = spec.unit.as_deref().and_then(patterns::unit_of);
        let pieces = patterns::pieces(&spec.pattern, Some(&spec.size), unit)?;
        let handles: Vec<Handle> =
            shares::LEADS.into_iter().chain(shares::SHARES.iter().map(|share| share.handle)).collect();
        let handles: Vec<Handle> = Handle::ALL.into_iter().filter(|handle| handles.contains(handle)).collect();
        Growth::of(&pieces, &seams.bytes, &seams.name, &handles).origin(Origin::Grade)
    }

    fn imprint(&self) -> Result<Imprint> {
        let unit = self.spec.unit.as_deref().and_then(patterns::unit_of);
        Ok(Imprint::of(patterns::Nest::read(&self.spec.pattern, unit)?.texts()))
    }

    fn own(&self) -> Result<Vec<Style>> {
        let unit = self.spec.unit.as_deref().and_then(patterns::unit_of);
        let style = |size: &spec::file::SizeFile| {
            if size.name == self.spec.size {
                return stages::style(&self.spec);
            }
            patterns::read_style(&size.pattern, self.spec.seams.as_ref(), Some(&size.name), unit)
        };
        self.entry.sizes.iter().map(style).collect()
    }

    /// Names of the pattern's sizes, where it has as many.
    fn names(&self) -> Vec<String> {
        if self.entry.sizes.len() == self.count {
            return self.entry.sizes.iter().map(|size| size.name.clone()).collect();
        }
        (1..=self.count).map(|number| number.to_string()).collect()
    }
}

/// Levels that the base covers and that have a band, girths of the trunk first.
fn bands(entry: &GarmentEntry, covered: &[Covered], without: &[String]) -> Result<Vec<Band>> {
    let is_covered = |level: &str| covered.iter().any(|known| known.level == level);
    if let Some(other) = without.iter().find(|level| !is_covered(level)) {
        let known = covered.iter().map(|known| known.level.clone()).collect();
        return Err(StudyError::NotFound { what: "level", name: other.clone(), known });
    }
    let is_top = ["chest", "bust"].into_iter().any(is_covered);
    let band = |known: &Covered| {
        let band_m = entry.target.meant_m(&known.level, is_top)?;
        let decides = entry.target.band(&known.level, is_top, known.is_held)?;
        Some(Band { level: known.level.clone(), band_m, decides })
    };
    let asked = covered.iter().filter(|known| !without.contains(&known.level));
    let mut bands: Vec<Band> = asked.filter_map(band).collect();
    bands.sort_by_key(|band| tally::order(&band.level));
    if bands.is_empty() { Err(AdviceError::NoTarget { garment: entry.name.clone() }.into()) } else { Ok(bands) }
}

/// Person in the middle of all, by girth at a level.
fn in_the_middle<'f>(figures: &'f [Figure], level: &str) -> Option<&'f Figure> {
    let mut all: Vec<&Figure> = figures.iter().collect();
    all.sort_by(|a, b| a.girth_m(level).unwrap_or(0.0).total_cmp(&b.girth_m(level).unwrap_or(0.0)));
    all.get(all.len() / 2).copied()
}

fn turned(amounts: &[(Handle, f64)]) -> Vec<Turn> {
    let turn = |(handle, amount_m): &(Handle, f64)| Turn {
        handle: handle.as_str(),
        amount_mm: (mm(*amount_m) * 10.0).round() / 10.0,
    };
    amounts.iter().map(turn).collect()
}

fn grown(knobs: &Knobs, turns: &Turns, run: Run) -> Vec<Grown> {
    let lead = |(number, lead): (usize, &knobs::Lead)| -> Vec<Grown> {
        let girth_m = lead.told[0].1;
        let row = |(handle, told_m): &(Handle, f64)| Grown {
            handle: handle.as_str(),
            with: lead.handle.as_str(),
            of_40_mm: mm(*told_m),
            steps_mm: (0..run.groups())
                .map(|group| mm(told_m / girth_m * knobs.step_m(turns, group, number)))
                .collect(),
        };
        lead.told.iter().map(row).collect()
    };
    knobs.leads.iter().enumerate().flat_map(lead).collect()
}

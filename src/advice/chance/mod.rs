//! Probability that a garment fits: the unknowns of body, garment, cloth and start are drawn, and every draw is judged.

mod bench;
mod draped;
mod planted;
#[cfg(test)]
mod tests;

pub use draped::DrapedChance;
pub use planted::{PlantedLevel, PlantedTally, Reliability, planted};

use serde::Serialize;

use crate::alteration::one;
use crate::error::AdviceError;
use bench::{Bench, Sized};
use body::Dimension;
use engine::stages;
use fit::Draw;
use fit::chance::{self, Share, Sitting, Verdict};
use fit::target::{Target, is_within_reach};
use geom::units::{from_mm, mm};
use report::Chart;
use report::chart::{Probable, chance_chart};
use spec::{JobSpec, Study};
use store::{InOrigin, Origin, Result};

#[derive(Clone, Debug, PartialEq)]
pub struct Question {
    /// Needed where the study has several.
    pub garment: Option<String>,
    /// Needed where the study has several.
    pub subject: Option<String>,
    /// Size to report level by level; `None` for the one worn most often.
    pub size: Option<String>,
    pub draws: usize,
    pub seed: u64,
    /// Factor on the measurement errors of a trained measurer.
    pub error_factor: f64,
    /// Tolerance of half a girth of the garment: one of twenty garments is off by more.
    pub tolerance_mm: f64,
    /// Number of draws to drape by FEM-GS.
    pub fem: usize,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LikelyDimension {
    /// Key of the dimension; it ends in the unit.
    pub dimension: &'static str,
    /// Value that was read, and the standard deviation of its error; `None` where it was not read.
    pub read: Option<[f64; 2]>,
    /// Lower end, median and upper end of the 80 % interval of the true value.
    pub likely: [f64; 3],
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LevelChance {
    pub level: String,
    /// Least and greatest; `None` without a target.
    pub target_mm: Option<[f64; 2]>,
    /// Lower end, median and upper end of the 80 % interval.
    pub ease_mm: [f64; 3],
    /// Share of draws.
    pub tight: f64,
    /// Share of draws.
    pub loose: f64,
    /// Share of draws in which the level is outside its target and the worst one.
    pub decides: f64,
}

impl LevelChance {
    pub fn as_meant(&self) -> f64 {
        1.0 - self.tight - self.loose
    }
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SizeChance {
    pub size: String,
    pub wear: Share,
    /// Probability that every level is within its target.
    pub fits: Share,
    /// Share of draws in which the worst level is too tight.
    pub tight: f64,
    pub loose: f64,
    /// Share of draws in which the worst level departs from its target by more than a grade step, counting too tight
    /// double.
    pub out_of_reach: f64,
    /// Levels from the neck down.
    pub levels: Vec<LevelChance>,
}

impl SizeChance {
    /// Words for the size to wear; for the nearest one where it is out of reach in more than half of the draws.
    pub fn place(&self) -> &'static str {
        if self.out_of_reach > 0.5 { "the nearest, though none fits," } else { "the one to wear" }
    }

    /// `None` where none ever does.
    pub fn decides(&self) -> Option<&LevelChance> {
        let most = self.levels.iter().max_by(|a, b| a.decides.total_cmp(&b.decides));
        most.filter(|level| level.decides > 0.0)
    }
}

#[derive(Clone, Debug, Serialize)]
pub struct Chance {
    pub garment: String,
    pub subject: String,
    /// Intended fit, as study files name it.
    pub intended: &'static str,
    pub draws: usize,
    /// Equal seeds give equal answers.
    pub seed: u64,
    pub body: Vec<LikelyDimension>,
    pub sizes: Vec<SizeChance>,
    /// Size that is reported level by level.
    pub told: String,
    /// Drapes of that size; `None` where none were asked for.
    pub drape: Option<DrapedChance>,
}

impl Chance {
    pub fn told(&self) -> Option<&SizeChance> {
        self.sizes.iter().find(|size| size.size == self.told)
    }

    pub fn chart(&self) -> Result<Chart> {
        let title = format!("{} on {}", self.garment, self.subject);
        let row = |size: &SizeChance, level: &LevelChance| Probable {
            size: size.size.clone(),
            level: level.level.replace('_', " "),
            target_m: level.target_mm.map(|band| band.map(from_mm)),
            ease_m: level.ease_mm.map(from_mm),
            share: level.target_mm.map(|_| level.as_meant()),
        };
        let rows: Vec<Probable> =
            self.sizes.iter().flat_map(|size| size.levels.iter().map(|level| row(size, level))).collect();
        chance_chart(&title, &rows).origin(Origin::Report)
    }
}

pub fn chance(study: &Study, question: &Question) -> Result<Chance> {
    let (jobs, target) = asked(study, question)?;
    let first = jobs.first().ok_or(AdviceError::NoSize)?;
    let asked_size = question.size.as_deref().map(|size| one("size", Some(size), sizes_of(&jobs))).transpose()?;
    let styles = jobs.iter().map(|job| Ok((job.size.clone(), stages::style(job)?)));
    let styles = styles.collect::<Result<Vec<_>>>()?;
    let scanned = first.person.scan.is_some().then(|| first.person.body()).transpose()?;
    let bench = Bench::new(&styles, &target, &first.person.measurements, scanned.as_ref(), question)?;
    let sizes = tallied(&bench, question);
    let worn = sizes.iter().reduce(|best, size| if size.wear.share > best.wear.share { size } else { best });
    let told = asked_size.or_else(|| worn.map(|size| size.size.clone())).unwrap_or_default();
    let job = jobs.iter().find(|job| job.size == told).filter(|_| question.fem > 0);
    Ok(Chance {
        garment: first.garment.clone(),
        subject: first.subject.clone(),
        intended: target.intended.as_str(),
        draws: question.draws,
        seed: question.seed,
        body: known(&bench),
        drape: job.map(|job| draped::draped(job, &bench, question)).transpose()?,
        told,
        sizes,
    })
}

fn sizes_of(jobs: &[JobSpec]) -> Vec<String> {
    jobs.iter().map(|job| job.size.clone()).collect()
}

fn asked(study: &Study, question: &Question) -> Result<(Vec<JobSpec>, Target)> {
    let garments = study.garments.iter().map(|garment| garment.name.clone()).collect();
    let name = one("garment", question.garment.as_deref(), garments)?;
    let garment = study.garments.iter().find(|garment| garment.name == name);
    let subjects = garment.map(|garment| garment.subjects.clone()).unwrap_or_default();
    let subject = one("subject", question.subject.as_deref(), subjects)?;
    let mut jobs = spec::jobs_of(study, &name, &subject);
    jobs.dedup_by(|next, before| next.size == before.size);
    Ok((jobs, garment.map_or_else(Target::default, |garment| garment.target.clone())))
}

fn known(bench: &Bench) -> Vec<LikelyDimension> {
    let scale = |dimension: Dimension, value: f64| (value * dimension.per_si() * 10.0).round() / 10.0;
    let likely_dimension = |dimension: Dimension| {
        let likely = bench.likely_at(dimension)?;
        let read = bench.readings.get(dimension).map(|value| [value, bench.error(dimension)]);
        Some(LikelyDimension {
            dimension: dimension.key(),
            read: read.map(|read| read.map(|value| scale(dimension, value))),
            likely: likely.map(|value| scale(dimension, value)),
        })
    };
    Dimension::ALL.into_iter().filter_map(likely_dimension).collect()
}

/// Draws bodies and garments, judges every draw, and counts.
fn tallied(bench: &Bench, question: &Question) -> Vec<SizeChance> {
    let mut draw = Draw::new(question.seed);
    let mut drawn: Vec<Vec<Vec<f64>>> = vec![Vec::with_capacity(question.draws); bench.sizes.len()];
    let mut verdicts: Vec<Vec<Verdict>> = vec![Vec::with_capacity(question.draws); bench.sizes.len()];
    let mut worn = vec![0; bench.sizes.len()];
    for _ in 0..question.draws {
        let person = bench.person(&mut draw);
        let mut judged = Vec::with_capacity(bench.sizes.len());
        for (number, size) in bench.sizes.iter().enumerate() {
            let eases = bench.eases_m(size, &person, &mut draw);
            judged.push(chance::verdict(&eases, &size.bands()));
            drawn[number].push(eases);
        }
        if let Some(best) = chance::to_wear(&judged) {
            worn[best] += 1;
        }
        judged.into_iter().enumerate().for_each(|(number, verdict)| verdicts[number].push(verdict));
    }
    let all = bench.sizes.iter().zip(drawn).zip(verdicts).zip(worn);
    all.map(|(((size, drawn), verdicts), worn)| size_chance(size, &drawn, &verdicts, worn)).collect()
}

fn size_chance(size: &Sized, drawn: &[Vec<f64>], verdicts: &[Verdict], worn: usize) -> SizeChance {
    let draws = verdicts.len();
    let count = |is: &dyn Fn(&Verdict) -> bool| verdicts.iter().filter(|verdict| is(verdict)).count();
    let share = |count: usize| Share::of(count, draws).share;
    let level = |(number, level): (usize, &bench::Level)| {
        let eases: Vec<f64> = drawn.iter().map(|eases| eases[number]).collect();
        let sits = |wanted: Sitting| {
            let is = |ease: &&f64| level.band.is_some_and(|band| chance::sitting(**ease, &band) == wanted);
            share(eases.iter().filter(is).count())
        };
        LevelChance {
            level: level.name.clone(),
            target_mm: level.band.map(|band| band.ends_m.map(mm)),
            ease_mm: chance::interval(&eases).map(mm),
            tight: sits(Sitting::Tight),
            loose: sits(Sitting::Loose),
            decides: share(count(&|verdict| verdict.decides == Some(number))),
        }
    };
    SizeChance {
        size: size.size.clone(),
        wear: Share::of(worn, draws),
        fits: Share::of(count(&|verdict| verdict.sitting == Sitting::Fits), draws),
        tight: share(count(&|verdict| verdict.sitting == Sitting::Tight)),
        loose: share(count(&|verdict| verdict.sitting == Sitting::Loose)),
        out_of_reach: share(count(&|verdict| !is_within_reach(verdict.weight_m))),
        levels: size.levels.iter().enumerate().map(level).collect(),
    }
}

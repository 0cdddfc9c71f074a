//! Calibration of the probabilities: simulated people with known bodies are measured with errors and judged from the
//! readings, and the judgement is compared with the truth.

use std::thread;

use serde::Serialize;

use crate::chance::bench::Bench;
use crate::chance::{Question, asked, tallied};
use crate::error::AdviceError;
use body::{Body, Dimension, Likely, Measurements, Sex};
use engine::{ease, stages};
use fit::chance::{self, Share, Sitting};
use fit::target::Target;
use fit::{Draw, Ease};
use geom::units::mm;
use pattern::Style;
use spec::{Study, bodies};
use store::Result;

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PlantedLevel {
    pub level: String,
    pub people: usize,
    /// Share of these people whose true ease lies in the predicted 80 % interval.
    pub held: Share,
    /// Mean width of the interval.
    pub width_mm: f64,
}

/// Truth of the probabilities within a range.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Reliability {
    /// Least and greatest probability of the range.
    pub told: [f64; 2],
    pub cases: usize,
    pub mean: f64,
    pub came_true: Share,
}

/// Calibration on simulated people with known bodies.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PlantedTally {
    /// Number of people, half of them women.
    pub people: usize,
    /// Dimensions that were read on each person.
    pub read: Vec<&'static str>,
    /// Share of true eases within the 80 % interval, over all levels with a target.
    pub held: Share,
    pub levels: Vec<PlantedLevel>,
    pub fits: Vec<Reliability>,
    pub wear: Vec<Reliability>,
}

const RANGES: [f64; 7] = [0.0, 0.1, 0.3, 0.5, 0.7, 0.9, 1.0];

#[derive(Default)]
struct Case {
    levels: Vec<CaseLevel>,
    fits: Vec<Told>,
    wear: Vec<Told>,
}

/// Ease at a level of the size to wear.
struct CaseLevel {
    level: String,
    has_target: bool,
    /// Predicted ends and median of the 80 % interval, mm.
    told_mm: [f64; 3],
    true_mm: f64,
}

impl CaseLevel {
    fn is_held(&self) -> bool {
        (self.told_mm[0]..=self.told_mm[2]).contains(&self.true_mm)
    }
}

struct Told {
    probability: f64,
    came_true: bool,
}

/// Draws people of both sexes from the survey. On each reads the dimensions that are known of the subject, with errors
/// of `error_factor`, and counts how often the truth lies where [`chance`](crate::chance::chance()) predicts.
pub fn planted(study: &Study, question: &Question, people: usize, error_factor: f64) -> Result<PlantedTally> {
    let (jobs, target) = asked(study, question)?;
    let styles = jobs.iter().map(|job| Ok((job.size.clone(), stages::style(job)?))).collect::<Result<Vec<_>>>()?;
    let read = jobs.first().map(|job| job.person.measurements.known().map(|(dimension, _)| dimension).collect());
    let read: Vec<Dimension> = read.unwrap_or_default();
    let plot = Plot { styles: &styles, target: &target, read: &read, question, error_factor };
    let workers = thread::available_parallelism().map_or(1, usize::from);
    let cases: Vec<Result<Vec<Case>>> = thread::scope(|scope| {
        let work = |worker: usize| move || (worker..people).step_by(workers).map(|number| plot.case(number)).collect();
        let threads: Vec<_> = (0..workers).map(|worker| scope.spawn(work(worker))).collect();
        let lost = |_| Err(AdviceError::LostThread.into());
        threads.into_iter().map(|thread| thread.join().unwrap_or_else(lost)).collect()
    });
    let cases: Vec<Case> = cases.into_iter().collect::<Result<Vec<_>>>()?.into_iter().flatten().collect();
    Ok(tally(&cases, &read))
}

#[derive(Clone, Copy)]
struct Plot<'a> {
    styles: &'a [(String, Style)],
    target: &'a Target,
    read: &'a [Dimension],
    question: &'a Question,
    error_factor: f64,
}

impl Plot<'_> {
    fn case(&self, number: usize) -> Result<Case> {
        let mut draw = Draw::new(Draw::new(self.question.seed ^ ((number as u64) << 32)).bits());
        let sex = if number.is_multiple_of(2) { Sex::Female } else { Sex::Male };
        // Draws again if no body can be built, or if the readings fit nobody.
        let (body, bench) = loop {
            if let Some(found) = self.planted(sex, &mut draw) {
                break found;
            }
        };
        let told = tallied(&bench, &Question { seed: draw.bits(), ..self.question.clone() });
        let Some(worn) = told.iter().reduce(|best, size| if size.wear.share > best.wear.share { size } else { best })
        else {
            return Ok(Case::default());
        };
        let mut case = Case::default();
        let mut verdicts = Vec::new();
        for ((size, chance), (_, style)) in bench.sizes.iter().zip(&told).zip(self.styles) {
            let eases = ease::on(style, &body);
            let made_m = size.made_m(&mut draw);
            let ease_m = |level: &str| eases.iter().find(|ease| ease.level == level).map_or(f64::NAN, Ease::ease_m);
            let levels = size.levels.iter().zip(made_m);
            let truth: Vec<f64> = levels.map(|(level, made_m)| ease_m(&level.name) + made_m).collect();
            let verdict = chance::verdict(&truth, &size.bands());
            case.fits.push(Told { probability: chance.fits.share, came_true: verdict.sitting == Sitting::Fits });
            verdicts.push(verdict);
            if chance.size == worn.size {
                let levels = chance.levels.iter().zip(truth).filter(|(_, ease_m)| ease_m.is_finite());
                case.levels.extend(levels.map(|(level, ease_m)| CaseLevel {
                    level: level.level.clone(),
                    has_target: level.target_mm.is_some(),
                    told_mm: level.ease_mm,
                    true_mm: mm(ease_m),
                }));
            }
        }
        let to_wear = chance::to_wear(&verdicts);
        let wear = told
            .iter()
            .enumerate()
            .map(|(number, size)| Told { probability: size.wear.share, came_true: to_wear == Some(number) });
        case.wear = wear.collect();
        Ok(case)
    }

    /// `None` where the body cannot be built or the readings fit nobody.
    fn planted(&self, sex: Sex, draw: &mut Draw) -> Option<(Body, Bench)> {
        let person = Likely::anybody(sex).person(&std::array::from_fn(|_| draw.normal()));
        let body = bodies::build_body(&person).ok()?;
        let mut readings = Measurements::of(sex, f64::NAN);
        for dimension in self.read {
            let error = self.error_factor * dimension.reading_error() * draw.normal();
            readings.set(*dimension, person.get(*dimension).map(|value| value + error));
        }
        let bench = Bench::new(self.styles, self.target, &readings, None, self.question).ok()?;
        Some((body, bench))
    }
}

fn tally(cases: &[Case], read: &[Dimension]) -> PlantedTally {
    let all = || cases.iter().flat_map(|case| &case.levels);
    let held = |of: &[&CaseLevel]| Share::of(of.iter().filter(|level| level.is_held()).count(), of.len());
    let mut names: Vec<&str> = Vec::new();
    for CaseLevel { level, .. } in all() {
        if !names.contains(&level.as_str()) {
            names.push(level);
        }
    }
    let level = |name: &&str| {
        let own: Vec<_> = all().filter(|case| case.level == *name).collect();
        let width = own.iter().map(|case| case.told_mm[2] - case.told_mm[0]).sum::<f64>() / own.len() as f64;
        PlantedLevel {
            level: (*name).to_owned(),
            people: own.len(),
            held: held(&own),
            width_mm: (width * 10.0).round() / 10.0,
        }
    };
    PlantedTally {
        people: cases.len(),
        read: read.iter().map(|dimension| dimension.key()).collect(),
        held: held(&all().filter(|case| case.has_target).collect::<Vec<_>>()),
        levels: names.iter().map(level).collect(),
        fits: reliability(cases.iter().flat_map(|case| &case.fits)),
        wear: reliability(cases.iter().flat_map(|case| &case.wear)),
    }
}

fn reliability<'a>(told: impl Iterator<Item = &'a Told>) -> Vec<Reliability> {
    let told: Vec<&Told> = told.collect();
    let last = RANGES.len() - 2;
    let within = |number: usize| {
        let [low, high] = [RANGES[number], RANGES[number + 1]];
        let is_within = |p: f64| p >= low && (p < high || number == last);
        let own: Vec<_> = told.iter().filter(|told| is_within(told.probability)).collect();
        let mean = own.iter().map(|told| told.probability).sum::<f64>() / own.len() as f64;
        let came_true = Share::of(own.iter().filter(|told| told.came_true).count(), own.len());
        Reliability { told: [low, high], cases: own.len(), mean, came_true }
    };
    (0..=last).map(within).filter(|range| range.cases > 0).collect()
}

//! A population as a few representative bodies, as the thesis proposes (7.1). People are drawn from a published survey
//! and grouped by the dimensions that clothes depend on; the middle person represents each group. For a new subject the
//! nearest representative answers, whose results exist already.

use std::fmt::Write;

use body::{self, Dimension, Measurements, Sex};
use fit::Draw;
use spec::entry::filled;
use spec::fields::sex_name;
use spec::{Given, MEASUREMENTS};
use store::{JobId, Result, Store, StudyError, SubjectId, read};
use wardrobe::catalogue;

/// Dimensions by which people are drawn and grouped: those that the thesis gives of its subjects.
pub(crate) const DIMENSIONS: [Dimension; 7] = [
    Dimension::Stature,
    Dimension::Weight,
    Dimension::ChestGirth,
    Dimension::WaistGirth,
    Dimension::HipGirth,
    Dimension::NeckGirth,
    Dimension::AcrossShoulder,
];
/// Greatest magnitude of a standard score: one person in 16,000 is beyond it.
const EXTREME: f64 = 4.0;
/// Greatest number of representatives for which people are grouped. Beyond it everybody who is drawn is a
/// representative, since a round of grouping takes as many comparisons as people times representatives.
const GROUPED: usize = 500;
const ROUNDS: usize = 200;

#[derive(Clone, Debug, PartialEq)]
pub struct Representative {
    /// Measurements, rounded to 1 mm and 0.1 kg.
    pub measurements: Measurements,
    /// Share of the people of this sex who are in the group.
    pub share: f64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PopulationOptions {
    /// Number of representatives of each sex.
    pub bodies: usize,
    /// Number of people drawn of each sex.
    pub people: usize,
    pub seed: u64,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Nearest {
    pub subject: String,
    /// Root mean square difference of the dimensions that both have, in standard deviations.
    pub distance: f64,
    pub widest: Difference,
    pub jobs: Vec<JobId>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Difference {
    pub dimension: Dimension,
    /// Value of the person who is asked about, m or kg.
    pub asked: f64,
    /// Value of the representative, m or kg.
    pub found: f64,
}

/// Draws people of a sex as frequently as they occur in the survey.
pub(crate) fn people(sex: Sex, count: usize, random: &mut Draw) -> Vec<Measurements> {
    (0..count).map(|_| draw(sex, random)).collect()
}

/// Most frequent first.
pub fn representatives(sex: Sex, options: &PopulationOptions) -> Vec<Representative> {
    let mut random = Draw::new(options.seed ^ if sex == Sex::Male { 0x6d } else { 0x66 });
    if options.bodies > GROUPED {
        let share = 1.0 / options.bodies as f64;
        let drawn = |_| Representative { measurements: rounded(&draw(sex, &mut random)), share };
        return (0..options.bodies).map(drawn).collect();
    }
    let people = people(sex, options.people, &mut random);
    let points: Vec<Point> = people.iter().map(point).collect();
    let groups = group(&points, options.bodies, &mut random);
    let mut found: Vec<Representative> = groups
        .into_iter()
        .map(|(middle, size)| Representative {
            measurements: rounded(&people[middle]),
            share: size as f64 / options.people as f64,
        })
        .collect();
    found.sort_by(|a, b| b.share.total_cmp(&a.share));
    found
}

/// Writes `[[subject]]` tables.
pub fn subjects_text(representatives: &[Representative]) -> String {
    let mut text = String::new();
    for (number, Representative { measurements, share }) in representatives.iter().enumerate() {
        let sex = sex_name(measurements);
        // Writing to a `String` does not fail, here and below.
        let _ = writeln!(text, "[[subject]] # {:.2} % of {sex}s", share * 100.0);
        let _ = writeln!(text, "id = \"{}{:03}\"\nsex = \"{sex}\"", &sex[..1], number + 1);
        for field in MEASUREMENTS.iter() {
            if let Some(value) = field.get(measurements) {
                let _ = writeln!(text, "{} = {value}", field.key);
            }
        }
        text.push('\n');
    }
    text
}

/// Nearest subject of the same sex.
pub fn nearest(store: &Store, study: &str, given: &[Given]) -> Result<Nearest> {
    read::study(store, study)?;
    let subject = &filled::<Measurements>(None, "", given).map_err(|problems| StudyError::Refused {
        what: "subject",
        name: "to compare".to_owned(),
        problems: problems.into_iter().map(|(_, problem)| problem).collect(),
    })?;
    let sql = "SELECT DISTINCT job.subject, subject_id FROM job JOIN study USING (study_id)
        WHERE study.name = ? AND is_current ORDER BY job.subject";
    let mut statement = store.reader.prepare_cached(sql)?;
    let known: Vec<(String, i64)> =
        statement.query_map([study], |row| Ok((row.get(0)?, row.get(1)?)))?.collect::<rusqlite::Result<_>>()?;
    let mut best: Option<Nearest> = None;
    for (name, id) in known {
        let theirs = catalogue::subject_revision(store, SubjectId(id))?.measurements;
        let Some((distance, widest)) = distance(subject, &theirs) else { continue };
        if best.as_ref().is_none_or(|best| distance < best.distance) {
            best = Some(Nearest { subject: name, distance, widest, jobs: vec![] });
        }
    }
    let mut best = best.ok_or_else(|| StudyError::NotFound {
        what: "subject of the study who is",
        name: sex_name(subject).to_owned(),
        known: vec![],
    })?;
    let sql = "SELECT job_id FROM job JOIN study USING (study_id) WHERE study.name = ? AND subject = ? AND is_current
        AND status IN ('done', 'not_converged') ORDER BY job_id";
    let mut statement = store.reader.prepare_cached(sql)?;
    let jobs = statement.query_map([study, &best.subject], |row| row.get(0).map(JobId))?;
    best.jobs = jobs.collect::<rusqlite::Result<_>>()?;
    Ok(best)
}

/// Root mean square difference of two people of one sex over the dimensions that both have, and the greatest one.
fn distance(a: &Measurements, b: &Measurements) -> Option<(f64, Difference)> {
    if a.sex != b.sex {
        return None;
    }
    let theirs = body::scores(b);
    let mut squares = Vec::new();
    let mut widest: Option<(f64, Dimension)> = None;
    for (dimension, score) in body::scores(a) {
        let Some((_, other)) = theirs.iter().find(|(known, _)| *known == dimension) else { continue };
        let difference = (score - other).abs();
        squares.push(difference * difference);
        if widest.is_none_or(|(most, _)| difference > most) {
            widest = Some((difference, dimension));
        }
    }
    let (_, dimension) = widest?;
    let mean = squares.iter().sum::<f64>() / squares.len() as f64;
    Some((mean.sqrt(), Difference { dimension, asked: a.get(dimension)?, found: b.get(dimension)? }))
}

/// Draws a person whose scores are not beyond [`EXTREME`].
fn draw(sex: Sex, random: &mut Draw) -> Measurements {
    loop {
        let scores = DIMENSIONS.map(|dimension| (dimension, random.normal()));
        let person = body::person(sex, &scores);
        let is_ordinary = person.known().all(|(dimension, value)| {
            let [least, greatest] = dimension.range();
            (least..=greatest).contains(&value)
        });
        if is_ordinary && scores.iter().all(|(_, score)| score.abs() < EXTREME) {
            return person;
        }
    }
}

/// Rounds measurements to the resolution of a tape and of scales.
fn rounded(person: &Measurements) -> Measurements {
    let mut rounded = person.clone();
    for (dimension, value) in person.known() {
        let scale = if dimension == Dimension::Weight { 10.0 } else { 1000.0 };
        rounded.set(dimension, (value * scale).round() / scale);
    }
    rounded
}

/// A person's dimensions in standard deviations of the survey.
type Point = [f64; DIMENSIONS.len()];

fn point(person: &Measurements) -> Point {
    let scores = body::scores(person);
    DIMENSIONS.map(|dimension| scores.iter().find(|(known, _)| *known == dimension).map_or(0.0, |(_, score)| *score))
}

fn off(a: &Point, b: &Point) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum()
}

/// Groups points by k-means [Lloyd 1982], started as in [Arthur and Vassilvitskii 2007]. Returns for each group the
/// point nearest to its mean, and the number of its points.
fn group(points: &[Point], count: usize, random: &mut Draw) -> Vec<(usize, usize)> {
    let mut middles = seeds(points, count, random);
    let mut group_of = vec![usize::MAX; points.len()];
    for _ in 0..ROUNDS {
        let next: Vec<usize> = points.iter().map(|point| nearest_middle(point, &middles)).collect();
        if next == group_of {
            break;
        }
        group_of = next;
        for (number, middle) in middles.iter_mut().enumerate() {
            let mut sum = Point::default();
            let members = group_of.iter().zip(points).filter(|(group, _)| **group == number);
            let mut size = 0.0;
            for (_, point) in members {
                sum.iter_mut().zip(point).for_each(|(sum, x)| *sum += x);
                size += 1.0;
            }
            if size > 0.0 {
                *middle = sum.map(|sum| sum / size);
            }
        }
    }
    let mut found = Vec::with_capacity(middles.len());
    for (number, middle) in middles.iter().enumerate() {
        let members: Vec<usize> = (0..points.len()).filter(|&k| group_of[k] == number).collect();
        let best = members.iter().copied().min_by(|&a, &b| off(&points[a], middle).total_cmp(&off(&points[b], middle)));
        found.extend(best.map(|best| (best, members.len())));
    }
    found
}

/// First means: each point is drawn with a probability that grows with its distance from those drawn before.
fn seeds(points: &[Point], count: usize, random: &mut Draw) -> Vec<Point> {
    let mut middles: Vec<Point> = points.first().copied().into_iter().collect();
    let mut far: Vec<f64> = points.iter().map(|point| middles.first().map_or(0.0, |first| off(point, first))).collect();
    while middles.len() < count.min(points.len()) {
        let mut left = random.share() * far.iter().sum::<f64>();
        let chosen = far.iter().position(|far| {
            left -= far;
            left <= 0.0
        });
        let next = points[chosen.unwrap_or(points.len() - 1)];
        far.iter_mut().zip(points).for_each(|(far, point)| *far = far.min(off(point, &next)));
        middles.push(next);
    }
    middles
}

fn nearest_middle(point: &Point, middles: &[Point]) -> usize {
    let far = |k: &usize| off(point, &middles[*k]);
    (0..middles.len()).min_by(|a, b| far(a).total_cmp(&far(b))).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    const FEW: PopulationOptions = PopulationOptions { bodies: 12, people: 1500, seed: 1 };

    #[test]
    fn people_are_drawn_as_frequent_as_in_the_survey() {
        let mut random = Draw::new(3);
        let points: Vec<Point> = (0..4000).map(|_| point(&draw(Sex::Male, &mut random))).collect();
        for k in 0..DIMENSIONS.len() {
            let mean = points.iter().map(|p| p[k]).sum::<f64>() / 4000.0;
            let sd = (points.iter().map(|p| (p[k] - mean).powi(2)).sum::<f64>() / 3999.0).sqrt();
            assert!(mean.abs() < 0.06 && (sd - 1.0).abs() < 0.06, "{:?}: {mean} {sd}", DIMENSIONS[k]);
        }
        // Correlation of stature and weight in the drawn people.
        let both = points.iter().map(|p| p[0] * p[1]).sum::<f64>() / 4000.0;
        assert!((both - 0.472).abs() < 0.05, "{both}");
    }

    #[test]
    fn representatives_are_people_and_stand_for_everybody() {
        let found = representatives(Sex::Female, &FEW);
        assert_eq!(found, representatives(Sex::Female, &FEW), "the same seed, the same people");
        assert_eq!(found.len(), FEW.bodies);
        assert!((found.iter().map(|group| group.share).sum::<f64>() - 1.0).abs() < 1e-9);
        assert!(found[0].share < 0.25 && found[FEW.bodies - 1].share > 0.01, "{found:?}");
        // On average a person is within the spread of one group from the nearest middle.
        let middles: Vec<Point> = found.iter().map(|middle| point(&middle.measurements)).collect();
        let mut random = Draw::new(9);
        let far: Vec<f64> = (0..500)
            .map(|_| point(&draw(Sex::Female, &mut random)))
            .map(|p| (off(&p, &middles[nearest_middle(&p, &middles)]) / 7.0).sqrt())
            .collect();
        let mean = far.iter().sum::<f64>() / 500.0;
        assert!(mean < 0.75, "{mean}");
    }

    #[test]
    fn of_very_many_everybody_stands_for_himself() {
        let many = PopulationOptions { bodies: GROUPED + 1, people: 100, seed: 1 };
        let found = representatives(Sex::Male, &many);
        assert_eq!(found.len(), GROUPED + 1);
        assert!((found.iter().map(|person| person.share).sum::<f64>() - 1.0).abs() < 1e-9);
        let statures = found.iter().filter_map(|person| person.measurements.get(Dimension::Stature));
        let mean = statures.sum::<f64>() / found.len() as f64;
        assert!((mean - 1.756).abs() < 0.01, "{mean}");
    }

    #[test]
    fn every_representative_can_be_a_body_of_a_study() {
        let text = subjects_text(&representatives(Sex::Male, &FEW));
        let table: toml::Table = text.parse().expect("TOML");
        assert_eq!(table["subject"].as_array().map(Vec::len), Some(FEW.bodies));
        for person in representatives(Sex::Male, &FEW) {
            body::build(&person.measurements).expect("a person that can be");
        }
    }

    #[test]
    fn the_nearest_is_of_the_same_sex_and_alike() {
        let person = |sex, chest| Measurements::of(sex, 1.75).with(Dimension::ChestGirth, chest);
        assert_eq!(distance(&person(Sex::Male, 1.0), &person(Sex::Female, 1.0)), None);
        let (same, _) = distance(&person(Sex::Male, 1.0), &person(Sex::Male, 1.0)).expect("alike");
        let (far, widest) = distance(&person(Sex::Male, 1.0), &person(Sex::Male, 1.2)).expect("alike");
        let chest = Difference { dimension: Dimension::ChestGirth, asked: 1.0, found: 1.2 };
        assert!(same == 0.0 && far > 1.0 && widest == chest, "{far} {widest:?}");
    }
}

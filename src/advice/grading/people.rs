//! People of a population: drawn from the survey, built, and reduced to the measurements that ease needs.

use std::num::NonZero;
use std::thread;

use crate::population;
use body::{Body, Girths, Measurements, Sex};
use engine::ease::{self, Length};
use fit::Draw;
use pattern::Style;
use pattern::pom::Stand;
use spec::bodies;

/// Change of the seed for the people held out, so that others are drawn.
const HELD_OUT: u64 = 0x68_656c_646f_7574;
/// Spacing of the heights at which girths of the trunk are kept, and reach of these heights beyond waist and hip.
const APART_M: f64 = 0.010;
const BEYOND_M: f64 = 0.100;

/// A person, reduced to the measurements that ease needs.
pub struct Figure {
    pub measurements: Measurements,
    stand: Stand,
    girths: Girths,
    /// Heights above the floor and girths of the trunk there, m, from the lowest up. Empty where every level of the
    /// garment is measured at the height of the body's own level.
    trunk: Vec<[f64; 2]>,
}

pub struct Covered {
    pub level: String,
    /// True if the body is measured at another height than that of its own level.
    pub has_own_height: bool,
    /// True if the cut holds the garment to the body there.
    pub is_held: bool,
}

impl Figure {
    pub fn of(measurements: &Measurements, body: &Body, has_trunk: bool) -> Self {
        let stand = ease::stand(body);
        let (from_m, to_m) = (stand.hip_m.min(stand.waist_m) - BEYOND_M, stand.hip_m.max(stand.waist_m) + BEYOND_M);
        let heights =
            (0..).map(|k| from_m + f64::from(k) * APART_M).take_while(|height_m| has_trunk && *height_m < to_m);
        let girth = |height_m: f64| Some([height_m, body.trunk_girth_at(height_m)?]);
        let trunk = heights.filter_map(girth).collect();
        Self { measurements: measurements.clone(), stand, girths: body.girths.clone(), trunk }
    }

    /// Eases in m; `None` where the style does not cover the level.
    pub fn eases(&self, style: &Style, levels: &[String]) -> Vec<Option<f64>> {
        let found = ease::lengths(style, &self.stand);
        let ease_at = |level: &String| {
            let length = found.iter().find(|length| length.level == *level)?;
            Some(length.length_m - self.body_m(length)?)
        };
        levels.iter().map(ease_at).collect()
    }

    /// Levels from the neck down.
    pub fn covered(&self, style: &Style) -> Vec<Covered> {
        let found = ease::lengths(style, &self.stand).into_iter();
        let covered = found.map(|length| Covered {
            has_own_height: length.height_m.is_some(),
            is_held: length.is_held,
            level: length.level,
        });
        covered.filter(|known| known.has_own_height || self.girth_m(&known.level).is_some()).collect()
    }

    /// Girth or length of the body.
    pub fn girth_m(&self, level: &str) -> Option<f64> {
        ease::body_length_m(&self.girths, level)
    }

    fn body_m(&self, level: &Length) -> Option<f64> {
        level.height_m.and_then(|height_m| self.trunk_m(height_m)).or_else(|| self.girth_m(&level.level))
    }

    fn trunk_m(&self, height_m: f64) -> Option<f64> {
        let pair = self.trunk.windows(2).find(|pair| (pair[0][0]..=pair[1][0]).contains(&height_m))?;
        let share = (height_m - pair[0][0]) / (pair[1][0] - pair[0][0]);
        Some(pair[0][1] + share * (pair[1][1] - pair[0][1]))
    }
}

/// Draws people of some sexes, equally many of each, and from another seed the people held out.
pub fn drawn(sexes: &[Sex], counts: [usize; 2], seed: u64) -> [Vec<Measurements>; 2] {
    let seeds = [seed, seed ^ HELD_OUT];
    [0, 1].map(|k| {
        let mut random = Draw::new(seeds[k]);
        // The first sex has one more where the people cannot be halved.
        let share = |number: usize| (counts[k] + sexes.len() - 1 - number) / sexes.len().max(1);
        let drawn = sexes.iter().enumerate().map(|(number, sex)| population::people(*sex, share(number), &mut random));
        drawn.collect::<Vec<_>>().concat()
    })
}

/// Figures in the order of the people, without those whose bodies cannot be built.
pub fn figures(people: &[Measurements], has_trunk: bool) -> Vec<Figure> {
    let figure = |person: &Measurements| {
        let body = bodies::build_body(person).ok()?;
        Some(Figure::of(person, &body, has_trunk))
    };
    of_all(people, figure).into_iter().flatten().collect()
}

/// Eases by person and level, m.
pub fn eases(style: &Style, figures: &[Figure], levels: &[String]) -> Vec<Vec<Option<f64>>> {
    of_all(figures, |figure| figure.eases(style, levels))
}

/// Maps all items on all cores; results are in order.
pub fn of_all<T: Sync, U: Send>(all: &[T], make: impl Fn(&T) -> U + Sync) -> Vec<U> {
    let threads = thread::available_parallelism().map_or(1, NonZero::get);
    let share = all.len().div_ceil(threads).max(1);
    thread::scope(|scope| {
        let parts: Vec<_> =
            all.chunks(share).map(|part| scope.spawn(|| part.iter().map(&make).collect::<Vec<U>>())).collect();
        let joined = parts.into_iter().map(|part| match part.join() {
            Ok(made) => made,
            Err(panic) => std::panic::resume_unwind(panic),
        });
        joined.flatten().collect()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use pattern::draft::Model;

    #[test]
    fn a_figure_has_the_ease_of_its_body() {
        for model in [Model::Tshirt, Model::Trousers] {
            let draft = &model.drafts()[1];
            let style = Style::read(&draft.pieces, model.seams(), "drafted.seams.toml").expect("our own");
            let [people, others] = drawn(&[Sex::Male], [3, 1], 4);
            assert_ne!(people[0], others[0], "those held out are others");
            for (person, figure) in people.iter().zip(figures(&people, true)) {
                let body = bodies::build_body(person).expect("a person that can be");
                let eases = ease::on(&style, &body);
                assert!(eases.len() > 3);
                for ease in eases {
                    let found = figure.eases(&style, std::slice::from_ref(&ease.level))[0].expect("covered");
                    assert!((found - ease.ease_m()).abs() < 0.5e-3, "{}: {found}, not {}", ease.level, ease.ease_m());
                }
            }
        }
    }

    #[test]
    fn two_sexes_are_drawn_in_halves() {
        let [people, held_out] = drawn(&[Sex::Female, Sex::Male], [5, 4], 4);
        let men = |people: &[Measurements]| people.iter().filter(|person| person.sex == Sex::Male).count();
        assert_eq!([people.len(), men(&people), held_out.len(), men(&held_out)], [5, 2, 4, 2]);
    }

    #[test]
    fn all_are_taken_in_their_order() {
        let numbers: Vec<usize> = (0..101).collect();
        assert_eq!(of_all(&numbers, |k| 2 * k), numbers.iter().map(|k| 2 * k).collect::<Vec<_>>());
        assert!(of_all(&[], |k: &usize| *k).is_empty());
    }
}

//! Tally of the people whom sizes fit. As in the view `v_size`, a size fits if the ease of every level is in its band.

use crate::grading::knobs::Band;
use crate::grading::people::{self, Figure};
use crate::grading::{LevelShare, PartShare, Range, SizeSet, SizeShare};
use crate::population::DIMENSIONS;
use body::Dimension;
use fit::target;
use geom::units::mm;
use pattern::Style;

/// Departure that counts for a level which the base covers and the size does not: more than any ease departs.
const UNCOVERED_M: f64 = 1.0;
const PARTS: usize = 5;
/// Standard errors in half of a 95 % interval.
const NORMAL_95: f64 = 1.96;
const PERCENTILES: [f64; 3] = [0.05, 0.5, 0.95];
/// Girths of the trunk, from the top down; they stand before other levels.
const ORDER: [&str; 5] = ["chest", "bust", "underbust", "waist", "hip"];

pub fn order(level: &str) -> usize {
    ORDER.iter().position(|known| *known == level).unwrap_or(ORDER.len())
}

#[derive(Clone, Copy, Debug)]
struct Worst {
    level: usize,
    /// Weighted departure from the level's band; 0 where all levels are in their bands.
    weight_m: f64,
}

pub struct Tally {
    /// Worst level, by size and then person.
    worst: Vec<Vec<Worst>>,
    /// True for a level outside its band on the size to wear, by person and then level.
    off: Vec<Vec<bool>>,
}

impl Tally {
    /// Ignores levels that the base does not cover on a person.
    pub fn of(styles: &[Style], base: &Style, figures: &[Figure], bands: &[Band]) -> Self {
        let levels: Vec<String> = bands.iter().map(|band| band.level.clone()).collect();
        let asked = people::eases(base, figures, &levels);
        let weights = |style: &Style| -> Vec<Vec<f64>> {
            let eases = people::eases(style, figures, &levels);
            let weights = |(eases, asked): (&Vec<Option<f64>>, &Vec<Option<f64>>)| -> Vec<f64> {
                (0..bands.len()).map(|level| weight(eases[level], asked[level], &bands[level].decides)).collect()
            };
            eases.iter().zip(&asked).map(weights).collect()
        };
        Self::of_weights(&styles.iter().map(weights).collect::<Vec<_>>())
    }

    /// Judges by weighted departures: by size, then person, then level.
    fn of_weights(weights: &[Vec<Vec<f64>>]) -> Self {
        let worst_of = |weights: &Vec<f64>| {
            let all = weights.iter().enumerate().map(|(level, weight_m)| Worst { level, weight_m: *weight_m });
            let none = Worst { level: 0, weight_m: 0.0 };
            all.fold(none, |worst, next| if next.weight_m > worst.weight_m { next } else { worst })
        };
        let worst: Vec<Vec<Worst>> = weights.iter().map(|people| people.iter().map(worst_of).collect()).collect();
        let people = worst.first().map_or(0, Vec::len);
        let off = (0..people)
            .map(|person| weights[to_wear(&worst, person)][person].iter().map(|weight| *weight > 0.0).collect())
            .collect();
        Self { worst, off }
    }

    /// Index of the size to wear: the one whose worst level is best; the smaller of equals.
    pub fn wears(&self, person: usize) -> usize {
        to_wear(&self.worst, person)
    }

    pub fn is_fitted(&self, person: usize) -> bool {
        self.worst[self.wears(person)][person].weight_m == 0.0
    }

    fn people(&self) -> usize {
        self.off.len()
    }

    fn fitted_percent(&self) -> f64 {
        percent((0..self.people()).filter(|person| self.is_fitted(*person)).count(), self.people())
    }

    pub fn set(&self, set: &'static str, names: &[String], sought: &Self, figures: &[Figure]) -> SizeSet {
        let held_out_percent = self.fitted_percent();
        let share = held_out_percent / 100.0;
        let within = NORMAL_95 * (share * (1.0 - share) / self.people().max(1) as f64).sqrt();
        let sizes = names.iter().enumerate().map(|(size, name)| {
            let fits = self.worst[size].iter().filter(|worst| worst.weight_m == 0.0).count();
            let wearers: Vec<usize> =
                (0..self.people()).filter(|person| self.is_fitted(*person) && self.wears(*person) == size).collect();
            SizeShare {
                size: name.clone(),
                fits_percent: percent(fits, self.people()),
                worn_percent: percent(wearers.len(), self.people()),
                turns: Vec::new(),
                wearers: ranges(figures, &wearers),
            }
        });
        SizeSet {
            set,
            sought_percent: sought.fitted_percent(),
            held_out_percent,
            within_percent: 100.0 * within,
            sizes: sizes.collect(),
        }
    }

    fn within_percent(&self, level: usize) -> f64 {
        percent(self.off.iter().filter(|off| !off[level]).count(), self.people())
    }

    /// Share of the people whom no size fits for whom this level is the worst.
    fn fails_percent(&self, level: usize) -> f64 {
        let unfitted = || (0..self.people()).filter(|person| !self.is_fitted(*person));
        let fails = unfitted().filter(|person| self.worst[self.wears(*person)][*person].level == level).count();
        percent(fails, unfitted().count())
    }
}

/// Weighted departure of an ease from what is meant, m. `asked` is the ease on the base; without it the level does not
/// count.
fn weight(ease_m: Option<f64>, asked: Option<f64>, meant: &target::Band) -> f64 {
    match (ease_m, asked) {
        (_, None) => 0.0,
        (None, Some(_)) => UNCOVERED_M,
        (Some(ease_m), Some(_)) => meant.weight_m(ease_m),
    }
}

fn to_wear(worst: &[Vec<Worst>], person: usize) -> usize {
    let weight_m = |size: &usize| worst[*size][person].weight_m;
    (0..worst.len()).min_by(|a, b| weight_m(a).total_cmp(&weight_m(b))).unwrap_or(0)
}

fn percent(count: usize, of: usize) -> f64 {
    100.0 * count as f64 / of.max(1) as f64
}

fn ranges(figures: &[Figure], wearers: &[usize]) -> Vec<Range> {
    let range = |dimension: Dimension| {
        let figures = wearers.iter().filter_map(|person| figures.get(*person));
        let values = figures.filter_map(|figure| figure.measurements.get(dimension));
        let mut values: Vec<f64> = values.map(|value| value * dimension.per_si()).collect();
        values.sort_by(f64::total_cmp);
        let percentile = |share: f64| values.get(((values.len() as f64 - 1.0) * share).round() as usize).copied();
        let [low, middle, high] = PERCENTILES.map(percentile);
        Some(Range { dimension: dimension.key(), values: [low?, middle?, high?] })
    };
    DIMENSIONS.into_iter().filter_map(range).collect()
}

pub fn levels(bands: &[Band], sets: [&Tally; 2]) -> Vec<LevelShare> {
    let level = |(number, band): (usize, &Band)| LevelShare {
        level: band.level.clone(),
        target_mm: band.decides.ends_m.map(mm),
        within_percent: sets.map(|set| set.within_percent(number)),
        fails_percent: sets.map(|set| set.fails_percent(number)),
    };
    bands.iter().enumerate().map(level).collect()
}

/// Divides the people by girth at the first level.
pub fn parts(figures: &[Figure], bands: &[Band], sets: [&Tally; 2]) -> (String, Vec<PartShare>) {
    let level = bands.first().map_or_else(String::new, |band| band.level.clone());
    let girth_mm = |person: &usize| figures[*person].girth_m(&level).map_or(0.0, mm);
    let mut all: Vec<usize> = (0..figures.len()).collect();
    all.sort_by(|a, b| girth_mm(a).total_cmp(&girth_mm(b)));
    let part = |people: &[usize]| {
        let fitted =
            |set: &Tally| percent(people.iter().filter(|person| set.is_fitted(**person)).count(), people.len());
        let ends = [people.first(), people.last()].map(|person| person.map_or(0.0, girth_mm));
        PartShare { from_to_mm: ends, fits_percent: sets.map(fitted) }
    };
    let cut = |number: usize| all.len() * number / PARTS;
    let parts = (0..PARTS).map(|number| part(&all[cut(number)..cut(number + 1)])).collect();
    (level, parts)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_ease_counts_by_how_far_it_is_off_and_double_where_it_is_tight() {
        let check = |ease_m, asked, expect: f64| {
            let found = weight(ease_m, asked, &target::Band { ends_m: [0.04, 0.12], must_close: false });
            assert!((found - expect).abs() < 1e-12, "{ease_m:?} {asked:?}: {found}");
        };
        check(Some(0.04), Some(0.0), 0.0);
        check(Some(0.12), Some(0.0), 0.0);
        check(Some(0.01), Some(0.0), 0.06);
        check(Some(0.15), Some(0.0), 0.03);
        check(Some(0.15), None, 0.0);
        check(None, Some(0.0), UNCOVERED_M);
        check(None, None, 0.0);
    }

    #[test]
    fn the_smaller_of_two_that_fit_is_worn_and_who_is_not_fitted_fails_at_the_worst_level() {
        // Weighted departures: two sizes, four people, two levels.
        let small = vec![vec![0.0, 0.0], vec![0.02, 0.0], vec![0.0, 0.01], vec![0.09, 0.03]];
        let large = vec![vec![0.0, 0.0], vec![0.0, 0.0], vec![0.05, 0.0], vec![0.02, 0.04]];
        let tally = Tally::of_weights(&[small, large]);
        assert_eq!((0..4).map(|person| tally.wears(person)).collect::<Vec<_>>(), [0, 1, 0, 1]);
        assert_eq!((0..4).map(|person| tally.is_fitted(person)).collect::<Vec<_>>(), [true, true, false, false]);
        let names = ["S", "L"].map(str::to_owned);
        let set = tally.set("new", &names, &tally, &[]);
        assert_eq!((set.held_out_percent, set.sizes[0].fits_percent, set.sizes[1].fits_percent), (50.0, 25.0, 50.0));
        assert_eq!((set.sizes[0].worn_percent, set.sizes[1].worn_percent), (25.0, 25.0));
        // The third person fails by the second level alone; the fourth by both, and most by the first.
        assert_eq!((tally.within_percent(0), tally.within_percent(1)), (75.0, 50.0));
        assert_eq!((tally.fails_percent(0), tally.fails_percent(1)), (0.0, 100.0));
    }
}

//! People by their normal scores in the survey: drawn, and compared.

use super::survey::Survey;
use crate::{Dimension, Measurements, Sex};

/// Person with given normal scores. The first dimension lies its score away from the median of all people, each further
/// one from that of the people with the same preceding dimensions. Independent normal scores give people as often as
/// they occur in the survey [Gordon 2014].
pub fn person(sex: Sex, scores: &[(Dimension, f64)]) -> Measurements {
    let survey = Survey::of(sex);
    let mut given: Vec<(Dimension, f64)> = Vec::with_capacity(scores.len());
    let mut person = Measurements::of(sex, survey.expect(&[Dimension::Stature], &[])[0].median());
    for &(dimension, score) in scores {
        let value = survey.expect(&[dimension], &given)[0].at(score);
        person.set(dimension, value);
        given.push((dimension, value));
    }
    person
}

/// Normal scores of the known dimensions of a subject, each among all people of the survey.
pub fn scores(subject: &Measurements) -> Vec<(Dimension, f64)> {
    let survey = Survey::of(subject.sex);
    subject.known().map(|(dimension, value)| (dimension, survey.expect(&[dimension], &[])[0].score(value))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_person_is_of_median_scores_and_a_tall_one_is_heavy() {
        let dimensions = [Dimension::Stature, Dimension::Weight, Dimension::ChestGirth];
        let median = person(Sex::Female, &dimensions.map(|dimension| (dimension, 0.0)));
        for (dimension, score) in scores(&median) {
            assert!(score.abs() < 1e-9, "{dimension:?} {score}");
        }
        let tall = person(Sex::Female, &[(dimensions[0], 2.0), (dimensions[1], 0.0), (dimensions[2], 0.0)]);
        let found = scores(&tall);
        assert!((found[0].1 - 2.0).abs() < 1e-9 && found[1].1 > 0.8 && found[1].1 < 1.4, "{found:?}");
    }
}

//! Bodies with figures that a tailor alters for, and the figures of any body: its departures from the standard body, which
//! has the same main measurements and no figure.

use super::build::{self, build};
use super::fit::{self, Fit};
use super::template::Template;
use crate::measure::{figure_tape, sites};
use crate::people::dimension::Dimension;
use crate::people::figures::{ByTrait, DIMENSIONS, Figures, TRAITS, Trait};
use crate::people::profile::Profile;
use crate::repair::feet::Feet;
use crate::{Body, BodyError, Girths, Measurements, Sex};
use geom::TriMesh;
use geom::units::mm;
use serde::ser::SerializeStruct as _;

/// Greatest number of fits with other doses, and error of a trait below which they end, m. Judgement.
const TRIES: usize = 8;
const MET: f64 = 5e-4;

/// Greatest accepted error of a trait, m, and share of its amount: what a measurer does not tell.
const TOLERANCE: f64 = 3e-3;
const TOLERATED: f64 = 0.2;

/// Greatest dose, m. A bend by more folds the skin. Judgement.
const MOST: f64 = 0.07;

/// Builds a mannequin with figures.
///
/// All given measurements are kept. Each trait differs by its amount from that of the body without figures, and those that
/// are not named do not differ.
///
/// # Examples
/// ```
/// use body::{Figures, Measurements, Sex};
///
/// let body = body::build_figured(&Measurements::of(Sex::Male, 1.78), &Figures::read(["flat_seat"])?)?;
/// let found = body::figures(&body)?;
/// let clear: Vec<_> = found.iter().filter(|found| found.is_clear()).map(|found| found.name()).collect();
/// assert_eq!(clear, ["flat_seat"]);
/// # Ok::<(), body::BodyError>(())
/// ```
pub fn build_figured(known: &Measurements, figures: &Figures) -> Result<Body, BodyError> {
    if figures.is_empty() {
        return build(known);
    }
    figures.check(known)?;
    let mut profile = Profile::new(known)?;
    for (of, dimension, sign) in DIMENSIONS {
        if figures.amount(of) != 0.0 {
            profile.depart(dimension, sign * figures.amount(of));
        }
    }
    let asked = Trait::ALL.map(|of| if is_dimension(of) { 0.0 } else { figures.amount(of) });
    bent(&profile, asked).and_then(build::describe).map_err(build::unformed)
}

fn is_dimension(of: Trait) -> bool {
    DIMENSIONS.iter().any(|(other, ..)| *other == of)
}

/// Fits a skin whose traits differ from those of the skin without bends by the amounts `asked`, m: the dose of a trait
/// changes by the error of its reading until all traits are met, those of amount 0 too.
fn bent(profile: &Profile, asked: ByTrait<f64>) -> Result<Fit<'_>, BodyError> {
    let plain = fit::fit(profile, [0.0; TRAITS])?;
    if asked.iter().all(|amount| *amount == 0.0) {
        return Ok(plain);
    }
    let before = read(&plain);
    if let Some(i) = (0..TRAITS).find(|&i| asked[i] != 0.0 && before[i].is_none()) {
        let problem = "the body does not show where it is".to_owned();
        let figure = Trait::ALL[i].name(asked[i]).to_owned();
        return Err(BodyError::Figure { figure, problem, accepted: "a body without it".to_owned() });
    }
    let off = |fit: &Fit<'_>| -> ByTrait<f64> {
        let now = read(fit);
        std::array::from_fn(|i| {
            let change = before[i].zip(now[i]).map(|(before, now)| now - before);
            change.filter(|_| !is_dimension(Trait::ALL[i])).map_or(0.0, |change| asked[i] - change)
        })
    };
    let worst = |off: &ByTrait<f64>| off.iter().map(|error| error.abs()).fold(0.0, f64::max);
    let mut doses: ByTrait<f64> = std::array::from_fn(|i| asked[i] * GAINS[i]);
    let mut best: Option<(f64, Fit<'_>, ByTrait<f64>)> = None;
    for _ in 0..TRIES {
        let fit = fit::fit(profile, doses)?;
        let error = off(&fit);
        let is_better = best.as_ref().is_none_or(|(least, ..)| worst(&error) < *least);
        if is_better {
            best = Some((worst(&error), fit, error));
        }
        if worst(&error) < MET {
            break;
        }
        doses = std::array::from_fn(|i| {
            // A trait that is asked answers as it did, the others as they usually do.
            let reached = (asked[i] - error[i]) / asked[i];
            let next =
                if asked[i] == 0.0 { doses[i] + GAINS[i] * error[i] } else { doses[i] / reached.clamp(0.5, 2.0) };
            next.clamp(-MOST, MOST)
        });
    }
    let (_, fit, error) = best.expect("there is a first try");
    let unmet = (0..TRAITS).find(|&i| error[i].abs() > TOLERANCE.max(TOLERATED * asked[i].abs()));
    unmet.map_or(Ok(fit), |i| Err(refusal(i, &asked, &error)))
}

fn refusal(unmet: usize, asked: &ByTrait<f64>, error: &ByTrait<f64>) -> BodyError {
    let greatest = (0..TRAITS).max_by(|&a, &b| asked[a].abs().total_cmp(&asked[b].abs())).unwrap_or(unmet);
    let told = if asked[unmet] == 0.0 { greatest } else { unmet };
    let [amount, reached] = [asked[told], asked[told] - error[told]].map(|amount| mm(amount.abs()));
    let problem = match told == unmet {
        true => format!("{reached:.0} mm of it are reached on this body"),
        false => format!("on this body it changes the {:?} too", Trait::ALL[unmet]),
    };
    let figure = format!("{}={amount:.0}", Trait::ALL[told].name(asked[told]));
    BodyError::Figure { figure, problem, accepted: "less of it".to_owned() }
}

fn read(fit: &Fit<'_>) -> ByTrait<Option<f64>> {
    figure_tape::read(&fit.mesh, &fit.sites, &fit.girths, fit.figure.profile.sex)
}

/// Dose for a unit of each trait, on a body of mean measurements.
const GAINS: ByTrait<f64> = [1.0, 1.2, 1.0, 2.2, 2.5, 1.0, 1.0, 0.0, 0.0, 0.0, 1.0];

/// Trait of a body beside that of its standard body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FigureFound {
    pub of: Trait,
    /// Amount above 0 for the longer or fuller one.
    pub amount_mm: f64,
    /// Standard deviation of the amount, mm: that of the points by which the tape is laid; of a skin other than that of the
    /// built bodies also that of the standard body, whose shape is less than sure.
    pub sd_mm: f64,
}

impl FigureFound {
    /// True if the amount is more than two standard deviations.
    pub fn is_clear(&self) -> bool {
        self.amount_mm.abs() > 2.0 * self.sd_mm
    }

    pub fn name(&self) -> &'static str {
        self.of.name(self.amount_mm)
    }
}

/// Serialised as `trait`, `amount_mm`, `sd_mm` and, where the amount is clear, the name of the `figure`.
impl serde::Serialize for FigureFound {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let tenths = |value: f64| (10.0 * value).round() / 10.0;
        let mut fields = serializer.serialize_struct("FigureFound", 4)?;
        fields.serialize_field("trait", &self.of)?;
        fields.serialize_field("amount_mm", &tenths(self.amount_mm))?;
        fields.serialize_field("sd_mm", &tenths(self.sd_mm))?;
        fields.serialize_field("figure", &self.is_clear().then(|| self.name()))?;
        fields.end()
    }
}

/// Main measurements, which the standard body of a person shares. Across shoulder is none: on a scan the shoulder points
/// follow from the slope of the shoulders.
const MAIN: [Dimension; 5] =
    [Dimension::Stature, Dimension::ChestGirth, Dimension::WaistGirth, Dimension::HipGirth, Dimension::NeckGirth];

/// Finds the traits of an upright body, built or scanned, beside those of its standard body.
///
/// The standard body is built from stature and the girths of chest, waist, hip and neck, and for lengths also from the
/// height of the crotch and the girths of upper arm and thigh. All are read on both bodies by the same rules.
/// Traits that a body does not show are left out.
pub fn figures(body: &Body) -> Result<Vec<FigureFound>, BodyError> {
    of_mesh(&body.mesh, body.sex)
}

pub(crate) fn of_mesh(mesh: &TriMesh, sex: Sex) -> Result<Vec<FigureFound>, BodyError> {
    let (found, girths) = seen(mesh, sex)?;
    let main = known(&girths, sex, &MAIN);
    let expected = Profile::new(&main)?;
    let all: Vec<Dimension> = MAIN.into_iter().chain(DIMENSIONS.map(|(_, dimension, _)| dimension)).collect();
    let standard = build(&known(&girths, sex, &all)).or_else(|_| build(&main))?;
    let (usual, _) = seen(&standard.mesh, sex)?;
    let amount = |of: Trait| {
        let as_dimension = DIMENSIONS.iter().find(|(other, ..)| *other == of);
        match as_dimension {
            Some((_, dimension, sign)) => Some(sign * (girths.get(*dimension)? - expected.at(*dimension))),
            None => Some(found[of as usize]? - usual[of as usize]?),
        }
    };
    let scale = girths.get(Dimension::Stature).unwrap_or(USUAL_STATURE) / USUAL_STATURE;
    let is_ours = Template::of(sex).is_skin_of(mesh);
    let deviation = |of: Trait| DEVIATIONS[of as usize].hypot(if is_ours { 0.0 } else { SHAPES[of as usize] }) * scale;
    let told = |of: Trait| Some(FigureFound { of, amount_mm: mm(amount(of)?), sd_mm: mm(deviation(of)) });
    Ok(Trait::ALL.into_iter().filter_map(told).collect())
}

fn seen(mesh: &TriMesh, sex: Sex) -> Result<(ByTrait<Option<f64>>, Girths), BodyError> {
    let (sites, _) = sites::find_sites(mesh, Some(sex), Feet::BOTH)?;
    let girths = sites::girths_at(mesh, &sites)?;
    Ok((figure_tape::read(mesh, &sites, &girths, sex), girths))
}

fn known(girths: &Girths, sex: Sex, dimensions: &[Dimension]) -> Measurements {
    let mut known = Measurements::of(sex, f64::NAN);
    for &dimension in dimensions {
        let [least, greatest] = dimension.range();
        known.set(dimension, girths.get(dimension).filter(|value| (least..=greatest).contains(value)));
    }
    known
}

/// Standard deviations of the traits, m, on a body of 1.7 m: those of the points by which the tape is laid
/// ([`crate::measure::confidence`]). The crotch point for seat and abdomen, the back neck point for the upper back, the
/// nipples and the sides for the bust, the shoulder points for the shoulders.
const DEVIATIONS: ByTrait<f64> =
    [0.0040, 0.0040, 0.0030, 0.0060, 0.0040, 0.0035, 0.0040, 0.0050, 0.0040, 0.0015, 0.0040];
const USUAL_STATURE: f64 = 1.7;

/// Standard deviations of the standard body's shape from that of other people of its measurements, m, on a body of 1.7 m:
/// root mean squares of what is found on the six reference bodies, men and women, slim and heavy. Dimensions are beside
/// the survey, and flanks beside each other.
const SHAPES: ByTrait<f64> = [0.015, 0.014, 0.006, 0.005, 0.034, 0.009, 0.0065, 0.0, 0.0, 0.0, 0.0];

#[cfg(test)]
#[path = "figured_tests.rs"]
mod tests;

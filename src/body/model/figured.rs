//! Bodies with figures that a tailor alters for, and the figures of any body: its departures from the standard body, which
//! has the same main measurements and no figure.

use super::build::{self, build};
use super::fit::{self, Fit};
use crate::measure::{figure_tape, sites};
use crate::people::dimension::Dimension;
use crate::people::figures::{ByTrait, Figures, TRAITS, Trait};
use crate::people::profile::Profile;
use crate::repair::feet::Feet;
use crate::{Body, BodyError, Girths, Measurements};
use geom::TriMesh;
use geom::units::mm;

/// Traits that are a dimension, and sign of their amount in it. The body rise falls with the height of the crotch.
const DIMENSIONS: [(Trait, Dimension, f64); 3] = [
    (Trait::UpperArm, Dimension::UpperArmGirth, 1.0),
    (Trait::Thigh, Dimension::ThighGirth, 1.0),
    (Trait::Rise, Dimension::Inseam, -1.0),
];

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
/// # Errors
/// As [`build`], and [`BodyError::Figure`] for a figure that another given measurement decides, that the sex does not have,
/// or that the body cannot take.
///
/// # Examples
/// ```
/// use body::{Figures, Measurements, Sex};
///
/// let body = body::build_figured(&Measurements::of(Sex::Male, 1.78), &Figures::read(["flat_seat"])?)?;
/// let found = body::figures(&body)?;
/// let clear: Vec<_> = found.iter().filter(|found| found.is_clear()).map(|found| found.name()).collect();
/// assert_eq!(clear, [Some("flat_seat")]);
/// # Ok::<(), body::BodyError>(())
/// ```
pub fn build_figured(known: &Measurements, figures: &Figures) -> Result<Body, BodyError> {
    if figures.is_empty() {
        return build(known);
    }
    let profile = departed(known, figures)?;
    let asked: ByTrait<f64> =
        std::array::from_fn(|i| if is_dimension(Trait::ALL[i]) { 0.0 } else { figures.amount(Trait::ALL[i]) });
    bent(&profile, asked).and_then(build::describe).map_err(build::unformed)
}

fn is_dimension(of: Trait) -> bool {
    DIMENSIONS.iter().any(|(other, ..)| *other == of)
}

/// Profile of a person whose dimensions depart from their estimates by figures.
fn departed(known: &Measurements, figures: &Figures) -> Result<Profile, BodyError> {
    let mut profile = Profile::new(known)?;
    let refused = |of: Trait, problem: String, accepted: &str| {
        let figure = of.figure(figures.amount_mm(of)).unwrap_or_default().to_owned();
        BodyError::Figure { figure, problem, accepted: accepted.to_owned() }
    };
    for (of, dimension, sign) in DIMENSIONS {
        let amount = figures.amount(of);
        if amount != 0.0 && known.get(dimension).is_some() {
            let problem = format!("`{}` is given, and says it already", dimension.key());
            return Err(refused(of, problem, "one of them"));
        }
        if amount != 0.0 {
            profile.depart(dimension, sign * amount);
        }
    }
    if figures.amount(Trait::Bust) != 0.0 && known.sex == crate::Sex::Male {
        return Err(refused(Trait::Bust, "the body is a man's".to_owned(), "it for women"));
    }
    Ok(profile)
}

/// Fits a skin whose traits differ from those of the skin without bends by the amounts `asked`, m.
///
/// The dose of a trait changes by the error of its reading, until all traits are met, those of amount 0 too.
fn bent(profile: &Profile, asked: ByTrait<f64>) -> Result<Fit<'_>, BodyError> {
    let plain = fit::fit(profile, [0.0; TRAITS])?;
    if asked.iter().all(|amount| *amount == 0.0) {
        return Ok(plain);
    }
    let before = read(&plain);
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
    let Some(i) = unmet else { return Ok(fit) };
    let which = if asked[i] == 0.0 {
        (0..TRAITS).max_by(|&a, &b| asked[a].abs().total_cmp(&asked[b].abs())).unwrap_or(i)
    } else {
        i
    };
    let figure = Trait::ALL[which].figure(asked[which]).unwrap_or_default();
    Err(BodyError::Figure {
        figure: format!("{figure}={:.0}", mm(asked[which].abs())),
        problem: format!("{:.0} mm of it are reached on this body", mm((asked[i] - error[i]).abs())),
        accepted: "less of it".to_owned(),
    })
}

fn read(fit: &Fit<'_>) -> ByTrait<Option<f64>> {
    figure_tape::read(&fit.mesh, &fit.sites, &fit.girths, fit.figure.profile.sex)
}

/// Dose for a unit of each trait, on a body of mean measurements.
const GAINS: ByTrait<f64> = [1.0, 1.2, 1.0, 2.2, 2.5, 1.0, 1.0, 0.0, 0.0, 0.0, 1.0];

/// Trait of a body beside that of its standard body.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct FigureFound {
    /// Trait.
    #[serde(rename = "trait")]
    pub of: Trait,
    /// Amount, mm, above 0 for the longer or fuller one.
    pub amount_mm: f64,
    /// Standard deviation of the amount, mm: that of the tape, and of the points that it is laid by.
    pub sd_mm: f64,
}

impl FigureFound {
    /// True if the amount is more than two standard deviations.
    #[must_use]
    pub fn is_clear(&self) -> bool {
        self.amount_mm.abs() > 2.0 * self.sd_mm
    }

    /// Name of the figure, such as `flat_seat`. `None` where the trade has no name for it.
    #[must_use]
    pub fn name(&self) -> Option<&'static str> {
        self.of.figure(self.amount_mm)
    }
}

/// Main measurements, which the standard body of a person shares.
const MAIN: [Dimension; 6] = [
    Dimension::Stature,
    Dimension::ChestGirth,
    Dimension::WaistGirth,
    Dimension::HipGirth,
    Dimension::NeckGirth,
    Dimension::AcrossShoulder,
];

/// Finds the traits of an upright body, built or scanned, beside those of its standard body.
///
/// The standard body is built from stature, the girths of chest, waist, hip and neck, and across shoulder, and for lengths
/// also from the height of the crotch and the girths of upper arm and thigh. All are read on both bodies by the same rules.
/// Traits that a body does not show are left out.
///
/// # Errors
/// [`BodyError::MissingPart`] for a mesh that shows no standing person, and the errors of [`build`] where no standard body
/// has these measurements.
pub fn figures(body: &Body) -> Result<Vec<FigureFound>, BodyError> {
    let (found, girths) = seen(&body.mesh, body)?;
    let main = known(&girths, body, &MAIN);
    let expected = Profile::new(&main)?;
    let all: Vec<Dimension> = MAIN.into_iter().chain(DIMENSIONS.map(|(_, dimension, _)| dimension)).collect();
    let standard = build(&known(&girths, body, &all)).or_else(|_| build(&main))?;
    let (usual, _) = seen(&standard.mesh, body)?;
    let stature = girths.get(Dimension::Stature).unwrap_or_default();
    let amount = |of: Trait| {
        let as_dimension = DIMENSIONS.iter().find(|(other, ..)| *other == of);
        match as_dimension {
            Some((_, dimension, sign)) => Some(sign * (girths.get(*dimension)? - expected.at(*dimension))),
            None => Some(found[of as usize]? - usual[of as usize]?),
        }
    };
    let told = |of: Trait| {
        Some(FigureFound {
            of,
            amount_mm: mm(amount(of)?),
            sd_mm: mm(DEVIATIONS[of as usize] * stature / USUAL_STATURE),
        })
    };
    Ok(Trait::ALL.into_iter().filter_map(told).collect())
}

/// Readings of the traits on a mesh, and its girths.
fn seen(mesh: &TriMesh, body: &Body) -> Result<(ByTrait<Option<f64>>, Girths), BodyError> {
    let (sites, _) = sites::find_sites(mesh, Some(body.sex), Feet::BOTH)?;
    let girths = sites::girths_at(mesh, &sites)?;
    Ok((figure_tape::read(mesh, &sites, &girths, body.sex), girths))
}

fn known(girths: &Girths, body: &Body, dimensions: &[Dimension]) -> Measurements {
    let mut known = Measurements::of(body.sex, f64::NAN);
    for &dimension in dimensions {
        known.set(dimension, girths.get(dimension));
    }
    known
}

/// Standard deviations of the traits, m, on a body of 1.7 m: those of the points by which the tape is laid
/// ([`crate::measure::confidence`]). The crotch point for seat and abdomen, the back neck point for the upper back, the
/// nipples and the sides for the bust, the shoulder points for the shoulders.
const DEVIATIONS: ByTrait<f64> =
    [0.0040, 0.0040, 0.0030, 0.0060, 0.0040, 0.0035, 0.0040, 0.0050, 0.0040, 0.0015, 0.0040];
const USUAL_STATURE: f64 = 1.7;

#[cfg(test)]
#[path = "figured_tests.rs"]
mod tests;

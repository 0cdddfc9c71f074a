//! Fit of a figure: corrects its dimensions until the tape reads the requested measurements on its skin.

use super::figure_sites;
use super::limb_tape::LimbSites;
use super::template::Template;
use crate::measure::girths::Girths;
use crate::measure::sites::{self, Sites};
use crate::measure::tape::Neck;
use crate::people::dimension::{COUNT, Dimension};
use crate::people::figures::{ByTrait, TRAITS};
use crate::people::profile::Profile;
use crate::shape::figure::{Factors, Figure};
use crate::{BodyError, Sex};
use geom::TriMesh;
use std::sync::LazyLock;

/// Greatest number of rounds, and of corrections in each. Levels of the tape are fixed in a round. Judgement.
const ROUNDS: usize = 6;
const CORRECTIONS: usize = 6;

/// Error that ends the corrections of a round, and error with new levels that ends the fit, m: below those accepted.
const CORRECTED: f64 = 3e-4;
const FITTED: f64 = 8e-4;

/// Greatest accepted deviation of a girth, and of a length, from the request, m. Judgement: at most the error of a
/// measurer ([`crate::people::likely`]).
const GIRTH_TOLERANCE: f64 = 2e-3;
const LENGTH_TOLERANCE: f64 = 5e-3;

#[derive(Clone)]
pub(super) struct Fit<'a> {
    pub figure: Figure<'a>,
    pub mesh: TriMesh,
    pub sites: Sites,
    pub girths: Girths,
}

/// Takes as `doses` the strengths of the bends by which the body departs from the standard body.
pub(super) fn fit(profile: &Profile, doses: ByTrait<f64>) -> Result<Fit<'_>, BodyError> {
    static MALE: LazyLock<Factors> = LazyLock::new(|| start(Sex::Male));
    static FEMALE: LazyLock<Factors> = LazyLock::new(|| start(Sex::Female));
    let factors = match profile.sex {
        Sex::Male => &MALE,
        Sex::Female => &FEMALE,
    };
    fit_from(profile, **factors, doses)
}

/// Factors for the template's person: a good start for others, as the difference of skin and figure varies little.
fn start(sex: Sex) -> Factors {
    let person = Template::person(sex);
    fit_from(&person, [1.0; COUNT], [0.0; TRAITS]).map_or([1.0; COUNT], |fit| fit.figure.factors)
}

fn fit_from(profile: &Profile, factors: Factors, doses: ByTrait<f64>) -> Result<Fit<'_>, BodyError> {
    let template = Template::of(profile.sex);
    let figure = Figure { factors, doses, ..Figure::new(profile) };
    let mesh = template.dress(&figure);
    let sites = figure_sites::find(&mesh, &figure)?;
    let girths = read(&mesh, &figure, &sites)?;
    let mut fit = Fit { figure, mesh, sites, girths };
    for round in 0..ROUNDS {
        for _ in 0..CORRECTIONS {
            if fit.worst(profile).is_none_or(|worst| worst.off().abs() < CORRECTED) {
                break;
            }
            fit.correct(profile, template)?;
        }
        let found = figure_sites::find(&fit.mesh, &fit.figure)?;
        let girths = read(&fit.mesh, &fit.figure, &found)?;
        let anew = Fit { sites: found, girths, ..fit.clone() };
        if anew.worst(profile).is_none_or(|worst| worst.off().abs() < FITTED) {
            return Ok(anew);
        }
        // The mean with the last levels ends oscillations between levels and corrections.
        let sites = if round == 0 { anew.sites } else { half_way(&fit.sites, anew.sites) };
        fit.hold(sites)?;
    }
    for _ in 0..CORRECTIONS {
        fit.correct(profile, template)?;
    }
    let unmet =
        errors(profile, &fit.girths).into_iter().find(|error| profile.is_given(error.dimension) && error.is_unmet());
    unmet.map_or(Ok(fit), |error| Err(error.refusal()))
}

impl Fit<'_> {
    fn worst(&self, profile: &Profile) -> Option<Fitted> {
        let asked = errors(profile, &self.girths).into_iter().filter(|error| error.is_asked(profile));
        asked.max_by(|a, b| a.off().abs().total_cmp(&b.off().abs()))
    }

    /// Multiplies every dimension by requested / read value, with fixed levels.
    fn correct(&mut self, profile: &Profile, template: &Template) -> Result<(), BodyError> {
        for error in errors(profile, &self.girths) {
            self.figure.adjust(error.dimension, error.asked / error.read);
        }
        self.mesh = template.dress(&self.figure);
        self.hold(self.sites.clone())
    }

    fn hold(&mut self, levels: Sites) -> Result<(), BodyError> {
        self.sites = figure_sites::hold(&self.mesh, &self.figure, &levels)?;
        self.girths = read(&self.mesh, &self.figure, &self.sites)?;
        Ok(())
    }
}

fn half_way(a: &Sites, b: Sites) -> Sites {
    let middle = |a: f64, b: f64| (a + b) / 2.0;
    Sites {
        chest: middle(a.chest, b.chest),
        underbust: middle(a.underbust, b.underbust),
        hip: middle(a.hip, b.hip),
        neck: Neck {
            centre: a.neck.centre.lerp(&b.neck.centre, 0.5),
            height: middle(a.neck.height, b.neck.height),
            lean: middle(a.neck.lean, b.neck.lean),
            ..b.neck
        },
        ..b
    }
}

/// Dimensions that are fitted even if they are only estimated.
const MAIN: [Dimension; 5] = [
    Dimension::NeckGirth,
    Dimension::ChestGirth,
    Dimension::WaistGirth,
    Dimension::HipGirth,
    Dimension::AcrossShoulder,
];

fn read(mesh: &TriMesh, figure: &Figure, sites: &Sites) -> Result<Girths, BodyError> {
    let mut girths = sites::girths_at(mesh, sites)?;
    LimbSites::of(figure, sites).read(mesh, &mut girths);
    Ok(girths)
}

/// A fitted measurement: requested and read value, m.
struct Fitted {
    dimension: Dimension,
    asked: f64,
    read: f64,
}

impl Fitted {
    fn off(&self) -> f64 {
        self.read - self.asked
    }

    /// True if the measurement must be met: it is given, or one of [`MAIN`].
    fn is_asked(&self, profile: &Profile) -> bool {
        profile.is_given(self.dimension) || MAIN.contains(&self.dimension)
    }

    fn is_unmet(&self) -> bool {
        self.off().abs() > self.tolerance()
    }

    fn tolerance(&self) -> f64 {
        match self.dimension {
            Dimension::AcrossShoulder | Dimension::Inseam | Dimension::ArmLength => LENGTH_TOLERANCE,
            _ => GIRTH_TOLERANCE,
        }
    }

    fn refusal(&self) -> BodyError {
        let Self { dimension, asked, read } = self;
        let [asked, read] = [asked, read].map(|metres| metres * 1e3);
        BodyError::Inconsistent {
            reason: format!("{} of {asked:.0} mm was asked, {read:.0} mm is reached", dimension.name()),
        }
    }
}

/// Dimensions of a figure that are corrected. Of several that are not reached, the first is reported.
const CORRECTED_BY: [Dimension; 15] = {
    use Dimension::*;
    [
        NeckGirth,
        ChestGirth,
        UnderbustGirth,
        WaistGirth,
        HipGirth,
        AcrossShoulder,
        ThighGirth,
        KneeGirth,
        CalfGirth,
        AnkleGirth,
        UpperArmGirth,
        ForearmGirth,
        WristGirth,
        Inseam,
        ArmLength,
    ]
};

/// Requested and read value of all corrected dimensions, but for an under-bust girth that is not given.
fn errors(profile: &Profile, read: &Girths) -> Vec<Fitted> {
    let counts = |dimension: &Dimension| *dimension != Dimension::UnderbustGirth || profile.is_given(*dimension);
    let fitted = |dimension| Some(Fitted { dimension, asked: profile.at(dimension), read: read.get(dimension)? });
    CORRECTED_BY.into_iter().filter(counts).filter_map(fitted).collect()
}

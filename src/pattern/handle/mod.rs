//! Handles: parametric changes of a pattern as a fit technologist makes them, such as moving a side seam at the waist
//! or the depth of the neck.
//!
//! No seam file names the handles of a style: `body` finds the movable parts by the roles of the pieces. Each handle
//! makes a `Plan` (in `girths`, `waist`, `lengths`, `upper`, `across`, `sleeve` or `seat`): points that move with the
//! amount, points that give way, and conditions on lengths. `rig` interpolates the displacement along the outlines, and `solve` finds how
//! far each point gives way. `darts_and_bands` makes darts and bands follow, and `field` the inside of the pieces.

mod across;
mod body;
mod darts_and_bands;
mod drawn;
mod error;
mod field;
mod girths;
mod kind;
mod lengths;
mod meshed;
mod plan;
mod restyle;
mod rig;
mod seat;
mod sleeve;
mod solve;
#[cfg(test)]
mod tests;
mod upper;
mod waist;

pub(crate) use self::drawn::with_corners;
pub use self::drawn::{Redrawn, outlines_apart_m};
pub use self::error::HandleError;
pub use self::kind::Handle;
pub(crate) use self::solve::least_step;

use std::collections::BTreeMap;
use std::ops::Range;

use self::body::Body;
use self::field::Field;
use self::plan::Plan;
use crate::pom::anatomy::Anatomy;
use crate::pom::{Point, PointOfMeasure};
use crate::propose::Face;
use crate::style::Style;
use geom::units::mm;

/// Limit either way. A larger change would make another garment.
const MOST_M: f64 = 0.3;
/// Greatest change of the length difference of the sides of a seam, and residual of a condition on lengths.
const PAIRED_M: f64 = 0.1e-3;

/// Tolerance on the change of the point of measure of `Handle::aim`, and greatest number of iterations.
const AIMED_M: f64 = 1e-6;
const MOST_AIMS: usize = 8;
/// Range of `amount / change` within which the displacement is rescaled. Beyond it, the point of measure has jumped to
/// another place.
const AIM_RATIOS: Range<f64> = 0.5..2.0;

/// Limit for an amount at which the sides of a seam do not stay equally long.
const HALVINGS: u32 = 2;

type Fields = BTreeMap<usize, Field>;
struct Change {
    style: Style,
    fields: Fields,
}

struct Course {
    style: Style,
    steps: Vec<Fields>,
}

impl Handle {
    /// Point of measure that must change by exactly the amount, found by iteration. `None` if moving the points
    /// suffices.
    fn aim(self, body: &Body<'_>) -> Option<Point> {
        match self {
            // The waist of a top is at its narrowest girth, whose level shifts.
            Self::Waist if body.trunk.is_none() => Some(Point::HalfWaist),
            Self::Bust => Some(Point::HalfChest),
            Self::Hip => Some(Point::HalfHip),
            Self::Hem => Some(Point::HalfHem),
            Self::Thigh => Some(Point::HalfThigh),
            Self::Knee => Some(Point::HalfKnee),
            Self::LegOpening => Some(Point::HalfLegOpening),
            Self::NeckWidth => Some(Point::NeckWidth),
            Self::Bicep => Some(Point::HalfBicep),
            Self::Cuff => Some(Point::HalfCuff),
            _ => None,
        }
    }

    fn plan(self, body: &Body<'_>) -> Option<Plan> {
        match self {
            Self::Chest | Self::Waist | Self::Hip | Self::Hem | Self::Thigh | Self::Knee | Self::LegOpening => {
                girths::plan(body, self)
            }
            Self::Darts => waist::darts(body),
            Self::CentreBack => waist::centre_back(body),
            Self::Fork => seat::fork(body),
            Self::Seat => seat::wedge(body, &seat::SEAT),
            Self::Abdomen => seat::wedge(body, &seat::ABDOMEN),
            Self::Rise => seat::depth(body),
            Self::FrontRise => seat::rise(body, Face::Front),
            Self::BackRise => seat::rise(body, Face::Back),
            Self::LegLength => lengths::leg_length(body),
            Self::ShoulderSlope => upper::shoulder_slope(body),
            Self::ForwardShoulder => upper::forward_shoulder(body),
            Self::ShoulderLength => upper::shoulder_length(body),
            Self::FrontWidth => across::width(body, Face::Front),
            Self::BackWidth => across::width(body, Face::Back),
            Self::UpperBack => across::upper_back(body),
            Self::Bust => across::bust(body),
            Self::SwayBack => across::sway_back(body),
            Self::FrontNeckDepth => upper::neck_depth(body, Face::Front),
            Self::BackNeckDepth => upper::neck_depth(body, Face::Back),
            Self::NeckWidth => upper::neck_width(body),
            Self::ArmholeDepth => upper::armhole_depth(body),
            Self::Bicep => sleeve::bicep(body),
            Self::Cuff => sleeve::cuff(body),
            Self::CapHeight => sleeve::cap_height(body),
            Self::SleeveLength => lengths::sleeve_length(body),
            Self::BodyLength => lengths::body_length(body),
            Self::FrontLength => lengths::face_length(body, Face::Front),
            Self::BackLength => lengths::face_length(body, Face::Back),
            Self::SkirtLength => lengths::skirt_length(body),
        }
    }
}

impl Style {
    /// Applicable handles, as far as the roles of the pieces show, in the order of [`Handle::ALL`].
    pub fn handles(&self) -> Vec<Handle> {
        let anatomy = Anatomy::of(self);
        let body = Body::of(&anatomy, &self.points_of_measure());
        Handle::ALL.into_iter().filter(|handle| handle.plan(&body).is_some()).collect()
    }

    /// Applies handles with their amounts, m, one after the other.
    ///
    /// # Examples
    /// ```
    /// use pattern::{Handle, Style, draft::Model};
    ///
    /// let medium = &Model::Tshirt.drafts()[1];
    /// let style = Style::read(&medium.pieces, Model::Tshirt.seams(), "tshirt.seams.toml")?;
    /// let changed = style.moved(&[(Handle::Waist, -0.008), (Handle::FrontNeckDepth, 0.005)])?;
    /// let half_hem = |style: &Style| style.points_of_measure().iter().find(|p| p.point.as_str() == "half_hem").map(|p| p.length_m);
    /// assert_eq!(half_hem(&changed).map(|m| (1e4 * m).round()), half_hem(&style).map(|m| (1e4 * m).round()));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn moved(&self, handles: &[(Handle, f64)]) -> Result<Self, HandleError> {
        let mut style = self.clone();
        for &(handle, amount_m) in handles {
            style = style.moved_in_steps(handle, amount_m, HALVINGS)?.style;
        }
        Ok(style)
    }

    /// Halves the amount up to `halvings` times if the two sides of a seam do not stay equally long.
    fn moved_in_steps(&self, handle: Handle, amount_m: f64, halvings: u32) -> Result<Course, HandleError> {
        let halves = || -> Result<Course, HandleError> {
            let Course { style, mut steps } = self.moved_in_steps(handle, 0.5 * amount_m, halvings - 1)?;
            let rest = style.moved_in_steps(handle, 0.5 * amount_m, halvings - 1)?;
            steps.extend(rest.steps);
            Ok(Course { style: rest.style, steps })
        };
        match self.moved_by(handle, amount_m) {
            Err(parted @ HandleError::Length { .. }) if halvings > 0 => halves().map_err(|_| parted),
            other => other.map(|Change { style, fields }| Course { style, steps: vec![fields] }),
        }
    }

    fn moved_by(&self, handle: Handle, amount_m: f64) -> Result<Change, HandleError> {
        if !(-MOST_M..=MOST_M).contains(&amount_m) {
            return Err(HandleError::Amount { handle, amount_mm: mm(amount_m), most_mm: mm(MOST_M) });
        }
        let anatomy = Anatomy::of(self);
        let points = self.points_of_measure();
        let body = Body::of(&anatomy, &points);
        let Some(mut plan) = handle.plan(&body) else {
            let accepted: Vec<&str> = self.handles().iter().map(|handle| handle.as_str()).collect();
            return Err(HandleError::Absent { style: self.name.clone(), handle, accepted: accepted.join(", ") });
        };
        if amount_m == 0.0 {
            return Ok(Change { style: self.clone(), fields: BTreeMap::new() });
        }
        darts_and_bands::darts(&body, &mut plan);
        darts_and_bands::bands(&body, &mut plan);
        let fine = solve::refined(self, &plan);
        let length_m = |points: &[PointOfMeasure]| {
            handle
                .aim(&body)
                .and_then(|aim| points.iter().find(|measure| measure.point == aim))
                .map(|measure| measure.length_m)
        };
        let before_m = length_m(&points);
        let mut driven_m = amount_m;
        let mut change = self.driven(&fine, &plan, handle, [amount_m, driven_m])?;
        for _ in 0..MOST_AIMS {
            let after_m = length_m(&change.style.points_of_measure());
            let Some(changed_m) = after_m.zip(before_m).map(|(after, before)| after - before) else { break };
            let ratio = amount_m / changed_m;
            if (changed_m - amount_m).abs() < AIMED_M || !AIM_RATIOS.contains(&ratio) {
                break;
            }
            driven_m *= ratio;
            change = self.driven(&fine, &plan, handle, [amount_m, driven_m])?;
        }
        Ok(change)
    }

    /// `driven_m` is chosen so that the measure changes by `amount_m`.
    fn driven(
        &self,
        fine: &Self,
        plan: &Plan,
        handle: Handle,
        [amount_m, driven_m]: [f64; 2],
    ) -> Result<Change, HandleError> {
        let amount_mm = mm(amount_m);
        let solved = solve::solved(fine, plan, driven_m);
        let off = |place: String, off_m: f64, what: &str| HandleError::Length {
            handle,
            amount_mm,
            place,
            found: format!("{what} {:.2} mm", mm(off_m)),
            within_mm: mm(PAIRED_M),
        };
        let not_held = |off_m: f64| off_m.is_nan() || off_m.abs() > PAIRED_M;
        let worst = solved.seams.iter().max_by(|seam, other| seam.off_m.abs().total_cmp(&other.off_m.abs()));
        if let Some(worst) = worst.filter(|seam| not_held(seam.off_m)) {
            return Err(off(
                self.seam_words(worst.seam),
                worst.off_m,
                "what is sewn on does not follow: its sides come apart by",
            ));
        }
        if let Some((number, off_m)) = solved.conditions_m.iter().enumerate().find(|(_, off_m)| not_held(**off_m)) {
            let edges = plan.conditions[number].terms.iter().map(|term| self.edge_name(term.span.edge));
            return Err(off(edges.collect::<Vec<_>>().join(", "), *off_m, "the length cannot be kept: it is off by"));
        }
        let Change { style, fields } = restyle::with_lines(fine, solved.lines);
        if let Some((piece, at)) = restyle::new_crossing(self, &style) {
            return Err(HandleError::Crossing { handle, amount_mm, piece, u_mm: mm(at.x), v_mm: mm(at.y) });
        }
        Ok(Change { style, fields })
    }

    fn seam_words(&self, number: usize) -> String {
        let seam = &self.seams[number];
        let side = |edges: &[crate::style::EdgeRef]| {
            edges.iter().map(|edge| self.edge_name(*edge)).collect::<Vec<_>>().join(" + ")
        };
        format!("seam `{}` of {} and {}", seam.name, side(&seam.a), side(&seam.b))
    }
}

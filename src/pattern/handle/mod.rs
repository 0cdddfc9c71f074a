//! Handles: what a fit technologist takes hold of to change a pattern, such as a side seam at the waist or the depth of the neck.
//!
//! No seam file has to name them: `body` finds by the roles of the pieces what there is to take hold of. Each handle is a `Plan`: places
//! that move with the amount (`girths`, `lengths`, `upper`, `sleeve`, `seat`), places that give way, and lengths that hold. `rig` carries
//! the outlines along, `solve` finds how far what gives way moves, `follow` takes darts and bands along, and `field` what lies inside.

mod body;
mod drawn;
mod field;
mod follow;
mod girths;
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

pub use self::drawn::{Redrawn, redrawn};

use std::collections::BTreeMap;
use std::ops::Range;

use self::body::Body;
use self::field::Field;
use self::plan::Plan;
use crate::pom::anatomy::Anatomy;
use crate::pom::{Point, PointOfMeasure};
use crate::propose::Face;
use crate::seams::StyleError;
use crate::style::Style;
use geom::units::mm;

/// Greatest amount of a handle either way, m: more is another garment.
const MOST_M: f64 = 0.3;
/// By how much more than before the sides of a seam may differ, and a length that holds may change, m.
const PAIRED_M: f64 = 0.1e-3;

/// How near to its amount a handle changes the point of measure that it aims at, m, and most tries.
const AIMED_M: f64 = 1e-6;
const MOST_AIMS: usize = 8;
/// Ratios of an amount to what it changes within which it is aimed: beyond, the point of measure lies elsewhere after the change.
const AIM_RATIOS: Range<f64> = 0.5..2.0;

/// How often a way is halved at most on which the sides of a seam part.
const HALVINGS: u32 = 2;

/// How each piece that changed did.
type Fields = BTreeMap<usize, Field>;
/// A style changed by a handle, and how.
type Change = (Style, Fields);

/// A handle by its name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Handle {
    /// Half of the girth at the chest.
    Chest,
    /// Half of the girth at the waist.
    Waist,
    /// Half of the girth at the hip.
    Hip,
    /// Half of the lower edge.
    Hem,
    /// Half of the girth of a leg at the thigh, by its outseam.
    Thigh,
    /// Half of the girth of a leg at the knee.
    Knee,
    /// Half of the lower edge of a leg.
    LegOpening,
    /// Half of the girth of a leg at the fork, by its inseam.
    Fork,
    /// Length of the seat seam in front.
    FrontRise,
    /// Length of the seat seam behind.
    BackRise,
    /// Length of the inseam.
    LegLength,
    /// Height of the shoulder point.
    ShoulderSlope,
    /// Length of the shoulder.
    ShoulderLength,
    /// Depth of the neck in front.
    FrontNeckDepth,
    /// Depth of the neck behind.
    BackNeckDepth,
    /// Width of the neck.
    NeckWidth,
    /// Depth of the armhole.
    ArmholeDepth,
    /// Half of the girth of the sleeve at the bicep.
    Bicep,
    /// Half of the lower edge of the sleeve.
    Cuff,
    /// Height of the sleeve's cap.
    CapHeight,
    /// Length of the sleeve.
    SleeveLength,
    /// Length of front and back.
    BodyLength,
    /// Length of the front in its middle.
    FrontLength,
    /// Length of the back in its middle.
    BackLength,
    /// Length of the skirt.
    SkirtLength,
}

impl Handle {
    /// All, in the order of a list.
    pub const ALL: [Self; 25] = [
        Self::Chest,
        Self::Waist,
        Self::Hip,
        Self::Hem,
        Self::Thigh,
        Self::Knee,
        Self::LegOpening,
        Self::Fork,
        Self::FrontRise,
        Self::BackRise,
        Self::LegLength,
        Self::ShoulderSlope,
        Self::ShoulderLength,
        Self::FrontNeckDepth,
        Self::BackNeckDepth,
        Self::NeckWidth,
        Self::ArmholeDepth,
        Self::Bicep,
        Self::Cuff,
        Self::CapHeight,
        Self::SleeveLength,
        Self::BodyLength,
        Self::FrontLength,
        Self::BackLength,
        Self::SkirtLength,
    ];

    /// Name, and what a positive amount does.
    const fn words(self) -> (&'static str, &'static str) {
        match self {
            Self::Chest => (
                "chest",
                "half of the girth 25 mm below the armhole wider: both side seams out from there up to the underarm points; armholes \
                 lengthen below their middle and sleeves follow at the underarm",
            ),
            Self::Waist => (
                "waist",
                "half of the waist wider: side seams or outseams out there; of a dress bodice and skirt alike; a waistband follows",
            ),
            Self::Hip => ("hip", "half of the girth at the hip wider: side seams or outseams out there"),
            Self::Hem => ("hem", "half of the lower edge wider: both side seams out there"),
            Self::Thigh => ("thigh", "half of the leg 25 mm below the fork wider: outseams out there"),
            Self::Knee => ("knee", "half of the leg at the knee wider: inseams and outseams out there"),
            Self::LegOpening => ("leg_opening", "half of the leg's lower edge wider: inseams and outseams out there"),
            Self::Fork => (
                "fork",
                "half of the leg at the fork wider: forks of front and back out, inseams with them down to the thigh; the seat seams \
                 lengthen by it",
            ),
            Self::FrontRise => (
                "front_rise",
                "front seat seam longer: the upper edge higher there, as before at the outseams, and as long",
            ),
            Self::BackRise => (
                "back_rise",
                "back seat seam longer: the upper edge higher there, as before at the outseams, and as long",
            ),
            Self::LegLength => {
                ("leg_length", "inseam longer: legs lengthen evenly between fork and lower edge, outseams with them")
            }
            Self::ShoulderSlope => (
                "shoulder_slope",
                "shoulder points lower, front and back: the shoulder keeps its length, the armhole keeps its own and sinks with it",
            ),
            Self::ShoulderLength => {
                ("shoulder_length", "shoulder longer: shoulder points outwards along it; the armhole keeps its length")
            }
            Self::FrontNeckDepth => ("front_neck_depth", "neckline lower at centre front"),
            Self::BackNeckDepth => ("back_neck_depth", "neckline lower at centre back"),
            Self::NeckWidth => (
                "neck_width",
                "neck wider: high points of the shoulder outwards along it, each by half; the shoulder shortens",
            ),
            Self::ArmholeDepth => (
                "armhole_depth",
                "underarm points lower along the side seam; the sleeve's underarm points as far down the arm, and across it until the \
                 cap fits",
            ),
            Self::Bicep => (
                "bicep",
                "half of the sleeve 25 mm below the armhole wider: its underarm points out, and up until the cap is as long as before",
            ),
            Self::Cuff => ("cuff", "half of the sleeve's lower edge wider: the underarm seam out there"),
            Self::CapHeight => (
                "cap_height",
                "cap higher: the sleeve's underarm points down the arm, and inwards until the cap is as long as before",
            ),
            Self::SleeveLength => ("sleeve_length", "sleeve longer, evenly between underarm and lower edge"),
            Self::BodyLength => (
                "body_length",
                "front and back longer: slashed straight across below the armhole, side seams with them",
            ),
            Self::FrontLength => (
                "front_length",
                "front longer in its middle: the lower edge falls between the high points of the shoulder, and not at the side seams",
            ),
            Self::BackLength => (
                "back_length",
                "back longer in its middle: the lower edge falls between the high points of the shoulder, and not at the side seams",
            ),
            Self::SkirtLength => {
                ("skirt_length", "skirt longer: slashed straight across below the hip, side seams with it")
            }
        }
    }

    /// Name in tables and files.
    #[must_use]
    pub const fn as_str(self) -> &'static str {
        self.words().0
    }

    /// What a positive amount does.
    #[must_use]
    pub const fn definition(self) -> &'static str {
        self.words().1
    }

    /// Whether the amount is that of half of a girth: the girth changes by twice as much.
    #[must_use]
    pub const fn is_half_girth(self) -> bool {
        use Handle::*;
        matches!(self, Chest | Waist | Hip | Hem | Thigh | Knee | LegOpening | Fork | Bicep | Cuff)
    }

    /// The handle of a name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|handle| handle.as_str() == name)
    }

    /// The point of measure that changes by just the amount, of a handle whose places alone do not tell it.
    fn aim(self, body: &Body<'_>) -> Option<Point> {
        match self {
            // The waist of a top is where it is narrowest, and that goes elsewhere.
            Self::Waist if body.trunk.is_none() => Some(Point::HalfWaist),
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

    /// The point of measure that changes by the amount, of a handle that changes one by just that.
    #[must_use]
    pub const fn changes(self) -> Option<Point> {
        Some(match self {
            Self::Chest => Point::HalfChest,
            Self::Waist => Point::HalfWaist,
            Self::Hip => Point::HalfHip,
            Self::Hem => Point::HalfHem,
            Self::Thigh => Point::HalfThigh,
            Self::Knee => Point::HalfKnee,
            Self::LegOpening => Point::HalfLegOpening,
            Self::FrontRise => Point::FrontRise,
            Self::BackRise => Point::BackRise,
            Self::LegLength => Point::Inseam,
            Self::ShoulderLength => Point::Shoulder,
            Self::FrontNeckDepth => Point::FrontNeckDrop,
            Self::BackNeckDepth => Point::BackNeckDrop,
            Self::NeckWidth => Point::NeckWidth,
            Self::Bicep => Point::HalfBicep,
            Self::Cuff => Point::HalfCuff,
            Self::SleeveLength => Point::SleeveLength,
            Self::BodyLength | Self::SkirtLength => Point::CentreBackLength,
            _ => return None,
        })
    }

    fn plan(self, body: &Body<'_>) -> Option<Plan> {
        match self {
            Self::Chest | Self::Waist | Self::Hip | Self::Hem | Self::Thigh | Self::Knee | Self::LegOpening => {
                girths::plan(body, self)
            }
            Self::Fork => seat::fork(body),
            Self::FrontRise => seat::rise(body, Face::Front),
            Self::BackRise => seat::rise(body, Face::Back),
            Self::LegLength => lengths::leg_length(body),
            Self::ShoulderSlope => upper::shoulder_slope(body),
            Self::ShoulderLength => upper::shoulder_length(body),
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

/// Why a style cannot be changed by a handle.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum HandleError {
    /// An amount that is no such length.
    #[error("handle `{handle}`: {amount_mm:.1} mm; accepted: -{most_mm} to {most_mm} mm", handle = .handle.as_str())]
    Amount {
        /// Handle that was to be moved.
        handle: Handle,
        /// Amount asked for, mm.
        amount_mm: f64,
        /// Greatest accepted either way, mm.
        most_mm: f64,
    },
    /// A handle that the style does not have.
    #[error("style `{style}`: there is no handle `{handle}`; there is: {accepted}", handle = .handle.as_str())]
    Absent {
        /// Name of the style.
        style: String,
        /// Handle that was asked for.
        handle: Handle,
        /// Handles that it has.
        accepted: String,
    },
    /// A partner that cannot follow, or a length that cannot hold.
    #[error(
        "handle `{handle}` by {amount_mm:.1} mm: {place}: {found}; accepted: a change within {within_mm} mm", handle = .handle.as_str()
    )]
    Length {
        /// Handle that was moved.
        handle: Handle,
        /// Amount asked for, mm.
        amount_mm: f64,
        /// Seam with its edges, or edges.
        place: String,
        /// By how much it is off.
        found: String,
        /// What would be accepted, mm.
        within_mm: f64,
    },
    /// An outline that would cross itself.
    #[error(
        "handle `{handle}` by {amount_mm:.1} mm: the outline of piece `{piece}` crosses itself at ({u_mm:.0}, {v_mm:.0}) mm; accepted: an \
         amount that leaves it free of crossings", handle = .handle.as_str()
    )]
    Crossing {
        /// Handle that was moved.
        handle: Handle,
        /// Amount asked for, mm.
        amount_mm: f64,
        /// Identifier of the piece whose outline crosses itself.
        piece: String,
        /// First coordinate of the crossing in the piece's plane, mm.
        u_mm: f64,
        /// Second coordinate of the crossing in the piece's plane, mm.
        v_mm: f64,
    },
    /// A piece that is drawn once and worn twice, and would have to change in two ways.
    #[error(
        "block `{block}` is worn in several ways, which change it differently by {apart_mm:.2} mm; accepted: a block each"
    )]
    Drawn {
        /// Name of the block in the pattern file.
        block: String,
        /// How far apart both changes are, mm.
        apart_mm: f64,
    },
    /// Pieces and a seam file that make no style.
    #[error(transparent)]
    Style(#[from] StyleError),
}

impl HandleError {
    /// The handle that cannot be applied, where it is one.
    #[must_use]
    pub const fn handle(&self) -> Option<Handle> {
        match self {
            Self::Amount { handle, .. }
            | Self::Absent { handle, .. }
            | Self::Length { handle, .. }
            | Self::Crossing { handle, .. } => Some(*handle),
            Self::Drawn { .. } | Self::Style(_) => None,
        }
    }
}

impl Style {
    /// The handles that the style has, in the order of [`Handle::ALL`]. What cannot be told by the roles of its pieces is left out.
    #[must_use]
    pub fn handles(&self) -> Vec<Handle> {
        let anatomy = Anatomy::of(self);
        let body = Body::of(&anatomy, &self.points_of_measure());
        Handle::ALL.into_iter().filter(|handle| handle.plan(&body).is_some()).collect()
    }

    /// The style changed by handles with their amounts, m, one after the other.
    ///
    /// # Errors
    /// [`HandleError`] of a handle that the style does not have, of a seam whose other side cannot follow, and of an outline that would
    /// cross itself.
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
            style = style.moved_in_steps(handle, amount_m, HALVINGS)?.0;
        }
        Ok(style)
    }

    /// The style changed by one handle, and how each piece that changed did, step by step: where the sides of a seam part over a long way,
    /// they may not over two halves of it.
    fn moved_in_steps(&self, handle: Handle, amount_m: f64, halvings: u32) -> Result<(Self, Vec<Fields>), HandleError> {
        let halves = || -> Result<(Self, Vec<Fields>), HandleError> {
            let (style, mut fields) = self.moved_in_steps(handle, 0.5 * amount_m, halvings - 1)?;
            let (style, others) = style.moved_in_steps(handle, 0.5 * amount_m, halvings - 1)?;
            fields.extend(others);
            Ok((style, fields))
        };
        match self.moved_by(handle, amount_m) {
            Err(parted @ HandleError::Length { .. }) if halvings > 0 => halves().map_err(|_| parted),
            other => other.map(|(style, fields)| (style, vec![fields])),
        }
    }

    /// The style changed by one handle, and how each piece that changed did.
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
            return Ok((self.clone(), BTreeMap::new()));
        }
        follow::darts(&body, &mut plan);
        follow::bands(&body, &mut plan);
        let fine = solve::refined(self, &plan);
        let length_m = |points: &[PointOfMeasure]| {
            handle.aim(&body).and_then(|aim| points.iter().find(|one| one.point == aim)).map(|one| one.length_m)
        };
        let before_m = length_m(&points);
        let mut driven_m = amount_m;
        let mut change = self.driven(&fine, &plan, handle, [amount_m, driven_m])?;
        for _ in 0..MOST_AIMS {
            let after_m = length_m(&change.0.points_of_measure());
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

    /// The style changed by a plan that moves its places by `driven_m` for a handle's amount, m.
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
        let worst = solved.seams_m.iter().max_by(|one, other| one.1.abs().total_cmp(&other.1.abs()));
        if let Some((number, off_m)) = worst.filter(|(_, off_m)| not_held(*off_m)) {
            return Err(off(
                self.seam_words(*number),
                *off_m,
                "what is sewn on does not follow: its sides come apart by",
            ));
        }
        if let Some((number, off_m)) = solved.conditions_m.iter().enumerate().find(|(_, off_m)| not_held(**off_m)) {
            let edges = plan.conditions[number].spans.iter().map(|(span, _)| self.edge_name(span.edge));
            return Err(off(edges.collect::<Vec<_>>().join(", "), *off_m, "the length cannot be kept: it is off by"));
        }
        let (style, fields) = restyle::with_lines(fine, solved.lines);
        if let Some((piece, at)) = restyle::new_crossing(self, &style) {
            return Err(HandleError::Crossing { handle, amount_mm, piece, u_mm: mm(at.x), v_mm: mm(at.y) });
        }
        Ok((style, fields))
    }

    /// A seam with its edges, for messages.
    fn seam_words(&self, number: usize) -> String {
        let seam = &self.seams[number];
        let side = |edges: &[crate::style::EdgeRef]| {
            edges.iter().map(|edge| self.edge_name(*edge)).collect::<Vec<_>>().join(" + ")
        };
        format!("seam `{}` of {} and {}", seam.name, side(&seam.a), side(&seam.b))
    }
}

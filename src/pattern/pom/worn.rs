//! Girths of a garment where the body that is to wear it has its levels: all that its ease needs, before anything is draped.
//!
//! A top hangs from the side neck points, a skirt from the waist; the fork of trousers lies at the crotch.

use super::anatomy::Anatomy;
use super::legs::Legs;
use super::top::Trunk;
use super::{Garb, Point, PointOfMeasure};
use crate::style::{PathPart, Style};

/// Heights of a standing body's levels above the floor, and distances along its arm from the shoulder point; m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stand {
    /// Side neck points.
    pub side_neck_m: f64,
    /// Under the bust.
    pub underbust_m: f64,
    /// Waist level (ISO 8559-1).
    pub waist_m: f64,
    /// Hip, where the buttocks protrude most.
    pub hip_m: f64,
    /// Crotch, at the upper end of the inside leg.
    pub crotch_m: f64,
    /// Middle of the knee.
    pub knee_m: f64,
    /// Forearm, along the arm.
    pub forearm_along_m: f64,
    /// Wrist, along the arm.
    pub wrist_along_m: f64,
}

/// What a garment has at a level of a body.
#[derive(Clone, Debug, PartialEq)]
pub struct WornLength {
    /// Level: `neck`, `across_shoulder`, `chest`, `underbust`, `waist`, `hip`, `thigh`, `knee`, `upper_arm`, `forearm`, `wrist`.
    pub level: &'static str,
    /// Girth of the cloth there, or its width across the shoulders, m.
    pub length_m: f64,
    /// Height above the floor at which the body is measured, m, where that is not where its level lies: the upper edge of trousers.
    pub height_m: Option<f64>,
    /// Where it lies on the cloth: of a girth that is measured by its half, that half.
    pub path: Vec<PathPart>,
}

/// How much shorter than the arm a sleeve may be that still goes round the wrist, m.
const SHORT_OF_WRIST_M: f64 = 0.040;
/// Distance within which a waist seam lies at the waist, m.
const AT_WAIST_M: f64 = 0.060;

impl Style {
    /// What the style has at the levels of a body that it covers, from the neck down.
    #[must_use]
    pub fn worn_lengths(&self, stand: &Stand) -> Vec<WornLength> {
        self.worn_lengths_on(std::slice::from_ref(stand)).pop().unwrap_or_default()
    }

    /// The same for several bodies: what the pieces are is found once.
    #[must_use]
    pub fn worn_lengths_on(&self, stands: &[Stand]) -> Vec<Vec<WornLength>> {
        let anatomy = Anatomy::of(self);
        let garb = Garb::of(&anatomy);
        let points = garb.points();
        stands.iter().map(|stand| on(self, &anatomy, &garb, &points, stand)).collect()
    }
}

/// What a garment has at the levels of one body.
fn on(
    style: &Style,
    anatomy: &Anatomy<'_>,
    garb: &Garb<'_>,
    points: &[PointOfMeasure],
    stand: &Stand,
) -> Vec<WornLength> {
    let Garb { trunk, sleeve, legs, .. } = garb;
    let of = |point: Point| {
        let one = points.iter().find(|one: &&PointOfMeasure| one.point == point)?;
        Some((one.length_m, one.path.clone()))
    };
    let mut found = Vec::new();
    let mut add = |level, length: Option<(f64, Vec<PathPart>)>, height_m| {
        found.extend(length.map(|(length_m, path)| WornLength { level, length_m, height_m, path }));
    };
    let both = |(half_m, path): (f64, Vec<PathPart>)| (2.0 * half_m, path);
    let round = |path: Vec<PathPart>| (style.path_length_m(&path), path);
    add("neck", of(Point::Neck), None);
    // How wide the shoulders of a garment without sleeves are is its design.
    add("across_shoulder", of(Point::AcrossShoulder).filter(|_| sleeve.is_some()), None);
    add("chest", of(Point::HalfChest).map(both), None);
    let hangs = Hangs::of(anatomy, trunk.as_ref(), legs.as_ref(), stand);
    let at = |height_m: f64| hangs.as_ref().and_then(|hangs| hangs.round(anatomy, height_m)).map(round);
    add("underbust", at(stand.underbust_m), None);
    match (trunk, legs) {
        (Some(trunk), _) => {
            let seam = trunk.waist_below_neck_m().map(|m| stand.side_neck_m - m);
            let is_seam = seam.is_some_and(|height_m| (height_m - stand.waist_m).abs() < AT_WAIST_M);
            add("waist", if is_seam { of(Point::HalfWaist).map(both) } else { at(stand.waist_m) }, None);
        }
        (None, Some(legs)) => {
            let top_m = stand.crotch_m + legs.top_above_fork_m();
            add("waist", of(Point::HalfWaist).map(both), Some(top_m));
        }
        (None, None) => add("waist", of(Point::HalfWaist).map(both), None),
    }
    add("hip", at(stand.hip_m), None);
    add("thigh", of(Point::HalfThigh).map(both), None);
    let knee = legs.as_ref().and_then(|legs| legs.round(stand.knee_m - stand.crotch_m)).map(round);
    add("knee", knee, None);
    add("upper_arm", of(Point::HalfBicep).map(both), None);
    if let (Some(sleeve), Some((sleeve_m, _))) = (sleeve, of(Point::SleeveLength)) {
        add("forearm", sleeve.round(stand.forearm_along_m).map(round), None);
        let reaches = sleeve_m > stand.wrist_along_m - SHORT_OF_WRIST_M;
        add("wrist", of(Point::HalfCuff).filter(|_| reaches).map(both), None);
    }
    found
}

/// A way down the front of a garment with the height of its beginning.
struct Hangs {
    path: Vec<PathPart>,
    top_m: f64,
    /// Height below which the cloth goes all round.
    round_m: f64,
}

impl Hangs {
    fn of(anatomy: &Anatomy<'_>, trunk: Option<&Trunk<'_>>, legs: Option<&Legs<'_>>, stand: &Stand) -> Option<Self> {
        if let Some(trunk) = trunk {
            let (path, below_neck_m) = trunk.way_down()?;
            let top_m = stand.side_neck_m - below_neck_m;
            return Some(Self { path, top_m, round_m: stand.side_neck_m - trunk.chest_below_neck_m()? });
        }
        if let Some(legs) = legs {
            let (path, above_fork_m) = legs.way_down()?;
            let top_m = stand.crotch_m + above_fork_m;
            return Some(Self { path, top_m, round_m: top_m });
        }
        let path = super::skirt::way_down(anatomy)?;
        Some(Self { path, top_m: stand.waist_m, round_m: stand.waist_m })
    }

    /// Way round the cloth at a height above the floor, m; `None` where it does not go round there.
    fn round(&self, anatomy: &Anatomy<'_>, height_m: f64) -> Option<Vec<PathPart>> {
        let (piece, place) =
            anatomy.ways.along(&self.path, self.top_m - height_m).filter(|_| height_m <= self.round_m)?;
        anatomy.ways.round_through(piece, place)
    }
}

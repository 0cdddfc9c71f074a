//! Girths of a garment at the levels of the body that is to wear it, from which ease follows before anything is draped.
//!
//! A top hangs from the side neck points, a skirt from the waist. The fork of trousers lies at the crotch.

use super::anatomy::Anatomy;
use super::legs::Legs;
use super::top::Trunk;
use super::{Garb, Point, PointOfMeasure};
use crate::style::{PathPart, Style};

/// Heights of the levels of a standing body above the floor, m, and distances along its arm from the shoulder point, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stand {
    pub side_neck_m: f64,
    pub underbust_m: f64,
    /// Waist level (ISO 8559-1).
    pub waist_m: f64,
    /// Greatest protrusion of the buttocks.
    pub hip_m: f64,
    /// Upper end of the inside leg.
    pub crotch_m: f64,
    pub knee_m: f64,
    pub forearm_along_m: f64,
    pub wrist_along_m: f64,
}

/// Girth or width of a garment at a level of a body.
#[derive(Clone, Debug, PartialEq)]
pub struct WornLength {
    /// One of `neck`, `across_shoulder`, `chest`, `underbust`, `waist`, `hip`, `thigh`, `knee`, `upper_arm`, `forearm`,
    /// `wrist`.
    pub level: &'static str,
    /// Girth of the cloth, or its width across the shoulders.
    pub length_m: f64,
    /// Height above the floor; `None` for that of the level. The upper edge of trousers may lie elsewhere than the
    /// waist.
    pub height_m: Option<f64>,
    /// True if the cut holds the garment to the body there. False where it hangs free from above, as below the chest of
    /// a straight shirt, or is as wide as a limb needs, as at the knee.
    pub is_held: bool,
    /// Path on the cloth. For a girth, it may be that of half the girth.
    pub path: Vec<PathPart>,
}

/// Greatest distance of a sleeve end above the wrist for it to count as a cuff at the wrist.
const SHORT_OF_WRIST_M: f64 = 0.040;
/// Greatest distance from the waist of a seam that counts as the garment's waist.
const AT_WAIST_M: f64 = 0.060;
/// Share of the wider girth by which a cut that follows the body narrows towards its waist: half of what the body does.
/// Its waist is 12 (men) to 18 % (women) less than its chest, and 25 % less than a woman's hip [en13402].
const TAKEN_IN: f64 = 0.08;
/// Distance below its upper edge at which the girth of a skirt is taken: below waistband and folded edge.
const BELOW_TOP_M: f64 = 0.020;
/// Distance below the hip over which the flare of a skirt is taken.
const BELOW_HIP_M: f64 = 0.150;
/// Growth of a girth above the hip, as a multiple of that below it, from which a skirt is shaped to the hip. In a cone,
/// such as a circle skirt, it grows alike above and below.
const BENT: f64 = 1.5;

impl Style {
    /// Girths and widths of the style at the levels of a body that it covers, from the neck down.
    pub fn worn_lengths(&self, stand: &Stand) -> Vec<WornLength> {
        self.worn_lengths_on(std::slice::from_ref(stand)).pop().unwrap_or_default()
    }

    /// As [`Style::worn_lengths`], but identifies the pieces once.
    pub fn worn_lengths_on(&self, stands: &[Stand]) -> Vec<Vec<WornLength>> {
        let anatomy = Anatomy::of(self);
        let garb = Garb::of(&anatomy);
        let points = garb.points();
        stands.iter().map(|stand| lengths_on(self, &anatomy, &garb, &points, stand)).collect()
    }
}

struct OnCloth {
    length_m: f64,
    path: Vec<PathPart>,
}

fn lengths_on(
    style: &Style,
    anatomy: &Anatomy<'_>,
    garb: &Garb<'_>,
    points: &[PointOfMeasure],
    stand: &Stand,
) -> Vec<WornLength> {
    let Garb { trunk, sleeve, legs, .. } = garb;
    let flat = |point: Point| {
        let found = points.iter().find(|measure: &&PointOfMeasure| measure.point == point)?;
        Some(OnCloth { length_m: found.length_m, path: found.path.clone() })
    };
    let mut found: Vec<WornLength> = Vec::new();
    let mut add = |level, is_held, length: Option<OnCloth>, height_m| {
        found.extend(length.map(|OnCloth { length_m, path }| WornLength { level, length_m, height_m, is_held, path }));
    };
    let doubled = |half: OnCloth| OnCloth { length_m: 2.0 * half.length_m, ..half };
    let measured = |path: Vec<PathPart>| OnCloth { length_m: style.path_length_m(&path), path };
    add("neck", true, flat(Point::Neck), None);
    // Without sleeves, the width of the shoulders is free to the designer.
    add("across_shoulder", true, flat(Point::AcrossShoulder).filter(|_| sleeve.is_some()), None);
    let chest = flat(Point::HalfChest).map(doubled);
    let chest_m = chest.as_ref().map(|chest| chest.length_m);
    add("chest", true, chest, None);
    let hangs = Hangs::of(anatomy, trunk.as_ref(), legs.as_ref(), stand);
    let girth_at = |height_m: f64| hangs.as_ref().and_then(|hangs| hangs.round(anatomy, height_m)).map(measured);
    let girth_m_at = |height_m: f64| girth_at(height_m).map(|girth| girth.length_m);
    let seam = trunk.as_ref().and_then(Trunk::waist_below_neck_m).map(|m| stand.side_neck_m - m);
    let has_seam_at = |height_m: f64| seam.is_some_and(|seam_m| (seam_m - height_m).abs() < AT_WAIST_M);
    let is_seam = has_seam_at(stand.waist_m);
    let waist = if trunk.is_none() || is_seam { flat(Point::HalfWaist).map(doubled) } else { girth_at(stand.waist_m) };
    let waist_m = waist.as_ref().map(|waist| waist.length_m);
    // A way that left the cloth at a dart or an armhole is shorter than the girths above and below it.
    let least_m = chest_m.into_iter().chain(waist_m).reduce(f64::min);
    let is_whole = |girth: &OnCloth| least_m.is_none_or(|least_m| girth.length_m > (1.0 - TAKEN_IN) * least_m);
    let underbust = girth_at(stand.underbust_m).filter(is_whole);
    add("underbust", has_seam_at(stand.underbust_m), underbust, None);
    let is_waist_held = trunk.is_none() || is_seam || is_taken_in(chest_m, waist_m);
    let top_m = legs.as_ref().filter(|_| trunk.is_none()).map(|legs| stand.crotch_m + legs.top_above_fork_m());
    add("waist", is_waist_held, waist, top_m);
    let is_hip_held = match (trunk, legs) {
        (None, Some(_)) => is_taken_in(girth_m_at(stand.hip_m), waist_m),
        _ => is_waist_held && is_shaped_to_the_hip(girth_m_at, stand),
    };
    add("hip", is_hip_held, girth_at(stand.hip_m), None);
    add("thigh", false, flat(Point::HalfThigh).map(doubled), None);
    let knee = legs.as_ref().and_then(|legs| legs.round(stand.knee_m - stand.crotch_m)).map(measured);
    add("knee", false, knee, None);
    add("upper_arm", false, flat(Point::HalfBicep).map(doubled), None);
    if let (Some(sleeve), Some(whole)) = (sleeve, flat(Point::SleeveLength)) {
        add("forearm", false, sleeve.round(stand.forearm_along_m).map(measured), None);
        let reaches = whole.length_m > stand.wrist_along_m - SHORT_OF_WRIST_M;
        add("wrist", false, flat(Point::HalfCuff).filter(|_| reaches).map(doubled), None);
    }
    found
}

fn is_taken_in(wide_m: Option<f64>, narrow_m: Option<f64>) -> bool {
    wide_m.zip(narrow_m).is_some_and(|(wide, narrow)| narrow <= (1.0 - TAKEN_IN) * wide)
}

fn is_shaped_to_the_hip(girth_m_at: impl Fn(f64) -> Option<f64>, stand: &Stand) -> bool {
    let top_m = stand.waist_m - BELOW_TOP_M;
    let (top, hip) = (girth_m_at(top_m), girth_m_at(stand.hip_m));
    let Some((top, hip)) = top.zip(hip).filter(|_| is_taken_in(hip, top)) else { return false };
    // A skirt that ends sooner has no flare.
    let below = girth_m_at(stand.hip_m - BELOW_HIP_M).map_or(0.0, |below| (below - hip) / BELOW_HIP_M);
    (hip - top) / (top_m - stand.hip_m) > BENT * below
}

/// Path down the front of a garment, and the height at which it begins.
struct Hangs {
    path: Vec<PathPart>,
    top_m: f64,
    /// Height above the floor below which the cloth goes all round.
    round_m: f64,
}

impl Hangs {
    fn of(anatomy: &Anatomy<'_>, trunk: Option<&Trunk<'_>>, legs: Option<&Legs<'_>>, stand: &Stand) -> Option<Self> {
        if let Some(trunk) = trunk {
            let down = trunk.way_down()?;
            let top_m = stand.side_neck_m - down.below_neck_m;
            return Some(Self { path: down.path, top_m, round_m: stand.side_neck_m - trunk.chest_below_neck_m()? });
        }
        if let Some(legs) = legs {
            let down = legs.way_down()?;
            let top_m = stand.crotch_m + down.above_fork_m;
            return Some(Self { path: down.path, top_m, round_m: top_m });
        }
        let path = super::skirt::way_down(anatomy)?;
        Some(Self { path, top_m: stand.waist_m, round_m: stand.waist_m })
    }

    /// Path at a height above the floor. `None` where the cloth does not go all round.
    fn round(&self, anatomy: &Anatomy<'_>, height_m: f64) -> Option<Vec<PathPart>> {
        let point = anatomy.ways.along(&self.path, self.top_m - height_m).filter(|_| height_m <= self.round_m)?;
        anatomy.ways.round_through(point)
    }
}

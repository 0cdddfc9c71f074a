//! Heights, widths and depths of a body from its front and side silhouettes.

use super::camera::Camera;
use super::refused;
use super::sections::{LOWEST, Level, Profile, STEP, Section};
use super::silhouette::{Mask, Run};
use crate::measure::sites::{CHEST, usual_chest};
use crate::measure::slices::steps;
use crate::{BodyError, Sex};

/// Height of the ISO 8559-1 waist / stature, men and women [Gordon 2014].
const WAIST: [f64; 2] = [0.6212, 0.6299];

/// Distance from the median plane of the most prominent points of breasts and buttocks, as a share of half the width:
/// in the side view they are nearer to the camera by it. Judgement.
const NEARER: f64 = 0.4;

/// Range of height of the narrowest section of the neck, as shares of stature. Judgement.
const NECK: [f64; 2] = [0.83, 0.90];

/// Least width or depth of a neck, as a share of stature. Model bodies have at least 0.045.
const LEAST_NECK: f64 = 0.03;

/// Mean height of the narrowest section, as a share of stature, of the 160 model bodies of [`crate::shape::atlas`].
const USUAL_NECK: f64 = 0.8714;

/// Radius of the crown / stature. Seen from below or above, the edge of the head is not its highest point. Judgement.
const CROWN: f64 = 0.05;

/// Distance by which the nearest edge of the soles lies in front of the subject's axis, as a share of stature. The edge
/// is seen below the floor under the axis. Judgement.
const SOLES_NEARER: f64 = 0.09;

/// Weight of the crown against the soles in the estimate of the camera's height, in front and side view. Hair raises
/// the crown, and in the side view the nearer foot is nearer to the camera by an unknown step. These weights leave the
/// least standard deviation for 700 pictures of model bodies: 4 and 6 mm.
const CROWN_COUNTS: [f64; 2] = [0.5, 0.8];

/// Greatest relative difference between heights of a person in a picture and by stature and camera. Judgement.
const MISFIT: f64 = 0.03;

/// Range of heights from thigh to waist / stature for the subject's axis in the side view, and their number. Judgement.
const UPRIGHT: [f64; 2] = [0.30, 0.62];
const UPRIGHTS: u32 = 33;

/// Distance by which the middle of thigh and trunk lies in front of the axis, which passes through the pelvis, as a
/// share of stature. Mean of 80 model bodies, standard deviation 0.0023.
const MIDDLE_BEFORE_AXIS: f64 = 0.012;

/// Focal length of a picture, pixels, and distance of the camera, m.
#[derive(Clone, Copy, Debug)]
struct Lens {
    focal_px: f64,
    distance_m: f64,
}

#[derive(Clone, Debug)]
pub(super) struct View {
    mask: Mask,
    rows: (usize, usize),
    /// Lens and distance. `None` for an orthographic view.
    camera: Option<Lens>,
    /// Height of the camera, m. 0 for an orthographic view.
    camera_height: f64,
}

impl View {
    pub fn new(name: &'static str, mask: Mask, camera: Option<&Camera>) -> Result<Self, BodyError> {
        let rows = mask.rows().ok_or_else(|| refused(name, "no person is seen"))?;
        let camera = camera.map(|camera| Lens {
            focal_px: camera.focal_over_height * mask.height as f64,
            distance_m: camera.distance_m,
        });
        let is_sound = |lens: Lens| (1.0..1e7).contains(&lens.focal_px) && (0.8..100.0).contains(&lens.distance_m);
        if camera.is_some_and(|lens| !is_sound(lens)) {
            return Err(refused(name, "the camera given is impossible (distance 0.8 to 100 m)"));
        }
        Ok(Self { mask, rows, camera, camera_height: 0.0 })
    }

    /// True if two runs of the width of legs are seen side by side in most rows of the legs.
    fn shows_two_legs(&self) -> bool {
        let (top, bottom) = self.rows;
        let height = bottom - top + 1;
        let rows = (0..20).map(|i| bottom - (height * (12 + i)) / 100);
        let apart = |row: usize| {
            let wide = |(start, end): &Run| (end - start) * 25 > height;
            self.mask.runs(row).iter().filter(|run| wide(run)).count() >= 2
        };
        rows.filter(|row| apart(*row)).count() > 10
    }

    /// Sets the height of the camera from the rows of crown and soles. `crown_counts` is the weight of the crown.
    fn of_stature(mut self, stature: f64, crown_counts: f64) -> Self {
        let Some(Lens { focal_px: focal, distance_m: distance }) = self.camera else { return self };
        let middle = self.mask.height as f64 / 2.0;
        let rise = (middle - self.rows.0 as f64) / focal;
        let by_crown = stature - distance * rise + CROWN * stature * (rise.hypot(1.0) - 1.0);
        let by_soles = (distance - SOLES_NEARER * stature) * ((self.rows.1 + 1) as f64 - middle) / focal;
        self.camera_height = crown_counts * by_crown + (1.0 - crown_counts) * by_soles;
        self
    }

    fn widest(&self, row: usize) -> Option<Run> {
        self.mask.runs(row).into_iter().max_by_key(|(start, end)| end - start)
    }
}

/// Both silhouettes, measured in m.
#[derive(Clone, Debug)]
pub(super) struct Outlines {
    front: View,
    side: View,
    stature: f64,
    /// Column of the subject's axis in the side view.
    axis: f64,
    pub crotch: f64,
}

impl Outlines {
    pub fn new(front: View, side: View, stature: f64) -> Result<Self, BodyError> {
        let [front, side] =
            [(front, CROWN_COUNTS[0]), (side, CROWN_COUNTS[1])].map(|(view, counts)| view.of_stature(stature, counts));
        let axis = side.mask.width as f64 / 2.0;
        let mut outlines = Self { front, side, stature, axis, crotch: 0.0 };
        outlines.axis = outlines.find_axis().unwrap_or(axis);
        outlines.crotch = outlines
            .find_crotch()
            .ok_or_else(|| refused("front", "the legs are not apart, or it is no person seen from the front"))?;
        Ok(outlines)
    }

    /// Note for the user on a person who is too tall or too small in a view for stature, distance and focal length.
    /// `None` for a plausible height, or without a camera. A camera that looks up or down changes the height as a wrong
    /// distance or focal length does, and one picture cannot tell them apart.
    pub fn doubt(&self, name: &str, side: bool) -> Option<String> {
        let view = if side { &self.side } else { &self.front };
        let Lens { focal_px: focal, distance_m: distance } = view.camera?;
        let seen = (view.rows.1 + 1 - view.rows.0) as f64 * distance / focal;
        let nearer = SOLES_NEARER * self.stature;
        let rise = (self.stature - view.camera_height) / distance;
        let crown = self.stature * (1.0 - CROWN * (rise.hypot(1.0) - 1.0));
        let soles = view.camera_height.max(0.0) * nearer / (distance - nearer);
        let misfit = seen / (crown + soles) - 1.0;
        (misfit.abs() > MISFIT).then(|| {
            let than = if misfit > 0.0 { "taller" } else { "smaller" };
            format!(
                "in the {name} picture the person is {:.0} % {than} than stature, distance and focal length say: one of them is \
                 wrong, or the camera looked up or down",
                100.0 * misfit.abs()
            )
        })
    }

    /// Sections at neck, chest, waist and hip, and true if the arms hide the sides of the chest.
    pub fn sections(&self, sex: Sex, notes: &mut Vec<String>) -> Result<([Section; 4], bool), BodyError> {
        let waist = WAIST[usize::from(sex == Sex::Female)] * self.stature;
        self.check_arms(waist)?;
        if self.side.shows_two_legs() {
            return Err(refused(
                "side",
                "two legs are seen apart: it is no side view, or the legs stand one before the other",
            ));
        }
        let chest = self.chest_level().ok_or_else(|| refused("side", "no chest is found in its outline"))?;
        let hip = self.hip_level().ok_or_else(|| refused("side", "no buttocks are found in its outline"))?;
        let trunk = |level, height| self.section(level, height, bulges(level));
        let mut sections =
            [self.neck()?, trunk(Level::Chest, chest)?, trunk(Level::Waist, waist)?, trunk(Level::Hip, hip)?];
        let hidden = self.hidden_chest_width(chest);
        if let Some(width) = hidden {
            sections[1].width = width;
            notes.push("the arms hide the sides of the chest: the width just below is taken".to_owned());
        }
        Ok((sections, hidden.is_some()))
    }

    /// Outlines of the trunk at equal steps upwards. A width is `None` if the trunk is not seen apart from arms or
    /// legs.
    pub fn trunk(&self) -> Profile {
        let height = |i: usize| (LOWEST + STEP * i as f64) * self.stature;
        // A leg may cross the middle, too, but the trunk does not begin there.
        let is_trunk = |h: f64| self.trunk_run(h, self.middle_depth(h)).is_some_and(|run| self.is_central(run));
        let seen =
            |i: usize| (self.arms_apart(height(i)) && is_trunk(height(i))).then(|| self.width(height(i))).flatten();
        Profile { widths: std::array::from_fn(seen), sides: std::array::from_fn(|i| self.profile(height(i), [0.0; 2])) }
    }

    /// Metres per pixel at a distance `nearer` towards the camera.
    fn scale(&self, view: &View, nearer: f64) -> f64 {
        view.camera.map_or_else(
            || self.stature / (view.rows.1 + 1 - view.rows.0) as f64,
            |lens| (lens.distance_m - nearer) / lens.focal_px,
        )
    }

    /// Row of a view that shows a point at a height that is `nearer` to the camera than the subject's axis.
    fn row(&self, view: &View, height: f64, nearer: f64) -> Option<usize> {
        let scale = self.scale(view, nearer);
        let row = match view.camera {
            None => (view.rows.1 + 1) as f64 - height / scale,
            Some(_) => view.mask.height as f64 / 2.0 - (height - view.camera_height) / scale,
        };
        (row >= view.rows.0 as f64 - 0.5 && row <= view.rows.1 as f64 + 0.5).then_some(row as usize)
    }

    /// Front and back of the trunk at a height in the side view, m from the subject's axis.
    fn profile(&self, height: f64, nearer: [f64; 2]) -> Option<[f64; 2]> {
        let edge = |nearer: f64, front: bool| {
            let (back_px, front_px) = self.side.widest(self.row(&self.side, height, nearer)?)?;
            let column = if front { front_px } else { back_px };
            Some((column as f64 - self.axis) * self.scale(&self.side, nearer))
        };
        Some([edge(nearer[0], true)?, edge(nearer[1], false)?])
    }

    fn find_axis(&self) -> Option<f64> {
        let middle = |height: f64| {
            let (back, front) = self.side.widest(self.row(&self.side, height, 0.0)?)?;
            Some((back + front) as f64 / 2.0)
        };
        let [from, to] = UPRIGHT.map(|share| share * self.stature);
        let mut middles: Vec<f64> = steps(from, to, UPRIGHTS).filter_map(middle).collect();
        middles.sort_by(f64::total_cmp);
        let before = MIDDLE_BEFORE_AXIS * self.stature / self.scale(&self.side, 0.0);
        middles.get(middles.len() / 2).map(|column| column - before)
    }

    /// Run of the trunk at a height in the front view: the nearest to the middle of the head.
    fn trunk_run(&self, height: f64, nearer: f64) -> Option<Run> {
        let middle = self.head_column()?;
        let off = |&(start, end): &Run| ((start + end) as f64 / 2.0 - middle).abs();
        let runs = self.front.mask.runs(self.row(&self.front, height, nearer)?);
        runs.into_iter()
            .filter(|(start, end)| (*start as f64) < middle && (*end as f64) > middle)
            .min_by(|a, b| off(a).total_cmp(&off(b)))
    }

    /// True if the middle of the head lies above the middle half of a run.
    fn is_central(&self, (start, end): Run) -> bool {
        let quarter = (end - start) as f64 / 4.0;
        self.head_column().is_some_and(|middle| middle > start as f64 + quarter && middle < end as f64 - quarter)
    }

    fn head_column(&self) -> Option<f64> {
        let (start, end) = self.front.widest(self.row(&self.front, 0.94 * self.stature, 0.0)?)?;
        Some((start + end) as f64 / 2.0)
    }

    /// Distance of the trunk's middle from the axis towards the front camera. Without a camera 0: it changes nothing.
    fn middle_depth(&self, height: f64) -> f64 {
        let depth = |h: f64| self.profile(h, [0.0; 2]).map(|[front, back]| (front + back) / 2.0);
        // The subject stands on the axis of the ankles, wherever in the side picture that is.
        if self.front.camera.is_none() { 0.0 } else { depth(height).unwrap_or(0.0) }
    }

    fn width(&self, height: f64) -> Option<f64> {
        let nearer = self.middle_depth(height);
        let (start, end) = self.trunk_run(height, nearer)?;
        Some((end - start) as f64 * self.scale(&self.front, nearer))
    }

    fn section(&self, level: Level, height: f64, bulges: [bool; 2]) -> Result<Section, BodyError> {
        let missing = |view| refused(view, format!("no {} is found in its outline", level.name()));
        let width = self.width(height).ok_or_else(|| missing("front"))?;
        let nearer = bulges.map(|bulges| if bulges { NEARER * width / 2.0 } else { 0.0 });
        let [front, back] = self.profile(height, nearer).ok_or_else(|| missing("side"))?;
        Ok(Section { level, height, width, depth: front - back })
    }

    fn find_crotch(&self) -> Option<f64> {
        let gap = |height: f64| {
            let middle = self.head_column()?;
            let runs = self.front.mask.runs(self.row(&self.front, height, 0.0)?);
            Some(!runs.iter().any(|(start, end)| (*start as f64) < middle && (*end as f64) > middle))
        };
        let heights: Vec<f64> = steps(0.30 * self.stature, 0.60 * self.stature, 300).collect();
        // A shadow may join the legs below the highest gap, so the highest counts.
        let last = heights.iter().rposition(|&height| gap(height) == Some(true))?;
        heights.get(last + 1).copied()
    }

    fn hip_level(&self) -> Option<f64> {
        let heights = steps(self.crotch + 0.01 * self.stature, self.crotch + 0.10 * self.stature, 48);
        let back = |z: f64| Some((z, self.profile(z, [0.0, NEARER * 0.1 * self.stature])?[1]));
        let lows = heights.filter_map(back).collect::<Vec<_>>();
        let least = lows.iter().map(|(_, y)| *y).min_by(f64::total_cmp)?;
        middle_of(lows.iter().filter(|(_, y)| *y < least + 1e-3).map(|(z, _)| *z))
    }

    /// Level of the nipples: the mean of the height at which the front stands out most from the chord between ribs and
    /// collar bones, and of the expected height by proportion.
    fn chest_level(&self) -> Option<f64> {
        let (low, high) = (0.66 * self.stature, 0.80 * self.stature);
        let front = |z: f64| Some(self.profile(z, [0.0; 2])?[0]);
        let (y_low, y_high) = (front(low)?, front(high)?);
        let out = |z: f64| Some((z, front(z)? - y_low - (y_high - y_low) * (z - low) / (high - low)));
        let [from, to] = CHEST.map(|share| share * self.stature);
        let outs: Vec<(f64, f64)> = steps(from, to, 40).filter_map(out).collect();
        let most = outs.iter().map(|(_, y)| *y).max_by(f64::total_cmp)?;
        let foremost = middle_of(outs.iter().filter(|(_, y)| *y > most - 1e-3).map(|(z, _)| *z))?;
        Some((foremost + usual_chest(self.stature, self.crotch)) / 2.0)
    }

    /// Narrowest section of the neck: width in the front view, and least distance between front and back outline in the
    /// side view.
    fn neck(&self) -> Result<Section, BodyError> {
        let heights: Vec<f64> = steps(NECK[0] * self.stature, NECK[1] * self.stature, 40).collect();
        let width = heights.iter().filter_map(|&z| Some((z, self.width(z)?))).min_by(|a, b| a.1.total_cmp(&b.1));
        let (height, width) = width.ok_or_else(|| refused("front", "no neck is found in its outline"))?;
        let edges: Vec<(f64, [f64; 2])> =
            heights.iter().filter_map(|&z| Some((z, self.profile(z, [0.0; 2])?))).collect();
        let across = edges
            .iter()
            .flat_map(|(z, [front, _])| edges.iter().map(move |(other, [_, back])| (front - back).hypot(z - other)));
        let depth = across.min_by(f64::total_cmp).ok_or_else(|| refused("side", "no neck is found in its outline"))?;
        if width.min(depth) < LEAST_NECK * self.stature {
            let view = if width < depth { "front" } else { "side" };
            let problem = format!(
                "the neck is only {:.0} mm wide there: hair or skin is as the background is",
                1e3 * width.min(depth)
            );
            return Err(refused(view, problem));
        }
        // A neck is nearly as narrow over some centimetres, so the mean with the usual height is more certain.
        let height = (height + USUAL_NECK * self.stature) / 2.0;
        Ok(Section { level: Level::Neck, height, width, depth })
    }

    fn arms_apart(&self, height: f64) -> bool {
        let nearer = self.middle_depth(height);
        let (Some(row), Some((start, end))) = (self.row(&self.front, height, nearer), self.trunk_run(height, nearer))
        else {
            return false;
        };
        let runs = self.front.mask.runs(row);
        runs.iter().any(|run| run.1 <= start) && runs.iter().any(|run| run.0 >= end)
    }

    /// Width of a chest whose sides arms hide: at the nearest height below with arms apart. `None` if they do not.
    fn hidden_chest_width(&self, chest: f64) -> Option<f64> {
        if self.arms_apart(chest) {
            return None;
        }
        let step = 0.002 * self.stature;
        let clear = (1..40).map(|i| chest - step * f64::from(i)).find(|&z| self.arms_apart(z))?;
        self.width(clear - 2.0 * step)
    }

    /// Refuses arms that touch the trunk at the waist. Arms stretched out are far from it, hanging arms must be apart.
    fn check_arms(&self, waist: f64) -> Result<(), BodyError> {
        let missing = || refused("front", "no waist is found in its outline");
        let width = self.width(waist).ok_or_else(missing)?;
        let columns = |row: usize| self.front.mask.runs(row);
        let rows = self.front.rows.0..=self.front.rows.1;
        let left = rows.clone().filter_map(|row| columns(row).first().map(|run| run.0)).min();
        let right = rows.filter_map(|row| columns(row).last().map(|run| run.1)).max();
        let span = left.zip(right).map_or(0.0, |(left, right)| (right - left) as f64 * self.scale(&self.front, 0.0));
        if !self.arms_apart(waist) && span < 1.7 * width {
            return Err(refused(
                "front",
                format!("the arms touch the {}", if span < 1.3 * width { "trunk" } else { "waist" }),
            ));
        }
        Ok(())
    }
}

/// True for front and back of a level that bulges beside the median plane.
fn bulges(level: Level) -> [bool; 2] {
    [level == Level::Chest, level == Level::Hip]
}

/// Mean of the least and the greatest value. `None` without values.
fn middle_of(values: impl Iterator<Item = f64> + Clone) -> Option<f64> {
    let (low, high) = (values.clone().min_by(f64::total_cmp)?, values.max_by(f64::total_cmp)?);
    Some((low + high) / 2.0)
}

//! Fronts, backs and skirts: before and behind the body, each bent about the vertical (4.2-4.7).

use std::f64::consts::PI;

use super::Bend;
use super::body_parts::Form;
use super::ellipse::Ellipse;
use super::layout::{Joins, Sheet};
use geom::{V2, V3};
use pattern::Role;

geom::constants! {
    "placement.trunk",
    /// Least distance of a piece from the skin before sewing.
    pub const CLEARANCE_M: f64 = 0.02;
    const BETWEEN_M: f64 = 0.01;
    /// Share of the half width within which the skin bounds the depth of the ellipse: at the sides it has no depth.
    const BOUNDING: f64 = 0.9;
    /// Share of a turn that a piece takes if it goes round the body alone.
    const ROUND: f64 = 0.95;
    /// Width of a seam over its height beyond which it is a shoulder seam; steeper ones are side seams.
    const SHOULDER_SLOPE: f64 = 1.0;
    /// Offset and angle of [T], for the one that the study does not give.
    const USUAL: (f64, f64) = (2.1, PI);
    /// Least angle of an arc: a flat piece has no radius.
    const FLAT_RAD: f64 = 0.01;
}

pub const TOPS: [Role; 4] = [Role::Front, Role::Back, Role::BodiceFront, Role::BodiceBack];
pub const FRONTS: [Role; 3] = [Role::Front, Role::BodiceFront, Role::SkirtFront];
pub const BACKS: [Role; 3] = [Role::Back, Role::BodiceBack, Role::SkirtBack];

pub struct Bent {
    /// 1 in front, -1 behind.
    side: f64,
    curve: Ellipse,
    centre_y: f64,
    /// Height of the sheet's 0.
    lift: f64,
}

impl Bent {
    /// Bends the sheet of one side; `is_alone` is true where nothing is worn on the other.
    ///
    /// By default it follows half an ellipse that clears the body by [`CLEARANCE_M`], as wide as the trunk and as deep
    /// as the piece needs to reach from side to side. With an offset or an angle given it follows the thesis's arc.
    pub fn new(form: &Form, joins: &Joins, sheet: &Sheet, side: f64, is_alone: bool, bend: &Bend) -> Self {
        let (low, high) = sheet.bounds(joins.garment);
        let lift = lift(form, joins, sheet);
        let width = high.x - low.x;
        let (bottom, top) = (low.y + lift, high.y + lift);
        let axis = form.trunk_axis().origin.y;
        let armpit = form.body.landmarks.armpit[0].z.min(form.body.landmarks.armpit[1].z);
        if bend.offset_mu.is_some() || bend.bend_angle_rad.is_some() {
            let level = if has_tops(joins, sheet) { form.body.levels.chest_m } else { form.body.levels.hip_m };
            let depth = form.depth(level);
            let radius = width / bend.bend_angle_rad.unwrap_or(USUAL.1).max(FLAT_RAD);
            let apex = 0.5 * bend.offset_mu.unwrap_or(USUAL.0) * (depth.y - depth.x);
            let centre_y = axis + side * (apex - radius);
            return Self { side, curve: Ellipse::new(radius, radius), centre_y, lift };
        }
        let half_width = form.half_width(bottom, top.min(armpit)) + CLEARANCE_M;
        let ahead = |p: &V3| side * (p.y - axis) / (1.0 - (p.x / half_width).powi(2)).sqrt();
        let within = form.between(bottom, top).filter(|p| p.x.abs() < BOUNDING * half_width);
        let least = within.map(ahead).fold(0.0, f64::max) + CLEARANCE_M;
        // Half the ellipse for half the garment; all of it for a piece that goes round alone.
        let half_round = if is_alone { 0.5 * width / ROUND } else { width + 2.0 * BETWEEN_M };
        Self { side, curve: Ellipse::reaching(half_width, least, half_round), centre_y: axis, lift }
    }

    pub fn at(&self, p: V2) -> V3 {
        let bent = self.curve.at(p.x);
        // Seen from outside, x runs to the subject's left in front and to the right behind.
        V3::new(-self.side * bent.x, self.centre_y + self.side * bent.y, self.lift + p.y)
    }
}

fn has_tops(joins: &Joins, sheet: &Sheet) -> bool {
    sheet.parts.iter().any(|part| TOPS.contains(&joins.garment.pieces[part.piece].role))
}

/// Height of the sheet's 0. The highest point of a top lies at the side neck points, or at the armpits if no seam holds
/// it over the shoulders. The upper edge of a skirt lies at the waist.
fn lift(form: &Form, joins: &Joins, sheet: &Sheet) -> f64 {
    let body = form.body;
    let tops = joins.worn_as(&TOPS);
    let is_top = |v: usize| tops.contains(&joins.piece_of[v]);
    let garment = joins.garment;
    let highest_top = sheet.points(garment).filter(|(v, _)| is_top(*v)).map(|(_, p)| p.y).reduce(f64::max);
    let [right, left] = if has_shoulders(joins, sheet) { body.landmarks.side_neck } else { body.landmarks.armpit };
    match highest_top {
        Some(highest) => 0.5 * (right.z + left.z) - highest,
        None => body.levels.waist_m - sheet.bounds(garment).1.y,
    }
}

/// True if a seam to the other side that runs sideways, or one to a sleeve, holds the sheet.
fn has_shoulders(joins: &Joins, sheet: &Sheet) -> bool {
    let own = sheet.pieces();
    let others: Vec<usize> = joins.worn_as(&TOPS).into_iter().filter(|p| !own.contains(p)).collect();
    if sheet.parts.iter().any(|part| !joins.to_any(part.piece, &sleeves(joins)).is_empty()) {
        return true;
    }
    joins.garment.seams.iter().any(|seam| {
        let ends = |&[a, b]: &[usize; 2]| {
            let (a, b) = if own.contains(&joins.piece_of[a]) { (a, b) } else { (b, a) };
            let part = sheet.parts.iter().find(|part| part.piece == joins.piece_of[a])?;
            others.contains(&joins.piece_of[b]).then(|| part.at(joins.garment.rest[a]))
        };
        let places: Vec<V2> = seam.pairs.iter().filter_map(ends).collect();
        let low = places.iter().fold(V2::repeat(f64::MAX), |low, p| low.inf(p));
        let high = places.iter().fold(V2::repeat(f64::MIN), |high, p| high.sup(p));
        places.len() > 1 && high.x - low.x > SHOULDER_SLOPE * (high.y - low.y)
    })
}

pub fn sleeves(joins: &Joins) -> Vec<usize> {
    joins.worn_as(&[Role::SleeveRight, Role::SleeveLeft])
}

//! Trouser legs: front and back of a leg about the leg, row by row, their upper part about that half of the body.
//!
//! Rows below the fork (the lower end of the centre seam) go round the leg: from its outside over the front (or back) to
//! its inside. Rows well above it go round half the body: from its side to the median plane. Between them rows pass from
//! one to the other. A row takes its whole half ring, so that all seams start nearly closed. Where a leg would reach below the
//! instep, its front is drawn up there, as one does who puts trousers on: else toes end up on the wrong side of the cloth.

use std::f64::consts::{FRAC_PI_2, PI};

use super::form::{Form, Hand};
use super::layout::{Joins, Sheet};
use super::trunk::CLEARANCE_M;
use geom::{V2, V3, smooth_step};
use pattern::{Garment, Role};

geom::constants! {
    "placement.leg",
    /// How far below the body's crotch the garment's starts, m.
    const BELOW_CROTCH_M: f64 = 0.02;
    /// Distance from the median plane of what lies between the legs, m.
    const BESIDE_MEDIAN_M: f64 = 4e-3;
    /// Height over which rows pass from the leg to the body, m.
    const PASSAGE_M: f64 = 0.12;
    /// Height of the ankles: what hangs lower at the sides and behind is placed as if the foot were not there, m.
    const ANKLE_M: f64 = 0.09;
    /// Height of the instep, m: the front of a leg that began lower would have the foot through it.
    const INSTEP_M: f64 = 0.11;
    /// Sine of the angle from the side of a leg from which on all of it lies above the foot.
    const FRONT: f64 = 0.7;
    /// Where the fork is sought in a leg without a centre seam: share of its height.
    const USUAL_FORK: f64 = 0.75;
    /// A row counts as full with this share of the width of the row [`INNER_M`] further in.
    const FULL: f64 = 0.9;
    const INNER_M: f64 = 0.04;
    /// Distance of the rows that are tried, m.
    const ROW_M: f64 = 5e-3;
}

/// Roles of one leg: front, back, and both in one piece.
pub fn roles(hand: Hand) -> [Role; 3] {
    if hand > 0.0 {
        [Role::LegFrontRight, Role::LegBackRight, Role::LegRight]
    } else {
        [Role::LegFrontLeft, Role::LegBackLeft, Role::LegLeft]
    }
}

/// What of a leg a sheet is: its front, its back, or both in one piece, in the order of [`roles`].
pub const FACES: [Option<f64>; 3] = [Some(1.0), Some(-1.0), None];

/// Front and back of a leg.
pub struct Leg<'a> {
    form: &'a Form<'a>,
    joins: &'a Joins<'a>,
    hand: Hand,
    faces: Vec<LegFace>,
}

/// One side of a leg.
struct LegFace {
    sheet: Sheet,
    /// 1 in front, -1 behind; `None` for both in one piece, whose middle lies outside.
    side: Option<f64>,
    /// Height in the sheet of the fork.
    fork: f64,
    /// Height in the sheet of its lowest point.
    hem: f64,
    /// Heights between which rows go from side to side: beyond them slope the hem and the waist edge.
    full: [f64; 2],
}

impl LegFace {
    /// Ends of the row at a height; beyond the full rows those of the nearest.
    fn row(&self, garment: &Garment, height: f64) -> Option<(f64, f64)> {
        self.sheet.row(garment, height.clamp(self.full[0], self.full[1]))
    }
}

/// Heights of the lowest and highest rows that go from side to side.
fn full_rows(sheet: &Sheet, garment: &Garment) -> [f64; 2] {
    let (low, high) = sheet.bounds(garment);
    let width = |y: f64| sheet.row(garment, y).map_or(0.0, |(left, right)| right - left);
    let is_full = |y: f64, inner: f64| width(y) > FULL * width(inner);
    let steps = (0..).map(|k| f64::from(k) * ROW_M).take_while(|step| *step < 0.25 * (high.y - low.y));
    let top = steps.clone().map(|step| high.y - step).find(|y| is_full(*y, y - INNER_M));
    let bottom = steps.map(|step| low.y + step).find(|y| is_full(*y, y + INNER_M));
    [bottom.unwrap_or(low.y), top.unwrap_or(high.y)]
}

/// An ellipse about a part of the body at one height.
struct Ring {
    centre: V2,
    half: V2,
}

impl<'a> Leg<'a> {
    /// Sheets of one leg with their sides, as in [`FACES`]; `others` are the pieces of the other leg.
    pub fn new(
        form: &'a Form,
        joins: &'a Joins,
        hand: Hand,
        sheets: impl IntoIterator<Item = (Sheet, Option<f64>)>,
        others: &[usize],
    ) -> Self {
        let face = |(sheet, side): (Sheet, Option<f64>)| {
            let centre: Vec<usize> =
                sheet.pieces().iter().flat_map(|&p| joins.to_any(p, others)).map(|pair| pair[0]).collect();
            let seam = sheet.points(joins.garment).filter(|(v, _)| centre.contains(v)).map(|(_, p)| p.y);
            let (low, high) = sheet.bounds(joins.garment);
            let fork = seam.reduce(f64::min).unwrap_or(low.y + USUAL_FORK * (high.y - low.y));
            let full = full_rows(&sheet, joins.garment);
            LegFace { sheet, side, fork, hem: low.y, full }
        };
        Self { form, joins, hand, faces: sheets.into_iter().map(face).collect() }
    }

    /// All sheets, and where each of their vertices goes.
    pub fn places(&self) -> impl Iterator<Item = (&Sheet, Vec<(usize, V3)>)> {
        self.faces.iter().map(|face| {
            let of = |(v, p): (usize, V2)| (v, self.at(face, p));
            (&face.sheet, face.sheet.points(self.joins.garment).map(of).collect())
        })
    }

    fn at(&self, face: &LegFace, p: V2) -> V3 {
        let above = p.y - face.fork;
        let height = self.crotch_m() + above;
        let (side, inwards) = self.side_and_inwards(face, p);
        let girth: f64 = self.faces.iter().filter_map(|other| self.width(other, above)).sum();
        let on = |ring: Ring, angle: f64, full: f64| {
            let size = (girth / (full * 0.5 * (ring.half.x + ring.half.y))).max(1.0);
            let (sin, cos) = (angle * inwards).sin_cos();
            ring.centre + V2::new(self.hand * ring.half.x * cos, side * ring.half.y * sin) * size
        };
        let height = self.above_instep(face, side, height, (PI * inwards).sin());
        let about_leg = on(self.leg_ring(height), PI, 2.0 * PI);
        let about_body = on(self.body_ring(height), FRAC_PI_2, PI);
        let place = about_leg.lerp(&about_body, smooth_step(above / PASSAGE_M));
        V3::new(self.hand * (self.hand * place.x).max(BESIDE_MEDIAN_M), place.y, height)
    }

    /// Whether a point of a sheet lies in front (1) or behind (-1), and its share of the way from the outside of the leg to its inside.
    fn side_and_inwards(&self, face: &LegFace, p: V2) -> (f64, f64) {
        let (low, high) = face.row(self.joins.garment, p.y).unwrap_or((p.x, p.x));
        let share = |from: f64| if high > low { (from / (high - low)).clamp(0.0, 1.0) } else { 0.5 };
        match face.side {
            // Outwards is to the right on the back of the right leg and on the front of the left one.
            Some(side) => (side, share(if self.hand * side < 0.0 { high - p.x } else { p.x - low })),
            // Seen from outside the front of the right leg is to the right.
            None => {
                let across = 2.0 * share(p.x - low) - 1.0;
                (if self.hand * across < 0.0 { -1.0 } else { 1.0 }, across.abs())
            }
        }
    }

    /// Where a point begins that would lie at `height` if its leg hung straight, `sin` the sine of its angle from the
    /// side. The front of a leg that is too long is drawn up over the instep, all from half way down.
    fn above_instep(&self, face: &LegFace, side: f64, height: f64, sin: f64) -> f64 {
        let instep = INSTEP_M.min(self.crotch_m());
        let hem = self.crotch_m() + face.hem - face.fork;
        let half_way = 0.5 * (self.crotch_m() + instep);
        if side < 0.0 || height >= half_way || hem >= instep {
            return height;
        }
        let drawn_up = half_way - (half_way - height) * (half_way - instep) / (half_way - hem);
        height + (drawn_up - height) * smooth_step(sin / FRONT)
    }

    /// Height of the fork, m.
    fn crotch_m(&self) -> f64 {
        self.form.body.levels.crotch_m - BELOW_CROTCH_M
    }

    /// Width of a face at a height above its fork.
    fn width(&self, face: &LegFace, above: f64) -> Option<f64> {
        face.row(self.joins.garment, face.fork + above).map(|(low, high)| high - low)
    }

    /// About the leg; above the crotch and below the ankle as there.
    fn leg_ring(&self, height: f64) -> Ring {
        let crotch = self.crotch_m();
        self.ring(height.clamp(ANKLE_M.min(crotch), crotch), |p| p.x * self.hand > 0.0)
    }

    /// About the body; below the crotch as there.
    fn body_ring(&self, height: f64) -> Ring {
        let ring = self.ring(height.max(self.form.body.levels.crotch_m + BELOW_CROTCH_M), |_| true);
        Ring { centre: V2::new(0.0, ring.centre.y), ..ring }
    }

    fn ring(&self, height: f64, takes: impl Fn(&V3) -> bool) -> Ring {
        let band = self.form.between(height - BELOW_CROTCH_M, height + BELOW_CROTCH_M).filter(|p| takes(p));
        let start = (V2::repeat(f64::MAX), V2::repeat(f64::MIN));
        let (low, high) = band.map(|p| p.xy()).fold(start, |(low, high), p| (low.inf(&p), high.sup(&p)));
        if low.x > high.x {
            return Ring { centre: V2::zeros(), half: V2::repeat(CLEARANCE_M) };
        }
        Ring { centre: (low + high) * 0.5, half: (high - low) * 0.5 + V2::repeat(CLEARANCE_M) }
    }
}

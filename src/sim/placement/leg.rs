//! Trouser legs: front and back of a leg about the leg, row by row, their upper part about that half of the body.
//!
//! Rows below the fork (the lower end of the centre seam) go round the leg: from its outside over the front (or back)
//! to its inside. Rows well above it go round half the body: from its side to the median plane. The rows between are
//! blended from one to the other. A row takes its whole half ring, so that all seams start nearly closed. Where a leg
//! would reach below the instep, its front is drawn up there, as when one puts trousers on. Otherwise the toes would
//! start outside the cloth.

use std::f64::consts::{FRAC_PI_2, PI};

use super::body_parts::{Form, Hand};
use super::layout::{Joins, Sheet};
use super::trunk::CLEARANCE_M;
use geom::{V2, V3, smooth_step};
use pattern::{Garment, Role};

geom::constants! {
    "placement.leg",
    const BELOW_CROTCH_M: f64 = 0.02;
    const BESIDE_MEDIAN_M: f64 = 4e-3;
    /// Height over which rows are blended from the leg to the body.
    const PASSAGE_M: f64 = 0.12;
    /// Height of the ankles: cloth that hangs lower at the sides and behind is placed as if there were no foot.
    const ANKLE_M: f64 = 0.09;
    /// Height of the instep: the foot would pierce the front of a leg that began lower.
    const INSTEP_M: f64 = 0.11;
    /// Sine of the angle from the side of a leg beyond which its front lies above the foot.
    const FRONT: f64 = 0.7;
    /// Height of the fork in a leg without a centre seam, as a share of the leg's height.
    const USUAL_FORK: f64 = 0.75;
    /// Share of the width of the row [`INNER_M`] further in from which on a row counts as full.
    const FULL: f64 = 0.9;
    const INNER_M: f64 = 0.04;
    const ROW_M: f64 = 5e-3;
}

/// Front, back, and both in one piece.
pub fn roles(hand: Hand) -> [Role; 3] {
    if hand > 0.0 {
        [Role::LegFrontRight, Role::LegBackRight, Role::LegRight]
    } else {
        [Role::LegFrontLeft, Role::LegBackLeft, Role::LegLeft]
    }
}

/// Sides in the order of [`roles`]: 1 in front, -1 behind, `None` for both in one piece.
pub const FACES: [Option<f64>; 3] = [Some(1.0), Some(-1.0), None];

pub struct Leg<'a> {
    form: &'a Form<'a>,
    joins: &'a Joins<'a>,
    hand: Hand,
    faces: Vec<LegFace>,
}

struct LegFace {
    sheet: Sheet,
    /// 1 in front, -1 behind; `None` for both in one piece, whose middle lies outside.
    side: Option<f64>,
    fork: f64,
    /// Height of the lowest point in the sheet.
    hem: f64,
    /// Heights between which rows go from side to side; beyond them hem and waist edge slope.
    full: [f64; 2],
}

impl LegFace {
    /// Ends of the row at a height; beyond the full rows those of the nearest full row.
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

/// Ellipse about a part of the body at one height.
struct Ring {
    centre: V2,
    half: V2,
}

impl<'a> Leg<'a> {
    /// Takes sheets with their sides, as in [`FACES`]; `others` are the pieces of the other leg.
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

    pub fn places(&self) -> impl Iterator<Item = (&Sheet, Vec<(usize, V3)>)> {
        self.faces.iter().map(|face| {
            let placed = |(v, p): (usize, V2)| (v, self.at(face, p));
            (&face.sheet, face.sheet.points(self.joins.garment).map(placed).collect())
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

    /// Side of a point, 1 in front or -1 behind, and its share of the way from the outside of the leg to its inside.
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

    /// Initial height of a point that would lie at `height` if its leg hung straight; `sin` is the sine of its angle
    /// from the side. The front of a leg that is too long is drawn up over the instep; its lower half shrinks evenly.
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

    fn crotch_m(&self) -> f64 {
        self.form.body.levels.crotch_m - BELOW_CROTCH_M
    }

    fn width(&self, face: &LegFace, above: f64) -> Option<f64> {
        face.row(self.joins.garment, face.fork + above).map(|(low, high)| high - low)
    }

    /// Above the crotch and below the ankle the ring of crotch and ankle.
    fn leg_ring(&self, height: f64) -> Ring {
        let crotch = self.crotch_m();
        self.ring(height.clamp(ANKLE_M.min(crotch), crotch), |p| p.x * self.hand > 0.0)
    }

    /// Below the crotch the ring of the crotch.
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

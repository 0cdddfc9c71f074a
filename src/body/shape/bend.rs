//! Bends of the skin: smooth displacements that give a body a seat, an abdomen, a back or a bust other than the mean.
//!
//! A bend is a bump over heights, and over the front or the back of the sections. The shapes are judgement: they reach as
//! far as the parts of the body that they change, and are so wide that the skin does not fold.

use super::figure::Figure;
use super::loft::Station;
use crate::measure::figure_tape::BLADES;
use crate::people::figures::{ByTrait, Trait};
use geom::{V3, smooth_step};

/// Bump over heights: 1 at `at`, 0 from `down` below and `up` above, m.
struct Bump {
    at: f64,
    down: f64,
    up: f64,
}

impl Bump {
    fn weight(&self, z: f64) -> f64 {
        let t = (z - self.at) / if z < self.at { self.down } else { self.up };
        (1.0 - t * t).max(0.0).powi(2)
    }
}

struct Depth {
    middle: f64,
    half: f64,
}

impl Depth {
    fn of(section: &Station) -> Self {
        Self { middle: section.centre.y, half: section.half_depth }
    }

    /// Weight of the front (`side` 1) or back (-1): 0 at the side of the body, 1 at its front or back.
    fn weight(&self, y: f64, side: f64) -> f64 {
        smooth_step(side * (y - self.middle) / self.half)
    }
}

pub(crate) struct Bend {
    doses: ByTrait<f64>,
    seat: (Bump, Depth),
    abdomen: (Bump, Depth),
    waist: Bump,
    blades: (Bump, Depth),
    chest: (Bump, Depth),
    /// Heights between which the shoulder is moved, and distances from the median plane, m.
    shoulder: [f64; 2],
    shoulder_out: [f64; 2],
    flank: Bump,
    flank_out: f64,
}

impl Bend {
    /// `None` for the standard body.
    pub fn of(figure: &Figure) -> Option<Self> {
        let doses = figure.doses;
        if doses.iter().all(|dose| *dose == 0.0) {
            return None;
        }
        let h = figure.stature();
        let (crotch, hip, waist) = (figure.crotch(), figure.hip(), figure.atlas.waist * h);
        let (chest, nape) = (figure.atlas.chest * h, figure.back_neck_height());
        let trunk = figure.trunk_sections();
        let depth = |i: usize| Depth::of(&trunk[i]);
        let to_waist = waist - hip;
        let abdomen = hip + 0.25 * to_waist;
        let blades = chest + 0.4 * (nape - chest);
        Some(Self {
            doses,
            seat: (Bump { at: hip, down: 0.08 * h, up: to_waist }, depth(1)),
            abdomen: (Bump { at: abdomen, down: abdomen - crotch + 0.02 * h, up: waist - abdomen }, depth(2)),
            waist: Bump { at: waist, down: to_waist, up: BLADES * h - waist },
            blades: (Bump { at: blades, down: 0.10 * h, up: nape - blades }, depth(8)),
            chest: (Bump { at: chest, down: 0.065 * h, up: 0.07 * h }, depth(7)),
            shoulder: [chest + 0.01 * h, figure.shoulder_height() - 0.01 * h],
            shoulder_out: [1.2 * figure.shoulder_line().0, figure.shoulder_x()],
            flank: Bump { at: hip + 0.5 * to_waist, down: to_waist, up: 0.9 * to_waist },
            flank_out: trunk[2].half_width,
        })
    }

    /// Point of trunk or leg after the bends that are alike on both sides.
    pub fn moved(&self, p: V3) -> V3 {
        let dose = |of: Trait| self.doses[of as usize];
        let bumped = |(bump, depth): &(Bump, Depth), side: f64| bump.weight(p.z) * depth.weight(p.y, side);
        let out = p.x.abs();
        // The back behind the bust gives way by as much, so that the chest girth hardly changes.
        let back = dose(Trait::Seat) * bumped(&self.seat, -1.0) + dose(Trait::UpperBack) * bumped(&self.blades, -1.0)
            - dose(Trait::Bust) * bumped(&self.chest, -1.0);
        let front = dose(Trait::Abdomen) * bumped(&self.abdomen, 1.0) + dose(Trait::Bust) * bumped(&self.chest, 1.0);
        let whole = -dose(Trait::SwayBack) * self.waist.weight(p.z);
        let share = |value: f64, [none, all]: [f64; 2]| smooth_step((value - none) / (all - none));
        let tips = dose(Trait::ShoulderForward) * share(p.z, self.shoulder) * share(out, self.shoulder_out);
        V3::new(p.x, p.y + front - back + whole + tips, p.z)
    }

    /// Height by which a point of the right half is raised where the right hip is higher, m.
    pub fn raised(&self, p: V3) -> f64 {
        self.doses[Trait::HighHip as usize] * self.flank.weight(p.z) * smooth_step(p.x / self.flank_out / 0.8)
    }
}

//! Rings of pieces rolled about the trunk or another limb.
//!
//! A sector is rolled to the cone on which it closes, a strip to a cylinder. A ring that is too wide to fit between the
//! arms is rolled to a steeper cone. A ring that is gathered into an edge goes in waves about a cone that begins at
//! that edge.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use super::attachment::body_radius as body_radius_about;
use super::body_parts::{Axis, Cylindrical, Form};
use super::interval::bounds;
use super::limb::Limb;
use super::piece_ring::{Flat, Polar};
use super::rows::InRow;
use geom::{V2, V3};

geom::constants! {
    "placement.round",
    /// Share of a turn that a ring takes: one seam starts open.
    pub const ROUND: f64 = 0.95;
    /// Least distance from the skin.
    const CLEARANCE_M: f64 = 0.02;
    /// Half height of the band of the body that a point must clear.
    const BAND_M: f64 = 0.02;
    const LEAST_SPAN_RAD: f64 = 0.1;
    /// Greatest and least sine of the half angle of a cone, where a wide skirt would take more, and the steps between.
    const SPREADS: (f64, f64, u32) = (0.35, 0.2, 5);
    /// Sine of the half angle of the cone on which a sector starts, over that of the cone on which it closes without
    /// waves. On the latter its hem would turn in.
    const STEEPER: f64 = 0.7;
    /// Waves of a skirt that is wider than its cone.
    const WAVES: f64 = 8.0;
    const SAMPLES: u32 = 32;
}

/// Places a ring with its upper edge at height `top`, no farther from the axis than `within`.
pub fn place(form: &Form, flat: &Flat, top: f64, within: Option<f64>) -> Vec<(usize, V3)> {
    let axis = form.trunk_axis();
    let unrolled = Unrolled::of(flat);
    let off_body = |rolled: Vec<Rolled>| {
        let short = rolled.iter().map(|p| body_radius(form, &axis, top - p.below) + CLEARANCE_M - p.radius);
        let wider = short.fold(0.0, f64::max);
        rolled.into_iter().map(|p| Rolled { radius: p.radius + wider, ..p }).collect::<Vec<_>>()
    };
    let room = |rolled: &[Rolled]| {
        rolled.iter().map(|p| arm_radius(form, &axis, top - p.below) - p.radius).fold(f64::INFINITY, f64::min)
    };
    let (wide, narrow, steps) = SPREADS;
    let spread = |k: u32| wide + (narrow - wide) * f64::from(k) / f64::from(steps);
    let cones = (0..=steps).map(|k| off_body(unrolled.rolled(spread(k), within.unwrap_or(f64::INFINITY))));
    // The widest cone that is clear of the arms, else the one that comes nearest to it.
    let clear = |cone: &[Rolled]| room(cone).min(CLEARANCE_M);
    let rolled = cones.rev().max_by(|a, b| clear(a).total_cmp(&clear(b))).unwrap_or_default();
    rolled.iter().map(|p| (p.vertex, axis.point(p.angle, p.radius, top - p.below))).collect()
}

pub struct Held {
    pub vertex: usize,
    pub partner: Cylindrical,
}

pub fn mean(held: &[Held], coordinate: fn(&Cylindrical) -> f64) -> f64 {
    held.iter().map(|held| coordinate(&held.partner)).sum::<f64>() / held.len() as f64
}

/// Places a ring about a limb; it hangs from the partners of `held`.
pub fn place_about(form: &Form, limb: &Limb, flat: &Flat, held: &[Held]) -> Vec<(usize, V3)> {
    let (within, top) = (mean(held, |p| p.radius), mean(held, |p| p.height));
    let rolled = Unrolled::of(flat).rolled(SPREADS.0, within);
    let angles: BTreeMap<usize, f64> = rolled.iter().map(|p| (p.vertex, p.angle)).collect();
    let (sin, cos) = held.iter().fold((0.0, 0.0), |(sin, cos), Held { vertex, partner }| {
        let turn = partner.angle - angles.get(vertex).unwrap_or(&0.0);
        (sin + turn.sin(), cos + turn.cos())
    });
    let lowest = rolled.iter().map(|p| top - p.below).fold(top, f64::min);
    let skin = body_radius_about(form, limb, lowest, top) + CLEARANCE_M;
    let wider = rolled.iter().map(|p| skin - p.radius).fold(0.0, f64::max);
    let turn = sin.atan2(cos);
    rolled.iter().map(|p| (p.vertex, limb.point(p.angle + turn, p.radius + wider, top - p.below))).collect()
}

struct OnCone {
    vertex: usize,
    /// From the front to the right seen from outside, rad.
    angle: f64,
    /// Radius of the circle that is as long as the ring there, m.
    radius: f64,
    /// Distance from the upper edge along the cone, m.
    length: f64,
}

struct Unrolled {
    points: Vec<OnCone>,
    /// Radius of the upper edge, m.
    upper: f64,
    /// Greatest distance from the upper edge, m.
    height: f64,
    /// Sine of the cone's half angle.
    spread: f64,
}

struct Rolled {
    vertex: usize,
    /// From the front to the right seen from outside, rad.
    angle: f64,
    radius: f64,
    /// Below the piece's upper edge, m.
    below: f64,
}

impl Unrolled {
    fn of(flat: &Flat) -> Self {
        match flat {
            Flat::Sector(points) => {
                let [low, high] = bounds(points.iter().map(|p| p.angle));
                let [inner, outer] = bounds(points.iter().map(|p| p.radius));
                let share = (high - low).max(LEAST_SPAN_RAD) / (TAU * ROUND);
                let on_cone = |&Polar { vertex, angle, radius }: &Polar| OnCone {
                    vertex,
                    angle: angle / share,
                    radius: radius * share,
                    length: radius - inner,
                };
                let points = points.iter().map(on_cone).collect();
                Self { points, upper: inner * share, height: outer - inner, spread: share }
            }
            Flat::Strip(points) => {
                let [left, right] = bounds(points.iter().map(|(_, p)| p.x));
                let [low, high] = bounds(points.iter().map(|(_, p)| p.y));
                let radius = ((right - left) / (TAU * ROUND)).max(1e-3);
                let on_cylinder =
                    |&(vertex, p): &(usize, V2)| OnCone { vertex, angle: p.x / radius, radius, length: high - p.y };
                let points = points.iter().map(on_cylinder).collect();
                Self { points, upper: radius, height: high - low, spread: 0.0 }
            }
            Flat::Rows(points) => {
                let [top, hem] = bounds(points.iter().map(|p| p.below_m));
                let on_cone = |p: &InRow| OnCone {
                    vertex: p.vertex,
                    angle: p.share * TAU * ROUND,
                    radius: p.row_m / (TAU * ROUND),
                    length: p.below_m - top,
                };
                let (upper, spread) = (flat.inner_m() / (TAU * ROUND), flat.turn_rad() / TAU);
                Self { points: points.iter().map(on_cone).collect(), upper, height: hem - top, spread }
            }
        }
    }

    /// Rolls the ring to a cone, the tip above. The sine of its half angle is at most `spread`, its upper radius at most
    /// `within`. A ring that is longer than the cone's circle goes in waves.
    fn rolled(&self, spread: f64, within: f64) -> Vec<Rolled> {
        let upper = self.upper.min(within);
        let gathered = (self.upper - upper) / self.height.max(f64::MIN_POSITIVE);
        let spread = (STEEPER * self.spread + gathered).min(spread);
        let steep = (1.0 - spread * spread).sqrt();
        let roll = |&OnCone { vertex, angle, radius, length }: &OnCone| {
            let mean = upper + length * spread;
            let wave = wave(radius / mean) * (WAVES * angle).cos();
            Rolled { vertex, angle, radius: mean * (1.0 + wave), below: length * steep }
        };
        self.points.iter().map(roll).collect()
    }
}

/// Amplitude over the radius of waves about a circle that are `ratio` times as long as the circle.
fn wave(ratio: f64) -> f64 {
    let length = |height: f64| {
        let slope = |k: u32| height * WAVES * (TAU * f64::from(k) / f64::from(SAMPLES)).sin();
        (0..SAMPLES).map(|k| slope(k).hypot(1.0)).sum::<f64>() / f64::from(SAMPLES)
    };
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..30 {
        let middle = 0.5 * (low + high);
        if length(middle) < ratio { low = middle } else { high = middle }
    }
    low
}

fn body_radius(form: &Form, axis: &Axis, height: f64) -> f64 {
    form.between(height - BAND_M, height + BAND_M).map(|p| axis.coordinates(p).radius).fold(0.0, f64::max)
}

/// Least distance of the arms' skin from the axis of the trunk about a height.
fn arm_radius(form: &Form, axis: &Axis, height: f64) -> f64 {
    let near = form.arms.iter().filter(|p| (p.z - height).abs() < BAND_M);
    near.map(|p| axis.coordinates(p).radius).fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laboratory::{self, sheets::sheet};
    use crate::placement::{self, Bend};
    use body::{self, Measurements, Sex};
    use geom::Surface;
    use pattern::Role;
    use pattern::garment::SeamMesh;

    #[test]
    fn a_skirt_sewn_to_itself_closes_round_the_body() {
        let body = body::build(&Measurements::of(Sex::Female, 1.65)).expect("a body");
        let surface = Surface::new(&body.mesh).expect("a closed body");
        let (columns, rows) = (40, 10);
        let form = Form::of(&body);
        // A strip of 1 by 0.25 bent to a sector, or left as it is.
        let check = |bent: &dyn Fn(f64, f64) -> V2, is_within_arms: bool| {
            let (flat, triangles) = sheet(columns, rows, 1.0 / columns as f64);
            let rest: Vec<V2> = flat.iter().map(|p| bent(p.x, p.y)).collect();
            let mut garment = laboratory::garment((rest, triangles));
            garment.pieces[0].role = Role::Other;
            let pairs = (0..=rows).map(|row| [row * (columns + 1), row * (columns + 1) + columns]).collect();
            garment.seams = vec![SeamMesh { name: "side".to_owned(), pairs }];
            let x = placement::place(&body, &garment, &Bend::default()).expect("it goes round");
            let inside = x.iter().filter(|p| surface.signed_distance(p) < 0.0).count();
            assert_eq!(inside, 0, "of {} inside the body", x.len());
            let gap = garment.seams[0].pairs.iter().map(|[a, b]| (x[*a] - x[*b]).norm()).fold(0.0, f64::max);
            assert!(gap < 0.4, "the seam starts {gap} m open");
            // Outwards is outside: counter-clockwise triangles face away from the axis.
            let [a, b, c] = garment.triangles[garment.triangles.len() / 2].map(|v| x[v]);
            assert!((b - a).cross(&(c - a)).dot(&V3::new(a.x, a.y, 0.0)) > 0.0, "inside out");
            let clears = |p: &V3| form.trunk_axis().coordinates(p).radius < arm_radius(&form, &form.trunk_axis(), p.z);
            assert!(!is_within_arms || x.iter().all(clears), "about the arms");
            // No triangle reaches over the gap that is left open.
            let angle = |v: &usize| form.trunk_axis().coordinates(&x[*v]).angle;
            for triangle in &garment.triangles {
                let [low, high] = bounds(triangle.iter().map(angle));
                let spread = (high - low).min(TAU - (high - low));
                assert!(spread < 0.3, "a triangle spans {spread} rad");
            }
            // The hem lies lower than the waist.
            assert!(x[0].z < x[rows * (columns + 1)].z, "upside down");
        };
        check(&|u, v| V2::new(u, v), false);
        let sector = |angle: f64, inner: f64| {
            move |u: f64, v: f64| {
                let (sin, cos) = (angle * (u - 0.5)).sin_cos();
                V2::new(sin, -cos) * (inner + 0.25 - v) + V2::new(0.2, 0.7)
            }
        };
        check(&sector(0.25 * TAU, 0.6), false);
        check(&sector(0.5 * TAU, 0.26), true);
        check(&sector(TAU, 0.13), true);
    }

    #[test]
    fn waves_are_as_long_as_asked() {
        assert!(wave(1.0) < 1e-4);
        for ratio in [1.1, 1.5, 3.0] {
            let place = |k: u32| {
                let angle = TAU * f64::from(k) / 20_000.0;
                let radius = 1.0 + wave(ratio) * (WAVES * angle).cos();
                V2::new(angle, radius)
            };
            // Unrolled: the waves lie along a line, not about a circle.
            let length: f64 = (0..20_000).map(|k| (place(k + 1) - place(k)).norm()).sum();
            assert!((length / (ratio * TAU) - 1.0).abs() < 2e-3, "{ratio}: {}", length / TAU);
        }
    }
}

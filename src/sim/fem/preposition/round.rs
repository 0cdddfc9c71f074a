//! Rings of pieces rolled about the trunk.
//!
//! A sector is rolled to the cone on which it closes, and what is wider than fits between the arms to a steeper cone, about which
//! it goes in waves; a strip to a cylinder.

use std::f64::consts::TAU;

use super::form::{Axis, Form};
use super::ring::{Flat, bounds};
use crate::geom::{V2, V3};

/// Share of a turn that a ring takes: its last seam starts open.
const ROUND: f64 = 0.95;
/// Least distance from the skin, m.
const CLEARANCE_M: f64 = 0.02;
/// Half height of the band of the body that a point keeps clear of, m.
const BAND_M: f64 = 0.02;
/// Least angle that a sector is taken to span, rad.
const LEAST_SPAN_RAD: f64 = 0.1;
/// Greatest and least sine of the angle between a cone and its axis, where a wide skirt would take more, and the steps between.
const SPREADS: (f64, f64, u32) = (0.35, 0.2, 5);
/// Sine of the steepest cone that a sector starts on over that of the one on which it closes without waves: from there its hem would turn in.
const STEEPER: f64 = 0.7;
/// Waves of a skirt that is wider than its cone, and the directions in which their length is taken.
const WAVES: (f64, u32) = (8.0, 32);

/// Vertices of a ring with their places, its upper edge at the height `top` and, of a sector, no further from the axis than `within`.
pub fn place(form: &Form, flat: &Flat, top: f64, within: Option<f64>) -> Vec<(usize, V3)> {
    let axis = form.trunk_axis();
    let off_body = |rolled: Vec<Rolled>| {
        let short = rolled.iter().map(|p| body_radius(form, &axis, top - p.below) + CLEARANCE_M - p.radius);
        let wider = short.fold(0.0, f64::max);
        rolled.into_iter().map(|p| Rolled { radius: p.radius + wider, ..p }).collect::<Vec<_>>()
    };
    let room = |rolled: &[Rolled]| {
        rolled.iter().map(|p| arm_radius(form, &axis, top - p.below) - p.radius).fold(f64::INFINITY, f64::min)
    };
    let rolled = match flat {
        Flat::Sector(points) => {
            let (wide, narrow, steps) = SPREADS;
            let spread = |k: u32| wide + (narrow - wide) * f64::from(k) / f64::from(steps);
            let cones = (0..=steps).map(|k| off_body(about(points, spread(k), within)));
            // The widest that is clear of the arms, else the one that comes nearest to it.
            let clear = |cone: &[Rolled]| room(cone).min(CLEARANCE_M);
            cones.rev().max_by(|a, b| clear(a).total_cmp(&clear(b))).unwrap_or_default()
        }
        Flat::Strip(points) => off_body(along(points)),
    };
    rolled.iter().map(|p| (p.vertex, axis.point(p.angle, p.radius, top - p.below))).collect()
}

/// A point on the cone or cylinder.
struct Rolled {
    vertex: usize,
    /// From the front to the right seen from outside, rad.
    angle: f64,
    radius: f64,
    /// Below the piece's upper edge, m.
    below: f64,
}

/// On a cone, the tip above, that spreads by at most the sine `spread` from `within` at most; in waves where the sector is wider.
fn about(points: &[(usize, f64, f64)], spread: f64, within: Option<f64>) -> Vec<Rolled> {
    let [low, high] = bounds(points.iter().map(|p| p.1));
    let [inner, _] = bounds(points.iter().map(|p| p.2));
    let share = (high - low).max(LEAST_SPAN_RAD) / (TAU * ROUND);
    let spread = (STEEPER * share).min(spread);
    let upper = within.unwrap_or(f64::INFINITY).min(inner * share);
    let steep = (1.0 - spread * spread).sqrt();
    let roll = |&(vertex, angle, length): &(usize, f64, f64)| {
        let angle = angle / share;
        let mean = upper + (length - inner) * spread;
        let wave = wave(length * share / mean) * (WAVES.0 * angle).cos();
        Rolled { vertex, angle, radius: mean * (1.0 + wave), below: (length - inner) * steep }
    };
    points.iter().map(roll).collect()
}

/// Height of waves about a circle over its radius that makes them `ratio` times as long as the circle.
fn wave(ratio: f64) -> f64 {
    let (count, samples) = WAVES;
    let length = |height: f64| {
        let at = |k: u32| height * count * (TAU * f64::from(k) / f64::from(samples)).sin();
        (0..samples).map(|k| at(k).hypot(1.0)).sum::<f64>() / f64::from(samples)
    };
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..30 {
        let middle = 0.5 * (low + high);
        if length(middle) < ratio { low = middle } else { high = middle }
    }
    low
}

/// On a cylinder.
fn along(points: &[(usize, V2)]) -> Vec<Rolled> {
    let [left, right] = bounds(points.iter().map(|(_, p)| p.x));
    let [_, high] = bounds(points.iter().map(|(_, p)| p.y));
    let radius = ((right - left) / (TAU * ROUND)).max(1e-3);
    let middle = 0.5 * (left + right);
    let roll =
        |&(vertex, p): &(usize, V2)| Rolled { vertex, angle: (p.x - middle) / radius, radius, below: high - p.y };
    points.iter().map(roll).collect()
}

/// Greatest distance of the trunk's skin from its axis about a height.
fn body_radius(form: &Form, axis: &Axis, height: f64) -> f64 {
    form.between(height - BAND_M, height + BAND_M).map(|p| axis.coordinates(p).1).fold(0.0, f64::max)
}

/// Least distance of the arms' skin from the axis of the trunk about a height.
fn arm_radius(form: &Form, axis: &Axis, height: f64) -> f64 {
    let near = form.arms.iter().filter(|p| (p.z - height).abs() < BAND_M);
    near.map(|p| axis.coordinates(p).1).fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::{self, Measurements, Sex};
    use crate::geom::Surface;
    use crate::pattern::Role;
    use crate::pattern::garment::SeamMesh;
    use crate::sim::fem::{Params, preposition};
    use crate::sim::laboratory::{self, sheets::sheet};

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
            let x = preposition::place(&body, &garment, &Params::default()).expect("it goes round");
            let inside = x.iter().filter(|p| surface.signed_distance(p) < 0.0).count();
            assert_eq!(inside, 0, "of {} inside the body", x.len());
            let gap = garment.seams[0].pairs.iter().map(|[a, b]| (x[*a] - x[*b]).norm()).fold(0.0, f64::max);
            assert!(gap < 0.4, "the seam starts {gap} m open");
            // Outwards is outside: counter-clockwise triangles face away from the axis.
            let [a, b, c] = garment.triangles[garment.triangles.len() / 2].map(|v| x[v]);
            assert!((b - a).cross(&(c - a)).dot(&V3::new(a.x, a.y, 0.0)) > 0.0, "inside out");
            let clears = |p: &V3| form.trunk_axis().coordinates(p).1 < arm_radius(&form, &form.trunk_axis(), p.z);
            assert!(!is_within_arms || x.iter().all(clears), "about the arms");
            // No triangle reaches over the gap that is left open.
            let angle = |v: &usize| form.trunk_axis().coordinates(&x[*v]).0;
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
            let at = |k: u32| {
                let angle = TAU * f64::from(k) / 20_000.0;
                let radius = 1.0 + wave(ratio) * (WAVES.0 * angle).cos();
                V2::new(angle, radius)
            };
            // Unrolled: the waves lie along a line, not about a circle.
            let length: f64 = (0..20_000).map(|k| (at(k + 1) - at(k)).norm()).sum();
            assert!((length / (ratio * TAU) - 1.0).abs() < 2e-3, "{ratio}: {}", length / TAU);
        }
    }
}

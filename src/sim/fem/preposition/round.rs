//! Pieces that go round the trunk alone, sewn to themselves: circle skirts, tubes.
//!
//! The seam says what they are: the motion in the plane that takes one of its sides onto the other is a turn about the middle
//! of a circle skirt, or a shift along a tube. The piece is rolled to the cone or the cylinder on which that closes it,
//! with the seam behind.

use std::f64::consts::TAU;

use super::form::Form;
use super::sheet::Joins;
use crate::geom::{V2, V3};

/// Share of a turn that the piece takes: its seam starts open.
const ROUND: f64 = 0.95;
/// Least distance from the skin, m.
const CLEARANCE_M: f64 = 0.02;
/// Half height of the band of the body that a point keeps clear of, m.
const BAND_M: f64 = 0.02;
/// A turn by less than this is a shift, rad.
const SHIFT_RAD: f64 = 0.05;
/// Sides of a seam nearer than this lie on each other: a full circle, cut open, m.
const CUT_M: f64 = 1e-3;
/// Least slope of a cone: a full circle lies nearly flat.
const SLOPE: f64 = 0.1;

/// Places of the vertices of `piece`, its upper edge at the waist.
pub fn place(form: &Form, joins: &Joins, piece: usize) -> Vec<V3> {
    let rest = &joins.garment.rest;
    let points: Vec<V2> = joins.garment.pieces[piece].vertices.clone().map(|v| rest[v]).collect();
    let rolled = match apex(&joins.between(piece, piece), rest, &points) {
        Some((apex, front)) => about(apex, front, &points),
        None => along(joins.up(piece, V2::y()), &points),
    };
    let top = form.body.levels.waist_m;
    let axis = form.trunk_axis();
    let short = rolled.iter().map(|p| body_radius(form, top - p.below) + CLEARANCE_M - p.radius);
    let wider = short.fold(0.0, f64::max);
    rolled.iter().map(|p| axis.point(p.angle, p.radius + wider, top - p.below)).collect()
}

/// A point on the cone or cylinder.
struct Rolled {
    /// From the front to the right seen from outside, rad.
    angle: f64,
    radius: f64,
    /// Below the piece's upper edge, m.
    below: f64,
}

/// The point about which one side of a seam turns onto the other, and the direction from it to the middle of the piece; `None`
/// where the side is shifted.
fn apex(pairs: &[[usize; 2]], rest: &[V2], points: &[V2]) -> Option<(V2, V2)> {
    let n = pairs.len().max(1) as f64;
    let [to, from] = [0, 1].map(|side| pairs.iter().map(|pair| rest[pair[side]]).sum::<V2>() / n);
    let (mut dot, mut perp) = (0.0, 0.0);
    for pair in pairs {
        let (a, b) = (rest[pair[0]] - to, rest[pair[1]] - from);
        dot += b.dot(&a);
        perp += b.perp(&a);
    }
    let turn = perp.atan2(dot);
    if (to - from).norm() < CUT_M {
        let centre = points.iter().sum::<V2>() / points.len().max(1) as f64;
        return Some((centre, centre - to));
    }
    if turn.abs() < SHIFT_RAD {
        return None;
    }
    // The middle of the base of an equal-legged triangle with this angle at its tip.
    let base = to - from;
    let height = 0.5 / (0.5 * turn).tan();
    let apex = (to + from) * 0.5 + V2::new(-base.y, base.x) * height;
    Some((apex, points.iter().map(|p| p - apex).sum()))
}

/// On a cone, the apex above.
fn about(apex: V2, front: V2, points: &[V2]) -> Vec<Rolled> {
    let polar = |p: &V2| {
        let d = p - apex;
        (front.perp(&d).atan2(front.dot(&d)), d.norm())
    };
    let polar: Vec<(f64, f64)> = points.iter().map(polar).collect();
    let span = 2.0 * polar.iter().map(|p| p.0.abs()).fold(SHIFT_RAD, f64::max);
    let inner = polar.iter().map(|p| p.1).fold(f64::MAX, f64::min);
    let share = span / (TAU * ROUND);
    let slope = (1.0 - share * share).max(SLOPE * SLOPE).sqrt();
    let roll = |(angle, length): (f64, f64)| Rolled {
        angle: angle / share,
        radius: length * share,
        below: (length - inner) * slope,
    };
    polar.into_iter().map(roll).collect()
}

/// On a cylinder.
fn along(up: V2, points: &[V2]) -> Vec<Rolled> {
    let upright: Vec<V2> = points.iter().map(|p| V2::new(p.x * up.y - p.y * up.x, p.dot(&up))).collect();
    let low = upright.iter().fold(V2::repeat(f64::MAX), |low, p| low.inf(p));
    let high = upright.iter().fold(V2::repeat(f64::MIN), |high, p| high.sup(p));
    let radius = ((high.x - low.x) / (TAU * ROUND)).max(1e-3);
    let middle = 0.5 * (low.x + high.x);
    upright.iter().map(|p| Rolled { angle: (p.x - middle) / radius, radius, below: high.y - p.y }).collect()
}

/// Greatest distance of the trunk's skin from its axis about a height.
fn body_radius(form: &Form, height: f64) -> f64 {
    let axis = form.trunk_axis();
    let near = form.between(height - BAND_M, height + BAND_M);
    near.map(|p| (p.x - axis.origin.x).hypot(p.y - axis.origin.y)).fold(0.0, f64::max)
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
        // A strip of 1 by 0.25 bent to a sector, or left as it is.
        let check = |bent: &dyn Fn(f64, f64) -> V2| {
            let (flat, triangles) = sheet(columns, rows, 1.0 / columns as f64);
            let rest: Vec<V2> = flat.iter().map(|p| bent(p.x, p.y)).collect();
            let mut garment = laboratory::garment((rest, triangles));
            garment.pieces[0].role = Role::Other;
            let pairs = (0..=rows).map(|row| [row * (columns + 1), row * (columns + 1) + columns]).collect();
            garment.seams = vec![SeamMesh { name: "side".to_owned(), pairs }];
            let x = preposition::place(&body, &garment, &Params::default()).expect("it goes round");
            // A wide skirt may start in the hands.
            let inside = x.iter().filter(|p| surface.signed_distance(p) < 0.0).count();
            assert!(50 * inside < x.len(), "{inside} of {} inside the body", x.len());
            let gap = garment.seams[0].pairs.iter().map(|[a, b]| (x[*a] - x[*b]).norm()).fold(0.0, f64::max);
            assert!(gap < 0.4, "the seam starts {gap} m open");
            // Outwards is outside: counter-clockwise triangles face away from the axis.
            let [a, b, c] = garment.triangles[garment.triangles.len() / 2].map(|v| x[v]);
            assert!((b - a).cross(&(c - a)).dot(&V3::new(a.x, a.y, 0.0)) > 0.0, "inside out");
            // The hem lies lower than the waist.
            assert!(x[0].z < x[rows * (columns + 1)].z, "upside down");
        };
        check(&|u, v| V2::new(u, v));
        let sector = |angle: f64| {
            move |u: f64, v: f64| {
                let (sin, cos) = (angle * (u - 0.5)).sin_cos();
                V2::new(sin, -cos) * (0.6 / angle + 0.5 - v) + V2::new(0.2, 0.7)
            }
        };
        check(&sector(0.5 * TAU));
        check(&sector(0.25 * TAU));
        check(&sector(TAU));
    }
}

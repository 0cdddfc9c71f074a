//! Continuous collision detection (CCD): whether two primitives of the cloth meet on the straight path between two
//! positions.

use super::distance::{ClosestPoints, Primitives};
use geom::V3;

geom::constants! {
    "contact.ccd",
    /// Least distance of a pair on its path, as a share of its distance at the start.
    const KEPT_SHARE: f64 = 0.1;
    /// Share of the remaining distance that one advance uses up.
    const ADVANCE_SHARE: f64 = 0.9;
    /// Least distance, as a share of the present one, of a pair that may come no nearer: a margin for rounding.
    const NEARLY: f64 = 0.999;
    /// Distance below which two primitives touch: a twentieth of the distance to which the strongest contact force
    /// presses layers.
    pub const TOUCHING_M: f64 = 1e-6;
    /// Greatest number of advances. A pair that takes more moves so near that it may count as meeting.
    const MAX_ITERATIONS: usize = 40;
}

/// True if a pair comes nearer than a tenth of its distance on the path from `x` to `y`.
pub fn collides(x: &[V3], y: &[V3], primitives: Primitives) -> bool {
    free_share(x, y, primitives, 0.0) < 1.0
}

/// Share of the path from `x` to `y` that a pair can take, its vertices moving uniformly. It ends where the distance
/// falls below about a tenth of that at the start, or below `least_m`. A pair nearer than `least_m` already may come no
/// nearer. Additive conservative advancement: each advance is too short to use up the distance [Li, Kaufman, Jiang
/// 2021].
///
/// A pair that touches at the start is not limited. It would stop every step of the whole cloth, and crossings that
/// result are drawn out again.
pub fn free_share(x: &[V3], y: &[V3], primitives: Primitives, least_m: f64) -> f64 {
    let vertices = primitives.vertices();
    let mut places = vertices.map(|v| x[v]);
    let mut moves = vertices.map(|v| y[v] - x[v]);
    // A common translation changes no distance.
    let mean = moves.iter().sum::<V3>() / 4.0;
    moves.iter_mut().for_each(|d| *d -= mean);
    let [a, b, c, d] = moves.map(|d| d.norm());
    let closing = match primitives {
        Primitives::VertexTriangle(_) => a + b.max(c).max(d),
        Primitives::EdgeEdge(_) => a.max(b) + c.max(d),
    };
    let mut distance = ClosestPoints::at(&places, primitives).gap.norm();
    let least = (KEPT_SHARE * distance).max(least_m.min(NEARLY * distance));
    if distance - least > closing || distance < TOUCHING_M {
        return 1.0;
    }
    let mut time = 0.0;
    for _ in 0..MAX_ITERATIONS {
        let advance = ADVANCE_SHARE * (distance - least) / closing;
        if time + advance >= 1.0 {
            return 1.0;
        }
        time += advance;
        places.iter_mut().zip(&moves).for_each(|(p, d)| *p += d * advance);
        let before = std::mem::replace(&mut distance, ClosestPoints::at(&places, primitives).gap.norm());
        if distance <= before && distance <= least + KEPT_SHARE * least {
            break;
        }
    }
    time
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_passes_does_not_meet_and_what_goes_through_does() {
        let triangle = [V3::zeros(), V3::new(0.02, 0.0, 0.0), V3::new(0.0, 0.02, 0.0)];
        let check = |from: [f64; 3], to: [f64; 3], expect: bool| {
            let with = |p: [f64; 3]| [vec![V3::from(p)], triangle.to_vec()].concat();
            let pair = Primitives::VertexTriangle([0, 1, 2, 3]);
            assert_eq!(collides(&with(from), &with(to), pair), expect, "{from:?} to {to:?}");
            // Moved together with the triangle it never collides.
            let [x, mut y] = [from, from].map(with);
            y.iter_mut().for_each(|p| *p += V3::new(0.3, -0.2, 1.0));
            assert!(!collides(&x, &y, pair));
        };
        check([0.005, 0.005, 1e-3], [0.005, 0.005, -1e-3], true);
        check([0.005, 0.005, 1e-3], [0.005, 0.005, 5e-5], true);
        check([0.005, 0.005, 1e-3], [0.005, 0.005, 2e-4], false);
        check([0.002, 0.002, 1e-3], [0.009, 0.009, 1e-3], false);
        check([-0.005, 0.005, 1e-3], [-0.005, 0.005, -1e-3], false);
        check([-0.005, 0.005, 1e-3], [0.005, 0.005, -1e-3], true);
        let crossed = |height: f64| {
            let [a, b] = [V3::new(-0.01, 0.0, height), V3::new(0.01, 0.0, height)];
            [a, b, V3::new(0.0, -0.01, 0.0), V3::new(0.0, 0.01, 0.0)]
        };
        let edges = Primitives::EdgeEdge([0, 1, 2, 3]);
        assert!(collides(&crossed(1e-3), &crossed(-2e-3), edges));
        assert!(!collides(&crossed(1e-3), &crossed(4e-4), edges));
    }

    #[test]
    fn a_pair_comes_no_nearer_than_asked_for_and_what_is_nearer_may_leave() {
        let triangle = [V3::zeros(), V3::new(0.02, 0.0, 0.0), V3::new(0.0, 0.02, 0.0)];
        let share = |from: f64, to: f64| {
            let with = |height: f64| [vec![V3::new(0.005, 0.005, height)], triangle.to_vec()].concat();
            free_share(&with(from), &with(to), Primitives::VertexTriangle([0, 1, 2, 3]), 1e-4)
        };
        let check = |from: f64, to: f64, low: f64, high: f64| {
            let share = share(from, to);
            assert!((low..=high).contains(&share), "{from} to {to}: {share}");
        };
        check(5e-4, -5e-4, 0.3, 0.4);
        check(5e-5, -5e-5, 0.0, 1e-3);
        check(5e-5, 1e-3, 1.0, 1.0);
        check(1e-3, 5e-4, 1.0, 1.0);
    }
}

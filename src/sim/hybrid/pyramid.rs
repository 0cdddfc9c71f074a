//! Pyramid coordinates: a vertex by its ring of neighbours [T 5.4.3, Sheffer & Kraevoy 2004].
//!
//! The ring is projected along its normal. Mean value coordinates of the projected vertex give its foot in the ring's
//! plane, and the angles at which it sees its neighbours give its height. The coordinates are invariant under rigid
//! motions, and the shape is reconstructed from them. With the weights and lengths of the pattern (5.7, 5.8) and the
//! angles in between (5.9) a garment gets its size back while its curvature stays.

use std::collections::BTreeMap;

use geom::{V2, V3};

#[derive(Clone, Debug)]
struct Apex {
    vertex: usize,
    /// Neighbours in cyclic order.
    ring: Vec<usize>,
    /// Mean value weight of each neighbour (5.7), with sum 1.
    weights: Vec<f64>,
    /// Length of the edge to each neighbour in the pattern (5.8).
    lengths_m: Vec<f64>,
}

#[derive(Clone, Copy)]
struct Corner {
    /// rad.
    angle: f64,
    next_m: f64,
    last_m: f64,
}

#[derive(Clone, Debug)]
pub struct Pyramids {
    apexes: Vec<Apex>,
}

struct Base {
    normal: V3,
    /// Mean of the ring.
    centre: V3,
}

impl Base {
    /// `None` for a ring that spans no area.
    fn of(ring: &[usize], x: &[V3]) -> Option<Self> {
        let n = ring.len();
        let centre = ring.iter().map(|&v| x[v]).sum::<V3>() / n as f64;
        let area: V3 = (0..n).map(|i| (x[ring[i]] - centre).cross(&(x[ring[(i + 1) % n]] - centre))).sum();
        Some(Self { normal: area.try_normalize(1e-18)?, centre })
    }

    fn flat(&self, way: &V3) -> V3 {
        way - self.normal * way.dot(&self.normal)
    }
}

/// Weights (5.7) of the vectors from a point to its ring, in one plane; `None` if their sum is not positive.
fn mean_value_weights(arms: &[V3]) -> Option<Vec<f64>> {
    let n = arms.len();
    let half_tangent = |i: usize| {
        let (a, b) = (arms[i], arms[(i + 1) % n]);
        // tan(angle / 2) = sin / (1 + cos).
        a.cross(&b).norm() / (a.norm() * b.norm() + a.dot(&b)).max(1e-12)
    };
    let raw: Vec<f64> =
        (0..n).map(|i| (half_tangent((i + n - 1) % n) + half_tangent(i)) / arms[i].norm().max(1e-9)).collect();
    let sum: f64 = raw.iter().sum();
    (sum.is_finite() && sum > 0.0).then(|| raw.iter().map(|w| w / sum).collect())
}

impl Pyramids {
    /// Takes weights and lengths from the shape `x` itself.
    pub fn of_shape(triangles: &[[usize; 3]], x: &[V3]) -> Self {
        let rings = rings(triangles, x.len());
        let apex = |(vertex, ring): (usize, Vec<usize>)| {
            let base = Base::of(&ring, x)?;
            let arms: Vec<V3> = ring.iter().map(|&w| base.flat(&(x[w] - x[vertex]))).collect();
            let weights = mean_value_weights(&arms)?;
            let lengths_m = ring.iter().map(|&w| (x[w] - x[vertex]).norm()).collect();
            Some(Apex { vertex, ring, weights, lengths_m })
        };
        Self { apexes: rings.into_iter().filter_map(apex).collect() }
    }

    /// Takes weights and lengths from the pattern: `rest` are the corners of each triangle in its piece's plane.
    ///
    /// Round a vertex on a seam the triangles are laid side by side with their own angles, whatever these add up to.
    pub fn of_pattern(triangles: &[[usize; 3]], rest: &[[V2; 3]], count: usize) -> Self {
        let mut fans = vec![BTreeMap::new(); count];
        for (t, at) in triangles.iter().zip(rest) {
            for k in 0..3 {
                let [next, last] = [at[(k + 1) % 3] - at[k], at[(k + 2) % 3] - at[k]];
                let angle = next.perp(&last).abs().atan2(next.dot(&last));
                fans[t[k]].insert(t[(k + 1) % 3], Corner { angle, next_m: next.norm(), last_m: last.norm() });
            }
        }
        let apex = |(vertex, ring): (usize, Vec<usize>)| {
            let fan: Vec<Corner> = ring.iter().map(|w| fans[vertex].get(w).copied()).collect::<Option<_>>()?;
            let n = ring.len();
            // A neighbour's length is the mean of those in the triangles on both its sides.
            let lengths_m: Vec<f64> = (0..n).map(|i| (fan[i].next_m + fan[(i + n - 1) % n].last_m) / 2.0).collect();
            let half = |i: usize| (fan[i].angle / 2.0).tan();
            let raw: Vec<f64> = (0..n).map(|i| (half((i + n - 1) % n) + half(i)) / lengths_m[i]).collect();
            let sum: f64 = raw.iter().sum();
            let weights = (sum.is_finite() && sum > 0.0).then(|| raw.iter().map(|w| w / sum).collect())?;
            Some(Apex { vertex, ring, weights, lengths_m })
        };
        let rings = rings(triangles, count);
        Self { apexes: rings.into_iter().filter_map(apex).collect() }
    }

    /// One round of the reconstruction: every vertex moves to the apex of its pyramid over its ring in the shape `x`.
    ///
    /// The angle to each neighbour is the mean of that in `x` and that of an edge of the wanted length (5.9), which
    /// lies `share` of the way from the present length to that of the pattern.
    pub fn rebuild(&self, x: &[V3], share: f64) -> Vec<V3> {
        let mut next = x.to_vec();
        for apex in &self.apexes {
            if let Some(p) = apex.over(x, share) {
                next[apex.vertex] = p;
            }
        }
        next
    }
}

impl Apex {
    /// `v = sum w_i v'_i + n sum w_i ((v_i - c) n + |v' - v'_i| cot theta_i)`.
    fn over(&self, x: &[V3], share: f64) -> Option<V3> {
        let base = Base::of(&self.ring, x)?;
        let here = x[self.vertex];
        let (mut foot, mut height) = (V3::zeros(), 0.0);
        for ((&w, weight), pattern_m) in self.ring.iter().zip(&self.weights).zip(&self.lengths_m) {
            let way = here - x[w];
            let now_m = way.norm().max(1e-9);
            let flat_m = base.flat(&way).norm();
            let wanted_m = now_m + (pattern_m - now_m) * share;
            let sine = |length_m: f64| (flat_m / length_m).min(1.0);
            let angle = (sine(now_m).asin() + sine(wanted_m).asin()) / 2.0;
            // An apex above some neighbours and below others stays on its present side of each.
            let rise = flat_m / angle.tan().max(1e-9) * way.dot(&base.normal).signum();
            foot += (x[w] - base.normal * (x[w] - base.centre).dot(&base.normal)) * *weight;
            height += weight * ((x[w] - base.centre).dot(&base.normal) + rise);
        }
        Some(foot + base.normal * height)
    }
}

/// Closed rings of inner vertices, counter-clockwise.
fn rings(triangles: &[[usize; 3]], count: usize) -> Vec<(usize, Vec<usize>)> {
    let mut next = vec![BTreeMap::new(); count];
    for t in triangles {
        for k in 0..3 {
            next[t[k]].insert(t[(k + 1) % 3], t[(k + 2) % 3]);
        }
    }
    let ring = |(vertex, next): (usize, &BTreeMap<usize, usize>)| {
        let (&first, _) = next.first_key_value()?;
        let mut ring = vec![first];
        let mut neighbour = *next.get(&first)?;
        while neighbour != first && ring.len() <= next.len() {
            ring.push(neighbour);
            neighbour = *next.get(&neighbour)?;
        }
        (neighbour == first && ring.len() == next.len() && ring.len() > 2).then_some((vertex, ring))
    };
    next.iter().enumerate().filter_map(ring).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laboratory::sheets::{hexagonal_sheet, noise};
    use geom::shapes::sphere;

    fn bumpy() -> (Vec<V3>, Vec<[usize; 3]>) {
        let (rest, triangles) = hexagonal_sheet(12, 10, 0.02);
        let x =
            rest.iter().map(|p| V3::new(p.x, p.y, 0.01 * (40.0 * p.x).sin() * (30.0 * p.y).cos() + 0.3 * p.x * p.x));
        (x.collect(), triangles)
    }

    fn moved(x: &[V3]) -> Vec<V3> {
        let turn = nalgebra::Rotation3::from_euler_angles(0.4, -1.1, 2.3);
        x.iter().map(|p| turn * p + V3::new(3.0, -2.0, 0.7)).collect()
    }

    fn farthest(a: &[V3], b: &[V3]) -> f64 {
        a.iter().zip(b).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max)
    }

    #[test]
    fn coordinates_do_not_change_when_the_shape_is_moved_and_turned() {
        let (x, triangles) = bumpy();
        let [here, there] = [x.clone(), moved(&x)].map(|x| Pyramids::of_shape(&triangles, &x));
        assert_eq!(here.apexes.len(), there.apexes.len());
        for (a, b) in here.apexes.iter().zip(&there.apexes) {
            let same = |a: &[f64], b: &[f64]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-9);
            assert!(same(&a.weights, &b.weights) && same(&a.lengths_m, &b.lengths_m), "{a:?} and {b:?}");
        }
    }

    #[test]
    fn a_shape_is_what_its_own_coordinates_say() {
        let (bump, triangles) = bumpy();
        let ball = sphere(0.3, 12);
        for (x, triangles) in [(bump, triangles), (ball.positions, ball.triangles)] {
            let pyramids = Pyramids::of_shape(&triangles, &x);
            assert!(pyramids.apexes.len() > 50);
            let off = farthest(&pyramids.rebuild(&x, 1.0), &x);
            assert!(off < 1e-9, "{off}");
            let other = moved(&x);
            assert!(farthest(&pyramids.rebuild(&other, 1.0), &other) < 1e-9);
        }
    }

    #[test]
    fn a_disturbed_shape_comes_back() {
        let (x, triangles) = bumpy();
        let pyramids = Pyramids::of_shape(&triangles, &x);
        let inner: Vec<usize> = pyramids.apexes.iter().map(|apex| apex.vertex).collect();
        let mut now = x.clone();
        for (v, by) in inner.iter().zip(noise(inner.len(), 3)) {
            now[*v].x += 2e-3 * by;
        }
        let before = farthest(&now, &x);
        for _ in 0..100 {
            now = pyramids.rebuild(&now, 1.0);
        }
        assert!(farthest(&now, &x) < 0.5 * before, "{} after {before}", farthest(&now, &x));
    }

    #[test]
    fn a_bulge_grows_to_the_lengths_of_its_pattern() {
        // A shallow dome over a sheet whose pattern is 3 % larger than its plan: only height can make up for it.
        let (plan, triangles) = hexagonal_sheet(12, 10, 0.02);
        let middle = plan.iter().sum::<V2>() / plan.len() as f64;
        let dome = |p: &V2| V3::new(p.x, p.y, 0.02 * (1.0 - (p - middle).norm_squared() / 0.03).max(0.0));
        let mut x: Vec<V3> = plan.iter().map(dome).collect();
        let rest: Vec<[V2; 3]> = triangles.iter().map(|t| t.map(|v| plan[v] * 1.03)).collect();
        let pyramids = Pyramids::of_pattern(&triangles, &rest, x.len());
        let chi = |x: &[V3]| {
            let sides = || {
                pyramids
                    .apexes
                    .iter()
                    .flat_map(|a| a.ring.iter().zip(&a.lengths_m).map(move |(w, l)| (a.vertex, *w, *l)))
            };
            sides().map(|(v, w, length_m)| (x[v] - x[w]).norm() / length_m).sum::<f64>() / sides().count() as f64
        };
        let before = chi(&x);
        for _ in 0..10 {
            x = pyramids.rebuild(&x, 1.0);
        }
        assert!(before < chi(&x) && chi(&x) < 1.01, "{before}, then {}", chi(&x));
    }
}

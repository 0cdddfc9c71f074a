//! Cloth that crosses itself, and how it is drawn apart.

use super::nearest::Primitives;
use super::tangle::{Crossing, Release, Wings};
use crate::geom::V3;
use crate::sim::solver::Contact4;

/// Steps without fewer crossings after which they are drawn out harder.
const PATIENCE: u32 = 4;
/// Factor by which the force then grows.
const GROWTH: f64 = 1.5;
/// Most that it grows by in all.
const MOST_GROWTH: f64 = 100.0;
/// How far a step against a releasing force goes at most, m.
const STEP_M: f64 = 2e-3;

/// What crosses at a step. It has no right side: its edges and triangles let each other pass until they have come free, and
/// forces draw them out. These grow for as long as the crossings do not get fewer, as cloth may be drawn tight there.
pub struct Knots {
    wings: Wings,
    /// Pairs of vertices, one of an edge and one of a triangle that it pierces, both ways round, sorted.
    passing: Vec<[usize; 2]>,
    releases: Vec<Release>,
    /// Force that draws a crossing out, at first and now, N.
    force_n: [f64; 2],
    /// Steps for which crossings are still drawn out.
    steps_left: u32,
    /// Fewest crossings since there have been any, and for how many steps they have not got fewer.
    least: (usize, u32),
}

impl Knots {
    /// None yet. Those to come are drawn out by `force_n` newtons at first, for `steps` steps in all.
    #[must_use]
    pub fn new(triangles: &[[usize; 3]], force_n: f64, steps: u32) -> Self {
        Self {
            wings: Wings::new(triangles),
            passing: Vec::new(),
            releases: Vec::new(),
            force_n: [force_n; 2],
            steps_left: steps,
            least: (usize::MAX, 0),
        }
    }

    /// Leaves what crosses alone.
    pub fn leave(&mut self) {
        self.steps_left = 0;
    }

    /// Whether nothing crosses.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.passing.is_empty()
    }

    /// Takes up what crosses at `x`.
    pub fn see(&mut self, x: &[V3], found: &[Crossing]) {
        self.passing.clear();
        for Crossing { edge, triangle } in found {
            let each = edge.iter().flat_map(|&v| triangle.map(|w| [[v, w], [w, v]]));
            self.passing.extend(each.flatten());
        }
        self.passing.sort_unstable();
        self.passing.dedup();
        self.releases.clear();
        if self.steps_left > 0 && !found.is_empty() {
            self.steps_left -= 1;
            self.releases.extend(found.iter().filter_map(|crossing| Release::of(x, &self.wings, crossing)));
        }
        self.harden(found.len());
    }

    /// Lets the force grow if there are no fewer crossings than for some time.
    fn harden(&mut self, count: usize) {
        let ([first, now], (least, waited)) = (&mut self.force_n, &mut self.least);
        if count == 0 {
            (*now, *least, *waited) = (*first, usize::MAX, 0);
        } else if count < *least {
            (*least, *waited) = (count, 0);
        } else {
            *waited += 1;
            if *waited >= PATIENCE {
                *waited = 0;
                *now = (*now * GROWTH).min(MOST_GROWTH * *first);
            }
        }
    }

    /// Whether a pair belongs to a crossing, so that neither side hinders the other.
    #[must_use]
    pub fn pass(&self, primitives: Primitives) -> bool {
        if self.passing.is_empty() {
            return false;
        }
        let [a, b, c, d] = primitives.vertices();
        let pass = |v: usize, w: usize| self.passing.binary_search(&[v, w]).is_ok();
        match primitives {
            Primitives::VertexTriangle(_) => [b, c, d].into_iter().any(|w| pass(a, w)),
            Primitives::EdgeEdge(_) => [a, b].into_iter().any(|v| pass(v, c) || pass(v, d)),
        }
    }

    /// Energy of the forces, J.
    #[must_use]
    pub fn energy(&self, x: &[V3]) -> f64 {
        self.force_n[1] * self.releases.iter().map(|release| release.potential(x)).sum::<f64>()
    }

    /// Adds the forces, and the stiffness that keeps a step along them short.
    pub fn assemble(&self, forces: &mut [V3], contacts: &mut Vec<Contact4>) {
        let force_n = self.force_n[1];
        for release in &self.releases {
            release.add_force(force_n, forces);
            contacts.extend(release.couplings(force_n / STEP_M));
        }
    }
}

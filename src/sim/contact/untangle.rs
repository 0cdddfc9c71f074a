//! Untangling of cloth that crosses itself.

use super::distance::Primitives;
use super::intersections::{Intersection, Release, Wings};
use geom::V3;
use linalg::Contact4;

geom::constants! {
    "contact.untangle",
    /// Steps without fewer crossings after which the force grows.
    const PATIENCE: u32 = 4;
    const GROWTH: f64 = 1.5;
    const MOST_GROWTH: f64 = 100.0;
    /// Steps over which the contact of a pair that has come free grows to its thickness.
    const FRESH_STEPS: u32 = 20;
    /// Displacement to which the stiffness of a releasing force limits a step.
    const STEP_M: f64 = 2e-3;
}

/// Crossings of a cloth with itself. They have no inner and outer side: their edges and triangles pass each other
/// freely until they have come apart, and forces draw them out. The forces grow while the crossings do not decrease,
/// since the cloth may be under tension there.
///
/// A pair that comes free is far nearer than cloth that never crossed. With the full contact force at once it would be
/// thrown through whatever is behind it, caught there, drawn out, and thrown again. So its contact starts thin, and
/// grows.
///
/// Crossings that remain after a number of steps are left: from then on everything that crosses may pass for good. Else
/// pairs at the edge of such a knot would come free, be pushed back, and come free again for ever.
pub struct Untangling {
    wings: Option<Wings>,
    /// Pairs of a vertex of an edge and one of a triangle that it crosses, in both orders, sorted.
    passing: Vec<[usize; 2]>,
    /// Such pairs that have come free, with the steps since, sorted.
    fresh: Vec<([usize; 2], u32)>,
    releases: Vec<Release>,
    /// Force that draws a crossing out, at first and now.
    force_n: [f64; 2],
    steps_left: u32,
    are_left_alone: bool,
    /// Smallest number of crossings since there have been any, and the steps in which it has not decreased.
    least: (usize, u32),
}

impl Untangling {
    pub fn new(force_n: f64, steps: u32) -> Self {
        Self {
            wings: None,
            passing: Vec::new(),
            fresh: Vec::new(),
            releases: Vec::new(),
            force_n: [force_n; 2],
            steps_left: steps,
            are_left_alone: false,
            least: (usize::MAX, 0),
        }
    }

    pub fn leave(&mut self) {
        self.are_left_alone = true;
    }

    pub fn is_empty(&self) -> bool {
        self.passing.is_empty()
    }

    pub fn is_fresh(&self) -> bool {
        !self.fresh.is_empty()
    }

    /// Gives pairs that have come free the full thickness of their contact. Returns `true` if there were any.
    pub fn ripen(&mut self) -> bool {
        !std::mem::take(&mut self.fresh).is_empty()
    }

    pub fn grow(&mut self) {
        self.fresh.iter_mut().for_each(|(_, age)| *age += 1);
        self.fresh.retain(|(_, age)| *age < FRESH_STEPS);
    }

    pub fn see(&mut self, x: &[V3], triangles: &[[usize; 3]], found: &[Intersection]) {
        let before = std::mem::take(&mut self.passing);
        for Intersection { edge, triangle } in found {
            let each = edge.iter().flat_map(|&v| triangle.map(|w| [[v, w], [w, v]]));
            self.passing.extend(each.flatten());
        }
        if self.steps_left == 0 {
            self.passing.extend(&before);
        }
        self.passing.sort_unstable();
        self.passing.dedup();
        let free = before.into_iter().filter(|pair| self.passing.binary_search(pair).is_err());
        self.fresh.extend(free.map(|pair| (pair, 0)));
        self.fresh.sort_unstable();
        self.fresh.dedup_by_key(|(pair, _)| *pair);
        self.releases.clear();
        if self.steps_left > 0 && !found.is_empty() && !self.are_left_alone {
            self.steps_left -= 1;
            let wings = self.wings.get_or_insert_with(|| Wings::new(triangles));
            self.releases.extend(found.iter().filter_map(|crossing| Release::of(x, wings, crossing)));
        }
        self.harden(found.len());
    }

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

    pub fn pass(&self, primitives: Primitives) -> bool {
        if self.passing.is_empty() {
            return false;
        }
        primitives.across().any(|pair| self.passing.binary_search(&pair).is_ok())
    }

    /// Share of the thickness that a contact has: less than 1 where it has come free recently.
    pub fn thickness_share(&self, primitives: Primitives) -> f64 {
        if self.fresh.is_empty() {
            return 1.0;
        }
        let age = |pair| self.fresh.binary_search_by_key(&pair, |(pair, _)| *pair).ok().map(|at| self.fresh[at].1);
        let youngest = primitives.across().filter_map(age).min();
        youngest.map_or(1.0, |age| f64::from(age + 1) / f64::from(FRESH_STEPS + 1))
    }

    /// J.
    pub fn energy(&self, x: &[V3]) -> f64 {
        self.force_n[1] * self.releases.iter().map(|release| release.potential(x)).sum::<f64>()
    }

    /// Adds the forces, N, and the stiffness that limits a step along them.
    pub fn assemble(&self, forces: &mut [V3], contacts: &mut Vec<Contact4>) {
        let force_n = self.force_n[1];
        for release in &self.releases {
            release.add_force(force_n, forces);
            contacts.extend(release.couplings(force_n / STEP_M));
        }
    }
}

//! Cloth that crosses itself, and how it is drawn apart.

use super::distance::Primitives;
use super::intersections::{Intersection, Release, Wings};
use geom::V3;
use linalg::Contact4;

geom::constants! {
    "contact.untangle",
    /// Steps without fewer crossings after which they are drawn out harder.
    const PATIENCE: u32 = 4;
    /// Factor by which the force then grows.
    const GROWTH: f64 = 1.5;
    /// Most that it grows by in all.
    const MOST_GROWTH: f64 = 100.0;
    /// Steps over which the contact of what has come free grows to its thickness.
    const FRESH_STEPS: u32 = 20;
    /// How far a step against a releasing force goes at most, m.
    const STEP_M: f64 = 2e-3;
}

/// What crosses at a step. It has no right side: its edges and triangles let each other pass until they have come free, and
/// forces draw them out. These grow for as long as the crossings do not get fewer, as cloth may be drawn tight there.
///
/// What comes free lies far nearer than cloth that was never crossed. Pushed apart at once by all that a contact can, it is thrown
/// through whatever lies behind it, caught there, drawn out, and thrown again. So its contact starts thin, and grows.
///
/// What still crosses when it has been drawn for long enough is left: from then on all that crosses may pass for good. At the edge of
/// such a knot pairs would come free, be pushed back into it as soon as their contact has grown, and come free again for ever.
pub struct Untangling {
    /// Once there is a crossing.
    wings: Option<Wings>,
    /// Pairs of vertices, one of an edge and one of a triangle that it pierces, both ways round, sorted.
    passing: Vec<[usize; 2]>,
    /// Such pairs that have come free, and for how many steps they have been, sorted.
    fresh: Vec<([usize; 2], u32)>,
    releases: Vec<Release>,
    /// Force that draws a crossing out, at first and now, N.
    force_n: [f64; 2],
    /// Steps for which crossings are still drawn out.
    steps_left: u32,
    /// Whether they are left alone from the first.
    are_left_alone: bool,
    /// Fewest crossings since there have been any, and for how many steps they have not got fewer.
    least: (usize, u32),
}

impl Untangling {
    /// None yet. Those to come are drawn out by `force_n` newtons at first, for `steps` steps in all.
    #[must_use]
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

    /// Leaves what crosses alone.
    pub fn leave(&mut self) {
        self.are_left_alone = true;
    }

    /// Whether nothing crosses.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.passing.is_empty()
    }

    /// Whether something has come free of late, so that its contact has not got its thickness yet.
    #[must_use]
    pub fn is_fresh(&self) -> bool {
        !self.fresh.is_empty()
    }

    /// Gives all that has come free the thickness of its contact, and says whether there was any.
    pub fn ripen(&mut self) -> bool {
        !std::mem::take(&mut self.fresh).is_empty()
    }

    /// Lets the contacts of what has come free grow by a step.
    pub fn grow(&mut self) {
        self.fresh.iter_mut().for_each(|(_, age)| *age += 1);
        self.fresh.retain(|(_, age)| *age < FRESH_STEPS);
    }

    /// Takes up what crosses of these triangles at `x`.
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
        primitives.across().any(|pair| self.passing.binary_search(&pair).is_ok())
    }

    /// Share of its thickness that the contact of a pair has: less than 1 where it has come free of late.
    #[must_use]
    pub fn thickness_share(&self, primitives: Primitives) -> f64 {
        if self.fresh.is_empty() {
            return 1.0;
        }
        let age = |pair| self.fresh.binary_search_by_key(&pair, |(pair, _)| *pair).ok().map(|at| self.fresh[at].1);
        let youngest = primitives.across().filter_map(age).min();
        youngest.map_or(1.0, |age| f64::from(age + 1) / f64::from(FRESH_STEPS + 1))
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

//! Second tries: a garment that ends with a fault is put on again in other ways, and the best drape is kept.
//!
//! A fold that slips under another while the seams close is an accident of the start. From another start the same
//! garment often comes to rest without the fault. The ways and their order are fixed, so that the same inputs give the
//! same drape.

use crate::{Drape, SimError};

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Faults {
    /// True where the seams have squeezed the garment off the body.
    pub came_off: bool,
    pub moves: bool,
    pub self_crossings: usize,
    /// Deepest point inside the body; 0 by a simulator in which tight cloth may lie inside.
    pub depth_m: f64,
    /// Mean error of the measured lengths; 0 by a simulator in which tight cloth stretches.
    pub length_error: f64,
}

/// Limits up to which faults count as none, and their order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Criteria {
    pub depth_m: f64,
    pub length_error: f64,
    /// True where a drape at rest is better than any that still moves, whatever else is wrong with it.
    pub is_rest_first: bool,
}

impl Faults {
    pub fn are_none(&self, criteria: &Criteria) -> bool {
        let is_at_rest_on_the_body = !self.came_off && !self.moves && self.self_crossings == 0;
        is_at_rest_on_the_body && self.depth_m <= criteria.depth_m && self.length_error <= criteria.length_error
    }

    /// Equilibrium, self-intersection and penetration are constraints of different kinds. None makes up for another, so
    /// a better drape is better in one of them and worse in none (Pareto dominance). Depths up to the limit are equal.
    /// If the constraints are equal the error of the lengths decides: it is an objective, not a constraint.
    pub fn are_less_than(&self, other: &Self, criteria: &Criteria) -> bool {
        if self.came_off || other.came_off {
            return !self.came_off;
        }
        if criteria.is_rest_first && self.moves != other.moves {
            return other.moves;
        }
        let constraints = |faults: &Self| (faults.moves, faults.self_crossings, faults.depth_m.max(criteria.depth_m));
        let (own, others) = (constraints(self), constraints(other));
        if own == others {
            return self.length_error.total_cmp(&other.length_error).is_lt();
        }
        own.0 <= others.0 && own.1 <= others.1 && own.2 <= others.2
    }
}

pub trait Trial {
    type Way;

    const CRITERIA: Criteria;

    fn put_on(&mut self, way: &Self::Way) -> Result<Drape, SimError>;

    fn faults(&self, drape: &Drape) -> Faults;

    /// True while the budget allows another try; the best drape so far has the faults `least`.
    fn has_time(&self, least: &Faults) -> bool;
}

/// Best of `first` and the drapes that `ways` lead to. Ends with the first without a fault, or when the budget is used
/// up. Of drapes neither of which is better the earlier is kept. Fails with [`SimError::Cancelled`] as soon as a way
/// ends so.
pub fn best<T: Trial>(
    trial: &mut T,
    first: Option<Drape>,
    ways: impl IntoIterator<Item = T::Way>,
) -> Result<Drape, SimError> {
    let criteria = T::CRITERIA;
    let mut best = first.map(|drape| (trial.faults(&drape), drape));
    let mut refusal = None;
    for way in ways {
        if best.as_ref().is_some_and(|(least, _)| least.are_none(&criteria) || !trial.has_time(least)) {
            break;
        }
        match trial.put_on(&way) {
            Ok(drape) => {
                let faults = trial.faults(&drape);
                let is_better = |least: &Faults| faults.are_none(&criteria) || faults.are_less_than(least, &criteria);
                if best.as_ref().is_none_or(|(least, _)| is_better(least)) {
                    best = Some((faults, drape));
                }
            }
            Err(SimError::Cancelled) => return Err(SimError::Cancelled),
            Err(error) => refusal = refusal.or(Some(error)),
        }
    }
    best.map(|(_, drape)| drape).ok_or_else(|| refusal.unwrap_or(SimError::NoMesh))
}

/// Result of the first way that ends without an error, after one that ended with `refusal`. Fails with
/// [`SimError::Cancelled`] as soon as one ends so.
pub fn instead<Way, Found>(
    refusal: SimError,
    ways: impl IntoIterator<Item = Way>,
    mut put_on: impl FnMut(Way) -> Result<Found, SimError>,
) -> Result<Found, SimError> {
    for way in ways {
        match put_on(way) {
            Ok(found) => return Ok(found),
            Err(SimError::Cancelled) => return Err(SimError::Cancelled),
            Err(_) => {}
        }
    }
    Err(refusal)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing;

    const PHYSICAL: Criteria = Criteria { depth_m: 5e-4, length_error: 0.0, is_rest_first: false };
    const GEOMETRIC: Criteria = Criteria { depth_m: 0.0, length_error: 0.01, is_rest_first: true };

    fn worn(is_at_rest: bool, self_crossings: usize, depth_m: f64, length_error: f64) -> Faults {
        Faults { came_off: false, moves: !is_at_rest, self_crossings, depth_m, length_error }
    }

    fn check(criteria: &Criteria, faults: Faults, others: Faults, expect: bool) {
        let [is_less, is_more] =
            [(faults, others), (others, faults)].map(|(faults, others)| faults.are_less_than(&others, criteria));
        assert!(is_less == expect && !(is_less && is_more), "{faults:?} beside {others:?}");
    }

    #[test]
    fn what_is_better_in_one_constraint_must_not_be_worse_in_another() {
        let physical = |is_at_rest, depth_m, self_crossings| worn(is_at_rest, self_crossings, depth_m, 0.0);
        let check = |faults, others, expect| check(&PHYSICAL, faults, others, expect);
        check(physical(true, 1e-4, 3), physical(true, 1e-4, 5), true);
        check(physical(true, 2e-3, 5), physical(true, 4e-3, 5), true);
        check(physical(true, 4e-3, 5), physical(false, 4e-3, 5), true);
        check(physical(true, 4e-3, 5), physical(true, 4e-3, 5), false);
        // Both are as good as outside.
        check(physical(true, 1e-4, 5), physical(true, 3e-4, 5), false);
        check(physical(true, 3e-4, 3), physical(true, 1e-4, 5), true);
        // A body without an exact surface tells no depth.
        check(physical(true, f64::NAN, 5), physical(true, 1e-4, 5), false);
        assert!(!physical(true, f64::NAN, 0).are_none(&PHYSICAL));
        // Fewer intersections, but deeper or not at rest; at rest, but more intersections.
        check(physical(true, 4e-3, 3), physical(true, 1e-4, 5), false);
        check(physical(false, 1e-4, 0), physical(true, 1e-4, 5), false);
        check(physical(true, 1e-4, 5), physical(false, 1e-4, 0), false);
        check(Faults { came_off: true, ..physical(true, 0.0, 0) }, physical(false, 4e-3, 5), false);
        check(physical(false, 4e-3, 5), Faults { came_off: true, ..physical(true, 0.0, 0) }, true);
    }

    #[test]
    fn rest_comes_before_crossings_and_these_before_lengths_where_rest_is_first() {
        let geometric = |is_at_rest, self_crossings, length_error| worn(is_at_rest, self_crossings, 0.0, length_error);
        let check = |faults, others, expect| check(&GEOMETRIC, faults, others, expect);
        check(geometric(true, 5, 0.2), geometric(false, 0, 0.001), true);
        check(geometric(true, 1, 0.2), geometric(true, 2, 0.001), true);
        check(geometric(true, 2, 0.001), geometric(true, 2, 0.002), true);
        check(geometric(true, 2, 0.001), geometric(true, 2, 0.001), false);
        check(geometric(true, 2, 0.3), geometric(true, 2, f64::NAN), true);
        assert!(geometric(true, 0, 0.01).are_none(&GEOMETRIC) && !geometric(true, 0, 0.011).are_none(&GEOMETRIC));
    }

    /// As many crossings as each way says; `None` where it is refused.
    struct Scripted {
        budget: usize,
        tried: usize,
    }

    impl Trial for Scripted {
        type Way = Option<usize>;
        const CRITERIA: Criteria = PHYSICAL;

        fn put_on(&mut self, way: &Option<usize>) -> Result<Drape, SimError> {
            self.tried += 1;
            way.map(drape).ok_or(SimError::Singular)
        }

        fn faults(&self, drape: &Drape) -> Faults {
            worn(true, drape.self_crossings, 0.0, 0.0)
        }

        fn has_time(&self, _: &Faults) -> bool {
            self.tried < self.budget
        }
    }

    fn drape(self_crossings: usize) -> Drape {
        Drape { self_crossings, ..testing::drape() }
    }

    #[test]
    fn ways_are_tried_until_one_leaves_no_fault_or_the_budget_is_used_up() {
        let check = |first: Option<usize>, ways: &[Option<usize>], budget: usize, expect: (Option<usize>, usize)| {
            let mut trial = Scripted { budget, tried: 0 };
            let found = best(&mut trial, first.map(drape), ways.iter().copied());
            assert_eq!((found.ok().map(|drape| drape.self_crossings), trial.tried), expect, "{first:?}, {ways:?}");
        };
        check(Some(0), &[Some(0)], 9, (Some(0), 0));
        check(Some(3), &[Some(5), Some(2), Some(0), Some(0)], 9, (Some(0), 3));
        check(Some(3), &[None, Some(2), Some(4)], 9, (Some(2), 3));
        check(Some(3), &[Some(2), Some(0)], 1, (Some(2), 1));
        // The budget is not asked before there is a drape.
        check(None, &[None, Some(2), Some(0)], 1, (Some(2), 2));
        check(None, &[None, None], 9, (None, 2));
    }

    #[test]
    fn a_refusal_stands_where_no_other_way_ends_well() {
        let put_on = |way: Option<usize>| way.ok_or(SimError::Singular);
        assert_eq!(instead(SimError::NoMesh, [None, Some(2), Some(3)], put_on).ok(), Some(2));
        assert!(matches!(instead(SimError::NoMesh, [None, None], put_on), Err(SimError::NoMesh)));
        let cancel = |_: ()| -> Result<usize, SimError> { Err(SimError::Cancelled) };
        assert!(matches!(instead(SimError::NoMesh, [(), ()], cancel), Err(SimError::Cancelled)));
    }
}

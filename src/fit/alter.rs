//! Change of a pattern that brings its levels into their target bands by few handles: a quadratic programme for the
//! amounts, within a search over the sets of handles.

/// Quantity of a garment that should lie in a band.
#[derive(Clone, Debug, PartialEq)]
pub struct Goal {
    pub value: f64,
    /// Derivative with respect to each handle.
    pub sensitivity: Vec<f64>,
    pub band: [f64; 2],
    /// Compliance of the band: missing it by `m` costs `m^2 / gives`, beside the squares of the scaled changes or the
    /// cost of the handles. `None` if the band must be met whatever the change.
    pub gives: Option<f64>,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Change {
    /// Amount of each handle, in its unit.
    pub amounts: Vec<f64>,
    pub values: Vec<f64>,
}

/// Stiffness of a goal / that of the handles: a goal within the limits is missed by a ten-thousandth of the change.
const FIRMNESS: f64 = 1e4;
/// Greatest number of sweeps over all constraints. Each sweep reduces the error by a constant factor.
const SWEEPS: usize = 20_000;
/// Change of a multiplier, multiplied by the root of its stiffness, below which the iteration has converged.
const STILL: f64 = 1e-12;

/// Finds the change with the least sum of squares, in units of `scale`, that brings goals into their bands within the
/// limits of each handle. If the limits forbid that, the goals are missed by as little as the limits allow.
///
/// Solves the dual quadratic programme by coordinate ascent (Hildreth's method): each constraint in turn takes the
/// multiplier, at least 0, that meets it exactly. Goals have a compliance, limits have none.
pub fn least_change(goals: &[Goal], limits: &[[f64; 2]], scale: &[f64]) -> Change {
    let rows = constraints(goals, limits, scale);
    let mut h = vec![0.0; scale.len()];
    let mut multipliers = vec![0.0; rows.len()];
    for _ in 0..SWEEPS {
        let mut moved: f64 = 0.0;
        for (row, multiplier) in rows.iter().zip(&mut multipliers) {
            let stiffness: f64 = row.normal.iter().map(|a| a * a).sum::<f64>() + row.give;
            if stiffness == 0.0 {
                continue;
            }
            let over = dot(&row.normal, &h) - row.most - *multiplier * row.give;
            let next = (*multiplier + over / stiffness).max(0.0);
            let step = next - *multiplier;
            h.iter_mut().zip(&row.normal).for_each(|(h, a)| *h -= step * a);
            *multiplier = next;
            moved = moved.max(step.abs() * stiffness.sqrt());
        }
        if moved < STILL {
            break;
        }
    }
    let amounts: Vec<f64> = h.iter().zip(scale).map(|(h, scale)| h * scale).collect();
    let values = goals.iter().map(|goal| goal.value + dot(&goal.sensitivity, &amounts)).collect();
    Change { amounts, values }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Departure from a band that counts as none in [`fewest`], in the unit of the goals that must be met, m.
const MET: f64 = 0.5e-3;
/// Share of what all handles together do for a goal out of their reach that a smaller set may leave undone.
const SPARED: f64 = 0.1;
/// Greatest number of handles in a set. Every level of the trunk takes one, and a garment has no more levels.
const MOST_HANDLES: usize = 7;

/// Finds the cheapest change that meets the goals as well as all handles together can within their limits. A set of
/// handles costs the sum of their `costs`, and each its amount as a share of its limit; goals that scatter add what it
/// costs to miss them.
///
/// Searches the sets by branch and bound: a set whose costs reach those of the best one is not searched further, nor
/// one that misses a goal even if all handles that may still join move to their limits.
pub fn fewest(goals: &[Goal], limits: &[[f64; 2]], costs: &[f64]) -> Change {
    let asked = goals;
    let scale: Vec<f64> = limits.iter().map(|limit| limit[1].max(-limit[0])).collect();
    let all = least_change(asked, limits, &scale);
    let met = |(goal, value): (&Goal, &f64)| match goal.gives {
        None => {
            // What is out of reach need not be reached as far by a handle more.
            let spared = if off(goal, *value) > MET { SPARED * (value - goal.value).abs() } else { 0.0 };
            Goal { band: [goal.band[0].min(value - spared), goal.band[1].max(value + spared)], ..goal.clone() }
        }
        Some(_) => goal.clone(),
    };
    let goals: Vec<Goal> = asked.iter().zip(&all.values).map(met).collect();
    let moves = |place: &usize| scale[*place] > 0.0 && goals.iter().any(|goal| goal.sensitivity[*place] != 0.0);
    let mut order: Vec<usize> = (0..scale.len()).filter(moves).collect();
    order.sort_by(|a, b| costs[*a].total_cmp(&costs[*b]));
    let mut search = Search { asked, goals: &goals, limits, costs, scale: &scale, order: &order, best: None };
    search.extend(&mut Vec::new(), 0, 0.0);
    search.best.map_or(all, |(_, change)| change)
}

fn least_of(set: &[usize], goals: &[Goal], limits: &[[f64; 2]], scale: &[f64]) -> Change {
    let pick = |all: &[f64]| -> Vec<f64> { set.iter().map(|handle| all[*handle]).collect() };
    let own: Vec<Goal> =
        goals.iter().map(|goal| Goal { sensitivity: pick(&goal.sensitivity), ..goal.clone() }).collect();
    let own_limits: Vec<[f64; 2]> = set.iter().map(|handle| limits[*handle]).collect();
    let change = least_change(&own, &own_limits, &pick(scale));
    let mut amounts = vec![0.0; scale.len()];
    set.iter().zip(change.amounts).for_each(|(handle, amount)| amounts[*handle] = amount);
    Change { amounts, values: change.values }
}

pub fn cost(goals: &[Goal], limits: &[[f64; 2]], costs: &[f64], amounts: &[f64]) -> f64 {
    let moved = amounts.iter().zip(limits).zip(costs).filter(|((amount, _), _)| **amount != 0.0);
    let of_handles: f64 = moved.map(|((amount, limit), cost)| cost + amount.abs() / limit[1].max(-limit[0])).sum();
    let missed = goals.iter().filter_map(|goal| {
        let off = off(goal, goal.value + dot(&goal.sensitivity, amounts));
        goal.gives.map(|gives| off * off / gives)
    });
    of_handles + missed.sum::<f64>()
}

fn off(goal: &Goal, value: f64) -> f64 {
    (goal.band[0] - value).max(value - goal.band[1]).max(0.0)
}

struct Search<'a> {
    asked: &'a [Goal],
    /// Goals as a set has to meet them: what is out of reach may be spared.
    goals: &'a [Goal],
    limits: &'a [[f64; 2]],
    costs: &'a [f64],
    scale: &'a [f64],
    /// Handles that may join a set, the cheapest first.
    order: &'a [usize],
    best: Option<(f64, Change)>,
}

impl Search<'_> {
    /// Tries a set, and all that join to it handles from `next` on. `spent` is the cost of the set without its amounts.
    fn extend(&mut self, set: &mut Vec<usize>, next: usize, spent: f64) {
        if self.best.as_ref().is_some_and(|(best, _)| spent >= *best) || !self.may_meet(set, next) {
            return;
        }
        if self.may_meet(set, self.order.len()) {
            self.weigh(set);
        }
        if set.len() == MOST_HANDLES {
            return;
        }
        for place in next..self.order.len() {
            let handle = self.order[place];
            set.push(handle);
            self.extend(set, place + 1, spent + self.costs[handle]);
            set.pop();
        }
    }

    fn may_meet(&self, set: &[usize], next: usize) -> bool {
        let handles = || set.iter().chain(&self.order[next..]);
        self.goals.iter().filter(|goal| goal.gives.is_none()).all(|goal| {
            let [mut least, mut most] = [goal.value; 2];
            for handle in handles() {
                let ends = self.limits[*handle].map(|limit| limit * goal.sensitivity[*handle]);
                least += ends[0].min(ends[1]);
                most += ends[0].max(ends[1]);
            }
            least <= goal.band[1] + MET && most >= goal.band[0] - MET
        })
    }

    fn weigh(&mut self, set: &[usize]) {
        let change = least_of(set, self.goals, self.limits, self.scale);
        let is_met =
            self.goals.iter().zip(&change.values).all(|(goal, value)| goal.gives.is_some() || off(goal, *value) <= MET);
        if !is_met {
            return;
        }
        // What may be spared to choose the set is not spared within it.
        let change = least_of(set, self.asked, self.limits, self.scale);
        let cost = cost(self.asked, self.limits, self.costs, &change.amounts);
        if self.best.as_ref().is_none_or(|(best, _)| cost < *best) {
            self.best = Some((cost, change));
        }
    }
}

/// Constraint on scaled handles h: `normal . h <= most + give * multiplier`.
struct Constraint {
    normal: Vec<f64>,
    most: f64,
    give: f64,
}

fn constraints(goals: &[Goal], limits: &[[f64; 2]], scale: &[f64]) -> Vec<Constraint> {
    let mut rows = Vec::new();
    for goal in goals {
        let scaled: Vec<f64> = goal.sensitivity.iter().zip(scale).map(|(s, scale)| s * scale).collect();
        for (sign, bound) in [(1.0, goal.band[1]), (-1.0, goal.band[0])] {
            let normal: Vec<f64> = scaled.iter().map(|s| sign * s).collect();
            let give = goal.gives.unwrap_or(dot(&normal, &normal) / FIRMNESS);
            rows.push(Constraint { normal, most: sign * (bound - goal.value), give });
        }
    }
    for (handle, (limit, scale)) in limits.iter().zip(scale).enumerate() {
        for (sign, bound) in [(1.0, limit[1]), (-1.0, limit[0])] {
            let mut normal = vec![0.0; limits.len()];
            normal[handle] = sign;
            // A handle without any room has no scale.
            let most = if *scale == 0.0 { 0.0 } else { sign * bound / scale };
            rows.push(Constraint { normal, most, give: 0.0 });
        }
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::*;

    const WIDE: [f64; 2] = [-100.0, 100.0];

    fn goal(value: f64, sensitivity: &[f64], band: [f64; 2]) -> Goal {
        Goal { value, sensitivity: sensitivity.to_vec(), band, gives: None }
    }

    fn check(goals: &[Goal], limits: &[[f64; 2]], amounts: &[f64]) {
        let found = least_change(goals, limits, &vec![1.0; limits.len()]);
        for (found, expected) in found.amounts.iter().zip(amounts) {
            assert!((found - expected).abs() < 2e-3 * expected.abs().max(1.0), "{:?}, not {amounts:?}", found);
        }
    }

    #[test]
    fn what_lies_in_its_band_is_left() {
        check(&[goal(50.0, &[4.0, 1.0], [40.0, 60.0])], &[WIDE, WIDE], &[0.0, 0.0]);
    }

    #[test]
    fn handles_share_a_goal_by_their_sensitivities() {
        // Least squares under 4 a + 3 b = 50: a = 8, b = 6.
        check(&[goal(-10.0, &[4.0, 3.0], [40.0, 120.0])], &[WIDE, WIDE], &[8.0, 6.0]);
        check(&[goal(170.0, &[4.0, 3.0], [40.0, 120.0])], &[WIDE, WIDE], &[-8.0, -6.0]);
    }

    #[test]
    fn a_handle_at_its_limit_leaves_the_rest_to_the_others() {
        check(&[goal(-10.0, &[4.0, 3.0], [40.0, 120.0])], &[[-5.0, 5.0], WIDE], &[5.0, 10.0]);
    }

    #[test]
    fn two_goals_that_pull_one_handle_are_both_met() {
        // The waist needs 20 more, the hip must not grow: the second handle takes back what the first gives.
        let goals = [goal(0.0, &[4.0, 0.0], [20.0, 90.0]), goal(60.0, &[4.0, 4.0], [0.0, 60.0])];
        check(&goals, &[WIDE, WIDE], &[5.0, -5.0]);
    }

    #[test]
    fn what_limits_forbid_is_missed_by_as_little_as_they_allow() {
        let found = least_change(&[goal(0.0, &[4.0], [100.0, 120.0])], &[[-10.0, 10.0]], &[1.0]);
        assert!((found.amounts[0] - 10.0).abs() < 1e-6 && (found.values[0] - 40.0).abs() < 1e-5, "{found:?}");
    }

    #[test]
    fn what_scatters_gives_way_where_the_change_would_be_dear() {
        // Of a^2 + (10 - a)^2 / give the least, on the lower edge of the band.
        let soft = |give| Goal { gives: Some(give), ..goal(0.0, &[1.0], [10.0, 20.0]) };
        for (give, expected) in [(1.0, 5.0), (0.25, 8.0), (9.0, 1.0)] {
            check(&[soft(give)], &[WIDE], &[expected]);
        }
    }

    #[test]
    fn a_handle_that_is_dear_moves_less() {
        // 4 a + 4 b = 40 with b counted in tenths: a takes a hundred times as much.
        let found = least_change(&[goal(0.0, &[4.0, 4.0], [40.0, 99.0])], &[WIDE, WIDE], &[1.0, 0.1]);
        assert!((found.amounts[0] / found.amounts[1] - 100.0).abs() < 0.5, "{found:?}");
    }

    fn check_set(goals: &[Goal], limits: &[[f64; 2]], expect_mm: &[f64]) {
        let found = fewest(goals, limits, &vec![1.0; limits.len()]);
        for (found, expected) in found.amounts.iter().zip(expect_mm) {
            assert!((1e3 * found - expected).abs() < 0.6, "{:?}, not {expect_mm:?}", found);
        }
    }

    #[test]
    fn one_handle_that_does_it_alone_is_taken_before_two() {
        const WIDE_M: [f64; 2] = [-0.02, 0.02];
        let shared = goal(-0.010, &[2.0, 1.0], [0.020, 0.040]);
        check_set(std::slice::from_ref(&shared), &[WIDE_M; 2], &[15.0, 0.0]);
        // The first handle ends at its limit, so the second joins; each takes a like share of its limit.
        check_set(&[shared], &[[-0.010, 0.010], WIDE_M], &[7.5, 15.0]);
        // One handle serves both goals, though others serve each of them better.
        let both = [goal(0.0, &[1.0, 2.0, 0.0], [0.010, 0.020]), goal(0.0, &[1.0, 0.0, 2.0], [0.010, 0.020])];
        check_set(&both, &[WIDE_M; 3], &[10.0, 0.0, 0.0]);
        // Nothing reaches the goal: the handle goes as far as it may.
        check_set(&[goal(0.0, &[1.0, 0.05], [0.050, 0.060])], &[WIDE_M; 2], &[20.0, 0.0]);
        check_set(&[goal(0.015, &[1.0], [0.010, 0.020])], &[WIDE_M], &[0.0]);
    }

    #[test]
    fn no_subset_of_what_is_found_is_cheaper() {
        let mut state = 1u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) as f64 / f64::from(1u32 << 31)
        };
        for round in 0..10 {
            let limits = [[-0.02, 0.02]; 8];
            let goals: Vec<Goal> = (0..4)
                .map(|_| {
                    let slopes: Vec<f64> = (0..8).map(|_| if random() < 0.4 { 4.0 * random() } else { 0.0 }).collect();
                    goal(0.06 * (random() - 0.5), &slopes, [0.0, 0.01])
                })
                .collect();
            let costs: Vec<f64> = (0..8).map(|_| 1.0 + random()).collect();
            let found = fewest(&goals, &limits, &costs);
            let total = cost(&goals, &limits, &costs, &found.amounts);
            let used: Vec<usize> = (0..8).filter(|k| found.amounts[*k] != 0.0).collect();
            let pairs = used.iter().flat_map(|a| used.iter().map(move |b| [*a, *b]));
            for without in pairs {
                let fewer: Vec<[f64; 2]> =
                    (0..8).map(|k| if without.contains(&k) { [0.0; 2] } else { limits[k] }).collect();
                let other = fewest(&goals, &fewer, &costs);
                let as_good = goals.iter().zip(found.values.iter().zip(&other.values));
                let is_as_good =
                    as_good.clone().all(|(goal, (value, other))| off(goal, *other) <= off(goal, *value) + MET);
                let other = cost(&goals, &limits, &costs, &other.amounts);
                assert!(!is_as_good || other >= 0.9 * total, "{round}: {without:?} costs {other}, not {total}");
            }
        }
    }
}

//! Least change of a pattern that brings its levels into their target bands: a quadratic programme.

/// Quantity of a garment that should lie in a band.
#[derive(Clone, Debug, PartialEq)]
pub struct Goal {
    /// Present value.
    pub value: f64,
    /// Derivative with respect to each handle.
    pub sensitivity: Vec<f64>,
    /// Least and greatest wanted value.
    pub band: [f64; 2],
    /// Compliance of the band, for a quantity that scatters: missing the band by `m` costs `m^2 / gives`, to be added
    /// to the squares of the scaled changes. `None` if the band must be met whatever the change.
    pub gives: Option<f64>,
}

/// A change of handles.
#[derive(Clone, Debug, PartialEq)]
pub struct Change {
    /// Amount of each handle, in its unit.
    pub amounts: Vec<f64>,
    /// Value of each goal after the change.
    pub values: Vec<f64>,
}

/// Ratio of the stiffness of a goal to that of the handles. A goal within the limits is then missed by a ten-thousandth
/// of the change that it asks for.
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
#[must_use]
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

/// Constraint on scaled handles h: `normal . h <= most + give * multiplier`.
struct Constraint {
    normal: Vec<f64>,
    most: f64,
    give: f64,
}

/// Constraints of both ends of every band and every limit.
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
            rows.push(Constraint { normal, most: sign * bound / scale, give: 0.0 });
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
}

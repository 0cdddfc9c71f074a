//! Backtracking line search with Armijo's condition, along a step and its second-order correction.

use super::system::{Assembled, System, rms};
use geom::V3;

geom::constants! {
    "solver.line_search",
    /// Armijo's constant: share of the linearly predicted decrease that a step must reach.
    const SUFFICIENT_DECREASE: f64 = 1e-4;
    const MOST_HALVINGS: usize = 12;
    /// Factor by which a full step is lengthened, repeatedly while the energy falls. The stiffness leaves out
    /// compression, and so steps are too short where cloth buckles.
    const LENGTHENING: f64 = 1.5;
    const MOST_LENGTHENINGS: usize = 6;
    /// Least residual force that a full step is expected to leave, as a share of that before it. Where the residual
    /// asked for is lower, the force after the step is not computed.
    const GREATEST_FALL: f64 = 0.02;
}

/// Curve of a line search: `x + alpha direction + alpha^2 correction`.
pub struct Line<'s, 'c> {
    pub system: &'s System<'c>,
    pub x: &'s [V3],
    pub start: &'s Assembled<'c>,
    /// Displacement of the linear solve.
    pub direction: &'s [V3],
    pub correction: &'s [V3],
    /// Diagonal of the proximal term `M / h^2`, N/m.
    pub inertia: &'s [f64],
}

pub struct Reached {
    /// 0 where no length reduces the energy.
    pub alpha: f64,
    pub positions: Vec<V3>,
}

impl Line<'_, '_> {
    /// With the correction (`corrected` 1) or without it (0).
    fn point(&self, alpha: f64, corrected: f64) -> Vec<V3> {
        let moved = |((p, d), c): ((&V3, &V3), &V3)| p + d * alpha + c * (corrected * alpha * alpha);
        self.x.iter().zip(self.direction).zip(self.correction).map(moved).collect()
    }

    /// Energy with the proximal term, J.
    fn energy(&self, trial: &[V3]) -> f64 {
        let moved = trial.iter().zip(self.x).zip(self.inertia).map(|((p, q), m)| 0.5 * m * (p - q).norm_squared());
        self.system.energy(trial) + moved.sum::<f64>()
    }

    /// Searches the longest `alpha` at which the proximal energy has decreased enough. The correction is applied where
    /// the energy then decreases; else the step follows the direction alone.
    ///
    /// A full step is lengthened while the energy falls, unless its root-mean-square force is at most `enough_n`: that
    /// would bring back the stiff forces that it has just balanced. Without `enough_n` no step is lengthened.
    pub fn search(&self, enough_n: Option<f64>) -> Reached {
        let slope: f64 = self.start.forces.iter().zip(self.direction).map(|(f, d)| f.dot(d)).sum();
        let mut alpha = 1.0;
        for _ in 0..MOST_HALVINGS {
            for corrected in [1.0, 0.0] {
                let positions = self.point(alpha, corrected);
                let energy = self.energy(&positions);
                if energy <= self.start.energy - SUFFICIENT_DECREASE * alpha * slope.max(0.0) {
                    let goes_on =
                        alpha == 1.0 && enough_n.is_some_and(|enough_n| !self.is_enough(enough_n, &positions));
                    return if goes_on {
                        self.lengthen(corrected, energy, positions)
                    } else {
                        Reached { alpha, positions }
                    };
                }
            }
            alpha *= 0.5;
        }
        Reached { alpha: 0.0, positions: self.x.to_vec() }
    }

    /// True if a full step leaves a root-mean-square force of at most `enough_n`. False without computing the forces
    /// where no step could reach that.
    fn is_enough(&self, enough_n: f64, positions: &[V3]) -> bool {
        enough_n > GREATEST_FALL * rms(&self.start.forces) && rms(&self.system.forces(positions)) <= enough_n
    }

    fn lengthen(&self, corrected: f64, mut least: f64, mut positions: Vec<V3>) -> Reached {
        let mut alpha = 1.0;
        for _ in 0..MOST_LENGTHENINGS {
            let further = self.point(LENGTHENING * alpha, corrected);
            let energy = self.energy(&further);
            if energy >= least {
                break;
            }
            (alpha, least, positions) = (LENGTHENING * alpha, energy, further);
        }
        Reached { alpha, positions }
    }
}

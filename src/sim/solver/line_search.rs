//! Backtracking line search along a step and its second-order correction, with Armijo's condition.

use super::system::{Assembled, System, rms};
use geom::V3;

geom::constants! {
    "solver.line_search",
    /// Armijo's constant: share of the predicted decrease that a step must reach.
    const SUFFICIENT_DECREASE: f64 = 1e-4;
    const MOST_HALVINGS: usize = 12;
    /// The stiffness leaves compression out and so is too stiff where cloth buckles: a full step is lengthened by this factor
    /// for as long as the energy falls.
    const LENGTHENING: f64 = 1.5;
    const MOST_LENGTHENINGS: usize = 6;
    /// Share of the forces that a step leaves at best, as far as it is worth looking.
    const GREATEST_FALL: f64 = 0.02;
}

/// What a line search goes along: `x + alpha direction + alpha^2 correction`.
pub struct Line<'s, 'c> {
    /// The cloth and what acts on it.
    pub system: &'s System<'c>,
    /// Where the step starts.
    pub x: &'s [V3],
    /// What acts there.
    pub start: &'s Assembled<'c>,
    /// The linear solve's displacements, m.
    pub direction: &'s [V3],
    /// Their second-order correction, m.
    pub correction: &'s [V3],
    /// Diagonal of the inertia `M / h^2`, N/m.
    pub inertia: &'s [f64],
}

impl Line<'_, '_> {
    fn at(&self, alpha: f64, corrected: f64) -> Vec<V3> {
        let point = |((p, d), c): ((&V3, &V3), &V3)| p + d * alpha + c * (corrected * alpha * alpha);
        self.x.iter().zip(self.direction).zip(self.correction).map(point).collect()
    }

    /// Energy with inertia, J.
    fn energy(&self, trial: &[V3]) -> f64 {
        let moved = trial.iter().zip(self.x).zip(self.inertia).map(|((p, q), m)| 0.5 * m * (p - q).norm_squared());
        self.system.energy(trial) + moved.sum::<f64>()
    }

    /// The longest `alpha` at which the proximal energy has decreased enough, and the positions there. The step is corrected where that
    /// decreases the energy, else it goes along the direction alone; `alpha` is 0 where nothing decreases it.
    ///
    /// A full step is lengthened while the energy falls. One that leaves rms forces of `enough_n` or less is not: a longer one would call
    /// the stiff forces back that it has just balanced. Without `enough_n` none is.
    #[must_use]
    pub fn search(&self, enough_n: Option<f64>) -> (f64, Vec<V3>) {
        let slope: f64 = self.start.forces.iter().zip(self.direction).map(|(f, d)| f.dot(d)).sum();
        let mut alpha = 1.0;
        for _ in 0..MOST_HALVINGS {
            for corrected in [1.0, 0.0] {
                let positions = self.at(alpha, corrected);
                let energy = self.energy(&positions);
                if energy <= self.start.energy - SUFFICIENT_DECREASE * alpha * slope.max(0.0) {
                    let goes_on =
                        alpha == 1.0 && enough_n.is_some_and(|enough_n| !self.is_enough(enough_n, &positions));
                    return if goes_on { self.lengthen(corrected, energy, positions) } else { (alpha, positions) };
                }
            }
            alpha *= 0.5;
        }
        (0.0, self.x.to_vec())
    }

    /// Whether a full step to these positions leaves no more force than that, N, where it is worth looking.
    fn is_enough(&self, enough_n: f64, positions: &[V3]) -> bool {
        enough_n > GREATEST_FALL * rms(&self.start.forces) && rms(&self.system.forces(positions)) <= enough_n
    }

    /// Goes on beyond a full step, which reached some energy, while that falls.
    fn lengthen(&self, corrected: f64, mut least: f64, mut positions: Vec<V3>) -> (f64, Vec<V3>) {
        let mut alpha = 1.0;
        for _ in 0..MOST_LENGTHENINGS {
            let further = self.at(LENGTHENING * alpha, corrected);
            let energy = self.energy(&further);
            if energy >= least {
                break;
            }
            (alpha, least, positions) = (LENGTHENING * alpha, energy, further);
        }
        (alpha, positions)
    }
}

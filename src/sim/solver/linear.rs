//! The linear solves of a step: conjugate gradients with one of three preconditioners.

use nalgebra::Matrix3;
use wide::{f32x4, f64x4};

use super::factor::Factor;
use super::operator::Operator;
use super::patches::{Coarse, Patches};
use super::pcg::{self, PcgParams};
use super::quad::{self, Block};
use super::rows::Rows;
use crate::geom::V3;

/// How the linear systems of a cloth are solved.
pub enum LinearSolver {
    /// Block-Jacobi and patches that move rigidly: approximate, for garments.
    Patches(Option<Box<TwoLevel>>),
    /// A Cholesky factor, renewed when it has aged: exact, for specimens whose answer is compared with mechanics.
    Factor(Option<Box<Factor>>),
}

/// Iterations with an old factor after which a new one is made: about as many solves as a factorisation costs.
const PATIENCE: usize = 6;

impl Default for LinearSolver {
    fn default() -> Self {
        Self::Patches(None)
    }
}

impl LinearSolver {
    /// The solver that factorises.
    #[must_use]
    pub fn exact() -> Self {
        Self::Factor(None)
    }

    /// Whether it factorises.
    #[must_use]
    pub fn is_exact(&self) -> bool {
        matches!(self, Self::Factor(_))
    }

    /// Solves `K x = b` approximately, improving `x`, with the cloth at `positions`.
    pub fn solve(&mut self, operator: &Operator, positions: &[V3], b: &[V3], x: &mut [V3], params: &PcgParams) {
        match self {
            Self::Patches(kept) => {
                let two_level = kept.get_or_insert_with(|| Box::new(TwoLevel::new(operator)));
                two_level.solve(operator, positions, b, x, params);
            }
            Self::Factor(kept) => {
                let aged = kept.is_some();
                let factor = kept.get_or_insert_with(|| Box::new(Factor::new(operator)));
                let attempt = PcgParams { max_iterations: PATIENCE, ..*params };
                let rows = Rows::<f64x4>::new(operator);
                if aged && pcg::solve(&rows, &|r, z| factor.solve(r, z), b, x, &attempt).is_solved {
                    return;
                }
                factor.refresh(operator);
                pcg::solve(&rows, &|r, z| factor.solve(r, z), b, x, params);
            }
        }
    }
}

/// Solves `K x = b` with block-Jacobi in single precision: a direction of descent need not be better.
pub fn jacobi(operator: &Operator, b: &[V3], x: &mut [V3], params: &PcgParams) {
    let inverses = inverses(&operator.diagonal_blocks());
    pcg::solve(&Rows::new(operator), &|r, z| times(&inverses, r, z), b, x, params);
}

/// Block-Jacobi with the rigid motions of patches added, whose stiffness is factorised now and then.
pub struct TwoLevel {
    patches: Patches,
    coarse: Option<Coarse>,
    /// Iterations that the factor took when it was new.
    when_new: usize,
    /// Iterations that its age has cost since.
    lost: usize,
}

/// Iterations that a new factor costs.
const FACTOR_COST: usize = 12;

impl TwoLevel {
    fn new(operator: &Operator) -> Self {
        Self { patches: Patches::new(operator), coarse: None, when_new: 0, lost: 0 }
    }

    fn solve(&mut self, operator: &Operator, positions: &[V3], b: &[V3], x: &mut [V3], params: &PcgParams) {
        let diagonal = operator.diagonal_blocks();
        let inverses = inverses(&diagonal);
        let kept = self.coarse.take().filter(|_| self.lost < FACTOR_COST);
        let is_new = kept.is_none();
        let coarse = kept.unwrap_or_else(|| self.patches.factorise(operator, &diagonal, positions));
        let precondition = |r: &[f32x4], z: &mut [f32x4]| {
            times(&inverses, r, z);
            self.patches.add(&coarse, r, z);
        };
        let iterations = pcg::solve(&Rows::new(operator), &precondition, b, x, params).iterations;
        if is_new {
            (self.when_new, self.lost) = (iterations, 0);
        } else {
            self.lost += iterations.saturating_sub(self.when_new);
        }
        self.coarse = Some(coarse);
    }
}

fn inverses(diagonal: &[Matrix3<f64>]) -> Vec<Block<f32x4>> {
    diagonal.iter().map(|d| quad::block(&d.try_inverse().unwrap_or_else(Matrix3::zeros))).collect()
}

/// `z = D r` for symmetric blocks on a diagonal.
fn times(blocks: &[Block<f32x4>], r: &[f32x4], z: &mut [f32x4]) {
    for ((z, r), block) in z.iter_mut().zip(r).zip(blocks) {
        *z = quad::transposed_times(block, *r);
    }
}

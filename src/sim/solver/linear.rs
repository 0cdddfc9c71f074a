//! The linear solves of a step: conjugate gradients with one of two preconditioners.

use nalgebra::Matrix3;

use super::factor::Factor;
use super::operator::Operator;
use super::pcg::{self, PcgParams};
use super::rows::{self, Quad, Rows};
use crate::geom::V3;

/// How the linear systems of a cloth are solved.
#[derive(Default)]
pub enum LinearSolver {
    /// Block-Jacobi: cheap, approximate, for garments.
    #[default]
    Jacobi,
    /// A Cholesky factor, renewed when it has aged: exact, for specimens whose answer is compared with mechanics.
    Factor(Option<Box<Factor>>),
}

/// Iterations with an old factor after which a new one is made: about as many solves as a factorisation costs.
const PATIENCE: usize = 6;

impl LinearSolver {
    /// The solver that factorises.
    #[must_use]
    pub fn exact() -> Self {
        Self::Factor(None)
    }

    /// Solves `K x = b` approximately, improving `x`.
    pub fn solve(&mut self, operator: &Operator, b: &[V3], x: &mut [V3], params: &PcgParams) {
        match self {
            Self::Jacobi => jacobi(operator, b, x, params),
            Self::Factor(kept) => {
                let aged = kept.is_some();
                let factor = kept.get_or_insert_with(|| Box::new(Factor::new(operator)));
                let attempt = PcgParams { max_iterations: PATIENCE, ..*params };
                let rows = Rows::<f64>::new(operator);
                if aged && pcg::solve(&rows, &|r, z| factor.solve(r, z), b, x, &attempt) {
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
    let inverse = |d: &Matrix3<f64>| rows::block::<f32>(&d.try_inverse().unwrap_or_else(Matrix3::zeros));
    let inverses: Vec<_> = operator.diagonal_blocks().iter().map(inverse).collect();
    let precondition = |r: &[Quad<f32>], z: &mut [Quad<f32>]| {
        for ((z, r), d) in z.iter_mut().zip(r).zip(&inverses) {
            *z = rows::add_times([0.0; 4], d, r);
        }
    };
    pcg::solve(&Rows::new(operator), &precondition, b, x, params);
}

//! The linear solves of a step: conjugate gradients with one of three preconditioners.

use nalgebra::Matrix3;
use wide::{f32x4, f64x4};

use super::blocks::Row;
use super::factor::Factor;
use super::machine::Machine;
use super::operator::Operator;
use super::patches::{Coarse, Patches};
use super::pcg::{self, PcgParams, Preconditioner};
use super::quad::{self, Block, Quad};
use super::rows::Rows;
use geom::V3;

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
                if aged && pcg::solve(&rows, &**factor, b, x, &attempt).is_solved {
                    return;
                }
                factor.refresh(operator);
                pcg::solve(&rows, &**factor, b, x, params);
            }
        }
    }
}

/// Solves `K x = b` with block-Jacobi in single precision: a direction of descent need not be better.
pub fn jacobi(operator: &Operator, b: &[V3], x: &mut [V3], params: &PcgParams) {
    pcg::solve(&Rows::new(operator), Jacobi::new(&operator.diagonal_blocks()), b, x, params);
}

/// Inverses of the diagonal blocks.
struct Jacobi(Vec<Block<f32x4>>);

/// Products that are summed up in single precision.
const SUMMED: usize = 256;

impl Jacobi {
    fn new(diagonal: &[Matrix3<f64>]) -> Self {
        let inverse = |d: &Matrix3<f64>| quad::block(&d.try_inverse().unwrap_or_else(Matrix3::zeros));
        Self(diagonal.iter().map(inverse).collect())
    }
}

impl Preconditioner<f32x4> for Jacobi {
    #[inline(always)]
    fn begin<M: Machine>(&mut self, machine: M, r: &[f32x4], z: &mut [f32x4]) -> f64 {
        let mut works = 0.0;
        for ((z, r), blocks) in z.chunks_mut(SUMMED).zip(r.chunks(SUMMED)).zip(self.0.chunks(SUMMED)) {
            let mut sum = f32x4::ZERO;
            for ((z, r), block) in z.iter_mut().zip(r).zip(blocks) {
                *z = quad::transposed_times(block, *r);
                sum = machine.plus(*z, *r, sum);
            }
            works += sum.total();
        }
        works
    }
}

impl Preconditioner<f64x4> for &Factor {
    #[inline(always)]
    fn begin<M: Machine>(&mut self, _: M, r: &[f64x4], z: &mut [f64x4]) -> f64 {
        self.solve(r, z);
        pcg::dot(r, z, |r, z| *r * *z)
    }
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
        let kept = self.coarse.take().filter(|_| self.lost < FACTOR_COST);
        let is_new = kept.is_none();
        let coarse = kept.unwrap_or_else(|| self.patches.factorise(operator, &diagonal, positions));
        let motions = Vec::new();
        let both = Both { jacobi: Jacobi::new(&diagonal), patches: &self.patches, coarse: &coarse, motions };
        let iterations = pcg::solve(&Rows::new(operator), both, b, x, params).iterations;
        if is_new {
            (self.when_new, self.lost) = (iterations, 0);
        } else {
            self.lost += iterations.saturating_sub(self.when_new);
        }
        self.coarse = Some(coarse);
    }
}

/// Vertices one by one, and patches of them.
struct Both<'a> {
    jacobi: Jacobi,
    patches: &'a Patches,
    coarse: &'a Coarse,
    /// How the patches answer.
    motions: Vec<Row>,
}

impl Preconditioner<f32x4> for Both<'_> {
    #[inline(always)]
    fn begin<M: Machine>(&mut self, machine: M, r: &[f32x4], z: &mut [f32x4]) -> f64 {
        let works = self.jacobi.begin(machine, r, z);
        works + self.patches.answer(machine, self.coarse, r, &mut self.motions)
    }

    #[inline(always)]
    fn turn<M: Machine>(&self, machine: M, z: &[f32x4], beta: f32x4, states: &mut [[f32x4; 2]]) {
        self.patches.turn(machine, self.coarse, (&self.motions, z), beta, states);
    }
}

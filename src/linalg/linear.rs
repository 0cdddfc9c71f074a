//! Linear solves of a time step: conjugate gradients with one of three preconditioners.

use nalgebra::Matrix3;
use wide::{f32x4, f64x4};

use super::cholesky::Row;
use super::coarse::{CoarseFactor, CoarseSpace, Correction};
use super::csr::CsrMatrix;
use super::exact::Factor;
use super::operator::Operator;
use super::pcg::{self, PcgParams, Preconditioner};
use super::quad::{self, Block, Quad};
use super::simd::Simd;
use geom::V3;

pub enum LinearSolver {
    /// Block-Jacobi with a coarse space of rigid patches, for garments. Solutions are approximate.
    Patches(Option<Box<TwoLevel>>),
    /// Cholesky factor that is renewed when it has aged, for specimens that are compared with exact mechanics.
    Factor(Option<Box<Factor>>),
}

geom::constants! {
    "linalg.linear",
    /// Iterations with an old factor after which a new factor is made. They cost about as much as a factorisation.
    const PATIENCE: usize = 6;
    /// Number of products summed in single precision. Longer sums are accumulated in double.
    const SUMMED: usize = 256;
    /// Iterations in excess that cost as much as a new factor of the coarse space.
    const FACTOR_COST: usize = 12;
}

impl Default for LinearSolver {
    fn default() -> Self {
        Self::Patches(None)
    }
}

impl LinearSolver {
    pub fn exact() -> Self {
        Self::Factor(None)
    }

    pub fn is_exact(&self) -> bool {
        matches!(self, Self::Factor(_))
    }

    /// Solves `K x = b` approximately, starting from `x`.
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
                let rows = CsrMatrix::<f64x4>::new(operator);
                if aged && pcg::solve(&rows, &**factor, b, x, &attempt).is_solved {
                    return;
                }
                factor.refresh(operator);
                pcg::solve(&rows, &**factor, b, x, params);
            }
        }
    }
}

/// Solves `K x = b` with block-Jacobi in single precision, which suffices for a direction of descent.
pub fn jacobi(operator: &Operator, b: &[V3], x: &mut [V3], params: &PcgParams) {
    pcg::solve(&CsrMatrix::new(operator), Jacobi::new(&operator.diagonal_blocks()), b, x, params);
}

struct Jacobi(Vec<Block<f32x4>>);

impl Jacobi {
    fn new(diagonal: &[Matrix3<f64>]) -> Self {
        let inverse = |d: &Matrix3<f64>| quad::block(&d.try_inverse().unwrap_or_else(Matrix3::zeros));
        Self(diagonal.iter().map(inverse).collect())
    }
}

impl Preconditioner<f32x4> for Jacobi {
    #[inline(always)]
    fn apply<S: Simd>(&mut self, simd: S, r: &[f32x4], z: &mut [f32x4]) -> f64 {
        let mut r_dot_z = 0.0;
        for ((z, r), blocks) in z.chunks_mut(SUMMED).zip(r.chunks(SUMMED)).zip(self.0.chunks(SUMMED)) {
            let mut sum = f32x4::ZERO;
            for ((z, r), block) in z.iter_mut().zip(r).zip(blocks) {
                *z = quad::transposed_times(block, *r);
                sum = simd.mul_add(*z, *r, sum);
            }
            r_dot_z += sum.total();
        }
        r_dot_z
    }
}

impl Preconditioner<f64x4> for &Factor {
    #[inline(always)]
    fn apply<S: Simd>(&mut self, _: S, r: &[f64x4], z: &mut [f64x4]) -> f64 {
        self.solve(r, z);
        pcg::dot(r, z, |r, z| *r * *z)
    }
}

/// Block-Jacobi plus the coarse space of patches, whose factor is renewed when it has aged.
pub struct TwoLevel {
    patches: CoarseSpace,
    coarse: Option<CoarseFactor>,
    /// Number of iterations with the factor when it was new.
    when_new: usize,
    /// Sum of the iterations beyond that number in later solves.
    lost: usize,
}

impl TwoLevel {
    fn new(operator: &Operator) -> Self {
        Self { patches: CoarseSpace::new(operator), coarse: None, when_new: 0, lost: 0 }
    }

    fn solve(&mut self, operator: &Operator, positions: &[V3], b: &[V3], x: &mut [V3], params: &PcgParams) {
        let diagonal = operator.diagonal_blocks();
        let kept = self.coarse.take().filter(|_| self.lost < FACTOR_COST);
        let is_new = kept.is_none();
        let coarse = kept.unwrap_or_else(|| self.patches.factorise(operator, &diagonal, positions));
        let motions = Vec::new();
        let both =
            TwoLevelPreconditioner { jacobi: Jacobi::new(&diagonal), patches: &self.patches, coarse: &coarse, motions };
        let iterations = pcg::solve(&CsrMatrix::new(operator), both, b, x, params).iterations;
        if is_new {
            (self.when_new, self.lost) = (iterations, 0);
        } else {
            self.lost += iterations.saturating_sub(self.when_new);
        }
        self.coarse = Some(coarse);
    }
}

struct TwoLevelPreconditioner<'a> {
    jacobi: Jacobi,
    patches: &'a CoarseSpace,
    coarse: &'a CoarseFactor,
    motions: Vec<Row>,
}

impl Preconditioner<f32x4> for TwoLevelPreconditioner<'_> {
    #[inline(always)]
    fn apply<S: Simd>(&mut self, simd: S, r: &[f32x4], z: &mut [f32x4]) -> f64 {
        let r_dot_z = self.jacobi.apply(simd, r, z);
        r_dot_z + self.patches.restrict_and_solve(simd, self.coarse, r, &mut self.motions)
    }

    #[inline(always)]
    fn next_direction<S: Simd>(&self, simd: S, z: &[f32x4], beta: f32x4, states: &mut [[f32x4; 2]]) {
        let preconditioned = Correction { motions: &self.motions, z };
        self.patches.next_direction(simd, self.coarse, preconditioned, beta, states);
    }
}

//! Preconditioned conjugate gradients.

use super::csr::CsrMatrix;
use super::quad::Quad;
use super::simd::{self, Kernel, Simd};
use geom::V3;

#[derive(Clone, Copy, Debug)]
pub struct PcgParams {
    /// Greatest ratio of residual to right-hand side, both in the norm of the preconditioner, at which a solve stops.
    pub tolerance: f64,
    pub max_iterations: usize,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Outcome {
    pub is_solved: bool,
    pub iterations: usize,
}

/// Preconditioner `P`, applied in two steps, between which only the product `r . P r` is needed.
pub trait Preconditioner<Q: Quad> {
    /// Makes the first step of `P r`. Returns `r . P r`.
    fn apply<S: Simd>(&mut self, simd: S, r: &[Q], z: &mut [Q]) -> f64;

    /// Makes the second step: updates the direction in `[p, K p]` to `p = P r + beta p`, with `z` of the first step.
    #[inline(always)]
    fn next_direction<S: Simd>(&self, simd: S, z: &[Q], beta: Q, states: &mut [[Q; 2]]) {
        for ([p, _], z) in states.iter_mut().zip(z) {
            *p = beta.mul_add_on(*p, *z, simd);
        }
    }
}

/// Improves `x` towards the solution of `K x = b`, starting from the best multiple of `x` between 0 and 1.
///
/// Every iterate decreases the quadratic `x.K x / 2 - b.x`, so a solve that is cut short still yields a descent
/// direction.
pub fn solve<Q: Quad>(
    operator: &CsrMatrix<Q>,
    preconditioner: impl Preconditioner<Q>,
    b: &[V3],
    x: &mut [V3],
    params: &PcgParams,
) -> Outcome {
    let mut state: Vec<Q> = x.iter().map(Q::from_vector).collect();
    let b: Vec<Q> = b.iter().map(Q::from_vector).collect();
    let outcome = simd::dispatch(Improvement { operator, preconditioner, b: &b, x: &mut state, params });
    for (x, state) in x.iter_mut().zip(state) {
        *x = state.vector();
    }
    outcome
}

struct Improvement<'a, Q: Quad, P> {
    operator: &'a CsrMatrix<'a, Q>,
    preconditioner: P,
    b: &'a [Q],
    x: &'a mut [Q],
    params: &'a PcgParams,
}

impl<Q: Quad, P: Preconditioner<Q>> Kernel for Improvement<'_, Q, P> {
    type Output = Outcome;

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) -> Outcome {
        let Self { operator, mut preconditioner, b, x, params } = self;
        let (alike, within) = (|a: &Q, b: &Q| *a * *b, |[p, kp]: &[Q; 2], _: &[Q; 2]| *p * *kp);
        let mut z = vec![Q::ZERO; b.len()];
        let goal = preconditioner.apply(simd, b, &mut z) * params.tolerance * params.tolerance;
        // Direction `p` and `K p`. The given `x` is the first direction.
        let mut states: Vec<[Q; 2]> = x.iter().map(|x| [*x, Q::ZERO]).collect();
        operator.apply(simd, &mut states);
        // The best multiple of `x`, so that the start is no worse than zero.
        let scale = dot(x, b, alike) / dot(&states, &states, within);
        let mut alpha = if scale.is_finite() { scale.clamp(0.0, 1.0) } else { 0.0 };
        x.fill(Q::ZERO);
        let mut r = b.to_vec();
        let mut rz = f64::INFINITY;
        for iterations in 0..=params.max_iterations {
            let share = Q::spread(alpha);
            for ((x, r), [p, kp]) in x.iter_mut().zip(&mut r).zip(&states) {
                *x = share.mul_add_on(*p, *x, simd);
                *r = share.neg_mul_add_on(*kp, *r, simd);
            }
            let rz_next = preconditioner.apply(simd, &r, &mut z);
            if rz_next <= goal || rz_next <= Q::NEGLIGIBLE {
                return Outcome { is_solved: true, iterations };
            }
            if iterations == params.max_iterations {
                break;
            }
            // The second direction is that of the residual alone, because `rz` is infinite.
            let beta = Q::spread(rz_next / rz);
            rz = rz_next;
            preconditioner.next_direction(simd, &z, beta, &mut states);
            operator.apply(simd, &mut states);
            let curvature = dot(&states, &states, within);
            if curvature <= 0.0 {
                return Outcome { is_solved: true, iterations };
            }
            alpha = rz / curvature;
        }
        Outcome { is_solved: false, iterations: params.max_iterations }
    }
}

/// Sums in four partial sums, so that no addition waits for the preceding one.
#[inline(always)]
pub fn dot<Q: Quad, T, U>(a: &[T], b: &[U], product: impl Fn(&T, &U) -> Q) -> f64 {
    let ((a, a_rest), (b, b_rest)) = (a.as_chunks::<4>(), b.as_chunks::<4>());
    let mut sums = [Q::ZERO; 4];
    for (a, b) in a.iter().zip(b) {
        for k in 0..4 {
            sums[k] += product(&a[k], &b[k]);
        }
    }
    for (a, b) in a_rest.iter().zip(b_rest) {
        sums[0] += product(a, b);
    }
    ((sums[0] + sums[1]) + (sums[2] + sums[3])).total()
}

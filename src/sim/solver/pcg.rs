//! Preconditioned conjugate gradients.

use super::quad::Quad;
use super::rows::Rows;
use crate::geom::V3;

/// When to stop.
#[derive(Clone, Copy, Debug)]
pub struct PcgParams {
    /// Stop when the preconditioned residual has fallen to this share of that of the right-hand side.
    pub tolerance: f64,
    /// Stop after so many iterations at the latest.
    pub max_iterations: usize,
}

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Outcome {
    /// Whether the tolerance was met.
    pub is_solved: bool,
    /// Iterations.
    pub iterations: usize,
}

/// Writes `z = P r` for `(r, z)`.
pub type Preconditioner<'a, Q> = dyn Fn(&[Q], &mut [Q]) + 'a;

/// Improves `x` towards the solution of `K x = b` with a preconditioner `z = P r`, starting at the best multiple of it; says
/// how that ended.
///
/// Every iterate descends the quadratic `x.K x / 2 - b.x`, so a run cut short still yields a descent direction.
pub fn solve<Q: Quad>(
    operator: &Rows<Q>,
    precondition: &Preconditioner<Q>,
    b: &[V3],
    x: &mut [V3],
    params: &PcgParams,
) -> Outcome {
    let mut state: Vec<Q> = x.iter().map(Q::from_vector).collect();
    let outcome =
        improve(operator, precondition, &b.iter().map(Q::from_vector).collect::<Vec<_>>(), &mut state, params);
    for (x, state) in x.iter_mut().zip(state) {
        *x = state.vector();
    }
    outcome
}

fn improve<Q: Quad>(
    operator: &Rows<Q>,
    precondition: &Preconditioner<Q>,
    b: &[Q],
    x: &mut [Q],
    params: &PcgParams,
) -> Outcome {
    let mut z = vec![Q::ZERO; b.len()];
    let mut kp = z.clone();
    precondition(b, &mut z);
    let goal = dot(b, &z) * params.tolerance * params.tolerance;
    operator.apply(x, &mut kp);
    // Never worse than zero.
    let scale = dot(x, b) / dot(x, &kp);
    let scale = if scale.is_finite() { scale.clamp(0.0, 1.0) } else { 0.0 };
    x.iter_mut().for_each(|x| *x = *x * Q::spread(scale));
    let mut r = b.to_vec();
    add_scaled(&mut r, Q::spread(-scale), &kp);
    precondition(&r, &mut z);
    let mut p = z.clone();
    let mut rz = dot(&r, &z);
    for iterations in 0..params.max_iterations {
        if rz <= goal || rz <= Q::NEGLIGIBLE {
            return Outcome { is_solved: true, iterations };
        }
        operator.apply(&p, &mut kp);
        let curvature = dot(&p, &kp);
        if curvature <= 0.0 {
            return Outcome { is_solved: true, iterations };
        }
        let alpha = rz / curvature;
        add_scaled(x, Q::spread(alpha), &p);
        add_scaled(&mut r, Q::spread(-alpha), &kp);
        precondition(&r, &mut z);
        let rz_next = dot(&r, &z);
        let beta = Q::spread(rz_next / rz);
        rz = rz_next;
        for (p, z) in p.iter_mut().zip(&z) {
            *p = *z + beta * *p;
        }
    }
    Outcome { is_solved: rz <= goal, iterations: params.max_iterations }
}

fn add_scaled<Q: Quad>(a: &mut [Q], scale: Q, b: &[Q]) {
    for (a, b) in a.iter_mut().zip(b) {
        *a += scale * *b;
    }
}

/// Inner product; sums side by side, so that none waits for the other.
fn dot<Q: Quad>(a: &[Q], b: &[Q]) -> f64 {
    let ((a, a_rest), (b, b_rest)) = (a.as_chunks::<4>(), b.as_chunks::<4>());
    let mut sums = [Q::ZERO; 4];
    for (a, b) in a.iter().zip(b) {
        for k in 0..4 {
            sums[k] += a[k] * b[k];
        }
    }
    for (a, b) in a_rest.iter().zip(b_rest) {
        sums[0] += *a * *b;
    }
    ((sums[0] + sums[1]) + (sums[2] + sums[3])).total()
}

//! Preconditioned conjugate gradients.

use super::operator::Operator;
use crate::geom::V3;

/// When to stop.
#[derive(Clone, Copy, Debug)]
pub struct PcgParams {
    /// Stop when the preconditioned residual has fallen to this share of that of the right-hand side.
    pub tolerance: f64,
    /// Stop after so many iterations at the latest.
    pub max_iterations: usize,
}

/// Improves `x` towards the solution of `K x = b` with a preconditioner `z = P r`, starting at the best multiple of it; says
/// whether the tolerance was met.
///
/// Every iterate descends the quadratic `x.K x / 2 - b.x`, so a run cut short still yields a descent direction.
pub fn solve(
    operator: &Operator,
    precondition: &dyn Fn(&[V3], &mut [V3]),
    b: &[V3],
    x: &mut [V3],
    params: &PcgParams,
) -> bool {
    let n = b.len();
    let mut z = vec![V3::zeros(); n];
    let mut kp = vec![V3::zeros(); n];
    precondition(b, &mut z);
    let goal = dot(b, &z) * params.tolerance * params.tolerance;
    operator.apply(x, &mut kp);
    // Never worse than zero.
    let scale = dot(x, b) / dot(x, &kp);
    let scale = if scale.is_finite() { scale.clamp(0.0, 1.0) } else { 0.0 };
    x.iter_mut().for_each(|x| *x *= scale);
    let mut r: Vec<V3> = b.iter().zip(&kp).map(|(b, k)| b - k * scale).collect();
    precondition(&r, &mut z);
    let mut p = z.clone();
    let mut rz = dot(&r, &z);
    for _ in 0..params.max_iterations {
        if rz <= goal || rz <= f64::MIN_POSITIVE {
            return true;
        }
        operator.apply(&p, &mut kp);
        let curvature = dot(&p, &kp);
        if curvature <= 0.0 {
            return true;
        }
        let alpha = rz / curvature;
        for i in 0..n {
            x[i] += p[i] * alpha;
            r[i] -= kp[i] * alpha;
        }
        precondition(&r, &mut z);
        let rz_next = dot(&r, &z);
        let beta = rz_next / rz;
        rz = rz_next;
        for i in 0..n {
            p[i] = z[i] + p[i] * beta;
        }
    }
    rz <= goal
}

fn dot(a: &[V3], b: &[V3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.dot(b)).sum()
}

//! Preconditioned conjugate gradients with block-Jacobi preconditioning.

use nalgebra::Matrix3;

use super::operator::Operator;
use crate::geom::V3;

/// When to stop.
#[derive(Clone, Copy, Debug)]
pub struct PcgParams {
    /// Stop when the preconditioned residual has fallen to this share of its start.
    pub tolerance: f64,
    /// Stop after so many iterations at the latest.
    pub max_iterations: usize,
}

/// Solves `K x = b` approximately, from the best multiple of `start` (else from zero).
///
/// Every iterate descends the quadratic `x.K x / 2 - b.x`, so a run cut short still yields a descent direction.
#[must_use]
pub fn solve(operator: &Operator, b: &[V3], start: Option<&[V3]>, params: &PcgParams) -> Vec<V3> {
    let inverse: Vec<Matrix3<f64>> =
        operator.diagonal_blocks().iter().map(|d| d.try_inverse().unwrap_or_else(Matrix3::zeros)).collect();
    let n = b.len();
    let mut x = start.map_or_else(|| vec![V3::zeros(); n], <[V3]>::to_vec);
    let mut r = b.to_vec();
    let b_norm = dot(b, &precondition(&inverse, b));
    if start.is_some() {
        let mut kx = vec![V3::zeros(); n];
        operator.apply(&x, &mut kx);
        // The best multiple of the start: never worse than zero.
        let scale = dot(&x, b) / dot(&x, &kx);
        let scale = if scale.is_finite() { scale.clamp(0.0, 1.0) } else { 0.0 };
        for i in 0..n {
            x[i] *= scale;
            r[i] -= kx[i] * scale;
        }
    }
    let mut z = precondition(&inverse, &r);
    let mut p = z.clone();
    let mut kp = vec![V3::zeros(); n];
    let mut rz = dot(&r, &z);
    let goal = b_norm * params.tolerance * params.tolerance;
    for _ in 0..params.max_iterations {
        if rz <= goal || rz <= f64::MIN_POSITIVE {
            return x;
        }
        operator.apply(&p, &mut kp);
        let curvature = dot(&p, &kp);
        if curvature <= 0.0 {
            return x;
        }
        let alpha = rz / curvature;
        for i in 0..n {
            x[i] += p[i] * alpha;
            r[i] -= kp[i] * alpha;
            z[i] = inverse[i] * r[i];
        }
        let rz_next = dot(&r, &z);
        let beta = rz_next / rz;
        rz = rz_next;
        for i in 0..n {
            p[i] = z[i] + p[i] * beta;
        }
    }
    x
}

fn precondition(inverse: &[Matrix3<f64>], r: &[V3]) -> Vec<V3> {
    inverse.iter().zip(r).map(|(d, r)| d * r).collect()
}

fn dot(a: &[V3], b: &[V3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.dot(b)).sum()
}

//! Preconditioned conjugate gradients.

use nalgebra::RealField;

use super::rows::{self, Quad, Rows};
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
pub type Preconditioner<'a, T> = dyn Fn(&[Quad<T>], &mut [Quad<T>]) + 'a;

/// Improves `x` towards the solution of `K x = b` with a preconditioner `z = P r`, starting at the best multiple of it; says
/// how that ended.
///
/// Every iterate descends the quadratic `x.K x / 2 - b.x`, so a run cut short still yields a descent direction.
pub fn solve<T: RealField + Copy>(
    operator: &Rows<T>,
    precondition: &Preconditioner<T>,
    b: &[V3],
    x: &mut [V3],
    params: &PcgParams,
) -> Outcome {
    let n = b.len();
    let mut state: Vec<Quad<T>> = x.iter().map(rows::quad).collect();
    let solved = improve(operator, precondition, &b.iter().map(rows::quad).collect::<Vec<_>>(), &mut state, params);
    for v in 0..n {
        let component = |k: usize| state[v][k].to_subset().unwrap_or(f64::NAN);
        x[v] = V3::new(component(0), component(1), component(2));
    }
    solved
}

fn improve<T: RealField + Copy>(
    operator: &Rows<T>,
    precondition: &Preconditioner<T>,
    b: &[Quad<T>],
    x: &mut [Quad<T>],
    params: &PcgParams,
) -> Outcome {
    let n = b.len();
    let tolerance: T = nalgebra::convert(params.tolerance);
    let mut z = vec![[T::zero(); 4]; n];
    let mut kp = z.clone();
    precondition(b, &mut z);
    let goal = dot(b, &z) * tolerance * tolerance;
    operator.apply(x, &mut kp);
    // Never worse than zero.
    let scale = dot(x, b) / dot(x, &kp);
    let scale = if scale.is_finite() { scale.clamp(T::zero(), T::one()) } else { T::zero() };
    x.iter_mut().flatten().for_each(|x| *x *= scale);
    let mut r = b.to_vec();
    add_scaled(&mut r, -scale, &kp);
    precondition(&r, &mut z);
    let mut p = z.clone();
    let mut rz = dot(&r, &z);
    let nothing = T::default_epsilon().powi(3);
    for iterations in 0..params.max_iterations {
        if rz <= goal || rz <= nothing {
            return Outcome { is_solved: true, iterations };
        }
        operator.apply(&p, &mut kp);
        let curvature = dot(&p, &kp);
        if curvature <= T::zero() {
            return Outcome { is_solved: true, iterations };
        }
        let alpha = rz / curvature;
        add_scaled(x, alpha, &p);
        add_scaled(&mut r, -alpha, &kp);
        precondition(&r, &mut z);
        let rz_next = dot(&r, &z);
        let beta = rz_next / rz;
        rz = rz_next;
        for (p, z) in p.iter_mut().zip(&z) {
            for k in 0..4 {
                p[k] = z[k] + beta * p[k];
            }
        }
    }
    Outcome { is_solved: rz <= goal, iterations: params.max_iterations }
}

fn add_scaled<T: RealField + Copy>(a: &mut [Quad<T>], scale: T, b: &[Quad<T>]) {
    for (a, b) in a.iter_mut().zip(b) {
        for k in 0..4 {
            a[k] += scale * b[k];
        }
    }
}

/// Inner product; four sums side by side.
fn dot<T: RealField + Copy>(a: &[Quad<T>], b: &[Quad<T>]) -> T {
    let mut sums = [T::zero(); 4];
    for (a, b) in a.iter().zip(b) {
        for k in 0..4 {
            sums[k] += a[k] * b[k];
        }
    }
    (sums[0] + sums[2]) + (sums[1] + sums[3])
}

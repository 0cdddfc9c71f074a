//! Tangent stiffness of a cloth by finite differences of its forces, and its factor.
//!
//! The stiffness of a time step is positive definite and cheap, not exact: compression is left out, friction is stiff,
//! bending is condensed. The response to a small change needs the true derivative of the forces. Vertices that act on
//! no common force are displaced together [Curtis 1974], so the number of evaluations depends on the densest
//! neighbourhood and not on the size of the cloth.

use faer::linalg::solvers::Solve;
use faer::sparse::linalg::solvers::{Llt, Lu, SymbolicLlt, SymbolicLu};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMat};
use faer::{MatMut, Par, Side};
use nalgebra::Vector3;

use super::pairs::PairList;

/// Symmetric stiffness with three rows and columns per vertex, and its factor.
pub struct Tangent {
    /// Both triangles by columns.
    pattern: SymbolicSparseColMat<usize>,
    values: Vec<f64>,
    factor: Factor,
}

enum Factor {
    /// Cholesky factor of a stable equilibrium.
    Definite(Box<Llt<usize, f64>>),
    Indefinite(Box<Lu<usize, f64>>),
    /// The stiffness is singular.
    None,
}

impl Tangent {
    /// Symmetric part of `-df/dx` at `x`, by central differences with the step `step`, m. Each force must depend only
    /// on its vertex and those paired with it.
    pub fn of(
        pairs: &PairList,
        x: &[Vector3<f64>],
        step: f64,
        forces: impl Fn(&[Vector3<f64>]) -> Vec<Vector3<f64>>,
    ) -> Self {
        faer::set_global_parallelism(Par::Seq);
        let near = neighbours(pairs, x.len());
        let (mut columns, mut rows) = (vec![0], Vec::new());
        for near in &near {
            for _ in 0..3 {
                rows.extend(near.iter().flat_map(|&w| (0..3).map(move |k| 3 * w + k)));
                columns.push(rows.len());
            }
        }
        let mut values = vec![0.0; rows.len()];
        for moved in groups(&near) {
            for axis in 0..3 {
                let forces_at = |by: f64| {
                    let mut there = x.to_vec();
                    moved.iter().for_each(|&v| there[v][axis] += by);
                    forces(&there)
                };
                let (after, before) = (forces_at(step), forces_at(-step));
                for &v in &moved {
                    let start = columns[3 * v + axis];
                    for (slot, &w) in near[v].iter().enumerate() {
                        let falls = (before[w] - after[w]) / (2.0 * step);
                        (0..3).for_each(|k| values[start + 3 * slot + k] = falls[k]);
                    }
                }
            }
        }
        let pattern = SymbolicSparseColMat::new_checked(3 * x.len(), 3 * x.len(), columns, None, rows);
        let mut tangent = Self { pattern, values, factor: Factor::None };
        tangent.make_symmetric(&near);
        tangent.factorise();
        tangent
    }

    fn make_symmetric(&mut self, near: &[Vec<usize>]) {
        let starts = self.pattern.col_ptr();
        for (v, of_v) in near.iter().enumerate() {
            for (slot, &w) in of_v.iter().enumerate().filter(|(_, w)| **w >= v) {
                let Ok(back) = near[w].binary_search(&v) else { continue };
                for r in 0..3 {
                    for c in 0..3 {
                        let (here, mirrored) = (starts[3 * v + c] + 3 * slot + r, starts[3 * w + r] + 3 * back + c);
                        let mean = 0.5 * (self.values[here] + self.values[mirrored]);
                        (self.values[here], self.values[mirrored]) = (mean, mean);
                    }
                }
            }
        }
    }

    fn factorise(&mut self) {
        let matrix = SparseColMatRef::new(self.pattern.as_ref(), &self.values);
        let definite = || {
            let symbolic = SymbolicLlt::try_new(self.pattern.as_ref(), Side::Lower).ok()?;
            Llt::try_new_with_symbolic(symbolic, matrix, Side::Lower).ok()
        };
        let regular = || {
            let symbolic = SymbolicLu::try_new(self.pattern.as_ref()).ok()?;
            Lu::try_new_with_symbolic(symbolic, matrix).ok()
        };
        self.factor = match definite() {
            Some(factor) => Factor::Definite(Box::new(factor)),
            None => regular().map_or(Factor::None, |factor| Factor::Indefinite(Box::new(factor))),
        };
    }

    /// True if the equilibrium is stable.
    pub fn is_definite(&self) -> bool {
        matches!(self.factor, Factor::Definite(_))
    }

    /// Adds a spring (N/m) between every vertex and its present position.
    pub fn tie(&mut self, stiffness: f64) {
        for column in 0..self.pattern.ncols() {
            let range = self.pattern.col_range(column);
            if let Some(own) = range.clone().find(|&k| self.pattern.row_idx()[k] == column) {
                self.values[own] += stiffness;
            }
        }
        self.factorise();
    }

    /// `None` if the stiffness is singular.
    pub fn solve(&self, forces: &[Vector3<f64>]) -> Option<Vec<Vector3<f64>>> {
        let mut flat: Vec<f64> = forces.iter().flat_map(|f| [f.x, f.y, f.z]).collect();
        let rows = flat.len();
        let side = MatMut::from_column_major_slice_mut(&mut flat, rows, 1);
        match &self.factor {
            Factor::Definite(factor) => factor.solve_in_place(side),
            Factor::Indefinite(factor) => factor.solve_in_place(side),
            Factor::None => return None,
        }
        Some(flat.chunks_exact(3).map(|d| Vector3::new(d[0], d[1], d[2])).collect())
    }
}

/// Vertices coupled to each vertex, itself included, ascending.
fn neighbours(pairs: &PairList, count: usize) -> Vec<Vec<usize>> {
    let mut near: Vec<Vec<usize>> = (0..count).map(|v| vec![v]).collect();
    for &[i, j] in pairs.pairs() {
        near[i].push(j);
        near[j].push(i);
    }
    near.iter_mut().for_each(|near| near.sort_unstable());
    near
}

/// Colouring: no two vertices of a group act on the same force.
fn groups(near: &[Vec<usize>]) -> Vec<Vec<usize>> {
    let mut group_of = vec![usize::MAX; near.len()];
    let mut groups: Vec<Vec<usize>> = Vec::new();
    let mut taken_by = Vec::new();
    for v in 0..near.len() {
        for &w in near[v].iter().flat_map(|&w| &near[w]).filter(|w| group_of[**w] != usize::MAX) {
            taken_by[group_of[w]] = v;
        }
        let free = taken_by.iter().position(|by| *by != v);
        let group = free.unwrap_or_else(|| {
            groups.push(Vec::new());
            taken_by.push(usize::MAX);
            groups.len() - 1
        });
        group_of[v] = group;
        groups[group].push(v);
    }
    groups
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Neighbours pull each other by the cube of their distance, and springs pull to the floor.
    fn chain(x: &[Vector3<f64>], floor: f64) -> Vec<Vector3<f64>> {
        let mut forces: Vec<Vector3<f64>> = x.iter().map(|p| p * -floor).collect();
        for i in 1..x.len() {
            let way = x[i] - x[i - 1];
            let pull = way * way.norm_squared();
            forces[i] -= pull;
            forces[i - 1] += pull;
        }
        forces
    }

    fn tangent(x: &[Vector3<f64>], floor: f64) -> Tangent {
        let pairs = PairList::new((1..x.len()).map(|i| [i - 1, i]));
        Tangent::of(&pairs, x, 1e-5, |x| chain(x, floor))
    }

    fn bent(count: usize) -> Vec<Vector3<f64>> {
        (0..count).map(|k| Vector3::new(k as f64, (k as f64).sin(), 0.1 * (k * k) as f64)).collect()
    }

    #[test]
    fn a_solve_gives_the_displacement_that_takes_the_forces_away() {
        let x = bent(40);
        let check = |floor: f64, is_definite: bool| {
            let tangent = tangent(&x, floor);
            assert_eq!(tangent.is_definite(), is_definite, "{floor}");
            let push: Vec<Vector3<f64>> = (0..40).map(|k| Vector3::new(1.0, k as f64, -2.0)).collect();
            let way = tangent.solve(&push).expect("regular");
            let forces_at = |by: f64| chain(&x.iter().zip(&way).map(|(p, d)| p + d * by).collect::<Vec<_>>(), floor);
            let (after, before) = (forces_at(1e-6), forces_at(-1e-6));
            for ((after, before), push) in after.iter().zip(&before).zip(&push) {
                let gives = (before - after) / 2e-6;
                assert!((gives - push).norm() < 1e-3 * push.norm(), "{floor}: {gives} not {push}");
            }
        };
        check(0.5, true);
        check(-0.5, false);
        let mut tied = tangent(&x, -0.5);
        tied.tie(1.0);
        let push = vec![Vector3::new(0.0, 0.0, 1.0); 40];
        let [tied, floored] = [tied, tangent(&x, 0.5)].map(|tangent| tangent.solve(&push).expect("regular"));
        assert!(tied.iter().zip(&floored).all(|(tied, floored)| (tied - floored).norm() < 1e-3 * floored.norm()));
    }

    #[test]
    fn no_force_is_moved_by_two_of_a_group() {
        let near = neighbours(&PairList::new((1..30).flat_map(|i| [[i - 1, i], [i / 2, i]])), 30);
        let groups = groups(&near);
        assert_eq!(groups.iter().map(Vec::len).sum::<usize>(), 30);
        for group in groups {
            let mut moved: Vec<usize> = group.iter().flat_map(|&v| near[v].iter().copied()).collect();
            let all = moved.len();
            moved.sort_unstable();
            moved.dedup();
            assert_eq!(moved.len(), all);
        }
    }
}

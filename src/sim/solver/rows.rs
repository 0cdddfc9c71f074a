//! A stiffness as conjugate gradients multiply with it, hundreds of times a step.
//!
//! Each coupling stands once, in the row of its smaller vertex, and serves both: fewer bytes go through the processor than if it
//! stood in the rows of both, and a large cloth fills the caches with little else. All is applied to differences: in single precision,
//! membrane and bending would otherwise drown each other.

use std::borrow::Cow;
use std::ops::Range;

use super::operator::{Contact4, Operator};
use super::quad::{self, Block, Quad};

/// Couplings by their smaller vertex.
#[derive(Clone, Debug, Default)]
pub struct Upper {
    /// Where those of each vertex begin; one longer than there are vertices that are the smaller of a pair.
    starts: Vec<u32>,
    /// The larger vertex of each.
    others: Vec<u32>,
}

impl Upper {
    /// No couplings.
    pub const EMPTY: Self = Self { starts: Vec::new(), others: Vec::new() };

    /// Of distinct pairs, the smaller vertex first, sorted.
    #[must_use]
    pub fn new(pairs: &[[usize; 2]]) -> Self {
        let count = pairs.last().map_or(0, |pair| pair[0] + 1);
        let starts = (0..=count).map(|v| pairs.partition_point(|pair| pair[0] < v) as u32).collect();
        Self { starts, others: pairs.iter().map(|pair| pair[1] as u32).collect() }
    }

    /// Number of the coupling of `v` with the larger `other`.
    #[must_use]
    pub fn slot(&self, v: usize, other: usize) -> Option<usize> {
        let row = self.row(v);
        let at = self.others[row.clone()].binary_search(&(other as u32)).ok()?;
        Some(row.start + at)
    }

    /// Numbers of the couplings of `v`.
    #[inline(always)]
    fn row(&self, v: usize) -> Range<usize> {
        match self.starts.get(v..v + 2) {
            Some(&[from, to]) => from as usize..to as usize,
            _ => 0..0,
        }
    }

    /// The larger vertices of the couplings of `v`, each with what is kept of it.
    #[inline(always)]
    pub fn of<'a, T>(&'a self, v: usize, kept: &'a [T]) -> impl Iterator<Item = (usize, &'a T)> {
        let row = self.row(v);
        self.others[row.clone()].iter().map(|other| *other as usize).zip(&kept[row])
    }
}

/// An [`Operator`] in rows.
pub struct Rows<'a, Q: Quad> {
    diagonal: Vec<Block<Q>>,
    membrane: &'a Upper,
    blocks: Cow<'a, [Block<Q>]>,
    bending: &'a Upper,
    entries: Vec<Q::Scalar>,
    springs: Vec<([usize; 2], Q)>,
    contacts: Vec<Contact<Q>>,
}

/// A [`Contact4`] with its stiffness worked into its direction.
struct Contact<Q> {
    vertices: [usize; 4],
    weights: [Q; 4],
    along: Q,
}

impl<'a, Q: Quad> Rows<'a, Q> {
    /// Writes an operator into rows.
    #[must_use]
    pub fn new(operator: &'a Operator) -> Self {
        let contact = |c: &Contact4| Contact {
            vertices: c.vertices,
            weights: c.weights.map(Q::spread),
            along: Q::from_vector(&(c.normal * c.stiffness.sqrt())),
        };
        Self {
            diagonal: operator.diagonal.iter().map(quad::block).collect(),
            membrane: operator.membrane_pairs.upper(),
            blocks: Q::blocks(&operator.membrane),
            bending: operator.bending_pairs.upper(),
            entries: operator.bending.iter().map(|q| Q::scalar(*q)).collect(),
            springs: operator.springs.iter().map(|(pair, k)| (*pair, Q::spread(*k))).collect(),
            contacts: operator.contacts.iter().map(contact).collect(),
        }
    }

    /// `y = K x`.
    pub fn apply(&self, x: &[Q], y: &mut [Q]) {
        y.fill(Q::ZERO);
        for (i, diagonal) in self.diagonal.iter().enumerate() {
            let here = x[i];
            let mut rows = diagonal.map(|row| row * here);
            let mut force = y[i];
            for (j, block) in self.membrane.of(i, &self.blocks) {
                let difference = x[j] - here;
                for (row, entries) in rows.iter_mut().zip(block) {
                    *row += *entries * difference;
                }
                y[j] -= quad::transposed_times(block, difference);
            }
            for (j, entry) in self.bending.of(i, &self.entries) {
                let pull = (x[j] - here) * Q::splat(*entry);
                force += pull;
                y[j] -= pull;
            }
            y[i] = force + Q::totals(rows);
        }
        for (pair, stiffness) in &self.springs {
            let pull = (x[pair[0]] - x[pair[1]]) * *stiffness;
            y[pair[0]] += pull;
            y[pair[1]] -= pull;
        }
        for contact in &self.contacts {
            contact.apply(x, y);
        }
    }
}

impl<Q: Quad> Contact<Q> {
    fn apply(&self, x: &[Q], y: &mut [Q]) {
        let mut moved = Q::ZERO;
        for (v, weight) in self.vertices.iter().zip(&self.weights) {
            moved += x[*v] * *weight;
        }
        let force = self.along * Q::spread((moved * self.along).total());
        for (v, weight) in self.vertices.iter().zip(&self.weights) {
            y[*v] += force * *weight;
        }
    }
}

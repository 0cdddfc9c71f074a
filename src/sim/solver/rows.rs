//! A stiffness by rows: what conjugate gradients multiply with, hundreds of times a step.
//!
//! [`Operator`] keeps each coupling once; here each stands in the rows of both its vertices, so that a row is one run through
//! memory that ends in one store. Three components are padded to four, which fills a vector register. Still all is applied to
//! differences: in single precision, membrane and bending would otherwise drown each other.

use nalgebra::{Matrix3, RealField};

use super::operator::{Contact4, Operator, PairList};
use crate::geom::V3;

/// Three components and a zero.
pub type Quad<T> = [T; 4];

/// A 3x3 block by columns.
pub type Block<T> = [Quad<T>; 3];

/// `a + block v`, each product by a column.
#[inline(always)]
pub fn add_times<T: RealField + Copy>(mut a: Quad<T>, block: &Block<T>, v: &Quad<T>) -> Quad<T> {
    for c in 0..3 {
        for k in 0..4 {
            a[k] += block[c][k] * v[c];
        }
    }
    a
}

/// A block in the precision of the solve.
#[must_use]
pub fn block<T: RealField + Copy>(m: &Matrix3<f64>) -> Block<T> {
    [0, 1, 2].map(|c| quad(&m.column(c).into_owned()))
}

/// A vector in the precision of the solve.
#[must_use]
pub fn quad<T: RealField + Copy>(v: &V3) -> Quad<T> {
    [nalgebra::convert(v.x), nalgebra::convert(v.y), nalgebra::convert(v.z), T::zero()]
}

/// Where the pairs of a [`PairList`] stand when each is written into the rows of both its vertices.
#[derive(Clone, Debug, Default)]
pub struct RowTable {
    /// Where each row begins; one longer than there are vertices in pairs.
    starts: Vec<u32>,
    /// The other vertex of each entry.
    columns: Vec<u32>,
    /// Entries of each pair: in the row of its smaller vertex and in that of the larger.
    entries: Vec<[u32; 2]>,
}

impl RowTable {
    /// Of distinct pairs.
    #[must_use]
    pub fn new(pairs: &[[usize; 2]]) -> Self {
        let count = pairs.iter().map(|p| p[0].max(p[1]) + 1).max().unwrap_or(0);
        let mut starts = vec![0_u32; count + 1];
        for v in pairs.iter().flatten() {
            starts[v + 1] += 1;
        }
        for v in 0..count {
            starts[v + 1] += starts[v];
        }
        let mut next = starts.clone();
        let mut columns = vec![0; 2 * pairs.len()];
        let mut take = |v: usize, other: usize| {
            let at = next[v];
            next[v] += 1;
            columns[at as usize] = other as u32;
            at
        };
        // Pairs come sorted, so that each row's entries do.
        let entries = pairs.iter().map(|&[i, j]| [take(i, j), take(j, i)]).collect();
        Self { starts, columns, entries }
    }

    fn row(&self, v: usize) -> std::ops::Range<usize> {
        match self.starts.get(v..v + 2) {
            Some(&[from, to]) => from as usize..to as usize,
            _ => 0..0,
        }
    }
}

/// An [`Operator`] in rows.
pub struct Rows<'a, T> {
    diagonal: Vec<Block<T>>,
    membrane: &'a RowTable,
    blocks: Vec<Block<T>>,
    bending: &'a RowTable,
    entries: Vec<T>,
    springs: Vec<([usize; 2], T)>,
    contacts: Vec<Contact<T>>,
}

/// A [`Contact4`] with its stiffness worked into its direction.
struct Contact<T> {
    vertices: [usize; 4],
    weights: [T; 4],
    along: Quad<T>,
}

impl<'a, T: RealField + Copy> Rows<'a, T> {
    /// Writes an operator into rows.
    #[must_use]
    pub fn new(operator: &Operator<'a>) -> Self {
        let [membrane, bending] = [operator.membrane_pairs, operator.bending_pairs].map(PairList::rows);
        let mut blocks = vec![[[T::zero(); 4]; 3]; membrane.columns.len()];
        for (entry, m) in membrane.entries.iter().zip(&operator.membrane) {
            blocks[entry[0] as usize] = block(m);
            blocks[entry[1] as usize] = block(&m.transpose());
        }
        let mut entries = vec![T::zero(); bending.columns.len()];
        for (entry, q) in bending.entries.iter().zip(operator.bending) {
            for at in entry {
                entries[*at as usize] = nalgebra::convert(*q);
            }
        }
        let contact = |c: &Contact4| Contact {
            vertices: c.vertices,
            weights: c.weights.map(nalgebra::convert),
            along: quad(&(c.normal * c.stiffness.sqrt())),
        };
        Self {
            diagonal: operator.diagonal.iter().map(block).collect(),
            membrane,
            blocks,
            bending,
            entries,
            springs: operator.springs.iter().map(|(pair, k)| (*pair, nalgebra::convert(*k))).collect(),
            contacts: operator.contacts.iter().map(contact).collect(),
        }
    }

    /// `y = K x`.
    pub fn apply(&self, x: &[Quad<T>], y: &mut [Quad<T>]) {
        for (i, y) in y.iter_mut().enumerate() {
            let here = x[i];
            let mut sum = add_times([T::zero(); 4], &self.diagonal[i], &here);
            let row = self.membrane.row(i);
            for (column, block) in self.membrane.columns[row.clone()].iter().zip(&self.blocks[row]) {
                sum = add_times(sum, block, &minus(&x[*column as usize], &here));
            }
            let row = self.bending.row(i);
            for (column, entry) in self.bending.columns[row.clone()].iter().zip(&self.entries[row]) {
                let difference = minus(&x[*column as usize], &here);
                for k in 0..4 {
                    sum[k] += *entry * difference[k];
                }
            }
            *y = sum;
        }
        for (pair, stiffness) in &self.springs {
            let pull = minus(&x[pair[0]], &x[pair[1]]);
            for k in 0..3 {
                y[pair[0]][k] += pull[k] * *stiffness;
                y[pair[1]][k] -= pull[k] * *stiffness;
            }
        }
        for contact in &self.contacts {
            contact.apply(x, y);
        }
    }
}

impl<T: RealField + Copy> Contact<T> {
    fn apply(&self, x: &[Quad<T>], y: &mut [Quad<T>]) {
        let mut along = T::zero();
        for (v, weight) in self.vertices.iter().zip(&self.weights) {
            let x = &x[*v];
            along += *weight * (self.along[0] * x[0] + self.along[1] * x[1] + self.along[2] * x[2]);
        }
        for (v, weight) in self.vertices.iter().zip(&self.weights) {
            for k in 0..3 {
                y[*v][k] += self.along[k] * (along * *weight);
            }
        }
    }
}

#[inline(always)]
fn minus<T: RealField + Copy>(a: &Quad<T>, b: &Quad<T>) -> Quad<T> {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2], a[3] - b[3]]
}

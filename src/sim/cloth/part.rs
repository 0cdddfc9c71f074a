//! A part of a cloth as a system of its own: vertices that may move, and those around them that hold them.

use super::Cloth;
use super::bending::{Bending, Tangent};
use super::element::Element;
use super::membrane::Membrane;
use linalg::PairList;

/// Vertices of a part, in the order of the cloth.
pub struct Part {
    /// Indices in the cloth, ascending.
    pub vertices: Vec<usize>,
    pub is_free: Vec<bool>,
    names: Vec<Option<usize>>,
    triangles: Vec<usize>,
}

impl Part {
    /// Selects the vertices that are `free`, all that membrane or bending couple to them, and `others`.
    pub fn new(cloth: &Cloth, free: &[bool], others: &[usize]) -> Self {
        let mut is_in = free.to_vec();
        for &[i, j] in cloth.membrane.pairs.pairs().iter().chain(cloth.bending.pairs.pairs()) {
            is_in[i] |= free[j];
            is_in[j] |= free[i];
        }
        others.iter().for_each(|&v| is_in[v] = true);
        let Membrane { arcs, pairs, sides, .. } = &cloth.membrane;
        let changes = |side: usize| arcs.most.get(side).is_some_and(|_| arcs.of(side).any(|(v, _)| free[v]));
        let bends: Vec<bool> = (0..pairs.pairs().len()).map(changes).collect();
        let changes = |t: &usize| {
            cloth.triangles[*t].iter().any(|&v| free[v]) || sides[*t].iter().any(|&side| bends[side as usize])
        };
        let triangles: Vec<usize> = (0..cloth.triangles.len()).filter(changes).collect();
        for &t in &triangles {
            cloth.triangles[t].iter().for_each(|&v| is_in[v] = true);
            for &side in sides[t].iter().filter(|_| !arcs.most.is_empty()) {
                arcs.of(side as usize).for_each(|(v, _)| is_in[v] = true);
            }
        }
        let vertices: Vec<usize> = (0..free.len()).filter(|&v| is_in[v]).collect();
        let mut names = vec![None; free.len()];
        vertices.iter().enumerate().for_each(|(name, &v)| names[v] = Some(name));
        Self { is_free: vertices.iter().map(|&v| free[v]).collect(), vertices, names, triangles }
    }

    /// Indices in the part; `None` unless all vertices are in it and at least one may move.
    pub fn names<const N: usize>(&self, vertices: [usize; N]) -> Option<[usize; N]> {
        let names = vertices.map(|v| self.names[v]);
        let is_free = names.iter().flatten().any(|&name| self.is_free[name]);
        (is_free && names.iter().all(Option::is_some)).then(|| names.map(Option::unwrap_or_default))
    }

    pub fn of<T: Copy>(&self, values: &[T]) -> Vec<T> {
        self.vertices.iter().map(|&v| values[v]).collect()
    }
}

impl Cloth {
    pub fn part(&self, part: &Part) -> (Self, Vec<usize>) {
        let name = |v: usize| part.names[v].unwrap_or_default();
        let renamed = |t: &usize| {
            let element = &self.membrane.elements[*t];
            element.renamed(element.vertices().map(name))
        };
        let membrane = Membrane::new(self.membrane.laws().to_vec(), part.triangles.iter().map(renamed).collect());
        let arcs = self.membrane.arcs.part(&self.membrane.pairs, &membrane.pairs, &part.vertices, name);
        let membrane = membrane.with_arcs(arcs);
        let numbers = part.triangles.clone();
        let cloth = Self {
            vertex_of: (0..part.vertices.len()).collect(),
            triangles: membrane.elements.iter().map(Element::vertices).collect(),
            masses: part.of(&self.masses),
            areas: part.of(&self.areas),
            frictions: part.of(&self.frictions),
            bending: self.bending.part(part, [&self.membrane.pairs, &membrane.pairs]),
            membrane,
            bands: self.bands.part(part),
        };
        (cloth, numbers)
    }
}

impl Bending {
    /// Pairs with a vertex that may move. `sides` are the triangle sides of the cloth, then those of the part.
    pub fn part(&self, part: &Part, sides: [&PairList; 2]) -> Self {
        let (pairs, entries) = renamed(part, &self.pairs, &self.entries);
        Self { pairs, entries, tangent: self.tangent.part(part, sides) }
    }
}

impl Tangent {
    fn part(&self, part: &Part, sides: [&PairList; 2]) -> Self {
        let mut along = vec![0.0; sides[1].pairs().len()];
        for (&pair, entry) in sides[0].pairs().iter().zip(&self.along) {
            if let Some(slot) = part.names(pair).and_then(|[i, j]| sides[1].slot(i, j)) {
                along[slot] = *entry;
            }
        }
        let (pairs, across) = renamed(part, &self.pairs, &self.across);
        Self { along, pairs, across }
    }
}

/// Pairs with a vertex that may move, by indices of the part, with their entries. Their order stays, since that of the
/// vertices does.
fn renamed(part: &Part, pairs: &PairList, entries: &[f64]) -> (PairList, Vec<f64>) {
    let renamed = |(pair, entry): (&[usize; 2], &f64)| Some((part.names(*pair)?, *entry));
    let (pairs, entries): (Vec<[usize; 2]>, _) = pairs.pairs().iter().zip(entries).filter_map(renamed).unzip();
    (PairList::new(pairs), entries)
}

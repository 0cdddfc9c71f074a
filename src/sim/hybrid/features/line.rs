//! Lines of garment vertices: stretches of outline joined and divided.

use super::OnTube;
use crate::hybrid::outline::Chain;
use pattern::Garment;

pub(super) fn between([from, to]: [OnTube; 2]) -> impl Fn(f64) -> OnTube {
    move |share| OnTube {
        line: from.line + (to.line - from.line) * share,
        along: from.along + (to.along - from.along) * share,
    }
}

pub(super) fn run(from: usize, to: usize, chains: &[Chain]) -> impl Iterator<Item = &Chain> {
    let n = chains.len();
    (1..n).map(move |k| (from + k) % n).take_while(move |&i| i != to).map(|i| &chains[i])
}

pub(super) struct Group {
    pub before: usize,
    pub inner: Vec<usize>,
    pub after: usize,
}

pub(super) fn groups<K>(keys: &[Option<K>], start: usize) -> Vec<Group> {
    let n = keys.len();
    let mut found = Vec::new();
    let mut before = start;
    let mut inner = Vec::new();
    for k in 1..=n {
        let i = (start + k) % n;
        if keys[i].is_some() {
            found.push(Group { before, inner: std::mem::take(&mut inner), after: i });
            before = i;
        } else {
            inner.push(i);
        }
    }
    found
}

pub(super) fn joined<'c>(chains: impl Iterator<Item = &'c Chain>) -> Vec<usize> {
    let mut vertices: Vec<usize> = Vec::new();
    for chain in chains {
        let skip = usize::from(!vertices.is_empty());
        vertices.extend(&chain.vertices[skip..]);
    }
    vertices
}

pub(super) fn nth(garment: &Garment, vertices: &[usize], arc_m: f64) -> usize {
    let mut length_m = 0.0;
    let mut best = (f64::MAX, vertices[0]);
    for (k, &v) in vertices.iter().enumerate() {
        if k > 0 {
            length_m += (garment.rest[v] - garment.rest[vertices[k - 1]]).norm();
        }
        if (length_m - arc_m).abs() < best.0 {
            best = ((length_m - arc_m).abs(), v);
        }
    }
    best.1
}

//! Lines of garment vertices: stretches of outline put together and divided.

use super::OnTube;
use crate::hybrid::outline::Chain;
use pattern::Garment;

/// A line round a tube from one point of it to another.
pub(super) fn between([from, to]: [OnTube; 2]) -> impl Fn(f64) -> OnTube {
    move |share| OnTube {
        line: from.line + (to.line - from.line) * share,
        along: from.along + (to.along - from.along) * share,
    }
}

/// The chains that follow one and precede another.
pub(super) fn run(from: usize, to: usize, chains: &[Chain]) -> impl Iterator<Item = &Chain> {
    let n = chains.len();
    (1..n).map(move |k| (from + k) % n).take_while(move |&i| i != to).map(|i| &chains[i])
}

/// Groups of chains between key chains, counter-clockwise: key before, those between, key after.
pub(super) fn groups<K>(keys: &[Option<K>], start: usize) -> Vec<(usize, Vec<usize>, usize)> {
    let n = keys.len();
    let mut found = Vec::new();
    let mut before = start;
    let mut inner = Vec::new();
    for k in 1..=n {
        let i = (start + k) % n;
        if keys[i].is_some() {
            found.push((before, std::mem::take(&mut inner), i));
            before = i;
        } else {
            inner.push(i);
        }
    }
    found
}

/// Vertices of consecutive chains as one line.
pub(super) fn joined<'c>(chains: impl Iterator<Item = &'c Chain>) -> Vec<usize> {
    let mut vertices: Vec<usize> = Vec::new();
    for chain in chains {
        let skip = usize::from(!vertices.is_empty());
        vertices.extend(&chain.vertices[skip..]);
    }
    vertices
}

/// The vertex of a line that is nearest to arc length `arc_m`.
pub(super) fn nth(garment: &Garment, vertices: &[usize], arc_m: f64) -> usize {
    let mut at = 0.0;
    let mut best = (f64::MAX, vertices[0]);
    for (k, &v) in vertices.iter().enumerate() {
        if k > 0 {
            at += (garment.rest[v] - garment.rest[vertices[k - 1]]).norm();
        }
        if (at - arc_m).abs() < best.0 {
            best = ((at - arc_m).abs(), v);
        }
    }
    best.1
}

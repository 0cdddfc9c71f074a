//! Topology of the sewn surface: a garment that is worn hangs together, has no handle, and no hole that nothing fits
//! through.

use super::stretch::Stretch;

/// Length below which an opening is none that a garment has.
const PINHOLE_M: f64 = 90e-3;

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Surface {
    pub components: usize,
    /// Of all components.
    pub handles: usize,
    pub openings: usize,
    pub pinholes: usize,
}

impl Surface {
    /// Of parts that are sewn along whole stretches, run in opposite directions. Parts in no seam do not count.
    pub fn of(stretches: &[Stretch], seams: impl Iterator<Item = (usize, usize)>) -> Self {
        let seams: Vec<(usize, usize)> = seams.collect();
        let parts = stretches.last().map_or(0, |last| last.part + 1);
        let mut partner = vec![None; stretches.len()];
        for &(a, b) in &seams {
            (partner[a], partner[b]) = (Some(b), Some(a));
        }
        let mut is_sewn = vec![false; parts];
        (0..stretches.len()).filter(|&k| partner[k].is_some()).for_each(|k| is_sewn[stretches[k].part] = true);
        // A vertex is the first of the stretches that begin there.
        let (mut vertices, mut components) = (Classes::of(stretches.len()), Classes::of(parts));
        for &(a, b) in &seams {
            vertices.join(a, stretches[b].next);
            vertices.join(b, stretches[a].next);
            components.join(stretches[a].part, stretches[b].part);
        }
        let of_sewn = |k: &usize| is_sewn[stretches[*k].part];
        let count = |all: usize, is_it: &dyn Fn(&usize) -> bool| (0..all).filter(is_it).count();
        let vertices = count(stretches.len(), &|k| of_sewn(k) && vertices.is_first(*k));
        let edges = count(stretches.len(), &of_sewn) - seams.len();
        let faces = count(parts, &|part| is_sewn[*part]);
        let components = count(parts, &|part| is_sewn[*part] && components.is_first(*part));
        let lengths = openings(stretches, &partner, of_sewn);
        let (openings, pinholes) = (lengths.len(), lengths.iter().filter(|length| **length < PINHOLE_M).count());
        // V - E + F = 2 C - 2 H - B.
        let handles = (2 * components + edges).saturating_sub(openings + vertices + faces) / 2;
        Self { components, handles, openings, pinholes }
    }
}

/// Lengths of the boundary loops.
fn openings(stretches: &[Stretch], partner: &[Option<usize>], is_sewn: impl Fn(&usize) -> bool) -> Vec<f64> {
    let mut is_seen = vec![false; stretches.len()];
    let mut lengths = Vec::new();
    for start in (0..stretches.len()).filter(|k| is_sewn(k) && partner[*k].is_none()) {
        let (mut at, mut length) = (start, 0.0);
        while !is_seen[at] {
            is_seen[at] = true;
            length += stretches[at].length;
            at = stretches[at].next;
            while let Some(other) = partner[at] {
                at = stretches[other].next;
            }
        }
        if length > 0.0 {
            lengths.push(length);
        }
    }
    lengths
}

/// Disjoint sets, each known by its least member.
struct Classes(Vec<usize>);

impl Classes {
    fn of(count: usize) -> Self {
        Self((0..count).collect())
    }

    fn first(&self, mut k: usize) -> usize {
        while self.0[k] != k {
            k = self.0[k];
        }
        k
    }

    fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.first(a), self.first(b));
        self.0[a.max(b)] = a.min(b);
    }

    fn is_first(&self, k: usize) -> bool {
        self.0[k] == k
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recogniser::Part;
    use crate::recogniser::stretch::stretches;
    use crate::trade::Named;
    use geom::V2;

    fn rectangle() -> Part {
        let outline = [[0.0, 0.0], [0.4, 0.0], [0.4, 0.6], [0.0, 0.6]].map(V2::from).to_vec();
        Part { outline, corners: vec![0, 1, 2, 3], notches: Vec::new(), said: Named::default() }
    }

    #[test]
    fn handles_and_openings_follow_from_the_seams() {
        // Four stretches a part: lower, right, upper, left.
        let check = |parts: usize, seams: &[(usize, usize)], expect: Surface| {
            let stretches = stretches(&vec![rectangle(); parts]);
            assert_eq!(Surface::of(&stretches, seams.iter().copied()), expect, "{seams:?}");
        };
        let surface = |components, handles, openings| Surface { components, handles, openings, pinholes: 0 };
        check(2, &[], surface(0, 0, 0));
        check(1, &[(1, 3)], surface(1, 0, 2));
        check(2, &[(1, 7), (3, 5)], surface(1, 0, 2));
        // A torus, and a tube with a cap that closes it half.
        check(1, &[(1, 3), (0, 2)], surface(1, 1, 0));
        check(2, &[(1, 3), (2, 4)], surface(1, 0, 2));
        // Two tubes beside each other, joined at their upper edges all round.
        check(2, &[(1, 3), (5, 7), (2, 6)], surface(1, 0, 2));
        check(3, &[(1, 3), (5, 7)], surface(2, 0, 4));
    }
}

//! Statements that the network hears: answers of a person, and what was found before.

use std::collections::{BTreeMap, BTreeSet};

/// Statement about a stretch that is heard, and not weighed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fact {
    Sewn(usize),
    Free,
}

/// Statements about stretches.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Facts {
    of: BTreeMap<usize, Fact>,
    /// Pairs, the lower index first, that are not sewn to each other.
    apart: BTreeSet<[usize; 2]>,
}

impl Facts {
    pub fn of(&self, stretch: usize) -> Option<Fact> {
        self.of.get(&stretch).copied()
    }

    pub fn sew(&mut self, a: usize, b: usize) {
        self.of.extend([(a, Fact::Sewn(b)), (b, Fact::Sewn(a))]);
    }

    pub fn free(&mut self, stretch: usize) {
        self.of.insert(stretch, Fact::Free);
    }

    pub fn part(&mut self, a: usize, b: usize) {
        self.apart.insert([a.min(b), a.max(b)]);
    }

    pub fn may_be_sewn(&self, a: usize, b: usize) -> bool {
        a != b && self.of(a).is_none() && self.of(b).is_none() && !self.apart.contains(&[a.min(b), a.max(b)])
    }

    /// Row of likelihoods of a stretch with a statement.
    pub fn row(&self, stretch: usize, count: usize) -> Option<Vec<f32>> {
        let mut row = vec![0.0; count + 1];
        row[match self.of(stretch)? {
            Fact::Sewn(other) => other,
            Fact::Free => count,
        }] = 1.0;
        Some(row)
    }
}

//! Statements that the network hears: answers of a person, and what was found before.

use std::collections::BTreeMap;

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
}

impl Facts {
    pub fn of(&self, stretch: usize) -> Option<Fact> {
        self.of.get(&stretch).copied()
    }

    /// Replaces what was stated of either.
    pub fn sew(&mut self, a: usize, b: usize) {
        [a, b].into_iter().for_each(|k| self.forget(k));
        self.of.extend([(a, Fact::Sewn(b)), (b, Fact::Sewn(a))]);
    }

    /// Replaces what was stated of it.
    pub fn free(&mut self, stretch: usize) {
        self.forget(stretch);
        self.of.insert(stretch, Fact::Free);
    }

    fn forget(&mut self, stretch: usize) {
        if let Some(Fact::Sewn(other)) = self.of.remove(&stretch) {
            self.of.remove(&other);
        }
    }

    pub fn may_be_sewn(&self, a: usize, b: usize) -> bool {
        a != b && self.of(a).is_none() && self.of(b).is_none()
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

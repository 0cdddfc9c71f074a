//! Marks on rows of a list, on all of which an action acts.

use std::collections::BTreeSet;

/// Marked rows, by what identifies them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Marks<T: Ord> {
    marked: BTreeSet<T>,
    /// Row that was marked last, where a range begins.
    last: Option<T>,
}

impl<T: Ord> Default for Marks<T> {
    fn default() -> Self {
        Self { marked: BTreeSet::new(), last: None }
    }
}

impl<T: Ord + Clone> Marks<T> {
    pub fn is_empty(&self) -> bool {
        self.marked.is_empty()
    }

    pub fn len(&self) -> usize {
        self.marked.len()
    }

    pub fn has(&self, row: &T) -> bool {
        self.marked.contains(row)
    }

    pub fn iter(&self) -> impl Iterator<Item = &T> {
        self.marked.iter()
    }

    pub fn toggle(&mut self, row: T) {
        if !self.marked.remove(&row) {
            self.marked.insert(row.clone());
        }
        self.last = Some(row);
    }

    /// Marks the shown rows between the one that was marked last and the selected one, both included.
    pub fn extend_to(&mut self, shown: &[T], selected: T) {
        let place = |row: &T| shown.iter().position(|other| other == row);
        let to = place(&selected);
        let from = self.last.as_ref().and_then(place).or(to);
        if let Some((from, to)) = from.zip(to) {
            self.marked.extend(shown[from.min(to)..=from.max(to)].iter().cloned());
        }
        self.last = Some(selected);
    }

    /// Marks all shown rows; where all are marked, takes their marks away.
    pub fn toggle_all(&mut self, shown: &[T]) {
        if shown.iter().all(|row| self.marked.contains(row)) {
            self.marked.retain(|row| !shown.contains(row));
        } else {
            self.marked.extend(shown.iter().cloned());
        }
    }

    pub fn clear(&mut self) {
        (self.marked, self.last) = (BTreeSet::new(), None);
    }

    /// The marked rows among those that are shown, and the number of the others, which no action touches.
    pub fn seen(&self, shown: &[T]) -> (Vec<T>, usize) {
        let shown: BTreeSet<&T> = shown.iter().collect();
        let seen: Vec<T> = self.marked.iter().filter(|row| shown.contains(row)).cloned().collect();
        let hidden = self.marked.len() - seen.len();
        (seen, hidden)
    }

    pub fn keep(&mut self, is_there: impl Fn(&T) -> bool) {
        self.marked.retain(is_there);
    }
}

impl<T: Ord + Clone> FromIterator<T> for Marks<T> {
    fn from_iter<I: IntoIterator<Item = T>>(rows: I) -> Self {
        Self { marked: rows.into_iter().collect(), last: None }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_marked_one_by_one_by_ranges_and_together() {
        let shown = [5, 3, 9, 1, 7];
        let check = |act: &dyn Fn(&mut Marks<i32>), expect: &[i32]| {
            let mut marks = Marks::default();
            act(&mut marks);
            assert_eq!(marks.iter().copied().collect::<Vec<_>>(), expect);
        };
        check(&|marks| marks.toggle(3), &[3]);
        check(&|marks| (0..2).for_each(|_| marks.toggle(3)), &[]);
        check(&|marks| marks.extend_to(&shown, 9), &[9]);
        check(
            &|marks| {
                marks.toggle(1);
                marks.extend_to(&shown, 3);
            },
            &[1, 3, 9],
        );
        check(&|marks| marks.toggle_all(&shown), &[1, 3, 5, 7, 9]);
        check(
            &|marks| {
                marks.toggle_all(&shown);
                marks.toggle_all(&shown[1..3]);
            },
            &[1, 5, 7],
        );
        check(
            &|marks| {
                marks.toggle_all(&shown);
                marks.keep(|row| *row > 4);
            },
            &[5, 7, 9],
        );
    }
}

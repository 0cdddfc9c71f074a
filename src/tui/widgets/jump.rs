//! Labels of places on the screen, and the goals of jumps to them.

use ratatui::layout::{Margin, Position, Rect};

use crate::widgets::lists::first_shown;

/// Letters of labels, those under the fingers first.
const LETTERS: &[u8; 26] = b"asdfghjklqwertyuiopzxcvbnm";

/// Goal of a jump.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Goal {
    /// To a pane of the screen, the first is 0.
    Pane(usize),
    /// To a pane, and in it so many rows down.
    Row(usize, isize),
    /// To something that the screen counts itself: a cell of the grid, an edge of a piece.
    Item(usize),
}

/// A place on the screen and where a jump to it leads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Target {
    /// Cell in which its letters stand.
    pub at: Position,
    /// Its goal.
    pub goal: Goal,
}

/// The inside of a pane with a border.
pub fn inside(area: Rect) -> Rect {
    area.inner(Margin::new(1, 1))
}

/// The target of a pane, in its border.
pub fn pane(area: Rect, pane: usize) -> Target {
    Target { at: Position::new(area.x + 1, area.y), goal: Goal::Pane(pane) }
}

/// The rows of a list that are shown of so many around the selected one, below so many lines of a header.
pub fn rows(pane: usize, area: Rect, head: usize, rows: usize, selected: usize) -> Vec<Target> {
    let height = usize::from(area.height).saturating_sub(head);
    let first = first_shown(selected, rows, height);
    let target = |k: usize| Target {
        at: Position::new(area.x, area.y + (head + k - first) as u16),
        goal: Goal::Row(pane, k as isize - selected as isize),
    };
    (first..rows).take(height).map(target).collect()
}

/// The label of a target of so many: one letter, or two where there are more targets than letters.
pub fn label(k: usize, targets: usize) -> String {
    let letter = |k: usize| char::from(LETTERS[k % LETTERS.len()]);
    if targets <= LETTERS.len() {
        letter(k).to_string()
    } else {
        [letter(k / LETTERS.len()), letter(k)].iter().collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_are_short_and_each_is_one() {
        for targets in [1, 26, 27, 600] {
            let mut labels: Vec<String> = (0..targets).map(|k| label(k, targets)).collect();
            assert!(labels.iter().all(|label| label.len() == if targets > 26 { 2 } else { 1 }));
            labels.sort();
            labels.dedup();
            assert_eq!(labels.len(), targets);
        }
    }

    #[test]
    fn rows_are_those_shown() {
        let found = rows(1, Rect::new(3, 5, 10, 4), 1, 9, 4);
        let expect =
            [(6, -1), (7, 0), (8, 1)].map(|(y, step)| Target { at: Position::new(3, y), goal: Goal::Row(1, step) });
        assert_eq!(found, expect);
        assert_eq!(rows(0, Rect::new(0, 0, 10, 1), 1, 9, 0), []);
    }
}

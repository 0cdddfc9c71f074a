//! Labels of places on the screen, and goals of jumps to them.

use ratatui::layout::{Margin, Position, Rect, Size};

use crate::widgets::lists::first_shown;

/// Letters for labels, the easiest to type first.
const LETTERS: &[u8; 26] = b"asdfghjklqwertyuiopzxcvbnm";

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Goal {
    /// Pane, from 0.
    Pane(usize),
    /// A pane, then a number of rows down.
    Row(usize, isize),
    /// An item by the screen's own numbering: a cell of the grid, an edge of a piece.
    Item(usize),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Target {
    /// Cell at which its label begins.
    pub at: Position,
    /// Columns and rows from there on that a click can hit.
    pub size: Size,
    pub goal: Goal,
}

/// Area within a pane's border.
pub fn inside(area: Rect) -> Rect {
    area.inner(Margin::new(1, 1))
}

/// Target of a pane, on its border.
pub fn pane(area: Rect, pane: usize) -> Target {
    let size = Size::new(area.width.saturating_sub(1), area.height);
    Target { at: Position::new(area.x + 1, area.y), size, goal: Goal::Pane(pane) }
}

/// Targets of the shown rows of a list: `rows` in all, shown around the selected one, below a header of `head` lines.
pub fn rows(pane: usize, area: Rect, head: usize, rows: usize, selected: usize) -> Vec<Target> {
    let height = usize::from(area.height).saturating_sub(head);
    let first = first_shown(selected, rows, height);
    let target = |k: usize| Target {
        at: Position::new(area.x, area.y + (head + k - first) as u16),
        size: Size::new(area.width, 1),
        goal: Goal::Row(pane, k as isize - selected as isize),
    };
    (first..rows).take(height).map(target).collect()
}

/// Goal of a click: that of the smallest target at a place.
pub fn hit(targets: &[Target], at: Position) -> Option<Goal> {
    let is_hit = |target: &&Target| Rect::from((target.at, target.size)).contains(at);
    let area = |target: &&Target| u32::from(target.size.width) * u32::from(target.size.height);
    targets.iter().filter(is_hit).min_by_key(area).map(|target| target.goal)
}

/// Label of target `k`: one letter, or two if there are more targets than letters.
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
        let expect = [(6, -1), (7, 0), (8, 1)].map(|(y, step)| Target {
            at: Position::new(3, y),
            size: Size::new(10, 1),
            goal: Goal::Row(1, step),
        });
        assert_eq!(found, expect);
        assert_eq!(rows(0, Rect::new(0, 0, 10, 1), 1, 9, 0), []);
    }

    #[test]
    fn a_click_hits_a_row_before_its_pane() {
        let area = Rect::new(3, 5, 10, 4);
        let targets = [vec![pane(area, 1)], rows(1, inside(area), 0, 9, 4)].concat();
        let check = |x, y, expect| assert_eq!(hit(&targets, Position::new(x, y)), expect, "{x} {y}");
        check(4, 6, Some(Goal::Row(1, -1)));
        check(11, 7, Some(Goal::Row(1, 0)));
        check(6, 5, Some(Goal::Pane(1)));
        check(2, 6, None);
        check(6, 9, None);
    }
}

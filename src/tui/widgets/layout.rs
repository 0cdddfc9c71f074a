//! Division of the screen into areas.

use ratatui::layout::{Constraint, Layout, Rect};

/// Least columns and rows for grids and panes; smaller terminals get lists.
const NARROW: (u16, u16) = (60, 16);
/// Least columns for panes side by side.
pub const WIDE: u16 = 120;

/// Areas of tabs, body and status line.
pub fn rows(area: Rect) -> [Rect; 3] {
    Layout::vertical([Constraint::Length(1), Constraint::Fill(1), Constraint::Length(1)]).areas(area)
}

/// True if only lists fit.
pub fn is_narrow(area: Rect) -> bool {
    area.width < NARROW.0 || area.height < NARROW.1
}

pub fn middle(area: Rect, width: u16, height: u16) -> Rect {
    let x = area.x + area.width.saturating_sub(width) / 2;
    let y = area.y + area.height.saturating_sub(height) / 2;
    Rect::new(x, y, width, height).intersection(area)
}

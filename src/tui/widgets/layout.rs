//! Layout of the screen.

use ratatui::layout::{Constraint, Layout, Rect};

/// Terminals with fewer columns or rows than this get lists instead of grids and panes.
const NARROW: (u16, u16) = (60, 16);
/// Terminals with at least so many columns get panes side by side.
pub const WIDE: u16 = 120;

/// Tabs, body, status line.
pub fn rows(area: Rect) -> [Rect; 3] {
    Layout::vertical([Constraint::Length(1), Constraint::Fill(1), Constraint::Length(1)]).areas(area)
}

/// True if there is only room for lists.
pub fn is_narrow(area: Rect) -> bool {
    area.width < NARROW.0 || area.height < NARROW.1
}

/// A place of a size in the middle of an area.
pub fn middle(area: Rect, width: u16, height: u16) -> Rect {
    let x = area.x + area.width.saturating_sub(width) / 2;
    let y = area.y + area.height.saturating_sub(height) / 2;
    Rect::new(x, y, width, height).intersection(area)
}

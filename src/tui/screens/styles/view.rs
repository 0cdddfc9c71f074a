//! The view of the pieces: where a place on the desk is in the pane.

use ratatui::layout::{Position, Rect};

use crate::messages::seams::SizeLayout;
use wardrobe::seams::DeskEdge;

/// Scale from mm to braille dots, of which a cell has two by four.
pub struct View {
    pub area: Rect,
    /// Left and upper end of the pane, mm.
    pub corner: [f64; 2],
    /// Millimetres per dot.
    pub scale: f64,
}

impl View {
    /// View of all pieces in a pane; `None` without pieces or room.
    pub fn of(area: Rect, layout: &SizeLayout) -> Option<Self> {
        let edges = layout.out.desk.pieces.iter().flat_map(|piece| &piece.edges);
        let points = edges.flat_map(|edge| &edge.line_mm);
        let bounds = points.fold(None, |bounds: Option<[f64; 4]>, [x, y]| {
            let [left, low, right, high] = bounds.unwrap_or([*x, *y, *x, *y]);
            Some([left.min(*x), low.min(*y), right.max(*x), high.max(*y)])
        });
        let [left, low, right, high] = bounds?;
        if area.width < 4 || area.height < 3 {
            return None;
        }
        let dots = [f64::from(area.width) * 2.0, f64::from(area.height) * 4.0];
        // One dot stays free on each side.
        let scale = ((right - left) / (dots[0] - 2.0)).max((high - low) / (dots[1] - 2.0)).max(1e-6);
        let corner = [(left + right - scale * dots[0]) / 2.0, (low + high + scale * dots[1]) / 2.0];
        Some(Self { area, corner, scale })
    }

    /// Place of a point in dots, from the left and upper end of the pane.
    pub fn dots(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [(x - self.corner[0]) / self.scale, (self.corner[1] - y) / self.scale]
    }

    /// Returns `None` outside the pane.
    pub fn cell(&self, place: [f64; 2]) -> Option<Position> {
        let [x, y] = self.dots(place);
        let [column, row] = [(x / 2.0).floor(), (y / 4.0).floor()];
        let is_inside =
            column >= 0.0 && row >= 0.0 && column < f64::from(self.area.width) && row < f64::from(self.area.height);
        is_inside.then(|| Position::new(self.area.x + column as u16, self.area.y + row as u16))
    }
}

/// Points along an edge, at most `apart_mm` apart.
pub fn walked(edge: &DeskEdge, apart_mm: f64) -> Vec<[f64; 2]> {
    let mut places = vec![];
    for pair in edge.line_mm.windows(2) {
        let [a, b] = [pair[0], pair[1]];
        let steps = ((b[0] - a[0]).hypot(b[1] - a[1]) / apart_mm).ceil().clamp(1.0, 1e4) as usize;
        let point_at = |share: f64| [a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])];
        places.extend((0..=steps).map(|k| point_at(k as f64 / steps as f64)));
    }
    places
}

//! Braille dots, eight in each cell, in the styles of lines.

use ratatui::style::Style;
use ratatui::text::{Line, Span};

/// Bits of the dots in a braille letter, by column and row.
const BITS: [[u32; 4]; 2] = [[0x01, 0x02, 0x04, 0x40], [0x08, 0x10, 0x20, 0x80]];

/// A dashed line, as numbers of dots.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Dash {
    pub on: usize,
    pub off: usize,
}

/// A grid of braille cells. A cell has the style of its latest dot.
pub struct Dots {
    columns: usize,
    cells: Vec<(u32, Style)>,
}

impl Dots {
    pub fn new(columns: usize, rows: usize) -> Self {
        Self { columns, cells: vec![(0, Style::new()); columns * rows] }
    }

    /// Number of dots across and down.
    pub fn size(&self) -> [usize; 2] {
        [2 * self.columns, 4 * self.cells.len() / self.columns.max(1)]
    }

    /// Draws a dot at a point, counted from the left and the top. Ignores points outside.
    pub fn draw(&mut self, [x, y]: [f64; 2], style: Style) {
        let [width, height] = self.size().map(|size| size as f64);
        if !(0.0..width).contains(&x) || !(0.0..height).contains(&y) {
            return;
        }
        let (x, y) = (x as usize, y as usize);
        let cell = &mut self.cells[y / 4 * self.columns + x / 2];
        *cell = (cell.0 | BITS[x % 2][y % 4], style);
    }

    /// Draws a line through points; dashes continue around its corners.
    pub fn line(&mut self, places: &[[f64; 2]], dash: Dash, style: Style) {
        let (mut last, mut drawn) = (None, 0);
        for [[x, y], [to_x, to_y]] in places.windows(2).map(|two| [two[0], two[1]]) {
            let steps = (2.0 * (to_x - x).abs().max((to_y - y).abs())).ceil().max(1.0);
            for k in 0..=steps as usize {
                let share = k as f64 / steps;
                let place = [x + (to_x - x) * share, y + (to_y - y) * share];
                let dot = place.map(f64::floor);
                if last != Some(dot) {
                    last = Some(dot);
                    if drawn % (dash.on + dash.off) < dash.on {
                        self.draw(place, style);
                    }
                    drawn += 1;
                }
            }
        }
    }

    /// Rows of text, with a span for each run of one style.
    pub fn lines(&self) -> Vec<Line<'static>> {
        let row = |row: &[(u32, Style)]| {
            let runs = row.chunk_by(|one, next| one.1 == next.1);
            Line::from_iter(runs.map(|run| Span::styled(run.iter().map(letter).collect::<String>(), run[0].1)))
        };
        self.cells.chunks(self.columns.max(1)).map(row).collect()
    }
}

fn letter((bits, _): &(u32, Style)) -> char {
    if *bits == 0 { ' ' } else { char::from_u32(0x2800 + bits).unwrap_or(' ') }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_dashed_and_cut_at_the_edge() {
        let check = |places: &[[f64; 2]], on: usize, off: usize, expect: &str| {
            let mut dots = Dots::new(4, 1);
            dots.line(places, Dash { on, off }, Style::new());
            assert_eq!(dots.lines()[0].to_string(), expect, "{places:?}");
        };
        check(&[[0.0, 0.0], [7.0, 0.0]], 1, 0, "⠉⠉⠉⠉");
        check(&[[0.0, 0.0], [7.0, 0.0]], 2, 2, "⠉ ⠉ ");
        check(&[[0.0, 3.0], [3.0, 3.0], [7.0, 3.0]], 1, 1, "⡀⡀⡀⡀");
        check(&[[-9.0, 1.0], [99.0, 1.0]], 1, 0, "⠒⠒⠒⠒");
        check(&[[0.0, 9.0], [7.0, f64::NAN]], 1, 0, "    ");
    }
}

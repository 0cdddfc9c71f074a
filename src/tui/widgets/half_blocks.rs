//! Pictures in cells: as half blocks of two colours, or as letters in terminals without colours.

use image::{Rgba, RgbaImage, imageops};
use ratatui::buffer::Buffer;
use ratatui::layout::{Rect, Size};
use ratatui::style::Color;

/// Step to which red, green and blue are rounded. Neighbours that look alike become equal, and are sent together.
const STEP: u8 = 8;

/// A picture of half blocks: colours of the upper and lower half of each cell, row by row; `None` for background.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Blocks {
    pub size: Size,
    halves: Vec<[Option<[u8; 3]>; 2]>,
}

impl Blocks {
    pub fn of(picture: &RgbaImage, size: Size) -> Self {
        let (columns, rows) = (u32::from(size.width), u32::from(size.height));
        let half = |x: u32, y: u32| {
            let level = |v: u8| v.saturating_add(STEP / 2) / STEP * STEP;
            mean(picture, (x, columns), (y, 2 * rows)).map(|colour| colour.map(level))
        };
        let cells = (0..rows).flat_map(|y| (0..columns).map(move |x| (x, y)));
        Self { size, halves: cells.map(|(x, y)| [half(x, 2 * y), half(x, 2 * y + 1)]).collect() }
    }

    /// Draws the blocks into a buffer; the background stays that of the terminal.
    pub fn render(&self, area: Rect, buffer: &mut Buffer) {
        let colour = |[r, g, b]: [u8; 3]| Color::Rgb(r, g, b);
        for (place, [above, below]) in area.positions().zip(&self.halves) {
            let Some(cell) = buffer.cell_mut(place) else { continue };
            cell.reset();
            match (above, below) {
                (None, None) => {}
                (Some(above), None) => drop(cell.set_symbol("▀").set_fg(colour(*above))),
                (None, Some(below)) => drop(cell.set_symbol("▄").set_fg(colour(*below))),
                (Some(above), Some(below)) if above == below => drop(cell.set_bg(colour(*above))),
                (Some(above), Some(below)) => {
                    cell.set_symbol("▀").set_fg(colour(*above)).set_bg(colour(*below));
                }
            }
        }
    }
}

/// Picture as letters: the darker, the denser. Background stays blank.
pub fn letters(picture: &RgbaImage, size: Size) -> Vec<String> {
    const RAMP: [char; 4] = ['░', '▒', '▓', '█'];
    let (columns, rows) = (u32::from(size.width), u32::from(size.height));
    let letter = |x: u32, y: u32| {
        let Some([r, g, b]) = mean(picture, (x, columns), (y, rows)) else { return ' ' };
        let light = 0.2126 * f64::from(r) + 0.7152 * f64::from(g) + 0.0722 * f64::from(b);
        RAMP[((255.0 - light) / 64.0) as usize % RAMP.len()]
    };
    (0..rows).map(|y| (0..columns).map(|x| letter(x, y)).collect()).collect()
}

/// Mean colour of the opaque part of a picture's block: one of `columns` columns and `rows` rows. `None` if less than
/// half of it is opaque.
fn mean(picture: &RgbaImage, (column, columns): (u32, u32), (row, rows): (u32, u32)) -> Option<[u8; 3]> {
    let part = |k: u32, of: u32, pixels: u32| {
        let from = (k * pixels / of).min(pixels.saturating_sub(1));
        from..((k + 1) * pixels / of).clamp(from + 1, pixels)
    };
    let (mut sum, mut opaque, mut all) = ([0u32; 3], 0, 0);
    for y in part(row, rows, picture.height()) {
        for x in part(column, columns, picture.width()) {
            let pixel = picture.get_pixel(x, y);
            all += 1;
            if is_opaque(pixel) {
                opaque += 1;
                sum.iter_mut().zip(pixel.0).for_each(|(sum, v)| *sum += u32::from(v));
            }
        }
    }
    (2 * opaque >= all && opaque > 0).then(|| sum.map(|sum| (sum / opaque) as u8))
}

/// Opaque part of a picture, with a small margin.
pub fn cropped(picture: &RgbaImage) -> RgbaImage {
    let (width, height) = picture.dimensions();
    let shown = picture.enumerate_pixels().filter(|(.., pixel)| is_opaque(pixel));
    let bounds = shown.fold(None, |bounds: Option<[u32; 4]>, (x, y, _)| {
        let [left, top, right, bottom] = bounds.unwrap_or([x, y, x, y]);
        Some([left.min(x), top.min(y), right.max(x), bottom.max(y)])
    });
    let Some([left, top, right, bottom]) = bounds else { return picture.clone() };
    let margin = width.max(height) / 50;
    let (left, top) = (left.saturating_sub(margin), top.saturating_sub(margin));
    let (right, bottom) = ((right + margin).min(width - 1), (bottom + margin).min(height - 1));
    imageops::crop_imm(picture, left, top, right - left + 1, bottom - top + 1).to_image()
}

fn is_opaque(pixel: &Rgba<u8>) -> bool {
    pixel[3] >= 128
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::widgets::picture::tests::shirt;

    #[test]
    fn crops_to_what_is_shown() {
        let cut = cropped(&shirt());
        assert_eq!(cut.dimensions(), (108, 88));
        let empty = RgbaImage::from_pixel(30, 20, Rgba([9, 9, 9, 0]));
        assert_eq!(cropped(&empty).dimensions(), (30, 20));
    }

    #[test]
    fn backgrounds_are_left_to_the_terminal_and_one_colour_is_one() {
        let blocks = Blocks::of(&shirt(), Size::new(20, 10));
        let mut buffer = Buffer::empty(Rect::new(0, 0, 20, 10));
        blocks.render(buffer.area, &mut buffer);
        assert_eq!(buffer[(0, 0)], ratatui::buffer::Cell::default());
        let trunk = &buffer[(9, 5)];
        assert_eq!((trunk.symbol(), trunk.bg), (" ", Color::Rgb(40, 88, 160)), "{buffer:?}");
    }
}

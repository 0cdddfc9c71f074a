//! Pictures in cells: half blocks of two colours, or letters where there are none.

use image::{Rgba, RgbaImage, imageops};
use ratatui::buffer::Buffer;
use ratatui::layout::{Rect, Size};
use ratatui::style::Color;

/// Steps of the levels of red, green and blue: neighbours that look the same are the same, and are sent as one.
const STEP: u8 = 8;

/// A picture of half blocks: colours above and below in each cell, row by row; none where the background is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Blocks {
    /// Columns and rows.
    pub size: Size,
    halves: Vec<[Option<[u8; 3]>; 2]>,
}

impl Blocks {
    /// The blocks of a picture.
    #[must_use]
    pub fn of(picture: &RgbaImage, size: Size) -> Self {
        let (columns, rows) = (u32::from(size.width), u32::from(size.height));
        let small = imageops::resize(picture, columns, 2 * rows, imageops::FilterType::Triangle);
        let half = |x: u32, y: u32| {
            let pixel = small.get_pixel(x, y);
            let Rgba([r, g, b, _]) = *pixel;
            let row = (y * picture.height() + picture.height() / 2) / (2 * rows);
            (!is_background(picture, row, pixel)).then(|| [r, g, b].map(|v| v.saturating_add(STEP / 2) / STEP * STEP))
        };
        let cells = (0..rows).flat_map(|y| (0..columns).map(move |x| (x, y)));
        Self { size, halves: cells.map(|(x, y)| [half(x, 2 * y), half(x, 2 * y + 1)]).collect() }
    }

    /// Puts them into a buffer; a background stays that of the terminal.
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

/// A picture as letters: the darker, the denser; background stays empty.
#[must_use]
pub fn letters(picture: &RgbaImage, size: Size) -> Vec<String> {
    const RAMP: [char; 4] = ['░', '▒', '▓', '█'];
    let (columns, rows) = (u32::from(size.width), u32::from(size.height));
    let small = imageops::resize(picture, columns, rows, imageops::FilterType::Triangle);
    let letter = |row: u32, pixel: &Rgba<u8>| {
        if is_background(picture, row * picture.height() / rows, pixel) {
            return ' ';
        }
        let light = 0.2126 * f64::from(pixel[0]) + 0.7152 * f64::from(pixel[1]) + 0.0722 * f64::from(pixel[2]);
        RAMP[((255.0 - light) / 64.0) as usize % RAMP.len()]
    };
    (0..).zip(small.rows()).map(|(y, row)| row.map(|pixel| letter(y, pixel)).collect()).collect()
}

/// The part of a picture that differs from its background, with a small margin.
#[must_use]
pub fn cropped(picture: &RgbaImage) -> RgbaImage {
    let (width, height) = picture.dimensions();
    let shown = picture.enumerate_pixels().filter(|(_, y, pixel)| !is_background(picture, *y, pixel));
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

/// Whether a pixel is transparent or near the colour its row begins with: backgrounds may change from top to bottom.
fn is_background(picture: &RgbaImage, row: u32, pixel: &Rgba<u8>) -> bool {
    let edge = picture.get_pixel(0, row);
    pixel[3] < 8 || (0..4).all(|k| pixel[k].abs_diff(edge[k]) < 12)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tui::picture::tests::shirt;

    #[test]
    fn crops_to_what_is_shown() {
        let cut = cropped(&shirt());
        assert_eq!(cut.dimensions(), (108, 88));
        let empty = RgbaImage::from_pixel(30, 20, Rgba([9, 9, 9, 255]));
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

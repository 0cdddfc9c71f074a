//! Labels and legends on pictures, and contact sheets of several pictures.

use super::colour::Scale;
use super::{Camera, RenderError, Scene, View, png, rasterise_svg, render};
use image::{Rgba, RgbaImage, imageops};
use std::fmt::Write;

#[derive(Clone, Debug)]
pub struct Cell {
    pub picture: RgbaImage,
    pub label: String,
}

const INK: &str = "#22262b";
const PAPER: Rgba<u8> = Rgba([255, 255, 255, 255]);

/// Arranges pictures in rows of `columns`, each above its label, below a title unless `title` is empty.
pub fn contact_sheet(title: &str, cells: &[Cell], columns: usize) -> Result<RgbaImage, RenderError> {
    let columns = columns.clamp(1, cells.len().max(1)) as u32;
    let cell_width = cells.iter().map(|c| c.picture.width()).max().unwrap_or(0);
    let cell_height = cells.iter().map(|c| c.picture.height()).max().unwrap_or(0);
    let text = (cell_width / 22).clamp(11, 28);
    let (gap, line) = (text / 2, text * 2);
    let head = if title.is_empty() { gap } else { text * 3 };
    let rows = (cells.len() as u32).div_ceil(columns);
    let (width, height) = (columns * (cell_width + gap) + gap, head + rows * (cell_height + line));
    if cells.is_empty() || width > 8192 || height > 8192 {
        return Err(RenderError::Size { width, height });
    }
    let mut sheet = RgbaImage::from_pixel(width, height, PAPER);
    let mut labels = svg_head(width, height);
    label(&mut labels, gap + text / 4, text * 2, text + text / 5, "font-weight=\"bold\"", title);
    for (k, cell) in (0..).zip(cells) {
        let (x, y) = (gap + (k % columns) * (cell_width + gap), head + (k / columns) * (cell_height + line));
        imageops::overlay(&mut sheet, &cell.picture, i64::from(x), i64::from(y));
        let (middle, base) = (x + cell_width / 2, y + cell_height + text + text / 4);
        label(&mut labels, middle, base, text, "text-anchor=\"middle\"", &cell.label);
    }
    labels.push_str("</svg>");
    imageops::overlay(&mut sheet, &rasterise_svg(&labels, 1.0)?, 0, 0);
    Ok(sheet)
}

/// Takes pictures of a scene in all four views, each `width` by `height` pixels, and arranges them in a row. `camera`
/// gives the camera of each view. Returns a PNG file.
pub fn from_all_sides(
    scene: &Scene,
    camera: impl Fn(View) -> Camera,
    [width, height]: [u32; 2],
) -> Result<Vec<u8>, RenderError> {
    let shot = |view: View| {
        Ok(Cell { picture: render(scene, &camera(view), width, height)?, label: view.as_str().to_owned() })
    };
    let cells = View::ALL.into_iter().map(shot).collect::<Result<Vec<_>, RenderError>>()?;
    png(&contact_sheet("", &cells, cells.len())?)
}

fn svg_head(width: u32, height: u32) -> String {
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" font-family=\"DejaVu Sans\">"
    )
}

fn label(svg: &mut String, x: u32, y: u32, size: u32, attributes: &str, text: &str) {
    let text = escape(text);
    let _ = write!(svg, "<text x=\"{x}\" y=\"{y}\" font-size=\"{size}\" fill=\"{INK}\" {attributes}>{text}</text>");
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

/// Draws the legend of a scale into the lower left corner of a picture: colour bar, five ticks, label and unit.
pub fn draw_legend(picture: &mut RgbaImage, scale: &Scale) -> Result<(), RenderError> {
    let text = f64::from((picture.width() / 45).clamp(10, 24));
    let (bar_width, bar_height) = (text * 1.1, text * 13.0);
    let (left, top) = (text, text * 2.6);
    let height = top + bar_height + text * 1.2;
    let (width, height) = (f64::from(picture.width()).ceil() as u32, height.ceil() as u32);
    let unit = if scale.unit.is_empty() { String::new() } else { format!(" [{}]", scale.unit) };
    let caption = format!("{}{unit}", scale.label);
    let mut svg = svg_head(width, height);
    let _ = write!(
        svg,
        "<rect x=\"{}\" y=\"0\" width=\"{}\" height=\"{height}\" rx=\"{}\" fill=\"#fff\" fill-opacity=\"0.82\"/>",
        left * 0.4,
        text * (caption.chars().count() as f64 * 0.62).max(6.5) + text * 1.2,
        text * 0.5,
    );
    const STRIPS: u32 = 64;
    for strip in 0..STRIPS {
        let t = 1.0 - (f64::from(strip) + 0.5) / f64::from(STRIPS);
        let (y, h) = (top + bar_height * f64::from(strip) / f64::from(STRIPS), bar_height / f64::from(STRIPS) + 0.6);
        let colour = scale.map.at(t).hex();
        let _ =
            write!(svg, "<rect x=\"{left}\" y=\"{y:.2}\" width=\"{bar_width}\" height=\"{h:.2}\" fill=\"{colour}\"/>");
    }
    let _ = write!(
        svg,
        "<rect x=\"{left}\" y=\"{top}\" width=\"{bar_width}\" height=\"{bar_height}\" fill=\"none\" stroke=\"{INK}\" stroke-width=\"{:.1}\"/>",
        text / 16.0
    );
    let decimals = match scale.high - scale.low {
        range if range >= 10.0 => 0,
        range if range >= 1.0 => 1,
        range if range >= 0.4 => 2,
        _ => 3,
    };
    for tick in 0..5 {
        let t = f64::from(tick) / 4.0;
        let (y, value) = (top + bar_height * (1.0 - t), scale.low + t * (scale.high - scale.low));
        let right = left + bar_width;
        let bound = match tick {
            0 if scale.low != 0.0 => "\u{2264}\u{2009}",
            4 => "\u{2265}\u{2009}",
            _ => "",
        };
        let _ = write!(
            svg,
            "<line x1=\"{right}\" y1=\"{y}\" x2=\"{}\" y2=\"{y}\" stroke=\"{INK}\"/><text x=\"{}\" y=\"{}\" font-size=\"{text}\" fill=\"{INK}\">{bound}{value:.decimals$}</text>",
            right + text * 0.4,
            right + text * 0.65,
            y + text * 0.36,
        );
    }
    label(&mut svg, left as u32, (text * 1.6) as u32, text as u32, "", &caption);
    svg.push_str("</svg>");
    let drawing = rasterise_svg(&svg, 1.0)?;
    let y = i64::from(picture.height()) - i64::from(drawing.height()) - text as i64;
    imageops::overlay(picture, &drawing, 0, y.max(0));
    Ok(())
}

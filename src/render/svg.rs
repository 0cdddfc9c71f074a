//! Rasterisation of the SVG that charts, labels and legends are drawn in: filled and stroked shapes, and text in embedded
//! fonts, so that pictures do not depend on the fonts of the machine.

use super::RenderError;
use ab_glyph::{Font, FontRef, GlyphId, point};
use ab_glyph_rasterizer::Rasterizer;
use image::RgbaImage;
use roxmltree::{Document, Node};
use std::collections::BTreeSet;
use std::f32::consts::TAU;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Letters of drawings that the embedded fonts lack.
static LACKING: Mutex<BTreeSet<char>> = Mutex::new(BTreeSet::new());

fn lock(letters: &Mutex<BTreeSet<char>>) -> MutexGuard<'_, BTreeSet<char>> {
    letters.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Letters that stand as empty boxes in what this process has rasterised, in the order of their code points: the embedded
/// fonts have none of Chinese, Japanese and Korean.
pub fn lacking_letters() -> Vec<char> {
    lock(&LACKING).iter().copied().collect()
}

/// Greatest side of a picture, pixels.
const MOST_PIXELS: u32 = 8192;

/// Size of type where a text names none, as SVG has it.
const TYPE: f32 = 12.0;

/// Corners of a circle.
const ROUND: usize = 96;

/// Rasterises an SVG drawing at `scale` pixels per unit, on a transparent ground. Takes rectangles, lines, polylines,
/// polygons, circles and texts with presentation attributes, and refuses all else.
pub fn rasterise_svg(svg: &str, scale: f32) -> Result<RgbaImage, RenderError> {
    let document = Document::parse(svg).map_err(|error| RenderError::Svg(error.to_string()))?;
    let root = document.root_element();
    if root.tag_name().name() != "svg" {
        return Err(RenderError::Svg(format!("<{}>; accepted: <svg>", root.tag_name().name())));
    }
    let [width, height] = ["width", "height"].map(|side| (number(root, side, 0.0) * scale).ceil() as u32);
    if !(1..=MOST_PIXELS).contains(&width) || !(1..=MOST_PIXELS).contains(&height) {
        return Err(RenderError::Size { width, height });
    }
    let mut sheet = Sheet { picture: RgbaImage::new(width, height), scale };
    for node in root.children().filter(Node::is_element) {
        sheet.draw(node)?;
    }
    Ok(sheet.picture)
}

/// Number of an attribute, which may end in `px`.
fn number(node: Node<'_, '_>, name: &str, otherwise: f32) -> f32 {
    let text = node.attribute(name).map(|text| text.trim().trim_end_matches("px"));
    text.and_then(|text| text.parse().ok()).filter(|value: &f32| value.is_finite()).unwrap_or(otherwise)
}

/// Colour of an attribute with its opacity, `None` for `none`.
fn ink(node: Node<'_, '_>, name: &str, otherwise: Option<&str>) -> Result<Option<[f32; 4]>, RenderError> {
    let Some(text) = node.attribute(name).or(otherwise).filter(|text| *text != "none") else { return Ok(None) };
    let digits = text.strip_prefix('#').unwrap_or_default();
    let long: String = if digits.len() == 3 { digits.chars().flat_map(|c| [c, c]).collect() } else { digits.into() };
    let value = u32::from_str_radix(&long, 16).ok().filter(|_| long.len() == 6);
    let value = value.ok_or_else(|| RenderError::Svg(format!("colour `{text}`; accepted: #rgb, #rrggbb or none")))?;
    let channel = |shift: u32| (value >> shift & 0xff) as f32;
    let opacity = number(node, "opacity", 1.0) * number(node, &format!("{name}-opacity"), 1.0);
    Ok(Some([channel(16), channel(8), channel(0), opacity.clamp(0.0, 1.0)]))
}

type Ring = Vec<[f32; 2]>;

/// Picture that grows shape by shape.
struct Sheet {
    picture: RgbaImage,
    /// Pixels per unit of the drawing.
    scale: f32,
}

impl Sheet {
    fn draw(&mut self, node: Node<'_, '_>) -> Result<(), RenderError> {
        let at = |name: &str| number(node, name, 0.0);
        let half = number(node, "stroke-width", 1.0) / 2.0;
        let stroke = ink(node, "stroke", None)?;
        let name = node.tag_name().name();
        let fill = ink(node, "fill", (name != "line").then_some("#000"))?;
        let (outline, stroked): (Ring, Vec<Ring>) = match name {
            "text" => return self.text(node, fill),
            "line" => {
                let ends = vec![[at("x1"), at("y1")], [at("x2"), at("y2")]];
                (vec![], strip(&ends, half, 0.0))
            }
            "polyline" => (points(node)?, strip(&points(node)?, half, 0.0)),
            "polygon" => {
                let corners = points(node)?;
                let closed: Ring = corners.iter().chain(corners.first()).copied().collect();
                (corners, strip(&closed, half, 0.0))
            }
            "rect" => {
                let corners = rectangle(node);
                let closed: Ring = corners.iter().chain(corners.first()).copied().collect();
                // Square corners are closed by the overhang of both sides.
                let overhang = if node.has_attribute("rx") { 0.0 } else { half };
                (corners, strip(&closed, half, overhang))
            }
            "circle" => {
                let ring = |radius: f32| arc([at("cx"), at("cy")], radius.max(0.0), 0.0, ROUND);
                let mut inner = ring(at("r") - half);
                inner.reverse();
                (ring(at("r")), vec![ring(at("r") + half), inner])
            }
            other => {
                return Err(RenderError::Svg(format!(
                    "<{other}>; accepted: rect, line, polyline, polygon, circle and text"
                )));
            }
        };
        if let Some(fill) = fill {
            self.cover(&[outline], fill);
        }
        if let Some(stroke) = stroke {
            self.cover(&stroked, stroke);
        }
        Ok(())
    }

    /// Lays an ink over what rings enclose. Rings of one orientation add up, those of the other are cut out.
    fn cover(&mut self, rings: &[Ring], ink: [f32; 4]) {
        let place = |[x, y]: [f32; 2]| [x * self.scale, y * self.scale];
        let all = || rings.iter().flatten().map(|&at| place(at));
        let low = all().fold([f32::INFINITY; 2], |low, at| [low[0].min(at[0]), low[1].min(at[1])]);
        let high = all().fold([f32::NEG_INFINITY; 2], |high, at| [high[0].max(at[0]), high[1].max(at[1])]);
        let [left, top] = low.map(|value| value.floor() - 1.0);
        let [width, height] = [high[0] - left, high[1] - top].map(|side| side.ceil() as usize + 2);
        if rings.iter().all(Vec::is_empty) || width.max(height) > 4 * MOST_PIXELS as usize {
            return;
        }
        let mut raster = Rasterizer::new(width, height);
        for ring in rings {
            for (k, &from) in ring.iter().enumerate() {
                let [from, to] = [from, ring[(k + 1) % ring.len()]].map(place);
                raster.draw_line(point(from[0] - left, from[1] - top), point(to[0] - left, to[1] - top));
            }
        }
        raster.for_each_pixel_2d(|x, y, share| {
            self.blend(left as i64 + i64::from(x), top as i64 + i64::from(y), share, ink)
        });
    }

    /// Lays an ink over a share of a pixel.
    fn blend(&mut self, x: i64, y: i64, share: f32, [red, green, blue, opacity]: [f32; 4]) {
        let (Ok(x), Ok(y)) = (u32::try_from(x), u32::try_from(y)) else { return };
        let over = share.abs().min(1.0) * opacity;
        if over <= 0.0 {
            return;
        }
        let Some(pixel) = self.picture.get_pixel_mut_checked(x, y) else { return };
        let under = f32::from(pixel[3]) / 255.0 * (1.0 - over);
        let alpha = over + under;
        for (channel, value) in [red, green, blue].into_iter().enumerate() {
            pixel[channel] = ((value * over + f32::from(pixel[channel]) * under) / alpha).round() as u8;
        }
        pixel[3] = (255.0 * alpha).round() as u8;
    }

    fn text(&mut self, node: Node<'_, '_>, fill: Option<[f32; 4]>) -> Result<(), RenderError> {
        let Some(fill) = fill else { return Ok(()) };
        let root = node.document().root_element();
        let size = number(node, "font-size", number(root, "font-size", TYPE));
        let is_bold = node.attribute("font-weight") == Some("bold");
        let file = if is_bold { dejavu::sans::bold() } else { dejavu::sans::regular() };
        let font = FontRef::try_from_slice(file).map_err(|error| RenderError::Svg(error.to_string()))?;
        let em = size / font.units_per_em().unwrap_or(2048.0);
        let text = node.text().unwrap_or_default().trim();
        let glyphs: Vec<GlyphId> = text.chars().map(|letter| font.glyph_id(letter)).collect();
        lock(&LACKING).extend(text.chars().zip(&glyphs).filter(|(_, glyph)| glyph.0 == 0).map(|(letter, _)| letter));
        let mut x = 0.0;
        let mut places = Vec::new();
        for (k, &glyph) in glyphs.iter().enumerate() {
            if k > 0 {
                x += font.kern_unscaled(glyphs[k - 1], glyph) * em;
            }
            places.push(x);
            x += font.h_advance_unscaled(glyph) * em;
        }
        let before = match node.attribute("text-anchor") {
            Some("middle") => x / 2.0,
            Some("end") => x,
            _ => 0.0,
        };
        let left = number(node, "x", 0.0) - before;
        let base = number(node, "y", 0.0) + shift(node.attribute("dy").unwrap_or_default()) * size;
        // Height of the font, by which `ab_glyph` counts, of an em of the wanted size.
        let height = font.height_unscaled() * em * self.scale;
        for (glyph, place) in glyphs.into_iter().zip(places) {
            let at = point((left + place) * self.scale, base * self.scale);
            let Some(outlined) = font.outline_glyph(glyph.with_scale_and_position(height, at)) else { continue };
            let corner = outlined.px_bounds().min;
            outlined.draw(|x, y, share| {
                self.blend(corner.x as i64 + i64::from(x), corner.y as i64 + i64::from(y), share, fill);
            });
        }
        Ok(())
    }
}

/// Shift of a base line such as `0.5ex`, ems. An x is taken for half an em high.
fn shift(text: &str) -> f32 {
    let of = |unit: &str, ems: f32| Some(text.strip_suffix(unit)?.parse::<f32>().ok()? * ems);
    of("em", 1.0).or_else(|| of("ex", 0.5)).unwrap_or(0.0)
}

fn points(node: Node<'_, '_>) -> Result<Ring, RenderError> {
    let text = node.attribute("points").unwrap_or_default();
    let numbers = text.split([' ', ',']).filter(|part| !part.is_empty()).map(str::parse);
    let numbers: Vec<f32> =
        numbers.collect::<Result<_, _>>().map_err(|_| RenderError::Svg(format!("points `{text}`")))?;
    Ok(numbers.chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect())
}

/// Corners of an arc, from an angle on by an eighth of `of` at a time; the whole circle where `of` is [`ROUND`].
fn arc([x, y]: [f32; 2], radius: f32, from: f32, corners: usize) -> Ring {
    let corner = |k: usize| {
        let angle = from + TAU * k as f32 / ROUND as f32;
        [x + radius * angle.cos(), y + radius * angle.sin()]
    };
    (0..corners).map(corner).collect()
}

/// Corners of a rectangle, rounded by `rx`. Sides may be in percent of the drawing.
fn rectangle(node: Node<'_, '_>) -> Ring {
    let side = |name: &str| {
        let percent = node.attribute(name).and_then(|text| text.strip_suffix('%')?.parse::<f32>().ok());
        let whole = || number(node.document().root_element(), name, 0.0);
        percent.map_or_else(|| number(node, name, 0.0), |percent| whole() * percent / 100.0)
    };
    let [left, top] = ["x", "y"].map(|name| number(node, name, 0.0));
    let [right, bottom] = [left + side("width"), top + side("height")];
    let radius = number(node, "rx", 0.0).min((right - left) / 2.0).min((bottom - top) / 2.0);
    if radius <= 0.0 {
        return vec![[left, top], [right, top], [right, bottom], [left, bottom]];
    }
    let middles = [[right - radius, bottom - radius], [left + radius, bottom - radius]];
    let above = [[left + radius, top + radius], [right - radius, top + radius]];
    let quarter = |(k, middle): (usize, [f32; 2])| arc(middle, radius, TAU * k as f32 / 4.0, ROUND / 4 + 1);
    middles.into_iter().chain(above).enumerate().flat_map(quarter).collect()
}

/// Rings that a pen of a half width covers along a line: a quadrangle for each segment, a disk at each inner corner. All run
/// the same way round. Segments overhang their ends.
fn strip(line: &[[f32; 2]], half: f32, overhang: f32) -> Vec<Ring> {
    let segment = |pair: &[[f32; 2]]| {
        let ([ax, ay], [bx, by]) = (pair[0], pair[1]);
        let length = (bx - ax).hypot(by - ay);
        (length > 0.0).then(|| {
            let [ux, uy] = [(bx - ax) / length, (by - ay) / length];
            let [ax, ay, bx, by] = [ax - ux * overhang, ay - uy * overhang, bx + ux * overhang, by + uy * overhang];
            let [nx, ny] = [-uy * half, ux * half];
            vec![[ax - nx, ay - ny], [bx - nx, by - ny], [bx + nx, by + ny], [ax + nx, ay + ny]]
        })
    };
    let mut rings: Vec<Ring> = line.windows(2).filter_map(segment).collect();
    if overhang == 0.0 {
        let is_closed = line.len() > 2 && line.first() == line.last();
        let inner = line.iter().skip(1).take(line.len().saturating_sub(if is_closed { 1 } else { 2 }));
        rings.extend(inner.map(|&corner| arc(corner, half, 0.0, ROUND)));
    }
    rings
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Alpha of each pixel of a drawing of 8 by 8 units, one line a row: `#` is full, `+` about half.
    fn drawn(shapes: &str) -> String {
        let svg = format!("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"8\" height=\"8\">{shapes}</svg>");
        let picture = rasterise_svg(&svg, 1.0).expect("a drawing");
        let letter = |alpha: u8| match alpha {
            0..64 => '.',
            64..192 => '+',
            192.. => '#',
        };
        let rows = picture.rows().map(|row| row.map(|pixel| letter(pixel[3])).collect::<String>());
        rows.collect::<Vec<_>>().join("\n")
    }

    #[test]
    fn shapes_cover_what_they_enclose() {
        let check = |shapes: &str, rows: [&str; 8]| assert_eq!(drawn(shapes), rows.join("\n"), "{shapes}");
        let (none, bar) = ("........", ".######.");
        check("<rect x='1' y='2' width='6' height='3'/>", [none, none, bar, bar, bar, none, none, none]);
        check(
            "<rect x='2' y='2' width='4' height='4' fill='none' stroke='#000' stroke-width='2'/>",
            [none, bar, bar, ".##..##.", ".##..##.", bar, bar, none],
        );
        check(
            "<line x1='1' y1='4' x2='7' y2='4' stroke='#000' stroke-width='2'/>",
            [none, none, none, bar, bar, none, none, none],
        );
        check(
            "<polyline points='2,1 2,6 7,6' fill='none' stroke='#123456' stroke-width='2'/>",
            [none, ".##.....", ".##.....", ".##.....", ".##.....", bar, bar, none],
        );
        check("<polygon points='0,0 8,0 8,8 0,8' fill-opacity='0.5'/>", ["++++++++"; 8]);
        let ring = drawn("<circle cx='4' cy='4' r='3' fill='none' stroke='#000' stroke-width='1.5'/>");
        assert_eq!((ring.matches('#').count() > 8, ring.lines().nth(4).map(|row| &row[3..5])), (true, Some("..")));
    }

    #[test]
    fn inks_lie_over_each_other() {
        let svg = "<svg width='2' height='1'><rect width='100%' height='100%' fill='#fff'/>\
                   <rect width='1' height='1' fill='#ff0000' opacity='0.5'/></svg>";
        let picture = rasterise_svg(svg, 1.0).expect("a drawing");
        assert_eq!(picture.into_raw(), [255, 128, 128, 255, 255, 255, 255, 255]);
    }

    #[test]
    fn text_stands_at_its_anchor() {
        let middle = |anchor: &str| {
            let text = format!("<text x='50' y='15' text-anchor='{anchor}'>mmm</text>");
            let picture = rasterise_svg(&format!("<svg width='100' height='20'>{text}</svg>"), 1.0).expect("a drawing");
            let inked: Vec<f64> =
                picture.enumerate_pixels().filter(|(.., pixel)| pixel[3] > 128).map(|(x, ..)| f64::from(x)).collect();
            inked.iter().sum::<f64>() / inked.len() as f64
        };
        let [start, centre, end] = ["start", "middle", "end"].map(middle);
        assert!((centre - 50.0).abs() < 1.0 && (start + end - 100.0).abs() < 2.0, "{start} {centre} {end}");
        assert!(start > 60.0, "three letters of 12 px: {start}");
    }

    #[test]
    fn what_is_not_drawn_is_refused() {
        let check = |svg: &str, expect: &str| {
            let told = rasterise_svg(svg, 1.0).expect_err("refused").to_string();
            assert!(told.contains(expect), "{told}");
        };
        check("<p/>", "<p>");
        check("<svg width='2' height='2'><path d='M0 0h4'/></svg>", "<path>; accepted: rect, line");
        check("<svg width='2' height='2'><rect fill='red'/></svg>", "colour `red`");
        check("<svg width='9000' height='2'/>", "9000");
        check("<svg height='2'/>", "0");
    }
}

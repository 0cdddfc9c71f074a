//! Bodies from a front and a side picture: silhouettes, camera, widths and depths at the girth levels, girths.

use super::camera::Camera;
use super::facing;
use super::outline::{Outlines, View};
use super::refused;
use super::segment;
use super::silhouette::Mask;
use super::trunk;
use crate::{BodyError, Dimension, Measurements, Sex};
use image::metadata::Orientation;
use image::{DynamicImage, ImageDecoder, ImageError, ImageReader};
use std::io::Cursor;

/// Greatest number of pixels of a picture, and length of its longer side at the working size, pixels. Judgement.
const MOST_PIXELS: u64 = 120_000_000;
const WORKING: u32 = 2400;

/// Least height of a person at the working size, pixels. Judgement: a pixel is then 7 mm.
const LEAST_HEIGHT: usize = 250;

/// Greatest lean of the figure in front and side view, degrees. In the side view posture adds to it. Judgement.
const MOST_LEAN_DEG: [f64; 2] = [3.0, 6.0];

/// Greatest dark and least bright gray level of a mask, which has nothing between. Judgement.
const MASK_LEVELS: [u8; 2] = [40, 215];

#[derive(Clone, Debug, PartialEq)]
pub struct Pictured {
    pub measurements: Measurements,
    /// Neck, chest, waist and hip.
    pub levels: Vec<PicturedLevel>,
    pub crotch_level_m: f64,
    /// Assumptions, as sentences for the user.
    pub notes: Vec<String>,
}

#[derive(Clone, Debug, PartialEq)]
pub struct PicturedLevel {
    pub name: &'static str,
    pub level_m: f64,
    pub width_m: f64,
    pub depth_m: f64,
    pub girth_m: f64,
    /// Half width of the interval of the girth that contains four in five people.
    pub within_m: f64,
}

/// Measures a body in a front and a side picture, scaled by its stature. The pictures are PNG or JPEG: photographs with
/// a plain background, or black and white masks. Without a camera they count as orthographic.
pub fn from_pictures(
    front: &[u8],
    side: &[u8],
    camera: Option<&Camera>,
    sex: Sex,
    stature_m: f64,
) -> Result<Pictured, BodyError> {
    let front = View::new("front", person("front", front)?, camera)?;
    let (side, turned) = facing::to_the_right(person("side", side)?, sex);
    let side = View::new("side", side, camera)?;
    let mut notes: Vec<String> = turned.into_iter().collect();
    if camera.is_none() {
        notes.push("no camera given: taken as seen from far away, which reads a near person too large".to_owned());
    }
    let outlines = Outlines::new(front, side, stature_m)?;
    notes.extend([("front", false), ("side", true)].into_iter().filter_map(|(name, side)| outlines.doubt(name, side)));
    let (sections, is_chest_hidden) = outlines.sections(sex, &mut notes)?;
    let read = trunk::read(&trunk::Seen {
        sex,
        stature_m,
        crotch_m: outlines.crotch,
        profile: outlines.trunk(),
        sections,
        is_chest_hidden,
        is_near: camera.is_some(),
    });
    let girths = read.map(|level| level.girth_m);
    let levels = sections.iter().zip(&read).map(|(section, level)| PicturedLevel {
        name: section.level.name(),
        level_m: section.height,
        width_m: level.width_m,
        depth_m: level.depth_m,
        girth_m: level.girth_m,
        within_m: level.within_m,
    });
    let levels = levels.collect();
    let [neck, chest, waist, hip] = girths.map(Some);
    let measurements = Measurements::of(sex, stature_m)
        .with(Dimension::ChestGirth, chest)
        .with(Dimension::WaistGirth, waist)
        .with(Dimension::HipGirth, hip)
        .with(Dimension::NeckGirth, neck);
    Ok(Pictured { measurements, levels, crotch_level_m: outlines.crotch, notes })
}

fn unreadable(view: &'static str, error: &dyn std::fmt::Display) -> BodyError {
    refused(view, format!("it cannot be read ({error})"))
}

/// Decoder of a picture, with the orientation in which viewers show it: cameras store pictures as the sensor lies.
fn decoder<'a>(view: &'static str, bytes: &'a [u8]) -> Result<(impl ImageDecoder + use<'a>, Orientation), BodyError> {
    let reader =
        ImageReader::new(Cursor::new(bytes)).with_guessed_format().map_err(|error| unreadable(view, &error))?;
    if reader.format().is_none() {
        return Err(BodyError::PictureFormat { view, format: format_of(bytes) });
    }
    let mut decoder = reader.into_decoder().map_err(|error| match error {
        ImageError::Unsupported(_) => BodyError::PictureFormat { view, format: format_of(bytes) },
        error => unreadable(view, &error),
    })?;
    let orientation = decoder.orientation().unwrap_or(Orientation::NoTransforms);
    Ok((decoder, orientation))
}

fn format_of(bytes: &[u8]) -> &'static str {
    let is_brand =
        |brands: &[&[u8]]| bytes.get(4..8) == Some(b"ftyp") && brands.iter().any(|b| bytes.get(8..12) == Some(*b));
    match bytes {
        _ if is_brand(&[b"heic", b"heix", b"hevc", b"heim", b"heis", b"mif1", b"msf1"]) => "HEIC",
        _ if is_brand(&[b"avif", b"avis"]) => "AVIF",
        [b'R', b'I', b'F', b'F', _, _, _, _, b'W', b'E', b'B', b'P', ..] => "WebP",
        [b'I', b'I', 42, 0, ..] | [b'M', b'M', 0, 42, ..] => "TIFF or a camera's raw format",
        [b'G', b'I', b'F', b'8', ..] => "GIF",
        [b'B', b'M', ..] => "BMP",
        [b'%', b'P', b'D', b'F', ..] => "PDF",
        [] => "empty",
        _ => "of no known picture format",
    }
}

/// Width and height of a picture as shown, pixels.
fn size(view: &'static str, bytes: &[u8]) -> Result<(u32, u32), BodyError> {
    let (decoder, orientation) = decoder(view, bytes)?;
    let (width, height) = decoder.dimensions();
    let is_lying = matches!(
        orientation,
        Orientation::Rotate90 | Orientation::Rotate270 | Orientation::Rotate90FlipH | Orientation::Rotate270FlipH
    );
    Ok(if is_lying { (height, width) } else { (width, height) })
}

/// Height of the front picture in pixels, for [`Camera::of_focal`].
pub fn picture_height(front: &[u8]) -> Result<u32, BodyError> {
    size("front", front).map(|(_, height)| height)
}

fn person(view: &'static str, bytes: &[u8]) -> Result<Mask, BodyError> {
    let (width, height) = size(view, bytes)?;
    if u64::from(width) * u64::from(height) > MOST_PIXELS {
        return Err(refused(view, format!("it has {width} x {height} pixels, at most 120 million are read")));
    }
    let (decoder, orientation) = decoder(view, bytes)?;
    let mut picture = DynamicImage::from_decoder(decoder).map_err(|error| unreadable(view, &error))?;
    picture.apply_orientation(orientation);
    let longer = width.max(height);
    let share = (f64::from(WORKING) / f64::from(longer)).min(1.0);
    let scaled = |side: u32| ((f64::from(side) * share).round() as u32).max(1);
    let picture = if share < 1.0 { picture.thumbnail_exact(scaled(width), scaled(height)) } else { picture };
    let found = match mask(&picture) {
        Some(mask) => mask,
        None => segment::segment(&picture).ok_or_else(|| refused(view, "its background is not plain"))?,
    };
    check(view, &found)?;
    Ok(found.cleaned())
}

/// Mask of a black and white picture, whose border has the colour of the background. `None` for a photograph.
fn mask(picture: &DynamicImage) -> Option<Mask> {
    let gray = picture.to_luma8();
    let (width, height) = (gray.width() as usize, gray.height() as usize);
    let values: Vec<u8> = gray.into_raw();
    let clear = values.iter().filter(|v| **v <= MASK_LEVELS[0] || **v >= MASK_LEVELS[1]).count();
    let both = values.iter().any(|v| *v <= MASK_LEVELS[0]) && values.iter().any(|v| *v >= MASK_LEVELS[1]);
    if !both || clear * 100 < values.len() * 99 || !is_colourless(picture) {
        return None;
    }
    let border = |i: usize| i.is_multiple_of(width) || i % width + 1 == width || i < width || i + width >= values.len();
    let (rim, bright) = (0..values.len())
        .filter(|&i| border(i))
        .fold((0, 0), |(all, bright), i| (all + 1, bright + usize::from(values[i] > 127)));
    let inverted = 2 * bright > rim;
    Some(Mask::new(width, height, values.iter().map(|v| (*v > 127) != inverted).collect()))
}

fn is_colourless(picture: &DynamicImage) -> bool {
    let rgb = picture.to_rgb8();
    rgb.pixels().step_by(97).all(|p| p.0.iter().max().zip(p.0.iter().min()).is_none_or(|(a, b)| a - b < 24))
}

/// Refuses anything but one standing person who is wholly in the picture.
fn check(view: &'static str, mask: &Mask) -> Result<(), BodyError> {
    let pieces = mask.pieces();
    let Some(person) = pieces.first().filter(|piece| piece.len() * 400 > mask.bits.len()) else {
        return Err(refused(view, "no person is seen before the background"));
    };
    if pieces.get(1).is_some_and(|second| second.len() * 4 > person.len()) {
        return Err(refused(view, "two figures are seen; one person alone is accepted"));
    }
    let columns = || person.iter().map(|i| i % mask.width);
    let (left, right) = (columns().min().unwrap_or(0), columns().max().unwrap_or(0));
    let rows = || person.iter().map(|i| i / mask.width);
    let (top, bottom) = (rows().min().unwrap_or(0), rows().max().unwrap_or(0));
    if top == 0 || bottom + 1 == mask.height || left == 0 || right + 1 == mask.width {
        return Err(refused(view, "the person is cut off by the border; head, hands and feet must be in the picture"));
    }
    let (width, height) = (right - left + 1, bottom - top + 1);
    if height < LEAST_HEIGHT {
        return Err(refused(
            view,
            format!("the person is only {height} pixels high; at least {LEAST_HEIGHT} are needed"),
        ));
    }
    if height < width || height > 12 * width || person.len() * 12 < width * height {
        return Err(refused(view, format!("the figure ({width} x {height} pixels) is no standing person")));
    }
    let lean = lean_deg(mask, person);
    let limit = if view == "front" { MOST_LEAN_DEG[0] } else { MOST_LEAN_DEG[1] };
    if lean.abs() > limit {
        let problem = format!("the figure leans by {lean:.1} degrees (at most {limit}): the camera was tilted");
        return Err(refused(view, problem));
    }
    Ok(())
}

/// Angle of the long axis of the figure from the vertical, degrees, clockwise positive.
fn lean_deg(mask: &Mask, person: &[usize]) -> f64 {
    let place = |i: &usize| [(i % mask.width) as f64, (i / mask.width) as f64];
    let count = person.len().max(1) as f64;
    let mean = |value: &dyn Fn([f64; 2]) -> f64| person.iter().map(|i| value(place(i))).sum::<f64>() / count;
    let (x, y) = (mean(&|p| p[0]), mean(&|p| p[1]));
    let (xx, yy) = (mean(&|p| (p[0] - x).powi(2)), mean(&|p| (p[1] - y).powi(2)));
    let xy = mean(&|p| (p[0] - x) * (p[1] - y));
    // Principal axis of the second moments. Rows count downwards.
    -((2.0 * xy).atan2(yy - xx) / 2.0).to_degrees()
}

#[cfg(test)]
#[path = "pictures_tests.rs"]
mod tests;

//! Pictures of meshes without a GPU or a display (GRM in [T 3.6]): a z-buffer, soft light, and scales of colours.
//!
//! A [`Scene`] is built from its layers (body, cloth) and lit once for all views. [`render`] then takes a picture from
//! a [`Camera`]; cameras with the same [`Frame`] have the same scale. Left and right are the viewer's: from the front,
//! the subject's right is at the left of the picture.

mod bake;
mod camera;
mod colour;
pub mod export;
mod floor;
mod lettering;
mod raster;
mod relief;
mod scene;
mod shade;
mod svg;
mod texture;
mod visible;
mod weave;

pub use camera::{Camera, Frame, View};
pub use colour::{ColourMap, Rgb, Scale};
pub use lettering::{Cell, contact_sheet, draw_legend, from_all_sides};
pub use scene::{Layer, Material, Paint, Print, Scene, Values};
pub use shade::{cutout, render};
pub use svg::{lacking_letters, rasterise_svg};
pub use texture::{Mapping, Texture, texture_coordinates};
pub use weave::Weave;

use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{DynamicImage, RgbaImage};

#[derive(Debug, thiserror::Error)]
pub enum RenderError {
    #[error("layer {layer}, triangle {triangle}: vertex {vertex} does not exist; the mesh has {vertices} vertices")]
    NoSuchVertex { layer: usize, triangle: usize, vertex: usize, vertices: usize },
    #[error(
        "layer {layer}, vertex {vertex}: position is not finite; every coordinate must be a finite number of metres"
    )]
    NotFinite { layer: usize, vertex: usize },
    #[error("layer {layer}: {found} values or texture coordinates given, the mesh needs {needed}")]
    PaintLength { layer: usize, found: usize, needed: usize },
    #[error("layer {layer}: a triangle names a texture beyond the {textures} that are there")]
    NoSuchTexture { layer: usize, textures: usize },
    #[error("no layer {layer}; the scene has {layers}, counted from 0")]
    NoSuchLayer { layer: usize, layers: usize },
    #[error("picture of {width} x {height} pixels; each side must be 1 to 8192")]
    Size { width: u32, height: u32 },
    #[error("SVG drawing: {0}")]
    Svg(String),
    #[error("animation: {0}")]
    Animation(String),
    #[error("picture encoding: {0}")]
    Encode(#[from] image::ImageError),
}

pub fn png(picture: &RgbaImage) -> Result<Vec<u8>, RenderError> {
    let mut bytes = Vec::new();
    let encoder = PngEncoder::new_with_quality(&mut bytes, CompressionType::Default, FilterType::Adaptive);
    if picture.pixels().all(|pixel| pixel[3] == u8::MAX) {
        let opaque = DynamicImage::ImageRgba8(picture.clone()).to_rgb8();
        opaque.write_with_encoder(encoder)?;
    } else {
        picture.write_with_encoder(encoder)?;
    }
    Ok(bytes)
}

/// Encodes pictures of one size as an endless animation. Programs without support for animation show the first picture.
pub fn animated_png(pictures: &[RgbaImage], each_ms: u32) -> Result<Vec<u8>, RenderError> {
    let Some(first) = pictures.first() else { return Err(RenderError::Animation("no pictures".into())) };
    if pictures.iter().any(|picture| picture.dimensions() != first.dimensions()) {
        return Err(RenderError::Animation("pictures of several sizes".into()));
    }
    let refused = |error: png::EncodingError| RenderError::Animation(error.to_string());
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, first.width(), first.height());
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_animated(pictures.len() as u32, 0).map_err(refused)?;
    encoder.set_frame_delay(each_ms.min(u32::from(u16::MAX)) as u16, 1000).map_err(refused)?;
    let mut writer = encoder.write_header().map_err(refused)?;
    for picture in pictures {
        writer.write_image_data(picture.as_raw()).map_err(refused)?;
    }
    writer.finish().map_err(refused)?;
    Ok(bytes)
}

/// Encodes a picture as a JPEG file of quality 85, about a quarter as large as PNG. Transparency becomes white.
pub fn jpeg(picture: &RgbaImage) -> Result<Vec<u8>, RenderError> {
    let mut rgb = image::RgbImage::new(picture.width(), picture.height());
    for (to, from) in rgb.pixels_mut().zip(picture.pixels()) {
        let alpha = u32::from(from[3]);
        to.0 = [0, 1, 2].map(|k| ((u32::from(from[k]) * alpha + 255 * (255 - alpha)) / 255) as u8);
    }
    let mut bytes = Vec::new();
    rgb.write_with_encoder(image::codecs::jpeg::JpegEncoder::new_with_quality(&mut bytes, 85))?;
    Ok(bytes)
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that cannot go on should stop")]
mod tests;

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

/// Reason why a picture could not be made.
#[derive(Debug, thiserror::Error)]
pub enum RenderError {
    /// A triangle refers to a vertex that does not exist.
    #[error("layer {layer}, triangle {triangle}: vertex {vertex} does not exist; the mesh has {vertices} vertices")]
    NoSuchVertex {
        /// Index of the layer.
        layer: usize,
        /// Index of the triangle in its mesh.
        triangle: usize,
        /// Vertex that the triangle refers to.
        vertex: usize,
        /// Number of vertices of the mesh.
        vertices: usize,
    },
    /// A position is not finite.
    #[error(
        "layer {layer}, vertex {vertex}: position is not finite; every coordinate must be a finite number of metres"
    )]
    NotFinite {
        /// Index of the layer.
        layer: usize,
        /// Index of the vertex in its mesh.
        vertex: usize,
    },
    /// A scalar field or texture does not fit its mesh.
    #[error("layer {layer}: {found} values or texture coordinates given, the mesh needs {needed}")]
    PaintLength {
        /// Index of the layer.
        layer: usize,
        /// Number of values, texture coordinates or texture numbers given.
        found: usize,
        /// Number that the mesh needs: that of its vertices or triangles.
        needed: usize,
    },
    /// A triangle refers to a texture that does not exist.
    #[error("layer {layer}: a triangle names a texture beyond the {textures} that are there")]
    NoSuchTexture {
        /// Index of the layer.
        layer: usize,
        /// Number of textures of the layer.
        textures: usize,
    },
    /// The scene has no such layer.
    #[error("no layer {layer}; the scene has {layers}, counted from 0")]
    NoSuchLayer {
        /// Index that was given.
        layer: usize,
        /// Number of layers of the scene.
        layers: usize,
    },
    /// The size of a picture is out of range.
    #[error("picture of {width} x {height} pixels; each side must be 1 to 8192")]
    Size {
        /// Width that was given, pixels.
        width: u32,
        /// Height that was given, pixels.
        height: u32,
    },
    /// An SVG drawing could not be read.
    #[error("SVG drawing: {0}")]
    Svg(String),
    /// Pictures cannot be frames of one animation.
    #[error("animation: {0}")]
    Animation(String),
    /// An encoder refused a picture.
    #[error("picture encoding: {0}")]
    Encode(#[from] image::ImageError),
}

/// Encodes a picture as a PNG file.
///
/// # Errors
/// [`RenderError::Encode`] for an empty picture.
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

/// Encodes pictures of one size as an animated PNG file, each shown for `each_ms` milliseconds, in an endless loop.
/// Programs without support for animation show the first picture.
///
/// # Errors
/// [`RenderError::Animation`] where there is no picture or their sizes differ.
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
///
/// # Errors
/// [`RenderError::Encode`] for an empty picture.
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

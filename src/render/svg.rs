//! Rasterisation of SVG drawings with embedded fonts, so that pictures do not depend on the fonts of the machine.

use super::RenderError;
use image::RgbaImage;
use resvg::usvg::{self, fontdb};
use std::sync::{Arc, OnceLock};

/// Fonts that drawings may use: DejaVu Sans, regular and bold.
fn fonts() -> Arc<fontdb::Database> {
    static FONTS: OnceLock<Arc<fontdb::Database>> = OnceLock::new();
    let load = || {
        let mut fonts = fontdb::Database::new();
        fonts.load_font_data(dejavu::sans::regular().to_vec());
        fonts.load_font_data(dejavu::sans::bold().to_vec());
        fonts.set_sans_serif_family("DejaVu Sans");
        Arc::new(fonts)
    };
    FONTS.get_or_init(load).clone()
}

/// Rasterises an SVG drawing at `scale` pixels per unit, on a transparent ground.
///
/// # Errors
/// [`RenderError::Svg`] where the text is no SVG, [`RenderError::Size`] where the drawing has no size or is too large.
pub fn rasterise_svg(svg: &str, scale: f32) -> Result<RgbaImage, RenderError> {
    let options = usvg::Options { fontdb: fonts(), font_family: "DejaVu Sans".into(), ..Default::default() };
    let tree = usvg::Tree::from_str(svg, &options).map_err(|e| RenderError::Svg(e.to_string()))?;
    let pixels = |length: f32| (length * scale).ceil() as u32;
    let (width, height) = (pixels(tree.size().width()), pixels(tree.size().height()));
    let size = RenderError::Size { width, height };
    if width > 8192 || height > 8192 {
        return Err(size);
    }
    let Some(mut pixmap) = resvg::tiny_skia::Pixmap::new(width, height) else { return Err(size) };
    resvg::render(&tree, resvg::tiny_skia::Transform::from_scale(scale, scale), &mut pixmap.as_mut());
    let straight = pixmap.pixels().iter().flat_map(|p| {
        let p = p.demultiply();
        [p.red(), p.green(), p.blue(), p.alpha()]
    });
    RgbaImage::from_raw(width, height, straight.collect()).ok_or(size)
}

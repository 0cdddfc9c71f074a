//! Rasterisation of SVG drawings with embedded fonts, so that pictures do not depend on the fonts of the machine.

use super::RenderError;
use image::RgbaImage;
use resvg::usvg::{self, fontdb};
use std::collections::BTreeSet;
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};

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

static LACKING: Mutex<BTreeSet<char>> = Mutex::new(BTreeSet::new());

fn lock(letters: &Mutex<BTreeSet<char>>) -> MutexGuard<'_, BTreeSet<char>> {
    letters.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Letters that this process has rasterised as empty boxes, by code point: Chinese, Japanese and Korean have no font.
pub fn lacking_letters() -> Vec<char> {
    lock(&LACKING).iter().copied().collect()
}

/// Rasterises an SVG drawing at `scale` pixels per unit, on a transparent ground.
pub fn rasterise_svg(svg: &str, scale: f32) -> Result<RgbaImage, RenderError> {
    let fallback = usvg::FontResolver::default_fallback_selector();
    let options = usvg::Options {
        fontdb: fonts(),
        font_family: "DejaVu Sans".into(),
        font_resolver: usvg::FontResolver {
            select_font: usvg::FontResolver::default_font_selector(),
            select_fallback: Box::new(move |letter, used, fonts| {
                let found = fallback(letter, used, fonts);
                if found.is_none() {
                    lock(&LACKING).insert(letter);
                }
                found
            }),
        },
        ..Default::default()
    };
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

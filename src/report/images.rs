//! Pictures inside the page.

use base64::Engine;

use super::ReportError;
use super::data::{FieldMap, Picture};
use super::text::number;

pub(super) struct Image {
    /// Data URL.
    pub address: String,
    /// Full-size file beside the page; empty without one.
    pub file: String,
    pub alt: String,
    pub caption: String,
}

impl Image {
    pub fn new(picture: &Picture) -> Result<Self, ReportError> {
        let kind = match picture.bytes.as_slice() {
            [0x89, b'P', b'N', b'G', ..] => "image/png",
            [0xff, 0xd8, 0xff, ..] => "image/jpeg",
            _ => return Err(ReportError::PictureFormat(picture.caption.clone())),
        };
        Ok(Self {
            address: address(kind, &picture.bytes),
            file: picture.file.clone(),
            alt: picture.alt.clone(),
            caption: picture.caption.clone(),
        })
    }
}

pub(super) struct MapImage {
    pub image: Image,
    pub label: String,
    pub low: String,
    pub middle: String,
    pub high: String,
    /// Colours of the legend from low to high, in the syntax of CSS.
    pub ramp: String,
}

impl MapImage {
    pub fn new(map: &FieldMap) -> Result<Self, ReportError> {
        let scale = &map.scale;
        let decimals = if scale.high - scale.low >= 10.0 { 0 } else { 2 };
        let unit = if scale.unit.is_empty() { String::new() } else { format!("\u{a0}{}", scale.unit) };
        let tick = |t: f64| format!("{}{unit}", number(scale.low + t * (scale.high - scale.low), decimals));
        let stops: Vec<String> = (0..=12).map(|k| scale.map.at(f64::from(k) / 12.0).hex()).collect();
        Ok(Self {
            image: Image::new(&map.picture)?,
            label: scale.label.clone(),
            low: tick(0.0),
            middle: tick(0.5),
            high: tick(1.0),
            ramp: stops.join(","),
        })
    }
}

/// Data URL; `kind` is the media type.
pub(super) fn address(kind: &str, bytes: &[u8]) -> String {
    format!("data:{kind};base64,{}", base64::engine::general_purpose::STANDARD.encode(bytes))
}

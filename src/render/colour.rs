//! Colours: sRGB for input and output, linear light for shading, colour maps for readers with any colour vision.

/// A colour in sRGB.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rgb(pub u8, pub u8, pub u8);

impl Rgb {
    /// Formats the colour as `#rrggbb`.
    pub fn hex(self) -> String {
        format!("#{:02x}{:02x}{:02x}", self.0, self.1, self.2)
    }

    /// Parses `rrggbb`, with or without a `#`; `None` for any other text.
    pub fn from_hex(text: &str) -> Option<Self> {
        let hex = text.strip_prefix('#').unwrap_or(text);
        let is_hex = hex.len() == 6 && hex.bytes().all(|b| b.is_ascii_hexdigit());
        let byte = |k: usize| u8::from_str_radix(hex.get(k..k + 2)?, 16).ok();
        if is_hex { Some(Self(byte(0)?, byte(2)?, byte(4)?)) } else { None }
    }

    /// Linear light, 0 to 1 [IEC 61966-2-1].
    pub(super) fn linear(self) -> [f32; 3] {
        [self.0, self.1, self.2].map(|v| decode(f32::from(v) / 255.0))
    }

    /// Relative luminance, 0 to 1 [WCAG 2.2].
    pub fn luminance(self) -> f64 {
        let [r, g, b] = self.linear().map(f64::from);
        0.2126 * r + 0.7152 * g + 0.0722 * b
    }

    /// Contrast ratio of two colours, 1 to 21 [WCAG 2.2].
    pub fn contrast(self, other: Self) -> f64 {
        let (a, b) = (self.luminance(), other.luminance());
        (a.max(b) + 0.05) / (a.min(b) + 0.05)
    }
}

/// Linear light of an sRGB value, 0 to 1 [IEC 61966-2-1].
fn decode(v: f32) -> f32 {
    if v <= 0.040_45 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) }
}

/// sRGB value of linear light, 0 to 1 [IEC 61966-2-1].
fn encode(v: f32) -> f32 {
    if v <= 0.003_130_8 { v * 12.92 } else { 1.055 * v.powf(1.0 / 2.4) - 0.055 }
}

/// Table that converts linear light to 8-bit sRGB.
pub(super) struct Encoder(Vec<u8>);

impl Encoder {
    const STEPS: usize = 4096;

    pub fn new() -> Self {
        let step = |i: usize| (255.0 * encode(i as f32 / Self::STEPS as f32)).round() as u8;
        Self((0..=Self::STEPS).map(step).collect())
    }

    pub fn encode(&self, linear: [f32; 3]) -> [u8; 3] {
        let [r, g, b] = linear;
        let level = |v: f32| self.0[(v.clamp(0.0, 1.0) * Self::STEPS as f32) as usize];
        [level(r), level(g), level(b)]
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColourMap {
    /// Blue, near white in the middle, orange. For values on both sides of a centre.
    Diverging,
    /// Near white to orange and brown. For values that are mostly zero, and matter where they are not.
    Rising,
    /// Dark violet over teal to yellow, with steadily rising lightness. For values from low to high.
    Sequential,
}

impl ColourMap {
    fn stops(self) -> &'static [Rgb] {
        const DIVERGING: [Rgb; 9] = [
            Rgb(0x0b, 0x3c, 0x7d),
            Rgb(0x2b, 0x6c, 0xb0),
            Rgb(0x6f, 0xa3, 0xd4),
            Rgb(0xb5, 0xd0, 0xea),
            Rgb(0xf4, 0xf1, 0xea),
            Rgb(0xf7, 0xcf, 0x9d),
            Rgb(0xec, 0x9a, 0x4a),
            Rgb(0xc9, 0x61, 0x12),
            Rgb(0x85, 0x34, 0x03),
        ];
        const SEQUENTIAL: [Rgb; 7] = [
            Rgb(0x3b, 0x14, 0x5c),
            Rgb(0x3f, 0x42, 0x87),
            Rgb(0x2f, 0x6c, 0x8e),
            Rgb(0x21, 0x91, 0x8c),
            Rgb(0x44, 0xb5, 0x72),
            Rgb(0xa5, 0xd4, 0x3a),
            Rgb(0xfc, 0xe4, 0x3c),
        ];
        match self {
            Self::Diverging => &DIVERGING,
            Self::Rising => &DIVERGING[4..],
            Self::Sequential => &SEQUENTIAL,
        }
    }

    /// Colour at `t`, from 0 to 1; beyond, the colour of the nearer end.
    pub fn at(self, t: f64) -> Rgb {
        let stops = self.stops();
        let place = t.clamp(0.0, 1.0) * (stops.len() - 1) as f64;
        let below = (place as usize).min(stops.len() - 2);
        let (a, b, f) = (stops[below], stops[below + 1], place - below as f64);
        let mix = |a: u8, b: u8| (f64::from(a) + f * (f64::from(b) - f64::from(a))).round() as u8;
        Rgb(mix(a.0, b.0), mix(a.1, b.1), mix(a.2, b.2))
    }
}

/// Mapping of values to colours, the same for a whole study so that its pictures are comparable.
#[derive(Clone, Debug, PartialEq)]
pub struct Scale {
    pub map: ColourMap,
    pub low: f64,
    pub high: f64,
    /// Quantity, such as `stretch along the warp`.
    pub label: String,
    /// Unit in the legend; empty for a quantity without one.
    pub unit: String,
}

impl Scale {
    pub fn diverging(centre: f64, reach: f64, label: impl Into<String>, unit: impl Into<String>) -> Self {
        let (low, high) = (centre - reach, centre + reach);
        Self { map: ColourMap::Diverging, low, high, label: label.into(), unit: unit.into() }
    }

    /// Scale from near white to brown, from 0 to `high`.
    pub fn rising(high: f64, label: impl Into<String>, unit: impl Into<String>) -> Self {
        Self { map: ColourMap::Rising, low: 0.0, high, label: label.into(), unit: unit.into() }
    }

    pub fn sequential(low: f64, high: f64, label: impl Into<String>, unit: impl Into<String>) -> Self {
        Self { map: ColourMap::Sequential, low, high, label: label.into(), unit: unit.into() }
    }

    /// Returns mid grey for NaN.
    pub fn colour(&self, value: f64) -> Rgb {
        let t = (value - self.low) / (self.high - self.low);
        if t.is_finite() { self.map.at(t) } else { Rgb(0x9a, 0x9a, 0x9a) }
    }
}

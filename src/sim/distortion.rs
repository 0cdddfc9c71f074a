//! Distortion of a drape: the stretch of the cloth beyond its pattern, and a decision on it (the controlling scheme of
//! [T 7.2.1]).
//!
//! A garment that is too small still closes in FEM-GS, under whatever tension that takes. The measure is a quantile of
//! the greater principal stretch over the area of the cloth: the value that 1 % of the area exceeds. Single triangles
//! at a corner or at the tip of a dart do not reach that area. A strip over the hips does.

mod measure;

use pattern::Spot;

geom::constants! {
    "distortion",
    /// Share of the area that may be stretched by more than the measure.
    pub const SHARE: f64 = 0.01;
}

/// Stretch of a garment, with its place on the pattern.
#[derive(Clone, Debug, PartialEq)]
pub struct Distortion {
    /// Principal stretch less 1 that [`SHARE`] of the area exceeds.
    pub stretch: f64,
    /// Piece that holds most of the area above it, and the centroid of that area.
    pub most_of_it: Spot,
}

impl std::fmt::Display for Distortion {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let (share, percent) = (100.0 * SHARE, 100.0 * self.stretch);
        let spot = &self.most_of_it;
        write!(f, "{share} % of the cloth is stretched by more than {percent:.1} %, most of it in {spot}")
    }
}

//! Geometry shared by all stages: vectors, triangle meshes, polylines, plane sections, distance fields.
//!
//! World frame: metres, origin on the floor between the feet, `x` to the subject's right, `y` to the front, `z` up.

pub mod constants;
pub mod contour;
pub mod crossing;
pub mod field;
pub mod hull;
pub mod mesh;
pub mod polyline;
pub mod section;
pub mod shapes;
pub mod surface;
pub mod triangle;
pub mod units;
pub mod winding;

pub use field::DistanceField;
pub use mesh::TriMesh;
pub use surface::Surface;

/// A point or vector of the plane, m.
pub type V2 = nalgebra::Vector2<f64>;
/// A point or vector of space, m.
pub type V3 = nalgebra::Vector3<f64>;

/// Cubic smooth step `3 t^2 - 2 t^3`, with zero slope at 0 and 1. `t` is clamped to 0..=1.
pub fn smooth_step(t: f64) -> f64 {
    let t = t.clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

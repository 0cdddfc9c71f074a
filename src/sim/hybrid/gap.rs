//! How much a garment lacks where it does not close around the body: the message of Hybrid-GS to its user.

use crate::body::Body;
use crate::geom::section::{Outline, Plane, section};
use crate::geom::hull::tape_girth;
use crate::geom::{TriMesh, V3};
use crate::pattern::{Garment, Role};
use crate::sim::sewing;
use crate::units::from_mm;

/// Girth of a draped garment beside that of the body, at a level of the body.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Closure {
    /// Body level (`chest`, `hip`, ...).
    pub level: String,
    /// Height at which the garment was measured, m.
    pub height_m: f64,
    /// Girth of the body at the level, m.
    pub body_girth_m: f64,
    /// Length of the cloth round the trunk, m.
    pub garment_girth_m: f64,
}

impl Closure {
    /// By how much the garment fails to close around the body, m: negative where it is larger.
    #[must_use]
    pub fn shortfall_m(&self) -> f64 {
        self.body_girth_m - self.garment_girth_m
    }
}

/// The trunk of a garment may be open at the chest (an armhole): it is then measured at most this far below, m.
const DOWN_M: f64 = 0.15;
/// In steps of this, m.
const STEP_M: f64 = 0.005;

/// Girths at each level of the body that the garment goes round; positions in m.
#[must_use]
pub fn closures(body: &Body, garment: &Garment, positions: &[V3]) -> Vec<Closure> {
    let trunk = trunk(garment, positions);
    let corners = trunk.triangles.iter().flatten().map(|&v| trunk.positions[v].z);
    let top_m = corners.fold(f64::MIN, f64::max);
    let closure = |(name, height_m, girth_mm, down_m): (&str, f64, f64, f64)| {
        let heights = (0..=(down_m / STEP_M) as usize).map(|k| height_m - k as f64 * STEP_M);
        let girth = heights.filter(|z| *z < top_m).find_map(|z| Some((z, girth_at(&trunk, z)?)));
        let (height_m, garment_girth_m) = girth.filter(|_| height_m < top_m)?;
        Some(Closure { level: name.to_owned(), height_m, body_girth_m: from_mm(girth_mm), garment_girth_m })
    };
    let (levels, girths) = (&body.levels, &body.girths);
    let levels = [
        ("chest", levels.chest_m, girths.chest_girth_mm, DOWN_M),
        ("underbust", levels.underbust_m, girths.underbust_girth_mm, 0.0),
        ("waist", levels.waist_m, girths.waist_girth_mm, 0.0),
        ("hip", levels.hip_m, girths.hip_girth_mm, 0.0),
    ];
    levels.into_iter().filter_map(closure).collect()
}

/// What covers the trunk, sewn: everything but sleeves.
fn trunk(garment: &Garment, positions: &[V3]) -> TriMesh {
    let sewn = sewing::welded(garment);
    let pieces = garment.pieces.iter().filter(|p| !matches!(p.role, Role::SleeveRight | Role::SleeveLeft));
    let triangles = pieces.flat_map(|p| &garment.triangles[p.triangles.clone()]).map(|t| t.map(|v| sewn[v]));
    let mut mesh = TriMesh { positions: positions.to_vec(), triangles: triangles.collect() };
    for (&v, p) in sewn.iter().zip(positions) {
        mesh.positions[v] = *p;
    }
    mesh
}

/// Girth of the cloth round the body's axis at a height, as a tape reads it, m: like that of the body, without folds.
fn girth_at(trunk: &TriMesh, z: f64) -> Option<f64> {
    let round = |outline: &Outline| {
        let (low, high) = outline.bounds();
        outline.closed && low.x < 0.0 && high.x > 0.0
    };
    section(trunk, &Plane::horizontal(z)).iter().filter(|o| round(o)).map(|o| tape_girth(&o.points)).max_by(f64::total_cmp)
}

//! How much a garment lacks where it does not close around the body: the message of Hybrid-GS to its user.

use crate::body::Body;
use crate::geom::section::{Outline, Plane, section};
use crate::geom::{TriMesh, V2, V3};
use crate::pattern::{Garment, Role};
use crate::sim::sewing;
use crate::units::from_mm;

/// Girth of a draped garment beside that of the body, at one of the style's fit levels.
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

/// The trunk of a garment may be open at a level (an armhole): it is then measured at most this far below, m.
const DOWN_M: f64 = 0.25;
/// In steps of this, m.
const STEP_M: f64 = 0.005;

/// Girths at the garment's fit levels whose height on the body is known; positions in m.
#[must_use]
pub fn closures(body: &Body, garment: &Garment, positions: &[V3]) -> Vec<Closure> {
    let trunk = trunk(garment, positions);
    let levels = garment.fit_levels.iter().filter_map(|fit| Some((&fit.level, level(body, &fit.level)?)));
    levels
        .filter_map(|(name, (height_m, body_girth_m))| {
            let heights = (0..(DOWN_M / STEP_M) as usize).map(|k| height_m - k as f64 * STEP_M);
            let (height_m, garment_girth_m) = heights.into_iter().find_map(|z| Some((z, girth_at(&trunk, z)?)))?;
            Some(Closure { level: name.clone(), height_m, body_girth_m, garment_girth_m })
        })
        .collect()
}

/// Height and girth of a body level, m.
fn level(body: &Body, name: &str) -> Option<(f64, f64)> {
    let (height_m, girth_mm) = match name {
        "chest" | "bust" => (body.levels.chest_m, body.girths.chest_girth_mm),
        "underbust" => (body.levels.underbust_m, body.girths.underbust_girth_mm),
        "waist" => (body.levels.waist_m, body.girths.waist_girth_mm),
        "hip" => (body.levels.hip_m, body.girths.hip_girth_mm),
        _ => return None,
    };
    Some((height_m, from_mm(girth_mm)))
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

/// Length of the closed outline in which a horizontal plane cuts cloth round the body's axis, m.
fn girth_at(trunk: &TriMesh, z: f64) -> Option<f64> {
    let length = |outline: &Outline| -> f64 {
        let next = outline.points.iter().cycle().skip(1);
        outline.points.iter().zip(next).map(|(a, b): (&V2, &V2)| (b - a).norm()).sum()
    };
    let round = |outline: &Outline| {
        let (low, high) = outline.bounds();
        outline.closed && low.x < 0.0 && high.x > 0.0
    };
    section(trunk, &Plane::horizontal(z)).iter().filter(|o| round(o)).map(length).max_by(f64::total_cmp)
}

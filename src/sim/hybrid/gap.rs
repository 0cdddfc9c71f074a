//! How much a garment lacks where it does not close around the body: the message of Hybrid-GS to its user.

use super::features::face;
use super::ring;
use super::sewn::Sewn;
use crate::sewing;
use body::{Body, Dimension};
use geom::hull::tape_girth;
use geom::section::{Outline, Plane, section};
use geom::{TriMesh, V3};
use pattern::garment::SeamMesh;
use pattern::{Garment, PieceMesh, Role};

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

/// Girths at each level of the body that the garment goes round; positions in m.
///
/// Where the style says which line of the pattern goes round a level, the drape is measured along that line, wherever it lies:
/// a plane would cut the cloth along another one. Otherwise it is the length of the cloth from underarm to underarm at the
/// chest, where a level plane would cut armholes, and what a tape reads at the other levels.
#[must_use]
pub fn closures(body: &Body, garment: &Garment, positions: &[V3]) -> Vec<Closure> {
    let trunk = trunk(garment, positions);
    let (levels, girths) = (&body.levels, &body.girths);
    let at = |z: f64| Some((z, girth_at(&trunk, z)?));
    let closure = |(name, found, around): (&str, Option<(f64, f64)>, Dimension)| {
        let (height_m, garment_girth_m) = along_fit_line(garment, name, positions).or(found)?;
        Some(Closure { level: name.to_owned(), height_m, body_girth_m: girths.get(around)?, garment_girth_m })
    };
    let levels = [
        ("chest", at_underarm(garment, positions).or_else(|| at(levels.chest_m)), Dimension::ChestGirth),
        ("underbust", at(levels.underbust_m), Dimension::UnderbustGirth),
        ("waist", at(levels.waist_m), Dimension::WaistGirth),
        ("hip", at(levels.hip_m), Dimension::HipGirth),
    ];
    levels.into_iter().filter_map(closure).collect()
}

/// Mean height and length of the line that the style gives for a level, m; `None` where it gives none on the cloth.
fn along_fit_line(garment: &Garment, level: &str, positions: &[V3]) -> Option<(f64, f64)> {
    let runs = &garment.fit_levels.iter().find(|fit| fit.level == level)?.runs;
    let heights: Vec<f64> = runs.iter().flat_map(|run| &run.points).map(|point| point.at(positions).z).collect();
    let length_m = runs.iter().map(|run| run.length_m(&garment.rest, positions)).sum();
    (!heights.is_empty()).then(|| (heights.iter().sum::<f64>() / heights.len() as f64, length_m))
}

/// Height of the underarms and length of the cloth between them, front and back, m; `None` for garments without, and where the line does
/// not go all the way round, as below the neckline of a top without straps.
fn at_underarm(garment: &Garment, positions: &[V3]) -> Option<(f64, f64)> {
    ring::at_underarm(garment, &Sewn::at(garment, positions)).first()?;
    let underarms = underarms(garment);
    let length = |(piece, v): &(&PieceMesh, usize)| across_m(garment, piece, garment.rest[*v].y, positions);
    let length_m = underarms.iter().map(length).sum();
    let heights = underarms.iter().map(|(_, v)| positions[*v].z);
    (!underarms.is_empty()).then(|| (heights.sum::<f64>() / underarms.len() as f64, length_m))
}

/// Fronts and backs of a top with their underarms: the upper end of the side seam. None where one of them has no side.
pub fn underarms(garment: &Garment) -> Vec<(&PieceMesh, usize)> {
    let is_top = |p: &&PieceMesh| matches!(p.role, Role::Front | Role::Back | Role::BodiceFront | Role::BodiceBack);
    let tops: Vec<&PieceMesh> = garment.pieces.iter().filter(is_top).collect();
    let of = |v: usize| tops.iter().find(|p| p.vertices.contains(&v)).map(|p| face(p.role));
    // Front to back, upright: the sides.
    let is_side = |seam: &&SeamMesh| {
        let (Some(first), Some(last)) = (seam.pairs.first(), seam.pairs.last()) else { return false };
        let chord = garment.rest[last[0]] - garment.rest[first[0]];
        let faces = first.map(of);
        faces.iter().all(Option::is_some) && faces[0] != faces[1] && chord.y.abs() > chord.x.abs()
    };
    let sides: Vec<usize> =
        garment.seams.iter().filter(is_side).flat_map(|s| s.pairs.iter().flatten().copied()).collect();
    let underarm = |piece: &&PieceMesh| {
        let own = sides.iter().copied().filter(|v| piece.vertices.contains(v));
        own.max_by(|&a, &b| garment.rest[a].y.total_cmp(&garment.rest[b].y))
    };
    tops.iter().map(|piece| Some((*piece, underarm(piece)?))).collect::<Option<Vec<_>>>().unwrap_or_default()
}

/// Length in space of the line at height `v` across a piece, m.
fn across_m(garment: &Garment, piece: &PieceMesh, v: f64, positions: &[V3]) -> f64 {
    let cut = |t: &[usize; 3]| -> f64 {
        let ends: Vec<V3> = (0..3)
            .filter_map(|k| {
                let (a, b) = (t[k], t[(k + 1) % 3]);
                let (below, above) = (garment.rest[a].y - v, garment.rest[b].y - v);
                ((below < 0.0) != (above < 0.0)).then(|| positions[a].lerp(&positions[b], below / (below - above)))
            })
            .collect();
        if let [a, b] = ends.as_slice() { (b - a).norm() } else { 0.0 }
    };
    garment.triangles[piece.triangles.clone()].iter().map(cut).sum()
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
    section(trunk, &Plane::horizontal(z))
        .iter()
        .filter(|o| round(o))
        .map(|o| tape_girth(&o.points))
        .max_by(f64::total_cmp)
}

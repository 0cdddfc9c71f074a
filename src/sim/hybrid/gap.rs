//! Shortfall of a garment's girths against those of the body, which Hybrid-GS reports instead of stretched cloth.

use super::girth_lines;
use super::underarms::underarms;
use super::welded_mesh::Sewn;
use crate::sewing;
use body::{Body, Dimension};
use geom::hull::tape_girth;
use geom::section::{Outline, Plane, section};
use geom::{TriMesh, V3};
use pattern::{Garment, PieceMesh, Role};

#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Closure {
    /// `chest`, `hip`, ...
    pub level: String,
    pub height_m: f64,
    pub body_girth_m: f64,
    /// Length of the cloth round the trunk.
    pub garment_girth_m: f64,
}

impl Closure {
    /// Negative where the garment is larger.
    pub fn shortfall_m(&self) -> f64 {
        self.body_girth_m - self.garment_girth_m
    }
}

/// Girths at each level of the body that the garment goes round.
///
/// If the style names the line of the pattern that goes round a level, the drape is measured along it, wherever it
/// lies: a plane would cut the cloth along another line. Else the chest is measured from underarm to underarm, because
/// a level plane would cut the armholes, and the other levels as a tape reads them.
pub fn closures(body: &Body, garment: &Garment, positions: &[V3]) -> Vec<Closure> {
    let trunk = trunk(garment, positions);
    let (levels, girths) = (&body.levels, &body.girths);
    let taped = |z: f64| Some(Girth { height_m: z, length_m: girth_m(&trunk, z)? });
    let closure = |(name, found, around): (&str, Option<Girth>, Dimension)| {
        let Girth { height_m, length_m } = along_fit_line(garment, name, positions).or(found)?;
        let body_girth_m = girths.get(around)?;
        Some(Closure { level: name.to_owned(), height_m, body_girth_m, garment_girth_m: length_m })
    };
    let levels = [
        ("chest", at_underarm(garment, positions).or_else(|| taped(levels.chest_m)), Dimension::ChestGirth),
        ("underbust", taped(levels.underbust_m), Dimension::UnderbustGirth),
        ("waist", taped(levels.waist_m), Dimension::WaistGirth),
        ("hip", taped(levels.hip_m), Dimension::HipGirth),
    ];
    levels.into_iter().filter_map(closure).collect()
}

struct Girth {
    height_m: f64,
    length_m: f64,
}

/// Line that the style names for a level; `None` where it names none on the cloth.
fn along_fit_line(garment: &Garment, level: &str, positions: &[V3]) -> Option<Girth> {
    let runs = &garment.fit_levels.iter().find(|fit| fit.level == level)?.runs;
    let heights: Vec<f64> = runs.iter().flat_map(|run| &run.points).map(|point| point.at(positions).z).collect();
    let length_m = runs.iter().map(|run| run.length_m(&garment.rest, positions)).sum();
    let height_m = || heights.iter().sum::<f64>() / heights.len() as f64;
    (!heights.is_empty()).then(|| Girth { height_m: height_m(), length_m })
}

/// Line from underarm to underarm, front and back. `None` for a garment without underarms, and where the line does not
/// close, as below the neckline of a top without straps.
fn at_underarm(garment: &Garment, positions: &[V3]) -> Option<Girth> {
    girth_lines::at_underarm(garment, &Sewn::at(garment, positions)).first()?;
    let underarms = underarms(garment);
    let length = |(piece, v): &(&PieceMesh, usize)| across_m(garment, piece, garment.rest[*v].y, positions);
    let length_m = underarms.iter().map(length).sum();
    let heights = underarms.iter().map(|(_, v)| positions[*v].z);
    let height_m = heights.sum::<f64>() / underarms.len() as f64;
    (!underarms.is_empty()).then_some(Girth { height_m, length_m })
}

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

/// All pieces but sleeves, sewn.
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

/// Girth about the body's axis at a height, as a tape reads it: without folds, as for the body.
fn girth_m(trunk: &TriMesh, z: f64) -> Option<f64> {
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

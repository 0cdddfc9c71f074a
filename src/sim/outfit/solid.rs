//! A body with cloth on it as one solid, over which more is worn.

use super::Layer;
use crate::{SimError, sewing};
use body::Body;
use geom::contour::{Grid, contour};
use geom::winding::Winding;
use geom::{DistanceField, Surface, TriMesh, V3};

geom::constants! {
    "outfit.solid",
    /// Distance from the cloth at which the solid ends, m: contact begins at two thirds of it.
    const SKIN_M: f64 = 3e-3;
    /// Edge of the cells in which the solid is sought, m.
    const CELL_M: f64 = 8e-3;
    /// Edge of the cells of its distance field, m.
    const FIELD_M: f64 = 5e-3;
    /// Distance beyond which only the side matters, m.
    const NEAR_M: f64 = 0.02;
    /// How fast the side changes with the winding number, where an opening is bridged.
    const SHARPNESS: f64 = 4.0;
}

/// A body with layers on it, their vertices at `positions`, as a body of its own, and its field: what is between cloth and skin is solid.
///
/// # Errors
/// When the layers have no triangle, or the solid cannot be built.
pub fn dressed(
    (body, field): (&Body, &DistanceField),
    layers: &[Layer],
    positions: &[Vec<V3>],
) -> Result<(Body, DistanceField), SimError> {
    let cloth = cloth(layers, positions)?;
    let (surface, winding) = (Surface::new(&cloth).map_err(SimError::Solid)?, Winding::new(&cloth));
    let bounds = |mesh: &TriMesh| mesh.bounds().unwrap_or_default();
    let ((low, high), (lowest, highest)) = (bounds(&cloth), bounds(&body.mesh));
    let reach = V3::repeat(SKIN_M + CELL_M);
    let (low, high) = (low - reach, high + reach);
    let grid = grid(low.inf(&(lowest - reach)), high.sup(&(highest + reach)));
    let value = |p: V3| {
        let bare_m = field.value_and_gradient(&p).0;
        if bare_m < -CELL_M || (p - low).min() < 0.0 || (high - p).min() < 0.0 {
            return bare_m;
        }
        let (distance_m, _) = surface.nearest_within(&p, NEAR_M);
        let side = (SHARPNESS * (0.5 - winding.number(p))).clamp(-1.0, 1.0);
        bare_m.min(side * distance_m - SKIN_M)
    };
    let [nx, ny, nz] = grid.counts();
    let nodes = (0..nz).flat_map(|k| (0..ny).flat_map(move |j| (0..nx).map(move |i| [i, j, k])));
    let values: Vec<f64> = nodes.map(|at| value(grid.node(at))).collect();
    let quads = contour(&grid, &values);
    let triangles = quads.quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    let mesh = TriMesh { positions: quads.positions, triangles };
    let field = DistanceField::build(&mesh, FIELD_M).map_err(SimError::Solid)?;
    Ok((Body { mesh, ..body.clone() }, field))
}

/// All layers, sewn, as one mesh.
fn cloth(layers: &[Layer], positions: &[Vec<V3>]) -> Result<TriMesh, SimError> {
    let mut all = TriMesh::default();
    for (layer, positions) in layers.iter().zip(positions) {
        let garment = layer.finest()?;
        let vertex_of = sewing::welded(garment);
        let first = all.positions.len();
        all.triangles.extend(garment.triangles.iter().map(|t| t.map(|v| first + vertex_of[v])));
        all.positions.extend(sewing::merged(&vertex_of, positions));
    }
    Ok(all)
}

/// Cells about a box, with a node in its middle plane across x: what is mirrored has the mirrored solid.
fn grid(low: V3, high: V3) -> Grid {
    let axis = |low: f64, high: f64| {
        let half = (0.5 * (high - low) / CELL_M).ceil() as i32 + 1;
        (-half..=half).map(|n| 0.5 * (low + high) + f64::from(n) * CELL_M).collect()
    };
    Grid { axes: [axis(low.x, high.x), axis(low.y, high.y), axis(low.z, high.z)] }
}

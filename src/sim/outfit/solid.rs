//! A body with cloth on it as one solid, over which more is worn.

use super::Layer;
use crate::{SimError, sewing};
use body::Body;
use geom::contour::{Grid, contour};
use geom::winding::Winding;
use geom::{DistanceField, Surface, TriMesh, V3};
use pattern::Role;

geom::constants! {
    "outfit.solid",
    /// Edge of the cells in which the solid is sought, m: a flap of cloth, twice as thick as the distance at which more is worn over it, has
    /// nodes within.
    const CELL_M: f64 = 5e-3;
    /// Distance from the middle of a block of cells beyond which all of them are on one side, m.
    const BLOCK_M: f64 = 0.025;
    /// Edge of the cells of its distance field, m.
    const FIELD_M: f64 = 5e-3;
    /// Distance beyond which only the side matters, m.
    const NEAR_M: f64 = 0.02;
    /// How fast the side changes with the winding number, where an opening is bridged.
    const SHARPNESS: f64 = 4.0;
    /// Cells along the edge of a block.
    const BLOCK: usize = 4;
}

/// A body with layers on it, their vertices at `positions`, as a body of its own, and its field: what is between cloth and skin is solid,
/// and so much beyond the cloth as is given, m.
///
/// # Errors
/// When the layers have no triangle, or the solid cannot be built.
pub fn dressed(
    (body, field): (&Body, &DistanceField),
    layers: &[Layer],
    positions: &[Vec<V3>],
    beyond_m: f64,
) -> Result<(Body, DistanceField), SimError> {
    let cloth = cloth(layers, positions, |_| true)?;
    let (surface, winding) = (Surface::new(&cloth).map_err(SimError::Solid)?, Winding::new(&cloth));
    let bounds = |mesh: &TriMesh| mesh.bounds().unwrap_or_default();
    let ((low, high), (lowest, highest)) = (bounds(&cloth), bounds(&body.mesh));
    let reach = V3::repeat(beyond_m + CELL_M);
    let (low, high) = (low - reach, high + reach);
    let grid = grid(low.inf(&(lowest - reach)), high.sup(&(highest + reach)));
    let side = |p: V3| (SHARPNESS * (0.5 - winding.number(p))).clamp(-1.0, 1.0);
    let [nx, ny, nz] = grid.counts();
    let blocks = [nx, ny, nz].map(|count| count.div_ceil(BLOCK));
    // Of each block of nodes that is far from the cloth, its side.
    let mut far: Vec<Option<Option<f64>>> = vec![None; blocks.iter().product()];
    let mut value = |at: [usize; 3]| {
        let p = grid.node(at);
        let bare_m = field.value_and_gradient(&p).0;
        if bare_m < -CELL_M || (p - low).min() < 0.0 || (high - p).min() < 0.0 {
            return bare_m;
        }
        let [i, j, k] = at.map(|n| n / BLOCK);
        let block = &mut far[i + blocks[0] * (j + blocks[1] * k)];
        let side_of_block = *block.get_or_insert_with(|| {
            let middle = at.map(|n| n - n % BLOCK);
            let from = grid.node(middle) + V3::repeat(0.5 * CELL_M * (BLOCK - 1) as f64);
            let is_far = surface.nearest_within(&from, BLOCK_M).1.is_none();
            is_far.then(|| side(from))
        });
        let (side, distance_m) = match side_of_block {
            Some(side) => (side, NEAR_M),
            None => (side(p), surface.nearest_within(&p, NEAR_M).0),
        };
        bare_m.min(side * distance_m - beyond_m)
    };
    let nodes = (0..nz).flat_map(|k| (0..ny).flat_map(move |j| (0..nx).map(move |i| [i, j, k])));
    let values: Vec<f64> = nodes.map(&mut value).collect();
    let quads = contour(&grid, &values);
    let triangles = quads.quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    let mesh = TriMesh { positions: quads.positions, triangles };
    let field = DistanceField::build(&mesh, FIELD_M).map_err(SimError::Solid)?;
    let is_on_trunk = |role: Role| !matches!(role, Role::SleeveRight | Role::SleeveLeft);
    let on_trunk = self::cloth(layers, positions, is_on_trunk)?;
    Ok((body.enclosed(mesh, &on_trunk), field))
}

/// The pieces of all layers whose roles are wanted, sewn, as one mesh.
fn cloth(layers: &[Layer], positions: &[Vec<V3>], is_wanted: impl Fn(Role) -> bool) -> Result<TriMesh, SimError> {
    let mut all = TriMesh::default();
    for (layer, positions) in layers.iter().zip(positions) {
        let garment = layer.finest()?;
        let vertex_of = sewing::welded(garment);
        let first = all.positions.len();
        for piece in garment.pieces.iter().filter(|piece| is_wanted(piece.role)) {
            let own = &garment.triangles[piece.triangles.clone()];
            all.triangles.extend(own.iter().map(|t| t.map(|v| first + vertex_of[v])));
        }
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

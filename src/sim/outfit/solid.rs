//! A body with cloth on it as one solid, on which the next layer is draped.

use std::collections::BTreeMap;

use super::{Layer, Wearer};
use crate::{SimError, sewing};
use body::Body;
use geom::winding::Winding;
use geom::{DistanceField, Surface, TriMesh, V3};
use pattern::Role;

geom::constants! {
    "outfit.solid",
    /// Distance beyond which only the side matters.
    const NEAR_M: f64 = 0.02;
    /// Cells along the edge of a block whose side one winding number may decide.
    const BLOCK: usize = 4;
    /// Slope of the side over the winding number, where an opening is bridged.
    const SHARPNESS: f64 = 4.0;
    /// Distance from the middle of a block to its corners over its edge: half its diagonal, and a margin.
    const TO_CORNER: f64 = 0.9;
}

/// Body with layers on it as a body of its own. The field has the nodes of the body's own and more. All space between
/// cloth and skin is solid, and so are `beyond_m` outside the cloth. A single layer of cloth is resolved where that is
/// no less than the field's spacing.
pub fn dressed(
    Wearer { body, field }: Wearer,
    layers: &[Layer],
    positions: &[Vec<V3>],
    beyond_m: f64,
) -> Result<(Body, DistanceField), SimError> {
    let cloth = cloth(layers, positions, |_| true)?;
    let (low, high) = cloth.bounds().unwrap_or_default();
    let reach = V3::repeat(beyond_m + NEAR_M);
    let field = field.widened(low - reach, high + reach);
    let mut about = About::new(&cloth, field.spacing_m())?;
    let nodes = field.nodes_within(low - reach, high + reach);
    let outside = nodes.filter(|(_, _, bare_m)| *bare_m > -field.spacing_m());
    let changes: Vec<(usize, f64)> =
        outside.map(|(node, p, bare_m)| (node, bare_m.min(about.signed_m(p) - beyond_m))).collect();
    let mesh = field.with(changes.into_iter()).surface();
    // Inside, the nodes have the sign and no distance yet. Cloth that starts there needs a gradient to find the way
    // out.
    let field = DistanceField::build(&mesh, field.spacing_m()).map_err(SimError::Solid)?;
    let is_on_trunk = |role: Role| !matches!(role, Role::SleeveRight | Role::SleeveLeft);
    let on_trunk = self::cloth(layers, positions, is_on_trunk)?;
    Ok((body.enclosed(mesh, &on_trunk), field))
}

struct About {
    surface: Surface,
    winding: Winding,
    block_m: f64,
    /// Blocks of nodes asked for so far, each with its side where it is far from the cloth.
    blocks: BTreeMap<[i64; 3], Option<f64>>,
}

impl About {
    fn new(cloth: &TriMesh, spacing_m: f64) -> Result<Self, SimError> {
        let surface = Surface::new(cloth).map_err(SimError::Solid)?;
        Ok(Self { surface, winding: Winding::new(cloth), block_m: spacing_m * BLOCK as f64, blocks: BTreeMap::new() })
    }

    /// Side by the winding number: 1 before the cloth, -1 behind it, in between near an opening.
    fn side(&self, p: V3) -> f64 {
        (SHARPNESS * (0.5 - self.winding.number(p))).clamp(-1.0, 1.0)
    }

    /// Negative behind the cloth; up to [`NEAR_M`].
    fn signed_m(&mut self, p: V3) -> f64 {
        let block = [0, 1, 2].map(|k| (p[k] / self.block_m).floor() as i64);
        let side_of_block = match self.blocks.get(&block) {
            Some(side) => *side,
            None => {
                let middle = V3::from_fn(|k, _| (block[k] as f64 + 0.5) * self.block_m);
                let is_far = self.surface.nearest_within(&middle, TO_CORNER * self.block_m + NEAR_M).1.is_none();
                let side = is_far.then(|| self.side(middle));
                self.blocks.insert(block, side);
                side
            }
        };
        match side_of_block {
            Some(side) => side * NEAR_M,
            None => self.side(p) * self.surface.nearest_within(&p, NEAR_M).0,
        }
    }
}

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

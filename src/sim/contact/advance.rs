//! Whether two parts of the cloth meet on the straight way from one place to another.

use super::nearest::{Nearest, Primitives};
use crate::geom::V3;

/// Share of its distance that a pair keeps on its way at least.
const KEPT: f64 = 0.1;
/// Share of the distance that is gone at once.
const ADVANCE: f64 = 0.9;
/// Most advances: a pair that takes more glides along so near that it may as well be said to meet.
const MOST_ADVANCES: usize = 40;

/// Whether a pair comes nearer than a tenth of its distance on the way from `x` to `y`, its vertices moving evenly: by
/// conservative advancement, which goes on by as much as cannot use the distance up [Li 2021]. A pair that touches already
/// has nothing to keep.
#[must_use]
pub fn meets(x: &[V3], y: &[V3], primitives: Primitives) -> bool {
    let vertices = primitives.vertices();
    let mut at = vertices.map(|v| x[v]);
    let mut moves = vertices.map(|v| y[v] - x[v]);
    // What all have in common brings none nearer.
    let mean = moves.iter().sum::<V3>() / 4.0;
    moves.iter_mut().for_each(|d| *d -= mean);
    let [a, b, c, d] = moves.map(|d| d.norm());
    let closing = match primitives {
        Primitives::VertexTriangle(_) => a + b.max(c).max(d),
        Primitives::EdgeEdge(_) => a.max(b) + c.max(d),
    };
    let mut distance = Nearest::at(&at, primitives).gap.norm();
    if distance > closing || distance == 0.0 {
        return false;
    }
    let least = KEPT * distance;
    let mut time = 0.0;
    for _ in 0..MOST_ADVANCES {
        let advance = ADVANCE * (distance - least) / closing;
        time += advance;
        if time >= 1.0 {
            return false;
        }
        at.iter_mut().zip(&moves).for_each(|(p, d)| *p += d * advance);
        distance = Nearest::at(&at, primitives).gap.norm();
        if distance <= least + KEPT * least {
            return true;
        }
    }
    true
}

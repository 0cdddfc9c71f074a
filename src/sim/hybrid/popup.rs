//! Phase 3: pop-up (5.4). The sewn garment leaves the body's surface and takes its pattern's size.
//!
//! First the silhouette: every free edge grows radially to its length (5.4). Then the reconstruction, as rigid as possible
//! with the pattern as rest shape, under control of every measurement of the style.

use super::elastic::{Elastic, Pull};
use super::sewn::Sewn;
use crate::geom::V3;
use crate::pattern::{Garment, Measurement};

/// Steps of the reconstruction.
pub const STEPS: u32 = 20;
/// Weight of a control: that of a strip of cloth this wide along it, m.
pub const CONTROL_WIDTH_M: f64 = 0.5;
/// Weight of a vertex's own place, per area of cloth: it only keeps the garment from drifting, 1/m2.
const HOLD: f64 = 0.05;

/// Grows the free edges radially from their centres by `(L2D - L3D) / 2 pi` (5.4).
#[must_use]
pub fn restore_silhouette(garment: &Garment, sewn: &Sewn) -> Vec<V3> {
    let mut rest_of = std::collections::BTreeMap::new();
    for t in &garment.triangles {
        for k in 0..3 {
            let (a, b) = (t[k], t[(k + 1) % 3]);
            rest_of.insert([sewn.vertex_of[a], sewn.vertex_of[b]], (garment.rest[b] - garment.rest[a]).norm());
        }
    }
    let mut x = sewn.x.clone();
    for ring in &sewn.loops {
        let n = ring.len();
        let steps = || (0..n).map(|k| [ring[k], ring[(k + 1) % n]]);
        let drawn: f64 = steps().filter_map(|step| rest_of.get(&step)).sum();
        let now: f64 = steps().map(|[a, b]| (x[b] - x[a]).norm()).sum();
        let centre = ring.iter().map(|&v| x[v]).sum::<V3>() / n as f64;
        for &v in ring {
            let out = (x[v] - centre).try_normalize(1e-9).unwrap_or_else(V3::zeros);
            x[v] += out * ((drawn - now) / std::f64::consts::TAU);
        }
    }
    x
}

/// Rest areas that belong to the sewn vertices, m2.
#[must_use]
pub fn areas(garment: &Garment, sewn: &Sewn) -> Vec<f64> {
    let mut areas = vec![0.0; sewn.x.len()];
    for (t, sewn) in garment.triangles.iter().zip(&sewn.triangles) {
        let [a, b, c] = t.map(|v| garment.rest[v]);
        let area = 0.5 * (b - a).perp(&(c - a)).abs();
        for &v in sewn {
            areas[v] += area / 3.0;
        }
    }
    areas
}

/// Reconstructs the garment step by step; calls `each` with the positions after every step, which may end it early by
/// returning an error. `None` for a garment with triangles without area.
pub fn reconstruct<E>(
    garment: &Garment,
    sewn: &Sewn,
    x: Vec<V3>,
    controls: &[&Measurement],
    mut each: impl FnMut(&[V3]) -> Result<(), E>,
) -> Result<Option<Vec<V3>>, E> {
    let weights = areas(garment, sewn).iter().map(|a| a * HOLD).collect();
    let Some(mut elastic) = Elastic::new(garment, &sewn.vertex_of, &x, controls, CONTROL_WIDTH_M, &[], weights) else {
        return Ok(None);
    };
    let loads = vec![V3::zeros(); x.len()];
    let mut x = x;
    for step in 1..=STEPS {
        // The controls get to their length halfway, so that the cloth around them can follow.
        let share = (2.0 * f64::from(step) / f64::from(STEPS)).min(1.0);
        x = elastic.step(&x, &Pull { targets: &x, loads: &loads, share });
        each(&x)?;
    }
    Ok(Some(x))
}

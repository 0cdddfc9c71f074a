//! Pieces drawn together about the body by their seams: for garments that have no features on the body to be mapped
//! onto.
//!
//! The pieces start as [`crate::placement`] rolls them up: sheets bent about the trunk, cones and rings round it, tubes
//! about limbs. From there the seams draw them together a little at a time. The pieces keep their size, as rigid as
//! possible. The body pushes them out, and no cloth goes through other cloth. Of the fabric only its bending rigidity
//! enters, where it exceeds the least that folds need.

use super::relax::{Push, RelaxParams, Relaxation};
use super::welded_mesh::Sewn;
use crate::dressing::Wearer;
use crate::placement::{self, Bend, Folded};
use crate::walls::Walls;
use crate::{Fabric, SimError, quality, sewing};
use geom::V3;
use pattern::Garment;

geom::constants! {
    "hybrid.draw",
    /// Greatest displacement of a vertex in a step.
    const STRIDE_M: f64 = 8e-3;
    /// Length by which the sides of a seam are drawn nearer in a step at first.
    const CLOSER_M: f64 = 5e-3;
    /// Factor by which that grows where they come no nearer.
    const GROWTH: f64 = 1.5;
    const PATIENCE: u32 = 4;
    /// Length at which the seams are given up: an obstacle holds them open.
    const MOST_CLOSER_M: f64 = 1.0;
    /// Share of the least mean gap so far below which a gap counts as progress.
    const PROGRESS: f64 = 0.98;
    /// Weight of contact per area and over the membrane stiffness, 1/m2. Seams draw harder than gravity does.
    const CONTACT: f64 = 4000.0;
    const CLOSED_M: f64 = 3e-3;
    const STEPS: u32 = 400;
}

/// Places the pieces and draws their seams together; returns the positions of the vertices. Calls `each` with those of
/// every step, which may end it early with an error. Fails with [`SimError::Open`] where seams stay open.
pub fn together(
    wearer: Wearer,
    garment: &Garment,
    fabric: &Fabric,
    mut each: impl FnMut(&[V3]) -> Result<(), SimError>,
) -> Result<Vec<V3>, SimError> {
    let mut x = placement::place(wearer.body, garment, &Bend::default())?;
    if let Some(folded) = Folded::of(garment) {
        // Pieces that are folded onto the garment would slip under seams that are still open.
        let (under, kept) = garment.without(&folded.pieces);
        let own: Vec<V3> = kept.iter().map(|&v| x[v]).collect();
        let placed = x.clone();
        let whole = |drawn: &[V3]| {
            let mut all = placed.clone();
            kept.iter().zip(drawn).for_each(|(&v, p)| all[v] = *p);
            all
        };
        let drawn = draw(wearer, &under, fabric, own, |now| each(&whole(now)))?;
        x = whole(&drawn);
        folded.turn_up(garment, &mut x);
    }
    draw(wearer, garment, fabric, x, each)
}

fn draw(
    wearer: Wearer,
    garment: &Garment,
    fabric: &Fabric,
    x: Vec<V3>,
    mut each: impl FnMut(&[V3]) -> Result<(), SimError>,
) -> Result<Vec<V3>, SimError> {
    let pieces = Sewn::pieces(garment, &x);
    let vertex_of = sewing::welded(garment);
    let walls = Walls::new(wearer.body, garment, &vertex_of, &sewing::merged(&vertex_of, &x)).unsewn(&vertex_of);
    let params = RelaxParams { stride_m: STRIDE_M, contact: CONTACT, ..RelaxParams::default() };
    let mut relaxation =
        Relaxation::new(wearer.field, garment, &pieces, fabric, &[], walls, params)?.kept_apart(garment, &pieces);
    let (mut closer_m, mut least, mut stalled) = (CLOSER_M, f64::MAX, 0);
    for _ in 0..STEPS {
        relaxation.step(Push { firm: false, gravity: 0.0, share: 1.0, closer_m });
        each(&relaxation.x)?;
        if quality::seam_gap_m(garment, &relaxation.x) <= CLOSED_M {
            break;
        }
        let mean_m = mean_gap_m(garment, &relaxation.x);
        stalled += 1;
        if mean_m < PROGRESS * least {
            (least, stalled) = (mean_m, 0);
        }
        if stalled == PATIENCE {
            stalled = 0;
            closer_m *= GROWTH;
            if closer_m > MOST_CLOSER_M {
                break;
            }
        }
    }
    sewing::closed(garment, &relaxation.x)?;
    Ok(relaxation.x)
}

fn mean_gap_m(garment: &Garment, x: &[V3]) -> f64 {
    let gaps: Vec<f64> =
        garment.seams.iter().flat_map(|seam| &seam.pairs).map(|&[a, b]| (x[a] - x[b]).norm()).collect();
    gaps.iter().sum::<f64>() / gaps.len().max(1) as f64
}

//! Pieces that go round the body by themselves, drawn together: for garments whose kind has no features on the body to be mapped onto.
//!
//! The form is what the pattern's own pieces roll up to: sheets bent about the trunk, cones and rings round it, tubes about limbs
//! ([`crate::placement`]). From there the seams draw them together a little at a time. The pieces keep their size, as rigid as possible; the
//! body pushes them out, and no cloth goes through other cloth. Of the fabric only its bending enters, where that is stiffer than the least that
//! folds need.

use super::relax::{Push, RelaxParams, Relaxation};
use super::sewn::Sewn;
use crate::placement::{self, Bend, Folded};
use crate::walls::Walls;
use crate::{Fabric, SimError, quality, sewing};
use body::Body;
use geom::{DistanceField, V3};
use pattern::Garment;

geom::constants! {
    "hybrid.draw",
    /// How far a vertex goes in a step at most, m.
    const STRIDE_M: f64 = 8e-3;
    /// By how much the sides of a seam want to come nearer at first, m.
    const CLOSER_M: f64 = 5e-3;
    /// Factor by which they want to come nearer where they do not.
    const GROWTH: f64 = 1.5;
    /// Steps without progress after which they do.
    const PATIENCE: u32 = 4;
    /// Where that ends, m: something else holds the seam open.
    const MOST_CLOSER_M: f64 = 1.0;
    /// Share of the least mean gap so far that a smaller one has to be.
    const PROGRESS: f64 = 0.98;
    /// Weight of contact, per area and over the stiffness, 1/m2: seams draw harder than weight.
    const CONTACT: f64 = 4000.0;
    /// Gap with which all seams count as closed, m.
    const CLOSED_M: f64 = 3e-3;
    /// Steps at most.
    const STEPS: u32 = 400;
}

/// Positions of a garment's vertices, m, whose seams have been drawn together; calls `each` with those of every step, which ends it early
/// with an error.
///
/// # Errors
/// [`SimError::CannotPlace`], [`SimError::Degenerate`], [`SimError::Open`] where seams stay open, and those of `each`.
pub fn together(
    body: &Body,
    field: &DistanceField,
    garment: &Garment,
    fabric: &Fabric,
    mut each: impl FnMut(&[V3]) -> Result<(), SimError>,
) -> Result<Vec<V3>, SimError> {
    let mut x = placement::place(body, garment, &Bend::default())?;
    if let Some(folded) = Folded::of(garment) {
        // What is folded onto the garment would slip under what is still open.
        let (under, kept) = garment.without(&folded.pieces);
        let own: Vec<V3> = kept.iter().map(|&v| x[v]).collect();
        let placed = x.clone();
        let whole = |drawn: &[V3]| {
            let mut all = placed.clone();
            kept.iter().zip(drawn).for_each(|(&v, p)| all[v] = *p);
            all
        };
        let drawn = draw(body, field, &under, fabric, own, |now| each(&whole(now)))?;
        x = whole(&drawn);
        folded.turn_up(garment, &mut x);
    }
    draw(body, field, garment, fabric, x, each)
}

/// Draws all seams of pieces at `x` together.
fn draw(
    body: &Body,
    field: &DistanceField,
    garment: &Garment,
    fabric: &Fabric,
    x: Vec<V3>,
    mut each: impl FnMut(&[V3]) -> Result<(), SimError>,
) -> Result<Vec<V3>, SimError> {
    let pieces = Sewn::pieces(garment, &x);
    let vertex_of = sewing::welded(garment);
    let walls = Walls::new(body, garment, &vertex_of, &sewing::merged(&vertex_of, &x)).unsewn(&vertex_of);
    let params = RelaxParams { stride_m: STRIDE_M, contact: CONTACT, ..RelaxParams::default() };
    let mut relaxation =
        Relaxation::new(field, garment, &pieces, fabric, &[], walls, params)?.kept_apart(garment, &pieces);
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

/// Mean gap of seams, m.
fn mean_gap_m(garment: &Garment, x: &[V3]) -> f64 {
    let gaps: Vec<f64> =
        garment.seams.iter().flat_map(|seam| &seam.pairs).map(|&[a, b]| (x[a] - x[b]).norm()).collect();
    gaps.iter().sum::<f64>() / gaps.len().max(1) as f64
}

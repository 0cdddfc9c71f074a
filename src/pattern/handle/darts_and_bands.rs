//! Parts that follow a handle: darts move with their mouths, bands and yokes stretch with the edges that they are sewn
//! to.

use std::collections::{BTreeMap, BTreeSet};

use super::body::Body;
use super::plan::{Move, Plan, corners};
use crate::pom::anatomy::Part;
use crate::style::EdgeRef;
use crate::style::openings::EdgeEnd;
use geom::V2;

/// Distance along a band below which two of its corners are one end.
const END_M: f64 = 20e-3;

/// Drives tips by the mean displacement of their mouths, and lets them give way so that both edges stay equally long.
pub fn darts(body: &Body<'_>, plan: &mut Plan) {
    let anatomy = body.anatomy;
    let touched = touched(plan);
    for [leg, other] in body.darts().into_iter().filter(|[leg, _]| touched.contains(&leg.piece)) {
        let moved = |place: V2| -> Option<V2> {
            let is_there = |m: &&Move| m.at.edge.piece == leg.piece && anatomy.style().place(m.at) == place;
            let moves: Vec<V2> = plan.moves.iter().filter(is_there).map(|m| m.by).collect();
            (!moves.is_empty()).then(|| moves.iter().sum())
        };
        let mouth = [anatomy.place(EdgeEnd::new(leg, false)), anatomy.place(EdgeEnd::new(other, true))].map(moved);
        let tip = anatomy.point(EdgeEnd::new(leg, true));
        let is_told = moved(anatomy.place(EdgeEnd::new(leg, true))).is_some();
        let mean = 0.5 * mouth.iter().map(|by| by.unwrap_or_else(V2::zeros)).sum::<V2>();
        if !is_told && mean != V2::zeros() {
            plan.drive(tip, mean);
        }
        plan.give(tip, V2::x());
        plan.give(tip, V2::y());
    }
}

fn touched(plan: &Plan) -> BTreeSet<usize> {
    plan.moves.iter().chain(plan.gives.iter().flatten()).map(|m| m.at.edge.piece).collect()
}

/// Lets pieces without a recognised role (waistbands, cuffs, collars, yokes) stretch along the edge that is sewn to a
/// moving piece.
pub fn bands(body: &Body<'_>, plan: &mut Plan) {
    let anatomy = body.anatomy;
    let style = anatomy.style();
    let mut reached = touched(plan);
    let mut bands: BTreeMap<usize, EdgeRef> = BTreeMap::new();
    loop {
        let before = bands.len();
        for seam in &style.seams {
            for (own, other) in [(&seam.a, &seam.b), (&seam.b, &seam.a)] {
                if !other.iter().any(|edge| reached.contains(&edge.piece)) {
                    continue;
                }
                for edge in own.iter().filter(|edge| anatomy.parts[edge.piece] == Part::Other) {
                    bands.entry(edge.piece).or_insert(*edge);
                }
            }
        }
        reached.extend(bands.keys().copied());
        if bands.len() == before {
            break;
        }
    }
    plan.gives.extend(bands.into_iter().flat_map(|(piece, edge)| stretches(body, piece, edge)));
}

/// Ways to stretch along the chord of an edge: one for each interval between successive corners, with the middle of the
/// piece at rest.
fn stretches(body: &Body<'_>, piece: usize, edge: EdgeRef) -> Vec<Vec<Move>> {
    let anatomy = body.anatomy;
    let chord = anatomy.place(EdgeEnd::new(edge, true)) - anatomy.place(EdgeEnd::new(edge, false));
    let Some(along) = chord.try_normalize(0.0) else { return Vec::new() };
    let corners = corners(anatomy, piece);
    let place = |corner: &EdgeEnd| anatomy.place(*corner).dot(&along);
    let mut levels: Vec<f64> = corners.iter().map(place).collect();
    levels.sort_by(f64::total_cmp);
    levels.dedup_by(|later, earlier| *later - *earlier < END_M);
    // Corners at the same end of a shaped band move by the same.
    let reach = |corner: &EdgeEnd| {
        let at_m = place(corner);
        levels
            .iter()
            .copied()
            .min_by(|level, other| (level - at_m).abs().total_cmp(&(other - at_m).abs()))
            .unwrap_or(at_m)
    };
    let Some(middle) = levels.first().zip(levels.last()).map(|(low, high)| 0.5 * (low + high)) else {
        return Vec::new();
    };
    let stretch = |ends: &[f64]| {
        let share = |m: f64| share_of(ends, m) - share_of(ends, middle);
        corners.iter().map(|corner| Move::new(anatomy.point(*corner), along * share(reach(corner)))).collect()
    };
    levels.windows(2).map(stretch).collect()
}

/// Clamped to 0..=1.
fn share_of(ends: &[f64], m: f64) -> f64 {
    ((m - ends[0]) / (ends[1] - ends[0])).clamp(0.0, 1.0)
}

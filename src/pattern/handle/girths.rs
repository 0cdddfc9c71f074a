//! Handles of girths: they move side seams, outseams and inseams outwards at a level.

use super::Handle;
use super::body::{Body, Level, Limb, NEAR_M, Side};
use super::plan::{Condition, Move, Plan, end, ends_between, start};
use super::{rig, upper};
use crate::style::EdgePoint;
use geom::smooth_step;

const AT_LEVEL_M: f64 = 1e-6;

/// Plan of a girth handle. `None` if no side has its level. All sides with the level are driven by the same distance,
/// so that half of the girth changes by the amount. Every edge keeps its length, because its lower end gives way.
pub fn plan(body: &Body<'_>, handle: Handle) -> Option<Plan> {
    let is_moved = |side: &&Side| moves(side, handle);
    if !body.sides.iter().any(|side| moves(side, handle)) {
        return None;
    }
    let mut plan = Plan::default();
    for side in body.sides.iter().filter(is_moved) {
        let in_girth = |other: &&Side| shares_girth(side.limb, other.limb, handle) && moves(other, handle);
        // Half of the girth changes by half of the sum of the displacements.
        let by = 2.0 / body.sides.iter().filter(in_girth).count() as f64;
        drive(body, &mut plan, side, handle, by);
        keep(body, &mut plan, side);
        if handle == Handle::Waist && side.limb == Limb::Skirt && body.trunk.is_some() {
            // The skirt follows the waist of its bodice.
            plan.give(body.point(start(&side.chain)), side.out);
        }
    }
    if handle == Handle::Chest {
        upper::hold_across(body, &mut plan);
        upper::sleeves_follow(body, &mut plan);
    }
    Some(plan)
}

fn moves(side: &Side, handle: Handle) -> bool {
    // The handle `thigh` moves the outseam only. Near the fork, the inseam belongs to the handle `fork`.
    let is_meant = !(handle == Handle::Thigh && matches!(side.limb, Limb::Inner(_)));
    is_meant && side.levels.iter().any(|level| level.handle == handle)
}

fn shares_girth(limb: Limb, other: Limb, handle: Handle) -> bool {
    match (limb, other) {
        (Limb::Outer(a) | Limb::Inner(a), Limb::Outer(b) | Limb::Inner(b)) => {
            a == b || matches!(handle, Handle::Waist | Handle::Hip)
        }
        _ => limb == other,
    }
}

/// Drives a side outwards, holds its other levels, and interpolates between by [`smooth_step`].
pub fn drive(body: &Body<'_>, plan: &mut Plan, side: &Side, handle: Handle, by: f64) {
    let value = |level: Handle| if level == handle { by } else { 0.0 };
    let mut levels = Vec::new();
    for &Level { at_m, handle } in &side.levels {
        let Some(at) = place(body, side, at_m) else { continue };
        plan.drive(at, side.out * value(handle));
        levels.push(at);
    }
    let mut before_m = 0.0;
    for pair in side.chain.windows(2) {
        before_m += body.anatomy.length_m(&[pair[0].edge]);
        let Some([from, to]) =
            side.levels.windows(2).find(|l| (l[0].at_m..=l[1].at_m).contains(&before_m)).map(|l| [l[0], l[1]])
        else {
            continue;
        };
        let corners = ends_between(body.anatomy, pair);
        // A corner needs a displacement. A smooth joint follows from the interpolation of `rig`.
        if corners.len() > 1 || rig::is_sharp(body.anatomy.style(), pair[0]) {
            let t = (before_m - from.at_m) / (to.at_m - from.at_m);
            let by = side.out * (value(from.handle) + (value(to.handle) - value(from.handle)) * smooth_step(t));
            let place = |at: EdgePoint| body.anatomy.style().place(at);
            let is_told = |at: &EdgePoint| levels.iter().any(|level| (place(*level) - place(*at)).norm() < AT_LEVEL_M);
            plan.moves.extend(corners.into_iter().filter(|at| !is_told(at)).map(|at| Move::new(at, by)));
        }
    }
}

/// Point at an arc length from the upper end. Near an end it is the corner there.
fn place(body: &Body<'_>, side: &Side, at_m: f64) -> Option<EdgePoint> {
    let length_m: f64 = side.chain.iter().map(|step| body.anatomy.length_m(&[step.edge])).sum();
    if at_m <= 0.0 {
        Some(body.point(start(&side.chain)))
    } else if at_m >= length_m - NEAR_M {
        Some(body.point(end(&side.chain)))
    } else {
        body.anatomy.along(&side.chain, at_m)
    }
}

/// Keeps the length of every edge: its lower end gives way along it.
pub fn keep(body: &Body<'_>, plan: &mut Plan, side: &Side) {
    plan.conditions.extend(side.chain.iter().map(|edge| Condition::chain(&vec![*edge], 0.0)));
    plan.yield_ends(body.anatomy, &side.chain);
}

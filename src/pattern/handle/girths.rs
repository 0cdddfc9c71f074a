//! Handles of girths: side seams, outseams and inseams moved outwards at a level.

use super::Handle;
use super::body::{Body, Limb, NEAR_M, Side};
use super::plan::{Condition, Move, Plan, along, end, start};
use super::{rig, upper};
use crate::pom::anatomy::Chain;
use crate::style::EdgePoint;
use crate::style::openings::EdgeEnd;
use geom::{V2, smooth_step};

/// Distance within which a corner of a side lies at one of its levels, m.
const AT_LEVEL_M: f64 = 1e-6;

/// What a girth handle does; `None` where no seam has its level.
///
/// All sides that have the level move by the same, so that half of the girth changes by the amount. Every side keeps its length: its lower
/// end gives way.
pub fn plan(body: &Body<'_>, handle: Handle) -> Option<Plan> {
    let is_moved = |side: &&Side| moves(side, handle);
    if !body.sides.iter().any(|side| moves(side, handle)) {
        return None;
    }
    let mut plan = Plan::default();
    for side in body.sides.iter().filter(is_moved) {
        let in_girth = |other: &&Side| shares_girth(side.limb, other.limb, handle) && moves(other, handle);
        // Half of the girth is half of what all sides add.
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

/// Whether a handle moves a side.
fn moves(side: &Side, handle: Handle) -> bool {
    // Next to the fork a thigh is widened by the outseam; the handle `fork` widens it by the inseam.
    let is_meant = !(handle == Handle::Thigh && matches!(side.limb, Limb::Inner(_)));
    is_meant && side.levels.iter().any(|(_, level)| *level == handle)
}

/// Whether two sides take part in the same girth at a level.
fn shares_girth(one: Limb, other: Limb, handle: Handle) -> bool {
    match (one, other) {
        (Limb::Outer(a) | Limb::Inner(a), Limb::Outer(b) | Limb::Inner(b)) => {
            a == b || matches!(handle, Handle::Waist | Handle::Hip)
        }
        _ => one == other,
    }
}

/// Moves a side outwards at a level, by nothing at its other levels, and smoothly between.
pub fn drive(body: &Body<'_>, plan: &mut Plan, side: &Side, handle: Handle, by: f64) {
    let value = |level: Handle| if level == handle { by } else { 0.0 };
    let mut levels = Vec::new();
    for &(at_m, level) in &side.levels {
        let Some(at) = place(body, side, at_m) else { continue };
        plan.drive(at, side.out * value(level));
        levels.push(at);
    }
    let mut before_m = 0.0;
    for pair in side.chain.windows(2) {
        before_m += body.anatomy.length_m(&[pair[0].0]);
        let Some([from, to]) =
            side.levels.windows(2).find(|l| (l[0].0..=l[1].0).contains(&before_m)).map(|l| [l[0], l[1]])
        else {
            continue;
        };
        let corners = ends_between(body, pair);
        // A smooth joint goes along with the edges on both sides of it.
        if corners.len() > 1 || rig::is_sharp(body.anatomy.style(), pair[0]) {
            let t = (before_m - from.0) / (to.0 - from.0);
            let by = side.out * (value(from.1) + (value(to.1) - value(from.1)) * smooth_step(t));
            let place = |at: EdgePoint| body.anatomy.style().place(at);
            let is_told = |at: &EdgePoint| levels.iter().any(|level| (place(*level) - place(*at)).norm() < AT_LEVEL_M);
            plan.moves.extend(corners.into_iter().filter(|at| !is_told(at)).map(|at| Move::new(at, by)));
        }
    }
}

/// The corner between two edges of a chain; both ends where a dart lies between.
fn ends_between(body: &Body<'_>, pair: &[EdgeEnd]) -> Vec<EdgePoint> {
    let below = (pair[1].0, !pair[1].1);
    let is_one = body.anatomy.style().over_corner(pair[0]) == below;
    [Some(pair[0]), Some(below).filter(|_| !is_one)].into_iter().flatten().map(|end| body.point(end)).collect()
}

/// The corners between the edges of a side stay where they are.
pub fn hold(body: &Body<'_>, plan: &mut Plan, chain: &Chain) {
    let corners = chain.windows(2).flat_map(|pair| ends_between(body, pair));
    plan.moves.extend(corners.map(|at| Move::new(at, V2::zeros())));
}

/// The place of a side at a distance from its start; its ends exactly.
fn place(body: &Body<'_>, side: &Side, at_m: f64) -> Option<EdgePoint> {
    let length_m: f64 = side.chain.iter().map(|(edge, _)| body.anatomy.length_m(&[*edge])).sum();
    if at_m <= 0.0 {
        Some(body.point(start(&side.chain)))
    } else if at_m >= length_m - NEAR_M {
        Some(body.point(end(&side.chain)))
    } else {
        body.anatomy.along(&side.chain, at_m)
    }
}

/// Every edge of a side keeps its length: its lower end gives way along it.
pub fn keep(body: &Body<'_>, plan: &mut Plan, side: &Side) {
    plan.conditions.extend(side.chain.iter().map(|edge| Condition::chain(&vec![*edge], 0.0)));
    yield_ends(body, plan, &side.chain);
}

/// The lower end of every edge of a chain gives way along the edge.
pub fn yield_ends(body: &Body<'_>, plan: &mut Plan, chain: &Chain) {
    for (k, edge) in chain.iter().enumerate() {
        let down = along(body.anatomy, &vec![*edge]);
        let ends = chain.get(k..k + 2).map_or_else(|| vec![body.point(*edge)], |pair| ends_between(body, pair));
        plan.gives.push(ends.into_iter().map(|at| Move::new(at, down)).collect());
    }
}

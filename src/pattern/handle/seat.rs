//! Handles of the seat of trousers: rises and fork.

use super::Handle;
use super::body::{Body, Limb, met};
use super::girths;
use super::plan::{Condition, Move, Plan, start};
use crate::pom::Point;
use crate::propose::Face;
use crate::style::EdgeRef;
use geom::V2;

/// Raises the upper edge at the front or back seat seam. At the outseam the edge stays, and it keeps its length.
pub fn rise(body: &Body<'_>, face: Face) -> Option<Plan> {
    let mut plan = Plan::default();
    for leg in &body.legs {
        let crotch = &leg.inner[usize::from(face == Face::Back)].crotch;
        let top = body.point(start(crotch));
        plan.drive(top, V2::y());
        plan.give(top, V2::y());
        plan.give(top, V2::x());
        plan.conditions.push(Condition::chain(crotch, 1.0));
        let piece = crotch[0].edge.piece;
        let waist: Vec<EdgeRef> = leg.waist.iter().copied().filter(|edge| edge.piece == piece).collect();
        plan.conditions.push(Condition::edges(&waist, 0.0));
    }
    hold_hip(body, &mut plan);
    (!body.legs.is_empty()).then_some(plan)
}

/// Moves the forks of front and back outwards, and the inseams at the thigh with them. The inseams keep their lengths,
/// and the seat seams stay at the hip.
pub fn fork(body: &Body<'_>) -> Option<Plan> {
    let mut plan = Plan::default();
    for side in body.sides.iter().filter(|side| matches!(side.limb, Limb::Inner(_))) {
        for level in [Handle::Fork, Handle::Thigh] {
            girths::drive(body, &mut plan, side, level, 1.0);
        }
        girths::keep(body, &mut plan, side);
    }
    hold_hip(body, &mut plan);
    (!body.legs.is_empty()).then_some(plan)
}

/// Holds the seat seams at the hip level.
fn hold_hip(body: &Body<'_>, plan: &mut Plan) {
    for leg in &body.legs {
        let points = leg.points();
        let hip =
            points.iter().find(|measure| measure.point == Point::HalfHip).map_or(&[][..], |measure| &measure.path);
        for run in &leg.inner {
            let at = met(body.anatomy, &run.crotch, hip).and_then(|at_m| body.anatomy.along(&run.crotch, at_m));
            plan.moves.extend(at.map(|at| Move::new(at, V2::zeros())));
        }
    }
}

//! Handles of sleeves.

use super::body::Body;
use super::plan::{Condition, Move, Plan, end};
use super::upper::{cap_terms, hold_sleeve, move_underarm};
use geom::V2;

/// The underarm points move outwards, and give way upwards so that the cap keeps its length.
pub fn bicep(body: &Body<'_>) -> Option<Plan> {
    let mut plan = Plan::default();
    for cap in body.caps() {
        hold_sleeve(body, &mut plan, cap);
        move_underarm(body, &mut plan.moves, cap, cap.out * cap.widening(body.anatomy)?);
        let mut give = Vec::new();
        move_underarm(body, &mut give, cap, -cap.down);
        plan.gives.push(give);
        plan.give(body.point(end(&cap.seam)), cap.down);
        plan.conditions.push(Condition { terms: cap_terms(cap), change: 0.0 });
    }
    (!plan.moves.is_empty()).then_some(plan)
}

/// The underarm points move down the arm, and give way inwards so that the cap keeps its length.
pub fn cap_height(body: &Body<'_>) -> Option<Plan> {
    let mut plan = Plan::default();
    for cap in body.caps() {
        hold_sleeve(body, &mut plan, cap);
        move_underarm(body, &mut plan.moves, cap, cap.down);
        let mut give = Vec::new();
        move_underarm(body, &mut give, cap, -cap.out);
        plan.gives.push(give);
        plan.give(body.point(end(&cap.seam)), cap.down);
        plan.conditions.push(Condition { terms: cap_terms(cap), change: 0.0 });
    }
    (!plan.moves.is_empty()).then_some(plan)
}

/// Widens half of the lower edge: the lower ends of the underarm seam move outwards.
pub fn cuff(body: &Body<'_>) -> Option<Plan> {
    let mut plan = Plan::default();
    for cap in body.caps() {
        plan.moves.extend(cap.bicep(body.anatomy).map(|at| Move::new(at, V2::zeros())));
        plan.drive(body.point(end(&cap.seam)), cap.out);
        plan.give(body.point(end(&cap.seam)), cap.down);
    }
    (!plan.moves.is_empty()).then_some(plan)
}

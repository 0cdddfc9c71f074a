//! Handles of the waist apart from its side seams: darts, and the seat seam.

use std::collections::BTreeMap;

use super::body::Body;
use super::plan::{Condition, Move, Plan, start};
use super::seat::hold_hip;
use crate::pom::anatomy::Part;
use crate::style::EdgeRef;
use crate::style::openings::EdgeEnd;
use geom::V2;

/// Makes the darts on the waist smaller, all by the same, so that half of the waist grows by the amount.
pub fn darts(body: &Body<'_>) -> Option<Plan> {
    let anatomy = body.anatomy;
    let mut waists: BTreeMap<Limb, Vec<[EdgeEnd; 2]>> = BTreeMap::new();
    for [leg, other] in body.darts() {
        let mouth = [EdgeEnd::new(leg, false), EdgeEnd::new(other, true)];
        let beside = mouth.map(|end| anatomy.style().over_corner(end).edge);
        if let Some(limb) = Limb::of(anatomy.parts[leg.piece]).filter(|limb| is_waist(body, *limb, &beside)) {
            waists.entry(limb).or_default().push(mouth);
        }
    }
    let mut plan = Plan::default();
    for mouths in waists.values() {
        // Half of the waist grows by half of the sum over all darts.
        let by = 2.0 / mouths.len() as f64;
        for mouth in mouths {
            let [from, to] = mouth.map(|end| anatomy.place(end));
            let half = (to - from).try_normalize(0.0)? * (0.5 * by);
            plan.drive(body.point(mouth[0]), half);
            plan.drive(body.point(mouth[1]), -half);
        }
    }
    (!waists.is_empty()).then_some(plan)
}

/// Part of a garment with a waist of its own.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Limb {
    Legs,
    Skirt,
    Trunk,
}

impl Limb {
    fn of(part: Part) -> Option<Self> {
        match part {
            Part::Leg(..) => Some(Self::Legs),
            Part::Skirt(_) => Some(Self::Skirt),
            Part::Trunk(_) => Some(Self::Trunk),
            _ => None,
        }
    }
}

fn is_waist(body: &Body<'_>, limb: Limb, beside: &[EdgeRef; 2]) -> bool {
    let anatomy = body.anatomy;
    let all = |edges: &[EdgeRef]| beside.iter().all(|edge| edges.contains(edge));
    match limb {
        Limb::Legs => body.legs.iter().any(|leg| all(&leg.waist)),
        Limb::Trunk => body.trunk.as_ref().is_some_and(|trunk| anatomy.has_below(&trunk.bottom) && all(&trunk.bottom)),
        Limb::Skirt => {
            let openings = anatomy.style().openings(&|piece| matches!(anatomy.parts[piece], Part::Skirt(_)));
            let tops = body.sides.iter().filter(|side| side.limb == super::body::Limb::Skirt);
            let tops: Vec<EdgeRef> = tops.map(|side| anatomy.style().over_corner(start(&side.chain)).edge).collect();
            openings.iter().any(|edges| all(edges) && tops.iter().any(|top| edges.contains(top)))
        }
    }
}

/// Moves the seat seam outwards at the back waist, so that half of the waist grows by the amount. The seam keeps its
/// length and its place at the hip.
pub fn centre_back(body: &Body<'_>) -> Option<Plan> {
    let mut plan = Plan::default();
    for leg in &body.legs {
        let crotch = &leg.inner[1].crotch;
        let top = body.point(start(crotch));
        let own = |edge: &&EdgeRef| edge.piece == crotch[0].edge.piece;
        let waist: Vec<EdgeRef> = leg.waist.iter().filter(own).copied().collect();
        let outer = body.anatomy.place(start(&leg.outer.as_ref()?[1]));
        let out = (body.anatomy.place(start(crotch)).x - outer.x).signum();
        plan.moves.push(Move::new(top, V2::x() * out));
        plan.moves.push(Move::turning(top));
        plan.give(top, V2::x());
        plan.give(top, V2::y());
        plan.conditions.push(Condition::chain(crotch, 0.0));
        plan.conditions.push(Condition::edges(&waist, 1.0));
    }
    hold_hip(body, &mut plan);
    (body.legs.len() == 2).then_some(plan)
}

//! Handles of the seat of trousers and skirts: wedges, rises and fork.

use super::Handle;
use super::body::{Body, Limb, Side, met};
use super::girths;
use super::plan::{Condition, Move, Plan, corners, start};
use crate::pom::Point;
use crate::pom::anatomy::{Chain, Part};
use crate::pom::legs::Legs;
use crate::propose::Face;
use crate::style::openings::EdgeEnd;
use crate::style::{EdgePoint, EdgeRef};
use geom::V2;

/// Lies across one face of the legs.
pub struct Wedge {
    face: Face,
    /// Height as a share of the way from the hip to the waist.
    up: f64,
    /// Displacement outwards, m/m of the wedge.
    fork: f64,
}

/// Lies at the seat line. The fork takes half of it, as published amounts do: 10 to 30 mm and 5 to 15 mm [Liechty10].
pub const SEAT: Wedge = Wedge { face: Face::Back, up: 0.0, fork: 0.5 };
/// Lies half-way between hip and waist.
pub const ABDOMEN: Wedge = Wedge { face: Face::Front, up: 0.5, fork: 0.0 };

/// Opens a wedge from the seat seam to nothing at the outseam. Everything above turns about its point at the outseam,
/// so the waist keeps its length.
pub fn wedge(body: &Body<'_>, Wedge { face, up, fork }: &Wedge) -> Option<Plan> {
    let anatomy = body.anatomy;
    let mut plan = Plan::default();
    for leg in &body.legs {
        let Hips { crotch, outer, at_m: [crotch_m, outer_m] } = hips(body, leg, *face)?;
        let hinge = anatomy.along(crotch, (1.0 - up) * crotch_m)?;
        let pivot = anatomy.along(outer, (1.0 - up) * outer_m)?;
        let [at, about] = [hinge, pivot].map(|point| anatomy.style().place(point));
        let across = at - about;
        plan.moves.extend([hinge, pivot].map(|point| Move::new(point, V2::zeros())));
        for corner in corners(anatomy, hinge.edge.piece) {
            let arm = anatomy.place(corner) - about;
            if across.perp(&arm) * across.x.signum() > 0.0 {
                plan.drive(anatomy.point(corner), V2::new(-arm.y, arm.x) / across.x);
            }
        }
        let [inner, outside] = [crotch, outer].map(|chain| body.point(start(chain)));
        plan.moves.push(Move::turning(inner));
        plan.give(inner, V2::x());
        plan.give(outside, V2::y());
        plan.conditions.push(Condition::edges(&waist_of(leg, hinge.edge.piece), 0.0));
    }
    let is_own = |piece: usize| plan.moves.iter().any(|m| m.at.edge.piece == piece);
    let sides: Vec<_> = body.sides.iter().filter(|side| matches!(side.limb, Limb::Inner(_))).collect();
    let own: Vec<_> = sides.into_iter().filter(|side| is_own(side.chain[0].edge.piece)).collect();
    if *fork != 0.0 {
        for side in own {
            for level in [Handle::Fork, Handle::Thigh] {
                girths::drive(body, &mut plan, side, level, *fork);
            }
            girths::keep(body, &mut plan, side);
        }
    }
    (!body.legs.is_empty()).then_some(plan)
}

/// Lengthens the legs between waist and hip, level all round.
pub fn depth(body: &Body<'_>) -> Option<Plan> {
    let anatomy = body.anatomy;
    let mut plan = Plan::default();
    for leg in &body.legs {
        for face in Face::BOTH {
            let Hips { crotch, outer, at_m: [crotch_m, outer_m] } = hips(body, leg, face)?;
            let line = [anatomy.along(crotch, crotch_m)?, anatomy.along(outer, outer_m)?];
            plan.moves.extend(line.map(|point| Move::new(point, V2::zeros())));
            let level_m = line.iter().map(|point| anatomy.style().place(*point).y).fold(f64::MIN, f64::max);
            let above = corners(anatomy, crotch[0].edge.piece).into_iter();
            let above = above.filter(|corner| anatomy.place(*corner).y > level_m);
            above.for_each(|corner| plan.drive(anatomy.point(corner), V2::y()));
            plan.give(body.point(start(outer)), V2::y());
        }
    }
    (!body.legs.is_empty()).then_some(plan)
}

/// Seams of one face of a leg, with the arc lengths from the waist at which the hip level meets them, m.
struct Hips<'l> {
    crotch: &'l Chain,
    outer: &'l Chain,
    at_m: [f64; 2],
}

fn hips<'l>(body: &Body<'_>, leg: &'l Legs<'_>, face: Face) -> Option<Hips<'l>> {
    let side = usize::from(face == Face::Back);
    let crotch = &leg.inner[side].crotch;
    let outer = &leg.outer.as_ref()?[side];
    let points = leg.points();
    let hip = &points.iter().find(|measure| measure.point == Point::HalfHip)?.path;
    Some(Hips { crotch, outer, at_m: [met(body.anatomy, crotch, hip)?, met(body.anatomy, outer, hip)?] })
}

fn waist_of(leg: &Legs<'_>, piece: usize) -> Vec<EdgeRef> {
    leg.waist.iter().copied().filter(|edge| edge.piece == piece).collect()
}

/// Raises the upper edge at the seat seam. At the outseam it stays, and it keeps its length.
pub fn rise(body: &Body<'_>, face: Face) -> Option<Plan> {
    if body.legs.is_empty() {
        return skirt_rise(body, face);
    }
    let mut plan = Plan::default();
    for leg in &body.legs {
        let crotch = &leg.inner[usize::from(face == Face::Back)].crotch;
        let top = body.point(start(crotch));
        plan.drive(top, V2::y());
        plan.give(top, V2::y());
        plan.give(top, V2::x());
        plan.conditions.push(Condition::chain(crotch, 1.0));
        plan.conditions.push(Condition::edges(&waist_of(leg, crotch[0].edge.piece), 0.0));
    }
    hold_hip(body, &mut plan);
    Some(plan)
}

/// Raises the upper edge at the centre. `None` for a skirt that hangs from a bodice, or that is not one face of one or
/// two pieces.
fn skirt_rise(body: &Body<'_>, face: Face) -> Option<Plan> {
    let anatomy = body.anatomy;
    let is_face = |piece: usize| anatomy.parts[piece] == Part::Skirt(face);
    let own = |side: &&Side| side.limb == Limb::Skirt && is_face(side.chain[0].edge.piece);
    let sides: Vec<&Side> = body.sides.iter().filter(own).collect();
    let [first, second] = sides[..] else { return None };
    let tops = [first, second].map(|side| anatomy.place(start(&side.chain)));
    let openings = anatomy.style().openings(&|piece| matches!(anatomy.parts[piece], Part::Skirt(_)));
    let upper = openings.iter().find(|all| all.contains(&anatomy.style().over_corner(start(&first.chain)).edge))?;
    let waist: Vec<EdgeRef> = upper.iter().copied().filter(|edge| is_face(edge.piece)).collect();
    if body.trunk.is_some() {
        return None;
    }
    let mut plan = Plan::default();
    let centres = match first.chain[0].edge.piece == second.chain[0].edge.piece {
        true => vec![anatomy.meeting(&waist, |p| p.x - 0.5 * (tops[0].x + tops[1].x))?],
        false => [first, second].into_iter().map(|side| far_end(body, &waist, side)).collect::<Option<_>>()?,
    };
    plan.moves.extend(centres.into_iter().map(|at| Move::new(at, V2::y())));
    plan.conditions.push(Condition::edges(&waist, 0.0));
    plan.gives.push([first, second].map(|side| Move::new(body.point(start(&side.chain)), side.out)).to_vec());
    for chain in body.sides.iter().filter(|side| side.limb == Limb::Skirt).map(|side| &side.chain) {
        plan.give(body.point(start(chain)), V2::y());
    }
    Some(plan)
}

/// End of the upper edge of half a skirt that is farthest from the side seam.
fn far_end(body: &Body<'_>, waist: &[EdgeRef], side: &Side) -> Option<EdgePoint> {
    let from = body.anatomy.place(start(&side.chain));
    let own = waist.iter().filter(|edge| edge.piece == side.chain[0].edge.piece);
    let ends = own.flat_map(|edge| [false, true].map(|is_last| EdgeEnd::new(*edge, is_last)));
    let away = |end: &EdgeEnd| (body.anatomy.place(*end).x - from.x).abs();
    ends.max_by(|a, b| away(a).total_cmp(&away(b))).map(|end| body.point(end))
}

/// Moves the forks outwards, and the inseams at the thigh with them. The inseams keep their lengths, and the seat seams
/// stay at the hip.
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

pub fn hold_hip(body: &Body<'_>, plan: &mut Plan) {
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

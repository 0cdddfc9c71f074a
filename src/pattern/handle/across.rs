//! Handles of one face of the trunk: its widths, the upper back, the bust and the back waist.

use super::Handle;
use super::body::{Armhole, Body, Limb, Side};
use super::plan::{Condition, Move, Plan, end};
use super::upper::{half_way_up, neck_centres, sleeves_follow};
use super::{girths, lengths};
use crate::pom::anatomy::Part;
use crate::propose::Face;
use crate::style::openings::EdgeEnd;
use crate::style::{EdgePoint, EdgeRef};
use geom::V2;

/// With the horizontal unit vector out of the piece.
fn armholes<'b>(body: &'b Body<'_>, face: Face) -> impl Iterator<Item = (&'b Armhole, V2)> {
    let is_own = move |side: &&Side, armhole: &Armhole| side.chain[0] == armhole.side[0];
    let own = body.armholes.iter().filter(move |armhole| part(body, armhole) == Part::Trunk(face));
    own.filter_map(move |armhole| body.sides.iter().find(|side| is_own(side, armhole)).map(|side| (armhole, side.out)))
}

fn part(body: &Body<'_>, armhole: &Armhole) -> Part {
    body.anatomy.parts[armhole.underarm.edge.piece]
}

/// Widens half-way up the armholes, each by the amount.
pub fn width(body: &Body<'_>, face: Face) -> Option<Plan> {
    let mut plan = Plan::default();
    for (armhole, out) in armholes(body, face) {
        plan.drive(half_way_up(body, armhole)?, out);
        plan.moves.extend(armhole.tip.map(|tip| Move::turning(body.point(tip))));
    }
    if plan.moves.is_empty() {
        return None;
    }
    sleeves_follow(body, &mut plan);
    Some(plan)
}

/// Raises the back neckline, cut across the blades from centre to armhole and opened. The high points of the shoulder
/// give way so that neckline and shoulder keep their lengths.
pub fn upper_back(body: &Body<'_>) -> Option<Plan> {
    let (trunk, anatomy) = (body.trunk.as_ref()?, body.anatomy);
    let centres = neck_centres(body, Face::Back)?;
    let centre_m = anatomy.style().place(*centres.first()?).x;
    let mut plan = Plan::default();
    plan.moves.extend(centres.iter().map(|at| Move::new(*at, V2::y())));
    for sides in &trunk.shoulders {
        let [high, tip] = [sides[1][0].other(), end(&sides[1])];
        let away_m = |end: EdgeEnd| (anatomy.place(end).x - centre_m).abs();
        plan.drive(body.point(high), V2::y() * (1.0 - away_m(high) / away_m(tip)));
        plan.give(body.point(high), V2::x());
        plan.give(body.point(high), V2::y());
        plan.moves.push(Move::turning(body.point(high)));
        plan.conditions.push(Condition::chain(&sides[1], 0.0));
    }
    let is_back = |edge: &&EdgeRef| anatomy.parts[edge.piece] == Part::Trunk(Face::Back);
    let neck: Vec<EdgeRef> = trunk.neck.iter().filter(is_back).copied().collect();
    plan.conditions.push(Condition::edges(&neck, 0.0));
    (!trunk.shoulders.is_empty() && !neck.is_empty()).then_some(plan)
}

/// Length that the front gains in its middle for each unit of width: it turns about a point about 100 mm above the bust
/// point and 70 mm beside it [Armstrong10].
const LENGTH_PER_WIDTH: f64 = 0.7;

/// Widens the front alone at the chest, at each side, and lengthens its middle. Its armholes keep their lengths.
pub fn bust(body: &Body<'_>) -> Option<Plan> {
    let mut plan = waist_seam(body, Face::Front).or_else(|| lengths::face_length(body, Face::Front))?;
    plan.moves.iter_mut().for_each(|moved| moved.by *= LENGTH_PER_WIDTH);
    let mut is_any = false;
    for (armhole, _) in armholes(body, Face::Front) {
        let side = body.sides.iter().find(|side| side.chain[0] == armhole.side[0])?;
        girths::drive(body, &mut plan, side, Handle::Chest, 1.0);
        girths::keep(body, &mut plan, side);
        plan.conditions.push(Condition::edges(&armhole.edges, 0.0));
        plan.give(body.point(armhole.underarm), armhole.down(body));
        plan.moves.extend(half_way_up(body, armhole).map(|at| Move::new(at, V2::zeros())));
        is_any = true;
    }
    sleeves_follow(body, &mut plan);
    is_any.then_some(plan)
}

/// Lowers the waist seam of a back bodice at its centre. `None` for a trunk without a waist seam.
pub fn sway_back(body: &Body<'_>) -> Option<Plan> {
    waist_seam(body, Face::Back)
}

/// The side seams stay, and the seam keeps its length.
fn waist_seam(body: &Body<'_>, face: Face) -> Option<Plan> {
    let (trunk, anatomy) = (body.trunk.as_ref()?, body.anatomy);
    let is_face = |piece: usize| anatomy.parts[piece] == Part::Trunk(face);
    let waist: Vec<EdgeRef> = trunk.bottom.iter().filter(|edge| is_face(edge.piece)).copied().collect();
    if !anatomy.has_below(&trunk.bottom) {
        return None;
    }
    let mut plan = Plan::default();
    plan.moves.extend(centres(body, face, &waist)?.into_iter().map(|at| Move::new(at, -V2::y())));
    plan.conditions.push(Condition::edges(&waist, 0.0));
    let is_own = |side: &&Side| side.limb == Limb::Trunk && is_face(side.chain[0].edge.piece);
    let own = body.sides.iter().filter(is_own);
    plan.gives.push(own.map(|side| Move::new(body.point(end(&side.chain)), side.out)).collect());
    for side in body.sides.iter().filter(|side| side.limb == Limb::Trunk) {
        plan.give(body.point(end(&side.chain)), V2::y());
    }
    Some(plan)
}

/// Points of the lower edge: one, or one on each half.
fn centres(body: &Body<'_>, face: Face, waist: &[EdgeRef]) -> Option<Vec<EdgePoint>> {
    let anatomy = body.anatomy;
    let necks = neck_centres(body, face)?;
    let below = |neck: &EdgePoint| {
        let x = anatomy.style().place(*neck).x;
        let own: Vec<EdgeRef> = waist.iter().copied().filter(|edge| edge.piece == neck.edge.piece).collect();
        let ends = own.iter().flat_map(|edge| [false, true].map(|is_last| EdgeEnd::new(*edge, is_last)));
        let away = |end: &EdgeEnd| (anatomy.place(*end).x - x).abs();
        let nearest = ends.min_by(|a, b| away(a).total_cmp(&away(b)))?;
        let within = anatomy.meeting(&own, |p| p.x - x);
        Some(within.filter(|_| away(&nearest) > super::body::NEAR_M).unwrap_or_else(|| anatomy.point(nearest)))
    };
    necks.iter().map(below).collect()
}

//! Handles of shoulder, neck and armhole, and of the sleeve that is sewn to it. Their plans drive points by the amount,
//! hold points in place, and let points give way so that lengths are kept ([`Plan`]).

use super::body::{Armhole, Body, HalfCap, NEAR_M};
use super::plan::{Condition, Move, Plan, Term, along, end, start};
use crate::pom::anatomy::{Chain, Part};
use crate::pom::top::Centre;
use crate::propose::Face;
use crate::style::openings::EdgeEnd;
use crate::style::{EdgePoint, EdgeRef};
use geom::V2;

/// Lowers the shoulder points. Shoulder and armhole keep their lengths, so the armhole sinks as well.
pub fn shoulder_slope(body: &Body<'_>) -> Option<Plan> {
    let mut plan = Plan::default();
    for Shoulder { seam, outwards } in shoulders(body)? {
        let tip = body.point(end(&seam));
        plan.drive(tip, -V2::y());
        plan.give(tip, V2::x() * outwards.x.signum());
        plan.conditions.push(Condition::chain(&seam, 0.0));
    }
    armholes_keep(body, &mut plan);
    Some(plan)
}

/// Lowers the front shoulder points and raises the back ones. Shoulders keep their lengths. The halves of a sleeve that
/// meet at the shoulder shift along the cap.
pub fn forward_shoulder(body: &Body<'_>) -> Option<Plan> {
    let mut plan = Plan::default();
    for Shoulder { seam, outwards } in shoulders(body)? {
        let tip = body.point(end(&seam));
        let is_front = body.anatomy.parts[tip.edge.piece] == Part::Trunk(Face::Front);
        plan.drive(tip, if is_front { -V2::y() } else { V2::y() });
        plan.give(tip, V2::x() * outwards.x.signum());
        plan.conditions.push(Condition::chain(&seam, 0.0));
    }
    hold_across(body, &mut plan);
    for faces in body.armholes.chunks(Face::BOTH.len()) {
        let edges: Vec<EdgeRef> = faces.iter().flat_map(|face| face.edges.iter().copied()).collect();
        plan.conditions.push(Condition::edges(&edges, 0.0));
        let down = |face: &Armhole| face.down(body);
        plan.gives.push(faces.iter().map(|face| Move::new(body.point(face.underarm), down(face))).collect());
    }
    for cap in body.caps() {
        plan.give(cap.top, cap.out);
    }
    Some(plan)
}

/// Moves the shoulder points outwards along the shoulder. The armhole keeps its length.
pub fn shoulder_length(body: &Body<'_>) -> Option<Plan> {
    let mut plan = Plan::default();
    for Shoulder { seam, outwards } in shoulders(body)? {
        let tip = body.point(end(&seam));
        plan.drive(tip, outwards);
        plan.give(tip, outwards);
        plan.conditions.push(Condition::chain(&seam, 1.0));
        plan.moves.push(Move::turning(tip));
    }
    hold_across(body, &mut plan);
    armholes_keep(body, &mut plan);
    Some(plan)
}

/// Moves the high points of the shoulder (at the neck) outwards along it, each by half of the amount. The centres of
/// the neckline stay.
pub fn neck_width(body: &Body<'_>) -> Option<Plan> {
    let mut plan = Plan::default();
    for Shoulder { seam, outwards } in shoulders(body)? {
        let high = body.point(start(&seam));
        plan.drive(high, outwards * (0.5 / outwards.x.abs()));
        plan.give(high, outwards);
        plan.moves.push(Move::turning(high));
    }
    for centre in Face::BOTH.into_iter().filter_map(|face| neck_centres(body, face)).flatten() {
        plan.drive(centre, V2::zeros());
    }
    Some(plan)
}

pub fn neck_depth(body: &Body<'_>, face: Face) -> Option<Plan> {
    let mut plan = Plan::default();
    for at in neck_centres(body, face)? {
        plan.drive(at, -V2::y());
    }
    let high = body.trunk.as_ref()?.high_points(face).into_iter();
    plan.moves.extend(high.map(|high| Move::turning(body.point(high))));
    Some(plan)
}

/// One point, or one on each half.
pub fn neck_centres(body: &Body<'_>, face: Face) -> Option<Vec<EdgePoint>> {
    let (trunk, anatomy) = (body.trunk.as_ref()?, body.anatomy);
    if let Centre::Within(at) = trunk.neck_centre(face)? {
        let ends = [false, true].map(|is_last| anatomy.point(EdgeEnd::new(at.edge, is_last)));
        let corner = ends.into_iter().find(|end| (end.arc_m - at.arc_m).abs() < NEAR_M);
        return Some(vec![corner.unwrap_or(at)]);
    }
    let high = trunk.high_points(face);
    let centres = high.into_iter().filter_map(|high| trunk.neck_end(high)).map(|end| anatomy.point(end));
    Some(centres.collect())
}

/// Lowers the underarm points along the side seam. Those of the sleeve move as far down the arm, and give way across it
/// so that the cap fits.
pub fn armhole_depth(body: &Body<'_>) -> Option<Plan> {
    if body.armholes.is_empty() {
        return None;
    }
    let mut plan = Plan::default();
    for armhole in &body.armholes {
        let down = armhole.down(body);
        plan.drive(body.point(armhole.underarm), down / down.y.abs());
        plan.hold(body.anatomy, &armhole.side);
        if let Some(cap) = &armhole.cap {
            move_underarm(body, &mut plan.moves, cap, cap.down);
        }
    }
    for faces in body.armholes.chunks(Face::BOTH.len()) {
        // The side seam may slant differently in front and back. One factor of opposite signs keeps both sides equally
        // long.
        let apart = faces.iter().zip([0.5, -0.5]);
        plan.gives.push(apart.map(|(face, by)| Move::new(body.point(face.underarm), face.down(body) * by)).collect());
    }
    hold_across(body, &mut plan);
    sleeves_follow(body, &mut plan);
    Some(plan)
}

struct Shoulder {
    /// Directed outwards from the neck.
    seam: Chain,
    /// Unit vector from the neck.
    outwards: V2,
}

/// Both sides of all seams. `None` for a garment without any, or with a vertical one.
fn shoulders(body: &Body<'_>) -> Option<Vec<Shoulder>> {
    let trunk = body.trunk.as_ref().filter(|trunk| !trunk.shoulders.is_empty())?;
    let sides = trunk.shoulders.iter().flatten();
    let shoulder = |seam: &Chain| Shoulder { seam: seam.clone(), outwards: along(body.anatomy, seam) };
    let found: Vec<Shoulder> = sides.map(shoulder).collect();
    found.iter().all(|shoulder| shoulder.outwards.x != 0.0).then_some(found)
}

/// Keeps the length of every armhole: its underarm points give way down the side seam, by one factor for front and
/// back. A free lower end of the side seam gives way for the small difference.
fn armholes_keep(body: &Body<'_>, plan: &mut Plan) {
    for faces in body.armholes.chunks(Face::BOTH.len()) {
        let edges: Vec<EdgeRef> = faces.iter().flat_map(|face| face.edges.iter().copied()).collect();
        plan.conditions.push(Condition::edges(&edges, 0.0));
        let down = |face: &Armhole| face.down(body);
        plan.gives.push(faces.iter().map(|face| Move::new(body.point(face.underarm), down(face))).collect());
        for face in faces {
            plan.hold(body.anatomy, &face.side);
            slide_joints(body, plan, face);
            let low = end(&face.side);
            if body.anatomy.ways.is_free(body.anatomy.style().over_corner(low).edge) {
                plan.give(body.point(low), down(face));
            }
        }
    }
    sleeves_follow(body, plan);
}

/// Lets joints between the edges give way along the armhole.
fn slide_joints(body: &Body<'_>, plan: &mut Plan, face: &Armhole) {
    for edge in &face.edges {
        let corner = body.anatomy.style().over_corner(EdgeEnd::new(*edge, true));
        if face.edges.contains(&corner.edge) {
            plan.give(body.point(corner), along(body.anatomy, &vec![EdgeEnd::new(*edge, true)]));
        }
    }
}

impl Armhole {
    /// Unit vector along the side seam at the underarm.
    pub fn down(&self, body: &Body<'_>) -> V2 {
        along(body.anatomy, &vec![self.side[0]])
    }
}

/// Holds half the height, where the widths across front and back are measured.
pub fn hold_across(body: &Body<'_>, plan: &mut Plan) {
    plan.moves.extend(
        body.armholes.iter().filter_map(|armhole| half_way_up(body, armhole)).map(|at| Move::new(at, V2::zeros())),
    );
}

/// `None` for an armhole without a shoulder point.
pub fn half_way_up(body: &Body<'_>, armhole: &Armhole) -> Option<EdgePoint> {
    let (tip, low) = (body.anatomy.place(armhole.tip?).y, body.anatomy.place(armhole.underarm).y);
    body.anatomy.meeting(&armhole.edges, |p| p.y - 0.5 * (tip + low))
}

/// Keeps each half cap as long as its part of the armhole: the underarm point of the sleeve gives way across the arm.
pub fn sleeves_follow(body: &Body<'_>, plan: &mut Plan) {
    for armhole in &body.armholes {
        let Some(cap) = &armhole.cap else { continue };
        let mut terms = cap_terms(cap);
        let is_sewn_on =
            |edge: &&EdgeRef| body.anatomy.ways.partners(**edge).iter().any(|other| other.piece == cap.piece);
        terms.extend(armhole.edges.iter().filter(is_sewn_on).map(|edge| Term::whole(*edge, -1.0)));
        plan.conditions.push(Condition { terms, change: 0.0 });
        hold_sleeve(body, plan, cap);
        let mut give = Vec::new();
        move_underarm(body, &mut give, cap, cap.out);
        plan.gives.push(give);
        plan.give(body.point(end(&cap.seam)), cap.along(body.anatomy));
    }
}

pub fn cap_terms(cap: &HalfCap) -> Vec<Term> {
    cap.spans.iter().map(|span| Term { span: *span, factor: 1.0 }).collect()
}

/// Holds the top of the cap, and the bicep level of the underarm seam.
pub fn hold_sleeve(body: &Body<'_>, plan: &mut Plan, cap: &HalfCap) {
    plan.drive(cap.top, V2::zeros());
    plan.moves.extend(cap.bicep(body.anatomy).map(|at| Move::new(at, V2::zeros())));
}

/// Moves the underarm point and the point at the bicep level below.
pub fn move_underarm(body: &Body<'_>, moves: &mut Vec<Move>, cap: &HalfCap, by: V2) {
    moves.push(Move::new(body.point(cap.underarm), by));
    moves.extend(cap.bicep(body.anatomy).map(|at| Move::new(at, by)));
}

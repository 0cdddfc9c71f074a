//! Handles of lengths: they slash pieces straight across and spread them, or lower the lower edge.

use std::collections::BTreeMap;

use super::body::{Body, Limb, Side};
use super::plan::{Condition, Move, Plan, along, corners, end, start};
use crate::pom::anatomy::{Anatomy, BELOW_ARMHOLE_M, Part};
use crate::propose::Face;
use crate::style::openings::EdgeEnd;
use crate::style::{EdgePoint, PathPart};
use geom::V2;

/// Corners above stay, corners below all move by the same.
struct Slash {
    down: V2,
    /// Ends of the spread along `down`.
    from_m: f64,
    to_m: f64,
}

/// Below the armhole, front and back alike.
pub fn body_length(body: &Body<'_>) -> Option<Plan> {
    body.trunk.as_ref()?;
    slashed(body, |side| side.limb == Limb::Trunk, BELOW_ARMHOLE_M)
}

/// Below the waist, or the hip if it has that level.
pub fn skirt_length(body: &Body<'_>) -> Option<Plan> {
    let hip = |side: &Side| {
        side.levels.iter().find(|level| level.handle == super::Handle::Hip).map_or(0.0, |level| level.at_m)
    };
    let from_m = body.sides.iter().filter(|side| side.limb == Limb::Skirt).map(hip).fold(0.0, f64::max);
    slashed(body, |side| side.limb == Limb::Skirt, from_m)
}

/// Between fork and lower edge, so that the inseam changes by the amount.
pub fn leg_length(body: &Body<'_>) -> Option<Plan> {
    let mut plan = slashed(body, |side| matches!(side.limb, Limb::Inner(_)), 0.0)?;
    for side in &body.sides {
        match side.limb {
            Limb::Inner(_) => plan.conditions.push(Condition::chain(&side.chain, 1.0)),
            Limb::Outer(_) => plan.give(body.point(end(&side.chain)), along(body.anatomy, &side.chain)),
            _ => {}
        }
    }
    Some(plan)
}

/// Slashes `below_m` under the upper ends of some sides.
fn slashed(body: &Body<'_>, is_meant: impl Fn(&Side) -> bool, below_m: f64) -> Option<Plan> {
    let anatomy = body.anatomy;
    let mut plan = Plan::default();
    let mut slashes: BTreeMap<usize, Slash> = BTreeMap::new();
    let pieces: Vec<usize> =
        body.sides.iter().filter(|side| is_meant(side)).map(|side| side.chain[0].edge.piece).collect();
    let limbs: Vec<Part> = pieces.iter().map(|piece| anatomy.parts[*piece]).collect();
    let openings = anatomy.style().openings(&|piece| limbs.contains(&anatomy.parts[piece]));
    for side in body.sides.iter().filter(|side| is_meant(side)) {
        let down = -V2::y();
        let [top, low] = [start(&side.chain), end(&side.chain)];
        let reach = |at: EdgeEnd| anatomy.place(at).dot(&down);
        for (EdgeEnd { edge, .. }, is_top) in [(top, true), (low, false)] {
            let slash = slashes.entry(edge.piece).or_insert(Slash { down, from_m: f64::MIN, to_m: f64::MAX });
            if is_top {
                slash.from_m = slash.from_m.max(reach(top) + below_m);
            } else {
                let opening = openings.iter().find(|opening| opening.contains(&anatomy.style().over_corner(low).edge));
                let own = opening.into_iter().flatten().filter(|own| own.piece == edge.piece);
                let ends = own.flat_map(|edge| [false, true].map(|is_last| reach(EdgeEnd::new(*edge, is_last))));
                slash.to_m = ends.fold(slash.to_m.min(reach(low)), f64::min);
            }
        }
        plan.yield_ends(anatomy, &side.chain);
    }
    if slashes.is_empty() {
        return None;
    }
    for (piece, slash) in slashes {
        spread(anatomy, &mut plan, piece, &slash);
    }
    Some(plan)
}

/// Drives corners above a slash by zero, below it by the amount, in it linearly between.
fn spread(anatomy: &Anatomy<'_>, plan: &mut Plan, piece: usize, slash: &Slash) {
    for corner in corners(anatomy, piece) {
        let at_m = anatomy.place(corner).dot(&slash.down);
        let share = ((at_m - slash.from_m) / (slash.to_m - slash.from_m).max(BELOW_ARMHOLE_M)).clamp(0.0, 1.0);
        plan.drive(anatomy.point(corner), slash.down * share);
    }
}

/// Between underarm and lower edge.
pub fn sleeve_length(body: &Body<'_>) -> Option<Plan> {
    let anatomy = body.anatomy;
    let mut plan = Plan::default();
    let mut slashes: BTreeMap<usize, Slash> = BTreeMap::new();
    for cap in body.caps() {
        let slash = slashes.entry(cap.piece).or_insert(Slash { down: cap.down, from_m: f64::MIN, to_m: f64::MAX });
        slash.from_m = slash.from_m.max(anatomy.place(cap.underarm).dot(&cap.down));
        slash.to_m = slash.to_m.min(anatomy.place(end(&cap.seam)).dot(&cap.down));
        plan.give(body.point(end(&cap.seam)), cap.down);
    }
    if slashes.is_empty() {
        return None;
    }
    for (piece, slash) in slashes {
        spread(anatomy, &mut plan, piece, &slash);
    }
    Some(plan)
}

/// Lowers the lower edge from its centre to below the high point of the shoulder. From there the displacement falls to
/// zero at the side seams.
pub fn face_length(body: &Body<'_>, face: Face) -> Option<Plan> {
    let (trunk, anatomy) = (body.trunk.as_ref()?, body.anatomy);
    let openings = anatomy.style().openings(&|_| true);
    let sides: Vec<EdgePoint> = body.sides.iter().map(|side| body.point(end(&side.chain))).collect();
    let mut plan = Plan::default();
    let mut moved: Vec<EdgePoint> = Vec::new();
    for high in trunk.high_points(face) {
        let path = trunk.down_from(high)?.path;
        let Some(PathPart::Line([_, below])) = path.last() else { return None };
        let hem = openings.iter().find(|opening| opening.contains(&below.edge))?;
        plan.moves.push(Move::new(*below, -V2::y()));
        let own = hem.iter().filter(|edge| edge.piece == below.edge.piece);
        for corner in own.flat_map(|edge| [false, true].map(|is_last| EdgeEnd::new(*edge, is_last))) {
            let place = anatomy.place(corner);
            let is_at = |at: &EdgePoint| at.edge.piece == corner.edge.piece && anatomy.style().place(*at) == place;
            if !sides.iter().chain(&moved).any(is_at) {
                moved.push(anatomy.point(corner));
            }
        }
    }
    plan.moves.extend(moved.iter().map(|at| Move::new(*at, -V2::y())));
    let is_face =
        |m: &Move| matches!(anatomy.parts[m.at.edge.piece], Part::Trunk(own) | Part::Skirt(own) if own == face);
    (!plan.moves.is_empty() && plan.moves.iter().all(is_face)).then_some(plan)
}

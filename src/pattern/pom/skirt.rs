//! Points of measure of skirts, alone or sewn to a bodice.

use super::anatomy::{Anatomy, Chain, Part};
use super::ways::Heading;
use super::{Point, PointOfMeasure};
use crate::propose::{Class, Face, said};
use crate::style::openings::EdgeEnd;
use crate::style::{EdgeRef, PathPart};

/// Distance below the waist at which the hip is measured, as on a person of 1.7 m.
const HIP_BELOW_WAIST_M: f64 = 0.200;
/// Least ratio of chord to length of a waist edge that has a hip below it. A rounder edge is that of a circle skirt,
/// whose hip is no straight line.
const STRAIGHT: f64 = 0.9;

pub fn points(anatomy: &Anatomy<'_>) -> Vec<PointOfMeasure> {
    let found = points_at_sides(anatomy);
    if found.is_empty() { points_all_round(anatomy) } else { found }
}

/// Points of measure of a skirt in one piece or of gores, which have neither front nor back: waist and hem. Empty where
/// something else is there but bands.
fn points_all_round(anatomy: &Anatomy<'_>) -> Vec<PointOfMeasure> {
    let style = anatomy.style();
    let is_skirt = |piece: usize| said(&style.pieces[piece].id).class == Some(Class::Skirt);
    let openings = style.openings(&is_skirt);
    let has_parts = anatomy.parts.iter().any(|part| *part != Part::Other);
    let [one, other] = openings.as_slice() else { return Vec::new() };
    if has_parts {
        return Vec::new();
    }
    // What carries the skirt is sewn to its waist. Without a band it hangs from its narrower edge.
    let is_free = |opening: &[EdgeRef]| opening.iter().all(|edge| anatomy.ways.is_free(*edge));
    let is_first = match [one, other].map(|opening| is_free(opening)) {
        [false, true] => true,
        [true, false] => false,
        _ => anatomy.length_m(one) <= anatomy.length_m(other),
    };
    let (waist, hem) = if is_first { (one, other) } else { (other, one) };
    let mut held: Vec<EdgeRef> = waist.iter().flat_map(|edge| anatomy.ways.partners(*edge)).copied().collect();
    held.dedup();
    let waist = if held.is_empty() { waist } else { &held };
    let hem = anatomy.beyond(hem, is_skirt).map(|edges| anatomy.along_edges(Point::HalfHem, &edges, 0.5));
    [anatomy.along_edges(Point::HalfWaist, waist, 0.5)].into_iter().chain(hem).collect()
}

/// Empty without side seams.
fn points_at_sides(anatomy: &Anatomy<'_>) -> Vec<PointOfMeasure> {
    let is_skirt = |piece: usize| matches!(anatomy.parts[piece], Part::Skirt(_));
    let openings = anatomy.style().openings(&is_skirt);
    let top_of = |chain: &Chain| anatomy.opening_at(&openings, chain[0].other());
    let sides = side_seams(anatomy);
    let Some((side, waist)) = sides.into_iter().find_map(|[front, _]| top_of(&front).map(|top| (front, top))) else {
        return Vec::new();
    };
    let waist = &openings[waist];
    let mut found = Vec::new();
    // A dress takes waist and lengths from its bodice.
    if !anatomy.parts.iter().any(|part| matches!(part, Part::Trunk(_))) {
        let edge = anatomy.beyond(waist, is_skirt);
        found.extend(edge.map(|edges| anatomy.along_edges(Point::HalfWaist, &edges, 0.5)));
        found.extend(Face::BOTH.into_iter().filter_map(|face| centre(anatomy, waist, face)));
    }
    let hems: Vec<&Vec<EdgeRef>> = openings.iter().filter(|opening| *opening != waist).collect();
    if let [hem] = hems.as_slice() {
        let edge = anatomy.beyond(hem, is_skirt);
        found.extend(edge.map(|edges| anatomy.along_edges(Point::HalfHem, &edges, 0.5)));
    }
    if waist.iter().all(|edge| is_straight(anatomy, *edge)) {
        let round = anatomy.along(&side, HIP_BELOW_WAIST_M).and_then(|at| anatomy.ways.round(at));
        found.extend(round.map(|path| anatomy.along_path(Point::HalfHip, path, 0.5)));
    }
    found
}

/// Both sides of each side seam of a skirt, front and back, from the upper end.
pub fn side_seams(anatomy: &Anatomy<'_>) -> Vec<[Chain; 2]> {
    let is_of = |face: Face| move |part: Part| part == Part::Skirt(face);
    let seams = 0..anatomy.style().seams.len();
    let joins = seams.filter_map(|seam| anatomy.between(seam, is_of(Face::Front), is_of(Face::Back)));
    joins.filter(|[front, _]| anatomy.is_upright(front)).map(|sides| anatomy.turned_down(sides)).collect()
}

/// Path down the front, half-way between its middle and its side.
pub fn way_down(anatomy: &Anatomy<'_>) -> Option<Vec<PathPart>> {
    let is_skirt = |piece: usize| matches!(anatomy.parts[piece], Part::Skirt(_));
    let is_front = |edge: &EdgeRef| anatomy.parts[edge.piece] == Part::Skirt(Face::Front);
    let openings = anatomy.style().openings(&is_skirt);
    let height = |opening: &Vec<EdgeRef>| {
        let ends = opening.iter().filter(|edge| is_front(edge)).map(|edge| anatomy.place(EdgeEnd::new(*edge, false)).y);
        ends.fold(f64::MIN, f64::max)
    };
    let waist = openings.iter().max_by(|opening, other| height(opening).total_cmp(&height(other)))?;
    let piece = waist.iter().find(|edge| is_front(edge))?.piece;
    let own: Vec<EdgeRef> = waist.iter().copied().filter(|edge| edge.piece == piece).collect();
    let ends = own.iter().flat_map(|edge| [false, true].map(|is_last| anatomy.place(EdgeEnd::new(*edge, is_last)).x));
    let (low, high) = ends.fold((f64::MAX, f64::MIN), |(low, high), u| (low.min(u), high.max(u)));
    let top = anatomy.meeting(&own, |p| p.x - (0.25 * low + 0.75 * high))?;
    anatomy.ways.walk(top, Heading::Down, |_| false).map(|way| way.parts)
}

fn is_straight(anatomy: &Anatomy<'_>, edge: EdgeRef) -> bool {
    let [from, to] = [false, true].map(|is_last| anatomy.place(EdgeEnd::new(edge, is_last)));
    (to - from).norm() > STRAIGHT * anatomy.length_m(&[edge])
}

fn centre(anatomy: &Anatomy<'_>, waist: &[EdgeRef], face: Face) -> Option<PointOfMeasure> {
    let point = if face == Face::Front { Point::CentreFrontLength } else { Point::CentreBackLength };
    let own: Vec<EdgeRef> =
        waist.iter().copied().filter(|edge| anatomy.parts[edge.piece] == Part::Skirt(face)).collect();
    let piece = own.first()?.piece;
    // Half a skirt is sewn to the other half at one end of its waist.
    let ends = own.iter().flat_map(|edge| [EdgeEnd::new(*edge, false), EdgeEnd::new(*edge, true)]);
    let is_centre = |end: &EdgeEnd| {
        let next = anatomy.style().over_corner(*end).edge;
        let is_half = |other: &EdgeRef| other.piece != next.piece && anatomy.parts[other.piece] == Part::Skirt(face);
        anatomy.ways.partners(next).iter().any(is_half)
    };
    if let Some(end) = ends.into_iter().find(is_centre) {
        let path = anatomy.down_centre(end);
        return (!path.is_empty()).then(|| anatomy.along_path(point, path, 1.0));
    }
    if own.iter().any(|edge| edge.piece != piece) {
        return None;
    }
    let corners =
        own.iter().flat_map(|edge| [false, true].map(|is_last| anatomy.place(EdgeEnd::new(*edge, is_last)).x));
    let (low, high) = corners.fold((f64::MAX, f64::MIN), |(low, high), u| (low.min(u), high.max(u)));
    let at = anatomy.meeting(&own, |p| p.x - 0.5 * (low + high))?;
    let way = anatomy.ways.walk(at, Heading::Down, |_| false)?;
    Some(anatomy.along_path(point, way.parts, 1.0))
}

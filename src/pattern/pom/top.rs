//! Points of measure of garments of the trunk.

use super::anatomy::{Anatomy, BELOW_ARMHOLE_M, BESIDE_M, Chain, Part, distance};
use super::ways::Heading;
use super::{Point, PointOfMeasure};
use crate::propose::Face;
use crate::style::openings::EdgeEnd;
use crate::style::{EdgePoint, EdgeRef, PathPart};
use geom::V2;

/// For straight sides: from chest to waist of a person of 1.7 m.
const WAIST_BELOW_ARMHOLE_M: f64 = 0.180;
/// Least distance of the narrowest girth from armhole and hem, and spacing of the candidates.
const FROM_ENDS_M: f64 = 0.060;
const STEP_M: f64 = 0.005;
/// Least difference of the narrowest girth from those at both ends that makes a waist.
const SHAPED_M: f64 = 0.008;
/// Greatest slant of the front edge of an open garment from the vertical, as the tangent of the angle.
const FRONT_EDGE_SLANT: f64 = 0.14;
/// Greatest distance of such an edge from the side of its piece, as a share of the width of the piece.
const FRONT_EDGE_INSET: f64 = 0.1;

fn is_face(face: Face) -> impl Fn(Part) -> bool {
    move |part| part == Part::Trunk(face)
}

/// The trunk of a garment: front and back pieces, sewn to each other without any others.
pub struct Trunk<'a> {
    anatomy: &'a Anatomy<'a>,
    /// Closed chains of free edges: neck, armholes, lower end.
    pub openings: Vec<Vec<EdgeRef>>,
    /// Both sides of each side seam that ends at an armhole or at the top edge: front and back, directed downwards.
    pub sides: Vec<[Chain; 2]>,
    /// Front and back side of each shoulder seam, directed outwards from the neck.
    pub shoulders: Vec<[Chain; 2]>,
    /// Indices of the openings that are armholes.
    pub armholes: Vec<usize>,
    pub neck: Vec<EdgeRef>,
    pub bottom: Vec<EdgeRef>,
}

impl<'a> Trunk<'a> {
    /// `None` for a style without side seams between a front and a back.
    pub fn of(anatomy: &'a Anatomy<'a>) -> Option<Self> {
        let openings = anatomy.style().openings(&|piece| matches!(anatomy.parts[piece], Part::Trunk(_)));
        let seams = 0..anatomy.style().seams.len();
        let joins = seams.filter_map(|seam| anatomy.between(seam, is_face(Face::Front), is_face(Face::Back)));
        let (upright, across): (Vec<_>, Vec<_>) = joins.partition(|[front, _]| anatomy.is_upright(front));
        let start = |chain: &Chain| -> EdgeEnd { chain[0].other() };
        let end = |chain: &Chain| -> EdgeEnd { chain[chain.len() - 1] };
        let all_sides: Vec<[Chain; 2]> = upright.into_iter().map(|sides| anatomy.turned_down(sides)).collect();
        let opening = |at: EdgeEnd| anatomy.opening_at(&openings, at);
        let sides: Vec<[Chain; 2]> = all_sides
            .iter()
            .filter(|[front, _]| opening(start(front)).is_some())
            .map(|side| anatomy.over_darts(side, &all_sides))
            .collect();
        let tops: Vec<usize> = sides.iter().filter_map(|[front, _]| opening(start(front))).collect();
        // In a garment without shoulders, two side seams end at one opening: its top edge.
        let armholes: Vec<usize> =
            tops.iter().copied().filter(|top| tops.iter().filter(|other| *other == top).count() == 1).collect();
        let shoulder = |sides: [Chain; 2]| -> Option<[Chain; 2]> {
            let ends = [opening(start(&sides[0])), opening(end(&sides[0]))];
            let is_outer = ends.map(|end| end.is_some_and(|end| armholes.contains(&end)));
            match is_outer {
                [false, true] => Some(sides),
                [true, false] => Some(sides.map(|chain| chain.into_iter().rev().map(|step| step.other()).collect())),
                _ => None,
            }
        };
        let shoulders: Vec<[Chain; 2]> = across.into_iter().filter_map(shoulder).collect();
        let neck = shoulders.first().and_then(|[front, _]| opening(start(front)));
        let bottom = all_sides.iter().filter_map(|[front, _]| opening(end(front))).find(|k| !armholes.contains(k));
        let mut trunk = Self {
            anatomy,
            neck: neck.map_or_else(Vec::new, |k| openings[k].clone()),
            bottom: bottom.map_or_else(Vec::new, |k| openings[k].clone()),
            openings,
            sides,
            shoulders,
            armholes,
        };
        if neck.is_some() && neck == bottom {
            trunk.part_neck_from_hem();
        }
        (!trunk.sides.is_empty()).then_some(trunk)
    }

    pub fn points(&self) -> Vec<PointOfMeasure> {
        let mut found = self.girths();
        for face in Face::BOTH {
            found.extend(self.lengths(face));
            found.extend(self.across(face));
        }
        found.extend(self.shoulders());
        found.extend(self.neck());
        found
    }

    /// One opening of a garment that is open in front holds both, with the front edges between.
    fn part_neck_from_hem(&mut self) {
        let opening = std::mem::take(&mut self.neck);
        let Some(first) = opening.iter().position(|edge| self.is_front_edge(*edge)) else {
            self.bottom.clear();
            return;
        };
        let ring = || opening[first..].iter().chain(&opening[..first]).copied();
        let is_front_edge = |edge: &EdgeRef| self.is_front_edge(*edge);
        let stretches: Vec<Vec<EdgeRef>> = ring()
            .collect::<Vec<_>>()
            .split(is_front_edge)
            .filter(|part| !part.is_empty())
            .map(<[_]>::to_vec)
            .collect();
        let touches = |part: &Vec<EdgeRef>, ends: &[EdgeEnd]| {
            ends.iter().any(|end| part.contains(&self.anatomy.style().over_corner(*end).edge))
        };
        let high: Vec<EdgeEnd> = self.shoulders.iter().map(|[front, _]| front[0].other()).collect();
        let neck = stretches.iter().find(|part| touches(part, &high)).cloned();
        let bottom = stretches.into_iter().filter(|part| Some(part) != neck.as_ref()).max_by_key(Vec::len);
        self.neck = neck.unwrap_or_default();
        self.bottom = bottom.unwrap_or_default();
    }

    fn is_front_edge(&self, edge: EdgeRef) -> bool {
        if self.anatomy.parts[edge.piece] != Part::Trunk(Face::Front) {
            return false;
        }
        let [from, to] = [false, true].map(|is_last| self.anatomy.place(EdgeEnd::new(edge, is_last)));
        let outline = self.anatomy.style().pieces[edge.piece].outline();
        let (low, high) = outline.iter().fold((f64::MAX, f64::MIN), |(low, high), p| (low.min(p.x), high.max(p.x)));
        let middle = 0.5 * (from.x + to.x);
        let is_outer = (middle - low).min(high - middle) < FRONT_EDGE_INSET * (high - low);
        is_outer && (to.x - from.x).abs() < FRONT_EDGE_SLANT * (to.y - from.y).abs()
    }

    fn girths(&self) -> Vec<PointOfMeasure> {
        let anatomy = self.anatomy;
        let mut found = Vec::new();
        let side = &self.sides[0][0];
        let round = |below_m: f64| self.round_along(side, below_m);
        let chest = self.round_below_armhole(BELOW_ARMHOLE_M);
        found.extend(chest.map(|path| anatomy.along_path(Point::HalfChest, path, 0.5)));
        let is_trunk = |piece: usize| matches!(anatomy.parts[piece], Part::Trunk(_));
        if anatomy.has_below(&self.bottom) {
            found.push(anatomy.along_edges(Point::HalfWaist, &self.bottom, 0.5));
        } else {
            let length_m: f64 = side.iter().map(|step| anatomy.length_m(&[step.edge])).sum();
            let places =
                (0..).map(|k| FROM_ENDS_M + STEP_M * f64::from(k)).take_while(|at| *at < length_m - FROM_ENDS_M);
            let girths = places.filter_map(|at| Some((at, anatomy.style().path_length_m(&round(at)?))));
            found.extend(
                round(waist(&girths.collect::<Vec<_>>())).map(|path| anatomy.along_path(Point::HalfWaist, path, 0.5)),
            );
        }
        let hem = Some(&self.bottom).filter(|bottom| !bottom.is_empty()).and_then(|b| anatomy.beyond(b, is_trunk));
        found.extend(hem.map(|hem| anatomy.along_edges(Point::HalfHem, &hem, 0.5)));
        found
    }

    fn round_along(&self, side: &Chain, below_m: f64) -> Option<Vec<PathPart>> {
        self.anatomy.along(side, below_m).and_then(|at| self.anatomy.ways.round(at))
    }

    /// Path round the body at a distance below the armhole along the side seam, m. `None` past the end of the seam.
    pub fn round_below_armhole(&self, below_m: f64) -> Option<Vec<PathPart>> {
        let side = &self.sides[0][0];
        self.round_along(side, below_m + self.dip_m(side))
    }

    /// Distance from the high point of the shoulder, m. `None` above the armhole, and past the lower edge.
    pub fn round_below_neck(&self, below_m: f64) -> Option<Vec<PathPart>> {
        let underarm_m = self.underarm_below_neck_m()?;
        let down = self.way_down()?;
        let ways = &self.anatomy.ways;
        let at = ways.along(&down.path, below_m - down.below_neck_m).filter(|_| below_m >= underarm_m)?;
        ways.round_through(at)
    }

    /// Depth of the armhole below the upper end of a side seam: a panel between front and back is hollow at the top.
    fn dip_m(&self, side: &Chain) -> f64 {
        let anatomy = self.anatomy;
        let top = side[0].other();
        let armholes = self.armholes.iter().flat_map(|k| &self.openings[*k]);
        let own = armholes.filter(|edge| edge.piece == top.edge.piece);
        let heights = own.flat_map(|edge| anatomy.style().edge(*edge).line.points()).map(|p| p.y);
        heights.map(|y| anatomy.place(top).y - y).fold(0.0, f64::max)
    }

    /// Corners of front or back at which the shoulder meets the neck.
    pub fn high_points(&self, face: Face) -> Vec<EdgeEnd> {
        self.shoulders.iter().map(|sides| sides[usize::from(face == Face::Back)][0]).map(|step| step.other()).collect()
    }

    fn lengths(&self, face: Face) -> Vec<PointOfMeasure> {
        let anatomy = self.anatomy;
        let (from_shoulder, centre) = match face {
            Face::Front => (Point::FrontLength, Point::CentreFrontLength),
            Face::Back => (Point::BackLength, Point::CentreBackLength),
        };
        let mut found = Vec::new();
        let high = self.high_points(face);
        let down = |at: EdgePoint| anatomy.ways.walk(at, Heading::Down, |_| false).map(|way| way.parts);
        found.extend(high.first().and_then(|end| self.length_from_neck(from_shoulder, *end)));
        match self.neck_centre(face) {
            Some(Centre::Within(at)) => found.extend(down(at).map(|path| anatomy.along_path(centre, path, 1.0))),
            Some(Centre::Corner(end)) => {
                let path = anatomy.down_centre(end);
                found.extend((!path.is_empty()).then(|| anatomy.along_path(centre, path, 1.0)));
            }
            None => {}
        }
        found
    }

    /// Length straight down. Where the neckline dips below the shoulder, the path begins at the neckline, and the
    /// distance above it is added, as a tape would span it.
    fn length_from_neck(&self, point: Point, high: EdgeEnd) -> Option<PointOfMeasure> {
        let down = self.down_from(high)?;
        let along = self.anatomy.along_path(point, down.path, 1.0);
        Some(PointOfMeasure { length_m: along.length_m + down.below_neck_m, ..along })
    }

    pub fn down_from(&self, high: EdgeEnd) -> Option<PathFromNeck> {
        let anatomy = self.anatomy;
        let top = anatomy.place(high);
        let own: Vec<EdgeRef> = self.neck.iter().copied().filter(|edge| edge.piece == high.edge.piece).collect();
        // The path begins a little outwards on the shoulder: a square neckline falls straight down from the high point.
        let outwards = (anatomy.place(high.other()).x - top.x).signum();
        let beside = |p: V2| p.x - top.x - outwards * BESIDE_M;
        let start = anatomy.meeting(&[high.edge], beside).unwrap_or_else(|| anatomy.point(high));
        let height = |at: EdgePoint| anatomy.style().place(at).y;
        let below = anatomy.lowest_meeting(&own, beside).filter(|at| height(start) - height(*at) > BESIDE_M);
        let from = below.unwrap_or(start);
        let way = anatomy.ways.walk(from, Heading::Down, |_| false)?;
        Some(PathFromNeck { path: way.parts, below_neck_m: top.y - height(from) })
    }

    pub fn way_down(&self) -> Option<PathFromNeck> {
        self.down_from(*self.high_points(Face::Front).first()?)
    }

    /// Height of the high point of the shoulder above the underarm. `None` if no piece has both.
    fn underarm_below_neck_m(&self) -> Option<f64> {
        let underarms = self.sides.iter().flatten().map(|chain| chain[0].other());
        let high = Face::BOTH.into_iter().flat_map(|face| self.high_points(face)).collect::<Vec<_>>();
        underarms.into_iter().find_map(|underarm| {
            let high = high.iter().find(|high| high.edge.piece == underarm.edge.piece)?;
            Some(self.anatomy.place(*high).y - self.anatomy.place(underarm).y)
        })
    }

    /// `None` if no piece has high point and underarm.
    pub fn chest_below_neck_m(&self) -> Option<f64> {
        self.underarm_below_neck_m().map(|m| m + BELOW_ARMHOLE_M)
    }

    /// Waist seam at the side. `None` if nothing hangs from the trunk, or no piece has high point and underarm.
    pub fn waist_below_neck_m(&self) -> Option<f64> {
        let side_m: f64 = self.sides[0][0].iter().map(|step| self.anatomy.length_m(&[step.edge])).sum();
        self.underarm_below_neck_m().filter(|_| self.anatomy.has_below(&self.bottom)).map(|m| m + side_m)
    }

    /// Front sides, directed downwards.
    pub fn side_seams(&self) -> Vec<Chain> {
        self.sides.iter().map(|[front, _]| front.clone()).collect()
    }

    /// Points of the armhole seams at the outer ends of the shoulders.
    pub fn shoulder_points(&self) -> Vec<EdgePoint> {
        let outer = self.shoulders.iter().map(|[front, _]| front[front.len() - 1]);
        outer.map(|end| self.anatomy.point(self.anatomy.style().over_corner(end))).collect()
    }

    pub fn neck_centre(&self, face: Face) -> Option<Centre> {
        let anatomy = self.anatomy;
        let high = self.high_points(face);
        let first = high.first()?;
        let own: Vec<EdgeRef> = self.neck.iter().copied().filter(|edge| edge.piece == first.edge.piece).collect();
        if let Some(other) = high.iter().skip(1).find(|end| end.edge.piece == first.edge.piece) {
            let middle = 0.5 * (anatomy.place(*first).x + anatomy.place(*other).x);
            return anatomy.meeting(&own, |p| p.x - middle).map(Centre::Within);
        }
        self.neck_end(*first).map(Centre::Corner)
    }

    /// End of the neckline of half a front or back, opposite its high point.
    pub fn neck_end(&self, high: EdgeEnd) -> Option<EdgeEnd> {
        let mut at = high;
        loop {
            let next = self.anatomy.style().over_corner(at);
            if next.edge.piece != high.edge.piece || !self.neck.contains(&next.edge) {
                return (at != high).then_some(at);
            }
            at = next.other();
        }
    }

    fn neck(&self) -> Vec<PointOfMeasure> {
        let anatomy = self.anatomy;
        let mut found = Vec::new();
        for face in [Face::Back, Face::Front] {
            let (Some(centre), Some(high)) = (self.neck_centre(face), self.high_points(face).first().copied()) else {
                continue;
            };
            let (at, half_m) = match centre {
                Centre::Within(at) => {
                    let at = anatomy.style().place(at);
                    (at, (anatomy.place(high).x - at.x).abs())
                }
                Centre::Corner(end) => (anatomy.place(end), (anatomy.place(high).x - anatomy.place(end).x).abs()),
            };
            // The width is that of the back, because fronts may overlap.
            if found.is_empty() {
                found.push(distance(Point::NeckWidth, 2.0 * half_m));
            }
            let drop = if face == Face::Back { Point::BackNeckDrop } else { Point::FrontNeckDrop };
            found.push(distance(drop, anatomy.place(high).y - at.y));
        }
        if !self.neck.is_empty() {
            found.push(anatomy.along_edges(Point::Neck, &self.neck, 1.0));
        }
        found
    }

    fn shoulders(&self) -> Vec<PointOfMeasure> {
        let anatomy = self.anatomy;
        let mut found = Vec::new();
        if let Some([front, _]) = self.shoulders.first() {
            let edges: Vec<EdgeRef> = front.iter().map(|step| step.edge).collect();
            found.push(anatomy.along_edges(Point::Shoulder, &edges, 1.0));
        }
        let outer: Vec<EdgeEnd> = self.shoulders.iter().map(|[_, back]| back[back.len() - 1]).collect();
        let halves = || {
            let Some(Centre::Corner(centre)) = self.neck_centre(Face::Back) else { return None };
            let end = outer.first().filter(|end| end.edge.piece == centre.edge.piece)?;
            Some(2.0 * (anatomy.place(*end).x - anatomy.place(centre).x).abs())
        };
        let width_m = match outer.as_slice() {
            [point, other, ..] if point.edge.piece == other.edge.piece => {
                Some((anatomy.place(*point) - anatomy.place(*other)).norm())
            }
            _ => halves(),
        };
        found.extend(width_m.map(|m| distance(Point::AcrossShoulder, m)));
        if let Some(armhole) = self.armholes.first() {
            found.push(anatomy.along_edges(Point::Armhole, &self.openings[*armhole], 1.0));
        }
        found
    }

    /// Width half-way up the armhole.
    fn across(&self, face: Face) -> Option<PointOfMeasure> {
        let starts = self.armholes.iter().filter_map(|k| self.half_way_up(*k, face));
        self.across_from(face, &starts.collect::<Vec<_>>())
    }

    /// Width at a distance below the high point of the shoulder. `None` where no armhole is.
    pub fn across_below_neck_m(&self, face: Face, below_m: f64) -> Option<f64> {
        let anatomy = self.anatomy;
        let level = |armhole: &usize| {
            let own = self.openings[*armhole].iter().filter(|edge| anatomy.parts[edge.piece] == Part::Trunk(face));
            let own: Vec<EdgeRef> = own.copied().collect();
            // A yoke has the high point, and the piece below it the armhole: they have no level in common.
            let high =
                self.high_points(face).into_iter().find(|high| own.iter().any(|edge| edge.piece == high.edge.piece))?;
            let top = anatomy.place(high).y;
            let own: Vec<EdgeRef> = own.into_iter().filter(|edge| edge.piece == high.edge.piece).collect();
            anatomy.meeting(&own, |p| p.y - top + below_m)
        };
        let starts: Vec<EdgePoint> = self.armholes.iter().filter_map(level).collect();
        self.across_from(face, &starts).map(|found| found.length_m)
    }

    /// Width from armhole to armhole, level from a point of each.
    fn across_from(&self, face: Face, starts: &[EdgePoint]) -> Option<PointOfMeasure> {
        let anatomy = self.anatomy;
        let point = if face == Face::Front { Point::AcrossFront } else { Point::AcrossBack };
        let is_armhole = |edge: EdgeRef| self.armholes.iter().any(|k| self.openings[*k].contains(&edge));
        let first = *starts.first()?;
        let ahead = anatomy.ways.walk(first, Heading::Level, |at| is_armhole(at.edge))?;
        if is_armhole(ahead.end.edge) {
            return Some(anatomy.along_path(point, ahead.parts, 1.0));
        }
        let place = |at: EdgePoint| anatomy.style().place(at);
        if !self.neck.contains(&ahead.end.edge) {
            // If the front is open there, its other half is added.
            let behind = anatomy.ways.walk(*starts.get(1)?, Heading::Level, |at| is_armhole(at.edge))?;
            return Some(anatomy.along_path(point, [ahead.parts, behind.parts].concat(), 1.0));
        }
        // The width spans a low neckline.
        let other = starts.get(1).filter(|other| other.edge.piece == first.edge.piece);
        let halves = || match self.neck_centre(face) {
            Some(Centre::Corner(end)) if end.edge.piece == first.edge.piece => {
                Some(2.0 * (place(first).x - anatomy.place(end).x).abs())
            }
            _ => None,
        };
        let width_m = other.map(|other| (place(*other) - place(first)).norm()).or_else(halves);
        width_m.map(|m| distance(point, m))
    }

    /// In height if one piece has underarm and shoulder, otherwise along the armhole.
    fn half_way_up(&self, armhole: usize, face: Face) -> Option<EdgePoint> {
        let anatomy = self.anatomy;
        let on_face = |edge: &&EdgeRef| anatomy.parts[edge.piece] == Part::Trunk(face);
        let edges: Vec<EdgeRef> = self.openings[armhole].iter().filter(on_face).copied().collect();
        let first = *edges.first()?;
        if edges.iter().all(|edge| edge.piece == first.piece) {
            let points = || edges.iter().flat_map(|edge| anatomy.style().edge(*edge).line.points());
            let ends = edges
                .iter()
                .flat_map(|edge| [false, true].map(|is_last| anatomy.place(EdgeEnd::new(*edge, is_last)).y));
            let low = points().map(|p| p.y).fold(f64::MAX, f64::min);
            let high = ends.fold(f64::MIN, f64::max);
            return anatomy.meeting(&edges, |p| p.y - 0.5 * (low + high));
        }
        let mut rest_m = 0.5 * anatomy.length_m(&edges);
        for edge in edges {
            let length_m = anatomy.length_m(&[edge]);
            if rest_m <= length_m {
                return Some(EdgePoint { edge, arc_m: rest_m });
            }
            rest_m -= length_m;
        }
        None
    }
}

pub struct PathFromNeck {
    pub path: Vec<PathPart>,
    /// Distance of the beginning of the path below the high point of the shoulder.
    pub below_neck_m: f64,
}

/// Intersection of the neckline with the centre of a front or back.
pub enum Centre {
    /// Whole piece.
    Within(EdgePoint),
    /// Half a piece.
    Corner(EdgeEnd),
}

/// Distance of the waist of a top below the armhole, m: that of the narrowest girth, or for straight sides a usual one.
/// `girths` are (distance below the armhole, girth), m.
fn waist(girths: &[(f64, f64)]) -> f64 {
    let narrowest = girths.iter().min_by(|candidate, other| candidate.1.total_cmp(&other.1));
    match (girths, narrowest) {
        ([first, .., last], Some(least)) if least.1 + SHAPED_M < first.1.min(last.1) => least.0,
        _ => WAIST_BELOW_ARMHOLE_M,
    }
}

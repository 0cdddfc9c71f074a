//! Changes of the entities of a piece, each by its kind and layer.

use std::ops::Range;

use geom::V2;
use geom::polyline::{boundary_distance, contains, signed_area};
use geom::units::from_mm;

use super::sheet::Sheet;
use super::sides::{DRAWN_M, Side, on_sides};
use super::{Entity, Redraw, Spot, spots};
use crate::dxf::units::Unit;

const AT_VERTEX_M: f64 = 0.5e-3;
/// Turning angle from which a curve point is a corner: 30 degrees.
const CORNER_RAD: f64 = 0.52;
/// Ratio of neighbouring sides below which the longer one is no part of a curve.
const SHORTER: f64 = 0.25;
const STILL_M: f64 = 1e-6;
/// Flags of a polyline and of its vertices [DXF reference, POLYLINE, VERTEX].
const CLOSED: i32 = 1;
const FRAME_OF_SPLINE: i32 = 16;
/// Group codes of an LWPOLYLINE vertex after its x: y, widths, bulge, identifier.
const OF_VERTEX: [i32; 5] = [20, 40, 41, 42, 91];
const NOTCHES: [&str; 5] = ["4", "80", "81", "82", "83"];

pub struct Redrawing<'s, 'a, 'r> {
    sheet: &'s mut Sheet<'a>,
    redraw: &'r Redraw<'r>,
    /// Metres in a unit of the file.
    scale: f64,
    marks_curves: bool,
    sides: Vec<Side>,
    /// Curve points to add, m.
    marks: Vec<V2>,
    departs_m: f64,
}

struct Chain {
    /// In the unit of the file. Along a normal that points down, x is reversed.
    spots: Vec<Spot>,
    ranges: Vec<Range<usize>>,
    is_closed: bool,
    /// -1 if x is reversed.
    sense: f64,
}

impl<'s, 'a, 'r> Redrawing<'s, 'a, 'r> {
    pub fn new(sheet: &'s mut Sheet<'a>, unit: Unit, redraw: &'r Redraw<'r>, marks_curves: bool) -> Self {
        let scale = from_mm(unit.mm_per_unit());
        Self { sheet, redraw, scale, marks_curves, sides: Vec::new(), marks: Vec::new(), departs_m: 0.0 }
    }

    /// Returns the greatest distance of an outline from where it is carried to, m.
    pub fn draw(mut self, entities: &[&Entity<'_>]) -> f64 {
        // Outlines come first: what lies on them stays on them.
        let (outlines, others): (Vec<&Entity<'_>>, Vec<&Entity<'_>>) =
            entities.iter().partition(|entity| self.is_outline(entity));
        // The cut line comes before them all.
        let (cut, within): (Vec<&Entity<'_>>, Vec<&Entity<'_>>) =
            outlines.into_iter().partition(|entity| entity.layer == "1");
        cut.into_iter().chain(within).for_each(|entity| self.outline(entity));
        self.mark_curves(&others);
        let shift_of = |layer: &str| {
            let first =
                others.iter().find(|entity| entity.layer == layer && matches!(entity.kind, "LINE" | "POLYLINE"));
            first.map_or_else(V2::zeros, |line| self.shift_of_middle(line))
        };
        let shifts = [("7", shift_of("7")), ("5", shift_of("5"))];
        for entity in others {
            match shifts.iter().find(|(layer, _)| *layer == entity.layer) {
                // Grain line and grade reference line keep their directions.
                Some((_, shift)) if matches!(entity.kind, "LINE" | "POLYLINE" | "LWPOLYLINE") => {
                    self.shift(entity, *shift);
                }
                _ => self.other(entity),
            }
        }
        self.departs_m
    }

    /// True also for a line that tells how a cut or sewn line runs.
    fn is_outline(&self, entity: &Entity<'_>) -> bool {
        match (entity.kind, entity.layer) {
            ("LINE" | "POLYLINE" | "LWPOLYLINE", "1" | "14" | "84" | "87") => true,
            // Old Valentina files draw the sew line here.
            ("POLYLINE" | "LWPOLYLINE", "8") => {
                let chain = self.chain(entity);
                let points: Vec<V2> = chain.spots.iter().map(|spot| spot.at * self.scale).collect();
                let area_m2 = signed_area(&points).abs();
                (chain.is_closed
                    || points.first().zip(points.last()).is_some_and(|(a, b)| (a - b).norm() < AT_VERTEX_M))
                    && area_m2 > 0.5 * self.redraw.piece.area_m2()
            }
            _ => false,
        }
    }

    /// Place of a point after the change: with the drawn outlines, or as it is carried.
    fn place(&self, at: V2) -> V2 {
        on_sides(&self.sides, at).unwrap_or_else(|| (self.redraw.carried)(at))
    }

    fn set(&mut self, spot: Spot, sense: f64, to: V2) {
        if (to - self.metres(spot, sense)).norm() > STILL_M {
            self.sheet.set(spot.x, sense * to.x / self.scale);
            self.sheet.set(spot.y, to.y / self.scale);
        }
    }

    fn metres(&self, spot: Spot, sense: f64) -> V2 {
        V2::new(sense * spot.at.x, spot.at.y) * self.scale
    }

    fn chain(&self, entity: &Entity<'_>) -> Chain {
        let flag = |range: &Range<usize>, code: i32| {
            let tag = range.clone().find(|&tag| self.sheet.tags[tag].code == code);
            tag.map_or(0.0, |tag| self.sheet.number(tag))
        };
        let is_closed = flag(&entity.head, 70) as i32 & CLOSED != 0;
        let sense = if flag(&entity.head, 230) < 0.0 { -1.0 } else { 1.0 };
        let head = entity.head.clone();
        match entity.kind {
            "POLYLINE" => {
                let is_drawn = |range: &&Range<usize>| flag(range, 70) as i32 & FRAME_OF_SPLINE == 0;
                let first = |range: &Range<usize>| {
                    Some((spots(self.sheet, range.clone(), 10).into_iter().next()?, range.clone()))
                };
                let (spots, ranges) = entity.vertices.iter().filter(is_drawn).filter_map(first).unzip();
                Chain { spots, ranges, is_closed, sense }
            }
            "LWPOLYLINE" => {
                let spots = spots(self.sheet, head.clone(), 10);
                let range = |spot: &Spot| {
                    let more = |&tag: &usize| OF_VERTEX.contains(&self.sheet.tags[tag].code);
                    spot.x..(spot.x + 1..head.end).take_while(more).last().map_or(spot.y, |last| last) + 1
                };
                let ranges = spots.iter().map(range).collect();
                Chain { spots, ranges, is_closed, sense }
            }
            _ => {
                let ends = [10, 11].into_iter().filter_map(|code| spots(self.sheet, head.clone(), code).pop());
                // A LINE is drawn in world coordinates, whatever its normal.
                Chain { spots: ends.collect(), ranges: vec![head.clone(), head.clone()], is_closed: false, sense: 1.0 }
            }
        }
    }

    /// Adds points to straight sides that bend.
    fn outline(&mut self, entity: &Entity<'_>) {
        let chain = self.chain(entity);
        let points: Vec<V2> = chain.spots.iter().map(|spot| self.metres(*spot, chain.sense)).collect();
        let n = points.len();
        let is_own = matches!(entity.layer, "1" | "14" | "8");
        // A sew line that ends on the cut line still does.
        let mut places: Vec<V2> = points.iter().map(|point| self.place(*point)).collect();
        let mut added = 0;
        for side in 0..if chain.is_closed { n } else { n.saturating_sub(1) } {
            let next = (side + 1) % n;
            let bulge = self.bulge(&chain, side);
            let is_sewn = self.is_sewn([points[side], points[next]]);
            let is_divided = bulge.is_none() && is_sewn && !self.is_chord(&points, chain.is_closed, side);
            let drawn =
                Side::new([points[side], points[next]], [places[side], places[next]], self.redraw.carried, is_divided);
            match bulge {
                Some((tag, bulge)) => self.bend(tag, bulge, [points[side], points[next]], chain.sense),
                None => self.departs_m = self.departs_m.max(if is_own && is_sewn { drawn.departs_m } else { 0.0 }),
            }
            let between: Vec<V2> = drawn.between().collect();
            added += between.len();
            match (entity.kind, between.first()) {
                ("LINE", Some(first)) => {
                    self.divide_line(entity, &chain.spots, &between, places[1]);
                    places[1] = *first;
                }
                _ => self.divide(&chain, side, &between),
            }
            if is_own {
                self.mark(&drawn, &points);
                self.sides.push(drawn);
            }
        }
        for (spot, place) in chain.spots.iter().zip(places) {
            self.set(*spot, chain.sense, place);
        }
        let count = entity.head.clone().find(|&tag| self.sheet.tags[tag].code == 90);
        if let Some(tag) = count.filter(|_| entity.kind == "LWPOLYLINE" && added > 0) {
            self.sheet.set_count(tag, n + added);
        }
    }

    /// False where a quality curve is followed.
    fn is_sewn(&self, [from, to]: [V2; 2]) -> bool {
        let (middle, piece) = (from.lerp(&to, 0.5), self.redraw.piece);
        let lines = [Some(&piece.outline), piece.sew_line.as_ref()];
        lines.into_iter().flatten().any(|line| boundary_distance(line, &middle) < DRAWN_M)
    }

    /// True for a side that stands for a part of a curve. It is not divided: programs draw a smooth curve through the
    /// points, which a point on a chord would flatten.
    ///
    /// An end of such a side is a curve point where the outline turns, but less than at a corner, and the next side is
    /// not much shorter.
    fn is_chord(&self, points: &[V2], is_closed: bool, side: usize) -> bool {
        let n = points.len();
        let [from, to] = [points[side], points[(side + 1) % n]];
        let before = (is_closed || side > 0).then(|| points[(side + n - 1) % n]);
        let after = (is_closed || side + 2 < n).then(|| points[(side + 2) % n]);
        let piece = self.redraw.piece;
        let is_marked = |at: V2| {
            let is_near = |point: &V2| (point - at).norm() < AT_VERTEX_M;
            piece.curve_points.iter().any(is_near) && !piece.turn_points.iter().any(is_near)
        };
        let is_bent = |at: V2, beside: Option<V2>| {
            let length_m = (to - from).norm();
            beside.is_some_and(|beside| {
                let turn = (at - beside).angle(&(from + to - at - at));
                // An arc that turns so much from chord to chord leaves its chord by an eighth of the turn.
                turn < CORNER_RAD && 0.125 * turn * length_m > DRAWN_M && (at - beside).norm() > SHORTER * length_m
            })
        };
        [(from, before), (to, after)].into_iter().any(|(at, beside)| is_marked(at) && is_bent(at, beside))
    }

    fn divide(&mut self, chain: &Chain, vertex: usize, between: &[V2]) {
        let (spot, range) = (chain.spots[vertex], chain.ranges[vertex].clone());
        for point in between {
            let numbers = [(spot.x, chain.sense * point.x / self.scale), (spot.y, point.y / self.scale)];
            self.sheet.copy(range.clone(), &numbers, |code| code == 42, range.end - 1);
        }
    }

    /// Adds a LINE from each point to the next, and on to `last`.
    fn divide_line(&mut self, entity: &Entity<'_>, ends: &[Spot], between: &[V2], last: V2) {
        let [from, to] = ends else { return };
        for (k, start) in between.iter().enumerate() {
            let end = between.get(k + 1).unwrap_or(&last);
            let points = [(from, start), (to, end)];
            let numbers: Vec<(usize, f64)> =
                points.iter().flat_map(|(spot, p)| [(spot.x, p.x / self.scale), (spot.y, p.y / self.scale)]).collect();
            self.sheet.copy(entity.head.clone(), &numbers, |_| false, entity.last);
        }
    }

    /// Notes curve points for added vertices: where the file marks the curves of this line, or of other pieces alone.
    fn mark(&mut self, drawn: &Side, line: &[V2]) {
        let piece = self.redraw.piece;
        let is_on = |mark: &V2| line.iter().any(|vertex| (vertex - mark).norm() < AT_VERTEX_M);
        let is_marked = (piece.curve_points.is_empty() && self.marks_curves) || piece.curve_points.iter().any(is_on);
        // Two lines may draw the same side.
        if is_marked && !self.sides.iter().any(|side| side.is_drawn_again_by(drawn)) {
            self.marks.extend(drawn.between());
        }
    }

    /// Adds them after the last curve point of the piece.
    fn mark_curves(&mut self, others: &[&Entity<'_>]) {
        let is_point = |entity: &&&Entity<'_>| entity.kind == "POINT";
        let own = others.iter().rev().find(|entity| is_point(entity) && entity.layer == "3");
        let Some(after) = own.or_else(|| others.iter().rev().find(is_point)).or(others.last()) else { return };
        for point in std::mem::take(&mut self.marks) {
            let [x, y] = [point.x / self.scale, point.y / self.scale];
            match own.and_then(|own| spots(self.sheet, own.head.clone(), 10).pop()) {
                Some(spot) => self.sheet.copy(after.head.clone(), &[(spot.x, x), (spot.y, y)], |_| false, after.last),
                None => self.sheet.add_point("POINT", "3", [x, y], after.last),
            }
        }
    }

    /// Tag and value. `None` for a straight side.
    fn bulge(&self, chain: &Chain, side: usize) -> Option<(usize, f64)> {
        let tag = chain.ranges[side].clone().find(|&tag| self.sheet.tags[tag].code == 42)?;
        let bulge = self.sheet.number(tag);
        (bulge != 0.0).then_some((tag, bulge))
    }

    /// The arc goes through the carried middle of the arc before.
    fn bend(&mut self, tag: usize, bulge: f64, [from, to]: [V2; 2], sense: f64) {
        let chord = to - from;
        let middle = from + chord * 0.5 + V2::new(chord.y, -chord.x) * (0.5 * bulge * sense);
        let [start, middle, end] = [from, middle, to].map(self.redraw.carried);
        let is_still = [(start, from), (end, to)].iter().all(|(p, was)| (p - was).norm() < STILL_M);
        if !is_still {
            let (to_start, to_end) = (start - middle, end - middle);
            let half = 0.5 * (std::f64::consts::PI - to_start.angle(&to_end));
            self.sheet.set(tag, half.tan().copysign((end - start).perp(&(start - middle))) * sense);
        }
    }

    /// The arc goes through its carried ends and middle.
    fn arc(&mut self, entity: &Entity<'_>) {
        let sense = self.chain(entity).sense;
        let tag = |code: i32| entity.head.clone().find(|&tag| self.sheet.tags[tag].code == code);
        let spot = spots(self.sheet, entity.head.clone(), 10).pop();
        let (Some(spot), Some(radius), Some(from), Some(to)) = (spot, tag(40), tag(50), tag(51)) else { return };
        let degrees = [from, to].map(|tag| self.sheet.number(tag));
        let turn_deg = (degrees[1] - degrees[0]).rem_euclid(360.0);
        let radius_m = self.sheet.number(radius) * self.scale;
        let (at, carried) = (self.metres(spot, sense), self.redraw.carried);
        let points = [0.0, 0.5, 1.0].map(|share| {
            let (sine, cosine) = (degrees[0] + share * turn_deg).to_radians().sin_cos();
            at + V2::new(sense * cosine, sine) * radius_m
        });
        let places = points.map(carried);
        if points.iter().zip(&places).all(|(was, is)| (is - was).norm() < STILL_M) {
            return;
        }
        let Some(centre) = centre_through(places) else { return };
        self.set(spot, sense, centre);
        self.sheet.set(radius, (places[0] - centre).norm() / self.scale);
        for (tag, place) in [(from, places[0]), (to, places[2])] {
            let way = place - centre;
            self.sheet.set(tag, way.y.atan2(sense * way.x).to_degrees().rem_euclid(360.0));
        }
    }

    fn shift_of_middle(&self, entity: &Entity<'_>) -> V2 {
        let chain = self.chain(entity);
        let (Some(first), Some(last)) = (chain.spots.first(), chain.spots.last()) else { return V2::zeros() };
        let middle = self.metres(*first, chain.sense).lerp(&self.metres(*last, chain.sense), 0.5);
        self.rounded(self.place(middle) - middle)
    }

    /// Rounds as the file does, so that a shifted figure keeps its direction to the last decimal.
    fn rounded(&self, by: V2) -> V2 {
        by.map(|by| self.sheet.rounded(by / self.scale) * self.scale)
    }

    fn shift(&mut self, entity: &Entity<'_>, by: V2) {
        let chain = self.chain(entity);
        for spot in chain.spots {
            let to = self.metres(spot, chain.sense) + by;
            self.set(spot, chain.sense, to);
        }
    }

    fn other(&mut self, entity: &Entity<'_>) {
        let is_notch = NOTCHES.contains(&entity.layer);
        match entity.kind {
            "ARC" if matches!(entity.layer, "1" | "14") => self.arc(entity),
            "LINE" | "POLYLINE" | "LWPOLYLINE" if is_notch || entity.layer == "13" => {
                let chain = self.chain(entity);
                let (Some(first), Some(last)) = (chain.spots.first(), chain.spots.last()) else { return };
                let [first, last] = [first, last].map(|spot| self.metres(*spot, chain.sense));
                // A notch keeps its depth and direction, and a cross of a drill hole its shape.
                let at = if is_notch { first } else { first.lerp(&last, 0.5) };
                self.shift(entity, self.rounded(self.place(at) - at));
            }
            "LINE" | "POLYLINE" | "LWPOLYLINE" => {
                let chain = self.chain(entity);
                for spot in chain.spots {
                    let to = self.place(self.metres(spot, chain.sense));
                    self.set(spot, chain.sense, to);
                }
            }
            "POINT" | "INSERT" => self.carry(entity, &[10]),
            "SPLINE" => self.carry(entity, &[10, 11]),
            "CIRCLE" | "ARC" | "ELLIPSE" => self.carry(entity, &[10]),
            "TEXT" | "MTEXT" => self.text(entity),
            _ => {}
        }
    }

    fn carry(&mut self, entity: &Entity<'_>, codes: &[i32]) {
        let sense = if matches!(entity.kind, "CIRCLE" | "ARC") { self.chain(entity).sense } else { 1.0 };
        for spot in codes.iter().flat_map(|code| spots(self.sheet, entity.head.clone(), *code)).collect::<Vec<_>>() {
            let to = self.place(self.metres(spot, sense));
            self.set(spot, sense, to);
        }
    }

    /// Moves a text with the point whose rule it tells. Another text moves only if it would lie outside its piece.
    fn text(&mut self, entity: &Entity<'_>) {
        let Some(spot) = spots(self.sheet, entity.head.clone(), 10).into_iter().next() else { return };
        let at = self.metres(spot, 1.0);
        let value = entity.head.clone().find(|&tag| self.sheet.tags[tag].code == 1);
        let is_rule = value.is_some_and(|tag| self.sheet.tags[tag].value.trim_ascii().starts_with(b"#"));
        let outline = &self.redraw.piece.outline;
        let is_left = || {
            let moved: Vec<V2> = outline.iter().map(|p| (self.redraw.carried)(*p)).collect();
            contains(outline, &at) && !contains(&moved, &at)
        };
        if !is_rule && !is_left() {
            return;
        }
        let by = self.rounded(self.place(at) - at);
        self.set(spot, 1.0, at + by);
        // The second point of a TEXT aligns it; that of an MTEXT is a direction.
        if entity.kind == "TEXT" {
            for second in spots(self.sheet, entity.head.clone(), 11) {
                let to = self.metres(second, 1.0) + by;
                self.set(second, 1.0, to);
            }
        }
    }
}

/// `None` for points on a line.
fn centre_through([a, b, c]: [V2; 3]) -> Option<V2> {
    let (u, v) = (b - a, c - a);
    let twice_area = 2.0 * u.perp(&v);
    let towards =
        V2::new(v.y * u.norm_squared() - u.y * v.norm_squared(), u.x * v.norm_squared() - v.x * u.norm_squared());
    (twice_area.abs() > f64::MIN_POSITIVE).then(|| a + towards / twice_area)
}

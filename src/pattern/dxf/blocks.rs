//! From the entities of one block to a piece.

use dxf::entities::{Entity, EntityType};

use crate::geom::V2;
use crate::geom::polyline::{contains, self_crossing, signed_area};
use crate::pattern::piece::{Notch, Piece};
use crate::units::mm;

/// Greatest gap between the ends of boundary lines that join, m.
const JOIN_M: f64 = 0.05e-3;
/// Points closer than this are one, m.
const SAME_M: f64 = 1e-6;
/// Least area of a piece, m2.
const LEAST_AREA_M2: f64 = 1e-6;
/// Least share of the outline's area that a closed line on layer 8 must enclose to be an old Valentina sew line.
const SEW_LINE_SHARE: f64 = 0.5;

/// What a block draws, by AAMA layer, in metres.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Drawn {
    boundary: Vec<Line>,
    sew_lines: Vec<Line>,
    internal: Vec<Line>,
    grain: Vec<Line>,
    mirror: Vec<Line>,
    turn_points: Vec<V2>,
    curve_points: Vec<V2>,
    notches: Vec<Notch>,
    texts: Vec<(String, String)>,
    /// Boundary entities that are not lines, and bulges: what they are and where.
    unreadable: Vec<String>,
    /// Number of entities of any kind but texts.
    count: usize,
}

/// A line as drawn.
#[derive(Clone, Debug, PartialEq)]
struct Line {
    points: Vec<V2>,
    is_closed: bool,
}

impl Line {
    fn ends(&self) -> [V2; 2] {
        [self.points[0], self.points[self.points.len() - 1]]
    }
}

impl Drawn {
    /// Sorts entities by layer; `scale` turns file units into metres.
    pub fn collect<'e>(entities: impl Iterator<Item = &'e Entity>, scale: f64) -> Self {
        let mut drawn = Self::default();
        for entity in entities {
            drawn.add(entity, scale);
        }
        drawn
    }

    /// Whether the block draws nothing at all (model and paper space of some writers).
    pub fn is_empty(&self) -> bool {
        self.count == 0 && self.texts.is_empty()
    }

    fn add(&mut self, entity: &Entity, scale: f64) {
        let layer = entity.common.layer.trim();
        let at = |x: f64, y: f64| V2::new(x, y) * scale;
        match &entity.specific {
            EntityType::Text(text) => return self.texts.push(key_and_value(&text.value)),
            EntityType::Insert(_) => return,
            _ => self.count += 1,
        }
        match &entity.specific {
            EntityType::ModelPoint(point) => {
                let place = at(point.location.x, point.location.y);
                match layer {
                    "2" => self.turn_points.push(place),
                    "3" => self.curve_points.push(place),
                    "4" | "80" | "81" | "82" | "83" => self.notches.push(Notch {
                        at: place,
                        depth_m: (point.location.z != 0.0).then_some(point.location.z * scale),
                        angle_deg: Some(point.angle),
                    }),
                    _ => {}
                }
            }
            EntityType::Line(line) => {
                let ends = [at(line.p1.x, line.p1.y), at(line.p2.x, line.p2.y)];
                self.add_line(layer, Line { points: ends.to_vec(), is_closed: false });
            }
            EntityType::Polyline(line) => {
                let points = line.vertices().map(|v| at(v.location.x, v.location.y)).collect();
                let bulges = line.vertices().filter(|v| v.bulge != 0.0).map(|v| at(v.location.x, v.location.y));
                self.note_bulges(layer, bulges);
                self.add_line(layer, Line { points, is_closed: line.flags & 1 == 1 });
            }
            EntityType::LwPolyline(line) => {
                let points = line.vertices.iter().map(|v| at(v.x, v.y)).collect();
                self.note_bulges(layer, line.vertices.iter().filter(|v| v.bulge != 0.0).map(|v| at(v.x, v.y)));
                self.add_line(layer, Line { points, is_closed: line.is_closed() });
            }
            EntityType::AttributeDefinition(_) | EntityType::Attribute(_) | EntityType::MText(_) => {}
            other if layer == "1" => {
                let kind = format!("{other:?}");
                let kind = kind.split('(').next().unwrap_or_default();
                self.unreadable.push(format!("a {kind} on layer 1; accepted: polylines and lines"));
            }
            _ => {}
        }
    }

    fn note_bulges(&mut self, layer: &str, places: impl Iterator<Item = V2>) {
        if layer == "1" {
            let note = |p: V2| format!("an arc (bulge) at {}; accepted: straight sides between vertices", text_mm(&p));
            self.unreadable.extend(places.map(note));
        }
    }

    fn add_line(&mut self, layer: &str, mut line: Line) {
        line.points.dedup_by(|later, earlier| (*later - *earlier).norm() < SAME_M);
        if line.points.is_empty() || (line.points.len() == 1 && layer != "1") {
            return;
        }
        match layer {
            "1" => self.boundary.push(line),
            "14" => self.sew_lines.push(line),
            "8" => self.internal.push(line),
            "7" => self.grain.push(line),
            "6" => self.mirror.push(line),
            "4" | "80" | "81" | "82" | "83" => {
                let [at, inner] = line.ends();
                let cut = inner - at;
                self.notches.push(Notch {
                    at,
                    depth_m: Some(cut.norm()),
                    angle_deg: Some(cut.y.atan2(cut.x).to_degrees().rem_euclid(360.0)),
                });
            }
            _ => {}
        }
    }

    /// The piece that the block draws.
    ///
    /// # Errors
    /// A sentence that says why it is no usable piece, with the place in millimetres.
    pub fn into_piece(mut self, block: &str) -> Result<Piece, String> {
        if let Some(reason) = self.unreadable.into_iter().next() {
            return Err(reason);
        }
        let mut outline = joined(std::mem::take(&mut self.boundary), "outline (layer 1)")?;
        check_simple(&outline, "outline")?;
        let area = signed_area(&outline);
        if area.abs() < LEAST_AREA_M2 {
            return Err(format!("the outline encloses {:.3} mm2; accepted: an area", area.abs() * 1e6));
        }
        if area < 0.0 {
            outline.reverse();
            // Keep the first vertex first.
            outline.rotate_right(1);
        }
        let sew_line = sew_line(self.sew_lines, &mut self.internal, &outline)?;
        let take = |texts: &mut Vec<(String, String)>, key: &str| {
            let index = texts.iter().position(|(found, value)| found.eq_ignore_ascii_case(key) && !value.is_empty());
            index.map(|index| texts.remove(index).1)
        };
        let ends = |lines: &[Line]| lines.first().map(Line::ends);
        Ok(Piece {
            block: block.to_owned(),
            name: take(&mut self.texts, "piece name").unwrap_or_else(|| block.to_owned()),
            size: take(&mut self.texts, "size"),
            quantity: take(&mut self.texts, "quantity"),
            texts: self.texts,
            outline,
            is_clockwise_in_file: area < 0.0,
            turn_points: self.turn_points,
            curve_points: self.curve_points,
            notches: self.notches,
            grain: ends(&self.grain),
            mirror_line: ends(&self.mirror),
            internal_lines: self.internal.into_iter().map(|line| line.points).collect(),
            sew_line,
        })
    }
}

/// `(key, value)` texts of a set of entities.
pub fn texts<'e>(entities: impl Iterator<Item = &'e Entity>) -> Vec<(String, String)> {
    let text = |entity: &'e Entity| match &entity.specific {
        EntityType::Text(text) => Some(key_and_value(&text.value)),
        _ => None,
    };
    entities.filter_map(text).collect()
}

fn key_and_value(text: &str) -> (String, String) {
    match text.split_once(':') {
        Some((key, value)) => (key.trim().to_owned(), value.trim().to_owned()),
        None => (String::new(), text.trim().to_owned()),
    }
}

/// Joins lines end to end into one closed polygon without a repeated first vertex.
fn joined(mut lines: Vec<Line>, what: &str) -> Result<Vec<V2>, String> {
    if lines.is_empty() {
        return Err(format!("no {what}; accepted: one closed polyline, or lines that join into one"));
    }
    let first = lines.remove(0);
    let is_closed = first.is_closed;
    let mut points = first.points;
    while !is_closed && !lines.is_empty() {
        let end = points[points.len() - 1];
        let touches = |line: &Line| line.ends().iter().any(|p| (p - end).norm() < JOIN_M);
        let Some(next) = lines.iter().position(touches) else { break };
        let mut next = lines.remove(next).points;
        if (next[0] - end).norm() >= JOIN_M {
            next.reverse();
        }
        points.extend(next.into_iter().skip(1));
    }
    let (start, end) = (points[0], points[points.len() - 1]);
    let gap = (end - start).norm();
    if points.len() > 1 && gap < JOIN_M {
        points.pop();
    } else if !is_closed {
        return Err(format!(
            "the {what} does not close: {:.2} mm from {} to {}",
            mm(gap),
            text_mm(&end),
            text_mm(&start)
        ));
    }
    if let Some(other) = lines.first() {
        return Err(format!("a second {what} at {}; accepted: one", text_mm(&other.points[0])));
    }
    if points.len() < 3 {
        return Err(format!("the {what} has {} vertices; accepted: at least 3", points.len()));
    }
    Ok(points)
}

fn check_simple(outline: &[V2], what: &str) -> Result<(), String> {
    match self_crossing(outline) {
        Some(place) => Err(format!("the {what} crosses itself at {}", text_mm(&place))),
        None => Ok(()),
    }
}

/// The sew line: layer 14, or in files of old Valentina a closed line on layer 8 that holds most of the piece.
fn sew_line(on_14: Vec<Line>, internal: &mut Vec<Line>, outline: &[V2]) -> Result<Option<Vec<V2>>, String> {
    let mut line = if on_14.is_empty() {
        let is_sew_line = |line: &Line| {
            let ends = line.ends();
            (line.is_closed || (ends[1] - ends[0]).norm() < JOIN_M)
                && signed_area(&line.points).abs() > SEW_LINE_SHARE * signed_area(outline)
                && line.points.iter().all(|p| contains(outline, p))
        };
        let Some(index) = internal.iter().position(is_sew_line) else { return Ok(None) };
        let found = internal.remove(index);
        joined(vec![Line { is_closed: true, ..found }], "sew line (layer 8)")?
    } else {
        joined(on_14, "sew line (layer 14)")?
    };
    if signed_area(&line) < 0.0 {
        line.reverse();
        line.rotate_right(1);
    }
    Ok(Some(line))
}

fn text_mm(point: &V2) -> String {
    format!("({:.2}, {:.2}) mm", mm(point.x), mm(point.y))
}

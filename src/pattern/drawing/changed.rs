//! Drawing of a changed style: outlines before and after over each other, with the way that each edge has moved, in
//! millimetres.

use std::fmt::Write as _;

use super::{CSS, MARGIN_MM, Pen, TITLE_MM, bounds_mm, escaped, title};
use crate::arrange::{Placed, arrange, arranged};
use crate::handle::Handle;
use crate::style::{Style, StylePiece};
use geom::V2;
use geom::polyline::{Polyline, segment_meeting};
use geom::units::mm;

/// Way across an edge from which it has an arrow.
const MOVED_MM: f64 = 1.0;
/// Number of parts of an edge at whose ends its way is measured.
const PARTS: u32 = 40;
/// Reach of the search for an edge of before, as a multiple of the way of the point that was at the same share of it.
const REACH: f64 = 1.5;
/// Preference for the middle of an edge, as a share of the way: an edge that has moved as a whole has its arrow there.
const TO_MIDDLE: f64 = 0.05;
const LINE_MM: f64 = 24.0;
/// Width of one of its signs, and height.
const LABEL_MM: V2 = V2::new(8.2, 16.0);
/// Distances of a label from the tip of its arrow that are tried.
const DISTANCES_MM: [f64; 6] = [18.0, 27.0, 38.0, 52.0, 70.0, 95.0];
const DIRECTIONS: u32 = 16;
/// Change of a measurement from which it is listed.
const LISTED_MM: f64 = 0.05;

/// Way of a point across its edge on the sheet, mm.
#[derive(Clone, Copy, Debug)]
struct Way {
    from: V2,
    to: V2,
    length_mm: f64,
}

/// Draws a style that handles have changed by their amounts, m, with the outlines of before dashed. An arrow shows how
/// far each edge has moved across itself where it has moved most to that side, from a millimetre on. Below stand the
/// handles, and the measurements that change.
pub fn changed_svg(before: &Style, after: &Style, moves: &[(Handle, f64)]) -> String {
    let (places, now) = (arrange(after), arranged(after));
    let laid = |(piece, place): (&StylePiece, &Placed)| -> Vec<Polyline> {
        piece.edges.iter().map(|edge| edge.line.mapped(|p| place.at(p))).collect()
    };
    let then: Vec<Vec<Polyline>> = before.pieces.iter().zip(&places).map(laid).collect();
    let points = then.iter().flatten().flat_map(|line| line.points().iter().copied());
    let all: Vec<V2> = now.pieces.iter().flat_map(StylePiece::outline).chain(points).collect();
    let (low, high) = bounds_mm(&all);
    let pen = Pen { origin: V2::new(MARGIN_MM - low.x, MARGIN_MM + TITLE_MM + high.y) };
    let notes = notes(before, after, moves);
    let widest = notes.iter().map(|note| note.chars().count()).max().unwrap_or(0) as f64 * 9.0;
    let width = (high.x - low.x).max(widest) + 2.0 * MARGIN_MM;
    let drawn_mm = high.y - low.y + 2.0 * MARGIN_MM + TITLE_MM;
    let height = drawn_mm + LINE_MM * notes.len() as f64 + MARGIN_MM;
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width:.0} {height:.0}\" width=\"{width:.0}\" height=\"{height:.0}\">\n\
         <style>{CSS}</style>\n<rect width=\"{width:.0}\" height=\"{height:.0}\" fill=\"#fff\"/>\n"
    );
    now.pieces.iter().for_each(|piece| pen.piece(&mut out, &now.size, piece));
    for line in &then {
        let outline = line.iter().flat_map(|line| line.points().split_last().map_or(&[][..], |(_, others)| others));
        pen.path(&mut out, "before", outline.copied(), true);
    }
    let ways: Vec<Way> = now.pieces.iter().zip(&then).flat_map(|(piece, then)| ways(&pen, piece, then)).collect();
    let mut labels = Labels { sheet: V2::new(width, drawn_mm), taken: ways.iter().map(Way::extent).collect() };
    labels.taken.extend(now.pieces.iter().map(|piece| title_extent(&pen, piece, &now.size)));
    ways.iter().for_each(|way| way.draw(&mut out, labels.place(way)));
    for (line, note) in notes.iter().enumerate() {
        let y = drawn_mm + LINE_MM * line as f64 + 10.0;
        let _ = writeln!(out, "<text class=\"note\" x=\"{MARGIN_MM:.1}\" y=\"{y:.1}\">{}</text>", escaped(note));
    }
    out.push_str("</svg>\n");
    out
}

fn title_extent(pen: &Pen, piece: &StylePiece, size: &str) -> [V2; 2] {
    let at = pen.title_at(&piece.outline());
    // Letters of 19 mm are 12 mm wide.
    [at - V2::new(0.0, 19.0), at + V2::new(12.0 * title(piece, size).chars().count() as f64, 4.0)]
}

fn notes(before: &Style, after: &Style, moves: &[(Handle, f64)]) -> Vec<String> {
    let moved = |(handle, amount_m): &(Handle, f64)| {
        let of = if handle.is_half_girth() { ", half of the girth" } else { "" };
        format!("{} {:+.1} mm{of}", handle.as_str().replace('_', " "), mm(*amount_m))
    };
    let pairs = before.measurements.iter().zip(&after.measurements);
    let changed = pairs.filter(|(was, is)| mm(is.l2d_m - was.l2d_m).abs() >= LISTED_MM);
    let changed = changed.map(|(was, is)| {
        let [was_mm, is_mm] = [was.l2d_m, is.l2d_m].map(mm);
        format!("{}: {was_mm:.1} to {is_mm:.1} mm ({:+.1})", is.name, is_mm - was_mm)
    });
    let key = "dashed: before; arrows: from there to the edge as it is now, in mm".to_owned();
    moves.iter().map(moved).chain(changed).chain([key]).collect()
}

/// One for each stretch of an edge that has moved to one side.
fn ways(pen: &Pen, piece: &StylePiece, before: &[Polyline]) -> Vec<Way> {
    piece.edges.iter().zip(before).flat_map(|(edge, before)| stretches(pen, before, &edge.line)).collect()
}

/// Greatest way of each stretch of an edge on which the way is at least [`MOVED_MM`], and to the same side.
fn stretches(pen: &Pen, before: &Polyline, after: &Polyline) -> Vec<Way> {
    let across = |part: u32| {
        let share = f64::from(part) / f64::from(PARTS);
        let arc_m = share * after.length();
        let step_m = 0.5 * after.length() / f64::from(PARTS);
        let to = after.at(arc_m);
        let along = after.at(arc_m + step_m) - after.at(arc_m - step_m);
        let normal = V2::new(-along.y, along.x).try_normalize(0.0).unwrap_or_else(V2::zeros);
        let reach = normal * (REACH * (to - before.at(share * before.length())).norm());
        // Where the edge of before is across, if it is: an edge may now be longer.
        let meets = before.points().windows(2).filter_map(|side| {
            let (share, _) = segment_meeting((to - reach, to + reach), (side[0], side[1]))?;
            Some(reach * (2.0 * share - 1.0))
        });
        let by = -meets.min_by(|a, b| a.norm().total_cmp(&b.norm())).unwrap_or_else(V2::zeros);
        let way = Way { from: pen.at(to - by), to: pen.at(to), length_mm: mm(by.norm()) };
        (mm(by.dot(&normal)), way, way.length_mm * (1.0 - TO_MIDDLE * (2.0 * share - 1.0).abs()))
    };
    let mut found: Vec<(f64, Way, f64)> = Vec::new();
    let mut is_open = false;
    for next in (0..=PARTS).map(across) {
        if next.0.abs() < MOVED_MM {
            is_open = false;
            continue;
        }
        match found.last_mut().filter(|last| is_open && last.0.signum() == next.0.signum()) {
            Some(last) if next.2 > last.2 => *last = next,
            Some(_) => {}
            None => found.push(next),
        }
        is_open = true;
    }
    found.into_iter().map(|(_, way, _)| way).collect()
}

impl Way {
    /// Lower and upper corner of the arrow, mm.
    fn extent(&self) -> [V2; 2] {
        [self.from.inf(&self.to).add_scalar(-2.0), self.from.sup(&self.to).add_scalar(2.0)]
    }

    fn text(&self) -> String {
        format!("{:.1}", self.length_mm)
    }

    fn draw(&self, out: &mut String, label: V2) {
        let along = (self.to - self.from) / self.length_mm;
        let side = V2::new(-along.y, along.x);
        let head = (0.5 * self.length_mm).min(6.0);
        let barbs = [1.0, -1.0].map(|sign| self.to - along * head + side * (0.45 * head * sign));
        let _ = writeln!(
            out,
            "<path class=\"way\" d=\"M{:.2} {:.2}L{:.2} {:.2}M{:.2} {:.2}L{:.2} {:.2}L{:.2} {:.2}\"/>",
            self.from.x,
            self.from.y,
            self.to.x,
            self.to.y,
            barbs[0].x,
            barbs[0].y,
            self.to.x,
            self.to.y,
            barbs[1].x,
            barbs[1].y
        );
        let text = self.text();
        let size = V2::new(LABEL_MM.x * text.len() as f64, LABEL_MM.y);
        let corner = label - size * 0.5;
        let _ = writeln!(
            out,
            "<path class=\"thin\" d=\"M{:.2} {:.2}L{:.2} {:.2}\"/><rect class=\"under\" x=\"{:.1}\" y=\"{:.1}\" width=\"{:.1}\" \
             height=\"{:.1}\"/><text class=\"by\" x=\"{:.1}\" y=\"{:.1}\">{text}</text>",
            self.to.x,
            self.to.y,
            label.x,
            label.y,
            corner.x,
            corner.y,
            size.x,
            size.y,
            label.x,
            label.y + 4.8
        );
    }
}

struct Labels {
    /// Width and height, mm.
    sheet: V2,
    taken: Vec<[V2; 2]>,
}

impl Labels {
    /// Middle of the label: the first free place, in the direction of the arrow first. Without one, the first of all.
    fn place(&mut self, way: &Way) -> V2 {
        let half = V2::new(LABEL_MM.x * way.text().len() as f64, LABEL_MM.y) * 0.5;
        let along = (way.to - way.from) / way.length_mm;
        let turned = |k: u32| {
            // 0, 1, -1, 2, -2 ... parts of a turn.
            let step = f64::from(k.div_ceil(2)) * if k % 2 == 1 { 1.0 } else { -1.0 };
            let (sine, cosine) = (step * std::f64::consts::TAU / f64::from(DIRECTIONS)).sin_cos();
            V2::new(cosine * along.x - sine * along.y, sine * along.x + cosine * along.y)
        };
        let tried = DISTANCES_MM.into_iter().flat_map(|far| (0..DIRECTIONS).map(move |k| way.to + turned(k) * far));
        let is_free = |middle: &V2| {
            let (low, high) = (middle - half, middle + half);
            let meets = |[a, b]: &[V2; 2]| low.x < b.x && high.x > a.x && low.y < b.y && high.y > a.y;
            low.min() > 0.0 && high.x < self.sheet.x && high.y < self.sheet.y && !self.taken.iter().any(meets)
        };
        let middle = tried.clone().find(is_free).or_else(|| tried.clone().next()).unwrap_or(way.to);
        self.taken.push([middle - half, middle + half]);
        middle
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draft::Model;

    fn labels(sheet: &str) -> Vec<[f64; 4]> {
        let number = |tag: &str, name: &str| -> f64 {
            let value = tag.split(&format!(" {name}=\"")).nth(1).and_then(|rest| rest.split('"').next());
            value.and_then(|value| value.parse().ok()).expect("a number")
        };
        let tags = sheet.split("<rect class=\"under\"").skip(1);
        tags.map(|tag| ["x", "y", "width", "height"].map(|name| number(tag, name))).collect()
    }

    #[test]
    fn every_edge_that_moves_has_one_arrow_with_its_way() {
        let check = |model: Model, moves: &[(Handle, f64)], arrows: usize, says: &[&str]| {
            let style = Style::read(&model.drafts().swap_remove(0).pieces, model.seams(), "a").expect("a style");
            let sheet = changed_svg(&style, &style.moved(moves).expect("it has them"), moves);
            assert_eq!(sheet.matches("class=\"piece\"").count(), style.pieces.len());
            assert_eq!(sheet.matches("class=\"before\"").count(), style.pieces.len());
            let labels = labels(&sheet);
            assert_eq!(labels.len(), arrows, "{model:?} {moves:?}");
            let apart = |a: &[f64; 4], b: &[f64; 4]| {
                a[0] + a[2] <= b[0] || b[0] + b[2] <= a[0] || a[1] + a[3] <= b[1] || b[1] + b[3] <= a[1]
            };
            let all_apart = (0..arrows).all(|k| labels[..k].iter().all(|other| apart(other, &labels[k])));
            assert!(all_apart, "{model:?} {moves:?}: {labels:?}");
            for words in says {
                assert!(sheet.contains(words), "{model:?}: {words} in {sheet}");
            }
        };
        use Handle::*;
        check(Model::Tshirt, &[], 0, &["dashed: before"]);
        // The lower edges of front and back go down. Their side seams lengthen, and stay where they are.
        check(Model::Tshirt, &[(BodyLength, 0.02)], 2, &["body length +20.0 mm", ">20.0</text>"]);
        check(Model::Tshirt, &[(Hem, 0.02)], 4, &["hem +20.0 mm, half of the girth", ">10.0</text>"]);
        // Two lower edges; eight side seams at the waist, and four of them lower down, where they now lie outside.
        check(
            Model::Dress,
            &[(Waist, -0.01), (SkirtLength, 0.03)],
            14,
            &["waist -10.0 mm, half of the girth", ">30.4</text>"],
        );
    }
}

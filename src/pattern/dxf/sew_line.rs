//! Reading of the sew line, which is drawn inside the outline or ends on it.

use super::outline::{JOIN_M, Line, chains, check_simple, closed, counter_clockwise, joined, without_copies};
use geom::V2;
use geom::polyline::{contains, signed_area};

/// Least share of the outline that a closed line on layer 8 encloses as sew line. Old Valentina files draw it there.
const SEW_LINE_SHARE: f64 = 0.5;
const ON_OUTLINE_M: f64 = 0.1e-3;

/// Takes layer 14, or in files of old Valentina a closed line on layer 8 that encloses most of the piece.
pub fn sew_line(on_14: Vec<Line>, internal: &mut Vec<Line>, outline: &[V2]) -> Result<Option<Vec<V2>>, String> {
    let mut line = if on_14.is_empty() {
        let is_sew_line = |line: &Line| {
            (line.is_closed || line.gap() < JOIN_M)
                && signed_area(&line.points).abs() > SEW_LINE_SHARE * signed_area(outline)
                && line.points.iter().all(|p| contains(outline, p))
        };
        let Some(index) = internal.iter().position(is_sew_line) else { return Ok(None) };
        let found = internal.remove(index);
        closed(Line { is_closed: true, ..found }, "sew line (layer 8)")?
    } else {
        closed_on(&without_copies(on_14).0, outline, "sew line (layer 14)")?
    };
    counter_clockwise(&mut line);
    Ok(Some(line))
}

/// Closes chains that end on the outline by following it to the next chain. A half piece (up to the fold) and a piece
/// with an edge without allowance are drawn like this.
fn closed_on(lines: &[Line], outline: &[V2], what: &str) -> Result<Vec<V2>, String> {
    let chains = chains(lines);
    let along = Along::new(outline);
    let mut placed: Vec<(f64, f64, Vec<V2>)> = Vec::new();
    for chain in &chains {
        let ends = chain.ends().map(|end| along.arc_of(&end));
        match ends {
            [Some(from), Some(to)] if !chain.closes() => {
                let back: Vec<V2> = chain.points.iter().rev().copied().collect();
                // A sew line cuts off a strip, so the direction that leaves more of the piece is the right one.
                let area = |points: &[V2], from: f64, to: f64| {
                    signed_area(&[points.to_vec(), along.between(to, from)].concat())
                };
                placed.push(if area(&chain.points, from, to) >= area(&back, to, from) {
                    (from, to, chain.points.clone())
                } else {
                    (to, from, back)
                });
            }
            _ => return joined(lines, what),
        }
    }
    placed.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut points: Vec<V2> = Vec::new();
    for (k, (_, to, chain)) in placed.iter().enumerate() {
        points.extend(chain);
        points.extend(along.between(*to, placed[(k + 1) % placed.len()].0));
    }
    points.dedup_by(|later, earlier| (*later - *earlier).norm() < JOIN_M);
    if points.is_empty() {
        return joined(lines, what);
    }
    check_simple(&points, what)?;
    closed(Line { points, is_closed: true }, what)
}

struct Along<'a> {
    outline: &'a [V2],
    /// At each vertex, and at the end, m.
    arcs: Vec<f64>,
}

impl<'a> Along<'a> {
    fn new(outline: &'a [V2]) -> Self {
        let n = outline.len();
        let mut arcs = vec![0.0];
        for i in 0..n {
            arcs.push(arcs[i] + (outline[(i + 1) % n] - outline[i]).norm());
        }
        Self { outline, arcs }
    }

    /// In m. `None` for a point off the outline.
    fn arc_of(&self, point: &V2) -> Option<f64> {
        let n = self.outline.len();
        let side = |i: usize| {
            let (from, to) = (self.outline[i], self.outline[(i + 1) % n]);
            let along = to - from;
            let share = ((point - from).dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
            ((from + along * share - point).norm(), self.arcs[i] + share * along.norm())
        };
        let nearest = (0..n).map(side).min_by(|a, b| a.0.total_cmp(&b.0));
        nearest.filter(|(distance_m, _)| *distance_m < ON_OUTLINE_M).map(|(_, arc)| arc)
    }

    /// In the direction of the outline.
    fn between(&self, from: f64, to: f64) -> Vec<V2> {
        let total = self.arcs[self.outline.len()];
        let ahead = |arc: f64| (arc - from).rem_euclid(total);
        let end = ahead(to);
        let mut passed: Vec<(f64, V2)> = self
            .outline
            .iter()
            .zip(&self.arcs)
            .map(|(p, arc)| (ahead(*arc), *p))
            .filter(|(arc, _)| *arc > 0.0 && *arc < end)
            .collect();
        passed.sort_by(|a, b| a.0.total_cmp(&b.0));
        passed.into_iter().map(|(_, p)| p).collect()
    }
}

//! Grading: derives the pieces of every size from those of the sample size and a grade rule table.
//!
//! A text `# n` at a point of the outline assigns grade rule `n` to it. Between two grade points the displacement of
//! the outline is interpolated linearly in arc length, and so is that of a line inside between two of its points.
//! Other points inside move with the nearest point of the outline, unless they have rules of their own.

mod cardinal;
mod growth;
mod table;
mod ungrade;
mod unit;

pub use self::growth::{Graded, Growth, GrowthError};
pub use self::table::{GradeError, GradeTable, Imprint, is_name_of_table, named_in_pattern, read, write};
pub use self::ungrade::{Ungraded, ungrade};
pub use self::unit::in_unit_of;
use super::dxf::{PatternFile, Refused};
use super::piece::{Notch, Piece};
use geom::V2;
use geom::polyline::{segment_distance, self_crossing, signed_area};
use geom::units::mm;

const ON_OUTLINE_M: f64 = 1e-3;
/// Least difference of two distances, or steps, that counts: half of the rounding of files.
const NEARER_M: f64 = 0.05e-3;
/// Greatest slope of a grade reference line that counts as horizontal.
const HORIZONTAL: f64 = 0.02;

/// The sample size stays as drawn. A piece that cannot be graded is listed in [`PatternFile::refused`].
pub fn grade(file: &PatternFile, table: &GradeTable) -> Result<PatternFile, GradeError> {
    let fail = |found: String, accepted: &str| {
        Err(GradeError { file: file.file.clone(), line: None, found, accepted: accepted.to_owned() })
    };
    let sample = &table.sizes[table.sample];
    let is_sample = |piece: &Piece| piece.size.as_deref().is_none_or(|size| size.eq_ignore_ascii_case(sample));
    if let Some(other) = file.pieces.iter().find(|piece| !is_sample(piece)) {
        let size = other.size.as_deref().unwrap_or_default();
        return fail(
            format!("size `{size}` for piece `{}`", other.name),
            &format!("pieces of the sample size {sample} only"),
        );
    }
    if file.pieces.iter().all(|piece| piece.grade_points.is_empty()) {
        return fail("no grade point".to_owned(), "texts `# n` at points of the outline, n being a rule of the table");
    }
    let mut graded = PatternFile { pieces: Vec::new(), ..file.clone() };
    for (k, size) in table.sizes.iter().enumerate() {
        for piece in &file.pieces {
            let sized = if k == table.sample { Ok(piece.clone()) } else { graded_piece(piece, table, k) };
            match sized {
                Ok(sized) => graded.pieces.push(Piece { size: Some(size.clone()), ..sized }),
                Err(reason) => {
                    let reason = format!("size {size}: {reason}");
                    let size = Some(size.clone());
                    graded.refused.push(Refused { block: piece.block.clone(), line: None, size, reason });
                }
            }
        }
    }
    Ok(graded)
}

fn graded_piece(piece: &Piece, table: &GradeTable, size: usize) -> Result<Piece, String> {
    let graded = moved_piece(piece, table, size)?;
    if let Some(place) = self_crossing(&graded.outline) {
        return Err(format!("the graded outline crosses itself at ({:.2}, {:.2}) mm", mm(place.x), mm(place.y)));
    }
    if signed_area(&graded.outline) <= 0.0 {
        return Err("the graded outline encloses no area".to_owned());
    }
    Ok(graded)
}

/// Moves the points, whatever the outline becomes.
fn moved_piece(piece: &Piece, table: &GradeTable, size: usize) -> Result<Piece, String> {
    if let Some([from, to]) = piece.grade_reference {
        let along = to - from;
        if along.y.abs() > HORIZONTAL * along.x.abs() {
            let angle = along.y.atan2(along.x).to_degrees();
            return Err(format!(
                "a grade reference line at {angle:.0} degrees: programs differ on whether rules turn with it; accepted: \
                 a horizontal one, or none"
            ));
        }
    }
    let field = Field::of(piece, table, size)?;
    let moved = |point: &V2| point + field.at(point);
    let moved_all = |points: &[V2]| -> Vec<V2> { points.iter().map(moved).collect() };
    let inner = |point: &V2| point + field.at_inner(point);
    let inner_all = |points: &[V2]| -> Vec<V2> { points.iter().map(inner).collect() };
    let moved_lines =
        |lines: &[Vec<V2>]| -> Vec<Vec<V2>> { lines.iter().map(|line| field.line(line, false)).collect() };
    let moved_ends = |ends: Option<[V2; 2]>| ends.map(|ends| ends.map(|end| moved(&end)));
    let outline: Vec<V2> = piece.outline.iter().zip(&field.steps).map(|(point, step)| point + step).collect();
    Ok(Piece {
        outline,
        drawn_perimeter_m: None,
        turn_points: moved_all(&piece.turn_points),
        curve_points: moved_all(&piece.curve_points),
        notches: piece.notches.iter().map(|notch| Notch { at: inner(&notch.at), ..*notch }).collect(),
        grain: piece.grain.map(|ends| ends.map(|end| inner(&end))),
        mirror_line: moved_ends(piece.mirror_line),
        grade_reference: moved_ends(piece.grade_reference),
        grade_points: Vec::new(),
        internal_lines: moved_lines(&piece.internal_lines),
        cut_outs: moved_lines(&piece.cut_outs),
        drill_holes: inner_all(&piece.drill_holes),
        sew_line: piece.sew_line.as_deref().map(|line| field.line(line, true)),
        ..piece.clone()
    })
}

struct InnerPoint {
    at: V2,
    /// Displacement by its rule, m.
    step: V2,
}

/// Displacements of the vertices of an outline, and of the inner points that have a grade rule.
struct Field<'a> {
    outline: &'a [V2],
    steps: Vec<V2>,
    own: Vec<InnerPoint>,
}

impl<'a> Field<'a> {
    fn of(piece: &'a Piece, table: &GradeTable, size: usize) -> Result<Self, String> {
        let outline = &piece.outline;
        let mut graded: Vec<Option<(u32, V2)>> = vec![None; outline.len()];
        let mut own: Vec<InnerPoint> = Vec::new();
        for point in &piece.grade_points {
            let Some(steps) = table.rules.get(&point.rule) else {
                return Err(format!("rule {} at {}, which {} does not hold", point.rule, place(&point.at), table.file));
            };
            let distance = |k: &usize| (outline[*k] - point.at).norm();
            let nearest = (0..outline.len()).min_by(|a, b| distance(a).total_cmp(&distance(b)));
            let from_inner = inner_points(piece).map(|inner| (inner - point.at).norm()).fold(f64::INFINITY, f64::min);
            // Lines inside a piece may begin beside a corner, closer than the text of its rule stands.
            let is_inner = |vertex: &usize| point.is_inner || from_inner + NEARER_M < distance(vertex);
            let on_outline = nearest.filter(|vertex| !is_inner(vertex) && distance(vertex) < ON_OUTLINE_M);
            let Some(vertex) = on_outline else {
                own.push(InnerPoint { at: point.at, step: steps[size] });
                continue;
            };
            let is_other = |step: V2| (step - steps[size]).norm() > NEARER_M;
            match graded[vertex] {
                // A rule that says otherwise is that of the inner line that ends there.
                Some((rule, step)) if rule != point.rule && is_other(step) && from_inner < ON_OUTLINE_M => {
                    own.push(InnerPoint { at: point.at, step: steps[size] });
                }
                Some((rule, step)) if rule != point.rule && is_other(step) => {
                    let found = format!("rules {rule} and {} at {}", point.rule, place(&point.at));
                    return Err(format!("{found}; accepted: one rule a point"));
                }
                _ => graded[vertex] = Some((point.rule, steps[size])),
            }
        }
        let known: Vec<(usize, V2)> =
            graded.iter().enumerate().filter_map(|(vertex, step)| step.map(|(_, step)| (vertex, step))).collect();
        if known.len() < 2 {
            return Err(format!("{} graded points on the outline; accepted: at least 2", known.len()));
        }
        Ok(Self { outline, steps: between(outline, &known), own })
    }

    /// Takes its own rule, otherwise the nearest point of the outline.
    fn at_inner(&self, point: &V2) -> V2 {
        self.own(point).unwrap_or_else(|| self.at(point))
    }

    fn own(&self, point: &V2) -> Option<V2> {
        let near = self.own.iter().filter(|own| (own.at - point).norm() < ON_OUTLINE_M);
        near.min_by(|a, b| (a.at - point).norm().total_cmp(&(b.at - point).norm())).map(|own| own.step)
    }

    /// Moves a line inside. Between two of its points that have rules it follows them as the outline does.
    fn line(&self, points: &[V2], is_closed: bool) -> Vec<V2> {
        let own = points.iter().enumerate().filter_map(|(vertex, point)| Some((vertex, self.own(point)?)));
        let known: Vec<(usize, V2)> = own.collect();
        let (Some((first, _)), Some((last, _))) = (known.first(), known.last()) else {
            return points.iter().map(|point| point + self.at(point)).collect();
        };
        if first == last {
            return points.iter().map(|point| point + self.at_inner(point)).collect();
        }
        let steps = between(points, &known);
        let follows = |vertex: &usize| is_closed || (first..=last).contains(&vertex);
        let step = |vertex: usize| if follows(&vertex) { steps[vertex] } else { self.at(&points[vertex]) };
        (0..points.len()).map(|vertex| points[vertex] + step(vertex)).collect()
    }

    /// Displacement of the nearest point of the outline.
    fn at(&self, point: &V2) -> V2 {
        let n = self.outline.len();
        let distance = |k: &usize| segment_distance(&self.outline[*k], &self.outline[(*k + 1) % n], point);
        let Some(k) = (0..n).min_by(|a, b| distance(a).total_cmp(&distance(b))) else { return V2::zeros() };
        let (start, end) = (self.outline[k], self.outline[(k + 1) % n]);
        let along = end - start;
        let share = ((point - start).dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
        self.steps[k].lerp(&self.steps[(k + 1) % n], share)
    }
}

fn inner_points(piece: &Piece) -> impl Iterator<Item = &V2> {
    piece.internal_lines.iter().chain(&piece.cut_outs).flatten().chain(&piece.drill_holes)
}

/// Interpolates displacements of a closed outline linearly in arc length.
fn between(outline: &[V2], known: &[(usize, V2)]) -> Vec<V2> {
    let n = outline.len();
    let mut steps = vec![V2::zeros(); n];
    for (k, &(from, first)) in known.iter().enumerate() {
        let (to, last) = known[(k + 1) % known.len()];
        let count = (to + n - from) % n;
        let side = |i: usize| (outline[(from + i + 1) % n] - outline[(from + i) % n]).norm();
        let length: f64 = (0..count).map(side).sum();
        let mut along = 0.0;
        for i in 0..count {
            steps[(from + i) % n] = first.lerp(&last, along / length.max(f64::MIN_POSITIVE));
            along += side(i);
        }
    }
    steps
}

fn place(point: &V2) -> String {
    format!("({:.1}, {:.1}) mm", mm(point.x), mm(point.y))
}

#[cfg(test)]
mod tests;

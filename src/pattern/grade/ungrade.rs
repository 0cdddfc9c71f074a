//! Inverse of grading: derives the sample size with grade points, and the grade rule table, from a nest of all sizes.
//!
//! Corners correspond between sizes as those of a seam file do. Between two corners, the outlines of all sizes are
//! divided at equal shares of their length, wherever an outline of some size has a vertex. Each size keeps its
//! vertices, and every vertex has a rule.

use std::collections::BTreeMap;

use super::{GradeError, GradeTable};
use crate::dxf::{PatternFile, Unit};
use crate::piece::{GradePoint, Piece};
use crate::style::corners::corner_vertices;
use crate::style::nest_corners::in_sizes;
use geom::V2;
use geom::polyline::Polyline;

/// Distance along a line below which vertices of two sizes correspond.
const SAME_PLACE_M: f64 = 0.2e-3;
/// Difference below which displacements share one rule: the last digit of a written table.
const SAME_STEP_M: f64 = 1e-7;

#[derive(Clone, Debug, PartialEq)]
pub struct Ungraded {
    pub pieces: Vec<Piece>,
    pub table: GradeTable,
    /// Features that get no rules because some size lacks them. They move with the outline.
    pub notes: Vec<String>,
}

pub fn ungrade(file: &PatternFile, sample: &str) -> Result<Ungraded, GradeError> {
    let fail = |found: String, accepted: &str| GradeError {
        file: file.file.clone(),
        line: None,
        found,
        accepted: accepted.to_owned(),
    };
    let sizes: Vec<String> = file.sizes().into_iter().map(str::to_owned).collect();
    if let Some(unnamed) = sizes.iter().find(|size| size.is_empty() || size.contains(char::is_whitespace)) {
        return Err(fail(format!("size `{unnamed}`"), "sizes with names of one word"));
    }
    let pieces_of = |size: &str| -> Vec<&Piece> {
        file.pieces.iter().filter(|piece| piece.size.as_deref() == Some(size)).collect()
    };
    let index = sizes.iter().position(|size| size.eq_ignore_ascii_case(sample));
    let index = index.ok_or_else(|| fail(format!("no size `{sample}`"), &format!("one of {}", sizes.join(", "))))?;
    let nest: Vec<Vec<&Piece>> = sizes.iter().map(|size| pieces_of(size)).collect();
    let mut rules = Rules { sizes: sizes.len(), steps: Vec::new() };
    let (mut pieces, mut notes) = (Vec::new(), Vec::new());
    for (k, piece) in nest[index].iter().enumerate() {
        let number = nest[index][..k].iter().filter(|other| other.name == piece.name).count();
        let all = nest.iter().zip(&sizes).map(|(pieces, size)| {
            let found = pieces.iter().filter(|other| other.name == piece.name).nth(number).copied();
            found.ok_or_else(|| fail(format!("no piece `{}` in size {size}", piece.name), "every piece in every size"))
        });
        let all = all.collect::<Result<Vec<&Piece>, GradeError>>()?;
        let graded = graded(&all, index, &mut rules, &mut notes);
        pieces.push(
            graded.map_err(|found| fail(format!("piece `{}`: {found}", piece.name), "the same piece in every size"))?,
        );
    }
    let steps = rules.steps.into_iter().enumerate().map(|(number, steps)| (number as u32 + 1, steps));
    let rules: BTreeMap<u32, Vec<V2>> = steps.collect();
    let table = GradeTable { file: file.file.clone(), sizes, sample: index, unit: Unit::Mm, rules };
    Ok(Ungraded { pieces, table, notes })
}

struct Rules {
    sizes: usize,
    steps: Vec<Vec<V2>>,
}

impl Rules {
    /// Rule that moves a point of the sample size to its positions in all sizes.
    fn number(&mut self, places: &[V2], sample: usize) -> u32 {
        debug_assert_eq!(places.len(), self.sizes);
        let steps: Vec<V2> = places.iter().map(|place| place - places[sample]).collect();
        let is_same = |other: &Vec<V2>| other.iter().zip(&steps).all(|(a, b)| (a - b).amax() < SAME_STEP_M);
        let found = self.steps.iter().position(is_same);
        let index = found.unwrap_or_else(|| {
            self.steps.push(steps);
            self.steps.len() - 1
        });
        index as u32 + 1
    }
}

/// Sample size with a grade point at every vertex.
fn graded(all: &[&Piece], sample: usize, rules: &mut Rules, notes: &mut Vec<String>) -> Result<Piece, String> {
    let mut piece = all[sample].clone();
    let outlines = ring(all, sample, |piece| piece.outline.clone())?;
    let mut points = Vec::new();
    let mut mark = |places: Vec<V2>, is_inner: bool| {
        points.push(GradePoint { at: places[sample], rule: rules.number(&places, sample), is_inner });
    };
    let across = |lines: &[Vec<V2>], k: usize| -> Vec<V2> { lines.iter().map(|line| line[k]).collect() };
    (0..outlines[0].len()).for_each(|k| mark(across(&outlines, k), false));
    piece.outline.clone_from(&outlines[sample]);
    if all.iter().all(|piece| piece.sew_line.is_some()) {
        let lines = ring(all, sample, |piece| piece.sew_line.clone().unwrap_or_default())?;
        (0..lines[0].len()).for_each(|k| mark(across(&lines, k), true));
        piece.sew_line = Some(lines[sample].clone());
    }
    for (what, feature) in [
        ("internal lines", (|piece: &Piece| piece.internal_lines.clone()) as fn(&Piece) -> Vec<Vec<V2>>),
        ("cut-outs", |piece| piece.cut_outs.clone()),
    ] {
        let lines: Vec<Vec<Vec<V2>>> = all.iter().map(|piece| feature(piece)).collect();
        if !is_in_all(&piece.name, what, &lines, notes) {
            continue;
        }
        let mut own = Vec::new();
        for k in 0..lines[sample].len() {
            let line: Vec<Vec<V2>> = lines.iter().map(|lines| lines[k].clone()).collect();
            let line = if line.iter().any(|sized| sized.len() < 2) { line } else { cut_alike(&line) };
            (0..line[sample].len()).for_each(|k| mark(across(&line, k), true));
            own.push(line[sample].clone());
        }
        if what == "cut-outs" { piece.cut_outs = own } else { piece.internal_lines = own }
    }
    for (what, feature) in [
        ("drill holes", (|piece: &Piece| piece.drill_holes.clone()) as fn(&Piece) -> Vec<V2>),
        ("notches", |piece| piece.notches.iter().map(|notch| notch.at).collect()),
    ] {
        let places: Vec<Vec<V2>> = all.iter().map(|piece| feature(piece)).collect();
        if !is_in_all(&piece.name, what, &places, notes) {
            continue;
        }
        (0..places[sample].len()).for_each(|k| mark(across(&places, k), true));
    }
    let grains: Vec<[V2; 2]> = all.iter().filter_map(|piece| piece.grain).collect();
    if grains.len() == all.len() {
        [0, 1].into_iter().for_each(|end| mark(grains.iter().map(|grain| grain[end]).collect(), true));
    }
    let is_turn = |at: &V2| piece.turn_points.iter().any(|turn| (turn - at).norm() < SAME_PLACE_M);
    piece.curve_points = piece.outline.iter().filter(|at| !is_turn(at)).copied().collect();
    piece.grade_points = points;
    // The rules are written along the axes of the file.
    piece.grade_reference = None;
    Ok(piece)
}

/// True for equally many of a feature. Otherwise adds a note.
fn is_in_all<T>(piece: &str, what: &str, all: &[Vec<T>], notes: &mut Vec<String>) -> bool {
    let is_same = all.iter().all(|sized| sized.len() == all[0].len());
    if !is_same {
        notes.push(format!("piece `{piece}`: not every size has its {what}: they move with the outline"));
    }
    is_same
}

/// Line of each size, all with the same number of vertices, among them the corners of the sample size.
fn ring(all: &[&Piece], sample: usize, line_of: impl Fn(&Piece) -> Vec<V2>) -> Result<Vec<Vec<V2>>, String> {
    let pieces: Vec<Piece> =
        all.iter().map(|piece| Piece { outline: line_of(piece), sew_line: None, ..(*piece).clone() }).collect();
    let own = corner_vertices(&pieces[sample]);
    // A line without corners begins at the first vertex of the sample size.
    let own = if own.is_empty() { vec![0] } else { own };
    let corners = in_sizes(&pieces, sample, &own)
        .map_err(|(size, _)| format!("another outline in size {:?}", pieces[size].size))?;
    let mut rings = vec![Vec::new(); all.len()];
    for k in 0..own.len() {
        let stretch = |(piece, corners): (&Piece, &Vec<usize>)| -> Vec<V2> {
            let n = piece.outline.len();
            let (from, to) = (corners[k], corners[(k + 1) % corners.len()]);
            let steps = if to == from { n } else { (to + n - from) % n };
            (0..=steps).map(|step| piece.outline[(from + step) % n]).collect()
        };
        let stretches: Vec<Vec<V2>> = pieces.iter().zip(&corners).map(stretch).collect();
        for (ring, stretch) in rings.iter_mut().zip(cut_alike(&stretches)) {
            ring.extend_from_slice(&stretch[..stretch.len() - 1]);
        }
    }
    Ok(rings)
}

/// Divides open lines wherever that of some size has a vertex, at the same share of the length.
fn cut_alike(lines: &[Vec<V2>]) -> Vec<Vec<V2>> {
    if lines.iter().all(|line| line.len() == lines[0].len()) {
        return lines.to_vec();
    }
    let Some(curves) = lines.iter().map(|line| Polyline::new(line.clone())).collect::<Option<Vec<_>>>() else {
        return lines.to_vec();
    };
    let inner = curves.iter().enumerate().flat_map(|(size, curve)| {
        let arcs = curve.arcs();
        arcs[1..arcs.len() - 1].iter().map(move |arc| (arc / curve.length(), size))
    });
    let mut all: Vec<(f64, usize)> = inner.collect();
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    let same = SAME_PLACE_M / curves.iter().map(Polyline::length).fold(SAME_PLACE_M, f64::max);
    let mut groups: Vec<Vec<(f64, usize)>> = Vec::new();
    for vertex in all {
        let is_near =
            |group: &Vec<(f64, usize)>| vertex.0 - group[0].0 < same && group.iter().all(|(_, size)| *size != vertex.1);
        match groups.last_mut().filter(|group| is_near(group)) {
            Some(group) => group.push(vertex),
            None => groups.push(vec![vertex]),
        }
    }
    let cut = |(size, curve): (usize, &Polyline)| {
        // Vertices of other sizes are interpolated between those of this size, and never coincide with them.
        let own = |group: &Vec<(f64, usize)>| Some([group[0].0, group.iter().find(|(_, owner)| *owner == size)?.0]);
        let known: Vec<[f64; 2]> =
            [[0.0; 2]].into_iter().chain(groups.iter().filter_map(own)).chain([[1.0; 2]]).collect();
        let place = |group: &Vec<(f64, usize)>| {
            let after = known.iter().position(|[first, _]| *first >= group[0].0).unwrap_or(known.len() - 1).max(1);
            let ([from, own_from], [to, own_to]) = (known[after - 1], known[after]);
            curve.at((own_from + (own_to - own_from) * (group[0].0 - from) / (to - from)) * curve.length())
        };
        let ends = [curve.points()[0], curve.points()[curve.points().len() - 1]];
        let between = groups.iter().map(place);
        [ends[0]].into_iter().chain(between).chain([ends[1]]).collect()
    };
    curves.iter().enumerate().map(cut).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_corner_stays_that_corner_however_far_it_moves() {
        // A side whose upper end moves by a tenth of the piece, with a vertex of the curve above it where the end was.
        let piece = |height: f64, first: usize| {
            let corners = [V2::zeros(), V2::new(0.5, 0.0), V2::new(0.5, height), V2::new(0.25, 0.5)];
            let between = |k: usize| -> Vec<V2> {
                let (from, to) = (corners[k], corners[(k + 1) % 4]);
                (0..25).map(|step| from.lerp(&to, f64::from(step) / 25.0)).collect()
            };
            let turns = (0..4).map(|k| corners[(k + first) % 4]).collect();
            Piece { outline: (0..4).flat_map(between).collect(), turn_points: turns, ..Piece::default() }
        };
        let (sample, moved) = (piece(0.40, 0), piece(0.33, 2));
        let rings = ring(&[&sample, &moved], 0, |piece| piece.outline.clone()).expect("one pattern");
        for corner in &sample.turn_points {
            let at = rings[0].iter().position(|p| (p - corner).norm() < 1e-9).expect("a corner of the sample");
            let to = rings[1][at];
            let is_corner = moved.turn_points.iter().any(|turn| (turn - to).norm() < 1e-9);
            assert!(is_corner && (to - corner).norm() < 0.08, "{corner:?} goes to {to:?}");
        }
    }

    #[test]
    fn vertices_of_several_sizes_do_not_fall_upon_each_other() {
        // 400 mm long; the second size has its vertex just before one that the first size has besides.
        let line = |places_mm: &[f64]| -> Vec<V2> { places_mm.iter().map(|mm| V2::new(1e-3 * mm, 0.0)).collect() };
        let lines = [line(&[0.0, 40.0, 40.2, 400.0]), line(&[0.0, 40.199_9, 400.0]), line(&[0.0, 300.0, 400.0])];
        for cut in cut_alike(&lines) {
            assert_eq!(cut.len(), 5, "{cut:?}");
            let nearest = cut.windows(2).map(|pair| pair[1].x - pair[0].x).fold(f64::INFINITY, f64::min);
            assert!(nearest > 0.05e-3, "{cut:?}");
        }
    }
}

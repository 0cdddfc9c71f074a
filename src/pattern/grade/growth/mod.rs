//! Growth of a pattern as a grade makes it: its cardinal points move, and the curves between them follow.
//!
//! Each handle is tried by a small amount, and the displacement of the cardinal points is kept. A side whose width a
//! handle sets between two corners, such as a waist, gets a point there. Curves that follow do not have the lengths that
//! the handle gives them. The displacements are therefore corrected by the smallest ones that keep the sides of every
//! seam alike: as far apart as before, with ease and gathers in proportion to the seam. Sizes are sums of these
//! displacements, so that even amounts make an even grade.

mod nest;
#[cfg(test)]
mod tests;

pub use self::nest::Graded;

use std::collections::BTreeMap;

use super::cardinal::{self, Cardinal, Kind};
use super::{Field, GradeTable, graded_piece, moved_piece};
use crate::dxf::Unit;
use crate::garment::Role;
use crate::handle::{Handle, HandleError, Redrawn, least_step};
use crate::piece::{Beside, GradePoint, Piece};
use crate::pom::Point;
use crate::seams::{SeamFile, StyleError};
use crate::style::correspond::shares;
use crate::style::named::called;
use crate::style::nest_corners::corners_of;
use crate::style::{EdgeRef, Style};
use geom::V2;
use geom::units::{from_mm, mm};

/// Amount by which each handle is tried.
const TRIED_M: f64 = 5e-3;
/// Shares of it, tried where a handle cannot move so far.
const SHARES: [f64; 3] = [1.0, 0.4, 0.1];
/// Displacement of one point by which its effect on the seams is found.
const NUDGE_M: f64 = 0.5e-3;
/// Last digit of a displacement in a table, as in genuine ones.
const DIGIT_M: f64 = 1e-5;
/// Greatest change of the difference between the sides of a seam, besides what its ease and gathers grow by.
const SEAM_M: f64 = 0.5e-3;
/// Change above which a size is corrected: below it, rules stay even.
const CLOSE_M: f64 = 0.4e-3;
const CORRECTIONS: usize = 4;
/// Weight of a point of front, back or leg in a correction: a sleeve is fitted to its armhole, and a band to its waist.
const TRUNK: f64 = 0.5;
/// Greatest distance from a cut line to its sew line. Points that near are corrected alike.
const ALLOWANCE_M: f64 = 40e-3;
/// Handles that set the width of a side between its corners.
const BETWEEN: [Handle; 4] = [Handle::Waist, Handle::Hip, Handle::Thigh, Handle::Knee];
/// Least displacement of such a place by a handle, relative to its amount.
const LEAST_SHARE: f64 = 0.2;
/// Least ratio of the displacement of such a place to that of the corners of its side.
const ABOVE_CORNERS: f64 = 1.25;
/// Distance along which such places of two handles are one.
const ONE_PLACE_M: f64 = 40e-3;

#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum GrowthError {
    #[error(transparent)]
    Handle(#[from] HandleError),
    #[error(transparent)]
    Style(#[from] StyleError),
    #[error("piece `{piece}`: {found}; accepted: sizes nearer to the sample size")]
    Piece { piece: String, found: String },
    #[error(
        "seam `{seam}`: its sides come apart by {off_mm:.1} mm when {by}; accepted: {within_mm} mm, besides what ease and gathers grow by"
    )]
    Seam {
        seam: String,
        /// Change of the difference of its sides.
        off_mm: f64,
        /// Handles with their amounts.
        by: String,
        within_mm: f64,
    },
}

/// A pattern with the displacement of its cardinal points by each handle.
#[derive(Clone, Debug)]
pub struct Growth {
    file: String,
    seams: Vec<u8>,
    /// Has a tolerance that lets sides come apart.
    loose: SeamFile,
    /// Greatest difference of the sides of a seam beside its ease.
    tolerance_m: f64,
    /// Sample size, with a grade point at every cardinal point.
    pieces: Vec<Piece>,
    points: Vec<Cardinal>,
    /// Corners that the seam file refers to by their places, by piece identifier: index of the piece and its vertices,
    /// the same in every size.
    corners: BTreeMap<String, (usize, Vec<usize>)>,
    style: Style,
    /// Both sides of each seam of the sample size.
    lengths_m: Vec<[f64; 2]>,
    /// Displacement of every cardinal point by each handle, m per m.
    fields: Vec<(Handle, Vec<V2>)>,
    levers: Levers,
    refused: Vec<(Handle, HandleError)>,
}

/// Effect of the displacement of sewn points on the seams.
#[derive(Clone, Debug, Default)]
struct Levers {
    /// Point and axis.
    columns: Vec<(usize, usize)>,
    weights: Vec<f64>,
    /// Change by seam and then column, m/m, times the weight.
    rows: Vec<Vec<f64>>,
}

impl Growth {
    /// `file` is the name of the seam file for messages. Handles that the pattern has and that cannot move are
    /// [`Self::refused`].
    pub fn of(pieces: &[Piece], seam_bytes: &[u8], file: &str, handles: &[Handle]) -> Result<Self, GrowthError> {
        let redrawn = Redrawn::of(pieces, seam_bytes, file, &[])?;
        let mut pieces = redrawn.pieces();
        let seams = redrawn.seams(&pieces, seam_bytes, file)?;
        for piece in &mut pieces {
            let Beside { garment, fold, .. } = std::mem::take(&mut piece.beside);
            piece.beside = Beside { garment, fold, ..Beside::default() };
            piece.grade_points.clear();
            // Rules are written along the axes of the file.
            piece.grade_reference = None;
        }
        let entries = SeamFile::parse(&seams, file)?;
        let style = Style::of(&pieces, &entries, file)?;
        let tolerance_m = from_mm(entries.length_tolerance_mm);
        let loose = SeamFile { length_tolerance_mm: f64::INFINITY, ..entries };
        let lengths_m = lengths_m(&style);
        let mut growth = Self {
            file: file.to_owned(),
            seams,
            loose,
            tolerance_m,
            points: Vec::new(),
            corners: BTreeMap::new(),
            pieces,
            style,
            lengths_m,
            fields: Vec::new(),
            levers: Levers::default(),
            refused: Vec::new(),
        };
        growth.try_handles(handles)?;
        growth.levers = growth.levers()?;
        for number in 0..growth.fields.len() {
            growth.keep_seams(number)?;
        }
        Ok(growth)
    }

    /// Sample size.
    pub fn style(&self) -> &Style {
        &self.style
    }

    pub fn handles(&self) -> impl Iterator<Item = Handle> + '_ {
        self.fields.iter().map(|(handle, _)| *handle)
    }

    pub fn refused(&self) -> &[(Handle, HandleError)] {
        &self.refused
    }

    fn try_handles(&mut self, handles: &[Handle]) -> Result<(), GrowthError> {
        let mut points: Vec<Cardinal> =
            self.pieces.iter().enumerate().flat_map(|(number, piece)| cardinal::points(number, piece)).collect();
        let corners = self.corners_of_seams();
        for corner in corners.values().flatten() {
            if !points.contains(corner) {
                points.push(*corner);
            }
        }
        let sides: Vec<cardinal::Side> =
            self.pieces.iter().enumerate().flat_map(|(number, piece)| cardinal::sides(number, piece)).collect();
        // Places along the sides come after the points.
        let mut probe = self.pieces.clone();
        let mark = |piece: &mut Piece, at: V2| piece.grade_points.push(GradePoint { at, rule: 1, is_inner: true });
        points.iter().for_each(|point| mark(&mut probe[point.piece], point.at));
        sides.iter().for_each(|side| side.places.iter().for_each(|at| mark(&mut probe[side.piece], *at)));
        let has = self.style.handles();
        let mut moved = Vec::new();
        for handle in handles.iter().copied().filter(|handle| has.contains(handle)) {
            match self.tried(&probe, handle) {
                Ok(places) => moved.push((handle, places)),
                Err(error) => self.refused.push((handle, error)),
            }
        }
        let mut read = Places { taken: vec![0; probe.len()] };
        let of_points: Vec<[usize; 2]> = points.iter().map(|point| read.next(point.piece)).collect();
        let of_sides: Vec<Vec<[usize; 2]>> =
            sides.iter().map(|side| side.places.iter().map(|_| read.next(side.piece)).collect()).collect();
        let between = between_corners(&sides, &of_sides, &moved);
        for &(side, k) in &between {
            let side = &sides[side];
            let piece = &mut self.pieces[side.piece];
            let line = if side.kind == Kind::SewLine { piece.sew_line.as_mut() } else { Some(&mut piece.outline) };
            line.into_iter().for_each(|line| cardinal::with_vertex(line, side.places[k]));
            if side.kind == Kind::Outline && !piece.curve_points.is_empty() {
                piece.curve_points.push(side.places[k]);
            }
        }
        // Only now do the lines have all their vertices.
        self.corners =
            corners.into_iter().filter_map(|(name, corners)| Some((name, self.vertices(&corners)?))).collect();
        let added = between.iter().map(|&(side, k)| {
            (
                Cardinal { piece: sides[side].piece, at: sides[side].places[k], kind: sides[side].kind },
                of_sides[side][k],
            )
        });
        let (points, places): (Vec<Cardinal>, Vec<[usize; 2]>) =
            points.iter().copied().zip(of_points).chain(added).unzip();
        self.fields = moved
            .into_iter()
            .map(|(handle, moved)| (handle, places.iter().map(|[piece, k]| moved[*piece][*k]).collect()))
            .collect();
        self.points = points;
        for (_, field) in &mut self.fields {
            together(&self.points, field);
        }
        for (number, point) in self.points.iter().enumerate() {
            let is_inner = point.kind != Kind::Outline;
            self.pieces[point.piece].grade_points.push(GradePoint { at: point.at, rule: number as u32 + 1, is_inner });
        }
        Ok(())
    }

    fn corners_of_seams(&self) -> BTreeMap<String, Vec<Cardinal>> {
        let mut corners = BTreeMap::new();
        for (name, entry) in self.loose.piece.iter().filter(|(_, entry)| !entry.corners_at.is_empty()) {
            let Some(&piece) = called(&self.pieces, &entry.block, self.loose.size.as_deref()).first() else { continue };
            let drawn = &self.pieces[piece];
            let kind = if drawn.sew_line.is_some() { Kind::SewLine } else { Kind::Outline };
            let vertices = corners_of(drawn, self.loose.size.as_deref(), &entry.corners_at).unwrap_or_default();
            let corner = |vertex: usize| Cardinal { piece, at: drawn.seam_outline()[vertex], kind };
            corners.insert(name.clone(), vertices.into_iter().map(corner).collect());
        }
        corners
    }

    fn vertices(&self, corners: &[Cardinal]) -> Option<(usize, Vec<usize>)> {
        let piece = corners.first()?.piece;
        let outline = self.pieces[piece].seam_outline();
        let nearest = |corner: &Cardinal| {
            let away = |vertex: &usize| (outline[*vertex] - corner.at).norm_squared();
            (0..outline.len()).min_by(|a, b| away(a).total_cmp(&away(b))).unwrap_or(0)
        };
        Some((piece, corners.iter().map(nearest).collect()))
    }

    fn places(&self, pieces: &[Piece]) -> BTreeMap<String, Vec<[f64; 2]>> {
        let of_piece = |(name, (piece, vertices)): (&String, &(usize, Vec<usize>))| {
            (name.clone(), shares(pieces[*piece].seam_outline(), vertices))
        };
        self.corners.iter().map(of_piece).collect()
    }

    /// Displacement of the grade points of all pieces, m per m.
    fn tried(&self, probe: &[Piece], handle: Handle) -> Result<Vec<Vec<V2>>, HandleError> {
        let moved = |amount_m: f64| {
            Redrawn::of(probe, &self.seams, &self.file, &[(handle, amount_m)]).map(|redrawn| redrawn.pieces())
        };
        let both = |share: f64| Ok([moved(-share * TRIED_M)?, moved(share * TRIED_M)?]);
        let mut refused = None;
        for share in SHARES {
            match both(share) {
                Ok([less, more]) => {
                    let step = |(less, more): (&GradePoint, &GradePoint)| (more.at - less.at) / (2.0 * share * TRIED_M);
                    let piece = |(less, more): (&Piece, &Piece)| {
                        less.grade_points.iter().zip(&more.grade_points).map(step).collect()
                    };
                    return Ok(less.iter().zip(&more).map(piece).collect());
                }
                Err(error) => refused = refused.or(Some(error)),
            }
        }
        refused.map_or(Ok(Vec::new()), Err)
    }

    /// Displaces the cardinal points of `only`, or of all pieces, m.
    fn displaced(&self, steps: &[V2], only: Option<usize>) -> Result<Vec<Piece>, GrowthError> {
        let rules = steps.iter().enumerate().map(|(k, step)| (k as u32 + 1, vec![V2::zeros(), *step])).collect();
        let sizes = ["sample", "size"].map(str::to_owned).to_vec();
        let table = GradeTable { sizes, ..self.table(rules, 0) };
        let piece = |(number, piece): (usize, &Piece)| {
            let is_still = only.is_some_and(|only| only != number) || piece.grade_points.is_empty();
            if is_still {
                return Ok(piece.clone());
            }
            // A trial by half a millimetre tells lengths, even where it closes a slit.
            let moved = if only.is_some() { moved_piece(piece, &table, 1) } else { graded_piece(piece, &table, 1) };
            moved.map_err(|found| GrowthError::Piece { piece: piece.name.clone(), found })
        };
        self.pieces.iter().enumerate().map(piece).collect()
    }

    fn table(&self, rules: BTreeMap<u32, Vec<V2>>, sample: usize) -> GradeTable {
        GradeTable { file: self.file.clone(), sizes: Vec::new(), sample, unit: Unit::Mm, rules }
    }

    /// The seams may come apart.
    fn loosely(&self, steps: &[V2], only: Option<usize>) -> Result<Style, GrowthError> {
        let pieces = self.displaced(steps, only)?;
        let mut entries = self.loose.clone();
        for (name, places) in self.places(&pieces) {
            entries.piece.entry(name).and_modify(|entry| entry.corners_at = places);
        }
        Ok(Style::of(&pieces, &entries, &self.file)?)
    }

    /// Change of the difference between the sides of each seam, besides what its ease grows by.
    fn off_m(&self, style: &Style) -> Vec<f64> {
        let off = |([a, b], [a_before, b_before]): (&[f64; 2], &[f64; 2])| {
            (a - b) - (a_before - b_before) * b / b_before.max(f64::MIN_POSITIVE)
        };
        lengths_m(style).iter().zip(&self.lengths_m).map(off).collect()
    }

    fn levers(&self) -> Result<Levers, GrowthError> {
        let trunk = self.trunk();
        let mut levers = Levers { rows: vec![Vec::new(); self.lengths_m.len()], ..Levers::default() };
        for (number, point) in self.points.iter().enumerate().filter(|(_, p)| p.is_sewn(&self.pieces[p.piece])) {
            for axis in 0..2 {
                let mut steps = vec![V2::zeros(); self.points.len()];
                steps[number][axis] = NUDGE_M;
                let off_m = self.off_m(&self.loosely(&steps, Some(point.piece))?);
                let weight = if trunk.contains(&point.piece) { TRUNK } else { 1.0 };
                levers.columns.push((number, axis));
                levers.weights.push(weight);
                levers.rows.iter_mut().zip(off_m).for_each(|(row, off_m)| row.push(weight * off_m / NUDGE_M));
            }
        }
        Ok(levers)
    }

    fn trunk(&self) -> Vec<usize> {
        let is_trunk =
            |role: Role| !matches!(role, Role::SleeveLeft | Role::SleeveRight | Role::Waistband | Role::Other);
        let entries = self.loose.piece.values().filter(|entry| is_trunk(entry.role));
        entries
            .filter_map(|entry| called(&self.pieces, &entry.block, self.loose.size.as_deref()).first().copied())
            .collect()
    }

    /// Smallest displacement that changes the seams by `-off_m`.
    fn correction(&self, off_m: &[f64]) -> Vec<V2> {
        let Levers { columns, weights, rows } = &self.levers;
        let mut steps = vec![V2::zeros(); self.points.len()];
        for (((number, axis), weight), step) in columns.iter().zip(weights).zip(least_step(rows, off_m)) {
            steps[*number][*axis] -= weight * step;
        }
        let sewn: Vec<usize> = columns.iter().map(|(number, _)| *number).collect();
        for (number, point) in self.points.iter().enumerate().filter(|(number, _)| !sewn.contains(number)) {
            let away = |other: &usize| (self.points[*other].at - point.at).norm();
            let near = sewn.iter().copied().filter(|other| self.points[*other].piece == point.piece);
            let nearest = near.min_by(|a, b| away(a).total_cmp(&away(b))).filter(|other| away(other) < ALLOWANCE_M);
            if point.kind == Kind::Outline
                && let Some(nearest) = nearest
            {
                steps[number] = steps[nearest];
            }
        }
        steps
    }

    /// Corrects one handle so that seams keep to first order, and lets notches follow the outline.
    fn keep_seams(&mut self, number: usize) -> Result<(), GrowthError> {
        let scaled = |by_m: f64| -> Vec<V2> { self.fields[number].1.iter().map(|step| step * by_m).collect() };
        let [less, more] = [-TRIED_M, TRIED_M].map(|by_m| self.loosely(&scaled(by_m), None));
        let (less, more) = (self.off_m(&less?), self.off_m(&more?));
        let slopes: Vec<f64> = less.iter().zip(&more).map(|(less, more)| (more - less) / (2.0 * TRIED_M)).collect();
        let correction = self.correction(&slopes);
        let mut field: Vec<V2> = self.fields[number].1.iter().zip(&correction).map(|(step, by)| step + by).collect();
        self.follow(&mut field);
        self.fields[number].1 = field;
        Ok(())
    }

    fn follow(&self, field: &mut [V2]) {
        let rules = field.iter().enumerate().map(|(k, step)| (k as u32 + 1, vec![*step])).collect();
        let table = self.table(rules, 0);
        for (number, piece) in self.pieces.iter().enumerate() {
            let is_on = |point: &&GradePoint| self.points[point.rule as usize - 1].kind == Kind::Outline;
            let bare =
                Piece { grade_points: piece.grade_points.iter().filter(is_on).copied().collect(), ..piece.clone() };
            let Ok(outline) = Field::of(&bare, &table, 0) else { continue };
            let notches = self.points.iter().zip(field.iter_mut());
            let notches = notches.filter(|(point, _)| point.piece == number && point.kind == Kind::Notch);
            notches.for_each(|(point, step)| *step = outline.at(&point.at));
        }
    }

    /// Displacement by amounts of handles, m, as tables write it. Where the sum of the handles parts the sides of a
    /// seam, its points are corrected for this size.
    fn steps(&self, amounts: &[(Handle, f64)]) -> Result<(Vec<V2>, Style), GrowthError> {
        let mut exact = vec![V2::zeros(); self.points.len()];
        for (handle, amount_m) in amounts {
            let Some((_, field)) = self.fields.iter().find(|(known, _)| known == handle) else { continue };
            exact.iter_mut().zip(field).for_each(|(step, by)| *step += by * *amount_m);
        }
        let rounded = |exact: &[V2]| -> Vec<V2> {
            exact.iter().map(|step| step.map(|x| (x / DIGIT_M).round() * DIGIT_M)).collect()
        };
        let mut steps = rounded(&exact);
        let mut style = self.loosely(&steps, None)?;
        let mut off_m = self.off_m(&style);
        let worst = |off_m: &[f64]| off_m.iter().fold(0.0_f64, |worst, off| worst.max(off.abs()));
        for _ in 0..CORRECTIONS {
            if worst(&off_m) < CLOSE_M {
                break;
            }
            let correction = self.correction(&off_m);
            exact.iter_mut().zip(&correction).for_each(|(step, by)| *step += by);
            self.follow(&mut exact);
            steps = rounded(&exact);
            style = self.loosely(&steps, None)?;
            off_m = self.off_m(&style);
        }
        let apart = off_m.iter().enumerate().max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
        match apart.filter(|(_, off)| off.is_nan() || off.abs() > SEAM_M) {
            None => Ok((steps, style)),
            Some((seam, off)) => {
                let by: Vec<String> =
                    amounts.iter().map(|(h, m)| format!("{} moves by {:+.0} mm", h.as_str(), mm(*m))).collect();
                let seam = self.style.seams[seam].name.clone();
                Err(GrowthError::Seam { seam, off_mm: mm(*off), by: by.join(", "), within_mm: mm(SEAM_M) })
            }
        }
    }

    /// Amounts are in m.
    pub fn sized(&self, amounts: &[(Handle, f64)]) -> Result<Style, GrowthError> {
        Ok(self.steps(amounts)?.1)
    }

    /// Amounts that change points of measure as told, m: each by the handle that is named for it, and all others not at
    /// all. A handle without a point of measure keeps its amount.
    pub fn aimed(&self, told: &[(Handle, f64)]) -> Result<Vec<(Handle, f64)>, GrowthError> {
        let told: Vec<(Handle, f64)> =
            told.iter().copied().filter(|(handle, _)| self.handles().any(|h| h == *handle)).collect();
        let aims: Vec<Option<Point>> = told.iter().map(|(handle, _)| handle.changes()).collect();
        let measured = |handle: Handle, by_m: f64| -> Result<Vec<Option<f64>>, GrowthError> {
            let style = self.sized(&[(handle, by_m)])?;
            let found = style.points_of_measure();
            let length = |aim: &Option<Point>| found.iter().find(|p| Some(p.point) == *aim).map(|p| p.length_m);
            Ok(aims.iter().map(length).collect())
        };
        let mut rows = vec![vec![0.0; told.len()]; told.len()];
        for (column, (handle, _)) in told.iter().enumerate() {
            let (less, more) = (measured(*handle, -TRIED_M)?, measured(*handle, TRIED_M)?);
            for (row, both) in less.iter().zip(&more).map(|(less, more)| less.zip(*more)).enumerate() {
                let own = if row == column { 1.0 } else { 0.0 };
                rows[row][column] = both.map_or(own, |(less, more)| (more - less) / (2.0 * TRIED_M));
            }
        }
        let missed: Vec<f64> = rows
            .iter()
            .zip(&told)
            .map(|(row, (_, aim_m))| {
                row.iter().zip(&told).map(|(by, (_, amount_m))| by * amount_m).sum::<f64>() - aim_m
            })
            .collect();
        let steps = least_step(&rows, &missed);
        Ok(told.iter().zip(steps).map(|((handle, amount_m), step)| (*handle, amount_m - step)).collect())
    }
}

struct Places {
    taken: Vec<usize>,
}

impl Places {
    fn next(&mut self, piece: usize) -> [usize; 2] {
        self.taken[piece] += 1;
        [piece, self.taken[piece] - 1]
    }
}

fn lengths_m(style: &Style) -> Vec<[f64; 2]> {
    let length = |side: &[EdgeRef]| side.iter().map(|edge| style.edge(*edge).line.length()).sum();
    style.seams.iter().map(|seam| [length(&seam.a), length(&seam.b)]).collect()
}

/// Both ends of a grain line move by their mean, so that it keeps its direction.
fn together(points: &[Cardinal], field: &mut [V2]) {
    for k in 1..points.len() {
        if points[k].kind == Kind::Grain && points[k - 1].kind == Kind::Grain && points[k].piece == points[k - 1].piece
        {
            let mean = 0.5 * (field[k] + field[k - 1]);
            (field[k - 1], field[k]) = (mean, mean);
        }
    }
}

/// Side and place where a handle sets a width between corners: where it moves the side most, if more than its corners.
fn between_corners(
    sides: &[cardinal::Side],
    places: &[Vec<[usize; 2]>],
    moved: &[(Handle, Vec<Vec<V2>>)],
) -> Vec<(usize, usize)> {
    let mut found: Vec<(usize, usize)> = Vec::new();
    for (_, moved) in moved.iter().filter(|(handle, _)| BETWEEN.contains(handle)) {
        for (number, side) in sides.iter().enumerate() {
            let by = |k: usize| moved[places[number][k][0]][places[number][k][1]].norm();
            let Some(most) = side.inner.clone().max_by(|a, b| by(*a).total_cmp(&by(*b))) else { continue };
            let corners = by(0).max(by(side.places.len() - 1));
            let is_near = |&(other, k): &(usize, usize)| {
                other == number && (side.places[k] - side.places[most]).norm() < ONE_PLACE_M
            };
            if by(most) > LEAST_SHARE && by(most) > ABOVE_CORNERS * corners && !found.iter().any(is_near) {
                found.push((number, most));
            }
        }
    }
    found
}

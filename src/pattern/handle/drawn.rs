//! Handles applied to pieces as drawn in the file, so that a changed style can be written and its seam file stays
//! valid.

use std::collections::BTreeMap;

use super::HALVINGS;
use super::field::Field;
use super::{Handle, HandleError};
use crate::piece::{Beside, Piece};
use crate::seams::{SeamFile, StyleError};
use crate::style::correspond::shares;
use crate::style::named::called;
use crate::style::nest_corners::corners_of;
use crate::style::{Style, StylePiece};
use geom::V2;
use geom::units::mm;
use toml_edit::{Array, DocumentMut, Value, value};

/// Greatest deviation of a displaced segment from the displaced positions of its inner points, m: a hundredth of the
/// tolerance of a seam.
const CARRIED_M: f64 = 5e-6;
/// Length below which such a segment is not divided further, m.
const SHORT_M: f64 = 1e-3;
/// Greatest difference between the changes of a block that is worn twice, m.
const ALIKE_M: f64 = 0.05e-3;

/// Changed pieces, and a seam file that makes the changed style of these pieces.
#[derive(Clone, Debug, PartialEq)]
pub struct Redrawn {
    /// Pieces as drawn, with changed outlines, in the order of the file.
    pub pieces: Vec<Piece>,
    /// Bytes of the seam file. Only `corners_at`, the positions of corners on their pieces, change.
    pub seams: Vec<u8>,
}

/// Applies handles with their amounts, m, to pieces as drawn. The pieces and the seam file make the style that has the
/// handles. `file` is the name of the seam file for messages.
///
/// # Errors
/// [`HandleError`] if pieces and seam file make no style, a handle cannot be applied, or a block that is worn twice
/// would have to change in two ways.
pub fn redrawn(
    pieces: &[Piece],
    seam_bytes: &[u8],
    file: &str,
    handles: &[(Handle, f64)],
) -> Result<Redrawn, HandleError> {
    let entries = SeamFile::parse(seam_bytes, file)?;
    let style = Style::of(pieces, &entries, file)?;
    let (mut after, mut steps) = (style.clone(), Vec::new());
    for &(handle, amount_m) in handles {
        let course = after.moved_in_steps(handle, amount_m, HALVINGS)?;
        steps.extend(course.steps);
        after = course.style;
    }
    let mut redrawn: BTreeMap<usize, Carrier<'_>> = BTreeMap::new();
    for (number, (worn, entry)) in style.pieces.iter().zip(entries.piece.values()).enumerate() {
        let Some(&drawn) = called(pieces, &entry.block, entries.size.as_deref()).first() else { continue };
        let fields = steps.iter().filter_map(|fields| fields.get(&number)).collect();
        let carrier = Carrier { pose: Pose::of(&pieces[drawn], worn, entry.mirror), fields };
        if let Some(other) = redrawn.get(&drawn) {
            let apart = |p: &V2| (carrier.carried(*p) - other.carried(*p)).norm();
            let apart_m = pieces[drawn].outline.iter().map(apart).fold(0.0, f64::max);
            if apart_m > ALIKE_M {
                return Err(HandleError::Drawn { block: entry.block.clone(), apart_mm: mm(apart_m) });
            }
        }
        redrawn.insert(drawn, carrier);
    }
    let piece =
        |(number, piece): (usize, &Piece)| redrawn.get(&number).map_or_else(|| piece.clone(), |by| by.piece(piece));
    let changed: Vec<Piece> = pieces.iter().enumerate().map(piece).collect();
    let mut corners = BTreeMap::new();
    for (name, entry) in entries.piece.iter().filter(|(_, entry)| !entry.corners_at.is_empty()) {
        let Some(&drawn) = called(pieces, &entry.block, entries.size.as_deref()).first() else { continue };
        let vertices = corners_of(&pieces[drawn], entries.size.as_deref(), &entry.corners_at);
        let (Some(by), Ok(vertices)) = (redrawn.get(&drawn), vertices) else { continue };
        let (before, after) = (pieces[drawn].seam_outline(), changed[drawn].seam_outline());
        let nearest = |place: V2| {
            let away = |k: &usize| (after[*k] - place).norm_squared();
            (0..after.len()).min_by(|vertex, other| away(vertex).total_cmp(&away(other))).unwrap_or(0)
        };
        let moved: Vec<usize> = vertices.into_iter().map(|vertex| nearest(by.carried(before[vertex]))).collect();
        corners.insert(name.clone(), shares(after, &moved));
    }
    Ok(Redrawn { pieces: changed, seams: with_corners(seam_bytes, file, &corners)? })
}

/// Bytes of a seam file with changed `corners_at` of some pieces. The rest of its text stays.
pub(crate) fn with_corners(
    seam_bytes: &[u8],
    file: &str,
    corners: &BTreeMap<String, Vec<[f64; 2]>>,
) -> Result<Vec<u8>, HandleError> {
    if corners.is_empty() {
        return Ok(seam_bytes.to_vec());
    }
    let syntax = |reason: String| StyleError::Syntax { file: file.to_owned(), reason };
    let text = std::str::from_utf8(seam_bytes).map_err(|error| syntax(error.to_string()))?;
    let mut document: DocumentMut = text.parse().map_err(|error: toml_edit::TomlError| syntax(error.to_string()))?;
    for (name, places) in corners {
        let places: Array = places.iter().map(|place| Value::from(place.iter().copied().collect::<Array>())).collect();
        document["piece"][name]["corners_at"] = value(places);
    }
    Ok(document.to_string().into_bytes())
}

/// Transform of a piece from drawn to worn: mirrored by the seam file, then turned upright.
struct Pose {
    is_mirrored: bool,
    /// Cosine and sine of the turn.
    turn: V2,
}

impl Pose {
    /// Transform of a drawn piece to a piece of the style. The grain gives the rotation.
    fn of(drawn: &Piece, worn: &StylePiece, is_mirrored: bool) -> Self {
        let grain = drawn.grain.and_then(|[from, to]| (to - from).try_normalize(0.0)).unwrap_or_else(V2::y);
        let grain = if is_mirrored { V2::new(-grain.x, grain.y) } else { grain };
        Self { is_mirrored, turn: V2::new(grain.dot(&worn.grain), grain.perp(&worn.grain)) }
    }

    fn worn(&self, p: V2) -> V2 {
        let p = if self.is_mirrored { V2::new(-p.x, p.y) } else { p };
        V2::new(self.turn.x * p.x - self.turn.y * p.y, self.turn.y * p.x + self.turn.x * p.y)
    }

    fn drawn(&self, p: V2) -> V2 {
        let p = V2::new(self.turn.x * p.x + self.turn.y * p.y, self.turn.x * p.y - self.turn.y * p.x);
        if self.is_mirrored { V2::new(-p.x, p.y) } else { p }
    }
}

/// Displacement of a drawn piece by the fields of all handles in turn.
struct Carrier<'a> {
    pose: Pose,
    fields: Vec<&'a Field>,
}

impl Carrier<'_> {
    fn carried(&self, p: V2) -> V2 {
        if self.fields.is_empty() {
            return p;
        }
        self.pose.drawn(self.fields.iter().fold(self.pose.worn(p), |p, field| field.carried(p)))
    }

    /// Displaces a line, dividing its segments where the field bends them.
    fn line(&self, points: &[V2], is_closed: bool) -> Vec<V2> {
        let Some(&first) = points.first() else { return Vec::new() };
        let mut carried = vec![self.carried(first)];
        for ends in points.windows(2) {
            self.segment([ends[0], ends[1]], &mut carried);
        }
        if is_closed {
            self.segment([points[points.len() - 1], first], &mut carried);
            carried.pop();
        }
        carried
    }

    /// Appends the displaced points of a segment after its start.
    fn segment(&self, [from, to]: [V2; 2], carried: &mut Vec<V2>) {
        let middle = from.lerp(&to, 0.5);
        let bend = self.carried(middle) - self.carried(from).lerp(&self.carried(to), 0.5);
        let quarter = from.lerp(&to, 0.25);
        let bend_before = self.carried(quarter) - self.carried(from).lerp(&self.carried(to), 0.25);
        if bend.norm().max(bend_before.norm()) > CARRIED_M && (to - from).norm() > SHORT_M {
            self.segment([from, middle], carried);
            self.segment([middle, to], carried);
        } else {
            carried.push(self.carried(to));
        }
    }

    fn piece(&self, drawn: &Piece) -> Piece {
        let mut piece = Piece { beside: Beside::default(), ..drawn.clone() };
        piece.outline = self.line(&drawn.outline, true);
        piece.sew_line = drawn.sew_line.as_ref().map(|line| self.line(line, true));
        for line in piece.internal_lines.iter_mut().chain(&mut piece.cut_outs) {
            *line = self.line(line, false);
        }
        let points = piece.turn_points.iter_mut().chain(&mut piece.drill_holes);
        let marks = piece.notches.iter_mut().map(|notch| &mut notch.at);
        let graded = piece.grade_points.iter_mut().map(|point| &mut point.at);
        points.chain(marks).chain(graded).for_each(|p| *p = self.carried(*p));
        if !piece.curve_points.is_empty() {
            let is_curve = |p: &&V2| !piece.turn_points.contains(p);
            piece.curve_points = piece.outline.iter().filter(is_curve).copied().collect();
        }
        piece.mirror_line = drawn.mirror_line.map(|line| line.map(|p| self.carried(p)));
        // Grain line and grade reference line are translated only, so they keep their directions.
        for line in [&mut piece.grain, &mut piece.grade_reference].into_iter().flatten() {
            let middle = line[0].lerp(&line[1], 0.5);
            let by = self.carried(middle) - middle;
            line.iter_mut().for_each(|p| *p += by);
        }
        piece
    }
}

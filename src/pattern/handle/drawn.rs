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
use crate::style::shrinkage::Shrinkage;
use crate::style::{Style, StylePiece};
use crate::unfold::Fold;
use geom::V2;
use geom::polyline::segment_distance;
use geom::units::mm;
use toml_edit::{Array, DocumentMut, Value, value};

/// Greatest deviation of a displaced segment from the displaced positions of its inner points: a hundredth of the
/// tolerance of a seam.
const CARRIED_M: f64 = 5e-6;
/// Length below which a segment is not divided further.
const SHORT_M: f64 = 1e-3;
/// Greatest difference between the changes of a block that is worn twice.
const ALIKE_M: f64 = 0.05e-3;

/// Handles applied to pieces as drawn.
pub struct Redrawn<'a> {
    pieces: &'a [Piece],
    entries: SeamFile,
    carriers: BTreeMap<usize, Carrier>,
}

impl<'a> Redrawn<'a> {
    /// Amounts are in m. Fails also where a block that is worn twice would change in two ways.
    pub fn of(
        pieces: &'a [Piece],
        seam_bytes: &[u8],
        file: &str,
        handles: &[(Handle, f64)],
    ) -> Result<Self, HandleError> {
        let entries = SeamFile::parse(seam_bytes, file)?;
        let style = Style::of(pieces, &entries, file)?;
        let (mut after, mut steps) = (style.clone(), Vec::new());
        for &(handle, amount_m) in handles {
            let course = after.moved_in_steps(handle, amount_m, HALVINGS)?;
            steps.extend(course.steps);
            after = course.style;
        }
        let mut carriers: BTreeMap<usize, Carrier> = BTreeMap::new();
        for (number, (worn, entry)) in style.pieces.iter().zip(entries.piece.values()).enumerate() {
            let Some(&drawn) = called(pieces, &entry.block, entries.size.as_deref()).first() else { continue };
            let fields: Vec<Field> = steps.iter_mut().filter_map(|fields| fields.remove(&number)).collect();
            let fold = pieces[drawn].beside.fold.and_then(Fold::at);
            let carrier = Carrier { pose: Pose::of(&pieces[drawn], worn, entry.mirror, style.shrinkage), fields, fold };
            if let Some(other) = carriers.get(&drawn) {
                let apart = |p: &V2| (carrier.carried(*p) - other.carried(*p)).norm();
                let apart_m = pieces[drawn].outline.iter().map(apart).fold(0.0, f64::max);
                if apart_m > ALIKE_M {
                    return Err(HandleError::Drawn { block: entry.block.clone(), apart_mm: mm(apart_m) });
                }
            }
            carriers.insert(drawn, carrier);
        }
        Ok(Self { pieces, entries, carriers })
    }

    /// Half of a piece that is folded changes as its other half does, so that it still lies at the fold.
    pub fn carried(&self, piece: usize, p: V2) -> V2 {
        self.carriers.get(&piece).map_or(p, |by| by.carried(p))
    }

    /// Outlines get as many vertices as follow the change within a hundredth of a millimetre. The order is that of the
    /// file.
    pub fn pieces(&self) -> Vec<Piece> {
        let piece = |(number, piece): (usize, &Piece)| {
            self.carriers.get(&number).map_or_else(|| piece.clone(), |by| by.piece(piece))
        };
        self.pieces.iter().enumerate().map(piece).collect()
    }

    /// Seam file for changed pieces, given in the order of the pieces before. Only `corners_at`, the positions of
    /// corners on their pieces, change. Corners that are found on another size of a nest stay.
    pub fn seams(&self, changed: &[Piece], seam_bytes: &[u8], file: &str) -> Result<Vec<u8>, HandleError> {
        let (entries, mut corners) = (&self.entries, BTreeMap::new());
        let made_on = entries.size.as_deref();
        for (name, entry) in entries.piece.iter().filter(|(_, entry)| !entry.corners_at.is_empty()) {
            let Some(&drawn) = called(self.pieces, &entry.block, made_on).first() else { continue };
            let (before, Some(after)) = (&self.pieces[drawn], changed.get(drawn)) else { continue };
            let is_made_on = |size: &Option<String>| {
                size.as_deref().zip(made_on).is_some_and(|(size, made_on)| size.eq_ignore_ascii_case(made_on))
            };
            let is_other = !is_made_on(&after.size) && after.beside.sizes.iter().any(|sized| is_made_on(&sized.size));
            let vertices = corners_of(before, made_on, &entry.corners_at);
            let (Some(by), Ok(vertices), false) = (self.carriers.get(&drawn), vertices, is_other) else { continue };
            let (before, after) = (before.seam_outline(), after.seam_outline());
            let nearest = |place: V2| {
                let away = |k: &usize| (after[*k] - place).norm_squared();
                (0..after.len()).min_by(|vertex, other| away(vertex).total_cmp(&away(other))).unwrap_or(0)
            };
            let moved: Vec<usize> = vertices.into_iter().map(|vertex| nearest(by.carried(before[vertex]))).collect();
            corners.insert(name.clone(), shares(after, &moved));
        }
        with_corners(seam_bytes, file, &corners)
    }
}

/// Greatest distance between the edges, each piece laid on the other by its corners. Infinite if the styles have not
/// the same edges.
pub fn outlines_apart_m(style: &Style, other: &Style) -> f64 {
    let has_same = |(piece, other): (&StylePiece, &StylePiece)| piece.edges.len() == other.edges.len();
    if style.pieces.len() != other.pieces.len() || !style.pieces.iter().zip(&other.pieces).all(has_same) {
        return f64::INFINITY;
    }
    let middle = |piece: &StylePiece| -> V2 {
        piece.edges.iter().map(|edge| edge.line.points()[0]).sum::<V2>() / piece.edges.len().max(1) as f64
    };
    let away = |points: &[V2], line: &[V2], by: V2| {
        let distance = |p: &V2| {
            line.windows(2).map(|ends| segment_distance(&ends[0], &ends[1], &(p + by))).fold(f64::INFINITY, f64::min)
        };
        points.iter().map(distance).fold(0.0, f64::max)
    };
    let apart = |(piece, other): (&StylePiece, &StylePiece)| {
        let by = middle(other) - middle(piece);
        let edges = piece.edges.iter().zip(&other.edges).map(|(edge, of_other)| {
            let (line, other) = (edge.line.points(), of_other.line.points());
            away(line, other, by).max(away(other, line, -by))
        });
        edges.fold(0.0, f64::max)
    };
    style.pieces.iter().zip(&other.pieces).map(apart).fold(0.0, f64::max)
}

/// Changes `corners_at` of some pieces. The rest of the text stays.
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

/// Transform from drawn to worn: mirrored by the seam file, shrunk, then turned upright.
struct Pose {
    is_mirrored: bool,
    /// Of the cloth, and the grain before the turn.
    shrinkage: Shrinkage,
    grain: V2,
    /// Cosine and sine.
    turn: V2,
}

impl Pose {
    /// The grain gives the rotation.
    fn of(drawn: &Piece, worn: &StylePiece, is_mirrored: bool, shrinkage: Shrinkage) -> Self {
        let grain = drawn.grain.and_then(|[from, to]| (to - from).try_normalize(0.0)).unwrap_or_else(V2::y);
        let grain = if is_mirrored { V2::new(-grain.x, grain.y) } else { grain };
        let turn = V2::new(grain.dot(&worn.grain), grain.perp(&worn.grain));
        Self { is_mirrored, shrinkage, grain, turn }
    }

    fn worn(&self, p: V2) -> V2 {
        let p = if self.is_mirrored { V2::new(-p.x, p.y) } else { p };
        let p = self.shrinkage.worn(p, self.grain);
        V2::new(self.turn.x * p.x - self.turn.y * p.y, self.turn.y * p.x + self.turn.x * p.y)
    }

    fn drawn(&self, p: V2) -> V2 {
        let p = V2::new(self.turn.x * p.x + self.turn.y * p.y, self.turn.x * p.y - self.turn.y * p.x);
        let p = self.shrinkage.cut(p, self.grain);
        if self.is_mirrored { V2::new(-p.x, p.y) } else { p }
    }
}

/// Displaces a drawn piece by the fields of all handles in turn.
struct Carrier {
    pose: Pose,
    fields: Vec<Field>,
    fold: Option<Fold>,
}

impl Carrier {
    fn carried(&self, p: V2) -> V2 {
        if self.fields.is_empty() {
            return p;
        }
        let whole = |p: V2| self.pose.drawn(self.fields.iter().fold(self.pose.worn(p), |p, field| field.carried(p)));
        match &self.fold {
            // The mean of the change and of its mirror image. A band that stretches from one end stretches from the fold.
            Some(fold) => whole(p).lerp(&fold.reflected(whole(fold.reflected(p))), 0.5),
            None => whole(p),
        }
    }

    /// Divides segments where the field bends them.
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

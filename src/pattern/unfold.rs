//! Unfolding of a half piece at its mirror line (fold line).

use super::piece::{Notch, Piece};
use geom::V2;

const ON_FOLD_M: f64 = 0.1e-3;
/// Turning angle of the unfolded outline below which an end of the mirror line is no corner.
const CORNER_TURN_DEG: f64 = 10.0;

/// Reflects points to the other half.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fold {
    from: V2,
    along: V2,
}

impl Fold {
    /// `None` for a line of no length.
    pub(crate) fn at([from, to]: [V2; 2]) -> Option<Self> {
        Some(Self { from, along: (to - from).try_normalize(0.0)? })
    }

    fn distance(&self, point: &V2) -> f64 {
        self.along.perp(&(point - self.from)).abs()
    }

    pub(crate) fn reflected(&self, point: V2) -> V2 {
        let offset = point - self.from;
        self.from + self.along * (2.0 * self.along.dot(&offset)) - offset
    }

    /// Joins both halves of a closed outline. `None` if none of its sides lies along the mirror line.
    fn opened(&self, outline: &[V2]) -> Option<Vec<V2>> {
        let n = outline.len();
        let is_on = |i: usize| self.distance(&outline[i % n]) < ON_FOLD_M;
        // The vertices on the mirror line are consecutive. The half outline begins at the last of them and ends at the
        // first.
        let last = (0..n).find(|&i| is_on(i) && !is_on(i + 1))?;
        let half_sides = (1..n).find(|&k| is_on(last + k))?;
        let rest_is_fold = (half_sides..=n).all(|k| is_on(last + k));
        if half_sides == n || half_sides + 1 > n || !rest_is_fold {
            return None;
        }
        let half: Vec<V2> = (0..=half_sides).map(|k| outline[(last + k) % n]).collect();
        let other = half[1..half_sides].iter().rev().map(|&p| self.reflected(p));
        Some(half.iter().copied().chain(other).collect())
    }
}

impl Piece {
    /// Opens a half piece, which has the mirror line (layer 6) as a side. `None` for a piece that is whole already, or
    /// whose sew line has no side on its mirror line.
    ///
    /// Points, notches and lines are mirrored too. An end of the mirror line stays a turn point only if the unfolded
    /// outline turns there.
    pub fn unfolded(&self) -> Option<Self> {
        let fold = Fold::at(self.mirror_line?)?;
        let outline = fold.opened(&self.outline)?;
        let sew_line = match &self.sew_line {
            Some(line) => Some(fold.opened(line)?),
            None => None,
        };
        let is_off = |point: &&V2| fold.distance(point) >= ON_FOLD_M;
        let both = |points: &[V2]| -> Vec<V2> {
            let mirrored = points.iter().filter(is_off).map(|&p| fold.reflected(p));
            points.iter().copied().chain(mirrored).collect()
        };
        let turn_points = both(&self.turn_points);
        let is_corner = |point: &V2| fold.distance(point) >= ON_FOLD_M || turn_deg(&outline, point) >= CORNER_TURN_DEG;
        let mirrored_notch = |notch: &Notch| Notch {
            at: fold.reflected(notch.at),
            angle_deg: notch.angle_deg.map(|angle| {
                let fold_angle = fold.along.y.atan2(fold.along.x).to_degrees();
                (2.0 * fold_angle - angle).rem_euclid(360.0)
            }),
            ..*notch
        };
        let off_fold = |line: &&Vec<V2>| line.iter().any(|p| is_off(&p));
        let both_lines = |lines: &[Vec<V2>]| -> Vec<Vec<V2>> {
            let mirrored = lines.iter().filter(off_fold).map(|line| line.iter().map(|&p| fold.reflected(p)).collect());
            lines.iter().cloned().chain(mirrored).collect()
        };
        let other_notches = self.notches.iter().filter(|notch| is_off(&&notch.at)).map(mirrored_notch);
        Some(Self {
            turn_points: turn_points.into_iter().filter(is_corner).collect(),
            curve_points: both(&self.curve_points),
            notches: self.notches.iter().copied().chain(other_notches).collect(),
            internal_lines: both_lines(&self.internal_lines),
            cut_outs: both_lines(&self.cut_outs),
            drill_holes: both(&self.drill_holes),
            mirror_line: None,
            outline,
            drawn_perimeter_m: None,
            sew_line,
            ..self.clone()
        })
    }
}

/// 180 for a point that is no vertex.
fn turn_deg(outline: &[V2], point: &V2) -> f64 {
    let n = outline.len();
    match (0..n).find(|&i| (outline[i] - point).norm() < ON_FOLD_M) {
        Some(i) => (outline[i] - outline[(i + n - 1) % n]).angle(&(outline[(i + 1) % n] - outline[i])).to_degrees(),
        None => 180.0,
    }
}

#[cfg(test)]
mod tests {
    use crate::draft::{TshirtSize, tshirt};
    use geom::V2;
    use geom::polyline::signed_area;

    #[test]
    fn half_a_front_opens_into_the_front() {
        let whole = tshirt(TshirtSize::S).pieces.remove(0);
        assert_eq!(whole.unfolded(), None);
        let mut half = whole.clone();
        let on_left = |points: &[V2]| -> Vec<V2> { points.iter().copied().filter(|p| p.x > -1e-9).collect() };
        half.outline = on_left(&whole.outline);
        half.outline.insert(0, V2::zeros());
        half.turn_points = on_left(&whole.turn_points);
        half.turn_points.push(V2::zeros());
        half.notches.retain(|notch| notch.at.x > -1e-9);
        half.mirror_line = Some([V2::zeros(), V2::new(0.0, whole.turn_points[5].y)]);
        let opened = half.unfolded().expect("it is half a piece");
        assert!((opened.area_m2() - whole.area_m2()).abs() < 1e-12);
        assert!((opened.perimeter_m() - whole.perimeter_m()).abs() < 1e-12);
        assert!(signed_area(&opened.outline) > 0.0);
        // The apex of the V stays a corner; the middle of the hem is none.
        assert_eq!(opened.turn_points.len(), whole.turn_points.len());
        assert!(opened.turn_points.contains(&whole.turn_points[5]) && !opened.turn_points.contains(&V2::zeros()));
        assert_eq!(opened.notches.len(), whole.notches.len());
    }

    #[test]
    fn a_fold_line_inside_a_whole_piece_opens_nothing() {
        let mut piece = tshirt(TshirtSize::S).pieces.remove(0);
        piece.mirror_line = Some([V2::zeros(), V2::new(0.0, 0.5)]);
        assert_eq!(piece.unfolded(), None);
    }
}

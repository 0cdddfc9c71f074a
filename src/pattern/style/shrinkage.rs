//! Shrinkage of the cloth between cutting and wearing, as a test of washing states it: percent of the length that is
//! cut, along and across the grain line.

use std::fmt;
use std::ops::RangeInclusive;

use super::{Edge, Style, StylePiece};
use crate::seams::SeamFile;
use geom::V2;

/// A cloth that grows has less than 0.
const ACCEPTED_PCT: RangeInclusive<f64> = -10.0..=30.0;

/// Shares of the cut lengths by which the cloth is shorter when it is worn.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Shrinkage {
    warp: f64,
    weft: f64,
}

impl Shrinkage {
    /// Fails for a shrinkage that no cloth has, with what was found and what is accepted.
    pub fn of(entries: &SeamFile) -> Result<Self, [String; 2]> {
        let share = |key: &str, pct: f64| {
            let [least, most] = [ACCEPTED_PCT.start(), ACCEPTED_PCT.end()];
            let refused = || [format!("{key} = {pct}"), format!("{least} to {most} percent")];
            if ACCEPTED_PCT.contains(&pct) { Ok(0.01 * pct) } else { Err(refused()) }
        };
        Ok(Self {
            warp: share("shrinkage_warp_pct", entries.shrinkage_warp_pct)?,
            weft: share("shrinkage_weft_pct", entries.shrinkage_weft_pct)?,
        })
    }

    pub fn is_none(self) -> bool {
        self == Self::default()
    }

    /// Shrinks about the origin. `grain` is a unit vector along the warp.
    pub(crate) fn worn(self, p: V2, grain: V2) -> V2 {
        self.scaled(p, grain, |share| 1.0 - share)
    }

    /// Place before the cloth shrank.
    pub(crate) fn cut(self, p: V2, grain: V2) -> V2 {
        self.scaled(p, grain, |share| 1.0 / (1.0 - share))
    }

    /// A cloth that keeps its lengths keeps every bit of them.
    fn scaled(self, p: V2, grain: V2, factor: impl Fn(f64) -> f64) -> V2 {
        let weft = V2::new(grain.y, -grain.x);
        let moved = |share: f64, along: V2| along * ((factor(share) - 1.0) * along.dot(&p));
        if self.is_none() { p } else { p + moved(self.warp, grain) + moved(self.weft, weft) }
    }
}

impl fmt::Display for Shrinkage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let pct = |share: f64| (share * 1e4).round() / 100.0;
        write!(f, "{} % along the grain line and {} % across it", pct(self.warp), pct(self.weft))
    }
}

impl Style {
    pub(super) fn shrink(&mut self, shrinkage: Shrinkage) {
        if shrinkage != self.shrinkage {
            *self = self.as_cut();
            self.pieces.iter_mut().for_each(|piece| piece.map(|p, grain| shrinkage.worn(p, grain)));
            self.shrinkage = shrinkage;
        }
    }

    /// Pieces as they are cut, before the cloth shrinks. Lengths of measurements stay those of the worn pieces.
    pub fn as_cut(&self) -> Self {
        let mut style = self.clone();
        if !self.shrinkage.is_none() {
            style.pieces.iter_mut().for_each(|piece| piece.map(|p, grain| self.shrinkage.cut(p, grain)));
            style.shrinkage = Shrinkage::default();
        }
        style
    }
}

impl StylePiece {
    /// Applies a linear map of a point and the grain.
    fn map(&mut self, image: impl Fn(V2, V2) -> V2) {
        let grain = self.grain;
        let arcs: Vec<Vec<usize>> = self.edges.iter().map(vertices_of_corners).collect();
        self.place(|p| image(p, grain));
        for (edge, vertices) in self.edges.iter_mut().zip(arcs) {
            edge.corners = vertices.into_iter().map(|vertex| edge.line.arcs()[vertex]).collect();
        }
    }
}

fn vertices_of_corners(edge: &Edge) -> Vec<usize> {
    let arcs = edge.line.arcs();
    let nearest = |corner: &f64| {
        let away = |vertex: &usize| (arcs[*vertex] - corner).abs();
        (0..arcs.len()).min_by(|a, b| away(a).total_cmp(&away(b))).unwrap_or(0)
    };
    edge.corners.iter().map(nearest).collect()
}

#[cfg(test)]
mod tests {
    use crate::draft::Model;
    use crate::pom::Point;
    use crate::{Style, StyleError};

    fn tee(top: &str) -> Result<Style, StyleError> {
        let seams = [top.as_bytes(), Model::Tshirt.seams()].concat();
        Style::read(&Model::Tshirt.drafts()[1].pieces, &seams, "tee.toml")
    }

    #[test]
    fn a_garment_is_shorter_by_the_warp_and_narrower_by_the_weft() {
        let plain = tee("").expect("a style");
        let check = |warp: f64, weft: f64| {
            let text = format!("shrinkage_warp_pct = {warp}\nshrinkage_weft_pct = {weft}\n");
            let washed = tee(&text).expect("a style");
            let length_m = |style: &Style, of: Point| {
                let points = style.points_of_measure();
                points.iter().find(|found| found.point == of).expect("a point").length_m
            };
            let share = |of: Point| length_m(&washed, of) / length_m(&plain, of);
            assert!((share(Point::HalfChest) - (1.0 - 0.01 * weft)).abs() < 1e-9, "{}", share(Point::HalfChest));
            assert!((share(Point::BackLength) - (1.0 - 0.01 * warp)).abs() < 1e-9, "{}", share(Point::BackLength));
            // Seams close, though their sides run at different angles to the grain.
            washed.mesh(30e-3).expect("a mesh");
            let apart_m = crate::handle::outlines_apart_m(&washed.as_cut(), &plain);
            assert!(apart_m < 1e-12, "{apart_m}");
        };
        check(5.0, 3.0);
        check(0.0, 8.0);
        check(-2.0, 0.0);
        assert_eq!(tee("shrinkage_warp_pct = 0.0\n").expect("a style"), plain, "to the bit");
    }

    #[test]
    fn a_shrinkage_that_no_cloth_has_is_refused() {
        let error = tee("shrinkage_weft_pct = 300\n").expect_err("no cloth").to_string();
        assert!(error.contains("shrinkage_weft_pct = 300") && error.contains("-10 to 30 percent"), "{error}");
    }
}

//! A piece as worn: its named edges, grain and notches.

use crate::garment::Role;
use crate::piece::Notch;
use geom::V2;
use geom::polyline::Polyline;

/// Counter-clockwise as worn.
#[derive(Clone, Debug, PartialEq)]
pub struct Edge {
    /// Unique in the piece. `None` for a part of the outline that the seam file does not name.
    pub name: Option<String>,
    /// As drawn.
    pub line: Polyline,
    /// Arc lengths of the corners inside the edge, m.
    pub corners: Vec<f64>,
}

#[derive(Clone, Debug, PartialEq)]
pub struct StylePiece {
    /// Identifier in the seam file, such as `front`.
    pub id: String,
    pub role: Role,
    /// Counter-clockwise; they form the closed outline.
    pub edges: Vec<Edge>,
    /// Unit vector.
    pub grain: V2,
    /// On the outline as worn.
    pub notches: Vec<Notch>,
    /// Numbered as in the seam file.
    pub corners: Vec<V2>,
}

impl StylePiece {
    /// Closed, counter-clockwise.
    pub fn outline(&self) -> Vec<V2> {
        self.edges
            .iter()
            .flat_map(|edge| edge.line.points().split_last().map_or(&[][..], |(_, rest)| rest))
            .copied()
            .collect()
    }

    /// Rotates about the origin, counter-clockwise.
    pub fn turn(&mut self, angle_rad: f64) {
        let (sin, cos) = angle_rad.sin_cos();
        let turned = |p: V2| V2::new(cos * p.x - sin * p.y, sin * p.x + cos * p.y);
        self.place(turned);
        for notch in &mut self.notches {
            notch.angle_deg = notch.angle_deg.map(|angle| (angle + angle_rad.to_degrees()).rem_euclid(360.0));
        }
        self.grain = turned(self.grain);
    }

    /// In its plane, m.
    pub fn shift(&mut self, by: V2) {
        self.place(|p| p + by);
    }

    pub(super) fn place(&mut self, image: impl Fn(V2) -> V2) {
        for edge in &mut self.edges {
            edge.line = edge.line.mapped(&image);
        }
        self.notches.iter_mut().for_each(|notch| notch.at = image(notch.at));
        self.corners.iter_mut().for_each(|corner| *corner = image(*corner));
    }
}

//! A piece as worn: its named edges, grain and notches.

use crate::garment::Role;
use crate::piece::Notch;
use geom::V2;
use geom::polyline::Polyline;

/// An edge of a piece, counter-clockwise as worn.
#[derive(Clone, Debug, PartialEq)]
pub struct Edge {
    /// Name, unique in the piece. `None` for a part of the outline that the seam file does not name.
    pub name: Option<String>,
    /// Curve as drawn.
    pub line: Polyline,
    /// Arc lengths of the corners inside the edge, m.
    pub corners: Vec<f64>,
}

/// A piece as worn.
#[derive(Clone, Debug, PartialEq)]
pub struct StylePiece {
    /// Identifier in the seam file, such as `front`.
    pub id: String,
    /// Role of the piece.
    pub role: Role,
    /// Edges in counter-clockwise order, which form the closed outline.
    pub edges: Vec<Edge>,
    /// Unit vector of the grain.
    pub grain: V2,
    /// Notches on the outline as worn.
    pub notches: Vec<Notch>,
    /// Corners, numbered as in the seam file.
    pub corners: Vec<V2>,
}

impl StylePiece {
    /// Closed outline, counter-clockwise.
    #[must_use]
    pub fn outline(&self) -> Vec<V2> {
        self.edges
            .iter()
            .flat_map(|edge| edge.line.points().split_last().map_or(&[][..], |(_, rest)| rest))
            .copied()
            .collect()
    }

    /// Rotates the piece about the origin, counter-clockwise, radians.
    pub fn turn(&mut self, angle_rad: f64) {
        let (sin, cos) = angle_rad.sin_cos();
        let turned = |p: V2| V2::new(cos * p.x - sin * p.y, sin * p.x + cos * p.y);
        self.place(turned);
        for notch in &mut self.notches {
            notch.angle_deg = notch.angle_deg.map(|angle| (angle + angle_rad.to_degrees()).rem_euclid(360.0));
        }
        self.grain = turned(self.grain);
    }

    /// Translates the piece in its plane, m.
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

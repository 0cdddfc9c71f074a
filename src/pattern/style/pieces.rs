//! A piece as worn: its edges by name, its grain, its notches.

use crate::garment::Role;
use crate::piece::Notch;
use geom::V2;
use geom::polyline::Polyline;

/// An edge of a piece, counter-clockwise as worn.
#[derive(Clone, Debug, PartialEq)]
pub struct Edge {
    /// Name, unique within the piece; `None` for a stretch of outline that the seam file does not name.
    pub name: Option<String>,
    /// The drawn curve.
    pub line: Polyline,
    /// Arc lengths of the corners passed between its ends.
    pub corners: Vec<f64>,
}

/// A piece as worn.
#[derive(Clone, Debug, PartialEq)]
pub struct StylePiece {
    /// Identifier in the seam file, such as `front`.
    pub id: String,
    /// How it is worn.
    pub role: Role,
    /// Its edges in counter-clockwise order; together they are the closed outline.
    pub edges: Vec<Edge>,
    /// Unit vector of the grain.
    pub grain: V2,
    /// Notches on the outline as worn.
    pub notches: Vec<Notch>,
    /// Corners as worn, by their number in the seam file.
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

    /// Turns it about the origin, counter-clockwise, rad.
    pub fn turn(&mut self, angle_rad: f64) {
        let (sin, cos) = angle_rad.sin_cos();
        let turned = |p: V2| V2::new(cos * p.x - sin * p.y, sin * p.x + cos * p.y);
        self.place(turned);
        for notch in &mut self.notches {
            notch.angle_deg = notch.angle_deg.map(|angle| (angle + angle_rad.to_degrees()).rem_euclid(360.0));
        }
        self.grain = turned(self.grain);
    }

    /// Moves the piece in its plane, m.
    pub fn shift(&mut self, by: V2) {
        self.place(|p| p + by);
    }

    fn place(&mut self, at: impl Fn(V2) -> V2) {
        for edge in &mut self.edges {
            edge.line = edge.line.mapped(&at);
        }
        self.notches.iter_mut().for_each(|notch| notch.at = at(notch.at));
        self.corners.iter_mut().for_each(|corner| *corner = at(*corner));
    }
}

//! Planes that separate the cloth of two limbs where its contact with itself does not. Legs keep to their sides of the
//! median plane, a sleeve and the side of the trunk to their sides of the plane between arm and trunk.

use body::{Body, Layer};
use geom::V3;
use pattern::{Garment, Role};

struct Wall {
    point: V3,
    /// Unit normal.
    normal: V3,
    /// Direction in which a half-plane extends from its point; `None` for a whole plane.
    onwards: Option<V3>,
}

/// Walls, with the side that each sewn vertex keeps to.
pub struct Walls {
    walls: Vec<Wall>,
    /// Wall and side of each vertex: 1 or -1, or 0 for the seam between legs, which stays on the wall. `None` for a
    /// vertex that keeps to no wall.
    keeps: Vec<Option<(usize, f64)>>,
}

impl Walls {
    pub fn new(body: &Body, garment: &Garment, vertex_of: &[usize], x: &[V3]) -> Self {
        let median = Wall { point: V3::zeros(), normal: V3::x(), onwards: None };
        let arms = [0, 1].map(|side| Wall::beside_arm(body, side));
        let walls: Vec<Wall> = std::iter::once(median).chain(arms).collect();
        // Sums over the pieces that meet in a vertex: wall, side, number.
        let mut sums = vec![(0, 0.0, 0.0); x.len()];
        for piece in &garment.pieces {
            for v in piece.vertices.clone() {
                let sewn_v = vertex_of[v];
                if let Some((wall, side)) = side_of(piece.role, &x[sewn_v]) {
                    let sum = &mut sums[sewn_v];
                    *sum = (wall, sum.1 + side, sum.2 + 1.0);
                }
            }
        }
        let keep = |(wall, sum, n): (usize, f64, f64)| {
            let is_clear = n > 0.0 && sum.abs() == n;
            // Only the legs meet on their wall. An armhole may lie above or below the armpit.
            (is_clear || (n > 0.0 && wall == MEDIAN)).then_some((wall, if is_clear { sum.signum() } else { 0.0 }))
        };
        Self { walls, keeps: sums.into_iter().map(keep).collect() }
    }

    /// Walls for the vertices before they are sewn.
    pub fn unsewn(mut self, vertex_of: &[usize]) -> Self {
        self.keeps = vertex_of.iter().map(|&v| self.keeps[v]).collect();
        self
    }

    /// Depth of a vertex on the wrong side, m, and the unit direction of the shortest way back, past the wall's end if
    /// that is nearer; `None` where it is on its side.
    pub fn trespass(&self, vertex: usize, p: &V3) -> Option<(f64, V3)> {
        let (wall, side) = self.keeps[vertex].filter(|(_, side)| *side != 0.0)?;
        let Wall { point, normal, onwards } = &self.walls[wall];
        let from = p - point;
        let through = (-side * from.dot(normal), normal * side);
        let ways = onwards.map(|d| (from.dot(&d), -d)).into_iter().chain([through]);
        ways.min_by(|a, b| a.0.total_cmp(&b.0)).filter(|(depth, _)| *depth > 0.0)
    }

    /// Projection of a vertex to the distance `offset_m` on its side; `None` where it is there already.
    pub fn back(&self, vertex: usize, p: &V3, offset_m: f64) -> Option<V3> {
        let (wall, side) = self.keeps[vertex]?;
        let Wall { point, normal, onwards } = &self.walls[wall];
        let from = p - point;
        let height = from.dot(normal);
        let is_beyond = side == 0.0 || height * side < offset_m;
        (is_beyond && onwards.is_none_or(|d| from.dot(&d) > 0.0)).then(|| p + normal * (side * offset_m - height))
    }
}

const MEDIAN: usize = 0;

fn side_of(role: Role, at: &V3) -> Option<(usize, f64)> {
    match role {
        Role::LegFrontRight | Role::LegBackRight | Role::LegRight => Some((MEDIAN, 1.0)),
        Role::LegFrontLeft | Role::LegBackLeft | Role::LegLeft => Some((MEDIAN, -1.0)),
        Role::SleeveRight => Some((1, 1.0)),
        Role::SleeveLeft => Some((2, 1.0)),
        Role::Waistband | Role::Other => None,
        _ => Some((if at.x > 0.0 { 1 } else { 2 }, -1.0)),
    }
}

impl Wall {
    /// Half-plane from the armpit outwards and down, along the bisector of arm and trunk; its normal points to the arm.
    fn beside_arm(body: &Body, side: usize) -> Self {
        use Layer::*;
        let [armscye, elbow] = [[ArmscyeRight, ElbowRight], [ArmscyeLeft, ElbowLeft]][side];
        let arm = body.control.ring_centre(elbow) - body.control.ring_centre(armscye);
        let onwards = (arm.normalize() - V3::z()).normalize();
        let normal = (arm - onwards * arm.dot(&onwards)).normalize();
        Self { point: body.landmarks.armpit[side], normal, onwards: Some(onwards) }
    }
}

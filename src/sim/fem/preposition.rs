//! Automatic preposition (4.2): key points onto features, pieces offset and bent about the trunk, sleeves onto the arms.

use crate::body::{Body, Joint};
use crate::geom::{V2, V3};
use crate::pattern::{Garment, PieceMesh, Role};
use crate::sim::SimError;

use super::params::Params;

/// Half height of the band of the body in which its depth is read, m.
const LEVEL_BAND_M: f64 = 0.02;
/// Least clearance of a sleeve from the arm before sewing, m.
const SLEEVE_CLEARANCE_M: f64 = 0.012;
/// Most of a full turn that a sleeve is bent over: its underarm seam starts open.
const SLEEVE_TURN: f64 = 0.95;

/// World positions of all garment vertices before sewing, m.
///
/// # Errors
/// [`SimError::CannotPlace`] for a piece that is no front, back or sleeve.
pub fn place(body: &Body, garment: &Garment, params: &Params) -> Result<Vec<V3>, SimError> {
    let mut positions = vec![V3::zeros(); garment.rest.len()];
    for piece in &garment.pieces {
        let frame = PieceFrame::of(piece, garment);
        let place: Box<dyn Fn(V2) -> V3> = match piece.role {
            Role::Front => about_trunk(body, &frame, 1.0, params),
            Role::Back => about_trunk(body, &frame, -1.0, params),
            Role::SleeveRight => about_arm(body, &frame, 1.0),
            Role::SleeveLeft => about_arm(body, &frame, -1.0),
            role => {
                let accepted = "front, back, sleeve_right, sleeve_left";
                return Err(SimError::CannotPlace { piece: piece.id.clone(), role, accepted });
            }
        };
        for v in piece.vertices.clone() {
            positions[v] = place(frame.local(garment.rest[v]));
        }
    }
    Ok(positions)
}

/// A piece in its own upright frame: `u` to the right seen from outside and 0 in the middle, `v` up along the grain.
struct PieceFrame {
    grain: V2,
    middle_u: f64,
    width: f64,
    top_v: f64,
}

impl PieceFrame {
    fn of(piece: &PieceMesh, garment: &Garment) -> Self {
        let weft = V2::new(piece.grain.y, -piece.grain.x);
        let points = || garment.rest[piece.vertices.clone()].iter();
        let (low, high) = points().map(|p| p.dot(&weft)).fold((f64::MAX, f64::MIN), |(l, h), u| (l.min(u), h.max(u)));
        let top_v = points().map(|p| p.dot(&piece.grain)).fold(f64::MIN, f64::max);
        Self { grain: piece.grain, middle_u: 0.5 * (low + high), width: high - low, top_v }
    }

    /// (u, v) of a rest point, `v` measured downwards from the highest point (negative).
    fn local(&self, p: V2) -> V2 {
        let weft = V2::new(self.grain.y, -self.grain.x);
        V2::new(p.dot(&weft) - self.middle_u, p.dot(&self.grain) - self.top_v)
    }
}

/// Front (`side` 1) or back (-1): the highest point meets the side neck points, the piece stands `d` before the trunk's
/// centre and is bent to an arc about the vertical (4.2-4.7).
fn about_trunk(body: &Body, frame: &PieceFrame, side: f64, params: &Params) -> Box<dyn Fn(V2) -> V3> {
    let (back, front) = trunk_depth(body);
    let top = 0.5 * (body.landmarks.side_neck[0].z + body.landmarks.side_neck[1].z);
    let offset = 0.5 * params.offset_mu * (front - back);
    let radius = frame.width / params.bend_angle_rad;
    let centre_y = 0.5 * (front + back);
    Box::new(move |p| {
        let angle = p.x / radius;
        // Seen from outside, u runs to the subject's left on the front and to the right on the back.
        V3::new(-side * radius * angle.sin(), centre_y + side * (offset + radius * (angle.cos() - 1.0)), top + p.y)
    })
}

/// Least and greatest `y` of the trunk at chest level.
fn trunk_depth(body: &Body) -> (f64, f64) {
    let half_width = body.landmarks.side_neck[0].x.abs().max(body.landmarks.bust[0].x.abs());
    let near = body
        .mesh
        .positions
        .iter()
        .filter(|p| (p.z - body.levels.chest_m).abs() < LEVEL_BAND_M && p.x.abs() < half_width + LEVEL_BAND_M);
    near.fold((f64::MAX, f64::MIN), |(low, high), p| (low.min(p.y), high.max(p.y)))
}

/// A sleeve of the right (`side` 1) or left (-1) arm: bent to a cylinder whose axis is the upper arm's bone, cap towards
/// the shoulder (4.2.5).
fn about_arm(body: &Body, frame: &PieceFrame, side: f64) -> Box<dyn Fn(V2) -> V3> {
    let (shoulder, elbow, tip) = if side > 0.0 {
        (body.skeleton.at(Joint::ShoulderRight), body.skeleton.at(Joint::ElbowRight), body.landmarks.shoulder[0])
    } else {
        (body.skeleton.at(Joint::ShoulderLeft), body.skeleton.at(Joint::ElbowLeft), body.landmarks.shoulder[1])
    };
    let axis = (elbow - shoulder).normalize();
    let sideways = V3::new(side, 0.0, 0.0);
    let outward = (sideways - axis * sideways.dot(&axis)).normalize();
    // Seen from outside, u runs to the front on the right sleeve and to the back on the left one.
    let across = V3::new(0.0, side, 0.0);
    let arm = arm_radius(body, &shoulder, &axis) + SLEEVE_CLEARANCE_M;
    let radius = (frame.width / (SLEEVE_TURN * std::f64::consts::TAU)).max(arm);
    let start = (tip - shoulder).dot(&axis);
    Box::new(move |p| {
        let angle = p.x / radius;
        shoulder + axis * (start - p.y) + (outward * angle.cos() + across * angle.sin()) * radius
    })
}

/// Greatest distance of the skin from the bone of the upper arm, well below the armpit, m.
fn arm_radius(body: &Body, shoulder: &V3, axis: &V3) -> f64 {
    let within = 0.15..0.25;
    body.mesh
        .positions
        .iter()
        .filter_map(|p| {
            let along = (p - shoulder).dot(axis);
            let radius = (p - shoulder - axis * along).norm();
            (within.contains(&along) && radius < 0.1).then_some(radius)
        })
        .fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::{self, Measurements, Sex};
    use crate::pattern::Style;
    use crate::pattern::draft::Model;

    #[test]
    fn a_piece_that_cannot_be_placed_is_named() {
        let body = body::build(&Measurements::of(Sex::Male, 1.75)).expect("a body");
        let placed = |model: Model| {
            let style = Style::read(&model.drafts()[0].pieces, model.seams(), "seams").expect("a style");
            place(&body, &style.mesh(0.04).expect("a mesh"), &Params::default())
        };
        assert!(placed(Model::Teetop).is_ok());
        let error = placed(Model::Trousers).expect_err("legs are not placed").to_string();
        assert!(error.contains("leg_back_left") && error.contains("cannot place role"), "{error}");
    }
}

//! Drafting: the men's T-shirt of the thesis, drawn so that its nine measurements are the published ones.
//!
//! The pieces are **net**: layer 1 is the sew line, without allowances. Length decisions, where the nine numbers leave
//! them open:
//! - The neck is a **V**, as [T 6.2.1] says. The numbers agree: a neckline that leaves the apex along its chord and
//!   meets the shoulder at a right angle, with a back neck 22 mm deep, gives half neck widths of 80.0, 80.1 and
//!   80.2 mm for S, M and L, whereas a round neck 176 mm deep would be only about 142 mm wide.
//! - **Sleeve length is the underarm seam.** Its published L3D hardly varies (119.1-119.4 mm over four subjects) as a
//!   hanging seam does, and as a length from the cap top it would leave no room for the cap of a 504 mm armhole.
//! - Sides are straight and vertical, so the girth at the underarm is the hem girth. Front and back share the shoulder
//!   line; the front armhole is scooped deeper and 6 mm longer. The cap has no ease: it is as long as the armhole.

mod curve;

use self::curve::{bezier, bisect, length};
use super::dxf;
use super::piece::{Notch, Piece};
use crate::geom::V2;
use crate::geom::polyline::Polyline;
use crate::units::from_mm;

/// Slope of the shoulder line below the horizontal, degrees.
const SHOULDER_SLOPE_DEG: f64 = 20.0;
/// Depth of the back neck below the side-neck points, m.
const BACK_NECK_DROP_M: f64 = 0.022;
/// Front armhole length minus the mean of front and back, m.
const ARMHOLE_BALANCE_M: f64 = 0.003;
/// Cap height over armhole depth.
const CAP_HEIGHT_SHARE: f64 = 0.56;
/// Spacing of a double notch, m.
const DOUBLE_NOTCH_M: f64 = 0.010;
/// Share of an armhole from the underarm at which it is notched.
const ARMHOLE_NOTCH_SHARE: f64 = 0.35;
/// Depth of the notches, m.
const NOTCH_DEPTH_M: f64 = 0.004;

/// Seam file of the T-shirt, for all sizes.
pub const TSHIRT_SEAMS: &[u8] = include_bytes!("tshirt.seams.toml");

/// Sizes of the T-shirt.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TshirtSize {
    /// Small.
    S,
    /// Medium.
    M,
    /// Large.
    L,
}

impl TshirtSize {
    /// All sizes, smallest first.
    pub const ALL: [Self; 3] = [Self::S, Self::M, Self::L];

    /// Its letter.
    #[must_use]
    pub fn as_str(self) -> &'static str {
        match self {
            Self::S => "S",
            Self::M => "M",
            Self::L => "L",
        }
    }

    /// Published lengths `#1` to `#9`, mm [T tables 6-5, 6-8, 6-11].
    #[must_use]
    pub fn published_mm(self) -> [f64; 9] {
        match self {
            Self::S => [974.10, 356.53, 550.76, 704.96, 503.71, 560.09, 458.95, 156.67, 119.18],
            Self::M => [1034.10, 366.53, 560.76, 719.96, 527.34, 569.46, 463.95, 166.01, 130.68],
            Self::L => [1094.10, 376.53, 570.76, 734.96, 551.55, 578.89, 468.96, 175.44, 142.55],
        }
    }
}

/// Drafted pieces of one size.
#[derive(Clone, Debug, PartialEq)]
pub struct Draft {
    /// Style name.
    pub style: String,
    /// Size name.
    pub size: String,
    /// Pieces, net.
    pub pieces: Vec<Piece>,
}

/// Drafts the men's T-shirt: blocks `FRONT`, `BACK` and `SLEEVE` (the right one; the left is its mirror image).
#[must_use]
pub fn tshirt(size: TshirtSize) -> Draft {
    let lengths = size.published_mm().map(from_mm);
    let body = Body::solve(&lengths);
    let pieces = [body.front(), body.back(), body.sleeve(&lengths)]
        .into_iter()
        .map(|mut piece| {
            piece.size = Some(size.as_str().to_owned());
            let is_corner = |point: &V2| piece.turn_points.contains(point);
            piece.curve_points = piece.outline.iter().copied().filter(|point| !is_corner(point)).collect();
            piece
        })
        .collect();
    Draft { style: "Mens T-shirt".to_owned(), size: size.as_str().to_owned(), pieces }
}

/// The files of the T-shirt, by name: one DXF a size and the seam file of the style.
#[must_use]
pub fn tshirt_files() -> Vec<(String, Vec<u8>)> {
    let drawing = |size: TshirtSize| {
        let name = format!("tshirt-{}.dxf", size.as_str().to_lowercase());
        (name, dxf::write(&tshirt(size)))
    };
    let seams = ("tshirt.seams.toml".to_owned(), TSHIRT_SEAMS.to_vec());
    TshirtSize::ALL.into_iter().map(drawing).chain([seams]).collect()
}

/// Half front and half back, on the `u > 0` side of the centre line, hem at `v = 0`.
struct Body {
    /// Half width at hem and underarm.
    half_width: f64,
    /// Centre front and centre back neck points.
    centre_front: V2,
    centre_back: V2,
    underarm: V2,
    /// Curves, each from the centre outwards or from the shoulder down.
    front_neck: Vec<V2>,
    back_neck: Vec<V2>,
    front_armhole: Vec<V2>,
    back_armhole: Vec<V2>,
}

impl Body {
    fn solve(lengths: &[f64; 9]) -> Self {
        let [hem, _, front_centre, back_centre, armhole, neck, side, shoulder, _] = *lengths;
        let slope = SHOULDER_SLOPE_DEG.to_radians();
        let along_shoulder = V2::new(slope.cos(), -slope.sin());
        // Both necklines and both armholes leave the shoulder line at right angles.
        let down = V2::new(-slope.sin(), -slope.cos());
        let centre_front = V2::new(0.0, front_centre);
        let centre_back = V2::new(0.0, back_centre);
        let side_neck = |width: f64| V2::new(width, back_centre + BACK_NECK_DROP_M);
        let front_neck = |width: f64| {
            let (apex, end) = (centre_front, side_neck(width));
            let chord = end - apex;
            bezier([apex, apex + chord / 3.0, end + down * (0.36 * chord.norm()), end])
        };
        let back_neck = |width: f64| {
            let end = side_neck(width);
            bezier([centre_back, centre_back + V2::x() * (0.55 * width), end + down * (0.72 * BACK_NECK_DROP_M), end])
        };
        let width = bisect(0.02, 0.2, |w| 2.0 * (length(&front_neck(w)) + length(&back_neck(w))) - neck);
        let half_width = hem / 4.0;
        let underarm = V2::new(half_width, side);
        let tip = side_neck(width) + along_shoulder * shoulder;
        let depth = tip.y - side;
        let armhole_curve = |reach: f64, target: f64| {
            let curve = |inset: f64| bezier([tip, tip + down * (reach * depth), underarm - V2::x() * inset, underarm]);
            curve(bisect(0.0, 0.25, |inset| length(&curve(inset)) - target))
        };
        Self {
            half_width,
            centre_front,
            centre_back,
            underarm,
            front_neck: front_neck(width),
            back_neck: back_neck(width),
            front_armhole: armhole_curve(0.5, armhole / 2.0 + ARMHOLE_BALANCE_M),
            back_armhole: armhole_curve(0.6, armhole / 2.0 - ARMHOLE_BALANCE_M),
        }
    }

    /// The whole front: hem, left side, armhole, shoulder, V-neck, and back down the right.
    fn front(&self) -> Piece {
        let notch_arcs = |curve: &[V2]| vec![length(curve) * (1.0 - ARMHOLE_NOTCH_SHARE)];
        let mut piece = self.trunk("FRONT", &self.front_armhole, &self.front_neck, &notch_arcs);
        piece.turn_points.insert(5, self.centre_front);
        piece
    }

    /// The whole back; its neck is one smooth curve.
    fn back(&self) -> Piece {
        let notch_arcs = |curve: &[V2]| {
            let first = length(curve) * (1.0 - ARMHOLE_NOTCH_SHARE);
            vec![first, first - DOUBLE_NOTCH_M]
        };
        let mut piece = self.trunk("BACK", &self.back_armhole, &self.back_neck, &notch_arcs);
        piece.notches.push(notch(self.centre_back, 270.0));
        piece
    }

    fn trunk(&self, block: &str, armhole: &[V2], neck: &[V2], notch_arcs: &dyn Fn(&[V2]) -> Vec<f64>) -> Piece {
        let hem = V2::new(self.half_width, 0.0);
        let (tip, side_neck) = (armhole[0], neck[neck.len() - 1]);
        let mut right_half = vec![hem];
        right_half.extend(armhole.iter().rev());
        right_half.extend(neck.iter().rev());
        // The mirrored half runs back down; the centre neck point belongs to both.
        let left_half = right_half.iter().rev().skip(1).map(|&p| mirrored(p));
        let mut outline = vec![mirrored(hem)];
        outline.extend(right_half.iter().copied().chain(left_half));
        outline.pop();
        let corners = [hem, self.underarm, tip, side_neck];
        let turn_points =
            [mirrored(hem)].into_iter().chain(corners).chain(corners[1..].iter().rev().map(|&p| mirrored(p)));
        let mut piece = Piece {
            turn_points: turn_points.collect(),
            curve_points: Vec::new(),
            notches: notches_along(armhole, notch_arcs(armhole)),
            grain: Some([V2::new(0.0, 0.08), V2::new(0.0, 0.40)]),
            ..net(block, "1", outline)
        };
        let other_side: Vec<Notch> = piece.notches.iter().map(|n| mirrored_notch(*n)).collect();
        piece.notches.extend(other_side);
        piece.notches.push(notch(V2::zeros(), 90.0));
        piece
    }

    /// The right sleeve: front half of the cap on `+u`, as long as the front armhole; back half likewise.
    fn sleeve(&self, lengths: &[f64; 9]) -> Piece {
        let (opening, underarm_seam) = (lengths[1], lengths[8]);
        let depth = self.front_armhole[0].y - self.underarm.y;
        let height = CAP_HEIGHT_SHARE * depth;
        let front = cap(height, length(&self.front_armhole));
        let back: Vec<V2> = cap(height, length(&self.back_armhole)).into_iter().map(mirrored).collect();
        let (front_width, back_width) = (front[0].x, -back[0].x);
        let taper = (front_width + back_width - opening) / 2.0;
        let drop = (underarm_seam.powi(2) - taper.powi(2)).sqrt();
        let opening_front = V2::new(front_width - taper, -drop);
        let opening_back = V2::new(taper - back_width, -drop);
        let mut outline = vec![opening_back, opening_front];
        outline.extend(&front);
        outline.extend(back.iter().rev().skip(1));
        let top = V2::new(0.0, height);
        let front_notch = length(&front) * ARMHOLE_NOTCH_SHARE;
        let back_notch = length(&back) * ARMHOLE_NOTCH_SHARE;
        let mut notches = notches_along(&front, vec![front_notch]);
        notches.extend(notches_along(&back, vec![back_notch, back_notch + DOUBLE_NOTCH_M]));
        notches.push(notch(top, 270.0));
        Piece {
            turn_points: vec![opening_back, opening_front, front[0], top, back[0]],
            notches,
            grain: Some([V2::new(0.0, -0.6 * drop), V2::new(0.0, 0.7 * height)]),
            ..net("SLEEVE", "2", outline)
        }
    }
}

/// Half a sleeve cap of a given height and length, from the underarm point on `+u` to the top.
fn cap(height: f64, target: f64) -> Vec<V2> {
    let curve = |width: f64| {
        bezier([
            V2::new(width, 0.0),
            V2::new(0.62 * width, 0.06 * height),
            V2::new(0.45 * width, height),
            V2::new(0.0, height),
        ])
    };
    curve(bisect(0.0, target, |width| length(&curve(width)) - target))
}

/// A net piece with an outline only.
fn net(block: &str, quantity: &str, outline: Vec<V2>) -> Piece {
    Piece {
        block: block.to_owned(),
        name: block.to_owned(),
        size: None,
        quantity: Some(quantity.to_owned()),
        texts: vec![
            ("Material".to_owned(), "JERSEY".to_owned()),
            ("Annotation".to_owned(), "NET, NO SEAM ALLOWANCE".to_owned()),
        ],
        outline,
        is_clockwise_in_file: false,
        turn_points: Vec::new(),
        curve_points: Vec::new(),
        notches: Vec::new(),
        grain: None,
        mirror_line: None,
        internal_lines: Vec::new(),
        sew_line: None,
    }
}

fn notch(at: V2, angle_deg: f64) -> Notch {
    Notch { at, depth_m: Some(NOTCH_DEPTH_M), angle_deg: Some(angle_deg) }
}

/// Notches at arc lengths along a curve whose inside lies to its left or right, cut at right angles towards `u = 0`.
fn notches_along(curve: &[V2], arcs: Vec<f64>) -> Vec<Notch> {
    let Some(line) = Polyline::new(curve.to_vec()) else { return Vec::new() };
    let step = 1e-3;
    arcs.into_iter()
        .map(|arc| {
            let along = line.at(arc + step) - line.at(arc - step);
            let mut inwards = V2::new(-along.y, along.x);
            if inwards.x * line.at(arc).x > 0.0 {
                inwards = -inwards;
            }
            notch(line.at(arc), inwards.y.atan2(inwards.x).to_degrees().rem_euclid(360.0))
        })
        .collect()
}

fn mirrored(point: V2) -> V2 {
    V2::new(-point.x, point.y)
}

fn mirrored_notch(original: Notch) -> Notch {
    Notch {
        at: mirrored(original.at),
        angle_deg: original.angle_deg.map(|angle| (180.0 - angle).rem_euclid(360.0)),
        ..original
    }
}

#[cfg(test)]
mod tests;

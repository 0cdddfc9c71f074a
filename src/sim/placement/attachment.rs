//! Pieces placed by those that they are sewn to: waistbands, cuffs, collars, hoods, pockets.
//!
//! The places of their partners are unrolled about the limb. The least-squares similarity that takes the piece's seam
//! to them gives the piece its rotation, its place and its bend. A godet, both sides of which are sewn into one slit,
//! is folded outwards there.

use std::f64::consts::{PI, TAU};

use super::body_parts::{Cylindrical, Form};
use super::layout::Joins;
use super::limb::Limb;
use geom::{V2, V3};

geom::constants! {
    "placement.follow",
    /// Least distance from the skin.
    const CLEARANCE_M: f64 = 0.012;
    /// Share of the room round a limb that a piece may take.
    const ROUND: f64 = 0.97;
    /// Sideways scale from a piece's seams to its partners', over the upward scale, below which they are the sides of a
    /// slit.
    const SLIT: f64 = 0.4;
    /// Least mean square of the height of such seams over that of their breadth; the second where the slit is taller
    /// than broad.
    const UPRIGHT: [f64; 2] = [0.1, 0.01];
    /// Squared residual of the similarity of a piece's mirrored seams to its partners, over that of the seams as they
    /// are, below which the piece is their other half.
    const OTHER_HALF: f64 = 0.5;
    /// Least share of its width that a piece in a slit takes sideways.
    const OPEN: f64 = 0.2;
    /// Least and greatest scale of a similarity: no seam is gathered more.
    const SCALE: [f64; 2] = [0.3, 4.0];
}

pub struct Follower {
    pub piece: usize,
    /// Its vertices with those of placed pieces that they are sewn to.
    pub pairs: Vec<[usize; 2]>,
    pub limb: Limb,
}

impl Follower {
    /// Circular mean of the angles of the partners, which are at `placed`, rad.
    fn angle(&self, placed: &[V3]) -> f64 {
        let angles = self.pairs.iter().map(|pair| self.limb.coordinates(&placed[pair[1]]).angle);
        let (sin, cos) = angles.fold((0.0, 0.0), |(sin, cos), angle: f64| (sin + angle.sin(), cos + angle.cos()));
        sin.atan2(cos)
    }

    /// Angle that the piece may take to either side: half a turn, or half the angle to the nearest of the pieces beside
    /// it.
    pub fn room_rad(&self, beside: &[Self], placed: &[V3]) -> f64 {
        let others = beside.iter().filter(|other| other.piece != self.piece && other.limb == self.limb);
        let apart = |other: &Self| {
            let turn = (other.angle(placed) - self.angle(placed)).rem_euclid(TAU);
            0.5 * turn.min(TAU - turn)
        };
        others.map(apart).fold(PI, f64::min)
    }
}

/// Places of the vertices of a piece whose partners are at `placed`; it goes no farther round than there is room.
pub fn place(form: &Form, joins: &Joins, follower: &Follower, room_rad: f64, placed: &[V3]) -> Vec<V3> {
    let rest = &joins.garment.rest;
    let Follower { piece, pairs, limb } = follower;
    let own: Vec<V2> = pairs.iter().map(|pair| rest[pair[0]]).collect();
    let partners: Vec<_> = pairs.iter().map(|pair| limb.coordinates(&placed[pair[1]])).collect();
    let radius = partners.iter().map(|p| p.radius).sum::<f64>() / partners.len() as f64;
    let angles = unwrapped(&own, &partners.iter().map(|p| p.angle).collect::<Vec<_>>());
    let goal: Vec<V2> = angles.iter().zip(&partners).map(|(angle, p)| V2::new(angle * radius, p.height)).collect();
    let fit = Similarity::of(&own, &goal);
    let vertices = joins.garment.pieces[*piece].vertices.clone();
    let places: Vec<V2> = vertices.map(|v| fit.turned(rest[v])).collect();
    let sides = Sides::new(&fit, &own, &goal, partners.iter().map(|p| p.radius));
    if sides.are_a_slit {
        return places.iter().map(|p| sides.fold(p, &fit.to, radius, limb)).collect();
    }
    let heights = places.iter().map(|p| fit.to.y + p.y);
    let (low, high) = heights.fold((f64::MAX, f64::MIN), |(low, high), h| (low.min(h), high.max(h)));
    // Bent to the angle that its partners take, but outside the body.
    let bent = (radius / fit.scale).min(radius).max(body_radius(form, limb, low, high) + CLEARANCE_M);
    let span = places.iter().fold(0.0, |most: f64, p| most.max(p.x.abs())) * fit.scale / radius;
    let per_m = fit.scale / radius * (ROUND * room_rad / span).min(1.0);
    places.iter().map(|p| limb.point(fit.to.x / radius + p.x * per_m, bent, fit.to.y + p.y)).collect()
}

/// True for a godet: a piece that is sewn to one other only, with both its sides into a slit in that.
pub fn is_in_a_slit(joins: &Joins, piece: usize) -> bool {
    let rest = &joins.garment.rest;
    let others: Vec<usize> = (0..joins.garment.pieces.len()).filter(|&other| other != piece).collect();
    let pairs = joins.to_any(piece, &others);
    let Some(partner) = pairs.first().map(|pair| joins.piece_of[pair[1]]) else { return false };
    let own: Vec<V2> = pairs.iter().map(|pair| rest[pair[0]]).collect();
    let goal: Vec<V2> = pairs.iter().map(|pair| rest[pair[1]]).collect();
    let fit = Similarity::of(&own, &goal);
    let sides = Sides::new(&fit, &own, &goal, std::iter::repeat(0.0));
    let is_only_partner = pairs.iter().all(|pair| joins.piece_of[pair[1]] == partner);
    is_only_partner && sides.are_a_slit && !is_other_half(&own, &goal)
}

/// True if places fit their partners much better as a mirror image, as for front and back of a skirt. Along the two
/// sides of a slit they fit about as well without mirroring.
fn is_other_half(own: &[V2], goal: &[V2]) -> bool {
    let error = |own: &[V2]| {
        let fit = Similarity::of(own, goal);
        let miss = |(p, q): (&V2, &V2)| (fit.to + fit.turned(*p) * fit.scale - q).norm_squared();
        own.iter().zip(goal).map(miss).sum::<f64>()
    };
    let mirrored: Vec<V2> = own.iter().map(|p| V2::new(-p.x, p.y)).collect();
    error(&mirrored) < OTHER_HALF * error(own)
}

struct Sides {
    /// Place sideways and up from the middle, and the partner's distance from the axis, m.
    points: Vec<(V2, f64)>,
    /// Sideways scale from the points to their partners.
    squeezed: f64,
    are_a_slit: bool,
}

impl Sides {
    fn new(fit: &Similarity, own: &[V2], goals: &[V2], from_axis: impl Iterator<Item = f64>) -> Self {
        let own: Vec<V2> = own.iter().map(|p| fit.turned(*p)).collect();
        let (mut size, mut partners, mut slit) = (V2::zeros(), V2::zeros(), V2::zeros());
        for (p, goal) in own.iter().zip(goals.iter().map(|goal| goal - fit.to)) {
            size += p.component_mul(p);
            partners += p.component_mul(&goal);
            slit += goal.component_mul(&goal);
        }
        let scale = partners.component_div(&size.map(|s| s.max(f64::MIN_POSITIVE)));
        let upright = UPRIGHT[usize::from(slit.y > slit.x)];
        let are_a_slit = size.y > upright * size.x && scale.x < SLIT * scale.y;
        Self { points: own.into_iter().zip(from_axis).collect(), squeezed: scale.x, are_a_slit }
    }

    /// Folds a piece outwards from the slit at `middle`, like a tent.
    fn fold(&self, p: &V2, middle: &V2, radius: f64, limb: &Limb) -> V3 {
        let [half_width, from_axis] = self.beside(p).unwrap_or([p.x.abs(), radius]);
        let open = self.squeezed.max(OPEN);
        let outwards = (half_width - p.x.abs()).max(0.0) * (1.0 - open * open).sqrt();
        limb.point((middle.x + p.x * open) / radius, from_axis + CLEARANCE_M + outwards, middle.y + p.y)
    }

    /// Distance from the middle of the nearer side at a point's height, and the partner's distance from the axis, m.
    fn beside(&self, p: &V2) -> Option<[f64; 2]> {
        let own_side = || self.points.iter().filter(|(side, _)| side.x * p.x >= 0.0);
        let from = |y: f64| move |a: &&(V2, f64), b: &&(V2, f64)| (a.0.y - y).abs().total_cmp(&(b.0.y - y).abs());
        let below = own_side().filter(|(side, _)| side.y <= p.y).min_by(from(p.y));
        let above = own_side().filter(|(side, _)| side.y > p.y).min_by(from(p.y));
        let (low, high) = (below.or(above)?, above.or(below)?);
        let share = ((p.y - low.0.y) / (high.0.y - low.0.y).max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        let between = |low: f64, high: f64| low + (high - low) * share;
        Some([between(low.0.x.abs(), high.0.x.abs()), between(low.1, high.1)])
    }
}

/// Unwraps angles along the principal axis of the piece: neighbours differ by at most half a turn.
fn unwrapped(own: &[V2], angles: &[f64]) -> Vec<f64> {
    let mean = own.iter().sum::<V2>() / own.len() as f64;
    let spread = own.iter().map(|p| (p - mean) * (p - mean).transpose()).sum::<nalgebra::Matrix2<f64>>();
    let eigen = spread.symmetric_eigen();
    let long = eigen.eigenvectors.column(eigen.eigenvalues.imax()).into_owned();
    let mut order: Vec<usize> = (0..own.len()).collect();
    order.sort_by(|&a, &b| own[a].dot(&long).total_cmp(&own[b].dot(&long)));
    let mut result = angles.to_vec();
    for pair in order.windows(2) {
        let turns = ((result[pair[0]] - angles[pair[1]]) / TAU).round();
        result[pair[1]] = angles[pair[1]] + turns * TAU;
    }
    result
}

/// Rotation about a centre, and the scale that goes with it.
pub struct Similarity {
    from: V2,
    to: V2,
    rotation: nalgebra::Rotation2<f64>,
    scale: f64,
}

impl Similarity {
    /// Least-squares similarity that takes `own` to `goal`, without mirroring.
    pub fn of(own: &[V2], goal: &[V2]) -> Self {
        let mean = |points: &[V2]| points.iter().sum::<V2>() / points.len() as f64;
        let (from, to) = (mean(own), mean(goal));
        let (mut dot, mut perp, mut size) = (0.0, 0.0, 0.0);
        for (p, q) in own.iter().zip(goal) {
            let (p, q) = (p - from, q - to);
            dot += p.dot(&q);
            perp += p.perp(&q);
            size += p.norm_squared();
        }
        let scale = if size > 0.0 { dot.hypot(perp) / size } else { 1.0 };
        Self { from, to, rotation: nalgebra::Rotation2::new(perp.atan2(dot)), scale: scale.clamp(SCALE[0], SCALE[1]) }
    }

    /// Leaves out the scale.
    pub fn motion(&self) -> nalgebra::Isometry2<f64> {
        nalgebra::Isometry2::new(self.to - self.rotation * self.from, self.rotation.angle())
    }

    /// Turns a point about the centre, without scale, and returns it relative to the centre.
    fn turned(&self, p: V2) -> V2 {
        self.rotation * (p - self.from)
    }
}

pub fn body_radius(form: &Form, limb: &Limb, low: f64, high: f64) -> f64 {
    // Only an arm's axis slopes.
    let skin = if limb.axis.up == V3::z() { &form.trunk } else { &form.arms };
    let own_side = |p: &&V3| limb.axis.origin.x == 0.0 || p.x * limb.axis.origin.x > 0.0;
    let near = skin.iter().filter(own_side).filter_map(|p| {
        let Cylindrical { radius, height, .. } = limb.coordinates(p);
        (low..=high).contains(&height).then_some(radius)
    });
    near.fold(0.0, f64::max)
}

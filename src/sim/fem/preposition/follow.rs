//! Pieces that follow what they are sewn to: waistbands, cuffs, collars, hoods, pockets.
//!
//! The places of their partners are unrolled about the limb; the similarity that takes the piece's seam nearest to
//! them says how the piece is turned, where it lies and how wide it is bent.

use std::f64::consts::{PI, TAU};

use super::form::Form;
use super::limb::Limb;
use super::sheet::Joins;
use crate::geom::{V2, V3};

/// Least distance from the skin, m.
const CLEARANCE_M: f64 = 0.012;

/// Places of the vertices of `piece`, which `pairs` join (own vertex first) to vertices at `placed`.
pub fn place(form: &Form, joins: &Joins, piece: usize, pairs: &[[usize; 2]], placed: &[V3], limb: &Limb) -> Vec<V3> {
    let rest = &joins.garment.rest;
    let own: Vec<V2> = pairs.iter().map(|pair| rest[pair[0]]).collect();
    let partners: Vec<_> = pairs.iter().map(|pair| limb.coordinates(&placed[pair[1]])).collect();
    let radius = partners.iter().map(|p| p.1).sum::<f64>() / partners.len() as f64;
    let angles = unwrapped(&own, &partners.iter().map(|p| p.0).collect::<Vec<_>>());
    let goal: Vec<V2> = angles.iter().zip(&partners).map(|(angle, p)| V2::new(angle * radius, p.2)).collect();
    let fit = Similarity::of(&own, &goal);
    let vertices = joins.garment.pieces[piece].vertices.clone();
    let places: Vec<V2> = vertices.map(|v| fit.turned(rest[v])).collect();
    let heights = places.iter().map(|p| fit.to.y + p.y);
    let (low, high) = heights.fold((f64::MAX, f64::MIN), |(low, high), h| (low.min(h), high.max(h)));
    // Bent to the angle its partners take up; no nearer to the axis than the body lets it.
    let bent = (radius / fit.scale).min(radius).max(body_radius(form, limb, low, high) + CLEARANCE_M);
    let span = places.iter().fold(0.0, |most: f64, p| most.max(p.x.abs())) * fit.scale / radius;
    let per_m = fit.scale / radius * (0.97 * PI / span.max(0.97 * PI)).min(1.0);
    places.iter().map(|p| limb.point(fit.to.x / radius + p.x * per_m, bent, fit.to.y + p.y)).collect()
}

/// Angles made continuous along the piece: neighbours on its longer side differ by less than half a turn.
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

/// Least and greatest scale of a fit: a seam is not gathered more.
const SCALE: [f64; 2] = [0.3, 4.0];

/// A rotation about a centre, and the scale that goes with it.
pub struct Similarity {
    from: V2,
    to: V2,
    rotation: nalgebra::Rotation2<f64>,
    scale: f64,
}

impl Similarity {
    /// The least-squares similarity that takes `own` to `goal`, without mirroring.
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

    /// The same without the scale.
    pub fn motion(&self) -> nalgebra::Isometry2<f64> {
        nalgebra::Isometry2::new(self.to - self.rotation * self.from, self.rotation.angle())
    }

    /// A point turned about the centre, not scaled, relative to it.
    fn turned(&self, p: V2) -> V2 {
        self.rotation * (p - self.from)
    }
}

/// Greatest distance of the limb's skin from its middle between two heights.
fn body_radius(form: &Form, limb: &Limb, low: f64, high: f64) -> f64 {
    // An arm's axis slopes, the others are upright.
    let skin = if limb.axis.up == V3::z() { &form.trunk } else { &form.arms };
    let own_side = |p: &&V3| limb.axis.origin.x == 0.0 || p.x * limb.axis.origin.x > 0.0;
    let near = skin.iter().filter(own_side).filter_map(|p| {
        let (_, radius, height) = limb.coordinates(p);
        (low..=high).contains(&height).then_some(radius)
    });
    near.fold(0.0, f64::max)
}

//! Contact of the cloth with itself (self-contact): vertices are kept a thickness away from triangles, and edges from
//! edges.
//!
//! The potential of a pair is a function of the distance of its two primitives. That distance is continuous where a
//! closest point passes over a rim [Li 2020], so the energy has no jumps at which a line search would stop. The force
//! rises steeply as two layers approach (`barrier`), so that tension does not draw one through the other. No step may
//! take them through: where a pair would meet on the path from the last step (`ccd`), the energy is infinite.
//!
//! All pairs without a common vertex are watched, except those within flat cloth (`normal_cones`). So cloth that does
//! not cross itself hardly ever comes to do so: only layers pressed to within a micrometre may pass. Pairs are searched
//! up to a distance, which is greater where clusters of cloth approach each other faster. Steps go no farther than
//! unknown pairs need to meet. A common motion of many vertices brings no pair nearer (`normal_cones`).
//!
//! Cloth that crosses itself when it is first seen passes through itself there, while the line of intersection is drawn
//! out of it (`untangle`). Layers rub on each other (`rub`).

use std::borrow::Cow;

use super::barrier::{Push, push};
use super::broad_phase::{BroadPhase, Pair, Within};
use super::ccd;
use super::distance::{ClosestPoints, Primitives, cross_squared};
use super::intersections::{Intersection, intersections};
use super::normal_cones::{Motion, longest_m};
use super::rub::{Pressed, Rub};
use super::untangle::Untangling;
use crate::cloth::part::Part;
use geom::V3;
use linalg::Contact4;

#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct ClothContactParams {
    /// Distance below which layers repel each other.
    pub thickness_m: f64,
    pub stiffness_n_m3: f64,
    /// Distance up to which pairs are searched: twice the displacement of a vertex in a step.
    pub reach_m: f64,
    /// Force that draws a crossing out. It grows where it does not suffice.
    pub release_n: f64,
    pub release_steps: u32,
}

impl Default for ClothContactParams {
    fn default() -> Self {
        Self { thickness_m: 2e-3, stiffness_n_m3: 1e6, reach_m: 0.02, release_n: 0.02, release_steps: 400 }
    }
}

geom::constants! {
    "contact.cloth",
    /// Squared sine of the angle between two edges below which their contact fades out. Parallel edges have no unique
    /// direction of contact.
    const MOLLIFIED_BELOW: f64 = 0.01;
    /// Steps as long as the last one for which known pairs must suffice: at least, and when they are searched.
    const STEPS_AHEAD: [f64; 2] = [1.5, 3.0];
    /// Least margin of the approach of a pair before it is searched again, and the margin when it is searched.
    const SLACK_M: [f64; 2] = [1e-3, 4e-3];
    /// Limit of the search distance over the size of the triangles. A vertex of a finer mesh then has no more pairs.
    /// Within twice that distance it would have four times as many.
    const REACH_SIZES: f64 = 0.7;
    /// Least value of that limit. In a step two vertices approach each other by at most half of it.
    const LEAST_REACH_M: f64 = 8e-3;
    /// Share of the distance to unknown pairs that a step may take. The rest is for its second-order correction.
    const FREE_SHARE: f64 = 0.9;
    /// Number of intervals of distance by which pairs are sorted.
    const SHELLS: f64 = 64.0;
    /// Rounds in which vertices that would collide go a part of their path. Later they stay where they are.
    const SHARED_STOPS: usize = 6;
    const MOST_STOPS: usize = 60;
    const APART_ROUNDS: usize = 6;
    /// Greatest increase of the distance of a pair that is moved apart, as a share of the thickness.
    const GROWN_SHARE: f64 = 0.25;
    /// Distance below which primitives that are moved without regard to energy come no nearer.
    const NEAREST_M: f64 = 1e-4;
    /// Greatest thickness of a contact over the size of the triangles. In flat cloth no primitive then repels its
    /// neighbours.
    const THICKNESS_SIZES: f64 = 0.5;
}

struct Press {
    primitives: Primitives,
    vertices: [usize; 4],
    weights: [f64; 4],
    /// Unit vector from the second primitive to the first.
    normal: V3,
    push: Push,
    /// Thickness less distance.
    depth_m: f64,
    /// Penalty stiffness per area times the smallest rest area among the vertices.
    stiffness_n_m: f64,
    /// Mollifier [Li 2020] `e/e0 (2 - e/e0)` of two nearly parallel edges, else 1. `e` is the squared norm of their
    /// cross product, and `e0` its threshold.
    mollifier: f64,
    /// By the first edge and by the second, 1/m.
    mollifier_gradient: Option<[V3; 2]>,
}

impl Press {
    fn pressed(self) -> Pressed {
        let Self { primitives, weights, normal, push, stiffness_n_m, mollifier, .. } = self;
        let force_n = mollifier * stiffness_n_m * push.force;
        Pressed { primitives, weights, normal, force_n, stiffness_n_m: mollifier * stiffness_n_m }
    }
}

pub struct ClothContact<'a> {
    params: ClothContactParams,
    /// `None` in a part of the cloth.
    broad_phase: Option<BroadPhase<'a>>,
    areas: Cow<'a, [f64]>,
    /// Sorted by intervals of their distance when they were found.
    pairs: Vec<Pair>,
    found_at: Vec<V3>,
    last: Vec<V3>,
    /// Motion between `found_at` and `last`.
    made: Option<Motion>,
    /// Greatest approach from the last step before unknown pairs could meet.
    room_m: f64,
    untangling: Untangling,
    /// `None` while friction is off.
    rub: Option<Rub>,
}

impl<'a> ClothContact<'a> {
    /// `areas` are the rest areas of the vertices, m2.
    pub fn new(params: ClothContactParams, triangles: &'a [[usize; 3]], areas: impl Into<Cow<'a, [f64]>>) -> Self {
        let areas = areas.into();
        let size = (areas.iter().sum::<f64>() / areas.len().max(1) as f64).sqrt();
        let reach_m = params.reach_m.min((REACH_SIZES * size).max(LEAST_REACH_M));
        Self {
            params: ClothContactParams { reach_m, ..params },
            broad_phase: Some(BroadPhase::new(triangles, areas.len())),
            areas,
            pairs: Vec::new(),
            found_at: Vec::new(),
            last: Vec::new(),
            made: None,
            room_m: 0.0,
            untangling: Untangling::new(params.release_n, params.release_steps),
            rub: None,
        }
    }

    pub fn set_friction(&mut self, coefficients: impl Iterator<Item = f64>) {
        self.rub = Some(Rub::new(coefficients.collect()));
    }

    pub fn hold_fast(&mut self) {
        self.rub.iter_mut().for_each(Rub::hold_fast);
    }

    pub fn drag_anchors(&mut self, x: &[V3]) {
        self.rub.iter_mut().for_each(|rub| rub.end(x));
    }

    pub fn take_anchors(&mut self, part: &Part, contact: &ClothContact) {
        if let (Some(rub), Some(of_part)) = (&mut self.rub, &contact.rub) {
            rub.take(of_part, |primitives| primitives.renamed(|vertices| Some(vertices.map(|v| part.vertices[v]))));
        }
    }

    /// Treats each `sewn` pair as one vertex, and leaves crossings alone: for cloth that is being sewn.
    pub fn but_near(mut self, sewn: impl Iterator<Item = [usize; 2]>) -> Self {
        if let Some(broad_phase) = &mut self.broad_phase {
            broad_phase.join(sewn);
        }
        self.untangling.leave();
        self
    }

    /// True if nothing crosses, or has come free of a crossing recently.
    pub fn is_untangled(&self) -> bool {
        self.untangling.is_empty() && !self.untangling.is_fresh()
    }

    /// Gives contacts that are still growing their full thickness. Returns `true` if there were any: the cloth was not
    /// at rest.
    pub fn ripen(&mut self) -> bool {
        self.untangling.ripen()
    }

    pub fn partners<'s>(&'s self, free: &'s [bool]) -> impl Iterator<Item = usize> + 's {
        let vertices = self.pairs.iter().map(|pair| pair.primitives.vertices());
        vertices.filter(|vertices| vertices.iter().any(|&v| free[v])).flatten()
    }

    /// Contact of a part of the cloth with itself and with the rest. It knows the near pairs found already, and
    /// searches no others.
    pub fn part<'p>(&self, part: &Part, x: &[V3]) -> ClothContact<'p> {
        let renamed =
            |pair: &Pair| Some(Pair { primitives: pair.primitives.renamed(|vertices| part.names(vertices))?, ..*pair });
        ClothContact {
            params: self.params,
            broad_phase: None,
            areas: Cow::Owned(part.of(&self.areas)),
            pairs: self.pairs.iter().filter_map(renamed).collect(),
            found_at: part.of(&self.found_at),
            last: x.to_vec(),
            made: None,
            room_m: self.room_m,
            untangling: Untangling::new(0.0, 0),
            rub: self.rub.as_ref().map(|rub| rub.part(part)),
        }
    }

    /// Updates the contact after a step. Searches near pairs again where the cloth has moved so far, or folded so
    /// sharply, that the next step could miss one. Finds the way out of crossings, and begins a step of friction.
    pub fn update(&mut self, x: &[V3]) {
        self.look(x);
        if let Some(mut rub) = self.rub.take() {
            rub.begin(x, self.presses(x).map(Press::pressed));
            self.rub = Some(rub);
        }
    }

    fn look(&mut self, x: &[V3]) {
        self.untangling.grow();
        let Some(mut broad_phase) = self.broad_phase.take() else {
            self.room_m -= 2.0 * farthest(x, &self.last);
            self.last = x.to_vec();
            return;
        };
        let made = (self.found_at.len() == x.len()).then(|| broad_phase.motion(&differences(x, &self.found_at)));
        let mut may_cross = self.may_cross(&broad_phase, x, made.as_ref());
        let last = std::mem::replace(&mut self.last, x.to_vec());
        let step = (last.len() == x.len()).then(|| broad_phase.motion(&differences(x, &last)));
        let stays_flat = broad_phase.stay_flat(x);
        let lasts = match (&made, &step) {
            (Some(made), Some(step)) => self.lasts(&broad_phase, made, step),
            _ => false,
        };
        self.made = made;
        if !stays_flat || !lasts {
            self.seek(&mut broad_phase, x, step.as_ref());
        }
        may_cross |= !stays_flat;
        if may_cross {
            // Primitives that are being sewn together do not count as crossing. Otherwise everything around them could
            // pass.
            let are_apart = |crossing: &Intersection| broad_phase.are_apart(&crossing.edge, &crossing.triangle);
            let mut found = intersections(x, broad_phase.edges(), broad_phase.triangles());
            found.retain(are_apart);
            self.untangling.see(x, broad_phase.triangles(), &found);
        }
        self.broad_phase = Some(broad_phase);
    }

    /// True if the known pairs suffice for more steps like the last, where the cloth has `made` a motion since they
    /// were found. Updates the room that is left.
    fn lasts(&mut self, broad_phase: &BroadPhase, made: &Motion, step: &Motion) -> bool {
        self.room_m = broad_phase.room_m([(made, 1.0)]);
        broad_phase.room_m([(made, 1.0), (step, STEPS_AHEAD[0])]) >= self.params.thickness_m
    }

    /// True if the cloth crossed itself before, touched at the last step, or was moved farther than known pairs reach.
    /// Pairs that are near and do not touch cannot have passed.
    fn may_cross(&self, broad_phase: &BroadPhase, x: &[V3], made: Option<&Motion>) -> bool {
        let is_known = |made| 2.0 * farthest(x, &self.last) < self.room_m || broad_phase.room_m([(made, 1.0)]) > 0.0;
        !made.is_some_and(is_known) || !self.untangling.is_empty() || self.touches()
    }

    /// True if primitives touched at the last [`ClothContact::update`], and so may pass each other in the next step.
    pub fn touches(&self) -> bool {
        let touches = |primitives| ClosestPoints::of(&self.last, primitives).gap.norm() < ccd::TOUCHING_M;
        self.near([&self.last], ccd::TOUCHING_M).any(touches)
    }

    /// Greatest displacement of each vertex in any direction from the last [`ClothContact::update`]. Beyond it, near
    /// pairs could be unknown.
    pub fn free_path_m(&self) -> f64 {
        0.5 * FREE_SHARE * self.room_m
    }

    /// Share of these displacements that the vertices may go for the same reason. A common motion of many vertices does
    /// not count.
    pub fn free_share(&self, displacements: &[V3]) -> f64 {
        let share = self.free_path_m() / longest_m(displacements);
        match (&self.broad_phase, &self.made) {
            (Some(broad_phase), Some(made)) if share < 1.0 => {
                FREE_SHARE * broad_phase.free_share(made, &broad_phase.motion(displacements))
            }
            _ => share,
        }
    }

    fn is_known(&self, x: &[V3]) -> bool {
        2.0 * farthest(x, &self.last) < self.room_m
            || self.broad_phase.as_ref().is_some_and(|broad_phase| {
                let made = broad_phase.motion(&differences(x, &self.found_at));
                broad_phase.room_m([(&made, 1.0)]) > 0.0
            })
    }

    fn seek(&mut self, broad_phase: &mut BroadPhase, x: &[V3], step: Option<&Motion>) {
        let ClothContactParams { thickness_m, reach_m: most_m, .. } = self.params;
        let [least_steps, steps] = STEPS_AHEAD;
        let horizon_m = step.map_or(2.0 * most_m, |step| (2.0 * steps * step.farthest_m).max(most_m));
        let within = |clusters| {
            let closing_m = step.map_or(f64::INFINITY, |step| step.closing_m(clusters));
            let [at_least_m, at_best_m] = SLACK_M.map(|slack_m| {
                let slack_m = (steps * closing_m).max(least_steps * closing_m + slack_m);
                (thickness_m + slack_m).min(most_m)
            });
            Within { at_least_m, at_best_m }
        };
        let found = broad_phase.find_pairs(x, horizon_m, self.made.as_ref(), within);
        let mut ends = [0; SHELLS as usize + 1];
        for pair in found {
            ends[usize::from(shell(pair.distance_m, most_m)) + 1] += 1;
        }
        // Counting sort: the beginning of each interval.
        for shell in 1..ends.len() {
            ends[shell] += ends[shell - 1];
        }
        self.pairs.clear();
        self.pairs.resize(found.len(), Pair { primitives: Primitives::EdgeEdge([0; 4]), distance_m: 0.0 });
        for pair in found {
            let slot = &mut ends[usize::from(shell(pair.distance_m, most_m))];
            self.pairs[*slot] = *pair;
            *slot += 1;
        }
        self.found_at = x.to_vec();
        self.made = Some(broad_phase.rest());
        self.room_m = broad_phase.room_m([]);
    }

    /// Pairs that can be nearer than `within_m` at any of `places`, or on the paths between them.
    fn near<const N: usize>(&self, places: [&[V3]; N], within_m: f64) -> impl Iterator<Item = Primitives> {
        let moved = places.map(|x| differences(x, &self.found_at));
        let most_m = moved.iter().map(|d| longest_m(d)).fold(0.0, f64::max);
        let last = shell(within_m + 2.0 * most_m, self.params.reach_m);
        let nearest = self.pairs.partition_point(|pair| shell(pair.distance_m, self.params.reach_m) <= last);
        let is_near = move |pair: &&Pair| {
            let spare_m = pair.distance_m - within_m;
            let closes = |[a, b]: [usize; 2]| moved.iter().any(|d| (d[a] - d[b]).norm_squared() > spare_m * spare_m);
            (spare_m < 0.0 || pair.primitives.across().any(closes)) && !self.untangling.pass(pair.primitives)
        };
        self.pairs[..nearest].iter().filter(is_near).map(|pair| pair.primitives)
    }

    fn is_barred(&self, x: &[V3]) -> bool {
        !self.is_known(x) || self.near([x, &self.last], 0.0).any(|primitives| ccd::collides(&self.last, x, primitives))
    }

    /// Moves vertices from their positions at the last [`ClothContact::update`] towards `x`, and stops each before it
    /// collides. For cloth that is moved without regard to energy. Returns the number of vertices that had to stop.
    pub fn stop(&self, x: &mut [V3]) -> usize {
        let mut shares = vec![1.0_f64; x.len()];
        let goals = x.to_vec();
        for round in 0..MOST_STOPS {
            let mut stopped = Vec::new();
            for primitives in self.near([x, &self.last], NEAREST_M) {
                let share = ccd::free_share(&self.last, x, primitives, NEAREST_M);
                if share < 1.0 {
                    let share = if round < SHARED_STOPS { share } else { 0.0 };
                    stopped.extend(primitives.vertices().map(|v| (v, share)));
                }
            }
            if stopped.is_empty() {
                break;
            }
            let before = shares.clone();
            for (v, share) in stopped {
                shares[v] = shares[v].min(before[v] * share);
                x[v] = self.last[v] + (goals[v] - self.last[v]) * shares[v];
            }
        }
        shares.iter().filter(|share| **share < 1.0).count()
    }

    /// Moves vertices so that near pairs keep their side, and regain the distance of the last [`ClothContact::update`],
    /// or a little more up to the thickness. Each vertex moves by the mean of what its pairs ask for, in several
    /// rounds.
    pub fn keep_apart(&self, x: &mut [V3]) {
        struct Sided {
            vertices: [usize; 4],
            weights: [f64; 4],
            normal: V3,
            wanted_m: f64,
            norm: f64,
        }
        let sided = |primitives: Primitives| {
            let ClosestPoints { weights, gap } = ClosestPoints::of(&self.last, primitives);
            let norm = weights.iter().map(|w| w * w).sum::<f64>();
            let vertices = primitives.vertices();
            let area = vertices.iter().map(|&v| self.areas[v]).fold(f64::MAX, f64::min);
            let thickness_m = self.params.thickness_m.min(THICKNESS_SIZES * area.sqrt());
            let wanted_m = thickness_m.min(gap.norm() + GROWN_SHARE * thickness_m);
            Some(Sided { vertices, weights, normal: gap.try_normalize(0.0)?, wanted_m, norm })
        };
        let pairs: Vec<Sided> = self.near([x, &self.last], self.params.thickness_m).filter_map(sided).collect();
        let mut sums = vec![(V3::zeros(), 0.0); x.len()];
        for _ in 0..APART_ROUNDS {
            let mut any = false;
            for Sided { vertices, weights, normal, wanted_m, norm } in &pairs {
                let distance_m: f64 = (0..4).map(|k| x[vertices[k]].dot(normal) * weights[k]).sum();
                let lack_m = wanted_m - distance_m;
                if lack_m > 0.0 {
                    any = true;
                    for (v, weight) in vertices.iter().zip(weights).filter(|(_, w)| **w != 0.0) {
                        sums[*v].0 += normal * (weight / norm * lack_m);
                        sums[*v].1 += 1.0;
                    }
                }
            }
            if !any {
                break;
            }
            for (p, sum) in x.iter_mut().zip(&mut sums).filter(|(_, sum)| sum.1 > 0.0) {
                *p += sum.0 / sum.1;
                *sum = (V3::zeros(), 0.0);
            }
        }
    }

    /// Mean displacement that would free each vertex from its contacts; `None` without contact.
    pub fn ways_out(&self, x: &[V3]) -> Vec<Option<V3>> {
        let mut sums = vec![(V3::zeros(), 0.0); x.len()];
        for Press { vertices, weights, normal, depth_m, mollifier, .. } in self.presses(x) {
            let depth_m = depth_m * mollifier;
            let norm = weights.iter().map(|w| w * w).sum::<f64>();
            for (v, weight) in vertices.into_iter().zip(weights).filter(|(_, w)| *w != 0.0) {
                sums[v].0 += normal * (weight / norm * depth_m);
                sums[v].1 += 1.0;
            }
        }
        sums.into_iter().map(|(sum, n)| (n > 0.0).then(|| sum / n)).collect()
    }

    /// `None` where the pair does not touch.
    fn press(&self, x: &[V3], primitives: Primitives) -> Option<Press> {
        let vertices = primitives.vertices();
        let nearest = ClosestPoints::of(x, primitives);
        let normal = nearest.gap.try_normalize(0.0)?;
        let area = vertices.iter().map(|&v| self.areas[v]).fold(f64::MAX, f64::min);
        let grown_m = self.params.thickness_m.min(THICKNESS_SIZES * area.sqrt());
        let thickness_m = grown_m * self.untangling.thickness_share(primitives);
        let push = push(nearest.gap.norm(), thickness_m, self.params.stiffness_n_m3)?;
        let stiffness_n_m = self.params.stiffness_n_m3 * area;
        let mut press = Press {
            primitives,
            vertices,
            weights: nearest.weights,
            normal,
            push,
            depth_m: thickness_m - nearest.gap.norm(),
            stiffness_n_m,
            mollifier: 1.0,
            mollifier_gradient: None,
        };
        if let Primitives::EdgeEdge([a, b, c, d]) = primitives {
            let edges_at = |x: &[V3]| [x[b] - x[a], x[d] - x[c]];
            let [u, w] = edges_at(&self.found_at);
            let full = MOLLIFIED_BELOW * u.norm_squared() * w.norm_squared();
            let [u, w] = edges_at(x);
            let (area, slopes) = cross_squared(&u, &w);
            if area < full {
                let part = area / full;
                press.mollifier = part * (2.0 - part);
                press.mollifier_gradient = Some(slopes.map(|slope| slope * ((2.0 - 2.0 * part) / full)));
            }
        }
        Some(press)
    }

    fn presses<'s>(&'s self, x: &'s [V3]) -> impl Iterator<Item = Press> + 's {
        self.near([x], self.params.thickness_m).filter_map(|primitives| self.press(x, primitives))
    }

    /// J. Infinite where the cloth would pass through itself on the path from the last step, so that a line search
    /// rejects it.
    pub fn energy(&self, x: &[V3]) -> f64 {
        if self.is_barred(x) { f64::INFINITY } else { self.pressed_energy(x) }
    }

    /// J, whether or not the cloth would pass through itself.
    pub fn pressed_energy(&self, x: &[V3]) -> f64 {
        let pressed = |press: Press| press.stiffness_n_m * press.mollifier * press.push.energy;
        let rubbed_j = self.rub.as_ref().map_or(0.0, |rub| rub.energy(x));
        self.presses(x).map(pressed).sum::<f64>() + self.untangling.energy(x) + rubbed_j
    }

    pub fn assemble(&self, x: &[V3], forces: &mut [V3]) -> Vec<Contact4> {
        let mut contacts = Vec::new();
        for press in self.presses(x) {
            let Press { vertices, weights, normal, push, stiffness_n_m: k, mollifier, mollifier_gradient, .. } = press;
            for i in 0..4 {
                forces[vertices[i]] += normal * (mollifier * k * push.force * weights[i]);
            }
            if let Some(slopes) = mollifier_gradient {
                for (slope, ends) in slopes.iter().zip([[0, 1], [2, 3]]) {
                    let force = slope * (k * push.energy);
                    forces[vertices[ends[0]]] += force;
                    forces[vertices[ends[1]]] -= force;
                }
            }
            contacts.push(Contact4 { vertices, weights, normal, stiffness: mollifier * k * push.stiffness });
        }
        self.untangling.assemble(forces, &mut contacts);
        if let Some(rub) = &self.rub {
            rub.assemble(x, forces, &mut contacts);
        }
        contacts
    }
}

fn shell(distance_m: f64, reach_m: f64) -> u8 {
    (SHELLS * distance_m / reach_m) as u8
}

fn differences(x: &[V3], from: &[V3]) -> Vec<V3> {
    x.iter().zip(from).map(|(p, q)| p - q).collect()
}

fn farthest(x: &[V3], from: &[V3]) -> f64 {
    x.iter().zip(from).map(|(p, q)| (p - q).norm_squared()).fold(0.0, f64::max).sqrt()
}

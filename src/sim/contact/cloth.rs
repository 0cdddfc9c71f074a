//! Contact of the cloth with itself: vertices are kept a thickness away from triangles, edges from edges.
//!
//! Each pair is pushed apart by the true distance of its two primitives. That runs on smoothly where a nearest point
//! slides over a rim [Li 2020]: the energy has no steps, and a line search no place to stop at. The push rises steeply
//! as two layers come near (`barrier`), so that tension does not draw one through the other. No step may take it
//! through: where a pair would meet on the way from the last step (`ccd`) the energy is infinite. All pairs that share
//! no vertex are watched, but for those within flat cloth (`normal_cones`), so what does not cross hardly ever comes
//! to: only what is pressed to within a thousandth of a millimetre may pass. Pairs are sought within a reach, farther
//! where clusters of cloth close in on each other faster. Steps go no farther than pairs beyond it need to meet, so
//! none is met unseen. What many vertices do together brings none nearer (`normal_cones`). Cloth that already crosses
//! when it is first seen passes through itself there, while the line along which it crosses is drawn out of it
//! (`untangle`). Layers rub on each other (`rub`).

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

/// Parameters of self-contact.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct ClothContactParams {
    /// Distance at which layers begin to push each other apart, m.
    pub thickness_m: f64,
    /// Penalty, N/m3.
    pub stiffness_n_m3: f64,
    /// Pairs are sought up to this distance at most, m: twice what two vertices move towards each other in a step.
    pub reach_m: f64,
    /// Force that draws a crossing out, N; it grows where that does not do.
    pub release_n: f64,
    /// Steps for which crossings are drawn out.
    pub release_steps: u32,
}

impl Default for ClothContactParams {
    fn default() -> Self {
        Self { thickness_m: 2e-3, stiffness_n_m3: 1e6, reach_m: 0.02, release_n: 0.02, release_steps: 400 }
    }
}

geom::constants! {
    "contact.cloth",
    /// Squared sine of the angle between two edges below which their contact fades out: parallel edges have no one direction
    /// in which they face each other.
    const MOLLIFIED_BELOW: f64 = 0.01;
    /// For how many steps as long as the last pairs are known: at least, and at best.
    const STEPS_AHEAD: [f64; 2] = [1.5, 3.0];
    /// How much nearer a pair is to come at least before it is sought again; and, where it is, until then, m.
    const SLACK_M: [f64; 2] = [1e-3, 4e-3];
    /// Limit of the search distance over the size of the triangles. A vertex of a finer mesh then has no more pairs, and
    /// a quarter as many as within twice that distance.
    const REACH_SIZES: f64 = 0.7;
    /// Least value of that limit, m: in a step two vertices approach each other by at most half of it.
    const LEAST_REACH_M: f64 = 8e-3;
    /// Share of the way to what is unknown that a step may take: corrections come on top.
    const FREE_SHARE: f64 = 0.9;
    /// Shells of distance by which pairs are sorted.
    const SHELLS: f64 = 64.0;
    /// Rounds in which what would meet goes a part of its way, and in which it then stays where it is.
    const SHARED_STOPS: usize = 6;
    const MOST_STOPS: usize = 60;
    /// Rounds in which what is near is kept apart.
    const APART_ROUNDS: usize = 6;
    /// Share of the thickness by which a pair is brought apart at once.
    const GROWN_SHARE: f64 = 0.25;
    /// Distance below which nothing comes nearer that is moved without regard to energy, m.
    const NEAREST_M: f64 = 1e-4;
    /// Thickness of a contact over the size of triangles, at most: within a flat cloth none pushes its broad_phase.
    const THICKNESS_SIZES: f64 = 0.5;
}

/// How deep a pair is in contact at some positions.
struct Press {
    primitives: Primitives,
    vertices: [usize; 4],
    weights: [f64; 4],
    /// Direction away from the second primitive.
    normal: V3,
    push: Push,
    /// How much nearer than the thickness the pair is, m.
    depth_m: f64,
    /// Penalty stiffness: by the smallest rest area among the vertices.
    stiffness_n_m: f64,
    /// Mollifier [Li 2020]: the share of the contact that counts: less than 1 for nearly parallel edges.
    mollifier: f64,
    /// Gradient of the mollifier by the first edge and by the second.
    mollifier_gradient: Option<[V3; 2]>,
}

impl Press {
    /// What friction has to know of it.
    fn pressed(self) -> Pressed {
        let Self { primitives, weights, normal, push, stiffness_n_m, mollifier, .. } = self;
        let force_n = mollifier * stiffness_n_m * push.force;
        Pressed { primitives, weights, normal, force_n, stiffness_n_m: mollifier * stiffness_n_m }
    }
}

/// Self-contact of one cloth.
pub struct ClothContact<'a> {
    params: ClothContactParams,
    /// `None` in a part of the cloth.
    broad_phase: Option<BroadPhase<'a>>,
    areas: Cow<'a, [f64]>,
    /// Nearest first, as far as shells tell.
    pairs: Vec<Pair>,
    found_at: Vec<V3>,
    /// Where the cloth was at the last step.
    last: Vec<V3>,
    /// How it had come there from where pairs were found.
    made: Option<Motion>,
    /// How much nearer than there unknown pairs may come before they could meet, m.
    room_m: f64,
    untangling: Untangling,
    /// `None` while friction is off.
    rub: Option<Rub>,
}

impl<'a> ClothContact<'a> {
    /// Self-contact over the triangles of a cloth; `areas` are the vertices' rest areas, m2.
    #[must_use]
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

    /// Switches friction of layers on each other on, with a Coulomb coefficient of each vertex. They are held where they now lie.
    pub fn set_friction(&mut self, coefficients: impl Iterator<Item = f64>) {
        self.rub = Some(Rub::new(coefficients.collect()));
    }

    /// From now on friction holds layers on each other, whatever that takes.
    pub fn hold_fast(&mut self) {
        self.rub.iter_mut().for_each(Rub::hold_fast);
    }

    /// Sets where layers are held after a step has been taken to `x`: what has slid is held from there.
    pub fn drag_anchors(&mut self, x: &[V3]) {
        self.rub.iter_mut().for_each(|rub| rub.end(x));
    }

    /// Takes over where friction has come to hold the layers of a part of the cloth.
    pub fn take_anchors(&mut self, part: &Part, contact: &ClothContact) {
        if let (Some(rub), Some(of_part)) = (&mut self.rub, &contact.rub) {
            rub.take(of_part, |primitives| primitives.renamed(|vertices| Some(vertices.map(|v| part.vertices[v]))));
        }
    }

    /// Takes `sewn` pairs for one vertex each, and leaves alone what crosses: for cloth that is being sewn.
    #[must_use]
    pub fn but_near(mut self, sewn: impl Iterator<Item = [usize; 2]>) -> Self {
        if let Some(broad_phase) = &mut self.broad_phase {
            broad_phase.join(sewn);
        }
        self.untangling.leave();
        self
    }

    /// Whether nothing crosses, nor did so of late.
    #[must_use]
    pub fn is_untangled(&self) -> bool {
        self.untangling.is_empty() && !self.untangling.is_fresh()
    }

    /// Gives contacts the thickness that they are still growing to, and says whether there were any: cloth is not at rest before.
    pub fn ripen(&mut self) -> bool {
        self.untangling.ripen()
    }

    /// Vertices of pairs of which one is `free`.
    pub fn partners<'s>(&'s self, free: &'s [bool]) -> impl Iterator<Item = usize> + 's {
        let vertices = self.pairs.iter().map(|pair| pair.primitives.vertices());
        vertices.filter(|vertices| vertices.iter().any(|&v| free[v])).flatten()
    }

    /// The contact of a part of the cloth, which lies at `x`, with itself and with the rest: it knows the near pairs that were found
    /// already, and seeks no others.
    #[must_use]
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

    /// Looks at where the cloth has come in a step: seeks near pairs anew where it has moved so far, or folded so sharply, that one
    /// could be missed in the next, and finds the way out of crossings.
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
            // What is about to be one vertex does not cross; taken for a crossing, it would let all else about it pass.
            let are_apart = |crossing: &Intersection| broad_phase.are_apart(&crossing.edge, &crossing.triangle);
            let mut found = intersections(x, broad_phase.edges(), broad_phase.triangles());
            found.retain(are_apart);
            self.untangling.see(x, broad_phase.triangles(), &found);
        }
        self.broad_phase = Some(broad_phase);
    }

    /// Whether what is known of near pairs, since when the cloth has `made` a motion, does for more steps like the last; finds how much
    /// room is left.
    fn lasts(&mut self, broad_phase: &BroadPhase, made: &Motion, step: &Motion) -> bool {
        self.room_m = broad_phase.room_m([(made, 1.0)]);
        broad_phase.room_m([(made, 1.0), (step, STEPS_AHEAD[0])]) >= self.params.thickness_m
    }

    /// Whether the cloth, which has `made` a motion to `x` since pairs were found, may have come to cross itself: it did already, or touched
    /// at the last step and may have passed since, or was moved by others. What is near, and does not touch, is kept from it.
    fn may_cross(&self, broad_phase: &BroadPhase, x: &[V3], made: Option<&Motion>) -> bool {
        let is_known = |made| 2.0 * farthest(x, &self.last) < self.room_m || broad_phase.room_m([(made, 1.0)]) > 0.0;
        !made.is_some_and(is_known) || !self.untangling.is_empty() || self.touches()
    }

    /// Whether parts of the cloth touched at the last [`ClothContact::update`], and so may pass each other in the next step.
    #[must_use]
    pub fn touches(&self) -> bool {
        let touches = |primitives| ClosestPoints::of(&self.last, primitives).gap.norm() < ccd::TOUCHING_M;
        self.near([&self.last], ccd::TOUCHING_M).any(touches)
    }

    /// How far vertices may go, each its own way, from where the cloth was at the last [`ClothContact::update`], m: farther, near
    /// pairs could be unknown.
    #[must_use]
    pub fn free_path_m(&self) -> f64 {
        0.5 * FREE_SHARE * self.room_m
    }

    /// Share of these displacements that vertices may go for the same reason: what many do together brings them no nearer.
    #[must_use]
    pub fn free_share(&self, displacements: &[V3]) -> f64 {
        let share = self.free_path_m() / longest_m(displacements);
        match (&self.broad_phase, &self.made) {
            (Some(broad_phase), Some(made)) if share < 1.0 => {
                FREE_SHARE * broad_phase.free_share(made, &broad_phase.motion(displacements))
            }
            _ => share,
        }
    }

    /// Whether no unknown pair can meet at `x`.
    fn is_known(&self, x: &[V3]) -> bool {
        2.0 * farthest(x, &self.last) < self.room_m
            || self.broad_phase.as_ref().is_some_and(|broad_phase| {
                let made = broad_phase.motion(&differences(x, &self.found_at));
                broad_phase.room_m([(&made, 1.0)]) > 0.0
            })
    }

    /// Seeks near pairs at `x`, for steps like the last.
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
        // Sorted by counting: where each shell begins.
        for shell in 1..ends.len() {
            ends[shell] += ends[shell - 1];
        }
        self.pairs.clear();
        self.pairs.resize(found.len(), Pair { primitives: Primitives::EdgeEdge([0; 4]), distance_m: 0.0 });
        for pair in found {
            let at = &mut ends[usize::from(shell(pair.distance_m, most_m))];
            self.pairs[*at] = *pair;
            *at += 1;
        }
        self.found_at = x.to_vec();
        self.made = Some(broad_phase.rest());
        self.room_m = broad_phase.room_m([]);
    }

    /// Pairs that can be nearer than `within_m` at any of some places, or on the way between them.
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

    /// Whether cloth would go through itself on the straight way from the last step to `x`.
    fn is_barred(&self, x: &[V3]) -> bool {
        !self.is_known(x) || self.near([x, &self.last], 0.0).any(|primitives| ccd::collides(&self.last, x, primitives))
    }

    /// Where vertices come to that go from where the cloth was at the last [`ClothContact::update`] to `x` each for itself, and stop before
    /// they meet what is near: for cloth that is moved without regard to energy. Says how many had to stop.
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

    /// Moves vertices at `x` so that what is near keeps to the side, and comes to the distance, that it had at the last
    /// [`ClothContact::update`], or a little more of it up to the thickness. They move by the mean of what all pairs
    /// ask for, some times over.
    pub fn keep_apart(&self, x: &mut [V3]) {
        let sided = |primitives: Primitives| {
            let ClosestPoints { weights, gap } = ClosestPoints::of(&self.last, primitives);
            let norm = weights.iter().map(|w| w * w).sum::<f64>();
            let vertices = primitives.vertices();
            let area = vertices.iter().map(|&v| self.areas[v]).fold(f64::MAX, f64::min);
            let thickness_m = self.params.thickness_m.min(THICKNESS_SIZES * area.sqrt());
            let wanted_m = thickness_m.min(gap.norm() + GROWN_SHARE * thickness_m);
            Some((vertices, weights, gap.try_normalize(0.0)?, wanted_m, norm))
        };
        let pairs: Vec<_> = self.near([x, &self.last], self.params.thickness_m).filter_map(sided).collect();
        let mut sums = vec![(V3::zeros(), 0.0); x.len()];
        for _ in 0..APART_ROUNDS {
            let mut any = false;
            for (vertices, weights, normal, wanted_m, norm) in &pairs {
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

    /// The displacement of each vertex at `x` that would bring it out of what it presses on, the mean where there is more; none where it
    /// presses on nothing.
    #[must_use]
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

    fn press(&self, x: &[V3], primitives: Primitives) -> Option<Press> {
        let vertices = primitives.vertices();
        let nearest = ClosestPoints::of(x, primitives);
        let normal = nearest.gap.try_normalize(0.0)?;
        let area = vertices.iter().map(|&v| self.areas[v]).fold(f64::MAX, f64::min);
        let grown_m = self.params.thickness_m.min(THICKNESS_SIZES * area.sqrt());
        let thickness_m = grown_m * self.untangling.thickness_share(primitives);
        let push = push(nearest.gap.norm(), thickness_m)?;
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

    /// Contact energy, J; infinite where the cloth would go through itself on the way from the last step, so that no line
    /// search goes there.
    #[must_use]
    pub fn energy(&self, x: &[V3]) -> f64 {
        if self.is_barred(x) { f64::INFINITY } else { self.pressed_energy(x) }
    }

    /// Contact energy, J, wherever that leads.
    #[must_use]
    pub fn pressed_energy(&self, x: &[V3]) -> f64 {
        let pressed = |press: Press| press.stiffness_n_m * press.mollifier * press.push.energy;
        let rubbed_j = self.rub.as_ref().map_or(0.0, |rub| rub.energy(x));
        self.presses(x).map(pressed).sum::<f64>() + self.untangling.energy(x) + rubbed_j
    }

    /// Adds the contact forces and returns the stiffness.
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

/// Which of the shells that part the reach a distance falls in.
fn shell(distance_m: f64, reach_m: f64) -> u8 {
    (SHELLS * distance_m / reach_m) as u8
}

/// How far each vertex is from where it was, m.
fn differences(x: &[V3], from: &[V3]) -> Vec<V3> {
    x.iter().zip(from).map(|(p, q)| p - q).collect()
}

/// Greatest distance of a vertex from where it was, m.
fn farthest(x: &[V3], from: &[V3]) -> f64 {
    x.iter().zip(from).map(|(p, q)| (p - q).norm_squared()).fold(0.0, f64::max).sqrt()
}

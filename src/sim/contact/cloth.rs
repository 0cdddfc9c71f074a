//! Contact of the cloth with itself: vertices are kept a thickness away from triangles, edges from edges.
//!
//! Each pair is pushed apart by the true distance of its two primitives, which runs on smoothly where a nearest point
//! slides over a rim (as in [Li 2020]): the energy has no steps, and a line search no place to stop at. While the nearest
//! points lie within both primitives, the side on which the pair lies is remembered, so cloth that slips through in a
//! step is pushed back to where it came from. Pairs are sought within a reach that no step can cross, so none is met
//! unseen. Cloth that already crosses when it is first seen passes through itself while the line along which it crosses
//! is drawn out of it ([`super::tangle`]). There is no friction between layers.

use super::advance;
use super::nearest::{Nearest, Primitives, spanned_squared};
use super::search::Neighbours;
use super::tangle::{Crossing, Release, Wings, crossings};
use crate::geom::V3;
use crate::sim::solver::Contact4;

/// Parameters of self-contact.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct ClothContactParams {
    /// Distance at which layers begin to push each other apart, m.
    pub thickness_m: f64,
    /// Penalty, N/m3.
    pub stiffness_n_m3: f64,
    /// Pairs are sought up to this distance at most, m: twice what a vertex moves in a step.
    pub reach_m: f64,
    /// Force that draws a crossing out, N.
    pub release_n: f64,
    /// Steps for which crossings are drawn out: what is still tangled then is held so by the body.
    pub release_steps: u32,
}

impl Default for ClothContactParams {
    fn default() -> Self {
        Self { thickness_m: 2e-3, stiffness_n_m3: 1e6, reach_m: 0.02, release_n: 0.02, release_steps: 150 }
    }
}

/// What a contact does at some distance, over its penalty stiffness.
#[derive(Clone, Copy, Debug)]
struct Push {
    /// Energy, m2.
    energy: f64,
    /// Force, m.
    force: f64,
    stiffness: f64,
}

impl ClothContactParams {
    /// At a distance: a spring over the thickness, and within half of it a barrier that no force overcomes [Li 2020].
    /// `None` beyond the thickness.
    fn push(&self, distance_m: f64, size_m: f64) -> Option<Push> {
        let t = self.thickness_m.min(size_m);
        let depth = t - distance_m;
        // Not a number where a triangle has collapsed.
        if depth.is_nan() || depth <= 0.0 {
            return None;
        }
        let mut push = Push { energy: 0.5 * depth * depth, force: depth, stiffness: 1.0 };
        let (knee, least) = (BARRIER_FROM * t, BARRIER_TO * t);
        if distance_m < knee {
            let d = distance_m.max(least);
            let (u, log) = (knee - d, (knee / d).ln());
            let barrier = Push {
                energy: u * u * log,
                force: u * (2.0 * log + u / d),
                stiffness: 2.0 * log + 4.0 * u / d + u * u / (d * d),
            };
            // Nearer still it runs on as a parabola.
            let below = d - distance_m;
            push.energy += BARRIER * (barrier.energy + below * (barrier.force + 0.5 * below * barrier.stiffness));
            push.force += BARRIER * (barrier.force + below * barrier.stiffness);
            push.stiffness += BARRIER * barrier.stiffness;
        }
        Some(push)
    }
}

/// Share of the thickness below which the barrier rises.
const BARRIER_FROM: f64 = 0.5;
/// Share of the thickness down to which it rises as a logarithm.
const BARRIER_TO: f64 = 0.01;
const SIZE: f64 = 0.5;
/// Its strength over that of the spring.
const BARRIER: f64 = 4.0;

/// Squared sine of the angle between two edges below which their contact fades out: parallel edges have no one direction
/// in which they face each other.
const PARALLEL: f64 = 0.01;
/// Least movement that a search foresees, m.
const LEAST_SLACK_M: f64 = 2e-3;
/// Steps without fewer crossings after which they are drawn out harder.
const PATIENCE: u32 = 4;
/// Factor of that.
const RELEASE_GROWTH: f64 = 1.5;
/// Most that the force grows by in all.
const MOST_RELEASE: f64 = 100.0;
/// How far a step against a releasing force goes at most, m.
const RELEASE_STEP_M: f64 = 2e-3;

/// A pair that is near.
#[derive(Clone, Copy, Debug)]
struct Pair {
    primitives: Primitives,
    /// Distance when the pairs were sought, m.
    distance_m: f64,
}

/// How deep a pair is in contact at some positions.
struct Press {
    vertices: [usize; 4],
    weights: [f64; 4],
    /// Direction away from the second primitive.
    normal: V3,
    push: Push,
    /// Share of the contact that counts: less than 1 for nearly parallel edges.
    share: f64,
    /// Gradient of that share by the first edge and by the second.
    fading: Option<[V3; 2]>,
}

/// Self-contact of one cloth.
pub struct ClothContact<'a> {
    params: ClothContactParams,
    neighbours: Neighbours<'a>,
    wings: Wings,
    areas: &'a [f64],
    /// Nearest first.
    pairs: Vec<Pair>,
    found_at: Vec<V3>,
    reach_m: f64,
    /// Where the cloth was at the last step.
    last: Vec<V3>,
    is_tangled: bool,
    /// Vertices of what crosses: it has no right side, and passes until it has come free.
    tangled: Vec<[usize; 2]>,
    released: u32,
    /// Force that draws a crossing out, N: it grows where they do not get fewer.
    release_n: f64,
    /// Fewest crossings of the tangle so far, and for how many steps they have not got fewer.
    least_tangled: usize,
    stalled: u32,
    releases: Vec<Release>,
}

impl<'a> ClothContact<'a> {
    /// Self-contact over the triangles of a cloth; `areas` are the vertices' rest areas, m2.
    #[must_use]
    pub fn new(params: ClothContactParams, triangles: &'a [[usize; 3]], areas: &'a [f64]) -> Self {
        Self {
            params,
            neighbours: Neighbours::new(triangles, areas.len()),
            wings: Wings::new(triangles),
            areas,
            pairs: Vec::new(),
            found_at: Vec::new(),
            reach_m: params.reach_m,
            last: Vec::new(),
            is_tangled: false,
            tangled: Vec::new(),
            released: 0,
            release_n: params.release_n,
            least_tangled: usize::MAX,
            stalled: 0,
            releases: Vec::new(),
        }
    }

    /// Leaves alone what is near `sewn` pairs, which will join, and what crosses: for cloth that is being sewn.
    #[must_use]
    pub fn but_near(mut self, sewn: impl Iterator<Item = [usize; 2]>) -> Self {
        self.neighbours.join(sewn);
        self.params.release_steps = 0;
        self
    }

    /// Looks at where the cloth has come in a step: seeks near pairs anew where it has moved so far that one could be
    /// missed in the next, remembers on which side each lies, and finds the way out of crossings.
    pub fn update(&mut self, x: &[V3]) {
        let step = if self.last.len() == x.len() { farthest(x, &self.last) } else { self.params.reach_m };
        self.last = x.to_vec();
        let expected = 1.5 * step;
        let moved = if self.found_at.len() == x.len() { farthest(x, &self.found_at) } else { f64::MAX };
        if moved + expected > 0.5 * (self.reach_m - self.params.thickness_m) {
            let wanted = self.params.thickness_m + 2.0 * (expected + expected.max(LEAST_SLACK_M));
            self.reach_m = wanted.min(self.params.reach_m);
            self.seek(x);
            // Only cloth that has moved can have come to cross.
            self.is_tangled = true;
        }
        if self.is_tangled {
            self.untangle(x);
        }
    }

    /// Finds what crosses, lets it pass, and the way out of it.
    fn untangle(&mut self, x: &[V3]) {
        let found: Vec<Crossing> = crossings(x, self.neighbours.edges(), self.neighbours.triangles()).collect();
        self.is_tangled = !found.is_empty();
        self.tangled.clear();
        for crossing in &found {
            let each = crossing.edge.into_iter().flat_map(|v| crossing.triangle.map(|w| [v, w]));
            self.tangled.extend(each.flat_map(|[v, w]| [[v, w], [w, v]]));
        }
        self.tangled.sort_unstable();
        self.tangled.dedup();
        self.releases.clear();
        if found.len() < self.least_tangled {
            (self.least_tangled, self.stalled) = (found.len(), 0);
        } else {
            self.stalled += 1;
        }
        if self.stalled >= PATIENCE {
            self.stalled = 0;
            self.release_n = (self.release_n * RELEASE_GROWTH).min(MOST_RELEASE * self.params.release_n);
        }
        if found.is_empty() {
            (self.least_tangled, self.stalled, self.release_n) = (usize::MAX, 0, self.params.release_n);
        }
        if self.released < self.params.release_steps {
            self.released += 1;
            self.releases = found.iter().filter_map(|crossing| Release::of(x, &self.wings, crossing)).collect();
        }
    }

    fn seek(&mut self, x: &[V3]) {
        self.pairs.clear();
        for primitives in self.neighbours.within(x, self.reach_m) {
            let distance_m = Nearest::of(x, primitives).gap.norm();
            if distance_m < self.reach_m {
                self.pairs.push(Pair { primitives, distance_m });
            }
        }
        let order = |a: &Pair, b: &Pair| a.distance_m.total_cmp(&b.distance_m).then(a.primitives.cmp(&b.primitives));
        self.pairs.sort_unstable_by(order);
        self.found_at = x.to_vec();
    }

    /// How far each vertex has come since the pairs were sought, m.
    fn moved(&self, x: &[V3]) -> Vec<f64> {
        x.iter().zip(&self.found_at).map(|(p, q)| (p - q).norm()).collect()
    }

    /// Pairs that can be nearer than `within_m` where their vertices have come as far as `moved`.
    fn near<'s>(&'s self, moved: Vec<f64>, within_m: f64) -> impl Iterator<Item = Primitives> + 's {
        let most = moved.iter().copied().fold(0.0, f64::max);
        let nearest = self.pairs.partition_point(|pair| pair.distance_m < within_m + 2.0 * most);
        let is_near = move |pair: &&Pair| {
            let [a, b, c, d] = pair.primitives.vertices().map(|v| moved[v]);
            let closing = match pair.primitives {
                Primitives::VertexTriangle(_) => a + b.max(c).max(d),
                Primitives::EdgeEdge(_) => a.max(b) + c.max(d),
            };
            pair.distance_m < within_m + closing && !self.passes(pair.primitives)
        };
        self.pairs[..nearest].iter().filter(is_near).map(|pair| pair.primitives)
    }

    /// Whether both sides of a pair are tangled, so that neither hinders the other.
    fn passes(&self, primitives: Primitives) -> bool {
        if self.tangled.is_empty() {
            return false;
        }
        let [a, b, c, d] = primitives.vertices();
        let cross = |v: usize, w: usize| self.tangled.binary_search(&[v, w]).is_ok();
        match primitives {
            Primitives::VertexTriangle(_) => [b, c, d].into_iter().any(|w| cross(a, w)),
            Primitives::EdgeEdge(_) => [a, b].into_iter().any(|v| cross(v, c) || cross(v, d)),
        }
    }

    /// Whether cloth would go through itself on the straight way from the last step to `x`.
    fn is_barred(&self, x: &[V3]) -> bool {
        let moved = self.moved(x);
        if 2.0 * moved.iter().copied().fold(0.0, f64::max) >= self.reach_m {
            return true;
        }
        let farthest = moved.iter().zip(self.moved(&self.last)).map(|(a, b)| a.max(b)).collect();
        self.near(farthest, 0.0).any(|primitives| advance::meets(&self.last, x, primitives))
    }

    fn press(&self, x: &[V3], primitives: Primitives) -> Option<Press> {
        let vertices = primitives.vertices();
        let nearest = Nearest::of(x, primitives);
        let height = nearest.gap.norm();
        let normal = nearest.gap.try_normalize(0.0)?;
        let push = self
            .params
            .push(height, SIZE * vertices.map(|v| self.areas[v]).into_iter().fold(f64::MAX, f64::min).sqrt())?;
        let mut press = Press { vertices, weights: nearest.weights, normal, push, share: 1.0, fading: None };
        if let Primitives::EdgeEdge([a, b, c, d]) = primitives {
            let edges_at = |x: &[V3]| [x[b] - x[a], x[d] - x[c]];
            let [u, w] = edges_at(&self.found_at);
            let full = PARALLEL * u.norm_squared() * w.norm_squared();
            let [u, w] = edges_at(x);
            let (area, slopes) = spanned_squared(&u, &w);
            if area < full {
                let part = area / full;
                press.share = part * (2.0 - part);
                press.fading = Some(slopes.map(|slope| slope * ((2.0 - 2.0 * part) / full)));
            }
        }
        Some(press)
    }

    fn presses<'s>(&'s self, x: &'s [V3]) -> impl Iterator<Item = Press> + 's {
        self.near(self.moved(x), self.params.thickness_m).filter_map(|primitives| self.press(x, primitives))
    }

    /// Penalty stiffness of a contact, N/m: by the smallest rest area among its vertices.
    fn stiffness(&self, press: &Press) -> f64 {
        self.params.stiffness_n_m3 * press.vertices.iter().map(|&v| self.areas[v]).fold(f64::MAX, f64::min)
    }

    /// Contact energy, J.
    #[must_use]
    pub fn energy(&self, x: &[V3]) -> f64 {
        if self.is_barred(x) {
            return f64::INFINITY;
        }
        let pressed = |press: Press| self.stiffness(&press) * press.share * press.push.energy;
        let released: f64 = self.releases.iter().map(|release| release.potential(x)).sum();
        self.presses(x).map(pressed).sum::<f64>() + self.release_n * released
    }

    /// Adds the contact forces and returns the stiffness.
    pub fn assemble(&self, x: &[V3], forces: &mut [V3]) -> Vec<Contact4> {
        let mut contacts = Vec::new();
        for press in self.presses(x) {
            let k = self.stiffness(&press);
            let Press { vertices, weights, normal, push, share, fading } = press;
            for i in 0..4 {
                forces[vertices[i]] += normal * (share * k * push.force * weights[i]);
            }
            if let Some(slopes) = fading {
                for (slope, ends) in slopes.iter().zip([[0, 1], [2, 3]]) {
                    let force = slope * (k * push.energy);
                    forces[vertices[ends[0]]] += force;
                    forces[vertices[ends[1]]] -= force;
                }
            }
            contacts.push(Contact4 { vertices, weights, normal, stiffness: share * k * push.stiffness });
        }
        for release in &self.releases {
            release.add_force(self.release_n, forces);
            contacts.extend(release.couplings(self.release_n / RELEASE_STEP_M));
        }
        contacts
    }
}

/// Greatest distance of a vertex from where it was, m.
fn farthest(x: &[V3], from: &[V3]) -> f64 {
    x.iter().zip(from).map(|(p, q)| (p - q).norm_squared()).fold(0.0, f64::max).sqrt()
}

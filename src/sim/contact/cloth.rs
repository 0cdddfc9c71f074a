//! Contact of the cloth with itself: vertices are kept a thickness away from triangles, edges from edges.
//!
//! Each pair is pushed apart by the true distance of its two primitives, which runs on smoothly where a nearest point
//! slides over a rim (as in [Li 2020]): the energy has no steps, and a line search no place to stop at. While the nearest
//! points lie within both primitives, the side on which the pair lies is remembered, so cloth that slips through in a
//! step is pushed back to where it came from. Pairs are sought within a reach that no step can cross, so none is met
//! unseen. Cloth that already crosses when it is first seen passes through itself while the line along which it crosses
//! is drawn out of it ([`super::tangle`]). There is no friction between layers.

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

/// Squared sine of the angle between two edges below which their contact fades out: parallel edges have no one direction
/// in which they face each other.
const PARALLEL: f64 = 0.01;
/// Least movement that a search foresees, m.
const LEAST_SLACK_M: f64 = 2e-3;
/// How far a step against a releasing force goes at most, m.
const RELEASE_STEP_M: f64 = 2e-3;

/// A pair that is near.
#[derive(Clone, Copy, Debug)]
struct Pair {
    primitives: Primitives,
    /// Distance when the pairs were sought, m.
    distance_m: f64,
    /// Unit normal of the second primitive on the side where the first one was last seen within it.
    away: V3,
    /// Whether the nearest points then lay within both primitives.
    is_within: bool,
    /// Whether the first one was then on the wrong side: such a pair counts however far it is through.
    has_slipped: bool,
}

impl Pair {
    /// On which side of the second primitive the first belongs, 1 where its normal points: where it was seen, or where it
    /// now is if it has come over a rim since.
    fn side(&self, normal: &V3, gap: &V3) -> f64 {
        normal.dot(if self.is_within { &self.away } else { gap }).signum()
    }
}

/// How deep a pair is in contact at some positions.
struct Press {
    vertices: [usize; 4],
    weights: [f64; 4],
    /// Direction away from the second primitive.
    normal: V3,
    /// By how much the pair is nearer than the thickness, m.
    depth: f64,
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
    tangled: Vec<bool>,
    released: u32,
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
            tangled: vec![false; areas.len()],
            released: 0,
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
        self.see_sides(x);
    }

    /// Finds what crosses, lets it pass, and the way out of it.
    fn untangle(&mut self, x: &[V3]) {
        let found: Vec<Crossing> = crossings(x, self.neighbours.edges(), self.neighbours.triangles()).collect();
        self.is_tangled = !found.is_empty();
        self.tangled = vec![false; x.len()];
        for v in found.iter().flat_map(|crossing| crossing.edge.into_iter().chain(crossing.triangle)) {
            self.tangled[v] = true;
        }
        for pair in &mut self.pairs {
            if pair.primitives.vertices().iter().any(|v| self.tangled[*v]) {
                pair.is_within = false;
            }
        }
        self.releases.clear();
        if self.released < self.params.release_steps {
            self.released += 1;
            self.releases = found.iter().filter_map(|crossing| Release::of(x, &self.wings, crossing)).collect();
        }
    }

    fn seek(&mut self, x: &[V3]) {
        // All others have stayed apart: they lie on the side where they are.
        let mut known: Vec<Pair> = self.near(x).map(|(_, pair)| *pair).collect();
        known.sort_unstable_by_key(|pair| pair.primitives);
        let mut found = Vec::new();
        for primitives in self.neighbours.within(x, self.reach_m) {
            let nearest = Nearest::of(x, primitives);
            let distance_m = nearest.gap.norm();
            let Some(away) = nearest.gap.try_normalize(0.0).filter(|_| distance_m < self.reach_m) else { continue };
            match known.binary_search_by_key(&primitives, |p| p.primitives) {
                Ok(index) => found.push(Pair { distance_m, ..known[index] }),
                Err(_) => found.push(Pair {
                    primitives,
                    distance_m,
                    away,
                    is_within: nearest.normal.is_some(),
                    has_slipped: false,
                }),
            }
        }
        found.sort_unstable_by(|a, b| a.distance_m.total_cmp(&b.distance_m).then(a.primitives.cmp(&b.primitives)));
        self.pairs = found;
        self.found_at = x.to_vec();
    }

    /// Remembers on which side the near pairs lie.
    fn see_sides(&mut self, x: &[V3]) {
        let near: Vec<(usize, Nearest)> = self.near(x).map(|(k, pair)| (k, Nearest::of(x, pair.primitives))).collect();
        for (k, nearest) in near {
            let pair = &mut self.pairs[k];
            if let Some(normal) = nearest.normal {
                pair.away = normal * pair.side(&normal, &nearest.gap);
            }
            pair.is_within = nearest.normal.is_some();
            pair.has_slipped = pair.is_within && pair.away.dot(&nearest.gap) < 0.0;
        }
    }

    /// Pairs that can be in contact at `x`, with their places.
    fn near<'s>(&'s self, x: &[V3]) -> impl Iterator<Item = (usize, &'s Pair)> + 's {
        let moved: Vec<f64> = if self.pairs.is_empty() {
            Vec::new()
        } else {
            x.iter().zip(&self.found_at).map(|(p, q)| (p - q).norm()).collect()
        };
        let most = moved.iter().copied().fold(0.0, f64::max);
        let thickness = self.params.thickness_m;
        let nearest = self.pairs.partition_point(|pair| pair.distance_m < thickness + 2.0 * most);
        self.pairs.iter().enumerate().filter(move |(k, pair)| {
            if !pair.has_slipped && *k >= nearest {
                return false;
            }
            let [a, b, c, d] = pair.primitives.vertices().map(|v| moved[v]);
            let closing = match pair.primitives {
                Primitives::VertexTriangle(_) => a + b.max(c).max(d),
                Primitives::EdgeEdge(_) => a.max(b) + c.max(d),
            };
            let is_near = pair.has_slipped || pair.distance_m < thickness + closing;
            is_near && !pair.primitives.vertices().iter().any(|v| self.tangled[*v])
        })
    }

    fn press(&self, x: &[V3], pair: &Pair) -> Option<Press> {
        let vertices = pair.primitives.vertices();
        let nearest = Nearest::of(x, pair.primitives);
        let (normal, height) = match nearest.normal {
            Some(normal) => {
                let normal = normal * pair.side(&normal, &nearest.gap);
                (normal, normal.dot(&nearest.gap))
            }
            None => nearest.gap.try_normalize(0.0).map(|normal| (normal, nearest.gap.norm()))?,
        };
        let depth = self.params.thickness_m - height;
        // Not a number where a triangle has collapsed.
        if depth.is_nan() || depth <= 0.0 {
            return None;
        }
        let mut press = Press { vertices, weights: nearest.weights, normal, depth, share: 1.0, fading: None };
        if let Primitives::EdgeEdge([a, b, c, d]) = pair.primitives {
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
        self.near(x).filter_map(|(_, pair)| self.press(x, pair))
    }

    /// Penalty stiffness of a contact, N/m: by the smallest rest area among its vertices.
    fn stiffness(&self, press: &Press) -> f64 {
        self.params.stiffness_n_m3 * press.vertices.iter().map(|&v| self.areas[v]).fold(f64::MAX, f64::min)
    }

    /// Contact energy, J.
    #[must_use]
    pub fn energy(&self, x: &[V3]) -> f64 {
        let pressed = |press: Press| 0.5 * self.stiffness(&press) * press.share * press.depth * press.depth;
        let released: f64 = self.releases.iter().map(|release| release.potential(x)).sum();
        self.presses(x).map(pressed).sum::<f64>() + self.params.release_n * released
    }

    /// Adds the contact forces and returns the stiffness.
    pub fn assemble(&self, x: &[V3], forces: &mut [V3]) -> Vec<Contact4> {
        let mut contacts = Vec::new();
        for press in self.presses(x) {
            let k = self.stiffness(&press);
            let Press { vertices, weights, normal, depth, share, fading } = press;
            for i in 0..4 {
                forces[vertices[i]] += normal * (share * k * depth * weights[i]);
            }
            if let Some(slopes) = fading {
                for (slope, ends) in slopes.iter().zip([[0, 1], [2, 3]]) {
                    let force = slope * (0.5 * k * depth * depth);
                    forces[vertices[ends[0]]] += force;
                    forces[vertices[ends[1]]] -= force;
                }
            }
            contacts.push(Contact4 { vertices, weights, normal, stiffness: share * k });
        }
        for release in &self.releases {
            release.add_force(self.params.release_n, forces);
            contacts.extend(release.couplings(self.params.release_n / RELEASE_STEP_M));
        }
        contacts
    }
}

/// Greatest distance of a vertex from where it was, m.
fn farthest(x: &[V3], from: &[V3]) -> f64 {
    x.iter().zip(from).map(|(p, q)| (p - q).norm_squared()).fold(0.0, f64::max).sqrt()
}

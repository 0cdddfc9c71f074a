//! Contact of cloth with the body and the floor: a penalty in a distance field, and Coulomb friction with anchors.
//!
//! A sample of the cloth is repelled where its distance `phi` in the field is less than the offset `d0`. The pressure
//! grows with the depth `d = d0 - phi`, softly at first (`penalty::push`). The force is the pressure times the rest area.
//! It is along the raw gradient of the field, so that it is exactly the derivative of the energy. Friction ties a
//! touching sample to an anchor by a spring of stiffness `k_t`. Beyond the Coulomb limit the anchor is dragged along.
//!
//! The samples are the vertices, and those points between them that [`BodyContact::hold_out`] has found inside. Where
//! the body is more curved than the mesh resolves, chords would cut into it. The force on such a point is distributed
//! to its vertices by its barycentric weights.

use std::collections::BTreeMap;

use nalgebra::Matrix3;

use super::friction::{Friction, Hold, across};
use super::intersections::edges_of;
use super::penalty::{ContactParams, Push};
use super::point::Point;
use super::skin::Skin;
use crate::cloth::part::Part;
use geom::{DistanceField, V3};
use linalg::Contact4;

geom::constants! {
    "contact.body",
    /// Contribution of the field's curvature to the stiffness below which it is left out, as a share of that along the
    /// gradient.
    const NEARLY_FLAT: f64 = 0.02;
    /// Greatest growth of an offset at once.
    const MOST_YIELD_M: f64 = 2e-3;
    /// Greatest error of the blurred field near cloth that touches.
    const FIELD_ERROR_M: f64 = 4e-3;
    /// Bound on the gradient of the field. A true distance field has the gradient 1; the rest is for rounding.
    const STEEPEST: f64 = 1.05;
}

/// Point of the cloth that is kept out of the body.
#[derive(Clone, Copy, Debug)]
struct Sample {
    point: Point,
    /// Distance in the field below which it is repelled.
    offset_m: f64,
    area_m2: f64,
}

#[derive(Clone, Copy, Debug)]
struct Seen {
    place: V3,
    /// Distance that the sample may move from `place` before it can touch.
    slack_m: f64,
}

impl Seen {
    const NEVER: Self = Self { place: V3::new(0.0, 0.0, 0.0), slack_m: f64::MIN };

    #[inline(always)]
    fn is_clear(&self, p: &V3) -> bool {
        self.slack_m > 0.0 && (p - self.place).norm_squared() < self.slack_m * self.slack_m
    }
}

#[derive(Clone, Copy, Debug)]
struct Touch {
    sample: usize,
    gradient: V3,
    push: Push,
}

pub struct BodyContact<'a> {
    field: &'a DistanceField,
    floor_m: Option<f64>,
    params: ContactParams,
    /// Vertices in their order, then points between them.
    samples: Vec<Sample>,
    vertices: usize,
    anchors: Vec<Option<V3>>,
    /// Stored apart from `samples`, since most samples need nothing else.
    seen: Vec<Seen>,
    /// Coefficients of the vertices; `None` while friction is off.
    friction: Option<Vec<f64>>,
    /// True if friction holds beyond the Coulomb limit.
    holds_fast: bool,
    touching: Vec<Touch>,
}

impl<'a> BodyContact<'a> {
    /// Contact without friction for vertices with the rest areas `areas`, m2.
    pub fn new(field: &'a DistanceField, params: ContactParams, areas: &[f64]) -> Self {
        let sample =
            |(v, area): (usize, &f64)| Sample { point: Point::vertex(v), offset_m: params.offset_m, area_m2: *area };
        Self {
            field,
            floor_m: None,
            params,
            samples: areas.iter().enumerate().map(sample).collect(),
            vertices: areas.len(),
            anchors: vec![None; areas.len()],
            seen: vec![Seen::NEVER; areas.len()],
            friction: None,
            holds_fast: false,
            touching: Vec::new(),
        }
    }

    pub fn part(&self, part: &Part) -> Self {
        let vertex = |(name, &v): (usize, &usize)| Sample { point: Point::vertex(name), ..self.samples[v] };
        let vertices = part.vertices.iter().enumerate().map(vertex);
        let (between, renamed): (Vec<usize>, Vec<Sample>) = self.between(part).unzip();
        let of_whole = || part.vertices.iter().chain(&between);
        Self {
            field: self.field,
            floor_m: self.floor_m,
            params: self.params,
            samples: vertices.chain(renamed).collect(),
            vertices: part.vertices.len(),
            anchors: of_whole().map(|&k| self.anchors[k]).collect(),
            seen: of_whole().map(|&k| self.seen[k]).collect(),
            friction: self.friction.as_ref().map(|friction| part.of(friction)),
            holds_fast: self.holds_fast,
            touching: Vec::new(),
        }
    }

    fn between(&self, part: &Part) -> impl Iterator<Item = (usize, Sample)> {
        let renamed = |point: &Point| Some(Point { vertices: part.names(point.vertices)?, ..*point });
        let between = self.samples.iter().enumerate().skip(self.vertices);
        between.filter_map(move |(k, sample)| Some((k, Sample { point: renamed(&sample.point)?, ..*sample })))
    }

    pub fn take_anchors(&mut self, part: &Part, contact: &BodyContact) {
        let between: Vec<usize> = self.between(part).map(|(k, _)| k).collect();
        for (&k, anchor) in part.vertices.iter().chain(&between).zip(&contact.anchors) {
            self.anchors[k] = *anchor;
        }
    }

    pub fn set_floor(&mut self, height_m: f64) {
        self.floor_m = Some(height_m);
        self.seen.fill(Seen::NEVER);
    }

    /// Distance to body and floor, m, and its gradient.
    #[inline(always)]
    fn distance(&self, p: &V3) -> (f64, V3) {
        let (distance, gradient) = self.field.value_and_gradient(p);
        match self.floor_m {
            Some(floor_m) if p.z - floor_m < distance => (p.z - floor_m, V3::z()),
            _ => (distance, gradient),
        }
    }

    /// Hessian of the distance, 1/m.
    fn curvature(&self, p: &V3) -> Matrix3<f64> {
        let is_on_floor = |floor_m| p.z - floor_m < self.field.value_and_gradient(p).0;
        if self.floor_m.is_some_and(is_on_floor) { Matrix3::zeros() } else { self.field.hessian(p) }
    }

    pub fn set_stiffness(&mut self, stiffness_n_m3: f64) {
        self.params.stiffness_n_m3 = stiffness_n_m3;
    }

    /// Greatest depth of a sample below its offset: the yield of the penalty.
    pub fn yields_m(&self, x: &[V3]) -> f64 {
        let depths = (0..self.samples.len()).filter_map(|k| self.depth(k, x));
        depths.map(|(depth, _)| depth).fold(0.0, f64::max)
    }

    /// Switches friction on, with a coefficient for each vertex. Anchors are set at the present position.
    pub fn set_friction(&mut self, coefficients: impl Iterator<Item = f64>) {
        self.friction = Some(coefficients.collect());
        self.anchors.fill(None);
    }

    /// Makes friction hold every sample at its anchor from now on, whatever the force. A sample that has slid is just
    /// at its Coulomb limit: it would be held in one direction only.
    pub fn hold_fast(&mut self) {
        self.holds_fast = true;
    }

    /// Number of samples in contact at the last [`BodyContact::assemble`].
    pub fn count(&self) -> usize {
        self.touching.len()
    }

    /// Adds edge midpoints and triangle centroids as samples, for coarse meshes, whose edges could pass through an arm
    /// unnoticed.
    pub fn with_points_between(mut self, triangles: &[[usize; 3]]) -> Self {
        let edges = edges_of(triangles);
        for point in Point::between(edges.pairs(), triangles) {
            self.push(point, self.params.offset_m);
        }
        self
    }

    fn push(&mut self, point: Point, offset_m: f64) {
        let area_m2 = (0..3).map(|k| self.samples[point.vertices[k]].area_m2 * point.weights[k]).sum();
        self.samples.push(Sample { point, offset_m, area_m2 });
        self.anchors.push(None);
        self.seen.push(Seen::NEVER);
    }

    /// Tests vertices, midpoints of `edges` and centroids of `triangles` against the exact surface. Those inside are
    /// held [`ContactParams::clearance_m`] off it from now on. Returns the greatest depth, m (0 where there is none).
    ///
    /// The offset of such a point is corrected for the blur of the field, which cuts off sharp convex parts of the
    /// body. Where the cloth `is_at_rest` and a point held before is still inside, the penalty yields to the load, and
    /// the offset grows by the depth (an augmented penalty).
    pub fn hold_out(
        &mut self,
        skin: &Skin,
        (edges, triangles): (&[[usize; 2]], &[[usize; 3]]),
        x: &[V3],
        is_at_rest: bool,
    ) -> f64 {
        let between = self.samples.iter().enumerate().skip(self.vertices);
        let mut known: BTreeMap<[usize; 3], usize> = between.map(|(k, sample)| (sample.point.vertices, k)).collect();
        let mut deepest = 0.0_f64;
        let points = (0..self.vertices).map(Point::vertex);
        for point in points.chain(Point::between(edges, triangles)) {
            let p = point.at(x);
            let (distance, _) = self.field.value_and_gradient(&p);
            if distance > self.params.offset_m + FIELD_ERROR_M {
                continue;
            }
            let Some(depth) = skin.depth(&p, distance) else { continue };
            deepest = deepest.max(depth);
            // The vertices are the first samples, in their order.
            let [first, _, last] = point.vertices;
            let held_as = if first == last { Some(first) } else { known.get(&point.vertices).copied() };
            let is_held = held_as.is_some();
            let index = held_as.unwrap_or_else(|| {
                known.insert(point.vertices, self.samples.len());
                self.push(point, f64::MIN);
                self.samples.len() - 1
            });
            self.seen[index] = Seen::NEVER;
            let held = &mut self.samples[index];
            held.offset_m = if is_held && is_at_rest && distance < held.offset_m {
                held.offset_m + depth.min(MOST_YIELD_M)
            } else {
                held.offset_m.max(distance + depth + self.params.clearance_m)
            };
        }
        deepest
    }

    #[inline(always)]
    fn place(&self, k: usize, x: &[V3]) -> V3 {
        if k < self.vertices { x[k] } else { self.samples[k].point.at(x) }
    }

    /// Depth below the offset, m, and the gradient of the distance; `None` where the sample does not touch.
    #[inline(always)]
    fn depth(&self, k: usize, x: &[V3]) -> Option<(f64, V3)> {
        let p = self.place(k, x);
        if self.seen[k].is_clear(&p) {
            return None;
        }
        let (distance, gradient) = self.distance(&p);
        Some((self.samples[k].offset_m - distance, gradient)).filter(|(depth, _)| *depth > 0.0)
    }

    /// Contact and friction energy, J. Friction uses the normal forces and anchors of the current step.
    pub fn energy(&self, x: &[V3]) -> f64 {
        let mut energy = 0.0;
        for k in 0..self.samples.len() {
            if let Some((depth, _)) = self.depth(k, x) {
                energy += self.samples[k].area_m2 * self.params.push(depth).energy_n_m;
            }
        }
        energy + self.touching.iter().filter_map(|t| self.friction_at(t, x)).map(|f| f.energy_j).sum::<f64>()
    }

    /// Adds the contact and friction forces, N. Friction uses the normal forces and anchors of the current step.
    pub fn add_forces(&self, x: &[V3], forces: &mut [V3]) {
        for k in 0..self.samples.len() {
            if let Some((depth, gradient)) = self.depth(k, x) {
                let sample = &self.samples[k];
                let force_n = sample.area_m2 * self.params.push(depth).pressure_n_m2;
                sample.point.add_force(&(gradient * force_n), forces);
            }
        }
        self.add_friction(x, forces);
    }

    fn add_friction(&self, x: &[V3], forces: &mut [V3]) {
        for touch in &self.touching {
            if let Some(f) = self.friction_at(touch, x) {
                self.samples[touch.sample].point.add_force(&f.force, forces);
            }
        }
    }

    /// Finds the touching samples. Adds their forces (N), and the stiffness of vertices (N/m) to `diagonal`. Returns
    /// the energy (J) and the stiffness of points between vertices.
    pub fn assemble(&mut self, x: &[V3], forces: &mut [V3], diagonal: &mut [Matrix3<f64>]) -> (f64, Vec<Contact4>) {
        self.find_touching(x);
        let (mut pushed, mut rubbed) = (0.0, 0.0);
        let mut couplings = Vec::new();
        for touch in &self.touching {
            let sample = &self.samples[touch.sample];
            let friction = self.friction_at(touch, x);
            sample.point.add_force(&(touch.gradient * (sample.area_m2 * touch.push.pressure_n_m2)), forces);
            pushed += sample.area_m2 * touch.push.energy_n_m;
            if let Some(f) = &friction {
                sample.point.add_force(&f.force, forces);
                rubbed += f.energy_j;
            }
            let stiffness = self.stiffness_at(touch, &sample.point.at(x), friction.map_or(0.0, |f| f.stiffness_n_m));
            if touch.sample < self.vertices {
                diagonal[touch.sample] += stiffness;
            } else {
                let eigen = stiffness.symmetric_eigen();
                let directions = (0..3).map(|k| (eigen.eigenvectors.column(k).into_owned(), eigen.eigenvalues[k]));
                couplings.extend(directions.filter(|(_, k)| *k > 0.0).map(|(n, k)| sample.point.coupling(n, k)));
            }
        }
        (pushed + rubbed, couplings)
    }

    /// Hessian of a touching sample's energy without its negative eigenvalues, and `sideways` the tangential stiffness
    /// of friction.
    ///
    /// The curvature of the field matters where skin faces skin. In an armpit the gradient is small and turns within a
    /// few millimetres, and cloth between the two sides is held by that alone.
    fn stiffness_at(&self, touch: &Touch, p: &V3, sideways: f64) -> Matrix3<f64> {
        let upright = touch.gradient * touch.gradient.transpose() * touch.push.stiffness_n_m3;
        let bent = self.curvature(p) * touch.push.pressure_n_m2;
        let stiffness = if bent.norm() > NEARLY_FLAT * upright.norm() {
            let mut eigen = (upright - bent).symmetric_eigen();
            eigen.eigenvalues.apply(|value| *value = value.max(0.0));
            eigen.recompose()
        } else {
            upright
        };
        let normal = touch.gradient.try_normalize(0.0).unwrap_or_default();
        let friction = (Matrix3::identity() - normal * normal.transpose()) * sideways;
        stiffness * self.samples[touch.sample].area_m2 + friction
    }

    /// Adds the forces of the samples that touch at `x`, the end of a step, and the stiffness of new and deeper
    /// contacts beyond that of [`BodyContact::assemble`]: of vertices to `diagonal`, of points between them as return
    /// value.
    pub fn meet(&self, x: &[V3], forces: &mut [V3], diagonal: &mut [Matrix3<f64>]) -> Vec<Contact4> {
        let mut has = vec![0.0; self.samples.len()];
        for touch in &self.touching {
            has[touch.sample] = touch.push.stiffness_n_m3;
        }
        let mut couplings = Vec::new();
        for (k, sample) in self.samples.iter().enumerate() {
            let Some((depth, gradient)) = self.depth(k, x) else { continue };
            let push = self.params.push(depth);
            sample.point.add_force(&(gradient * (sample.area_m2 * push.pressure_n_m2)), forces);
            let lacks = sample.area_m2 * (push.stiffness_n_m3 - has[k]).max(0.0);
            if k < self.vertices {
                diagonal[k] += gradient * gradient.transpose() * lacks;
            } else {
                couplings.push(sample.point.coupling(gradient, lacks));
            }
        }
        self.add_friction(x, forces);
        couplings
    }

    /// Sets anchors for new contacts.
    fn find_touching(&mut self, x: &[V3]) {
        self.touching.clear();
        for k in 0..self.samples.len() {
            let p = self.place(k, x);
            if self.seen[k].is_clear(&p) {
                self.anchors[k] = None;
                continue;
            }
            let (distance, gradient) = self.distance(&p);
            let depth = self.samples[k].offset_m - distance;
            self.seen[k] = Seen { place: p, slack_m: -depth / STEEPEST };
            if depth <= 0.0 {
                self.anchors[k] = None;
                continue;
            }
            self.touching.push(Touch { sample: k, gradient, push: self.params.push(depth) });
            if self.friction.is_some() {
                self.anchors[k].get_or_insert(p);
            }
        }
    }

    /// `None` without friction or anchor.
    fn friction_at(&self, touch: &Touch, x: &[V3]) -> Option<Friction> {
        let sample = &self.samples[touch.sample];
        let coefficient = self.friction.as_ref()?[sample.point.vertices[0]];
        let limit = coefficient * sample.area_m2 * touch.push.pressure_n_m2 * touch.gradient.norm();
        let anchor = self.anchors[touch.sample]?;
        let normal = touch.gradient.try_normalize(0.0)?;
        let slip = across(&(sample.point.at(x) - anchor), &normal);
        let stiffest = sample.area_m2 * self.params.stiffness_n_m3 * self.params.tangential_share;
        let stiffness_n_m = stiffest.min(limit / self.params.slip_m);
        Some(Hold { limit_n: limit, stiffness_n_m, is_fast: self.holds_fast }.at(slip))
    }

    /// Updates the anchors after a step to `x`: those of sliding samples are dragged along, and all are moved along the
    /// normal to the level of their samples. One left behind along the normal would pull sideways as soon as the normal
    /// turns. In the crease of an armpit it turns by 12 degrees within 0.05 mm, and vertices would oscillate there for
    /// ever.
    pub fn drag_anchors(&mut self, x: &[V3]) {
        for k in 0..self.touching.len() {
            let touch = self.touching[k];
            let held = self.friction_at(&touch, x).map(|f| f.held);
            let p = self.place(touch.sample, x);
            if let (Some(anchor), Some(held)) = (&mut self.anchors[touch.sample], held) {
                *anchor = p - held;
            }
        }
    }
}

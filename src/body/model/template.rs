//! Template skin of a sex: polygonised once on an average figure, then carried to any other.
//!
//! Every vertex is bound to the nearby body parts by coordinates in them: position between two sections, direction,
//! distance from the outline. On another figure the same coordinates give another position. Where parts meet, the
//! positions by all of them are blended. All bodies of a sex thus have the same topology and vertex order.

use crate::people::profile::Profile;
use crate::shape::bend::Bend;
use crate::shape::field::{NEAR, Parts};
use crate::shape::figure::Figure;
use crate::shape::loft::{Loft, Part, Place, Ring, column};
use crate::shape::surface::Skin;
use crate::{Dimension, Measurements, Sex};
use geom::contour::Grid;
use geom::{TriMesh, V2, V3, smooth_step};
use std::sync::LazyLock;

/// Stature (m) and body mass index (kg/m2) of the template's figure: in the middle of the adults it is carried to.
const FIGURE: [f64; 2] = [1.70, 24.0];

/// Grid spacing / stature: of the body, and of the thinner arms (along x) and feet (along z). Judgement.
const SPACING: f64 = 0.0095;
const FINE_SPACING: f64 = 0.0070;

/// Height of the ankles / stature, below which the grid is fine. Judgement.
const ANKLE: f64 = 0.045;

/// Difference between the distances from two parts up to which a vertex is bound to both, m. Judgement.
const MIXING: f64 = 0.08;

/// Parts whose skin bends: trunk and leg. Arms move with the shoulder joint.
const BENT: [usize; 2] = [0, 3];

/// Number of smoothing passes where trunk and limbs meet, and step of a pass. Judgement.
const EVENING_PASSES: usize = 30;
const EVENING_STEP: f64 = 0.6;

/// Distances from floor and median plane below which vertices belong to the sole or that plane, m: below grid spacing.
const SOLE: f64 = 1.5e-3;
const MEDIAN: f64 = 1e-3;

/// Greatest difference in height between a vertex and its mirror image, m: rounding, amplified by the fairing.
const PAIRED: f64 = 5e-3;

#[derive(Clone, Copy, Debug)]
struct Image {
    vertex: usize,
    is_mirrored: bool,
}

#[derive(Clone, Debug)]
struct Tie {
    /// Index of the part, and true for its mirror image on the left.
    part: usize,
    left: bool,
    weight: f64,
    /// Index of the tabulated section below, and share of the way to the next section.
    ring: usize,
    share: f64,
    /// Direction in the section, as a vector and as a number of tabulated directions.
    direction: V2,
    column: f64,
    /// Distance from the outline, and along the axis past the end of the part, m.
    off: f64,
    past: f64,
}

#[derive(Clone, Debug)]
struct Vertex {
    ties: Vec<Tie>,
    median: bool,
    sole: bool,
    /// Position on the figure of the template, m.
    home: V3,
    /// Weight of the smoothing of the displacement: 1 where trunk and limb meet, 0 far from there.
    evened: f64,
    around: Vec<Image>,
}

#[derive(Clone, Debug)]
pub(super) struct Template {
    stature: f64,
    parts: [Part; 5],
    rings: [Vec<Ring>; 5],
    vertices: Vec<Vertex>,
    images: Vec<Image>,
    triangles: Vec<[usize; 3]>,
}

impl Template {
    /// Makes it on first use.
    pub fn of(sex: Sex) -> &'static Self {
        static MALE: LazyLock<Template> = LazyLock::new(|| Template::new(Sex::Male));
        static FEMALE: LazyLock<Template> = LazyLock::new(|| Template::new(Sex::Female));
        match sex {
            Sex::Male => &MALE,
            Sex::Female => &FEMALE,
        }
    }

    pub fn person(sex: Sex) -> Profile {
        let [stature, mass_index] = FIGURE;
        let weight_kg = Some(mass_index * stature * stature);
        let known = Measurements::of(sex, stature).with(Dimension::Weight, weight_kg);
        Profile::new(&known).expect("an ordinary person is in range")
    }

    fn new(sex: Sex) -> Self {
        let profile = Self::person(sex);
        let figure = Figure::new(&profile);
        let stature = figure.stature();
        let fields = Parts::new(figure.parts(), figure.hand_start());
        let mesh = Skin::new(&fields, &grid(&figure)).triangles();
        let right: Vec<usize> = (0..mesh.positions.len()).filter(|&i| mesh.positions[i].x > -MEDIAN).collect();
        let mut vertices: Vec<Vertex> = right.iter().map(|&i| Vertex::new(&fields, mesh.positions[i])).collect();
        let images = images(&mesh.positions, &right);
        for [a, b] in mesh.edges() {
            for (from, to) in [(a, b), (b, a)] {
                if let Image { vertex, is_mirrored: false } = images[from] {
                    vertices[vertex].around.push(images[to]);
                }
            }
        }
        let rings = fields.lofts().map(|loft| loft.rings().to_vec());
        Self { stature, parts: figure.parts(), rings, vertices, images, triangles: mesh.triangles }
    }

    pub fn is_skin_of(&self, mesh: &TriMesh) -> bool {
        self.triangles == mesh.triangles
    }

    /// Carries the skin to a figure, stretched in height so that it stands on the floor and has the requested stature.
    pub fn dress(&self, figure: &Figure) -> TriMesh {
        let parts = figure.parts();
        let rings: [Vec<Ring>; 5] = std::array::from_fn(|i| parts[i].like(&self.parts[i], &self.rings[i]));
        let scale = figure.stature() / self.stature;
        let bend = Bend::of(figure);
        let weighted_place = |tie: &Tie| {
            let (low, high) = (&rings[tie.part][tie.ring], &rings[tie.part][tie.ring + 1]);
            let mix = |a: f64, b: f64| a + (b - a) * tie.share;
            let radius = mix(low.radius(tie.column), high.radius(tie.column)) + tie.off * scale;
            let local = low.centre.lerp(&high.centre, tie.share) + tie.direction * radius;
            let point = parts[tie.part].lift(local, mix(low.at, high.at) + tie.past * scale);
            let point = match &bend {
                Some(bend) if BENT.contains(&tie.part) => bend.moved(point),
                _ => point,
            };
            let side = if tie.left { -1.0 } else { 1.0 };
            V3::new(side * point.x, point.y, point.z) * tie.weight
        };
        let place = |vertex: &Vertex| {
            let p: V3 = vertex.ties.iter().map(weighted_place).sum();
            V3::new(if vertex.median { 0.0 } else { p.x }, p.y, p.z)
        };
        let mut right = self.evened(self.vertices.iter().map(place).collect(), scale);
        for (p, vertex) in right.iter_mut().zip(&self.vertices) {
            p.z = if vertex.sole { 0.0 } else { p.z.max(0.0) };
        }
        let crown = right.iter().map(|p| p.z).fold(0.0, f64::max);
        let stretch = figure.stature() / crown;
        let image = |&Image { vertex, is_mirrored }: &Image| {
            let p: V3 = right[vertex];
            let raised = bend.as_ref().filter(|_| !is_mirrored).map_or(p.z, |bend| p.z + bend.raised(p));
            V3::new(if is_mirrored { -p.x } else { p.x }, p.y, raised * stretch)
        };
        TriMesh { positions: self.images.iter().map(image).collect(), triangles: self.triangles.clone() }
    }
}

impl Template {
    /// Smooths the displacements where trunk and limbs meet, because both displace neighbouring vertices differently.
    fn evened(&self, mut right: Vec<V3>, scale: f64) -> Vec<V3> {
        let mut moved: Vec<V3> = right.iter().zip(&self.vertices).map(|(p, vertex)| p - vertex.home * scale).collect();
        let joints: Vec<usize> = (0..right.len()).filter(|&i| self.vertices[i].evened > 0.0).collect();
        for _ in 0..EVENING_PASSES {
            for &i in &joints {
                let vertex = &self.vertices[i];
                let step = |&Image { vertex, is_mirrored }: &Image| {
                    let m: V3 = moved[vertex];
                    if is_mirrored { V3::new(-m.x, m.y, m.z) } else { m }
                };
                let mean = vertex.around.iter().map(step).sum::<V3>() / vertex.around.len() as f64;
                moved[i] = moved[i].lerp(&mean, EVENING_STEP * vertex.evened);
            }
        }
        for &i in &joints {
            right[i] = self.vertices[i].home * scale + moved[i];
        }
        right
    }
}

impl Vertex {
    fn new(fields: &Parts, point: V3) -> Self {
        let left = V3::new(-point.x, point.y, point.z);
        let lofts = fields.lofts();
        let candidates = (0..lofts.len()).map(|part| (part, false)).chain([(3, true), (4, true)]);
        let distance = |&(part, mirrored): &(usize, bool)| {
            lofts[part].sample(if mirrored { left } else { point }, NEAR).distance.max(0.0)
        };
        let distances: Vec<((usize, bool), f64)> = candidates.map(|c| (c, distance(&c))).collect();
        let least = distances.iter().map(|(_, distance)| *distance).fold(f64::INFINITY, f64::min);
        let mut ties: Vec<Tie> = distances
            .into_iter()
            .filter_map(|((part, mirrored), distance)| {
                let share = 1.0 - (distance - least) / MIXING;
                let weight = smooth_step(share) * lofts[part].own(point);
                let point = if mirrored { left } else { point };
                (share > 0.0).then(|| Tie::new(lofts[part], part, mirrored, weight, point))
            })
            .collect();
        let sum: f64 = ties.iter().map(|tie| tie.weight).sum();
        for tie in &mut ties {
            tie.weight /= sum;
        }
        let evened = fields.fairness(point);
        let (median, sole) = (point.x.abs() < MEDIAN, point.z < SOLE);
        Self { ties, median, sole, home: point, evened, around: Vec::new() }
    }
}

impl Tie {
    fn new(loft: &Loft, part: usize, left: bool, weight: f64, point: V3) -> Self {
        let Place { ring: place, past, local } = loft.locate(point);
        let rings = loft.rings();
        let ring = (place as usize).min(rings.len() - 2);
        let share = place - ring as f64;
        let (low, high) = (&rings[ring], &rings[ring + 1]);
        let from_centre = local - low.centre.lerp(&high.centre, share);
        let column = column(from_centre);
        let radius = low.radius(column) + (high.radius(column) - low.radius(column)) * share;
        let direction = from_centre.try_normalize(1e-9).unwrap_or_else(V2::x);
        Self { part, left, weight, ring, share, direction, column, off: from_centre.norm() - radius, past }
    }
}

fn images(positions: &[V3], right: &[usize]) -> Vec<Image> {
    let mut by_height: Vec<usize> = (0..right.len()).collect();
    by_height.sort_by(|&a, &b| positions[right[a]].z.total_cmp(&positions[right[b]].z));
    let mut images: Vec<Option<Image>> = vec![None; positions.len()];
    for (vertex, &i) in right.iter().enumerate() {
        images[i] = Some(Image { vertex, is_mirrored: false });
    }
    let nearest = |p: V3| {
        let mirrored = V3::new(-p.x, p.y, p.z);
        let from = by_height.partition_point(|&i| positions[right[i]].z < p.z - PAIRED);
        let level = by_height[from..].iter().take_while(|&&i| positions[right[i]].z < p.z + PAIRED);
        let off = |&&i: &&usize| (positions[right[i]] - mirrored).norm_squared();
        *level.min_by(|a, b| off(a).total_cmp(&off(b))).expect("the grid is its own mirror image, and so is the skin")
    };
    let image = |i: usize| images[i].unwrap_or_else(|| Image { vertex: nearest(positions[i]), is_mirrored: true });
    (0..positions.len()).map(image).collect()
}

/// Grid for the skin of a figure, finer beyond the shoulders and below the ankles.
fn grid(figure: &Figure) -> Grid {
    let stature = figure.stature();
    let walk = |from: f64, to: f64, spacing: &dyn Fn(f64) -> f64| {
        let mut nodes = vec![from];
        let mut at = from;
        while at < to {
            at += spacing(at) * stature;
            nodes.push(at);
        }
        nodes
    };
    let (low, high) = figure.extent();
    let sideways = |x: f64| if x > figure.shoulder_x() { FINE_SPACING } else { SPACING };
    let upward = |z: f64| if z < ANKLE * stature { FINE_SPACING } else { SPACING };
    let right = walk(SPACING * stature / 2.0, high.x, &sideways);
    let x: Vec<f64> = right.iter().rev().map(|x| -x).chain(right.iter().copied()).collect();
    let y = walk(low.y, high.y, &|_| SPACING);
    let z = walk(low.z, high.z, &upward);
    Grid { axes: [x, y, z] }
}

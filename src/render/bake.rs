//! Light that does not depend on the camera: how much of the sky each vertex sees (ambient occlusion), and the shadow
//! where the subject stands on the floor, both from shadow maps all round the sphere.

use super::camera::Projection;
use super::raster::cover;
use super::scene::Scene;
use nalgebra::Vector3;

/// Pairs of opposite directions from which the scene is looked at.
const PAIRS: usize = 32;
/// Samples along a side of each map.
const MAP: usize = 400;
/// Cells along a side of the floor.
const CELLS: usize = 96;

/// Light on the floor under the subject.
#[derive(Default)]
pub(super) struct Floor {
    /// Height of the floor, m.
    pub z: f32,
    low: [f32; 2],
    cell: f32,
    openness: Vec<f32>,
}

impl Floor {
    fn new(z: f32, centre: Vector3<f32>, radius: f32) -> Self {
        let cell = 2.0 * radius / CELLS as f32;
        Self { z, low: [centre.x - radius, centre.y - radius], cell, openness: vec![0.0; CELLS * CELLS] }
    }

    /// Evens out the steps that single directions leave, and lets the shadow end before the border does.
    fn soften(&mut self) {
        for _ in 0..8 {
            let before = self.openness.clone();
            for j in 1..CELLS - 1 {
                for i in 1..CELLS - 1 {
                    let row = |j: usize| before[j * CELLS + i - 1] + before[j * CELLS + i] + before[j * CELLS + i + 1];
                    self.openness[j * CELLS + i] = (row(j - 1) + row(j) + row(j + 1)) / 9.0;
                }
            }
        }
        let from_centre = |k: usize| (2.0 * k as f32 + 1.0) / CELLS as f32 - 1.0;
        for (k, open) in self.openness.iter_mut().enumerate() {
            let r = from_centre(k % CELLS).hypot(from_centre(k / CELLS));
            let fade = ((1.0 - r) / 0.6).clamp(0.0, 1.0);
            *open = 1.0 - (1.0 - *open) * fade * fade * (3.0 - 2.0 * fade);
        }
    }

    fn points(&self) -> Vec<Vector3<f32>> {
        let at = |i: usize, axis: usize| self.low[axis] + (i as f32 + 0.5) * self.cell;
        (0..CELLS * CELLS).map(|k| Vector3::new(at(k % CELLS, 0), at(k / CELLS, 1), self.z)).collect()
    }

    /// Share of the sky seen from a point of the floor, blended between cells; 1 far away.
    pub fn openness(&self, x: f32, y: f32) -> f32 {
        if self.openness.is_empty() {
            return 1.0;
        }
        let place = [(x - self.low[0]) / self.cell - 0.5, (y - self.low[1]) / self.cell - 0.5];
        if place.iter().any(|&p| p < 0.0 || p >= (CELLS - 1) as f32) {
            return 1.0;
        }
        let (i, j) = (place[0] as usize, place[1] as usize);
        let (f, g) = (place[0] - i as f32, place[1] - j as f32);
        let at = |i: usize, j: usize| self.openness[j * CELLS + i];
        (1.0 - g) * ((1.0 - f) * at(i, j) + f * at(i + 1, j)) + g * ((1.0 - f) * at(i, j + 1) + f * at(i + 1, j + 1))
    }
}

/// Depth of the first and the last surface along one direction.
struct TwoSided {
    projection: Projection,
    near: Vec<f32>,
    far: Vec<f32>,
}

impl TwoSided {
    fn new(scene: &Scene, towards: Vector3<f32>) -> Self {
        let projection = Projection::of_light(towards, scene.centre, scene.radius * 1.02, MAP);
        let mut near = vec![f32::INFINITY; MAP * MAP];
        let mut far = vec![f32::NEG_INFINITY; MAP * MAP];
        let projected: Vec<[f32; 3]> = scene.positions.iter().map(|p| projection.project(p)).collect();
        for triangle in 0..scene.triangles.len() {
            // Skin gives way here as it does in the picture: cloth that has sunk into it a little is not in its shade.
            let recede = scene.recede(triangle);
            cover(scene.corners(triangle, &projected), MAP, MAP, |sample, depth| {
                near[sample] = near[sample].min(depth + recede);
                far[sample] = far[sample].max(depth - recede);
            });
        }
        Self { projection, near, far }
    }

    /// Whether a point is open to the direction (`true`, towards the light) or to its opposite.
    fn open(&self, point: &Vector3<f32>, along: bool, bias: f32) -> bool {
        let [x, y, depth] = self.projection.project(point);
        if x < 0.0 || y < 0.0 || x >= MAP as f32 || y >= MAP as f32 {
            return true;
        }
        let sample = y as usize * MAP + x as usize;
        if along { depth <= self.near[sample] + bias } else { depth >= self.far[sample] - bias }
    }
}

/// Unit vectors spread evenly over the upper half sphere (a Fibonacci spiral).
fn directions() -> impl Iterator<Item = Vector3<f32>> {
    let golden = std::f32::consts::PI * (3.0 - 5.0_f32.sqrt());
    (0..PAIRS).map(move |i| {
        let z = (i as f32 + 0.5) / PAIRS as f32;
        let (sin, cos) = (golden * i as f32).sin_cos();
        let r = (1.0 - z * z).sqrt();
        Vector3::new(r * cos, r * sin, z)
    })
}

/// Fills in `scene.openness` and `scene.floor`.
pub(super) fn light(scene: &mut Scene, floor_z: f32) {
    // Points stand off their surface by a little more than a map sample, so that a surface does not shadow itself.
    let sample = 2.0 * scene.radius / MAP as f32;
    let (stand_off, bias) = (1.2 * sample, 1.2 * sample);
    let mut floor = Floor::new(floor_z, scene.centre, scene.radius * 0.75);
    let floor_points = floor.points();
    let mut seen = vec![[0.0_f32; 2]; scene.positions.len()];
    let mut whole = vec![[0.0_f32; 2]; scene.positions.len()];
    let mut floor_whole = 0.0;
    for towards in directions() {
        let map = TwoSided::new(scene, towards);
        for (vertex, (position, normal)) in scene.positions.iter().zip(&scene.normals).enumerate() {
            let cosine = normal.dot(&towards);
            // The direction lights the front where the normal leans to it and the back otherwise; its opposite the reverse.
            for along in [true, false] {
                let side = usize::from((cosine > 0.0) != along);
                let outward = if side == 0 { *normal } else { -normal };
                whole[vertex][side] += cosine.abs();
                if map.open(&(position + outward * stand_off), along, bias) {
                    seen[vertex][side] += cosine.abs();
                }
            }
        }
        // High light counts more: the shadow gathers where the subject stands.
        let weight = towards.z.powi(2);
        floor_whole += weight;
        for (open, point) in floor.openness.iter_mut().zip(&floor_points) {
            *open += if map.open(point, true, bias) { weight } else { 0.0 };
        }
    }
    floor.openness.iter_mut().for_each(|open| *open /= floor_whole);
    floor.soften();
    let share = |seen: f32, whole: f32| if whole > 0.0 { seen / whole } else { 1.0 };
    scene.openness = seen.iter().zip(&whole).map(|(s, w)| [share(s[0], w[0]), share(s[1], w[1])]).collect();
    scene.floor = floor;
}

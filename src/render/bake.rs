//! Light that does not depend on the camera, computed once for a scene: ambient occlusion of each vertex, and the
//! shadow on the floor. Both come from shadow maps in directions all around.

use super::camera::Projection;
use super::floor::Floor;
use super::raster::cover;
use super::scene::Scene;
use nalgebra::Vector3;

/// Number of pairs of opposite directions.
const PAIRS: usize = 32;
/// Samples along a side of each shadow map.
const MAP: usize = 400;

/// Shadow map of a direction and its opposite: depths of the first and the last surface along the direction.
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
            // Skin recedes here as in the picture, so that it does not shade cloth that has sunk into it a little.
            let recede = scene.recede(triangle);
            cover(scene.corners(triangle, &projected), MAP, MAP, |sample, depth| {
                near[sample] = near[sample].min(depth + recede);
                far[sample] = far[sample].max(depth - recede);
            });
        }
        Self { projection, near, far }
    }

    /// True if a point is lit from the direction (`along`) or from its opposite (not `along`).
    fn open(&self, point: &Vector3<f32>, along: bool, bias: f32) -> bool {
        let [x, y, depth] = self.projection.project(point);
        if x < 0.0 || y < 0.0 || x >= MAP as f32 || y >= MAP as f32 {
            return true;
        }
        let sample = y as usize * MAP + x as usize;
        if along { depth <= self.near[sample] + bias } else { depth >= self.far[sample] - bias }
    }
}

/// Unit vectors, evenly distributed over the upper hemisphere (a Fibonacci spiral).
fn directions() -> impl Iterator<Item = Vector3<f32>> {
    let golden = std::f32::consts::PI * (3.0 - 5.0_f32.sqrt());
    (0..PAIRS).map(move |i| {
        let z = (i as f32 + 0.5) / PAIRS as f32;
        let (sin, cos) = (golden * i as f32).sin_cos();
        let r = (1.0 - z * z).sqrt();
        Vector3::new(r * cos, r * sin, z)
    })
}

impl Scene {
    /// Computes the ambient occlusion of the vertices and the shadow on the floor at the height `floor_z`.
    pub(super) fn bake(&mut self, floor_z: f32) {
        // Points are moved off their surface by a little more than a map sample, so that a surface does not shadow
        // itself.
        let sample = 2.0 * self.radius / MAP as f32;
        let (stand_off, bias) = (1.2 * sample, 1.2 * sample);
        let mut floor = Floor::new(floor_z, self.centre, self.radius * 0.75);
        let floor_points = floor.points();
        let mut seen = vec![[0.0_f32; 2]; self.positions.len()];
        let mut whole = vec![[0.0_f32; 2]; self.positions.len()];
        let mut floor_whole = 0.0;
        for towards in directions() {
            let map = TwoSided::new(self, towards);
            for (vertex, (position, normal)) in self.positions.iter().zip(&self.normals).enumerate() {
                let cosine = normal.dot(&towards);
                // The direction lights the front side of a surface whose normal points towards it, else the back side;
                // its opposite lights the other side.
                for along in [true, false] {
                    let side = usize::from((cosine > 0.0) != along);
                    let outward = if side == 0 { *normal } else { -normal };
                    whole[vertex][side] += cosine.abs();
                    if map.open(&(position + outward * stand_off), along, bias) {
                        seen[vertex][side] += cosine.abs();
                    }
                }
            }
            // Steep light has more weight, so that the shadow concentrates where the subject stands.
            let weight = towards.z.powi(2);
            floor_whole += weight;
            for (open, point) in floor.openness.iter_mut().zip(&floor_points) {
                *open += if map.open(point, true, bias) { weight } else { 0.0 };
            }
        }
        floor.openness.iter_mut().for_each(|open| *open /= floor_whole);
        floor.soften();
        let share = |seen: f32, whole: f32| if whole > 0.0 { seen / whole } else { 1.0 };
        self.openness = seen.iter().zip(&whole).map(|(s, w)| [share(s[0], w[0]), share(s[1], w[1])]).collect();
        self.floor = floor;
    }
}

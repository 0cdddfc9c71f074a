//! Orthographic cameras. All cameras of one frame share their scale.

use geom::{TriMesh, V3};
use nalgebra::Vector3;

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum View {
    /// From `+y`; the subject's right is at the left of the picture.
    Front,
    /// From `+x`, the subject's right side; the subject faces the right of the picture.
    Side,
    /// From `-y`, behind the subject; the subject's right is at the right of the picture.
    Back,
    Quarter,
}

impl View {
    pub const ALL: [Self; 4] = [Self::Front, Self::Side, Self::Back, Self::Quarter];

    /// Name under pictures and in file names.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Front => "front",
            Self::Side => "side",
            Self::Back => "back",
            Self::Quarter => "quarter",
        }
    }

    /// Angle about `z` from the front towards the subject's right.
    pub fn azimuth_deg(self) -> f64 {
        match self {
            Self::Front => 0.0,
            Self::Quarter => 38.0,
            Self::Side => 90.0,
            Self::Back => 180.0,
        }
    }
}

/// Common frame of pictures that are compared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// World point at the picture's centre, m.
    pub centre: V3,
    /// World length from top to bottom of the picture.
    pub height_m: f64,
}

impl Frame {
    /// Smallest frame, with a margin, that contains all meshes in every view. `aspect` is the pictures' width divided
    /// by their height. Given every subject of a study it makes one scale for all; given a garment alone, a close view.
    /// Without vertices it shows the surroundings of the origin.
    pub fn enclosing<'a>(meshes: impl IntoIterator<Item = &'a TriMesh>, aspect: f64) -> Self {
        let meshes: Vec<&TriMesh> = meshes.into_iter().collect();
        let bounds = meshes.iter().filter_map(|m| m.bounds()).reduce(|a, b| (a.0.inf(&b.0), a.1.sup(&b.1)));
        let Some((low, high)) = bounds else { return Self { centre: V3::new(0.0, 0.0, 1.0), height_m: 2.0 } };
        let mut frame = Self { centre: (low + high) / 2.0, height_m: 1e-3 };
        for view in View::ALL {
            let [right, up, _] = Camera::new(view, frame).axes();
            for point in meshes.iter().flat_map(|m| &m.positions) {
                let d = point - frame.centre;
                frame.height_m = frame.height_m.max(2.0 * d.dot(&up).abs()).max(2.0 * d.dot(&right).abs() / aspect);
            }
        }
        Self { height_m: 1.06 * frame.height_m, ..frame }
    }
}

/// An orthographic camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    pub frame: Frame,
    /// Angle about `z` from the front towards the subject's right.
    pub azimuth_deg: f64,
    /// Angle above the horizon.
    pub elevation_deg: f64,
}

impl Camera {
    /// Camera of a view, a little above the horizon so that the floor shows.
    pub fn new(view: View, frame: Frame) -> Self {
        Self { frame, azimuth_deg: view.azimuth_deg(), elevation_deg: 5.0 }
    }

    /// Unit vectors of the picture in world coordinates: to the right, up, and towards the viewer.
    pub fn axes(&self) -> [V3; 3] {
        let (sin_a, cos_a) = self.azimuth_deg.to_radians().sin_cos();
        let (sin_e, cos_e) = self.elevation_deg.to_radians().sin_cos();
        let viewer = V3::new(sin_a * cos_e, cos_a * cos_e, sin_e);
        let right = V3::new(-cos_a, sin_a, 0.0);
        [right, viewer.cross(&right), viewer]
    }
}

#[derive(Clone, Copy)]
pub(super) struct Projection {
    /// Unit vectors to the right, up and towards the viewer, in world coordinates.
    pub axes: [Vector3<f32>; 3],
    centre: Vector3<f32>,
    /// Samples per metre.
    pub per_m: f32,
    half: [f32; 2],
}

impl Projection {
    pub fn new(camera: &Camera, width: usize, height: usize) -> Self {
        Self {
            axes: camera.axes().map(|v| v.cast()),
            centre: camera.frame.centre.cast(),
            per_m: (height as f64 / camera.frame.height_m) as f32,
            half: [width as f32 / 2.0, height as f32 / 2.0],
        }
    }

    /// Projection along parallel light from the direction `towards`: a square of `size` samples covers a ball.
    pub fn of_light(towards: Vector3<f32>, centre: Vector3<f32>, radius: f32, size: usize) -> Self {
        let helper = if towards.z.abs() > 0.9 { Vector3::x() } else { Vector3::z() };
        let right = helper.cross(&towards).normalize();
        let half = size as f32 / 2.0;
        Self { axes: [right, towards.cross(&right), towards], centre, per_m: half / radius, half: [half, half] }
    }

    /// Converts a world point to samples (x right, y down) and to its distance behind the centre plane, m.
    pub fn project(&self, point: &Vector3<f32>) -> [f32; 3] {
        let d = point - self.centre;
        [
            self.half[0] + self.per_m * d.dot(&self.axes[0]),
            self.half[1] - self.per_m * d.dot(&self.axes[1]),
            -d.dot(&self.axes[2]),
        ]
    }

    pub fn unproject(&self, x: f32, y: f32, depth: f32) -> Vector3<f32> {
        self.centre + self.axes[0] * ((x - self.half[0]) / self.per_m)
            - self.axes[1] * ((y - self.half[1]) / self.per_m)
            - self.axes[2] * depth
    }
}

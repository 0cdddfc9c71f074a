//! Human model [T 3.2]: from measurements to a measured, closed mannequin with joints and landmarks.
//!
//! Rooms, from the ground up. Each uses only those before it:
//!
//! | room | holds |
//! |---|---|
//! | `people` | dimensions, the survey of adults, estimates of what was not measured |
//! | `repair` | repair of surfaces: stray pieces, floor, holes, branching edges |
//! | `measure` | the tape: landmarks, levels, girths, lengths |
//! | `shape` | cross-sections, limbs and trunk lofted through them, the skin over all |
//! | `model` | the mannequin: built, fitted to the tape, its control mesh |
//! | `files`, `photo` | bodies from files, and from pictures |
//! | `scan`, `pose` | a body from a scan; another pose |

mod error;
mod files;
mod measure;
mod model;
mod people;
mod photo;
mod pose;
mod repair;
mod scan;
mod shape;
#[cfg(test)]
mod testing;

pub use error::BodyError;
pub use files::import::{Imported, LengthUnit, import, write_obj};
pub use measure::confidence::Confidence;
pub use measure::girths::Girths;
pub use measure::lengths::{Lengths, Measured, lengths};
pub use measure::sites::measure;
pub use measure::tailor::Taken;
pub use model::build::build;
pub use model::control::{ControlMesh, Layer, RING, Region};
pub use model::control_file::{ControlFile, read_control, write_control};
pub use model::figured::{FigureFound, build_figured, figures};
pub use people::dimension::{Dimension, Measurements};
pub use people::draw::{person, scores};
pub use people::figures::{Figures, Trait};
pub use people::foreign::read_foreign;
pub use people::likely::Likely;
pub use people::profile::{Doubt, Mass, percentile, plausibility};
pub use photo::camera::Camera;
pub use photo::pictures::{Pictured, PicturedLevel, from_pictures, picture_height};
pub use pose::{Pose, pose, way};
pub use scan::{Scan, from_scan};

use geom::section::{self, Plane};
use geom::{TriMesh, V2, V3, hull};

/// Sex of the subject, as far as body shape and sizing tables distinguish it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Sex {
    #[serde(alias = "m", alias = "M")]
    Male,
    #[serde(alias = "f", alias = "F")]
    Female,
}

/// The 17 joints [T 3.1, figure 3-11].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Joint {
    Pelvis,
    Waist,
    Chest,
    Neck,
    Head,
    ShoulderRight,
    ElbowRight,
    WristRight,
    ShoulderLeft,
    ElbowLeft,
    WristLeft,
    HipRight,
    KneeRight,
    AnkleRight,
    HipLeft,
    KneeLeft,
    AnkleLeft,
}

/// Joint positions in the world frame, m, indexed by [`Joint`].
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Skeleton {
    pub joints: [V3; 17],
}

impl Skeleton {
    pub fn at(&self, joint: Joint) -> V3 {
        self.joints[joint as usize]
    }
}

/// Landmarks on the fine mesh, m. Pairs are `[right, left]`.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Landmarks {
    /// Side neck points: intersections of the shoulder lines with the base of the neck.
    pub side_neck: [V3; 2],
    /// Shoulder points: outer ends of the shoulder lines (acromion).
    pub shoulder: [V3; 2],
    /// Back neck point (cervicale).
    pub back_neck: V3,
    /// Front neck point (suprasternale).
    pub front_neck: V3,
    pub armpit: [V3; 2],
    /// Most prominent points of the chest or bust.
    pub bust: [V3; 2],
    /// Crotch point: lowest point of the trunk in the median plane, between the legs.
    pub crotch: V3,
}

/// Heights above the floor.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Levels {
    /// Chest or bust.
    pub chest_m: f64,
    pub underbust_m: f64,
    /// Level of ISO 8559-1.
    pub waist_m: f64,
    /// Height of the greatest protrusion of the buttocks (ISO 8559-1).
    pub hip_m: f64,
    /// Upper end of the inside leg.
    pub crotch_m: f64,
    /// Height of the least girth of the neck, read at the spine.
    pub neck_m: f64,
}

/// A human model that can be dressed.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Body {
    /// Decides mean shape and waist level.
    pub sex: Sex,
    /// Closed fine mesh, m.
    pub mesh: TriMesh,
    pub skeleton: Skeleton,
    pub landmarks: Landmarks,
    pub levels: Levels,
    /// Coarse control mesh of rings on the skin [T 3.2.2].
    pub control: ControlMesh,
    /// Readings of the tape on the fine mesh.
    pub girths: Girths,
}

impl Body {
    /// Girth of the trunk at a height above the floor, m, as a taut tape reads it. `None` at a height without a trunk.
    pub fn trunk_girth_at(&self, height_m: f64) -> Option<f64> {
        measure::tape::trunk_girth(&self.mesh, height_m, self.skeleton.at(Joint::Waist).x)
    }

    /// Body inside a garment that `mesh` encloses. Girths of the trunk are read over `on_trunk`, the cloth there.
    pub fn enclosed(&self, mesh: TriMesh, on_trunk: &TriMesh) -> Self {
        let Levels { chest_m, underbust_m, waist_m, hip_m, .. } = self.levels;
        let mut girths = self.girths.clone();
        let read = [
            (Dimension::ChestGirth, chest_m),
            (Dimension::UnderbustGirth, underbust_m),
            (Dimension::WaistGirth, waist_m),
            (Dimension::HipGirth, hip_m),
        ];
        for (dimension, height_m) in read {
            let bare = measure::tape::trunk_outline(&self.mesh, height_m, self.skeleton.at(Joint::Waist).x);
            let cloth = section::section(on_trunk, &Plane::horizontal(height_m));
            let points: Vec<V2> =
                bare.iter().chain(&cloth).flat_map(|outline| outline.points.iter().copied()).collect();
            if bare.is_some() {
                girths.set(dimension, hull::tape_girth(&points));
            }
        }
        Self { mesh, girths, ..self.clone() }
    }

    /// Tailor's measurements other than girths.
    pub fn tailor(&self) -> Vec<Taken> {
        measure::tailor::of_body(self)
    }

    /// Bands on the skin that show the tape round chest, under-bust, waist and hip, m.
    pub fn tapes(&self) -> TriMesh {
        let Levels { chest_m, underbust_m, waist_m, hip_m, .. } = self.levels;
        measure::tape::bands(&self.mesh, &[chest_m, underbust_m, waist_m, hip_m], 0.0)
    }

    /// Bands on the skin that show the lines of the tailor's measurements, m.
    pub fn lines(&self) -> TriMesh {
        let mut bands = TriMesh::default();
        self.tailor().iter().for_each(|taken| measure::tape::draw(&mut bands, &taken.path));
        bands
    }
}

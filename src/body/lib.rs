//! The human model (HMM, thesis 3.2): from measurements to a measured, featured, closed mannequin.

mod align;
mod anthropometry;
mod arm;
mod atlas;
mod build;
mod clean;
mod control;
mod control_cut;
mod control_file;
mod dimension;
mod draw;
mod field;
mod figure;
mod fit;
mod girths;
mod import;
mod interpolate;
mod landmarks;
mod lengths;
mod limb_tape;
mod limbs;
mod loft;
mod manifold;
mod measure;
mod outline;
mod pictures;
mod pose;
mod repair;
mod scan;
mod scanned;
mod sections;
mod segment;
mod silhouette;
mod slices;
mod stl;
mod surface;
mod survey;
mod tape;
mod template;
#[cfg(test)]
mod testing;

pub use anthropometry::{Doubt, Mass, percentile, plausibility};
pub use build::build;
pub use control::{ControlMesh, Layer, RING, Region};
pub use control_file::{ControlFile, read_control, write_control};
pub use dimension::{Dimension, Measurements};
pub use draw::{person, scores};
pub use girths::Girths;
pub use import::{Imported, LengthUnit, import, write_obj};
pub use lengths::{Lengths, Measured, lengths};
pub use measure::measure;
pub use pictures::{Camera, Pictured, PicturedLevel, from_pictures, picture_height};
pub use pose::{Pose, pose};
pub use scan::{Scan, from_scan};

use geom::units::mm;
use geom::{TriMesh, V3};

/// Why no body could be made or measured.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum BodyError {
    /// A measurement that no adult has.
    #[error("{name} = {value} {unit} is impossible; accepted: {least} to {greatest} {unit}")]
    OutOfRange {
        /// Key of the measurement.
        name: &'static str,
        /// What was given.
        value: f64,
        /// Least accepted value.
        least: f64,
        /// Greatest accepted value.
        greatest: f64,
        /// Unit of the numbers.
        unit: &'static str,
    },
    /// The mesh has no section where the body part should be.
    #[error(
        "no {part} found at a height of {:.0} mm: is this a standing person, z up, with the feet on z = 0?",
        mm(*height_m)
    )]
    MissingPart {
        /// Body part.
        part: &'static str,
        /// Height of the search, m.
        height_m: f64,
    },
    /// Two measurements that no adult has together.
    #[error("{found} does not go with {with}: no adult has both; accepted with it: {least:.0} to {greatest:.0} {unit}")]
    Contradiction {
        /// The measurement with its value.
        found: String,
        /// The other one, with its value.
        with: String,
        /// Least accepted value.
        least: f64,
        /// Greatest accepted value.
        greatest: f64,
        /// Unit of the numbers.
        unit: &'static str,
    },
    /// Measurements that are possible each, but not of one body.
    #[error("these measurements do not make one body ({reason}); accepted: girths that one adult has together")]
    Inconsistent {
        /// What cannot be formed, or which measurement is not reached.
        reason: String,
    },
    /// A mesh file that cannot be read.
    #[error("{format}, {place}: {problem}; accepted: OBJ, PLY or STL with triangles or polygons")]
    File {
        /// Format of the file.
        format: &'static str,
        /// Line, vertex or face.
        place: String,
        /// What is wrong there.
        problem: String,
    },
    /// A picture that no body can be read from.
    #[error(
        "the {view} picture cannot be used: {problem}; accepted: one standing person, arms off the trunk, wholly seen before a plain background"
    )]
    Picture {
        /// Front or side.
        view: &'static str,
        /// What is wrong.
        problem: String,
    },
    /// Limbs that cannot be brought where they were asked.
    #[error("no such pose: {problem}")]
    Pose {
        /// What cannot be done, and what can.
        problem: String,
    },
    /// A surface that cannot bound a solid body.
    #[error("the surface does not close: {problem}; accepted: one whole body, its holes under 0.9 m round")]
    Open {
        /// What is open.
        problem: String,
    },
    /// More than one body.
    #[error(
        "two pieces of a like size: several bodies, or halves that are not joined; accepted: one body in one piece"
    )]
    Several,
    /// A mesh that is no adult in the unit given.
    #[error("the body is {extent:.4} {unit} high, which is no adult; accepted: 1.2 to 2.4 m; is the unit right?")]
    WrongUnit {
        /// Height in the unit given.
        extent: f64,
        /// The unit.
        unit: &'static str,
    },
    /// A mesh whose size fits a standing adult in no unit.
    #[error("the body is {extent} high, which is no adult in mm, cm or m; accepted: 1.2 to 2.4 m, or say the unit")]
    Unit {
        /// Height in the file's unit.
        extent: f64,
    },
}

/// Sex of the subject, as far as body shape and sizing tables distinguish it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Sex {
    /// Male.
    #[serde(alias = "m", alias = "M")]
    Male,
    /// Female.
    #[serde(alias = "f", alias = "F")]
    Female,
}

/// The 17 joints (thesis 3.1, figure 3-11).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[allow(missing_docs)]
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

/// Joint positions in world space, metres, indexed by [`Joint`].
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Skeleton {
    /// One position a joint, in the order of [`Joint`].
    pub joints: [V3; 17],
}

impl Skeleton {
    /// Position of a joint, metres.
    #[must_use]
    pub fn at(&self, joint: Joint) -> V3 {
        self.joints[joint as usize]
    }
}

/// Feature points on the fine mesh, metres. Pairs are `[right, left]`.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Landmarks {
    /// Side neck points: where the shoulder line meets the base of the neck.
    pub side_neck: [V3; 2],
    /// Shoulder points: outer ends of the shoulder lines (acromion).
    pub shoulder: [V3; 2],
    /// Back neck point (cervicale).
    pub back_neck: V3,
    /// Front neck point (suprasternale).
    pub front_neck: V3,
    /// Lowest points of the armpits.
    pub armpit: [V3; 2],
    /// Most prominent points of the chest or bust.
    pub bust: [V3; 2],
    /// Crotch.
    pub crotch: V3,
}

/// Heights above the floor of the girth levels, metres.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Levels {
    /// Chest or bust.
    pub chest_m: f64,
    /// Under the bust.
    pub underbust_m: f64,
    /// Waist (ISO 8559-1).
    pub waist_m: f64,
    /// Hip.
    pub hip_m: f64,
    /// Crotch.
    pub crotch_m: f64,
    /// Narrowest neck.
    pub neck_m: f64,
}

/// A dressed-ready human model.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Body {
    /// Sex.
    pub sex: Sex,
    /// Closed fine mesh, metres.
    pub mesh: TriMesh,
    /// Joints.
    pub skeleton: Skeleton,
    /// Feature points.
    pub landmarks: Landmarks,
    /// Heights of the girth levels.
    pub levels: Levels,
    /// Layered coarse mesh on the skin.
    pub control: ControlMesh,
    /// What the tape reads on the fine mesh.
    pub girths: Girths,
}

impl Body {
    /// The tapes round chest, underbust, waist and hip, as bands on the skin to be drawn; metres.
    #[must_use]
    pub fn tapes(&self) -> TriMesh {
        let Levels { chest_m, underbust_m, waist_m, hip_m, .. } = self.levels;
        tape::bands(&self.mesh, &[chest_m, underbust_m, waist_m, hip_m], 0.0)
    }
}

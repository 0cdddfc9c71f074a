//! The human model (HMM, thesis 3.2): from measurements to a measured, featured, closed mannequin.

use crate::geom::{TriMesh, V3};

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

/// What is known of a subject, SI units; names after ISO 8559-1. Absent values are estimated.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Measurements {
    /// Sex.
    pub sex: Sex,
    /// Stature, m.
    pub stature_m: f64,
    /// Body mass, kg.
    pub weight_kg: Option<f64>,
    /// Chest (men) or bust (women) girth, m.
    pub chest_girth_m: Option<f64>,
    /// Waist girth (ISO 8559-1 level), m.
    pub waist_girth_m: Option<f64>,
    /// Hip girth, m.
    pub hip_girth_m: Option<f64>,
    /// Neck girth, m.
    pub neck_girth_m: Option<f64>,
    /// Across-shoulder width over the back neck point, m.
    pub across_shoulder_m: Option<f64>,
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
}

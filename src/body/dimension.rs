//! The measurements by which a subject is known, named after ISO 8559-1.

use super::Measurements;

/// A body dimension. The order is that of the tables of the survey.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Dimension {
    /// Stature.
    Stature,
    /// Body mass.
    Weight,
    /// Chest (men) or bust (women) girth.
    ChestGirth,
    /// Waist girth, at the ISO 8559-1 level.
    WaistGirth,
    /// Hip girth.
    HipGirth,
    /// Neck girth.
    NeckGirth,
    /// Tape over the back neck point from shoulder point to shoulder point.
    AcrossShoulder,
    /// Thigh girth.
    ThighGirth,
    /// Knee girth, at the middle of the kneecap.
    KneeGirth,
    /// Calf girth, the greatest.
    CalfGirth,
    /// Ankle girth, the smallest above the ankle.
    AnkleGirth,
    /// Upper arm girth, relaxed.
    UpperArmGirth,
    /// Forearm girth, relaxed.
    ForearmGirth,
    /// Wrist girth.
    WristGirth,
    /// Inside leg height: floor to crotch.
    Inseam,
    /// Shoulder point over the elbow to the wrist.
    ArmLength,
    /// Foot length.
    FootLength,
    /// Breadth over the upper arms (bideltoid, ISO 7250-1); always estimated.
    ShoulderBreadth,
    /// Under-bust girth.
    UnderbustGirth,
}

/// Number of dimensions.
pub(super) const COUNT: usize = 19;

impl Dimension {
    /// Every dimension that a subject may be known by.
    pub const ALL: [Self; COUNT - 1] = {
        use Dimension::*;
        [
            Stature,
            Weight,
            ChestGirth,
            UnderbustGirth,
            WaistGirth,
            HipGirth,
            NeckGirth,
            AcrossShoulder,
            ThighGirth,
            KneeGirth,
            CalfGirth,
            AnkleGirth,
            UpperArmGirth,
            ForearmGirth,
            WristGirth,
            Inseam,
            ArmLength,
            FootLength,
        ]
    };

    /// Key in study files, tables and JSON, with the unit in which it is written there.
    #[must_use]
    pub const fn key(self) -> &'static str {
        self.facts().0
    }

    /// Name for people to read.
    #[must_use]
    pub const fn name(self) -> &'static str {
        self.facts().1
    }

    /// Least and greatest accepted value, m or kg: wider than the range of the adults of the survey.
    #[must_use]
    pub fn range(self) -> [f64; 2] {
        self.facts().2
    }

    /// How many of the unit of the key make one SI unit.
    #[must_use]
    pub fn per_si(self) -> f64 {
        if self == Self::Weight { 1.0 } else { 1e3 }
    }

    /// Unit of the key.
    #[must_use]
    pub fn unit(self) -> &'static str {
        if self == Self::Weight { "kg" } else { "mm" }
    }

    /// Key, name and accepted range.
    const fn facts(self) -> (&'static str, &'static str, [f64; 2]) {
        match self {
            Self::Stature => ("stature_mm", "stature", [1.30, 2.20]),
            Self::Weight => ("weight_kg", "weight", [30.0, 220.0]),
            Self::ChestGirth => ("chest_girth_mm", "chest girth", [0.60, 1.70]),
            Self::WaistGirth => ("waist_girth_mm", "waist girth", [0.45, 1.70]),
            Self::HipGirth => ("hip_girth_mm", "hip girth", [0.65, 1.75]),
            Self::NeckGirth => ("neck_girth_mm", "neck girth", [0.25, 0.58]),
            Self::AcrossShoulder => ("across_shoulder_mm", "across shoulder", [0.30, 0.60]),
            Self::ThighGirth => ("thigh_girth_mm", "thigh girth", [0.32, 1.05]),
            Self::KneeGirth => ("knee_girth_mm", "knee girth", [0.22, 0.66]),
            Self::CalfGirth => ("calf_girth_mm", "calf girth", [0.22, 0.62]),
            Self::AnkleGirth => ("ankle_girth_mm", "ankle girth", [0.15, 0.38]),
            Self::UpperArmGirth => ("upper_arm_girth_mm", "upper arm girth", [0.16, 0.60]),
            Self::ForearmGirth => ("forearm_girth_mm", "forearm girth", [0.16, 0.45]),
            Self::WristGirth => ("wrist_girth_mm", "wrist girth", [0.11, 0.25]),
            Self::Inseam => ("inseam_mm", "inseam", [0.50, 1.10]),
            Self::ArmLength => ("arm_length_mm", "arm length", [0.38, 0.80]),
            Self::FootLength => ("foot_length_mm", "foot length", [0.18, 0.36]),
            Self::ShoulderBreadth => ("shoulder_breadth_mm", "shoulder breadth", [0.30, 0.80]),
            Self::UnderbustGirth => ("underbust_girth_mm", "under-bust girth", [0.50, 1.60]),
        }
    }
}

impl Measurements {
    /// A dimension where it is known, m or kg.
    #[must_use]
    pub fn get(&self, dimension: Dimension) -> Option<f64> {
        match dimension {
            Dimension::Stature => Some(self.stature_m),
            Dimension::Weight => self.weight_kg,
            Dimension::ChestGirth => self.chest_girth_m,
            Dimension::UnderbustGirth => self.underbust_girth_m,
            Dimension::WaistGirth => self.waist_girth_m,
            Dimension::HipGirth => self.hip_girth_m,
            Dimension::NeckGirth => self.neck_girth_m,
            Dimension::AcrossShoulder => self.across_shoulder_m,
            Dimension::ThighGirth => self.thigh_girth_m,
            Dimension::KneeGirth => self.knee_girth_m,
            Dimension::CalfGirth => self.calf_girth_m,
            Dimension::AnkleGirth => self.ankle_girth_m,
            Dimension::UpperArmGirth => self.upper_arm_girth_m,
            Dimension::ForearmGirth => self.forearm_girth_m,
            Dimension::WristGirth => self.wrist_girth_m,
            Dimension::Inseam => self.inseam_m,
            Dimension::ArmLength => self.arm_length_m,
            Dimension::FootLength => self.foot_length_m,
            Dimension::ShoulderBreadth => None,
        }
    }

    /// Makes a dimension known, m or kg. The breadth over the upper arms cannot be given and is left out.
    pub fn set(&mut self, dimension: Dimension, value: f64) {
        let slot = match dimension {
            Dimension::Stature => {
                self.stature_m = value;
                return;
            }
            Dimension::ShoulderBreadth => return,
            Dimension::Weight => &mut self.weight_kg,
            Dimension::ChestGirth => &mut self.chest_girth_m,
            Dimension::UnderbustGirth => &mut self.underbust_girth_m,
            Dimension::WaistGirth => &mut self.waist_girth_m,
            Dimension::HipGirth => &mut self.hip_girth_m,
            Dimension::NeckGirth => &mut self.neck_girth_m,
            Dimension::AcrossShoulder => &mut self.across_shoulder_m,
            Dimension::ThighGirth => &mut self.thigh_girth_m,
            Dimension::KneeGirth => &mut self.knee_girth_m,
            Dimension::CalfGirth => &mut self.calf_girth_m,
            Dimension::AnkleGirth => &mut self.ankle_girth_m,
            Dimension::UpperArmGirth => &mut self.upper_arm_girth_m,
            Dimension::ForearmGirth => &mut self.forearm_girth_m,
            Dimension::WristGirth => &mut self.wrist_girth_m,
            Dimension::Inseam => &mut self.inseam_m,
            Dimension::ArmLength => &mut self.arm_length_m,
            Dimension::FootLength => &mut self.foot_length_m,
        };
        *slot = Some(value);
    }

    /// Every known dimension with its value, m or kg.
    pub fn known(&self) -> impl Iterator<Item = (Dimension, f64)> + '_ {
        Dimension::ALL.into_iter().filter_map(|dimension| self.get(dimension).map(|value| (dimension, value)))
    }
}

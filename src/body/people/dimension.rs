//! Body dimensions of a subject, named after ISO 8559-1.

use std::collections::BTreeMap;

use crate::Sex;

/// Body dimension, in the order of the tables of the survey (`survey.rs`).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Dimension {
    Stature,
    /// Mass in kg.
    Weight,
    /// Chest (men) or bust (women) girth.
    ChestGirth,
    /// Level of ISO 8559-1.
    WaistGirth,
    /// Girth at the greatest protrusion of the buttocks.
    HipGirth,
    /// Least girth of the neck, with the tape perpendicular to its axis.
    NeckGirth,
    /// Length of the tape from shoulder point to shoulder point across the back neck point.
    AcrossShoulder,
    /// Girth of the thigh just below the crotch.
    ThighGirth,
    /// Level of the middle of the kneecap.
    KneeGirth,
    /// Greatest girth of the calf.
    CalfGirth,
    /// Least girth above the ankle.
    AnkleGirth,
    /// Relaxed arm.
    UpperArmGirth,
    /// Relaxed arm.
    ForearmGirth,
    /// Girth over the wrist bones.
    WristGirth,
    /// Inside leg height: floor to crotch.
    Inseam,
    /// Distance from the shoulder point over the elbow to the wrist.
    ArmLength,
    FootLength,
    /// Breadth across the upper arms (bideltoid, ISO 7250-1), which is always estimated.
    ShoulderBreadth,
    UnderbustGirth,
}

pub(crate) const COUNT: usize = 19;

struct Facts {
    key: &'static str,
    name: &'static str,
    words: &'static str,
    range: [f64; 2],
}

const fn facts(key: &'static str, name: &'static str, words: &'static str, range: [f64; 2]) -> Facts {
    Facts { key, name, words, range }
}

impl Dimension {
    /// All dimensions that may be given for a subject, the most common first.
    pub const ALL: [Self; COUNT - 1] = {
        use Dimension::*;
        [
            Stature,
            Weight,
            ChestGirth,
            WaistGirth,
            HipGirth,
            NeckGirth,
            AcrossShoulder,
            UnderbustGirth,
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

    /// Key in study files, tables and JSON, with its unit.
    pub const fn key(self) -> &'static str {
        self.facts().key
    }

    pub const fn name(self) -> &'static str {
        self.facts().name
    }

    /// Description, if the name alone does not suffice.
    pub const fn words(self) -> &'static str {
        self.facts().words
    }

    /// Least and greatest accepted value, m or kg. Judgement: wider than the range of the adults in the survey.
    pub fn range(self) -> [f64; 2] {
        self.facts().range
    }

    /// Number of units of the key in one SI unit.
    pub fn per_si(self) -> f64 {
        if self == Self::Weight { 1.0 } else { 1e3 }
    }

    pub fn unit(self) -> &'static str {
        if self == Self::Weight { "kg" } else { "mm" }
    }

    const fn facts(self) -> Facts {
        match self {
            Self::Stature => facts("stature_mm", "stature", "Stature", [1.30, 2.20]),
            Self::Weight => facts("weight_kg", "weight", "Body mass", [30.0, 220.0]),
            Self::ChestGirth => facts("chest_girth_mm", "chest girth", "Chest or bust girth", [0.60, 1.70]),
            Self::WaistGirth => facts("waist_girth_mm", "waist girth", "Waist girth", [0.45, 1.70]),
            Self::HipGirth => facts("hip_girth_mm", "hip girth", "Hip girth", [0.65, 1.75]),
            Self::NeckGirth => facts("neck_girth_mm", "neck girth", "Neck girth", [0.25, 0.58]),
            Self::AcrossShoulder => {
                facts("across_shoulder_mm", "across shoulder", "Width across the shoulders", [0.30, 0.60])
            }
            Self::ThighGirth => {
                facts("thigh_girth_mm", "thigh girth", "Thigh girth, just below the crotch", [0.32, 1.05])
            }
            Self::KneeGirth => facts("knee_girth_mm", "knee girth", "Knee girth", [0.22, 0.66]),
            Self::CalfGirth => facts("calf_girth_mm", "calf girth", "Calf girth", [0.22, 0.62]),
            Self::AnkleGirth => facts("ankle_girth_mm", "ankle girth", "Ankle girth", [0.15, 0.38]),
            Self::UpperArmGirth => {
                facts("upper_arm_girth_mm", "upper arm girth", "Upper arm girth, relaxed", [0.16, 0.60])
            }
            Self::ForearmGirth => facts("forearm_girth_mm", "forearm girth", "Forearm girth, relaxed", [0.16, 0.45]),
            Self::WristGirth => facts("wrist_girth_mm", "wrist girth", "Wrist girth", [0.11, 0.25]),
            Self::Inseam => facts("inseam_mm", "inseam", "Inside leg height", [0.50, 1.10]),
            Self::ArmLength => {
                facts("arm_length_mm", "arm length", "Shoulder point over the elbow to the wrist", [0.38, 0.80])
            }
            Self::FootLength => facts("foot_length_mm", "foot length", "Foot length", [0.18, 0.36]),
            Self::ShoulderBreadth => {
                facts("shoulder_breadth_mm", "shoulder breadth", "Breadth over the upper arms", [0.30, 0.80])
            }
            Self::UnderbustGirth => facts("underbust_girth_mm", "under-bust girth", "Under-bust girth", [0.50, 1.60]),
        }
    }
}

/// Sex and measured dimensions of a subject, m or kg.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(into = "Written", try_from = "Written")]
pub struct Measurements {
    /// Decides the table of the survey for missing dimensions.
    pub sex: Sex,
    values: [Option<f64>; COUNT],
}

impl Measurements {
    pub fn of(sex: Sex, stature_m: f64) -> Self {
        Self { sex, values: [None; COUNT] }.with(Dimension::Stature, stature_m)
    }

    /// Sets a dimension, m or kg. `None` removes it.
    pub fn with(mut self, dimension: Dimension, value: impl Into<Option<f64>>) -> Self {
        self.set(dimension, value);
        self
    }

    pub fn get(&self, dimension: Dimension) -> Option<f64> {
        self.values[dimension as usize]
    }

    /// Sets a dimension, m or kg, or removes it by `None`. Ignores the breadth across the upper arms.
    pub fn set(&mut self, dimension: Dimension, value: impl Into<Option<f64>>) {
        if dimension != Dimension::ShoulderBreadth {
            self.values[dimension as usize] = value.into();
        }
    }

    /// NaN if it is unknown.
    pub fn stature_m(&self) -> f64 {
        self.get(Dimension::Stature).unwrap_or(f64::NAN)
    }

    pub fn known(&self) -> impl Iterator<Item = (Dimension, f64)> + '_ {
        Dimension::ALL.into_iter().filter_map(|dimension| self.get(dimension).map(|value| (dimension, value)))
    }
}

/// [`Measurements`] as serialised: SI values by key, such as `chest_girth_m`.
#[derive(serde::Serialize, serde::Deserialize)]
struct Written {
    sex: Sex,
    #[serde(flatten)]
    values: BTreeMap<String, Option<f64>>,
}

fn si_key(dimension: Dimension) -> String {
    let key = dimension.key();
    key.strip_suffix("_mm").map_or_else(|| key.to_owned(), |stem| format!("{stem}_m"))
}

impl From<Measurements> for Written {
    fn from(known: Measurements) -> Self {
        let values = Dimension::ALL.map(|dimension| (si_key(dimension), known.get(dimension)));
        Self { sex: known.sex, values: values.into() }
    }
}

impl TryFrom<Written> for Measurements {
    type Error = String;

    fn try_from(written: Written) -> Result<Self, String> {
        let mut known = Self { sex: written.sex, values: [None; COUNT] };
        for (key, value) in written.values {
            let dimension = Dimension::ALL.into_iter().find(|dimension| si_key(*dimension) == key);
            known.set(dimension.ok_or_else(|| format!("no measurement `{key}`"))?, value);
        }
        Ok(known)
    }
}

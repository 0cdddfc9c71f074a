//! Body dimensions of a subject, named after ISO 8559-1.

use std::collections::BTreeMap;

use crate::Sex;

/// Body dimension, in the order of the tables of the survey (`survey.rs`).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Dimension {
    /// Height from the floor to the crown of the head.
    Stature,
    /// Body mass, kg.
    Weight,
    /// Chest (men) or bust (women) girth.
    ChestGirth,
    /// Waist girth, at the ISO 8559-1 level.
    WaistGirth,
    /// Girth at the greatest protrusion of the buttocks.
    HipGirth,
    /// Least girth of the neck, with the tape perpendicular to its axis.
    NeckGirth,
    /// Length of the tape from shoulder point to shoulder point across the back neck point.
    AcrossShoulder,
    /// Girth of the thigh just below the crotch.
    ThighGirth,
    /// Knee girth, at the middle of the kneecap.
    KneeGirth,
    /// Greatest girth of the calf.
    CalfGirth,
    /// Least girth above the ankle.
    AnkleGirth,
    /// Upper arm girth, relaxed.
    UpperArmGirth,
    /// Forearm girth, relaxed.
    ForearmGirth,
    /// Girth over the wrist bones.
    WristGirth,
    /// Inside leg height: floor to crotch.
    Inseam,
    /// Distance from the shoulder point over the elbow to the wrist.
    ArmLength,
    /// Length of the foot, from the heel to the tip of the longest toe.
    FootLength,
    /// Breadth across the upper arms (bideltoid, ISO 7250-1), which is always estimated.
    ShoulderBreadth,
    /// Girth of the trunk under the bust.
    UnderbustGirth,
}

/// Number of dimensions.
pub(crate) const COUNT: usize = 19;

/// Names and accepted range of a dimension.
struct Facts {
    key: &'static str,
    name: &'static str,
    words: &'static str,
    /// Least and greatest accepted value, m or kg.
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
    #[must_use]
    pub const fn key(self) -> &'static str {
        self.facts().key
    }

    /// Name for readers.
    #[must_use]
    pub const fn name(self) -> &'static str {
        self.facts().name
    }

    /// Description, if the name alone does not suffice.
    #[must_use]
    pub const fn words(self) -> &'static str {
        self.facts().words
    }

    /// Least and greatest accepted value, m or kg. Judgement: wider than the range of the adults in the survey.
    #[must_use]
    pub fn range(self) -> [f64; 2] {
        self.facts().range
    }

    /// Number of units of the key in one SI unit.
    #[must_use]
    pub fn per_si(self) -> f64 {
        if self == Self::Weight { 1.0 } else { 1e3 }
    }

    /// Unit of the key.
    #[must_use]
    pub fn unit(self) -> &'static str {
        if self == Self::Weight { "kg" } else { "mm" }
    }

    /// Key, name, description and accepted range.
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
    /// Sex, which decides the table of the survey by which missing dimensions are estimated.
    pub sex: Sex,
    values: [Option<f64>; COUNT],
}

impl Measurements {
    /// Subject of whom only sex and stature (m) are known.
    #[must_use]
    pub fn of(sex: Sex, stature_m: f64) -> Self {
        Self { sex, values: [None; COUNT] }.with(Dimension::Stature, stature_m)
    }

    /// Returns the subject with a dimension set, m or kg, or removed by `None`.
    #[must_use]
    pub fn with(mut self, dimension: Dimension, value: impl Into<Option<f64>>) -> Self {
        self.set(dimension, value);
        self
    }

    /// Value of a dimension, m or kg. `None` if it is unknown.
    #[must_use]
    pub fn get(&self, dimension: Dimension) -> Option<f64> {
        self.values[dimension as usize]
    }

    /// Sets a dimension, m or kg, or removes it by `None`. The breadth across the upper arms cannot be given and is
    /// ignored.
    pub fn set(&mut self, dimension: Dimension, value: impl Into<Option<f64>>) {
        if dimension != Dimension::ShoulderBreadth {
            self.values[dimension as usize] = value.into();
        }
    }

    /// Stature, m. NaN if it is unknown.
    #[must_use]
    pub fn stature_m(&self) -> f64 {
        self.get(Dimension::Stature).unwrap_or(f64::NAN)
    }

    /// All known dimensions with their values, m or kg.
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

/// Key of a dimension in SI units.
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

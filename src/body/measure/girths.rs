//! Girths and levels that a tape reads on a body.

use crate::people::dimension::{COUNT, Dimension};
use crate::repair::feet::Feet;
use crate::{Measurements, Sex};
use geom::units::{from_mm, mm};
use serde::de::Error as _;
use std::collections::BTreeMap;

const READ: [Dimension; 16] = {
    use Dimension::*;
    [
        Stature,
        NeckGirth,
        ChestGirth,
        UnderbustGirth,
        WaistGirth,
        HipGirth,
        ThighGirth,
        UpperArmGirth,
        KneeGirth,
        CalfGirth,
        AnkleGirth,
        ForearmGirth,
        WristGirth,
        ArmLength,
        AcrossShoulder,
        Inseam,
    ]
};

const LEVELS: [(Dimension, &str); 9] = [
    (Dimension::NeckGirth, "neck_level_mm"),
    (Dimension::ChestGirth, "chest_level_mm"),
    (Dimension::UnderbustGirth, "underbust_level_mm"),
    (Dimension::WaistGirth, "waist_level_mm"),
    (Dimension::HipGirth, "hip_level_mm"),
    (Dimension::ThighGirth, "thigh_level_mm"),
    (Dimension::UpperArmGirth, "upper_arm_level_mm"),
    (Dimension::AcrossShoulder, "shoulder_level_mm"),
    (Dimension::Inseam, "crotch_level_mm"),
];

const LOWER_LEG: [Dimension; 3] = [Dimension::KneeGirth, Dimension::CalfGirth, Dimension::AnkleGirth];

const PLACED_BY_STATURE: [Dimension; 6] = [
    Dimension::Stature,
    Dimension::Inseam,
    Dimension::WaistGirth,
    Dimension::UpperArmGirth,
    Dimension::AcrossShoulder,
    Dimension::ArmLength,
];

const VOLUME: &str = "volume_l";

/// Girths, levels and volume of a body. Girths of lower arms and lower legs are read where the axes of the limbs are
/// known.
///
/// Serialised by the keys of `body measure`, in the units in which numbers are written, so that a stored body is equal
/// to the last bit when it is read again.
#[derive(Clone, Debug, PartialEq)]
pub struct Girths {
    /// Values in mm, by dimension.
    values: [Option<f64>; COUNT],
    /// Heights above the floor by dimension, mm.
    levels: [Option<f64>; COUNT],
    volume_l: f64,
}

impl Girths {
    pub(super) fn of(volume_m3: f64) -> Self {
        Self { values: [None; COUNT], levels: [None; COUNT], volume_l: volume_m3 * 1e3 }
    }

    /// Sets a dimension, m. `None` if the tape cannot be laid.
    pub(crate) fn set(&mut self, dimension: Dimension, value: impl Into<Option<f64>>) {
        self.values[dimension as usize] = value.into().map(mm);
    }

    pub(super) fn set_level(&mut self, dimension: Dimension, height: impl Into<Option<f64>>) {
        self.levels[dimension as usize] = height.into().map(mm);
    }

    /// Removes what a body with these feet does not show: without one foot the volume and, on the right leg, all below
    /// the knee, without both also heights and what is read at a share of the stature, as the floor is unknown.
    pub(crate) fn keep_known(&mut self, feet: Feet) {
        if feet == Feet::BOTH {
            return;
        }
        self.volume_l = f64::NAN;
        if !feet.right {
            LOWER_LEG.into_iter().for_each(|dimension| self.set(dimension, None));
        }
        if !feet.stand() {
            PLACED_BY_STATURE.into_iter().for_each(|dimension| self.set(dimension, None));
            self.levels = [None; COUNT];
        }
    }

    /// Lowers the levels by a distance, m. Stature and inseam stay those of the upright body.
    pub(crate) fn lower(&mut self, down: f64) {
        self.levels.iter_mut().flatten().for_each(|level| *level -= mm(down));
    }

    /// Value of a dimension, m. `None` if it was not read.
    pub fn get(&self, dimension: Dimension) -> Option<f64> {
        self.values[dimension as usize].map(from_mm)
    }

    /// NaN for a body without both feet.
    pub fn volume_l(&self) -> f64 {
        self.volume_l
    }

    /// Value of a key as it is written, mm or l. `None` if it was not read.
    pub fn written(&self, key: &str) -> Option<f64> {
        self.entries().find(|(other, _)| *other == key)?.1
    }

    pub(super) fn entries(&self) -> impl Iterator<Item = (&'static str, Option<f64>)> {
        let values = READ.map(|dimension| (dimension.key(), self.values[dimension as usize]));
        let levels = LEVELS.map(|(dimension, key)| (key, self.levels[dimension as usize]));
        values.into_iter().chain([(VOLUME, Some(self.volume_l).filter(|litres| litres.is_finite()))]).chain(levels)
    }

    /// Measurements of a subject with these girths: all that a subject may have, rounded to 0.1 mm, finer than a tape.
    pub fn measurements(&self, sex: Sex) -> Measurements {
        let mut known = Measurements::of(sex, f64::NAN);
        for dimension in READ {
            let [least, greatest] = dimension.range();
            let may_be = |value: &f64| dimension == Dimension::Stature || (least..=greatest).contains(value);
            let tenths = |value: f64| from_mm((mm(value) * 10.0).round() / 10.0);
            known.set(dimension, self.get(dimension).map(tenths).filter(may_be));
        }
        known
    }
}

impl serde::Serialize for Girths {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.entries())
    }
}

impl<'de> serde::Deserialize<'de> for Girths {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let written = BTreeMap::<String, Option<f64>>::deserialize(deserializer)?;
        let value_of = |key: &str| written.get(key).copied().flatten();
        let volume_l = value_of(VOLUME).ok_or_else(|| D::Error::missing_field(VOLUME))?;
        let mut girths = Self { values: [None; COUNT], levels: [None; COUNT], volume_l };
        READ.into_iter().for_each(|dimension| girths.values[dimension as usize] = value_of(dimension.key()));
        LEVELS.into_iter().for_each(|(dimension, key)| girths.levels[dimension as usize] = value_of(key));
        Ok(girths)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stored_body_equals_the_one_that_was_stored() {
        let mut girths = Girths::of(0.0612345678901234);
        for (i, dimension) in READ.into_iter().enumerate().filter(|(i, _)| i % 3 > 0) {
            girths.set(dimension, 0.1 + 0.123_456_789_012_345_67 * i as f64);
        }
        girths.set_level(Dimension::Inseam, 0.797_687_976_754_969);
        let text = serde_json::to_string(&girths).expect("numbers");
        assert!(text.contains("\"stature_mm\":null") && text.contains("\"crotch_level_mm\":797.68797"), "{text}");
        let read: Girths = serde_json::from_str(&text).expect("what was written");
        assert_eq!(read, girths);
        assert_eq!(read.written("crotch_level_mm"), girths.written("crotch_level_mm"));
        let cut = text.replace("volume_l", "volume");
        assert!(serde_json::from_str::<Girths>(&cut).is_err_and(|error| error.to_string().contains("volume_l")));
    }
}

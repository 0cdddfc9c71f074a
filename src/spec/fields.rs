//! The numbers of subjects and fabrics: their keys, units and accepted values.

use std::ops::RangeInclusive;
use std::sync::LazyLock;

use crate::entry::{Entry, Field, Given, Sheet};
use crate::sheets::FABRIC_SHEETS;
use body::{Dimension, Measurements, Sex};
use geom::units::{from_mm, mm};
use sim::Fabric;
use sim::fabric::Stretched;

/// Every [`Dimension`], with names after ISO 8559-1.
pub static MEASUREMENTS: LazyLock<Vec<Field<Measurements>>> =
    LazyLock::new(|| Dimension::ALL.into_iter().map(measurement).collect());

fn measurement(dimension: Dimension) -> Field<Measurements> {
    let is_length = dimension.unit() == "mm";
    Field {
        key: dimension.key(),
        label: dimension.name(),
        is_required: dimension == Dimension::Stature,
        range: body_range(dimension),
        get: Box::new(move |subject: &Measurements| {
            subject.get(dimension).map(|value| if is_length { millimetres(value) } else { value })
        }),
        set: Box::new(move |subject: &mut Measurements, value| {
            subject.set(dimension, value.map(|value| if is_length { from_mm(value) } else { value }));
        }),
    }
}

/// Values of a measurement with which a body can be built, in the unit of the key.
fn body_range(dimension: Dimension) -> RangeInclusive<f64> {
    let [least, greatest] = dimension.range().map(|bound| (bound * dimension.per_si() * 1e6).round() / 1e6);
    least..=greatest
}

/// Makes a field for a number of [`Fabric`], which is in SI units.
macro_rules! number {
    ($field:ident, $label:literal, $range:expr) => {
        Field {
            key: stringify!($field),
            label: $label,
            is_required: true,
            range: $range,
            get: Box::new(|fabric: &Fabric| Some(fabric.$field)),
            set: Box::new(|fabric: &mut Fabric, value| fabric.$field = value.unwrap_or(f64::NAN)),
        }
    };
}

pub static FABRIC_NUMBERS: LazyLock<Vec<Field<Fabric>>> = LazyLock::new(|| {
    vec![
        number!(density_kg_m2, "areal density", 0.005..=5.0),
        Field {
            key: "thickness_mm",
            label: "thickness",
            is_required: true,
            range: 0.01..=20.0,
            get: Box::new(|fabric: &Fabric| Some(millimetres(fabric.thickness_m))),
            set: Box::new(|fabric: &mut Fabric, value| fabric.thickness_m = from_mm(value.unwrap_or(f64::NAN))),
        },
        number!(membrane_warp_n_m, "strip modulus along the grain", 1.0..=1e6),
        number!(membrane_weft_n_m, "strip modulus across the grain", 1.0..=1e6),
        Field {
            key: "membrane_coupling_n_m",
            label: "coupling of the two [default: 0]",
            is_required: false,
            range: 0.0..=1e6,
            get: Box::new(|fabric: &Fabric| Some(fabric.membrane_coupling_n_m)),
            set: Box::new(|fabric: &mut Fabric, value| fabric.membrane_coupling_n_m = value.unwrap_or(0.0)),
        },
        number!(shear_n_m, "shear modulus", 0.1..=1e6),
        number!(bending_warp_nm, "bending rigidity, warp", 1e-9..=1e-1),
        number!(bending_weft_nm, "bending rigidity, weft", 1e-9..=1e-1),
        number!(friction_body, "friction on the body", 0.0..=5.0),
        number!(friction_self, "friction on itself", 0.0..=5.0),
        Field {
            key: "stretch_pct",
            label: "stretch of a knit's second moduli [default: none]",
            is_required: false,
            range: 1.0..=200.0,
            get: Box::new(|fabric: &Fabric| fabric.stretched.map(|law| (law.stretch * 1e10).round() / 1e8)),
            set: Box::new(|fabric: &mut Fabric, value| {
                set_stretched(fabric, value, |law, value| law.stretch = value / 100.0)
            }),
        },
        Field {
            key: "stretched_warp_n_m",
            label: "secant modulus there, warp",
            is_required: false,
            range: 1.0..=1e6,
            get: Box::new(|fabric: &Fabric| fabric.stretched.map(|law| law.membrane_warp_n_m)),
            set: Box::new(|fabric: &mut Fabric, value| {
                set_stretched(fabric, value, |law, value| law.membrane_warp_n_m = value)
            }),
        },
        Field {
            key: "stretched_weft_n_m",
            label: "secant modulus there, weft",
            is_required: false,
            range: 1.0..=1e6,
            get: Box::new(|fabric: &Fabric| fabric.stretched.map(|law| law.membrane_weft_n_m)),
            set: Box::new(|fabric: &mut Fabric, value| {
                set_stretched(fabric, value, |law, value| law.membrane_weft_n_m = value)
            }),
        },
    ]
});

/// Sets one of the three numbers that say how cloth stiffens when stretched. Removing one number removes all three.
fn set_stretched(fabric: &mut Fabric, value: Option<f64>, set: fn(&mut Stretched, f64)) {
    let unset = Stretched { stretch: f64::NAN, membrane_warp_n_m: f64::NAN, membrane_weft_n_m: f64::NAN };
    match value {
        Some(value) => set(fabric.stretched.get_or_insert(unset), value),
        None => fabric.stretched = None,
    }
}

pub fn sex(word: &str) -> Result<Sex, String> {
    match word.trim() {
        "male" | "m" | "M" => Ok(Sex::Male),
        "female" | "f" | "F" => Ok(Sex::Female),
        other => Err(format!("sex `{other}`; accepted: male, female")),
    }
}

impl Entry for Measurements {
    fn fields() -> &'static [Field<Self>] {
        &MEASUREMENTS
    }

    const TEXTS: &'static [(&'static str, bool)] = &[("sex", true)];

    fn blank(_: &str) -> Self {
        Self::of(Sex::Female, f64::NAN)
    }

    fn set_text(&mut self, _: &str, text: &str) -> Result<(), String> {
        self.sex = sex(text)?;
        Ok(())
    }
}

impl Entry for Fabric {
    fn fields() -> &'static [Field<Self>] {
        &FABRIC_NUMBERS
    }

    fn sheets() -> &'static [Sheet<Self>] {
        &FABRIC_SHEETS
    }

    const TEXTS: &'static [(&'static str, bool)] = &[("source", false)];

    fn blank(name: &str) -> Self {
        Self {
            name: name.to_owned(),
            density_kg_m2: f64::NAN,
            thickness_m: f64::NAN,
            membrane_warp_n_m: f64::NAN,
            membrane_weft_n_m: f64::NAN,
            membrane_coupling_n_m: 0.0,
            shear_n_m: f64::NAN,
            bending_warp_nm: f64::NAN,
            bending_weft_nm: f64::NAN,
            friction_body: f64::NAN,
            friction_self: f64::NAN,
            source: "own".to_owned(),
            stretched: None,
        }
    }

    fn check(&self) -> Result<(), Given> {
        let Some(law) = self.stretched else { return Ok(()) };
        let numbers = [
            ("stretch_pct", law.stretch),
            ("stretched_warp_n_m", law.membrane_warp_n_m),
            ("stretched_weft_n_m", law.membrane_weft_n_m),
        ];
        let missing = numbers.into_iter().find(|(_, number)| number.is_nan());
        missing.map_or(Ok(()), |(key, _)| {
            let problem = format!("`{key}` is missing; a knit that stiffens has a stretch and both moduli there");
            Err((key.to_owned(), problem))
        })
    }

    fn set_text(&mut self, _: &str, text: &str) -> Result<(), String> {
        self.source = text.trim().to_owned();
        Ok(())
    }
}

/// Name in SQL and study files.
pub fn sex_name(m: &Measurements) -> &'static str {
    match m.sex {
        Sex::Male => "male",
        Sex::Female => "female",
    }
}

/// Converts a length to mm, rounded to 1 nm so that a written value survives the way back to metres.
pub fn millimetres(length_m: f64) -> f64 {
    (mm(length_m) * 1e6).round() / 1e6
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::entry::filled;

    fn given(pairs: &[(&str, &str)]) -> Vec<Given> {
        pairs.iter().map(|(key, text)| ((*key).to_owned(), (*text).to_owned())).collect()
    }

    #[test]
    fn every_field_keeps_what_it_is_given() {
        let mut subject = Measurements::blank("");
        for field in MEASUREMENTS.iter() {
            let value = *field.range.start();
            field.set(&mut subject, Some(value));
            assert_eq!(field.get(&subject), Some(value), "{}", field.key);
        }
        let mut fabric = Fabric::blank("");
        for field in FABRIC_NUMBERS.iter() {
            field.set(&mut fabric, Some(0.31));
            assert_eq!(field.get(&fabric), Some(0.31), "{}", field.key);
        }
    }

    #[test]
    fn every_wrong_value_is_named() {
        let told = |pairs: &[(&str, &str)]| {
            let problems = filled::<Measurements>(None, "anna", &given(pairs)).expect_err("wrong");
            problems.into_iter().map(|(_, problem)| problem).collect::<Vec<_>>()
        };
        assert_eq!(told(&[("sex", "f")]), ["`stature_mm` is missing"]);
        assert_eq!(
            told(&[("sex", "woman"), ("stature_mm", "1,65"), ("waist_girth_mm", "70"), ("wiast_girth_mm", "700")]),
            [
                "sex `woman`; accepted: male, female",
                "`stature_mm` is 1.65; accepted: 1300 to 2200",
                "`waist_girth_mm` is 70; accepted: 450 to 1700",
                "unknown value `wiast_girth_mm`; did you mean `waist_girth_mm`?",
            ]
        );
        assert!(told(&[("sex", "f"), ("stature_mm", "NaN")])[0].contains("is NaN"));
    }

    #[test]
    fn values_are_laid_over_an_entry_and_taken_away() {
        let anna = given(&[("sex", "f"), ("stature_mm", "1650"), ("waist_girth_mm", "700")]);
        let anna = filled::<Measurements>(None, "anna", &anna).expect("right");
        assert_eq!(
            (anna.sex, anna.stature_m(), anna.get(Dimension::WaistGirth)),
            (Sex::Female, from_mm(1650.0), Some(from_mm(700.0)))
        );
        let edited =
            filled(Some(&anna), "anna", &given(&[("waist_girth_mm", ""), ("weight_kg", " 60 ")])).expect("right");
        assert_eq!(edited, anna.with(Dimension::WaistGirth, None).with(Dimension::Weight, 60.0));
    }
}

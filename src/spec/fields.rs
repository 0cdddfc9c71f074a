//! The numbers of subjects and fabrics: their names, the values accepted, and how they are read from text. Study files,
//! imported tables, flags and forms all go through these lists, so that a value is accepted everywhere or nowhere.

use std::ops::RangeInclusive;
use std::sync::LazyLock;

use crate::sheets::FABRIC_SHEETS;
use body::{Dimension, Measurements, Sex};
use geom::units::{from_mm, mm};
use sim::Fabric;
use sim::fabric::Stretched;
use store::nearest;

/// One number of an entry of the catalogue, in the unit its key ends with.
pub struct Field<T: 'static> {
    /// Key in study files, tables and SQL (`waist_girth_mm`).
    pub key: &'static str,
    /// Name on screens and in help.
    pub label: &'static str,
    /// Whether no entry is without it.
    pub is_required: bool,
    pub(super) range: RangeInclusive<f64>,
    pub(super) get: Box<Get<T>>,
    pub(super) set: Box<Set<T>>,
}

/// A number in another unit or by another test, and the key of the [`Field`] that it stands for.
pub struct Sheet<T: 'static> {
    /// How it is given.
    pub field: Field<T>,
    /// What it stands for.
    pub key: &'static str,
}

impl<T: Entry> Sheet<T> {
    /// Gives an entry what a number stands for.
    ///
    /// # Errors
    /// When that is nothing that it can have.
    pub(crate) fn apply(&self, entry: &mut T, number: f64) -> Result<(), String> {
        self.field.set(entry, Some(number));
        let stands_for = T::fields().iter().find(|field| field.key == self.key);
        let problem = stands_for.and_then(|field| field.check(field.get(entry)?).err());
        problem.map_or(Ok(()), |problem| Err(format!("`{}` is {number}: {problem}", self.field.key)))
    }

    /// What is wrong where a number is given twice: `is_given` tells of a key.
    pub(crate) fn doubled(&self, is_given: impl Fn(&str) -> bool) -> Option<String> {
        let others = T::sheets().iter().filter(|other| other.key == self.key && other.field.key != self.field.key);
        let other = std::iter::once(self.key).chain(others.map(|other| other.field.key)).find(|key| is_given(key))?;
        Some(format!("`{}` and `{other}` are one number; give one of them", self.field.key))
    }
}

/// Whether a required field has none of the ways in which it can be given.
pub(crate) fn is_absent<T: Entry>(field: &Field<T>, is_given: impl Fn(&str) -> bool) -> bool {
    let stand_ins = T::sheets().iter().filter(|sheet| sheet.key == field.key);
    field.is_required && !is_given(field.key) && !stand_ins.map(|sheet| sheet.field.key).any(is_given)
}

type Get<T> = dyn Fn(&T) -> Option<f64> + Send + Sync;
type Set<T> = dyn Fn(&mut T, Option<f64>) + Send + Sync;

impl<T> Field<T> {
    /// Flag of the command line (`waist-girth-mm`).
    #[must_use]
    pub fn flag(&self) -> String {
        self.key.replace('_', "-")
    }

    /// Its value in an entry.
    #[must_use]
    pub fn get(&self, entry: &T) -> Option<f64> {
        (self.get)(entry)
    }

    /// Gives it a value, or none.
    pub fn set(&self, entry: &mut T, value: Option<f64>) {
        (self.set)(entry, value);
    }

    /// Whether a number is one that it can have.
    ///
    /// # Errors
    /// What was found and what would be accepted.
    pub fn check(&self, number: f64) -> Result<f64, String> {
        let range = &self.range;
        if range.contains(&number) {
            return Ok(number);
        }
        Err(format!("`{}` is {number}; accepted: {} to {}", self.key, range.start(), range.end()))
    }

    /// A value from text; empty text is no value.
    ///
    /// # Errors
    /// What was found and what would be accepted.
    pub fn read(&self, text: &str) -> Result<Option<f64>, String> {
        let range = &self.range;
        let accepted = format!("accepted: {} to {}", range.start(), range.end());
        match text.trim() {
            "" if self.is_required => Err(format!("`{}` is missing; {accepted}", self.key)),
            "" => Ok(None),
            text => match text.parse() {
                Ok(number) => self.check(number).map(Some),
                Err(_) => Err(format!("`{}` is `{text}`, which is no number; {accepted}", self.key)),
            },
        }
    }
}

/// The measurements of a subject: every [`Dimension`] that may be known; names after ISO 8559-1.
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

/// The values of a measurement that a body can be built with, in the unit of its key.
fn body_range(dimension: Dimension) -> RangeInclusive<f64> {
    let [least, greatest] = dimension.range().map(|bound| (bound * dimension.per_si() * 1e6).round() / 1e6);
    least..=greatest
}

/// A number of [`Fabric`] in SI units.
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

/// The numbers of a fabric.
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

/// Sets one of the three numbers of a law that stiffens; one that is taken away takes the law with it.
fn set_stretched(fabric: &mut Fabric, value: Option<f64>, set: fn(&mut Stretched, f64)) {
    let unset = Stretched { stretch: f64::NAN, membrane_warp_n_m: f64::NAN, membrane_weft_n_m: f64::NAN };
    match value {
        Some(value) => set(fabric.stretched.get_or_insert(unset), value),
        None => fabric.stretched = None,
    }
}

/// The sex of a word.
///
/// # Errors
/// What was found and what would be accepted.
pub fn sex(word: &str) -> Result<Sex, String> {
    match word.trim() {
        "male" | "m" | "M" => Ok(Sex::Male),
        "female" | "f" | "F" => Ok(Sex::Female),
        other => Err(format!("sex `{other}`; accepted: male, female")),
    }
}

/// A value that was given for one key of an entry.
pub type Given = (String, String);

/// What can be made from keys and texts: a subject or a fabric.
pub trait Entry: Clone + 'static {
    /// Every number that the entry has, with its key, unit and accepted values.
    fn fields() -> &'static [Field<Self>];

    /// Other ways to give its numbers; a later one may depend on an earlier one.
    fn sheets() -> &'static [Sheet<Self>] {
        &[]
    }

    /// Its texts besides the name, and whether it must have them.
    const TEXTS: &'static [(&'static str, bool)];

    /// One without any value.
    fn blank(name: &str) -> Self;

    /// Gives it a text.
    fn set_text(&mut self, key: &str, text: &str) -> Result<(), String>;

    /// Whether its numbers go together; else the key with what is wrong.
    fn check(&self) -> Result<(), Given> {
        Ok(())
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

/// All keys of an entry.
pub fn keys<T: Entry>() -> Vec<&'static str> {
    let sheets = T::sheets().iter().map(|sheet| sheet.field.key);
    T::TEXTS.iter().map(|(key, _)| *key).chain(T::fields().iter().map(|field| field.key)).chain(sheets).collect()
}

/// Lays given values over an entry, or over a blank one, which then needs all that is required.
///
/// # Errors
/// Every key with what is wrong with its value.
pub fn filled<T: Entry>(base: Option<&T>, name: &str, given: &[Given]) -> Result<T, Vec<Given>> {
    let mut entry = base.cloned().unwrap_or_else(|| T::blank(name));
    let mut problems = Vec::new();
    let is_given = |key: &str| given.iter().any(|(given, _)| given == key);
    let is_sheet = |key: &str| T::sheets().iter().any(|sheet| sheet.field.key == key);
    for (key, text) in given.iter().filter(|(key, _)| !is_sheet(key)) {
        let done = if T::TEXTS.iter().any(|(name, _)| name == key) {
            entry.set_text(key, text)
        } else if let Some(field) = T::fields().iter().find(|field| field.key == key) {
            field.read(text).map(|value| field.set(&mut entry, value))
        } else {
            let hint = match nearest(key, keys::<T>()) {
                Some(near) => format!("did you mean `{near}`?"),
                None => format!("accepted: {}", keys::<T>().join(", ")),
            };
            Err(format!("unknown value `{key}`; {hint}"))
        };
        problems.extend(done.err().map(|problem| (key.clone(), problem)));
    }
    for sheet in T::sheets() {
        let key = sheet.field.key;
        let Some((_, text)) = given.iter().find(|(given, _)| given == key) else { continue };
        let number = sheet.field.read(text).and_then(|number| number.ok_or_else(|| format!("`{key}` has no value")));
        let applied = number.and_then(|number| sheet.apply(&mut entry, number));
        let problem = sheet.doubled(is_given).map_or(applied, Err);
        problems.extend(problem.err().map(|problem| (key.to_owned(), problem)));
    }
    if base.is_none() {
        let texts = T::TEXTS.iter().filter(|(key, is_required)| *is_required && !is_given(key)).map(|(key, _)| *key);
        let numbers = T::fields().iter().filter(|field| is_absent(*field, is_given)).map(|field| field.key);
        problems.extend(texts.chain(numbers).map(|key| (key.to_owned(), format!("`{key}` is missing"))));
    }
    problems.extend(entry.check().err());
    if problems.is_empty() { Ok(entry) } else { Err(problems) }
}

/// Name of a subject's sex in SQL and study files.
pub fn sex_name(m: &Measurements) -> &'static str {
    match m.sex {
        Sex::Male => "male",
        Sex::Female => "female",
    }
}

/// A length as written in millimetres, to a nanometre: metres and back do not change it.
pub fn millimetres(length_m: f64) -> f64 {
    (mm(length_m) * 1e6).round() / 1e6
}

#[cfg(test)]
mod tests {
    use super::*;

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
                "`stature_mm` is `1,65`, which is no number; accepted: 1300 to 2200",
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

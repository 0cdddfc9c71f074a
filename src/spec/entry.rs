//! Entries of the catalogue (subjects, fabrics), made of named numbers and texts. Study files, imported tables, flags
//! and forms are all read here, so all of them accept the same values.

use std::ops::RangeInclusive;

use store::nearest;

/// One number of an entry of the catalogue, in the unit that ends its key.
pub struct Field<T: 'static> {
    /// Key in study files, tables and SQL (`waist_girth_mm`).
    pub key: &'static str,
    /// Name on screens and in help.
    pub label: &'static str,
    pub is_required: bool,
    pub(crate) range: RangeInclusive<f64>,
    pub(crate) get: Box<Get<T>>,
    pub(crate) set: Box<Set<T>>,
}

/// Another way to give a number of an entry, such as in another unit or by another test.
pub struct Sheet<T: 'static> {
    pub field: Field<T>,
    /// Key of the [`Field`] that the number is converted to.
    pub key: &'static str,
}

impl<T: Entry> Sheet<T> {
    pub(crate) fn apply(&self, entry: &mut T, number: f64) -> Result<(), String> {
        self.field.set(entry, Some(number));
        let stands_for = T::fields().iter().find(|field| field.key == self.key);
        let problem = stands_for.and_then(|field| field.check(field.get(entry)?).err());
        problem.map_or(Ok(()), |problem| Err(format!("`{}` is {number}: {problem}", self.field.key)))
    }

    /// Problem of a field that is given in two ways. `is_given` is true for keys that are given.
    pub(crate) fn doubled(&self, is_given: impl Fn(&str) -> bool) -> Option<String> {
        let others = T::sheets().iter().filter(|other| other.key == self.key && other.field.key != self.field.key);
        let other = std::iter::once(self.key).chain(others.map(|other| other.field.key)).find(|key| is_given(key))?;
        Some(format!("`{}` and `{other}` are one number; give one of them", self.field.key))
    }
}

pub(crate) fn is_absent<T: Entry>(field: &Field<T>, is_given: impl Fn(&str) -> bool) -> bool {
    let stand_ins = T::sheets().iter().filter(|sheet| sheet.key == field.key);
    field.is_required && !is_given(field.key) && !stand_ins.map(|sheet| sheet.field.key).any(is_given)
}

type Get<T> = dyn Fn(&T) -> Option<f64> + Send + Sync;
type Set<T> = dyn Fn(&mut T, Option<f64>) + Send + Sync;

impl<T> Field<T> {
    /// Flag of the command line (`waist-girth-mm`).
    pub fn flag(&self) -> String {
        self.key.replace('_', "-")
    }

    pub fn get(&self, entry: &T) -> Option<f64> {
        (self.get)(entry)
    }

    /// `None` takes it away.
    pub fn set(&self, entry: &mut T, value: Option<f64>) {
        (self.set)(entry, value);
    }

    /// Least and greatest number.
    pub fn accepted(&self) -> [f64; 2] {
        [*self.range.start(), *self.range.end()]
    }

    pub fn check(&self, number: f64) -> Result<f64, String> {
        let range = &self.range;
        if range.contains(&number) {
            return Ok(number);
        }
        Err(format!("`{}` is {number}; accepted: {} to {}", self.key, range.start(), range.end()))
    }

    /// `None` for empty text.
    pub fn read(&self, text: &str) -> Result<Option<f64>, String> {
        let range = &self.range;
        let accepted = format!("accepted: {} to {}", range.start(), range.end());
        match text.trim() {
            "" if self.is_required => Err(format!("`{}` is missing; {accepted}", self.key)),
            "" => Ok(None),
            text => match decimal(text) {
                Some(number) => self.check(number).map(Some),
                None => Err(format!("`{}` is `{text}`, which is no number; {accepted}", self.key)),
            },
        }
    }
}

/// Number of a text, with a point or a comma before its decimals. A comma before three digits may part thousands, so
/// that text is no number.
pub fn decimal(text: &str) -> Option<f64> {
    let Some((whole, decimals)) = text.split_once(',') else { return text.parse().ok() };
    let is_plain = !decimals.is_empty() && decimals.chars().all(|letter| letter.is_ascii_digit());
    if !is_plain || decimals.len() == 3 || whole.contains('.') {
        return None;
    }
    format!("{whole}.{decimals}").parse().ok()
}

/// Key of an entry, and its value as text.
pub type Given = (String, String);

/// An entry of the catalogue, made from keys and texts: the measurements of a subject, or a fabric.
pub trait Entry: Clone + 'static {
    fn fields() -> &'static [Field<Self>];

    /// Other ways to give these numbers, in an order in which a conversion uses only numbers before it.
    fn sheets() -> &'static [Sheet<Self>] {
        &[]
    }

    /// Keys of the texts besides the name, each with true where the text is required.
    const TEXTS: &'static [(&'static str, bool)];

    fn blank(name: &str) -> Self;

    fn set_text(&mut self, key: &str, text: &str) -> Result<(), String>;

    /// Checks that the numbers go together; the error is a key with its problem.
    fn check(&self) -> Result<(), Given> {
        Ok(())
    }
}

pub fn keys<T: Entry>() -> Vec<&'static str> {
    let sheets = T::sheets().iter().map(|sheet| sheet.field.key);
    T::TEXTS.iter().map(|(key, _)| *key).chain(T::fields().iter().map(|field| field.key)).chain(sheets).collect()
}

/// Sets given values in a copy of `base`. Without `base` begins with a blank entry, which then needs all required
/// values.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decimals_follow_a_point_or_a_comma() {
        let check = |text: &str, expect: Option<f64>| assert_eq!(decimal(text), expect, "{text}");
        check("91.5", Some(91.5));
        check("91,5", Some(91.5));
        check("-0,25", Some(-0.25));
        check("2e-5", Some(2e-5));
        check("1,700", None);
        check("1.700,5", None);
        check("1,7,5", None);
        check("91,", None);
        check("91,5e3", None);
        check("tall", None);
    }
}

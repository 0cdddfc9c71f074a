//! Entries of the catalogue, made of named numbers and texts. Study files, imported tables, flags and forms all go through
//! here, so that a value is accepted everywhere or nowhere.

use std::ops::RangeInclusive;

use store::nearest;

/// One number of an entry of the catalogue, in the unit its key ends with.
pub struct Field<T: 'static> {
    /// Key in study files, tables and SQL (`waist_girth_mm`).
    pub key: &'static str,
    /// Name on screens and in help.
    pub label: &'static str,
    /// Whether no entry is without it.
    pub is_required: bool,
    pub(crate) range: RangeInclusive<f64>,
    pub(crate) get: Box<Get<T>>,
    pub(crate) set: Box<Set<T>>,
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

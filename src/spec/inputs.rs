//! Inputs of a job as named values. Their hash is the key of the result, and their changes explain a miss of the cache.

use std::collections::BTreeMap;
use std::fmt;

use store::StageKind;

/// Named values, such as `fabric.cotton_shirting_light.density_kg_m2 = 0.1036`.
#[derive(Clone, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(transparent)]
pub struct Inputs(BTreeMap<String, String>);

/// First part of the input's name decides.
fn depends_on(stage: StageKind, name: &str) -> bool {
    let group = name.split('.').next().unwrap_or_default();
    match stage {
        StageKind::Body => matches!(group, "subject" | "body"),
        StageKind::Field => matches!(group, "subject" | "body" | "field"),
        StageKind::Mesh => matches!(group, "pattern" | "seams" | "mesh"),
        StageKind::Drape => group != "measure",
    }
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Change {
    pub name: String,
    /// `None` where the input is new.
    pub before: Option<String>,
    /// `None` where the input is gone.
    pub after: Option<String>,
}

impl fmt::Display for Change {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (&self.before, &self.after) {
            (Some(before), Some(after)) => write!(f, "{}: {} -> {}", self.name, short(before), short(after)),
            (None, Some(after)) => write!(f, "{}: new, {}", self.name, short(after)),
            (Some(before), None) => write!(f, "{}: gone, was {}", self.name, short(before)),
            (None, None) => write!(f, "{}", self.name),
        }
    }
}

/// Shortens a hash to its first 8 digits; other values stay whole.
fn short(value: &str) -> &str {
    let is_hash = value.len() == 64 && value.bytes().all(|byte| byte.is_ascii_hexdigit());
    if is_hash { &value[..8] } else { value }
}

impl Inputs {
    pub fn set(&mut self, name: impl Into<String>, value: impl fmt::Display) {
        self.0.insert(name.into(), value.to_string());
    }

    pub fn iter(&self) -> impl Iterator<Item = (&str, &str)> {
        self.0.iter().map(|(name, value)| (name.as_str(), value.as_str()))
    }

    pub fn hash(&self) -> String {
        self.hash_of(|_| true).to_hex().to_string()
    }

    pub fn digest(&self) -> [u8; 32] {
        *self.hash_of(|_| true).as_bytes()
    }

    /// Hash of a stage and of the inputs that it depends on, hex.
    pub fn stage_hash(&self, stage: StageKind) -> String {
        let mut hasher = blake3::Hasher::new();
        hasher.update(stage.as_str().as_bytes());
        hasher.update(self.hash_of(|name| depends_on(stage, name)).to_hex().as_bytes());
        hasher.finalize().to_hex().to_string()
    }

    /// Puts the length of each text before it, so that no two lists of inputs have the same bytes.
    fn hash_of(&self, matters: impl Fn(&str) -> bool) -> blake3::Hash {
        let mut hasher = blake3::Hasher::new();
        for (name, value) in self.0.iter().filter(|(name, _)| matters(name)) {
            for text in [name, value] {
                hasher.update(&(text.len() as u64).to_le_bytes());
                hasher.update(text.as_bytes());
            }
        }
        hasher.finalize()
    }

    /// Sorted by name.
    pub fn changes_since(&self, earlier: &Self) -> Vec<Change> {
        let mut names: Vec<&String> = self.0.keys().chain(earlier.0.keys()).collect();
        names.sort();
        names.dedup();
        names
            .into_iter()
            .filter(|name| self.0.get(*name) != earlier.0.get(*name))
            .map(|name| Change {
                name: name.clone(),
                before: earlier.0.get(name).cloned(),
                after: self.0.get(name).cloned(),
            })
            .collect()
    }
}

impl FromIterator<(String, String)> for Inputs {
    fn from_iter<I: IntoIterator<Item = (String, String)>>(pairs: I) -> Self {
        Self(pairs.into_iter().collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn inputs(pairs: &[(&str, &str)]) -> Inputs {
        pairs.iter().map(|(name, value)| ((*name).to_owned(), (*value).to_owned())).collect()
    }

    #[test]
    fn a_stage_depends_on_its_own_inputs_only() {
        let old = inputs(&[("subject.ii.stature_mm", "1690"), ("fabric.c.shear_n_m", "97"), ("seams.tee", "a")]);
        let check = |changed: &str, expected: &[StageKind]| {
            let mut new = old.clone();
            new.set(changed, "other");
            let missed: Vec<StageKind> =
                StageKind::ALL.into_iter().filter(|&stage| new.stage_hash(stage) != old.stage_hash(stage)).collect();
            assert_eq!(missed, expected, "{changed}");
        };
        check("subject.ii.stature_mm", &[StageKind::Body, StageKind::Field, StageKind::Drape]);
        check("fabric.c.shear_n_m", &[StageKind::Drape]);
        check("seams.tee", &[StageKind::Mesh, StageKind::Drape]);
        check("measure.version", &[]);
    }

    #[test]
    fn names_and_values_do_not_run_into_each_other() {
        assert_ne!(inputs(&[("a", "bc")]).hash(), inputs(&[("ab", "c")]).hash());
        assert_ne!(inputs(&[("a", "b"), ("c", "d")]).hash(), inputs(&[("a", "bcd")]).hash());
    }

    #[test]
    fn changes_are_named() {
        let old = inputs(&[("a", "1"), ("b", "2"), ("gone", "3")]);
        let new = inputs(&[("a", "1"), ("b", &"f".repeat(64)), ("new", "4")]);
        let told: Vec<String> = new.changes_since(&old).iter().map(Change::to_string).collect();
        assert_eq!(told, ["b: 2 -> ffffffff", "gone: gone, was 3", "new: new, 4"]);
    }
}

//! Studies, subjects, sizes and fabrics that the palette can go to by name.

use crate::keys::screen::Screen;
use crate::messages::snapshot::Snapshot;

/// A study or an entry of the catalogue.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Thing {
    Study(String),
    Subject(String),
    /// Style, then size.
    Size(String, String),
    Fabric(String),
}

impl Thing {
    pub fn all(data: Option<&Snapshot>) -> Vec<Self> {
        let Some(data) = data else { return vec![] };
        let studies = data.studies.iter().map(|row| Self::Study(row.name.clone()));
        let subjects = data.subjects.iter().map(|row| Self::Subject(row.name.clone()));
        let sizes = data.sizes.iter().map(|row| Self::Size(row.style.clone(), row.size.clone()));
        let fabrics = data.fabrics.iter().map(|row| Self::Fabric(row.fabric.name.clone()));
        studies.chain(subjects).chain(sizes).chain(fabrics).collect()
    }

    /// Kind and name.
    pub fn words(&self) -> (&'static str, String) {
        match self {
            Self::Study(name) => ("study", name.clone()),
            Self::Subject(name) => ("subject", name.clone()),
            Self::Size(style, size) => ("style", format!("{style} {size}")),
            Self::Fabric(name) => ("fabric", name.clone()),
        }
    }

    pub fn screen(&self) -> Screen {
        match self {
            Self::Study(_) => Screen::Study,
            Self::Subject(_) => Screen::Subjects,
            Self::Size(..) => Screen::Styles,
            Self::Fabric(_) => Screen::Fabrics,
        }
    }

    /// Number of letters that lie between those of a text in these words; `None` where the words do not have its letters
    /// in order.
    pub fn distance(&self, text: &str) -> Option<usize> {
        let (what, name) = self.words();
        let words: Vec<char> = format!("{what} {name}").to_lowercase().chars().collect();
        let wanted: Vec<char> = text.to_lowercase().chars().filter(|letter| !letter.is_whitespace()).collect();
        let first = *wanted.first()?;
        let starts = (0..words.len()).filter(|start| words[*start] == first);
        let from = |start: usize| {
            let mut at = start;
            for letter in &wanted[1..] {
                at = at + 1 + words[at + 1..].iter().position(|other| other == letter)?;
            }
            Some(at - start + 1 - wanted.len())
        };
        starts.filter_map(from).min()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn things_are_found_by_letters_in_order() {
        let check =
            |thing: Thing, text: &str, expect: Option<usize>| assert_eq!(thing.distance(text), expect, "{text}");
        check(Thing::Study("quickstart".into()), "quick", Some(0));
        check(Thing::Study("quickstart".into()), "qst", Some(4));
        check(Thing::Subject("male-ii".into()), "male ii", Some(1));
        check(Thing::Subject("male-ii".into()), "subject m", Some(1));
        check(Thing::Size("polo".into(), "50".into()), "polo50", Some(1));
        check(Thing::Fabric("denim_raw".into()), "xyz", None);
        check(Thing::Fabric("denim_raw".into()), "", None);
    }
}

//! What a piece's name says, in the languages of [`super::words`].
//!
//! A name is cut into words, and a word that is none of the trade's into words of the trade: `Vorderhose` is `vorder` and `hose`. What is
//! left over makes it another word: a `frock` is no German skirt, a `palazzo` no Portuguese yoke.

use std::collections::BTreeMap;
use std::sync::LazyLock;

use super::words::{CLASSES, FACES, HANDS, PARTS, PLAIN};
use super::{Class, Face, Hand};

/// What is read from a name.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Named {
    /// Kind of piece.
    pub class: Option<Class>,
    /// Front or back.
    pub face: Option<Face>,
    /// Side of the wearer.
    pub hand: Option<Hand>,
    /// Which part of its kind it is.
    pub part: Option<Part>,
}

/// What tells parts of one kind from each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// The piece below the arm of a sleeve in two.
    Under,
    /// A gore of a skirt: one part among several alike.
    Gore,
    /// Any part of a garment.
    Panel,
}

impl Named {
    /// What it says together with another; of two kinds, faces, hands or parts the one that is listed first.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        fn first<T: Copy + PartialEq>(a: Option<T>, b: Option<T>, order: impl Iterator<Item = T>) -> Option<T> {
            order.into_iter().find(|&one| a == Some(one) || b == Some(one)).or(a).or(b)
        }
        Self {
            class: first(self.class, other.class, CLASSES.iter().map(|(class, _)| *class)),
            face: first(self.face, other.face, Face::BOTH.into_iter()),
            hand: first(self.hand, other.hand, Hand::BOTH.into_iter()),
            part: first(self.part, other.part, PARTS.iter().map(|(part, _)| *part)),
        }
    }

    /// Whether it says neither a kind, nor front or back, nor a side.
    #[must_use]
    pub fn is_nameless(self) -> bool {
        (self.class, self.face, self.hand) == (None, None, None)
    }
}

/// Words after which a name tells only of a detail (`front with pocket`).
const DETAILS: [&str; 13] =
    ["no", "with", "without", "ohne", "mit", "sans", "avec", "con", "sin", "senza", "met", "zonder", "без"];

/// First letter of the scripts that put a word or a syllable in a sign.
const SIGNS: char = '\u{2e80}';
/// Scripts whose words hold marks beside their letters.
const MARKED: std::ops::Range<char> = '\u{900}'..'\u{e00}';
/// Letters of a word from which on it is a word in compounds too, in an alphabet.
const LEAST_IN_COMPOUND: usize = 3;
/// Most letters that an ending has.
const LONGEST_ENDING: usize = 3;

/// Words of a name, in lower case: it is cut where letters end, where capitals begin, and between alphabets and signs.
#[must_use]
pub fn words(name: &str) -> Vec<String> {
    let mut words: Vec<String> = Vec::new();
    let mut before: Option<char> = None;
    for c in name.chars() {
        if !c.is_alphabetic() && !MARKED.contains(&c) {
            // An article that is cut short is no initial.
            if matches!(c, '\'' | '\u{2019}') && before.is_some() {
                words.pop_if(|word| word.chars().count() == 1);
            }
            before = None;
            continue;
        }
        let goes_on = |before: char| (before >= SIGNS) == (c >= SIGNS) && !(before.is_lowercase() && c.is_uppercase());
        match words.last_mut().filter(|_| before.is_some_and(goes_on)) {
            Some(word) => word.extend(c.to_lowercase()),
            None => words.push(c.to_lowercase().collect()),
        }
        before = Some(c);
    }
    words
}

/// Tells kind, face and hand of a piece from its name.
#[must_use]
pub fn read(name: &str) -> Named {
    let words = words(name);
    read_words(&words.iter().map(String::as_str).collect::<Vec<_>>(), false)
}

/// What the words of a name say together; an initial says front or back where the kind of piece is said or known.
#[must_use]
pub fn read_words(words: &[&str], is_kind_known: bool) -> Named {
    let words = || words.iter().take_while(|word| !DETAILS.contains(word));
    let said = words().filter_map(|word| word_of(word)).fold(Named::default(), Named::and);
    let is_known = is_kind_known || said.class.is_some();
    let is_initial = |initial: &str| is_known && words().any(|word| *word == initial);
    let face = said.face.or(if is_initial("f") {
        Some(Face::Front)
    } else if is_initial("b") {
        Some(Face::Back)
    } else {
        None
    });
    Named { face, ..said }
}

/// What a word says: one of the trade's, or a compound of such; `None` for any other.
#[must_use]
pub fn word_of(word: &str) -> Option<Named> {
    let ends: Vec<usize> = word.char_indices().map(|(at, _)| at).chain([word.len()]).collect();
    // The fewest words of the trade that make up the beginning, with what they say.
    let mut made: Vec<Option<(usize, Named)>> = vec![None; ends.len()];
    made[0] = Some((0, Named::default()));
    for from in 0..ends.len() - 1 {
        let Some((count, said)) = made[from] else { continue };
        for to in from + 1..ends.len() {
            let is_whole = from == 0 && to + 1 == ends.len();
            let Some(named) = listed(&word[ends[from]..ends[to]], to + 1 == ends.len(), is_whole) else { continue };
            let found = (count + 1, said.and(named));
            // An `s` behind a word makes it several, or joins it to the next.
            let joined = (word[ends[to]..].starts_with('s')).then_some(to + 1);
            for to in [Some(to), joined].into_iter().flatten() {
                if made[to].is_none_or(|(fewest, _)| count + 1 < fewest) {
                    made[to] = Some(found);
                }
            }
        }
    }
    made[ends.len() - 1].map(|(_, named)| named)
}

/// What a word of the trade says; one of few letters is none in a compound, and a stem has its ending where the compound ends.
fn listed(word: &str, is_last: bool, is_whole: bool) -> Option<Named> {
    let is_sign = word.chars().all(|c| c >= SIGNS);
    let letters = word.chars().count();
    if !is_whole && !is_sign && letters < LEAST_IN_COMPOUND {
        return None;
    }
    let ends = [word.len()].into_iter().chain(word.char_indices().map(|(at, _)| at).rev().take(LONGEST_ENDING));
    let stem = ends.filter(|_| is_last).find_map(|at| STEMS.get(&word[..at]).copied());
    let (whole, stem) = (WORDS.get(word).copied(), stem);
    whole.map(|named| named.and(stem.unwrap_or_default())).or(stem)
}

/// Every word with what it says.
static WORDS: LazyLock<BTreeMap<&str, Named>> = LazyLock::new(|| lexicon(false));
/// The same of stems.
static STEMS: LazyLock<BTreeMap<&str, Named>> = LazyLock::new(|| lexicon(true));

fn lexicon(of_stems: bool) -> BTreeMap<&'static str, Named> {
    let plain = Named::default();
    let classes = CLASSES.iter().map(|(class, words)| (Named { class: Some(*class), ..plain }, *words));
    let faces = FACES.iter().map(|(face, words)| (Named { face: Some(*face), ..plain }, *words));
    let hands = HANDS.iter().map(|(hand, words)| (Named { hand: Some(*hand), ..plain }, *words));
    let parts = PARTS.iter().map(|(part, words)| (Named { part: Some(*part), ..plain }, *words));
    let mut all: BTreeMap<&str, Named> = BTreeMap::new();
    for (named, words) in classes.chain(faces).chain(hands).chain(parts).chain([(plain, PLAIN)]) {
        for word in words {
            if word.ends_with('-') == of_stems {
                let said = all.entry(word.trim_end_matches('-')).or_default();
                *said = said.and(named);
            }
        }
    }
    all
}
#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_many_languages_are_read() {
        let check = |name: &str, class: Option<Class>, face: Option<Face>, hand: Option<Hand>| {
            assert_eq!(Named { part: None, ..read(name) }, Named { class, face, hand, part: None }, "{name}");
        };
        use Class::{Cuff, Leg, Other, Skirt, Sleeve, Waistband, Yoke};
        use Face::{Back, Front};
        check("TEAGAN FRONT", None, Some(Front), None);
        check("Front_636968_M", None, Some(Front), None);
        check("BELLA_FRONTSIDEDART_36", None, Some(Front), None);
        check("FRONT_WITH_POCKET", None, Some(Front), None);
        check("PACO FRONTPOCKETBAG", Some(Other), Some(Front), None);
        check("right_btorso", None, Some(Back), Some(Hand::Right));
        check("pant_f_r", Some(Leg), Some(Front), Some(Hand::Right));
        check("sl_left_cuff_b", Some(Cuff), Some(Back), Some(Hand::Left));
        check("wb_front", Some(Waistband), Some(Front), None);
        check("Vorderhose links", Some(Leg), Some(Front), Some(Hand::Left));
        check("Rückenteil", None, Some(Back), None);
        check("manche droite", Some(Sleeve), None, Some(Hand::Right));
        check("falda delantero", Some(Skirt), Some(Front), None);
        check("Manica", Some(Sleeve), None, None);
        check("achterpand", None, Some(Back), None);
        check("Рукав", Some(Sleeve), None, None);
        check("Спинка", None, Some(Back), None);
        check("Полочка", None, Some(Front), None);
        check("Підборт", Some(Other), None, None);
        check("CORNELIUS ZIPPERGUARD", Some(Other), None, None);
        check("Застёжка-молния", Some(Other), None, None);
        check("YOKE", Some(Yoke), None, None);
        check("Back Yoke", Some(Yoke), Some(Back), None);
        check("YOKE LINING", Some(Other), None, None);
        check("Кокетка спинки", Some(Yoke), Some(Back), None);
        check("CUFFINTERFACE", Some(Other), None, None);
        check("Pattentasche", Some(Other), None, None);
        check("\u{524d}\u{7247}", None, Some(Front), None);
        check("\u{5f8c}\u{8eab}\u{9803}", None, Some(Back), None);
        check("\u{5de6}\u{8896}", Some(Sleeve), None, Some(Hand::Left));
        check("\u{c18c}\u{b9e4}", Some(Sleeve), None, None);
        check("Ön beden", None, Some(Front), None);
        check("Arka etek", Some(Skirt), Some(Back), None);
        check("sağ kol", Some(Sleeve), None, Some(Hand::Right));
        check("Framstycke", None, Some(Front), None);
        check("zadní díl", None, Some(Back), None);
        check("Μανίκι", Some(Sleeve), None, None);
        check("tay áo", Some(Sleeve), None, None);
        check("?????", None, None, None);
        check("DETAIL", None, None, None);
        for (name, expect) in [("UNDERSLEEVE", true), ("Unterärmel", true), ("TOPSLEEVE", false), ("Sleeve", false)] {
            assert_eq!(read(name).part == Some(Part::Under), expect, "{name}");
        }
    }
}

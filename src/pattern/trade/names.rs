//! Reading of the names of pieces, in the languages of `words`.
//!
//! A name is split into words. A word that is no garment term is divided into terms: `Vorderhose` is `vorder` and
//! `hose`. If anything remains, the word is another one: a `frock` is no German skirt, a `palazzo` no Portuguese yoke.

use std::collections::BTreeMap;
use std::sync::LazyLock;

use super::words::{CLASSES, FACES, HANDS, PARTS, PLAIN};
use super::{Class, Face, Hand, PartName};

/// Statement of a name about a piece. `None` for what it does not say.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Named {
    pub class: Option<Class>,
    pub face: Option<Face>,
    pub hand: Option<Hand>,
    pub part: Option<PartName>,
}

impl Named {
    /// Combines two statements. Of two kinds, faces, hands or parts, the one that is listed first counts.
    pub fn and(self, other: Self) -> Self {
        fn first<T: Copy + PartialEq>(a: Option<T>, b: Option<T>, order: impl Iterator<Item = T>) -> Option<T> {
            order.into_iter().find(|&listed| a == Some(listed) || b == Some(listed)).or(a).or(b)
        }
        Self {
            class: first(self.class, other.class, CLASSES.iter().map(|(class, _)| *class)),
            face: first(self.face, other.face, Face::BOTH.into_iter()),
            hand: first(self.hand, other.hand, Hand::BOTH.into_iter()),
            part: first(self.part, other.part, PARTS.iter().map(|(part, _)| *part)),
        }
    }

    /// True if neither kind, nor front or back, nor side is given.
    pub fn is_nameless(self) -> bool {
        (self.class, self.face, self.hand) == (None, None, None)
    }
}

/// Words after which a name describes only a detail (`front with pocket`).
const DETAILS: [&str; 13] =
    ["no", "with", "without", "ohne", "mit", "sans", "avec", "con", "sin", "senza", "met", "zonder", "без"];

/// First character of the scripts that write a word or a syllable as one sign.
const SIGNS: char = '\u{2e80}';
/// Scripts whose words contain combining marks.
const MARKED: std::ops::Range<char> = '\u{900}'..'\u{e00}';
/// Least number of letters of an alphabetic word inside a compound.
const LEAST_IN_COMPOUND: usize = 3;
const LONGEST_ENDING: usize = 3;

/// Splits at other characters than letters, before capitals, and between alphabets and signs; in lower case.
pub fn words(name: &str) -> Vec<String> {
    let mut words: Vec<String> = Vec::new();
    let mut before: Option<char> = None;
    for c in name.chars() {
        if !c.is_alphabetic() && !MARKED.contains(&c) {
            // An elided article (`d'`, `l'`) is not an initial.
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

pub fn read(name: &str) -> Named {
    let words = words(name);
    read_words(&words.iter().map(String::as_str).collect::<Vec<_>>(), false)
}

/// Initials `f` and `b` mean front and back if the kind of piece is known.
pub fn read_words(words: &[&str], is_kind_known: bool) -> Named {
    let words = || words.iter().take_while(|word| !DETAILS.contains(word));
    // Terms that are written as two words: `neck band`, `waist band`.
    let both =
        words().zip(words().skip(1)).filter_map(|(first, second)| WORDS.get(format!("{first}{second}").as_str()));
    let said = words().filter_map(|word| word_of(word)).chain(both.copied()).fold(Named::default(), Named::and);
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

/// Takes a garment term or a compound of terms. `None` for any other word.
pub fn word_of(word: &str) -> Option<Named> {
    let ends: Vec<usize> = word.char_indices().map(|(at, _)| at).chain([word.len()]).collect();
    // For each beginning of the word, the fewest terms that make it up, with their statement. `None` if no terms do.
    let mut made: Vec<Option<(usize, Named)>> = vec![None; ends.len()];
    made[0] = Some((0, Named::default()));
    for from in 0..ends.len() - 1 {
        let Some((count, said)) = made[from] else { continue };
        for to in from + 1..ends.len() {
            let is_whole = from == 0 && to + 1 == ends.len();
            let Some(named) = listed(&word[ends[from]..ends[to]], to + 1 == ends.len(), is_whole) else { continue };
            let found = (count + 1, said.and(named));
            // An `s` after a term is a plural, or joins the term to the next.
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

/// Short terms do not count inside a compound, and a stem takes its ending at the end of one.
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

static WORDS: LazyLock<BTreeMap<&str, Named>> = LazyLock::new(|| lexicon(false));
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
        check("TATE_NECK_BAND", Some(Other), None, None);
        check("WAIST BAND BACK", Some(Waistband), Some(Back), None);
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
            assert_eq!(read(name).part == Some(PartName::Under), expect, "{name}");
        }
    }
}

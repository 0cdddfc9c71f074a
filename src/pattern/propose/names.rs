//! What a piece's name says, in the languages of [`super::words`].

use super::words::{CLASSES, FACES, HANDS};
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
}

/// Parts of words that say the lower piece of a sleeve in two.
const UNDER: [&str; 8] = ["under", "lower", "unter", "dessous", "inferior", "onder", "spodni", "нижн"];

/// Words after which a name tells only of a detail (`front with pocket`).
const DETAILS: [&str; 13] =
    ["no", "with", "without", "ohne", "mit", "sans", "avec", "con", "sin", "senza", "met", "zonder", "без"];

/// Tells kind, face and hand of a piece from the words of its name.
#[must_use]
pub fn read(name: &str) -> Named {
    let lower = name.to_lowercase();
    let words: Vec<&str> = lower
        .split(|c: char| !c.is_alphabetic())
        .filter(|word| !word.is_empty())
        .take_while(|word| !DETAILS.contains(word))
        .collect();
    // A part of up to three letters must be a whole word, but for scripts that put a word or a syllable in a sign.
    let is_long = |part: &str| part.chars().count() > 3 || part.chars().all(|c| c >= '\u{900}');
    let has = |part: &&str| words.iter().any(|word| word == part || (is_long(part) && word.contains(*part)));
    let has_any = |parts: &&[&str]| parts.iter().any(has);
    let class = CLASSES.iter().find(|(_, parts)| has_any(parts)).map(|(class, _)| *class);
    let is_initial = |initial: &str| class.is_some() && words.contains(&initial);
    let face = FACES.iter().find(|(_, parts)| has_any(parts)).map(|(face, _)| *face);
    let face = face.or(if is_initial("f") {
        Some(Face::Front)
    } else if is_initial("b") {
        Some(Face::Back)
    } else {
        None
    });
    let is_hand = |part: &&str| words.contains(part) || (part.chars().all(|c| c >= '\u{900}') && has(part));
    let hand = HANDS.iter().find(|(_, parts)| parts.iter().any(is_hand)).map(|(hand, _)| *hand);
    Named { class, face, hand }
}

/// Parts of words that name a gore of a skirt.
const GORES: [&str; 4] = ["gore", "bahn", "nesga", "клин"];
/// Parts of words that name any part of a garment.
const PANELS: [&str; 2] = ["panel", "paneel"];

/// Whether a name is that of a gore: one part of a skirt among several alike.
#[must_use]
pub fn is_gore(name: &str) -> bool {
    let lower = name.to_lowercase();
    GORES.iter().any(|part| lower.contains(part))
}

/// Whether a name says no more than that it is a part.
#[must_use]
pub fn is_panel(name: &str) -> bool {
    let lower = name.to_lowercase();
    PANELS.iter().any(|part| lower.contains(part))
}

/// Whether the name of a sleeve says that it is the piece below the arm of a sleeve in two.
#[must_use]
pub fn is_under_sleeve(name: &str) -> bool {
    let lower = name.to_lowercase();
    UNDER.iter().any(|part| lower.contains(part))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_many_languages_are_read() {
        let check = |name: &str, class: Option<Class>, face: Option<Face>, hand: Option<Hand>| {
            assert_eq!(read(name), Named { class, face, hand }, "{name}");
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
            assert_eq!(is_under_sleeve(name), expect, "{name}");
        }
    }
}

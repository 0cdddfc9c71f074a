//! What a file says of its pieces beside their names: categories and other texts, and the letters that a style number ends in.
//!
//! A CAD program calls the pieces of style `AB12` `AB12FR`, `AB12BK`, `AB12SL`. What all names have in common tells nothing of any piece.
//! What is left is a word, or one of the trade's abbreviations.

use super::{Class, Face, names};
use crate::piece::Piece;

/// Keys of texts that say what a piece is, in lower case.
const KEYS: [&str; 7] = ["category", "piece description", "piece_name", "piece_id", "piece id", "type", "part"];
/// Keys of texts that also tell how to cut it: `CUT 2 FABRIC, 2 LINING` makes no lining of a front.
const REMARKS: [&str; 2] = ["annotation", "description"];

/// Abbreviations of the trade, whole words in lower case, and what they are written out to.
const ABBREVIATIONS: [(&str, &[&str]); 12] = [
    ("front", &["f", "fr", "frt", "frnt", "fa", "vt"]),
    ("back", &["b", "bk", "bck", "ba"]),
    ("sleeve", &["sl", "slv", "sle", "ss", "ls"]),
    ("waistband", &["wb", "wstb"]),
    ("yoke", &["yk", "yo"]),
    ("cuff", &["cu", "cuf", "cff"]),
    ("collar", &["co", "clr", "col", "clst", "cs"]),
    ("leg", &["ll", "leg"]),
    ("hood", &["ho", "hd"]),
    ("pocket", &["pk", "pkt", "pkb"]),
    ("placket", &["pl", "plkt", "plk"]),
    ("interlining", &["int", "intl", "lin", "lng"]),
];

/// Letters that a word of several runs into its style's name with (`RUNNERBK`), longest first.
const ENDINGS: [(&str, &[&str]); 3] = [("front", &["frt", "fr"]), ("back", &["bck", "bk"]), ("sleeve", &["slv", "sl"])];

/// Pieces with what the file says of each.
pub fn told(pieces: &[Piece]) -> Vec<Piece> {
    let common = common_start(pieces);
    let rest = |piece: &Piece| piece.name.get(common..).unwrap_or_default().to_owned();
    let is_kind = |name: &str| names::read(name).class.is_some();
    let tells_kind = |rest: &str| is_kind(rest) || written_out(rest).is_some_and(|words| is_kind(&words));
    // A word that all names begin with, as a style called by its waistband has it, tells nothing where the rest of a name does.
    let is_of_style = pieces.first().is_some_and(|piece| is_kind(piece.name.get(..common).unwrap_or_default()))
        && pieces.iter().any(|piece| tells_kind(&rest(piece)));
    let said = |piece: &Piece| -> String {
        let texts = |keys: &'static [&str]| {
            let of_keys = piece.texts.iter().filter(move |(key, _)| keys.contains(&key.to_lowercase().as_str()));
            of_keys.map(|(_, value)| value.as_str())
        };
        let tells = |text: &&str| {
            let named = names::read(text);
            named.class.is_some() || named.face.is_some()
        };
        let is_plain = |text: &&str| tells(text) && names::read(text).class != Some(Class::Other);
        let own = texts(&KEYS).find(tells).or_else(|| texts(&REMARKS).find(is_plain));
        // A name that says the kind says it best; a category may be that of a library.
        match own {
            _ if is_of_style && is_kind(&rest(piece)) => rest(piece),
            _ if !is_of_style && is_kind(&piece.name) => piece.name.clone(),
            // The same text beside fronts and backs was copied: the letters of the name go before it.
            Some(text) if is_copied(pieces, text, &|other| face_of(&rest(other))) => {
                written_out(&rest(piece)).unwrap_or_else(|| completed(text, &piece.name))
            }
            Some(text) => completed(text, &piece.name),
            None if !is_of_style && tells(&piece.name.as_str()) => piece.name.clone(),
            None => written_out(&rest(piece)).unwrap_or_else(|| piece.name.clone()),
        }
    };
    pieces.iter().map(|piece| Piece { told: said(piece), ..piece.clone() }).collect()
}

/// Front or back, as what is left of a name says.
fn face_of(rest: &str) -> Option<Face> {
    names::read(&written_out(rest).unwrap_or_else(|| rest.to_owned())).face
}

/// Whether pieces whose names say front and back have the same text, which says one of them.
fn is_copied(pieces: &[Piece], text: &str, face: &dyn Fn(&Piece) -> Option<Face>) -> bool {
    let has = |piece: &&Piece| piece.texts.iter().any(|(_, value)| value == text);
    let says = |wanted: Face| pieces.iter().filter(has).any(|piece| face(piece) == Some(wanted));
    names::read(text).face.is_some() && Face::BOTH.into_iter().all(says)
}

/// A text, with front or back and the side of the wearer where only the name gives them.
fn completed(text: &str, name: &str) -> String {
    let (said, named) = (names::read(text), names::read(name));
    let face = named.face.filter(|_| said.face.is_none()).map(|face| face.to_string());
    let hand = named.hand.filter(|_| said.hand.is_none()).map(|hand| hand.to_string());
    [Some(text.to_owned()), face, hand].into_iter().flatten().collect::<Vec<_>>().join(" ")
}

/// Bytes that all names begin with.
fn common_start(pieces: &[Piece]) -> usize {
    let mut names = pieces.iter().map(|piece| piece.name.as_str());
    let Some(first) = names.next().filter(|_| pieces.len() > 1) else { return 0 };
    let shared = |name: &str| -> usize {
        let same = first.char_indices().zip(name.chars()).take_while(|((_, a), b)| a.eq_ignore_ascii_case(b));
        same.map(|((at, a), _)| at + a.len_utf8()).last().unwrap_or(0)
    };
    names.map(shared).min().unwrap_or(0)
}

/// What is left of a name with its abbreviations written out; `None` where it has none.
fn written_out(rest: &str) -> Option<String> {
    let lower = rest.to_lowercase();
    let words = || lower.split(|c: char| !c.is_alphabetic()).filter(|word| !word.is_empty());
    let whole = |word: &str| ABBREVIATIONS.iter().find(|(_, short)| short.contains(&word)).map(|(long, _)| *long);
    let ending = |word: &str| {
        ENDINGS.iter().find(|(_, endings)| endings.iter().any(|ending| word.ends_with(ending))).map(|(long, _)| *long)
    };
    let exact: Vec<&str> = words().filter_map(whole).collect();
    let found: Vec<&str> = if exact.is_empty() { words().filter_map(ending).take(1).collect() } else { exact };
    (!found.is_empty()).then(|| found.join(" "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_after_a_style_number_say_what_a_piece_is() {
        let check = |names: &[&str], expect: &[&str]| {
            let pieces: Vec<Piece> =
                names.iter().map(|name| Piece { name: (*name).to_owned(), ..Piece::default() }).collect();
            let found: Vec<String> = told(&pieces).into_iter().map(|piece| piece.told).collect();
            assert_eq!(found, expect);
        };
        check(&["AB12XFR", "AB12XBK", "AB12XSL"], &["front", "back", "sleeve"]);
        check(&["Z-1 FRT", "Z-1 BCK V2", "Z-1 WB"], &["front", "back", "Z-1 WB"]);
        check(&["SLEEK RUN FR", "SLEEK RUNNERBK"], &["front", "back"]);
        check(&["VORDERTEIL", "RUECKENTEIL"], &["VORDERTEIL", "RUECKENTEIL"]);
        check(&["X9-1", "X9-2"], &["X9-1", "X9-2"]);
        check(&["LEGGING WB WB", "LEGGING WB LL"], &["WB", "leg"]);
        check(&["SLEEVE F", "SLEEVE B"], &["SLEEVE F", "SLEEVE B"]);
        check(&["FRONT"], &["FRONT"]);
    }

    #[test]
    fn a_category_says_what_a_name_does_not() {
        let check = |name: &str, category: &str, expect: &str| {
            let texts = vec![("Category".to_owned(), category.to_owned())];
            let piece = Piece { name: name.to_owned(), texts, ..Piece::default() };
            assert_eq!(told(&[piece])[0].told, expect);
        };
        check("A1_LEFT", "SLEEVE SHORT", "SLEEVE SHORT left");
        check("BACK 2", "SLEEVE", "SLEEVE back");
        check("skirt_back", "leg", "skirt_back");
        check("wb_back", "body", "wb_back");
    }

    #[test]
    fn a_category_that_was_copied_goes_behind_the_names() {
        let piece = |name: &str| Piece {
            name: name.to_owned(),
            texts: vec![("CATEGORY".to_owned(), "FRONT".to_owned())],
            ..Piece::default()
        };
        let check = |names: [&str; 2], expect: [&str; 2]| {
            let found: Vec<String> = told(&names.map(piece)).into_iter().map(|piece| piece.told).collect();
            assert_eq!(found, expect);
        };
        check(["AB12_FR", "AB12_BK"], ["front", "back"]);
        check(["AB12_1", "AB12_2"], ["FRONT", "FRONT"]);
    }

    #[test]
    fn how_to_cut_a_piece_makes_no_lining_of_it() {
        let text = |key: &str, value: &str| (key.to_owned(), value.to_owned());
        let texts = vec![text("Annotation", "CUT 2 FABRIC, CUT 2 LINING"), text("Category", "FRONT")];
        let piece = Piece { name: "A1".to_owned(), texts, ..Piece::default() };
        assert_eq!(told(&[piece])[0].told, "FRONT");
        let piece =
            |remark: &str| Piece { name: "A1".to_owned(), texts: vec![text("Annotation", remark)], ..Piece::default() };
        assert_eq!(told(&[piece("SLEEVE X2")])[0].told, "SLEEVE X2");
        assert_eq!(told(&[piece("cut 1 lining")])[0].told, "A1");
    }
}

//! Statements of a file about its pieces, by their names, categories and other texts.
//!
//! A CAD program names the pieces of style `AB12` `AB12FR`, `AB12BK`, `AB12SL`, and those of `PALAZZO` `PALAZZO FRONT`,
//! `PALAZZO BACK`. The words that all names share do not describe a single piece. The rest is a garment term or a usual
//! abbreviation.

use super::{Class, Face, Hand, PartName};
use crate::piece::Piece;
use crate::trade::{self, Named};

/// Keys of texts that describe a piece, in lower case.
const KEYS: [&str; 7] = ["category", "piece description", "piece_name", "piece_id", "piece id", "type", "part"];
/// Texts that also say how to cut a piece. `CUT 2 FABRIC, 2 LINING` does not make a front a lining.
const REMARKS: [&str; 2] = ["annotation", "description"];

/// Lower-case words, by the terms that they stand for.
const ABBREVIATIONS: [(&str, &[&str]); 13] = [
    ("front", &["f", "fr", "frn", "fnt", "frt", "frnt", "fa", "vt"]),
    ("back", &["b", "bk", "bck", "bak", "bac", "ba"]),
    ("sleeve", &["sl", "slv", "sle", "ss", "ls"]),
    ("waistband", &["wb", "wstb"]),
    ("yoke", &["yk", "yo"]),
    ("cuff", &["cu", "cuf", "cff"]),
    ("collar", &["co", "clr", "col", "clst", "cs"]),
    ("leg", &["ll", "leg"]),
    ("hood", &["ho", "hd"]),
    ("pocket", &["pk", "pkt", "pkb", "pckt", "pckting", "pcktng"]),
    ("facing", &["fc", "fcg", "fac", "fcng"]),
    ("placket", &["pl", "plkt", "plk"]),
    ("interlining", &["int", "intl", "lin", "lng", "reins", "reinf"]),
];

/// Abbreviations that follow the name of the style without a separator (`RUNNERBK`), the longest first.
const ENDINGS: [(&str, &[&str]); 3] = [("front", &["frt", "fr"]), ("back", &["bck", "bk"]), ("sleeve", &["slv", "sl"])];

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Told {
    /// Name and texts of the piece.
    pub own: Named,
    /// Words that all names in the file share. They are about the style.
    pub shared: Named,
}

impl Told {
    pub fn all(self) -> Named {
        let (own, shared) = (self.own, self.shared);
        Named {
            class: own.class.or(shared.class),
            face: own.face.or(shared.face),
            hand: own.hand.or(shared.hand),
            part: own.part.or(shared.part),
        }
    }
}

pub fn told(pieces: &[Piece]) -> Vec<Told> {
    let (words, of_style) = words_of(pieces);
    let (own, common) = parted(&words);
    let common_text = |text: &str| pieces.len() > 1 && pieces.iter().all(|piece| has_text(piece, text));
    let common_texts = pieces.first().into_iter().flat_map(|piece| texts(piece, &KEYS));
    let common_texts = common_texts.filter(|text| common_text(text)).map(trade::read);
    let shared = common_texts.fold(read(&common, false), |said, text| if said.is_nameless() { text } else { said });
    let is_kind_known = shared.class.is_some();
    let start = common_start(pieces);
    let rest = |piece: &Piece| written_out(piece.name.get(start..).unwrap_or_default());
    let by_name: Vec<Named> = own.iter().map(|words| read(words, is_kind_known)).collect();
    let face = |k: usize| by_name[k].face.or_else(|| rest(&pieces[k])?.face);
    let own_of = |(k, piece): (usize, &Piece)| -> Named {
        let named = by_name[k];
        // The name tells the kind better than the category, which may be that of a library.
        if named.class.is_some() {
            return lined(pieces, piece, named);
        }
        let tells = |text: &&str| {
            let said = trade::read(text);
            !common_text(text) && (said.class.is_some() || said.face.is_some())
        };
        let is_plain = |text: &&str| tells(text) && trade::read(text).class != Some(Class::Other);
        let text = texts(piece, &KEYS).find(tells).or_else(|| texts(piece, &REMARKS).find(is_plain));
        let over = |first: Named| Named {
            class: first.class,
            face: first.face.or(named.face),
            hand: first.hand.or(named.hand),
            part: named.part.or(first.part),
        };
        let said = match text {
            // A text that is equal for fronts and backs was copied, so the letters of the name count before it.
            Some(text) if is_copied(pieces, text, &face) => over(rest(piece).unwrap_or_else(|| trade::read(text))),
            Some(text) => over(trade::read(text)),
            None if named.face.is_some() => named,
            None => rest(piece).map_or(named, over),
        };
        lined(pieces, piece, said)
    };
    let mut own: Vec<Named> = pieces.iter().enumerate().map(own_of).collect();
    tell_side_panels(&mut own);
    let shared_by = |style: &Vec<String>| shared_of(shared.and(read(style, false)), &own);
    own.iter().zip(&of_style).map(|(&own, style)| Told { own, shared: shared_by(style) }).collect()
}

/// Makes a side that is neither front nor back a panel between them, where there is a front and a back of no other kind.
fn tell_side_panels(own: &mut [Named]) {
    let is_trunk = |face: Face| own.iter().any(|named| named.face == Some(face) && named.class.is_none());
    if !Face::BOTH.into_iter().all(is_trunk) {
        return;
    }
    for named in own.iter_mut().filter(|named| (named.class, named.face) == (None, None)) {
        named.class = (named.part == Some(PartName::Side)).then_some(Class::SidePanel);
    }
}

/// Part of the shared statement that may hold for a single piece. If names give more than numbers, that is only the
/// kind of a garment whose other pieces are bands: all other pieces of a skirt are of its kind, those of a shirt are
/// not.
fn shared_of(shared: Named, own: &[Named]) -> Named {
    let is_garment = matches!(shared.class, Some(Class::Leg | Class::Skirt));
    let goes_with = |own: &Named| match own.class {
        None => true,
        Some(Class::Yoke | Class::Waistband | Class::Other) => is_garment,
        class => is_garment && class == shared.class,
    };
    let class = shared.class.filter(|_| own.iter().all(goes_with));
    if own.iter().any(|own| own.class.is_some() || own.face.is_some()) {
        Named { class: class.filter(|&class| class != Class::Other), face: None, hand: None, part: shared.part }
    } else {
        shared
    }
}

/// Makes a piece a lining if its material is one and that of other pieces is not.
fn lined(pieces: &[Piece], piece: &Piece, said: Named) -> Named {
    let is_lining = |piece: &Piece| {
        let materials = piece.texts.iter().filter(|(key, _)| key.eq_ignore_ascii_case("material"));
        materials.map(|(_, value)| trade::read(value)).any(|said| said.class == Some(Class::Other))
    };
    let is_one = is_lining(piece) && (pieces.len() == 1 || !pieces.iter().all(is_lining));
    if is_one { Named { class: Some(Class::Other), ..said } } else { said }
}

fn texts<'p>(piece: &'p Piece, keys: &'static [&str]) -> impl Iterator<Item = &'p str> {
    let of_keys = piece.texts.iter().filter(move |(key, _)| keys.contains(&key.to_lowercase().as_str()));
    of_keys.map(|(_, value)| value.as_str())
}

fn has_text(piece: &Piece, text: &str) -> bool {
    piece.texts.iter().any(|(_, value)| value == text)
}

/// True if a front and a back have the same text, and the text names one of them.
fn is_copied(pieces: &[Piece], text: &str, face: &dyn Fn(usize) -> Option<Face>) -> bool {
    let says = |wanted: Face| (0..pieces.len()).any(|k| has_text(&pieces[k], text) && face(k) == Some(wanted));
    trade::read(text).face.is_some() && Face::BOTH.into_iter().all(says)
}

fn read(words: &[String], is_kind_known: bool) -> Named {
    trade::read_words(&words.iter().map(String::as_str).collect::<Vec<_>>(), is_kind_known)
}

/// Words of every name without the names of style and size, and those of the words that name a kind.
fn words_of(pieces: &[Piece]) -> (Vec<Vec<String>>, Vec<Vec<String>>) {
    let names: Vec<Vec<String>> = pieces.iter().map(|piece| trade::words(&piece.name)).collect();
    let names: Vec<Vec<String>> = names.iter().map(|words| loosened(words, &names)).collect();
    let hands: Vec<Hand> = names.iter().flatten().filter_map(|word| trade::word_of(word)?.hand).collect();
    let is_pair = Hand::BOTH.into_iter().all(|hand| hands.contains(&hand));
    let without = |(piece, mut words): (&Piece, Vec<String>)| {
        let mut of_style: Vec<String> = Vec::new();
        for text in &piece.beside.garment {
            let said = trade::words(text);
            let at = words.windows(said.len().max(1)).position(|found| found == said);
            // Right and left are not sizes.
            let is_hand =
                is_pair && said.iter().any(|word| trade::word_of(word).is_some_and(|said| said.hand.is_some()));
            if let Some(at) = at.filter(|_| !said.is_empty() && said.len() < words.len() && !is_hand) {
                let is_kind = |word: &String| trade::word_of(word).is_some_and(|said| said.class.is_some());
                of_style.extend(words.drain(at..at + said.len()).filter(is_kind));
            }
        }
        (words, of_style)
    };
    pieces.iter().zip(names).map(without).unzip()
}

/// Splits words where the name of a style joins a garment term. The name must be a word of another name, or be joined
/// to another term there (`TEAGANFRONT` beside `TEAGANBACK`).
fn loosened(words: &[String], names: &[Vec<String>]) -> Vec<String> {
    let is_of_trade = |part: &str| trade::word_of(part).is_some();
    let is_style = |part: &str, word: &String| {
        let others = names.iter().flatten().filter(|other| *other != word);
        others.filter_map(|other| other.strip_prefix(part)).any(|rest| rest.is_empty() || is_of_trade(rest))
    };
    let cut = |word: &String| -> Option<[String; 2]> {
        let mut places = word.char_indices().skip(1).map(|(at, _)| word.split_at(at)).filter(|_| !is_of_trade(word));
        let (style, rest) = places.find(|(style, rest)| is_of_trade(rest) && is_style(style, word))?;
        Some([style, rest].map(str::to_owned))
    };
    words.iter().flat_map(|word| cut(word).map_or_else(|| vec![word.clone()], Vec::from)).collect()
}

fn parted(names: &[Vec<String>]) -> (Vec<Vec<String>>, Vec<String>) {
    let mut own = names.to_vec();
    let mut common: Vec<String> = Vec::new();
    if names.len() > 1 {
        for word in &names[0] {
            if own.iter().all(|words| words.contains(word)) {
                for words in &mut own {
                    // Of two equal words, the first belongs to the style.
                    if let Some(at) = words.iter().position(|other| other == word) {
                        words.remove(at);
                    }
                }
                common.push(word.clone());
            }
        }
    }
    (own, common)
}

fn common_start(pieces: &[Piece]) -> usize {
    let mut names = pieces.iter().map(|piece| piece.name.as_str());
    let Some(first) = names.next().filter(|_| pieces.len() > 1) else { return 0 };
    let shared = |name: &str| -> usize {
        let same = first.char_indices().zip(name.chars()).take_while(|((_, a), b)| a.eq_ignore_ascii_case(b));
        same.map(|((at, a), _)| at + a.len_utf8()).last().unwrap_or(0)
    };
    names.map(shared).min().unwrap_or(0)
}

fn written_out(rest: &str) -> Option<Named> {
    let words = trade::words(rest);
    let whole = |word: &str| ABBREVIATIONS.iter().find(|(_, short)| short.contains(&word)).map(|(long, _)| *long);
    let ending = |word: &str| {
        ENDINGS.iter().find(|(_, endings)| endings.iter().any(|ending| word.ends_with(ending))).map(|(long, _)| *long)
    };
    let exact: Vec<&str> = words.iter().filter_map(|word| whole(word)).collect();
    let found = if exact.is_empty() { words.iter().filter_map(|word| ending(word)).take(1).collect() } else { exact };
    (!found.is_empty()).then(|| trade::read_words(&found, false))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::piece::Beside;

    fn all(pieces: &[Piece]) -> Vec<Named> {
        told(pieces).into_iter().map(Told::all).collect()
    }

    fn called(name: &str) -> Piece {
        Piece { name: name.to_owned(), ..Piece::default() }
    }

    fn in_garment(name: &str, garment: &[String]) -> Piece {
        Piece { beside: Beside { garment: garment.to_vec(), ..Beside::default() }, ..called(name) }
    }

    #[test]
    fn what_is_left_of_a_name_says_what_a_piece_is() {
        let check = |names: &[&str], expect: &[&str]| {
            let pieces: Vec<Piece> = names.iter().map(|name| called(name)).collect();
            assert_eq!(all(&pieces), expect.iter().map(|name| trade::read(name)).collect::<Vec<_>>(), "{names:?}");
        };
        check(&["AB12XFR", "AB12XBK", "AB12XSL"], &["front", "back", "sleeve"]);
        check(&["Z-1 FRT", "Z-1 BCK V2", "Z-1 WB"], &["front", "back", "waistband"]);
        check(&["SLEEK RUN FR", "SLEEK RUNNERBK"], &["front", "back"]);
        check(&["VORDERTEIL", "RUECKENTEIL"], &["front", "back"]);
        check(&["X9-1", "X9-2"], &["", ""]);
        check(&["LEGGING WB WB", "LEGGING WB LL"], &["waistband", "leg"]);
        check(&["SLEEVE F", "SLEEVE B"], &["sleeve front", "sleeve back"]);
        check(&["FRONT"], &["front"]);
        // The style's name before, behind, run into the word, and like a word of the trade.
        check(&["PALAZZO FRONT", "PALAZZO BACK"], &["front", "back"]);
        check(&["FRONT FROCK 38", "BACK FROCK 38"], &["front", "back"]);
        check(&["TEAGANFRONT", "TEAGANBACK", "TEAGAN POCKET"], &["front", "back", "pocket"]);
        check(&["BACK BACK", "BACK FRONT"], &["back", "front"]);
        check(&["SHORT SLEEVE FRONT", "SHORT SLEEVE COLLAR"], &["front", "collar"]);
        check(&["SKIRT FRONT", "SKIRT BACK"], &["skirt front", "skirt back"]);
        check(&["FRONT_L", "BACK_L", "SLEEVE_L"], &["front", "back", "sleeve"]);
        check(&["\u{590f}\u{5b63}\u{524d}\u{7247}", "\u{590f}\u{5b63}\u{540e}\u{7247}"], &["front", "back"]);
    }

    #[test]
    fn the_name_of_the_style_and_the_size_are_no_name_of_a_piece() {
        let check = |names: &[&str], garment: &[&str], expect: &[&str]| {
            let garment: Vec<String> = garment.iter().map(|text| (*text).to_owned()).collect();
            let pieces: Vec<Piece> = names.iter().map(|name| in_garment(name, &garment)).collect();
            let own: Vec<Named> = told(&pieces).into_iter().map(|told| told.own).collect();
            assert_eq!(own, expect.iter().map(|name| trade::read(name)).collect::<Vec<_>>(), "{names:?}");
        };
        check(&["ROCK AND ROLL FRONT", "COLLAR"], &["Rock and Roll"], &["front", "collar"]);
        check(&["FRONT L", "COLLAR"], &["L"], &["front", "collar"]);
        check(&["FRONT L", "FRONT R", "COLLAR"], &["L"], &["front left", "front right", "collar"]);
        check(&["FRONT", "BACK"], &["FRONT"], &["front", "back"]);
        let skirt = ["SKIRT FRONT", "SKIRT BACK", "BAND"];
        check(&skirt, &["Skirt"], &["front", "back", ""]);
        let of_style = |name: &&str| in_garment(name, &["Skirt".to_owned()]);
        let all = all(&skirt.iter().map(of_style).collect::<Vec<_>>());
        let classes: Vec<Option<Class>> = all.iter().map(|named| named.class).collect();
        assert_eq!(classes, [Some(Class::Skirt), Some(Class::Skirt), None], "what is called a skirt is one");
    }

    #[test]
    fn a_category_says_what_a_name_does_not() {
        let check = |name: &str, category: &str, expect: &str| {
            let texts = vec![("Category".to_owned(), category.to_owned())];
            assert_eq!(all(&[Piece { texts, ..called(name) }]), [trade::read(expect)], "{name}");
        };
        check("A1_LEFT", "SLEEVE SHORT", "SLEEVE SHORT left");
        check("BACK 2", "SLEEVE", "SLEEVE back");
        check("skirt_back", "leg", "skirt_back");
        check("wb_back", "body", "wb_back");
    }

    #[test]
    fn a_category_that_was_copied_goes_behind_the_names() {
        let piece = |name: &str| Piece { texts: vec![("CATEGORY".to_owned(), "FRONT".to_owned())], ..called(name) };
        let check = |names: &[&str], expect: &[&str]| {
            let pieces: Vec<Piece> = names.iter().map(|name| piece(name)).collect();
            assert_eq!(all(&pieces), expect.iter().map(|name| trade::read(name)).collect::<Vec<_>>(), "{names:?}");
        };
        check(&["AB12_FR", "AB12_BK"], &["front", "back"]);
        check(&["AB12_1", "AB12_2"], &["front", "front"]);
    }

    #[test]
    fn how_to_cut_a_piece_makes_no_lining_of_it() {
        let text = |key: &str, value: &str| (key.to_owned(), value.to_owned());
        let texts = vec![text("Annotation", "CUT 2 FABRIC, CUT 2 LINING"), text("Category", "FRONT")];
        let with = |texts: Vec<(String, String)>| all(&[Piece { texts, ..called("A1") }])[0];
        assert_eq!(with(texts), trade::read("FRONT"));
        assert_eq!(with(vec![text("Annotation", "SLEEVE X2")]), trade::read("SLEEVE"));
        assert_eq!(with(vec![text("Annotation", "cut 1 lining")]), Named::default());
    }

    #[test]
    fn a_material_that_all_pieces_have_makes_no_linings() {
        let piece = |name: &str, material: &str| Piece {
            texts: vec![("Material".to_owned(), material.to_owned())],
            ..called(name)
        };
        let classes = |pieces: &[Piece]| all(pieces).iter().map(|named| named.class).collect::<Vec<_>>();
        assert_eq!(classes(&[piece("FRONT", "Loop terry"), piece("BACK", "Loop terry")]), [None, None]);
        assert_eq!(classes(&[piece("FRONT", "Twill"), piece("BACK", "Lining")]), [None, Some(Class::Other)]);
    }
}

//! Descriptions of lengths: their words in one language, and the place that they name.

use super::number;
use crate::dxf::Unit;
use crate::trade::{self, Class, Face};

/// Part of a garment that a place is told from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchor {
    Armhole,
    HighPoint,
    Hem,
    /// Also the upper edge of trousers and skirts.
    Waist,
    /// Lower edge of the waistband.
    Waistband,
    Crotch,
    Cuff,
}

impl Anchor {
    fn of(word: &str) -> Option<Self> {
        Some(match word {
            "armhole" => Self::Armhole,
            "hps" | "shoulder" => Self::HighPoint,
            "hem" => Self::Hem,
            "waist" => Self::Waist,
            "waistband" => Self::Waistband,
            "crotch" => Self::Crotch,
            "cuff" => Self::Cuff,
            _ => return None,
        })
    }

    fn word(self) -> &'static str {
        match self {
            Self::Armhole => "armhole",
            Self::HighPoint => "hps",
            Self::Hem => "hem",
            Self::Waist => "waist",
            Self::Waistband => "waistband",
            Self::Crotch => "crotch",
            Self::Cuff => "cuff",
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    pub anchor: Anchor,
    pub is_above: bool,
    pub distance: f64,
    /// Unit of the distance. `None` if it is not written.
    pub unit: Option<Unit>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extent {
    /// As it is measured flat.
    Half,
    Whole,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Told {
    /// Words of the trade, in one form each, in order.
    pub words: Vec<&'static str>,
    pub place: Option<Place>,
    pub extent: Option<Extent>,
}

impl Told {
    pub fn has(&self, word: &str) -> bool {
        self.words.contains(&word)
    }
}

#[derive(Clone, Debug, PartialEq)]
enum Token {
    Word(&'static str),
    Number { value: f64, unit: Option<Unit>, is_fraction: bool },
}

const TERMS: [(&[&str], &str); 31] = [
    (&["high", "point", "of", "the", "shoulder"], "hps"),
    (&["highest", "point", "of", "shoulder"], "hps"),
    (&["high", "point", "of", "shoulder"], "hps"),
    (&["high", "point", "shoulder"], "hps"),
    (&["high", "shoulder", "point"], "hps"),
    (&["high", "shoulder"], "hps"),
    (&["shoulder", "neck", "point"], "hps"),
    (&["neck", "shoulder", "point"], "hps"),
    (&["side", "neck", "point"], "hps"),
    (&["side", "neck"], "hps"),
    (&["neck", "point"], "hps"),
    (&["pit", "to", "pit"], "chest"),
    (&["armpit", "to", "armpit"], "chest"),
    (&["arm", "hole"], "armhole"),
    (&["arm", "pit"], "armhole"),
    (&["under", "arm"], "armhole"),
    (&["upper", "arm"], "bicep"),
    (&["shoulder", "to", "shoulder"], "across shoulder"),
    (&["centre", "front"], "cf"),
    (&["front", "centre"], "cf"),
    (&["centre", "back"], "cb"),
    (&["back", "centre"], "cb"),
    (&["waist", "band"], "waistband"),
    (&["in", "seam"], "inseam"),
    (&["inside", "leg"], "inseam"),
    (&["inner", "leg"], "inseam"),
    (&["inside", "seam"], "inseam"),
    (&["out", "seam"], "outseam"),
    (&["outside", "leg"], "outseam"),
    (&["outer", "leg"], "outseam"),
    (&["side", "seam"], "outseam"),
];

/// Words with the forms in which they are written, in English and, where pattern makers also write them, in German,
/// French, Spanish and Italian.
#[rustfmt::skip]
const WORDS: [(&str, &[&str]); 75] = [
    ("armhole", &["armhole", "armholes", "ah", "armpit", "underarm", "ua", "pit", "armscye", "scye", "armloch", "emmanchure", "sisa", "giromanica"]),
    ("hps", &["hps", "hsp", "snp", "sps", "hpsh"]),
    ("hem", &["hem", "bottom", "btm", "sweep", "saum", "ourlet", "bas", "bajo", "orlo", "fondo"]),
    ("waist", &["waist", "waistline", "wst", "taille", "taillen"]),
    ("waistband", &["waistband", "wb", "bund"]),
    ("crotch", &["crotch", "crutch", "fork", "schritt", "fourche", "tiro", "cavallo"]),
    ("cuff", &["cuff", "cuffs", "wrist"]),
    ("chest", &["chest", "bust", "brust", "poitrine", "pecho", "petto", "torace"]),
    ("hip", &["hip", "hips", "seat", "hüft", "hüfte", "hüften", "gesäß", "hanche", "hanches", "cadera", "fianchi", "bacino"]),
    ("thigh", &["thigh", "thighs", "oberschenkel", "schenkel", "cuisse", "muslo", "coscia"]),
    ("knee", &["knee", "knees", "knie", "genou", "rodilla", "ginocchio"]),
    ("bicep", &["bicep", "biceps", "muscle", "oberarm"]),
    ("forearm", &["forearm", "unterarm"]),
    ("elbow", &["elbow", "ellbogen", "coude", "codo", "gomito"]),
    ("neck", &["neck", "neckline", "hals", "halsausschnitt", "ausschnitt", "encolure", "escote", "scollo", "scollatura"]),
    ("shoulder", &["shoulder", "shoulders", "shldr", "shld", "shlder", "schulter", "épaule", "epaule", "hombro", "spalla", "spalle"]),
    ("front", &["front", "frt", "fr", "fnt"]),
    ("back", &["back", "bk", "bck"]),
    ("sleeve", &["sleeve", "sleeves", "slv", "slvs"]),
    ("leg", &["leg", "legs"]),
    ("cf", &["cf"]),
    ("cb", &["cb"]),
    ("centre", &["centre", "center", "ctr", "milieu", "centro"]),
    ("length", &["length", "len", "lgth", "lth", "lng", "long", "länge", "laenge", "longueur", "largo", "lunghezza"]),
    ("width", &["width", "wdth", "wth", "weite", "breite", "largeur", "ancho", "larghezza"]),
    ("opening", &["opening", "opng", "opg", "open"]),
    ("circumference", &["circumference", "circ", "circumf", "girth", "round", "around", "total", "full", "umfang", "tour", "contorno", "circonferenza", "giro"]),
    ("half", &["half", "halbe", "halb", "demi", "medio", "media", "mezzo", "mezza"]),
    ("flat", &["flat", "laid"]),
    ("drop", &["drop"]),
    ("depth", &["depth", "deep", "tiefe", "profondeur"]),
    ("height", &["height", "höhe", "hauteur", "altura", "altezza"]),
    ("rise", &["rise", "leibhöhe", "montant"]),
    ("inseam", &["inseam", "insm", "schrittlänge", "entrejambe", "entrepierna"]),
    ("outseam", &["outseam", "outsm", "sideseam", "seitenlänge"]),
    ("across", &["across", "acrs"]),
    ("body", &["body", "garment"]),
    ("skirt", &["skirt", "rock", "jupe", "falda", "gonna"]),
    ("relaxed", &["relaxed", "rlx", "unstretched"]),
    ("stretched", &["stretched", "stretch", "extended", "ext", "max", "maximum", "minimum", "min", "gedehnt"]),
    ("straight", &["straight"]),
    ("curve", &["curve", "curved", "along"]),
    ("slope", &["slope", "slant", "forward", "schräge"]),
    ("seam", &["seam", "edge", "point", "naht", "kante"]),
    ("collar", &["collar", "kragen", "col"]),
    ("hood", &["hood"]),
    ("pocket", &["pocket", "pckt", "pkt", "tasche"]),
    ("placket", &["placket"]),
    ("fly", &["fly"]),
    ("zip", &["zip", "zipper"]),
    ("button", &["button", "buttons", "buttonhole", "snap"]),
    ("yoke", &["yoke"]),
    ("dart", &["dart", "darts", "pleat", "pleats"]),
    ("slit", &["slit", "vent", "split"]),
    ("strap", &["strap", "straps"]),
    ("loop", &["loop", "loops", "tab", "flap", "belt"]),
    ("label", &["label", "logo", "print", "embroidery", "motif"]),
    ("placement", &["placement", "position", "distance", "spacing", "spread"]),
    ("stand", &["stand", "band"]),
    ("elastic", &["elastic", "tape", "binding", "piping", "stitch", "stitching", "topstitch"]),
    ("calf", &["calf", "ankle"]),
    ("cap", &["cap", "crown"]),
    ("panel", &["panel", "gusset", "insert", "facing"]),
    ("without", &["excl", "excluding", "without", "ohne", "sans"]),
    ("below", &["below", "under", "beneath", "unter", "unterhalb", "sous", "sotto"]),
    ("above", &["above", "über", "oberhalb", "sopra"]),
    ("from", &["from", "ab", "von", "at", "off", "depuis", "desde", "da"]),
    ("down", &["down", "dn"]),
    ("up", &["up"]),
    ("high", &["high"]),
    ("low", &["low", "lower"]),
    ("upper", &["upper"]),
    ("mid", &["mid", "middle", "halfway"]),
    ("natural", &["natural"]),
    ("x", &["x"]),
];

const WAYS: [&str; 5] = ["below", "above", "from", "down", "up"];
/// Words between a direction and the part of the garment that it is from.
const BETWEEN: [&str; 7] = ["from", "down", "up", "hem", "seam", "natural", "upper"];

pub fn read(description: &str) -> Told {
    let mut tokens = tokens(description);
    let mut extent = None;
    // `1/2 chest` is half of it.
    if let [Token::Number { value, unit: None, is_fraction: true }, Token::Word(next), ..] = &tokens[..]
        && *value == 0.5
        && !WAYS.contains(next)
    {
        tokens.remove(0);
        extent = Some(Extent::Half);
    }
    let place = place(&mut tokens);
    let written = tokens.iter().filter_map(|token| match token {
        Token::Word(word) => Some(*word),
        Token::Number { .. } => None,
    });
    let mut words: Vec<&'static str> = written.flat_map(|word| word.split(' ')).collect();
    for at in 0..words.len() {
        // `X-front` is across the front.
        if words[at] == "x" {
            words[at] = "across";
        }
    }
    let extent = extent
        .or(words.contains(&"circumference").then_some(Extent::Whole))
        .or(words.iter().any(|word| ["half", "flat"].contains(word)).then_some(Extent::Half));
    Told { words, place, extent }
}

/// Takes the place out of the tokens. A part without a distance stays among them as a word.
fn place(tokens: &mut Vec<Token>) -> Option<Place> {
    let word = |token: Option<&Token>| match token {
        Some(Token::Word(word)) => Some(*word),
        _ => None,
    };
    let anchor = |token: Option<&Token>| word(token).and_then(Anchor::of);
    let way = (0..tokens.len()).find(|k| word(tokens.get(*k)).is_some_and(|word| WAYS.contains(&word)))?;
    let mut end = way + 1;
    while word(tokens.get(end)).is_some_and(|next| BETWEEN.contains(&next)) && anchor(tokens.get(end + 1)).is_some() {
        end += 1;
    }
    let anchor = anchor(tokens.get(end))?;
    let says =
        |ways: [&str; 2]| tokens[way..end].iter().any(|token| word(Some(token)).is_some_and(|w| ways.contains(&w)));
    let (is_up, is_down) = (says(["above", "up"]), says(["below", "down"]));
    let number = |token: Option<&Token>| match token {
        Some(Token::Number { value, unit, .. }) => Some((*value, *unit)),
        _ => None,
    };
    let before = way.checked_sub(1).and_then(|k| number(tokens.get(k)));
    let after = number(tokens.get(end + 1)).filter(|_| before.is_none());
    tokens.drain(way - usize::from(before.is_some())..=end + usize::from(after.is_some()));
    if let Some((distance, unit)) = before.or(after) {
        // From an edge below, the way leads up.
        let is_above = is_up || !is_down && matches!(anchor, Anchor::Hem | Anchor::Cuff);
        return Some(Place { anchor, is_above, distance, unit });
    }
    let is_left_out = anchor == Anchor::Waistband && is_down;
    tokens.push(Token::Word(if is_left_out { "without" } else { anchor.word() }));
    None
}

/// Leaves out words that say nothing of lengths.
fn tokens(description: &str) -> Vec<Token> {
    let plain = initials(&description.to_lowercase());
    let (mut found, mut words): (Vec<Token>, Vec<String>) = (Vec::new(), Vec::new());
    let mut rest = plain.as_str();
    while let Some(first) = rest.chars().next() {
        if let Some((written, after)) = number::leading(rest) {
            found.extend(terms(&std::mem::take(&mut words)));
            let number::Written { value, unit, is_fraction } = written;
            found.push(Token::Number { value, unit, is_fraction });
            rest = after;
        } else if first.is_alphabetic() {
            let end = rest.find(|c: char| !c.is_alphabetic()).unwrap_or(rest.len());
            words.push(rest[..end].to_owned());
            rest = &rest[end..];
        } else {
            // A digit that begins no number is passed over with its number.
            let is_same = |c: char| c.is_ascii_digit() == first.is_ascii_digit() && !c.is_alphabetic();
            let end = if first.is_ascii_digit() {
                rest.find(|c: char| !is_same(c)).unwrap_or(rest.len())
            } else {
                first.len_utf8()
            };
            rest = &rest[end..];
        }
    }
    found.extend(terms(&words));
    found
}

/// Drops the points and strokes: `c.b.` and `u/a` are `cb` and `ua`.
fn initials(text: &str) -> String {
    let letters: Vec<char> = text.chars().collect();
    let is_letter = |k: usize| letters.get(k).is_some_and(|c| c.is_alphabetic());
    let is_single = |k: usize| is_letter(k) && (k == 0 || !is_letter(k - 1)) && !is_letter(k + 1);
    let is_between = |k: usize| matches!(letters[k], '.' | '/') && k > 0 && is_single(k - 1) && is_single(k + 1);
    (0..letters.len()).filter(|k| !is_between(*k)).map(|k| letters[k]).collect()
}

fn terms(written: &[String]) -> Vec<Token> {
    let words: Vec<&str> = written.iter().map(|word| if word == "center" { "centre" } else { word }).collect();
    let mut found = Vec::new();
    let mut at = 0;
    while at < words.len() {
        let term = TERMS.iter().find(|(term, _)| words[at..].starts_with(term));
        if let Some((term, word)) = term {
            found.push(Token::Word(word));
            at += term.len();
            continue;
        }
        found.extend(forms(words[at]).into_iter().map(Token::Word));
        at += 1;
    }
    found
}

/// Words that a written word stands for: itself in one form, or the parts of a compound such as `Brustweite`.
fn forms(word: &str) -> Vec<&'static str> {
    if let Some(known) = own(word) {
        return vec![known];
    }
    let cut = (1..word.len()).filter(|at| word.is_char_boundary(*at));
    // An `s` may join the parts.
    let second = |rest: &str| known(rest).or_else(|| known(rest.strip_prefix('s')?));
    let mut parts = cut.filter_map(|at| Some([known(&word[..at])?, second(&word[at..])?]));
    let parts = parts.next().map(|parts| parts.to_vec());
    parts.unwrap_or_else(|| known(word).into_iter().collect())
}

fn own(word: &str) -> Option<&'static str> {
    WORDS.iter().find(|(_, forms)| forms.contains(&word)).map(|(known, _)| *known)
}

fn known(word: &str) -> Option<&'static str> {
    if let Some(known) = own(word) {
        return Some(known);
    }
    // Short words of other languages are English words too.
    let named = trade::word_of(word).filter(|_| word.chars().count() > 2)?;
    match (named.class, named.face) {
        (Some(Class::Sleeve), _) => Some("sleeve"),
        (Some(Class::Cuff), _) => Some("cuff"),
        (Some(Class::Waistband), _) => Some("waistband"),
        (None, Some(Face::Front)) => Some("front"),
        (None, Some(Face::Back)) => Some("back"),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn descriptions_are_words_places_and_extents() {
        use Anchor::*;
        let check = |text: &str, words: &[&str], place: Option<(Anchor, bool, f64)>, extent: Option<Extent>| {
            let told = read(text);
            let found = told.place.map(|at| (at.anchor, at.is_above, at.distance));
            assert_eq!((&told.words[..], found, told.extent), (words, place, extent), "{text}");
        };
        let (half, whole) = (Some(Extent::Half), Some(Extent::Whole));
        check("1/2 Chest - 1\" below armhole", &["chest"], Some((Armhole, false, 1.0)), half);
        check("CHEST CIRC. (2.5 cm below A/H)", &["chest", "circumference"], Some((Armhole, false, 2.5)), whole);
        check("Waist width, 17 1/2\" down from HPS", &["waist", "width"], Some((HighPoint, false, 17.5)), None);
        check("Body length from high point shoulder", &["body", "length", "hps"], None, None);
        check("C.B. length", &["cb", "length"], None, None);
        check("Center front length", &["cf", "length"], None, None);
        check("X-Front", &["across", "front"], None, None);
        check("Knee - 14\" below crotch", &["knee"], Some((Crotch, false, 14.0)), None);
        check("Low hip 3 inches above crotch", &["low", "hip"], Some((Crotch, true, 3.0)), None);
        check("Forearm 5\" up from cuff", &["forearm"], Some((Cuff, true, 5.0)), None);
        check("Width 10cm from bottom hem", &["width"], Some((Hem, true, 10.0)), None);
        check("Front rise below waistband", &["front", "rise", "without"], None, None);
        check("Brustweite", &["chest", "width"], None, None);
        check("Rückenlänge ab Schulter", &["back", "length", "hps"], None, None);
        check("Ärmellänge", &["sleeve", "length"], None, None);
        check("1/2 tour de poitrine", &["circumference", "chest"], None, half);
        check("Across shoulder", &["across", "shoulder"], None, None);
        check("Shoulder to shoulder", &["across", "shoulder"], None, None);
    }
}

//! Number of copies of a piece, and the fold that it is laid on, by its quantity and its texts.

use super::shape::Shape;
use crate::piece::Piece;

const FOLD: [&str; 15] = [
    "on fold",
    "on the fold",
    "place on fold",
    "im bruch",
    "stoffbruch",
    "au pli",
    "sur le pli",
    "al doblez",
    "en doblez",
    "na dobra",
    "in piega",
    "stofvouw",
    "\u{441}\u{433}\u{438}\u{431}",
    "\u{5bf9}\u{6298}",
    "\u{8fde}\u{6298}",
];
const CUT: [&str; 8] = ["cut", "zuschneiden", "couper", "cortar", "tagliare", "knip", "\u{434}\u{435}\u{442}", "x"];

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cutting {
    /// `None` if the file does not say.
    pub times: Option<u32>,
    pub on_fold: bool,
}

impl Cutting {
    /// The quantity goes before the texts.
    pub fn of(piece: &Piece) -> Self {
        let texts = || piece.texts.iter().map(|(_, text)| text.to_lowercase());
        let of_quantity = piece.quantity.as_deref().and_then(|quantity| {
            let numbers = quantity.split(|c: char| !c.is_ascii_digit()).filter_map(|number| number.parse::<u32>().ok());
            numbers.reduce(u32::saturating_add)
        });
        let times = of_quantity.filter(|times| *times > 0).or_else(|| texts().find_map(|text| times_of(&text)));
        Self { times, on_fold: texts().any(|text| FOLD.iter().any(|fold| text.contains(fold))) }
    }
}

/// True for half a front or back: laid on the fold, or cut twice from an outline that is not symmetric. A piece that was
/// unfolded is whole, though its texts speak of the half that is drawn.
pub fn is_half(piece: &Piece, shape: &Shape) -> bool {
    let Cutting { times, on_fold } = Cutting::of(piece);
    let is_lopsided = || (0..2).all(|turns| shape.framed(turns).0.mirror().is_none());
    piece.beside.fold.is_none() && (on_fold || (times == Some(2) && is_lopsided()))
}

/// Reads `cut 2`, `cut 1 pair`. `None` for another text.
fn times_of(text: &str) -> Option<u32> {
    let words: Vec<&str> = text.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty()).collect();
    let after = words.iter().position(|word| CUT.contains(word)).and_then(|at| words.get(at + 1))?;
    let times: u32 = after.parse().ok()?;
    Some(if words.iter().any(|word| word.starts_with("pair")) { times.saturating_mul(2) } else { times })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_say_how_often_a_piece_is_cut_and_whether_on_the_fold() {
        let check = |quantity: &str, text: &str, times: Option<u32>, on_fold: bool| {
            let quantity = (!quantity.is_empty()).then(|| quantity.to_owned());
            let piece = Piece { quantity, texts: vec![(String::new(), text.to_owned())], ..Piece::default() };
            assert_eq!(
                Cutting::of(&piece),
                Cutting { times, on_fold },
                "{quantity:?} {text}",
                quantity = piece.quantity
            );
        };
        check("", "Fabric, Cut 1 on fold", Some(1), true);
        check("", "Fabric, Cut 2", Some(2), false);
        check("", "cut 1 pair", Some(2), false);
        check("", "1x im Stoffbruch zuschneiden", None, true);
        check("1,1", "", Some(2), false);
        check("2", "cut 4", Some(2), false);
        check("0", "a front", None, false);
    }
}

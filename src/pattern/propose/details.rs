//! Pieces that a drape does without.

use super::Class;
use crate::piece::Piece;
use crate::trade::Named;

/// Greatest area of a nameless piece that is taken for a detail, as a share of the largest piece. The sleeve of a
/// T-shirt has a fifth, half of a child's sleeve a tenth.
pub const DETAIL_SHARE: f64 = 0.08;

/// Square of the perimeter over four areas from which a piece is a strip: about 13 times as long as wide. A leg, the
/// slenderest piece round the body, has 8.
const STRIP: f64 = 15.0;

/// True for each piece that a drape does without: a detail by its name, a small nameless piece, a strip that is called
/// front or back alone, and an alternative that is not cut.
pub fn details(pieces: &[Piece], named: &[Named]) -> Vec<bool> {
    let largest_m2 = pieces.iter().map(Piece::area_m2).fold(0.0, f64::max);
    let is_detail = |(piece, named): (&Piece, &Named)| {
        named.class == Some(Class::Other)
            || (named.is_nameless() && piece.area_m2() < DETAIL_SHARE * largest_m2)
            || (matches!(named.class, None | Some(Class::SidePanel)) && is_strip(piece))
    };
    pieces
        .iter()
        .zip(named)
        .map(is_detail)
        .zip(spares(pieces))
        .map(|(is_detail, is_spare)| is_detail || is_spare)
        .collect()
}

/// True for each piece of quantity 0 beside others that are cut: an alternative of the model.
pub fn spares(pieces: &[Piece]) -> Vec<bool> {
    let is_none = |piece: &Piece| {
        let counts = piece.quantity.as_deref().map(|quantity| quantity.split(',').map(str::trim).collect::<Vec<_>>());
        counts.is_some_and(|counts| !counts.is_empty() && counts.iter().all(|count| *count == "0"))
    };
    let are_none: Vec<bool> = pieces.iter().map(is_none).collect();
    if are_none.iter().all(|is_none| *is_none) { vec![false; pieces.len()] } else { are_none }
}

/// True for a tape, a band or a binding: a rectangle with sides `a` and `b` has a square of the perimeter over four
/// areas of `a / b + 2 + b / a`.
pub fn is_strip(piece: &Piece) -> bool {
    piece.perimeter_m().powi(2) > 4.0 * STRIP * piece.area_m2()
}

//! Gores: equal pieces of a skirt, sewn side to side all round.
//!
//! A piece is a gore if its name says skirt or gore, neither front nor back, and three or more are cut in all. All
//! other pieces must then be bands and details. Equal panels are gores as well. A pair cut for left and right
//! alternates with its mirror image round the skirt.

use super::{Class, PartName};
use crate::piece::Piece;
use crate::trade::Named;
use geom::polyline::{perimeter, signed_area};

const LEAST: u32 = 3;
/// Greatest plausible quantity.
const MOST: u32 = 40;
/// Greatest relative difference of area and of perimeter between equal panels.
const ALIKE: f64 = 0.05;

/// Number of copies of a piece.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cut {
    pub plain: u32,
    pub mirrored: u32,
}

impl Cut {
    /// Parses one number, or the numbers of left and right. A missing or zero quantity is one.
    fn of(piece: &Piece) -> Self {
        let text = piece.quantity.as_deref().unwrap_or_default();
        let mut numbers = text.split(|c: char| !c.is_ascii_digit()).filter_map(|number| number.parse().ok());
        match (numbers.next().unwrap_or(0), numbers.next().unwrap_or(0)) {
            (0, 0) => Self { plain: 1, mirrored: 0 },
            (plain, mirrored) => Self { plain, mirrored },
        }
    }

    pub fn times(self) -> u32 {
        self.plain.saturating_add(self.mirrored)
    }

    /// Yields true for a mirrored copy, in the order of sewing.
    pub fn copies(self) -> impl Iterator<Item = bool> {
        // Pairs alternate, so that equal sides meet.
        let is_pair = self.plain == self.mirrored;
        (0..self.times()).map(move |k| if is_pair { k % 2 == 1 } else { k >= self.plain })
    }
}

/// `None` for a piece that is no gore.
pub fn gores(pieces: &[Piece], named: &[Named]) -> Vec<Option<Cut>> {
    let is_plain = |named: &Named| match named.class {
        Some(Class::Waistband | Class::Other) => true,
        Some(Class::Skirt) | None => named.face.is_none(),
        _ => false,
    };
    let are_plain = named.iter().all(is_plain);
    // The word panel alone is weak evidence: the panels must also be alike.
    let of_panels = pieces.iter().zip(named).filter(|(_, named)| named.part == Some(PartName::Panel));
    let are_alike = alike(of_panels.map(|(piece, _)| piece));
    let is_gore = |named: &Named| {
        let is_part = named.part == Some(PartName::Gore) || named.part == Some(PartName::Panel) && are_alike;
        let is_called = named.class == Some(Class::Skirt) || named.class.is_none() && is_part;
        are_plain && is_called && named.hand.is_none()
    };
    let cut = |(piece, named): (&Piece, &Named)| is_gore(named).then(|| Cut::of(piece));
    let cuts: Vec<Option<Cut>> = pieces.iter().zip(named).map(cut).collect();
    let times: u32 = cuts.iter().flatten().map(|cut| cut.times().min(MOST + 1)).sum();
    if (LEAST..=MOST).contains(&times) { cuts } else { vec![None; pieces.len()] }
}

/// True if outlines have nearly equal areas and perimeters.
fn alike<'p>(pieces: impl Iterator<Item = &'p Piece>) -> bool {
    let sizes_of = |piece: &Piece| [signed_area(&piece.outline).abs(), perimeter(&piece.outline)];
    let sizes: Vec<[f64; 2]> = pieces.map(sizes_of).collect();
    (0..2).all(|k| {
        let greatest = sizes.iter().map(|size| size[k]).fold(0.0, f64::max);
        sizes.iter().all(|size| size[k] >= (1.0 - ALIKE) * greatest)
    })
}

#[cfg(test)]
mod tests {
    use super::super::told::{Told, told};
    use super::*;
    use geom::V2;

    #[test]
    fn a_quantity_says_how_often_a_gore_is_cut() {
        let check = |quantity: Option<&str>, mirrored: &[bool]| {
            let piece = Piece { quantity: quantity.map(str::to_owned), ..Piece::default() };
            assert_eq!(Cut::of(&piece).copies().collect::<Vec<_>>(), mirrored, "{quantity:?}");
        };
        check(None, &[false]);
        check(Some("3"), &[false; 3]);
        check(Some("cut 4"), &[false; 4]);
        check(Some("2,2"), &[false, true, false, true]);
        check(Some("2,0"), &[false, false]);
        check(Some("1,2"), &[false, true, true]);
        check(Some("0"), &[false]);
    }

    fn named(pieces: &[Piece]) -> Vec<Named> {
        told(pieces).into_iter().map(Told::all).collect()
    }

    #[test]
    fn gores_are_told_by_name_and_number() {
        let check = |pieces: &[(&str, &str)], are: &[bool]| {
            let piece = |&(name, quantity): &(&str, &str)| Piece {
                name: name.to_owned(),
                quantity: Some(quantity.to_owned()),
                ..Piece::default()
            };
            let pieces: Vec<Piece> = pieces.iter().map(piece).collect();
            assert_eq!(
                gores(&pieces, &named(&pieces)).iter().map(Option::is_some).collect::<Vec<_>>(),
                are,
                "{pieces:?}"
            );
        };
        check(&[("GORE", "8"), ("WAISTBAND", "1")], &[true, false]);
        check(&[("SKIRT GORE", "3,3")], &[true]);
        check(&[("panel_0", "1"), ("panel_1", "1"), ("panel_2", "1"), ("wb_front", "1")], &[true, true, true, false]);
        // Too few, or beside other pieces.
        check(&[("SKIRT", "1"), ("WAISTBAND", "1")], &[false, false]);
        check(&[("SKIRT", "2")], &[false]);
        check(&[("PANEL", "4"), ("FRONT", "1"), ("BACK", "1")], &[false, false, false]);
        check(&[("PANEL", "4"), ("SLEEVE", "2")], &[false, false]);
        check(&[("GORE", "4000000000")], &[false]);
        check(&[("GORE", "4000000000,4000000000")], &[false]);
    }

    #[test]
    fn panels_of_different_shapes_are_no_gores() {
        let check = |widths: &[f64], are: bool| {
            let panel = |&width: &f64| Piece {
                name: "PANEL".to_owned(),
                outline: [(0.0, 0.0), (width, 0.0), (width, 0.6), (0.0, 0.6)].map(|(x, y)| V2::new(x, y)).to_vec(),
                ..Piece::default()
            };
            let pieces: Vec<Piece> = widths.iter().map(panel).collect();
            assert!(gores(&pieces, &named(&pieces)).iter().all(|gore| gore.is_some() == are), "{widths:?}");
        };
        check(&[0.2, 0.2, 0.201], true);
        check(&[0.2, 0.2, 0.3], false);
    }
}

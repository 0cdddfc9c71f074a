//! Names of pieces in seam files: finds the pieces of a name, and makes a unique name for a piece.

use crate::dxf::r12_name;
use crate::piece::Piece;

/// Indices of the pieces that a seam file means by a name. Compared in turn until a piece matches: block name, piece
/// name, either with an ordinal number (`NAME#2`), block name as written in DXF R12, and either without the size, which
/// the names of blocks in a nest contain. `made_on` is the size that the seam file was made on.
pub(crate) fn called(pieces: &[Piece], name: &str, made_on: Option<&str>) -> Vec<usize> {
    let ways: [fn(&Piece) -> &str; 2] = [|piece| &piece.block, |piece| &piece.name];
    let by = |is: &dyn Fn(&Piece) -> bool| (0..pieces.len()).filter(|&i| is(&pieces[i])).collect::<Vec<_>>();
    let plain = ways.iter().map(|way| by(&|piece| way(piece) == name));
    let numbered = name.rsplit_once('#').and_then(|(base, number)| Some((base, number.parse::<usize>().ok()?)));
    let by_number = ways.iter().map(|way| {
        let (base, number) = numbered?;
        by(&|piece| way(piece) == base).get(number.checked_sub(1)?).copied()
    });
    let by_number = by_number.map(|found| found.into_iter().collect::<Vec<_>>());
    let written = [r12_name(name)];
    let by_written = written.iter().map(|written| by(&|piece| piece.block == *written));
    // The first of several equal names has no number.
    let first = numbered.filter(|(_, number)| *number == 1).map_or(name, |(base, _)| base);
    let bare = without(first, made_on.unwrap_or_default());
    let by_bare = ways.iter().map(|way| {
        let is_it = |piece: &Piece| bare == without(way(piece), piece.size.as_deref().unwrap_or_default());
        // A name that is nothing but a size tells a piece only beside `made_on`.
        if bare.is_empty() && made_on.is_none() { Vec::new() } else { by(&is_it) }
    });
    let found = plain.chain(by_number).chain(by_written).chain(by_bare).find(|found| !found.is_empty());
    found.unwrap_or_default()
}

/// Unique name of a piece for a seam file: its piece name, its block name, or else its block name with an ordinal
/// number. In a nest, where block names contain the size, the piece name with an ordinal number comes before the block
/// name.
pub(crate) fn reference(pieces: &[Piece], index: usize) -> String {
    let piece = &pieces[index];
    let is_only = |name: &str| pieces.iter().filter(|p| p.name == name || p.block == name).count() == 1;
    let number = |is: fn(&Piece) -> &str| pieces[..=index].iter().filter(|p| is(p) == is(piece)).count();
    if is_only(&piece.name) {
        piece.name.clone()
    } else if piece.size.is_some() && piece.name != piece.block {
        format!("{}#{}", piece.name, number(|piece| &piece.name))
    } else if is_only(&piece.block) {
        piece.block.clone()
    } else {
        format!("{}#{}", piece.block, number(|piece| &piece.block))
    }
}

pub(crate) fn without(name: &str, size: &str) -> Vec<String> {
    let (mut left, size) = (words(name), words(size));
    while let Some(at) = left.windows(size.len().max(1)).position(|some| *some == size[..]) {
        left.drain(at..at + size.len());
    }
    left
}

fn words(name: &str) -> Vec<String> {
    let words = name.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty());
    words.map(str::to_lowercase).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_are_called_by_block_name_number_and_without_their_size() {
        let piece = |block: &str, name: &str| Piece {
            block: block.to_owned(),
            name: name.to_owned(),
            size: Some("L".to_owned()),
            ..Piece::default()
        };
        let pieces = [piece("B1", "front"), piece("back-L", "x"), piece("c", "cuff"), piece("d", "cuff")];
        let check = |name: &str, made_on: Option<&str>, expect: &[usize]| {
            assert_eq!(called(&pieces, name, made_on), expect, "{name}");
        };
        check("B1", None, &[0]);
        check("front", None, &[0]);
        check("cuff", None, &[2, 3]);
        check("cuff#2", None, &[3]);
        check("cuff#3", None, &[]);
        check("back-M", None, &[]);
        check("back-M", Some("M"), &[1]);
        check("back-M", Some("S"), &[]);
    }

    #[test]
    fn pieces_are_called_by_the_blocks_that_they_were_drawn_in() {
        let check = |written: [&str; 3], size: Option<&str>, name: &str, made_on: Option<&str>, expect: &[usize]| {
            let piece = |(k, block): (usize, &str)| Piece {
                block: block.to_owned(),
                name: format!("piece {k}"),
                size: size.map(str::to_owned),
                ..Piece::default()
            };
            let pieces: Vec<Piece> = written.into_iter().enumerate().map(piece).collect();
            assert_eq!(called(&pieces, name, made_on), expect, "{name} among {written:?}");
        };
        let nest = ["F1_XS_S", "F1_XS_S_2", "BK 2_XS_S"];
        check(nest, Some("XS/S"), "F1", None, &[0]);
        check(nest, Some("XS/S"), "F1#1", None, &[0]);
        check(nest, Some("XS/S"), "F1#2", None, &[1]);
        check(nest, Some("XS/S"), "BK-2", None, &[2]);
        check(nest, Some("XS/S"), "F1-L/XL", Some("L/XL"), &[0]);
        check(nest, Some("XS/S"), "F1-L/XL", None, &[]);
        check(nest, Some("XS/S"), "F", None, &[]);
        check(["M", "L", "x"], Some("M"), "#", None, &[]);
        check(["TEE_FR_36", "a_very_long_name_of_a_block_that", "x"], None, "TEE FR_36", None, &[0]);
        check(["x", "a_very_long_name_of_a_block_tha", "y"], None, "a very long name of a block that", None, &[1]);
    }
}

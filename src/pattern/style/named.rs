//! Pieces by the names that seam files call them by.

use crate::piece::Piece;

/// Indices of the pieces that a seam file calls `name`: by their block, else by their piece name, else by either with its
/// number, `NAME#2`. Names that hold the size, as blocks of nests do, are compared without it; `made_on` is the size that
/// the seam file was made on.
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
    let bare = made_on.map(|size| without(name, size));
    let by_bare = ways.iter().map(|way| {
        let is_it = |piece: &Piece| {
            let size = piece.size.as_deref().unwrap_or_default();
            bare.as_ref().is_some_and(|bare| *bare == without(way(piece), size))
        };
        by(&is_it)
    });
    let found = plain.chain(by_number).chain(by_bare).find(|found| !found.is_empty());
    found.unwrap_or_default()
}

/// The words of a name without those that are the size.
fn without(name: &str, size: &str) -> Vec<String> {
    let words = name.split(|c: char| !c.is_alphanumeric());
    words.filter(|word| !word.eq_ignore_ascii_case(size)).map(str::to_ascii_lowercase).collect()
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
}

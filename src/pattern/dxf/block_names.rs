//! Names of written blocks, one per piece, as readers of DXF R12 accept them.
//!
//! A name in R12 has at most 31 characters: letters, digits, `$`, `-` and `_`. Some readers discard a file with any
//! other name, and some a file with a `$`. Upper and lower case count as equal. The true name of a piece stands in its
//! texts.

use std::collections::{BTreeMap, BTreeSet};

use super::NO_BLOCK;
use crate::piece::Piece;

/// Limit of R12.
const MOST_CHARS: usize = 31;

/// Replaces every character except letters and digits of any script, `-` and `_` by `_`.
pub(crate) fn r12_name(name: &str) -> String {
    let is_plain = |c: char| c.is_alphanumeric() || matches!(c, '-' | '_');
    name.trim().chars().map(|c| if is_plain(c) { c } else { '_' }).take(MOST_CHARS).collect()
}

/// Returns a different block name for each piece. A piece keeps the name of its block if no other has it. Otherwise its
/// size is appended, `FRONT_M`, as CAD programs do in a nest, and then a number: `FRONT_M_2`.
pub fn block_names(pieces: &[Piece]) -> Vec<String> {
    let own: Vec<String> = pieces.iter().map(own_name).collect();
    let mut alike: BTreeMap<String, Vec<usize>> = BTreeMap::new();
    for (k, name) in own.iter().enumerate() {
        alike.entry(name.to_uppercase()).or_default().push(k);
    }
    let mut taken: BTreeSet<String> =
        alike.iter().filter(|(_, found)| found.len() == 1).map(|(name, _)| name.clone()).collect();
    let mut names = own.clone();
    for (k, name) in names.iter_mut().enumerate() {
        let others = &alike[&own[k].to_uppercase()];
        if others.len() == 1 {
            continue;
        }
        let sizes = others.iter().filter_map(|&other| pieces[other].size.as_deref());
        let base = without_size(&own[k], &r12_name(&pieces[k].name), sizes);
        let size = pieces[k].size.as_deref().map(|size| format!("_{}", r12_name(size))).unwrap_or_default();
        let mut number = 1;
        *name = joined(base, &size);
        while !taken.insert(name.to_uppercase()) {
            number += 1;
            *name = joined(base, &format!("{size}_{number}"));
        }
    }
    names
}

fn own_name(piece: &Piece) -> String {
    let named = [&piece.block, &piece.name].into_iter().find(|name| !name.trim().is_empty() && *name != NO_BLOCK);
    r12_name(named.map_or("PIECE", String::as_str))
}

fn without_size<'n>(block: &'n str, name: &str, mut sizes: impl Iterator<Item = &'n str>) -> &'n str {
    let after = block.strip_prefix(name).filter(|_| !name.is_empty());
    let is_size = after.is_some_and(|after| {
        let after = after.trim_start_matches(['-', '_']);
        sizes.any(|size| r12_name(size).eq_ignore_ascii_case(after))
    });
    if is_size { &block[..name.len()] } else { block }
}

/// Clips the name to leave room for its suffix.
fn joined(name: &str, after: &str) -> String {
    let after: String = after.chars().take(MOST_CHARS - 1).collect();
    let room = MOST_CHARS - after.chars().count();
    name.chars().take(room).chain(after.chars()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_block_has_a_name_of_its_own() {
        let check = |given: &[(&str, &str, &str)], expect: &[&str]| {
            let piece = |&(block, name, size): &(&str, &str, &str)| Piece {
                block: block.to_owned(),
                name: name.to_owned(),
                size: (!size.is_empty()).then(|| size.to_owned()),
                ..Piece::default()
            };
            let names = block_names(&given.iter().map(piece).collect::<Vec<_>>());
            assert_eq!(names, expect, "{given:?}");
            let folded: BTreeSet<String> = names.iter().map(|name| name.to_uppercase()).collect();
            assert_eq!(folded.len(), names.len(), "{names:?}");
            assert!(names.iter().all(|name| (1..=MOST_CHARS).contains(&name.chars().count())), "{names:?}");
        };
        // What is unique stays.
        check(&[("FRONT", "FRONT", "M"), ("BACK-2", "BACK", "M")], &["FRONT", "BACK-2"]);
        check(&[("TEE FR_36", "TEE FR", "36"), ("TEE FR_38", "TEE FR", "38")], &["TEE_FR_36", "TEE_FR_38"]);
        // A nest.
        check(&[("FRONT", "FRONT", "S"), ("FRONT", "FRONT", "M")], &["FRONT_S", "FRONT_M"]);
        check(&[("front", "front", "S"), ("FRONT", "FRONT", "s")], &["front_S", "FRONT_s_2"]);
        check(&[("F1", "Front panel", "S"), ("F1", "Front panel", "M")], &["F1_S", "F1_M"]);
        // Graded from the sample size, whose block holds it.
        check(&[("FRONT-36", "FRONT", "34"), ("FRONT-36", "FRONT", "36")], &["FRONT_34", "FRONT_36"]);
        check(&[("PANEL_2", "PANEL", "34"), ("PANEL_2", "PANEL", "36")], &["PANEL_2_34", "PANEL_2_36"]);
        // Left and right of one name.
        check(&[("FRONT", "FRONT", "M"), ("FRONT", "FRONT", "M")], &["FRONT_M", "FRONT_M_2"]);
        check(&[("FRONT", "FRONT", ""), ("FRONT", "FRONT", "")], &["FRONT", "FRONT_2"]);
        // Names that others have already.
        check(&[("A_S", "x", "S"), ("A", "A", "S"), ("A", "A", "M")], &["A_S", "A_S_2", "A_M"]);
        // Sizes that are no names.
        check(&[("A", "A", "XS/S"), ("A", "A", "34 1/2"), ("A", "A", "34/1 2")], &["A_XS_S", "A_34_1_2", "A_34_1_2_2"]);
        // No block, no name, names of other scripts, long ones.
        check(&[(NO_BLOCK, "cuff", ""), (NO_BLOCK, NO_BLOCK, ""), ("", "", "")], &["cuff", "PIECE", "PIECE_2"]);
        check(&[("*Model_Space", "x", ""), ("$PAPER_SPACE", "y", "")], &["_Model_Space", "_PAPER_SPACE"]);
        check(&[("ПЕРЕД", "ПЕРЕД", "44"), ("перед", "перед", "46")], &["ПЕРЕД_44", "перед_46"]);
        let long = "an unusually long name of a front of a jacket";
        check(
            &[(long, long, "XXL"), (long, long, "XXXL")],
            &["an_unusually_long_name_of_a_XXL", "an_unusually_long_name_of__XXXL"],
        );
    }
}

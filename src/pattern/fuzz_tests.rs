//! Reading of thousands of damaged files of every kind, from a fixed seed. No reader panics, hangs, or makes much out
//! of little.

use super::draft::{Model, TshirtSize, tshirt};
use super::features::Features;
use super::{Style, dxf, garmentcode, grade, info, propose, source};

/// Limit for a small damaged file: a multiple of that of the entity with the most chords.
const MOST_POINTS: usize = 100_000;

const TOKENS: [&str; 46] = [
    "0\nSECTION\n",
    "0\nENDSEC\n",
    "0\nBLOCK\n",
    "0\nENDBLK\n",
    "0\nEOF\n",
    "0\nPOLYLINE\n",
    "0\nVERTEX\n",
    "0\nLWPOLYLINE\n",
    "0\nINSERT\n2\nP\n",
    "0\nARC\n8\n1\n10\n0\n20\n0\n40\n1e5\n50\n0\n51\n0\n",
    "0\nSPLINE\n",
    "0\nMTEXT\n8\n1\n10\n0\n20\n0\n1\n",
    "8\n84\n",
    "\\P",
    "\\U+",
    "\\f",
    "\u{524d}",
    "0\nCIRCLE\n8\n1\n10\n0\n20\n0\n40\n1e9\n",
    "42\n1\n",
    "42\n-1e300\n",
    "8\n1\n",
    "8\n14\n",
    "70\n1\n",
    "70\n64\n",
    "90\n2147483647\n",
    "72\n-1\n",
    "230\n-1\n",
    "210\n1\n",
    "1e308",
    "-1e308",
    "NaN",
    "inf",
    "-0",
    "0",
    "1",
    "99999999999999999999",
    "\u{0}",
    "\r\n",
    "\u{feff}",
    "[",
    "]",
    "{",
    "}",
    "\"",
    ",",
    "RULE: DELTA 1\n",
];

/// Xorshift64* [Marsaglia].
struct Random(u64);

impl Random {
    fn below(&mut self, bound: usize) -> usize {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 33) as usize % bound.max(1)
    }

    fn damage(&mut self, bytes: &mut Vec<u8>) {
        for _ in 0..1 + self.below(3) {
            let at = self.below(bytes.len());
            let to = (at + 1 + self.below(40)).min(bytes.len());
            match self.below(12) {
                0 if at < bytes.len() => bytes[at] = self.below(256) as u8,
                1 => drop(bytes.drain(at..to)),
                2 => {
                    let copy = bytes[at..to].to_vec();
                    let there = self.below(bytes.len());
                    bytes.splice(there..there, copy);
                }
                3 => bytes.truncate(at.max(1)),
                4..8 => {
                    if let Some(digit) = bytes[at..].iter_mut().find(|byte| byte.is_ascii_digit()) {
                        *digit = b'0' + self.below(10) as u8;
                    }
                }
                _ => {
                    let token = TOKENS[self.below(TOKENS.len())];
                    // In half of the cases where a line begins, as tags do.
                    let line = bytes[at..].iter().position(|&byte| byte == b'\n').map_or(at, |k| at + k + 1);
                    let there = if self.below(2) == 0 { at } else { line };
                    let end = if self.below(2) == 0 { there } else { to.max(there) };
                    bytes.splice(there..end, token.bytes());
                }
            }
            if bytes.is_empty() {
                return;
            }
        }
    }
}

const DRAWING: &str = "0\nSECTION\n2\nBLOCKS\n0\nBLOCK\n8\n0\n2\nP\n10\n0\n20\n0\n0\nLWPOLYLINE\n8\n1\n90\n3\n70\n1\n10\n0\n20\n0\n42\n0.2\n\
10\n90\n20\n0\n42\n0\n10\n90\n20\n90\n42\n0\n0\nPOLYLINE\n8\n8\n66\n1\n70\n0\n0\nVERTEX\n8\n8\n10\n50\n20\n10\n0\nVERTEX\n8\n8\n10\n60\n20\n20\n\
0\nSEQEND\n8\n8\n0\nPOINT\n8\n4\n10\n0\n20\n0\n30\n4\n0\nTEXT\n8\n1\n10\n9\n20\n9\n40\n3\n1\n# 1\n0\nARC\n8\n14\n10\n50\n20\n20\n40\n5\n50\n0\n\
51\n360\n0\nELLIPSE\n8\n11\n10\n60\n20\n20\n11\n5\n21\n0\n40\n0.5\n41\n0\n42\n3\n0\nSPLINE\n8\n8\n70\n8\n71\n2\n72\n6\n73\n3\n74\n0\n40\n0\n40\n0\n\
40\n0\n40\n1\n40\n1\n40\n1\n10\n40\n20\n10\n30\n0\n10\n50\n20\n20\n30\n0\n10\n60\n20\n10\n30\n0\n0\nCIRCLE\n8\n13\n10\n70\n20\n30\n40\n2\n0\nENDBLK\n\
8\n0\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n0\nINSERT\n8\n1\n2\nP\n10\n0\n20\n0\n41\n1\n50\n0\n0\nLINE\n8\n1\n10\n200\n20\n0\n11\n300\n21\n0\n0\n\
LINE\n8\n1\n10\n300\n20\n0\n11\n300\n21\n90\n0\nLINE\n8\n1\n10\n300\n20\n90\n11\n200\n21\n0\n0\nMTEXT\n8\n1\n10\n9\n20\n9\n40\n3\n1\n{\\fArial|b0;Style Name: X}\\PUnits: METRIC\n0\nENDSEC\n0\nEOF\n";

const RULES: &str =
    "UNITS: METRIC\nNUMBER OF SIZES: 2\nSIZE LIST: S M\nSAMPLE SIZE: S\nRULE: DELTA 1\n0.0, 0.0  5.0, 5.0\nEND\n";

fn survivors(whole: &[u8], rounds: usize, seed: u64, mut is_read: impl FnMut(&[u8]) -> bool) -> usize {
    assert!(is_read(whole), "the whole file reads");
    let mut random = Random(seed);
    let damaged = (0..rounds).filter(|_| {
        let mut bytes = whole.to_vec();
        random.damage(&mut bytes);
        is_read(&bytes)
    });
    damaged.count()
}

/// Checks also that the pattern is not larger than its bytes allow.
fn reads_pattern(bytes: &[u8]) -> bool {
    let Ok(file) = source::read(bytes, "a", Some(dxf::Unit::Mm)) else { return false };
    let points: usize = file.pieces.iter().map(|piece| piece.outline.len()).sum();
    let inner: usize = file.pieces.iter().flat_map(|piece| &piece.internal_lines).map(Vec::len).sum();
    assert!(points + inner <= MOST_POINTS, "{points} and {inner} points from {} bytes", bytes.len());
    assert!(file.pieces.iter().all(|piece| piece.area_m2() > 0.0 && piece.perimeter_m().is_finite()));
    assert!(file.pieces.iter().filter_map(|piece| piece.unfolded()).all(|piece| piece.area_m2() > 0.0));
    true
}

#[test]
fn damaged_drawings_never_panic_and_stay_small() {
    let some = survivors(DRAWING.as_bytes(), 4_000, 1, reads_pattern);
    assert!((100..3_900).contains(&some), "{some} of 4000 still read: the damage says nothing");
}

#[test]
fn damaged_drawings_with_quality_curves_and_names_of_any_code_page_never_panic() {
    let curve = "0\nLWPOLYLINE\n8\n84\n90\n4\n70\n1\n10\n0\n20\n0\n10\n45\n20\n-6\n10\n90\n20\n0\n10\n90\n20\n90\n0\nPOINT\n8\n4\n";
    let drawing = DRAWING.replacen("0\nPOINT\n8\n4\n", curve, 1);
    let at = drawing.find("# 1").expect("a text");
    let bytes = [&drawing.as_bytes()[..at], b"Piece Name: \xc7\xb0\xc6\xac", &drawing.as_bytes()[at + 3..]].concat();
    let some = survivors(&bytes, 4_000, 6, reads_pattern);
    assert!((100..3_900).contains(&some), "{some} of 4000 still read: the damage says nothing");
}

#[test]
fn proposals_of_damaged_garments_never_panic() {
    let tee = tshirt(TshirtSize::S).dxf();
    let mut proposed = 0;
    survivors(&tee, 60, 7, |bytes| {
        let Ok(file) = source::read(bytes, "a", Some(dxf::Unit::Mm)) else { return false };
        let Ok(pieces) = file.to_sew(None) else { return true };
        let proposal = propose::propose(&pieces);
        let all: Vec<(usize, char)> = proposal.questions.iter().map(|question| (question.number, 'a')).collect();
        // An answer may make another question needless.
        let _ = propose::propose_answered(&pieces, &all).map(|answered| answered.to_drape());
        proposed += 1;
        true
    });
    assert!(proposed > 10, "{proposed}");
}

#[test]
fn damaged_specifications_and_features_never_panic() {
    let draft = tshirt(TshirtSize::S);
    let (_, seams) = Model::Tshirt.files().into_iter().find(|(name, _)| name.ends_with(".toml")).expect("seams");
    let style = Style::read(&draft.pieces, &seams, "seams").expect("our own seams");
    let specification = serde_json::to_vec(&garmentcode::document(&style)).expect("JSON");
    assert!(survivors(&specification, 300, 2, reads_pattern) > 10);
    let features = serde_json::to_vec(&Features::of(&draft.pieces[2..], "a", &[])).expect("JSON");
    assert!(survivors(&features, 300, 3, reads_pattern) > 10);
}

#[test]
fn damaged_tables_never_panic() {
    let rules = survivors(RULES.as_bytes(), 2_000, 4, |bytes| {
        let table = grade::read(bytes, "a");
        table.is_ok_and(|table| table.rules.values().all(|steps| steps.len() == table.sizes.len()))
    });
    assert!(rules > 50, "{rules}");
    let told = survivors(b"piece,quantity,role\nFRONT,1,front\nBACK,\"1,1\",back\n", 2_000, 5, |bytes| {
        info::read(bytes, "a").is_ok()
    });
    assert!(told > 50, "{told}");
}

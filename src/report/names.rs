//! Parts of file names, made from free texts: names of garments, sizes, subjects, fabrics and studies.

use std::collections::BTreeSet;

/// Greatest length of a part, bytes. File systems allow names of 255 bytes, and a part is combined with words and an
/// extension.
const MOST_BYTES: usize = 160;
const NAMELESS: &str = "unnamed";
/// Device names: on Windows, no file may have one before its first dot.
const DEVICES: [&str; 4] = ["con", "prn", "aux", "nul"];
/// Device names that a number follows.
const NUMBERED: [&str; 2] = ["com", "lpt"];

/// Converts a name to a part of a file name. Letters and digits of any script, `_`, `.`, `+` and `=` stay; anything
/// else between them becomes one `-`. The part is not empty, does not begin with a dot and is at most 160 bytes long.
/// Different names may give the same part: [`FileNames`] makes them distinct.
pub fn file_part(name: &str) -> String {
    let mut part = String::new();
    let mut is_gap = false;
    for letter in name.chars() {
        // A dot stays only within a word, since `..` leads out of a folder.
        if !stays(letter) || letter == '.' && (is_gap || part.ends_with('.')) {
            is_gap = true;
            continue;
        }
        let gap = if is_gap && !part.is_empty() { "-" } else { "" };
        if part.len() + gap.len() + letter.len_utf8() > MOST_BYTES {
            break;
        }
        part.push_str(gap);
        part.push(letter);
        is_gap = false;
    }
    let part = part.trim_start_matches(['.', '-']).trim_end_matches(['.', '-']);
    if !part.contains(|letter: char| letter.is_alphanumeric()) {
        return NAMELESS.to_owned();
    }
    if is_device(part) { format!("{part}_") } else { part.to_owned() }
}

/// True if a character is allowed in a file name on any system, and unescaped in a URL.
fn stays(letter: char) -> bool {
    // Vowel signs and tones within words are combining marks of their scripts, and not letters.
    let is_mark = matches!(letter, '\u{300}'..='\u{1fff}' | '\u{3099}' | '\u{309a}' | '\u{a800}'..='\u{abff}');
    letter.is_alphanumeric() || "_.+=".contains(letter) || (is_mark && !letter.is_whitespace())
}

fn is_device(part: &str) -> bool {
    let stem = part.split('.').next().unwrap_or_default().to_lowercase();
    let is_numbered =
        |word: &&str| stem.strip_prefix(*word).is_some_and(|number| matches!(number.as_bytes(), [b'1'..=b'9']));
    DEVICES.contains(&stem.as_str()) || NUMBERED.iter().any(is_numbered)
}

/// Parts of file names in one folder, distinct even without regard to case.
#[derive(Clone, Debug, Default)]
pub struct FileNames(BTreeSet<String>);

impl FileNames {
    /// Converts a name to a part that no other name has, by appending a number where the plain part is taken.
    pub fn part(&mut self, name: &str) -> String {
        let plain = file_part(name);
        let numbered = (2..).map(|number: usize| format!("{plain}-{number}"));
        let mut free = std::iter::once(plain.clone()).chain(numbered).filter(|part| self.0.insert(part.to_lowercase()));
        free.next().unwrap_or(plain)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_becomes_a_part_of_a_file_name() {
        let long = "衣".repeat(100);
        let check = |name: &str, expect: &str| assert_eq!(file_part(name), expect, "{name:?}");
        for same in
            ["S", "tee", "2X+", "上衣", "ÉTÉ-40", "male_ii", "a=0.4", "1.5", "\u{e40}\u{e2a}\u{e37}\u{e49}\u{e2d}"]
        {
            check(same, same);
        }
        check("e\u{301}te\u{301}", "e\u{301}te\u{301}");
        check("S/M", "S-M");
        check("/../../../../OUTSIDE", "OUTSIDE");
        check("..", NAMELESS);
        check("", NAMELESS);
        check("+-+", NAMELESS);
        check(".hidden", "hidden");
        check("a\\b:c*d?e\"f<g>h|i", "a-b-c-d-e-f-g-h-i");
        check("tee, size S", "tee-size-S");
        check("50 % #1 &co", "50-1-co");
        check("a\u{202e}b\0c\nd\u{200b}e", "a-b-c-d-e");
        check("tee . ", "tee");
        check("a - /b--c", "a-b-c");
        check("con", "con_");
        check("NUL.txt", "NUL.txt_");
        check("com1", "com1_");
        check("com", "com");
        check("com10", "com10");
        check("console", "console");
        check(&long, &"衣".repeat(53));
    }

    #[test]
    fn names_of_one_folder_differ() {
        let names = ["S/M", "S:M", "s-m", "tee", "tee+", "TEE", "S-M-2", "上衣", "衬衫", "?", "*"];
        let mut taken = FileNames::default();
        let parts: Vec<String> = names.iter().map(|name| taken.part(name)).collect();
        let expect =
            ["S-M", "S-M-2", "s-m-3", "tee", "tee+", "TEE-2", "S-M-2-2", "上衣", "衬衫", "unnamed", "unnamed-2"];
        assert_eq!(parts, expect);
    }
}

//! Lines of an MTEXT entity, without its formatting [DXF reference, MTEXT].

use dxf::entities::MText;

/// Codes that end with a semicolon: font, colour, height, width, slant, spacing, alignment, paragraph.
const WITH_VALUE: &str = "fFcCHWQTAp";
/// Underline, overline, strike-through, on and off.
const TOGGLES: &str = "LlOoKk";

pub fn lines_of(text: &MText) -> Vec<String> {
    lines(&(text.extended_text.concat() + &text.text))
}

/// A TEXT without a backslash or brace is a line as it is.
pub fn lines(content: &str) -> Vec<String> {
    let mut lines = vec![String::new()];
    let mut rest = content.chars();
    while let Some(c) = rest.next() {
        let code = match c {
            '{' | '}' => continue,
            '\\' => rest.next(),
            _ => None,
        };
        let line = lines.last_mut().expect("there is always a line");
        match code {
            None => line.push(c),
            Some('P' | 'N' | 'X') => lines.push(String::new()),
            Some('~') => line.push(' '),
            Some('U') if rest.as_str().starts_with('+') => {
                let digits = rest.as_str().get(1..5).unwrap_or_default();
                match u32::from_str_radix(digits, 16).ok().and_then(char::from_u32) {
                    Some(sign) => {
                        line.push(sign);
                        rest.nth(4);
                    }
                    None => line.push_str("\\U"),
                }
            }
            Some('S') => {
                let stacked = rest.by_ref().take_while(|&c| c != ';');
                line.extend(stacked.map(|c| if matches!(c, '^' | '#') { '/' } else { c }));
            }
            Some(code) if WITH_VALUE.contains(code) => {
                let _ = rest.by_ref().find(|&c| c == ';');
            }
            Some(code) if TOGGLES.contains(code) => {}
            Some(escaped @ ('\\' | '{' | '}')) => line.push(escaped),
            Some(other) => line.extend(['\\', other]),
        }
    }
    lines.iter().map(|line| line.trim().to_owned()).filter(|line| !line.is_empty()).collect()
}

#[cfg(test)]
mod tests {
    use super::lines;

    #[test]
    fn formatting_is_left_out_and_lines_are_parted() {
        let check = |content: &str, expect: &[&str]| assert_eq!(lines(content), expect, "{content}");
        check("Piece Name: FRONT", &["Piece Name: FRONT"]);
        check(
            r"{\fArial|b0|i0|c162|p34;Piece Name: FRONT}\PSize: S\P\H1.5x;Quantity: 1",
            &["Piece Name: FRONT", "Size: S", "Quantity: 1"],
        );
        check(r"\A1;{\C1;\LSize\l: }1\S1/2;", &["Size: 11/2"]);
        check(r"Size: \S1^2;\~cm \{x\} \\", &[r"Size: 1/2 cm {x} \"]);
        check(r"\U+524D\U+7247", &["\u{524d}\u{7247}"]);
        check(r"\pxqc;A\P\PB", &["A", "B"]);
        // Damaged content ends somewhere.
        check(r"A\fArial", &["A"]);
        check(r"A\U+12", &[r"A\U+12"]);
        check("A\\", &[r"A\"]);
        check("", &[]);
    }
}

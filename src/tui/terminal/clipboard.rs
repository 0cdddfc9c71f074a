//! The clipboard of the user's terminal.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;

/// Control sequence (OSC 52) that puts a text on the clipboard of the terminal, even over SSH.
#[must_use]
pub fn osc52(text: &str) -> String {
    format!("\x1b]52;c;{}\x07", STANDARD.encode(text))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clipboard_sequence() {
        assert_eq!(osc52("toile"), "\x1b]52;c;dG9pbGU=\x07");
    }
}

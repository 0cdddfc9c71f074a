//! Colours of charts and tables. In chart files they are fixed. On the page the neutral ones become style variables, so
//! that a chart follows the reader's light or dark scheme.

use fit::Simulator;
use render::{ColourMap, Rgb};

/// Text and axes.
pub(super) const INK: Rgb = Rgb(0x1b, 0x24, 0x30);
pub(super) const MUTED: Rgb = Rgb(0x56, 0x61, 0x6f);
pub(super) const GRID: Rgb = Rgb(0xd9, 0xde, 0xe4);
/// Background of every second row.
pub(super) const BAND: Rgb = Rgb(0xf3, 0xf5, 0xf8);
pub(super) const PAPER: Rgb = Rgb(0xff, 0xff, 0xff);

/// Neutral colours with the style variables that replace them on the page.
pub(super) const VARIABLES: [(Rgb, &str); 5] = [
    (INK, "var(--ink)"),
    (MUTED, "var(--muted)"),
    (GRID, "var(--grid)"),
    (BAND, "var(--band)"),
    (PAPER, "var(--paper)"),
];

/// Colours of subjects in charts, for readers with any colour vision [Okabe & Ito 2008]. Those too pale for lines on
/// white are darkened.
pub(super) const SUBJECTS: [Rgb; 7] = [
    Rgb(0x00, 0x72, 0xb2),
    Rgb(0xd5, 0x5e, 0x00),
    Rgb(0x00, 0x8f, 0x68),
    Rgb(0xb8, 0x5a, 0x92),
    Rgb(0xb3, 0x7d, 0x00),
    Rgb(0x3d, 0x94, 0xcc),
    Rgb(0x7a, 0x6a, 0x58),
];

/// Colour of a simulator: that of its cloth in pictures, but deeper.
pub(super) fn simulator(simulator: Simulator) -> Rgb {
    match simulator {
        Simulator::Fem => Rgb(0x2c, 0x8a, 0x5f),
        Simulator::Hybrid => Rgb(0x2f, 0x6f, 0xb5),
    }
}

/// Half range of the colour scale of chi around 1, the same in every table.
pub(super) const CHI_REACH: f64 = 0.15;

/// Background of a cell for a chi, and the text colour on it: black or white, whichever has more contrast, which is
/// always at least 4.5.
pub(super) fn chi_cell(chi: f64) -> (Rgb, Rgb) {
    const BLACK: Rgb = Rgb(0, 0, 0);
    let ground = ColourMap::Diverging.at(0.5 + (chi - 1.0) / (2.0 * CHI_REACH));
    (ground, if ground.contrast(BLACK) >= ground.contrast(PAPER) { BLACK } else { PAPER })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_reads_on_every_ground() {
        let check = |ink: Rgb, ground: Rgb, least: f64| {
            let contrast = ink.contrast(ground);
            assert!(contrast >= least, "{} on {}: {contrast:.2}", ink.hex(), ground.hex());
        };
        for ground in [PAPER, BAND] {
            check(INK, ground, 7.0);
            check(MUTED, ground, 4.5);
        }
        for step in 0..=60 {
            let (ground, ink) = chi_cell(0.8 + 0.4 * f64::from(step) / 60.0);
            check(ink, ground, 4.5);
        }
        for mark in SUBJECTS.into_iter().chain([Simulator::Fem, Simulator::Hybrid].map(simulator)) {
            check(mark, PAPER, 3.0);
        }
    }

    #[test]
    fn style_sheet_schemes_read() {
        let css = include_str!("templates/report/style.css");
        let (light, dark) = css.split_once("prefers-color-scheme: dark").expect("a dark scheme");
        let colour = |scheme: &str, name: &str| {
            let (_, rest) = scheme.split_once(&format!("--{name}: #")).unwrap_or_else(|| panic!("--{name}"));
            let byte = |k: usize| u8::from_str_radix(&rest[k..k + 2], 16).expect("hexadecimal");
            Rgb(byte(0), byte(2), byte(4))
        };
        for (scheme, text) in [("light", light), ("dark", dark)] {
            let pairs = [
                ("ink", "paper", 7.0),
                ("ink", "page", 7.0),
                ("ink", "band", 7.0),
                ("muted", "paper", 4.5),
                ("muted", "page", 4.5),
                ("link", "page", 4.5),
                ("tight", "tight-ground", 4.5),
                ("just", "just-ground", 4.5),
                ("loose", "loose-ground", 4.5),
                ("bad", "bad-ground", 4.5),
                ("care", "care-ground", 4.5),
                ("good", "paper", 4.5),
            ];
            for (ink, ground, least) in pairs {
                let contrast = colour(text, ink).contrast(colour(text, ground));
                assert!(contrast >= least, "{scheme}: --{ink} on --{ground}: {contrast:.2}, {least} needed");
            }
        }
        assert_eq!(colour(light, "ink"), INK);
        assert_eq!(colour(light, "grid"), GRID);
    }
}

//! Colours: the sixteen of the terminal's own palette, so that light and dark themes both stay readable, or none.
//! Colour never stands alone: a glyph or a bar beside it says the same.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::{Color, Modifier, Style};

use study::{FitCell, FitClass, Status};

/// How many colours the terminal shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Colours {
    /// None.
    None,
    /// The 16 of the terminal's own palette.
    Basic,
    /// The 256 of xterm.
    Indexed,
    /// Red, green and blue of 8 bits.
    True,
}

/// Terminals that show 16 colours.
const BASIC: [&str; 6] = ["linux", "xterm", "screen", "vt220", "ansi", "xterm-16color"];

impl Colours {
    /// What the environment says: `NO_COLOR`, `TERM`, `COLORTERM`.
    #[must_use]
    pub fn detect(no_color: bool, env: &dyn Fn(&str) -> Option<String>) -> Self {
        let term = env("TERM").unwrap_or_default();
        let says_true = matches!(env("COLORTERM").as_deref(), Some("truecolor" | "24bit"));
        // tmux turns colours its outer terminal lacks into near ones by itself.
        let is_known = env("TMUX").is_some() || ["kitty", "ghostty", "direct", "foot"].iter().any(|t| term.contains(t));
        if no_color || env("NO_COLOR").is_some_and(|value| !value.is_empty()) || term == "dumb" {
            Self::None
        } else if says_true || is_known {
            Self::True
        } else if BASIC.contains(&term.as_str()) {
            Self::Basic
        } else {
            Self::Indexed
        }
    }
}

/// Whether the environment asks for ASCII: `TOILE_ASCII`, or a terminal that has nothing else.
#[must_use]
pub fn wants_ascii(env: &dyn Fn(&str) -> Option<String>) -> bool {
    let term = env("TERM").unwrap_or_default();
    env("TOILE_ASCII").is_some_and(|value| !value.is_empty()) || term == "dumb" || term.starts_with("vt")
}

/// The styles of the workbench.
#[derive(Clone, Copy, Debug)]
pub struct Theme {
    /// Colours there are.
    pub colours: Colours,
    /// Whether only ASCII is shown.
    pub ascii: bool,
}

impl Theme {
    fn fg(self, colour: Color) -> Style {
        if self.colours == Colours::None { Style::new() } else { Style::new().fg(colour) }
    }

    /// Right or finished.
    #[must_use]
    pub fn good(self) -> Style {
        self.fg(Color::Green)
    }

    /// Questionable.
    #[must_use]
    pub fn warn(self) -> Style {
        self.fg(Color::Magenta)
    }

    /// Wrong or failed.
    #[must_use]
    pub fn bad(self) -> Style {
        self.fg(Color::Red)
    }

    /// Going on.
    #[must_use]
    pub fn busy(self) -> Style {
        self.fg(Color::Cyan)
    }

    /// Of less weight.
    #[must_use]
    pub fn dim(self) -> Style {
        Style::new().add_modifier(Modifier::DIM)
    }

    /// A legend in a border: of less weight, whatever the border is like.
    #[must_use]
    pub fn legend(self) -> Style {
        Style::reset().add_modifier(Modifier::DIM)
    }

    /// Of more weight.
    #[must_use]
    pub fn bold(self) -> Style {
        Style::new().add_modifier(Modifier::BOLD)
    }

    /// Selected, in the pane that has the focus.
    #[must_use]
    pub fn selected(self) -> Style {
        Style::new().add_modifier(Modifier::REVERSED)
    }

    /// Selected, in another pane.
    #[must_use]
    pub fn marked(self) -> Style {
        Style::new().add_modifier(Modifier::BOLD | Modifier::UNDERLINED)
    }

    /// The style of a selection.
    #[must_use]
    pub fn selection(self, focused: bool) -> Style {
        if focused { self.selected() } else { self.marked() }
    }

    /// The border of a pane.
    #[must_use]
    pub fn border(self, focused: bool) -> Style {
        if focused { self.busy().add_modifier(Modifier::BOLD) } else { self.dim() }
    }

    /// The style of a status.
    #[must_use]
    pub fn status(self, status: Status) -> Style {
        match status {
            Status::Done => self.good(),
            Status::Running => self.busy(),
            Status::NotConverged => self.warn(),
            Status::Failed => self.bad(),
            Status::Queued | Status::Cancelled => self.dim(),
        }
    }

    /// The style of an evaluation ratio: how far it is from 1.
    #[must_use]
    pub fn chi(self, chi: f64) -> Style {
        match (chi - 1.0).abs() {
            error if error <= 0.01 => self.good(),
            error if error <= 0.03 => self.warn(),
            _ => self.bad(),
        }
    }

    /// The colour of a seam or a size, which its letter or line tells as well.
    #[must_use]
    pub fn lettered(self, number: usize) -> Color {
        const COLOURS: [Color; 5] = [Color::Green, Color::Magenta, Color::Cyan, Color::Red, Color::Blue];
        if self.has_colours() { COLOURS[number % COLOURS.len()] } else { Color::Reset }
    }

    /// Whether there are colours at all.
    #[must_use]
    pub fn has_colours(self) -> bool {
        self.colours != Colours::None
    }

    /// Turns colours the terminal lacks, as pictures have them, into the nearest it has.
    pub fn adapt(self, buffer: &mut Buffer, area: Rect) {
        let near: fn(Color) -> Color = match self.colours {
            Colours::Indexed => indexed,
            Colours::Basic => basic,
            Colours::None | Colours::True => return,
        };
        for position in area.intersection(buffer.area).positions() {
            let cell = &mut buffer[position];
            (cell.fg, cell.bg) = (near(cell.fg), near(cell.bg));
        }
    }
}

/// The nearest colour of xterm's 256: of its cube or its greys, whichever is nearer.
fn indexed(colour: Color) -> Color {
    const LEVELS: [u8; 6] = [0, 95, 135, 175, 215, 255];
    let Color::Rgb(r, g, b) = colour else { return colour };
    let level = |v: u8| (0..6).min_by_key(|k| LEVELS[*k].abs_diff(v)).unwrap_or(0);
    let [i, j, k] = [r, g, b].map(level);
    let mean = (u16::from(r) + u16::from(g) + u16::from(b)) / 3;
    let step = (mean.saturating_sub(3) / 10).min(23) as u8;
    let grey = 8 + 10 * step;
    let distance =
        |to: [u8; 3]| -> u32 { [r, g, b].iter().zip(to).map(|(v, to)| u32::from(v.abs_diff(to)).pow(2)).sum() };
    if distance([grey; 3]) < distance([LEVELS[i], LEVELS[j], LEVELS[k]]) {
        Color::Indexed(232 + step)
    } else {
        Color::Indexed(16 + (36 * i + 6 * j + k) as u8)
    }
}

/// The nearest of the 16 colours, as most terminals have them.
fn basic(colour: Color) -> Color {
    const PALETTE: [(Color, [u8; 3]); 16] = [
        (Color::Black, [0, 0, 0]),
        (Color::Red, [170, 0, 0]),
        (Color::Green, [0, 170, 0]),
        (Color::Yellow, [170, 85, 0]),
        (Color::Blue, [0, 0, 170]),
        (Color::Magenta, [170, 0, 170]),
        (Color::Cyan, [0, 170, 170]),
        (Color::Gray, [170, 170, 170]),
        (Color::DarkGray, [85, 85, 85]),
        (Color::LightRed, [255, 85, 85]),
        (Color::LightGreen, [85, 255, 85]),
        (Color::LightYellow, [255, 255, 85]),
        (Color::LightBlue, [85, 85, 255]),
        (Color::LightMagenta, [255, 85, 255]),
        (Color::LightCyan, [85, 255, 255]),
        (Color::White, [255, 255, 255]),
    ];
    let Color::Rgb(r, g, b) = colour else { return colour };
    let distance =
        |to: &[u8; 3]| -> u32 { [r, g, b].iter().zip(to).map(|(v, to)| u32::from(v.abs_diff(*to)).pow(2)).sum() };
    PALETTE.iter().min_by_key(|(_, to)| distance(to)).map_or(colour, |(near, _)| *near)
}

/// The glyph of a status.
#[must_use]
pub fn glyph(status: Status) -> &'static str {
    match status {
        Status::Queued => "…",
        Status::Running => "▶",
        Status::Done => "✓",
        Status::NotConverged => "≈",
        Status::Failed => "✗",
        Status::Cancelled => "⊘",
    }
}

/// The glyph of a fit: its class, `!` where undersized, `~` where borderline.
#[must_use]
pub fn fit_glyph(fit: &FitCell) -> String {
    let class = match fit.class {
        FitClass::Tight => 'T',
        FitClass::Just => 'J',
        FitClass::Loose => 'L',
    };
    let mark = match (fit.undersized, fit.borderline) {
        (true, _) => '!',
        (_, true) => '~',
        _ => ' ',
    };
    format!("{class}{mark}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_follow_the_environment() {
        let check = |no_color: bool, vars: &[(&str, &str)], expect: Colours| {
            let env = |name: &str| vars.iter().find(|(k, _)| *k == name).map(|(_, v)| (*v).to_owned());
            assert_eq!(Colours::detect(no_color, &env), expect, "{vars:?}");
        };
        check(false, &[("TERM", "xterm-256color")], Colours::Indexed);
        check(false, &[("TERM", "xterm"), ("COLORTERM", "truecolor")], Colours::True);
        check(false, &[("COLORTERM", "truecolor"), ("NO_COLOR", "1")], Colours::None);
        check(false, &[("COLORTERM", "truecolor"), ("NO_COLOR", "")], Colours::True);
        check(true, &[("COLORTERM", "truecolor")], Colours::None);
        check(false, &[("TERM", "dumb")], Colours::None);
        check(false, &[("TERM", "linux")], Colours::Basic);
    }

    #[test]
    fn nearest_indexed_colours() {
        let check =
            |rgb: (u8, u8, u8), expect| assert_eq!(indexed(Color::Rgb(rgb.0, rgb.1, rgb.2)), Color::Indexed(expect));
        check((0, 0, 0), 16);
        check((255, 255, 255), 231);
        check((255, 0, 0), 196);
        check((128, 128, 128), 244);
        assert_eq!(indexed(Color::Reset), Color::Reset);
        assert_eq!([basic(Color::Rgb(250, 240, 240)), basic(Color::Rgb(20, 160, 30))], [Color::White, Color::Green]);
    }

    #[test]
    fn without_colours_no_style_has_one() {
        let theme = Theme { colours: Colours::None, ascii: false };
        for style in [theme.good(), theme.warn(), theme.bad(), theme.busy(), theme.border(true), theme.chi(1.2)] {
            assert_eq!((style.fg, style.bg), (None, None));
        }
    }
}

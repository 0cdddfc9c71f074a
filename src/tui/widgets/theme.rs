//! Colours: the sixteen of the terminal's own palette, so that light and dark backgrounds are readable; those of the
//! user's file (`theme_file`); or none. A glyph or a bar always says the same as a colour.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::{Color, Modifier, Style};

use fit::FitClass;
use store::{FitCell, Status};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Colours {
    None,
    /// The 16 colours of the terminal's own palette.
    Basic,
    /// The 256 colours of xterm.
    Indexed,
    /// Red, green and blue, 8 bits each.
    True,
}

const BASIC: [&str; 6] = ["linux", "xterm", "screen", "vt220", "ansi", "xterm-16color"];

impl Colours {
    /// Detects the colours from the environment: `NO_COLOR`, `TERM`, `COLORTERM`.
    pub fn detect(no_color: bool, env: &dyn Fn(&str) -> Option<String>) -> Self {
        let term = env("TERM").unwrap_or_default();
        let says_true = matches!(env("COLORTERM").as_deref(), Some("truecolor" | "24bit"));
        // tmux replaces colours that its outer terminal lacks by near ones.
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

/// True if the environment asks for ASCII, by `TOILE_ASCII` or a terminal that has only ASCII.
pub fn wants_ascii(env: &dyn Fn(&str) -> Option<String>) -> bool {
    let term = env("TERM").unwrap_or_default();
    env("TOILE_ASCII").is_some_and(|value| !value.is_empty()) || term == "dumb" || term.starts_with("vt")
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// Right or finished.
    Good,
    /// Worth a second look.
    Warn,
    /// Wrong or failed.
    Bad,
    /// Not finished yet.
    Busy,
    /// Border of the pane with the focus.
    Focus,
    Dim,
    /// Selected, in the pane with the focus.
    Selected,
}

impl Role {
    pub const ALL: [Self; 7] = [Self::Good, Self::Warn, Self::Bad, Self::Busy, Self::Focus, Self::Dim, Self::Selected];

    /// Name in the file of colours.
    pub fn name(self) -> &'static str {
        match self {
            Self::Good => "good",
            Self::Warn => "warn",
            Self::Bad => "bad",
            Self::Busy => "busy",
            Self::Focus => "focus",
            Self::Dim => "dim",
            Self::Selected => "selected",
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Roles {
    /// Colours of roles, in the order of [`Role::ALL`]; `Reset` for a role that only weight shows.
    pub colours: [Color; Role::ALL.len()],
    /// Colours of seams and sizes, in turn.
    pub seams: &'static [Color],
}

impl Default for Roles {
    fn default() -> Self {
        const SEAMS: [Color; 5] = [Color::Green, Color::Magenta, Color::Cyan, Color::Red, Color::Blue];
        let colours = [Color::Green, Color::Magenta, Color::Red, Color::Cyan, Color::Cyan, Color::Reset, Color::Reset];
        Self { colours, seams: &SEAMS }
    }
}

#[derive(Clone, Copy, Debug)]
pub struct Theme {
    pub colours: Colours,
    pub ascii: bool,
    pub roles: Roles,
}

impl Theme {
    /// Theme of a terminal, without a file of colours.
    pub fn new(colours: Colours, ascii: bool) -> Self {
        Self { colours, ascii, roles: Roles::default() }
    }

    /// Nearest colour that the terminal has; `Reset` without colours.
    fn shown(self, colour: Color) -> Color {
        match self.colours {
            Colours::None => Color::Reset,
            Colours::Basic => basic(colour),
            Colours::Indexed => indexed(colour),
            Colours::True => colour,
        }
    }

    /// Adds the style of a role to a style, or `otherwise` if the role has no colour.
    fn of(self, role: Role, style: Style, otherwise: Style) -> Style {
        match self.shown(self.roles.colours[role as usize]) {
            Color::Reset => otherwise,
            colour => style.fg(colour),
        }
    }

    fn plain(self, role: Role) -> Style {
        self.of(role, Style::new(), Style::new())
    }

    pub fn good(self) -> Style {
        self.plain(Role::Good)
    }

    pub fn warn(self) -> Style {
        self.plain(Role::Warn)
    }

    pub fn bad(self) -> Style {
        self.plain(Role::Bad)
    }

    pub fn busy(self) -> Style {
        self.plain(Role::Busy)
    }

    pub fn dim(self) -> Style {
        self.of(Role::Dim, Style::new(), Style::new().add_modifier(Modifier::DIM))
    }

    /// Style of a legend in a border: less important, even if the border has the focus.
    pub fn legend(self) -> Style {
        Style::reset().patch(self.dim())
    }

    pub fn bold(self) -> Style {
        Style::new().add_modifier(Modifier::BOLD)
    }

    /// Style of the selection in the pane with the focus.
    pub fn selected(self) -> Style {
        let reversed = Style::new().add_modifier(Modifier::REVERSED);
        self.of(Role::Selected, reversed, reversed)
    }

    /// Style of the selection in another pane.
    pub fn marked(self) -> Style {
        Style::new().add_modifier(Modifier::BOLD | Modifier::UNDERLINED)
    }

    pub fn selection(self, focused: bool) -> Style {
        if focused { self.selected() } else { self.marked() }
    }

    pub fn border(self, focused: bool) -> Style {
        if focused { self.plain(Role::Focus).add_modifier(Modifier::BOLD) } else { self.dim() }
    }

    pub fn status(self, status: Status) -> Style {
        match status {
            Status::Done => self.good(),
            Status::Running => self.busy(),
            Status::NotConverged => self.warn(),
            Status::Failed => self.bad(),
            Status::Queued | Status::Cancelled => self.dim(),
        }
    }

    /// Style of the state of a result, of which `is_inside` says if it lies too deep inside the body.
    pub fn result(self, status: Status, is_inside: bool) -> Style {
        if is_inside { self.warn() } else { self.status(status) }
    }

    /// Style of a chi, by its departure from 1.
    pub fn chi(self, chi: f64) -> Style {
        match (chi - 1.0).abs() {
            error if error <= 0.01 => self.good(),
            error if error <= 0.03 => self.warn(),
            _ => self.bad(),
        }
    }

    /// Colour of a seam or a size; its letter or line says the same.
    pub fn lettered(self, number: usize) -> Color {
        self.shown(self.roles.seams[number % self.roles.seams.len()])
    }

    pub fn has_colours(self) -> bool {
        self.colours != Colours::None
    }

    /// Replaces colours that the terminal lacks, such as those of pictures, by the nearest it has.
    pub fn adapt(self, buffer: &mut Buffer, area: Rect) {
        if matches!(self.colours, Colours::None | Colours::True) {
            return;
        }
        for position in area.intersection(buffer.area).positions() {
            let cell = &mut buffer[position];
            (cell.fg, cell.bg) = (self.shown(cell.fg), self.shown(cell.bg));
        }
    }
}

/// Levels of a channel in xterm's colour cube.
const LEVELS: [u8; 6] = [0, 95, 135, 175, 215, 255];

/// The sixteen colours as most terminals show them.
const SIXTEEN: [(Color, [u8; 3]); 16] = [
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

/// Nearest of xterm's 256 colours, in its cube or among its greys.
fn indexed(colour: Color) -> Color {
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

fn basic(colour: Color) -> Color {
    let wanted = match colour {
        Color::Rgb(r, g, b) => [r, g, b],
        Color::Indexed(k @ 0..16) => return SIXTEEN[usize::from(k)].0,
        Color::Indexed(k @ 16..232) => [(k - 16) / 36, (k - 16) / 6 % 6, (k - 16) % 6].map(|n| LEVELS[usize::from(n)]),
        Color::Indexed(k) => [8 + 10 * (k - 232); 3],
        named => return named,
    };
    let distance =
        |to: &[u8; 3]| -> u32 { wanted.iter().zip(to).map(|(v, to)| u32::from(v.abs_diff(*to)).pow(2)).sum() };
    SIXTEEN.iter().min_by_key(|(_, to)| distance(to)).map_or(colour, |(near, _)| *near)
}

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

/// Sign of a state: its glyph, and `!` for a result that lies too deep inside the body.
pub fn sign(status: Status, is_inside: bool) -> String {
    format!("{}{}", glyph(status), if is_inside { "!" } else { "" })
}

/// Glyph of a fit: its class, then `!` if undersized or `~` if borderline.
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
    fn roles_have_the_nearest_colour_that_there_is() {
        let check = |colours: Colours, colour: Color, expect: Option<Color>| {
            let mut theme = Theme::new(colours, false);
            theme.roles.colours = [colour; Role::ALL.len()];
            for style in [theme.good(), theme.dim(), theme.selected(), theme.border(true)] {
                assert_eq!(style.fg, expect, "{colour:?} of {colours:?}");
            }
        };
        let orange = Color::Rgb(250, 90, 80);
        check(Colours::True, orange, Some(orange));
        check(Colours::Indexed, orange, Some(Color::Indexed(203)));
        check(Colours::Basic, orange, Some(Color::LightRed));
        check(Colours::Basic, Color::Indexed(196), Some(Color::Red));
        check(Colours::Basic, Color::Indexed(9), Some(Color::LightRed));
        check(Colours::Basic, Color::Indexed(255), Some(Color::White));
        check(Colours::None, orange, None);
        check(Colours::True, Color::Reset, None);
    }

    #[test]
    fn without_colours_no_style_has_one() {
        let theme = Theme::new(Colours::None, false);
        for style in [theme.good(), theme.warn(), theme.bad(), theme.busy(), theme.border(true), theme.chi(1.2)] {
            assert_eq!((style.fg, style.bg), (None, None));
        }
        assert_eq!(theme.lettered(3), Color::Reset);
    }
}

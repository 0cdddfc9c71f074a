//! The user's own colours: `theme.toml` in the config folder assigns colours to roles.
//!
//! ```toml
//! good = "#00875f"
//! warn = "light-magenta"
//! focus = 33
//! seams = ["blue", "#d75f00", 30]
//! ```

use ratatui::style::Color;
use toml::de::DeValue;

use crate::config::{Entry, Problems};
use crate::widgets::theme::{Role, Roles};

/// Name in the config folder.
pub const FILE: &str = "theme.toml";

/// Name of the entry with the colours of seams and sizes.
const SEAMS: &str = "seams";

const ACCEPTED: &str = "accepted: black, red, green, yellow, blue, magenta, cyan, gray, dark-gray, light-red to light-cyan, \
     white, 0 to 255, \"#rrggbb\", or \"reset\" for the terminal's own";

/// Colours from some entries; others stay at their defaults.
pub fn taken(entries: &[Entry<'_>], problems: &mut Problems) -> Roles {
    let mut roles = Roles::default();
    for entry in entries {
        match Role::ALL.into_iter().find(|role| role.name() == entry.name) {
            Some(role) => {
                if let Some(colour) = problems.or_tell(entry, colour(entry.value)) {
                    roles.colours[role as usize] = colour;
                }
            }
            None if entry.name == SEAMS => {
                roles.seams = problems.or_tell(entry, colours(entry.value)).map_or(roles.seams, |list| list.leak())
            }
            None => {
                let names = Role::ALL.map(Role::name).join(", ");
                problems.tell(entry.line, format!("no role `{}`; accepted: {names}, {SEAMS}", entry.name));
            }
        }
    }
    roles
}

fn colour(value: &DeValue<'_>) -> Result<Color, String> {
    let number = value.as_integer().map(|number| number.as_str());
    let Some(text) = value.as_str().or(number) else { return Err(format!("{}; {ACCEPTED}", value.type_str())) };
    text.parse().map_err(|_| format!("no colour `{text}`; {ACCEPTED}"))
}

fn colours(value: &DeValue<'_>) -> Result<Vec<Color>, String> {
    match value.as_array() {
        Some(list) if !list.is_empty() => list.iter().map(|entry| colour(entry.get_ref())).collect(),
        Some(_) => Err("no colour; accepted: a list of one or more colours".to_owned()),
        None => Err(format!("{}; accepted: a list of colours", value.type_str())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::{ConfigError, parse};

    fn read(text: &str) -> Result<Roles, ConfigError> {
        parse("theme.toml", text, taken)
    }

    #[test]
    fn roles_get_other_colours_and_the_rest_stays() {
        let roles =
            read("good = \"#00875f\"\nwarn = \"light-magenta\"\nfocus = 33\nseams = [1, \"blue\"]").expect("right");
        let check = |role: Role, expect: Color| assert_eq!(roles.colours[role as usize], expect, "{role:?}");
        check(Role::Good, Color::Rgb(0, 0x87, 0x5f));
        check(Role::Warn, Color::LightMagenta);
        check(Role::Focus, Color::Indexed(33));
        check(Role::Bad, Color::Red);
        assert_eq!(roles.seams, [Color::Indexed(1), Color::Blue]);
        assert_eq!(read("").expect("right"), Roles::default());
    }

    #[test]
    fn problems_name_their_line_and_what_would_be_accepted() {
        let check = |text: &str, expect: &str| {
            let said = read(text).expect_err("wrong").to_string();
            assert!(said.contains(expect), "{said}");
        };
        check("good = \"green\"\nbda = \"red\"", "theme.toml:2: no role `bda`; accepted: good, warn, bad");
        check("good = \"grene\"", "theme.toml:1: good: no colour `grene`; accepted: black, red");
        check("good = 256", "theme.toml:1: good: no colour `256`");
        check("good = \"#12345\"", "no colour `#12345`");
        check("good = true", "good: boolean; accepted: black");
        check("\nseams = []", "theme.toml:2: seams: no colour; accepted: a list");
        check("seams = \"red\"", "seams: string; accepted: a list of colours");
        check("good = ", "theme.toml:1: ");
    }

    /// Relative luminance of a colour, 0 to 1 [WCAG 2.2].
    fn luminance(colour: Color) -> f64 {
        let Color::Rgb(r, g, b) = colour else { panic!("{colour:?} depends on the terminal") };
        let linear = [r, g, b].map(|v| (f64::from(v) / 255.0 + 0.055) / 1.055).map(|v| v.powf(2.4));
        0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]
    }

    #[test]
    fn the_themes_of_the_documents_are_read_and_contrast() {
        let check = |text: &str, background: Color, least: f64| {
            let roles = read(text).expect("right");
            let behind = luminance(background);
            for colour in roles.colours.iter().chain(roles.seams) {
                let (low, high) = (luminance(*colour).min(behind), luminance(*colour).max(behind));
                let contrast = (high + 0.05) / (low + 0.05);
                assert!(contrast >= least, "{colour} has a contrast of {contrast:.1} only");
            }
        };
        check(include_str!("../../../docs/themes/light.toml"), Color::Rgb(255, 255, 255), 4.5);
        check(include_str!("../../../docs/themes/dark-high-contrast.toml"), Color::Rgb(0, 0, 0), 7.0);
    }
}

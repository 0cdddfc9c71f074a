//! Pictures in the terminal: what is asked for, and how pixels become cells.
//!
//! Nothing is asked of the terminal: its answer may come late, or take the first key with it (tmux: 1.8 s). What the
//! environment and the window size say is enough; otherwise half blocks, which every terminal can show.

use image::{DynamicImage, Rgba, RgbaImage, imageops};
use ratatui::layout::Size;
use ratatui_image::picker::{Picker, ProtocolType};
use ratatui_image::protocol::Protocol;
use ratatui_image::{FontSize, Resize};

use super::theme::Colours;
use crate::study::{JobId, Map, SubjectId, View};

/// How pictures are shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Images {
    /// As pixels where the environment says that the terminal can, as half blocks otherwise.
    #[default]
    Auto,
    /// As half blocks.
    Halfblocks,
    /// Not at all.
    Off,
}

impl std::str::FromStr for Images {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        match text {
            "auto" => Ok(Self::Auto),
            "halfblocks" => Ok(Self::Halfblocks),
            "off" => Ok(Self::Off),
            other => Err(format!("`{other}` is no way to show pictures; there are: auto, halfblocks, off")),
        }
    }
}

/// The view some steps on, round the drape.
#[must_use]
pub fn turned(view: View, steps: isize) -> View {
    let at = View::ALL.iter().position(|one| *one == view).unwrap_or(0);
    View::ALL[(at as isize + steps).rem_euclid(View::ALL.len() as isize) as usize]
}

/// What the colours mean next.
#[must_use]
pub fn next_map(map: Map) -> Map {
    let at = Map::ALL.iter().position(|one| *one == map).unwrap_or(0);
    Map::ALL[(at + 1) % Map::ALL.len()]
}

/// What a picture is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sitter {
    /// The drape of a job.
    Drape(JobId),
    /// The body of a subject, from the front and from the side.
    Body(SubjectId),
}

/// A picture that is wanted; one without cells has the body measured only.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shot {
    /// What is shown.
    pub of: Sitter,
    /// From where.
    pub view: View,
    /// In which colours.
    pub map: Map,
    /// Width of the pane, cells.
    pub columns: u16,
    /// Height of the pane, cells.
    pub rows: u16,
}

/// A picture as the terminal shows it.
pub enum Drawn {
    /// Pixels or half blocks.
    Cells(Protocol),
    /// Letters of growing density, for terminals without colours.
    Letters(Vec<String>),
}

impl std::fmt::Debug for Drawn {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Cells(_) => "Cells",
            Self::Letters(_) => "Letters",
        })
    }
}

/// Turns pictures into cells.
#[derive(Clone, Debug)]
pub struct Canvas {
    picker: Picker,
    letters: bool,
}

impl Canvas {
    /// The best way this terminal can show pictures; `None` where they are off.
    #[must_use]
    pub fn new(images: Images, colours: Colours, env: &dyn Fn(&str) -> Option<String>) -> Option<Self> {
        let letters = colours == Colours::None;
        let pixels = match images {
            Images::Off => return None,
            Images::Auto if !letters => pixel_protocol(env).zip(cell_size()),
            _ => None,
        };
        let picker = pixels.map_or_else(Picker::halfblocks, |(protocol, cell)| picker_of(protocol, cell));
        Some(Self { picker, letters })
    }

    /// Pixels to render for a picture, width by height.
    #[must_use]
    pub fn pixels(&self, shot: &Shot) -> (u32, u32) {
        let cell = self.picker.font_size();
        (u32::from(shot.columns) * u32::from(cell.width), u32::from(shot.rows) * u32::from(cell.height))
    }

    /// Crops a picture to what it shows and fits it into its pane.
    ///
    /// # Errors
    /// When the picture cannot be encoded for this terminal.
    pub fn draw(&self, picture: &RgbaImage, shot: &Shot) -> Result<Drawn, String> {
        let picture = cropped(picture);
        let cell = self.picker.font_size();
        let size = fitted(&picture, Size::new(shot.columns, shot.rows), cell);
        if self.letters {
            return Ok(Drawn::Letters(letters(&picture, size)));
        }
        // Whole cells, so that nothing of the terminal shines through along the edges.
        let (width, height) = (u32::from(size.width * cell.width), u32::from(size.height * cell.height));
        let exact = imageops::resize(&picture, width, height, imageops::FilterType::CatmullRom);
        let protocol = self.picker.new_protocol(DynamicImage::ImageRgba8(exact), size, Resize::Fit(None));
        protocol.map(Drawn::Cells).map_err(|error| error.to_string())
    }
}

/// The protocol of a terminal that names itself; none inside tmux and screen, which pass pixels on only when told to.
fn pixel_protocol(env: &dyn Fn(&str) -> Option<String>) -> Option<ProtocolType> {
    let is = |name: &str, value: &str| env(name).is_some_and(|found| found == value);
    if env("TMUX").is_some() || env("STY").is_some() {
        return None;
    }
    if is("TERM", "xterm-kitty") || is("TERM", "xterm-ghostty") || is("TERM_PROGRAM", "ghostty") {
        Some(ProtocolType::Kitty)
    } else if is("TERM_PROGRAM", "iTerm.app") || is("TERM_PROGRAM", "WezTerm") {
        Some(ProtocolType::Iterm2)
    } else if is("TERM", "foot") || is("TERM", "mlterm") {
        Some(ProtocolType::Sixel)
    } else {
        None
    }
}

/// Pixels of a cell, from the window size the kernel knows.
fn cell_size() -> Option<FontSize> {
    let window = crossterm::terminal::window_size().ok()?;
    let (width, height) = (window.width.checked_div(window.columns)?, window.height.checked_div(window.rows)?);
    (width > 0 && height > 0).then(|| FontSize::new(width, height))
}

fn picker_of(protocol: ProtocolType, cell: FontSize) -> Picker {
    // The constructor's replacement asks the terminal, which this module must not.
    #[allow(deprecated)]
    let mut picker = Picker::from_fontsize(cell);
    picker.set_protocol_type(protocol);
    picker
}

/// Cells that a picture fills of a pane when it is scaled to touch two of its sides.
fn fitted(picture: &RgbaImage, pane: Size, cell: FontSize) -> Size {
    let columns = f64::from(picture.width()) / f64::from(cell.width);
    let rows = f64::from(picture.height()) / f64::from(cell.height);
    let scale = (f64::from(pane.width) / columns).min(f64::from(pane.height) / rows);
    let cells = |n: f64, most: u16| ((n * scale).round() as u16).clamp(1, most.max(1));
    Size::new(cells(columns, pane.width), cells(rows, pane.height))
}

/// The part of a picture that differs from its background, with a small margin.
fn cropped(picture: &RgbaImage) -> RgbaImage {
    let (width, height) = picture.dimensions();
    let shown = picture.enumerate_pixels().filter(|(_, y, pixel)| !is_background(picture, *y, pixel));
    let bounds = shown.fold(None, |bounds: Option<[u32; 4]>, (x, y, _)| {
        let [left, top, right, bottom] = bounds.unwrap_or([x, y, x, y]);
        Some([left.min(x), top.min(y), right.max(x), bottom.max(y)])
    });
    let Some([left, top, right, bottom]) = bounds else { return picture.clone() };
    let margin = width.max(height) / 50;
    let (left, top) = (left.saturating_sub(margin), top.saturating_sub(margin));
    let (right, bottom) = ((right + margin).min(width - 1), (bottom + margin).min(height - 1));
    imageops::crop_imm(picture, left, top, right - left + 1, bottom - top + 1).to_image()
}

/// Whether a pixel is transparent or near the colour its row begins with: backgrounds may change from top to bottom.
fn is_background(picture: &RgbaImage, row: u32, pixel: &Rgba<u8>) -> bool {
    let edge = picture.get_pixel(0, row);
    pixel[3] < 8 || (0..4).all(|k| pixel[k].abs_diff(edge[k]) < 12)
}

/// A picture as letters: the darker, the denser; background stays empty.
fn letters(picture: &RgbaImage, size: Size) -> Vec<String> {
    const RAMP: [char; 4] = ['░', '▒', '▓', '█'];
    let (columns, rows) = (u32::from(size.width), u32::from(size.height));
    let small = imageops::resize(picture, columns, rows, imageops::FilterType::Triangle);
    let letter = |row: u32, pixel: &Rgba<u8>| {
        if is_background(picture, row * picture.height() / rows, pixel) {
            return ' ';
        }
        let light = 0.2126 * f64::from(pixel[0]) + 0.7152 * f64::from(pixel[1]) + 0.0722 * f64::from(pixel[2]);
        RAMP[((255.0 - light) / 64.0) as usize % RAMP.len()]
    };
    (0..).zip(small.rows()).map(|(y, row)| row.map(|pixel| letter(y, pixel)).collect()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A dark cross of a shirt's proportions in the middle of a light picture.
    fn shirt() -> RgbaImage {
        RgbaImage::from_fn(200, 200, |x, y| {
            let body = (80..120).contains(&x) && (60..140).contains(&y);
            let sleeves = (50..150).contains(&x) && (60..85).contains(&y);
            if body || sleeves { Rgba([40, 90, 160, 255]) } else { Rgba([240, 240, 240, 255]) }
        })
    }

    fn shot(columns: u16, rows: u16) -> Shot {
        Shot { of: Sitter::Drape(JobId(1)), view: View::Front, map: Map::Plain, columns, rows }
    }

    #[test]
    fn crops_to_what_is_shown() {
        let cut = cropped(&shirt());
        assert_eq!(cut.dimensions(), (108, 88));
        let empty = RgbaImage::from_pixel(30, 20, Rgba([9, 9, 9, 255]));
        assert_eq!(cropped(&empty).dimensions(), (30, 20));
    }

    #[test]
    fn half_blocks_fill_the_pane_in_one_direction() {
        let canvas = Canvas::new(Images::Halfblocks, Colours::True, &|_| None).expect("pictures are on");
        let Ok(Drawn::Cells(protocol)) = canvas.draw(&shirt(), &shot(30, 20)) else { panic!("cells") };
        assert_eq!(protocol.size().width, 30);
        assert!(protocol.size().height <= 20);
    }

    #[test]
    fn without_colours_letters_show_the_shape() {
        let canvas = Canvas::new(Images::Auto, Colours::None, &|_| None).expect("pictures are on");
        let Ok(Drawn::Letters(rows)) = canvas.draw(&shirt(), &shot(22, 9)) else { panic!("letters") };
        let width = |row: usize| rows[row].trim().chars().count();
        assert!((20..=22).contains(&width(1)), "sleeves span the pane: {}", width(1));
        assert!((8..=10).contains(&width(6)), "the trunk is narrower: {}", width(6));
    }

    #[test]
    fn protocols_are_taken_only_from_terminals_that_name_themselves() {
        let check = |vars: &[(&str, &str)], expect: Option<ProtocolType>| {
            let env = |name: &str| vars.iter().find(|(k, _)| *k == name).map(|(_, v)| (*v).to_owned());
            assert_eq!(pixel_protocol(&env), expect, "{vars:?}");
        };
        check(&[("TERM", "xterm-kitty")], Some(ProtocolType::Kitty));
        check(&[("TERM", "xterm-kitty"), ("TMUX", "1")], None);
        check(&[("TERM_PROGRAM", "WezTerm")], Some(ProtocolType::Iterm2));
        check(&[("TERM", "xterm-256color")], None);
    }

    #[test]
    fn views_turn_all_round() {
        assert_eq!(turned(View::Front, -1), View::Quarter);
        assert_eq!(turned(View::Quarter, 1), View::Front);
        let seen = std::iter::successors(Some(Map::Plain), |map| Some(next_map(*map))).take(Map::ALL.len());
        assert!(seen.eq(Map::ALL), "every map has its turn");
    }
}

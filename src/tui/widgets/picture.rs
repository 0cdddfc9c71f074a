//! Pictures in the terminal: requests for them, and how pixels become cells.
//!
//! The terminal itself is not queried: its answer may come late, or swallow the first key (tmux: 1.8 s). Environment
//! and window size say enough; where they do not, half blocks work in every terminal.

use image::{DynamicImage, RgbaImage, imageops};
use ratatui::layout::Size;
use ratatui_image::picker::{Picker, ProtocolType};
use ratatui_image::protocol::Protocol;
use ratatui_image::{FontSize, Resize};

use crate::widgets::half_blocks::{Blocks, cropped, letters};
use crate::widgets::theme::Colours;
use render::View;
use results::{Look, Map};
use store::{JobId, SubjectId};

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Images {
    /// As pixels where the environment says that the terminal can, as half blocks otherwise.
    #[default]
    Auto,
    /// As half blocks, which every terminal with colours shows.
    Halfblocks,
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

/// Pixels rendered for a cell that shows two pixels or a letter.
const SMALL: FontSize = FontSize::new(6, 12);
/// Angle of one step of turning.
const TURN_DEG: i32 = 15;
/// Least and greatest enlargement. A step multiplies or divides by 5/4.
const ZOOM_PCT: [u32; 2] = [100, 800];

/// The whole drape, from the front.
pub const FRONT: Look = Look { azimuth_deg: 0, zoom_pct: 100, rise_pct: 0 };

/// Named view of a look; `None` for other angles.
pub fn view_of(look: Look) -> Option<View> {
    View::ALL.into_iter().find(|view| view.azimuth_deg() as i32 == look.azimuth_deg)
}

/// Name of a look: view or angle, then enlargement.
pub fn look_name(look: Look) -> String {
    let side = view_of(look).map_or_else(|| format!("{}°", look.azimuth_deg), |view| view.as_str().to_owned());
    if look.zoom_pct == FRONT.zoom_pct { side } else { format!("{side} ×{:.1}", f64::from(look.zoom_pct) / 100.0) }
}

pub fn next_view(look: Look) -> Look {
    let at = view_of(look).and_then(|view| View::ALL.iter().position(|known| *known == view));
    let next = View::ALL[at.map_or(0, |at| (at + 1) % View::ALL.len())];
    Look { azimuth_deg: next.azimuth_deg() as i32, ..look }
}

/// Look turned by some steps about the vertical.
pub fn turned(look: Look, steps: isize) -> Look {
    let azimuth_deg = (look.azimuth_deg + TURN_DEG * steps as i32).rem_euclid(360);
    Look { azimuth_deg, ..look }
}

/// Look enlarged by some steps, or reduced if negative.
pub fn zoomed(look: Look, steps: i32) -> Look {
    let zoom_pct = if steps > 0 { look.zoom_pct * 5 / 4 } else { look.zoom_pct * 4 / 5 };
    let zoom_pct = zoom_pct.clamp(ZOOM_PCT[0], ZOOM_PCT[1]);
    // An unenlarged garment is in the middle.
    let rise_pct = if zoom_pct == ZOOM_PCT[0] { 0 } else { look.rise_pct };
    Look { zoom_pct, rise_pct, ..look }
}

pub fn raised(look: Look, steps: i32) -> Look {
    let step = (2000 / look.zoom_pct as i32).max(2);
    let reach = 100 - 100 * ZOOM_PCT[0] as i32 / look.zoom_pct as i32;
    Look { rise_pct: (look.rise_pct + steps * step).clamp(-reach, reach), ..look }
}

pub fn next_map(map: Map) -> Map {
    let at = Map::ALL.iter().position(|known| *known == map).unwrap_or(0);
    Map::ALL[(at + 1) % Map::ALL.len()]
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pictured {
    Drape(JobId),
    /// The body of a subject, from the front and from the side.
    Body(SubjectId),
    /// A preview, by the number of its request.
    Preview(u64),
}

/// Request for a picture; with no cells, a body is only measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PictureRequest {
    pub of: Pictured,
    pub look: Look,
    pub map: Map,
    pub columns: u16,
    pub rows: u16,
}

pub enum Drawn {
    Pixels(Protocol),
    Blocks(Blocks),
    /// Letters of growing density, for terminals without colours.
    Letters(Vec<String>),
}

impl std::fmt::Debug for Drawn {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Pixels(_) => "Pixels",
            Self::Blocks(_) => "Blocks",
            Self::Letters(_) => "Letters",
        })
    }
}

#[derive(Clone, Debug)]
pub struct PictureEncoder {
    /// Protocol for pixels; `None` for half blocks or letters.
    picker: Option<Picker>,
    letters: bool,
    cell: FontSize,
}

impl PictureEncoder {
    /// Chooses the best way to show pictures in this terminal; `None` if they are off.
    pub fn new(images: Images, colours: Colours, env: &dyn Fn(&str) -> Option<String>) -> Option<Self> {
        let letters = colours == Colours::None;
        let pixels = match images {
            Images::Off => return None,
            Images::Auto if !letters => pixel_protocol(env).zip(cell_size()),
            _ => None,
        };
        Some(Self::with(pixels, letters))
    }

    /// Encoder for pixels by a protocol with cells of a size, for letters, or for half blocks.
    pub fn with(pixels: Option<(ProtocolType, FontSize)>, letters: bool) -> Self {
        let picker = pixels.map(|(protocol, cell)| picker_of(protocol, cell));
        Self { picker, letters, cell: pixels.map_or(SMALL, |(_, cell)| cell) }
    }

    /// Width and height, in pixels, at which a picture must be rendered.
    pub fn pixels(&self, request: &PictureRequest) -> (u32, u32) {
        (u32::from(request.columns) * u32::from(self.cell.width), u32::from(request.rows) * u32::from(self.cell.height))
    }

    /// Crops a picture to what it shows and fits it into its pane.
    pub fn draw(&self, picture: &RgbaImage, request: &PictureRequest) -> Result<Drawn, String> {
        let picture = cropped(picture);
        let cell = self.cell;
        let size = fitted(&picture, Size::new(request.columns, request.rows), cell);
        if self.letters {
            return Ok(Drawn::Letters(letters(&picture, size)));
        }
        let Some(picker) = &self.picker else { return Ok(Drawn::Blocks(Blocks::of(&picture, size))) };
        // Draws on the backdrop, since terminals differ in what shines through. Fills whole cells, so that nothing
        // shines through at the edges.
        let (width, height) = (u32::from(size.width * cell.width), u32::from(size.height * cell.height));
        let opaque = |mut picture: RgbaImage| {
            picture.pixels_mut().for_each(|pixel| pixel.0[3] = 255);
            picture
        };
        let exact = imageops::resize(&opaque(picture), width, height, imageops::FilterType::CatmullRom);
        let protocol = picker.new_protocol(DynamicImage::ImageRgba8(exact), size, Resize::Fit(None));
        protocol.map(Drawn::Pixels).map_err(|error| error.to_string())
    }
}

/// Protocol of a terminal that identifies itself; `None` inside tmux and screen, which pass pixels on only if they are
/// told to.
pub fn pixel_protocol(env: &dyn Fn(&str) -> Option<String>) -> Option<ProtocolType> {
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

/// Size of a cell in pixels, from the kernel's window size.
fn cell_size() -> Option<FontSize> {
    let window = crossterm::terminal::window_size().ok()?;
    let (width, height) = (window.width.checked_div(window.columns)?, window.height.checked_div(window.rows)?);
    (width > 0 && height > 0).then(|| FontSize::new(width, height))
}

fn picker_of(protocol: ProtocolType, cell: FontSize) -> Picker {
    // The constructor that replaces this one queries the terminal.
    #[allow(deprecated)]
    let mut picker = Picker::from_fontsize(cell);
    picker.set_protocol_type(protocol);
    picker
}

/// Cells that a picture fills in a pane when scaled to touch two of its sides.
fn fitted(picture: &RgbaImage, pane: Size, cell: FontSize) -> Size {
    let columns = f64::from(picture.width()) / f64::from(cell.width);
    let rows = f64::from(picture.height()) / f64::from(cell.height);
    let scale = (f64::from(pane.width) / columns).min(f64::from(pane.height) / rows);
    let cells = |n: f64, most: u16| ((n * scale).round() as u16).clamp(1, most.max(1));
    Size::new(cells(columns, pane.width), cells(rows, pane.height))
}

#[cfg(test)]
pub mod tests {
    use image::Rgba;

    use super::*;

    /// A dark cross of a shirt's proportions in the middle of an empty picture.
    pub fn shirt() -> RgbaImage {
        RgbaImage::from_fn(200, 200, |x, y| {
            let body = (80..120).contains(&x) && (60..140).contains(&y);
            let sleeves = (50..150).contains(&x) && (60..85).contains(&y);
            if body || sleeves { Rgba([40, 90, 160, 255]) } else { Rgba([240, 240, 240, 0]) }
        })
    }

    fn request(columns: u16, rows: u16) -> PictureRequest {
        PictureRequest { of: Pictured::Drape(JobId(1)), look: FRONT, map: Map::Plain, columns, rows }
    }

    #[test]
    fn half_blocks_fill_the_pane_in_one_direction() {
        let encoder = PictureEncoder::new(Images::Halfblocks, Colours::True, &|_| None).expect("pictures are on");
        let Ok(Drawn::Blocks(blocks)) = encoder.draw(&shirt(), &request(30, 20)) else { panic!("blocks") };
        assert_eq!(blocks.size.width, 30);
        assert!(blocks.size.height <= 20);
    }

    #[test]
    fn without_colours_letters_show_the_shape() {
        let encoder = PictureEncoder::new(Images::Auto, Colours::None, &|_| None).expect("pictures are on");
        let Ok(Drawn::Letters(rows)) = encoder.draw(&shirt(), &request(22, 9)) else { panic!("letters") };
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
    fn drapes_turn_all_round_and_come_nearer() {
        let views = std::iter::successors(Some(FRONT), |look| Some(next_view(*look))).take(5).map(look_name);
        assert_eq!(views.collect::<Vec<_>>(), ["front", "side", "back", "quarter", "front"]);
        assert_eq!(look_name(turned(FRONT, -1)), "345°");
        assert_eq!(next_view(turned(FRONT, 1)), FRONT, "from anywhere the front comes next");
        assert_eq!(look_name(turned(FRONT, 6)), "side");
        assert_eq!(raised(FRONT, 3), FRONT, "the whole garment stays in the middle");
        let near = raised(zoomed(zoomed(FRONT, 1), 1), 1);
        assert_eq!(look_name(near), "front ×1.6");
        assert!(near.rise_pct > 0);
        assert_eq!(zoomed(zoomed(near, -1), -1).rise_pct, 0);
        let seen = std::iter::successors(Some(Map::Plain), |map| Some(next_map(*map))).take(Map::ALL.len());
        assert!(seen.eq(Map::ALL), "every map has its turn");
    }
}

//! Bytes for a picture, decoded as terminals would: kitty, sixel, iTerm2, and none of these in tmux.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::io;
use std::rc::Rc;

use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use image::{Rgba, RgbaImage};
use ratatui::layout::{Rect, Size};
use ratatui::{Terminal, TerminalOptions, Viewport};
use ratatui_image::{FontSize, Image};

use crate::terminal::framed::{FRAME, FramedBackend, Late};
use crate::widgets::picture::{Drawn, FRONT, PictureEncoder, PictureRequest, Pictured, pixel_protocol};
use results::Map;
use store::JobId;

/// Pixels of a cell, and cells of the picture, which needs several of kitty's chunks.
const CELL: FontSize = FontSize::new(6, 12);
const CELLS: Size = Size::new(16, 8);

/// A picture of four colours, a quarter each, divided by a line without symmetry.
fn picture() -> RgbaImage {
    let (width, height) = (u32::from(CELLS.width * CELL.width), u32::from(CELLS.height * CELL.height));
    RgbaImage::from_fn(width, height, |x, y| match (x < width / 3, y < height / 3) {
        (true, true) => Rgba([250, 10, 20, 255]),
        (true, false) => Rgba([0, 0, 0, 255]),
        (false, true) => Rgba([30, 120, 240, 255]),
        (false, false) => Rgba([20, 200, 90, 255]),
    })
}

#[derive(Clone, Default)]
struct Kept(Rc<RefCell<Vec<u8>>>);

impl io::Write for Kept {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.borrow_mut().extend(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Bytes that a picture becomes for a terminal with some environment variables.
fn sent(vars: &[(&str, &str)]) -> String {
    let env = |name: &str| vars.iter().find(|(known, _)| *known == name).map(|(_, value)| (*value).to_owned());
    let encoder = PictureEncoder::with(pixel_protocol(&env).map(|protocol| (protocol, CELL)), false);
    let (columns, rows) = (CELLS.width, CELLS.height);
    let request = PictureRequest { of: Pictured::Drape(JobId(1)), look: FRONT, map: Map::Plain, columns, rows };
    let drawn = encoder.draw(&picture(), &request).expect("it can be encoded");
    let (kept, area) = (Kept::default(), Rect::new(0, 0, columns, rows));
    let line = FramedBackend::new(kept.clone(), Some(CELLS)).expect("memory");
    let mut terminal =
        Terminal::with_options(line, TerminalOptions { viewport: Viewport::Fixed(area) }).expect("memory");
    let shown = terminal.draw(|frame| match &drawn {
        Drawn::Pixels(protocol) => frame.render_widget(Image::new(protocol), area),
        Drawn::Blocks(blocks) => blocks.render(area, frame.buffer_mut()),
        Drawn::Letters(_) => panic!("there are colours"),
    });
    shown.expect("memory");
    while terminal.backend_mut().late() != Late::Nothing {
        terminal.backend_mut().send(true).expect("memory");
    }
    String::from_utf8(kept.0.take()).expect("text")
}

/// Strings in the output that begin with a sequence such as `ESC _` and end with `ESC \` or a bell.
fn strings(bytes: &str, begins: char) -> Vec<&str> {
    let mut found = vec![];
    let mut rest = bytes;
    while let Some(at) = rest.find('\x1b') {
        rest = &rest[at + 1..];
        let kind = rest.chars().next().expect("an escape has something after it");
        match kind {
            '[' => continue,
            kind => assert_eq!(kind, begins, "only one kind of strings"),
        }
        let end = rest.find(['\x1b', '\x07']).expect("a string ends");
        found.push(&rest[1..end]);
        let terminator = if rest[end..].starts_with('\x07') { 1 } else { 2 };
        assert!(terminator == 1 || rest[end..].starts_with("\x1b\\"), "a string ends with a bell or ESC \\");
        rest = &rest[end + terminator..];
    }
    found
}

/// Keys and values of a text such as `a=1,b=2`.
fn keys(text: &str, separator: char) -> BTreeMap<&str, &str> {
    text.split(separator).filter_map(|pair| pair.split_once('=')).collect()
}

fn base64(text: &str) -> Vec<u8> {
    BASE64_STANDARD.decode(text).expect("base64")
}

fn difference(a: &RgbaImage, b: &RgbaImage) -> u8 {
    assert_eq!(a.dimensions(), b.dimensions());
    a.as_raw().iter().zip(b.as_raw()).map(|(a, b)| a.abs_diff(*b)).max().unwrap_or(0)
}

#[test]
fn kitty_is_sent_chunks_of_rgba_and_a_placeholder_a_cell() {
    let bytes = sent(&[("TERM", "xterm-kitty")]);
    let chunks = strings(&bytes, '_');
    assert!(chunks.len() > 1, "{} chunks", chunks.len());
    let mut pixels = vec![];
    let mut first = BTreeMap::new();
    for (k, chunk) in chunks.iter().enumerate() {
        let (control, payload) = chunk.strip_prefix('G').and_then(|rest| rest.split_once(';')).expect("a payload");
        let control = keys(control, ',');
        assert_eq!(control["m"], if k + 1 < chunks.len() { "1" } else { "0" }, "the last says that it is");
        assert!(payload.len() <= 4096 && (control["m"] == "0" || payload.len() % 4 == 0), "chunks are whole");
        pixels.extend(base64(payload));
        if k == 0 {
            first = control;
        } else {
            assert!(!control.contains_key("s"), "sizes are told once");
        }
    }
    let number = |key: &str| first[key].parse::<u32>().expect("a number");
    assert_eq!(
        (first["f"], first["a"], first["U"], first["q"]),
        ("32", "T", "1", "2"),
        "RGBA, shown by letters, no answer"
    );
    let shown = RgbaImage::from_raw(number("s"), number("v"), pixels).expect("as many pixels as it says");
    assert_eq!(difference(&shown, &picture()), 0);
    assert_eq!(bytes.matches('\u{10EEEE}').count(), usize::from(CELLS.width) * usize::from(CELLS.height));
    let [_, r, g, b] = number("i").to_be_bytes();
    assert!(bytes.contains(&format!("38;2;{r};{g};{b}m")), "their colour is its number");
}

#[test]
fn iterm_is_sent_one_png() {
    for program in ["iTerm.app", "WezTerm"] {
        let bytes = sent(&[("TERM_PROGRAM", program)]);
        let [one] = strings(&bytes, ']')[..] else { panic!("one string in {bytes:?}") };
        let (control, payload) = one.strip_prefix("1337;File=").and_then(|rest| rest.split_once(':')).expect("a file");
        let (control, png) = (keys(control, ';'), base64(payload));
        assert_eq!((control["inline"], control["size"]), ("1", png.len().to_string().as_str()));
        let shown = image::load_from_memory_with_format(&png, image::ImageFormat::Png).expect("a PNG").to_rgba8();
        assert_eq!(control["width"], format!("{}px", shown.width()));
        assert_eq!(control["height"], format!("{}px", shown.height()));
        assert_eq!(difference(&shown, &picture()), 0, "{program}");
    }
}

/// Picture in the data of a sixel string, as the VT340 reads it.
fn sixel(data: &str) -> RgbaImage {
    let mut rest = data;
    let number = |rest: &mut &str| -> u32 {
        let end = rest.find(|c: char| !c.is_ascii_digit()).unwrap_or(rest.len());
        let (digits, after) = rest.split_at(end);
        *rest = after.strip_prefix(';').unwrap_or(after);
        digits.parse().unwrap_or_else(|_| panic!("a number before {rest:.20?}"))
    };
    let mut colours = BTreeMap::new();
    let (mut shown, mut at, mut chosen) = (RgbaImage::new(0, 0), (0, 0), 0);
    while let Some(sign) = rest.chars().next() {
        rest = &rest[1..];
        let mut count = 1;
        let sign = if sign == '!' {
            count = number(&mut rest);
            let sign = rest.chars().next().expect("what is repeated");
            rest = &rest[1..];
            sign
        } else {
            sign
        };
        match sign {
            '"' => {
                let [_, _, width, height] = [(); 4].map(|()| number(&mut rest));
                shown = RgbaImage::new(width, height);
            }
            '#' => {
                let digits = rest.find(|c: char| !c.is_ascii_digit()).expect("more than a colour");
                let is_defined = rest[digits..].starts_with(';');
                chosen = number(&mut rest);
                if is_defined {
                    assert_eq!(number(&mut rest), 2, "red, green, blue in percent");
                    colours.insert(chosen, [(); 3].map(|()| (number(&mut rest) * 255 + 50) / 100));
                }
            }
            '$' => at.0 = 0,
            '-' => at = (0, at.1 + 6),
            '?'..='~' => {
                let bits = sign as u32 - '?' as u32;
                let [r, g, b] = colours[&chosen].map(|v| v as u8);
                for (x, bit) in (at.0..at.0 + count).flat_map(|x| (0..6).map(move |bit| (x, bit))) {
                    if bits & (1 << bit) != 0 {
                        shown.put_pixel(x, at.1 + bit, Rgba([r, g, b, 255]));
                    }
                }
                at.0 += count;
            }
            other => panic!("{other:?} is no sixel"),
        }
    }
    shown
}

#[test]
fn sixel_terminals_are_sent_one_string_with_all_pixels() {
    for term in ["foot", "mlterm"] {
        let bytes = sent(&[("TERM", term)]);
        let [one] = strings(&bytes, 'P')[..] else { panic!("one string in {bytes:?}") };
        let (parameters, data) = one.split_once('q').expect("sixels");
        assert!(parameters.chars().all(|c| c.is_ascii_digit() || c == ';'), "{parameters}");
        // Sixel has colours in percent.
        assert!(difference(&sixel(data), &picture()) <= 2, "{term}: {}", difference(&sixel(data), &picture()));
    }
}

#[test]
fn tmux_and_terminals_that_name_none_are_sent_half_blocks_in_frames() {
    for vars in
        [&[("TERM", "xterm-kitty"), ("TMUX", "tmux,1,0")][..], &[("TERM", "foot"), ("STY", "1")], &[("TERM", "xterm")]]
    {
        let bytes = sent(vars);
        assert_eq!(strings(&bytes, '['), Vec::<&str>::new(), "no strings: {vars:?}");
        assert!(bytes.contains('▀') && bytes.len() < FRAME, "{vars:?}");
    }
}

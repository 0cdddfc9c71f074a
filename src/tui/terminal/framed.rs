//! Output to the terminal: changes of the screen are sent in frames of at most [`FRAME`] bytes, texts before pictures.
//! What changes again before it is sent is never sent, so a slow line shows the latest state, and nothing queues up.
//!
//! This replaces ratatui's own backend, which sends every change at once. It uses sequences of ECMA-48 that the VT220
//! and later terminals understand. Blanks are erased, not written.

use std::io::{self, Write};

use crossterm::terminal;
use ratatui::backend::{Backend, ClearType, WindowSize};
use ratatui::buffer::Cell;
use ratatui::layout::{Position, Size};
use ratatui::style::{Color, Modifier};

use crate::widgets::text;

/// Most bytes of a frame. Only a picture of pixels is longer, since it cannot be divided.
pub const FRAME: usize = 4000;
/// Bytes that end a frame.
const END: usize = 4;
/// Number of blanks from which erasing them is shorter than writing them.
const ERASED: usize = 8;
/// Most bytes of a letter; a longer symbol is a sequence that shows pixels.
const LETTER: usize = 16;

#[derive(Clone, Default)]
struct Slot {
    cell: Cell,
    /// True if the contents are not sent yet.
    is_late: bool,
}

/// Kind of cells that are drawn but not sent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Late {
    Nothing,
    Pictures,
    /// Texts are not sent, and perhaps pictures.
    Texts,
}

/// The screen as drawn, and the parts of it that the terminal has.
pub struct FramedBackend<W: Write> {
    out: W,
    /// Size of the screen where there is no terminal; `None` asks the terminal.
    fixed: Option<Size>,
    size: Size,
    slots: Vec<Slot>,
}

impl<W: Write> FramedBackend<W> {
    /// Output to a terminal. Without `fixed`, the size is that of this process's terminal.
    pub fn new(out: W, fixed: Option<Size>) -> io::Result<Self> {
        let mut line = Self { out, fixed, size: Size::ZERO, slots: vec![] };
        line.fit(line.size()?);
        Ok(line)
    }

    /// Sets the size of the screen, all of it blank.
    fn fit(&mut self, size: Size) {
        self.size = size;
        self.slots = vec![Slot::default(); usize::from(size.width) * usize::from(size.height)];
    }

    pub fn late(&self) -> Late {
        let mut late = self.slots.iter().filter(|slot| slot.is_late).peekable();
        if late.peek().is_none() {
            return Late::Nothing;
        }
        if late.all(|slot| is_picture(&slot.cell)) { Late::Pictures } else { Late::Texts }
    }

    /// Sends a frame: texts, then pictures if `with_pictures`. Returns its number of bytes.
    pub fn send(&mut self, with_pictures: bool) -> io::Result<usize> {
        let mut frame = Frame::default();
        let columns = usize::from(self.size.width).max(1);
        let passes = if with_pictures { &[false, true][..] } else { &[false][..] };
        'passes: for pictures in passes {
            for (y, row) in self.slots.chunks_mut(columns).enumerate() {
                let mut x = 0;
                while x < columns {
                    if !row[x].is_late || is_picture(&row[x].cell) != *pictures {
                        x += 1;
                        continue;
                    }
                    let (before, length) = (frame.pen, frame.bytes.len());
                    let told = frame.tell(row, x, y);
                    if frame.bytes.len() + END > FRAME && length > 0 {
                        frame.bytes.truncate(length);
                        frame.pen = before;
                        break 'passes;
                    }
                    row[x..x + told].iter_mut().for_each(|slot| slot.is_late = false);
                    x += told;
                }
            }
        }
        frame.write(Pen::default().style);
        if frame.bytes.is_empty() {
            return Ok(0);
        }
        self.out.write_all(&frame.bytes)?;
        self.out.flush()?;
        Ok(frame.bytes.len())
    }
}

/// True if a cell is part of a picture: only half blocks and sequences for pixels have a background of their own.
fn is_picture(cell: &Cell) -> bool {
    cell.bg != Color::Reset || matches!(cell.symbol(), "▀" | "▄") || cell.symbol().len() > LETTER
}

fn is_blank(cell: &Cell) -> bool {
    let hidden = Modifier::REVERSED | Modifier::UNDERLINED | Modifier::CROSSED_OUT;
    cell.symbol() == " " && cell.bg == Color::Reset && !cell.modifier.intersects(hidden)
}

/// Foreground, background and weight of text.
type Style = (Color, Color, Modifier);

/// State of the terminal's cursor: place and style of the next letter. No place where terminals differ.
#[derive(Clone, Copy)]
struct Pen {
    at: Option<(usize, usize)>,
    style: Style,
}

impl Default for Pen {
    fn default() -> Self {
        Self { at: None, style: (Color::Reset, Color::Reset, Modifier::empty()) }
    }
}

#[derive(Default)]
struct Frame {
    bytes: Vec<u8>,
    pen: Pen,
}

impl Frame {
    /// Writes the next letter of a row, or erases blanks. Returns the number of columns.
    fn tell(&mut self, row: &[Slot], x: usize, y: usize) -> usize {
        let blanks = row[x..].iter().take_while(|slot| is_blank(&slot.cell)).count();
        self.go(x, y);
        let is_end = x + blanks == row.len();
        if blanks >= ERASED || is_end && blanks > 3 {
            self.write(Pen::default().style);
            let erase = if is_end { "\x1b[K".to_owned() } else { format!("\x1b[{blanks}X") };
            self.bytes.extend(erase.as_bytes());
            return blanks;
        }
        let cell = &row[x].cell;
        self.write((cell.fg, cell.bg, cell.modifier));
        self.bytes.extend(cell.symbol().as_bytes());
        let after = x + text::width(cell.symbol()).max(1);
        // After the last column, terminals differ: the cursor stands there still, or in the next line.
        let is_known = cell.symbol().len() <= LETTER && after < row.len();
        self.pen.at = is_known.then_some((after, y));
        1
    }

    fn go(&mut self, x: usize, y: usize) {
        let sequence = match self.pen.at {
            Some(at) if at == (x, y) => return,
            Some((column, line)) if line == y && column < x => format!("\x1b[{}C", x - column),
            _ => format!("\x1b[{};{}H", y + 1, x + 1),
        };
        self.bytes.extend(sequence.as_bytes());
        self.pen.at = Some((x, y));
    }

    /// Changes the style of the next letters.
    fn write(&mut self, style: Style) {
        if style == self.pen.style {
            return;
        }
        let plain = Pen::default().style;
        let (mut before, mut codes) = (self.pen.style, Vec::new());
        // Weights can only be switched off together.
        if !style.2.contains(before.2) || style == plain {
            codes.push(String::new());
            before = plain;
        }
        codes.extend(
            WEIGHTS.iter().filter(|(weight, _)| (style.2 - before.2).contains(*weight)).map(|w| w.1.to_owned()),
        );
        if style.0 != before.0 {
            codes.push(colour(style.0, 0));
        }
        if style.1 != before.1 {
            codes.push(colour(style.1, 10));
        }
        self.bytes.extend(format!("\x1b[{}m", codes.join(";")).as_bytes());
        self.pen.style = style;
    }
}

const WEIGHTS: [(Modifier, &str); 6] = [
    (Modifier::BOLD, "1"),
    (Modifier::DIM, "2"),
    (Modifier::ITALIC, "3"),
    (Modifier::UNDERLINED, "4"),
    (Modifier::REVERSED, "7"),
    (Modifier::CROSSED_OUT, "9"),
];

/// Code of a colour: for letters, or with `more` = 10 for backgrounds.
fn colour(colour: Color, more: u8) -> String {
    let basic = match colour {
        Color::Rgb(r, g, b) => return format!("{};2;{r};{g};{b}", 38 + more),
        Color::Indexed(k) => return format!("{};5;{k}", 38 + more),
        Color::Reset => 39,
        Color::Black => 30,
        Color::Red => 31,
        Color::Green => 32,
        Color::Yellow => 33,
        Color::Blue => 34,
        Color::Magenta => 35,
        Color::Cyan => 36,
        Color::Gray => 37,
        Color::DarkGray => 90,
        Color::LightRed => 91,
        Color::LightGreen => 92,
        Color::LightYellow => 93,
        Color::LightBlue => 94,
        Color::LightMagenta => 95,
        Color::LightCyan => 96,
        Color::White => 97,
    };
    (basic + more).to_string()
}

impl<W: Write> Backend for FramedBackend<W> {
    type Error = io::Error;

    /// Stores changes of the screen; [`FramedBackend::send`] sends them.
    fn draw<'a, I>(&mut self, content: I) -> io::Result<()>
    where
        I: Iterator<Item = (u16, u16, &'a Cell)>,
    {
        let columns = usize::from(self.size.width);
        for (x, y, cell) in content.filter(|(x, ..)| usize::from(*x) < columns) {
            if let Some(slot) = self.slots.get_mut(usize::from(y) * columns + usize::from(x)) {
                *slot = Slot { cell: cell.clone(), is_late: true };
            }
        }
        Ok(())
    }

    /// Hides the cursor; it stays hidden while the workbench has the terminal.
    fn hide_cursor(&mut self) -> io::Result<()> {
        Ok(())
    }

    fn show_cursor(&mut self) -> io::Result<()> {
        Ok(())
    }

    fn get_cursor_position(&mut self) -> io::Result<Position> {
        Ok(Position::ORIGIN)
    }

    fn set_cursor_position<P: Into<Position>>(&mut self, _: P) -> io::Result<()> {
        Ok(())
    }

    fn clear(&mut self) -> io::Result<()> {
        self.fit(self.size()?);
        self.out.write_all(b"\x1b[2J")
    }

    fn clear_region(&mut self, _: ClearType) -> io::Result<()> {
        self.clear()
    }

    fn size(&self) -> io::Result<Size> {
        self.fixed.map_or_else(|| terminal::size().map(Size::from), Ok)
    }

    fn window_size(&mut self) -> io::Result<WindowSize> {
        Ok(WindowSize { columns_rows: self.size()?, pixels: Size::ZERO })
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use std::num::NonZero;

    use proptest::prelude::*;
    use ratatui::buffer::Buffer;
    use ratatui::layout::Rect;

    use super::*;

    const SIZE: Size = Size::new(40, 6);

    fn terminal() -> vt100::Parser {
        let some = |n| NonZero::new(n).expect("not 0");
        vt100::Parser::new(some(SIZE.height), some(SIZE.width), 0)
    }

    fn draw(line: &mut FramedBackend<Vec<u8>>, before: &Buffer, after: &Buffer) {
        line.draw(before.diff(after).into_iter()).expect("memory");
    }

    /// Sends everything, frame by frame. Returns the length of the longest frame.
    fn send_all(line: &mut FramedBackend<Vec<u8>>, terminal: &mut vt100::Parser) -> usize {
        let mut longest = 0;
        while line.late() != Late::Nothing {
            longest = longest.max(line.send(true).expect("memory"));
            terminal.process(&std::mem::take(&mut line.out));
        }
        longest
    }

    fn screen() -> Buffer {
        Buffer::empty(Rect::new(0, 0, SIZE.width, SIZE.height))
    }

    #[test]
    fn texts_go_before_pictures_and_what_was_changed_again_is_not_sent() {
        let mut line = FramedBackend::new(vec![], Some(SIZE)).expect("a size");
        let (blank, mut first) = (screen(), screen());
        first[(3, 0)].set_symbol("▀").set_fg(Color::Rgb(1, 2, 3));
        first.set_string(0, 2, "words", ratatui::style::Style::new());
        draw(&mut line, &blank, &first);
        assert_eq!(line.late(), Late::Texts);
        line.send(false).expect("memory");
        let sent = String::from_utf8(std::mem::take(&mut line.out)).expect("text");
        assert!(sent.contains("words") && !sent.contains('▀'), "{sent:?}");
        assert_eq!(line.late(), Late::Pictures);
        let mut second = first.clone();
        second[(3, 0)].reset();
        draw(&mut line, &first, &second);
        line.send(true).expect("memory");
        let sent = String::from_utf8(std::mem::take(&mut line.out)).expect("text");
        assert!(line.late() == Late::Nothing && !sent.contains('▀'), "{sent:?}");
    }

    #[test]
    fn colours_are_the_shortest_that_name_them() {
        let check = |named, more, expect: &str| assert_eq!(colour(named, more), expect);
        check(Color::Red, 0, "31");
        check(Color::Reset, 10, "49");
        check(Color::Indexed(200), 10, "48;5;200");
        check(Color::Rgb(1, 20, 255), 0, "38;2;1;20;255");
    }

    fn cell() -> impl Strategy<Value = (u16, u16, &'static str, u8, u8, bool)> {
        let symbols = prop::sample::select(vec!["a", " ", "─", "▀", "⠿", "Z", " ", " "]);
        (0..SIZE.width, 0..SIZE.height, symbols, 0..5u8, 0..3u8, any::<bool>())
    }

    proptest! {
        #[test]
        fn the_terminal_shows_what_was_drawn(screens in prop::collection::vec(prop::collection::vec(cell(), 0..120), 1..4)) {
            let (mut line, mut terminal) = (FramedBackend::new(vec![], Some(SIZE)).expect("a size"), terminal());
            let mut before = screen();
            for cells in screens {
                let mut after = screen();
                for (x, y, symbol, front, back, is_bold) in cells {
                    let place = &mut after[(x, y)];
                    place.set_symbol(symbol);
                    place.fg = [Color::Reset, Color::Red, Color::Indexed(99), Color::Rgb(9, 8, 7), Color::White][usize::from(front)];
                    place.bg = [Color::Reset, Color::Blue, Color::Rgb(1, 2, 3)][usize::from(back)];
                    place.modifier = if is_bold { Modifier::BOLD } else { Modifier::empty() };
                }
                draw(&mut line, &before, &after);
                // Sends only a part before the next change.
                line.send(false).expect("memory");
                terminal.process(&std::mem::take(&mut line.out));
                before = after;
            }
            let longest = send_all(&mut line, &mut terminal);
            prop_assert!(longest <= FRAME, "{longest}");
            for y in 0..SIZE.height {
                for x in 0..SIZE.width {
                    let (wanted, shown) = (&before[(x, y)], terminal.screen().cell(y, x).expect("within"));
                    let text = if shown.has_contents() { shown.contents() } else { " " };
                    prop_assert_eq!(text, wanted.symbol(), "{} {}", x, y);
                    if wanted.symbol() != " " {
                        prop_assert_eq!(shown.bold(), wanted.modifier.contains(Modifier::BOLD));
                        let is_plain = shown.fgcolor() == vt100::Color::Default;
                        prop_assert_eq!(is_plain, wanted.fg == Color::Reset);
                    }
                    let is_plain = shown.bgcolor() == vt100::Color::Default;
                    prop_assert_eq!(is_plain, wanted.bg == Color::Reset);
                }
            }
        }
    }
}

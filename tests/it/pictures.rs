//! Pictures of the workbench for the documents, made from the real program: an SVG a screen, and one that moves.
//!
//! `TOILE_DB=db/toile.sqlite cargo test --test it pictures -- --ignored` writes them to `docs/pictures`; the database
//! should have the results of a study.

use std::fmt::Write;
use std::path::Path;

use super::program::Place;
use super::seat::Seat;
use super::workbench::workbench;

/// Width and height of a cell, and the size of its letters, pixels.
const CELL: (f64, f64) = (8.4, 17.0);
const LETTER: f64 = 14.0;
/// Columns and rows of the terminal.
const COLUMNS: u16 = 120;
const ROWS: u16 = 36;
/// Letters and background where the program names no colour.
const PLAIN: ([u8; 3], [u8; 3]) = ([216, 216, 216], [30, 30, 30]);
/// The first sixteen colours.
const SIXTEEN: [[u8; 3]; 16] = [
    [0, 0, 0],
    [224, 108, 117],
    [126, 196, 118],
    [229, 192, 123],
    [97, 150, 239],
    [208, 135, 230],
    [86, 192, 206],
    [190, 190, 190],
    [110, 110, 110],
    [240, 130, 140],
    [150, 220, 140],
    [240, 210, 140],
    [130, 175, 250],
    [225, 160, 245],
    [110, 215, 230],
    [255, 255, 255],
];

/// The red, green and blue of a colour of a terminal.
fn rgb(colour: vt100::Color, plain: [u8; 3]) -> [u8; 3] {
    match colour {
        vt100::Color::Default => plain,
        vt100::Color::Rgb(r, g, b) => [r, g, b],
        vt100::Color::Idx(k @ 0..=15) => SIXTEEN[usize::from(k)],
        vt100::Color::Idx(k @ 232..) => [8 + 10 * (k - 232); 3],
        vt100::Color::Idx(k) => {
            let level = |n: u8| if n == 0 { 0 } else { 55 + 40 * n };
            [(k - 16) / 36, (k - 16) / 6 % 6, (k - 16) % 6].map(level)
        }
    }
}

fn hex([r, g, b]: [u8; 3]) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// A letter as it is painted: its colours, and whether it is bold.
#[derive(Clone, PartialEq)]
struct Painted {
    text: String,
    front: [u8; 3],
    back: [u8; 3],
    is_bold: bool,
}

impl Painted {
    /// Where a half block begins, as a share of its cell.
    fn half(&self) -> Option<f64> {
        match self.text.as_str() {
            "▀" => Some(0.0),
            "▄" => Some(0.5),
            _ => None,
        }
    }
}

fn painted(cell: &vt100::Cell) -> Painted {
    let (mut front, mut back) = (rgb(cell.fgcolor(), PLAIN.0), rgb(cell.bgcolor(), PLAIN.1));
    if cell.inverse() {
        std::mem::swap(&mut front, &mut back);
    }
    if cell.dim() {
        front = std::array::from_fn(|k| ((u16::from(front[k]) * 3 + u16::from(back[k]) * 2) / 5) as u8);
    }
    let text = if cell.has_contents() { cell.contents().to_owned() } else { " ".to_owned() };
    Painted { text, front, back, is_bold: cell.bold() }
}

/// A screen as the inside of an SVG: a rectangle a run of one background, a text a run of one style. Half blocks are two
/// rectangles, so that pictures have no gaps.
fn drawn(screen: &vt100::Screen) -> String {
    let (rows, columns) = screen.size();
    let (rows, columns) = (rows.get(), columns.get());
    let mut svg = String::new();
    for row in 0..rows {
        let cells: Vec<Painted> = (0..columns).filter_map(|column| screen.cell(row, column)).map(painted).collect();
        let y = f64::from(row) * CELL.1;
        let runs = |same: &dyn Fn(&Painted, &Painted) -> bool| {
            let mut starts: Vec<usize> =
                (0..cells.len()).filter(|k| *k == 0 || !same(&cells[*k - 1], &cells[*k])).collect();
            starts.push(cells.len());
            starts.windows(2).map(|pair| (pair[0], pair[1])).collect::<Vec<_>>()
        };
        let mut rectangle = |from: usize, to: usize, top: f64, height: f64, colour: [u8; 3]| {
            let (x, width) = (from as f64 * CELL.0, (to - from) as f64 * CELL.0);
            let _ = write!(
                svg,
                r#"<rect x="{x:.1}" y="{top:.1}" width="{width:.1}" height="{height:.1}" fill="{}"/>"#,
                hex(colour)
            );
        };
        for (from, to) in runs(&|a, b| a.back == b.back) {
            if cells[from].back != PLAIN.1 {
                rectangle(from, to, y, CELL.1 + 0.3, cells[from].back);
            }
        }
        for (from, to) in runs(&|a, b| a.front == b.front && a.half() == b.half()) {
            if let Some(down) = cells[from].half() {
                rectangle(from, to, y + down * CELL.1, CELL.1 / 2.0 + 0.3, cells[from].front);
            }
        }
        for (from, to) in
            runs(&|a, b| a.front == b.front && a.is_bold == b.is_bold && a.half().is_some() == b.half().is_some())
        {
            if cells[from].half().is_some() {
                continue;
            }
            let text: String = cells[from..to].iter().map(|cell| cell.text.as_str()).collect();
            let weight = if cells[from].is_bold { r#" font-weight="bold""# } else { "" };
            // Viewers run blanks together: what several of them part is placed by itself.
            let mut column = from;
            for word in text.split("  ") {
                let shown = word.trim();
                let x = (column + word.chars().take_while(|c| *c == ' ').count()) as f64 * CELL.0;
                column += word.chars().count() + 2;
                if shown.is_empty() {
                    continue;
                }
                let width = shown.chars().count() as f64 * CELL.0;
                let escaped = shown.replace('&', "&amp;").replace('<', "&lt;");
                let _ = write!(
                    svg,
                    r#"<text x="{x:.1}" y="{:.1}" textLength="{width:.1}" fill="{}"{weight}>{escaped}</text>"#,
                    y + 0.76 * CELL.1,
                    hex(cells[from].front)
                );
            }
        }
        svg.push('\n');
    }
    svg
}

/// An SVG of some frames, each shown for so many seconds; one alone stands still.
fn picture(frames: &[(String, f64)], columns: u16, rows: u16) -> String {
    let (width, height) = (f64::from(columns) * CELL.0, f64::from(rows) * CELL.1);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width:.0} {height:.0}\" width=\"{width:.0}\" \
         font-family=\"DejaVu Sans Mono, Menlo, Consolas, monospace\" font-size=\"{LETTER}\" xml:space=\"preserve\">\n\
         <rect width=\"100%\" height=\"100%\" fill=\"{}\"/>\n",
        hex(PLAIN.1)
    );
    let total: f64 = frames.iter().map(|(_, seconds)| seconds).sum();
    let mut at = 0.0;
    for (k, (frame, seconds)) in frames.iter().enumerate() {
        if frames.len() > 1 {
            let (from, to) = (100.0 * at / total, 100.0 * (at + seconds) / total);
            let _ = write!(
                svg,
                "<style>@keyframes f{k} {{ 0% {{ visibility: {} }} {from:.3}% {{ visibility: visible }} {to:.3}% \
                 {{ visibility: hidden }} 100% {{ visibility: hidden }} }} .f{k} {{ visibility: hidden; animation: f{k} \
                 {total}s steps(1, end) infinite }}</style>\n<g class=\"f{k}\">\n{frame}</g>\n",
                if k == 0 { "visible" } else { "hidden" }
            );
            at += seconds;
        } else {
            svg += frame;
        }
    }
    svg + "</svg>\n"
}

/// Keys, how long what they show stays, and the name of a picture of its own.
type Scene<'a> = (&'a str, f64, Option<&'a str>);

/// A walk through the screens.
const SCENES: [Scene; 19] = [
    ("", 2.0, Some("study")),
    ("<Down>", 0.6, None),
    ("<Right>", 0.6, None),
    ("<Right>", 1.2, None),
    ("2", 1.6, None),
    ("4", 1.6, None),
    ("<Enter>", 2.0, Some("results")),
    ("v", 1.2, None),
    ("m", 1.2, None),
    ("m", 1.6, Some("stretch")),
    ("c", 2.4, Some("compare")),
    ("d", 1.4, None),
    ("7", 0.8, None),
    ("eSELECT garment, size, subject, simulator, ei FROM v_m", 0.8, None),
    ("<Tab> ORDER BY ei DESC<F5>", 1.0, None),
    ("<Tab>", 2.4, Some("sql")),
    ("9", 1.4, None),
    ("jjjjj", 2.0, Some("fabrics")),
    ("?", 2.0, None),
];

/// The steps of the tour.
const TOUR: [Scene; 6] = [
    ("<C-c>1T", 0.0, Some("tour-1")),
    ("<Enter>", 0.0, Some("tour-2")),
    ("<Enter>", 0.0, Some("tour-3")),
    ("<Enter>", 0.0, Some("tour-4")),
    ("<Enter>", 0.0, Some("tour-5")),
    ("<Enter>", 0.0, Some("tour-6")),
];

/// Plays scenes and writes those that have a picture of their own; returns all of them with their seconds.
fn played(seat: &Seat, scenes: &[Scene], folder: &Path) -> Vec<(String, f64)> {
    let play = |(keys, seconds, name): &Scene| {
        seat.press(keys);
        seat.settle();
        seat.wait_until("pictures", |screen| !screen.contains("drawing…") && !screen.contains("reading"));
        seat.settle();
        let frame = seat.shown(drawn);
        if let Some(name) = name {
            let still = picture(&[(frame.clone(), 1.0)], COLUMNS, ROWS);
            std::fs::write(folder.join(format!("{name}.svg")), still).expect("writable");
        }
        (frame, *seconds)
    };
    scenes.iter().map(play).collect()
}

#[test]
#[ignore = "writes docs/pictures from the database of TOILE_DB"]
fn pictures_of_the_workbench() {
    let database = std::env::var("TOILE_DB").expect("TOILE_DB names a database with results");
    let place = Place::new();
    let mut command = workbench(&place);
    command.env("TOILE_DB", std::path::absolute(database).expect("a path")).env("COLORTERM", "truecolor");
    let Some(seat) = Seat::take(&command, COLUMNS, ROWS) else { return };
    seat.wait_for("chi");
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/pictures");
    std::fs::create_dir_all(&folder).expect("writable");
    let frames = played(&seat, &SCENES, &folder);
    std::fs::write(folder.join("workbench.svg"), picture(&frames, COLUMNS, ROWS)).expect("writable");
    played(&seat, &TOUR, &folder);
}

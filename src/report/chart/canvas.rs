//! Canvas for charts, with a few kinds of marks and one type size.
//!
//! Lengths are in half CSS pixels, so that whole numbers place marks finely enough.

use super::super::{ReportError, theme};
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::register_font;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use render::Rgb;
use std::sync::OnceLock;

pub(super) const WIDTH: i32 = 1600;
/// Type size of labels.
pub(super) const TYPE: i32 = 27;
/// Height of one row of a chart by rows.
pub(super) const ROW: i32 = 58;

#[derive(Clone, Copy)]
pub(super) enum Align {
    Left,
    Middle,
    Right,
}

pub(super) struct Canvas<'a> {
    area: DrawingArea<SVGBackend<'a>, Shift>,
}

fn colour(rgb: Rgb) -> RGBColor {
    RGBColor(rgb.0, rgb.1, rgb.2)
}

pub(super) fn draw(
    height: i32,
    paint: impl FnOnce(&Canvas<'_>) -> Result<(), ReportError>,
) -> Result<String, ReportError> {
    load_fonts()?;
    let mut svg = String::new();
    {
        let area = SVGBackend::with_string(&mut svg, (WIDTH as u32, height.max(1) as u32)).into_drawing_area();
        let canvas = Canvas { area };
        paint(&canvas)?;
        canvas.area.present().map_err(refused)?;
    }
    Ok(svg)
}

/// Registers the embedded font, with which plotters measures text.
fn load_fonts() -> Result<(), ReportError> {
    static LOADED: OnceLock<bool> = OnceLock::new();
    let load = || {
        register_font("sans-serif", FontStyle::Normal, dejavu::sans::regular()).is_ok()
            && register_font("sans-serif", FontStyle::Bold, dejavu::sans::bold()).is_ok()
    };
    if *LOADED.get_or_init(load) {
        Ok(())
    } else {
        Err(ReportError::Chart("the embedded font could not be read".into()))
    }
}

fn refused<E: std::error::Error + Send + Sync>(error: DrawingAreaErrorKind<E>) -> ReportError {
    ReportError::Chart(error.to_string())
}

impl Canvas<'_> {
    /// Draws text; `bold` is for headings.
    pub fn text(&self, at: (i32, i32), text: &str, ink: Rgb, align: Align, bold: bool) -> Result<(), ReportError> {
        let anchor = match align {
            Align::Left => HPos::Left,
            Align::Middle => HPos::Center,
            Align::Right => HPos::Right,
        };
        let style = if bold { FontStyle::Bold } else { FontStyle::Normal };
        // For SVG, plotters divides the given size by 1.24.
        let ink = colour(ink);
        let style = ("sans-serif", f64::from(TYPE) * 1.24, style).into_text_style(&self.area);
        let style = style.color(&ink).pos(Pos::new(anchor, VPos::Center));
        self.area.draw(&Text::new(text.to_owned(), at, style)).map_err(refused)
    }

    pub fn text_width(&self, text: &str) -> i32 {
        let style = ("sans-serif", f64::from(TYPE)).into_text_style(&self.area);
        self.area.estimate_text_size(text, &style).map_or(TYPE * text.chars().count() as i32, |(width, _)| width as i32)
    }

    pub fn bar(&self, from: (i32, i32), to: (i32, i32), fill: Rgb) -> Result<(), ReportError> {
        self.area.draw(&Rectangle::new([from, to], colour(fill).filled())).map_err(refused)
    }

    pub fn area(&self, corners: Vec<(i32, i32)>, fill: Rgb) -> Result<(), ReportError> {
        self.area.draw(&Polygon::new(corners, colour(fill).filled())).map_err(refused)
    }

    pub fn line(&self, points: Vec<(i32, i32)>, ink: Rgb, width: u32) -> Result<(), ReportError> {
        self.area.draw(&PathElement::new(points, colour(ink).stroke_width(width))).map_err(refused)
    }

    /// Draws the mark of a series, which has its own shape and colour.
    pub fn mark(&self, (x, y): (i32, i32), series: usize, hollow: bool) -> Result<(), ReportError> {
        let ink = colour(theme::SUBJECTS[series % theme::SUBJECTS.len()]);
        let fill = if hollow { colour(theme::PAPER).filled() } else { ink.filled() };
        const R: i32 = 11;
        let corners: Vec<(i32, i32)> = match series % 4 {
            0 => {
                self.area.draw(&Circle::new((x, y), R, fill)).map_err(refused)?;
                return self.area.draw(&Circle::new((x, y), R, ink.stroke_width(4))).map_err(refused);
            }
            1 => vec![(x - 10, y - 10), (x + 10, y - 10), (x + 10, y + 10), (x - 10, y + 10)],
            2 => vec![(x, y - 13), (x + 13, y + 10), (x - 13, y + 10)],
            _ => vec![(x, y - 14), (x + 14, y), (x, y + 14), (x - 14, y)],
        };
        self.area.draw(&Polygon::new(corners.clone(), fill)).map_err(refused)?;
        let outline: Vec<_> = corners.iter().chain(corners.first()).copied().collect();
        self.area.draw(&PathElement::new(outline, ink.stroke_width(4))).map_err(refused)
    }

    /// Draws a filled dot.
    pub fn dot(&self, at: (i32, i32), fill: Rgb) -> Result<(), ReportError> {
        self.area.draw(&Circle::new(at, 12, colour(fill).filled())).map_err(refused)
    }

    /// Draws the marks and names of a chart, broken into lines. Returns the height.
    pub fn key(&self, names: &[String], left: i32, top: i32) -> Result<i32, ReportError> {
        let (mut x, mut y) = (left, top + TYPE);
        for (series, name) in names.iter().enumerate() {
            let width = 44 + self.text_width(name) + 40;
            if x + width > WIDTH && x > left {
                (x, y) = (left, y + TYPE + 20);
            }
            self.mark((x + 14, y), series, false)?;
            self.text((x + 44, y), name, theme::INK, Align::Left, false)?;
            x += width;
        }
        Ok(y + TYPE - top)
    }
}

/// Maps values to coordinates.
#[derive(Clone, Copy)]
pub(super) struct Axis {
    pub low: f64,
    pub high: f64,
    pub left: i32,
    pub right: i32,
}

impl Axis {
    /// Coordinate of a value, clamped to the axis.
    pub fn at(&self, value: f64) -> i32 {
        let t = ((value - self.low) / (self.high - self.low)).clamp(0.0, 1.0);
        self.left + (t * f64::from(self.right - self.left)).round() as i32
    }

    /// Round values for ticks, about eight at most, and the number of decimals that they need.
    pub fn ticks(&self) -> (Vec<f64>, usize) {
        let span = self.high - self.low;
        let rough = span / 8.0;
        let power = 10f64.powf(rough.log10().floor());
        let step = [1.0, 2.0, 5.0, 10.0].map(|m| m * power).into_iter().find(|&s| s >= rough).unwrap_or(rough);
        let first = (self.low / step - 1e-6).ceil() as i64;
        let last = (self.high / step + 1e-6).floor() as i64;
        let decimals = (-step.log10().floor()).max(0.0) as usize;
        ((first..=last).map(|k| k as f64 * step).collect(), decimals)
    }

    pub fn grid(&self, canvas: &Canvas<'_>, top: i32, bottom: i32) -> Result<(), ReportError> {
        let (ticks, decimals) = self.ticks();
        for tick in ticks {
            let x = self.at(tick);
            canvas.line(vec![(x, top), (x, bottom)], theme::GRID, 2)?;
            canvas.text((x, bottom + TYPE), &format!("{tick:.decimals$}"), theme::MUTED, Align::Middle, false)?;
        }
        Ok(())
    }
}

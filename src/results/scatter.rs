//! Scatter plots as SVG: head, frame, axes and colours of pictures that show people by two measurements.

use std::fmt::Write;

/// Colours that differ in lightness too [Okabe & Ito 2008].
pub const COLOURS: [&str; 7] = ["#0072b2", "#e69f00", "#009e73", "#cc79a7", "#56b4e9", "#d55e00", "#f0e442"];

/// Start of an SVG picture on white ground, px.
pub fn head(width: f64, height: f64) -> String {
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" height=\"{height}\" \
        font-family=\"DejaVu Sans, sans-serif\" font-size=\"12\" fill=\"#222\">\n<rect width=\"100%\" height=\"100%\" \
        fill=\"white\"/>\n"
    )
}

/// A square panel with two axes; lengths in px.
pub struct Panel {
    /// Distance from the left side of the picture.
    pub left: f64,
    pub side: f64,
    /// Distance from the top of the picture.
    pub margin: f64,
    /// Limits of the horizontal axis.
    pub x: (f64, f64),
    pub y: (f64, f64),
}

impl Panel {
    /// Horizontal position of a value.
    pub fn across(&self, x: f64) -> f64 {
        self.left + (x - self.x.0) / (self.x.1 - self.x.0) * self.side
    }

    /// Vertical position of a value.
    pub fn up(&self, y: f64) -> f64 {
        self.margin + self.side - (y - self.y.0) / (self.y.1 - self.y.0) * self.side
    }

    /// Escapes the texts.
    pub fn frame(&self, svg: &mut String, title: &str, [across, up]: [&str; 2]) {
        let Self { left, side, margin, x, y } = self;
        let bottom = margin + side;
        // Writing to a `String` does not fail, here and below.
        let _ = writeln!(svg, "<text x=\"{left}\" y=\"24\" font-size=\"16\">{title}</text>");
        let _ = writeln!(
            svg,
            "<rect x=\"{left}\" y=\"{margin}\" width=\"{side}\" height=\"{side}\" fill=\"none\" stroke=\"#999\"/>"
        );
        for k in 0..=4 {
            let share = f64::from(k) / 4.0;
            let (at_x, at_y) = (x.0 + (x.1 - x.0) * share, y.0 + (y.1 - y.0) * share);
            let (place, below) = (self.across(at_x), bottom + 16.0);
            let _ = writeln!(svg, "<text x=\"{place:.1}\" y=\"{below}\" text-anchor=\"middle\">{at_x:.0}</text>");
            let (place, beside) = (self.up(at_y) + 4.0, left - 5.0);
            let _ = writeln!(svg, "<text x=\"{beside}\" y=\"{place:.1}\" text-anchor=\"end\">{at_y:.0}</text>");
        }
        let (middle, below) = (left + side / 2.0, bottom + 36.0);
        let _ = writeln!(svg, "<text x=\"{middle}\" y=\"{below}\" text-anchor=\"middle\">{across}</text>");
        let _ = writeln!(svg, "<text x=\"{left}\" y=\"{}\">{up}</text>", margin - 8.0);
    }

    pub fn legend(&self, svg: &mut String, number: usize, colour: &str, text: &str) {
        let y = self.margin + 18.0 + 18.0 * number as f64;
        let _ = writeln!(svg, "<circle cx=\"{}\" cy=\"{}\" r=\"5\" fill=\"{colour}\"/>", self.left + 14.0, y - 4.0);
        let _ = writeln!(svg, "<text x=\"{}\" y=\"{y}\">{text}</text>", self.left + 24.0);
    }
}

/// Limits around values, rounded outwards to hundreds.
pub fn axis(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let (low, high) = values.fold((f64::MAX, f64::MIN), |(low, high), value| (low.min(value), high.max(value)));
    if low > high {
        return (0.0, 100.0);
    }
    (((low - 10.0) / 100.0).floor() * 100.0, ((high + 10.0) / 100.0).ceil() * 100.0)
}

/// Text in which the characters that XML reserves are escaped.
pub fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

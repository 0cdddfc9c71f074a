//! Charts, drawn with plotters as SVG with selectable text, and rasterised as PNG.

mod canvas;
mod chance;
mod chi;
mod difference;
mod metric;
mod repeat;
mod residual;
mod scatter;
mod section;

pub use chance::{Probable, chance_chart};
pub use chi::{chi_chart, mean_sd_chart};
pub use difference::{Difference, crossover_chart, difference_chart};
pub use metric::{Metric, metric_chart};
pub(super) use repeat::repeat_chart;
pub use residual::residual_chart;
pub use scatter::{ease_chart, time_chart};
pub use section::{Worn, section_chart};

use super::names::{FileNames, file_part};
use super::{ReportError, theme};
use image::imageops;
use render::{RenderError, png, rasterise_svg};

/// Longest side of a chart that is too large and therefore reduced for a PNG file, pixels.
const PNG_SIDE: f32 = 8000.0;

#[derive(Clone, Debug)]
pub struct Chart {
    name: String,
    svg: String,
    alt: String,
}

impl Chart {
    /// Makes a chart of a kind, such as `chi`, with a title.
    fn new(kind: &str, title: &str, svg: String, alt: String) -> Self {
        Self { name: file_part(&format!("{title} {kind}").to_lowercase()), svg, alt }
    }

    /// Gives the chart a name that no other chart of the report has.
    pub(super) fn name_among(&mut self, names: &mut FileNames) {
        self.name = names.part(&self.name);
    }

    /// Path of the file, relative to the report's page.
    pub fn address(&self, extension: &str) -> String {
        format!("charts/{}.{extension}", self.name)
    }

    pub fn svg(&self) -> &str {
        &self.svg
    }

    pub fn alt(&self) -> &str {
        &self.alt
    }

    /// Encodes on white, with the embedded font. Reduces a chart that is too large for a picture.
    pub fn png(&self) -> Result<Vec<u8>, ReportError> {
        let drawing = match rasterise_svg(&self.svg, 1.0) {
            // Many measurements of many subjects make a tall chart.
            Err(RenderError::Size { width, height }) => {
                rasterise_svg(&self.svg, PNG_SIDE / width.max(height).max(1) as f32)
            }
            drawn => drawn,
        }?;
        let mut picture = image::RgbaImage::from_pixel(drawing.width(), drawing.height(), image::Rgba([255; 4]));
        imageops::overlay(&mut picture, &drawing, 0, 0);
        Ok(png(&picture)?)
    }

    /// SVG element for the page. Its neutral colours follow the reader's light or dark scheme; it is as wide as the
    /// column.
    pub(super) fn inline(&self) -> String {
        let alt = super::text::escape(&self.alt);
        let mut svg =
            self.svg.replacen("<svg ", &format!("<svg class=\"chart\" role=\"img\" aria-label=\"{alt}\" "), 1);
        for (colour, variable) in theme::VARIABLES {
            svg = svg.replace(&colour.hex().to_uppercase(), variable);
        }
        svg.replace("font-family=\"sans-serif\" ", "").replace(" opacity=\"1\"", "").replace(">\n", ">")
    }
}

/// `most` counts characters.
fn shorten(text: &str, most: usize) -> String {
    if text.chars().count() <= most {
        return text.to_owned();
    }
    text.chars().take(most - 1).chain(['…']).collect()
}

fn row_label(no: u32, name: &str) -> String {
    format!("#{no} {}", shorten(name, 30))
}

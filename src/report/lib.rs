//! The report of a study: one HTML page that needs nothing else, and its charts.
//!
//! [`ReportData`] holds plain values; [`html`] turns them into a page without scripts or addresses of other machines:
//! pictures and pattern drawings are inside it. Pictures are best JPEG ([`render::jpeg`]): six runs of five stay
//! under 3 MB. Charts are SVG in the page; [`Chart::png`] gives the same as a file.

pub mod chart;
pub mod data;
mod evidence;
mod page;
mod repeats;
mod runs;
mod text;
mod theme;

pub use chart::Chart;
pub use data::ReportData;

use askama::Template;

/// Why a report could not be made.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// A chart could not be drawn.
    #[error("chart: {0}")]
    Chart(String),
    /// A picture could not be made.
    #[error("picture: {0}")]
    Picture(#[from] render::RenderError),
    /// The page could not be filled in.
    #[error("page: {0}")]
    Page(#[from] askama::Error),
    /// A picture is neither PNG nor JPEG.
    #[error("picture \"{0}\" is neither PNG nor JPEG")]
    PictureFormat(String),
    /// A link leads away from the report.
    #[error("link \"{0}\" must be an address relative to the report, like chi.csv")]
    Link(String),
}

/// The page of a report.
///
/// # Errors
/// A link that is not relative, a picture that is neither PNG nor JPEG, or a chart that cannot be drawn.
pub fn html(data: &ReportData) -> Result<String, ReportError> {
    Ok(page::Page::new(data)?.render()?)
}

/// The files of a report by their relative paths: `index.html` and its charts as SVG and PNG.
///
/// # Errors
/// As [`html`], and where a chart cannot be turned into pixels.
pub fn files(data: &ReportData) -> Result<Vec<(String, Vec<u8>)>, ReportError> {
    let page = page::Page::new(data)?;
    let mut files = vec![("index.html".to_owned(), page.render()?.into_bytes())];
    for chart in page.charts() {
        files.push((chart.address("svg"), chart.svg().as_bytes().to_vec()));
        files.push((chart.address("png"), chart.png()?));
    }
    Ok(files)
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that cannot go on should stop")]
mod tests;

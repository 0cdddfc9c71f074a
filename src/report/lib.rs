//! Report of a study: self-contained HTML pages, and their charts.
//!
//! [`ReportData`] holds plain values, and [`files`] turns them into pages. A page needs no network: pictures and
//! pattern drawings are embedded. The fit report has one script, its viewer; the page that compares simulators has
//! none. JPEG ([`render::jpeg`]) suits pictures best: six runs with five pictures each stay below 3 MB. Charts are SVG
//! in the page, and [`Chart::png`] makes files of them.

mod callouts;
pub mod chart;
pub mod data;
mod evidence;
mod images;
mod names;
mod page;
mod repeats;
mod runs;
mod sheet;
mod spread;
mod text;
mod theme;
pub mod viewer;

pub use chart::Chart;
pub use data::ReportData;
pub use names::{FileNames, file_part};

use askama::Template;

#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    #[error("chart: {0}")]
    Chart(String),
    #[error("picture: {0}")]
    Picture(#[from] render::RenderError),
    #[error("page: {0}")]
    Page(#[from] askama::Error),
    #[error("drapes: {0}")]
    Drapes(#[from] serde_json::Error),
    #[error("picture \"{0}\" is neither PNG nor JPEG")]
    PictureFormat(String),
    #[error("link \"{0}\" must be an address relative to the report, like chi.csv")]
    Link(String),
}

/// Purpose of a report, which decides its first page; the page for the other purpose lies beside it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    Fit,
    /// Comparison of the simulators: agreement of their drapes with the pattern.
    Compare,
}

/// Makes the page that compares the simulators.
pub fn html(data: &ReportData) -> Result<String, ReportError> {
    Ok(page(data, None, &mut FileNames::default())?.render()?)
}

/// Makes the files of a report, by their relative paths: `index.html` for its purpose, the other page where garments
/// are fitted, and charts as SVG and PNG.
pub fn files(data: &ReportData, purpose: Purpose) -> Result<Vec<(String, Vec<u8>)>, ReportError> {
    let [compare, fit] = match purpose {
        Purpose::Compare => ["index.html", "fit.html"],
        Purpose::Fit => ["compare.html", "index.html"],
    };
    let is_fitted = !data.fit.sheets.is_empty();
    let compare = if is_fitted { compare } else { "index.html" };
    let mut names = FileNames::default();
    let mut page = page(data, is_fitted.then_some(fit), &mut names)?;
    let mut files = vec![(compare.to_owned(), page.render()?.into_bytes())];
    if is_fitted {
        files.push((fit.to_owned(), sheet::FitPage::new(data, compare)?.render()?.into_bytes()));
    }
    for mut chart in data.fit.sheets.iter().flat_map(|sheet| sheet.sections.clone()) {
        chart.name_among(&mut names);
        files.push((chart.address("svg"), chart.svg().as_bytes().to_vec()));
    }
    for chart in page.charts() {
        files.push((chart.address("svg"), chart.svg().as_bytes().to_vec()));
        files.push((chart.address("png"), chart.png()?));
    }
    Ok(files)
}

/// Makes the page that compares the simulators, with file names for its charts that are not yet among `names`.
fn page<'a>(data: &'a ReportData, fit: Option<&'a str>, names: &mut FileNames) -> Result<page::Page<'a>, ReportError> {
    let mut page = page::Page::new(data, fit)?;
    page.charts().for_each(|chart| chart.name_among(names));
    Ok(page)
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that cannot go on should stop")]
mod tests;

//! Contact sheets beside a report: all drapes of a garment and size in one picture.

use std::collections::BTreeMap;

use image::imageops;

use render::{self, Cell, RenderError, View};
use report::FileNames;
use report::data::RawLink;
use store::{InOrigin, JobRow, Origin, Result};

/// Size of a picture on the page, pixels.
pub(super) const PICTURE: (u32, u32) = (480, 540);

/// Longest side of a sheet, without labels, pixels.
const SHEET_SIDE: f64 = 5500.0;
/// Number of jobs in a column of a sheet.
const JOBS_HIGH: f64 = 10.0;

/// Contact sheets of all garments and sizes. Each is made when its last job is added, since memory would not hold all
/// sheets of a large study.
pub(super) struct Sheets<'a> {
    study: &'a str,
    names: FileNames,
    open: BTreeMap<(&'a str, &'a str), Sheet>,
}

struct Sheet {
    /// Number of jobs still to be added.
    left: usize,
    columns: usize,
    /// Pixels of a picture.
    size: [u32; 2],
    cells: Vec<Cell>,
}

impl Sheet {
    /// Many jobs stand in several columns, so that the sheet is about square and within [`SHEET_SIDE`].
    fn new(jobs: usize) -> Self {
        let beside = (jobs as f64 / JOBS_HIGH).sqrt().ceil().max(1.0);
        let rows = (jobs as f64 / beside).ceil();
        let columns = beside * View::ALL.len() as f64;
        let [width, height] = [PICTURE.0, PICTURE.1].map(f64::from);
        let shrink = (SHEET_SIDE / (columns * width)).min(SHEET_SIDE / (rows * height)).min(1.0);
        let size = [width, height].map(|side| (side * shrink).max(1.0) as u32);
        Self { left: jobs, columns: columns as usize, size, cells: Vec::new() }
    }

    fn add(&mut self, cell: Cell) {
        let [width, height] = self.size;
        let picture = if width == PICTURE.0 {
            cell.picture
        } else {
            imageops::resize(&cell.picture, width, height, imageops::FilterType::CatmullRom)
        };
        self.cells.push(Cell { picture, ..cell });
    }
}

impl<'a> Sheets<'a> {
    pub(super) fn of(study: &'a str, jobs: &'a [JobRow]) -> Self {
        let mut counts: BTreeMap<_, usize> = BTreeMap::new();
        for job in jobs {
            *counts.entry((job.garment.as_str(), job.size.as_str())).or_default() += 1;
        }
        Self {
            study,
            names: FileNames::default(),
            open: counts.into_iter().map(|(key, count)| (key, Sheet::new(count))).collect(),
        }
    }

    /// Returns a link to the sheet and its file once it is complete.
    pub(super) fn add(&mut self, job: &'a JobRow, cells: Vec<Cell>) -> Result<Option<(RawLink, Vec<u8>)>> {
        let (garment, size) = (job.garment.as_str(), job.size.as_str());
        let Some(sheet) = self.open.get_mut(&(garment, size)) else { return Ok(None) };
        sheet.left -= 1;
        cells.into_iter().for_each(|cell| sheet.add(cell));
        if sheet.left > 0 || sheet.cells.is_empty() {
            return Ok(None);
        }
        let title = format!("{}: {garment}, size {size}", self.study);
        let picture = render::contact_sheet(&title, &sheet.cells, sheet.columns).and_then(|sheet| render::jpeg(&sheet));
        self.open.remove(&(garment, size));
        match picture {
            Ok(picture) => {
                let name = self.names.part(&format!("try-on-{garment}-{size}"));
                let label = format!("all try-ons of {garment}, size {size}, on one sheet");
                Ok(Some((RawLink { href: format!("pictures/{name}.jpg"), label }, picture)))
            }
            // No sheet holds thousands of runs; each run has its own pictures.
            Err(RenderError::Size { .. }) => Ok(None),
            Err(error) => Err(error).origin(Origin::Render),
        }
    }
}

#[cfg(test)]
mod tests {
    use image::RgbaImage;

    use super::*;

    #[test]
    fn a_sheet_of_many_runs_is_as_many_across_as_keep_it_square() {
        let check = |jobs: usize, columns: usize, size: [u32; 2]| {
            let sheet = Sheet::new(jobs);
            assert_eq!((sheet.left, sheet.columns, sheet.size), (jobs, columns, size));
            let empty = RgbaImage::new(size[0], size[1]);
            let cells: Vec<Cell> =
                (0..jobs * View::ALL.len()).map(|_| Cell { picture: empty.clone(), label: String::new() }).collect();
            render::contact_sheet("all", &cells, columns).expect("a sheet that fits");
        };
        check(1, 4, [480, 540]);
        check(10, 4, [480, 540]);
        check(12, 8, [480, 540]);
        check(50, 12, [287, 323]);
    }
}

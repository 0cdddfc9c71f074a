//! The fit report: recommended size, ease by level, balance and pressure. Another page compares the simulators.

use base64::Engine;
use sha2::{Digest, Sha256};

use super::ReportError;
use super::callouts::{Callout, overlay};
use super::data::{FitSheet, FitSize, FitVerdict, Outcome, Picture, ReportData, TryOn};
use super::images::{Image, MapImage, address};
use super::text::{count, simulator_name};
use super::viewer;
use fit::Simulator;

#[derive(askama::Template)]
#[template(path = "fit.html")]
pub(super) struct FitPage<'a> {
    data: &'a ReportData,
    /// Address of the page that compares the simulators.
    other: &'a str,
    sheets: Vec<Sheet<'a>>,
    drawings: Vec<(String, String)>,
    /// Data of the viewer as JSON; empty without drapes.
    drapes: String,
    script: &'static str,
    /// Hash of the script, by which the page's content security policy allows it.
    script_hash: String,
}

/// Names are those of the picture files.
const SIDES: [&str; 3] = ["front", "side", "back"];

struct Sheet<'a> {
    id: String,
    sheet: &'a FitSheet,
    /// One for each size that has a drape.
    columns: Vec<Column>,
    /// SVG of each chart.
    sections: Vec<String>,
    /// Source of the drape that is shown and measured, in words.
    source: String,
    called: Vec<Called>,
}

struct Called {
    image: Image,
    /// SVG.
    callouts: String,
}

/// Pictures of a size, all from one camera.
struct Column {
    size: String,
    is_to_wear: bool,
    fits: bool,
    words: String,
    views: Vec<Image>,
    maps: Vec<MapImage>,
}

impl<'a> FitPage<'a> {
    /// `other` is the address of the comparison.
    pub fn new(data: &'a ReportData, other: &'a str) -> Result<Self, ReportError> {
        let sheets = data.fit.sheets.iter().enumerate().map(|(number, sheet)| Sheet::new(number, sheet, data));
        let drawing = |drawing: &super::data::Drawing| {
            let name = format!("{}, size {}", drawing.garment, drawing.size);
            (name, address("image/svg+xml", drawing.svg.as_bytes()))
        };
        let drapes = if data.fit.drapes.is_empty() { String::new() } else { data.fit.drapes.json()? };
        let digest = Sha256::digest(viewer::SCRIPT.as_bytes());
        Ok(Self {
            data,
            other,
            sheets: sheets.collect::<Result<_, _>>()?,
            drawings: data.fit.points.iter().map(drawing).collect(),
            drapes,
            script: viewer::SCRIPT,
            script_hash: base64::engine::general_purpose::STANDARD.encode(digest),
        })
    }

    fn style(&self) -> &'static str {
        viewer::STYLE
    }

    fn fragment(&self) -> &'static str {
        viewer::FRAGMENT
    }
}

impl<'a> Sheet<'a> {
    fn new(number: usize, sheet: &'a FitSheet, data: &ReportData) -> Result<Self, ReportError> {
        let own = |run: &&TryOn| run.garment == sheet.garment && run.subject == sheet.subject && run.repeat == 1;
        let runs: Vec<&TryOn> =
            data.runs.iter().filter(own).filter(|run| !matches!(run.outcome, Outcome::Failed(_))).collect();
        let columns = sheet.sizes.iter().map(|size| {
            let run_of = |simulator: Simulator| {
                runs.iter().find(|run| run.size == size.size && run.simulator == simulator).copied()
            };
            let shown = sheet.simulator.and_then(run_of);
            let beside = run_of(Simulator::Hybrid).filter(|_| sheet.simulator == Some(Simulator::Fem));
            Column::new(size, shown, beside)
        });
        let columns = columns.collect::<Result<Vec<_>, _>>()?;
        let (columns, without): (Vec<Column>, Vec<Column>) =
            columns.into_iter().partition(|column| !column.views.is_empty());
        let without: Vec<String> = without.into_iter().map(|column| column.size).collect();
        let fabric = runs.first().map_or(String::new(), |run| format!(", {}", run.fabric.replace('_', " ")));
        let not_draped =
            if without.is_empty() { String::new() } else { format!("; not draped: {}", without.join(", ")) };
        let source = sheet.simulator.map_or("no drape yet".to_owned(), |simulator| {
            format!(
                "{} of {}{fabric}{not_draped}",
                count(runs.iter().filter(|run| run.simulator == simulator).count(), "drape"),
                simulator_name(simulator)
            )
        });
        let is_called = |run: &&&TryOn| run.size == sheet.called && Some(run.simulator) == sheet.simulator;
        Ok(Self {
            called: runs.iter().find(is_called).map_or(Ok(Vec::new()), |run| called(sheet, run))?,
            id: format!("fit-{}", number + 1),
            sheet,
            columns,
            sections: sheet.sections.iter().map(super::Chart::inline).collect(),
            source,
        })
    }
}

/// Pictures of a run from all sides, with the callouts of the comments that are seen there; none without a callout.
fn called(sheet: &FitSheet, run: &TryOn) -> Result<Vec<Called>, ReportError> {
    if sheet.comments.iter().all(|comment| comment.spot.is_none()) {
        return Ok(Vec::new());
    }
    let picture = |side: &str| {
        let shown = run.views.iter().find(|picture| picture.file.contains(&format!("{side}-plain")))?;
        let seen = sheet.comments.iter().filter(|comment| comment.side == side);
        let callouts: Vec<Callout> =
            seen.filter_map(|comment| Some(Callout { number: comment.number, at: comment.spot? })).collect();
        Some(Image::new(shown).map(|image| Called { image, callouts: overlay(&callouts) }))
    };
    SIDES.into_iter().filter_map(picture).collect()
}

impl Column {
    /// Selects front, side, back and stretch of the measured drape `shown`. A garment smaller than the body also gets
    /// the gap map of the Hybrid-GS drape `beside`, which shows where the garment does not close.
    fn new(size: &FitSize, shown: Option<&TryOn>, beside: Option<&TryOn>) -> Result<Self, ReportError> {
        let is = |picture: &&Picture, name: &str| picture.file.contains(name);
        let views = shown.into_iter().flat_map(|run| &run.views);
        let views =
            SIDES.into_iter().filter_map(|side| views.clone().find(|picture| is(picture, &format!("{side}-plain"))));
        let map = |run: Option<&'_ TryOn>, name: &str| {
            run.and_then(|run| run.maps.iter().find(|map| map.picture.file.contains(name))).map(MapImage::new)
        };
        let is_small = shown.and_then(|run| run.ease.as_ref()).is_some_and(fit::Ease::is_undersized);
        let gap_of = if is_small && beside.is_some() { beside } else { shown };
        let mut gap = map(gap_of, "front-gap").transpose()?;
        if let (Some(gap), true) = (&mut gap, is_small && beside.is_some()) {
            gap.image.caption = format!("{}: {}", simulator_name(Simulator::Hybrid), gap.image.caption);
        }
        let maps = map(shown, "front-stretch").into_iter().chain(gap.map(Ok));
        Ok(Self {
            size: size.size.clone(),
            is_to_wear: size.is_to_wear,
            fits: size.fits,
            words: size.words.clone(),
            views: views.map(Image::new).collect::<Result<_, _>>()?,
            maps: maps.collect::<Result<_, _>>()?,
        })
    }
}

impl FitVerdict {
    fn class(self) -> &'static str {
        match self {
            Self::Tight => "tight",
            Self::AsMeant => "just",
            Self::Loose => "loose",
        }
    }

    fn glyph(self) -> &'static str {
        match self {
            Self::Tight => "\u{25bc}",
            Self::AsMeant => "\u{25cf}",
            Self::Loose => "\u{25b2}",
        }
    }
}

//! `toile pattern features`, `convert` and `pom`: patterns in other formats.

use std::path::Path;

use super::args::BesideFiles;
use super::context::Context;
use super::{CliError, End, Outcome, output, xlsx};
use spec::patterns::Unit;
use wardrobe::seams::pattern_files::{self, Beside, Standard};
use wardrobe::seams::{Asking, specification};

pub fn beside(files: &BesideFiles) -> Beside<'_> {
    Beside {
        size: files.size.as_deref(),
        unit: files.unit.map(Unit::from),
        rules: files.rul.as_deref(),
        rule_unit: files.rul_unit.map(Unit::from),
        info: files.info.as_deref(),
    }
}

pub fn features(context: &Context, path: &Path, files: &BesideFiles, output: Option<&Path>) -> Outcome {
    output.map(|output| output::kind(output, &[("json", ())])).transpose()?;
    let (json, notes) = pattern_files::features(path, &beside(files))?;
    notes.iter().for_each(|note| context.say(note));
    let json = json + "\n";
    match output {
        Some(output) => context.write(output, json.into_bytes())?,
        None => output::text(&json)?,
    }
    Ok(End::Done)
}

#[derive(Clone, Copy)]
enum SheetFormat {
    Csv,
    Xlsx,
    Svg,
}

const SHEETS: [(&str, SheetFormat); 3] =
    [("csv", SheetFormat::Csv), ("xlsx", SheetFormat::Xlsx), ("svg", SheetFormat::Svg)];

pub fn points_of_measure(
    context: &Context,
    path: &Path,
    seams: Option<&Path>,
    how: &Asking<'_>,
    output: Option<&Path>,
) -> Outcome {
    let format = output.map(|file| output::kind(file, &SHEETS)).transpose()?;
    let specified = specification(path, seams, how)?;
    specified.notes.iter().for_each(|note| context.say(note));
    let Some((output, format)) = output.zip(format) else {
        match context.json {
            true => output::json(&specified)?,
            false => context.print(&specified.table())?,
        }
        return Ok(End::Done);
    };
    let bytes = match format {
        SheetFormat::Csv => specified.table().csv().into_bytes(),
        SheetFormat::Svg => specified.drawing.clone().into_bytes(),
        SheetFormat::Xlsx => xlsx::bytes(&[(&specified.garment, &specified.table())])?,
    };
    context.write(output, bytes)?;
    Ok(End::Done)
}

#[derive(Clone, Copy)]
enum PatternFormat {
    /// AAMA or ASTM DXF.
    Dxf,
    /// GarmentCode JSON.
    Json,
}

/// Formats of patterns by the endings of files; SVG is written by `toile pattern sheet`.
const PATTERNS: [(&str, PatternFormat); 2] = [("dxf", PatternFormat::Dxf), ("json", PatternFormat::Json)];

pub struct Written<'a> {
    /// Seam file, for formats that hold seams.
    pub seams: Option<&'a Path>,
    pub standard: Standard,
    /// True to write the sample size and a grade rule table.
    pub with_rul: bool,
}

/// Format is that of the output's ending.
pub fn convert(
    context: &Context,
    path: &Path,
    files: &BesideFiles,
    Written { seams, standard, with_rul }: &Written<'_>,
    output: &Path,
) -> Outcome {
    let (bytes, notes) = match output::kind(output, &PATTERNS)? {
        PatternFormat::Dxf if *with_rul => {
            let table = output.with_extension("rul");
            let name = table.file_stem().unwrap_or_default().to_string_lossy();
            let graded = pattern_files::convert_to_graded(path, &beside(files), *standard, &name)?;
            context.write(&table, graded.rules.into_bytes())?;
            (graded.dxf, graded.notes)
        }
        PatternFormat::Dxf => pattern_files::convert_to_dxf(path, &beside(files), *standard)?,
        PatternFormat::Json if *with_rul => {
            let found = format!("{}: --with-rul writes a DXF file; accepted: X.dxf", output.display());
            return Err(CliError::Usage(found));
        }
        PatternFormat::Json => {
            let (json, notes) = pattern_files::convert_to_garmentcode(path, *seams, &beside(files))?;
            ((json + "\n").into_bytes(), notes)
        }
    };
    notes.iter().for_each(|note| context.say(note));
    context.write(output, bytes)?;
    Ok(End::Done)
}

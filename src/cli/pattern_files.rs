//! `toile pattern features`, `convert` and `pom`: patterns as other kinds of file.

use std::path::Path;

use super::args::{BesideFiles, Format};
use super::context::Context;
use super::{CliError, End, Outcome, output, xlsx};
use study::files;
use study::patterns::Unit;
use study::seams::pattern_files::{self, Beside, Standard};
use study::seams::{Asking, specification};

/// What the arguments say about a pattern beside its file.
pub fn beside(files: &BesideFiles) -> Beside<'_> {
    Beside {
        size: files.size.as_deref(),
        unit: files.unit.map(Unit::from),
        rules: files.rul.as_deref(),
        info: files.info.as_deref(),
    }
}

/// Writes the features of a pattern's pieces, or prints them.
pub fn features(context: &Context, path: &Path, files: &BesideFiles, output: Option<&Path>) -> Outcome {
    let json = pattern_files::features(path, &beside(files))? + "\n";
    match output {
        Some(output) => write(context, output, json.into_bytes())?,
        None => output::text(&json)?,
    }
    Ok(End::Done)
}

/// Prints the points of measure of a pattern, or writes them as a sheet.
pub fn points_of_measure(
    context: &Context,
    path: &Path,
    seams: Option<&Path>,
    how: &Asking<'_>,
    output: Option<&Path>,
) -> Outcome {
    let specified = specification(path, seams, how)?;
    specified.notes.iter().for_each(|note| context.say(note));
    let Some(output) = output else {
        match context.json {
            true => output::json(&specified)?,
            false => context.print(&specified.table())?,
        }
        return Ok(End::Done);
    };
    let extension = output.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    let bytes = match extension.as_str() {
        "csv" => output::encoded(&specified.table(), Format::Csv)?,
        "svg" => specified.drawing.clone().into_bytes(),
        "xlsx" => xlsx::bytes(&[(&specified.garment, &specified.table())])?,
        _ => {
            let found = format!("{}: found `.{extension}`; accepted: X.csv, X.xlsx or X.svg", output.display());
            return Err(CliError::Usage(found));
        }
    };
    write(context, output, bytes)?;
    Ok(End::Done)
}

/// How a pattern is written.
pub struct Written<'a> {
    /// Seam file, for a kind of file that holds seams.
    pub seams: Option<&'a Path>,
    /// Standard of a DXF file.
    pub standard: Standard,
    /// Whether the sample size is written alone, with a grade rule table beside it.
    pub with_rul: bool,
}

/// Writes a pattern as the kind of file that the output's name says.
pub fn convert(
    context: &Context,
    path: &Path,
    files: &BesideFiles,
    Written { seams, standard, with_rul }: &Written<'_>,
    output: &Path,
) -> Outcome {
    let extension = output.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    let bytes = match extension.as_str() {
        "dxf" if *with_rul => {
            let table = output.with_extension("rul");
            let name = table.file_stem().unwrap_or_default().to_string_lossy();
            let graded = pattern_files::convert_to_graded(path, &beside(files), *standard, &name)?;
            graded.notes.iter().for_each(|note| context.say(note));
            write(context, &table, graded.rules.into_bytes())?;
            graded.dxf
        }
        "dxf" => pattern_files::convert_to_dxf(path, &beside(files), *standard)?,
        "json" => (pattern_files::convert_to_garmentcode(path, *seams, &beside(files))? + "\n").into_bytes(),
        _ => {
            let accepted = "X.dxf (AAMA or ASTM DXF) or X.json (GarmentCode); SVG is written by `toile pattern sheet`";
            return Err(CliError::Usage(format!("{}: found `.{extension}`; accepted: {accepted}", output.display())));
        }
    };
    write(context, output, bytes)?;
    Ok(End::Done)
}

fn write(context: &Context, output: &Path, bytes: Vec<u8>) -> Result<(), CliError> {
    let folder = output.parent().unwrap_or(Path::new(""));
    let name = output.file_name().unwrap_or_default().to_string_lossy().into_owned();
    files::write_files(folder, &[(name, bytes)])?;
    context.say(format_args!("wrote {}", output.display()));
    Ok(())
}

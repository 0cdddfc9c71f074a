//! `toile pattern spec` and `toile style spec`: specification sheets of buyers, in and out.

use std::path::Path;

use super::args::{PatternSpec, StyleSpec};
use super::context::Context;
use super::{End, Outcome, output, spec_workbook};
use spec::patterns::Unit;
use wardrobe::catalogue::{self, SpecGiven};
use wardrobe::seams::{SpecReport, spec_report};

#[derive(Clone, Copy)]
enum SheetFormat {
    Csv,
    Xlsx,
}

const SHEETS: [(&str, SheetFormat); 2] = [("csv", SheetFormat::Csv), ("xlsx", SheetFormat::Xlsx)];

pub fn of_pattern(context: &Context, arguments: &PatternSpec) -> Outcome {
    let PatternSpec { path, sheet, seams, cut, flags, output } = arguments;
    let format = format_of(output.as_deref())?;
    let how = cut.asking(&[]);
    let report = spec_report(path, seams.as_deref(), &how, sheet, flags.asked(), &flags.answers)?;
    show(context, &report, output.as_deref().zip(format))
}

/// Keeps the sheet of a style if one is given, and shows it beside the pattern.
pub fn of_style(context: &Context, arguments: &StyleSpec) -> Outcome {
    let StyleSpec { name, sheet, flags, subject, output } = arguments;
    let format = format_of(output.as_deref())?;
    let mut store = context.store()?;
    let given = SpecGiven {
        file: sheet.clone(),
        sheet: flags.tab.clone(),
        unit: flags.sheet_unit.map(Unit::from),
        answers: flags.answers.clone(),
    };
    let kept = if given == SpecGiven::default() { None } else { Some(catalogue::keep_spec(&mut store, name, &given)?) };
    let mut report = catalogue::spec(&mut store, name, subject.as_deref())?;
    report.notes.splice(0..0, kept.into_iter().flat_map(|kept| kept.notes));
    show(context, &report, output.as_deref().zip(format))
}

fn format_of(output: Option<&Path>) -> Result<Option<SheetFormat>, super::CliError> {
    output.map(|file| output::kind(file, &SHEETS)).transpose()
}

/// Prints a specification or writes it, with questions and remarks on standard error. Exit code 3 if a length is out of
/// tolerance.
fn show(context: &Context, report: &SpecReport, file: Option<(&Path, SheetFormat)>) -> Outcome {
    match file {
        Some((path, SheetFormat::Csv)) => context.write(path, report.table().csv().into_bytes())?,
        Some((path, SheetFormat::Xlsx)) => context.write(path, spec_workbook::bytes(report)?)?,
        None if context.json => output::json(report)?,
        None => context.print(&report.overview())?,
    }
    report.notes.iter().for_each(|note| context.say(note));
    for row in &report.asked {
        let candidates: Vec<String> =
            row.candidates.iter().map(|point| format!("--match {}={point}", row.code)).collect();
        let answers =
            candidates.into_iter().chain([format!("--match {}=none", row.code)]).collect::<Vec<_>>().join(", ");
        context.say(format_args!("{}, {}: {}: {answers}", row.code, row.description, row.why));
    }
    context.say(report.summary());
    Ok(if report.is_out() { End::CheckFailed } else { End::Done })
}

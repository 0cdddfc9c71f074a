//! `toile pattern`: commands that need only a pattern.

use std::collections::BTreeSet;
use std::path::Path;

use super::args::{DraftStyle, Pattern, SeamCommand, StyleFiles};
use super::context::Context;
use super::{CliError, End, Outcome, output, pattern_files, questions, sew, spec_sheet};
use geom::units::{from_mm, mm};
use spec::patterns::{self, FileReport, Finding, Model, Unit};
use store::{Table, Value, files};
use wardrobe::seams::pattern_files::inspect as inspect_files;
use wardrobe::seams::{self, CHECK_EDGE_MM, SizeCheck};

pub fn run(context: &Context, command: &Pattern) -> Outcome {
    match command {
        Pattern::Inspect { path, files, by_file } => {
            let reports = inspect_files(path, &pattern_files::beside(files))?;
            inspect(context, &reports, if *by_file { outcomes } else { pieces })
        }
        Pattern::Propose { path, cut, answer, ask, output } => {
            output.as_deref().map(|file| output::kind(file, &[("toml", ())])).transpose()?;
            let proposed =
                |answers: &[(usize, char)]| seams::propose(path, &cut.asking(answers)).map_err(CliError::from);
            let proposed = if *ask { questions::ask(answer.clone(), proposed)? } else { proposed(answer)? };
            propose(context, path, &proposed, output.as_deref())
        }
        Pattern::Check(files) => check(context, files),
        Pattern::Seam(edit) => seam(context, edit),
        Pattern::Sew(files) => sew::run(context, files),
        Pattern::Draft { style, output } => {
            output::folder(output, &["dxf", "toml"])?;
            for path in files::write_files(output, &patterns::drafted(model(*style)))? {
                output::text(&format!("{}\n", path.display()))?;
            }
            Ok(End::Done)
        }
        Pattern::Mesh { files, edge_length_mm } => mesh(context, files, *edge_length_mm),
        Pattern::Sheet { files, output } => {
            output::kind(output, &[("svg", ())])?;
            context.write(output, patterns::sheet(&style(files)?).into_bytes())?;
            Ok(End::Done)
        }
        Pattern::Pom { path, seams, cut, output } => {
            pattern_files::points_of_measure(context, path, seams.as_deref(), &cut.asking(&[]), output.as_deref())
        }
        Pattern::Spec(arguments) => spec_sheet::of_pattern(context, arguments),
        Pattern::Features { path, files, output } => pattern_files::features(context, path, files, output.as_deref()),
        Pattern::Convert { path, files, seams, standard, with_rul, output } => {
            let standard = (*standard).into();
            let kind = pattern_files::Written { seams: seams.as_deref(), standard, with_rul: *with_rul };
            pattern_files::convert(context, path, files, &kind, output)
        }
    }
}

pub fn model(style: DraftStyle) -> Model {
    match style {
        DraftStyle::Tshirt => Model::Tshirt,
        DraftStyle::Trousers => Model::Trousers,
        DraftStyle::Teetop => Model::Teetop,
        DraftStyle::Dress => Model::Dress,
    }
}

/// Prints a proposal, and writes it as a seam file if `output` is given. Questions go to standard error.
fn propose(context: &Context, path: &Path, proposed: &seams::Proposed, output: Option<&Path>) -> Outcome {
    let proposal = &proposed.proposal;
    if context.json {
        output::json(proposed)?;
    } else {
        context.print(&seams(proposal))?;
    }
    for note in &proposal.notes {
        context.say(note);
    }
    for question in &proposal.questions {
        context.say(format_args!("{}: {}. {question}", path.display(), question.number));
    }
    if let Some(output) = output {
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        context.write(output, proposal.toml(&name).into_bytes())?;
    }
    Ok(if proposal.seams.is_empty() { End::CheckFailed } else { End::Done })
}

fn seam(context: &Context, command: &SeamCommand) -> Outcome {
    let (home, step) = command.clone().step();
    let unit = home.unit.map(Unit::from);
    let file = seams::edit_seams(&home.pattern, &home.seams, home.size.as_deref(), unit, &step)?;
    context.write(&home.seams, String::from_utf8_lossy(&file.bytes).into_owned().into_bytes())?;
    Ok(End::Done)
}

fn seams(proposal: &seams::Proposal) -> Table {
    let columns = ["seam", "a", "b", "a_mm", "b_mm", "ratio", "confidence"];
    let round = |value: f64, per: f64| Value::Real((value * per).round() / per);
    let rows = proposal.seams.iter().map(|seam| {
        vec![
            Value::Text(seam.entry.name.clone()),
            Value::Text(seam.entry.a.join(" ")),
            Value::Text(seam.entry.b.join(" ")),
            round(seam.a_mm, 10.0),
            round(seam.b_mm, 10.0),
            round(seam.ratio(), 1000.0),
            round(seam.confidence, 100.0),
        ]
    });
    Table::new(columns, rows)
}

fn style(files: &StyleFiles) -> Result<patterns::Style, CliError> {
    Ok(patterns::style(&files.file, files.seams.as_deref(), files.size.as_deref(), files.unit.map(Unit::from))?)
}

/// Prints reports as JSON or as a table. A file that cannot be read, or a piece that is refused, gives the exit code of
/// unusable input.
fn inspect(context: &Context, reports: &[FileReport], table: fn(&[FileReport]) -> Table) -> Outcome {
    if context.json {
        let written: Vec<FileReport> = reports.iter().cloned().map(FileReport::as_written).collect();
        output::json(&written)?;
    } else {
        context.print(&table(reports))?;
    }
    for report in reports {
        for warning in &report.warnings {
            context.say(format_args!("{}: {warning}", report.file));
        }
        for refused in &report.refused {
            let line = refused.line.map(|line| format!(", line {line}")).unwrap_or_default();
            output::note(&format!("{}{line}, block `{}`: found {}", report.file, refused.block, refused.reason));
        }
        if let Some(error) = &report.error {
            output::note(error);
        }
    }
    let unusable = reports.iter().any(|report| report.error.is_some() || !report.refused.is_empty());
    Ok(if unusable || reports.is_empty() { End::Unusable } else { End::Done })
}

fn pieces(reports: &[FileReport]) -> Table {
    let columns = ["file", "block", "name", "size", "quantity", "perimeter_mm", "area_cm2", "notches", "grain_mm"];
    let text = |text: &str| Value::Text(text.to_owned());
    let maybe = |value: Option<Value>| value.unwrap_or(Value::Null);
    let rows = reports.iter().flat_map(|report| {
        report.pieces.iter().map(move |piece| {
            vec![
                text(&report.file),
                text(&piece.block),
                text(&piece.name),
                maybe(piece.size.as_deref().map(text)),
                maybe(piece.quantity.as_deref().map(text)),
                output::tenths(piece.perimeter_mm),
                Value::Real((piece.area_mm2 / 10.0).round() / 10.0),
                Value::Integer(piece.notches as i64),
                maybe(piece.grain_mm.map(output::tenths)),
            ]
        })
    });
    Table::new(columns, rows)
}

fn outcomes(reports: &[FileReport]) -> Table {
    let columns = ["file", "format", "unit", "pieces", "sizes", "half pieces", "refused", "outcome"];
    let row = |report: &FileReport| {
        let sizes: BTreeSet<&str> = report.pieces.iter().filter_map(|piece| piece.size.as_deref()).collect();
        let file = Path::new(&report.file).file_name().unwrap_or_default().to_string_lossy().into_owned();
        let reasons = report.refused.iter().map(|refused| format!("{}: {}", refused.block, refused.reason));
        let outcome = match &report.error {
            Some(error) => error.clone(),
            None if report.refused.is_empty() => "read".to_owned(),
            None => reasons.collect::<Vec<_>>().join("; "),
        };
        let count = |number: usize| Value::Integer(number as i64);
        vec![
            Value::Text(file),
            Value::Text(report.format.clone()),
            Value::Text(report.units.clone()),
            count(report.pieces.len()),
            count(sizes.len()),
            count(report.pieces.iter().filter(|piece| piece.unfolded).count()),
            count(report.refused.len()),
            Value::Text(outcome),
        ]
    };
    Table::new(columns, reports.iter().map(row))
}

/// Checks a pattern with its seam file, by making everything that a simulation needs from it.
fn check(context: &Context, files: &StyleFiles) -> Outcome {
    let is_study = |path: &Path| path.extension().is_some_and(|e| e == "toml") || path.join("study.toml").is_file();
    if is_study(&files.file) {
        return check_study(context, &files.file);
    }
    if files.size.is_none() {
        let checks = seams::check_sizes(&files.file, files.seams.as_deref(), files.unit.map(Unit::from))?;
        if checks.len() > 1 {
            return show_sizes(context, &checks);
        }
    }
    let checked = style(files).and_then(|style| Ok((patterns::mesh(&style, from_mm(CHECK_EDGE_MM))?, style)));
    let ((garment, quality), style) = match checked {
        Ok(checked) => checked,
        Err(CliError::Study(error @ store::StudyError::Refusal { .. })) => {
            output::tell(&error);
            return Ok(End::CheckFailed);
        }
        Err(error) => return Err(error),
    };
    let columns = ["#", "measurement", "l2d_mm", "free edge"];
    let rows = style.measurements.iter().map(|m| {
        let length = Value::Real((mm(m.l2d_m) * 100.0).round() / 100.0);
        let free = if m.is_free_edge { "yes" } else { "" };
        vec![Value::Integer(i64::from(m.no)), Value::Text(m.name.clone()), length, Value::Text(free.to_owned())]
    });
    context.print(&Table::new(columns, rows))?;
    let mut findings = patterns::garment_findings(&style, &garment);
    if let Some(seams) = &files.seams {
        findings.extend(seams::findings(&files.file, seams, files.size.as_deref(), files.unit.map(Unit::from))?);
    }
    findings.iter().for_each(|finding| output::note(&told(finding)));
    context.say(format_args!(
        "{}: {} pieces, {} seams, {} measurements; at {CHECK_EDGE_MM} mm {} vertices, least angle {:.0} degrees",
        files.file.display(),
        garment.pieces.len(),
        garment.seams.len(),
        garment.measurements.len(),
        garment.rest.len(),
        quality.min_angle_deg
    ));
    Ok(if findings.is_empty() { End::Done } else { End::CheckFailed })
}

fn told(finding: &Finding) -> String {
    format!("{}: `{}`: {}", finding.kind.as_str(), finding.place, finding.found)
}

fn check_study(context: &Context, path: &Path) -> Outcome {
    if context.db.exists() && !context.readonly {
        // A study names entries of the catalogue, so opening the store migrates an older database first.
        context.store()?;
    }
    show_sizes(context, &seams::check_study(path, &context.db)?)
}

/// Prints a row for each size. A finding on any size makes the check fail.
fn show_sizes(context: &Context, checks: &[SizeCheck]) -> Outcome {
    if context.json {
        output::json(&checks)?;
    } else {
        context.print(&sizes(checks))?;
    }
    for check in checks {
        let whole = check.error.iter().cloned();
        for line in whole.chain(check.findings.iter().map(told)) {
            output::note(&format!("{} {}: {line}", check.garment, check.size));
        }
    }
    Ok(if checks.iter().any(SizeCheck::is_bad) { End::CheckFailed } else { End::Done })
}

fn sizes(checks: &[SizeCheck]) -> Table {
    let columns =
        ["garment", "size", "pieces", "seams", "measurements", "fit_mm", "vertices", "least_angle_deg", "findings"];
    let row = |check: &SizeCheck| {
        let count = |number: usize| Value::Integer(number as i64);
        let levels = check.fit_mm.iter().map(|(level, girth_mm)| format!("{level} {girth_mm:.1}"));
        vec![
            Value::Text(check.garment.clone()),
            Value::Text(check.size.clone()),
            count(check.pieces),
            count(check.seams),
            count(check.measurements),
            Value::Text(levels.collect::<Vec<_>>().join(", ")),
            count(check.vertices),
            output::tenths(check.min_angle_deg),
            count(check.findings.len() + usize::from(check.error.is_some())),
        ]
    };
    Table::new(columns, checks.iter().map(row))
}

fn mesh(context: &Context, files: &StyleFiles, edge_length_mm: f64) -> Outcome {
    let (garment, quality) = patterns::mesh(&style(files)?, from_mm(edge_length_mm))?;
    let numbers = [
        ("vertices", Value::Integer(garment.rest.len() as i64)),
        ("triangles", Value::Integer(garment.triangles.len() as i64)),
        ("seam_pairs", Value::Integer(garment.seams.iter().map(|seam| seam.pairs.len() as i64).sum())),
        ("min_angle_deg", Value::Real(quality.min_angle_deg)),
        ("min_edge_mm", Value::Real(mm(quality.min_edge_m))),
        ("mean_edge_mm", Value::Real(mm(quality.mean_edge_m))),
        ("max_edge_mm", Value::Real(mm(quality.max_edge_m))),
    ];
    let (columns, row) = numbers.into_iter().map(|(name, value)| (name.to_owned(), value)).unzip();
    context.print(&Table { columns, rows: vec![row] })?;
    Ok(End::Done)
}

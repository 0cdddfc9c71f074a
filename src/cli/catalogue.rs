//! `toile subject|style|size|fabric`: lists the catalogue and changes it.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::args::{Catalogue, FabricValues, PatternUnit, PersonValues, SizeValues, StyleCommand, StyleValues};
use super::context::Context;
use super::{CliError, End, Outcome, body, output, spec_sheet};
use spec::Given;
use store::{Store, StudyError, Table, Value, sql};
use wardrobe::{Imported, Mode, Part, Saved, ScanGiven, SizeRow, Strictness, StyleGiven, catalogue};

/// Values of one part of the catalogue on the command line.
pub trait Values: Args {
    const PART: Part;

    fn save(&self, store: &mut Store, mode: Mode, name: &str) -> Result<Vec<Saved>, CliError>;
}

impl Values for PersonValues {
    const PART: Part = Part::Subject;

    fn save(&self, store: &mut Store, mode: Mode, name: &str) -> Result<Vec<Saved>, CliError> {
        let given = &self.values.0;
        let Some(file) = &self.scan else { return Ok(vec![catalogue::save_subject(store, mode, name, given)?]) };
        let is_number = |(key, _): &&Given| key != "sex";
        body::refuse_beside_scan(given.iter().find(is_number))?;
        let sex = given.first().map(|(_, word)| spec::sex(word)).transpose().map_err(CliError::Usage)?;
        let scan = ScanGiven { file: file.clone(), unit: self.unit.map(Into::into), sex };
        Ok(vec![catalogue::save_scan(store, mode, name, &scan)?])
    }
}

impl Values for FabricValues {
    const PART: Part = Part::Fabric;

    fn save(&self, store: &mut Store, mode: Mode, name: &str) -> Result<Vec<Saved>, CliError> {
        Ok(vec![catalogue::save_fabric(store, mode, name, self.like.as_deref(), &self.given)?])
    }
}

impl Values for StyleValues {
    const PART: Part = Part::Style;

    fn save(&self, store: &mut Store, mode: Mode, name: &str) -> Result<Vec<Saved>, CliError> {
        let given = StyleGiven {
            seams: self.seams.clone(),
            is_proposed: self.propose,
            unit: self.unit.and_then(unit_name),
            patterns: self.patterns.iter().map(|text| pattern_of(text)).collect(),
        };
        Ok(catalogue::save_style(store, mode, name, &given)?)
    }
}

impl Values for SizeValues {
    const PART: Part = Part::Size;

    fn save(&self, store: &mut Store, mode: Mode, name: &str) -> Result<Vec<Saved>, CliError> {
        let given = StyleGiven {
            seams: None,
            is_proposed: false,
            unit: self.unit.and_then(unit_name),
            patterns: self.pattern.iter().map(|path| (None, path.clone())).collect(),
        };
        Ok(vec![catalogue::save_size(store, mode, name, &given)?])
    }
}

/// Parses a pattern argument, `[SIZE=]FILE`.
pub fn pattern_of(text: &str) -> (Option<String>, PathBuf) {
    match text.split_once('=') {
        Some((size, file)) => (Some(size.to_owned()), PathBuf::from(file)),
        None => (None, PathBuf::from(text)),
    }
}

pub fn unit_name(unit: PatternUnit) -> Option<String> {
    unit.to_possible_value().map(|value| value.get_name().to_owned())
}

/// View of a part, and its columns that name an entry.
fn view(part: Part) -> (&'static str, &'static str) {
    match part {
        Part::Subject => ("v_subjects", "subject"),
        Part::Style => ("v_styles", "style"),
        Part::Size => ("v_sizes", "style || '/' || size"),
        Part::Fabric => ("v_fabrics", "fabric"),
    }
}

const HIDDEN: [&str; 8] = [
    "hash",
    "is_latest",
    "is_retired",
    "source",
    "entry",
    "of_another",
    "class_length_warp_mm",
    "class_length_weft_mm",
];

pub fn run<V: Values>(context: &Context, command: Catalogue<V>) -> Outcome {
    match command {
        Catalogue::Ls { all } => list(context, V::PART, all)?,
        Catalogue::Show { name } => show(context, V::PART, &name)?,
        Catalogue::Add { name, values } => say(context, &values.save(&mut context.store()?, Mode::Add, &name)?),
        Catalogue::Edit { name, values } => say(context, &values.save(&mut context.store()?, Mode::Edit, &name)?),
        Catalogue::Import { good_rows, files } => return import(context, V::PART, &files, good_rows),
        Catalogue::Rm { names } => {
            let mut store = context.store()?;
            for name in &names {
                context.say(catalogue::remove(&mut store, V::PART, name)?);
            }
        }
    }
    Ok(End::Done)
}

/// Imports files. With `good_rows`, prints the problems of the other rows.
fn import(context: &Context, part: Part, files: &[PathBuf], good_rows: bool) -> Outcome {
    let strictness = if good_rows { Strictness::GoodRows } else { Strictness::AllOrNone };
    let Imported { saved, left_out } = catalogue::import(&mut context.store()?, part, files, strictness)?;
    say(context, &saved);
    for problem in &left_out {
        output::tell(&format!("left out: {problem}"));
    }
    Ok(if left_out.is_empty() { End::Done } else { End::CheckFailed })
}

pub fn style(context: &Context, command: StyleCommand) -> Outcome {
    let (name, step) = match command {
        StyleCommand::Of(command) => return run(context, command),
        StyleCommand::Sew { name, step } => (name, step),
        StyleCommand::Spec(arguments) => return spec_sheet::of_style(context, &arguments),
    };
    let mut store = context.store()?;
    let (style, size) = name.split_once('/').map_or((name.as_str(), None), |(style, size)| (style, Some(size)));
    let sizes = catalogue::sizes(&store)?;
    let is_asked = |row: &&SizeRow| row.style == style && size.is_none_or(|size| row.size == size);
    let Some(row) = sizes.iter().find(is_asked) else {
        let known = sizes.iter().map(|row| format!("{}/{}", row.style, row.size)).collect();
        return Err(StudyError::NotFound { what: "size", name, known }.into());
    };
    let seams = catalogue::workpiece(&store, row.key)?.after(&step.step(style))?;
    say(context, &catalogue::save_seams(&mut store, style, &seams)?);
    Ok(End::Done)
}

pub fn say(context: &Context, saved: &[Saved]) {
    for entry in saved {
        entry.notes.iter().for_each(|note| context.say(format_args!("{} {}: {note}", entry.part, entry.name)));
        context.say(entry);
        for doubt in &entry.doubts {
            context.say(format_args!("{} {}: {doubt}", entry.part, entry.name));
        }
    }
}

fn list(context: &Context, part: Part, all: bool) -> Result<(), CliError> {
    let (view, key) = view(part);
    let shown = if all { "" } else { "AND NOT is_retired" };
    let sql = format!("SELECT *, {key} AS entry FROM {view} WHERE is_latest {shown} ORDER BY entry");
    let entries = described(part, sql::query(&context.store()?, &sql)?);
    if context.json {
        return context.print(&entries);
    }
    let entries = without(entries, &HIDDEN);
    let (entries, left_out) = match output::terminal_width() {
        Some(width) => output::fitting(entries, width),
        None => (entries, 0),
    };
    context.print(&entries)?;
    if left_out > 0 {
        context.say(format_args!("{left_out} more columns do not fit: `toile {part} show NAME` and --json have them"));
    }
    Ok(())
}

fn show(context: &Context, part: Part, name: &str) -> Result<(), CliError> {
    let (view, key) = view(part);
    let all = sql::query(&context.store()?, &format!("SELECT *, {key} AS entry FROM {view} ORDER BY entry, revision"))?;
    let entry = all.columns.len() - 1;
    let of_name = |row: &&Vec<Value>| row[entry] == Value::Text(name.to_owned());
    let rows: Vec<_> = all.rows.iter().filter(of_name).cloned().collect();
    if rows.is_empty() {
        let mut known: Vec<String> = all.rows.iter().map(|row| row[entry].to_string()).collect();
        known.dedup();
        return Err(StudyError::NotFound { what: part.as_str(), name: name.to_owned(), known }.into());
    }
    let found = described(part, Table { columns: all.columns, rows });
    context.print(&if context.json { found } else { sideways(&without(found, &["entry"])) })
}

/// Adds the columns that are computed from the numbers of entries.
fn described(part: Part, entries: Table) -> Table {
    if part == Part::Fabric { wardrobe::with_bending(entries) } else { entries }
}

fn without(table: Table, hidden: &[&str]) -> Table {
    let kept: Vec<usize> = (0..table.columns.len()).filter(|&k| !hidden.contains(&table.columns[k].as_str())).collect();
    let pick = |row: &Vec<Value>| kept.iter().map(|&k| row[k].clone()).collect();
    Table {
        columns: kept.iter().map(|&k| table.columns[k].clone()).collect(),
        rows: table.rows.iter().map(pick).collect(),
    }
}

/// Turns a table: a column for each revision, a row for each property.
fn sideways(table: &Table) -> Table {
    let mut columns = vec!["property".to_owned()];
    columns.extend((1..=table.rows.len()).map(|n| format!("revision {n}")));
    let row = |(k, name): (usize, &String)| {
        let values = table.rows.iter().map(|row| row[k].clone());
        std::iter::once(Value::Text(name.clone())).chain(values).collect()
    };
    Table { columns, rows: table.columns.iter().enumerate().map(row).collect() }
}

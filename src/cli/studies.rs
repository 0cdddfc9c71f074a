//! `toile study`: makes, checks and exports study files, and finds representatives of populations.

use std::path::{Path, PathBuf};

use super::args::{PatternUnit, Sex, StudyCommand, SubjectValues};
use super::catalogue::{pattern_of, say, unit_name};
use super::context::{Context, project_folder};
use super::pattern::model;
use super::{CliError, End, Outcome, body, output};
use advice::{PopulationOptions, population, representatives, subjects_text};
use engine::{NewStudy, Wearable, compose, wearables};
use results::size_map;
use spec::{export_study, new_study};
use store::files::{self, SourceFile};
use store::{SizeKey, Store, StudyError, sql};
use wardrobe::{Mode, StyleGiven, catalogue};

pub fn run(context: &Context, command: &StudyCommand) -> Outcome {
    match command {
        StudyCommand::New {
            folder,
            wear,
            outfit,
            subject,
            patterns,
            style_name,
            seams,
            unit,
            fabric,
            sim,
            fit,
            ..
        } if !subject.is_empty() => {
            let mut store = context.store()?;
            let folder = new_folder(folder);
            let own = own_style(context, &mut store, patterns, style_name.as_ref(), seams.as_ref(), *unit)?;
            let known = wearables(&catalogue::sizes(&store)?);
            let named = |wearable: &Wearable| format!("{}/{}", wearable.style, wearable.size);
            let find = |name: &String| {
                known.iter().find(|wearable| named(wearable) == *name).cloned().ok_or_else(|| StudyError::NotFound {
                    what: "size",
                    name: name.clone(),
                    known: known.iter().map(named).collect(),
                })
            };
            let own = known.iter().filter(|wearable| own.as_ref() == Some(&wearable.style)).cloned().map(Ok);
            let new = NewStudy {
                name: folder.file_name().unwrap_or_default().to_string_lossy().into_owned(),
                folder: folder.parent().unwrap_or(Path::new("")).to_owned(),
                subjects: subject.clone(),
                sizes: wear.iter().map(find).chain(own).collect::<Result<_, _>>()?,
                fabric: fabric.clone(),
                simulators: sim.iter().map(|&sim| sim.into()).collect(),
                fit: fit.map(Into::into),
                outfits: outfit.clone(),
            };
            let path = compose::create_study(&mut store, &new)?;
            context.say(format_args!("wrote {}; `{}` runs it", path.display(), run_command(&folder)));
        }
        StudyCommand::New { folder, style, fit, .. } => {
            let folder = new_folder(folder);
            context.write_files(&folder, &new_study(&folder, model(*style), fit.map(Into::into))?)?;
            context.say(format_args!("`{}` runs it", run_command(&folder)));
        }
        StudyCommand::Check(arguments) => {
            let study = context.study(&context.store()?, &arguments.study)?;
            let jobs = study.jobs();
            let count = |n: usize, what: &str| format!("{n} {what}{}", if n == 1 { "" } else { "s" });
            context.say(format_args!(
                "{} is in order: {}, {}, {}",
                study.path.display(),
                count(study.subjects.len(), "subject"),
                count(study.garments.len(), "garment"),
                count(jobs, "simulation"),
            ));
        }
        StudyCommand::Population { bodies, sex, people, seed } => {
            let (bodies, people) = (*bodies as usize, *people as usize);
            let options = PopulationOptions { bodies: bodies.min(people), people, seed: *seed };
            for sex in sex.map_or(vec![Sex::F, Sex::M], |sex| vec![sex]) {
                output::text(&subjects_text(&representatives(body::sex_of(sex), &options)))?;
            }
        }
        StudyCommand::Sizes { study, output } => {
            output::kind(output, &[("svg", ())])?;
            let store = context.store()?;
            let svg = size_map::size_map(&store, &context.study_name(&store, study)?)?;
            context.write(output, svg.into_bytes())?;
        }
        StudyCommand::Nearest { study, subject } => return nearest(context, study, subject),
        StudyCommand::Export { study, output } => {
            output::folder(output, &["toml"])?;
            let study = context.study(&context.store()?, study)?;
            context.write_files(output, &export_study(&study))?;
        }
    }
    Ok(End::Done)
}

/// Folder of a new study: of a bare name, that in the folder of the project's studies, where the workbench makes its own.
fn new_folder(given: &Path) -> PathBuf {
    let is_bare = given.components().count() == 1 && given.is_relative() && !given.exists();
    let project = project_folder().filter(|_| is_bare);
    project.map_or_else(|| given.to_owned(), |project| project.join("studies").join(given))
}

/// Command that runs the study of a folder, as it can be typed here.
fn run_command(folder: &Path) -> String {
    let here = std::env::current_dir().ok();
    let inside = here.as_deref().and_then(|here| folder.strip_prefix(here).ok());
    format!("toile run {}", files::word(&inside.unwrap_or(folder).to_string_lossy()))
}

/// Adds the user's patterns to the catalogue as a style, named after the first pattern unless `named`. A style of this
/// name that was made of the same files is taken as it is. Returns the style's name, and prints the number of open
/// questions.
fn own_style(
    context: &Context,
    store: &mut Store,
    patterns: &[String],
    named: Option<&String>,
    seams: Option<&PathBuf>,
    unit: Option<PatternUnit>,
) -> Result<Option<String>, CliError> {
    let Some(first) = patterns.first() else { return Ok(None) };
    let (_, file) = pattern_of(first);
    let of_file = || file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let name = named.cloned().unwrap_or_else(of_file);
    let known: Vec<SizeKey> =
        catalogue::sizes(store)?.iter().filter(|row| row.style == name).map(|row| row.key).collect();
    if !known.is_empty() {
        if !is_of(store, &known, patterns, seams)? {
            let text =
                format!("there is a style `{name}` already, of other files; --as NAME gives this one another name");
            return Err(CliError::Usage(text));
        }
        context.say(format_args!("style {name} is in the catalogue already, of the same files: it is taken as it is"));
        return Ok(Some(name));
    }
    let given = StyleGiven {
        seams: seams.cloned(),
        is_proposed: seams.is_none(),
        unit: unit.and_then(unit_name),
        patterns: patterns.iter().map(|text| pattern_of(text)).collect(),
    };
    say(context, &catalogue::save_style(store, Mode::Add, &name, &given)?);
    let sizes = catalogue::sizes(store)?;
    let row = sizes.iter().find(|row| row.style == name);
    let undecided = row.map(|row| catalogue::workpiece(store, row.key)?.laid_out()).transpose()?;
    let open = undecided.map_or(0, |laid| laid.undecided.iter().filter(|question| !question.is_sure).count());
    if open > 0 {
        context.say(format_args!("{open} questions about its seams stand: the workbench asks them (screen 3, Enter)"));
    }
    Ok(Some(name))
}

/// True if the sizes of a style were made of some patterns, and of a seam file where one is given.
fn is_of(store: &Store, sizes: &[SizeKey], patterns: &[String], seams: Option<&PathBuf>) -> Result<bool, StudyError> {
    let given: Vec<SourceFile> =
        patterns.iter().map(|text| SourceFile::read_pattern(&pattern_of(text).1)).collect::<Result<_, _>>()?;
    let pieces = sizes.iter().map(|key| catalogue::workpiece(store, *key)).collect::<Result<Vec<_>, _>>()?;
    let seams = seams.map(|path| SourceFile::read(path)).transpose()?;
    let has = |file: &SourceFile| pieces.iter().any(|piece| piece.pattern.bytes == file.bytes);
    let is_given = |file: &SourceFile| given.iter().any(|given| given.bytes == file.bytes);
    let is_sewn = |stored: Option<&SourceFile>| {
        seams.as_ref().is_none_or(|seams| stored.is_some_and(|stored| stored.bytes == seams.bytes))
    };
    let is_same = given.iter().all(has) && pieces.iter().all(|piece| is_given(&piece.pattern));
    Ok(is_same && pieces.iter().all(|piece| is_sewn(piece.seams.as_ref())))
}

fn nearest(context: &Context, study: &Path, subject: &SubjectValues) -> Outcome {
    let store = context.store()?;
    let name = context.study_name(&store, study)?;
    let nearest = population::nearest(&store, &name, &subject.0)?;
    let population::Difference { dimension, asked, found } = nearest.widest;
    let edge = |value: f64| format!("{:.0} {}", value * dimension.per_si(), dimension.unit());
    context.say(format_args!(
        "{} of {name} is nearest: {:.2} standard deviations off, most in {} ({}, not {})",
        nearest.subject,
        nearest.distance,
        dimension.name(),
        edge(found),
        edge(asked)
    ));
    let jobs: Vec<String> = nearest.jobs.iter().map(ToString::to_string).collect();
    let table = sql::query(
        &store,
        &format!(
            "SELECT garment, size, simulator, fit_class, round(ease_mm, 1) AS ease_mm, round(e_chi, 4) AS e_chi,
            round(ei, 4) AS ei, converged, job_id
        FROM v_metrics LEFT JOIN (SELECT * FROM v_ease WHERE decides) USING (study, garment, size, subject)
        WHERE job_id IN ({}) ORDER BY garment, size, simulator",
            jobs.join(", ")
        ),
    )?;
    context.print(&table)?;
    Ok(End::Done)
}

//! `toile render`, `toile export` and `toile report`: pictures, meshes and reports of results.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::UNIX_EPOCH;

use super::args::{
    Export, Map as MapArgument, MeshFormat as FormatArgument, Purpose as PurposeArgument, Render, Report,
    Stage as StageArgument, View as ViewArgument,
};
use super::context::{Context, project_folder};
use super::progress::Ongoing;
use super::{CliError, End, Outcome, output};
use render::export::MeshFormat;
use render::{Rgb, View, lacking_letters};
use report::{Chart, Purpose};
use results::{Cloth, Map, Order, Shot, Zoom, picture, record, reporting};
use sim::Stage;
use spec::Study;
use store::{JobId, Store, files};

pub fn render(context: &Context, arguments: &Render) -> Outcome {
    let shot = |view: &ViewArgument| match view {
        ViewArgument::Front => Shot::View(View::Front),
        ViewArgument::Side => Shot::View(View::Side),
        ViewArgument::Back => Shot::View(View::Back),
        ViewArgument::Quarter => Shot::View(View::Quarter),
        ViewArgument::CloseUp => Shot::CloseUp,
    };
    let shots = match arguments.turn {
        Some(degrees) => vec![Shot::Turned(degrees)],
        None => arguments.view.iter().map(shot).collect(),
    };
    let stage = |stage: &StageArgument| match stage {
        StageArgument::Sewn => Stage::Sewn,
        StageArgument::Popup => Stage::Popup,
        StageArgument::Drape => Stage::Drape,
    };
    let order = Order {
        shots,
        stages: arguments.stage.iter().map(stage).collect(),
        map: map(arguments.map),
        cloths: arguments.cloth.iter().map(|text| Cloth::parse(text)).collect::<Result<_, _>>()?,
        skin: arguments.skin.as_deref().map(colour).transpose()?,
        zoom: arguments.zoom.map(|zoom_pct| Zoom { zoom_pct, rise_pct: arguments.rise }),
        size: (arguments.width, arguments.height),
    };
    let jobs: Vec<JobId> = arguments.jobs.iter().copied().map(JobId).collect();
    let store = context.store()?;
    let endings: &[(&str, ())] =
        if arguments.turntable.is_some() { &[("png", ()), ("apng", ())] } else { &[("png", ())] };
    output::kind(&arguments.output, endings)?;
    let png = match (arguments.turntable, jobs.as_slice()) {
        (None, _) => picture::pictures(&store, &jobs, &order)?,
        (Some(pictures), [job]) => picture::turntable(&store, *job, &order, pictures)?,
        (Some(_), _) => return Err(CliError::Usage("--turntable shows one job".into())),
    };
    context.write(&arguments.output, png)?;
    Ok(End::Done)
}

fn colour(text: &str) -> Result<Rgb, CliError> {
    Rgb::from_hex(text).ok_or_else(|| CliError::Usage(format!("{text} is no colour; accepted: #rrggbb, like #dcb094")))
}

pub fn export(context: &Context, arguments: &Export) -> Outcome {
    let formats = [
        ("glb", FormatArgument::Glb),
        ("obj", FormatArgument::Obj),
        ("ply", FormatArgument::Ply),
        ("stl", FormatArgument::Stl),
    ];
    let format = match output::kind_or(&arguments.output, arguments.format, &formats)? {
        FormatArgument::Glb => MeshFormat::Glb,
        FormatArgument::Obj => MeshFormat::Obj,
        FormatArgument::Ply => MeshFormat::Ply,
        FormatArgument::Stl => MeshFormat::Stl,
    };
    let file = picture::mesh_file(&context.store()?, JobId(arguments.job), format, map(arguments.map))?;
    context.write(&arguments.output, file)?;
    Ok(End::Done)
}

fn map(argument: MapArgument) -> Map {
    match argument {
        MapArgument::Plain => Map::Plain,
        MapArgument::Check => Map::Check,
        MapArgument::Stretch => Map::Stretch,
        MapArgument::Tension => Map::Tension,
        MapArgument::Pressure => Map::Pressure,
        MapArgument::Gap => Map::Gap,
        MapArgument::Chi => Map::Chi,
    }
}

pub fn write_chart(context: &Context, file: &Path, chart: &Chart) -> Outcome {
    let bytes = match chart_format(file)? {
        ChartFormat::Svg => chart.svg().as_bytes().to_vec(),
        ChartFormat::Png => chart.png().map_err(|error| CliError::Usage(error.to_string()))?,
    };
    context.write(file, bytes)?;
    Ok(End::Done)
}

#[derive(Clone, Copy)]
pub enum ChartFormat {
    Svg,
    Png,
}

pub fn chart_format(file: &Path) -> Result<ChartFormat, CliError> {
    output::kind(file, &[("svg", ChartFormat::Svg), ("png", ChartFormat::Png)])
}

pub fn report(context: &Context, arguments: &Report) -> Outcome {
    arguments.output.as_deref().map(|folder| output::folder(folder, &["html", "pdf", "csv"])).transpose()?;
    let store = context.store()?;
    let name = context.study_name(&store, &arguments.study)?;
    let purpose = arguments.purpose.map(|purpose| match purpose {
        PurposeArgument::Fit => Purpose::Fit,
        PurposeArgument::Compare => Purpose::Compare,
    });
    let folder = arguments.output.clone().unwrap_or_else(|| default_folder(context, &name));
    write_report(context, &store, &name, &folder, purpose)?;
    if arguments.pdf { print_page(context, &folder) } else { Ok(End::Done) }
}

/// Browsers that can print a page, by their names on different systems.
const BROWSERS: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"];

/// Prints a report's page to a PDF file beside it, by the first of the browsers that is installed.
fn print_page(context: &Context, folder: &Path) -> Outcome {
    let missing = || {
        let names = BROWSERS.join(", ");
        CliError::Usage(format!(
            "--pdf: no Chromium is installed; accepted: {names}. The page prints from any browser."
        ))
    };
    let page = std::path::absolute(folder.join(PAGE))?;
    let pdf = page.with_extension("pdf");
    let print = |browser: &&str| {
        Command::new(browser)
            .args(["--headless", "--no-sandbox", "--disable-gpu", "--no-pdf-header-footer"])
            .arg(format!("--print-to-pdf={}", pdf.display()))
            .arg(&page)
            .output()
            .ok()
    };
    let output = BROWSERS.iter().find_map(print).ok_or_else(missing)?;
    if !output.status.success() || !pdf.is_file() {
        let said = String::from_utf8_lossy(&output.stderr);
        return Err(CliError::Usage(format!("--pdf: {}", said.lines().last().unwrap_or("the browser wrote no file"))));
    }
    context.say(format_args!("wrote {}", pdf.display()));
    Ok(End::Done)
}

fn write_report(
    context: &Context,
    store: &Store,
    study: &str,
    folder: &Path,
    purpose: Option<Purpose>,
) -> Result<(), CliError> {
    let ongoing = Ongoing::new("making the report: ", context.quiet);
    let made = reporting::report(store, study, purpose, &|part| ongoing.tell(part.name, part));
    ongoing.end();
    files::write_files(folder, &made?)?;
    tell_report(context, &folder.join(PAGE))
}

const PAGE: &str = "index.html";
/// Greatest number of letters that are told to be lacking in pictures.
const LISTED_LETTERS: usize = 12;

/// Writes a study's report, unless the present page comes from this database and is newer than the latest result, the
/// study file and this program. Prints its path.
pub fn bring_report(context: &Context, store: &mut Store, study: &Study, since_ms: i64) -> Result<(), CliError> {
    let page = default_folder(context, &study.name).join(PAGE);
    let program = std::env::current_exe().ok().and_then(|path| modified_ms(&path));
    let sources = [Some(since_ms), modified_ms(&study.path), program];
    if let Some(written) = modified_ms(&page)
        && sources.into_iter().flatten().all(|source| source < written)
        && record::knows_report(store, &study.name, &page, written)?
    {
        return tell_report(context, &page);
    }
    write_report(context, store, &study.name, &default_folder(context, &study.name), None)?;
    if let Some(written) = modified_ms(&page).filter(|_| !store.is_readonly()) {
        record::remember_report(store, &study.name, &page, written)?;
    }
    Ok(())
}

/// Time since 1970 (UTC).
fn modified_ms(path: &Path) -> Option<i64> {
    let modified = std::fs::metadata(path).and_then(|file| file.modified()).ok()?;
    i64::try_from(modified.duration_since(UNIX_EPOCH).ok()?.as_millis()).ok()
}

/// Path relative to the current folder if the page lies in it.
fn tell_report(context: &Context, page: &Path) -> Result<(), CliError> {
    let lacking = lacking_letters();
    if !lacking.is_empty() {
        let letters: Vec<String> = lacking.iter().take(LISTED_LETTERS).map(char::to_string).collect();
        let more = if lacking.len() > LISTED_LETTERS { ", ..." } else { "" };
        let letters = letters.join(" ");
        output::note(&format!(
            "pictures have boxes for {letters}{more}: their typeface lacks these; the page shows them"
        ));
    }
    let here = std::env::current_dir().unwrap_or_default();
    let page = page.strip_prefix(here).unwrap_or(page);
    if context.json {
        context.say(format_args!("report: {}", page.display()));
    } else {
        output::text(&format!("report: {}\n", page.display()))?;
    }
    Ok(())
}

/// Folder of a study's report: `reports/STUDY` of the project, or beside the database without a project.
pub fn default_folder(context: &Context, study: &str) -> PathBuf {
    let beside = || context.db.parent().map(Path::to_owned).unwrap_or_default();
    project_folder().unwrap_or_else(beside).join("reports").join(files::study_folder(study))
}

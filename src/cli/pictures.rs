//! `toile render`, `toile export` and `toile report`: what a run looks like.

use std::path::{Path, PathBuf};

use super::args::{Export, Map as MapArgument, MeshFormat as FormatArgument, Render, Report, View as ViewArgument};
use super::context::{Context, project_folder};
use super::{CliError, End, Outcome, output};
use crate::study::{JobId, Map, MeshFormat, View, Workspace, tools};

/// `toile render`.
pub fn render(context: &Context, arguments: &Render) -> Outcome {
    let view = match arguments.view {
        ViewArgument::Front => View::Front,
        ViewArgument::Side => View::Side,
        ViewArgument::Back => View::Back,
        ViewArgument::Quarter => View::Quarter,
    };
    let (workspace, map) = (context.workspace()?, map(arguments.map));
    let png = workspace.picture_png(JobId(arguments.job), view, arguments.width, arguments.height, map)?;
    write(context, &arguments.output, png)
}

/// `toile export`.
pub fn export(context: &Context, arguments: &Export) -> Outcome {
    let format = match arguments.format {
        FormatArgument::Glb => MeshFormat::Glb,
        FormatArgument::Obj => MeshFormat::Obj,
        FormatArgument::Ply => MeshFormat::Ply,
        FormatArgument::Stl => MeshFormat::Stl,
    };
    let file = context.workspace()?.mesh_file(JobId(arguments.job), format, map(arguments.map))?;
    write(context, &arguments.output, file)
}

fn map(argument: MapArgument) -> Map {
    match argument {
        MapArgument::Plain => Map::Plain,
        MapArgument::Check => Map::Check,
        MapArgument::Stretch => Map::Stretch,
        MapArgument::Tension => Map::Tension,
        MapArgument::Gap => Map::Gap,
    }
}

/// Writes one file and says so.
pub fn write(context: &Context, path: &Path, bytes: Vec<u8>) -> Outcome {
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    tools::write_files(path.parent().unwrap_or(Path::new("")), &[(name, bytes)])?;
    context.say(format_args!("wrote {}", path.display()));
    Ok(End::Done)
}

/// `toile report`.
pub fn report(context: &Context, arguments: &Report) -> Outcome {
    let workspace = context.workspace()?;
    let name = context.study_name(&workspace, &arguments.study)?;
    write_report(context, &workspace, &name, arguments.output.as_deref())?;
    Ok(End::Done)
}

/// Writes a study's report and prints the path of its page.
pub fn write_report(
    context: &Context,
    workspace: &Workspace,
    study: &str,
    folder: Option<&Path>,
) -> Result<(), CliError> {
    let folder = folder.map_or_else(|| default_folder(context, study), Path::to_owned);
    let files: Vec<(String, Vec<u8>)> = workspace.report(study)?;
    tools::write_files(&folder, &files)?;
    let page = folder.join("index.html");
    if context.json {
        context.say(format_args!("report: {}", page.display()));
    } else {
        output::text(&format!("report: {}\n", page.display()))?;
    }
    Ok(())
}

/// `reports/STUDY` of the project; without a project, beside the database.
fn default_folder(context: &Context, study: &str) -> PathBuf {
    let beside = || context.db.parent().map(Path::to_owned).unwrap_or_default();
    project_folder().unwrap_or_else(beside).join("reports").join(study)
}

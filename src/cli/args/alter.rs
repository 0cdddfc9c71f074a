//! Arguments of `alter`.

use std::path::PathBuf;

use clap::Args;

use super::pattern::DxfStandard;
use pattern::Handle;

/// Arguments of `alter`.
#[derive(Debug, Args)]
pub struct Alter {
    /// Folder of the study, or its study.toml.
    pub study: PathBuf,
    /// Garment; needed where the study has several.
    #[arg(long, value_name = "NAME")]
    pub garment: Option<String>,
    /// Who is to wear it; needed where the study has several.
    #[arg(long, value_name = "ID")]
    pub subject: Option<String>,
    /// Size that is changed.
    #[arg(long, value_name = "SIZE")]
    pub size: String,
    /// Ease that a level is to have instead of that of the intended fit, as hip=20..80 in mm, or what is to be read off the drape, as
    /// hem_front_over_back=-5..5; may be given again.
    #[arg(long, value_name = "NAME=LEAST..MOST", value_parser = target, allow_hyphen_values = true)]
    pub target: Vec<(String, [f64; 2])>,
    /// Greatest amount of every handle either way, instead of what a cutter does without drawing the pattern anew.
    #[arg(long, value_name = "MM")]
    pub limit_mm: Option<f64>,
    /// A handle that stays as it is; may be given again.
    #[arg(long, value_name = "HANDLE", value_parser = handle)]
    pub without: Vec<Handle>,
    /// A handle to move, as waist=-8 in mm, instead of finding the change; may be given again.
    #[arg(long = "move", value_name = "HANDLE=MM", value_parser = amount, conflicts_with_all = ["target", "without"], allow_hyphen_values = true)]
    pub moves: Vec<(Handle, f64)>,
    /// Drape the changed pattern by FEM-GS; a target of the drape does that anyway.
    #[arg(long)]
    pub drape: bool,
    /// Change all sizes alike, and write them as a nest beside the changed size: the grade stays.
    #[arg(long)]
    pub nest: bool,
    /// Show what targets may be set for, and what it is now, and change nothing.
    #[arg(long, conflicts_with_all = ["target", "moves", "drape", "output"])]
    pub list: bool,
    /// Standard of the DXF.
    #[arg(long, value_enum, default_value_t = DxfStandard::Aama)]
    pub standard: DxfStandard,
    /// Folder for the changed pattern, its seam file, and a sheet of old and new outlines.
    #[arg(long, short, value_name = "DIR")]
    pub output: Option<PathBuf>,
}

fn handle(text: &str) -> Result<Handle, String> {
    let known = || Handle::ALL.map(Handle::as_str).join(", ");
    Handle::named(text).ok_or_else(|| format!("no handle `{text}`; accepted: {}", known()))
}

fn amount(text: &str) -> Result<(Handle, f64), String> {
    let (name, mm) = text.split_once('=').ok_or("accepted: HANDLE=MM, like waist=-8")?;
    let amount_mm = mm.parse::<f64>().ok().filter(|mm| mm.is_finite());
    Ok((handle(name)?, amount_mm.ok_or_else(|| format!("`{mm}` is no length in mm"))?))
}

fn target(text: &str) -> Result<(String, [f64; 2]), String> {
    let parts = text.split_once('=').and_then(|(level, band)| Some((level, band.split_once("..")?)));
    let accepted = "accepted: NAME=LEAST..MOST, like hip=20..80 in mm";
    let (level, (least, most)) = parts.ok_or(accepted)?;
    match (least.parse::<f64>(), most.parse::<f64>()) {
        (Ok(least), Ok(most)) if least <= most => Ok((level.to_owned(), [least, most])),
        _ => Err(accepted.to_owned()),
    }
}

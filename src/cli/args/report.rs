//! Arguments of `report`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

/// Arguments of `report`.
#[derive(Debug, Args)]
pub struct Report {
    /// Name of the study, its folder, or its study.toml.
    pub study: PathBuf,
    /// Folder to write to [default: reports/STUDY].
    #[arg(long, short, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// What index.html shows; the other page lies beside it [default: compare where both simulators ran, else fit].
    #[arg(long = "for", value_enum, value_name = "PURPOSE")]
    pub purpose: Option<Purpose>,
    /// Print index.html to index.pdf as well, by a Chromium that is installed.
    #[arg(long)]
    pub pdf: bool,
}

/// What a report is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Purpose {
    /// Which size to wear, where it is tight or loose, how it hangs.
    Fit,
    /// Which simulator to trust, with the evidence.
    Compare,
}

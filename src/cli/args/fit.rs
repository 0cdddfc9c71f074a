//! Arguments of `fit` and `section`.

use std::path::PathBuf;

use clap::Args;

use super::attempt::TrySimulator;

/// Arguments of `fit`.
#[derive(Debug, Args)]
pub struct Fit {
    /// Folder of the study, its study.toml, or its name.
    pub study: PathBuf,
    /// Only this garment.
    #[arg(long, value_name = "NAME")]
    pub garment: Option<String>,
    /// Only this subject.
    #[arg(long, value_name = "ID")]
    pub subject: Option<String>,
}

/// Arguments of `section`.
#[derive(Debug, Args)]
pub struct Section {
    /// Folder of the study, its study.toml, or its name.
    pub study: PathBuf,
    /// Only this garment.
    #[arg(long, value_name = "NAME")]
    pub garment: Option<String>,
    /// Only this subject.
    #[arg(long, value_name = "ID")]
    pub subject: Option<String>,
    /// Only these sizes.
    #[arg(long, value_name = "SIZE", value_delimiter = ',')]
    pub size: Vec<String>,
    /// Drapes of this simulator [default: fem, or hybrid where that alone has any].
    #[arg(long, value_enum)]
    pub sim: Option<TrySimulator>,
    /// Only this level: chest, underbust, waist, hip, thigh, knee or upper_arm.
    #[arg(long, value_name = "LEVEL", conflicts_with = "at_mm")]
    pub level: Option<String>,
    /// A height above the floor instead of the levels; below the crotch the right leg is cut.
    #[arg(long, value_name = "MM", allow_negative_numbers = true)]
    pub at_mm: Option<f64>,
    /// A file to draw one section to, as SVG or PNG.
    #[arg(long, short, value_name = "FILE")]
    pub output: Option<PathBuf>,
}

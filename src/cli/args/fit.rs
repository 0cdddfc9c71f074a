//! Arguments of `fit`, `chance` and `section`.

use std::path::PathBuf;

use clap::Args;

use super::TrySimulator;

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

/// Arguments of `chance`.
#[derive(Debug, Args)]
pub struct Chance {
    /// Folder of the study, its study.toml, or its name.
    pub study: PathBuf,
    /// Garment; needed where the study has several.
    #[arg(long, value_name = "NAME")]
    pub garment: Option<String>,
    /// Who is to wear it; needed where the study has several.
    #[arg(long, value_name = "ID")]
    pub subject: Option<String>,
    /// Size whose levels are told [default: the one that is worn most often].
    #[arg(long, value_name = "SIZE")]
    pub size: Option<String>,
    /// How often body and garment are drawn.
    #[arg(long, value_name = "N", default_value_t = 500, value_parser = clap::value_parser!(u32).range(20..=100_000))]
    pub draws: u32,
    /// Seed of the draws.
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// Errors of the readings over those of somebody trained.
    #[arg(long, value_name = "TIMES", default_value_t = 1.0, value_parser = super::positive)]
    pub error_factor: f64,
    /// How far half of a girth of the garment may be off when it is made; one of twenty is off by more.
    #[arg(long, value_name = "MM", default_value_t = 6.0, value_parser = super::positive)]
    pub tolerance_mm: f64,
    /// Drape so many draws by FEM-GS, with cloth and start drawn too.
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u32).range(0..=10_000))]
    pub fem: u32,
    /// Plant so many people instead, measure them with errors, and count how often what is told comes true.
    #[arg(long, value_name = "N", conflicts_with_all = ["fem", "output"], value_parser = clap::value_parser!(u32).range(20..=100_000))]
    pub planted: Option<u32>,
    /// A file to draw the eases to, as SVG or PNG.
    #[arg(long, short, value_name = "FILE")]
    pub output: Option<PathBuf>,
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

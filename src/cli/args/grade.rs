//! Arguments of `grade`.

use std::path::PathBuf;

use clap::Args;

/// Arguments of `grade`.
#[derive(Debug, Args)]
pub struct Grade {
    /// Folder of the study, or its study.toml.
    pub study: PathBuf,
    /// Garment; needed where the study has several.
    #[arg(long, value_name = "NAME")]
    pub garment: Option<String>,
    /// How many sizes; as many as the pattern has where it is not said.
    #[arg(long, value_name = "N")]
    pub sizes: Option<usize>,
    /// Size that the others are made of; the one in the middle where it is not said.
    #[arg(long, value_name = "SIZE")]
    pub base: Option<String>,
    /// People whom the sizes are sought for.
    #[arg(long, value_name = "N", default_value_t = 2000)]
    pub people: usize,
    /// People on whom they are judged.
    #[arg(long, value_name = "N", default_value_t = 2000)]
    pub held_out: usize,
    /// Seed of the draw.
    #[arg(long, value_name = "S", default_value_t = 1)]
    pub seed: u64,
    /// The same step between all sizes.
    #[arg(long)]
    pub even: bool,
    /// A level that is not asked for, such as across_shoulder; may be given again.
    #[arg(long, value_name = "LEVEL")]
    pub without: Vec<String>,
    /// Share of the people held out whom a size fits who are draped in it by FEM-GS, such as 0.01.
    #[arg(long, value_name = "SHARE", default_value_t = 0.0)]
    pub drape: f64,
    /// Folder for the sizes as DXF, the base size with its rules, sheets and a picture.
    #[arg(long, short, value_name = "DIR")]
    pub output: Option<PathBuf>,
}

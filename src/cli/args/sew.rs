//! Arguments of `toile pattern sew`.

use std::path::PathBuf;

use clap::Args;

use super::{BodyFile, CutFiles};

/// A pattern, its seam file and the body that it is sewn on.
#[derive(Debug, Args)]
pub struct SewFiles {
    /// DXF file, folder of them, or GarmentCode JSON with its seams.
    pub file: PathBuf,
    /// Seam file; where there is none yet it is written as `propose` says. By default beside the pattern: X.seams.toml.
    #[arg(long, value_name = "FILE")]
    pub seams: Option<PathBuf>,
    #[command(flatten)]
    pub body: BodyFile,
    #[command(flatten)]
    pub cut: CutFiles,
    /// Fabric of the library, or a TOML file with what stands under a study's [[fabric]].
    #[arg(long, value_name = "NAME", default_value = sim::fabric::USUAL)]
    pub fabric: String,
    /// Sew again whenever the seam file has changed, until Ctrl-C.
    #[arg(long)]
    pub watch: bool,
    /// PNG file to write.
    #[arg(long, short, value_name = "FILE", default_value = "sewn.png")]
    pub output: PathBuf,
}

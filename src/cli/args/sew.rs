//! Arguments of `toile pattern sew`.

use std::path::PathBuf;

use clap::Args;

use super::{CutFiles, MeshUnit, Sex};

/// A pattern, its seam file and the body that it is sewn on.
#[derive(Debug, Args)]
pub struct SewFiles {
    /// DXF file, folder of them, or GarmentCode JSON with its seams.
    pub file: PathBuf,
    /// Seam file; where there is none yet it is written as `propose` says. By default beside the pattern: X.seams.toml.
    #[arg(long, value_name = "FILE")]
    pub seams: Option<PathBuf>,
    /// Body: a mesh or scan (OBJ, PLY, STL, GLB), or measurements (TOML, .smis, .vit, GarmentCode .yaml).
    #[arg(long, value_name = "FILE")]
    pub body: PathBuf,
    /// Unit of the mesh; by default told from its height.
    #[arg(long, value_enum)]
    pub body_unit: Option<MeshUnit>,
    /// Sex of the body; by default told from its girths.
    #[arg(long, value_enum)]
    pub sex: Option<Sex>,
    #[command(flatten)]
    pub cut: CutFiles,
    /// Sew again whenever the seam file has changed, until Ctrl-C.
    #[arg(long)]
    pub watch: bool,
    /// Picture to write.
    #[arg(long, short, value_name = "FILE", default_value = "sewn.png")]
    pub output: PathBuf,
}

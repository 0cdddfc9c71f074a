//! Arguments of `toile try`, and of `toile audit garments`, which tries many.

use std::path::PathBuf;

use clap::Args;

use super::{BodyFile, JobLimits, PatternUnit, TrySimulator};

/// Arguments of `try`.
#[derive(Debug, Args)]
pub struct Try {
    #[command(flatten)]
    pub body: BodyFile,
    /// Pattern: a DXF file, a folder of them, or a GarmentCode specification (JSON). Given several times, an outfit: the inner garment first.
    #[arg(long, value_name = "FILE", required = true)]
    pub pattern: Vec<PathBuf>,
    /// Seam file; without one a DXF pattern is sewn as `pattern propose` says, where that is sure. Of an outfit one for
    /// each pattern, `-` for none.
    #[arg(long, value_name = "FILE")]
    pub seams: Vec<String>,
    /// Size, where the pattern has several; of an outfit one for all, or one for each pattern.
    #[arg(long, value_name = "NAME")]
    pub size: Vec<String>,
    /// Unit of the pattern, where its file names none.
    #[arg(long, value_enum)]
    pub unit: Option<PatternUnit>,
    /// Seam allowance of pieces that have no sew line; a seam file says its own.
    #[arg(long, value_name = "MM", default_value_t = 0.0, conflicts_with = "seams")]
    pub allowance_mm: f64,
    /// Answer to a question of the proposal, by its number and the letter of the choice; may be given several times.
    #[arg(long, value_name = "N=x", value_parser = super::pattern::answer, conflicts_with = "seams")]
    pub answer: Vec<(usize, char)>,
    /// Simulator that drapes it.
    #[arg(long, value_enum, default_value_t = TrySimulator::Fem)]
    pub sim: TrySimulator,
    /// Fabric of the library, or a TOML file with what stands under a study's [[fabric]]; of an outfit one for all, or one for each pattern.
    #[arg(long, value_name = "NAME", default_value = sim::fabric::USUAL)]
    pub fabric: Vec<String>,
    /// Edge length of the mesh, mm.
    #[arg(long, value_name = "MM", default_value_t = 15.0)]
    pub edge_mm: f64,
    /// Drape N times, each from a start that differs a little, and print how far each chi lies apart (FEM-GS only).
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=100))]
    pub repeat: u32,
    /// Pose to dress the body in: arms_5 to arms_90, legs_, forward_, step_, or several (arms_45+legs_10); by default as it stands.
    #[arg(long, value_name = "POSE")]
    pub pose: Option<spec::bodies::Pose>,
    /// Pose that the body then moves into with the garment on: how far hem and cuffs are drawn, where it pulls and presses (FEM-GS only).
    #[arg(long, value_name = "POSE")]
    pub reach: Option<spec::bodies::Pose>,
    /// Folder for picture and meshes.
    #[arg(long, short, value_name = "DIR", default_value = "try")]
    pub output: PathBuf,
}

/// Arguments of `audit garments`.
#[derive(Debug, Args)]
pub struct AuditGarments {
    /// Folder of patterns: DXF, sewn as `pattern propose` says; GarmentCode specifications (JSON).
    pub garments: PathBuf,
    /// Folder of bodies: meshes and scans, or measurements.
    #[arg(long, value_name = "DIR")]
    pub bodies: PathBuf,
    /// Which garment goes with which body: CSV with the columns garment and body, file names without endings; by default all
    /// with all.
    #[arg(long, value_name = "FILE")]
    pub pairs: Option<PathBuf>,
    /// Simulators to drape with.
    #[arg(long, value_enum, value_delimiter = ',', default_values_t = [TrySimulator::Fem, TrySimulator::Hybrid])]
    pub sim: Vec<TrySimulator>,
    /// Fabric of the catalogue.
    #[arg(long, value_name = "NAME", default_value = sim::fabric::USUAL)]
    pub fabric: String,
    /// Unit of the patterns, where their files name none.
    #[arg(long, value_enum)]
    pub unit: Option<PatternUnit>,
    /// Seam allowance of pieces that have no sew line.
    #[arg(long, value_name = "MM", default_value_t = 0.0)]
    pub allowance_mm: f64,
    /// Simulations at once [default: number of cores].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub workers: Option<u16>,
    #[command(flatten)]
    pub limits: JobLimits,
    /// Folder for the study and audit.json; its name is the study's.
    #[arg(long, short, value_name = "DIR", default_value = "garments-audit")]
    pub output: PathBuf,
}

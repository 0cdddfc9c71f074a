//! The command line as clap parses it.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};
use clap_complete::Shell;

mod attempt;
mod body;
mod catalogue;
mod pattern;

pub use attempt::{Try, TrySimulator};
pub use body::{Body, BodyBuild, MeshUnit, Sex};
pub use catalogue::{Catalogue, FabricValues, SizeValues, StyleValues, SubjectValues};
pub use pattern::{BesideFiles, DraftStyle, Pattern, PatternUnit, SeamCommand, StyleFiles};

/// A fit-study workbench: dress bodies in sewing patterns, measure the drape, say which simulator to trust.
#[derive(Debug, Parser)]
#[command(name = "toile", version, max_term_width = 110, disable_help_subcommand = true)]
#[command(after_help = "Without a command the workbench (TUI) starts. Exit codes: 0 done, 2 usage or unusable input, \
    3 a check failed, 4 a job failed, 130 interrupted.")]
pub struct Arguments {
    #[command(flatten)]
    pub global: Global,
    /// How the workbench shows pictures.
    #[arg(long, value_parser = ["auto", "halfblocks", "off"], default_value = "auto")]
    pub images: String,
    #[command(subcommand)]
    pub command: Option<Command>,
}

/// Flags that every command takes.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Global options")]
pub struct Global {
    /// Database file; by default db/toile.sqlite beside the nearest studies folder, else in your data folder.
    #[arg(long, global = true, env = "TOILE_DB", hide_env_values = true, value_name = "PATH")]
    pub db: Option<PathBuf>,
    /// Change nothing in the database.
    #[arg(long, global = true)]
    pub readonly: bool,
    /// Print JSON instead of tables.
    #[arg(long, global = true)]
    pub json: bool,
    /// No progress and no messages but errors.
    #[arg(long, short, global = true)]
    pub quiet: bool,
    /// Say more.
    #[arg(long, short, global = true, conflicts_with = "quiet")]
    pub verbose: bool,
    /// No colours (also NO_COLOR).
    #[arg(long, global = true)]
    pub no_color: bool,
}

/// What to do.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Run a study: queue what is new or changed, simulate, measure, report.
    Run(Run),
    /// Dress one body in one garment, without a study: a picture, a table, the mesh.
    Try(Box<Try>),
    /// Write a study's report: HTML, PNG, CSV.
    Report(Report),
    /// Ask the database in SQL (read-only; also median, stddev, quantile).
    Sql(Sql),
    /// Recompute a study's results, or the thesis's printed tables, and say what does not add up.
    Audit(Audit),
    /// Ease and fit class of every size on every subject; needs no simulation.
    Ease(StudyPath),
    /// Which simulator to use for which fit.
    Recommend(Recommend),
    /// Sewing patterns: inspect, check, draft, mesh, draw.
    #[command(subcommand)]
    Pattern(Pattern),
    /// Bodies: build from measurements, measure any mesh.
    #[command(subcommand)]
    Body(Body),
    /// A picture of a result.
    Render(Render),
    /// A result's body and garment as a mesh file.
    Export(Export),
    /// The job queue.
    #[command(subcommand)]
    Queue(Queue),
    /// Subjects of the catalogue.
    #[command(subcommand)]
    Subject(Catalogue<SubjectValues>),
    /// Styles of the catalogue.
    #[command(subcommand)]
    Style(Catalogue<StyleValues>),
    /// Sizes of the catalogue.
    #[command(subcommand)]
    Size(Catalogue<SizeValues>),
    /// Fabrics of the catalogue.
    #[command(subcommand)]
    Fabric(Catalogue<FabricValues>),
    /// Check that everything toile needs is in order.
    Doctor,
    /// Version, database, studies.
    Info,
    /// Completion script for a shell.
    Completions {
        /// Shell.
        shell: Shell,
    },
    /// The manual page, as roff.
    Man,
}

/// A study by its folder, file or name.
#[derive(Debug, Args)]
pub struct StudyPath {
    /// Folder of the study, or its study.toml.
    pub study: PathBuf,
}

/// Arguments of `run`.
#[derive(Debug, Args)]
pub struct Run {
    /// Folder of the study, or its study.toml.
    pub study: PathBuf,
    /// Simulations at once [default: number of cores].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub workers: Option<u16>,
    /// Only these simulators.
    #[arg(long, value_name = "fem,hybrid", value_delimiter = ',')]
    pub sim: Vec<String>,
    /// Only these sizes.
    #[arg(long, value_name = "s,m", value_delimiter = ',')]
    pub size: Vec<String>,
    /// Only these subjects.
    #[arg(long, value_name = "i,ii", value_delimiter = ',')]
    pub subject: Vec<String>,
    /// Only these garments.
    #[arg(long, value_name = "NAME", value_delimiter = ',')]
    pub garment: Vec<String>,
    /// Say what would run and why; change nothing.
    #[arg(long)]
    pub dry_run: bool,
    /// Say of each job why it runs: which input changed.
    #[arg(long)]
    pub why: bool,
    /// Write no report.
    #[arg(long)]
    pub no_report: bool,
    /// Run in the background; a lost connection does not end it.
    #[arg(long, conflicts_with_all = ["dry_run", "attach"])]
    pub detach: bool,
    /// Follow a run that goes on elsewhere; leaving it does not end it.
    #[arg(long, conflicts_with_all = ["dry_run", "why"])]
    pub attach: bool,
}

/// Arguments of `report`.
#[derive(Debug, Args)]
pub struct Report {
    /// Name of the study, its folder, or its study.toml.
    pub study: PathBuf,
    /// Folder to write to [default: reports/STUDY].
    #[arg(long, short, value_name = "DIR")]
    pub output: Option<PathBuf>,
}

/// Arguments of `sql`.
#[derive(Debug, Args)]
#[command(group = clap::ArgGroup::new("source").required(true))]
pub struct Sql {
    /// The query.
    #[arg(group = "source")]
    pub query: Option<String>,
    /// A file with the query; - is standard input.
    #[arg(long, short, group = "source", value_name = "FILE")]
    pub file: Option<PathBuf>,
    /// How to print the rows.
    #[arg(long, value_enum)]
    pub format: Option<Format>,
}

/// How rows are printed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// For reading.
    Table,
    /// For spreadsheets.
    Csv,
    /// For programs.
    Json,
}

/// Arguments of `audit`.
#[derive(Debug, Args)]
pub struct Audit {
    /// Name of the study, its folder, or its study.toml; `thesis-published` (or `thesis`, where there is no study of that
    /// name) audits the printed tables.
    pub study: PathBuf,
}

/// Arguments of `recommend`.
#[derive(Debug, Args)]
pub struct Recommend {
    /// Name of the study, its folder, or its study.toml.
    pub study: PathBuf,
    /// Give the reasons.
    #[arg(long)]
    pub explain: bool,
}

/// Side of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum View {
    /// From the front.
    Front,
    /// From the subject's right.
    Side,
    /// From behind.
    Back,
    /// Between front and side.
    Quarter,
}

/// What colours the cloth of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Map {
    /// The simulator's colour.
    Plain,
    /// A woven check, which shows the grain and every distortion.
    Check,
    /// Stretch of the cloth.
    Stretch,
    /// Tension in the cloth.
    Tension,
    /// Gap between cloth and body.
    Gap,
}

/// Arguments of `render`.
#[derive(Debug, Args)]
pub struct Render {
    /// Number of the job (`toile queue ls`).
    pub job: i64,
    /// Side.
    #[arg(long, value_enum, default_value_t = View::Front)]
    pub view: View,
    /// Colours.
    #[arg(long, value_enum, default_value_t = Map::Plain)]
    pub map: Map,
    /// Pixels across.
    #[arg(long, default_value_t = 800, value_name = "PIXELS", value_parser = clap::value_parser!(u32).range(16..=8192))]
    pub width: u32,
    /// Pixels down.
    #[arg(long, default_value_t = 1000, value_name = "PIXELS", value_parser = clap::value_parser!(u32).range(16..=8192))]
    pub height: u32,
    /// PNG file to write.
    #[arg(long, short, value_name = "FILE")]
    pub output: PathBuf,
}

/// Format of an exported mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum MeshFormat {
    /// Binary glTF: two objects, with colours, texture coordinates and the map's values.
    Glb,
    /// Wavefront: two objects, with colours and texture coordinates.
    Obj,
    /// Stanford: one mesh, with colours and the map's values.
    Ply,
    /// Stereolithography: one mesh.
    Stl,
}

/// Arguments of `export`.
#[derive(Debug, Args)]
pub struct Export {
    /// Number of the job (`toile queue ls`).
    pub job: i64,
    /// Format.
    #[arg(long, value_enum)]
    pub format: MeshFormat,
    /// Colours.
    #[arg(long, value_enum, default_value_t = Map::Plain)]
    pub map: Map,
    /// File to write.
    #[arg(long, short, value_name = "FILE")]
    pub output: PathBuf,
}

/// Jobs by number, or all of a study.
#[derive(Debug, Args)]
#[command(group = clap::ArgGroup::new("which").required(true).multiple(true))]
pub struct Jobs {
    /// Job numbers.
    #[arg(group = "which")]
    pub jobs: Vec<i64>,
    /// All jobs of a study.
    #[arg(long, group = "which", value_name = "NAME")]
    pub study: Option<String>,
}

/// Commands on the queue.
#[derive(Debug, Subcommand)]
pub enum Queue {
    /// List jobs.
    Ls {
        /// Only of this study.
        study: Option<String>,
        /// Also jobs whose inputs are no longer the study's.
        #[arg(long)]
        all: bool,
    },
    /// Let no new jobs of a study start.
    Pause {
        /// Name of the study.
        study: String,
    },
    /// Let jobs of a paused study start again.
    Resume {
        /// Name of the study.
        study: String,
    },
    /// Cancel queued or running jobs.
    Cancel(Jobs),
    /// Queue failed or cancelled jobs again.
    Retry(Jobs),
    /// A job's log.
    Log {
        /// Job number.
        job: i64,
    },
}

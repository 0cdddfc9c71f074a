//! The command line as clap parses it.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};
use clap_complete::Shell;

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
    /// Write a study's report: HTML, PNG, CSV.
    Report(Report),
    /// Ask the database in SQL (read-only; also median, stddev, quantile).
    Sql(Sql),
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
    /// The job queue.
    #[command(subcommand)]
    Queue(Queue),
    /// Subjects of the catalogue.
    #[command(subcommand)]
    Subject(Catalogue),
    /// Styles of the catalogue.
    #[command(subcommand)]
    Style(Catalogue),
    /// Sizes of the catalogue.
    #[command(subcommand)]
    Size(Catalogue),
    /// Fabrics of the catalogue.
    #[command(subcommand)]
    Fabric(Catalogue),
    /// Check that everything toile needs is in order.
    Doctor,
    /// Version, database, studies.
    Info,
    /// Completion script for a shell.
    Completions {
        /// Shell.
        shell: Shell,
    },
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

/// Arguments of `recommend`.
#[derive(Debug, Args)]
pub struct Recommend {
    /// Name of the study, its folder, or its study.toml.
    pub study: PathBuf,
    /// Give the reasons.
    #[arg(long)]
    pub explain: bool,
}

/// Unit of a pattern whose file names none.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum PatternUnit {
    /// Millimetre.
    Mm,
    /// Centimetre.
    Cm,
    /// Inch.
    In,
}

/// Style that can be drafted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum DraftStyle {
    /// Men's V-neck T-shirt, sizes S, M and L.
    Tshirt,
    /// Men's trousers, sizes S, M and L.
    Trousers,
    /// Women's tee-top, sizes M and L.
    Teetop,
    /// Women's dress, one size.
    Dress,
}

/// A pattern with its seam file.
#[derive(Debug, Args)]
pub struct StyleFiles {
    /// DXF file, or GarmentCode JSON with its seams.
    pub file: PathBuf,
    /// Seam file; a DXF file needs one.
    #[arg(long, value_name = "FILE")]
    pub seams: Option<PathBuf>,
    /// Size, where the file holds several.
    #[arg(long, value_name = "NAME")]
    pub size: Option<String>,
    /// Unit of the file, where it names none.
    #[arg(long, value_enum)]
    pub unit: Option<PatternUnit>,
}

/// Commands on patterns.
#[derive(Debug, Subcommand)]
pub enum Pattern {
    /// What is in a pattern file (DXF, GarmentCode JSON), or in every one of a folder.
    Inspect {
        /// File or folder.
        path: PathBuf,
        /// Only pieces of this size.
        #[arg(long, value_name = "NAME")]
        size: Option<String>,
        /// Unit of the files, where they name none.
        #[arg(long, value_enum)]
        unit: Option<PatternUnit>,
        /// One row for each file: how many blocks are pieces, how many are refused and why.
        #[arg(long)]
        by_file: bool,
    },
    /// Propose a seam file: what each piece is and what is sewn to what, with confidences.
    Propose {
        /// DXF file, or a folder of them.
        path: PathBuf,
        /// Size, where a file holds several.
        #[arg(long, value_name = "NAME")]
        size: Option<String>,
        /// Unit of the files, where they name none.
        #[arg(long, value_enum)]
        unit: Option<PatternUnit>,
        /// Seam file to write, to be read and edited.
        #[arg(long, short, value_name = "FILE")]
        output: Option<PathBuf>,
    },
    /// Whether a pattern and its seam file fit together: seams, measurements, meshes.
    Check(StyleFiles),
    /// Draft a built-in style in all its sizes, with its seam file.
    Draft {
        /// Style.
        #[arg(value_enum, default_value = "tshirt")]
        style: DraftStyle,
        /// Folder to write to.
        #[arg(long, short, value_name = "DIR")]
        output: PathBuf,
    },
    /// Mesh a pattern; says how good the triangles are.
    Mesh {
        #[command(flatten)]
        files: StyleFiles,
        /// Edge length, mm.
        #[arg(long, default_value_t = 15.0, value_name = "MM")]
        edge_length_mm: f64,
    },
    /// Draw the pieces with their numbered measurements as SVG.
    Sheet {
        #[command(flatten)]
        files: StyleFiles,
        /// SVG file to write.
        #[arg(long, short, value_name = "FILE")]
        output: PathBuf,
    },
}

/// Sex of a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Sex {
    /// Male.
    M,
    /// Female.
    F,
}

/// Unit of a body mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum MeshUnit {
    /// Millimetre.
    Mm,
    /// Centimetre.
    Cm,
    /// Metre.
    M,
}

/// Commands on bodies.
#[derive(Debug, Subcommand)]
pub enum Body {
    /// Measure any upright body mesh (OBJ, PLY, STL).
    Measure {
        /// Mesh file.
        file: PathBuf,
        /// Unit of the file; by default told from its height.
        #[arg(long, value_enum)]
        unit: Option<MeshUnit>,
        /// Sex, where known: places the waist.
        #[arg(long, value_enum)]
        sex: Option<Sex>,
    },
    /// Build a body from measurements, from a front and a side picture, or from a subject of the catalogue.
    Build(Box<BodyBuild>),
    /// How well the bodies of a folder are measured from meshes, scans, silhouettes and photographs.
    Evaluate {
        /// Folder with manifest.csv, measurements.csv, and where there are any scans.csv and images.csv.
        folder: PathBuf,
    },
}

/// Arguments of `body build`.
#[derive(Debug, Args)]
pub struct BodyBuild {
    /// Subject of the catalogue to start from.
    #[arg(long, value_name = "NAME")]
    pub subject: Option<String>,
    /// Sex.
    #[arg(long, value_enum, required_unless_present_any = ["subject", "measurements"])]
    pub sex: Option<Sex>,
    /// TOML file with the keys of a study's [[subject]].
    #[arg(long, value_name = "FILE", conflicts_with = "subject")]
    pub measurements: Option<PathBuf>,
    /// Stature.
    #[arg(long, value_name = "N", required_unless_present_any = ["subject", "measurements"])]
    pub stature_mm: Option<f64>,
    /// Body mass.
    #[arg(long, value_name = "N")]
    pub weight_kg: Option<f64>,
    /// Chest or bust girth.
    #[arg(long, value_name = "N")]
    pub chest_girth_mm: Option<f64>,
    /// Waist girth.
    #[arg(long, value_name = "N")]
    pub waist_girth_mm: Option<f64>,
    /// Hip girth.
    #[arg(long, value_name = "N")]
    pub hip_girth_mm: Option<f64>,
    /// Neck girth.
    #[arg(long, value_name = "N")]
    pub neck_girth_mm: Option<f64>,
    /// Width across the shoulders.
    #[arg(long, value_name = "N")]
    pub across_shoulder_mm: Option<f64>,
    /// Front picture (PNG or JPEG): a photograph against a plain background, or a mask.
    #[arg(long, value_name = "IMAGE", requires = "side", conflicts_with_all = ["subject", "measurements"])]
    pub front: Option<PathBuf>,
    /// Side picture, the subject facing its right.
    #[arg(long, value_name = "IMAGE", requires = "front")]
    pub side: Option<PathBuf>,
    /// Distance of the camera from the subject.
    #[arg(long, value_name = "N", requires = "front", requires = "lens")]
    pub camera_distance_mm: Option<f64>,
    /// Focal length in pixels of the pictures.
    #[arg(long, value_name = "N", group = "lens", requires = "camera_distance_mm")]
    pub focal_px: Option<f64>,
    /// Vertical field of view of the pictures.
    #[arg(long, value_name = "N", group = "lens", requires = "camera_distance_mm")]
    pub fov_deg: Option<f64>,
    /// Folder to write body.obj, body.png, measurements.json, control.obj and control.json to.
    #[arg(long, short, value_name = "DIR")]
    pub output: PathBuf,
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

/// Commands on one part of the catalogue.
#[derive(Debug, Subcommand)]
pub enum Catalogue {
    /// List the latest revisions.
    Ls,
    /// One entry with all its revisions.
    Show {
        /// Name.
        name: String,
    },
}

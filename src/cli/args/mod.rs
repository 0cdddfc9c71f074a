//! The command line as clap parses it.

use std::ffi::OsString;
use std::path::PathBuf;

use clap::builder::Resettable;
use clap::error::ErrorKind;
use clap::{Args, Parser, Subcommand, ValueEnum};
use clap_complete::Shell;

mod alter;
mod attempt;
mod body;
mod catalogue;
mod comment;
mod cut;
mod fit;
mod grade;
mod measured;
mod pattern;
mod report;
mod seam;
mod sew;
mod simulator;
mod spec;
mod studies;

pub use alter::Alter;
pub use attempt::{AuditGarments, Try};
pub use body::{Body, BodyBuild, BodyFile, MeshUnit, Sex};
pub use catalogue::{Catalogue, FabricValues, PersonValues, SizeValues, StyleCommand, StyleValues, SubjectValues};
pub use comment::{Comment, Fittings};
pub use cut::{CutFiles, PatternUnit};
pub use fit::{Chance, Fit, Section};
pub use grade::Grade;
pub use pattern::{BesideFiles, DraftStyle, Pattern, StyleFiles};
pub use report::{Purpose, Report};
pub use seam::{SeamCommand, SewStep};
pub use sew::SewFiles;
pub use simulator::TrySimulator;
pub use spec::{PatternSpec, StyleSpec};
pub use studies::{StudyCommand, StudyPath};

/// A fit-study workbench: dress bodies in sewing patterns, measure the drape, judge the fit.
#[derive(Debug, Parser)]
#[command(name = "toile", version, max_term_width = 110, infer_long_args = true)]
#[command(
    after_help = "Without a command: the workbench. Exit codes: 0 done, 2 unusable, 3 check failed, 4 job failed."
)]
pub struct Arguments {
    #[command(flatten)]
    pub global: Global,
    /// Workbench pictures.
    #[arg(long, value_name = "HOW", value_parser = ["auto", "halfblocks", "off"], default_value = "auto")]
    pub images: String,
    #[command(subcommand)]
    pub command: Option<Command>,
}

/// The error with a usage line of only the typed arguments, since clap counts a database of the environment among them.
pub fn without_environment(command: clap::Command, error: clap::Error, arguments: &[OsString]) -> clap::Error {
    if !error.use_stderr() || error.kind() == ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand {
        return error;
    }
    let typed = command.mut_arg("db", |db| db.env(Resettable::Reset));
    typed.try_get_matches_from(arguments).err().unwrap_or(error)
}

/// Flags that every command takes.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Global options")]
pub struct Global {
    /// Database; else that of the nearest studies folder, or yours.
    #[arg(long, global = true, env = "TOILE_DB", hide_env_values = true, value_name = "PATH")]
    pub db: Option<PathBuf>,
    /// Change nothing in the database.
    #[arg(long, global = true)]
    pub readonly: bool,
    /// Print JSON instead of tables.
    #[arg(long, global = true)]
    pub json: bool,
    /// Only errors and what was asked for; `run` prints no tables.
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
    /// What does not add up in a study's results, or in the thesis's tables.
    Audit(Audit),
    /// Ease and fit class of every size on every subject, without a simulation.
    Ease(StudyPath),
    /// Which size to wear, and where it is tight or loose, without a simulation.
    Fit(Fit),
    /// How probable it is that a garment fits: tapes err, and garments vary.
    Chance(Chance),
    /// The least change of a size so that it fits somebody, as a new DXF.
    Alter(Alter),
    /// The sizes that fit the most people, as DXF with rules and a size chart.
    Grade(Grade),
    /// The air between body and cloth at a level, all sizes over each other.
    Section(Section),
    /// Comments of fittings, in rounds: what was measured, what is to be done, what is met.
    #[command(subcommand)]
    Comment(Comment),
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
    /// Study files: start, check, export.
    #[command(subcommand)]
    Study(StudyCommand),
    /// Jobs as files, for other machines.
    #[command(subcommand)]
    Job(Job),
    /// Subjects of the catalogue.
    #[command(subcommand)]
    Subject(Catalogue<PersonValues>),
    /// Styles of the catalogue.
    #[command(subcommand)]
    Style(StyleCommand),
    /// Sizes of the catalogue.
    #[command(subcommand)]
    Size(Catalogue<SizeValues>),
    /// Fabrics of the catalogue.
    ///
    /// `ls` and `show` tell of each whether it is one cloth or a class, and how long a strip of it bends by its own
    /// weight in a cantilever test. They tell where it stands among 618 known cloths, those of its weight (`p62`: 62 %
    /// bend more easily).
    #[command(subcommand)]
    Fabric(Catalogue<FabricValues>),
    /// The simulator's mechanics beside theory and published measurements.
    Lab(Lab),
    /// Check that everything toile needs is in order.
    Doctor,
    /// Version, database, studies.
    Info,
    /// Completion script for a shell.
    Completions {
        /// Shell to complete commands in.
        shell: Shell,
    },
    /// The manual page, as roff.
    Man,
}

impl Command {
    /// True if the command only tells what a database has, so that it makes no folder for one.
    pub fn only_tells(&self) -> bool {
        let is_telling =
            matches!(self, Self::Queue(_) | Self::Sql(_) | Self::Info | Self::Recommend(_) | Self::Section(_));
        is_telling || matches!(self, Self::Render(_) | Self::Export(_))
    }
}

/// Arguments of `lab`.
#[derive(Debug, Args)]
pub struct Lab {
    /// Experiments; by default all.
    #[arg(value_parser = sim::laboratory::bench::Experiment::ALL.map(sim::laboratory::bench::Experiment::as_str), value_name = "EXPERIMENT")]
    pub experiment: Vec<String>,
}

/// Arguments of `run`.
#[derive(Debug, Args)]
#[command(args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
pub struct Run {
    #[command(subcommand)]
    pub command: Option<RunCommand>,
    /// Folder of the study, or its study.toml.
    #[arg(required = true)]
    pub study: Option<PathBuf>,
    /// Simulations at once [default: number of cores].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub workers: Option<u16>,
    #[command(flatten)]
    pub part: StudyPart,
    #[command(flatten)]
    pub limits: JobLimits,
    /// Who works: threads of this process, or tasks of a Slurm cluster.
    #[arg(long, value_enum, default_value_t = Engine::Local)]
    pub engine: Engine,
    /// Folder that all nodes of the cluster see [default: slurm/STUDY beside the database].
    #[arg(long, value_name = "DIR")]
    pub slurm_dir: Option<PathBuf>,
    /// Option for sbatch, such as --time=10; may be given again.
    #[arg(long, value_name = "OPTION", allow_hyphen_values = true)]
    pub sbatch: Vec<String>,
    /// Say what would run and why; change nothing.
    #[arg(long)]
    pub dry_run: bool,
    /// Say of each job why it runs: which input changed.
    #[arg(long)]
    pub why: bool,
    /// Write no report.
    #[arg(long)]
    pub no_report: bool,
    /// The study of this name has moved here from another folder.
    #[arg(long)]
    pub moved: bool,
    /// Run in the background; a lost connection does not end it.
    #[arg(long, conflicts_with_all = ["dry_run", "attach"])]
    pub detach: bool,
    /// Follow a run that goes on elsewhere; leaving it does not end it.
    #[arg(long, conflicts_with_all = ["dry_run", "why"])]
    pub attach: bool,
}

/// Part of a study.
#[derive(Debug, Args)]
pub struct StudyPart {
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
}

/// What one job may take; over what the study file says.
#[derive(Debug, Args)]
pub struct JobLimits {
    /// End a simulation that takes longer; it has failed.
    #[arg(long, value_name = "SECONDS", value_parser = positive)]
    pub time_limit: Option<f64>,
    /// End a simulation that needs more memory; it has failed.
    #[arg(long, value_name = "MB", value_parser = clap::value_parser!(u32).range(50..))]
    pub memory_limit: Option<u32>,
}

/// A number above zero.
fn positive(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|number: &f64| number.is_finite() && *number > 0.0);
    number.ok_or_else(|| "not a number above 0".into())
}

/// Who works on jobs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Engine {
    /// Threads of this process.
    Local,
    /// Tasks of a Slurm cluster.
    Slurm,
}

/// Commands on stored runs.
#[derive(Debug, Subcommand)]
pub enum RunCommand {
    /// Everything that is stored of one run: where it was made, of what, and its numbers.
    Show {
        /// Number of the job (`toile queue ls`).
        job: i64,
    },
    /// Two runs side by side: inputs that differ, numbers, chi.
    Diff {
        /// Number of the one job.
        before: i64,
        /// Number of the other.
        after: i64,
    },
    /// Make a run again from its stored inputs, without the cache, and compare; exit code 3 when a bit differs.
    Rerun {
        /// Number of the job.
        job: i64,
    },
}

/// Commands on jobs as files, for any scheduler.
#[derive(Debug, Subcommand)]
pub enum Job {
    /// Queue a study and write a file for each job that is to be run.
    Handout {
        /// Folder of the study, or its study.toml.
        study: PathBuf,
        /// Folder to write to.
        #[arg(long, short, value_name = "DIR")]
        output: PathBuf,
        #[command(flatten)]
        part: StudyPart,
    },
    /// Run a job file within its limits, on any machine and without a database; its result lies beside it.
    Run {
        /// Job file to run.
        file: PathBuf,
        /// Result file to write.
        #[arg(long, short, value_name = "FILE")]
        output: Option<PathBuf>,
        /// Keep what the stages make in a database of this machine: so a run starts its jobs that have limits.
        #[arg(long, hide = true)]
        database: Option<PathBuf>,
    },
    /// Store results of job files: all of them or none; again changes nothing.
    Merge {
        /// Result files, or folders with them.
        #[arg(required = true)]
        results: Vec<PathBuf>,
    },
}

/// Arguments of `sql`.
#[derive(Debug, Args)]
#[command(group = clap::ArgGroup::new("source").required(true))]
pub struct Sql {
    /// The query, or the name of a saved one (--list).
    #[arg(group = "source")]
    pub query: Option<String>,
    /// List the saved queries: those of the program and of db/queries.
    #[arg(long, group = "source")]
    pub list: bool,
    /// A file with the query; - is standard input.
    #[arg(long, short, group = "source", value_name = "FILE")]
    pub file: Option<PathBuf>,
    /// How to print the rows; a file has the format of its ending.
    #[arg(long, value_enum)]
    pub format: Option<Format>,
    /// File to write to, in place of standard output: X.csv, X.json, X.parquet, X.xlsx, or X.txt for a table in columns.
    #[arg(long, short, value_name = "FILE")]
    pub output: Option<PathBuf>,
}

/// How rows are printed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// For reading: a table in columns.
    Table,
    /// For spreadsheets: CSV.
    Csv,
    /// For programs: JSON.
    Json,
    /// For data frames: a Parquet file.
    Parquet,
    /// For spreadsheets: a workbook.
    Xlsx,
}

/// Arguments of `audit`.
#[derive(Debug, Args)]
#[command(args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
pub struct Audit {
    #[command(subcommand)]
    pub command: Option<AuditCommand>,
    /// Name of the study, its folder, or its study.toml; `thesis-published` (or `thesis`, where there is no study of that
    /// name) audits the printed tables.
    #[arg(required = true)]
    pub study: Option<PathBuf>,
}

/// What else is audited.
#[derive(Debug, Subcommand)]
pub enum AuditCommand {
    /// Dress every body of a folder in every garment of another, by both simulators; say what drapes, and what not.
    ///
    /// It becomes a study in the folder of --output: run again, it goes on where it stopped.
    Garments(Box<AuditGarments>),
}

/// Arguments of `recommend`.
#[derive(Debug, Args)]
pub struct Recommend {
    /// Name of the study, its folder, or its study.toml; `thesis-published` for the thesis's printed tables.
    pub study: PathBuf,
    /// Give the reasons and the numbers behind them.
    #[arg(long)]
    pub explain: bool,
    /// Only this garment.
    #[arg(long, value_name = "NAME")]
    pub garment: Option<String>,
}

/// Side of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum View {
    /// From the front.
    Front,
    /// From the subject's right.
    Side,
    /// From behind the subject.
    Back,
    /// Between front and side.
    Quarter,
    /// From near, so that the cloth shows.
    CloseUp,
}

/// How far the garment of a picture has come.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Stage {
    /// Hybrid-GS: seams closed.
    Sewn,
    /// Hybrid-GS: popped up to the size of its pattern.
    Popup,
    /// At rest on the body.
    Drape,
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
    /// Pressure of the cloth on the body (FEM-GS).
    Pressure,
    /// Gap between cloth and body.
    Gap,
    /// chi of each measurement, where it is measured.
    Chi,
}

/// Arguments of `render`.
#[derive(Debug, Args)]
pub struct Render {
    /// Numbers of the jobs (`toile queue ls`); several come on one sheet, at one scale.
    #[arg(required = true, value_name = "JOB")]
    pub jobs: Vec<i64>,
    /// Side; several come on one sheet (front,side,back,quarter).
    #[arg(long, value_enum, value_delimiter = ',', default_values_t = [View::Front])]
    pub view: Vec<View>,
    /// How far the garment has come; several come on one sheet (popup,drape for before and after).
    #[arg(long, value_enum, value_delimiter = ',', default_values_t = [Stage::Drape], conflicts_with = "turntable")]
    pub stage: Vec<Stage>,
    /// Turned by this angle from the front towards the subject's right, degrees.
    #[arg(long, value_name = "DEG", conflicts_with = "view", allow_negative_numbers = true)]
    pub turn: Option<f64>,
    /// Turn once about the vertical: an animated PNG of so many pictures.
    #[arg(long, value_name = "PICTURES", conflicts_with_all = ["view", "turn"], value_parser = clap::value_parser!(u32).range(2..=360))]
    pub turntable: Option<u32>,
    /// Enlarge the garment, percent; at 100 it fills the picture.
    #[arg(long, value_name = "PCT", value_parser = clap::value_parser!(u32).range(10..=20000))]
    pub zoom: Option<u32>,
    /// How far the middle of an enlarged picture lies above the garment's, percent of half its height.
    #[arg(long, value_name = "PCT", default_value_t = 0, requires = "zoom", allow_negative_numbers = true, value_parser = clap::value_parser!(i32).range(-200..=200))]
    pub rise: i32,
    /// What colours the cloth.
    #[arg(long, value_enum, default_value_t = Map::Plain)]
    pub map: Map,
    /// Cut the garment, or one piece, from a cloth: fabric, plain, twill, jersey, rib, check, or an image file. MM is one
    /// repeat; without it yarns have their true size and an image comes once on each piece.
    #[arg(long, value_name = "[PIECE=]WHAT[#RRGGBB][@MM]")]
    pub cloth: Vec<String>,
    /// Colour of the skin, like #dcb094; a dress form without.
    #[arg(long, value_name = "#RRGGBB")]
    pub skin: Option<String>,
    /// Width of the picture, pixels.
    #[arg(long, default_value_t = 800, value_name = "PIXELS", value_parser = clap::value_parser!(u32).range(16..=8192))]
    pub width: u32,
    /// Height of the picture, pixels.
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
    /// Stereolithography: one mesh, coloured by triangle.
    Stl,
}

/// Arguments of `export`.
#[derive(Debug, Args)]
pub struct Export {
    /// Number of the job (`toile queue ls`).
    pub job: i64,
    /// Format of the file, where its name has no ending.
    #[arg(long, value_enum)]
    pub format: Option<MeshFormat>,
    /// What colours the vertices.
    #[arg(long, value_enum, default_value_t = Map::Plain)]
    pub map: Map,
    /// File to write: X.glb, X.obj, X.ply or X.stl.
    #[arg(long, short, value_name = "FILE")]
    pub output: PathBuf,
}

/// Jobs by number, or a group of them: all of a study, or of a part of it.
#[derive(Debug, Args)]
#[command(group = clap::ArgGroup::new("which").required(true).multiple(true))]
pub struct Jobs {
    /// Numbers of the jobs.
    #[arg(group = "which")]
    pub jobs: Vec<i64>,
    /// All jobs of a study.
    #[arg(long, group = "which", value_name = "NAME")]
    pub study: Option<String>,
    #[command(flatten)]
    pub part: StudyPart,
}

/// Commands on the queue.
#[derive(Debug, Subcommand)]
pub enum Queue {
    /// List jobs with their states.
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
    /// Queue failed or cancelled jobs again, and those they wait for.
    Retry(Jobs),
    /// Set the priority of jobs: greater runs earlier, 0 is that of most.
    Priority {
        /// Priority that the jobs get.
        #[arg(long, value_name = "N", allow_negative_numbers = true)]
        to: i64,
        #[command(flatten)]
        jobs: Jobs,
    },
    /// A job's log.
    Log {
        /// Number of the job.
        job: i64,
    },
}

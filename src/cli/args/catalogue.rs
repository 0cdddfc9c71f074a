//! Arguments of `toile subject`, `style`, `size` and `fabric`.

use std::path::PathBuf;

use clap::{Arg, ArgMatches, Args, Command, FromArgMatches, Subcommand};

use super::measured::{flag, given};
use super::{MeshUnit, PatternUnit, SewStep, StyleSpec};
use spec::{FABRIC_NUMBERS, Field, Given, MEASUREMENTS};

/// Commands on one part of the catalogue.
#[derive(Debug, Subcommand)]
pub enum Catalogue<V: Args> {
    /// List the current revisions.
    Ls {
        /// Also those that were removed and stay because results use them.
        #[arg(long)]
        all: bool,
    },
    /// One entry with all its revisions.
    Show {
        /// Name; of a size STYLE/SIZE.
        name: String,
    },
    /// Add an entry.
    Add {
        /// Name; of a size STYLE/SIZE.
        name: String,
        #[command(flatten)]
        values: V,
    },
    /// Change an entry: what is given makes a new revision, results keep theirs.
    Edit {
        /// Name; of a size STYLE/SIZE.
        name: String,
        #[command(flatten)]
        values: V,
    },
    /// Add or change all entries of files, or none if anything is wrong with one.
    Import {
        /// Take the rows of CSV files that are right, and tell what is wrong with the others; exit code 3 where any is left out.
        #[arg(long)]
        good_rows: bool,
        /// TOML files with the tables of a study.toml; of subjects and fabrics also CSV, a column a key.
        #[arg(required = true)]
        files: Vec<PathBuf>,
    },
    /// Remove entries; those that results use are hidden and stay stored.
    Rm {
        /// Names; of sizes STYLE/SIZE.
        #[arg(required = true)]
        names: Vec<String>,
    },
}

/// Commands on styles.
#[derive(Debug, Subcommand)]
pub enum StyleCommand {
    /// Commands as on any part of the catalogue.
    #[command(flatten)]
    Of(Catalogue<StyleValues>),
    /// Work on the seams of a style: confirm, answer, add, open or turn seams, leave out. Makes a new revision.
    Sew {
        /// Style, or STYLE/SIZE whose pieces are worked on.
        name: String,
        /// What is done.
        #[command(subcommand)]
        step: SewStep,
    },
    /// The buyer's specification sheet of a style: keep it, answer what is asked about its rows, show it beside the pattern.
    Spec(StyleSpec),
}

/// Values of a subject, by key.
#[derive(Debug)]
pub struct SubjectValues(pub Vec<Given>);

/// Who a subject is: values, or a scan.
#[derive(Debug, Args)]
pub struct PersonValues {
    #[command(flatten)]
    pub values: SubjectValues,
    /// Scan (OBJ, PLY, STL, GLB) that is the body; it is measured, and kept in the database.
    #[arg(long, value_name = "FILE")]
    pub scan: Option<PathBuf>,
    /// Unit of the scan; by default told from its height.
    #[arg(long, value_enum, requires = "scan")]
    pub unit: Option<MeshUnit>,
}

/// Values of a fabric, by key.
#[derive(Debug)]
pub struct FabricValues {
    /// Fabric to start from.
    pub like: Option<String>,
    /// Values as they were given, each with its key.
    pub given: Vec<Given>,
}

/// Files of a style.
#[derive(Debug, Args)]
pub struct StyleValues {
    /// Seam file; GarmentCode JSON needs none.
    #[arg(long, value_name = "FILE")]
    pub seams: Option<PathBuf>,
    /// Propose the seams of a new style that has none, on its sample size and held to the others.
    #[arg(long, conflicts_with = "seams")]
    pub propose: bool,
    /// Patterns (DXF, GarmentCode JSON); without SIZE= all sizes that a file names.
    #[arg(long = "pattern", value_name = "[SIZE=]FILE", num_args = 1..)]
    pub patterns: Vec<String>,
    /// Unit of the patterns, where they name none.
    #[arg(long, value_enum)]
    pub unit: Option<PatternUnit>,
}

/// Pattern of a size.
#[derive(Debug, Args)]
pub struct SizeValues {
    /// Pattern file of the size.
    #[arg(long, value_name = "FILE")]
    pub pattern: Option<PathBuf>,
    /// Unit of the pattern, where it names none.
    #[arg(long, value_enum)]
    pub unit: Option<PatternUnit>,
}

/// A flag for every number of an entry.
fn flags<T>(command: Command, fields: &'static [Field<T>]) -> Command {
    let heading = "Values (an empty one takes a value away)";
    command.args(fields.iter().map(|field| flag(field, field.label).help_heading(heading)))
}

impl FromArgMatches for SubjectValues {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let keys = std::iter::once("sex").chain(MEASUREMENTS.iter().map(|field| field.key));
        Ok(Self(given(matches, keys)))
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

impl Args for SubjectValues {
    fn augment_args(command: Command) -> Command {
        let sex = Arg::new("sex").long("sex").value_name("m|f").help("Sex");
        flags(command.arg(sex), &MEASUREMENTS)
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl FromArgMatches for FabricValues {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let keys = std::iter::once("source").chain(FABRIC_NUMBERS.iter().map(|field| field.key));
        Ok(Self { like: matches.get_one::<String>("like").cloned(), given: given(matches, keys) })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

impl Args for FabricValues {
    fn augment_args(command: Command) -> Command {
        let like = Arg::new("like").long("like").value_name("FABRIC").help("Fabric whose numbers to start from");
        let source = Arg::new("source").long("source").value_name("TEXT").help("Where the numbers are from");
        flags(command.arg(like).arg(source), &FABRIC_NUMBERS)
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

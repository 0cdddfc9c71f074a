//! Arguments of `toile study`.

use std::path::PathBuf;

use clap::{Args, Subcommand, ValueEnum};

use super::{DraftStyle, PatternUnit, Sex, SubjectValues, TrySimulator};
use engine::NewOutfit;

/// A study by its folder, file or name.
#[derive(Debug, Args)]
pub struct StudyPath {
    /// Folder of the study, or its study.toml.
    pub study: PathBuf,
}

/// How a garment is meant to sit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum IntendedFit {
    /// Smaller than the body, of cloth that stretches.
    Compression,
    /// Close to the body.
    Slim,
    /// With room to move.
    Regular,
    /// Away from the body.
    Loose,
}

impl From<IntendedFit> for fit::target::Intended {
    fn from(fit: IntendedFit) -> Self {
        match fit {
            IntendedFit::Compression => Self::Compression,
            IntendedFit::Slim => Self::Slim,
            IntendedFit::Regular => Self::Regular,
            IntendedFit::Loose => Self::Loose,
        }
    }
}

/// Commands on study files.
#[derive(Debug, Subcommand)]
pub enum StudyCommand {
    /// Start a study: a folder with a study.toml that says what may be in it, and drafted patterns, what the catalogue has, or
    /// patterns of your own.
    New {
        /// Folder to make. In a project a bare name is one in its folder `studies`, as in the workbench.
        folder: PathBuf,
        /// Style to draft.
        #[arg(long, value_enum, default_value_t = DraftStyle::Tshirt, conflicts_with_all = ["wear", "subject", "patterns"])]
        style: DraftStyle,
        /// Sizes of the catalogue, or of drafted styles, that it wears; its jobs are queued. May be given several times.
        #[arg(long, value_name = "STYLE/SIZE", requires = "subject")]
        wear: Vec<String>,
        /// Styles worn over each other, the inner first; may be given several times.
        #[arg(long, value_name = "NAME=STYLE,STYLE", requires = "subject")]
        outfit: Vec<NewOutfit>,
        /// Who of the catalogue wears them; may be given several times.
        #[arg(long, value_name = "NAME")]
        subject: Vec<String>,
        /// Patterns of your own (DXF, GarmentCode JSON), all sizes of which are worn: they become a style of the catalogue, called as the
        /// first file; a style of the same files is taken as it is. Its seams are proposed where there is no --seams.
        #[arg(long = "pattern", value_name = "[SIZE=]FILE", num_args = 1.., requires = "subject")]
        patterns: Vec<String>,
        /// Name of their style, instead of that of the first file.
        #[arg(long = "as", value_name = "NAME", requires = "patterns")]
        style_name: Option<String>,
        /// Seam file of those patterns.
        #[arg(long, value_name = "FILE", requires = "patterns")]
        seams: Option<PathBuf>,
        /// Unit of those patterns, where they name none.
        #[arg(long, value_enum, requires = "patterns")]
        unit: Option<PatternUnit>,
        /// Fabric of the catalogue.
        #[arg(long, value_name = "NAME", default_value = sim::fabric::USUAL)]
        fabric: String,
        /// Simulators; may be given twice.
        #[arg(long, value_enum, default_values_t = [TrySimulator::Fem, TrySimulator::Hybrid])]
        sim: Vec<TrySimulator>,
        /// How the garments are meant to sit; regular where it is not said.
        #[arg(long, value_enum)]
        fit: Option<IntendedFit>,
    },
    /// Check a study file and everything it names: every problem at once, with its line.
    Check(StudyPath),
    /// Print [[subject]] tables of people who stand for a population, drawn from a published survey [Gordon 2014].
    Population {
        /// How many of each sex; more than 500 are people as they are drawn.
        #[arg(long, default_value_t = 50, value_parser = clap::value_parser!(u32).range(1..=100_000))]
        bodies: u32,
        /// Only of this sex.
        #[arg(long, value_enum)]
        sex: Option<Sex>,
        /// People drawn of each sex, of whom up to 500 are chosen.
        #[arg(long, default_value_t = 5000, value_parser = clap::value_parser!(u32).range(100..=100_000))]
        people: u32,
        /// Seed of the draw.
        #[arg(long, default_value_t = 1)]
        seed: u64,
    },
    /// Draw which size fits whom: an SVG picture of all subjects of a study.
    Sizes {
        /// Name of the study, its folder, or its study.toml.
        study: PathBuf,
        /// SVG file to write.
        #[arg(long, short, value_name = "FILE")]
        output: PathBuf,
    },
    /// Who of a study is most like somebody, and the results there are of them already.
    Nearest {
        /// Name of the study, its folder, or its study.toml.
        study: PathBuf,
        #[command(flatten)]
        subject: SubjectValues,
    },
    /// Write a folder that reproduces a study elsewhere: what it takes from the catalogue is in it.
    Export {
        /// Folder of the study, or its study.toml.
        study: PathBuf,
        /// Folder to write to.
        #[arg(long, short, value_name = "DIR")]
        output: PathBuf,
    },
}

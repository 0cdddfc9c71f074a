//! Arguments of `comment`.

use std::path::PathBuf;

use clap::{Args, Subcommand, ValueEnum};
use store::comments;

/// Commands of `comment`.
#[derive(Debug, Subcommand)]
pub enum Comment {
    /// Comments of a study, with the rounds that asked and met them.
    Ls(Fittings),
    /// Begin the next round: what was measured is commented, and what is measured no more is met.
    Round(Fittings),
    /// Add a comment of your own to the last round.
    Add {
        #[command(flatten)]
        fitting: Fittings,
        /// Where it is seen: `front:hip`, `side:hem`, `back:neck`.
        #[arg(long, value_name = "SIDE:PLACE", value_parser = at)]
        at: (comments::Side, String),
        /// The comment.
        text: String,
        /// How grave it is.
        #[arg(long, value_enum, default_value_t = Severity::Minor)]
        severity: Severity,
        /// What is to be done.
        #[arg(long, value_name = "TEXT", default_value = "")]
        action: String,
    },
    /// Change a comment: close it, give it to somebody, word it anew.
    Set {
        #[command(flatten)]
        fitting: Fittings,
        /// Number of the comment.
        number: i64,
        /// Open it again, or close it.
        #[arg(long, value_enum)]
        status: Option<Status>,
        /// How grave it is.
        #[arg(long, value_enum)]
        severity: Option<Severity>,
        /// Other words.
        #[arg(long, value_name = "TEXT")]
        text: Option<String>,
        /// What is to be done.
        #[arg(long, value_name = "TEXT")]
        action: Option<String>,
        /// Who is to do it.
        #[arg(long, value_name = "NAME")]
        owner: Option<String>,
    },
    /// Sign the last round off.
    Sign {
        #[command(flatten)]
        fitting: Fittings,
        /// Who signs.
        #[arg(long, value_name = "NAME")]
        by: String,
    },
}

/// Garments on subjects of a study.
#[derive(Debug, Args)]
pub struct Fittings {
    /// Folder of the study, its study.toml, or its name.
    pub study: PathBuf,
    /// Garment; where one is meant, it may be left out of a study with one.
    #[arg(long, value_name = "NAME")]
    pub garment: Option<String>,
    /// Subject; where one is meant, it may be left out of a study with one.
    #[arg(long, value_name = "ID")]
    pub subject: Option<String>,
}

/// Weight of a comment.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Severity {
    /// May stay.
    Minor,
    /// To be mended before the next round.
    Major,
    /// The garment cannot be worn.
    Critical,
}

impl From<Severity> for comments::Severity {
    fn from(severity: Severity) -> Self {
        match severity {
            Severity::Minor => Self::Minor,
            Severity::Major => Self::Major,
            Severity::Critical => Self::Critical,
        }
    }
}

/// State to which a comment is set.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Status {
    /// To be done.
    Open,
    /// Done, or given up.
    Closed,
}

impl From<Status> for comments::State {
    fn from(status: Status) -> Self {
        match status {
            Status::Open => Self::Open,
            Status::Closed => Self::Closed,
        }
    }
}

/// Reads `front:hip`.
fn at(text: &str) -> Result<(comments::Side, String), String> {
    let found = text.split_once(':').and_then(|(side, place)| Some((comments::Side::named(side)?, place.trim())));
    let (side, place) = found
        .filter(|(_, place)| !place.is_empty())
        .ok_or_else(|| format!("found `{text}`; accepted: front:PLACE, side:PLACE, back:PLACE"))?;
    Ok((side, place.to_owned()))
}

//! The command line. Data goes to standard output, messages and progress to standard error. The exit code says how the
//! command ended.
//!
//! Arguments are parsed (`args`) and resolved (`context`) once. Each command is one function, which calls the crates
//! below this one.

mod alter;
mod answers;
mod args;
mod attempt;
mod body;
mod catalogue;
mod chance;
mod comment;
mod context;
mod detached;
mod fit;
mod grade;
mod health;
mod jobs;
mod lab;
mod output;
mod parquet;
mod pattern;
mod pattern_files;
mod pictures;
mod progress;
mod questions;
mod queue;
mod recommend;
mod run;
mod runs;
mod section;
mod sew;
mod spec_sheet;
mod spec_workbook;
mod studies;
#[cfg(test)]
mod tests;
mod wardrobe;
mod xlsx;

use std::error::Error;
use std::ffi::OsString;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::{CommandFactory, FromArgMatches};

use args::{Arguments, Command};
use context::Context;
use store::StudyError;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum End {
    Done = 0,
    /// The arguments or the input cannot be used.
    Unusable = 2,
    /// A check or tolerance failed.
    CheckFailed = 3,
    JobFailed = 4,
    /// A signal such as Ctrl-C ended the command.
    Interrupted = 130,
}

#[derive(Debug, thiserror::Error)]
enum CliError {
    #[error(transparent)]
    Study(#[from] StudyError),
    #[error("standard output: {0}")]
    Output(#[from] std::io::Error),
    #[error("{0}")]
    Usage(String),
}

impl CliError {
    fn end(&self) -> End {
        match self {
            Self::Study(StudyError::Interrupted) => End::Interrupted,
            _ => End::Unusable,
        }
    }
}

type Outcome = Result<End, CliError>;

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Workbench {
    pub database: PathBuf,
    /// True where the database was named by the user, so that commands shown must name it too.
    pub is_database_named: bool,
    pub readonly: bool,
    pub no_color: bool,
    /// Display of pictures: `auto`, `halfblocks` or `off`.
    pub images: String,
    /// Study that comes with the program. It need not be written yet.
    pub quickstart: PathBuf,
}

/// Makers of files that need all rows at once, by their endings.
pub const ENCODERS: [store::Encoder; 2] =
    [("parquet", |table| Ok(parquet::bytes(table))), ("xlsx", |table| xlsx::bytes(&[("rows", table)]))];

/// The possible values of an argument follow its help in the same line, so that a command's help fits a screen.
pub fn command() -> clap::Command {
    compact(Arguments::command()).disable_help_subcommand(false)
}

fn compact(command: clap::Command) -> clap::Command {
    with_remarks_last(command).disable_help_subcommand(true).mut_args(with_values_in_line).mut_subcommands(compact)
}

/// Moves a command's long help, after its summary, below its arguments.
fn with_remarks_last(command: clap::Command) -> clap::Command {
    let [summary, whole] = [command.get_about(), command.get_long_about()].map(|text| text.map(ToString::to_string));
    let Some((summary, whole)) = summary.zip(whole) else { return command };
    let remarks = whole.strip_prefix(&summary).unwrap_or(&whole).trim_start_matches('.').trim_start().to_owned();
    command.long_about(None::<&str>).after_help(remarks)
}

fn with_values_in_line(argument: clap::Arg) -> clap::Arg {
    let values = argument.get_possible_values();
    let names: Vec<&str> = values.iter().filter(|value| !value.is_hide_set()).map(|value| value.get_name()).collect();
    let Some(help) = argument.get_help().filter(|_| !names.is_empty() && argument.get_action().takes_values()) else {
        return argument;
    };
    let help = format!("{help} [possible values: {}]", names.join(", "));
    argument.help(help).hide_possible_values(true)
}

/// First of the arguments is the program's own name.
fn read(arguments: &[OsString]) -> Result<Arguments, clap::Error> {
    Arguments::from_arg_matches_mut(&mut command().try_get_matches_from(arguments)?)
}

/// Runs the program with its arguments, of which the first is its own name. Without a command it calls `workbench`,
/// since this crate does not know the workbench; a study that this returns is run in the background then.
pub fn main(
    arguments: impl IntoIterator<Item = OsString>,
    workbench: impl FnOnce(Workbench) -> Result<Option<PathBuf>, Box<dyn Error>>,
) -> ExitCode {
    let arguments: Vec<OsString> = arguments.into_iter().collect();
    let arguments = match read(&arguments) {
        Ok(arguments) => arguments,
        Err(error) => {
            let error = args::without_environment(command(), error, &arguments);
            // Prints help and version on standard output, errors on standard error. A stream that cannot be written is
            // ignored.
            let _ = error.print();
            return ExitCode::from(if error.use_stderr() { End::Unusable as u8 } else { End::Done as u8 });
        }
    };
    let end = execute(arguments, workbench).unwrap_or_else(|error| {
        output::tell(&error);
        error.end()
    });
    ExitCode::from(end as u8)
}

fn execute(
    arguments: Arguments,
    workbench: impl FnOnce(Workbench) -> Result<Option<PathBuf>, Box<dyn Error>>,
) -> Outcome {
    let context = Context::new(arguments.global)?;
    if arguments.command.as_ref().is_some_and(Command::only_tells) {
        context.must_have_folder()?;
    }
    match arguments.command {
        None => {
            let quickstart = context::quickstart(&context.db);
            let left = workbench(Workbench {
                database: context.db.clone(),
                is_database_named: context.is_db_named,
                readonly: context.readonly,
                no_color: !context.colour,
                images: arguments.images,
                quickstart,
            })
            .map_err(|error| CliError::Usage(error.to_string()))?;
            match left {
                None => Ok(End::Done),
                Some(study) => detached::go_on(&context, &study),
            }
        }
        Some(Command::Run(arguments)) => run::run(&context, &arguments),
        Some(Command::Try(arguments)) => attempt::run(&context, &arguments),
        Some(Command::Report(arguments)) => pictures::report(&context, &arguments),
        Some(Command::Sql(arguments)) => answers::sql(&context, &arguments),
        Some(Command::Audit(arguments)) => answers::audit(&context, &arguments),
        Some(Command::Ease(arguments)) => answers::ease(&context, &arguments),
        Some(Command::Alter(arguments)) => alter::alter(&context, &arguments),
        Some(Command::Grade(arguments)) => grade::grade(&context, &arguments),
        Some(Command::Chance(arguments)) => chance::chance(&context, &arguments),
        Some(Command::Fit(arguments)) => fit::fit(&context, &arguments),
        Some(Command::Comment(command)) => comment::comment(&context, &command),
        Some(Command::Section(arguments)) => section::section(&context, &arguments),
        Some(Command::Recommend(arguments)) => recommend::recommend(&context, &arguments),
        Some(Command::Pattern(command)) => pattern::run(&context, &command),
        Some(Command::Body(command)) => body::run(&context, &command),
        Some(Command::Render(arguments)) => pictures::render(&context, &arguments),
        Some(Command::Export(arguments)) => pictures::export(&context, &arguments),
        Some(Command::Queue(command)) => queue::run(&context, &command),
        Some(Command::Study(command)) => studies::run(&context, &command),
        Some(Command::Job(command)) => jobs::run(&context, &command),
        Some(Command::Subject(command)) => catalogue::run(&context, command),
        Some(Command::Style(command)) => catalogue::style(&context, command),
        Some(Command::Size(command)) => catalogue::run(&context, command),
        Some(Command::Fabric(command)) => catalogue::run(&context, command),
        Some(Command::Lab(arguments)) => lab::lab(&context, &arguments),
        Some(Command::Doctor) => health::doctor(&context),
        Some(Command::Info) => health::info(&context),
        Some(Command::Completions { shell }) => {
            let mut script = Vec::new();
            clap_complete::generate(shell, &mut command(), "toile", &mut script);
            output::text(&String::from_utf8_lossy(&script))?;
            Ok(End::Done)
        }
        Some(Command::Man) => {
            let mut page = Vec::new();
            clap_mangen::Man::new(command()).render(&mut page)?;
            output::text(&String::from_utf8_lossy(&page))?;
            Ok(End::Done)
        }
    }
}

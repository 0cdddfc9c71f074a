//! Measurements as flags, one for each key.

use clap::{Arg, ArgMatches, Args, Command, FromArgMatches};

use spec::bodies::Dimension;
use spec::{Field, Given, MEASUREMENTS};

/// Measurements of a body, by key.
#[derive(Debug)]
pub struct MeasuredValues(pub Vec<Given>);

/// The flag of a number.
pub(super) fn flag<T>(field: &Field<T>, help: &'static str) -> Arg {
    Arg::new(field.key).long(field.flag()).value_name("N").help(help).allow_hyphen_values(true)
}

/// Values that were given, each with its key.
pub(super) fn given(matches: &ArgMatches, keys: impl Iterator<Item = &'static str>) -> Vec<Given> {
    keys.filter_map(|key| Some((key.to_owned(), matches.get_one::<String>(key)?.clone()))).collect()
}

impl FromArgMatches for MeasuredValues {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        Ok(Self(given(matches, MEASUREMENTS.iter().map(|field| field.key))))
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

impl Args for MeasuredValues {
    fn augment_args(command: Command) -> Command {
        command.args(MEASUREMENTS.iter().zip(Dimension::ALL).map(|(field, dimension)| flag(field, dimension.words())))
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

//! `toile lab`: experiments of the laboratory, with their known answers.

use super::args::Lab;
use super::context::Context;
use super::{End, Outcome};
use sim::laboratory::bench::Experiment;
use store::{InOrigin, Origin, Table, Value};

pub fn lab(context: &Context, arguments: &Lab) -> Outcome {
    let is_asked = |experiment: &Experiment| {
        arguments.experiment.is_empty() || arguments.experiment.iter().any(|name| name == experiment.as_str())
    };
    let mut rows = Vec::new();
    for experiment in Experiment::ALL.into_iter().filter(is_asked) {
        context.say(format_args!("{}: {}", experiment.as_str(), experiment.about()));
        for finding in experiment.run().origin(Origin::Sim)? {
            let (error, unit) = finding.error();
            rows.push(vec![
                Value::Text(experiment.as_str().to_owned()),
                Value::Text(finding.case),
                Value::Text(finding.quantity.to_owned()),
                Value::Real(finding.known),
                Value::Real(finding.found),
                Value::Real(error),
                Value::Text(unit.to_owned()),
                Value::Text(finding.source),
            ]);
        }
    }
    let columns = ["experiment", "case", "quantity", "known", "found", "error", "of", "source"];
    context.print(&Table::new(columns, rows))?;
    Ok(End::Done)
}

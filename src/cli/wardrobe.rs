//! `toile audit garments`: every garment of a folder on every body of another.

use serde_json::json;

use super::args::AuditGarments;
use super::context::Context;
use super::{CliError, End, Outcome, output, run};
use engine::RunOptions;
use geom::units::from_mm;
use results::{Dressed, Tally, dressed, tally};
use spec::Limits;
use spec::patterns::Unit;
use store::{Table, Value, files};
use wardrobe::{Opened, Wardrobe};

const DOCUMENT: &str = "audit.json";

/// Exit code 3 if a drape has a fault.
pub fn audit(context: &Context, arguments: &AuditGarments) -> Outcome {
    let folder = &arguments.output;
    output::folder(folder, &["toml", "json"])?;
    let wardrobe = wardrobe(arguments)?;
    let Opened { files, refused } = wardrobe.open()?;
    files::make_folder(folder)?;
    files::write_files(folder, &files)?;
    for (path, why) in &refused {
        output::tell(&format!("{}: left out: {why}", path.display()));
    }
    let mut store = context.store()?;
    let mut study = context.study(&store, folder)?;
    study.limit(Limits { time_s: arguments.limits.time_limit, memory_mb: arguments.limits.memory_limit });
    let options = RunOptions { workers: arguments.workers.map(usize::from), ..RunOptions::default() };
    let interrupted = run::work(context, &mut store, &study, &options, false)?;
    let all = dressed::dressed(&store, &study.name)?;
    let tallies = tally(&all);
    let refused: Vec<_> =
        refused.iter().map(|(path, why)| json!({ "file": path.to_string_lossy(), "why": why })).collect();
    let document = json!({ "study": study.name, "simulators": tallies, "jobs": all, "left_out": refused });
    let text = serde_json::to_vec_pretty(&document).map_err(std::io::Error::from)?;
    files::write_files(folder, &[(DOCUMENT.to_owned(), text)])?;
    if context.json {
        output::json(&document)?;
    } else {
        context.print(&jobs_table(&all))?;
        context.print(&tally_table(&tallies))?;
    }
    context.say(format_args!("wrote {}", folder.join(DOCUMENT).display()));
    if interrupted {
        context.say("interrupted; the same command goes on where this stopped");
        return Ok(End::Interrupted);
    }
    Ok(if all.iter().any(|job| !job.faults.is_empty()) { End::CheckFailed } else { End::Done })
}

fn wardrobe(arguments: &AuditGarments) -> Result<Wardrobe, CliError> {
    let name = arguments.output.file_name().ok_or_else(|| CliError::Usage("--output names no folder".into()))?;
    Ok(Wardrobe {
        name: name.to_string_lossy().into_owned(),
        garments: arguments.garments.clone(),
        bodies: arguments.bodies.clone(),
        pairs: arguments.pairs.clone(),
        unit: arguments.unit.map(Unit::from),
        allowance_m: from_mm(arguments.allowance_mm),
        fabric: arguments.fabric.clone(),
        simulators: arguments.sim.iter().map(|sim| (*sim).into()).collect(),
    })
}

fn jobs_table(all: &[Dressed]) -> Table {
    let columns = ["garment", "body", "sim", "outcome", "inside mm", "short mm", "EI", "vertices", "s"];
    let row = |job: &Dressed| {
        let text = |text: &str| Value::Text(text.to_owned());
        vec![
            text(&job.garment),
            text(&job.subject),
            text(&job.simulator),
            Value::Text(outcome(job)),
            real(job.inside_mm, 1),
            real(job.shortfall_mm, 0),
            real(job.ei, 4),
            job.vertices.map_or(Value::Null, Value::Integer),
            real(job.wall_ms.map(|ms| ms as f64 / 1e3), 1),
        ]
    };
    Table::new(columns, all.iter().map(row))
}

/// Null for `None`.
fn real(number: Option<f64>, decimals: i32) -> Value {
    let scale = 10_f64.powi(decimals);
    number.map_or(Value::Null, |number| Value::Real((number * scale).round() / scale))
}

fn outcome(job: &Dressed) -> String {
    match (&job.refused, &job.faults[..]) {
        (Some(why), _) => format!("refused: {why}"),
        (None, []) if job.ei.is_some() => "good".to_owned(),
        (None, []) => job.status.as_str().to_owned(),
        (None, faults) => faults.join("; "),
    }
}

fn tally_table(tallies: &[Tally]) -> Table {
    let columns = ["sim", "ended", "good", "at fault", "refused", "mean EI", "median s", "slowest s"];
    let count = |n: usize| Value::Integer(n as i64);
    let row = |tally: &Tally| {
        vec![
            Value::Text(tally.simulator.clone()),
            count(tally.ended),
            count(tally.good),
            count(tally.faulty),
            count(tally.refused),
            real(tally.mean_ei, 4),
            real(tally.median_s, 1),
            real(tally.slowest_s, 1),
        ]
    };
    Table::new(columns, tallies.iter().map(row))
}

//! `toile try`: a garment, or an outfit, on one body.

use std::path::PathBuf;

use super::args::Try;
use super::context::Context;
use super::output::tenths;
use super::{CliError, End, Outcome, body, output};
use engine::{Attempt, AttemptLayer, Reached, ReachedAt, ReachedOpening, Tried};
use geom::units::from_mm;
use spec::patterns::Unit;
use store::{Table, Value, files};

/// Argument that means no value.
const NONE: &str = "-";

/// Runs `toile try`: writes pictures and meshes, and prints measurements.
pub fn run(context: &Context, arguments: &Try) -> Outcome {
    let asked = Attempt {
        body: arguments.body.body.clone(),
        body_unit: arguments.body.body_unit.map(Into::into),
        sex: arguments.body.sex.map(body::sex_of),
        layers: layers(arguments)?,
        unit: arguments.unit.map(Unit::from),
        allowance_m: from_mm(arguments.allowance_mm),
        answers: arguments.answer.clone(),
        simulator: arguments.sim.into(),
        edge_length_m: from_mm(arguments.edge_mm),
        repeat: arguments.repeat,
        pose: arguments.pose,
        reach: arguments.reach,
    };
    output::folder(&arguments.output, &["png", "glb", "obj"])?;
    files::make_folder(&arguments.output)?;
    let mut phase_before = String::new();
    let all = engine::attempt(&asked, &mut |phase, share| {
        if phase != phase_before {
            context.say(format_args!("{phase}, {:.0} %", 100.0 * share));
            phase.clone_into(&mut phase_before);
        }
    })?;
    for tried in &all {
        let whose = |said: &str| if all.len() > 1 { format!("{}: {said}", tried.garment) } else { said.to_owned() };
        context.write_files(&arguments.output, &tried.files)?;
        tried.notes.iter().for_each(|note| context.say(whose(note)));
        tried.problems.iter().for_each(|problem| output::tell(&whose(problem)));
    }
    match &all[..] {
        [tried] if context.json => output::json(tried)?,
        _ if context.json => output::json(&all)?,
        _ => all.iter().try_for_each(|tried| show(context, tried))?,
    }
    let is_good = all.iter().all(|tried| tried.problems.is_empty());
    Ok(if is_good { End::Done } else { End::CheckFailed })
}

/// Garments of the arguments, the inmost first. A flag that is given once applies to all.
fn layers(arguments: &Try) -> Result<Vec<AttemptLayer>, CliError> {
    let count = arguments.pattern.len();
    let of_each = |flag: &str, given: &[String]| match given.len() {
        0 => Ok(vec![None; count]),
        1 => Ok(vec![Some(given[0].clone()); count]),
        n if n == count => Ok(given.iter().map(|value| (value != NONE).then(|| value.clone())).collect()),
        n => Err(CliError::Usage(format!(
            "{n} times {flag} for {count} patterns; accepted: one of each pattern, in their order ({NONE} for none)"
        ))),
    };
    let seams = match &arguments.seams[..] {
        [_] if count > 1 => Err(CliError::Usage(format!(
            "one --seams for {count} patterns; accepted: one of each pattern, in their order ({NONE} for none)"
        ))),
        given => of_each("--seams", given),
    }?;
    let (sizes, fabrics) = (of_each("--size", &arguments.size)?, of_each("--fabric", &arguments.fabric)?);
    let layer = |(number, pattern): (usize, &PathBuf)| AttemptLayer {
        pattern: pattern.clone(),
        seams: seams[number].as_ref().map(PathBuf::from),
        size: sizes[number].clone(),
        fabric: fabrics[number].clone().unwrap_or_else(|| sim::fabric::USUAL.to_owned()),
    };
    Ok(arguments.pattern.iter().enumerate().map(layer).collect())
}

/// Prints the measurements of the last stage, the girths that the garment lacks, and the summary.
fn show(context: &Context, tried: &Tried) -> Result<(), CliError> {
    let mut columns = ["no", "measurement", "free", "l2d_mm", "l3d_mm", "chi"].map(str::to_owned).to_vec();
    if tried.chi_spread_max.is_some() {
        columns.push("chi_spread".to_owned());
    }
    let last = tried.chi.last().map(|row| row.stage);
    let rows = tried.chi.iter().filter(|row| Some(row.stage) == last).map(|row| {
        let mut cells = vec![
            Value::Integer(i64::from(row.measurement_no)),
            Value::Text(row.measurement.clone()),
            Value::Text(if row.is_free_edge { "yes" } else { "" }.to_owned()),
            tenths(row.l2d_mm),
            tenths(row.l3d_mm),
            Value::Real((row.chi * 1e4).round() / 1e4),
        ];
        cells.extend(row.chi_spread.map(|spread| Value::Real((spread * 1e4).round() / 1e4)));
        cells
    });
    context.print(&Table { columns, rows: rows.collect() })?;
    if !tried.gap.is_empty() {
        let columns = ["level", "body_girth_mm", "garment_girth_mm", "shortfall_mm"];
        let rows = tried.gap.iter().map(|gap| {
            let girths = [gap.body_girth_mm, gap.garment_girth_mm, gap.shortfall_mm].map(tenths);
            [Value::Text(gap.level.clone())].into_iter().chain(girths).collect()
        });
        context.print(&Table::new(columns, rows))?;
    }
    if let Some(reach) = &tried.reach {
        show_reach(context, reach)?;
    }
    let columns = ["n", "e_chi", "sd_chi", "ei", "residual", "penetration_mm", "crossings", "vertices", "wall_ms"];
    let row = vec![
        Value::Integer(tried.errors.n as i64),
        Value::Real(tried.errors.e_chi),
        Value::Real(tried.errors.sd_chi),
        Value::Real(tried.errors.ei),
        Value::Real(tried.cloth.residual),
        Value::Real(tried.cloth.penetration_max_mm),
        Value::Integer(tried.cloth.self_crossings as i64),
        Value::Integer(tried.cloth.vertices as i64),
        Value::Integer(i64::try_from(tried.wall_ms).unwrap_or(i64::MAX)),
    ];
    context.print(&Table::new(columns, [row]))
}

/// Prints the changes by a movement: openings, then loads on pieces and on regions of the body.
fn show_reach(context: &Context, reach: &Reached) -> Result<(), CliError> {
    let columns = ["opening", "drawn_mm", "drawn_most_mm"];
    let drawn = |reached: &ReachedOpening| {
        vec![Value::Text(reached.opening.clone()), tenths(reached.drawn_mm), tenths(reached.drawn_most_mm)]
    };
    context.print(&Table::new(columns, reach.opening.iter().map(drawn)))?;
    let loads = [("tension_n_m", &reach.tension_n_m), ("pressure_kpa", &reach.pressure_kpa)];
    for (quantity, places) in loads {
        let in_pose = format!("{quantity} {}", reach.pose);
        let load = |at: &ReachedAt| vec![Value::Text(at.place.clone()), hundredths(at.before), hundredths(at.after)];
        context.print(&Table::new(["place", quantity, &in_pose], places.iter().map(load)))?;
    }
    Ok(())
}

/// Number rounded to a hundredth.
fn hundredths(number: f64) -> Value {
    Value::Real((number * 100.0).round() / 100.0)
}

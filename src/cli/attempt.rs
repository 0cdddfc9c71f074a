//! `toile try`: a garment, or an outfit, on one body.

use std::path::PathBuf;
use std::time::{Duration, Instant};

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

/// Time without a line of progress after which there is another.
const SILENT: Duration = Duration::from_secs(5);
/// Least share done from which the time left is told. A smaller one takes too little time to tell.
const LEAST_SHARE: f64 = 0.1;

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
    let mut told = Progress::default();
    let all = engine::attempt(&asked, &mut |phase, share| {
        if let Some(line) = told.line(phase, share, Instant::now()) {
            context.say(line);
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

/// Progress of a simulation as lines of text: one for each phase, and one after each [`SILENT`].
#[derive(Default)]
struct Progress {
    began: Option<Instant>,
    said: Option<(String, Instant)>,
}

impl Progress {
    /// Line about the phase, the share of the whole that is done and the time left; `None` where there is no news.
    fn line(&mut self, phase: &str, share: f64, now: Instant) -> Option<String> {
        let began = *self.began.get_or_insert(now);
        let is_news = |(before, when): &(String, Instant)| before != phase || now - *when >= SILENT;
        if !self.said.as_ref().is_none_or(is_news) {
            return None;
        }
        self.said = Some((phase.to_owned(), now));
        let left_s = (now - began).as_secs_f64() * (1.0 - share) / share;
        let left =
            (LEAST_SHARE..1.0).contains(&share).then(|| format!(", about {:.0} s left", left_s.round().max(1.0)));
        Some(format!("{phase}, {:.0} %{}", 100.0 * share, left.unwrap_or_default()))
    }
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

fn hundredths(number: f64) -> Value {
    Value::Real((number * 100.0).round() / 100.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_phase_and_long_silence_are_told_with_the_time_left() {
        let (mut told, start) = (Progress::default(), Instant::now());
        let mut check = |after_s: u64, phase: &str, share: f64, expect: Option<&str>| {
            let line = told.line(phase, share, start + Duration::from_secs(after_s));
            assert_eq!(line.as_deref(), expect, "{phase} after {after_s} s");
        };
        check(0, "sew", 0.0, Some("sew, 0 %"));
        check(1, "sew", 0.04, None);
        check(2, "settle", 0.05, Some("settle, 5 %"));
        check(6, "settle", 0.2, None);
        check(7, "settle", 0.25, Some("settle, 25 %, about 21 s left"));
        check(19, "drape", 0.95, Some("drape, 95 %, about 1 s left"));
        check(25, "drape", 1.0, Some("drape, 100 %"));
    }
}

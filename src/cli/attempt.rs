//! `toile try`: one garment on one body.

use super::args::Try;
use super::context::Context;
use super::{CliError, End, Outcome, body, output};
use geom::units::from_mm;
use study::patterns::Unit;
use study::{self, Attempt, Table, Tried, Value, files};

/// Runs a trial; writes its picture and meshes, prints what was measured.
pub fn run(context: &Context, arguments: &Try) -> Outcome {
    let asked = Attempt {
        body: arguments.body.body.clone(),
        body_unit: arguments.body.body_unit.map(Into::into),
        sex: arguments.body.sex.map(body::of),
        pattern: arguments.pattern.clone(),
        seams: arguments.seams.clone(),
        size: arguments.size.clone(),
        unit: arguments.unit.map(Unit::from),
        allowance_m: from_mm(arguments.allowance_mm),
        answers: arguments.answer.clone(),
        simulator: arguments.sim.into(),
        fabric: arguments.fabric.clone(),
        edge_length_m: from_mm(arguments.edge_mm),
        repeat: arguments.repeat,
    };
    files::make_folder(&arguments.output)?;
    let mut phase_before = String::new();
    let tried = study::attempt(&asked, &mut |phase, share| {
        if phase != phase_before {
            context.say(format_args!("{phase}, {:.0} %", 100.0 * share));
            phase.clone_into(&mut phase_before);
        }
    })?;
    for path in files::write_files(&arguments.output, &tried.files)? {
        context.say(format_args!("wrote {}", path.display()));
    }
    for note in &tried.notes {
        context.say(note);
    }
    for problem in &tried.problems {
        output::tell(problem);
    }
    show(context, &tried)?;
    Ok(if tried.problems.is_empty() { End::Done } else { End::CheckFailed })
}

/// Rounded to a tenth.
fn tenths(number: f64) -> Value {
    Value::Real((number * 10.0).round() / 10.0)
}

/// The measurements as the last stage left them, what the garment lacks, then the summary; as JSON one document of all.
fn show(context: &Context, tried: &Tried) -> Result<(), CliError> {
    if context.json {
        return Ok(output::json(tried)?);
    }
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
        let columns = ["level", "body_girth_mm", "garment_girth_mm", "shortfall_mm"].map(str::to_owned).to_vec();
        let rows = tried.gap.iter().map(|gap| {
            let girths = [gap.body_girth_mm, gap.garment_girth_mm, gap.shortfall_mm].map(tenths);
            [Value::Text(gap.level.clone())].into_iter().chain(girths).collect()
        });
        context.print(&Table { columns, rows: rows.collect() })?;
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
    context.print(&Table { columns: columns.map(str::to_owned).to_vec(), rows: vec![row] })
}

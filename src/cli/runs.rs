//! `toile run show|diff|rerun`: one result in full, two side by side, or one computed again.

use serde_json::{Value as Json, json};

use super::args::RunCommand;
use super::context::Context;
use super::{End, Outcome, output};
use geom::units::mm;
use results::{ChiPair, Record, record};
use spec::{Change, Inputs};
use store::{JobId, MetricsRow, Table, Value};

pub fn run(context: &Context, command: &RunCommand) -> Outcome {
    match *command {
        RunCommand::Show { job } => show(context, JobId(job)),
        RunCommand::Diff { before, after } => diff(context, JobId(before), JobId(after)),
        RunCommand::Rerun { job } => rerun(context, JobId(job)),
    }
}

fn show(context: &Context, id: JobId) -> Outcome {
    let record = record::record(&context.store()?, id)?;
    if context.json {
        output::json(&record_json(&record))?;
        return Ok(End::Done);
    }
    let job = &record.job;
    let mut facts = vec![
        ("study", job.study.clone()),
        ("result of", format!("{} {} on {} by {}", job.garment, job.size, job.subject, job.simulator.as_str())),
        ("repeat", job.repeat.to_string()),
        ("status", job.status.as_str().to_owned()),
        ("attempts", job.attempts.to_string()),
    ];
    facts.extend(job.error.clone().map(|error| ("error", error)));
    facts.extend(job.wall_ms.map(|ms| ("took", format!("{:.1} s", ms as f64 / 1e3))));
    if let Some(made) = &record.provenance {
        let dirty = if made.git_dirty == Some(true) { ", with changes" } else { "" };
        facts.push(("program", made.program_version.clone()));
        facts.extend(made.git_commit.iter().map(|commit| ("commit", format!("{commit}{dirty}"))));
        facts.push(("machine", made.machine.clone()));
        facts.push(("seed", made.seed.to_string()));
    }
    facts.extend(record.stages.iter().map(|stage| {
        let made = if stage.was_cached { "from the cache" } else { "made" };
        ("stage", format!("{} {} {made}", stage.stage, &stage.hash[..stage.hash.len().min(16)]))
    }));
    let numbers = record.metrics.iter().flat_map(numbers);
    facts.extend(numbers.filter_map(|(name, number)| Some((name, short(number?)))));
    output::text(&output::pretty(&two_columns(["what", "value"], facts)))?;
    let inputs = record.inputs.iter().map(|(name, value)| (name, value.to_owned())).collect();
    output::text(&output::pretty(&two_columns(["input", "value"], inputs)))?;
    let rows = record.chi.iter().map(|row| {
        let length = |length_m: f64| Value::Text(format!("{:.2}", mm(length_m)));
        vec![
            Value::Integer(i64::from(row.no)),
            Value::Text(row.name.clone()),
            length(row.l2d_m),
            length(row.l3d_m),
            Value::Text(format!("{:.4}", row.chi())),
        ]
    });
    let columns = ["#", "measurement", "L2D mm", "L3D mm", "chi"];
    output::text(&output::pretty(&Table::new(columns, rows)))?;
    Ok(End::Done)
}

fn diff(context: &Context, before: JobId, after: JobId) -> Outcome {
    let found = record::compare(&context.store()?, before, after)?;
    let metrics = found.metrics.each_ref().map(|metrics| metrics.as_ref().map(numbers));
    let names: Vec<&str> =
        metrics.iter().flatten().next().map(|all| all.iter().map(|(name, _)| *name).collect()).unwrap_or_default();
    let value = |side: usize, k: usize| metrics[side].and_then(|numbers| numbers[k].1);
    if context.json {
        let differ: Vec<Json> = (0..names.len())
            .filter(|&k| value(0, k) != value(1, k))
            .map(|k| json!({ "name": names[k], "before": value(0, k), "after": value(1, k) }))
            .collect();
        let chi: Vec<Json> = found.chi.iter().map(chi_json).collect();
        output::json(&json!({ "inputs": changes_json(&found.inputs), "metrics": differ, "chi": chi }))?;
        return Ok(End::Done);
    }
    if found.inputs.is_empty() {
        context.say("no input differs");
    }
    for change in &found.inputs {
        output::text(&format!("{change}\n"))?;
    }
    let both = [before, after].map(|id| format!("job {id}"));
    let number = |number: Option<f64>| number.map_or(Value::Null, Value::Real);
    let rows =
        (0..names.len()).map(|k| vec![Value::Text(names[k].to_owned()), number(value(0, k)), number(value(1, k))]);
    let columns = [&["number".to_owned()][..], &both].concat();
    output::text(&output::pretty(&Table { columns, rows: rows.collect() }))?;
    output::text(&output::pretty(&chi_table(&found.chi, &both)))?;
    Ok(End::Done)
}

fn rerun(context: &Context, id: JobId) -> Outcome {
    let again = record::rerun(&context.store()?, id)?;
    let differ = again.chi.iter().filter(|pair| !pair.is_same()).count();
    if context.json {
        let chi: Vec<Json> = again.chi.iter().map(chi_json).collect();
        output::json(&json!({
            "same": differ == 0, "inputs": changes_json(&again.inputs), "chi": chi,
            "ei": { "before": again.ei[0], "after": again.ei[1] },
        }))?;
    } else {
        output::text(&output::pretty(&chi_table(&again.chi, &["stored".to_owned(), "now".to_owned()])))?;
    }
    for change in &again.inputs {
        context.say(format_args!("this program differs: {change}"));
    }
    if differ == 0 {
        context.say(format_args!("job {id}: the same to the last bit, {} measurements", again.chi.len()));
        return Ok(End::Done);
    }
    context.say(format_args!("job {id}: {differ} of {} measurements differ", again.chi.len()));
    Ok(End::CheckFailed)
}

/// Metrics of a result with their names in SQL; `None` for a metric that its program did not compute.
fn numbers(m: &MetricsRow) -> [(&'static str, Option<f64>); 13] {
    [
        ("n", Some(f64::from(m.n))),
        ("e_chi", Some(m.e_chi)),
        ("sd_chi", Some(m.sd_chi)),
        ("ei", Some(m.ei)),
        ("max_abs_error", Some(m.max_abs_error)),
        ("vertices", Some(f64::from(m.vertices))),
        ("faces", Some(f64::from(m.faces))),
        ("iterations", Some(f64::from(m.iterations))),
        ("residual", Some(m.residual)),
        ("penetration_max_mm", Some(mm(m.penetration_max_m))),
        ("seam_gap_max_mm", Some(mm(m.seam_gap_max_m))),
        ("self_crossings", m.self_crossings.map(f64::from)),
        ("distortion", m.distortion),
    ]
}

/// Number with at most six decimals.
fn short(number: f64) -> String {
    let text = format!("{number:.6}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

fn two_columns(columns: [&str; 2], rows: Vec<(&str, String)>) -> Table {
    let rows = rows.into_iter().map(|(name, value)| vec![Value::Text(name.to_owned()), Value::Text(value)]);
    Table::new(columns, rows)
}

/// Table of measurements in two results: both chi and their difference, `=` where all bits are equal.
fn chi_table(pairs: &[ChiPair], names: &[String; 2]) -> Table {
    let columns = [&["#".to_owned(), "measurement".to_owned()][..], names, &["difference".to_owned()]].concat();
    let rows = pairs.iter().map(|pair| {
        let [a, b] = pair.chi();
        let text = |chi: Option<f64>| chi.map_or(Value::Null, |chi| Value::Text(format!("{chi:.4}")));
        let difference = match (a, b) {
            _ if pair.is_same() => Value::Text("=".to_owned()),
            (Some(a), Some(b)) => Value::Text(format!("{:+.2e}", b - a)),
            _ => Value::Null,
        };
        vec![Value::Integer(i64::from(pair.no)), Value::Text(pair.name.clone()), text(a), text(b), difference]
    });
    Table { columns, rows: rows.collect() }
}

fn chi_json(pair: &ChiPair) -> Json {
    let [a, b] = pair.chi();
    json!({ "measurement_no": pair.no, "measurement": pair.name, "before": a, "after": b, "same": pair.is_same() })
}

fn changes_json(changes: &[Change]) -> Vec<Json> {
    changes.iter().map(|c| json!({ "input": c.name, "before": c.before, "after": c.after })).collect()
}

fn inputs_json(inputs: &Inputs) -> Json {
    inputs.iter().map(|(name, value)| (name.to_owned(), Json::from(value))).collect::<serde_json::Map<_, _>>().into()
}

fn record_json(record: &Record) -> Json {
    let job = &record.job;
    let metrics = record.metrics.as_ref().map(|metrics| {
        let numbers = numbers(metrics).into_iter().map(|(name, number)| (name.to_owned(), Json::from(number)));
        let mut all: serde_json::Map<String, Json> = numbers.collect();
        all.insert("converged".to_owned(), metrics.converged.into());
        all
    });
    let stages: Vec<Json> = record
        .stages
        .iter()
        .map(|stage| json!({ "stage": stage.stage, "hash": stage.hash, "was_cached": stage.was_cached }))
        .collect();
    let chi: Vec<Json> = record
        .chi
        .iter()
        .map(|row| {
            json!({ "measurement_no": row.no, "measurement": row.name, "stage": row.stage,
                "l2d_mm": mm(row.l2d_m), "l3d_mm": mm(row.l3d_m), "chi": row.chi() })
        })
        .collect();
    json!({
        "job_id": job.id.0, "study": job.study, "garment": job.garment, "size": job.size, "subject": job.subject,
        "simulator": job.simulator.as_str(), "repeat": job.repeat, "status": job.status.as_str(),
        "attempts": job.attempts, "error": job.error, "wall_ms": job.wall_ms, "is_current": job.is_current,
        "provenance": record.provenance, "inputs": inputs_json(&record.inputs), "stages": stages,
        "metrics": metrics, "chi": chi,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_in_the_unit_of_their_names() {
        let metrics = MetricsRow {
            n: 9,
            e_chi: 1.01,
            sd_chi: 0.02,
            ei: 0.03,
            max_abs_error: 0.04,
            vertices: 100,
            faces: 180,
            iterations: 7,
            residual: 0.001,
            converged: true,
            penetration_max_m: 0.25,
            seam_gap_max_m: 0.5,
            self_crossings: None,
            distortion: Some(0.0625),
        };
        let all = numbers(&metrics);
        let check = |name: &str, expect: Option<f64>| {
            assert_eq!(all.iter().find(|(known, _)| *known == name).map(|(_, number)| *number), Some(expect), "{name}");
        };
        check("penetration_max_mm", Some(250.0));
        check("seam_gap_max_mm", Some(500.0));
        check("max_abs_error", Some(0.04));
        check("self_crossings", None);
        check("distortion", Some(0.0625));
    }
}

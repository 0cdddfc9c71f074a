//! `toile body`: building and measuring bodies.

use std::path::Path;

use serde_json::Value as Json;

use super::args::{Body, BodyBuild, MeshUnit, Sex};
use super::context::Context;
use super::{CliError, End, Outcome, output};
use geom::units::from_mm;
use study::View;
use study::bodies;
use study::bodies::{Lens, Measurements};
use study::evaluate::{self, Accuracy};
use study::files;
use study::{Table, Value};

/// Size of the picture of a body, pixels.
const PICTURE: (u32, u32) = (700, 1200);

/// Runs a body command.
pub fn run(context: &Context, command: &Body) -> Outcome {
    match command {
        Body::Measure { file, unit, sex } => {
            let source = files::SourceFile::read(file)?;
            print(context, &bodies::measured(&read_scan(context, &source, *unit, *sex)?)?)?;
        }
        Body::Build(arguments) => build(context, arguments)?,
        Body::Pose { file, arm_deg, leg_deg, unit, sex, output } => {
            let source = files::SourceFile::read(file)?;
            let body = bodies::scanned_body(&source, read_scan(context, &source, *unit, *sex)?)?;
            let posed = bodies::pose_body(&body, bodies::Pose { arm_deg: *arm_deg, leg_deg: *leg_deg })?;
            write(context, &posed, output)?;
        }
        Body::Evaluate { folder } => evaluate(context, folder)?,
    }
    Ok(End::Done)
}

pub fn of(sex: Sex) -> bodies::Sex {
    match sex {
        Sex::M => bodies::Sex::Male,
        Sex::F => bodies::Sex::Female,
    }
}

/// Prints how well the bodies of a folder are measured.
fn evaluate(context: &Context, folder: &Path) -> Result<(), CliError> {
    let found = evaluate::evaluate(folder)?;
    if context.json {
        return Ok(output::json(&found)?);
    }
    for body in &found.bodies {
        if let Some(error) = &body.error {
            context.say(format_args!("{} {}: {error}", body.id, body.source));
        }
    }
    let tenth = |number: f64| Value::Real((number * 10.0).round() / 10.0);
    let row = |source: &str, name: &str, of: &Accuracy| {
        let words = [source, name].map(|word| Value::Text(word.to_owned()));
        words
            .into_iter()
            .chain([Value::Integer(of.n as i64), tenth(of.mae_mm), tenth(of.max_mm), tenth(of.bias_mm)])
            .collect()
    };
    let rows = found.source.iter().flat_map(|(source, of)| of.iter().map(move |(name, of)| row(source, name, of)));
    let columns = ["source", "measurement", "n", "mae_mm", "max_mm", "bias_mm"].map(str::to_owned).to_vec();
    context.print(&Table { columns, rows: rows.collect() })
}

/// Builds a body and writes its mesh, picture and measurements.
fn build(context: &Context, arguments: &BodyBuild) -> Result<(), CliError> {
    if let Some(file) = &arguments.scan {
        let source = files::SourceFile::read(file)?;
        let scan = read_scan(context, &source, arguments.unit, arguments.sex)?;
        return write(context, &bodies::scanned_body(&source, scan)?, &arguments.output);
    }
    let measurements = measurements(context, arguments)?;
    let body = bodies::build_body(&measurements)?;
    write_files(context, &body, &arguments.output)?;
    let judgement = bodies::judge_body(&measurements, &body);
    if context.json {
        return Ok(output::json(&judgement)?);
    }
    for doubt in &judgement.doubts {
        context.say(format_args!("{doubt}"));
    }
    context.say(format_args!("{}", judgement.mass));
    print(context, &body.girths)
}

/// Writes a body's files and prints its measurements.
fn write(context: &Context, body: &bodies::Body, folder: &Path) -> Result<(), CliError> {
    write_files(context, body, folder)?;
    if context.json { Ok(output::json(&body.girths)?) } else { print(context, &body.girths) }
}

/// Writes mesh, picture, measurements and control mesh of a body.
fn write_files(context: &Context, body: &bodies::Body, folder: &Path) -> Result<(), CliError> {
    let document = serde_json::to_string_pretty(&body.girths).map_err(std::io::Error::from)?;
    let mut files = vec![
        ("body.obj".to_owned(), bodies::write_obj(&body.mesh).into_bytes()),
        ("body.png".to_owned(), bodies::body_picture(body, View::Quarter, PICTURE.0, PICTURE.1)?),
        ("measurements.json".to_owned(), document.into_bytes()),
    ];
    files.extend(bodies::control_files(body)?);
    for path in files::write_files(folder, &files)? {
        context.say(format_args!("wrote {}", path.display()));
    }
    Ok(())
}

/// Reads a scan; what was guessed or repaired is said.
fn read_scan(
    context: &Context,
    source: &files::SourceFile,
    unit: Option<MeshUnit>,
    sex: Option<Sex>,
) -> Result<bodies::Scan, CliError> {
    let scan = bodies::read_scan(source, unit.map(Into::into), sex.map(of))?;
    for note in &scan.imported.notes {
        context.say(format_args!("{}: {note}", source.name));
    }
    Ok(scan)
}

/// The measurements of a catalogue entry or a file, with those of the command line over them.
fn measurements(context: &Context, arguments: &BodyBuild) -> Result<Measurements, CliError> {
    let mut known = match (&arguments.subject, &arguments.measurements) {
        (Some(name), _) => context.workspace()?.subject(name)?,
        (None, Some(file)) => study::read_measurements(file)?,
        (None, None) => {
            let (Some(sex), Some(stature_mm)) = (arguments.sex, arguments.stature_mm) else {
                return Err(CliError::Usage(
                    "say --sex and --stature-mm, or a --subject, or --measurements FILE".into(),
                ));
            };
            let (sex, stature_m) = (of(sex), from_mm(stature_mm));
            match (&arguments.front, &arguments.side) {
                (Some(front), Some(side)) => pictured(context, arguments, [front, side], sex, stature_m)?,
                _ => Measurements::of(sex, stature_m),
            }
        }
    };
    known.sex = arguments.sex.map_or(known.sex, of);
    known.stature_m = arguments.stature_mm.map_or(known.stature_m, from_mm);
    known.weight_kg = arguments.weight_kg.or(known.weight_kg);
    let lengths = [
        (&mut known.chest_girth_m, arguments.chest_girth_mm),
        (&mut known.waist_girth_m, arguments.waist_girth_mm),
        (&mut known.hip_girth_m, arguments.hip_girth_mm),
        (&mut known.neck_girth_m, arguments.neck_girth_mm),
        (&mut known.across_shoulder_m, arguments.across_shoulder_mm),
        (&mut known.underbust_girth_m, arguments.underbust_girth_mm),
        (&mut known.thigh_girth_m, arguments.thigh_girth_mm),
        (&mut known.knee_girth_m, arguments.knee_girth_mm),
        (&mut known.calf_girth_m, arguments.calf_girth_mm),
        (&mut known.ankle_girth_m, arguments.ankle_girth_mm),
        (&mut known.upper_arm_girth_m, arguments.upper_arm_girth_mm),
        (&mut known.forearm_girth_m, arguments.forearm_girth_mm),
        (&mut known.wrist_girth_m, arguments.wrist_girth_mm),
        (&mut known.inseam_m, arguments.inseam_mm),
        (&mut known.arm_length_m, arguments.arm_length_mm),
        (&mut known.foot_length_m, arguments.foot_length_mm),
    ];
    for (length, given_mm) in lengths {
        *length = given_mm.map(from_mm).or(*length);
    }
    Ok(known)
}

/// Measurements read from a front and a side picture.
fn pictured(
    context: &Context,
    arguments: &BodyBuild,
    [front, side]: [&Path; 2],
    sex: bodies::Sex,
    stature_m: f64,
) -> Result<Measurements, CliError> {
    let lens = match (arguments.focal_px, arguments.fov_deg) {
        (Some(focal_px), _) => Some(Lens::FocalPx(focal_px)),
        (None, Some(field_deg)) => Some(Lens::FieldDeg(field_deg)),
        (None, None) => None,
    };
    let camera = lens.zip(arguments.camera_distance_mm.map(from_mm));
    let found = bodies::read_pictures(front, side, camera, sex, stature_m)?;
    for note in &found.notes {
        context.say(format_args!("{note}"));
    }
    for level in &found.levels {
        let bodies::PicturedLevel { name, level_mm, width_mm, depth_mm, girth_mm } = level;
        context.say(format_args!(
            "{name}: {width_mm:.0} mm wide, {depth_mm:.0} mm deep at {level_mm:.0} mm, girth {girth_mm:.0} mm"
        ));
    }
    Ok(found.measurements)
}

/// Prints measurements: a table for reading, the contract's keys as JSON.
fn print(context: &Context, girths: &impl serde::Serialize) -> Result<(), CliError> {
    if context.json {
        return Ok(output::json(girths)?);
    }
    let document = serde_json::to_value(girths).map_err(std::io::Error::from)?;
    let tenth = |value: &Json| value.as_f64().map_or(Value::Null, |number| Value::Real((number * 10.0).round() / 10.0));
    let rows =
        document.as_object().into_iter().flatten().map(|(name, value)| vec![Value::Text(name.clone()), tenth(value)]);
    context.print(&Table { columns: vec!["measurement".into(), "value".into()], rows: rows.collect() })
}

//! `toile body`: bodies built, measured, posed and evaluated.

use std::path::Path;

use serde_json::Value as Json;

use super::args::{Body, BodyBuild, MeshUnit, Sex};
use super::context::Context;
use super::{CliError, End, Outcome, output};
use geom::units::{from_mm, mm};
use render::View;
use spec::bodies::{self, FigureFound, Figures, Lens, Measurements};
use spec::{Given, MEASUREMENTS, Person};
use store::{Table, Value, files};
use wardrobe::catalogue;
use wardrobe::evaluate::{self, Accuracy};

const PICTURE: (u32, u32) = (700, 1200);

const FILES: [&str; 3] = ["obj", "png", "json"];

pub fn run(context: &Context, command: &Body) -> Outcome {
    match command {
        Body::Measure { file, unit, sex } => {
            let source = files::SourceFile::read(file)?;
            let read = bodies::measured(&read_scan(context, &source, *unit, *sex)?)?;
            print(context, &read, read.figures.as_deref())?;
        }
        Body::Build(arguments) => build(context, arguments)?,
        Body::Pose { file, arm_deg, leg_deg, forward_deg, step_deg, unit, sex, output } => {
            output::folder(output, &FILES)?;
            let source = files::SourceFile::read(file)?;
            let body = bodies::scanned_body(&source, read_scan(context, &source, *unit, *sex)?)?;
            let [arm_deg, leg_deg, forward_deg, step_deg] = [*arm_deg, *leg_deg, *forward_deg, *step_deg];
            let posed = bodies::pose_body(&body, bodies::Pose { arm_deg, leg_deg, forward_deg, step_deg })?;
            write(context, &posed, output)?;
        }
        Body::Evaluate { folder } => evaluate(context, folder)?,
    }
    Ok(End::Done)
}

pub fn sex_of(sex: Sex) -> bodies::Sex {
    match sex {
        Sex::M => bodies::Sex::Male,
        Sex::F => bodies::Sex::Female,
    }
}

/// Prints how exactly the bodies of a folder are measured.
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
    let row = |source: &str, name: &str, accuracy: &Accuracy| {
        let words = [source, name].map(|word| Value::Text(word.to_owned()));
        let errors_mm = [accuracy.mae_mm, accuracy.max_mm, accuracy.bias_mm].map(output::tenths);
        words.into_iter().chain([Value::Integer(accuracy.n as i64)]).chain(errors_mm).collect()
    };
    let rows = found.source.iter().flat_map(|(source, measurements)| {
        measurements.iter().map(move |(name, accuracy)| row(source, name, accuracy))
    });
    let columns = ["source", "measurement", "n", "mae_mm", "max_mm", "bias_mm"];
    context.print(&Table::new(columns, rows))
}

fn build(context: &Context, arguments: &BodyBuild) -> Result<(), CliError> {
    output::folder(&arguments.output, &FILES)?;
    if let Some(file) = &arguments.scan {
        refuse_beside_scan(arguments.measured.0.first())?;
        let source = files::SourceFile::read(file)?;
        let scan = read_scan(context, &source, arguments.unit, arguments.sex)?;
        return write(context, &bodies::scanned_body(&source, scan)?, &arguments.output);
    }
    let person = person(context, arguments)?;
    let body = person.body()?;
    if person.scan.is_some() {
        return write(context, &body, &arguments.output);
    }
    let measurements = person.measurements;
    write_files(context, &body, &arguments.output)?;
    let judgement = bodies::judge_body(&measurements, &body);
    if context.json {
        return Ok(output::json(&judgement)?);
    }
    for doubt in &judgement.doubts {
        context.say(format_args!("{doubt}"));
    }
    context.say(format_args!("{}", judgement.mass));
    print(context, &judgement.read, judgement.read.figures.as_deref())
}

fn write(context: &Context, body: &bodies::Body, folder: &Path) -> Result<(), CliError> {
    write_files(context, body, folder)?;
    let read = bodies::read_body(body);
    print(context, &read, read.figures.as_deref())
}

fn write_files(context: &Context, body: &bodies::Body, folder: &Path) -> Result<(), CliError> {
    let document = serde_json::to_string_pretty(&bodies::read_body(body)).map_err(std::io::Error::from)?;
    let mut files = vec![
        ("body.obj".to_owned(), bodies::write_obj(&body.mesh).into_bytes()),
        ("body.png".to_owned(), bodies::body_picture(body, View::Quarter, PICTURE.0, PICTURE.1)?),
        ("measurements.json".to_owned(), document.into_bytes()),
    ];
    files.extend(bodies::control_files(body)?);
    context.write_files(folder, &files)
}

fn read_scan(
    context: &Context,
    source: &files::SourceFile,
    unit: Option<MeshUnit>,
    sex: Option<Sex>,
) -> Result<bodies::Scan, CliError> {
    let scan = bodies::read_scan(source, unit.map(Into::into), sex.map(sex_of))?;
    for note in &scan.imported.notes {
        context.say(format_args!("{}: {note}", source.name));
    }
    Ok(scan)
}

/// Refuses measurements together with a scan, since the scan is the body.
pub fn refuse_beside_scan(given: Option<&Given>) -> Result<(), CliError> {
    let Some((key, _)) = given else { return Ok(()) };
    Err(CliError::Usage(format!(
        "--{} does not go with --scan, which is the body itself; accepted with it: --sex, --unit",
        key.replace('_', "-")
    )))
}

/// Person of a catalogue entry, a file or pictures. Measurements on the command line replace the person's own.
fn person(context: &Context, arguments: &BodyBuild) -> Result<Person, CliError> {
    let figures = bodies::figures(arguments.figure.iter().map(String::as_str))?;
    let mut stored = Figures::default();
    let mut known = match (&arguments.subject, &arguments.measurements) {
        (Some(name), _) => {
            let person = catalogue::subject(&context.store()?, name)?;
            if person.scan.is_some() {
                refuse_beside_scan(arguments.measured.0.first())?;
                if !figures.is_empty() {
                    let problem = format!("--figure does not go with `{name}`, a scan, which has its own figures");
                    return Err(CliError::Usage(problem));
                }
                return Ok(person);
            }
            stored = person.figures;
            person.measurements
        }
        (None, Some(file)) => spec::read_measurements(file, arguments.sex.map(sex_of))?,
        (None, None) => {
            let missing = "say --sex and --stature-mm, or a --subject, or --measurements FILE";
            let sex = arguments.sex.map(sex_of).ok_or_else(|| CliError::Usage(missing.into()))?;
            let mut asked = Measurements::of(sex, f64::NAN);
            set_given(&mut asked, &arguments.measured.0)?;
            if asked.stature_m().is_nan() {
                return Err(CliError::Usage(missing.into()));
            }
            match (&arguments.front, &arguments.side) {
                (Some(front), Some(side)) => pictured(context, arguments, [front, side], sex, asked.stature_m())?,
                _ => asked,
            }
        }
    };
    known.sex = arguments.sex.map_or(known.sex, sex_of);
    set_given(&mut known, &arguments.measured.0)?;
    Ok(Person { figures: if figures.is_empty() { stored } else { figures }, ..known.into() })
}

fn set_given(known: &mut Measurements, given: &[Given]) -> Result<(), CliError> {
    for (key, text) in given {
        let Some(field) = MEASUREMENTS.iter().find(|field| field.key == key) else { continue };
        field.set(known, field.read(text).map_err(CliError::Usage)?);
    }
    Ok(())
}

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
    let distance_m = arguments.camera_distance_mm.map(from_mm);
    let camera = lens.zip(distance_m).map(|(lens, distance_m)| bodies::PictureCamera { lens, distance_m });
    let found = bodies::read_pictures(front, side, camera, sex, stature_m)?;
    for note in &found.notes {
        context.say(format_args!("{note}"));
    }
    for level in &found.levels {
        let name = level.name;
        let [width, depth, height] = [level.width_m, level.depth_m, level.level_m].map(mm);
        let [girth, within] = [level.girth_m, level.within_m].map(mm);
        context.say(format_args!(
            "{name}: {width:.0} mm wide, {depth:.0} mm deep at {height:.0} mm, girth {girth:.0} mm (within {within:.0} in four \
             of five)"
        ));
    }
    Ok(found.measurements)
}

/// Prints measurements as JSON with the documented keys, or as a table, with their standard deviations and the reasons
/// for these where they are known. Figures that are clear are told above the table.
fn print(context: &Context, read: &impl serde::Serialize, figures: Option<&[FigureFound]>) -> Result<(), CliError> {
    if context.json {
        return Ok(output::json(read)?);
    }
    for found in figures.unwrap_or_default().iter().filter(|found| found.is_clear()) {
        let (name, amount, sd) = (found.name(), found.amount_mm.abs(), found.sd_mm);
        context.say(format_args!("{name}: {amount:.0} mm (sd {sd:.0}) beside the standard body of these measurements"));
    }
    let document = serde_json::to_value(read).map_err(std::io::Error::from)?;
    let tenth = |value: &Json| value.as_f64().map_or(Value::Null, output::tenths);
    let confidence = &document["confidence"];
    let row = |(name, value): (&String, &Json)| {
        let mut row = vec![Value::Text(name.clone()), tenth(value)];
        if confidence.is_object() {
            let known = &confidence[name];
            let sd = known.get("sd_mm").or_else(|| known.get("sd_deg")).map_or(Value::Null, tenth);
            row.extend([sd, known["reason"].as_str().map_or(Value::Null, |text| Value::Text(text.to_owned()))]);
        }
        row
    };
    let rows = document
        .as_object()
        .into_iter()
        .flatten()
        .filter(|(name, value)| !value.is_object() && *name != "figures")
        .map(row);
    let shown = if confidence.is_object() { 4 } else { 2 };
    context.print(&Table::new(["measurement", "value", "sd", "limited by"].into_iter().take(shown), rows))
}

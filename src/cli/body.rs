//! `toile body`: building and measuring bodies.

use serde_json::Value as Json;

use super::args::{Body, BodyBuild, MeshUnit, Sex};
use super::context::Context;
use super::{CliError, End, Outcome, output};
use crate::study::tools::{self, Girths, LengthUnit, Measurements, View};
use crate::study::{Table, Value};
use crate::units::from_mm;

/// Size of the picture of a body, pixels.
const PICTURE: (u32, u32) = (700, 1200);

/// Runs a body command.
pub fn run(context: &Context, command: &Body) -> Outcome {
    match command {
        Body::Measure { file, unit, sex } => {
            let unit = unit.map(|unit| match unit {
                MeshUnit::Mm => LengthUnit::Millimetre,
                MeshUnit::Cm => LengthUnit::Centimetre,
                MeshUnit::M => LengthUnit::Metre,
            });
            let (girths, notes) = tools::measure_body(file, unit, sex.map(of))?;
            for note in notes {
                context.say(format_args!("{}: {note}", file.display()));
            }
            print(context, &girths)?;
        }
        Body::Build(arguments) => build(context, arguments)?,
    }
    Ok(End::Done)
}

fn of(sex: Sex) -> tools::Sex {
    match sex {
        Sex::M => tools::Sex::Male,
        Sex::F => tools::Sex::Female,
    }
}

/// Builds a body and writes its mesh, picture and measurements.
fn build(context: &Context, arguments: &BodyBuild) -> Result<(), CliError> {
    let measurements = measurements(context, arguments)?;
    let body = tools::build_body(&measurements)?;
    let document = serde_json::to_string_pretty(&body.girths).map_err(std::io::Error::from)?;
    let files = [
        ("body.obj".to_owned(), tools::write_obj(&body.mesh).into_bytes()),
        ("body.png".to_owned(), tools::body_picture(&body, View::Quarter, PICTURE.0, PICTURE.1)?),
        ("measurements.json".to_owned(), document.into_bytes()),
    ];
    for path in tools::write_files(&arguments.output, &files)? {
        context.say(format_args!("wrote {}", path.display()));
    }
    print(context, &body.girths)
}

/// The measurements of a catalogue entry or a file, with those of the command line over them.
fn measurements(context: &Context, arguments: &BodyBuild) -> Result<Measurements, CliError> {
    let mut known = match (&arguments.subject, &arguments.measurements) {
        (Some(name), _) => context.workspace()?.subject(name)?,
        (None, Some(file)) => tools::read_measurements(file)?,
        (None, None) => {
            let (Some(sex), Some(stature_mm)) = (arguments.sex, arguments.stature_mm) else {
                return Err(CliError::Usage(
                    "say --sex and --stature-mm, or a --subject, or --measurements FILE".into(),
                ));
            };
            Measurements {
                sex: of(sex),
                stature_m: from_mm(stature_mm),
                weight_kg: None,
                chest_girth_m: None,
                waist_girth_m: None,
                hip_girth_m: None,
                neck_girth_m: None,
                across_shoulder_m: None,
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
    ];
    for (length, given_mm) in lengths {
        *length = given_mm.map(from_mm).or(*length);
    }
    Ok(known)
}

/// Prints measurements: a table for reading, the contract's keys as JSON.
fn print(context: &Context, girths: &Girths) -> Result<(), CliError> {
    if context.json {
        return Ok(output::json(girths)?);
    }
    let document = serde_json::to_value(girths).map_err(std::io::Error::from)?;
    let tenth = |value: &Json| value.as_f64().map_or(Value::Null, |number| Value::Real((number * 10.0).round() / 10.0));
    let rows =
        document.as_object().into_iter().flatten().map(|(name, value)| vec![Value::Text(name.clone()), tenth(value)]);
    context.print(&Table { columns: vec!["measurement".into(), "value".into()], rows: rows.collect() })
}

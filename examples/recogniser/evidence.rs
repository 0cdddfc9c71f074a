//! Evidence of drawn garments, as numbers that `fit.py` fits the network of the recogniser to
//! (docs/patterns-method.md).
//!
//! `cargo run --release -p examples --bin evidence GARMENTS.jsonl OUT` reads one garment a line:
//! `{"pieces": [{"name": "front", "outline": [[u, v], ...], "corners": [k, ...], "notches": [[u, v], ...]}, ...]}`, lengths
//! in metres, and writes its stretches: counts and numbers, little-endian, one garment after another.

use std::error::Error;
use std::fs::File;
use std::io::{BufRead, BufReader, BufWriter, Write};

use serde_json::Value;
use toile::geom::V2;
use toile::pattern::propose;
use toile::pattern::recogniser::{self, evidence, stretch, symmetry};
use toile::pattern::{Notch, Piece};

type Outcome<T = ()> = Result<T, Box<dyn Error>>;

fn points(value: &Value) -> Vec<V2> {
    let number = |value: Option<&Value>| value.and_then(Value::as_f64).unwrap_or(f64::NAN);
    let list = value.as_array().map_or(&[][..], Vec::as_slice);
    list.iter().map(|point| V2::new(number(point.get(0)), number(point.get(1)))).collect()
}

fn piece(value: &Value) -> Piece {
    let outline = points(&value["outline"]);
    let corners = value["corners"].as_array().map_or(&[][..], Vec::as_slice).iter();
    let corners = corners.filter_map(Value::as_u64).filter_map(|corner| outline.get(corner as usize).copied());
    let notches = points(&value["notches"]).into_iter().map(|at| Notch { at, depth_m: None, angle_deg: None });
    Piece {
        name: value["name"].as_str().unwrap_or_default().to_owned(),
        turn_points: corners.collect(),
        notches: notches.collect(),
        outline,
        ..Piece::default()
    }
}

fn main() -> Outcome {
    let mut arguments = std::env::args().skip(1);
    let (Some(garments), Some(out)) = (arguments.next(), arguments.next()) else {
        return Err("two arguments are accepted: GARMENTS.jsonl OUT".into());
    };
    let mut out = BufWriter::new(File::create(out)?);
    for line in BufReader::new(File::open(garments)?).lines() {
        let garment: Value = serde_json::from_str(&line?)?;
        let pieces: Vec<Piece> =
            garment["pieces"].as_array().map_or(&[][..], Vec::as_slice).iter().map(piece).collect();
        write(&recogniser::parts(&pieces, &propose::named(&pieces)), &mut out)?;
    }
    Ok(out.flush()?)
}

fn write(parts: &[recogniser::Part], out: &mut impl Write) -> Outcome {
    let stretches = stretch::stretches(parts);
    let symmetry = symmetry::symmetry(parts, &stretches);
    let seen = evidence::evidence(parts, &stretches, &symmetry);
    let index = |found: Option<usize>| found.map_or(-1, |found| found as i32);
    integers(std::iter::once(stretches.len() as i32), out)?;
    integers(stretches.iter().map(|stretch| stretch.part as i32), out)?;
    integers(stretches.iter().map(|stretch| stretch.next as i32), out)?;
    integers(symmetry.own.iter().map(|&found| index(found)), out)?;
    integers(symmetry.twin.iter().map(|&found| index(found)), out)?;
    integers(stretches.iter().map(|stretch| symmetry.kind[stretch.part] as i32), out)?;
    let starts = stretches.iter().map(|stretch| start_mm(&parts[stretch.part], stretch.at));
    let lengths = stretches.iter().map(|stretch| 1000.0 * stretch.length);
    let angles = stretches.iter().map(|stretch| stretch.start_angle);
    floats(starts.chain(lengths).chain(angles).map(|number| number as f32), out)?;
    floats(seen.shape.iter().flatten().copied(), out)?;
    floats(seen.place.iter().flatten().copied(), out)?;
    floats(seen.said.iter().flatten().copied(), out)?;
    for i in 0..stretches.len() {
        for j in 0..stretches.len() {
            floats(evidence::pair(&stretches, &symmetry, i, j).into_iter(), out)?;
        }
    }
    Ok(())
}

fn integers(mut numbers: impl Iterator<Item = i32>, out: &mut impl Write) -> Outcome {
    numbers.try_for_each(|number| Ok(out.write_all(&number.to_le_bytes())?))
}

fn floats(mut numbers: impl Iterator<Item = f32>, out: &mut impl Write) -> Outcome {
    numbers.try_for_each(|number| Ok(out.write_all(&number.to_le_bytes())?))
}

/// Arc length of the outline before a corner.
fn start_mm(part: &recogniser::Part, corner: usize) -> f64 {
    let outline = &part.outline[..=part.corners[corner]];
    1000.0 * outline.windows(2).map(|ends| (ends[1] - ends[0]).norm()).sum::<f64>()
}

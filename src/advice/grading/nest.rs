//! The sizes as files: a DXF file each, and the sample size with the rules of all. These are read again and compared
//! with the sizes as grown.

use crate::error::AdviceError;
use crate::grading::Asked;
use crate::grading::knobs::{Knobs, Run};
use fit::coverage::Turns;
use geom::V2;
use geom::polyline::segment_distance;
use geom::units::mm;
use pattern::dxf::{self, PatternFile, Standard};
use pattern::grade::{self, Graded};
use pattern::{Handle, Piece, Style};
use report::FileNames;
use store::{InOrigin, Origin, Result};

/// Greatest accepted distance between a size as grown and as the rules make it.
const APART_M: f64 = 0.1e-3;

pub struct Nest {
    /// Sizes as the rules make them.
    pub styles: Vec<Style>,
    pub rules: usize,
    /// Greatest distance between a size as grown and as the rules make it.
    pub apart_m: f64,
    /// Files by name: patterns, rules and seam file.
    pub files: Vec<(String, Vec<u8>)>,
}

pub fn drawn(asked: &Asked<'_>, names: &[String], knobs: &Knobs, turns: &Turns, run: Run) -> Result<Nest> {
    let garment = &asked.spec.garment;
    let mut parts = FileNames::default();
    let whole = parts.part(garment);
    let sizes: Vec<(String, Vec<(Handle, f64)>)> =
        names.iter().enumerate().map(|(size, name)| (name.clone(), knobs.amounts(turns, run, size))).collect();
    if sizes.is_empty() {
        return Err(AdviceError::EmptyNest.into());
    }
    let Graded { pieces, table, seams, styles: grown } =
        knobs.growth.graded(&sizes, run.sample()).origin(Origin::Grade)?;
    let imprint = asked.imprint()?;
    let texts = |size: &str| -> Vec<(String, String)> {
        let own = [("Style Name", garment.as_str()), ("Sample Size", size), ("Units", "METRIC")];
        let own = own.map(|(key, value)| (key.to_owned(), value.to_owned()));
        own.into_iter().chain(imprint.texts()).collect()
    };
    let sample = &names[run.sample()];
    let of_table = texts(sample).into_iter().chain([grade::named_in_pattern(&whole)]).collect::<Vec<_>>();
    let written = dxf::write_pieces(&pieces, &of_table, Standard::Aama);
    let rules = grade::write(&table, &whole, &imprint, Standard::Aama);
    let mut files = vec![
        (format!("{whole}.dxf"), written.clone()),
        (format!("{whole}.rul"), rules.clone().into_bytes()),
        (format!("{whole}.seams.toml"), seams.clone()),
    ];
    let (nest, mut apart_m) = (read_again(&written, rules.as_bytes(), &whole)?, 0.0_f64);
    let mut styles = Vec::new();
    for (name, grown) in names.iter().zip(&grown) {
        let pieces = nest.to_sew(Some(name)).origin(Origin::Grade)?;
        let style = Style::read(&pieces, &seams, &format!("{whole}.seams.toml")).origin(Origin::Grade)?;
        apart_m = apart_m.max(apart(grown, &style, name)?);
        let sized: Vec<Piece> = nest.pieces.iter().filter(|piece| piece.size.as_ref() == Some(name)).cloned().collect();
        files.push((
            format!("{}.dxf", parts.part(&format!("{garment}-{name}"))),
            dxf::write_pieces(&sized, &texts(name), Standard::Aama),
        ));
        styles.push(style);
    }
    Ok(Nest { styles, rules: table.rules.len(), apart_m, files })
}

fn read_again(written: &[u8], rules: &[u8], name: &str) -> Result<PatternFile> {
    let sample = dxf::read(written, &format!("{name}.dxf"), None).origin(Origin::Grade)?;
    let table = grade::read(rules, &format!("{name}.rul")).origin(Origin::Grade)?;
    grade::grade(&sample, &table).origin(Origin::Grade)
}

/// Greatest distance of the sewn outlines of two styles of one size, m.
fn apart(grown: &Style, read: &Style, size: &str) -> Result<f64> {
    let mut apart_m: f64 = 0.0;
    for (piece, other) in grown.pieces.iter().zip(&read.pieces) {
        let [outline, again] = [piece, other].map(|piece| piece.outline());
        let apart = away(&outline, &again).max(away(&again, &outline));
        if apart > APART_M {
            let (apart_mm, accepted_mm) = (mm(apart), mm(APART_M));
            let (piece, size) = (piece.id.clone(), size.to_owned());
            return Err(AdviceError::OtherPiece { piece, size, apart_mm, accepted_mm }.into());
        }
        apart_m = apart_m.max(apart);
    }
    Ok(apart_m)
}

/// Greatest distance of the vertices of one outline from another, m.
fn away(vertices: &[V2], outline: &[V2]) -> f64 {
    let sides = || (0..outline.len()).map(|k| (outline[k], outline[(k + 1) % outline.len()]));
    let nearest = |p: &V2| sides().map(|(a, b)| segment_distance(&a, &b, p)).fold(f64::INFINITY, f64::min);
    vertices.iter().map(nearest).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grading::people::{self, Figure};
    use crate::grading::{GradeWish, bands};
    use spec::Study;
    use std::path::Path;
    use wardrobe::catalogue;

    fn made(study: &str, garment: &str, run: Run, turns: &Turns) -> Result<(Nest, Vec<&'static str>)> {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studies").join(study);
        let study = Study::load(&folder, &catalogue::known(None)?)?;
        let wish = GradeWish { garment: Some(garment.to_owned()), sizes: Some(run.count), ..GradeWish::default() };
        let asked = Asked::of(&study, &wish)?;
        let own = asked.own()?;
        let [somebody, _] = people::drawn(&asked.sexes, [1, 1], 1);
        let figures: Vec<Figure> = people::figures(&somebody, false);
        let bands = bands(asked.entry, &figures[0].covered(&own[asked.base]), &[])?;
        let knobs = Knobs::of(asked.growth()?, &figures[0], &bands, &asked.sexes, 0.1)?;
        let nest = drawn(&asked, &asked.names(), &knobs, turns, run)?;
        Ok((nest, knobs.handles.iter().map(|handle| handle.as_str()).collect()))
    }

    #[test]
    fn few_rules_make_the_sizes_again_that_were_grown() {
        let tshirt = ["chest", "waist", "hem", "shoulder_length", "bicep"];
        // Departures of the sample size, then the steps of chest, waist and hem in each group.
        let check = |run: Run, turns: &[i32]| {
            let (nest, handles) = made("population", "tshirt", run, &turns.to_vec()).expect("sizes");
            assert_eq!(handles, tshirt);
            assert!(nest.apart_m < APART_M && nest.styles.len() == run.count, "{}", nest.apart_m);
            assert!(nest.rules < 60, "{} rules", nest.rules);
        };
        check(Run { count: 3, split: None }, &[-10, -5, 0, -6, -4, 20, 20, 20]);
        check(Run { count: 5, split: Some(3) }, &[0, 0, 0, 0, 0, 10, 12, 9, 20, 22, 18]);
    }
}

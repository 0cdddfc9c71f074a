//! The sizes as files: a DXF file each, and the base size with the rules of the nest. These are read again and compared
//! with the sizes as drawn.

use crate::error::AdviceError;
use crate::grading::Asked;
use crate::grading::knobs::Knobs;
use fit::coverage::Turns;
use geom::V2;
use geom::polyline::segment_distance;
use geom::units::mm;
use pattern::dxf::{self, PatternFile, Standard};
use pattern::grade::{self, Ungraded};
use pattern::handle::Redrawn;
use pattern::{Piece, Style};
use report::FileNames;
use spec::patterns;
use store::files::SourceFile;
use store::{InOrigin, Origin, Result};

/// Greatest accepted distance between a size as drawn and as the rules make it, m.
const APART_M: f64 = 0.1e-3;

/// The sizes, written and read again.
pub struct Nest {
    /// Each size, as the rules make it.
    pub styles: Vec<Style>,
    /// Greatest distance between a size as drawn and as the rules make it, m.
    pub apart_m: f64,
    /// Files by name: patterns, rules and seam file.
    pub files: Vec<(String, Vec<u8>)>,
}

/// Draws the sizes, writes them as rules, and reads them again.
///
/// # Errors
/// When a handle cannot move so far, the sizes are no nest, or the rules do not make the sizes again.
pub fn drawn(
    asked: &Asked<'_>,
    seams: &SourceFile,
    names: &[String],
    knobs: &Knobs<'_>,
    turns: &Turns,
) -> Result<Nest> {
    let spec = &asked.spec;
    let garment = &spec.garment;
    let unit = spec.unit.as_deref().and_then(patterns::unit_of);
    let base = patterns::pieces(&spec.pattern, Some(&spec.size), unit)?;
    let texts = |size: &str| {
        let texts = [("Style Name", garment.as_str()), ("Sample Size", size), ("Units", "METRIC")];
        texts.map(|(key, value)| (key.to_owned(), value.to_owned()))
    };
    let mut parts = FileNames::default();
    let whole = parts.part(garment);
    let mut files = vec![(format!("{whole}.seams.toml"), seams.bytes.to_vec())];
    let mut nest: Option<PatternFile> = None;
    for (name, turns) in names.iter().zip(turns) {
        let redrawn = Redrawn::of(&base, &seams.bytes, &seams.name, &knobs.moves(turns));
        let mut pieces = redrawn.origin(Origin::Grade)?.pieces();
        pieces.iter_mut().for_each(|piece| piece.size = Some(name.clone()));
        let file = format!("{}.dxf", parts.part(&format!("{garment}-{name}")));
        let written = dxf::write_pieces(&pieces, &texts(name), Standard::Aama);
        let read = dxf::read(&written, &file, None).origin(Origin::Grade)?;
        files.push((file, written));
        match &mut nest {
            Some(nest) => nest.pieces.extend(read.pieces),
            None => nest = Some(read),
        }
    }
    let nest = nest.ok_or(AdviceError::EmptyNest)?;
    // The sample is the size in the middle, as usual.
    let sample = &names[names.len().saturating_sub(1) / 2];
    let Ungraded { pieces, table, .. } = grade::ungrade(&nest, sample).origin(Origin::Grade)?;
    let texts = texts(sample).into_iter().chain([grade::named_in_pattern(&whole)]).collect::<Vec<_>>();
    let written = dxf::write_pieces(&pieces, &texts, Standard::Aama);
    let rules = grade::write(&table, &whole, Standard::Aama);
    let (again, apart_m) = again(&nest, &written, rules.as_bytes(), &whole)?;
    let style = |name: &String| {
        let pieces = again.to_sew(Some(name)).origin(Origin::Grade)?;
        Style::read(&pieces, &seams.bytes, &seams.name).origin(Origin::Grade)
    };
    let styles = names.iter().map(style).collect::<Result<_>>()?;
    files.push((format!("{whole}.dxf"), written));
    files.push((format!("{whole}.rul"), rules.into_bytes()));
    Ok(Nest { styles, apart_m, files })
}

/// Sizes that the written sample size and rules make, with their greatest distance from the nest, m.
fn again(nest: &PatternFile, written: &[u8], rules: &[u8], name: &str) -> Result<(PatternFile, f64)> {
    let sample = dxf::read(written, &format!("{name}.dxf"), None).origin(Origin::Grade)?;
    let table = grade::read(rules, &format!("{name}.rul")).origin(Origin::Grade)?;
    let again = grade::grade(&sample, &table).origin(Origin::Grade)?;
    let mut apart_m: f64 = 0.0;
    for piece in &nest.pieces {
        let is_it = |other: &&Piece| other.name == piece.name && other.size == piece.size;
        let other = again.pieces.iter().find(is_it);
        let other = other.ok_or_else(|| AdviceError::NoPiece { piece: piece.name.clone() })?;
        let apart = away(&piece.outline, &other.outline).max(away(&other.outline, &piece.outline));
        if apart > APART_M {
            let size = piece.size.clone().unwrap_or_default();
            let (apart_mm, accepted_mm) = (mm(apart), mm(APART_M));
            return Err(AdviceError::OtherPiece { piece: piece.name.clone(), size, apart_mm, accepted_mm }.into());
        }
        apart_m = apart_m.max(apart);
    }
    Ok((again, apart_m))
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

    /// Sizes of a study's garment by turns of its knobs, and the names of the knobs.
    fn made(study: &str, garment: &str, turns: &[Vec<i32>]) -> Result<(Nest, Vec<&'static str>)> {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studies").join(study);
        let study = Study::load(&folder, &catalogue::known(None)?)?;
        let wish = GradeWish { garment: Some(garment.to_owned()), sizes: Some(turns.len()), ..GradeWish::default() };
        let asked = Asked::of(&study, &wish)?;
        let own = asked.own()?;
        let [somebody, _] = people::drawn(asked.sex, [1, 1], 1);
        let figures: Vec<Figure> = people::figures(&somebody, false);
        let bands = bands(asked.entry, &figures[0].covered(&own[asked.base]), &[])?;
        let knobs = Knobs::of(&own[asked.base], &own, &figures[0], &bands, 0.1)?;
        let seams = asked.spec.seams.clone().expect("a seam file");
        let nest = drawn(&asked, &seams, &asked.names(), &knobs, &turns.to_vec())?;
        Ok((nest, knobs.handles.iter().map(|handle| handle.as_str()).collect()))
    }

    #[test]
    fn rules_make_the_sizes_again_that_were_drawn() {
        let tshirt = ["chest", "waist", "hem", "shoulder_length", "bicep"];
        let turns: [&[Vec<i32>]; 3] = [
            &[vec![-30, -20, -10, -10, -8], vec![0; 5], vec![40, 45, 50, 6, 10]],
            &[vec![5, 9, 23, -7, 1], vec![31, 30, 37, -7, 6], vec![60, 70, 75, -7, 10]],
            &[vec![13, 4, 2, -11, -3], vec![47, 33, 21, -11, 3], vec![79, 73, 57, -3, 19]],
        ];
        for turns in turns {
            let (nest, handles) = made("population", "tshirt", turns).expect("sizes");
            assert_eq!(handles, tshirt);
            assert!(nest.apart_m < APART_M && nest.styles.len() == turns.len(), "{}", nest.apart_m);
        }
    }
}

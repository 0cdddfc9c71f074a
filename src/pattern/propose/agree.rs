//! What lengths say: outlines that differ, and yet are equally long along a seam to a part of a millimetre, were drafted for each
//! other, so each is what it was taken for.

use super::ProposedSeam;
use super::worn::Worn;
use geom::units::mm;

/// Difference of length of sides that were drafted for each other, mm: what files round.
const EXACT_MM: f64 = 0.5;
/// Share of the remaining doubt in a piece that a seam of equal sides takes away.
const GAIN: f64 = 0.3;

/// The pieces, surer by what the lengths along `seams`, proposed for them, say.
pub fn assured(mut worn: Vec<Worn>, seams: &[ProposedSeam]) -> Vec<Worn> {
    let agreed: Vec<Vec<f64>> = worn.iter().map(|one| agreed_mm(one, &worn, seams)).collect();
    for (one, lengths) in worn.iter_mut().zip(agreed) {
        one.confidence = 1.0 - (1.0 - one.confidence) * (1.0 - GAIN).powi(lengths.len() as i32);
    }
    worn
}

/// Lengths along which a piece agrees with unlike ones, mm; what comes twice, on the right and on the left, says nothing new.
fn agreed_mm(one: &Worn, worn: &[Worn], seams: &[ProposedSeam]) -> Vec<f64> {
    let mut lengths: Vec<f64> = Vec::new();
    for seam in seams.iter().filter(|seam| (seam.a_mm - seam.b_mm).abs() < EXACT_MM) {
        let sides = [&seam.entry.a, &seam.entry.b].map(|edges| pieces(worn, edges));
        let is_other = |side: &Vec<&Worn>| side.iter().all(|other| !are_alike(one, other));
        let has_one = |side: &Vec<&Worn>| side.iter().any(|own| own.id == one.id);
        let agrees = (has_one(&sides[0]) && is_other(&sides[1])) || (has_one(&sides[1]) && is_other(&sides[0]));
        if agrees && lengths.iter().all(|known| (known - seam.a_mm).abs() > EXACT_MM) {
            lengths.push(seam.a_mm);
        }
    }
    lengths
}

fn pieces<'w>(worn: &'w [Worn], edges: &[String]) -> Vec<&'w Worn> {
    let ids = edges.iter().filter_map(|edge| edge.split_once('.').map(|(id, _)| id));
    ids.filter_map(|id| worn.iter().find(|one| one.id == id)).collect()
}

/// Whether two pieces may be one outline twice, or its mirror image: then equal sides are no wonder.
fn are_alike(one: &Worn, other: &Worn) -> bool {
    let lengths = |worn: &Worn| {
        let mut lengths: Vec<f64> = worn.edges.iter().map(|edge| mm(edge.length)).collect();
        lengths.sort_by(f64::total_cmp);
        lengths
    };
    let (these, those) = (lengths(one), lengths(other));
    one.piece == other.piece
        || (these.len() == those.len() && these.iter().zip(&those).all(|(a, b)| (a - b).abs() < EXACT_MM))
}

//! Evidence of equal lengths: outlines that differ, and yet are equally long along a seam to a fraction of a
//! millimetre, were drafted for each other. So each is what it was recognised as.

use super::ProposedSeam;
use super::worn_pieces::Worn;
use geom::units::mm;

/// Greatest difference in length of sides that were drafted for each other: the rounding of files.
const EXACT_MM: f64 = 0.5;
/// Share of the remaining doubt in a piece that one seam with equal sides removes.
const GAIN: f64 = 0.3;

pub fn assured(mut worn: Vec<Worn>, seams: &[ProposedSeam]) -> Vec<Worn> {
    let agreed: Vec<Vec<f64>> = worn.iter().map(|piece| agreed_mm(piece, &worn, seams)).collect();
    for (piece, lengths) in worn.iter_mut().zip(agreed) {
        piece.confidence = 1.0 - (1.0 - piece.confidence) * (1.0 - GAIN).powi(lengths.len() as i32);
    }
    worn
}

/// Lengths that agree with those of others. One that occurs twice, right and left, counts once.
fn agreed_mm(piece: &Worn, worn: &[Worn], seams: &[ProposedSeam]) -> Vec<f64> {
    let mut lengths: Vec<f64> = Vec::new();
    for seam in seams.iter().filter(|seam| (seam.a_mm - seam.b_mm).abs() < EXACT_MM) {
        let sides = [&seam.entry.a, &seam.entry.b].map(|edges| pieces(worn, edges));
        let is_other = |side: &Vec<&Worn>| side.iter().all(|other| !are_alike(piece, other));
        let has_it = |side: &Vec<&Worn>| side.iter().any(|own| own.id == piece.id);
        let agrees = (has_it(&sides[0]) && is_other(&sides[1])) || (has_it(&sides[1]) && is_other(&sides[0]));
        if agrees && lengths.iter().all(|known| (known - seam.a_mm).abs() > EXACT_MM) {
            lengths.push(seam.a_mm);
        }
    }
    lengths
}

fn pieces<'w>(worn: &'w [Worn], edges: &[String]) -> Vec<&'w Worn> {
    let ids = edges.iter().filter_map(|edge| edge.split_once('.').map(|(id, _)| id));
    ids.filter_map(|id| worn.iter().find(|piece| piece.id == id)).collect()
}

/// True if two pieces may have the same outline, or mirror images of it. Equal sides are then no evidence.
fn are_alike(worn: &Worn, other: &Worn) -> bool {
    let lengths = |worn: &Worn| {
        let mut lengths: Vec<f64> = worn.edges.iter().map(|edge| mm(edge.length)).collect();
        lengths.sort_by(f64::total_cmp);
        lengths
    };
    let (these, those) = (lengths(worn), lengths(other));
    worn.piece == other.piece
        || (these.len() == those.len() && these.iter().zip(&those).all(|(a, b)| (a - b).abs() < EXACT_MM))
}

//! Placement of the ends of edges by the lengths of their seam partners.
//!
//! A vent, a step at a hem or a shifted seam puts corners near each other. The outline alone does not show at which of
//! these the side ends and the armhole begins. The partner does, because both sides of a seam are equally long.

use super::ask::Asker;
use super::recognised::Recognised;
use super::{sew, worn_pieces};
use crate::piece::Piece;

/// Greatest length moved from one edge to its neighbour, as a share of the shorter edge.
const MOVED_SHARE: f64 = 0.2;
/// Least gain in the sum of the confidences of all seams for which an end is moved.
const GAIN: f64 = 0.05;
const MOST_CORNERS: usize = 3;
const MOST_CHANGES: usize = 16;

/// Moves ends of edges to other corners while this raises the confidence of the seams of the whole garment.
pub fn settle(pieces: &[Piece], recognised: &mut [Recognised], asker: &Asker<'_>) {
    let mut sum = agreement(pieces, recognised, asker);
    for _ in 0..MOST_CHANGES {
        let mut best: Option<(f64, usize, Recognised)> = None;
        for index in 0..recognised.len() {
            for changed in changes(&recognised[index]) {
                let kept = std::mem::replace(&mut recognised[index], changed);
                let found = agreement(pieces, recognised, asker);
                let changed = std::mem::replace(&mut recognised[index], kept);
                if found > best.as_ref().map_or(sum + GAIN, |best| best.0) {
                    best = Some((found, index, changed));
                }
            }
        }
        let Some((found, index, changed)) = best else { return };
        (sum, recognised[index]) = (found, changed);
    }
}

/// Sum of the confidences of all proposed seams.
fn agreement(pieces: &[Piece], recognised: &[Recognised], asker: &Asker<'_>) -> f64 {
    let worn = worn_pieces::worn(pieces, recognised, None, &mut asker.aside());
    sew::sew(&worn, &mut asker.aside()).iter().map(|seam| seam.confidence).sum()
}

fn changes(candidate: &Recognised) -> Vec<Recognised> {
    let parts = &candidate.alignment.parts;
    let n = parts.len();
    let mut all = Vec::new();
    for first in 0..n {
        for corners in 1..=MOST_CORNERS {
            for is_longer in [true, false] {
                let Some(changed) = moved(candidate, first, corners, is_longer) else { continue };
                // If the other side of the piece has the same two edges in reverse order, they are moved too.
                let (label, next) = (parts[first].label, parts[(first + 1) % n].label);
                let twin = (0..n).find(|&k| k != first && parts[k].label == next && parts[(k + 1) % n].label == label);
                all.extend(twin.and_then(|twin| moved(&changed, twin, corners, !is_longer)));
                all.push(changed);
            }
        }
    }
    all
}

/// Moves the end of an edge by some corners, forwards if `is_longer`.
fn moved(candidate: &Recognised, first: usize, corners: usize, is_longer: bool) -> Option<Recognised> {
    let (shape, n) = (&candidate.shape, candidate.shape.len());
    let second = (first + 1) % candidate.alignment.parts.len();
    let [a, b] = [first, second].map(|k| candidate.alignment.parts[k]);
    let (given, from) = if is_longer { (b, b.from) } else { (a, (b.from + n - corners) % n) };
    if given.span <= corners || (0..corners).any(|k| shape.is_leg((from + k) % n)) {
        return None;
    }
    let length = |from: usize, span: usize| shape.sewn_length(from, span);
    if length(from, corners) > MOVED_SHARE * length(a.from, a.span).min(length(b.from, b.span)) {
        return None;
    }
    let mut changed = candidate.clone();
    let parts = &mut changed.alignment.parts;
    if is_longer {
        parts[first].span += corners;
        (parts[second].from, parts[second].span) = ((b.from + corners) % n, b.span - corners);
    } else {
        parts[first].span -= corners;
        (parts[second].from, parts[second].span) = ((b.from + n - corners) % n, b.span + corners);
    }
    Some(changed)
}

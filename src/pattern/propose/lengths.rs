//! Where one edge ends and the next begins, told by the lengths of what they are sewn to.
//!
//! A vent, a step at a hem or a shift of a seam puts corners near each other, and an outline alone does not say at which of them the side
//! ends and the armhole begins. The other piece does: sides that are sewn are as long as each other.

use super::ask::Asker;
use super::recognise::Recognised;
use super::{sew, worn};
use crate::piece::Piece;

/// Greatest length that changes from one edge to its neighbour, share of the shorter.
const MOVED_SHARE: f64 = 0.2;
/// Least gain in the sum of all seams' confidences that a change is made for.
const GAIN: f64 = 0.05;
/// Most corners that an end of an edge is moved by.
const MOST_CORNERS: usize = 3;
/// Changes after which the search ends at the latest.
const MOST_CHANGES: usize = 16;

/// Moves ends of edges to other corners while the seams of the whole garment agree better for it.
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

/// Sum of the confidences of the seams that are found.
fn agreement(pieces: &[Piece], recognised: &[Recognised], asker: &Asker<'_>) -> f64 {
    let worn = worn::worn(pieces, recognised, None, &mut asker.aside());
    sew::sew(&worn, &mut asker.aside()).iter().map(|seam| seam.confidence).sum()
}

/// A piece with the end of one edge, or of both alike edges of its two sides, at another corner.
fn changes(one: &Recognised) -> Vec<Recognised> {
    let parts = &one.alignment.parts;
    let n = parts.len();
    let mut all = Vec::new();
    for first in 0..n {
        for corners in 1..=MOST_CORNERS {
            for is_longer in [true, false] {
                let Some(changed) = moved(one, first, corners, is_longer) else { continue };
                // The same on the other side, where the piece has the two edges there too, the other way round.
                let (label, next) = (parts[first].label, parts[(first + 1) % n].label);
                let twin = (0..n).find(|&k| k != first && parts[k].label == next && parts[(k + 1) % n].label == label);
                all.extend(twin.and_then(|twin| moved(&changed, twin, corners, !is_longer)));
                all.push(changed);
            }
        }
    }
    all
}

/// A piece with the end of an edge moved on by some corners, or back.
fn moved(one: &Recognised, first: usize, corners: usize, is_longer: bool) -> Option<Recognised> {
    let (shape, n) = (&one.shape, one.shape.len());
    let second = (first + 1) % one.alignment.parts.len();
    let [a, b] = [first, second].map(|k| one.alignment.parts[k]);
    let (given, from) = if is_longer { (b, b.from) } else { (a, (b.from + n - corners) % n) };
    if given.span <= corners || (0..corners).any(|k| shape.is_leg((from + k) % n)) {
        return None;
    }
    let length = |from: usize, span: usize| shape.sewn_length(from, span);
    if length(from, corners) > MOVED_SHARE * length(a.from, a.span).min(length(b.from, b.span)) {
        return None;
    }
    let mut changed = one.clone();
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

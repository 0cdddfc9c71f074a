//! Detection of the arm for which a sleeve is drawn, by its cap: the front half is hollower, because the arm reaches
//! forwards.

use super::recognised::Recognised;
use super::{Class, Hand, Label};
use geom::V2;

/// Relative difference of the areas under both halves of a cap below which the halves count as equal.
const ALIKE: f64 = 0.02;

/// Arm for which a whole sleeve is drawn. A sleeve with equal halves may serve either, and counts as right. `None`
/// without a whole sleeve.
pub fn drawn_sleeve(recognised: &[Recognised], notes: &mut Vec<String>) -> Option<Hand> {
    let is_whole = |candidate: &&Recognised| {
        candidate.class == Class::Sleeve && candidate.alignment.template.is_whole && candidate.hand.is_none()
    };
    let sleeve = recognised.iter().find(is_whole)?;
    let [left, right] = halves(sleeve)?;
    let difference = 2.0 * (left - right) / (left + right);
    if difference.abs() < ALIKE {
        return Some(Hand::Right);
    }
    // Upright and seen from outside, the front of a right sleeve is on the right.
    let hand = if difference > 0.0 { Hand::Right } else { Hand::Left };
    notes.push(format!("the sleeve is taken to be drawn as the {hand} one: the hollower half of its cap is its front"));
    Some(hand)
}

/// Areas between a cap and its chord left and right of the midpoint of the chord, of the upright piece.
fn halves(sleeve: &Recognised) -> Option<[f64; 2]> {
    let (shape, _) = sleeve.shape.framed(sleeve.alignment.quarter_turns);
    let cap = sleeve.alignment.parts.iter().find(|part| part.label == Label::Cap)?;
    let mut points: Vec<V2> = (0..cap.span).flat_map(|k| shape.points((cap.from + k) % shape.len())).collect();
    points.dedup();
    let (from, to) = (*points.first()?, *points.last()?);
    let along = (to - from).try_normalize(1e-9)?;
    let half = 0.5 * (to - from).norm();
    let local: Vec<V2> =
        points.iter().map(|p| V2::new(along.dot(&(p - from)) - half, along.perp(&(p - from)))).collect();
    let mut areas = [0.0; 2];
    for ends in local.windows(2) {
        // Counter-clockwise, the cap runs from right to left, so it lies to the right of its directed chord.
        let (a, b) = (ends[0], ends[1]);
        for (k, side) in [1.0, -1.0].into_iter().enumerate() {
            let clipped = |p: V2| p.x * side > 0.0;
            let (mut a, mut b) = (a, b);
            if !clipped(a) && !clipped(b) {
                continue;
            }
            if clipped(a) != clipped(b) {
                let middle = a + (b - a) * (a.x / (a.x - b.x));
                if clipped(a) { b = middle } else { a = middle }
            }
            areas[k] += 0.5 * (a.y + b.y).abs() * (b.x - a.x).abs();
        }
    }
    (areas.iter().all(|area| *area > 0.0)).then_some(areas)
}

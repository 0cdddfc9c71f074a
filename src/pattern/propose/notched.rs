//! Evidence of notches: do two sides belong together, and in which direction?

use super::worn_pieces::{Along, Worn};
use super::{Class, Face, Hand, Label};

/// Greatest distance of two matching notches, as a share of the length of the seam.
const SAME_SHARE: f64 = 0.03;
/// Least difference in agreement between both directions that decides between them.
const CLEAR: f64 = 0.3;

type Side<'w> = [Along<'w>];

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Evidence {
    /// Notches match better than reversed, or all of them.
    For,
    /// Notches match better with one side reversed.
    Turned,
    /// Too few notches, or a match in neither direction.
    None,
}

/// Side `a` is walked counter-clockwise, side `b` clockwise.
pub fn evidence(a: &Side<'_>, b: &Side<'_>) -> Evidence {
    let (a, b) = (shares(a, true), shares(b, false));
    if a.is_empty() || b.is_empty() {
        return Evidence::None;
    }
    let turned: Vec<f64> = b.iter().map(|share| 1.0 - share).collect();
    let (straight, turned) = (agreement(&a, &b), agreement(&a, &turned));
    if turned > straight + CLEAR {
        Evidence::Turned
    } else if straight > turned + CLEAR || straight > 1.0 - 1e-9 {
        Evidence::For
    } else {
        Evidence::None
    }
}

/// Share of the notches of both sides that have a partner, each at most one.
fn agreement(a: &[f64], b: &[f64]) -> f64 {
    let mut free: Vec<f64> = b.to_vec();
    let mut matched = 0;
    for share in a {
        let nearest = (0..free.len()).min_by(|&i, &j| (free[i] - share).abs().total_cmp(&(free[j] - share).abs()));
        if let Some(nearest) = nearest.filter(|&i| (free[i] - share).abs() < SAME_SHARE) {
            free.swap_remove(nearest);
            matched += 1;
        }
    }
    2.0 * f64::from(matched) / (a.len() + b.len()) as f64
}

fn shares(side: &Side<'_>, is_forwards: bool) -> Vec<f64> {
    let total = length(side);
    let mut shares = Vec::new();
    let mut before = 0.0;
    for Along { edge, .. } in side {
        for &arc in &edge.notches {
            shares.push((before + if is_forwards { arc } else { edge.length - arc }) / total);
        }
        before += edge.length;
    }
    shares
}

/// Arm for which a whole sleeve is drawn whose name gives none, by the notches of cap and armhole. `worn` has it as the
/// right sleeve. `None` if the notches do not decide.
pub fn drawn_sleeve(worn: &[Worn]) -> Option<Hand> {
    let right = Some(Hand::Right);
    let cap = worn.iter().find(|worn| worn.class == Class::Sleeve && worn.is_whole && worn.hand == right)?;
    let armhole_of = |class, face| {
        let is_it = |worn: &&Worn| worn.class == class && worn.face == Some(face) && worn.hand != Some(Hand::Left);
        worn.iter().find(is_it).map_or_else(Vec::new, |worn| worn.chain_back(Label::Armhole, right))
    };
    let [front, back] = [[Class::SidePanel, Class::Body], [Class::Body, Class::SidePanel]];
    let front: Vec<_> = front.into_iter().flat_map(|class| armhole_of(class, Face::Front)).collect();
    let back: Vec<_> = back.into_iter().flat_map(|class| armhole_of(class, Face::Back)).collect();
    // Both sides of a raglan sleeve are sewn separately, and their notches lie at similar shares, so their lengths
    // decide.
    let sides = Hand::BOTH.map(|side| length(&cap.chain(Label::Cap, Some(side))));
    let by_lengths = cap.has(Label::Neck).then(|| by_lengths(sides, [length(&front), length(&back)])).flatten();
    by_lengths.or_else(|| match evidence(&cap.chain(Label::Cap, None), &[front, back].concat()) {
        Evidence::For => Some(Hand::Right),
        Evidence::Turned => Some(Hand::Left),
        Evidence::None => None,
    })
}

/// Compares a raglan sleeve's lengths with those of front and back, m. `None` if they do not decide.
fn by_lengths([right, left]: [f64; 2], [front, back]: [f64; 2]) -> Option<Hand> {
    let as_right = (right - front).abs() + (left - back).abs();
    let as_left = (right - back).abs() + (left - front).abs();
    let is_clear = (as_right - as_left).abs() > SAME_SHARE * (front + back);
    is_clear.then_some(if as_right < as_left { Hand::Right } else { Hand::Left })
}

/// In m.
fn length(side: &Side<'_>) -> f64 {
    side.iter().map(|along| along.edge.length).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn notches_agree_one_to_one() {
        for (a, b, expect) in [
            (&[0.2, 0.5][..], &[0.21, 0.49][..], 1.0),
            (&[0.2], &[0.8], 0.0),
            (&[0.2, 0.21], &[0.2], 2.0 / 3.0),
            (&[0.3, 0.7], &[0.3, 0.9], 0.5),
        ] {
            assert!((agreement(a, b) - expect).abs() < 1e-12, "{a:?} {b:?}");
        }
    }
}

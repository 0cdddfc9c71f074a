//! Congruent parts: mirror images, halves of one symmetric part, and equal copies.

use geom::V2;

use super::stretch::{Part, Stretch};

/// Greatest difference of corresponding lengths and points. Files round to hundredths of a millimetre, and drawn mirror
/// images are often redrawn.
const SAME_M: f64 = 1e-3;

/// Correspondences between stretches. Mirror images run backwards.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Symmetry {
    /// Mirror image in the same part.
    pub own: Vec<Option<usize>>,
    /// Mirror image in another part, which has this one as its own image.
    pub twin: Vec<Option<usize>>,
    /// For each part, the first part that is equal to it without being turned over.
    pub kind: Vec<usize>,
    /// The same stretch of the first part that is equal to this one without being turned over.
    pub like: Vec<usize>,
    /// For each part, the number of equal parts, itself included.
    pub copies: Vec<usize>,
    /// For each part, its mirror image.
    pub twin_part: Vec<Option<usize>>,
}

/// Corner and middle of each stretch, m.
struct Frame {
    first: usize,
    lengths: Vec<f64>,
    corners: Vec<V2>,
    middles: Vec<V2>,
}

pub fn symmetry(parts: &[Part], stretches: &[Stretch]) -> Symmetry {
    let frames: Vec<Frame> = (0..parts.len()).map(|part| frame(part, &parts[part], stretches)).collect();
    let mut found =
        Symmetry { own: vec![None; stretches.len()], twin: vec![None; stretches.len()], ..Symmetry::default() };
    for (i, frame) in frames.iter().enumerate() {
        let n = frame.lengths.len();
        let first = (0..i).find_map(|j| Some((j, equal(&frames[j], frame)?)));
        let (kind, shift) = first.unwrap_or((i, 0));
        found.kind.push(kind);
        found.like.extend((0..n).map(|k| frames[kind].first + (k + n - shift) % n));
    }
    found.copies = found.kind.iter().map(|kind| found.kind.iter().filter(|other| *other == kind).count()).collect();
    for frame in &frames {
        for (from, to) in mirrored(frame, frame).into_iter().flatten() {
            found.own[from] = Some(to);
        }
    }
    found.twin_part = vec![None; parts.len()];
    let mut pairs: Vec<(usize, usize)> = Vec::new();
    for i in 0..parts.len() {
        pairs.extend((i + 1..parts.len()).filter(|&j| mirrored(&frames[i], &frames[j]).is_some()).map(|j| (i, j)));
    }
    // Of several images, that of the other hand.
    pairs.sort_by_key(|&(i, j)| (!are_hands(&parts[i], &parts[j]), j - i, i));
    for (i, j) in pairs {
        if found.twin_part[i].is_none() && found.twin_part[j].is_none() {
            (found.twin_part[i], found.twin_part[j]) = (Some(j), Some(i));
            for (from, to) in mirrored(&frames[i], &frames[j]).into_iter().flatten() {
                (found.twin[from], found.twin[to]) = (Some(to), Some(from));
            }
        }
    }
    found
}

fn are_hands(a: &Part, b: &Part) -> bool {
    let is_other = a.said.hand.is_some() && a.said.hand == b.said.hand.map(crate::trade::Hand::other);
    is_other && (a.said.class, a.said.face) == (b.said.class, b.said.face)
}

fn frame(part: usize, drawn: &Part, stretches: &[Stretch]) -> Frame {
    let first = stretches.partition_point(|stretch| stretch.part < part);
    let own = &stretches[first..first + drawn.corners.len()];
    Frame {
        first,
        lengths: own.iter().map(|stretch| stretch.length).collect(),
        corners: drawn.corners.iter().map(|&corner| drawn.outline[corner]).collect(),
        middles: own.iter().map(|stretch| stretch.middle).collect(),
    }
}

/// Number of the stretch of `b` that is the first one of `a`. `None` for parts that are not equal.
fn equal(a: &Frame, b: &Frame) -> Option<usize> {
    let n = a.lengths.len();
    let fits = |shift: &usize| {
        let to = |k: usize| (k + shift) % n;
        let is_long = (0..n).all(|k| (a.lengths[k] - b.lengths[to(k)]).abs() < SAME_M);
        is_long && is_rigid((0..n).flat_map(|k| [(a.corners[k], b.corners[to(k)]), (a.middles[k], b.middles[to(k)])]))
    };
    if n == b.lengths.len() { (0..n).find(fits) } else { None }
}

/// Stretch of `a` and its image in `b`, each as an index among all stretches. `None` without a mirror image. A straight
/// stretch that is its own image says no symmetry by itself: the whole outline has to agree.
fn mirrored(a: &Frame, b: &Frame) -> Option<Vec<(usize, usize)>> {
    let n = a.lengths.len();
    if n != b.lengths.len() {
        return None;
    }
    let turned = |point: V2| V2::new(-point.x, point.y);
    let fits = |shift: &usize| {
        let to = |k: usize| (shift + n - k) % n;
        let is_long = (0..n).all(|k| (a.lengths[k] - b.lengths[to(k)]).abs() < SAME_M);
        let points =
            |k: usize| [(a.corners[k], turned(b.corners[(to(k) + 1) % n])), (a.middles[k], turned(b.middles[to(k)]))];
        is_long && is_rigid((0..n).flat_map(points))
    };
    let shift = (0..n).find(fits)?;
    Some((0..n).map(|k| (a.first + k, b.first + (shift + n - k) % n)).collect())
}

/// True if a rotation and a shift take the second points onto the first.
fn is_rigid(pairs: impl Iterator<Item = (V2, V2)>) -> bool {
    let pairs: Vec<(V2, V2)> = pairs.collect();
    let count = pairs.len() as f64;
    let (sum_a, sum_b) = pairs.iter().fold((V2::zeros(), V2::zeros()), |(a, b), (p, q)| (a + p, b + q));
    let (mean_a, mean_b) = (sum_a / count, sum_b / count);
    let centred = || pairs.iter().map(|(p, q)| (p - mean_a, q - mean_b));
    let (cos, sin) = centred().fold((0.0, 0.0), |(cos, sin), (p, q)| (cos + q.dot(&p), sin + q.perp(&p)));
    let size = cos.hypot(sin).max(f64::MIN_POSITIVE);
    let (cos, sin) = (cos / size, sin / size);
    centred().all(|(p, q)| (V2::new(cos * q.x - sin * q.y, sin * q.x + cos * q.y) - p).norm() < SAME_M)
}

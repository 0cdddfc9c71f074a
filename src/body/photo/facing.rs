//! Direction that the subject of a side picture faces. Front cameras of phones mirror pictures, and people turn either
//! way.

use super::sections::{LOWEST, SIDES, STEP};
use super::silhouette::Mask;
use super::trunk;
use crate::Sex;

/// Ranges of height of feet and ankles, as shares of the height of the figure. Seen from above, insteps reach up to
/// 0.08. Judgement.
const FEET: [f64; 2] = [0.0, 0.05];
const ANKLES: [f64; 2] = [0.10, 0.14];

/// Least distance between the middles of feet and ankles that tells the direction, as a share of stature. Toes reach
/// 0.08 in front of the ankle and heels 0.02 behind it, so the distance is about 0.03, of which this is a third.
const FORWARD: f64 = 0.01;

/// Least correlation that tells the direction: of the line through the middle of the trunk, from thigh to shoulders,
/// with that of people. They then share a quarter of their variance.
const ALIKE: f64 = 0.5;

/// Turns a side silhouette to face right. Returns a note for the user if it was turned or is undecided.
pub(super) fn to_the_right(mask: Mask, sex: Sex) -> (Mask, Option<String>) {
    let Some(rows) = mask.rows() else { return (mask, None) };
    let told = by_toes(&mask, rows) + by_trunk(&mask, rows, sex);
    match told.signum() {
        1 => (mask, None),
        -1 => {
            (mask.mirrored(), Some("the side picture faces its left, as toes and trunk tell: it was turned".to_owned()))
        }
        _ => {
            let note = "toes and trunk do not tell which way the side picture faces: it is taken to face its right";
            (mask, Some(note.to_owned()))
        }
    }
}

/// Direction of the toes: 1 to the right, -1 to the left, 0 undecided.
fn by_toes(mask: &Mask, rows: (usize, usize)) -> i32 {
    let forward = middle(mask, rows, FEET).zip(middle(mask, rows, ANKLES)).map_or(0.0, |(feet, ankles)| feet - ankles);
    sign(forward / (rows.1 + 1 - rows.0) as f64, FORWARD)
}

/// Middle column of the silhouette between two heights, as shares of the height of the figure. `None` without pixels.
fn middle(mask: &Mask, rows: (usize, usize), heights: [f64; 2]) -> Option<f64> {
    let [low, high] = heights.map(|height| row(rows, height));
    let runs: Vec<_> = (high..=low).flat_map(|row| mask.runs(row)).collect();
    let (left, right) = (runs.iter().map(|run| run.0).min()?, runs.iter().map(|run| run.1).max()?);
    Some((left + right) as f64 / 2.0)
}

/// Direction by belly, buttocks and the bend of the back, as of [`by_toes`].
fn by_trunk(mask: &Mask, rows: (usize, usize), sex: Sex) -> i32 {
    let widest = |height: f64| mask.runs(row(rows, height)).into_iter().max_by_key(|(start, end)| end - start);
    by_middles(|height| widest(height).map(|(start, end)| (start + end) as f64 / 2.0), sex)
}

/// Direction by the middle of a trunk (mean of back and front) at heights as shares of stature: 1 if it varies as in
/// people, -1 if it varies in the opposite way, 0 if undecided.
pub(crate) fn by_middles(middle: impl Fn(f64) -> Option<f64>, sex: Sex) -> i32 {
    let usual = trunk::usual_middles(sex);
    let both = (0..SIDES).filter_map(|i| Some((middle(LOWEST + STEP * i as f64)?, usual[i])));
    let (seen, usual): (Vec<f64>, Vec<f64>) = both.unzip();
    if 2 * seen.len() < SIDES { 0 } else { sign(correlation(&seen, &usual), ALIKE) }
}

fn row(rows: (usize, usize), height: f64) -> usize {
    rows.1 - (height * (rows.1 - rows.0) as f64) as usize
}

fn sign(value: f64, least: f64) -> i32 {
    i32::from(value > least) - i32::from(value < -least)
}

fn correlation(a: &[f64], b: &[f64]) -> f64 {
    let from_mean = |values: &[f64]| {
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        values.iter().map(|value| value - mean).collect::<Vec<_>>()
    };
    let (a, b) = (from_mean(a), from_mean(b));
    let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    product(&a, &b) / (product(&a, &a) * product(&b, &b)).sqrt().max(f64::MIN_POSITIVE)
}

//! Equations of the text that cannot be right, evaluated on numbers.

use crate::audit::{Audit, Finding};
use geom::V3;

/// Greatest difference that counts as rounding.
const EXACT: f64 = 1e-9;

/// Evaluates the printed equations (4.8), (4.9) and (4.20).
pub(super) fn check() -> Audit {
    Audit { recomputed: 3, findings: [rotation(), axis(), average()].into_iter().flatten().collect() }
}

/// (4.8) rotates a vector about an axis, so the length must stay.
fn rotation() -> Option<Finding> {
    let axis = V3::z_axis();
    let v = V3::new(1.0, 0.0, 1.0);
    let angle: f64 = 0.5;
    let (sin, cos) = angle.sin_cos();
    let printed = v * cos + axis.cross(&v) * sin + axis.into_inner() * (axis.dot(&v) * sin * (1.0 - cos));
    let rodrigues = v * cos + axis.cross(&v) * sin + axis.into_inner() * (axis.dot(&v) * (1.0 - cos));
    let grows = |turned: &V3| turned.norm() / v.norm();
    ((grows(&printed) - 1.0).abs() > EXACT).then(|| Finding {
        kind: "equation",
        place: "equation (4.8)".into(),
        stated: format!("length times {:.4} for (1, 0, 1) by 0.5 rad about z", grows(&printed)),
        recomputed: format!("times {:.4} without the last sine", grows(&rodrigues)),
        says: "Rodrigues's formula has k (k.v) (1 - cos t) as its last term, without sin t".into(),
    })
}

/// (4.9) is the axis of that rotation, so its length must be 1.
fn axis() -> Option<Finding> {
    let (from, to) = (V3::x(), V3::new(1.0, 1.0, 0.0).normalize());
    let cross = from.cross(&to);
    let sine = cross.norm() / (from.norm() * to.norm());
    let printed = cross / (cross.norm() * sine);
    ((printed.norm() - 1.0).abs() > EXACT).then(|| Finding {
        kind: "equation",
        place: "equation (4.9)".into(),
        stated: format!("axis of length {:.4} for vectors 45 degrees apart", printed.norm()),
        recomputed: format!("{:.4} without the sine", (cross / cross.norm()).norm()),
        says: "divides by sin(alpha) and by |v0 x vt|: one of them is too many".into(),
    })
}

/// (4.20) is a mean of n numbers, so of ones it must be 1.
fn average() -> Option<Finding> {
    let n = 6_u32;
    let printed = (0..=n).map(|_| 1.0).sum::<f64>() / f64::from(n);
    ((printed - 1.0).abs() > EXACT).then(|| Finding {
        kind: "equation",
        place: "equation (4.20)".into(),
        stated: format!("mean of six ones {printed:.4}"),
        recomputed: "1.0000 when the sum starts at 1".into(),
        says: "the sum runs from 0 to n, n + 1 terms, and is divided by n".into(),
    })
}

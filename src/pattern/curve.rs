//! Curves of drafted and imported panels, and the root finder of the drafts.

use geom::V2;

/// Chord error below 0.01 mm on the longest curve.
pub const CURVE_SEGMENTS: usize = 48;

/// Points evenly spaced in the parameter.
pub fn bezier(control: [V2; 4]) -> Vec<V2> {
    let [a, b, c, d] = control;
    (0..=CURVE_SEGMENTS)
        .map(|i| {
            let t = i as f64 / CURVE_SEGMENTS as f64;
            let s = 1.0 - t;
            a * (s * s * s) + b * (3.0 * s * s * t) + c * (3.0 * s * t * t) + d * (t * t * t)
        })
        .collect()
}

pub fn length(curve: &[V2]) -> f64 {
    curve.windows(2).map(|ends| (ends[1] - ends[0]).norm()).sum()
}

/// Root of an increasing function in `low..high`, by 60 bisections, which reach rounding.
pub fn bisect(mut low: f64, mut high: f64, increasing: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if increasing(middle) < 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

/// Circular arc from the origin along `+u`. `angle` is the total turning, radians, positive upwards and not zero.
pub fn arc(length: f64, angle: f64) -> Vec<V2> {
    let radius = length / angle;
    let point_at = |turned: f64| V2::new(radius * turned.sin(), radius * (1.0 - turned.cos()));
    (0..=CURVE_SEGMENTS).map(|i| point_at(angle * i as f64 / CURVE_SEGMENTS as f64)).collect()
}

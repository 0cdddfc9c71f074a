//! An ellipse by arc length.

use std::f64::consts::PI;

use geom::V2;

geom::constants! {
    "placement.ellipse",
    const STEPS: usize = 128;
    const DEEPEST_M: f64 = 3.0;
    const FOUND_M: f64 = 1e-4;
}

/// Ellipse with half axes across and ahead, parametrised by the signed arc length from its apex ahead.
pub struct Ellipse {
    half: V2,
    /// Arc lengths from the apex at even angles from 0 to half a turn.
    arcs: Vec<f64>,
}

impl Ellipse {
    /// Takes half axes.
    pub fn new(across: f64, ahead: f64) -> Self {
        let half = V2::new(across, ahead);
        let mut arcs = vec![0.0];
        for k in 0..STEPS {
            let chord = (point(half, k + 1) - point(half, k)).norm();
            arcs.push(arcs[k] + chord);
        }
        Self { half, arcs }
    }

    /// Ellipse of half width `across` that is at least `least` deep and half of which is at least `length` long.
    pub fn reaching(across: f64, least: f64, length: f64) -> Self {
        let (mut low, mut high) = (least, DEEPEST_M.max(least));
        if Self::new(across, low).half_length() >= length {
            return Self::new(across, low);
        }
        while high - low > FOUND_M {
            let middle = 0.5 * (low + high);
            if Self::new(across, middle).half_length() < length { low = middle } else { high = middle }
        }
        Self::new(across, high)
    }

    fn half_length(&self) -> f64 {
        self.arcs[STEPS]
    }

    /// Across, ahead.
    pub fn at(&self, arc: f64) -> V2 {
        let length = arc.abs().min(self.half_length());
        let k = self.arcs.partition_point(|a| *a < length).clamp(1, STEPS);
        let share = (length - self.arcs[k - 1]) / (self.arcs[k] - self.arcs[k - 1]);
        let p = point(self.half, k - 1).lerp(&point(self.half, k), share);
        V2::new(p.x * arc.signum(), p.y)
    }
}

fn point(half: V2, step: usize) -> V2 {
    let (sin, cos) = (step as f64 * PI / STEPS as f64).sin_cos();
    V2::new(half.x * sin, half.y * cos)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_circle_is_walked_evenly() {
        let circle = Ellipse::new(0.2, 0.2);
        for angle in [-1.5, -0.3, 0.0, 0.7, 3.0_f64] {
            let expected = V2::new(angle.sin(), angle.cos()) * 0.2;
            assert!((circle.at(0.2 * angle) - expected).norm() < 1e-4, "{angle}");
        }
    }

    #[test]
    fn it_is_as_deep_as_its_length_asks() {
        let check = |length: f64, least: f64| {
            let ellipse = Ellipse::reaching(0.2, least, length);
            let found = ellipse.half_length();
            assert!(found >= length && (found < length + 1e-3 || ellipse.half.y == least), "{found} for {length}");
        };
        check(0.3, 0.15);
        check(0.9, 0.15);
        check(2.0, 0.1);
    }
}

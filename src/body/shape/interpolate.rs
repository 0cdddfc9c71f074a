//! Monotone interpolation of a quantity along an axis.

/// Monotone piecewise cubic interpolant [Fritsch & Butland 1984], smooth and without overshoot.
#[derive(Clone, Debug)]
pub(super) struct Monotone {
    at: Vec<f64>,
    value: Vec<f64>,
    slope: Vec<f64>,
}

impl Monotone {
    /// Interpolant through `(at[i], value[i])`, where `at` strictly increases.
    pub fn new(at: &[f64], value: &[f64]) -> Self {
        let secant: Vec<f64> =
            at.windows(2).zip(value.windows(2)).map(|(x, y)| (y[1] - y[0]) / (x[1] - x[0])).collect();
        let inner = |i: usize| {
            let (left, right) = (secant[i - 1], secant[i]);
            if left * right <= 0.0 {
                return 0.0;
            }
            let (h_left, h_right) = (at[i] - at[i - 1], at[i + 1] - at[i]);
            let (w_left, w_right) = (2.0 * h_right + h_left, h_right + 2.0 * h_left);
            (w_left + w_right) / (w_left / left + w_right / right)
        };
        let last = at.len() - 1;
        let slope = (0..=last).map(|i| {
            if i == 0 {
                secant[0]
            } else if i == last {
                secant[last - 1]
            } else {
                inner(i)
            }
        });
        Self { slope: slope.collect(), at: at.to_vec(), value: value.to_vec() }
    }

    /// Value at `x`, constant beyond the ends.
    pub fn at(&self, x: f64) -> f64 {
        let last = self.at.len() - 1;
        if x <= self.at[0] {
            return self.value[0];
        }
        if x >= self.at[last] {
            return self.value[last];
        }
        let i = self.at.partition_point(|&a| a <= x) - 1;
        let h = self.at[i + 1] - self.at[i];
        let t = (x - self.at[i]) / h;
        let (s, t2) = (1.0 - t, t * t);
        (1.0 + 2.0 * t) * s * s * self.value[i]
            + t * s * s * h * self.slope[i]
            + t2 * (3.0 - 2.0 * t) * self.value[i + 1]
            - t2 * s * h * self.slope[i + 1]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_passes_through_and_never_overshoots() {
        let curve = Monotone::new(&[0.0, 1.0, 3.0, 4.0], &[0.0, 1.0, 1.2, 0.5]);
        for (x, y) in [(0.0, 0.0), (1.0, 1.0), (3.0, 1.2), (4.0, 0.5), (-1.0, 0.0), (9.0, 0.5)] {
            assert!((curve.at(x) - y).abs() < 1e-12, "at {x}");
        }
        assert!((0..400).all(|i| (-1e-12..=1.2 + 1e-12).contains(&curve.at(f64::from(i) * 0.01))));
    }
}

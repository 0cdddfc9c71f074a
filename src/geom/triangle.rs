//! Sorted corners of a triangle, and the point of a triangle nearest to a point of space.

use super::V3;

/// Sorted corners, whatever the orientation of the triangle, so that mirrored triangles are rounded alike.
pub fn sorted<T: Ord>(mut corners: [T; 3]) -> [T; 3] {
    corners.sort_unstable();
    corners
}

/// Barycentric coordinates of the point of a triangle nearest to `p` [Ericson 2005, 5.1.5].
pub fn nearest(p: &V3, [a, b, c]: &[V3; 3]) -> [f64; 3] {
    let weights = |wb: f64, wc: f64| [1.0 - (wb + wc), wb, wc];
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (d1, d2) = (ab.dot(&ap), ac.dot(&ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return weights(0.0, 0.0);
    }
    let bp = p - b;
    let (d3, d4) = (ab.dot(&bp), ac.dot(&bp));
    if d3 >= 0.0 && d4 <= d3 {
        return weights(1.0, 0.0);
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return weights(d1 / (d1 - d3), 0.0);
    }
    let cp = p - c;
    let (d5, d6) = (ab.dot(&cp), ac.dot(&cp));
    if d6 >= 0.0 && d5 <= d6 {
        return weights(0.0, 1.0);
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return weights(0.0, d2 / (d2 - d6));
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        let share = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return weights(1.0 - share, share);
    }
    let sum = va + vb + vc;
    weights(vb / sum, vc / sum)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_sample_of_the_triangle_is_nearer() {
        let triangle = [V3::new(0.0, 0.0, 0.0), V3::new(1.0, 0.1, 0.0), V3::new(0.2, 0.8, 0.3)];
        let [a, b, c] = triangle;
        let steps = || (0..=100).map(|k| f64::from(k) / 100.0);
        let check = |p: [f64; 3]| {
            let p = V3::from(p);
            let samples = steps().flat_map(|s| steps().map(move |t| a + ((b - a) * s + (c - b) * (s * t))));
            let least = samples.map(|q| (p - q).norm()).fold(f64::MAX, f64::min);
            let weights = nearest(&p, &triangle);
            let found = (p - (0..3).map(|k| triangle[k] * weights[k]).sum::<V3>()).norm();
            assert!(found <= least + 1e-12 && found > least - 0.02, "{found} for {least} at {p}");
        };
        check([2.0, 0.0, 0.0]);
        check([-1.0, -1.0, 0.2]);
        check([0.3, 2.0, 0.0]);
        check([0.4, 0.3, 1.0]);
        check([0.5, -1.0, 0.1]);
        check([0.9, 0.9, 0.0]);
        check([-0.5, 0.4, 0.2]);
    }
}

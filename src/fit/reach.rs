//! Displacement of the openings of a garment by a movement: a hem rises, a cuff is drawn up the arm.

use geom::V3;
use nalgebra::Matrix3;
use pattern::{Garment, Measurement, MeasurementKind};

/// Displacement of an opening along the body, positive into the garment: upwards for a hem, towards the shoulder for a
/// cuff, downwards for a neckline.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Drawn {
    /// Name of the measurement along the opening.
    pub opening: String,
    pub mean_m: f64,
    pub most_m: f64,
}

/// Displacement of each closed free edge, for vertices at `after` that would be at `kept` if they had stayed in place.
pub fn drawn(garment: &Garment, kept: &[V3], after: &[V3]) -> Vec<Drawn> {
    let is_opening = |m: &&Measurement| m.is_free_edge && m.kind == MeasurementKind::ClosedGirth;
    let middle = mean(kept.iter().copied());
    garment.measurements.iter().filter(is_opening).map(|opening| along(opening, middle, [kept, after])).collect()
}

fn along(opening: &Measurement, middle: V3, [kept, after]: [&[V3]; 2]) -> Drawn {
    let points: Vec<_> = opening.runs.iter().flat_map(|run| &run.points).collect();
    let places: Vec<V3> = points.iter().map(|point| point.at(kept)).collect();
    let inwards = axis(&places, middle);
    let ways: Vec<f64> =
        points.iter().zip(&places).map(|(point, kept)| (point.at(after) - kept).dot(&inwards)).collect();
    Drawn {
        opening: opening.name.clone(),
        mean_m: ways.iter().sum::<f64>() / ways.len().max(1) as f64,
        most_m: ways.into_iter().fold(f64::MIN, f64::max),
    }
}

fn mean(points: impl Iterator<Item = V3> + Clone) -> V3 {
    let count = points.clone().count().max(1) as f64;
    points.sum::<V3>() / count
}

/// Normal of the least-squares plane of some points, towards `middle`.
fn axis(points: &[V3], middle: V3) -> V3 {
    let centre = mean(points.iter().copied());
    let spread: Matrix3<f64> = points.iter().map(|p| (p - centre) * (p - centre).transpose()).sum();
    let eigen = spread.symmetric_eigen();
    let normal: V3 = eigen.eigenvectors.column(eigen.eigenvalues.imin()).into();
    if normal.dot(&(middle - centre)) < 0.0 { -normal } else { normal }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pattern::{MaterialLine, MaterialPoint};

    #[test]
    fn a_hem_that_rises_and_a_cuff_that_goes_up_the_arm_are_drawn_into_the_garment() {
        // A ring of eight vertices about an axis, and the rest of the garment beyond it.
        let ring = |along: V3, across: V3| -> Vec<V3> {
            let third = along.cross(&across);
            let point = |k: u32| {
                let (sin, cos) = (f64::from(k) * std::f64::consts::FRAC_PI_4).sin_cos();
                across * (0.1 * cos) + third * (0.1 * sin)
            };
            (0..8).map(point).chain([along * 0.3]).collect()
        };
        let points = (0..8).map(|v| MaterialPoint { vertices: [v; 3], weights: [1.0, 0.0, 0.0] }).collect();
        let opening = Measurement {
            no: 1,
            name: "Hem".into(),
            kind: MeasurementKind::ClosedGirth,
            is_free_edge: true,
            l2d_m: 0.6,
            runs: vec![MaterialLine { points, arc_m: vec![0.08; 7] }],
        };
        let seam = Measurement { is_free_edge: false, ..opening.clone() };
        let garment = Garment { measurements: vec![opening, seam], ..Garment::default() };
        let check = |along: V3, across: V3, moved: V3, expect_mm: [f64; 2]| {
            let kept = ring(along, across);
            let mut after = kept.clone();
            after[..8].iter_mut().for_each(|p| *p += moved);
            after[0] += along * 0.008;
            let found = drawn(&garment, &kept, &after);
            assert_eq!(found.len(), 1, "a seam is no opening");
            let found_mm = [found[0].mean_m, found[0].most_m].map(|m| 1e3 * m);
            assert!(found_mm.iter().zip(expect_mm).all(|(a, b)| (a - b).abs() < 1e-6), "{found_mm:?}");
        };
        check(V3::z(), V3::x(), V3::z() * 0.02, [21.0, 28.0]);
        check(-V3::x(), V3::y(), V3::x() * -0.03 + V3::y() * 0.01, [31.0, 38.0]);
        check(V3::z(), V3::y(), V3::z() * -0.05, [-49.0, -42.0]);
    }
}

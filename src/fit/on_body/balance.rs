//! Balance of a garment: heights of its edges, and lean of its side seams.

use geom::V3;

/// Half angle of the sectors that count as front, back and sides, radians (15 degrees). Judgement.
const HALF_SECTOR: f64 = std::f64::consts::PI / 12.0;

/// Heights of a closed edge above the floor. Right and left are the subject's. `None` for a side without cloth, as at
/// the opening of a coat.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Sides {
    pub front_m: Option<f64>,
    pub back_m: Option<f64>,
    pub right_m: Option<f64>,
    pub left_m: Option<f64>,
}

#[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Hang {
    /// Lower edge. Of trousers, that of one leg.
    pub hem: Option<Sides>,
    /// Upper edge of trousers and skirts.
    pub waist: Option<Sides>,
    /// Angles of right and left side seam from the vertical, positive if the lower end lies in front.
    pub lean_rad: [Option<f64>; 2],
}

/// Takes the lines of lower edge, upper edge and side seams on the body, each of one or several parts.
pub fn hang(hem: &[Vec<V3>], waist: &[Vec<V3>], side_seams: &[Vec<V3>]) -> Hang {
    let is_right = |right: bool| {
        let own = side_seams.iter().filter(move |seam| (mean_x(seam) > 0.0) == right);
        own.flatten().copied().collect::<Vec<V3>>()
    };
    Hang { hem: sides(hem), waist: sides(waist), lean_rad: [true, false].map(|right| lean(&is_right(right))) }
}

fn mean_x(line: &[V3]) -> f64 {
    line.iter().map(|p| p.x).sum::<f64>() / line.len().max(1) as f64
}

/// Mean heights of an edge, weighted by length, in the four sectors about its middle.
fn sides(edge: &[Vec<V3>]) -> Option<Sides> {
    let steps = || {
        edge.iter().flat_map(|line| line.windows(2)).map(|ends| (0.5 * (ends[0] + ends[1]), (ends[1] - ends[0]).norm()))
    };
    let length: f64 = steps().map(|(_, step)| step).sum();
    if length == 0.0 {
        return None;
    }
    let middle = steps().map(|(p, step)| p * step).sum::<V3>() / length;
    let towards = |way: V3| {
        let near = |p: &V3| {
            let flat = V3::new(p.x - middle.x, p.y - middle.y, 0.0);
            flat.dot(&way) > flat.norm() * HALF_SECTOR.cos()
        };
        let (sum, length) =
            steps().filter(|(p, _)| near(p)).fold((0.0, 0.0), |(sum, all), (p, step)| (sum + p.z * step, all + step));
        (length > 0.0).then(|| sum / length)
    };
    let [front_m, back_m, right_m, left_m] = [V3::y(), -V3::y(), V3::x(), -V3::x()].map(towards);
    Some(Sides { front_m, back_m, right_m, left_m })
}

/// Angle of a seam, highest to lowest point, from the vertical, radians, positive if the lower end lies in front.
fn lean(seam: &[V3]) -> Option<f64> {
    let high = seam.iter().max_by(|a, b| a.z.total_cmp(&b.z))?;
    let low = seam.iter().min_by(|a, b| a.z.total_cmp(&b.z))?;
    (high.z > low.z).then(|| (low.y - high.y).atan2(high.z - low.z))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A ring of radius 0.2 m that rises by `slope` a metre to the front and by `side` a metre to the right.
    fn ring(slope: f64, side: f64, turns: std::ops::Range<usize>) -> Vec<V3> {
        let point = |k: usize| {
            let (sin, cos) = (std::f64::consts::TAU * k as f64 / 360.0).sin_cos();
            V3::new(0.2 * sin, 0.2 * cos, 1.0 + 0.2 * (slope * cos + side * sin))
        };
        turns.map(point).collect()
    }

    #[test]
    fn a_tilted_hem_is_higher_where_it_rises() {
        let check = |slope: f64, side: f64| {
            let found = hang(&[ring(slope, side, 0..361)], &[], &[]).hem.expect("a hem");
            // The mean of the cosine over the sector.
            let mean = 0.2 * HALF_SECTOR.sin() / HALF_SECTOR;
            let expected = [slope, -slope, side, -side].map(|rise| 1.0 + mean * rise);
            let found = [found.front_m, found.back_m, found.right_m, found.left_m];
            for (found, expected) in found.into_iter().zip(expected) {
                assert!((found.expect("cloth") - expected).abs() < 1e-4, "{found:?}, not {expected}");
            }
        };
        check(0.0, 0.0);
        check(0.1, 0.0);
        check(-0.05, 0.2);
    }

    #[test]
    fn an_open_front_has_no_height_there() {
        let found = hang(&[ring(0.0, 0.0, 30..331)], &[], &[]).hem.expect("a hem");
        assert_eq!(found.front_m, None);
        assert!(found.back_m.is_some());
        assert_eq!(hang(&[], &[], &[]), Hang::default());
    }

    #[test]
    fn a_side_seam_leans_by_the_angle_that_it_is_turned() {
        let seam =
            |x: f64, lean: f64| vec![V3::new(x, 0.0, 1.4), V3::new(x, 0.5 * lean, 0.9), V3::new(x, 1.0 * lean, 0.4)];
        let found = hang(&[], &[], &[seam(0.2, 0.1), seam(-0.2, -0.05)]).lean_rad;
        for (found, expected) in found.into_iter().zip([0.1_f64, -0.05]) {
            assert!((found.expect("a seam") - expected.atan()).abs() < 1e-12);
        }
    }
}

//! Displacement field of a piece: the displacement of its outline, extended over the plane by mean value coordinates
//! [Floater 2003].

use geom::V2;
use geom::polyline::segment_distance;

const ON_OUTLINE_M: f64 = 1e-6;

pub struct Field {
    outline: Vec<V2>,
    by: Vec<V2>,
}

impl Field {
    /// Takes the vertices of an outline to `moved`.
    pub fn new(outline: Vec<V2>, moved: &[V2]) -> Self {
        let by = outline.iter().zip(moved).map(|(from, to)| to - from).collect();
        Self { outline, by }
    }

    pub fn carried(&self, place: V2) -> V2 {
        place + self.by_at(place)
    }

    /// Linear along the segments of the outline. Elsewhere the mean over all vertices with weights (tan(a/2) +
    /// tan(b/2)) / r, for the angles a and b that the adjacent segments subtend, and the distance r.
    pub fn by_at(&self, place: V2) -> V2 {
        let n = self.outline.len();
        let next = |k: usize| (k + 1) % n;
        let mut tangents = vec![0.0; n];
        for k in 0..n {
            let (from, to) = (self.outline[k], self.outline[next(k)]);
            if segment_distance(&from, &to, &place) < ON_OUTLINE_M {
                let way = to - from;
                let share = ((place - from).dot(&way) / way.norm_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
                return self.by[k].lerp(&self.by[next(k)], share);
            }
            let (near, far) = (from - place, to - place);
            let cross = near.perp(&far);
            // Tangent of half the angle that the segment subtends.
            tangents[k] = if cross == 0.0 { 0.0 } else { (near.norm() * far.norm() - near.dot(&far)) / cross };
        }
        let (mut total, mut sum) = (0.0, V2::zeros());
        for k in 0..n {
            let weight = (tangents[(k + n - 1) % n] + tangents[k]) / (self.outline[k] - place).norm();
            total += weight;
            sum += self.by[k] * weight;
        }
        if total == 0.0 { V2::zeros() } else { sum / total }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_field_is_exact_for_what_is_linear_and_on_the_outline() {
        let outline: Vec<V2> =
            [(0.0, 0.0), (0.4, 0.1), (0.5, 0.6), (0.2, 0.3), (-0.1, 0.5)].map(|(u, v)| V2::new(u, v)).to_vec();
        let image = |p: V2| V2::new(1.1 * p.x + 0.2 * p.y, 0.9 * p.y - 0.1 * p.x + 0.01);
        let moved: Vec<V2> = outline.iter().copied().map(image).collect();
        let field = Field::new(outline, &moved);
        for (u, v) in [(0.2, 0.1), (0.0, 0.0), (0.2, 0.05), (0.2, 0.6), (-0.3, 0.1), (0.45, 0.35)] {
            let p = V2::new(u, v);
            assert!((field.carried(p) - image(p)).norm() < 1e-9, "{p:?}");
        }
    }
}

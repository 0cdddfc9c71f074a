//! Closest points of a vertex and a triangle, or of two edges [Ericson 2005, 5.1].

use geom::{V3, triangle};

/// Vertices of a pair: `[vertex, triangle]` or `[edge, edge]`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Primitives {
    VertexTriangle([usize; 4]),
    EdgeEdge([usize; 4]),
}

impl Primitives {
    pub fn vertices(self) -> [usize; 4] {
        match self {
            Self::VertexTriangle(vertices) | Self::EdgeEdge(vertices) => vertices,
        }
    }

    pub fn across(self) -> impl Iterator<Item = [usize; 2]> {
        let vertices = self.vertices();
        let split = match self {
            Self::VertexTriangle(_) => 1,
            Self::EdgeEdge(_) => 2,
        };
        (0..split).flat_map(move |k| (split..4).map(move |l| [vertices[k], vertices[l]]))
    }

    /// `None` where `names` has none for the vertices.
    pub fn renamed(self, names: impl Fn([usize; 4]) -> Option<[usize; 4]>) -> Option<Self> {
        match self {
            Self::VertexTriangle(vertices) => names(vertices).map(Self::VertexTriangle),
            Self::EdgeEdge(vertices) => names(vertices).map(Self::EdgeEdge),
        }
    }
}

/// The vector from the second to the first is `sum w_k x_k`.
#[derive(Clone, Copy, Debug)]
pub struct ClosestPoints {
    /// They sum to zero.
    pub weights: [f64; 4],
    /// From the closest point of the second primitive to that of the first.
    pub gap: V3,
}

impl ClosestPoints {
    pub fn of(x: &[V3], primitives: Primitives) -> Self {
        Self::at(&primitives.vertices().map(|v| x[v]), primitives)
    }

    pub fn at(corners: &[V3; 4], primitives: Primitives) -> Self {
        let weights = match primitives {
            Primitives::VertexTriangle(_) => {
                let [p, a, b, c] = *corners;
                let [wa, wb, wc] = triangle::nearest(&p, &[a, b, c]);
                [1.0, -wa, -wb, -wc]
            }
            Primitives::EdgeEdge(_) => edge_edge(corners),
        };
        Self { weights, gap: (0..4).map(|k| corners[k] * weights[k]).sum() }
    }
}

fn edge_edge([a, b, c, d]: &[V3; 4]) -> [f64; 4] {
    let (u, w, r) = (b - a, d - c, a - c);
    let (uu, ww, uw) = (u.norm_squared(), w.norm_squared(), u.dot(&w));
    let (ur, wr) = (u.dot(&r), w.dot(&r));
    let along = |value: f64, length: f64| if length > 0.0 { (value / length).clamp(0.0, 1.0) } else { 0.0 };
    let area = uu * ww - uw * uw;
    let mut s = along(uw * wr - ur * ww, area);
    let free_t = if ww > 0.0 { (uw * s + wr) / ww } else { 0.0 };
    let t = free_t.clamp(0.0, 1.0);
    if t != free_t {
        s = along(t * uw - ur, uu);
    }
    [1.0 - s, s, t - 1.0, -t]
}

/// Squared norm of the cross product, and its gradient by the first and by the second. Zero where they are parallel.
pub fn cross_squared(u: &V3, w: &V3) -> (f64, [V3; 2]) {
    let (uu, ww, uw) = (u.norm_squared(), w.norm_squared(), u.dot(w));
    (u.cross(w).norm_squared(), [(u * ww - w * uw) * 2.0, (w * uu - u * uw) * 2.0])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_sampled_point_is_nearer() {
        let corner = |k: usize, seed: usize| {
            let noise = |axis: usize| ((k * 37 + seed * 101 + axis * 53) as f64).sin() * 1e4 % 1.0;
            V3::new(noise(0), noise(1), noise(2))
        };
        for seed in 0..200 {
            let x = [0, 1, 2, 3].map(|k| corner(k, seed));
            let steps = (0..=20).map(|i| f64::from(i) / 20.0);
            let in_triangle = steps.clone().flat_map(|b| (0..=20).map(move |i| (b, (1.0 - b) * f64::from(i) / 20.0)));
            let triangle = in_triangle.map(|(b, c)| x[0] - x[1] * (1.0 - b - c) - x[2] * b - x[3] * c);
            let on_edges = steps.clone().flat_map(|s| steps.clone().map(move |t| (s, t)));
            let edges = on_edges.map(|(s, t)| x[0].lerp(&x[1], s) - x[2].lerp(&x[3], t));
            let least = |gaps: &mut dyn Iterator<Item = V3>| gaps.map(|g| g.norm()).fold(f64::MAX, f64::min);
            let check = |primitives, sampled: f64| {
                let nearest = ClosestPoints::of(&x, primitives);
                let gap = nearest.gap.norm();
                assert!(gap <= sampled + 1e-12 && gap > sampled - 0.1, "{primitives:?} of {seed}: {gap} for {sampled}");
                assert!(nearest.weights.iter().sum::<f64>().abs() < 1e-12);
            };
            check(Primitives::VertexTriangle([0, 1, 2, 3]), least(&mut triangle.clone()));
            check(Primitives::EdgeEdge([0, 1, 2, 3]), least(&mut edges.clone()));
        }
    }
}

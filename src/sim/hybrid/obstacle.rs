//! The body as an obstacle: its distance field with an offset from the skin, and with insets where the garment cannot
//! close.

use geom::{DistanceField, V3};

pub struct Obstacle<'a> {
    field: &'a DistanceField,
    offset_m: f64,
    insets_m: Vec<f64>,
    /// Place of each vertex at its last evaluation, and its distance from the skin there, m.
    seen: Vec<(V3, f64)>,
}

impl<'a> Obstacle<'a> {
    /// Body without insets.
    pub fn new(field: &'a DistanceField, offset_m: f64, count: usize) -> Self {
        Self { field, offset_m, insets_m: vec![0.0; count], seen: vec![(V3::zeros(), f64::MIN); count] }
    }

    pub fn shrink(&mut self, insets_m: Vec<f64>) {
        self.insets_m = insets_m;
    }

    /// Depth of a vertex below where it is pushed (m, 0 outside), and the direction out.
    pub fn contact(&mut self, vertex: usize, p: &V3) -> (f64, V3) {
        self.contact_at(self.offset_m, vertex, p)
    }

    pub fn contact_at(&mut self, offset_m: f64, vertex: usize, p: &V3) -> (f64, V3) {
        let reach = offset_m - self.insets_m[vertex];
        let (place, distance) = self.seen[vertex];
        // The distance changes by no more than the vertex moved (Lipschitz constant 1).
        if distance - (p - place).norm() > reach {
            return (0.0, V3::zeros());
        }
        let (distance, gradient) = self.field.value_and_gradient(p);
        self.seen[vertex] = (*p, distance);
        ((reach - distance).max(0.0), gradient.try_normalize(1e-9).unwrap_or_else(V3::zeros))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geom::shapes::sphere;

    #[test]
    fn a_ball_pushes_out_to_its_offset_and_less_where_it_is_shrunk() {
        let field = DistanceField::build(&sphere(0.2, 24), 0.01).expect("a closed mesh");
        let mut ball = Obstacle::new(&field, 2e-3, 2);
        ball.shrink(vec![0.0, 0.01]);
        let inside = V3::new(0.19, 0.0, 0.0);
        let [(full, out), (shrunk, _)] = [0, 1].map(|v| ball.contact(v, &inside));
        assert!((full - 0.012).abs() < 1.5e-3 && out.x > 0.99, "{full} along {out:?}");
        assert!((full - shrunk - 0.01).abs() < 1e-9, "{shrunk} of {full}");
        // Far off the field is not evaluated until the vertex could have come near.
        assert_eq!(ball.contact(0, &V3::new(0.22, 0.0, 0.0)).0, 0.0);
        assert_eq!(ball.contact(0, &V3::new(0.215, 0.0, 0.0)).0, 0.0);
        assert_eq!(ball.contact(0, &inside).0, full);
    }
}

//! Generalised winding number of a surface round a point: exact, or with dipoles for evaluation at many points.
//!
//! The winding number of a surface with openings is not an integer: about 1 behind cloth that hangs about a body, about
//! 0 in front of it, and in between across an opening [Jacobson 2013]. Distant parts of the surface are approximated by
//! dipoles [Barill 2018].

use std::f64::consts::PI;

use super::{TriMesh, V3};

/// Greatest number of triangles of an undivided part. Judgement: fewer make the hierarchy deeper.
const LEAF: usize = 8;
/// Ratio of distance to radius from which a part is approximated by its dipole. The error of the winding number then
/// stays below 0.02 in the tests.
const FAR: f64 = 2.5;

/// 1 inside a closed mesh with outward normals, 0 outside [van Oosterom & Strackee 1983: solid angles].
pub fn winding_number(mesh: &TriMesh, point: V3) -> f64 {
    let angle = |triangle: &[usize; 3]| solid_angle(triangle.map(|vertex| mesh.positions[vertex]), point);
    mesh.triangles.iter().map(angle).sum::<f64>() / (4.0 * PI)
}

/// Positive where the point is behind the triangle.
fn solid_angle(corners: [V3; 3], point: V3) -> f64 {
    let [a, b, c] = corners.map(|corner| corner - point);
    let (la, lb, lc) = (a.norm(), b.norm(), c.norm());
    let below = la * lb * lc + a.dot(&b) * lc + b.dot(&c) * la + c.dot(&a) * lb;
    2.0 * a.dot(&b.cross(&c)).atan2(below)
}

struct Part {
    centre: V3,
    radius_m: f64,
    /// Sum of the triangles' areas times unit normals.
    dipole_m2: V3,
    /// Range `from..to` of the triangles.
    from: usize,
    to: usize,
    /// Index of the second half. The first half is the next part. `None` for an undivided part.
    second: Option<usize>,
}

/// Surface prepared for many evaluations.
pub struct Winding {
    triangles: Vec<[V3; 3]>,
    parts: Vec<Part>,
}

impl Winding {
    /// The mesh may have openings.
    pub fn new(mesh: &TriMesh) -> Self {
        let triangles = mesh.triangles.iter().map(|triangle| triangle.map(|vertex| mesh.positions[vertex]));
        let mut winding = Self { triangles: triangles.collect(), parts: Vec::new() };
        if !winding.triangles.is_empty() {
            winding.split(0, winding.triangles.len());
        }
        winding
    }

    /// Adds the part of the triangles `from..to` and the hierarchy below it. Returns its index.
    fn split(&mut self, from: usize, to: usize) -> usize {
        let own = &mut self.triangles[from..to];
        let middle = |corners: &[V3; 3]| corners.iter().sum::<V3>() / 3.0;
        let centre = own.iter().map(middle).sum::<V3>() / own.len() as f64;
        let radius_m = own.iter().flatten().map(|p| (p - centre).norm()).fold(0.0, f64::max);
        let dipole_m2 = own.iter().map(|[a, b, c]| (b - a).cross(&(c - a)) * 0.5).sum();
        let number = self.parts.len();
        let spread: V3 =
            own.iter().map(|corners| (middle(corners) - centre).component_mul(&(middle(corners) - centre))).sum();
        let half = own.len() / 2;
        let is_parted = own.len() > LEAF;
        if is_parted {
            own.select_nth_unstable_by(half, |a, b| middle(a)[spread.imax()].total_cmp(&middle(b)[spread.imax()]));
        }
        self.parts.push(Part { centre, radius_m, dipole_m2, from, to, second: None });
        if is_parted {
            self.split(from, from + half);
            self.parts[number].second = Some(self.split(from + half, to));
        }
        number
    }

    /// Approximate to 0.02.
    pub fn number(&self, point: V3) -> f64 {
        let mut angle = 0.0;
        let mut open: Vec<usize> = if self.parts.is_empty() { Vec::new() } else { vec![0] };
        while let Some(number) = open.pop() {
            let Part { centre, radius_m, dipole_m2, from, to, second } = self.parts[number];
            let (way, far_m) = (centre - point, FAR * radius_m);
            if way.norm_squared() > far_m * far_m {
                angle += dipole_m2.dot(&way) / way.norm().powi(3);
            } else if let Some(second) = second {
                open.extend([number + 1, second]);
            } else {
                angle += self.triangles[from..to].iter().map(|corners| solid_angle(*corners, point)).sum::<f64>();
            }
        }
        angle / (4.0 * PI)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes;

    #[test]
    fn the_inside_is_told_from_the_outside() {
        let ball = shapes::sphere(1.0, 8);
        for (point, wound) in [(V3::zeros(), 1.0), (V3::new(0.9, 0.0, 0.1), 1.0), (V3::new(0.0, 1.2, 0.0), 0.0)] {
            assert!((winding_number(&ball, point) - wound).abs() < 1e-9, "{point:?}");
        }
    }

    #[test]
    fn far_parts_are_dipoles_to_two_hundredths() {
        let whole = shapes::sphere(1.0, 24);
        let cup = TriMesh { triangles: whole.triangles[..1500].to_vec(), ..whole.clone() };
        for mesh in [whole, cup] {
            let winding = Winding::new(&mesh);
            for k in 0..200 {
                let turn = f64::from(k);
                let point = V3::new((0.7 * turn).sin(), (1.1 * turn).cos(), (0.3 * turn).sin()) * (0.1 + 0.01 * turn);
                let error = winding.number(point) - winding_number(&mesh, point);
                assert!(error.abs() < 0.02, "{point:?} errs by {error}");
            }
        }
        assert_eq!(Winding::new(&TriMesh::default()).number(V3::zeros()), 0.0);
    }
}

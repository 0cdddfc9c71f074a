//! Signed distance field of the body on a regular grid, for the contact solver.
//!
//! Values are exact at every node inside the surface and in a thin shell outside it, and constant beyond. Between nodes
//! the field is a quadratic B-spline with continuous value and gradient, so a vertex that rests in a crease (an armpit)
//! does not jump between two contact planes. The spline adds `spacing^2 / 8` times the Laplacian of the distance, which
//! is `2 H` at a surface of mean curvature `H`. It thus moves the surface inwards where it bulges and outwards where it
//! is hollow, by `spacing^2 H / 4`: 0.1 mm on a neck at 6 mm.
//!
//! The grid has a node at the middle of the surface's bounding box, equally many nodes on either side, and sums along x
//! run from both ends inwards. A body mirrored left to right therefore has the mirrored field, to the bit.

use nalgebra::Matrix3;
use wide::f64x2;

use super::contour::{Grid, QuadMesh, contour};
use super::surface::{Surface, SurfaceError};
use super::{TriMesh, V3};

/// Signed distance on a grid, m, negative inside.
#[derive(Clone, Debug, PartialEq)]
pub struct DistanceField {
    middle: V3,
    spacing_m: f64,
    /// Number of nodes along each axis, odd.
    size: [usize; 3],
    values: Vec<f32>,
}

#[derive(Debug, thiserror::Error)]
#[error("the stored distance field is damaged: {0}")]
pub struct FieldError(&'static str);

/// Width of the exact shell outside the surface, in grid cells. The spline at a point of the surface uses nodes up to
/// 1.5 sqrt(3) = 2.6 cells away.
const SHELL_CELLS: f64 = 2.5;
/// Unknown nearest triangle.
const NONE: u32 = u32::MAX;
/// Greatest number of nodes of a connected region whose side is computed. Their majority decides, so that a few wrong
/// pseudo-normals do not.
const MOST_ASKED: usize = 64;
/// Bound on the rounding of a distance to single precision.
const ROUNDED_M: f64 = 1e-5;
const HEADER_BYTES: usize = 7 * 8;

impl DistanceField {
    pub fn build(mesh: &TriMesh, spacing_m: f64) -> Result<Self, SurfaceError> {
        let surface = Surface::new(mesh)?;
        let (low, high) = mesh.bounds().unwrap_or_default();
        let margin = V3::repeat((SHELL_CELLS + 3.0) * spacing_m);
        let half = (high - low) * 0.5 + margin;
        let size = [0, 1, 2].map(|k| 2 * (half[k] / spacing_m).ceil() as usize + 1);
        let far = (SHELL_CELLS * spacing_m) as f32;
        let middle = (low + high) * 0.5;
        let mut field = Self { middle, spacing_m, size, values: vec![far; size.iter().product()] };
        let mut nearest = field.sample_shell(mesh, &surface);
        field.tell_sides(&surface, &nearest);
        field.fill_inside(&surface, &mut nearest);
        Ok(field)
    }

    /// Computes the unsigned distance at the nodes near a triangle. Returns the nearest triangle of each node, or
    /// [`NONE`].
    fn sample_shell(&mut self, mesh: &TriMesh, surface: &Surface) -> Vec<u32> {
        let reach = V3::repeat(SHELL_CELLS * self.spacing_m);
        let mut nearest = vec![NONE; self.values.len()];
        for (index, triangle) in (0..).zip(&mesh.triangles) {
            let [a, b, c] = triangle.map(|v| mesh.positions[v]);
            let normal = (b - a).cross(&(c - a)).try_normalize(0.0).unwrap_or_default();
            let (lowest, highest) = (a.inf(&b).inf(&c), a.sup(&b).sup(&c));
            let low = self.local(&(lowest - reach)).map(f64::ceil);
            let high = self.local(&(highest + reach)).map(f64::floor);
            let [along_x, along_y, along_z] = [0, 1, 2].map(|k| self.index(k, low[k])..=self.index(k, high[k]));
            for k in along_z {
                for j in along_y.clone() {
                    for i in along_x.clone() {
                        let (node, p) = (self.node(i, j, k), self.position(i, j, k));
                        // The distances to the plane and the bounding box of the triangle are lower bounds of the
                        // distance to it, up to rounding.
                        let known_m = f64::from(self.values[node]) + ROUNDED_M;
                        let to_box = (lowest - p).sup(&(p - highest)).sup(&V3::zeros());
                        if normal.dot(&(p - a)).abs() > known_m || to_box.norm_squared() > known_m * known_m {
                            continue;
                        }
                        let distance = surface.distance_to(index, &p).unwrap_or(f32::MAX);
                        if distance < self.values[node] {
                            (self.values[node], nearest[node]) = (distance, index);
                        }
                    }
                }
            }
        }
        nearest
    }

    /// Gives the nodes of the shell their signs. Neighbours whose distances sum to more than the spacing are on one
    /// side, and so are all that are connected in this way. The side of some is computed and the majority decides: on a
    /// crumpled mesh the pseudo-normal of the nearest feature can point the wrong way.
    fn tell_sides(&mut self, surface: &Surface, nearest: &[u32]) {
        // Across a flat surface normal to the axis the two distances sum to the spacing, up to rounding.
        let apart = 1.05 * self.spacing_m as f32;
        let strides = [1, self.size[0], self.size[0] * self.size[1]];
        let mut seen: Vec<bool> = nearest.iter().map(|triangle| *triangle == NONE).collect();
        for start in 0..nearest.len() {
            if seen[start] {
                continue;
            }
            seen[start] = true;
            let mut side = vec![start];
            let mut next = 0;
            while let Some(&node) = side.get(next) {
                next += 1;
                // The shell ends before the grid, so an index plus or minus a stride is that of a neighbour.
                for stride in strides {
                    for other in [node.wrapping_sub(stride), node + stride] {
                        if seen.get(other) == Some(&false) && self.values[node] + self.values[other] > apart {
                            seen[other] = true;
                            side.push(other);
                        }
                    }
                }
            }
            let asked = side.iter().step_by(side.len().div_ceil(MOST_ASKED));
            let count = asked.len();
            let inside = asked.filter(|node| surface.is_inside(&self.position_of(**node))).count();
            if 2 * inside > count {
                side.into_iter().for_each(|node| self.values[node] = -self.values[node]);
            }
        }
    }

    /// Computes the distance at the nodes deeper inside than the shell. Along x, each follows another node inside.
    fn fill_inside(&mut self, surface: &Surface, nearest: &mut [u32]) {
        let far = (SHELL_CELLS * self.spacing_m) as f32;
        for k in 0..self.size[2] {
            for j in 0..self.size[1] {
                for i in 1..self.size[0] {
                    let node = self.node(i, j, k);
                    if self.values[node] == far && self.values[node - 1] < 0.0 {
                        // The distance to the triangle nearest to the preceding node is an upper bound.
                        let p = self.position(i, j, k);
                        let most_m = surface.distance_to(nearest[node - 1], &p).map_or(f64::MAX, f64::from);
                        let (distance_m, triangle) = surface.nearest_within(&p, most_m);
                        self.values[node] = -distance_m as f32;
                        nearest[node] = triangle.unwrap_or(nearest[node - 1]);
                    }
                }
            }
        }
    }

    fn position_of(&self, node: usize) -> V3 {
        let [x, y, _] = self.size;
        self.position(node % x, node / x % y, node / (x * y))
    }

    fn node(&self, i: usize, j: usize, k: usize) -> usize {
        i + self.size[0] * (j + self.size[1] * k)
    }

    fn position(&self, i: usize, j: usize, k: usize) -> V3 {
        let from_middle = |n: usize, size: usize| n as f64 - (size / 2) as f64;
        let [x, y, z] = self.size;
        self.middle + V3::new(from_middle(i, x), from_middle(j, y), from_middle(k, z)) * self.spacing_m
    }

    /// Position relative to the middle node, in spacings.
    fn local(&self, p: &V3) -> V3 {
        (p - self.middle) / self.spacing_m
    }

    /// Index of the node `from_middle` spacings from the middle node, clamped to the grid.
    fn index(&self, axis: usize, from_middle: f64) -> usize {
        ((from_middle + (self.size[axis] / 2) as f64).max(0.0) as usize).min(self.size[axis] - 1)
    }

    /// Index along an axis of the first of the three nodes of the spline at a coordinate, and the coordinate relative
    /// to the middle one of the three, in spacings. `None` at the ends of the grid.
    fn about(&self, axis: usize, local: f64) -> Option<(usize, f64)> {
        let centre = local.round();
        let is_within = centre.abs() < (self.size[axis] / 2) as f64;
        is_within.then(|| (self.index(axis, centre) - 1, local - centre))
    }

    /// Index, position and value (m) of the nodes in a box.
    pub fn nodes_within(&self, low: V3, high: V3) -> impl Iterator<Item = (usize, V3, f64)> {
        let [low, high] = [self.local(&low).map(f64::ceil), self.local(&high).map(f64::floor)];
        let [along_x, along_y, along_z] = [0, 1, 2].map(|k| self.index(k, low[k])..=self.index(k, high[k]));
        let columns = along_x.flat_map(move |i| along_y.clone().map(move |j| (i, j)));
        columns.flat_map(move |(i, j)| along_z.clone().map(move |k| (i, j, k))).map(|(i, j, k)| {
            let node = self.node(i, j, k);
            (node, self.position(i, j, k), f64::from(self.values[node]))
        })
    }

    /// Returns the field with the values of some nodes changed: (index, value in m).
    pub fn with(&self, changes: impl Iterator<Item = (usize, f64)>) -> Self {
        let mut field = self.clone();
        let far = SHELL_CELLS * self.spacing_m;
        for (node, value) in changes {
            if let Some(old) = field.values.get_mut(node) {
                *old = value.min(far) as f32;
            }
        }
        field
    }

    pub fn spacing_m(&self) -> f64 {
        self.spacing_m
    }

    /// Returns the field on a larger grid with the same nodes, which contains a box and a shell round it.
    pub fn widened(&self, low: V3, high: V3) -> Self {
        let far = SHELL_CELLS * self.spacing_m;
        let reach = (high - self.middle).sup(&(self.middle - low)).add_scalar(far + 3.0 * self.spacing_m);
        let size = [0, 1, 2].map(|k| self.size[k].max(2 * (reach[k] / self.spacing_m).ceil() as usize + 1));
        let mut wide = Self { size, values: vec![far as f32; size.iter().product()], ..*self };
        let [x, y, z] = [0, 1, 2].map(|k| (size[k] - self.size[k]) / 2);
        for k in 0..self.size[2] {
            for j in 0..self.size[1] {
                let (from, to) = (self.node(0, j, k), wide.node(x, j + y, k + z));
                wide.values[to..to + self.size[0]].copy_from_slice(&self.values[from..from + self.size[0]]);
            }
        }
        wide
    }

    pub fn surface(&self) -> TriMesh {
        let [x, y, z] = self.size;
        let grid = Grid {
            axes: [
                (0..x).map(|i| self.position(i, 0, 0).x).collect(),
                (0..y).map(|j| self.position(0, j, 0).y).collect(),
                (0..z).map(|k| self.position(0, 0, k).z).collect(),
            ],
        };
        let values: Vec<f64> = self.values.iter().map(|value| f64::from(*value)).collect();
        let QuadMesh { positions, quads } = contour(&grid, &values);
        TriMesh { positions, triangles: quads.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect() }
    }

    /// Signed distance (m) and its gradient. Beyond the exact shell, the width of the shell and zero.
    pub fn value_and_gradient(&self, p: &V3) -> (f64, V3) {
        let local = self.local(p);
        let mut first = [0_usize; 3];
        let mut weight = [[0.0; 3]; 3];
        let mut slope = [[0.0; 3]; 3];
        for k in 0..3 {
            let Some((from, t)) = self.about(k, local[k]) else {
                return (SHELL_CELLS * self.spacing_m, V3::zeros());
            };
            first[k] = from;
            weight[k] = [0.5 * (0.5 - t) * (0.5 - t), 0.75 - t * t, 0.5 * (0.5 + t) * (0.5 + t)];
            slope[k] = [t - 0.5, -2.0 * t, t + 0.5];
        }
        let ([wx, wy, wz], [sx, sy, sz]) = (weight, slope);
        // One register sums value and derivative along x, the other the derivatives along y and z.
        let pair = |a: f64, b: f64| f64x2::from([a, b]);
        let along_x = [0, 1, 2].map(|k| pair(wx[k], sx[k]));
        let (mut value_gx, mut gy_gz) = (f64x2::ZERO, f64x2::ZERO);
        for c in 0..3 {
            for b in 0..3 {
                let row = self.node(first[0], first[1] + b, first[2] + c);
                let Some(&[v0, v1, v2]) = self.values.get(row..row + 3) else { continue };
                let [v0, v1, v2] = [v0, v1, v2].map(|v| f64x2::splat(f64::from(v)));
                let along = (v0 * along_x[0] + v2 * along_x[2]) + v1 * along_x[1];
                value_gx += along * f64x2::splat(wy[b] * wz[c]);
                gy_gz += f64x2::splat(along.to_array()[0]) * pair(sy[b], wy[b]) * pair(wz[c], sz[c]);
            }
        }
        let ([value, gx], [gy, gz]) = (value_gx.to_array(), gy_gz.to_array());
        let gradient = V3::new(gx, gy, gz);
        (value, gradient / self.spacing_m)
    }

    /// Second derivatives of the distance, 1/m. Zero beyond the exact shell.
    pub fn hessian(&self, p: &V3) -> Matrix3<f64> {
        let local = self.local(p);
        let mut first = [0_usize; 3];
        // Weights of the value, the first and the second derivative along each axis.
        let mut weight = [[[0.0; 3]; 3]; 3];
        for k in 0..3 {
            let Some((from, t)) = self.about(k, local[k]) else {
                return Matrix3::zeros();
            };
            first[k] = from;
            weight[k] = [
                [0.5 * (0.5 - t) * (0.5 - t), 0.75 - t * t, 0.5 * (0.5 + t) * (0.5 + t)],
                [t - 0.5, -2.0 * t, t + 0.5],
                [1.0, -2.0, 1.0],
            ];
        }
        let sum = |orders: [usize; 3]| -> f64 {
            let [x, y, z] = [0, 1, 2].map(|k| weight[k][orders[k]]);
            let term = |a: usize, b: usize, c: usize| {
                f64::from(self.values[self.node(first[0] + a, first[1] + b, first[2] + c)]) * x[a] * y[b] * z[c]
            };
            let row = |b: usize, c: usize| (term(0, b, c) + term(2, b, c)) + term(1, b, c);
            (0..9).map(|i| row(i % 3, i / 3)).sum()
        };
        let [xx, yy, zz] = [sum([2, 0, 0]), sum([0, 2, 0]), sum([0, 0, 2])];
        let [xy, yz, zx] = [sum([1, 1, 0]), sum([0, 1, 1]), sum([1, 0, 1])];
        Matrix3::new(xx, xy, zx, xy, yy, yz, zx, yz, zz) / (self.spacing_m * self.spacing_m)
    }

    pub fn to_bytes(&self) -> Vec<u8> {
        let mut bytes = Vec::with_capacity(HEADER_BYTES + 4 * self.values.len());
        for x in [self.middle.x, self.middle.y, self.middle.z, self.spacing_m] {
            bytes.extend(x.to_le_bytes());
        }
        for n in self.size {
            bytes.extend((n as u64).to_le_bytes());
        }
        for v in &self.values {
            bytes.extend(v.to_le_bytes());
        }
        bytes
    }

    pub fn from_bytes(bytes: &[u8]) -> Result<Self, FieldError> {
        if bytes.len() < HEADER_BYTES {
            return Err(FieldError("its header is cut off"));
        }
        let word = |k: usize| <[u8; 8]>::try_from(&bytes[8 * k..8 * k + 8]).unwrap_or_default();
        let float = |k: usize| f64::from_le_bytes(word(k));
        let size = [4, 5, 6].map(|k| usize::try_from(u64::from_le_bytes(word(k))).unwrap_or(0));
        let nodes = size.iter().try_fold(1_usize, |n, s| n.checked_mul(*s));
        if nodes.and_then(|n| n.checked_mul(4)) != Some(bytes.len() - HEADER_BYTES) {
            return Err(FieldError("its length does not match its grid"));
        }
        let values = bytes[HEADER_BYTES..]
            .chunks_exact(4)
            .map(|c| f32::from_le_bytes(<[u8; 4]>::try_from(c).unwrap_or_default()))
            .collect();
        Ok(Self { middle: V3::new(float(0), float(1), float(2)), spacing_m: float(3), size, values })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes::sphere;

    fn bumpy_sphere() -> TriMesh {
        let bumpy = |p: &V3| p * (1.0 + 0.2 * (17.0 * p.x).sin() * (11.0 * p.y + 3.0 * p.z).cos());
        let sphere = sphere(0.1, 30);
        TriMesh { positions: sphere.positions.iter().map(bumpy).collect(), triangles: sphere.triangles }
    }

    #[test]
    fn a_sphere_has_its_distance_and_normal() {
        let radius = 0.1;
        let field = DistanceField::build(&sphere(radius, 40), 0.005).expect("a closed sphere");
        let check = |direction: V3, distance: f64| {
            let p = direction.normalize() * (radius + distance);
            let (value, gradient) = field.value_and_gradient(&p);
            assert!((value - distance).abs() < 4e-4, "{value} for {distance}");
            assert!((gradient - p.normalize()).norm() < 0.03, "{gradient} at {p}");
        };
        for d in [-0.05, -0.01, 0.0, 0.003] {
            check(V3::new(1.0, 0.2, 0.1), d);
            check(V3::new(-0.3, 0.9, -0.4), d);
        }
        // Away from where the spline changes its piece.
        let (p, step) = (V3::new(0.0511, 0.0607, 0.0489), 1e-6);
        for k in 0..3 {
            let gradient_at = |d: f64| field.value_and_gradient(&(p + V3::ith(k, d))).1;
            let slope = (gradient_at(step) - gradient_at(-step)) / (2.0 * step);
            assert!((field.hessian(&p).column(k) - slope).norm() < 1e-5, "{slope} along axis {k}");
        }
        let (value, gradient) = field.value_and_gradient(&V3::new(3.0, 0.0, 0.0));
        assert!(value > 0.01 && gradient == V3::zeros());
    }

    #[test]
    fn nodes_have_the_exact_distance_inside_and_near_the_surface() {
        let mesh = bumpy_sphere();
        let (spacing_m, surface) = (0.006, Surface::new(&mesh).expect("closed"));
        let field = DistanceField::build(&mesh, spacing_m).expect("closed");
        let (low, high) = mesh.bounds().expect("not empty");
        let margin = V3::repeat(3.0 * spacing_m);
        let mut count = [0; 3];
        for (_, p, value) in field.nodes_within(low - margin, high + margin) {
            let exact = surface.signed_distance(&p);
            assert_eq!(value as f32, exact.min(SHELL_CELLS * spacing_m) as f32, "{p}");
            count[if exact < 0.0 { 0 } else { 1 + usize::from(exact > SHELL_CELLS * spacing_m) }] += 1;
        }
        assert!(count.iter().all(|n| *n > 1000), "{count:?}");
    }

    #[test]
    fn a_mirrored_surface_has_the_mirrored_field_to_the_bit() {
        let flipped = |p: &V3| V3::new(-p.x, p.y, p.z);
        let mesh = bumpy_sphere();
        let mirrored = TriMesh {
            positions: mesh.positions.iter().map(flipped).collect(),
            triangles: mesh.triangles.iter().map(|&[a, b, c]| [a, c, b]).collect(),
        };
        let [field, mirror] = [&mesh, &mirrored].map(|mesh| DistanceField::build(mesh, 0.006).expect("closed"));
        let signs = Matrix3::from_diagonal(&V3::new(-1.0, 1.0, 1.0));
        for p in &mesh.positions {
            for q in [p * 0.9, p + V3::new(1e-3, -2e-3, 3e-3), p * 1.05] {
                let (value, gradient) = field.value_and_gradient(&q);
                assert_eq!((value, flipped(&gradient)), mirror.value_and_gradient(&flipped(&q)), "{q}");
                assert_eq!(signs * field.hessian(&q) * signs, mirror.hessian(&flipped(&q)), "{q}");
            }
        }
    }

    #[test]
    fn bytes_come_back_and_damage_is_seen() {
        let field = DistanceField::build(&sphere(0.05, 12), 0.01).expect("a closed sphere");
        let bytes = field.to_bytes();
        assert_eq!(DistanceField::from_bytes(&bytes).expect("intact"), field);
        assert!(DistanceField::from_bytes(&bytes[..bytes.len() - 1]).is_err());
        assert!(DistanceField::from_bytes(&bytes[..10]).is_err());
    }
}

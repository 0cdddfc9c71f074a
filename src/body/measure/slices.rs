//! Horizontal sections of a mesh at many heights, by triangles sorted by height.

use geom::TriMesh;
use geom::section::{Outline, Plane, section, section_of};

pub(crate) trait Sliced {
    fn slice(&self, z: f64) -> Vec<Outline>;
}

impl Sliced for TriMesh {
    fn slice(&self, z: f64) -> Vec<Outline> {
        section(self, &Plane::horizontal(z))
    }
}

/// Height of a layer, m: about half of the height of a triangle.
const LAYER: f64 = 0.006;

/// Part of a mesh between two heights, sorted into layers. Planes outside that range give no outlines.
pub(super) struct Slices<'a> {
    mesh: &'a TriMesh,
    low: f64,
    /// Triangles that reach into each layer, then the index of the first triangle of each layer.
    triangles: Vec<[usize; 3]>,
    starts: Vec<usize>,
}

impl<'a> Slices<'a> {
    pub fn new(mesh: &'a TriMesh, low: f64, high: f64) -> Self {
        let count = ((high - low) / LAYER).max(0.0) as usize + 1;
        let layers = |triangle: &[usize; 3]| {
            let heights = triangle.map(|vertex| (mesh.positions[vertex].z - low) / LAYER);
            let least = heights.into_iter().fold(f64::INFINITY, f64::min);
            let most = heights.into_iter().fold(f64::NEG_INFINITY, f64::max);
            // A height near the border of two layers counts for both, because rounding might decide differently later.
            // Casts saturate at zero.
            let first = (least - 1e-6) as usize;
            if most < -1e-6 || first >= count { 0..0 } else { first..((most + 1e-6) as usize + 1).min(count) }
        };
        let spans: Vec<std::ops::Range<usize>> = mesh.triangles.iter().map(layers).collect();
        let mut starts = vec![0; count + 2];
        for layer in spans.iter().cloned().flatten() {
            starts[layer + 2] += 1;
        }
        for layer in 2..starts.len() {
            starts[layer] += starts[layer - 1];
        }
        let mut triangles = vec![[0; 3]; starts[count + 1]];
        for (triangle, span) in mesh.triangles.iter().zip(spans) {
            for layer in span {
                triangles[starts[layer + 1]] = *triangle;
                starts[layer + 1] += 1;
            }
        }
        starts.pop();
        Self { mesh, low, triangles, starts }
    }
}

impl Sliced for Slices<'_> {
    fn slice(&self, z: f64) -> Vec<Outline> {
        let layer = (z - self.low) / LAYER;
        if layer < 0.0 || layer as usize + 1 >= self.starts.len() {
            return Vec::new();
        }
        let inside = self.starts[layer as usize]..self.starts[layer as usize + 1];
        section_of(&self.mesh.positions, &self.triangles[inside], &Plane::horizontal(z))
    }
}

/// `count + 1` evenly spaced numbers from `from` to `to`.
pub(crate) fn steps(from: f64, to: f64, count: u32) -> impl Iterator<Item = f64> + Clone {
    (0..=count).map(move |i| from + (to - from) * f64::from(i) / f64::from(count))
}

#[cfg(test)]
mod tests {
    use super::*;
    use geom::V3;

    #[test]
    fn layers_give_the_sections_of_the_whole() {
        let ring = |i: usize| {
            let angle = i as f64;
            V3::new(angle.cos(), angle.sin(), 0.013 * i as f64)
        };
        let positions: Vec<V3> = (0..60).map(ring).collect();
        let triangles = (0..58).map(|i| [i, i + 1, i + 2]).collect();
        let mesh = TriMesh { positions, triangles };
        for high in [0.5, 0.501, 0.503, 0.5059] {
            let slices = Slices::new(&mesh, 0.1, high);
            for i in 0..=400 {
                let z = 0.1 + (high - 0.1) * f64::from(i) / 400.0;
                assert_eq!(slices.slice(z), mesh.slice(z), "z = {z} of {high}");
            }
        }
        let slices = Slices::new(&mesh, 0.1, 0.5);
        assert_eq!(slices.slice(0.09), Vec::new());
        assert_eq!(slices.slice(0.6), Vec::new());
    }
}

//! From the implicit skin to a near-uniform, closed triangle mesh.

use super::field::Parts;
use crate::geom::contour::{Grid, QuadMesh, contour};
use crate::geom::{TriMesh, V3};

/// Passes of tangential smoothing.
const PASSES: usize = 8;

/// Passes and step of the fairing of joints (steps up to 0.5 are stable).
const FAIRING_PASSES: usize = 80;
const FAIRING_STEP: f64 = 0.4;

/// A quadrilateral skin with its vertex neighbours.
#[derive(Clone, Debug)]
pub(super) struct Skin {
    mesh: QuadMesh,
    neighbours: Vec<Vec<usize>>,
}

impl Skin {
    /// Polygonises the skin of `parts` inside `[-extent, extent]`, at a grid of the given spacing, and evens it out.
    pub fn new(parts: &Parts, low: V3, high: V3, spacing: f64) -> Self {
        let mut skin = Self::polygonise(parts, low, high, spacing);
        for _ in 0..PASSES {
            skin.even_out(parts);
        }
        skin.fair_seams(parts);
        skin
    }

    fn polygonise(parts: &Parts, low: V3, high: V3, spacing: f64) -> Self {
        // Nodes at odd multiples of half the spacing: the grid is its own mirror image, and so is the mesh.
        let half = (high.x / spacing).ceil() as usize + 1;
        let count = |from: f64, to: f64| ((to - from) / spacing).ceil() as usize + 3;
        let counts = [2 * half, count(low.y, high.y), count(low.z, high.z)];
        let grid =
            Grid { low: V3::new((0.5 - half as f64) * spacing, low.y - spacing, low.z - spacing), spacing, counts };
        let mut values = vec![0.0; counts[0] * counts[1] * counts[2]];
        for k in 0..counts[2] {
            for j in 0..counts[1] {
                for i in half..counts[0] {
                    let value = parts.distance(grid.node([i, j, k]));
                    values[grid.index([i, j, k])] = value;
                    values[grid.index([counts[0] - 1 - i, j, k])] = value;
                }
            }
        }
        let mesh = contour(&grid, &values);
        let mut neighbours = vec![Vec::with_capacity(4); mesh.positions.len()];
        for quad in &mesh.quads {
            for i in 0..4 {
                neighbours[quad[i]].push(quad[(i + 1) % 4]);
            }
        }
        Self { mesh, neighbours }
    }

    /// One pass: every vertex moves to the mean of its neighbours and back onto the skin.
    pub fn even_out(&mut self, parts: &Parts) {
        let towards_mean = self.laplacian(&self.mesh.positions);
        for (position, step) in self.mesh.positions.iter_mut().zip(towards_mean) {
            *position = parts.project(*position + step);
        }
    }

    /// Moves every vertex onto the skin of changed parts.
    pub fn follow(&mut self, parts: &Parts) {
        for position in &mut self.mesh.positions {
            *position = parts.project(*position);
        }
        self.fair_seams(parts);
    }

    /// Fairs the joints between trunk and limbs as a thin plate, so that no crease is left there.
    fn fair_seams(&mut self, parts: &Parts) {
        let weights: Vec<f64> = self.mesh.positions.iter().map(|&p| FAIRING_STEP * parts.seam(p)).collect();
        for _ in 0..FAIRING_PASSES {
            let bend = self.laplacian(&self.laplacian(&self.mesh.positions));
            for (position, (bend, weight)) in self.mesh.positions.iter_mut().zip(bend.iter().zip(&weights)) {
                *position -= bend * *weight;
            }
        }
    }

    /// Difference of the mean of the neighbours and the vertex itself, for every vertex.
    fn laplacian(&self, of: &[V3]) -> Vec<V3> {
        let mean = |around: &[usize]| around.iter().map(|&i| of[i]).sum::<V3>() / around.len() as f64;
        self.neighbours.iter().zip(of).map(|(around, own)| mean(around) - own).collect()
    }

    /// The skin as triangles, stretched in height so that it stands on the floor and is `stature` tall.
    pub fn triangles(&self, stature: f64) -> TriMesh {
        let heights = || self.mesh.positions.iter().map(|p| p.z);
        let (low, high) = (heights().fold(f64::INFINITY, f64::min), heights().fold(f64::NEG_INFINITY, f64::max));
        let factor = stature / (high - low);
        let positions: Vec<V3> = self.mesh.positions.iter().map(|p| V3::new(p.x, p.y, (p.z - low) * factor)).collect();
        let triangles = self.mesh.quads.iter().flat_map(|quad| split(quad, &positions)).collect();
        TriMesh { positions, triangles }
    }
}

/// Splits a quadrilateral along its shorter diagonal.
fn split(&[a, b, c, d]: &[usize; 4], positions: &[V3]) -> [[usize; 3]; 2] {
    let length = |i: usize, j: usize| (positions[i] - positions[j]).norm();
    if length(a, c) <= length(b, d) { [[a, b, c], [a, c, d]] } else { [[b, c, d], [b, d, a]] }
}

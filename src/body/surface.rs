//! From the implicit skin to a near-uniform, closed triangle mesh.

use super::field::Parts;
use crate::geom::contour::{Grid, QuadMesh, contour};
use crate::geom::{TriMesh, V3};

/// Passes of tangential smoothing.
const PASSES: usize = 8;

/// Passes and step of the fairing of joints (steps up to 0.5 are stable).
const FAIRING_PASSES: usize = 120;
const FAIRING_STEP: f64 = 0.4;

/// Step at which vertices spread evenly within the skin while it is faired.
const SPREADING_STEP: f64 = 0.3;

/// Share of the fairing that the whole skin gets.
const BASE_FAIRING: f64 = 0.02;

/// A quadrilateral skin with its vertex neighbours.
#[derive(Clone, Debug)]
pub(super) struct Skin {
    mesh: QuadMesh,
    neighbours: Vec<Vec<usize>>,
}

impl Skin {
    /// Polygonises the skin of `parts` on a grid that is its own mirror image in x (and so is the mesh), and evens it out.
    pub fn new(parts: &Parts, grid: &Grid) -> Self {
        let mut skin = Self::polygonise(parts, grid);
        for _ in 0..PASSES {
            skin.even_out(parts);
        }
        skin.fair(parts);
        skin
    }

    fn polygonise(parts: &Parts, grid: &Grid) -> Self {
        let [nx, ny, nz] = grid.counts();
        let mut values = vec![0.0; nx * ny * nz];
        for k in 0..nz {
            for j in 0..ny {
                for i in nx / 2..nx {
                    let value = parts.distance(grid.node([i, j, k]));
                    values[grid.index([i, j, k])] = value;
                    values[grid.index([nx - 1 - i, j, k])] = value;
                }
            }
        }
        let mesh = contour(grid, &values);
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
        self.fair(parts);
    }

    /// Fairs the skin as a thin plate: much at the joints between trunk and limbs, so that no crease is left there, and
    /// elsewhere only against facets.
    fn fair(&mut self, parts: &Parts) {
        let weights: Vec<f64> = self.mesh.positions.iter().map(|&p| parts.fairness(p).max(BASE_FAIRING)).collect();
        let mut normals = Vec::new();
        for pass in 0..FAIRING_PASSES {
            if pass % 10 == 0 {
                normals = self.normals();
            }
            let to_mean = self.laplacian(&self.mesh.positions);
            let bend = self.laplacian(&to_mean);
            for i in 0..normals.len() {
                let sideways = to_mean[i] - normals[i] * to_mean[i].dot(&normals[i]);
                self.mesh.positions[i] += (sideways * SPREADING_STEP - bend[i] * FAIRING_STEP) * weights[i];
            }
        }
    }

    /// Unit normals of the vertices.
    fn normals(&self) -> Vec<V3> {
        let mut normals = vec![V3::zeros(); self.mesh.positions.len()];
        for &[a, b, c, d] in &self.mesh.quads {
            let at = |i: usize| self.mesh.positions[i];
            let normal = (at(c) - at(a)).cross(&(at(d) - at(b)));
            for vertex in [a, b, c, d] {
                normals[vertex] += normal;
            }
        }
        normals.into_iter().map(|n| n.try_normalize(0.0).unwrap_or_else(V3::zeros)).collect()
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

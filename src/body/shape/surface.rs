//! Near-uniform, closed triangle mesh of the implicit skin.

use super::field::Parts;
use geom::contour::{Grid, QuadMesh, contour};
use geom::{TriMesh, V3};

/// Number of passes of tangential smoothing, which make the mesh uniform. Judgement.
const PASSES: usize = 8;

/// Number of passes of the fairing of joints and of the whole skin, and step of a pass. The step is stable up to 0.5 at
/// vertices of four edges, and up to less elsewhere.
const JOINT_PASSES: usize = 170;
const BASE_PASSES: usize = 9;
const FAIRING_STEP: f64 = 0.25;

/// Step of the tangential smoothing during the fairing. Judgement.
const SPREADING_STEP: f64 = 0.3;

/// Weight of the fairing of the whole skin. Judgement.
const BASE_FAIRING: f64 = 0.4;

#[derive(Clone, Debug)]
pub(crate) struct Skin {
    mesh: QuadMesh,
    neighbours: Vec<Vec<usize>>,
}

impl Skin {
    /// Polygonises the skin of `parts` and makes its mesh uniform. The grid is symmetric in x, and so is the mesh.
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

    /// Moves every vertex to the mean of its neighbours and projects it onto the skin.
    fn even_out(&mut self, parts: &Parts) {
        let targets: Vec<V3> = (0..self.neighbours.len())
            .map(|i| self.mesh.positions[i] + self.to_mean(&self.mesh.positions, i))
            .collect();
        self.mesh.positions = targets.into_iter().map(|target| parts.project(target)).collect();
    }

    /// Fairs the skin as a thin plate: a little everywhere against facets, strongly where limbs meet against creases.
    fn fair(&mut self, parts: &Parts) {
        let everywhere = vec![BASE_FAIRING; self.mesh.positions.len()];
        self.fair_weighted(&everywhere, BASE_PASSES);
        let joints: Vec<f64> = self.mesh.positions.iter().map(|&p| parts.fairness(p)).collect();
        self.fair_weighted(&joints, JOINT_PASSES);
    }

    /// Thin-plate fairing of the vertices of positive weight, with tangential smoothing.
    fn fair_weighted(&mut self, weights: &[f64], passes: usize) {
        let moving: Vec<usize> = (0..weights.len()).filter(|&i| weights[i] > 0.0).collect();
        let mut around = moving.clone();
        around.extend(moving.iter().flat_map(|&i| &self.neighbours[i]));
        around.sort_unstable();
        around.dedup();
        let mut to_mean = vec![V3::zeros(); weights.len()];
        let mut normals = Vec::new();
        for pass in 0..passes {
            if pass % 20 == 0 {
                normals = self.normals();
            }
            for &i in &around {
                to_mean[i] = self.to_mean(&self.mesh.positions, i);
            }
            for &i in &moving {
                let sideways = to_mean[i] - normals[i] * to_mean[i].dot(&normals[i]);
                let bend = self.to_mean(&to_mean, i);
                self.mesh.positions[i] += (sideways * SPREADING_STEP - bend * FAIRING_STEP) * weights[i];
            }
        }
    }

    fn to_mean(&self, values: &[V3], i: usize) -> V3 {
        let around = &self.neighbours[i];
        around.iter().map(|&j| values[j]).sum::<V3>() / around.len() as f64 - values[i]
    }

    fn normals(&self) -> Vec<V3> {
        let mut normals = vec![V3::zeros(); self.mesh.positions.len()];
        for &[a, b, c, d] in &self.mesh.quads {
            let position = |i: usize| self.mesh.positions[i];
            let normal = (position(c) - position(a)).cross(&(position(d) - position(b)));
            for vertex in [a, b, c, d] {
                normals[vertex] += normal;
            }
        }
        normals.into_iter().map(|n| n.try_normalize(0.0).unwrap_or_else(V3::zeros)).collect()
    }

    /// Triangulates the skin: divides every quadrilateral along its shorter diagonal.
    pub fn triangles(self) -> TriMesh {
        let positions = self.mesh.positions;
        let triangles = self.mesh.quads.iter().flat_map(|quad| split(quad, &positions)).collect();
        TriMesh { positions, triangles }
    }
}

fn split(&[a, b, c, d]: &[usize; 4], positions: &[V3]) -> [[usize; 3]; 2] {
    let length = |i: usize, j: usize| (positions[i] - positions[j]).norm();
    if length(a, c) <= length(b, d) { [[a, b, c], [a, c, d]] } else { [[b, c, d], [b, d, a]] }
}

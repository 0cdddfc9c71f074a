//! Polygonisation of an implicit surface by dual marching cubes on a rectilinear grid.
//!
//! Each sheet of the surface in a cell gets its own vertex. Close sheets (thighs, armpits) therefore stay apart, and
//! the result is a closed manifold [Nielson 2004, Dual Marching Cubes].

use super::V3;

/// Rectilinear grid. Each axis has at least two node coordinates, increasing, m.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    pub axes: [Vec<f64>; 3],
}

impl Grid {
    pub fn counts(&self) -> [usize; 3] {
        [self.axes[0].len(), self.axes[1].len(), self.axes[2].len()]
    }

    pub fn node(&self, at: [usize; 3]) -> V3 {
        V3::new(self.axes[0][at[0]], self.axes[1][at[1]], self.axes[2][at[2]])
    }

    /// Index of a node's value in an array with x running fastest, then y, then z.
    pub fn index(&self, at: [usize; 3]) -> usize {
        (at[2] * self.axes[1].len() + at[1]) * self.axes[0].len() + at[0]
    }
}

/// Closed mesh, counter-clockwise seen from outside.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct QuadMesh {
    pub positions: Vec<V3>,
    pub quads: Vec<[usize; 4]>,
}

/// Corners of the twelve edges of a cell. Bit 0 of the number of a corner is +x, bit 1 is +y, bit 2 is +z. Edges 0-3
/// run along x, 4-7 along y, 8-11 along z.
const EDGES: [(usize, usize); 12] =
    [(0, 1), (2, 3), (4, 5), (6, 7), (0, 2), (1, 3), (4, 6), (5, 7), (0, 4), (1, 5), (2, 6), (3, 7)];

/// Corners of the six faces of a cell, in order round each face.
const FACES: [[usize; 4]; 6] = [[0, 2, 6, 4], [1, 3, 7, 5], [0, 1, 5, 4], [2, 3, 7, 6], [0, 1, 3, 2], [4, 5, 7, 6]];

/// Marks an edge of a cell, or a cell, without a vertex.
const NONE: usize = usize::MAX;

/// Polygonises the zero level set of `values` (negative inside, in the order of [`Grid::index`]).
///
/// Values on the border of the grid should be positive. Where they are not, the mesh stays open.
pub fn contour(grid: &Grid, values: &[f64]) -> QuadMesh {
    let mut mesh = QuadMesh::default();
    let [nx, ny, nz] = grid.counts();
    let mut cell_slot = vec![NONE; nx * ny * nz];
    let mut edge_vertices: Vec<[usize; 12]> = Vec::new();
    for k in 0..nz - 1 {
        for j in 0..ny - 1 {
            for i in 0..nx - 1 {
                let corners = cell_corners(grid, values, [i, j, k]);
                let inside = corners.iter().filter(|&&value| value < 0.0).count();
                if inside > 0 && inside < 8 {
                    cell_slot[grid.index([i, j, k])] = edge_vertices.len();
                    edge_vertices.push(place_vertices(grid, [i, j, k], &corners, &mut mesh.positions));
                }
            }
        }
    }
    for axis in 0..3 {
        emit_quads(grid, values, axis, &cell_slot, &edge_vertices, &mut mesh.quads);
    }
    mesh
}

fn cell_corners(grid: &Grid, values: &[f64], cell: [usize; 3]) -> [f64; 8] {
    std::array::from_fn(|c| values[grid.index([cell[0] + (c & 1), cell[1] + (c >> 1 & 1), cell[2] + (c >> 2)])])
}

/// Adds one vertex for every sheet in a cell. Returns that of each edge of the cell, or [`NONE`].
fn place_vertices(grid: &Grid, cell: [usize; 3], corners: &[f64; 8], positions: &mut Vec<V3>) -> [usize; 12] {
    let sheet = sheets(corners);
    let mut vertices = [NONE; 12];
    for root in 0..12 {
        let members: Vec<usize> = (0..12).filter(|&edge| sheet[edge] == root).collect();
        if members.is_empty() {
            continue;
        }
        let sum: V3 = members.iter().map(|&edge| crossing(EDGES[edge], corners)).sum();
        for &edge in &members {
            vertices[edge] = positions.len();
        }
        let (low, high) = (grid.node(cell), grid.node(cell.map(|i| i + 1)));
        positions.push(low + (high - low).component_mul(&(sum / members.len() as f64)));
    }
    vertices
}

/// Zero of the linear interpolant along an edge, in cells.
fn crossing((a, b): (usize, usize), corners: &[f64; 8]) -> V3 {
    let corner = |c: usize| V3::new((c & 1) as f64, (c >> 1 & 1) as f64, (c >> 2) as f64);
    corner(a) + (corner(b) - corner(a)) * (corners[a] / (corners[a] - corners[b]))
}

/// Sheet of each edge with a sign change, named by its least edge. [`NONE`] for any other edge.
///
/// Edges that change sign on a common face belong to one sheet. On a face with four changes, the two edges at each
/// inner corner do.
fn sheets(corners: &[f64; 8]) -> [usize; 12] {
    let inside = |corner: usize| corners[corner] < 0.0;
    let changes = |edge: usize| inside(EDGES[edge].0) != inside(EDGES[edge].1);
    let mut sheet: [usize; 12] = std::array::from_fn(|edge| if changes(edge) { edge } else { NONE });
    for face in FACES {
        let around: [usize; 4] = std::array::from_fn(|i| edge_between(face[i], face[(i + 1) % 4]));
        let changing: Vec<usize> = around.iter().copied().filter(|&edge| changes(edge)).collect();
        if changing.len() == 2 {
            join(&mut sheet, changing[0], changing[1]);
        } else if changing.len() == 4 {
            for i in (0..4).filter(|&i| inside(face[i])) {
                join(&mut sheet, around[(i + 3) % 4], around[i]);
            }
        }
    }
    sheet
}

fn edge_between(a: usize, b: usize) -> usize {
    let pair = (a.min(b), a.max(b));
    EDGES.iter().position(|&edge| edge == pair).expect("neighbours round a face share an edge")
}

fn join(sheet: &mut [usize; 12], a: usize, b: usize) {
    let (keep, drop) = (sheet[a].min(sheet[b]), sheet[a].max(sheet[b]));
    for label in sheet.iter_mut().filter(|label| **label == drop) {
        *label = keep;
    }
}

fn emit_quads(
    grid: &Grid,
    values: &[f64],
    axis: usize,
    cell_slot: &[usize],
    edge_vertices: &[[usize; 12]],
    quads: &mut Vec<[usize; 4]>,
) {
    let (p, q) = ((axis + 1) % 3, (axis + 2) % 3);
    let step = |at: [usize; 3], axis: usize, by: isize| {
        let mut moved = at;
        moved[axis] = moved[axis].wrapping_add_signed(by);
        moved
    };
    let mut limits = grid.counts().map(|count| 1..count - 1);
    limits[axis] = 0..grid.axes[axis].len() - 1;
    for k in limits[2].clone() {
        for j in limits[1].clone() {
            for i in limits[0].clone() {
                let from = [i, j, k];
                let (a, b) = (values[grid.index(from)], values[grid.index(step(from, axis, 1))]);
                if (a < 0.0) == (b < 0.0) {
                    continue;
                }
                let vertex = |dp: isize, dq: isize| {
                    let cell = step(step(from, p, dp), q, dq);
                    edge_vertices[cell_slot[grid.index(cell)]][cell_edge(axis, dp < 0, dq < 0)]
                };
                let quad = [vertex(-1, -1), vertex(0, -1), vertex(0, 0), vertex(-1, 0)];
                quads.push(if a < 0.0 { quad } else { [quad[3], quad[2], quad[1], quad[0]] });
            }
        }
    }
}

/// Edge along `axis` on the upper or lower side of each of the two other axes, in cyclic order.
fn cell_edge(axis: usize, upper_p: bool, upper_q: bool) -> usize {
    let (p, q) = ((axis + 1) % 3, (axis + 2) % 3);
    let corner = usize::from(upper_p) << p | usize::from(upper_q) << q;
    edge_between(corner, corner | 1 << axis)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::TriMesh;

    fn sample(spacing: f64, field: impl Fn(V3) -> f64) -> QuadMesh {
        let count = (3.0 / spacing) as usize;
        let axis: Vec<f64> = (0..count).map(|i| i as f64 * spacing - 1.5).collect();
        let grid = Grid { axes: [axis.clone(), axis.clone(), axis] };
        let mut values = vec![0.0; count * count * count];
        for k in 0..count {
            for j in 0..count {
                for i in 0..count {
                    values[grid.index([i, j, k])] = field(grid.node([i, j, k]));
                }
            }
        }
        contour(&grid, &values)
    }

    fn triangles(mesh: &QuadMesh) -> TriMesh {
        let triangles = mesh.quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
        TriMesh { positions: mesh.positions.clone(), triangles }
    }

    #[test]
    fn a_ball_is_closed_and_turned_outwards() {
        let mesh = triangles(&sample(0.1, |p| p.norm() - 1.0));
        assert!(mesh.is_closed_manifold());
        assert!((mesh.volume() / (4.0 / 3.0 * std::f64::consts::PI) - 1.0).abs() < 0.02, "{}", mesh.volume());
    }

    #[test]
    fn two_balls_closer_than_a_cell_stay_apart() {
        let gap = 0.05;
        let mesh = triangles(&sample(0.11, |p| (p.x.abs() - 0.6 - gap / 2.0).hypot(p.y).hypot(p.z) - 0.6));
        assert!(mesh.is_closed_manifold());
    }
}

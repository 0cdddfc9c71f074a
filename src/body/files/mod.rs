//! Files of bodies: formats, units and orientation.

mod align;
mod glb;
pub mod import;
mod stl;

use crate::BodyError;
use geom::TriMesh;
use std::collections::BTreeMap;

/// Greatest number of triangles of a mesh. More of them show nothing that a tape could read.
const MOST_TRIANGLES: usize = 1_000_000;

fn too_many(count: usize) -> BodyError {
    let problem = format!("{count} faces, at most {MOST_TRIANGLES} are taken: thin the scan out");
    file_error("mesh", "whole file", &problem)
}

fn file_error(format: &'static str, place: &str, problem: &str) -> BodyError {
    BodyError::File { format, place: place.to_owned(), problem: problem.to_owned() }
}

/// Drops triangles that have lost a side, too.
fn merge_equal_vertices(mesh: &TriMesh) -> TriMesh {
    let mut first_with: BTreeMap<[u64; 3], usize> = BTreeMap::new();
    let mut merged = TriMesh::default();
    let mut renamed = Vec::with_capacity(mesh.positions.len());
    for position in &mesh.positions {
        let key = [position.x, position.y, position.z].map(|c| (c + 0.0).to_bits());
        let index = *first_with.entry(key).or_insert(merged.positions.len());
        if index == merged.positions.len() {
            merged.positions.push(*position);
        }
        renamed.push(index);
    }
    let triangles = mesh.triangles.iter().map(|triangle| triangle.map(|corner| renamed[corner]));
    merged.triangles = triangles.filter(|[a, b, c]| a != b && b != c && c != a).collect();
    merged
}

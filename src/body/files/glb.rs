//! Binary glTF (`.glb`) [Khronos 2021]: the triangles of all meshes of the scene, placed by their nodes.
//!
//! It is read without the crate `gltf`, which panics on an index out of range.

use super::{MOST_TRIANGLES, file_error, merge_equal_vertices, too_many};
use crate::BodyError;
use geom::{TriMesh, V3};
use nalgebra::{Matrix4, Point3, Quaternion, Translation3, UnitQuaternion};
use serde::Deserialize;

pub(super) const MAGIC: &[u8] = b"glTF";
/// Greatest depth of a node. A greater one means a cycle.
const DEEPEST: usize = 64;
/// Greatest number of visited nodes. A greater one means that nodes are visited again and again.
const MOST_PLACED: usize = 10_000;
const TRIANGLES: u32 = 4;

#[derive(Deserialize)]
#[serde(rename_all = "camelCase", default)]
#[derive(Default)]
struct Document {
    scene: Option<usize>,
    scenes: Vec<Scene>,
    nodes: Vec<Node>,
    meshes: Vec<Mesh>,
    accessors: Vec<Accessor>,
    buffer_views: Vec<View>,
    extensions_required: Vec<String>,
}

#[derive(Deserialize)]
struct Scene {
    #[serde(default)]
    nodes: Vec<usize>,
}

#[derive(Deserialize)]
struct Node {
    mesh: Option<usize>,
    #[serde(default)]
    children: Vec<usize>,
    matrix: Option<[f64; 16]>,
    translation: Option<[f64; 3]>,
    rotation: Option<[f64; 4]>,
    scale: Option<[f64; 3]>,
}

#[derive(Deserialize)]
struct Mesh {
    primitives: Vec<Primitive>,
}

#[derive(Deserialize)]
struct Primitive {
    attributes: Attributes,
    indices: Option<usize>,
    mode: Option<u32>,
}

#[derive(Deserialize)]
struct Attributes {
    #[serde(rename = "POSITION")]
    position: Option<usize>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Accessor {
    buffer_view: Option<usize>,
    #[serde(default)]
    byte_offset: usize,
    component_type: u32,
    count: usize,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct View {
    #[serde(default)]
    buffer: usize,
    #[serde(default)]
    byte_offset: usize,
    byte_length: usize,
    byte_stride: Option<usize>,
}

/// Merges vertices of equal position, because a vertex occurs once for each chart of a texture.
pub(super) fn read(bytes: &[u8]) -> Result<TriMesh, BodyError> {
    let (json, data) = chunks(bytes).ok_or_else(|| refused("its chunks are cut off"))?;
    let document: Document = serde_json::from_slice(json).map_err(|error| refused(&error.to_string()))?;
    if let Some(extension) = document.extensions_required.first() {
        return Err(refused(&format!("it needs the extension {extension}, and only plain meshes are read")));
    }
    let scene = document.scenes.get(document.scene.unwrap_or(0)).ok_or_else(|| refused("no scene"))?;
    let mut mesh = TriMesh { positions: Vec::new(), triangles: Vec::new() };
    let mut open: Vec<(usize, Matrix4<f64>, usize)> =
        scene.nodes.iter().map(|&node| (node, Matrix4::identity(), 0)).collect();
    let mut placed = 0;
    while let Some((index, above, depth)) = open.pop() {
        placed += 1;
        if depth > DEEPEST || placed > MOST_PLACED {
            return Err(refused("nodes that hang from themselves"));
        }
        let node = document.nodes.get(index).ok_or_else(|| refused(&format!("no node {index}")))?;
        let place = above * node.place();
        if let Some(index) = node.mesh {
            let placed_mesh = document.meshes.get(index).ok_or_else(|| refused(&format!("no mesh {index}")))?;
            for primitive in &placed_mesh.primitives {
                document.add(&mut mesh, primitive, data, &place)?;
            }
        }
        if mesh.triangles.len() > MOST_TRIANGLES {
            return Err(too_many(mesh.triangles.len()));
        }
        open.extend(node.children.iter().map(|&child| (child, place, depth + 1)));
    }
    Ok(merge_equal_vertices(&mesh))
}

fn refused(problem: &str) -> BodyError {
    file_error("GLB", "whole file", problem)
}

/// JSON and binary data of a file.
fn chunks(bytes: &[u8]) -> Option<(&[u8], &[u8])> {
    let number = |at: usize| Some(u32::from_le_bytes(bytes.get(at..at + 4)?.try_into().ok()?) as usize);
    let end = 20_usize.checked_add(number(12)?)?;
    let json = bytes.get(20..end)?;
    let data = number(end).and_then(|length| bytes.get(end + 8..(end + 8).checked_add(length)?));
    Some((json, data.unwrap_or_default()))
}

impl Node {
    fn place(&self) -> Matrix4<f64> {
        if let Some(matrix) = self.matrix {
            return Matrix4::from_column_slice(&matrix);
        }
        let [x, y, z, w] = self.rotation.unwrap_or([0.0, 0.0, 0.0, 1.0]);
        let turn = UnitQuaternion::try_new(Quaternion::new(w, x, y, z), 0.0).unwrap_or_default();
        let shift = Translation3::from(self.translation.unwrap_or_default());
        let scale = V3::from(self.scale.unwrap_or([1.0; 3]));
        shift.to_homogeneous() * turn.to_homogeneous() * Matrix4::new_nonuniform_scaling(&scale)
    }
}

impl Document {
    /// Adds the triangles of a primitive. Points and lines are ignored.
    fn add(
        &self,
        mesh: &mut TriMesh,
        primitive: &Primitive,
        data: &[u8],
        place: &Matrix4<f64>,
    ) -> Result<(), BodyError> {
        if primitive.mode.unwrap_or(TRIANGLES) != TRIANGLES {
            return Ok(());
        }
        let damaged = || refused("a mesh whose vertices are not in the file itself");
        let float = |bytes: &[u8]| bytes.try_into().map_or(f64::NAN, |bytes| f64::from(f32::from_le_bytes(bytes)));
        let position = primitive.attributes.position.and_then(|index| self.accessors.get(index));
        let position = position.filter(|accessor| accessor.component_type == 5126).ok_or_else(damaged)?;
        let first = mesh.positions.len();
        for item in self.items(position, 12, data).ok_or_else(damaged)? {
            let p = Point3::new(float(&item[0..4]), float(&item[4..8]), float(&item[8..12]));
            mesh.positions.push(place.transform_point(&p).coords);
        }
        let count = mesh.positions.len() - first;
        let indices: Vec<usize> = match primitive.indices {
            None => (0..count).collect(),
            Some(index) => {
                let accessor = self.accessors.get(index).ok_or_else(damaged)?;
                let size = match accessor.component_type {
                    5121 => 1,
                    5123 => 2,
                    5125 => 4,
                    _ => return Err(damaged()),
                };
                let number = |item: &[u8]| item.iter().rev().fold(0, |sum, &byte| sum << 8 | usize::from(byte));
                self.items(accessor, size, data).ok_or_else(damaged)?.map(number).collect()
            }
        };
        if indices.iter().any(|index| *index >= count) {
            return Err(refused("a triangle at a vertex that is not there"));
        }
        let corners = indices.chunks_exact(3);
        mesh.triangles.extend(corners.map(|corner| [corner[0], corner[1], corner[2]].map(|index| first + index)));
        Ok(())
    }

    fn items<'d>(
        &self,
        accessor: &Accessor,
        size: usize,
        data: &'d [u8],
    ) -> Option<impl Iterator<Item = &'d [u8]> + use<'d>> {
        let view = self.buffer_views.get(accessor.buffer_view?).filter(|view| view.buffer == 0)?;
        let bytes = data.get(view.byte_offset..view.byte_offset.checked_add(view.byte_length)?)?;
        let bytes = bytes.get(accessor.byte_offset..)?;
        let stride = view.byte_stride.unwrap_or(size).max(size);
        let needed = stride.checked_mul(accessor.count.checked_sub(1)?)?.checked_add(size)?;
        let count = accessor.count;
        (needed <= bytes.len()).then(|| (0..count).map(move |k| &bytes[k * stride..k * stride + size]))
    }
}

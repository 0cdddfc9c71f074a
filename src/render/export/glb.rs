//! Binary glTF 2.0 [Khronos 2021]: a JSON chunk that describes the file, and a binary chunk with the numbers.

use serde_json::{Value, json};

use super::Part;
use geom::V3;

/// Component types and buffer targets of the standard.
const UNSIGNED_INT: u32 = 5125;
const FLOAT: u32 = 5126;
const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;

#[derive(Default)]
struct Buffer {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl Buffer {
    /// Adds rows of floating-point numbers, and returns the index of their accessor.
    fn floats<const N: usize>(&mut self, rows: &[[f32; N]], kind: &str, with_bounds: bool) -> usize {
        let bytes = rows.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
        let mut accessor = json!({ "componentType": FLOAT, "count": rows.len(), "type": kind });
        if with_bounds {
            let fold = |start: f32, pick: fn(f32, f32) -> f32| {
                let bound = |k: usize| rows.iter().map(|row| row[k]).fold(start, pick);
                (0..N).map(bound).collect::<Vec<_>>()
            };
            accessor["min"] = json!(fold(f32::INFINITY, f32::min));
            accessor["max"] = json!(fold(f32::NEG_INFINITY, f32::max));
        }
        self.add(bytes, ARRAY_BUFFER, accessor)
    }

    fn indices(&mut self, triangles: &[[usize; 3]]) -> usize {
        let bytes = triangles.iter().flatten().flat_map(|v| (*v as u32).to_le_bytes()).collect();
        let accessor = json!({ "componentType": UNSIGNED_INT, "count": 3 * triangles.len(), "type": "SCALAR" });
        self.add(bytes, ELEMENT_ARRAY_BUFFER, accessor)
    }

    fn add(&mut self, bytes: Vec<u8>, target: u32, mut accessor: Value) -> usize {
        // Every component has four bytes, so each view starts at a multiple of four, as the standard requires.
        self.views.push(json!({
            "buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len(), "target": target
        }));
        self.bytes.extend(bytes);
        accessor["bufferView"] = json!(self.views.len() - 1);
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }
}

pub(super) fn write(parts: &[Part<'_>]) -> Vec<u8> {
    let mut buffer = Buffer::default();
    let meshes: Vec<Value> = parts.iter().map(|part| mesh(part, &mut buffer)).collect();
    let nodes: Vec<Value> =
        parts.iter().enumerate().map(|(mesh, part)| json!({ "name": part.name, "mesh": mesh })).collect();
    let description = json!({
        "asset": { "version": "2.0", "generator": concat!("toile ", env!("CARGO_PKG_VERSION")) },
        "scene": 0,
        "scenes": [{ "nodes": (0..parts.len()).collect::<Vec<_>>() }],
        "nodes": nodes,
        "meshes": meshes,
        "materials": [{
            "doubleSided": true,
            "pbrMetallicRoughness": { "metallicFactor": 0.0, "roughnessFactor": 0.9 }
        }],
        "buffers": [{ "byteLength": buffer.bytes.len() }],
        "bufferViews": buffer.views,
        "accessors": buffer.accessors,
    });
    container(description.to_string().into_bytes(), buffer.bytes)
}

fn mesh(part: &Part<'_>, buffer: &mut Buffer) -> Value {
    let rows = |vectors: &[V3]| vectors.iter().map(turned).collect::<Vec<_>>();
    let mut attributes = json!({
        "POSITION": buffer.floats(&rows(&part.mesh.positions), "VEC3", true),
        "NORMAL": buffer.floats(&rows(&part.mesh.vertex_normals()), "VEC3", false),
        // Vertex colours are linear light in glTF.
        "COLOR_0": buffer.floats(&part.colours.iter().map(|c| c.linear()).collect::<Vec<_>>(), "VEC3", false),
    });
    if let Some(places) = part.places {
        // `v` points down in glTF.
        let places: Vec<[f32; 2]> = places.iter().map(|p| [p.x as f32, -p.y as f32]).collect();
        attributes["TEXCOORD_0"] = json!(buffer.floats(&places, "VEC2", false));
    }
    let mut mesh = json!({ "name": part.name });
    if let Some((name, values)) = part.values {
        let values: Vec<[f32; 1]> = values.iter().map(|v| [*v as f32]).collect();
        attributes["_VALUE"] = json!(buffer.floats(&values, "SCALAR", false));
        mesh["extras"] = json!({ "_VALUE": name });
    }
    let indices = buffer.indices(&part.mesh.triangles);
    mesh["primitives"] = json!([{ "attributes": attributes, "indices": indices, "material": 0 }]);
    mesh
}

/// Turns a vector to glTF: `z` (up) becomes `y`, `y` (front) `z`, and `x` changes its sign, to keep the orientation.
fn turned(v: &V3) -> [f32; 3] {
    [-v.x as f32, v.z as f32, v.y as f32]
}

/// Joins the header and the two chunks, each padded to four bytes: JSON with blanks, numbers with zeros.
fn container(mut description: Vec<u8>, mut numbers: Vec<u8>) -> Vec<u8> {
    description.resize(description.len().next_multiple_of(4), b' ');
    numbers.resize(numbers.len().next_multiple_of(4), 0);
    let total = 12 + 8 + description.len() + 8 + numbers.len();
    let mut file = Vec::with_capacity(total);
    file.extend(b"glTF");
    file.extend(2_u32.to_le_bytes());
    file.extend((total as u32).to_le_bytes());
    for (kind, chunk) in [(b"JSON", description), (b"BIN\0", numbers)] {
        file.extend((chunk.len() as u32).to_le_bytes());
        file.extend(kind);
        file.extend(chunk);
    }
    file
}

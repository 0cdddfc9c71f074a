//! Export to OBJ, PLY and STL.

use std::fmt::Write;

use super::{Part, Rgb};

/// Encodes Wavefront OBJ: positions and colours of the vertices, and texture coordinates where a part has places.
pub(super) fn obj(parts: &[Part<'_>]) -> String {
    let mut file = "# metres; x to the subject's right, y to the front, z up\n".to_owned();
    let (mut vertices, mut places) = (1, 1);
    for part in parts {
        // Writing to a string cannot fail.
        let _ = writeln!(file, "o {}", part.name);
        for (p, c) in part.mesh.positions.iter().zip(&part.colours) {
            let [r, g, b] = [c.0, c.1, c.2].map(|v| f64::from(v) / 255.0);
            let _ = writeln!(file, "v {:.7} {:.7} {:.7} {r:.4} {g:.4} {b:.4}", p.x, p.y, p.z);
        }
        for p in part.places.unwrap_or_default() {
            let _ = writeln!(file, "vt {:.6} {:.6}", p.x, p.y);
        }
        for triangle in &part.mesh.triangles {
            let corner = |v: &usize| match part.places {
                Some(_) => format!("{}/{}", v + vertices, v + places),
                None => (v + vertices).to_string(),
            };
            let _ = writeln!(file, "f {}", triangle.iter().map(corner).collect::<Vec<_>>().join(" "));
        }
        vertices += part.mesh.positions.len();
        places += part.places.map_or(0, <[_]>::len);
    }
    file
}

/// Encodes Stanford PLY, binary little-endian.
pub(super) fn ply(parts: &[Part<'_>]) -> Vec<u8> {
    let vertices: usize = parts.iter().map(|part| part.mesh.positions.len()).sum();
    let faces: usize = parts.iter().map(|part| part.mesh.triangles.len()).sum();
    let names: Vec<String> = parts.iter().enumerate().map(|(k, part)| format!("{k} {}", part.name)).collect();
    let maps: Vec<&str> = parts.iter().filter_map(|part| part.values).map(|(name, _)| name).collect();
    let mut file = format!(
        "ply\nformat binary_little_endian 1.0\ncomment metres; x to the subject's right, y to the front, z up\n\
        comment part: {}\ncomment value: {}\nelement vertex {vertices}\nproperty float x\nproperty float y\nproperty float z\n\
        property uchar red\nproperty uchar green\nproperty uchar blue\nproperty float value\nproperty uchar part\n\
        element face {faces}\nproperty list uchar uint vertex_indices\nend_header\n",
        names.join(", "),
        if maps.is_empty() { "none".to_owned() } else { maps.join(", ") },
    )
    .into_bytes();
    for (number, part) in parts.iter().enumerate() {
        for (v, p) in part.mesh.positions.iter().enumerate() {
            file.extend([p.x, p.y, p.z].iter().flat_map(|x| (*x as f32).to_le_bytes()));
            let colour = part.colours[v];
            file.extend([colour.0, colour.1, colour.2]);
            let value = part.values.map_or(f64::NAN, |(_, values)| values[v]);
            file.extend((value as f32).to_le_bytes());
            file.push(number as u8);
        }
    }
    let mut first = 0;
    for part in parts {
        for triangle in &part.mesh.triangles {
            file.push(3);
            file.extend(triangle.iter().flat_map(|v| ((v + first) as u32).to_le_bytes()));
        }
        first += part.mesh.positions.len();
    }
    file
}

/// Encodes binary STL, each triangle with its colour.
pub(super) fn stl(parts: &[Part<'_>]) -> Vec<u8> {
    let faces: usize = parts.iter().map(|part| part.mesh.triangles.len()).sum();
    let mut file = vec![0; 80];
    let title = b"toile, metres";
    file[..title.len()].copy_from_slice(title);
    file.extend((faces as u32).to_le_bytes());
    for part in parts {
        for (triangle, normal) in part.mesh.triangles.iter().zip(part.mesh.triangle_normals()) {
            let unit = normal.try_normalize(0.0).unwrap_or_default();
            for vector in [
                unit,
                part.mesh.positions[triangle[0]],
                part.mesh.positions[triangle[1]],
                part.mesh.positions[triangle[2]],
            ] {
                file.extend(vector.iter().flat_map(|x| (*x as f32).to_le_bytes()));
            }
            file.extend(face_colour(triangle.map(|v| part.colours[v])).to_le_bytes());
        }
    }
    file
}

/// Colour of a triangle, as VisCAM and MeshLab read it from STL: the mean of its corners, five bits a channel, blue
/// lowest. The highest bit says that there is a colour.
fn face_colour(corners: [Rgb; 3]) -> u16 {
    let mean = |channel: fn(&Rgb) -> u8| corners.iter().map(|colour| u16::from(channel(colour))).sum::<u16>() / 3;
    1 << 15 | (mean(|c| c.0) >> 3) << 10 | (mean(|c| c.1) >> 3) << 5 | mean(|c| c.2) >> 3
}

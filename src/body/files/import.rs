//! Import of bodies from OBJ, PLY, STL and GLB in any unit and orientation, and export to OBJ.
//!
//! Importers take bytes. The unit is given or inferred from the height, the upright axis is inferred from the extents.
//! The notes say both.

use super::{MOST_TRIANGLES, align, file_error, glb, merge_equal_vertices, stl, too_many};
use crate::BodyError;
use crate::repair::clean;
use geom::units::mm;
use geom::{TriMesh, V3};
use std::fmt::Write as _;
use std::io::Cursor;

#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum LengthUnit {
    #[serde(rename = "mm")]
    Millimetre,
    #[serde(rename = "cm")]
    Centimetre,
    #[serde(rename = "m")]
    Metre,
    #[serde(rename = "dm")]
    Decimetre,
    #[serde(rename = "in")]
    Inch,
}

impl LengthUnit {
    /// The height of a standing adult is plausible in only one of them.
    pub const ALL: [Self; 5] = [Self::Millimetre, Self::Centimetre, Self::Metre, Self::Decimetre, Self::Inch];

    pub fn metres(self) -> f64 {
        match self {
            Self::Millimetre => 1e-3,
            Self::Centimetre => 1e-2,
            Self::Metre => 1.0,
            Self::Decimetre => 0.1,
            Self::Inch => 0.0254,
        }
    }

    /// Symbol, such as `mm`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Millimetre => "mm",
            Self::Centimetre => "cm",
            Self::Metre => "m",
            Self::Decimetre => "dm",
            Self::Inch => "in",
        }
    }
}

#[derive(Clone, Debug, PartialEq)]
pub struct Imported {
    /// Mesh in metres, z up, on the floor.
    pub mesh: TriMesh,
    /// Unit of the file.
    pub unit: LengthUnit,
    /// Inferences and repairs, as sentences for the user.
    pub notes: Vec<String>,
}

/// Reads a body mesh in a format recognised by the first bytes.
pub fn import(bytes: &[u8], unit: Option<LengthUnit>) -> Result<Imported, BodyError> {
    settle(&read(bytes)?, unit)
}

fn read(bytes: &[u8]) -> Result<TriMesh, BodyError> {
    let announced = announced_faces(bytes);
    if announced > MOST_TRIANGLES {
        return Err(too_many(announced));
    }
    let mesh = if bytes.starts_with(b"ply") {
        read_ply(bytes)?
    } else if bytes.starts_with(glb::MAGIC) {
        glb::read(bytes)?
    } else if stl::is_stl(bytes) {
        stl::read(bytes)?
    } else {
        read_obj(bytes)?
    };
    if mesh.triangles.is_empty() {
        return Err(file_error("mesh", "whole file", "no faces found"));
    }
    if mesh.triangles.len() > MOST_TRIANGLES {
        return Err(too_many(mesh.triangles.len()));
    }
    let finite = mesh.positions.iter().position(|p| !p.iter().all(|c| c.is_finite()));
    if let Some(vertex) = finite {
        return Err(file_error("mesh", &format!("vertex {}", vertex + 1), "coordinate is not a finite number"));
    }
    Ok(mesh)
}

fn announced_faces(bytes: &[u8]) -> usize {
    if bytes.starts_with(b"ply") {
        let head = String::from_utf8_lossy(&bytes[..bytes.len().min(4096)]);
        let mut lines = head.lines().take_while(|line| line.trim() != "end_header");
        let count = lines.find_map(|line| line.trim().strip_prefix("element face")).map(|rest| rest.trim().parse());
        return count.and_then(Result::ok).unwrap_or(0);
    }
    if stl::is_stl(bytes) {
        return stl::announced_faces(bytes);
    }
    bytes.split(|byte| *byte == b'\n').filter(|line| line.starts_with(b"f ")).count()
}

fn read_obj(bytes: &[u8]) -> Result<TriMesh, BodyError> {
    let options = tobj::LoadOptions { triangulate: true, single_index: false, ignore_points: true, ignore_lines: true };
    let plain = positions_and_faces(bytes);
    let loaded = tobj::load_obj_buf(&mut Cursor::new(plain), &options, |_| Ok(Default::default()));
    let (models, _) = loaded.map_err(|error| file_error("OBJ", &obj_place(bytes), &error.to_string()))?;
    let mut mesh = TriMesh::default();
    for model in models {
        let first = mesh.positions.len();
        let numbers = model.mesh.positions.chunks_exact(3);
        mesh.positions.extend(numbers.map(|p| V3::new(f64::from(p[0]), f64::from(p[1]), f64::from(p[2]))));
        let corner = |i: u32| first + i as usize;
        mesh.triangles.extend(model.mesh.indices.chunks_exact(3).map(|t| [corner(t[0]), corner(t[1]), corner(t[2])]));
    }
    Ok(merge_equal_vertices(&mesh))
}

/// Vertices and faces of an OBJ, without names, comments, textures and colours, which may be in any code page.
fn positions_and_faces(bytes: &[u8]) -> String {
    let text = String::from_utf8_lossy(bytes).replace("\\\r\n", " ").replace("\\\n", " ");
    let plain = |line: &str| {
        let mut words = line.split('#').next().unwrap_or_default().split_whitespace();
        match words.next()? {
            "v" => Some(["v"].into_iter().chain(words.take(3)).collect::<Vec<_>>().join(" ")),
            "f" => {
                let corners = words.map(|word| word.split('/').next().unwrap_or_default());
                Some(["f"].into_iter().chain(corners).collect::<Vec<_>>().join(" "))
            }
            _ => None,
        }
    };
    text.lines().filter_map(plain).collect::<Vec<_>>().join("\n")
}

fn obj_place(bytes: &[u8]) -> String {
    let text = String::from_utf8_lossy(bytes);
    let broken = |line: &str| {
        let mut words = line.split_whitespace();
        let (keyword, rest) = (words.next(), words.collect::<Vec<_>>());
        match keyword {
            Some("v") => rest.len() < 3 || rest.iter().take(3).any(|word| word.parse::<f64>().is_err()),
            Some("f") => {
                rest.len() < 3
                    || rest.iter().any(|word| word.split('/').next().is_none_or(|i| i.parse::<i64>().is_err()))
            }
            _ => false,
        }
    };
    text.lines().position(broken).map_or_else(|| "whole file".to_owned(), |line| format!("line {}", line + 1))
}

fn read_ply(bytes: &[u8]) -> Result<TriMesh, BodyError> {
    use ply_rs_bw::parser::Parser;
    use ply_rs_bw::ply::{DefaultElement, Property};
    let number = |property: &Property| match *property {
        Property::Float(v) => Some(f64::from(v)),
        Property::Double(v) => Some(v),
        Property::Int(v) => Some(f64::from(v)),
        Property::Short(v) => Some(f64::from(v)),
        Property::Char(v) => Some(f64::from(v)),
        Property::UChar(v) => Some(f64::from(v)),
        Property::UShort(v) => Some(f64::from(v)),
        Property::UInt(v) => Some(f64::from(v)),
        _ => None,
    };
    let indices = |property: &Property| -> Option<Vec<usize>> {
        match property {
            Property::ListInt(list) => list.iter().map(|&i| usize::try_from(i).ok()).collect(),
            Property::ListUInt(list) => Some(list.iter().map(|&i| i as usize).collect()),
            Property::ListShort(list) => list.iter().map(|&i| usize::try_from(i).ok()).collect(),
            Property::ListUShort(list) => Some(list.iter().map(|&i| usize::from(i)).collect()),
            Property::ListUChar(list) => Some(list.iter().map(|&i| usize::from(i)).collect()),
            _ => None,
        }
    };
    let ply = Parser::<DefaultElement>::new()
        .read_ply(&mut Cursor::new(bytes))
        .map_err(|error| file_error("PLY", "header or data", &error.to_string()))?;
    let mut mesh = TriMesh::default();
    for (i, vertex) in ply.payload.get("vertex").into_iter().flatten().enumerate() {
        let coordinate = |name: &str| vertex.get(name).and_then(number);
        let position = coordinate("x").zip(coordinate("y")).zip(coordinate("z"));
        let ((x, y), z) =
            position.ok_or_else(|| file_error("PLY", &format!("vertex {}", i + 1), "no numbers x, y, z"))?;
        mesh.positions.push(V3::new(x, y, z));
    }
    for (i, face) in ply.payload.get("face").into_iter().flatten().enumerate() {
        let list = face.get("vertex_indices").or_else(|| face.get("vertex_index")).and_then(indices);
        let place = || format!("face {}", i + 1);
        let corners = list.ok_or_else(|| file_error("PLY", &place(), "no list vertex_indices"))?;
        if let Some(bad) = corners.iter().find(|&&corner| corner >= mesh.positions.len()) {
            let problem = format!("vertex index {bad}, but there are {} vertices", mesh.positions.len());
            return Err(file_error("PLY", &place(), &problem));
        }
        mesh.triangles.extend((2..corners.len()).map(|k| [corners[0], corners[k - 1], corners[k]]));
    }
    Ok(merge_equal_vertices(&mesh))
}

fn settle(mesh: &TriMesh, unit: Option<LengthUnit>) -> Result<Imported, BodyError> {
    let mut notes = Vec::new();
    if clean::several(mesh) {
        return Err(BodyError::Several);
    }
    let mut mesh = clean::keep_body(mesh, &mut notes);
    let along_axis = align::stand_up(&mut mesh, &mut notes);
    if let Some(lifted) = clean::drop_floor(&mesh, &mut notes) {
        mesh = lifted;
    }
    let (low, high) = mesh.bounds().ok_or_else(|| file_error("mesh", "whole file", "no faces found"))?;
    let height = high.z - low.z;
    let unit = match unit {
        Some(unit) if is_adult(height * unit.metres()) => unit,
        Some(unit) => return Err(BodyError::WrongUnit { extent: height, unit: unit.name() }),
        None => {
            let guess = guess_unit(height).ok_or(BodyError::Unit { extent: height })?;
            let height_mm = mm(height * guess.metres());
            notes.push(format!("unit taken as {} (the body is {height_mm:.1} mm high)", guess.name()));
            guess
        }
    };
    for p in &mut mesh.positions {
        p.z -= low.z;
        *p *= unit.metres();
    }
    let floor = low.z * unit.metres();
    if floor.abs() > 1e-3 {
        notes.push(format!("moved by {:.1} mm onto the floor", -floor * 1e3));
    }
    align::face_front(&mut mesh, &mut notes);
    align::straighten(&mut mesh, along_axis, &mut notes);
    align::face_front(&mut mesh, &mut notes);
    if align::looks_back(&mesh) {
        for p in &mut mesh.positions {
            *p = V3::new(-p.x, -p.y, p.z);
        }
        notes.push("turned by 180 degrees: the feet pointed backwards".to_owned());
    }
    if mesh.volume() < 0.0 {
        mesh.triangles.iter_mut().for_each(|triangle| triangle.reverse());
        notes.push("faces turned: they pointed inwards".to_owned());
    }
    Ok(Imported { mesh, unit, notes })
}

fn is_adult(height_m: f64) -> bool {
    (1.2..2.4).contains(&height_m)
}

/// Unit in which `height` is that of a standing adult.
fn guess_unit(height: f64) -> Option<LengthUnit> {
    LengthUnit::ALL.into_iter().find(|unit| (1.2..2.4).contains(&(height * unit.metres())))
}

/// Writes the mesh as Wavefront OBJ in metres, to a tenth of a micrometre.
pub fn write_obj(mesh: &TriMesh) -> String {
    let mut text = String::with_capacity(mesh.positions.len() * 36 + mesh.triangles.len() * 20);
    text.push_str("# metres; x to the subject's right, y to the front, z up\n");
    for p in &mesh.positions {
        let _ = writeln!(text, "v {:.7} {:.7} {:.7}", p.x, p.y, p.z);
    }
    for [a, b, c] in &mesh.triangles {
        let _ = writeln!(text, "f {} {} {}", a + 1, b + 1, c + 1);
    }
    text
}

#[cfg(test)]
#[path = "import_tests.rs"]
mod tests;

//! Export of meshes to files of other programs: glTF, OBJ, PLY, STL.
//!
//! Lengths are in metres. OBJ, PLY and STL have Toile's axes: `x` to the subject's right, `y` to the front, `z` up. In
//! glTF `y` is up, and the subject faces `z`.

mod glb;
mod text;

use geom::{TriMesh, V2};

use super::Rgb;

#[derive(Clone, Debug, PartialEq)]
pub struct Part<'a> {
    /// Name of the object (`body`, `garment`).
    pub name: &'a str,
    /// Surface of the part, lengths in metres.
    pub mesh: &'a TriMesh,
    pub colours: Vec<Rgb>,
    /// Position of each vertex in the flat pattern piece, m, written as texture coordinates.
    pub places: Option<&'a [V2]>,
    /// Name of a map and its value at each vertex.
    pub values: Option<(&'a str, &'a [f64])>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeshFormat {
    /// Binary glTF 2.0 [Khronos 2021]: every part, with colours, texture coordinates and values (`_VALUE`).
    Glb,
    /// Wavefront OBJ: every part as an object, colours after the coordinates, texture coordinates.
    Obj,
    /// Stanford PLY, binary: the parts as one mesh, with colours, values (`value`, NaN for a part without) and part
    /// numbers.
    Ply,
    /// STL, binary: the parts as one mesh, coloured by triangle.
    Stl,
}

impl MeshFormat {
    pub fn write(self, parts: &[Part<'_>]) -> Vec<u8> {
        match self {
            Self::Glb => glb::write(parts),
            Self::Obj => text::obj(parts).into_bytes(),
            Self::Ply => text::ply(parts),
            Self::Stl => text::stl(parts),
        }
    }
}

#[cfg(test)]
mod tests;

//! STL, ASCII and binary, read without the crate `stl_io`, which names no line in its errors, drops every solid but the
//! first, and rounds ASCII numbers to single precision.

use super::{file_error, merge_equal_vertices};
use crate::BodyError;
use geom::{TriMesh, V3};

/// Number of bytes before the facets of a binary file, and of one facet.
const HEADER: usize = 84;
const FACET: usize = 50;

pub(super) fn is_stl(bytes: &[u8]) -> bool {
    is_binary(bytes) || bytes.trim_ascii_start().starts_with(b"solid")
}

/// Number of facets that a binary file states, or that an ASCII file of its length may have.
pub(super) fn announced_faces(bytes: &[u8]) -> usize {
    /// Least number of bytes of a facet.
    const ASCII_FACET: usize = 100;
    if is_binary(bytes) { count(bytes) } else { bytes.len() / (4 * ASCII_FACET) }
}

/// True if the last byte of the facet count is zero, as for any count below 16 million and in no text. The header of a
/// binary file may begin with `solid` as well.
fn is_binary(bytes: &[u8]) -> bool {
    bytes.get(HEADER - 1) == Some(&0)
}

fn count(bytes: &[u8]) -> usize {
    bytes[HEADER - 4..HEADER].iter().rev().fold(0, |count, byte| count << 8 | usize::from(*byte))
}

/// Reads a file and merges the corners of its facets.
pub(super) fn read(bytes: &[u8]) -> Result<TriMesh, BodyError> {
    let corners = if is_binary(bytes) { binary_corners(bytes)? } else { ascii_corners(bytes)? };
    if corners.len() % 3 != 0 {
        return Err(file_error("STL", "end of file", "the last facet has fewer than three vertices"));
    }
    let triangles = (0..corners.len() / 3).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    Ok(merge_equal_vertices(&TriMesh { positions: corners, triangles }))
}

fn binary_corners(bytes: &[u8]) -> Result<Vec<V3>, BodyError> {
    let (announced, facets) = (count(bytes), bytes[HEADER..].chunks(FACET));
    if bytes.len() != HEADER + announced * FACET {
        let whole = (bytes.len() - HEADER) / FACET;
        let problem = format!("{announced} facets are announced, the file has {whole}");
        return Err(file_error("STL", &format!("facet {}", announced.min(whole) + 1), &problem));
    }
    let number = |b: &[u8]| f64::from(f32::from_le_bytes([b[0], b[1], b[2], b[3]]));
    let corner = |c: &[u8]| V3::new(number(c), number(&c[4..]), number(&c[8..]));
    Ok(facets.flat_map(|facet| facet[12..48].chunks_exact(12).map(corner)).collect())
}

fn ascii_corners(bytes: &[u8]) -> Result<Vec<V3>, BodyError> {
    let text = String::from_utf8_lossy(bytes);
    let mut corners = Vec::new();
    for (line, words) in
        text.lines().enumerate().filter_map(|(i, line)| Some((i + 1, line.trim().strip_prefix("vertex")?)))
    {
        let numbers: Vec<f64> = words.split_whitespace().map_while(|word| word.parse().ok()).collect();
        let [x, y, z] = numbers[..] else {
            return Err(file_error("STL", &format!("line {line}"), "a vertex needs three numbers"));
        };
        corners.push(V3::new(x, y, z));
    }
    Ok(corners)
}

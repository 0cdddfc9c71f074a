//! STL, ASCII and binary.

use super::import::{file_error, merge_equal_vertices};
use crate::BodyError;
use geom::{TriMesh, V3};

/// Bytes of a binary file before its facets, and of one facet.
const HEADER: usize = 84;
const FACET: usize = 50;

/// Whether these bytes are STL: the length fits a binary file's count, or the text begins like an ASCII file.
pub(super) fn is_stl(bytes: &[u8]) -> bool {
    fits_binary(bytes) || bytes.trim_ascii_start().starts_with(b"solid")
}

/// Facets of a binary file by its count, of an ASCII file by its length.
pub(super) fn announced_faces(bytes: &[u8]) -> usize {
    /// Fewest bytes that a facet of an ASCII file takes.
    const ASCII_FACET: usize = 100;
    if fits_binary(bytes) { (bytes.len() - HEADER) / FACET } else { bytes.len() / (4 * ASCII_FACET) }
}

fn fits_binary(bytes: &[u8]) -> bool {
    count(bytes).is_some_and(|count| count.checked_mul(FACET).and_then(|n| n.checked_add(HEADER)) == Some(bytes.len()))
}

fn count(bytes: &[u8]) -> Option<usize> {
    let number = bytes.get(HEADER - 4..HEADER)?;
    Some(u32::from_le_bytes(number.try_into().ok()?) as usize)
}

/// Reads a file and joins the corners of its facets.
///
/// # Errors
/// [`BodyError::File`] with the line of an ASCII file.
pub(super) fn read(bytes: &[u8]) -> Result<TriMesh, BodyError> {
    let corners = if fits_binary(bytes) { binary_corners(bytes) } else { ascii_corners(bytes)? };
    if corners.len() % 3 != 0 {
        return Err(file_error("STL", "end of file", "the last facet has fewer than three vertices"));
    }
    let triangles = (0..corners.len() / 3).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    Ok(merge_equal_vertices(&TriMesh { positions: corners, triangles }))
}

fn binary_corners(bytes: &[u8]) -> Vec<V3> {
    let facets = bytes[HEADER..].chunks_exact(FACET);
    let number = |b: &[u8]| f64::from(f32::from_le_bytes([b[0], b[1], b[2], b[3]]));
    facets
        .flat_map(|facet| {
            facet[12..48]
                .chunks_exact(12)
                .map(|c| V3::new(number(c), number(&c[4..]), number(&c[8..])))
                .collect::<Vec<_>>()
        })
        .collect()
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

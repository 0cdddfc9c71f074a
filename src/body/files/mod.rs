//! Bodies from files and back: formats, units, and which way is up.

mod align;
mod glb;
pub mod import;
mod stl;

use crate::BodyError;

/// Most triangles of a mesh: more tell nothing of a body that a tape could read.
const MOST_TRIANGLES: usize = 1_000_000;

fn too_many(count: usize) -> BodyError {
    let problem = format!("{count} faces, at most {MOST_TRIANGLES} are taken: thin the scan out");
    file_error("mesh", "whole file", &problem)
}

fn file_error(format: &'static str, place: &str, problem: &str) -> BodyError {
    BodyError::File { format, place: place.to_owned(), problem: problem.to_owned() }
}

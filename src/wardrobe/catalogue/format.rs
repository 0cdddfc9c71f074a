//! Formats of the files that entries are imported from.

use std::path::Path;

use pattern::table;
use store::Problem;

#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Format {
    Csv,
    Toml,
    /// A body scan.
    Mesh,
}

pub(super) fn format_of(path: &Path) -> Option<Format> {
    match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
        "csv" | "tsv" => Some(Format::Csv),
        "toml" => Some(Format::Toml),
        "obj" | "ply" | "stl" | "glb" => Some(Format::Mesh),
        _ => None,
    }
}

pub(super) fn unknown_format(path: &Path, accepted: &str) -> Problem {
    Problem::of(path, format!("its name tells no format that can be imported; accepted: {accepted}"))
}

/// Drops a byte order mark.
pub(super) fn text_of<'b>(path: &Path, bytes: &'b [u8]) -> Result<&'b str, Vec<Problem>> {
    table::text(bytes).map_err(|line| {
        let message = "bytes that are no text; accepted: UTF-8".to_owned();
        vec![Problem { line: Some(line), ..Problem::of(path, message) }]
    })
}

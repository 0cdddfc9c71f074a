//! Rules that the sources keep: how long a file may be, what may not be written into one.

use std::fs;

use super::tree::{files, root, text, within};

/// Lines that a source file may have.
const LINES: usize = 600;

#[test]
fn no_source_file_is_too_long() {
    for folder in ["src", "tests", "benches"] {
        for path in files(&root().join(folder), &["rs"]) {
            let lines = text(&path).lines().count();
            assert!(lines <= LINES, "{} has {lines} lines, more than {LINES}", within(&path));
        }
    }
}

#[test]
fn no_file_holds_the_path_of_a_machine() {
    // In two parts, so that this file does not hold them either.
    let homes =
        [["/ro", "ot/"], ["/ho", "me/"], ["/wo", "rk/"], ["/Us", "ers/"], ["C:\\", "Users"]].map(|p| p.concat());
    let mut paths = Vec::new();
    for folder in ["src", "tests", "benches", "studies", "db", ".ci"] {
        paths.extend(files(&root().join(folder), &["rs", "toml", "sql", "csv", "html", "css", "dxf", "snap", "md"]));
    }
    paths.extend(["Cargo.toml", "README.md", "ARCHITECTURE.md", "deny.toml", ".ci/run"].map(|name| root().join(name)));
    for path in paths.iter().filter(|path| path.is_file()) {
        let text = String::from_utf8_lossy(&fs::read(path).expect("readable")).into_owned();
        for (number, line) in text.lines().enumerate() {
            let found = homes.iter().find(|home| line.contains(*home));
            assert!(found.is_none(), "{}, line {}: {line}", within(path), number + 1);
        }
    }
}

#[test]
fn documents_name_what_exists() {
    for name in ["README.md", "ARCHITECTURE.md"] {
        let path = root().join(name);
        if !path.is_file() {
            eprintln!("skipped: {name} is not here");
            continue;
        }
        let text = text(&path);
        for word in text.split(|c: char| c.is_whitespace() || "`()[],;\"'".contains(c)) {
            let word = word.trim_end_matches(['.', ':', '/']).trim_start_matches("./");
            let folder = word.split('/').next().unwrap_or_default();
            let is_plain = word.chars().all(|c| c.is_ascii_alphanumeric() || "/._-".contains(c));
            // What a run writes is not there before it.
            let is_written = word.ends_with(".sqlite") || word.chars().any(|c| c.is_ascii_uppercase());
            if ["src", "tests", "benches", "studies", "db"].contains(&folder) && is_plain && !is_written {
                assert!(root().join(word).exists(), "{name} names {word}, which does not exist");
            }
        }
    }
}

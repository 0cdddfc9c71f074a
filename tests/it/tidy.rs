//! Rules that the sources keep: who may use whom, how long a file may be, what may not be written into one.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// What each module may use of the others; [`EVERYWHERE`] besides.
const MAY_USE: [(&str, &[&str]); 12] = [
    ("units", &[]),
    ("geom", &[]),
    ("body", &[]),
    ("pattern", &[]),
    ("sim", &["body", "pattern"]),
    ("measure", &["pattern", "sim::Drape", "body"]),
    ("fit", &["measure"]),
    ("render", &[]),
    ("report", &["measure", "fit", "render"]),
    ("study", &["body", "pattern", "sim", "measure", "fit", "render", "report"]),
    ("cli", &["study"]),
    ("tui", &["study"]),
];

/// What every module may use.
const EVERYWHERE: [&str; 2] = ["units", "geom"];

/// Parts of one module that never use each other.
const STRANGERS: [[&str; 2]; 1] = [["sim::fem", "sim::hybrid"]];

/// Packages that belong to one module.
const OWNED: [(&str, &str); 1] = [("rusqlite", "study")];

/// Lines that a source file may have.
const LINES: usize = 600;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Files below a folder with one of some extensions, by path.
fn files(folder: &Path, extensions: &[&str]) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).into_iter().flatten() {
        let path = entry.expect("a readable folder").path();
        if path.is_dir() {
            found.extend(files(&path, extensions));
        } else if path.extension().is_some_and(|e| extensions.iter().any(|wanted| e == *wanted)) {
            found.push(path);
        }
    }
    found.sort();
    found
}

fn text(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// A path within the project, with slashes.
fn within(path: &Path) -> String {
    path.strip_prefix(root()).unwrap_or(path).to_string_lossy().replace('\\', "/")
}

/// Module that a source file is: `src/sim/fem/mod.rs` is `[sim, fem]`.
fn module_of(path: &str) -> Vec<String> {
    let path = path.trim_start_matches("src/").trim_end_matches(".rs").trim_end_matches("/mod");
    path.split('/').filter(|part| !["lib", "main"].contains(part)).map(str::to_owned).collect()
}

/// Words and signs of Rust code, without comments and literals.
fn tokens(code: &str) -> Vec<String> {
    let chars: Vec<char> = code.chars().collect();
    let (mut found, mut i) = (Vec::new(), 0);
    let skip_to = |from: usize, ends: &dyn Fn(usize) -> bool| (from..chars.len()).find(|&k| ends(k));
    while i < chars.len() {
        let (c, next) = (chars[i], chars.get(i + 1).copied());
        match c {
            '/' if next == Some('/') => i = skip_to(i, &|k| chars[k] == '\n').unwrap_or(chars.len()),
            '/' if next == Some('*') => {
                i = skip_to(i + 2, &|k| chars[k - 1] == '*' && chars[k] == '/').map_or(chars.len(), |k| k + 1);
            }
            '"' => i = end_of_string(&chars, i),
            'r' if matches!(next, Some('"' | '#')) && !preceded_by_word(&chars, i) => i = end_of_raw(&chars, i),
            '\'' if next == Some('\\') => i = skip_to(i + 3, &|k| chars[k] == '\'').map_or(chars.len(), |k| k + 1),
            '\'' if chars.get(i + 2) == Some(&'\'') => i += 3,
            _ if c.is_alphanumeric() || c == '_' => {
                let end = skip_to(i, &|k| !(chars[k].is_alphanumeric() || chars[k] == '_')).unwrap_or(chars.len());
                found.push(chars[i..end].iter().collect());
                i = end;
            }
            ':' if next == Some(':') => {
                found.push("::".to_owned());
                i += 2;
            }
            _ => {
                if !c.is_whitespace() {
                    found.push(c.to_string());
                }
                i += 1;
            }
        }
    }
    found
}

fn preceded_by_word(chars: &[char], at: usize) -> bool {
    at > 0 && (chars[at - 1].is_alphanumeric() || chars[at - 1] == '_')
}

/// Index after a string literal that begins at `at`.
fn end_of_string(chars: &[char], at: usize) -> usize {
    let mut i = at + 1;
    while i < chars.len() && chars[i] != '"' {
        i += if chars[i] == '\\' { 2 } else { 1 };
    }
    i + 1
}

/// Index after a raw string literal whose `r` is at `at`; after the `r` where it is none (`r#type`).
fn end_of_raw(chars: &[char], at: usize) -> usize {
    let marks = chars[at + 1..].iter().take_while(|&&c| c == '#').count();
    if chars.get(at + 1 + marks) != Some(&'"') {
        return at + 1 + marks;
    }
    let ends = |k: usize| chars[k] == '"' && (1..=marks).all(|m| chars.get(k + m) == Some(&'#'));
    (at + 2 + marks..chars.len()).find(|&k| ends(k)).map_or(chars.len(), |k| k + 1 + marks)
}

/// Full paths, from the crate's root, of all that some code names by `crate::` or `super::`.
fn paths(code: &str, module: &[String]) -> BTreeSet<String> {
    let tokens = tokens(code);
    let mut found = BTreeSet::new();
    for i in 0..tokens.len() {
        let is_start = i == 0 || tokens[i - 1] != "::";
        if is_start && ["crate", "super"].contains(&tokens[i].as_str()) {
            let (mut base, mut at) = (Vec::new(), i);
            if tokens[i] == "super" {
                base = module.to_vec();
                while tokens.get(at).is_some_and(|token| token == "super") {
                    base.pop();
                    at += 2;
                }
            } else {
                at += 2;
            }
            branches(&tokens, at, &base, &mut found);
        }
    }
    found
}

/// Follows a path from `at`, into every branch of `{...}`; returns the index after it.
fn branches(tokens: &[String], mut at: usize, base: &[String], found: &mut BTreeSet<String>) -> usize {
    let mut path = base.to_vec();
    loop {
        match tokens.get(at).map(String::as_str) {
            Some("{") => {
                at += 1;
                while tokens.get(at).is_some_and(|token| token != "}") {
                    at = branches(tokens, at, &path, found);
                    while tokens.get(at).is_some_and(|token| token != "," && token != "}") {
                        at += 1; // `as name`
                    }
                    at += usize::from(tokens.get(at).is_some_and(|token| token == ","));
                }
                return at + 1;
            }
            Some(word) => path.push(word.to_owned()),
            None => return at,
        }
        if tokens.get(at + 1).is_none_or(|token| token != "::") {
            found.insert(path.join("::"));
            return at + 1;
        }
        at += 2;
    }
}

/// Whether a path is a module or lies within it.
fn is_within(path: &str, module: &str) -> bool {
    path.strip_prefix(module).is_some_and(|rest| rest.is_empty() || rest.starts_with("::"))
}

/// What a file of a module uses although it must not.
fn forbidden(module: &[String], code: &str) -> Vec<String> {
    let own = &module[0];
    let may = MAY_USE.iter().find(|(name, _)| name == own).unwrap_or_else(|| panic!("{own} is not in the table")).1;
    let mut wrong = Vec::new();
    for path in paths(code, module) {
        let is_ours = MAY_USE.iter().any(|(name, _)| is_within(&path, name));
        let may_use = |allowed: &&&str| is_within(&path, allowed);
        let is_allowed = is_within(&path, own) || EVERYWHERE.iter().chain(may).find(may_use).is_some();
        if is_ours && !is_allowed {
            wrong.push(path.clone());
        }
        for [a, b] in STRANGERS {
            for (mine, other) in [(a, b), (b, a)] {
                if is_within(&module.join("::"), mine) && is_within(&path, other) {
                    wrong.push(path.clone());
                }
            }
        }
    }
    let words = tokens(code);
    let foreign = OWNED.iter().filter(|(package, owner)| owner != own && words.iter().any(|word| word == package));
    wrong.extend(foreign.map(|(package, _)| (*package).to_owned()));
    wrong
}

#[test]
fn modules_use_only_what_they_may() {
    let (mut wrong, mut seen) = (Vec::new(), BTreeSet::new());
    for path in files(&root().join("src"), &["rs"]) {
        let module = module_of(&within(&path));
        let Some(first) = module.first() else { continue };
        seen.insert(first.clone());
        for used in forbidden(&module, &text(&path)) {
            wrong.push(format!("{}: {used}", within(&path)));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    let table: BTreeSet<String> = MAY_USE.iter().map(|(name, _)| (*name).to_owned()).collect();
    assert_eq!(seen, table, "every module is in the table, and the other way round");
}

#[test]
fn a_forbidden_use_is_seen_however_it_is_written() {
    let check = |module: &str, code: &str, expect: &[&str]| {
        let module: Vec<String> = module.split("::").map(str::to_owned).collect();
        assert_eq!(forbidden(&module, code), expect, "{code}");
    };
    check("body::build", "use crate::pattern::Garment;", &["pattern::Garment"]);
    check(
        "body::build",
        "use crate::{geom::V3, pattern::{Garment as G, Style}};",
        &["pattern::Garment", "pattern::Style"],
    );
    check("body::build", "let x = crate::pattern::read();", &["pattern::read"]);
    check("fit", "use super::sim::Drape;", &["sim::Drape"]);
    check("sim::fem::run", "use super::super::hybrid::x;", &["sim::hybrid::x"]);
    check("sim::hybrid", "use crate::sim::{cloth, fem};", &["sim::fem"]);
    check("measure", "use crate::sim::{Drape, fem};", &["sim::fem"]);
    check("cli::run", "use rusqlite::Connection;", &["rusqlite"]);
    check("tui", "use crate::cli::Workbench;", &["cli::Workbench"]);
    check(
        "body",
        "// use crate::pattern::x;\n/* crate::sim */ let a = \"crate::sim\"; let b = r#\"crate::sim\"#;",
        &[],
    );
    check("body", "use crate::units::mm; use crate::geom::V3; fn f<'a>(c: char) -> bool { c == '\"' }", &[]);
    check("sim::fem", "use crate::sim::cloth; use super::Drape; use crate::body::Body;", &[]);
    check("cli", "use crate::study::{self, tools};", &[]);
}

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
        if name == "ARCHITECTURE.md" {
            for (module, _) in MAY_USE {
                assert!(text.contains(module), "{name} does not name the module {module}");
            }
        }
    }
}

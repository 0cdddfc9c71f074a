//! Files with their bytes: those that a study reads, and those that the program writes.

use std::path::{Component, Path, PathBuf};
use std::sync::Arc;

use crate::error::{FileError, Origin, Result, StudyError};
use pattern::source::{self, Kind};
use report::file_part;

/// Greatest length of a study's name, bytes: folders and files are named after the study.
const MOST_NAME_BYTES: usize = 200;

/// A file as read; or a folder of DXF files, each with a piece of the same pattern, taken as one file.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct SourceFile {
    /// Name without folders; that of a folder ends in `/`.
    pub name: String,
    /// Contents (base64 in JSON). Of a folder: name, length and contents of each of its files, one after another.
    #[serde(with = "base64_bytes")]
    pub bytes: Arc<[u8]>,
}

mod base64_bytes {
    use std::sync::Arc;

    use base64::prelude::{BASE64_STANDARD, Engine};
    use serde::de::Error;
    use serde::{Deserialize, Deserializer, Serializer};

    pub fn serialize<S: Serializer>(bytes: &Arc<[u8]>, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(&BASE64_STANDARD.encode(bytes))
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Arc<[u8]>, D::Error> {
        let text = String::deserialize(deserializer)?;
        BASE64_STANDARD.decode(text).map(Arc::from).map_err(D::Error::custom)
    }
}

impl SourceFile {
    /// True if the file is a pattern that holds its own seams, as GarmentCode JSON does. Judged by the contents.
    pub fn holds_seams(&self) -> bool {
        !self.name.ends_with('/') && source::kind(&self.bytes) == Kind::GarmentCode
    }

    pub fn read(path: &Path) -> Result<Self> {
        let bytes = std::fs::read(path).map_err(StudyError::io(path))?;
        Ok(Self { name: name_of(path), bytes: bytes.into() })
    }

    /// Reads a pattern: a file, or all DXF files of a folder, sorted by name. A folder without DXF files must have
    /// exactly one JSON file that is a pattern, under any name.
    pub fn read_pattern(path: &Path) -> Result<Self> {
        if !path.is_dir() {
            return Self::read(path);
        }
        let ends_in = |file: &Path, ending: &str| {
            file.extension().is_some_and(|extension| extension.eq_ignore_ascii_case(ending))
        };
        let (mut files, mut json): (Vec<PathBuf>, Vec<Self>) = (Vec::new(), Vec::new());
        for entry in std::fs::read_dir(path).map_err(StudyError::io(path))? {
            let file = entry.map_err(StudyError::io(path))?.path();
            if ends_in(&file, "dxf") {
                files.push(file);
            } else if ends_in(&file, "json") {
                let read = Self::read(&file)?;
                json.extend(source::is_json_pattern(&read.bytes).then_some(read));
            }
        }
        files.sort();
        if files.is_empty() {
            if json.len() == 1 {
                return Ok(json.swap_remove(0));
            }
            let error = FileError::NoPattern { folder: path.to_owned(), patterns: json.len() };
            return Err(StudyError::refused(Origin::Pattern, error));
        }
        let parts = files.iter().map(|file| Self::read(file)).collect::<Result<Vec<_>>>()?;
        Ok(Self::folder(&name_of(path), &parts))
    }

    pub fn folder(name: &str, parts: &[Self]) -> Self {
        let mut bytes = Vec::new();
        for part in parts {
            bytes.extend_from_slice(format!("{}\0{}\0", part.name, part.bytes.len()).as_bytes());
            bytes.extend_from_slice(&part.bytes);
        }
        Self { name: format!("{name}/"), bytes: bytes.into() }
    }

    /// File itself, or those of the folder.
    pub fn parts(&self) -> Vec<Self> {
        if !self.name.ends_with('/') {
            return vec![self.clone()];
        }
        let mut parts = Vec::new();
        let mut rest = &self.bytes[..];
        // Bytes of `folder` split without a remainder; other bytes end the list.
        while let Some((name, after)) = split_zero(rest) {
            let Some((length, after)) = split_zero(after) else { break };
            let length = String::from_utf8_lossy(length).parse().unwrap_or(usize::MAX);
            let Some((bytes, after)) = after.split_at_checked(length) else { break };
            parts.push(Self { name: String::from_utf8_lossy(name).into_owned(), bytes: bytes.into() });
            rest = after;
        }
        parts
    }

    /// BLAKE3 of the contents, hex.
    pub fn hash(&self) -> String {
        blake3::hash(&self.bytes).to_hex().to_string()
    }
}

fn name_of(path: &Path) -> String {
    let full = path.canonicalize().unwrap_or_else(|_| path.to_owned());
    let named = if path.is_dir() { &full } else { path };
    named.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

fn split_zero(bytes: &[u8]) -> Option<(&[u8], &[u8])> {
    let at = bytes.iter().position(|&byte| byte == 0)?;
    Some((&bytes[..at], &bytes[at + 1..]))
}

/// Format by the ending of the name.
pub fn kind_of<T: Copy>(path: &Path, accepted: &[(&str, T)]) -> std::result::Result<T, FileError> {
    let extension = path.extension().unwrap_or_default().to_string_lossy();
    if let Some((_, kind)) = accepted.iter().find(|(ending, _)| extension.eq_ignore_ascii_case(ending)) {
        return Ok(*kind);
    }
    let found = if extension.is_empty() { "no ending".to_owned() } else { format!("`.{extension}`") };
    let names: Vec<String> = accepted.iter().map(|(ending, _)| format!("X.{ending}")).collect();
    let accepted = match names.split_last() {
        Some((last, rest)) if !rest.is_empty() => format!("{} or {last}", rest.join(", ")),
        _ => names.concat(),
    };
    Err(FileError::Format { path: path.to_owned(), found, accepted })
}

/// Makes a folder and tries to write there, so that a run fails at once and not after hours of work.
pub fn make_folder(folder: &Path) -> Result<()> {
    std::fs::create_dir_all(folder).map_err(StudyError::io(folder))?;
    let probe = folder.join(format!(".toile-{}", std::process::id()));
    std::fs::write(&probe, []).map_err(StudyError::io(folder))?;
    std::fs::remove_file(&probe).map_err(StudyError::io(&probe))
}

/// Reports, logs and jobs of a study lie in a folder or file of its name. The error tells the accepted names.
pub fn check_study_name(name: &str) -> std::result::Result<(), String> {
    let is_odd = |letter: char| letter.is_control() || matches!(letter, '/' | '\\');
    let is_one = !name.trim().is_empty() && name != "." && name != ".." && !name.chars().any(is_odd);
    if is_one && name.len() <= MOST_NAME_BYTES {
        return Ok(());
    }
    Err(format!("accepted: a name that a folder may have, of at most {MOST_NAME_BYTES} bytes, without `/` and `\\`"))
}

/// Name of the folder or file of a study: the study's own name where [`check_study_name`] accepts it, else a safe one.
/// A name in a database from elsewhere may be one that is not accepted.
pub fn study_folder(study: &str) -> String {
    if check_study_name(study).is_ok() { study.to_owned() } else { file_part(study) }
}

/// Returns the paths. Makes the folder where it is missing. Writes nothing where a file's name leads out of the folder.
pub fn write_files(folder: &Path, files: &[(String, Vec<u8>)]) -> Result<Vec<PathBuf>> {
    let is_within = |name: &str| Path::new(name).components().all(|part| matches!(part, Component::Normal(_)));
    if let Some((name, _)) = files.iter().find(|(name, _)| name.is_empty() || !is_within(name)) {
        let error = FileError::Outside { folder: folder.to_owned(), name: name.clone() };
        return Err(StudyError::refused(Origin::Store, error));
    }
    let mut paths = Vec::new();
    for (name, bytes) in files {
        let path = folder.join(name);
        let parent = path.parent().unwrap_or(folder);
        std::fs::create_dir_all(parent).map_err(StudyError::io(parent))?;
        std::fs::write(&path, bytes).map_err(StudyError::io(&path))?;
        paths.push(path);
    }
    Ok(paths)
}

/// Text as one word of a shell's command line.
pub fn word(text: &str) -> String {
    let is_plain = |letter: char| letter.is_ascii_alphanumeric() || "_-./+@%".contains(letter);
    if !text.is_empty() && text.chars().all(is_plain) {
        return text.to_owned();
    }
    format!("'{}'", text.replace('\'', "'\\''"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_of_a_shell_are_quoted() {
        let check = |text: &str, expect: &str| assert_eq!(word(text), expect);
        check("studies/a-b_1.toml", "studies/a-b_1.toml");
        check("my shirt", "'my shirt'");
        check("anna's", "'anna'\\''s'");
        check("", "''");
    }

    #[test]
    fn a_folder_of_another_program_is_its_one_pattern() {
        let folder = tempfile::tempdir().expect("a folder");
        let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).expect("writable");
        write("anything.json", "{\"pattern\": {\"panels\": {}}}");
        write("design.json", "{\"design\": 1}");
        write("body.yaml", "body:");
        assert_eq!(SourceFile::read_pattern(folder.path()).expect("one pattern").name, "anything.json");
        write("another.json", "{\"pattern\": {\"panels\": {}}}");
        let told = SourceFile::read_pattern(folder.path()).expect_err("two").to_string();
        assert!(told.contains("2 patterns as JSON"), "{told}");
    }

    #[test]
    fn the_ending_of_a_file_is_its_format() {
        let check = |name: &str, expect: std::result::Result<u8, &str>| {
            let found = kind_of(Path::new(name), &[("csv", 1), ("json", 2), ("txt", 3)]);
            assert_eq!(found.map_err(|error| error.to_string()), expect.map_err(str::to_owned), "{name}");
        };
        check("a.csv", Ok(1));
        check("b/a.b.JSON", Ok(2));
        check("a.parquet", Err("a.parquet: found `.parquet`; accepted: X.csv, X.json or X.txt"));
        check("csv", Err("csv: found no ending; accepted: X.csv, X.json or X.txt"));
        let told = kind_of(Path::new("a.b"), &[("svg", ())]).expect_err("another format").to_string();
        assert_eq!(told, "a.b: found `.b`; accepted: X.svg");
    }

    #[test]
    fn files_lie_in_their_folder() {
        let folder = tempfile::tempdir().expect("a folder");
        let inner = folder.path().join("a/b");
        let check = |name: &str, expect: bool| {
            let written = write_files(&inner, &[(name.to_owned(), b"x".to_vec())]);
            assert_eq!(written.is_ok(), expect, "{name}");
        };
        check("x.csv", true);
        check("charts/上衣 ..svg", true);
        check("../x.csv", false);
        check("charts/../../x.csv", false);
        check("", false);
        check(&folder.path().join("x.csv").to_string_lossy(), false);
        assert!(!folder.path().join("x.csv").exists() && !folder.path().join("a/x.csv").exists());
    }

    #[test]
    fn a_study_is_called_as_a_folder_may_be() {
        let long = "x".repeat(MOST_NAME_BYTES + 1);
        let check = |name: &str, folder: &str| {
            assert_eq!(check_study_name(name).is_ok(), name == folder, "{name:?}");
            assert_eq!(study_folder(name), folder, "{name:?}");
        };
        for same in ["thesis", "first try", "上衣", ".hidden", "a: b", "T-shirt, 2nd"] {
            check(same, same);
        }
        check("../../../OUT", "OUT");
        check("/etc/x", "etc-x");
        check("a\\b", "a-b");
        check("..", "unnamed");
        check("  ", "unnamed");
        check("a\nb", "a-b");
        check(&long, &long[..160]);
    }

    #[test]
    fn a_folder_is_its_dxf_files_by_name() {
        let folder = tempfile::tempdir().expect("a folder");
        for (name, text) in [("b.DXF", "two\0"), ("a.dxf", "one"), ("notes.txt", "x"), ("c.dxf", "")] {
            std::fs::write(folder.path().join(name), text).expect("writable");
        }
        let source = SourceFile::read_pattern(folder.path()).expect("it reads");
        let parts: Vec<(String, Vec<u8>)> =
            source.parts().into_iter().map(|part| (part.name, part.bytes.to_vec())).collect();
        let expect = [("a.dxf", "one"), ("b.DXF", "two\0"), ("c.dxf", "")];
        assert_eq!(parts, expect.map(|(name, text)| (name.to_owned(), text.as_bytes().to_vec())));
        let cut = SourceFile { bytes: source.bytes[..source.bytes.len() - 3].into(), ..source };
        assert_eq!(cut.parts().len(), 2);
        assert!(SourceFile::read_pattern(&folder.path().join("none")).is_err());
    }
}

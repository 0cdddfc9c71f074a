//! The user's own editor.

use std::io::Write;
use std::path::Path;
use std::process::Command;

use crate::messages::effect::Writing;

/// Opens a text in `$VISUAL`, `$EDITOR` or vi. Returns the saved text.
pub fn edit(what: &Writing) -> Result<String, String> {
    let (text, ending) = match what {
        Writing::File(path) => {
            run(path)?;
            return read(path);
        }
        Writing::Query(text) => (text.clone().into_bytes(), ".sql"),
        Writing::Seams(_, file) => (file.bytes.to_vec(), ".seams.toml"),
    };
    let file = tempfile::Builder::new().prefix("toile-").suffix(ending).tempfile();
    let mut file = file.map_err(|error| format!("no file to edit: {error}"))?;
    file.write_all(&text).map_err(|error| format!("{}: {error}", file.path().display()))?;
    // Editors may replace the file by another, so the file is read again by its path.
    let path = file.into_temp_path();
    run(&path)?;
    read(&path)
}

fn read(path: &Path) -> Result<String, String> {
    std::fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))
}

/// Runs the editor on a file. The editor's name may have arguments.
fn run(path: &Path) -> Result<(), String> {
    let named = |name: &str| std::env::var(name).ok().filter(|editor| !editor.trim().is_empty());
    let editor = named("VISUAL").or_else(|| named("EDITOR")).unwrap_or_else(|| "vi".to_owned());
    let status = Command::new("sh").arg("-c").arg(format!("{editor} \"$1\"")).arg("sh").arg(path).status();
    match status {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(format!("{editor}: {status}: nothing is taken back; EDITOR names another")),
        Err(error) => Err(format!("{editor}: {error}; EDITOR names another")),
    }
}

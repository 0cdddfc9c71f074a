//! Prompt for the path of a file or folder, or for a name.

use std::path::PathBuf;

use crossterm::event::{KeyCode, KeyEvent};
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::Line;

use crate::messages::effect::Effect;
use crate::messages::requests::{Command, FileTask, QueryRequest};
use crate::overlays::form_frame::{Sending, draw_frame, ended};
use crate::overlays::outcome::Outcome;
use crate::widgets::theme::Theme;
use crate::widgets::typing::edit;
use wardrobe::Part;

/// Purpose of the path or name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// Path of a file with subjects or fabrics to import.
    Import(Part),
    /// Path of a file for the rows of a query.
    Export(String),
    /// Path of a folder for the files of an altered pattern.
    Write(Vec<(String, Vec<u8>)>),
    /// Name under which to save a query.
    SaveQuery(String),
    /// New name for a saved query.
    RenameQuery(String),
}

impl Purpose {
    /// Title of the prompt.
    #[must_use]
    pub fn title(&self) -> &'static str {
        match self {
            Self::Import(Part::Fabric) => "import fabrics from",
            Self::Import(_) => "import subjects from",
            Self::Export(_) => "write all rows of the query into",
            Self::Write(_) => "write the changed pattern, its seam file and a sheet into",
            Self::SaveQuery(_) => "save the query as",
            Self::RenameQuery(_) => "rename the saved query to",
        }
    }

    /// Hint at the paths that are accepted.
    #[must_use]
    pub fn hint(&self) -> &'static str {
        match self {
            Self::Import(Part::Fabric) => "TOML with [[fabric]] tables, or CSV with columns name, density_kg_m2, …",
            Self::Import(_) => "CSV with columns name, sex, stature_mm, …, or a study.toml",
            Self::Export(_) => "a new file: NAME.csv or NAME.json",
            Self::Write(_) => "a folder, which is made where it is missing",
            Self::SaveQuery(_) => {
                "a name: NAME.sql in the folder queries beside the database; one of that name is replaced"
            }
            Self::RenameQuery(_) => "a name that no saved query has",
        }
    }

    /// Work that goes on after Enter.
    #[must_use]
    pub fn busy(&self) -> &'static str {
        match self {
            Self::Import(Part::Fabric) => "reading…",
            Self::Import(_) => "reading, and building each body…",
            Self::Export(_) | Self::Write(_) | Self::SaveQuery(_) | Self::RenameQuery(_) => "writing…",
        }
    }

    /// Legend of the keys.
    #[must_use]
    pub fn keys(&self) -> &'static str {
        match self {
            Self::Import(_) => " ↵ import all or none  Tab complete  Esc cancel ",
            Self::Export(_) | Self::Write(_) => " ↵ write  Tab complete  Esc cancel ",
            Self::SaveQuery(_) => " ↵ save  Esc cancel ",
            Self::RenameQuery(_) => " ↵ rename  Esc cancel ",
        }
    }
}

/// A prompt for a path or name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PathPrompt {
    /// Purpose of the prompt.
    pub purpose: Purpose,
    /// Text as typed.
    pub text: String,
    /// Progress of reading or writing the file.
    pub sending: Sending,
}

impl PathPrompt {
    /// Makes a prompt with a text to begin with.
    #[must_use]
    pub fn new(purpose: Purpose, text: impl Into<String>) -> Self {
        Self { purpose, text: text.into(), sending: Sending::default() }
    }

    /// True if the prompt is for a name, not for a path.
    fn is_name(&self) -> bool {
        matches!(self.purpose, Purpose::SaveQuery(_) | Purpose::RenameQuery(_))
    }

    /// Handles a key.
    pub fn key(&mut self, event: &KeyEvent) -> Outcome {
        if self.sending.is_busy {
            return Outcome::Open;
        }
        if event.code == KeyCode::Tab && !self.is_name() {
            self.text = completed(&self.text).unwrap_or_else(|| self.text.clone());
            return Outcome::Open;
        }
        if event.code != KeyCode::Enter {
            edit(&mut self.text, event);
            return Outcome::Open;
        }
        let path = self.text.trim();
        if path.is_empty() {
            return Outcome::Closed;
        }
        self.sending.start();
        let path = path_of(path);
        Outcome::Sent(vec![match &self.purpose {
            Purpose::Import(part) => Effect::Do(Command::Import(*part, path)),
            Purpose::Export(query) => Effect::Query(QueryRequest::Export(query.clone(), path)),
            Purpose::SaveQuery(query) => Effect::Query(QueryRequest::Save(query.clone(), self.text.trim().to_owned())),
            Purpose::RenameQuery(name) => {
                Effect::Query(QueryRequest::Rename(name.clone(), self.text.trim().to_owned()))
            }
            Purpose::Write(files) => Effect::Files(FileTask::Write(path, files.clone())),
        }])
    }
}

/// Path that was typed; `~/` is the home folder.
pub fn path_of(text: &str) -> PathBuf {
    let home = text.strip_prefix("~/").zip(std::env::home_dir());
    home.map_or_else(|| PathBuf::from(text), |(rest, home)| home.join(rest))
}

/// Typed path, completed as far as the files that exist leave no choice; `None` where that adds nothing.
#[must_use]
pub fn completed(text: &str) -> Option<String> {
    let (folder, start) =
        text.rsplit_once('/').map_or(("", text), |(_, start)| (&text[..text.len() - start.len()], start));
    let place = if folder.is_empty() { PathBuf::from(".") } else { path_of(folder) };
    let name = |entry: std::fs::DirEntry| {
        let end = if entry.path().is_dir() { "/" } else { "" };
        Some(entry.file_name().to_str()?.to_owned() + end)
    };
    let is_meant = |name: &String| name.starts_with(start) && (start.starts_with('.') || !name.starts_with('.'));
    let names: Vec<String> = std::fs::read_dir(place).ok()?.flatten().filter_map(name).filter(is_meant).collect();
    let first = names.first()?;
    let shared =
        |count: &usize| first.is_char_boundary(*count) && names.iter().all(|name| name.starts_with(&first[..*count]));
    let count = (start.len() + 1..=first.len()).rev().find(shared)?;
    Some(format!("{folder}{}", &first[..count]))
}

/// Draws the prompt.
pub fn draw(frame: &mut Frame<'_>, area: Rect, prompt: &PathPrompt, theme: Theme) {
    let width = area.width.min(100);
    let columns = usize::from(width.saturating_sub(2));
    // The end of a long path is shown, since typing goes on there.
    let mut lines = vec![Line::styled(ended(&format!(" {}▏", prompt.text), columns, true), theme.bold())];
    lines.extend(prompt.sending.lines(prompt.purpose.busy(), columns, theme));
    if lines.len() == 1 {
        let home = if prompt.is_name() { "" } else { "; ~/ is home" };
        lines.push(Line::styled(format!(" {}{home}", prompt.purpose.hint()), theme.dim()));
    }
    draw_frame(frame, area, width, prompt.purpose.title().to_owned(), prompt.purpose.keys(), lines, theme);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_are_completed_as_far_as_there_is_no_choice() {
        let folder = tempfile::tempdir().expect("a folder");
        let place = folder.path().display().to_string();
        for name in ["shirt-front.dxf", "shirt-back.dxf", ".hidden"] {
            std::fs::write(folder.path().join(name), "").expect("writable");
        }
        std::fs::create_dir(folder.path().join("trousers")).expect("writable");
        let check = |typed: &str, expect: Option<&str>| {
            let found = completed(&format!("{place}/{typed}"));
            assert_eq!(found, expect.map(|expect| format!("{place}/{expect}")), "{typed}");
        };
        check("s", Some("shirt-"));
        check("shirt-b", Some("shirt-back.dxf"));
        check("shirt-", None);
        check("t", Some("trousers/"));
        check("x", None);
        check(".", Some(".hidden"));
        check("trousers/", None);
    }
}

//! Prompt for the path of a file or folder, or for a name.

use std::path::PathBuf;

use crossterm::event::{KeyCode, KeyEvent};
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::Line;

use crate::messages::comments::{CommentDeed, FittingOf};
use crate::messages::effect::Effect;
use crate::messages::requests::{Command, FileTask, QueryRequest};
use crate::overlays::form_frame::{Sending, draw_frame, ended};
use crate::overlays::outcome::Outcome;
use crate::widgets::text::{self, left, shortened};
use crate::widgets::theme::Theme;
use crate::widgets::typing::edit;
use wardrobe::Part;

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
    RenameQuery(String),
    /// Name of who signs the last round of a fitting off.
    Sign(FittingOf),
}

impl Purpose {
    pub fn title(&self) -> &'static str {
        match self {
            Self::Import(Part::Fabric) => "import fabrics from",
            Self::Import(_) => "import subjects from",
            Self::Export(_) => "write all rows of the query into",
            Self::Write(_) => "write the changed pattern, its seam file and a sheet into",
            Self::SaveQuery(_) => "save the query as",
            Self::RenameQuery(_) => "rename the saved query to",
            Self::Sign(_) => "sign the last round off as",
        }
    }

    pub fn hint(&self) -> &'static str {
        match self {
            Self::Import(Part::Fabric) => "TOML with [[fabric]] tables, or CSV with columns name, density_kg_m2, …",
            Self::Import(_) => "CSV with columns name, sex, stature_mm, …, or a study.toml",
            Self::Export(_) => "a new file: NAME.csv, NAME.json, NAME.parquet or NAME.xlsx",
            Self::Write(_) => "a folder, which is made where it is missing",
            Self::SaveQuery(_) => {
                "a name: NAME.sql in the folder queries beside the database; one of that name is replaced"
            }
            Self::RenameQuery(_) => "a name that no saved query has",
            Self::Sign(_) => "your name; a later signature takes its place",
        }
    }

    /// Work that goes on after Enter.
    pub fn busy(&self) -> &'static str {
        match self {
            Self::Import(Part::Fabric) => "reading…",
            Self::Import(_) => "reading, and building each body…",
            Self::Export(_) | Self::Write(_) | Self::SaveQuery(_) | Self::RenameQuery(_) | Self::Sign(_) => "writing…",
        }
    }

    /// Endings of the files that Tab offers; empty for all files.
    fn endings(&self) -> &'static [&'static str] {
        match self {
            Self::Import(_) => &["csv", "toml"],
            Self::Export(_) => &ENDINGS,
            Self::Write(_) | Self::SaveQuery(_) | Self::RenameQuery(_) | Self::Sign(_) => &[],
        }
    }

    pub fn keys(&self) -> &'static str {
        match self {
            Self::Import(_) => " ↵ import all or none  Tab complete  Esc cancel ",
            Self::Export(_) => " ↵ write  Tab completes, or changes the ending  Esc cancel ",
            Self::Write(_) => " ↵ write  Tab complete  Esc cancel ",
            Self::SaveQuery(_) => " ↵ save  Esc cancel ",
            Self::RenameQuery(_) => " ↵ rename  Esc cancel ",
            Self::Sign(_) => " ↵ sign  Esc cancel ",
        }
    }
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PathPrompt {
    pub purpose: Purpose,
    pub text: String,
    /// Files among which the typed path leaves a choice, after Tab.
    pub offered: Candidates,
    pub sending: Sending,
}

impl PathPrompt {
    pub fn new(purpose: Purpose, text: impl Into<String>) -> Self {
        Self { purpose, text: text.into(), offered: Candidates::default(), sending: Sending::default() }
    }

    fn is_name(&self) -> bool {
        matches!(self.purpose, Purpose::SaveQuery(_) | Purpose::RenameQuery(_) | Purpose::Sign(_))
    }

    pub fn key(&mut self, event: &KeyEvent) -> Outcome {
        if self.sending.is_busy {
            return Outcome::Open;
        }
        if event.code == KeyCode::Tab && !self.is_name() {
            let before = self.text.len();
            self.offered = Candidates::complete(&mut self.text, self.purpose.endings());
            if matches!(self.purpose, Purpose::Export(_)) && self.offered.is_empty() && self.text.len() == before {
                next_ending(&mut self.text);
            }
            return Outcome::Open;
        }
        self.offered = Candidates::default();
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
            Purpose::Sign(of) => {
                let by = self.text.trim().to_owned();
                Effect::Do(Command::Comment(of.clone(), CommentDeed::Sign(by)))
            }
            Purpose::Write(files) => Effect::Files(FileTask::Write(path, files.clone())),
        }])
    }
}

/// Endings of files for the rows of a query.
const ENDINGS: [&str; 4] = ["csv", "json", "parquet", "xlsx"];

/// Gives a path with one of these endings the next one.
fn next_ending(path: &mut String) {
    let Some((name, ending)) = path.rsplit_once('.') else { return };
    if let Some(at) = ENDINGS.iter().position(|known| *known == ending) {
        *path = format!("{name}.{}", ENDINGS[(at + 1) % ENDINGS.len()]);
    }
}

/// Takes `~/` as the home folder.
pub fn path_of(text: &str) -> PathBuf {
    let home = text.strip_prefix("~/").zip(std::env::home_dir());
    home.map_or_else(|| PathBuf::from(text), |(rest, home)| home.join(rest))
}

/// Files of a folder that a typed path may mean.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Candidates {
    /// Names of the files, in order; those of folders end in `/`.
    names: Vec<String>,
}

impl Candidates {
    /// Completes a typed path as far as the files that exist leave no choice. Returns the files among which there is a
    /// choice, where the path cannot be completed; no files where it was. Only folders and files with some endings are
    /// offered; all files without any endings.
    pub fn complete(text: &mut String, endings: &[&str]) -> Self {
        let (folder, start) =
            text.rsplit_once('/').map_or(("", text.as_str()), |(_, start)| (&text[..text.len() - start.len()], start));
        let mut names = names_of(folder, start, endings);
        let Some(first) = names.first() else { return Self::default() };
        let shared = |count: &usize| {
            first.is_char_boundary(*count) && names.iter().all(|name| name.starts_with(&first[..*count]))
        };
        if let Some(count) = (start.len() + 1..=first.len()).rev().find(shared) {
            *text = format!("{folder}{}", &first[..count]);
            names.clear();
        }
        Self { names }
    }

    pub fn is_empty(&self) -> bool {
        self.names.len() < 2
    }

    pub fn lines(&self, columns: usize, lines: usize, theme: Theme) -> Vec<Line<'static>> {
        if self.is_empty() || lines == 0 {
            return vec![];
        }
        let widest = self.names.iter().map(|name| text::width(name)).max().unwrap_or(0) + 2;
        let across = (columns.saturating_sub(1) / widest).max(1);
        let rows: Vec<&[String]> = self.names.chunks(across).collect();
        let shown = if rows.len() > lines { lines - 1 } else { rows.len() };
        let line = |names: &&[String]| {
            let cells = names.iter().map(|name| left(name, widest)).collect::<String>();
            Line::raw(shortened(&format!(" {}", cells.trim_end()), columns))
        };
        let mut told: Vec<Line<'_>> = rows.iter().take(shown).map(line).collect();
        let more = self.names.len().saturating_sub(shown * across);
        if more > 0 {
            told.push(Line::styled(format!(" … and {more} more"), theme.dim()));
        }
        told
    }
}

/// Names of the files of a folder that begin with a text and have one of some endings, and of its folders, in order.
fn names_of(folder: &str, start: &str, endings: &[&str]) -> Vec<String> {
    let place = if folder.is_empty() { PathBuf::from(".") } else { path_of(folder) };
    let name = |entry: std::fs::DirEntry| {
        let end = if entry.path().is_dir() { "/" } else { "" };
        Some(entry.file_name().to_str()?.to_owned() + end)
    };
    let has_ending = |name: &str| {
        let own = name.rsplit_once('.').map_or("", |(_, ending)| ending);
        endings.is_empty() || name.ends_with('/') || endings.iter().any(|ending| own.eq_ignore_ascii_case(ending))
    };
    let is_meant = |name: &String| {
        name.starts_with(start) && (start.starts_with('.') || !name.starts_with('.')) && has_ending(name)
    };
    let files = std::fs::read_dir(place).into_iter().flatten().flatten();
    let mut names: Vec<String> = files.filter_map(name).filter(is_meant).collect();
    names.sort();
    names
}

pub fn draw(frame: &mut Frame<'_>, area: Rect, prompt: &PathPrompt, theme: Theme) {
    let width = area.width.min(100);
    let columns = usize::from(width.saturating_sub(2));
    // The end of a long path is shown, since typing goes on there.
    let mut lines = vec![Line::styled(ended(&format!(" {}▏", prompt.text), columns, true), theme.bold())];
    lines.extend(prompt.sending.lines(prompt.purpose.busy(), columns, theme));
    lines.extend(prompt.offered.lines(columns, usize::from(area.height.saturating_sub(4)), theme));
    if lines.len() == 1 {
        let home = if prompt.is_name() { "" } else { "; ~/ is home" };
        lines.push(Line::styled(format!(" {}{home}", prompt.purpose.hint()), theme.dim()));
    }
    draw_frame(frame, area, width, prompt.purpose.title().to_owned(), prompt.purpose.keys(), lines, theme);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::widgets::theme::Colours;

    #[test]
    fn paths_are_completed_as_far_as_there_is_no_choice() {
        let folder = tempfile::tempdir().expect("a folder");
        let place = folder.path().display().to_string();
        for name in ["shirt-front.dxf", "shirt-back.DXF", ".hidden.dxf", "shirt-tool"] {
            std::fs::write(folder.path().join(name), "").expect("writable");
        }
        std::fs::create_dir(folder.path().join("trousers")).expect("writable");
        let check = |typed: &str, expect: &str, offered: &[&str]| {
            let mut text = format!("{place}/{typed}");
            let found = Candidates::complete(&mut text, &["dxf", "json"]);
            let found: Vec<&str> =
                if found.is_empty() { vec![] } else { found.names.iter().map(String::as_str).collect() };
            assert_eq!((text, found.as_slice()), (format!("{place}/{expect}"), offered), "{typed}");
        };
        check("s", "shirt-", &[]);
        check("shirt-b", "shirt-back.DXF", &[]);
        check("shirt-", "shirt-", &["shirt-back.DXF", "shirt-front.dxf"]);
        check("t", "trousers/", &[]);
        check("", "", &["shirt-back.DXF", "shirt-front.dxf", "trousers/"]);
        check("x", "x", &[]);
        check(".", ".hidden.dxf", &[]);
        check("shirt-t", "shirt-t", &[]);
        check("trousers/", "trousers/", &[]);
    }

    #[test]
    fn tab_changes_the_ending_of_a_file_for_rows() {
        let check = |purpose: Purpose, text: &str, expect: &str| {
            let mut prompt = PathPrompt::new(purpose, text);
            prompt.key(&KeyEvent::from(KeyCode::Tab));
            assert_eq!(prompt.text, expect, "{text}");
        };
        let rows = || Purpose::Export("SELECT 1".into());
        check(rows(), "no-such-folder/rows.csv", "no-such-folder/rows.json");
        check(rows(), "no-such-folder/rows.json", "no-such-folder/rows.parquet");
        check(rows(), "no-such-folder/rows.xlsx", "no-such-folder/rows.csv");
        check(rows(), "no-such-folder/rows", "no-such-folder/rows");
        check(rows(), "no-such-folder/rows.txt", "no-such-folder/rows.txt");
        check(Purpose::Import(Part::Subject), "no-such-folder/rows.csv", "no-such-folder/rows.csv");
    }

    #[test]
    fn a_long_choice_is_cut_with_its_number() {
        let names = (0..30).map(|k| format!("size-{k:02}.dxf")).collect();
        let lines = Candidates { names }.lines(30, 4, Theme::new(Colours::None, false));
        let texts: Vec<String> = lines.iter().map(Line::to_string).collect();
        assert_eq!(texts[0], " size-00.dxf  size-01.dxf");
        assert_eq!(texts[3], " … and 24 more");
    }
}

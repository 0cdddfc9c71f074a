//! What is filled in: the values of a subject, each checked while it is typed, and the path of a file to import.

use std::path::PathBuf;

use crossterm::event::{KeyCode, KeyEvent};

use super::asker::Question;
use super::message::{Act, Effect};
use super::overlay::{Outcome, edit};
use super::text;
use crate::study::tools::Sex;
use crate::study::{Given, MEASUREMENTS, Mode, SubjectRow, is_doubtful, percentile, percentile_text, sex};

/// Lines of a form before its measurements: name and sex.
const NAME: usize = 0;
const SEX: usize = 1;
const FIRST_NUMBER: usize = 2;

/// What stands beside a value.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Note {
    /// Nothing.
    None,
    /// Where it stands among adults of the sex.
    Percentile(String),
    /// It is possible but rare.
    Doubt(String),
    /// It cannot be.
    Problem(String),
}

/// The values of a subject, as typed.
#[derive(Clone, Debug, PartialEq)]
pub struct Form {
    /// Whether the subject is new.
    pub mode: Mode,
    /// Name, sex, and the measurements.
    pub texts: Vec<String>,
    /// Line that is typed in.
    pub at: usize,
    /// Whether all problems are told, also those of empty lines.
    is_tried: bool,
    /// Whether it is being saved.
    pub is_busy: bool,
    /// Why it could not be saved.
    pub problem: Option<String>,
}

impl Form {
    /// The form of a new subject.
    #[must_use]
    pub fn empty() -> Self {
        let mut texts = vec![String::new(); FIRST_NUMBER + MEASUREMENTS.len()];
        texts[SEX] = "female".to_owned();
        Self { mode: Mode::Add, texts, at: NAME, is_tried: false, is_busy: false, problem: None }
    }

    /// The form of a subject that is there.
    #[must_use]
    pub fn of(subject: &SubjectRow) -> Self {
        let value = |value: Option<f64>| value.map_or(String::new(), |value| value.to_string());
        let mut texts = vec![subject.name.clone(), text::sex(subject).to_owned()];
        texts.extend(MEASUREMENTS.iter().map(|field| value(field.get(&subject.measurements))));
        Self { mode: Mode::Edit, texts, at: FIRST_NUMBER, ..Self::empty() }
    }

    /// Name of the subject.
    #[must_use]
    pub fn name(&self) -> &str {
        self.texts[NAME].trim()
    }

    /// Whether a line can be typed in: the name of a subject stays.
    fn is_open(&self, line: usize) -> bool {
        line != NAME || self.mode == Mode::Add
    }

    /// Name of a line.
    #[must_use]
    pub fn label(line: usize) -> &'static str {
        match line {
            NAME => "name",
            SEX => "sex",
            number => MEASUREMENTS[number - FIRST_NUMBER].label,
        }
    }

    /// Unit of a line.
    #[must_use]
    pub fn unit(line: usize) -> &'static str {
        match line {
            NAME | SEX => "",
            number if MEASUREMENTS[number - FIRST_NUMBER].key.ends_with("_kg") => "kg",
            _ => "mm",
        }
    }

    /// What stands beside a line.
    #[must_use]
    pub fn note(&self, line: usize) -> Note {
        let text = self.texts[line].as_str();
        if text.trim().is_empty() && !self.is_tried {
            return Note::None;
        }
        let noted = match line {
            NAME if text.trim().is_empty() => Err("a subject needs a name".to_owned()),
            NAME => Ok(Note::None),
            SEX => sex(text).map(|_| Note::None),
            number => {
                let field = &MEASUREMENTS[number - FIRST_NUMBER];
                let stands = |value: f64| percentile(self.sex()?, field.key, value);
                field.read(text).map(|value| match value.and_then(stands) {
                    None => Note::None,
                    Some(percentile) if is_doubtful(percentile) => Note::Doubt(percentile_text(percentile)),
                    Some(percentile) => Note::Percentile(percentile_text(percentile)),
                })
            }
        };
        noted.unwrap_or_else(Note::Problem)
    }

    fn sex(&self) -> Option<Sex> {
        sex(&self.texts[SEX]).ok()
    }

    /// Handles a key.
    pub fn key(&mut self, event: &KeyEvent) -> Outcome {
        if self.is_busy {
            return Outcome::Open;
        }
        match event.code {
            KeyCode::Enter => return self.save(),
            KeyCode::Tab | KeyCode::Down => self.step(1),
            KeyCode::BackTab | KeyCode::Up => self.step(self.texts.len() - 1),
            KeyCode::Left | KeyCode::Right | KeyCode::Char(' ') if self.at == SEX => {
                let other = if self.sex() == Some(Sex::Female) { "male" } else { "female" };
                self.texts[SEX] = other.to_owned();
            }
            _ => {
                edit(&mut self.texts[self.at], event);
            }
        }
        Outcome::Open
    }

    /// Goes on by some lines, round about, past a line that cannot be typed in.
    fn step(&mut self, lines: usize) {
        self.at = (self.at + lines) % self.texts.len();
        if !self.is_open(self.at) {
            self.at = (self.at + lines) % self.texts.len();
        }
    }

    /// Saves what was typed, or goes to the first line that cannot be right.
    fn save(&mut self) -> Outcome {
        self.is_tried = true;
        if let Some(line) = (0..self.texts.len()).find(|line| matches!(self.note(*line), Note::Problem(_))) {
            self.at = line;
            return Outcome::Open;
        }
        (self.is_busy, self.problem) = (true, None);
        let mut given: Vec<Given> = vec![("sex".to_owned(), self.texts[SEX].clone())];
        let numbers = MEASUREMENTS.iter().zip(&self.texts[FIRST_NUMBER..]);
        given.extend(numbers.map(|(field, text)| (field.key.to_owned(), text.clone())));
        Outcome::Sent(vec![Effect::Do(Act::SaveSubject(self.mode, self.name().to_owned(), given))])
    }
}

/// What a path is asked for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// Subjects to import.
    ImportSubjects,
    /// The rows of a query to write.
    Export(String),
}

impl Purpose {
    /// Title of the prompt.
    #[must_use]
    pub fn title(&self) -> &'static str {
        match self {
            Self::ImportSubjects => "import subjects from",
            Self::Export(_) => "write all rows of the query into",
        }
    }

    /// What a path may be.
    #[must_use]
    pub fn hint(&self) -> &'static str {
        match self {
            Self::ImportSubjects => "CSV with columns name, sex, stature_mm, …, or a study.toml",
            Self::Export(_) => "a new file: NAME.csv or NAME.json",
        }
    }

    /// What goes on after Enter.
    #[must_use]
    pub fn busy(&self) -> &'static str {
        match self {
            Self::ImportSubjects => "reading, and building each body…",
            Self::Export(_) => "writing…",
        }
    }

    /// What the keys do.
    #[must_use]
    pub fn keys(&self) -> &'static str {
        match self {
            Self::ImportSubjects => " ↵ import all or none  Esc cancel ",
            Self::Export(_) => " ↵ write  Esc cancel ",
        }
    }
}

/// The path of a file to read or write.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PathPrompt {
    /// What it is for.
    pub purpose: Purpose,
    /// What is typed.
    pub text: String,
    /// Whether the file is being read or written.
    pub is_busy: bool,
    /// Why it could not be.
    pub problem: Option<String>,
}

impl PathPrompt {
    /// Asks for a file with subjects.
    #[must_use]
    pub fn subjects() -> Self {
        Self { purpose: Purpose::ImportSubjects, text: String::new(), is_busy: false, problem: None }
    }

    /// Asks for the file that the rows of a query go into.
    #[must_use]
    pub fn export(query: String) -> Self {
        Self { purpose: Purpose::Export(query), text: "query.csv".to_owned(), ..Self::subjects() }
    }

    /// Handles a key.
    pub fn key(&mut self, event: &KeyEvent) -> Outcome {
        if self.is_busy {
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
        (self.is_busy, self.problem) = (true, None);
        let path = path_of(path);
        Outcome::Sent(vec![match &self.purpose {
            Purpose::ImportSubjects => Effect::Do(Act::ImportSubjects(path)),
            Purpose::Export(query) => Effect::Ask(Question::Export(query.clone(), path)),
        }])
    }
}

/// The path that was typed; `~/` is home.
pub(super) fn path_of(text: &str) -> PathBuf {
    let home = text.strip_prefix("~/").zip(std::env::home_dir());
    home.map_or_else(|| PathBuf::from(text), |(rest, home)| home.join(rest))
}

//! Form for the values of a subject or a fabric, checked while they are typed.

use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span};

use crate::messages::effect::Effect;
use crate::messages::requests::Command;
use crate::overlays::form_frame::{Sending, draw_frame, ended, is_done};
use crate::overlays::outcome::Outcome;
use crate::widgets::lists::first_shown;
use crate::widgets::text::{self, left, right, shortened};
use crate::widgets::theme::Theme;
use crate::widgets::typing::{edit, moved};
use geom::units::significant;
use spec::bodies::Sex;
use spec::{FABRIC_NUMBERS, Given, MEASUREMENTS, sex};
use wardrobe::{FabricRow, Mode, Part, SubjectRow, is_doubtful, percentile, percentile_text};

/// Lines of a form before its numbers: the name, and the sex of a subject or the source of a fabric's numbers.
const NAME: usize = 0;
const WORD: usize = 1;
const FIRST_NUMBER: usize = 2;

/// Factor beyond the least or greatest number in the catalogue from which a number is doubtful.
const FAR: f64 = 3.0;
/// Columns for a value.
const VALUE: usize = 12;

#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Note {
    None,
    /// Percentile among adults of the sex, or range among the fabrics of the catalogue.
    Place(String),
    /// The value is possible but rare.
    Doubt(String),
    Problem(String),
}

#[derive(Clone, Debug, PartialEq)]
pub struct Form {
    pub part: Part,
    pub mode: Mode,
    /// Name of the entry whose values a new one starts with.
    pub like: Option<String>,
    /// Name, sex or source, then the numbers, as typed.
    pub texts: Vec<String>,
    /// Least and greatest of each number in the catalogue; empty for subjects, whose notes are percentiles.
    known: Vec<[f64; 2]>,
    /// Index of the line that is edited.
    pub at: usize,
    /// True once saving was tried: then empty lines show their problems too.
    is_tried: bool,
    pub sending: Sending,
}

impl Form {
    fn new(part: Part, mode: Mode, texts: Vec<String>) -> Self {
        let at = if mode == Mode::Add { NAME } else { FIRST_NUMBER };
        Self { part, mode, like: None, texts, known: vec![], at, is_tried: false, sending: Sending::default() }
    }

    pub fn new_subject() -> Self {
        let mut texts = vec![String::new(); FIRST_NUMBER + MEASUREMENTS.len()];
        texts[WORD] = "female".to_owned();
        Self::new(Part::Subject, Mode::Add, texts)
    }

    pub fn of_subject(subject: &SubjectRow) -> Self {
        let value = |value: Option<f64>| value.map_or(String::new(), |value| value.to_string());
        let mut texts = vec![subject.name.clone(), text::sex(subject).to_owned()];
        texts.extend(MEASUREMENTS.iter().map(|field| value(field.get(&subject.measurements))));
        Self::new(Part::Subject, Mode::Edit, texts)
    }

    /// The form for editing a fabric, or for a new one that starts with its numbers. `all` gives the usual ranges.
    pub fn of_fabric(row: &FabricRow, mode: Mode, all: &[FabricRow]) -> Self {
        let is_new = mode == Mode::Add;
        let fabric = &row.fabric;
        let head = if is_new {
            [String::new(), format!("like {}", fabric.name)]
        } else {
            [&fabric.name, &fabric.source].map(Clone::clone)
        };
        let mut texts = head.to_vec();
        texts.extend(FABRIC_NUMBERS.iter().map(|field| field.get(fabric).map_or(String::new(), text::exact)));
        let known = FABRIC_NUMBERS.iter().map(|field| {
            let values = all.iter().filter_map(|row| field.get(&row.fabric));
            values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| [low.min(v), high.max(v)])
        });
        let known = known.collect();
        Self { like: is_new.then(|| fabric.name.clone()), known, ..Self::new(Part::Fabric, mode, texts) }
    }

    pub fn name(&self) -> &str {
        self.texts[NAME].trim()
    }

    /// True if a line can be edited: all but the name of an existing entry.
    fn is_open(&self, line: usize) -> bool {
        line != NAME || self.mode == Mode::Add
    }

    pub fn is_number(line: usize) -> bool {
        line >= FIRST_NUMBER
    }

    /// Key and name of a number.
    fn number(&self, line: usize) -> (&'static str, &'static str) {
        let k = line - FIRST_NUMBER;
        match self.part {
            Part::Fabric => (FABRIC_NUMBERS[k].key, fabric_label(k)),
            _ => (MEASUREMENTS[k].key, MEASUREMENTS[k].label),
        }
    }

    pub fn label(&self, line: usize) -> &'static str {
        match line {
            NAME => "name",
            WORD if self.part == Part::Fabric => "source of the numbers",
            WORD => "sex",
            number => self.number(number).1,
        }
    }

    pub fn unit(&self, line: usize) -> &'static str {
        if Self::is_number(line) { unit_of(self.number(line).0) } else { "" }
    }

    pub fn note(&self, line: usize) -> Note {
        let text = self.texts[line].as_str();
        if text.trim().is_empty() && !self.is_tried {
            return Note::None;
        }
        let noted = match line {
            NAME if text.trim().is_empty() => Err(format!("a {} needs a name", self.part)),
            NAME => Ok(Note::None),
            WORD if self.part == Part::Fabric => Ok(Note::None),
            WORD => sex(text).map(|_| Note::None),
            number if self.part == Part::Fabric => self.fabric_note(number - FIRST_NUMBER, text),
            number => self.subject_note(number - FIRST_NUMBER, text),
        };
        noted.unwrap_or_else(Note::Problem)
    }

    fn subject_note(&self, k: usize, text: &str) -> Result<Note, String> {
        let field = &MEASUREMENTS[k];
        let stands = |value: f64| percentile(self.sex()?, field.key, value);
        Ok(match field.read(text)?.and_then(stands) {
            None => Note::None,
            Some(percentile) if is_doubtful(percentile) => {
                Note::Doubt(format!("{} ! doubtful", percentile_text(percentile)))
            }
            Some(percentile) => Note::Place(percentile_text(percentile)),
        })
    }

    /// Note on the range among the fabrics of the catalogue. A number far outside may be in another unit.
    fn fabric_note(&self, k: usize, text: &str) -> Result<Note, String> {
        let value = FABRIC_NUMBERS[k].read(text)?;
        let Some((value, [low, high])) =
            value.zip(self.known.get(k).copied()).filter(|(_, [low, high])| low <= high && *high > 0.0)
        else {
            return Ok(Note::None);
        };
        let words = format!("known {} to {}", significant(low, 2), significant(high, 2));
        let is_far = value > FAR * high || value < low / FAR;
        Ok(if is_far { Note::Doubt(format!("! {words}")) } else { Note::Place(words) })
    }

    fn sex(&self) -> Option<Sex> {
        sex(&self.texts[WORD]).ok()
    }

    pub fn key(&mut self, event: &KeyEvent) -> Outcome {
        if self.sending.is_busy {
            return Outcome::Open;
        }
        match event.code {
            _ if is_done(event, self.at + 1 == self.texts.len()) => return self.save(),
            KeyCode::Enter | KeyCode::Tab | KeyCode::Down => self.step(1),
            KeyCode::BackTab | KeyCode::Up => self.step(self.texts.len() - 1),
            KeyCode::PageUp | KeyCode::PageDown | KeyCode::Home | KeyCode::End => self.go(event),
            KeyCode::Char('d') if event.modifiers.contains(KeyModifiers::CONTROL) => self.go(event),
            KeyCode::Left | KeyCode::Right | KeyCode::Char(' ') if self.at == WORD && self.part == Part::Subject => {
                let other = if self.sex() == Some(Sex::Female) { "male" } else { "female" };
                self.texts[WORD] = other.to_owned();
            }
            _ => {
                edit(&mut self.texts[self.at], event);
            }
        }
        Outcome::Open
    }

    /// Moves as in any list, but not to a line that cannot be edited.
    fn go(&mut self, event: &KeyEvent) {
        let next = moved(self.at, self.texts.len(), event, false);
        self.at = next.map_or(self.at, |next| if self.is_open(next) { next } else { next + 1 });
    }

    /// Moves by some lines, from the last on to the first, and past a line that cannot be edited.
    fn step(&mut self, lines: usize) {
        self.at = (self.at + lines) % self.texts.len();
        if !self.is_open(self.at) {
            self.at = (self.at + lines) % self.texts.len();
        }
    }

    /// Saves the entry, or moves to the first line with a problem.
    fn save(&mut self) -> Outcome {
        self.is_tried = true;
        if let Some(line) = (0..self.texts.len()).find(|line| matches!(self.note(*line), Note::Problem(_))) {
            self.at = line;
            return Outcome::Open;
        }
        self.sending.start();
        let word = if self.part == Part::Fabric { "source" } else { "sex" };
        let mut given: Vec<Given> = vec![(word.to_owned(), self.texts[WORD].clone())];
        let numbers = (FIRST_NUMBER..self.texts.len()).map(|line| (self.number(line).0, &self.texts[line]));
        given.extend(numbers.map(|(key, text)| (key.to_owned(), text.clone())));
        Outcome::Sent(vec![Effect::Do(Command::Save(self.part, self.mode, self.name().to_owned(), given))])
    }
}

/// Name of a number of fabrics, without the unit, which the command line adds.
pub fn fabric_label(k: usize) -> &'static str {
    let label = FABRIC_NUMBERS[k].label;
    label.split_once(" [").map_or(label, |(name, _)| name)
}

/// Unit that ends a key.
pub fn unit_of(key: &str) -> &'static str {
    const UNITS: [(&str, &str); 6] =
        [("_kg_m2", "kg/m²"), ("_n_m", "N/m"), ("_nm", "N m"), ("_pct", "%"), ("_kg", "kg"), ("_mm", "mm")];
    UNITS.iter().find(|(end, _)| key.ends_with(end)).map_or("", |(_, unit)| *unit)
}

pub fn draw(frame: &mut Frame<'_>, area: Rect, form: &Form, theme: Theme) {
    let title = match form.mode {
        Mode::Edit => format!("edit {}: a new revision, results keep theirs", form.name()),
        _ => format!("new {}{}", form.part, form.like.as_ref().map_or(String::new(), |name| format!(", like {name}"))),
    };
    let width = area.width.min(if form.part == Part::Fabric { 100 } else { 76 });
    let columns = usize::from(width.saturating_sub(2));
    // A line has little room for its problem, so the problem of the edited line also stands below.
    let mut sending = form.sending.clone();
    if let Note::Problem(problem) = form.note(form.at) {
        sending.problem = Some(problem);
    }
    let work = if form.part == Part::Fabric { "saving…" } else { "building the body…" };
    let end = sending.lines(work, columns, theme);
    let room = usize::from(area.height.saturating_sub(2)).saturating_sub(end.len());
    let first = first_shown(form.at, form.texts.len(), room);
    let shown = (first..form.texts.len()).take(room);
    let mut lines: Vec<Line<'_>> = shown.map(|k| line(form, k, columns, theme)).collect();
    lines.extend(end);
    let keys = match form.part {
        Part::Fabric => " ↵ Tab ↑↓ line  C-u empties it  F5 save  Esc cancel ",
        _ => " ↵ Tab ↑↓ line  F5 save  Esc cancel  empty = not known ",
    };
    draw_frame(frame, area, width, title, keys, lines, theme);
}

pub fn line(form: &Form, k: usize, columns: usize, theme: Theme) -> Line<'static> {
    let is_focused = k == form.at && !form.sending.is_busy;
    let mark = if is_focused { "▸" } else { " " };
    let value = if is_focused { format!("{}▏", form.texts[k]) } else { form.texts[k].clone() };
    let (note, style) = match form.note(k) {
        Note::None => (String::new(), theme.dim()),
        Note::Place(words) => (words, theme.dim()),
        Note::Doubt(words) => (words, theme.warn()),
        Note::Problem(problem) => (format!("✗ {problem}"), theme.bad()),
    };
    let lines = 0..form.texts.len();
    let widest = |of: &dyn Fn(usize) -> &'static str| lines.clone().map(|k| text::width(of(k))).max().unwrap_or(0);
    let head = format!("{mark} {} ", left(form.label(k), widest(&|k| form.label(k))));
    let typed = match Form::is_number(k) {
        true => format!("{head}{} {} ", right(&value, VALUE), left(form.unit(k), widest(&|k| form.unit(k)))),
        // A long text takes the room of its note and shows its end, where typing goes on.
        false => format!("{head}{} ", ended(&value, columns.saturating_sub(text::width(&head) + 1), is_focused)),
    };
    let room = columns.saturating_sub(text::width(&typed));
    let style_of_text = if is_focused { theme.bold() } else { ratatui::style::Style::new() };
    Line::from(vec![Span::styled(typed, style_of_text), Span::styled(shortened(&note, room), style)])
}

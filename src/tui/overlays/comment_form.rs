//! Form for a comment of a fitting: a new one, or other values of a known one.

use crossterm::event::{KeyCode, KeyEvent};
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::style::Style;
use ratatui::text::{Line, Span};

use crate::messages::comments::{Change, CommentDeed, FittingOf};
use crate::messages::effect::Effect;
use crate::messages::requests::Command;
use crate::overlays::form_frame::{Sending, draw_frame, ended, is_done};
use crate::overlays::outcome::Outcome;
use crate::widgets::text::{left, width};
use crate::widgets::theme::Theme;
use crate::widgets::typing::edit;
use store::comments::{Comment, Edit, Remark, Severity, Side, State};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Field {
    /// Side from which the comment is seen, chosen.
    Side,
    Place,
    Severity,
    /// Finding in words.
    Said,
    Action,
    /// Name of who is to act.
    Owner,
    Status,
}

/// Lines of a new comment, and of a known one.
const NEW: [Field; 5] = [Field::Side, Field::Place, Field::Severity, Field::Said, Field::Action];
const KNOWN: [Field; 5] = [Field::Severity, Field::Said, Field::Action, Field::Owner, Field::Status];
/// Columns for the name of a line.
const LABEL: usize = 10;

impl Field {
    pub fn label(self) -> &'static str {
        match self {
            Self::Side => "side",
            Self::Place => "place",
            Self::Severity => "severity",
            Self::Said => "comment",
            Self::Action => "action",
            Self::Owner => "owner",
            Self::Status => "status",
        }
    }

    /// Meaning of a line that is empty.
    fn hint(self) -> &'static str {
        match self {
            Self::Place => "where on the garment, such as hip or back neck",
            Self::Said => "what is seen, in words",
            Self::Action => "what is to be done; empty = not known",
            Self::Owner => "who is to do it; empty = nobody yet",
            Self::Side | Self::Severity | Self::Status => "",
        }
    }

    /// Values to choose from; empty for a line that is typed.
    fn choices(self) -> Vec<&'static str> {
        match self {
            Self::Side => Side::ALL.iter().map(|side| side.as_str()).collect(),
            Self::Severity => Severity::ALL.iter().map(|severity| severity.as_str()).collect(),
            Self::Status => [State::Open, State::Closed].map(State::as_str).to_vec(),
            Self::Place | Self::Said | Self::Action | Self::Owner => vec![],
        }
    }
}

#[derive(Clone, Debug, PartialEq)]
pub struct CommentForm {
    pub of: FittingOf,
    /// Comment as it is; `None` for a new one.
    pub known: Option<Comment>,
    /// Lines with their texts.
    pub lines: Vec<(Field, String)>,
    /// Index of the line that is edited.
    pub at: usize,
    pub sending: Sending,
}

impl CommentForm {
    pub fn new(of: FittingOf) -> Self {
        let text = |field: Field| field.choices().first().map_or(String::new(), |first| (*first).to_owned());
        let lines = NEW.map(|field| (field, text(field))).to_vec();
        Self { of, known: None, lines, at: 0, sending: Sending::default() }
    }

    pub fn of(of: FittingOf, comment: &Comment) -> Self {
        let lines = KNOWN.map(|field| (field, value(comment, field))).to_vec();
        Self { of, known: Some(comment.clone()), lines, at: 0, sending: Sending::default() }
    }

    /// Text of a line, without spaces around; empty for a line that the form does not have.
    fn text(&self, field: Field) -> &str {
        self.lines.iter().find(|(other, _)| *other == field).map_or("", |(_, text)| text.trim())
    }

    pub fn key(&mut self, event: &KeyEvent) -> Outcome {
        if self.sending.is_busy {
            return Outcome::Open;
        }
        self.sending.problem = None;
        let lines = self.lines.len();
        let is_choice = !self.lines[self.at].0.choices().is_empty();
        match event.code {
            _ if is_done(event, self.at + 1 == lines) => return self.save(),
            KeyCode::Enter | KeyCode::Tab | KeyCode::Down => self.at = (self.at + 1) % lines,
            KeyCode::BackTab | KeyCode::Up => self.at = (self.at + lines - 1) % lines,
            KeyCode::Left | KeyCode::Char('h') if is_choice => self.choose(-1),
            KeyCode::Right | KeyCode::Char('l' | ' ') if is_choice => self.choose(1),
            _ if is_choice => {}
            _ => {
                edit(&mut self.lines[self.at].1, event);
            }
        }
        Outcome::Open
    }

    fn choose(&mut self, step: isize) {
        let (field, text) = &mut self.lines[self.at];
        let choices = field.choices();
        let at = choices.iter().position(|choice| choice == text);
        let next = at.map_or(0, |at| (at as isize + step).rem_euclid(choices.len() as isize) as usize);
        *text = choices[next].to_owned();
    }

    /// Sends the form, or moves to a line that is missing. A form without a change closes.
    fn save(&mut self) -> Outcome {
        let missing = [(Field::Place, "a comment needs a place"), (Field::Said, "a comment needs words")];
        for (field, problem) in missing {
            let line = self.lines.iter().position(|(other, text)| *other == field && text.trim().is_empty());
            if let Some(line) = line {
                (self.at, self.sending.problem) = (line, Some(problem.to_owned()));
                return Outcome::Open;
            }
        }
        let deed = match &self.known {
            None => CommentDeed::Add(self.remark()),
            Some(comment) => match self.edit(comment) {
                edit if edit == Edit::default() => return Outcome::Closed,
                edit => CommentDeed::Set(Box::new(Change::of(comment, edit))),
            },
        };
        self.sending.start();
        Outcome::Sent(vec![Effect::Do(Command::Comment(self.of.clone(), deed))])
    }

    fn remark(&self) -> Remark {
        Remark {
            side: Side::named(self.text(Field::Side)).unwrap_or(Side::Front),
            place: self.text(Field::Place).to_owned(),
            said: self.text(Field::Said).to_owned(),
            severity: Severity::named(self.text(Field::Severity)).unwrap_or(Severity::Minor),
            cause: String::new(),
            action: self.text(Field::Action).to_owned(),
            quantity: None,
        }
    }

    /// Values that differ from those of a comment.
    fn edit(&self, comment: &Comment) -> Edit {
        let changed = |field: Field| Some(self.text(field)).filter(|text| *text != value(comment, field));
        Edit {
            status: changed(Field::Status).and_then(State::named),
            severity: changed(Field::Severity).and_then(Severity::named),
            said: changed(Field::Said).map(str::to_owned),
            action: changed(Field::Action).map(str::to_owned),
            owner: changed(Field::Owner).map(str::to_owned),
            is_worded: None,
        }
    }
}

fn value(comment: &Comment, field: Field) -> String {
    let remark = &comment.remark;
    match field {
        Field::Side => remark.side.as_str(),
        Field::Place => &remark.place,
        Field::Severity => remark.severity.as_str(),
        Field::Said => &remark.said,
        Field::Action => &remark.action,
        Field::Owner => &comment.owner,
        Field::Status => comment.status.as_str(),
    }
    .to_owned()
}

pub fn draw(frame: &mut Frame<'_>, area: Rect, form: &CommentForm, theme: Theme) {
    let columns = usize::from(area.width.min(100).saturating_sub(2));
    let line = |(k, (field, text)): (usize, &(Field, String))| {
        let is_focused = k == form.at && !form.sending.is_busy;
        let head = format!("{} {}", if is_focused { "▸" } else { " " }, left(field.label(), LABEL));
        let room = columns.saturating_sub(width(&head) + 1);
        let shown = match (field.choices().is_empty(), is_focused) {
            (false, true) => format!("◂ {text} ▸"),
            (false, false) => text.clone(),
            (true, true) => ended(&format!("{text}▏"), room, true),
            (true, false) => ended(text, room, false),
        };
        let hint = if text.is_empty() { format!(" {}", field.hint()) } else { String::new() };
        let style = if is_focused { theme.bold() } else { Style::new() };
        Line::from(vec![Span::styled(head + &shown, style), Span::styled(hint, theme.dim())])
    };
    let mut lines: Vec<Line<'_>> = form.lines.iter().enumerate().map(line).collect();
    lines.extend(form.sending.lines("writing…", columns, theme));
    let FittingOf { garment, subject, .. } = &form.of;
    let title = match &form.known {
        Some(comment) => format!("comment {} of {garment} on {subject}", comment.number),
        None => format!("new comment of {garment} on {subject}"),
    };
    let keys = " ↵ Tab ↑↓ line  ←→ choose  C-u empties it  F5 save  Esc cancel ";
    draw_frame(frame, area, area.width.min(100), title, keys, lines, theme);
}

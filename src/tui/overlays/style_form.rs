//! Form for importing a style: its pattern, and values that the pattern's file does not have.

use crossterm::event::{KeyCode, KeyEvent};
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span};

use crate::messages::effect::Effect;
use crate::messages::requests::Command;
use crate::overlays::form_frame::{Sending, draw_frame, ended, is_done};
use crate::overlays::outcome::Outcome;
use crate::overlays::path_prompt::{Candidates, path_of};
use crate::widgets::text::{self, left, shortened};
use crate::widgets::theme::Theme;
use crate::widgets::typing::edit;
use spec::patterns::Unit;
use wardrobe::StyleGiven;

/// Lines of the form.
const PATTERN: usize = 0;
const STYLE: usize = 1;
const SIZE: usize = 2;
const UNIT: usize = 3;
const SEAMS: usize = 4;

/// Most letters of a message about many sizes: the first sizes say enough.
const LONGEST: usize = 400;
pub const LABELS: [&str; 5] = ["pattern", "style", "size", "unit", "seam file"];

#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct StyleForm {
    /// Texts in the order of [`LABELS`].
    pub texts: [String; 5],
    pub at: usize,
    /// Files among which a typed path leaves a choice, after Tab.
    pub offered: Candidates,
    pub sending: Sending,
}

impl StyleForm {
    /// Meaning of a line that is left empty.
    pub fn hint(&self, line: usize) -> String {
        match line {
            PATTERN => "a DXF file or a folder of them, GarmentCode JSON, or a study.toml".to_owned(),
            STYLE if !self.style().is_empty() => format!("empty = {}", self.style()),
            STYLE => "empty = as the pattern's file is called".to_owned(),
            SIZE => "empty = all sizes that the file names".to_owned(),
            UNIT => "mm, cm or in; empty = as the file says".to_owned(),
            _ => "empty = the pattern's own seams, or proposed ones".to_owned(),
        }
    }

    /// Name of the style: as typed, or that of the pattern file.
    pub fn style(&self) -> String {
        let typed = self.texts[STYLE].trim();
        if !typed.is_empty() {
            return typed.to_owned();
        }
        let path = path_of(self.texts[PATTERN].trim());
        path.file_stem().unwrap_or_default().to_string_lossy().trim().to_owned()
    }

    pub fn size(&self) -> String {
        self.texts[SIZE].trim().to_owned()
    }

    pub fn key(&mut self, event: &KeyEvent) -> Outcome {
        if self.sending.is_busy {
            return Outcome::Open;
        }
        let lines = self.texts.len();
        if event.code != KeyCode::Tab {
            self.offered = Candidates::default();
        }
        match event.code {
            _ if is_done(event, self.at + 1 == lines) => return self.save(),
            KeyCode::Tab if self.complete() => return Outcome::Open,
            KeyCode::Enter | KeyCode::Tab | KeyCode::Down => {
                self.offered = Candidates::default();
                self.at = (self.at + 1) % lines;
            }
            KeyCode::BackTab | KeyCode::Up => self.at = (self.at + lines - 1) % lines,
            _ => {
                edit(&mut self.texts[self.at], event);
            }
        }
        Outcome::Open
    }

    /// Completes the path of the line, or offers the files among which there is a choice. Returns false where neither
    /// helps.
    fn complete(&mut self) -> bool {
        let text = &mut self.texts[self.at];
        if ![PATTERN, SEAMS].contains(&self.at) || text.is_empty() {
            return false;
        }
        let before = text.len();
        let endings: &[&str] = if self.at == PATTERN { &["dxf", "json", "toml"] } else { &["toml"] };
        let known = std::mem::replace(&mut self.offered, Candidates::complete(text, endings));
        // A second Tab on the same choice goes on, as it does on a path that is whole.
        text.len() > before || !self.offered.is_empty() && self.offered != known
    }

    fn save(&mut self) -> Outcome {
        let [pattern, _, size, unit, seams] = self.texts.each_ref().map(|text| text.trim());
        if pattern.is_empty() {
            return Outcome::Closed;
        }
        let units = Unit::ALL.map(Unit::as_str);
        if !unit.is_empty() && !units.contains(&unit) {
            let problem = format!("unit `{unit}`; accepted: {}, or empty where the file names it", units.join(", "));
            (self.at, self.sending.problem) = (UNIT, Some(problem));
            return Outcome::Open;
        }
        let given = StyleGiven {
            seams: (!seams.is_empty()).then(|| path_of(seams)),
            is_proposed: true,
            unit: (!unit.is_empty()).then(|| unit.to_owned()),
            patterns: vec![((!size.is_empty()).then(|| size.to_owned()), path_of(pattern))],
        };
        self.sending.start();
        Outcome::Sent(vec![Effect::Do(Command::ImportStyle(self.style(), given))])
    }

    /// Shows why the files were refused, and moves to the line that can remedy it.
    pub fn refused(&mut self, problem: String) {
        if problem.contains("no unit") || problem.contains("say the unit") {
            self.at = UNIT;
        } else if problem.contains("; say SIZE=") {
            self.at = SIZE;
        }
        let is_nest = self.size().is_empty() && problem.matches("size ").count() > 1;
        let hint = "; a size above imports that one alone";
        self.sending.refuse(if is_nest { shortened(&problem, LONGEST) + hint } else { problem });
    }
}

pub fn draw(frame: &mut Frame<'_>, area: Rect, form: &StyleForm, theme: Theme) {
    let width = area.width.min(100);
    let columns = usize::from(width.saturating_sub(2));
    let line = |(k, text): (usize, &String)| {
        let is_focused = k == form.at && !form.sending.is_busy;
        let (mark, end) = if is_focused { ("▸", "▏") } else { (" ", "") };
        let head = format!("{mark} {}", left(LABELS[k], 11));
        let room = columns.saturating_sub(text::width(&head));
        // The end of a long path is shown, since it tells paths apart.
        let shown = ended(&format!("{text}{end}"), room, true);
        let style = if is_focused { theme.bold() } else { ratatui::style::Style::new() };
        let hint = if text.is_empty() { format!(" {}", form.hint(k)) } else { String::new() };
        let hint = shortened(&hint, room.saturating_sub(text::width(&shown)));
        Line::from(vec![Span::styled(head + &shown, style), Span::styled(hint, theme.dim())])
    };
    let mut lines: Vec<Line<'_>> = form.texts.iter().enumerate().map(line).collect();
    let room = usize::from(area.height.saturating_sub(2)).saturating_sub(lines.len());
    lines.extend(form.offered.lines(columns, room, theme));
    lines.extend(form.sending.lines("reading, and sewing each size…", columns, theme));
    let keys = " Tab completes  ↵ next line  F5 import all or none  Esc cancel  ~/ is home ";
    draw_frame(frame, area, width, "import a style or sizes".to_owned(), keys, lines, theme);
}

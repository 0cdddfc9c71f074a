//! The tour: six screens of the present results, with a few words on each.

use crossterm::event::{KeyCode, KeyEvent};
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::Line;
use ratatui::widgets::{Clear, Paragraph};

use crate::keys::screen::Screen;
use crate::overlays::outcome::Outcome;
use crate::widgets::lists::pane;
use crate::widgets::text::wrapped;
use crate::widgets::theme::Theme;

/// Steps: screen and words.
const STEPS: [(Screen, &str); 6] = [
    (
        Screen::Study,
        "A study dresses subjects in the sizes of a garment by one or both simulators. Each cell is a simulation: ✓ is at rest. \
         Enter opens a cell.",
    ),
    (
        Screen::Fit,
        "Which size each subject wears, from ease: the girth of the pattern less that of the body. ▼ is tight, ▲ is loose. \
         a finds what to change.",
    ),
    (
        Screen::Results,
        "One drape. L2D is a length in the pattern, L3D the same on the drape, chi is L3D over L2D: 1 where nothing is stretched. \
         v turns it, m colours it.",
    ),
    (
        Screen::Compare,
        "FEM (physics alone) and Hybrid (the pattern's size first) on the same size and subject, side by side, and a verdict below.",
    ),
    (
        Screen::Sql,
        "Every number is in the database. F5 runs the query, o offers saved ones, w writes the rows as CSV, JSON or Parquet.",
    ),
    (
        Screen::Reports,
        "b builds the report: one HTML page that says, with evidence, which simulator to trust for which fit. Enter opens it.",
    ),
];

/// A step of the tour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tour {
    step: usize,
}

impl Tour {
    /// Step by number, from 0; `None` after the last.
    pub fn at(step: usize) -> Option<Self> {
        (step < STEPS.len()).then_some(Self { step })
    }

    pub fn screen(self) -> Screen {
        STEPS[self.step].0
    }

    pub fn key(self, event: &KeyEvent) -> Outcome {
        match event.code {
            KeyCode::Enter | KeyCode::Char(' ' | 'n' | 'l') | KeyCode::Right => Outcome::Tour(self.step + 1),
            KeyCode::Backspace | KeyCode::Char('N' | 'h') | KeyCode::Left => Outcome::Tour(self.step.saturating_sub(1)),
            KeyCode::Char('q') => Outcome::Closed,
            _ => Outcome::Open,
        }
    }
}

pub fn draw(frame: &mut Frame<'_>, area: Rect, tour: Tour, theme: Theme) {
    let width = usize::from(area.width.saturating_sub(2)).max(1);
    let texts = wrapped(STEPS[tour.step].1, width);
    let height = (texts.len() as u16 + 2).min(area.height);
    let place = Rect { y: area.bottom().saturating_sub(height), height, ..area };
    let title = format!("tour, {} of {}", tour.step + 1, STEPS.len());
    let block = pane(theme, title, true).title_bottom(Line::styled(" ↵ next  ← back  Esc ends it ", theme.legend()));
    let lines: Vec<Line<'_>> = texts.into_iter().map(Line::raw).collect();
    frame.render_widget(Clear, place);
    frame.render_widget(Paragraph::new(lines).block(block), place);
}

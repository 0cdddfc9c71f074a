//! Answering what is to be decided about seams: one thing at a time, each answer a key.

use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};

use crate::keys::screen::Screen;
use crate::messages::effect::Effect;
use crate::screens::movement::stepped;
use crate::screens::state::State;
use crate::screens::styles::state::{Asking, EdgeAt, Own, TableLine};
use wardrobe::seams::{LEFT_OUT, SeamStep, Undecided};

/// Keys while something is asked, for the status line.
pub const HINTS: &[(&str, &str)] = &[
    ("y", "take ●"),
    ("1-9", "choose"),
    ("A", "all sure"),
    ("n", "next"),
    ("e", "edge"),
    ("o", "piece"),
    ("u", "undo"),
    ("w", "save"),
    ("Esc", "leave"),
];

impl State {
    /// What is asked now.
    #[must_use]
    pub fn asked(&self) -> Option<Undecided> {
        let asking = self.styles.asking?;
        let out = &self.layout()?.ok()?.out;
        let knows = |(piece, edge): EdgeAt| out.desk.pieces.get(piece).is_some_and(|drawn| edge < drawn.edges.len());
        match asking.own {
            Some(Own::Edge(edge)) if knows(edge) => Some(match self.layout()?.ok()?.seam_at(edge) {
                Some(seam) => Undecided::seam(&out.desk, seam),
                None => Undecided::free(&out.desk, edge),
            }),
            Some(Own::Piece(piece)) if knows((piece, 0)) => Some(Undecided::piece(&out.desk, piece)),
            Some(Own::LeftOut(first)) => Undecided::left_out(&out.desk, first),
            Some(_) => None,
            None => out.undecided.get(asking.at).or(out.undecided.last()).cloned(),
        }
    }

    /// Asks what is to be decided, beginning with what is selected; says so where there is nothing.
    pub fn begin_asking(&mut self) {
        if !self.may_sew() {
            return;
        }
        let Some(Ok(layout)) = self.layout() else { return };
        let undecided = &layout.out.undecided;
        let selected = match self.table_line() {
            Some(TableLine::Question(k)) => Some(k),
            Some(TableLine::Seam(seam)) => undecided.iter().position(|one| one.seam == Some(seam)),
            _ => None,
        };
        let edge = self.styles.edge;
        let is_free = layout.seam_at(edge).is_none() && layout.edges().contains(&edge);
        match (selected, undecided.is_empty()) {
            (Some(at), _) => self.ask_about(Asking { at, own: None, goes_on: true }),
            (None, false) => self.ask_about(Asking { at: 0, own: None, goes_on: true }),
            (None, true) if is_free => self.ask_about(Asking { at: 0, own: Some(Own::Edge(edge)), goes_on: false }),
            (None, true) => self.say("nothing is left to decide: e asks about an edge, o about its piece, w saves"),
        }
    }

    /// Asks a question of the user's own.
    pub fn ask_own(&mut self, own: Own) {
        if self.may_sew() {
            let at = self.styles.asking.map_or(0, |asking| asking.at);
            let goes_on = self.styles.asking.is_some_and(|asking| asking.goes_on);
            self.ask_about(Asking { at, own: Some(own), goes_on });
        }
    }

    /// What is asked about pieces next: about the selected one, then about those that are left out, some at a time.
    #[must_use]
    pub fn next_of_piece(&self) -> Own {
        let left_out = self.layout().and_then(Result::ok).map_or(0, |layout| layout.out.desk.left_out.len());
        let next = match self.styles.asking.and_then(|asking| asking.own) {
            Some(Own::Piece(_)) => Some(0),
            Some(Own::LeftOut(first)) => Some(first + LEFT_OUT),
            _ => None,
        };
        let piece = Own::Piece(self.styles.edge.0);
        next.filter(|first| *first < left_out).map_or(piece, Own::LeftOut)
    }

    fn ask_about(&mut self, asking: Asking) {
        self.styles.asking = Some(asking);
        let edge = self.asked().and_then(|asked| asked.edges.first().copied());
        if let (None, Some(edge)) = (asking.own, edge) {
            self.styles.edge = edge;
            let line = self.layout().and_then(Result::ok).and_then(|layout| layout.seam_at(edge));
            self.styles.line = line.unwrap_or(self.styles.line);
        }
    }

    /// Goes on once something was answered and the pieces are laid out anew.
    pub fn go_on_asking(&mut self) {
        let Some(asking) = self.styles.asking else { return };
        let left = self.layout().and_then(Result::ok).map_or(0, |layout| layout.out.undecided.len());
        if asking.goes_on && left > 0 {
            self.ask_about(Asking { at: asking.at.min(left - 1), own: None, goes_on: true });
        } else {
            self.styles.asking = None;
            if left == 0 && !self.unsaved().is_empty() {
                self.say("all is decided: w saves the seams, t tries the garment on");
            }
        }
    }

    /// Takes a key while something is asked; `None` where it means what it always does.
    pub fn answer(&mut self, event: &KeyEvent) -> Option<Vec<Effect>> {
        let asking = self.styles.asking?;
        let asked = self.asked()?;
        if event.modifiers.intersects(KeyModifiers::CONTROL | KeyModifiers::ALT) {
            return None;
        }
        let step =
            |place: Option<usize>| place.and_then(|place| asked.choices.get(place)).map(|choice| choice.step.clone());
        match event.code {
            KeyCode::Char('y') | KeyCode::Enter => Some(self.take(step(asked.stands.or(Some(0))))),
            KeyCode::Char(digit @ '1'..='9') => Some(self.take(step(Some(digit as usize - '1' as usize)))),
            KeyCode::Char('A') => Some(self.take(Some(SeamStep::ConfirmSure))),
            KeyCode::Char('n' | 'j') | KeyCode::Down => Some(self.step_asking(asking, 1)),
            KeyCode::Char('N' | 'k') | KeyCode::Up => Some(self.step_asking(asking, -1)),
            KeyCode::Esc | KeyCode::Char('q') => {
                self.styles.asking = None;
                Some(vec![])
            }
            _ => None,
        }
    }

    fn take(&mut self, step: Option<SeamStep>) -> Vec<Effect> {
        match step {
            Some(step) if self.may_sew() => self.step_of_work(step),
            Some(_) => vec![],
            None => {
                self.say("there is no such answer; the digits before the answers choose");
                vec![]
            }
        }
    }

    fn step_asking(&mut self, asking: Asking, step: isize) -> Vec<Effect> {
        let left = self.layout().and_then(Result::ok).map_or(0, |layout| layout.out.undecided.len());
        if let Some(at) = stepped(asking.at, step, left) {
            self.ask_about(Asking { at, own: None, goes_on: true });
        }
        vec![]
    }

    /// Whether the seams are asked about on the screen that is shown.
    #[must_use]
    pub fn is_asking(&self) -> bool {
        self.nav.screen == Screen::Styles && self.styles.asking.is_some()
    }
}

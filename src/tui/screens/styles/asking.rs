//! Questions about the seams of a size. The Styles screen asks one at a time, and a key answers it. Questions come from
//! a list ([`Undecided`]: open questions of the proposal and of checks), or the user asks about an edge or a piece
//! ([`Own`]).

use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};

use crate::keys::screen::Screen;
use crate::messages::effect::Effect;
use crate::messages::seams::SizeLayout;
use crate::screens::movement::stepped;
use crate::screens::state::State;
use crate::screens::styles::state::{Asking, EdgeAt, Own, StylesScreen, TableLine};
use wardrobe::seams::{LEFT_OUT, SeamStep, Undecided};

/// Keys for the status line while a question is asked.
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

impl StylesScreen {
    /// The present question; `None` where nothing is asked, or where its edge or piece is gone.
    pub fn asked(&self, state: &State) -> Option<Undecided> {
        let asking = self.asking?;
        let out = &self.laid_out(state)?.out;
        let knows = |(piece, edge): EdgeAt| out.desk.pieces.get(piece).is_some_and(|drawn| edge < drawn.edges.len());
        match asking.own {
            Some(Own::Edge(edge)) if knows(edge) => Some(match self.laid_out(state)?.seam_at(edge) {
                Some(seam) => Undecided::seam(&out.desk, seam),
                None => Undecided::free(&out.desk, edge),
            }),
            Some(Own::Piece(piece)) if knows((piece, 0)) => Some(Undecided::piece(&out.desk, piece)),
            Some(Own::LeftOut(first)) => Undecided::left_out(&out.desk, first),
            Some(_) => None,
            None => out.undecided.get(asking.at).or(out.undecided.last()).cloned(),
        }
    }

    /// Edges that the present question is about: its own; without any, those of the edges and pieces that its text names.
    pub fn pointed(&self, state: &State) -> Vec<EdgeAt> {
        let (Some(asked), Some(layout)) = (self.asked(state), self.laid_out(state)) else { return vec![] };
        if asked.edges.is_empty() { named(&asked.text, layout) } else { asked.edges }
    }

    /// Starts asking: with the question of the selected line or, without one, with the first of the list. Where the
    /// list is empty, asks about the selected edge if that is in no seam; else says that nothing is left.
    pub fn begin_asking(&mut self, state: &mut State) {
        if !self.may_sew(state) {
            return;
        }
        let Some(layout) = self.laid_out(state) else { return };
        let undecided = &layout.out.undecided;
        let selected = match self.table_line(state) {
            Some(TableLine::Question(k)) => Some(k),
            Some(TableLine::Seam(seam)) => undecided.iter().position(|question| question.seam == Some(seam)),
            _ => None,
        };
        let edge = self.edge;
        let is_free = layout.seam_at(edge).is_none() && layout.edges().contains(&edge);
        match (selected, undecided.is_empty()) {
            (Some(at), _) => self.ask_about(state, Asking { at, own: None, goes_on: true }),
            (None, false) => self.ask_about(state, Asking { at: 0, own: None, goes_on: true }),
            (None, true) if is_free => {
                self.ask_about(state, Asking { at: 0, own: Some(Own::Edge(edge)), goes_on: false })
            }
            (None, true) => {
                let open = layout.left_open();
                state.say(format!("no question is left. {open} e asks about an edge, o about its piece, w saves"));
            }
        }
    }

    /// Asks a question of the user's own, instead of the next of the list.
    pub fn ask_own(&mut self, state: &mut State, own: Own) {
        if self.may_sew(state) {
            let at = self.asking.map_or(0, |asking| asking.at);
            let goes_on = self.asking.is_some_and(|asking| asking.goes_on);
            self.ask_about(state, Asking { at, own: Some(own), goes_on });
        }
    }

    /// The user's next question about pieces, as the same key is pressed again: first the selected piece, then the
    /// pieces that are left out, [`LEFT_OUT`] at a time.
    pub fn next_of_piece(&self, state: &State) -> Own {
        let left_out = self.laid_out(state).map_or(0, |layout| layout.out.desk.left_out.len());
        let next = match self.asking.and_then(|asking| asking.own) {
            Some(Own::Piece(_)) => Some(0),
            Some(Own::LeftOut(first)) => Some(first + LEFT_OUT),
            _ => None,
        };
        let piece = Own::Piece(self.edge.0);
        next.filter(|first| *first < left_out).map_or(piece, Own::LeftOut)
    }

    fn ask_about(&mut self, state: &State, asking: Asking) {
        self.asking = Some(asking);
        let edge = self.pointed(state).first().copied();
        if let (None, Some(edge)) = (asking.own, edge) {
            self.edge = edge;
            let line = self.laid_out(state).and_then(|layout| layout.seam_at(edge));
            self.line = line.unwrap_or(self.line);
        }
    }

    /// Moves on after an answer, once the pieces are laid out again: to the next question of the list, or to the end.
    pub fn go_on_asking(&mut self, state: &mut State) {
        let Some(asking) = self.asking else { return };
        let left = self.laid_out(state).map_or(0, |layout| layout.out.undecided.len());
        if asking.goes_on && left > 0 {
            self.ask_about(state, Asking { at: asking.at.min(left - 1), own: None, goes_on: true });
        } else {
            self.asking = None;
            if left == 0 && !self.edits.is_empty() {
                let open = self.laid_out(state).map_or(String::new(), |layout| layout.left_open());
                state.say(format!("no question is left. {open} w saves the seams, t tries the garment on"));
            }
        }
    }

    /// Handles a key while a question is asked; `None` for a key that keeps its usual meaning.
    pub fn answer(&mut self, state: &mut State, event: &KeyEvent) -> Option<Vec<Effect>> {
        let asking = self.asking?;
        let asked = self.asked(state)?;
        if event.modifiers.intersects(KeyModifiers::CONTROL | KeyModifiers::ALT) {
            return None;
        }
        let step =
            |place: Option<usize>| place.and_then(|place| asked.choices.get(place)).map(|choice| choice.step.clone());
        match event.code {
            KeyCode::Char('y') | KeyCode::Enter => Some(self.take(state, step(asked.stands.or(Some(0))))),
            KeyCode::Char(digit @ '1'..='9') => Some(self.take(state, step(Some(digit as usize - '1' as usize)))),
            KeyCode::Char('A') => Some(self.take(state, Some(SeamStep::ConfirmSure))),
            KeyCode::Char('n' | 'j') | KeyCode::Down => Some(self.step_asking(state, asking, 1)),
            KeyCode::Char('N' | 'k') | KeyCode::Up => Some(self.step_asking(state, asking, -1)),
            KeyCode::Esc | KeyCode::Char('q') => {
                self.asking = None;
                Some(vec![])
            }
            _ => None,
        }
    }

    fn take(&mut self, state: &mut State, step: Option<SeamStep>) -> Vec<Effect> {
        match step {
            Some(step) if self.may_sew(state) => self.step_of_work(state, step),
            Some(_) => vec![],
            None => state.reply("there is no such answer; the digits before the answers choose"),
        }
    }

    fn step_asking(&mut self, state: &State, asking: Asking, step: isize) -> Vec<Effect> {
        let left = self.laid_out(state).map_or(0, |layout| layout.out.undecided.len());
        if let Some(at) = stepped(asking.at, step, left) {
            self.ask_about(state, Asking { at, own: None, goes_on: true });
        }
        vec![]
    }

    pub fn is_asking(&self, state: &State) -> bool {
        state.nav.screen == Screen::Styles && self.asking.is_some()
    }
}

/// Edges that a text names; without any, those of the pieces that it names.
pub fn named(text: &str, layout: &SizeLayout) -> Vec<EdgeAt> {
    let is_part = |letter: char| letter.is_alphanumeric() || "_.-".contains(letter);
    let words: Vec<&str> = text.split(|letter: char| !is_part(letter)).map(|word| word.trim_end_matches('.')).collect();
    let desk = &layout.out.desk;
    let edges = layout.edges();
    let by_edge: Vec<EdgeAt> =
        edges.iter().copied().filter(|edge| words.contains(&desk.edge_name(*edge).as_str())).collect();
    if !by_edge.is_empty() {
        return by_edge;
    }
    edges.into_iter().filter(|(piece, _)| words.contains(&desk.pieces[*piece].id.as_str())).collect()
}

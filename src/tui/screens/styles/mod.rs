//! Screen 3: the styles and sizes of the catalogue; for the selected size its seams, measurements and pieces.

mod actions;
pub mod asking;
mod draw;
mod labels;
mod numbers;
mod pieces;
mod preview;
mod question;
mod seams;
pub mod state;
mod view;

use crossterm::event::KeyEvent;

use crate::keys::action::Action;
use crate::messages::effect::Effect;
use crate::screens::catalogue::may_change;
use crate::screens::movement::Movement;
use crate::screens::page::{Copied, Page, open_editor};
use crate::screens::state::State;
use crate::screens::styles::state::{Own, StylesScreen};
use wardrobe::Part;

impl Page for StylesScreen {
    fn go(&mut self, state: &mut State, movement: Movement) {
        if state.in_second_pane() {
            self.go_in_seams(state, movement);
        } else {
            self.go_in_sizes(state, movement);
        }
    }

    fn sideways(&mut self, state: &mut State, step: isize) {
        if state.in_second_pane() {
            self.step_edge(state, step);
        }
    }

    fn go_to_match(&mut self, state: &mut State, step: isize) {
        self.go_in_sizes(state, Movement::Round(step));
    }

    fn sort(&mut self, state: &mut State) {
        state.say("styles are listed by name, sizes as they came");
    }

    fn copied(&self, state: &State) -> Option<Copied> {
        self.laid_out(state).map(|layout| Copied { name: "the table of seams", text: actions::seam_table(layout) })
    }

    fn go_to_item(&mut self, state: &mut State, item: usize) {
        self.go_to_edge(state, item);
    }

    fn act(&mut self, state: &mut State, action: Action) -> Option<Vec<Effect>> {
        match action {
            Action::Import(Part::Style | Part::Size) => actions::import_style(state),
            Action::Remove(Part::Style | Part::Size) => self.remove_size(state),
            Action::EnlargePieces => self.enlarge_pieces(state),
            Action::MarkEdge => self.mark_edge(state),
            Action::UndoEdit => self.undo_edit(state),
            Action::RedoEdit => self.redo_edit(state),
            Action::AskEdge => self.ask_own(state, Own::Edge(self.edge)),
            Action::AskPiece => self.ask_own(state, self.next_of_piece(state)),
            Action::NextView => self.turn_preview(state),
            Action::AddSeam => return Some(self.add_seam(state)),
            Action::RemoveSeam => return Some(self.remove_seam(state)),
            Action::FlipSeam => return Some(self.flip_seam(state)),
            Action::Decide => self.decide(state),
            Action::TryOn => return Some(self.try_on(state)),
            Action::ProposeSeams => return Some(self.propose_seams(state)),
            Action::SaveSeams => return Some(self.save_seams(state)),
            _ => return None,
        }
        Some(vec![])
    }

    fn shrink(&mut self, _state: &mut State) -> bool {
        std::mem::take(&mut self.enlarged)
    }

    fn wanted(&mut self, state: &State) -> Vec<Effect> {
        self.ask_for_layout(state).into_iter().chain(self.ask_for_preview(state)).collect()
    }

    fn take_key(&mut self, state: &mut State, event: &KeyEvent) -> Option<Vec<Effect>> {
        self.answer(state, event)
    }

    fn write(&mut self, state: &mut State) -> Vec<Effect> {
        if !may_change(state, Part::Style) {
            return vec![];
        }
        open_editor(state, self.seam_file(state))
    }

    fn hints(&self, state: &State) -> Option<&'static [(&'static str, &'static str)]> {
        self.is_asking(state).then_some(asking::HINTS)
    }
}

//! Screen 3: the styles and sizes of the catalogue, and of the selected one its seams, measurements and pieces.

mod actions;
mod asking;
mod draw;
mod pieces;
mod preview;
mod question;
mod seams;
pub mod state;

use crossterm::event::KeyEvent;
use ratatui::Frame;
use ratatui::layout::Rect;

use crate::keys::action::Action;
use crate::messages::effect::Effect;
use crate::overlays::explanation::Selected;
use crate::screens::movement::Movement;
use crate::screens::page::Page;
use crate::screens::state::State;
use crate::screens::styles::state::Own;
use crate::widgets::jump::Target;
use crate::widgets::picture::Pictured;
use wardrobe::Part;

/// The screen of styles.
pub struct StylesPage;

/// What is said of the order.
const ORDER: &str = "styles are listed by name, sizes as they came";

impl Page for StylesPage {
    fn draw(&self, frame: &mut Frame<'_>, area: Rect, state: &State) {
        draw::draw(frame, area, state);
    }

    fn go(&self, state: &mut State, movement: Movement) {
        if state.in_second_pane() {
            state.go_in_seams(movement);
        } else {
            state.go_in_sizes(movement);
        }
    }

    fn sideways(&self, state: &mut State, step: isize) {
        if state.in_second_pane() {
            state.step_edge(step);
        }
    }

    fn go_to_match(&self, state: &mut State, step: isize) {
        state.go_in_sizes(Movement::Round(step));
    }

    fn sort(&self, state: &mut State) {
        state.say(ORDER);
    }

    fn reverse(&self, state: &mut State) {
        state.say(ORDER);
    }

    fn copied(&self, state: &State) -> Option<(String, &'static str)> {
        actions::seam_table(state).map(|table| (table, "the table of seams"))
    }

    fn targets(&self, state: &State, area: Rect) -> Vec<Target> {
        draw::targets(state, area)
    }

    fn go_to_item(&self, state: &mut State, item: usize) {
        state.go_to_edge(item);
    }

    fn explained(&self, _state: &State) -> Selected {
        Selected::new(String::new(), &draw::HEADINGS, &[])
    }

    fn act(&self, state: &mut State, action: Action) -> Option<Vec<Effect>> {
        match action {
            Action::Import(Part::Style | Part::Size) => state.import_style(),
            Action::Remove(Part::Style | Part::Size) => state.remove_size(),
            Action::EnlargePieces => state.enlarge_pieces(),
            Action::MarkEdge => state.mark_edge(),
            Action::UndoEdit => state.undo_edit(),
            Action::RedoEdit => state.redo_edit(),
            Action::AskEdge => state.ask_own(Own::Edge(state.styles.edge)),
            Action::AskPiece => state.ask_own(state.next_of_piece()),
            Action::NextView => state.turn_preview(),
            Action::AddSeam => return Some(state.add_seam()),
            Action::RemoveSeam => return Some(state.remove_seam()),
            Action::FlipSeam => return Some(state.flip_seam()),
            Action::Decide => state.decide(),
            Action::TryOn => return Some(state.try_on()),
            Action::ProposeSeams => return Some(state.propose_seams()),
            Action::SaveSeams => return Some(state.save_seams()),
            _ => return None,
        }
        Some(vec![])
    }

    fn shrink(&self, state: &mut State) -> bool {
        std::mem::take(&mut state.styles.enlarged)
    }

    fn wanted(&self, state: &mut State) -> Vec<Effect> {
        state.ask_for_layout().into_iter().chain(state.ask_for_preview()).collect()
    }

    fn take_key(&self, state: &mut State, event: &KeyEvent) -> Option<Vec<Effect>> {
        state.answer(event)
    }

    fn pictures(&self, state: &State, area: Rect) -> Vec<(Pictured, Rect)> {
        draw::pieces_area(state, area).map_or(vec![], |area| state.previewed(area))
    }

    fn hints(&self, state: &State) -> Option<&'static [(&'static str, &'static str)]> {
        state.is_asking().then_some(asking::HINTS)
    }
}

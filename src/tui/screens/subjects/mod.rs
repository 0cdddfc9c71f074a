//! Screen 2: the subjects of the catalogue; for the selected one its measurements and body.

mod actions;
pub mod draw;
pub mod state;

use crate::keys::action::Action;
use crate::keys::screen::Screen;
use crate::messages::effect::Effect;
use crate::screens::catalogue;
use crate::screens::movement::Movement;
use crate::screens::page::{Copied, Page};
use crate::screens::state::State;
use crate::screens::subjects::state::{SHOWN, SubjectsScreen};
use spec::MEASUREMENTS;
use wardrobe::Part;

impl Page for SubjectsScreen {
    fn go(&mut self, state: &mut State, movement: Movement) {
        if state.in_second_pane() {
            state.scroll_table(movement, MEASUREMENTS.len().saturating_sub(draw::table_rows(state.body())));
        } else {
            self.go_in_list(state, movement);
        }
    }

    fn go_to_match(&mut self, state: &mut State, step: isize) {
        self.go_in_list(state, Movement::Round(step));
    }

    fn sort(&mut self, _state: &mut State) {
        self.order.by = self.order.by.next(SHOWN);
    }

    fn reverse(&mut self, _state: &mut State) {
        self.order.reverse();
    }

    fn left(&mut self) {
        self.marks.clear();
    }

    fn receive(&mut self, state: &State) {
        let all = state.data.as_ref().map_or(&[][..], |data| &data.subjects);
        self.marks.keep(|name| all.iter().any(|row| row.name == *name));
        self.chosen = self.selected(state).map(|row| row.name.clone());
    }

    fn copied(&self, state: &State) -> Option<Copied> {
        self.line(state).map(|text| Copied { name: "the subject", text })
    }

    fn act(&mut self, state: &mut State, action: Action) -> Option<Vec<Effect>> {
        if state.nav.screen == Screen::Subjects {
            let shown: Vec<String> = self.shown(state).iter().map(|row| row.name.clone()).collect();
            let marked = catalogue::mark(state, &mut self.marks, action, &shown, self.chosen.as_ref());
            if marked.is_some() {
                return marked;
            }
        }
        match action {
            Action::Add(Part::Subject) => actions::add(state),
            Action::Edit(Part::Subject) => self.edit(state),
            Action::Import(Part::Subject) => catalogue::import(state, Part::Subject),
            Action::Remove(Part::Subject) => self.remove(state),
            _ => return None,
        }
        Some(vec![])
    }
}

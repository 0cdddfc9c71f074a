//! Screen 9: the fabrics of the catalogue; for the selected one its numbers, their source, and curves of force against
//! stretch.

mod actions;
mod draw;
pub mod state;

use crate::keys::action::Action;
use crate::keys::screen::Screen;
use crate::messages::effect::Effect;
use crate::screens::catalogue;
use crate::screens::fabrics::state::FabricsScreen;
use crate::screens::movement::Movement;
use crate::screens::page::{Copied, Page};
use crate::screens::state::State;
use wardrobe::Part;

impl Page for FabricsScreen {
    fn go(&mut self, state: &mut State, movement: Movement) {
        if state.in_second_pane() {
            state.scroll_table(movement, draw::table_lines().saturating_sub(draw::table_rows(state.body())));
        } else {
            self.go_in_list(state, movement);
        }
    }

    fn go_to_match(&mut self, state: &mut State, step: isize) {
        self.go_in_list(state, Movement::Round(step));
    }

    fn sort(&mut self, _state: &mut State) {
        self.order.by = self.order.by.next();
    }

    fn reverse(&mut self, _state: &mut State) {
        self.order.reverse();
    }

    fn left(&mut self) {
        self.marks.clear();
    }

    fn receive(&mut self, state: &State) {
        let all = state.data.as_ref().map_or(&[][..], |data| &data.fabrics);
        self.marks.keep(|name| all.iter().any(|row| row.fabric.name == *name));
        self.chosen = self.selected(state).map(|row| row.fabric.name.clone());
    }

    fn copied(&self, state: &State) -> Option<Copied> {
        self.line(state).map(|text| Copied { name: "the fabric", text })
    }

    fn act(&mut self, state: &mut State, action: Action) -> Option<Vec<Effect>> {
        if state.nav.screen == Screen::Fabrics {
            let shown: Vec<String> = self.shown(state).iter().map(|row| row.fabric.name.clone()).collect();
            let marked = catalogue::mark(state, &mut self.marks, action, &shown, self.chosen.as_ref());
            if marked.is_some() {
                return marked;
            }
        }
        match action {
            Action::Add(Part::Fabric) => self.add(state),
            Action::Edit(Part::Fabric) => self.edit(state),
            Action::Import(Part::Fabric) => catalogue::import(state, Part::Fabric),
            Action::Remove(Part::Fabric) => self.remove(state),
            _ => return None,
        }
        Some(vec![])
    }
}

//! Actions that all screens share; each screen has its own besides.

use crate::app::App;
use crate::app::frame::keys_of;
use crate::keys::action::Action;
use crate::messages::effect::Effect;
use crate::overlays::action_list::List;
use crate::overlays::commands::CommandLog;
use crate::overlays::explanation::Explanation;
use crate::overlays::jump::Jump;
use crate::overlays::things::Thing;
use crate::overlays::tour::Tour;
use crate::overlays::{Answer, Overlay};
use crate::screens::movement::Movement;
use crate::screens::page::Copied;
use crate::screens::state::State;
use crate::widgets::jump::Goal;

/// Lines of a screen that no list has: title, borders, headers, status line.
const FRAME_LINES: u16 = 8;

impl App {
    pub fn act(&mut self, action: Action) -> Vec<Effect> {
        let Self { state, screens } = self;
        if let Some(effects) = screens.act(state, action) {
            return effects;
        }
        let page = screens.page_mut(state.nav.screen);
        if let Some(movement) = movement(state, action) {
            page.go(state, movement);
            return vec![];
        }
        match action {
            Action::Left => page.sideways(state, -1),
            Action::Right => page.sideways(state, 1),
            Action::NextPane | Action::PreviousPane => {
                let pane = &mut state.nav.second_pane[state.nav.screen as usize];
                *pane = !*pane;
            }
            Action::Show(screen) => state.show(screen),
            Action::Back => {
                self.back();
            }
            Action::Leave | Action::Quit => {
                let is_back = action == Action::Leave && self.back();
                return if is_back { vec![] } else { self.quit() };
            }
            Action::Filter => state.overlay = Some(Overlay::Filter(state.filter().to_owned())),
            Action::NextMatch => self.go_to_match(1),
            Action::PreviousMatch => self.go_to_match(-1),
            Action::Sort => page.sort(state),
            Action::Reverse => page.reverse(state),
            Action::Copy => return self.copy(),
            Action::Ascii => {
                state.theme.ascii = !state.theme.ascii;
                state.terminal.chosen_ascii = Some(state.theme.ascii);
            }
            Action::Mouse => return take_mouse(state),
            Action::Help => self.state.overlay = Some(Overlay::Help(self.actions())),
            Action::Explain => state.overlay = Some(Overlay::Explanation(Explanation::of(page.explained(state)))),
            Action::Jump => self.offer_jumps(),
            Action::Palette => {
                let things = Thing::all(state.data.as_deref());
                self.state.overlay = Some(Overlay::Palette(self.actions().and(things)));
            }
            Action::Write => return page.write(state),
            Action::Tour => self.tour(0),
            Action::Commands => state.overlay = Some(Overlay::Commands(CommandLog::of(&state.told.commands))),
            Action::Redraw => return vec![Effect::Clear],
            Action::Suspend => return vec![Effect::Suspend],
            _ => {}
        }
        vec![]
    }

    /// List of all actions, with the keys of the present screen.
    fn actions(&self) -> List {
        List::of(self.state.setup.bindings, keys_of(self))
    }

    /// Shows a step of the tour; one after the last ends it.
    pub fn tour(&mut self, step: usize) {
        let state = &mut self.state;
        if state.is_first_start() {
            return state.say("the tour needs results: Enter runs the quickstart");
        }
        let Some(tour) = Tour::at(step) else { return state.say("that was the tour; ? lists all keys") };
        state.show(tour.screen());
        state.overlay = Some(Overlay::Tour(tour));
    }

    fn offer_jumps(&mut self) {
        let Self { state, screens } = self;
        let targets = screens.page(state.nav.screen).targets(state, state.body());
        match targets.is_empty() || state.data.is_none() {
            true => state.say("nothing to go to is seen here"),
            false => state.overlay = Some(Overlay::Jump(Jump { targets, typed: String::new() })),
        }
    }

    pub fn jump(&mut self, goal: Goal) {
        let Self { state, screens } = self;
        let page = screens.page_mut(state.nav.screen);
        match goal {
            Goal::Pane(pane) => page.focus(state, pane),
            Goal::Row(pane, step) => {
                page.focus(state, pane);
                page.go(state, Movement::By(step));
            }
            Goal::Item(item) => page.go_to_item(state, item),
        }
    }

    pub fn look_at(&mut self, thing: Thing) {
        let Self { state, screens } = self;
        state.show(thing.screen());
        state.nav.filters[thing.screen() as usize].clear();
        state.nav.second_pane[thing.screen() as usize] = false;
        match thing {
            Thing::Study(name) => state.open_study(name),
            Thing::Subject(name) => screens.subjects.chosen = Some(name),
            Thing::Size(style, size) => screens.styles.selected = Some((style, size)),
            Thing::Fabric(name) => (screens.fabrics.chosen, screens.fabrics.is_picked) = (Some(name), true),
        }
    }

    fn go_to_match(&mut self, step: isize) {
        let Self { state, screens } = self;
        if state.filter().is_empty() {
            state.say("no filter is set; / sets one");
        } else {
            screens.page_mut(state.nav.screen).go_to_match(state, step);
        }
    }

    fn copy(&mut self) -> Vec<Effect> {
        let Self { state, screens } = self;
        let Some(Copied { name, text }) = screens.page(state.nav.screen).copied(state) else {
            return state.reply("nothing to copy here");
        };
        state.copy(name, text)
    }

    /// Undoes the first that there is of filter, enlargement and change of screen. Returns false where there is none.
    fn back(&mut self) -> bool {
        let Self { state, screens } = self;
        let filter = &mut state.nav.filters[state.nav.screen as usize];
        if !filter.is_empty() {
            filter.clear();
        } else if screens.page_mut(state.nav.screen).shrink(state) {
            // The pane was enlarged, and is small again.
        } else if let Some(screen) = state.nav.trail.pop() {
            state.nav.screen = screen;
        } else {
            return false;
        }
        true
    }

    fn quit(&mut self) -> Vec<Effect> {
        let Self { state, screens } = self;
        let unsaved = screens.styles.unsaved();
        if let Some(target) = state.running.target.clone() {
            let seams = if unsaved.is_empty() { String::new() } else { format!(" Seams of {unsaved} are not saved.") };
            let text = format!(
                "A run goes on here. It can stop, and its unfinished jobs go back to the queue; or another process goes \
                on with it, and begins anew only what is in work.{seams}"
            );
            let stop = Answer { key: 's', label: "stop it", effects: vec![Effect::StopRun, Effect::Quit] };
            let leave = Answer { key: 'l', label: "leave it running", effects: vec![Effect::LeaveRunning(target)] };
            state.offer(text, vec![leave, stop]);
        } else if unsaved.is_empty() {
            return vec![Effect::Quit];
        } else {
            state.ask(format!("Seams of {unsaved} are not saved. Leave all the same?"), vec![Effect::Quit]);
        }
        vec![]
    }
}

fn movement(state: &State, action: Action) -> Option<Movement> {
    let page = (state.terminal.size.height.saturating_sub(FRAME_LINES).max(2) / 2) as isize;
    Some(match action {
        Action::Up => Movement::By(-1),
        Action::Down => Movement::By(1),
        Action::PageUp => Movement::By(-page),
        Action::PageDown => Movement::By(page),
        Action::First => Movement::First,
        Action::Last => Movement::Last,
        _ => return None,
    })
}

fn take_mouse(state: &mut State) -> Vec<Effect> {
    let is_taken = !state.terminal.has_mouse;
    (state.terminal.has_mouse, state.terminal.chosen_mouse) = (is_taken, Some(is_taken));
    let taken = "the mouse is taken: click, wheel; with Shift the terminal selects text";
    state.say(if is_taken { taken } else { "the mouse is the terminal's: it selects text" });
    vec![Effect::Mouse(is_taken)]
}

//! What actions do that all screens share; the rest is the screens' own.

use crate::app::frame::keys_of;
use crate::keys::action::Action;
use crate::messages::effect::Effect;
use crate::overlays::Overlay;
use crate::overlays::action_list::List;
use crate::overlays::commands::CommandLog;
use crate::overlays::explanation::Explanation;
use crate::overlays::jump::Jump;
use crate::overlays::things::Thing;
use crate::overlays::tour::Tour;
use crate::screens;
use crate::screens::movement::Movement;
use crate::screens::state::State;
use crate::widgets::jump::Goal;

/// Lines that no list has: title, borders, headers, status line.
const FRAME_LINES: u16 = 8;

impl State {
    /// Does an action; returns what others have to do.
    pub fn act(&mut self, action: Action) -> Vec<Effect> {
        if let Some(effects) = screens::act(self, action) {
            return effects;
        }
        let page = screens::page(self.nav.screen);
        if let Some(movement) = self.movement(action) {
            page.go(self, movement);
            return vec![];
        }
        match action {
            Action::Left => page.sideways(self, -1),
            Action::Right => page.sideways(self, 1),
            Action::NextPane | Action::PreviousPane => {
                let pane = &mut self.nav.second_pane[self.nav.screen as usize];
                *pane = !*pane;
            }
            Action::Show(screen) => self.show(screen),
            Action::Back => {
                self.back();
            }
            Action::Leave if self.back() => {}
            Action::Leave | Action::Quit => return self.quit(),
            Action::Filter => self.overlay = Some(Overlay::Filter(self.filter().to_owned())),
            Action::NextMatch => self.go_to_match(1),
            Action::PreviousMatch => self.go_to_match(-1),
            Action::Sort => page.sort(self),
            Action::Reverse => page.reverse(self),
            Action::Copy => return self.copy(),
            Action::Ascii => {
                self.theme.ascii = !self.theme.ascii;
                self.terminal.chosen_ascii = Some(self.theme.ascii);
            }
            Action::Mouse => return self.take_mouse(),
            Action::Help => self.overlay = Some(Overlay::Help(List::of(self.setup.bindings, keys_of(self)))),
            Action::Explain => self.overlay = Some(Overlay::Explanation(Explanation::of(page.explained(self)))),
            Action::Jump => self.offer_jumps(),
            Action::Palette => {
                let things = Thing::all(self.data.as_deref());
                self.overlay = Some(Overlay::Palette(List::of(self.setup.bindings, keys_of(self)).and(things)));
            }
            Action::Write => return self.write(),
            Action::Tour => self.tour(0),
            Action::Commands => self.overlay = Some(Overlay::Commands(CommandLog::of(&self.told.commands))),
            Action::Redraw => return vec![Effect::Clear],
            _ => {}
        }
        vec![]
    }

    /// Shows a step of the tour; after the last it ends.
    pub fn tour(&mut self, step: usize) {
        if self.is_first_start() {
            return self.say("the tour needs results: Enter runs the quickstart");
        }
        let Some(tour) = Tour::at(step) else { return self.say("that was the tour; ? lists all keys") };
        self.show(tour.screen());
        self.overlay = Some(Overlay::Tour(tour));
    }

    /// Puts letters on what is to be seen.
    fn offer_jumps(&mut self) {
        let targets = screens::page(self.nav.screen).targets(self, self.body());
        match targets.is_empty() || self.data.is_none() {
            true => self.say("nothing to go to is seen here"),
            false => self.overlay = Some(Overlay::Jump(Jump { targets, typed: String::new() })),
        }
    }

    /// Goes to what is to be seen somewhere.
    pub fn jump(&mut self, goal: Goal) {
        let page = screens::page(self.nav.screen);
        match goal {
            Goal::Pane(pane) => page.focus(self, pane),
            Goal::Row(pane, step) => {
                page.focus(self, pane);
                page.go(self, Movement::By(step));
            }
            Goal::Item(item) => page.go_to_item(self, item),
        }
    }

    /// Goes to something by its name.
    pub fn look_at(&mut self, thing: Thing) {
        self.show(thing.screen());
        self.nav.filters[thing.screen() as usize].clear();
        self.nav.second_pane[thing.screen() as usize] = false;
        match thing {
            Thing::Study(name) => self.open_study(name),
            Thing::Subject(name) => self.subjects.chosen = Some(name),
            Thing::Size(style, size) => self.styles.selected = Some((style, size)),
            Thing::Fabric(name) => self.fabrics.chosen = Some(name),
        }
    }

    /// The movement of an action, if it is one.
    fn movement(&self, action: Action) -> Option<Movement> {
        let page = (self.terminal.size.height.saturating_sub(FRAME_LINES).max(2) / 2) as isize;
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

    fn go_to_match(&mut self, step: isize) {
        if self.filter().is_empty() {
            self.say("no filter is set; / sets one");
        } else {
            screens::page(self.nav.screen).go_to_match(self, step);
        }
    }

    fn copy(&mut self) -> Vec<Effect> {
        let Some((text, what)) = screens::page(self.nav.screen).copied(self) else {
            self.say("nothing to copy here");
            return vec![];
        };
        self.say(format!("copied {what}"));
        vec![Effect::Copy(text)]
    }

    fn take_mouse(&mut self) -> Vec<Effect> {
        let is_taken = !self.terminal.has_mouse;
        self.terminal.has_mouse = is_taken;
        self.say(if is_taken { "the mouse is taken: tabs, wheel" } else { "the mouse is the terminal's" });
        vec![Effect::Mouse(is_taken)]
    }

    /// Takes back the latest of filter, enlargement and screen; returns whether there was any.
    fn back(&mut self) -> bool {
        let filter = &mut self.nav.filters[self.nav.screen as usize];
        if !filter.is_empty() {
            filter.clear();
        } else if screens::page(self.nav.screen).shrink(self) {
            // The pane has less room again.
        } else if let Some(screen) = self.nav.trail.pop() {
            self.nav.screen = screen;
        } else {
            return false;
        }
        true
    }

    fn quit(&mut self) -> Vec<Effect> {
        let unsaved = self.unsaved();
        if self.running.target.is_none() && unsaved.is_empty() {
            return vec![Effect::Quit];
        }
        if self.running.target.is_none() {
            self.ask(format!("Seams of {unsaved} are not saved. Leave all the same?"), vec![Effect::Quit]);
            return vec![];
        }
        self.ask(
            "A run goes on here. Stop it and leave? Unfinished jobs go back to the queue.",
            vec![Effect::StopRun, Effect::Quit],
        );
        vec![]
    }
}

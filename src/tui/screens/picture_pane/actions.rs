//! Looking at a drape from elsewhere; asking for pictures.

use ratatui::layout::{Rect, Size};

use crate::keys::action::Action;
use crate::keys::screen::Screen;
use crate::messages::effect::Effect;
use crate::screens::movement::Movement;
use crate::screens::picture_pane::draw::cells;
use crate::screens::picture_pane::state::Pictures;
use crate::screens::state::State;
use crate::widgets::picture::{self, Drawn, FRONT, PictureRequest, Pictured};
use results::Map;
use store::Status;

impl Pictures {
    /// Does an action on pictures; returns whether it is one.
    pub fn act(&mut self, action: Action) -> bool {
        match action {
            Action::NextView => self.look = picture::next_view(self.look),
            Action::ZoomIn => self.look = picture::zoomed(self.look, 1),
            Action::ZoomOut => self.look = picture::zoomed(self.look, -1),
            Action::NextMap => self.map = picture::next_map(self.map),
            Action::Enlarge => self.enlarged = !self.enlarged,
            _ => return false,
        }
        true
    }

    /// Turns drapes round.
    pub fn turn(&mut self, step: isize) {
        self.look = picture::turned(self.look, step);
    }

    /// A request for a picture as things are seen now.
    fn request(&self, of: Pictured, Size { width: columns, height: rows }: Size) -> PictureRequest {
        match of {
            Pictured::Preview(_) => PictureRequest { of, look: self.look, map: Map::Plain, columns, rows },
            Pictured::Drape(_) => PictureRequest { of, look: self.look, map: self.map, columns, rows },
            // Bodies have one view and no maps.
            Pictured::Body(_) => PictureRequest { of, look: FRONT, map: Map::Plain, columns, rows },
        }
    }
}

impl State {
    /// Moves an enlarged picture that has the focus up or down; returns whether there is one.
    pub fn raise_picture(&mut self, movement: Movement) -> bool {
        let is_near = self.in_second_pane() && self.pictures.look.zoom_pct > FRONT.zoom_pct;
        if let (true, Movement::By(step)) = (is_near, movement) {
            self.pictures.look = picture::raised(self.pictures.look, -step.signum() as i32);
        }
        is_near
    }

    /// The drape of the selected job in a pane, where there are both.
    #[must_use]
    pub fn drape_in(&self, pane: Option<Rect>) -> Vec<(Pictured, Rect)> {
        let job = self.job().filter(|job| job.status.has_result()).map(|job| Pictured::Drape(job.id));
        job.zip(pane).into_iter().collect()
    }

    /// Asks for the pictures of panes, where they are not those asked for already.
    pub fn ask_for_pictures(&mut self, panes: Vec<(Pictured, Rect)>) -> Option<Effect> {
        let sized = panes.into_iter().map(|(of, pane)| (of, cells(pane)));
        let sized = sized.filter(|(_, size)| self.setup.abilities.pictures && size.width >= 4 && size.height >= 3);
        let mut wanted: Vec<PictureRequest> = sized.map(|(of, size)| self.pictures.request(of, size)).collect();
        if let (true, true, Some(row)) = (self.nav.screen == Screen::Subjects, wanted.is_empty(), self.subject()) {
            // A body is measured where there is no room for its picture, too.
            wanted = vec![self.pictures.request(Pictured::Body(row.id), Size::ZERO)];
        }
        if wanted == self.pictures.requests {
            return None;
        }
        self.pictures.requests.clone_from(&wanted);
        (!wanted.is_empty()).then_some(Effect::Draw(wanted))
    }

    /// Takes in a picture that is still wanted, in the place of the one before of the same.
    pub fn take_picture(&mut self, request: PictureRequest, drawn: Result<Drawn, String>) {
        if self.pictures.requests.contains(&request) {
            let requests = &self.pictures.requests;
            self.pictures.drawn.retain(|(old, _)| old.of != request.of && requests.iter().any(|one| one.of == old.of));
            self.pictures.drawn.push((request, drawn));
        }
    }

    /// Watches the selected job while it runs here and is looked at.
    pub fn ask_to_watch(&mut self) -> Option<Effect> {
        let is_shown =
            matches!(self.nav.screen, Screen::Study | Screen::Jobs | Screen::Results) && self.running.target.is_some();
        let running = self.job().filter(|job| is_shown && job.status == Status::Running).map(|job| job.id);
        if running == self.running.watched {
            return None;
        }
        (self.running.watched, self.running.live) = (running, None);
        Some(Effect::Watch(running))
    }
}

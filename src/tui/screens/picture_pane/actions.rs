//! Changing the view on drapes; requesting pictures.

use ratatui::layout::{Rect, Size};

use crate::keys::action::Action;
use crate::keys::screen::Screen;
use crate::messages::answered::Answered;
use crate::messages::effect::Effect;
use crate::screens::movement::Movement;
use crate::screens::picture_pane::draw::cells;
use crate::screens::picture_pane::state::Pictures;
use crate::screens::state::State;
use crate::widgets::picture::{self, Drawn, FRONT, PictureRequest, Pictured};
use results::Map;
use store::Status;

impl Pictures {
    /// Returns false for an action that is not about pictures.
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

    /// Turns drapes about the vertical.
    pub fn turn(&mut self, step: isize) {
        self.look = picture::turned(self.look, step);
    }

    /// Moves an enlarged picture up or down. Returns false where none is enlarged.
    pub fn raise(&mut self, movement: Movement) -> bool {
        let is_near = self.look.zoom_pct > FRONT.zoom_pct;
        if let (true, Movement::By(step)) = (is_near, movement) {
            self.look = picture::raised(self.look, -step.signum() as i32);
        }
        is_near
    }

    /// Request for a picture of this size, in cells, in the present view.
    pub fn request(&self, of: Pictured, Size { width: columns, height: rows }: Size) -> PictureRequest {
        match of {
            Pictured::Preview(_) => PictureRequest { of, look: self.look, map: Map::Plain, columns, rows },
            Pictured::Drape(_) => PictureRequest { of, look: self.look, map: self.map, columns, rows },
            // Bodies have one view and no maps.
            Pictured::Body(_) => PictureRequest { of, look: FRONT, map: Map::Plain, columns, rows },
        }
    }

    /// Requests pictures, if they differ from those requested before.
    pub fn ask_for(&mut self, wanted: Vec<PictureRequest>) -> Option<Effect> {
        if wanted == self.requests {
            return None;
        }
        self.requests.clone_from(&wanted);
        (!wanted.is_empty()).then_some(Effect::Draw(wanted))
    }

    /// Stores a picture that is still wanted, replacing the one before.
    pub fn take(&mut self, request: PictureRequest, outcome: Result<Drawn, String>) {
        if self.requests.contains(&request) {
            let requests = &self.requests;
            let is_wanted = |of: Pictured| of != request.of && requests.iter().any(|wanted| wanted.of == of);
            self.drawn.retain(|old| is_wanted(old.request.of));
            self.drawn.push(Answered { request, outcome });
        }
    }
}

pub fn drape_in(state: &State, pane: Option<Rect>) -> Vec<(Pictured, Rect)> {
    let job = state.job().filter(|job| job.status.has_result()).map(|job| Pictured::Drape(job.id));
    job.zip(pane).into_iter().collect()
}

/// Requests for pictures of the panes that have room for one; empty where pictures are off.
pub fn requests(state: &State, panes: Vec<(Pictured, Rect)>) -> Vec<PictureRequest> {
    let sized = panes.into_iter().map(|(of, pane)| (of, cells(pane)));
    let sized = sized.filter(|(_, size)| state.setup.abilities.pictures && size.width >= 4 && size.height >= 3);
    sized.map(|(of, size)| state.pictures.request(of, size)).collect()
}

/// Watches the selected job while it runs here and its picture is shown.
pub fn watch(state: &mut State) -> Option<Effect> {
    let is_shown =
        matches!(state.nav.screen, Screen::Study | Screen::Jobs | Screen::Results) && state.running.target.is_some();
    let running = state.job().filter(|job| is_shown && job.status == Status::Running).map(|job| job.id);
    if running == state.running.watched {
        return None;
    }
    (state.running.watched, state.running.live) = (running, None);
    Some(Effect::Watch(running))
}

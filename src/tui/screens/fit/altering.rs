//! Requesting the alteration of a size, draping it and writing it.

use crate::keys::screen::Screen;
use crate::messages::alterations::AlterRequest;
use crate::messages::effect::Effect;
use crate::overlays::Overlay;
use crate::overlays::path_prompt::{PathPrompt, Purpose};
use crate::screens::fit::actions::worn;
use crate::screens::fit::state::{Alter, Draping};
use crate::screens::movement::Movement;
use crate::screens::state::State;
use crate::widgets::text::duration;
use advice::Alteration;
use fit::Simulator;
use report::file_part;
use store::JobRow;
use store::files::word;

/// Message while no alteration is shown.
const CLOSED: &str = "a finds what to change first";

impl Alter {
    /// Shows the alteration. If it is shown already, requests it again; if it was draped, keeps it.
    pub fn open(&mut self, state: &mut State) -> Vec<Effect> {
        state.show(Screen::Fit);
        let was_open = std::mem::replace(&mut self.is_open, true);
        let is_draped = self.found().is_some_and(|found| found.drape.is_some());
        let is_kept = !was_open && (is_draped || self.draping == Draping::GoesOn);
        match self.asked.take() {
            Some(asked) if !is_kept && is_looked_at(state, &asked) => vec![self.ask(asked)],
            asked => {
                self.asked = asked;
                vec![]
            }
        }
    }

    /// Alteration, shown or not.
    pub fn found(&self) -> Option<&Alteration> {
        self.answer.as_ref()?.as_deref().ok()
    }

    /// Requests the alteration for the shown garment and subject, if it is to be shown and was not requested before.
    pub fn ask_if_wanted(&mut self, state: &State) -> Option<Effect> {
        let is_asked = self.asked.as_ref().is_some_and(|asked| is_looked_at(state, asked));
        if !self.is_open || is_asked {
            return None;
        }
        to_alter(state).map(|request| self.ask(request))
    }

    fn ask(&mut self, request: AlterRequest) -> Effect {
        *self = Self { is_open: true, asked: Some(request.clone()), ..Self::default() };
        Effect::Alter(request)
    }

    pub fn step_size(&mut self, state: &mut State, step: isize) -> Vec<Effect> {
        let asked = self.asked.clone().filter(|_| self.is_open);
        let Some((asked, grid)) = asked.zip(state.grid()) else {
            return state.reply(CLOSED);
        };
        let at = grid.sizes.iter().position(|size| *size == asked.size);
        match at.and_then(|at| grid.sizes.get(at.checked_add_signed(step)?)).cloned() {
            Some(size) => vec![self.ask(AlterRequest { size, ..asked })],
            None => {
                let way = if step > 0 { "larger" } else { "smaller" };
                state.reply(format!("this study has no {way} size than {}", asked.size))
            }
        }
    }

    pub fn drape(&mut self, state: &mut State) -> Vec<Effect> {
        let Self { is_open, asked, answer, draping, .. } = &*self;
        let why_not = match (asked, answer) {
            _ if !is_open => CLOSED,
            (None, _) | (_, None) => "it is still sought what to change",
            (_, Some(Err(_))) => "there is no change to drape",
            _ if *draping == Draping::GoesOn => "it is being draped",
            (_, Some(Ok(found))) if found.drape.is_some() => "it is draped already; a finds the change anew",
            (Some(asked), Some(Ok(_))) => {
                let request = AlterRequest { is_draped: true, ..asked.clone() };
                self.draping = Draping::GoesOn;
                state.say(format!("draping in the background: {}", self.how_long(state)));
                return vec![Effect::Alter(request)];
            }
        };
        state.reply(why_not)
    }

    pub fn how_long(&self, state: &State) -> String {
        self.drape_ms(state).map_or("that may take minutes".to_owned(), |ms| {
            format!("the study's drape took {}, this one about as long", duration(ms))
        })
    }

    /// Duration of the study's own drape of this size; without one, the longest of the garment.
    fn drape_ms(&self, state: &State) -> Option<i64> {
        let asked = self.asked.as_ref()?;
        let is_drape = |job: &&JobRow| job.simulator == Simulator::Fem && job.status.has_result();
        let of_garment = state.data.as_ref()?.jobs.iter().filter(|job| job.garment == asked.garment).filter(is_drape);
        let is_same = |job: &&JobRow| job.size == asked.size && job.subject == asked.subject;
        let same = of_garment.clone().find(is_same).and_then(|job| job.wall_ms);
        same.or(of_garment.filter_map(|job| job.wall_ms).max())
    }

    pub fn write(&self, state: &mut State) {
        match self.found().filter(|_| self.is_open) {
            Some(found) => {
                let prompt = PathPrompt::new(Purpose::Write(found.files.clone()), folder(found));
                state.overlay = Some(Overlay::Path(prompt));
            }
            None if self.is_open => state.say("there is no changed pattern to write"),
            None => state.say(CLOSED),
        }
    }

    /// Stores an alteration that is still wanted. Where only its drape failed, the alteration stays.
    pub fn take(&mut self, state: &mut State, request: &AlterRequest, found: Result<Box<Alteration>, String>) {
        let flat = AlterRequest { is_draped: false, ..request.clone() };
        if self.asked.as_ref() != Some(&flat) {
            return;
        }
        match (request.is_draped, found) {
            (false, found) => self.answer = Some(found),
            (true, Ok(found)) => {
                (self.answer, self.draping) = (Some(Ok(found)), Draping::No);
                state.say(format!("the changed {} {} for {} is draped", flat.garment, flat.size, flat.subject));
            }
            (true, Err(error)) => {
                self.draping = Draping::Failed(error);
                state.complain(format!("the changed {} {} is not draped", flat.garment, flat.size));
            }
        }
    }

    /// Scrolls the alteration, of which `hidden` lines do not fit.
    pub fn scroll(&mut self, movement: Movement, hidden: usize) {
        self.down = movement.from(self.down.min(hidden), hidden + 1);
    }

    /// Command that finds and writes the same alteration.
    pub fn command(&self, state: &State) -> Option<String> {
        let (asked, found) = (self.asked.as_ref()?, self.found()?);
        let database = state.setup.database.as_ref();
        let database = database.map_or(String::new(), |path| format!(" --db {}", word(&path.display().to_string())));
        let study = word(&asked.study.display().to_string());
        let [subject, size, garment] = [&asked.subject, &asked.size, &asked.garment].map(|name| word(name));
        let drape = if found.drape.is_some() { " --drape" } else { "" };
        let folder = word(&folder(found));
        Some(format!(
            "toile{database} alter {study} --subject {subject} --size {size} --garment {garment}{drape} -o {folder}"
        ))
    }
}

/// Request for the size to wear of the shown garment and subject; where there is none, for the selected size.
fn to_alter(state: &State) -> Option<AlterRequest> {
    let (worn, grid) = (worn(state)?, state.grid()?);
    let to_wear = worn.card.to_wear().map(|size| &size.size);
    let size = to_wear.or(grid.sizes.get(state.place.size))?.clone();
    Some(AlterRequest {
        study: state.study()?.path.clone(),
        garment: worn.card.garment.clone(),
        subject: worn.card.subject.clone(),
        size,
        is_draped: false,
    })
}

/// True if a request is for the shown garment and subject, in any size.
fn is_looked_at(state: &State, asked: &AlterRequest) -> bool {
    to_alter(state).is_none_or(|request| request.is_for_same(asked))
}

fn folder(found: &Alteration) -> String {
    format!("altered/{}", file_part(&format!("{}_{}_{}", found.garment, found.size, found.subject)))
}

//! Asking what to change of a size, draping and writing it.

use crate::keys::screen::Screen;
use crate::messages::alterations::AlterRequest;
use crate::messages::effect::Effect;
use crate::overlays::Overlay;
use crate::overlays::path_prompt::PathPrompt;
use crate::screens::fit::state::{Alter, Draping};
use crate::screens::movement::Movement;
use crate::screens::state::State;
use crate::widgets::text::{duration, quoted};
use advice::Alteration;
use fit::Simulator;
use report::file_part;
use store::JobRow;

/// What is said where nothing is shown that could be changed.
const CLOSED: &str = "a finds what to change first";

impl State {
    /// Shows what to change; where that is shown already, it is found anew. What was draped is kept.
    pub fn open_alteration(&mut self) -> Vec<Effect> {
        self.show(Screen::Fit);
        let alter = &mut self.fit.alter;
        let was_open = std::mem::replace(&mut alter.is_open, true);
        let is_draped = self.alteration().is_some_and(|found| found.drape.is_some());
        let is_kept = !was_open && (is_draped || self.fit.alter.draping == Draping::GoesOn);
        match self.fit.alter.asked.take() {
            Some(asked) if !is_kept && self.is_looked_at(&asked) => vec![self.alter(asked)],
            asked => {
                self.fit.alter.asked = asked;
                vec![]
            }
        }
    }

    /// What was found to change, where it is shown or kept.
    #[must_use]
    pub fn alteration(&self) -> Option<&Alteration> {
        self.fit.alter.answer.as_ref()?.as_deref().ok()
    }

    /// Asks what to change of what is looked at, where it is shown and that was not asked for yet.
    pub fn ask_for_alteration(&mut self) -> Option<Effect> {
        let is_asked = self.fit.alter.asked.as_ref().is_some_and(|asked| self.is_looked_at(asked));
        if !self.fit.alter.is_open || is_asked {
            return None;
        }
        self.to_alter().map(|request| self.alter(request))
    }

    /// The size to wear of what is looked at; the selected one of the grid where none is to wear.
    fn to_alter(&self) -> Option<AlterRequest> {
        let (worn, grid) = (self.worn()?, self.grid()?);
        let to_wear = worn.card.to_wear().map(|size| &size.size);
        let size = to_wear.or(grid.sizes.get(self.study.place.size))?.clone();
        let study = self.data.as_ref()?.study()?.path.clone();
        Some(AlterRequest {
            study,
            garment: worn.card.garment.clone(),
            subject: worn.card.subject.clone(),
            size,
            is_draped: false,
        })
    }

    /// Whether a request is for what is looked at, in any of its sizes.
    fn is_looked_at(&self, asked: &AlterRequest) -> bool {
        self.to_alter().is_none_or(|request| request.is_for_same(asked))
    }

    /// Forgets what was found and asks for something else.
    fn alter(&mut self, request: AlterRequest) -> Effect {
        self.fit.alter = Alter { is_open: true, asked: Some(request.clone()), ..Alter::default() };
        Effect::Alter(request)
    }

    /// Asks what to change of the next larger size, or of the next smaller one.
    pub fn step_altered_size(&mut self, step: isize) -> Vec<Effect> {
        let asked = self.fit.alter.asked.clone().filter(|_| self.fit.alter.is_open);
        let Some((asked, grid)) = asked.zip(self.grid()) else {
            self.say(CLOSED);
            return vec![];
        };
        let at = grid.sizes.iter().position(|size| *size == asked.size);
        match at.and_then(|at| grid.sizes.get(at.checked_add_signed(step)?)).cloned() {
            Some(size) => vec![self.alter(AlterRequest { size, ..asked })],
            None => {
                let way = if step > 0 { "larger" } else { "smaller" };
                self.say(format!("there is no {way} size than {}", asked.size));
                vec![]
            }
        }
    }

    /// Has the changed pattern draped.
    pub fn drape_alteration(&mut self) -> Vec<Effect> {
        let Alter { is_open, asked, answer, draping, .. } = &self.fit.alter;
        let why_not = match (asked, answer) {
            _ if !is_open => CLOSED,
            (None, _) | (_, None) => "it is still sought what to change",
            (_, Some(Err(_))) => "there is no change to drape",
            _ if *draping == Draping::GoesOn => "it is being draped",
            (_, Some(Ok(found))) if found.drape.is_some() => "it is draped already; a finds the change anew",
            (Some(asked), Some(Ok(_))) => {
                let request = AlterRequest { is_draped: true, ..asked.clone() };
                self.fit.alter.draping = Draping::GoesOn;
                self.say(format!("draping in the background: {}", self.how_long()));
                return vec![Effect::Alter(request)];
            }
        };
        self.say(why_not);
        vec![]
    }

    /// About how long a drape of what is asked for takes, in words.
    #[must_use]
    pub fn how_long(&self) -> String {
        self.drape_ms().map_or("that may take minutes".to_owned(), |ms| {
            format!("the study's drape took {}, this one about as long", duration(ms))
        })
    }

    /// How long the study's own drape of what is asked for took, ms, else the longest of the garment.
    fn drape_ms(&self) -> Option<i64> {
        let asked = self.fit.alter.asked.as_ref()?;
        let is_drape = |job: &&JobRow| job.simulator == Simulator::Fem && job.status.has_result();
        let of_garment = self.data.as_ref()?.jobs.iter().filter(|job| job.garment == asked.garment).filter(is_drape);
        let is_same = |job: &&JobRow| job.size == asked.size && job.subject == asked.subject;
        let same = of_garment.clone().find(is_same).and_then(|job| job.wall_ms);
        same.or(of_garment.filter_map(|job| job.wall_ms).max())
    }

    /// Asks for the folder that the changed pattern goes into.
    pub fn write_alteration(&mut self) {
        match self.alteration().filter(|_| self.fit.alter.is_open) {
            Some(found) => {
                let prompt = PathPrompt::write(folder(found), found.files.clone());
                self.overlay = Some(Overlay::Path(prompt));
            }
            None if self.fit.alter.is_open => self.say("there is no changed pattern to write"),
            None => self.say(CLOSED),
        }
    }

    /// Takes in what was found, where it is still wanted. A drape that failed leaves the change as it was.
    pub fn take_alteration(&mut self, request: &AlterRequest, found: Result<Box<Alteration>, String>) {
        let flat = AlterRequest { is_draped: false, ..request.clone() };
        let alter = &mut self.fit.alter;
        if alter.asked.as_ref() != Some(&flat) {
            return;
        }
        match (request.is_draped, found) {
            (false, found) => alter.answer = Some(found),
            (true, Ok(found)) => {
                (alter.answer, alter.draping) = (Some(Ok(found)), Draping::No);
                self.say(format!("the changed {} {} for {} is draped", flat.garment, flat.size, flat.subject));
            }
            (true, Err(error)) => {
                alter.draping = Draping::Failed(error);
                self.complain(format!("the changed {} {} is not draped", flat.garment, flat.size));
            }
        }
    }

    /// Scrolls what is shown of a change, of which so many lines are hidden.
    pub fn scroll_alteration(&mut self, movement: Movement, hidden: usize) {
        let down = &mut self.fit.alter.down;
        *down = movement.from((*down).min(hidden), hidden + 1);
    }
}

/// The folder that a changed pattern is meant to go into.
fn folder(found: &Alteration) -> String {
    format!("altered/{}", file_part(&format!("{}_{}_{}", found.garment, found.size, found.subject)))
}

/// The command that finds the same and writes it.
#[must_use]
pub fn command(state: &State) -> Option<String> {
    let (asked, found) = (state.fit.alter.asked.as_ref()?, state.alteration()?);
    let database = state.setup.database.as_ref();
    let database = database.map_or(String::new(), |path| format!(" --db {}", quoted(&path.display().to_string())));
    let study = quoted(&asked.study.display().to_string());
    let [subject, size, garment] = [&asked.subject, &asked.size, &asked.garment].map(|name| quoted(name));
    let drape = if found.drape.is_some() { " --drape" } else { "" };
    let folder = quoted(&folder(found));
    Some(format!(
        "toile{database} alter {study} --subject {subject} --size {size} --garment {garment}{drape} -o {folder}"
    ))
}

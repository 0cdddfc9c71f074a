//! Moving about in the grid; other garments, other studies, new ones.

use std::path::PathBuf;

use crate::keys::screen::Screen;
use crate::messages::effect::Effect;
use crate::messages::requests::Target;
use crate::overlays::Overlay;
use crate::overlays::explanation::Selected;
use crate::overlays::study_form::{Filter, StudyForm};
use crate::screens::movement::{Movement, stepped};
use crate::screens::results::measurements;
use crate::screens::state::State;
use crate::screens::study::state::Place;
use crate::widgets::text;
use engine::wearables;
use sim::fabric::USUAL as USUAL_FABRIC;
use store::{Cell, FitCell, Grid, JobId};

impl State {
    /// The grid looked at; `None` where it has no size or no subject.
    #[must_use]
    pub fn grid(&self) -> Option<&Grid> {
        self.data.as_ref()?.grid.as_ref().filter(|grid| !grid.sizes.is_empty() && !grid.subjects.is_empty())
    }

    /// The cell at a place of the grid.
    #[must_use]
    pub fn cell_at(&self, place: Place) -> Option<&Cell> {
        self.grid()?.cells.get(place.size)?.get(place.subject)?.get(place.simulator)
    }

    /// The place of a job in the grid, where it is of its garment.
    #[must_use]
    pub fn place_of(&self, id: JobId) -> Option<Place> {
        let grid = self.grid()?;
        let job = self.data.as_ref()?.job(id).filter(|job| job.garment == grid.garment)?;
        Some(Place {
            size: grid.sizes.iter().position(|size| *size == job.size)?,
            simulator: grid.simulators.iter().position(|simulator| *simulator == job.simulator)?,
            subject: grid.subjects.iter().position(|subject| *subject == job.subject)?,
        })
    }

    /// The fit at a place of the grid.
    #[must_use]
    pub fn fit_at(&self, place: Place) -> Option<FitCell> {
        *self.grid()?.fits.get(place.size)?.get(place.subject)?
    }

    /// Whether a place of the grid contains the filter of the Study screen.
    #[must_use]
    pub fn is_match(&self, place: Place) -> bool {
        let filter = self.nav.filters[Screen::Study as usize].to_lowercase();
        let Some(grid) = self.grid() else { return false };
        let status = self.cell_at(place).and_then(|cell| cell.status).map_or("", text::status);
        let fit = self.fit_at(place).map_or("", |fit| fit.class.as_str());
        let sim = grid.simulators.get(place.simulator).map_or("", |sim| text::sim(*sim));
        let (size, subject) = (&grid.sizes[place.size], &grid.subjects[place.subject]);
        format!("{size} {subject} {sim} {status} {fit}").to_lowercase().contains(&filter)
    }

    /// All places of the grid, row by row.
    #[must_use]
    pub fn places(&self) -> Vec<Place> {
        let Some(grid) = self.grid() else { return vec![] };
        let (sizes, simulators, subjects) = (grid.sizes.len(), grid.simulators.len(), grid.subjects.len());
        let rows = (0..sizes).flat_map(|size| (0..simulators).map(move |simulator| (size, simulator)));
        rows.flat_map(|(size, simulator)| (0..subjects).map(move |subject| Place { size, simulator, subject }))
            .collect()
    }

    /// Keeps the place inside the grid.
    pub fn clamp_place(&mut self) {
        let Some(grid) = self.grid() else { return };
        let clamp = |index: usize, len: usize| index.min(len.saturating_sub(1));
        self.study.place = Place {
            size: clamp(self.study.place.size, grid.sizes.len()),
            simulator: clamp(self.study.place.simulator, grid.simulators.len()),
            subject: clamp(self.study.place.subject, grid.subjects.len()),
        };
    }

    /// Moves up or down in the grid.
    pub fn go_in_grid(&mut self, movement: Movement) {
        let Some(grid) = self.grid() else { return };
        let simulators = grid.simulators.len().max(1);
        let rows = grid.sizes.len() * simulators;
        let row = movement.from(self.study.place.size * simulators + self.study.place.simulator, rows);
        self.go_to(Place { size: row / simulators, simulator: row % simulators, ..self.study.place });
    }

    /// Selects a cell of the grid and its job, if it has one.
    fn go_to(&mut self, place: Place) {
        self.study.place = place;
        self.focus.job = self.cell_at(place).and_then(|cell| cell.job);
    }

    /// Goes to a cell by its place among all, row by row.
    pub fn go_to_cell(&mut self, cell: usize) {
        if let Some(place) = self.places().get(cell) {
            self.nav.second_pane[Screen::Study as usize] = false;
            self.go_to(*place);
        }
    }

    /// Goes to the next cell that matches the filter, or back.
    pub fn go_to_matching_cell(&mut self, step: isize) {
        let places = self.places();
        let at = places.iter().position(|place| *place == self.study.place).unwrap_or(0);
        let found = (1..=places.len())
            .filter_map(|k| stepped(at, step * k as isize, places.len()))
            .map(|next| places[next])
            .find(|place| self.is_match(*place));
        match found {
            Some(place) => self.go_to(place),
            None => self.say("no cell matches the filter"),
        }
    }

    /// Goes so many subjects to the right, or to the left.
    pub fn go_to_subject(&mut self, step: isize) {
        let Some(grid) = self.grid() else { return };
        let last = grid.subjects.len().saturating_sub(1);
        let subject = self.study.place.subject.saturating_add_signed(step).min(last);
        self.go_to(Place { subject, ..self.study.place });
    }

    /// Opens the result of the selected job; the quickstart where there is no study.
    pub fn open(&mut self) -> Vec<Effect> {
        if self.is_first_start() {
            return self.run(Target::Quickstart);
        }
        if self.focus.job.is_none() {
            self.say("nothing to open here: this cell has no job yet; R runs the study");
        } else {
            self.show(Screen::Results);
        }
        vec![]
    }

    /// Shows the next garment of the study, or the one before.
    pub fn step_garment(&mut self, step: isize) {
        let Some(garments) = self.data.as_ref().and_then(|data| data.study()).map(|study| &study.garments) else {
            return;
        };
        let at = garments.iter().position(|name| Some(name) == self.focus.garment.as_ref()).unwrap_or(0);
        let Some(next) = stepped(at, step, garments.len()) else { return };
        if next != at {
            self.focus.garment = Some(garments[next].clone());
            self.focus.job = None;
        }
    }

    /// Shows the next study.
    pub fn next_study(&mut self) {
        let Some(data) = &self.data else { return };
        let Some(next) = stepped(data.study, 1, data.studies.len()) else { return };
        if next == data.study {
            self.say("there is one study only");
            return;
        }
        let name = data.studies[next].name.clone();
        self.open_study(name);
    }

    /// Looks at a study.
    pub fn open_study(&mut self, name: String) {
        self.focus.study = Some(name);
        (self.focus.garment, self.focus.job, self.study.place) = (None, None, Place::default());
    }

    /// Asks what a new study is made of.
    pub fn new_study(&mut self) {
        let Some(data) = &self.data else { return };
        if !self.setup.abilities.run {
            self.complain("this workbench is read-only: start it without --readonly to make a study");
            return;
        }
        let names: Vec<&str> = data.studies.iter().map(|study| study.name.as_str()).collect();
        let name = (1..).map(|k| format!("study-{k}")).find(|name| !names.contains(&name.as_str())).unwrap_or_default();
        let fabrics: Vec<String> = data.fabrics.iter().map(|row| row.fabric.name.clone()).collect();
        let form = StudyForm {
            name,
            folder: self.setup.folders.studies.clone(),
            fabric: fabrics.iter().position(|name| name == USUAL_FABRIC).unwrap_or(0),
            fabrics,
            simulators: spec::SIMULATORS.map(|simulator| (simulator, true)).to_vec(),
            sizes: wearables(&data.sizes).into_iter().map(|wearable| (wearable, false)).collect(),
            subjects: data.subjects.iter().map(|row| (row.name.clone(), false)).collect(),
            filter: Filter::default(),
            at: 0,
            is_busy: false,
            problem: None,
        };
        self.overlay = Some(Overlay::StudyForm(Box::new(form)));
    }

    /// Opens a study that was made, or says in the form why it was not.
    pub fn study_created(&mut self, name: &str, outcome: Result<PathBuf, String>) {
        let awaited = self.told.awaited.take();
        self.told.commands.extend(awaited.filter(|_| outcome.is_ok()));
        match (outcome, &mut self.overlay) {
            (Ok(path), overlay) => {
                if matches!(overlay, Some(Overlay::StudyForm(_))) {
                    *overlay = None;
                }
                self.show(Screen::Study);
                (self.focus.study, self.focus.garment, self.focus.job) = (Some(name.to_owned()), None, None);
                self.say(format!("{} is written and its jobs are queued: R runs them", path.display()));
            }
            (Err(text), Some(Overlay::StudyForm(form))) => (form.is_busy, form.problem) = (false, Some(text)),
            (Err(text), _) => self.complain(text),
        }
    }
}

/// The selected cell, and what the grid and the numbers below it show.
pub fn explained(state: &State) -> Selected {
    let shown = measurements::explained(state);
    let place = state.study.place;
    let Some(grid) = state.grid() else { return shown };
    let cell = state.cell_at(place);
    let status = cell
        .and_then(|cell| cell.status)
        .map_or(", no job yet".to_owned(), |status| format!(", {}", text::status(status)));
    let ei = cell.and_then(|cell| cell.ei).map_or(String::new(), |ei| format!(", EI {ei:.4}"));
    let ease = |fit: FitCell| format!(", ease {} mm, {}", text::ease_mm(fit.ease_m), fit.class.as_str());
    let ease = state.fit_at(place).map_or(String::new(), ease);
    let (size, subject) = (&grid.sizes[place.size], &grid.subjects[place.subject]);
    let what = format!("{size} on {subject} by {}{status}{ei}{ease}", text::sim(grid.simulators[place.simulator]));
    let others: Vec<&str> = shown.names.iter().map(String::as_str).collect();
    Selected::new(what, &["EI", "ease mm", "fit class", "status", "FEM", "HYB"], &others)
}

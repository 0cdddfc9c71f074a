//! Moving in the grid; changing garment or study; making a study.

use std::collections::BTreeSet;
use std::path::PathBuf;

use crate::keys::screen::Screen;
use crate::messages::effect::Effect;
use crate::messages::requests::Target;
use crate::messages::snapshot::{Place, Snapshot};
use crate::overlays::Overlay;
use crate::overlays::explanation::Selected;
use crate::overlays::form_frame::Sending;
use crate::overlays::study_form::{Filter, StudyForm};
use crate::screens::measurements::draw as measured;
use crate::screens::movement::{Movement, stepped};
use crate::screens::state::State;
use crate::widgets::text::{self, left};
use crate::widgets::theme::{fit_glyph, glyph, sign};
use engine::{NewOutfit, wearables};
use sim::fabric::USUAL as USUAL_FABRIC;
use store::{Cell, FitCell, JobId, Status};

pub fn is_match(state: &State, place: Place) -> bool {
    let filter = state.filter_of(Screen::Study);
    let (Some(data), Some(grid)) = (&state.data, state.grid()) else { return false };
    let cell = data.cell_at(place);
    let status = cell.and_then(|cell| cell.status).map_or("", text::status);
    let shown = cell.map_or(String::new(), cell_text);
    let fit = data.fit_at(place);
    let class = fit.map_or("", |fit| fit.class.as_str());
    let ease = fit.map_or(String::new(), |fit| ease_text(&fit));
    let sim = grid.simulators.get(place.simulator).map_or("", |sim| text::sim(*sim));
    let (size, subject) = (&grid.sizes[place.size], &grid.subjects[place.subject]);
    format!("{size} {subject} {sim} {shown} {status} {ease} {class}").to_lowercase().contains(&filter)
}

/// Text of a cell: status glyph, with EI or share done.
pub fn cell_text(cell: &Cell) -> String {
    let Some(status) = cell.status else { return "·".into() };
    match (status, cell.ei, cell.fraction) {
        (Status::Running, _, Some(share)) => format!("{} {:.0}%", glyph(status), share * 100.0),
        (_, Some(ei), _) => format!("{}{}", left(&sign(status, cell.is_inside), 2), text::ei(ei)),
        _ => glyph(status).to_owned(),
    }
}

/// Text of a fit: its sign and the ease in mm.
pub fn ease_text(fit: &FitCell) -> String {
    format!("{} {}", fit_glyph(fit), text::ease_mm(fit.ease_m))
}

/// All places of the grid, row by row.
pub fn places(state: &State) -> Vec<Place> {
    let Some(grid) = state.grid() else { return vec![] };
    let (sizes, simulators, subjects) = (grid.sizes.len(), grid.simulators.len(), grid.subjects.len());
    let rows = (0..sizes).flat_map(|size| (0..simulators).map(move |simulator| (size, simulator)));
    rows.flat_map(|(size, simulator)| (0..subjects).map(move |subject| Place { size, simulator, subject })).collect()
}

/// Jobs of all cells, row by row.
pub fn grid_jobs(state: &State) -> Vec<JobId> {
    places(state).into_iter().filter_map(|place| state.data.as_ref()?.cell_at(place)?.job).collect()
}

/// Jobs of the cells that match the filter, row by row.
pub fn matching_jobs(state: &State) -> Vec<JobId> {
    let places = places(state).into_iter().filter(|place| is_match(state, *place));
    places.filter_map(|place| state.data.as_ref()?.cell_at(place)?.job).collect()
}

pub fn go_in_grid(state: &mut State, movement: Movement) {
    let Some(grid) = state.grid() else { return };
    let simulators = grid.simulators.len().max(1);
    let rows = grid.sizes.len() * simulators;
    let row = movement.from(state.place.size * simulators + state.place.simulator, rows);
    state.select_cell(Place { size: row / simulators, simulator: row % simulators, ..state.place });
}

/// Selects a cell by its index among all, counted row by row.
pub fn go_to_cell(state: &mut State, cell: usize) {
    if let Some(place) = places(state).get(cell) {
        state.nav.second_pane[Screen::Study as usize] = false;
        state.select_cell(*place);
    }
}

pub fn go_to_matching_cell(state: &mut State, step: isize) {
    let places = places(state);
    let at = places.iter().position(|place| *place == state.place).unwrap_or(0);
    let found = (1..=places.len())
        .filter_map(|k| stepped(at, step * k as isize, places.len()))
        .map(|next| places[next])
        .find(|place| is_match(state, *place));
    match found {
        Some(place) => state.select_cell(place),
        None => state.say("no cell matches the filter"),
    }
}

/// Runs the quickstart where there is no study.
pub fn open(state: &mut State) -> Vec<Effect> {
    if state.is_first_start() {
        return state.run(Target::Quickstart);
    }
    if state.focus.job.is_none() {
        state.say("nothing to open here: this cell has no job yet; R runs the study");
    } else {
        state.show(Screen::Results);
    }
    vec![]
}

pub fn step_garment(state: &mut State, step: isize) {
    let Some(garments) = state.study().map(|study| &study.garments) else { return };
    let at = garments.iter().position(|name| Some(name) == state.focus.garment.as_ref()).unwrap_or(0);
    let Some(next) = stepped(at, step, garments.len()) else { return };
    if next != at {
        state.focus.garment = Some(garments[next].clone());
        state.focus.job = None;
    }
}

pub fn next_study(state: &mut State) {
    let Some(data) = &state.data else { return };
    let Some(next) = stepped(data.study, 1, data.studies.len()) else { return };
    if next == data.study {
        state.say("there is one study only");
        return;
    }
    let name = data.studies[next].name.clone();
    state.open_study(name);
}

pub fn new_study(state: &mut State) {
    let Some(data) = &state.data else { return };
    if !state.setup.abilities.run {
        state.complain("this workbench is read-only: start it without --readonly to make a study");
        return;
    }
    let names: Vec<&str> = data.studies.iter().map(|study| study.name.as_str()).collect();
    let name = (1..).map(|k| format!("study-{k}")).find(|name| !names.contains(&name.as_str())).unwrap_or_default();
    let fabrics: Vec<String> = data.fabrics.iter().map(|row| row.fabric.name.clone()).collect();
    let form = StudyForm {
        name,
        folder: state.setup.folders.studies.clone(),
        fabric: fabrics.iter().position(|name| name == USUAL_FABRIC).unwrap_or(0),
        fabrics,
        simulators: spec::SIMULATORS.map(|simulator| (simulator, true)).to_vec(),
        sizes: wearables(&data.sizes).into_iter().map(|wearable| (wearable, false)).collect(),
        opened: BTreeSet::new(),
        outfits: outfits(data).into_iter().map(|outfit| (outfit, false)).collect(),
        own_outfit: String::new(),
        subjects: data.subjects.iter().map(|row| (row.name.clone(), false)).collect(),
        filter: Filter::default(),
        at: 0,
        sending: Sending::default(),
    };
    state.overlay = Some(Overlay::StudyForm(Box::new(form)));
}

/// Outfits of all studies, by style: each once, without those of styles that cannot be chosen.
fn outfits(data: &Snapshot) -> Vec<NewOutfit> {
    let known = wearables(&data.sizes);
    let mut outfits: Vec<NewOutfit> = vec![];
    for row in &data.outfits {
        let layers = row.layers.iter().map(|(_, style)| style.clone()).collect();
        let outfit = NewOutfit { name: row.name.clone(), layers };
        let is_known = |layer: &String| known.iter().any(|size| size.style == *layer);
        if outfit.layers.iter().all(is_known) && !outfits.contains(&outfit) {
            outfits.push(outfit);
        }
    }
    outfits
}

/// Shows a new study; its form shows an error instead.
pub fn study_created(state: &mut State, name: &str, outcome: Result<PathBuf, String>) {
    let awaited = state.told.awaited.take();
    state.told.commands.extend(awaited.filter(|_| outcome.is_ok()));
    match (outcome, &mut state.overlay) {
        (Ok(path), overlay) => {
            if matches!(overlay, Some(Overlay::StudyForm(_))) {
                *overlay = None;
            }
            state.show(Screen::Study);
            (state.focus.study, state.focus.garment, state.focus.job) = (Some(name.to_owned()), None, None);
            state.say(format!("{} is written and its jobs are queued: R runs them", path.display()));
        }
        (Err(text), Some(Overlay::StudyForm(form))) => form.sending.refuse(text),
        (Err(text), _) => state.complain(text),
    }
}

pub fn explained(state: &State) -> Selected {
    let shown = measured::explained(state);
    let place = state.place;
    let (Some(data), Some(grid)) = (&state.data, state.grid()) else { return shown };
    let cell = data.cell_at(place);
    let status = cell
        .and_then(|cell| cell.status)
        .map_or(", no job yet".to_owned(), |status| format!(", {}", text::status(status)));
    let ei = cell.and_then(|cell| cell.ei).map_or(String::new(), |ei| format!(", EI {ei:.4}"));
    let ease = |fit: FitCell| format!(", ease {} mm, {}", text::ease_mm(fit.ease_m), fit.class.as_str());
    let ease = data.fit_at(place).map_or(String::new(), ease);
    let (size, subject) = (&grid.sizes[place.size], &grid.subjects[place.subject]);
    let what = format!("{size} on {subject} by {}{status}{ei}{ease}", text::sim(grid.simulators[place.simulator]));
    let others: Vec<&str> = shown.names.iter().map(String::as_str).collect();
    Selected::new(what, &["EI", "ease mm", "fit class", "status", "FEM", "HYB"], &others)
}

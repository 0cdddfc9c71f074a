//! Handling of answers: data that was read or saved, texts from an editor, ends of runs.

use crate::app::App;
use crate::messages::effect::{Effect, Writing};
use crate::messages::snapshot::{Place, Snapshot};
use crate::overlays::Overlay;
use crate::screens::measurements;
use engine::Ending;
use store::Status;
use wardrobe::Part;

impl App {
    /// Stores what was read from the database. Tells the end of a run that another process made of the shown study.
    pub fn receive(&mut self, snapshot: Box<Snapshot>) -> Vec<Effect> {
        let ended = self.ended_elsewhere(&snapshot);
        let state = &mut self.state;
        state.running.is_settling &= snapshot.study().is_some_and(|study| study.count(Status::Running) > 0);
        let had_grid = state.grid().is_some();
        state.focus.study = snapshot.study().map(|study| study.name.clone());
        state.focus.garment = snapshot.grid.as_ref().map(|grid| grid.garment.clone());
        let data = state.data.insert(snapshot);
        if let Some(grid) = data.grid() {
            let inside = |index: usize, len: usize| index.min(len.saturating_sub(1));
            state.place = Place {
                size: inside(state.place.size, grid.sizes.len()),
                simulator: inside(state.place.simulator, grid.simulators.len()),
                subject: inside(state.place.subject, grid.subjects.len()),
            };
        }
        let known = state.focus.job.filter(|id| data.job(*id).is_some());
        let place = known.and_then(|id| data.place_of(id));
        self.screens.receive(state);
        measurements::clamp(state);
        match place {
            Some(place) => state.place = place,
            None if !had_grid || known.is_none() => state.select_cell(state.place),
            None => {}
        }
        let Some(ending) = ended else { return vec![] };
        state.told.commands.push(format!("# a run elsewhere has ended: {ending}"));
        state.say(format!("a run elsewhere has ended: {ending}"));
        vec![Effect::Notify(ending)]
    }

    /// Numbers of the jobs of the shown study, if jobs ran elsewhere at the last reading and none is open now.
    fn ended_elsewhere(&self, now: &Snapshot) -> Option<String> {
        let before = self.state.study().filter(|study| study.count(Status::Running) > 0)?;
        let study = now.study().filter(|study| study.name == before.name)?;
        let is_open = study.count(Status::Running) + study.count(Status::Queued) > 0;
        let is_own = self.state.running.target.is_some() || self.state.running.is_settling;
        if is_open || is_own {
            return None;
        }
        let counts = Status::ALL.into_iter().map(|status| (status, study.count(status)));
        let ran = counts.filter(|(_, jobs)| *jobs > 0).collect();
        let inside = now.jobs.iter().filter(|job| job.is_current && job.inside().is_some()).count();
        Some(Ending { study: study.name.clone(), ran, inside, as_before: 0 }.to_string())
    }

    /// Closes the form; a refusal is shown in it instead.
    pub fn saved(&mut self, outcome: Result<String, String>) {
        let Self { state, screens } = self;
        let awaited = state.told.awaited.take();
        state.told.commands.extend(awaited.filter(|_| outcome.is_ok()));
        match (outcome, &mut state.overlay) {
            (Err(text), Some(Overlay::Form(form))) if form.sending.is_busy => form.sending.refuse(text),
            (Err(text), Some(Overlay::Path(prompt))) if prompt.sending.is_busy => prompt.sending.refuse(text),
            (Err(text), Some(Overlay::CommentForm(form))) if form.sending.is_busy => form.sending.refuse(text),
            (Err(text), Some(Overlay::StyleForm(form))) if form.sending.is_busy => form.refused(text),
            (Err(text), _) => state.complain(text),
            (Ok(text), overlay) => {
                match overlay {
                    Some(Overlay::Form(form)) if form.sending.is_busy => {
                        let chosen = match form.part {
                            Part::Fabric => &mut screens.fabrics.chosen,
                            _ => &mut screens.subjects.chosen,
                        };
                        *chosen = Some(form.name().to_owned());
                        *overlay = None;
                    }
                    Some(Overlay::StyleForm(form)) if form.sending.is_busy => {
                        screens.styles.selected = Some((form.style(), form.size()));
                        *overlay = None;
                    }
                    Some(Overlay::CommentForm(form)) if form.sending.is_busy => *overlay = None,
                    Some(Overlay::Path(prompt)) if prompt.sending.is_busy => *overlay = None,
                    _ => {}
                }
                state.say(text);
            }
        }
    }

    pub fn written(&mut self, writing: Writing, text: Result<String, String>) -> Vec<Effect> {
        let Self { state, screens } = self;
        match (writing, text) {
            (_, Err(error)) => state.complain(error),
            (Writing::Query(_), Ok(text)) => screens.sql.take_query(state, &text),
            (Writing::Seams(request, file), Ok(text)) => return screens.styles.written(state, request, file, text),
            (Writing::File(path), Ok(_)) => state.say(format!("{}: R runs it as it is now", path.display())),
        }
        vec![]
    }

    pub fn run_ended(&mut self, outcome: Result<String, String>) -> Vec<Effect> {
        (self.state.running.target, self.state.running.is_settling) = (None, true);
        let (Ok(text) | Err(text)) = &outcome;
        let text = text.clone();
        // The line fades; the log keeps it.
        self.state.told.commands.push(format!("# the run has ended: {text}"));
        match outcome {
            Ok(text) => self.state.say(format!("the run has ended: {text}")),
            Err(text) => self.state.complain(text),
        }
        if self.state.terminal.detached { vec![Effect::Quit] } else { vec![Effect::Notify(text)] }
    }
}

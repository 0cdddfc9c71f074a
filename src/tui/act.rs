//! What each action does to the state.

use super::action::{Action, Screen};
use super::copy;
use super::entries;
use super::message::{Act, Effect, Target};
use super::overlay::{List, Overlay};
use super::picture;
use super::state::{ChiOrder, Place, State};
use study::{JobId, Part, why_no_retry};

impl State {
    /// Does an action; returns what others have to do.
    pub fn act(&mut self, action: Action) -> Vec<Effect> {
        match action {
            Action::Up | Action::Down | Action::First | Action::Last | Action::PageUp | Action::PageDown => {
                self.go(action);
            }
            Action::Left => self.sideways(-1),
            Action::Right => self.sideways(1),
            Action::NextPane | Action::PreviousPane => {
                let pane = &mut self.nav.second_pane[self.nav.screen as usize];
                *pane = !*pane;
            }
            Action::Show(screen) => self.show(screen),
            Action::Open => return self.open(),
            Action::Back => {
                self.back();
            }
            Action::Leave => {
                if !self.back() {
                    return self.quit();
                }
            }
            Action::Filter => self.overlay = Some(Overlay::Filter(self.filter().to_owned())),
            Action::NextMatch => self.go_to_match(1),
            Action::PreviousMatch => self.go_to_match(-1),
            Action::Sort => self.sort(),
            Action::Reverse => self.reverse(),
            Action::Copy => return self.copy(),
            Action::NextGarment => self.step_garment(1),
            Action::PreviousGarment => self.step_garment(-1),
            Action::NextStudy => self.next_study(),
            Action::OtherSimulator => self.other_simulator(),
            Action::NextStage => self.next_stage(),
            Action::NextView => self.drapes.look = picture::next_view(self.drapes.look),
            Action::ZoomIn => self.drapes.look = picture::zoomed(self.drapes.look, 1),
            Action::ZoomOut => self.drapes.look = picture::zoomed(self.drapes.look, -1),
            Action::Mark => self.mark_run(),
            Action::Unmark => self.unmark_runs(),
            Action::Differences => {
                (self.compare.differences_only, self.compare.contrast) = (!self.compare.differences_only, 0);
            }
            Action::NewStudy => self.new_study(),
            Action::EditQuery => self.nav.second_pane[Screen::Sql as usize] = false,
            Action::SavedQueries => self.offer_queries(),
            Action::OlderQuery => self.recall(-1),
            Action::NewerQuery => self.recall(1),
            Action::ExportQuery => self.export_query(),
            Action::BuildReport => return self.build_report(),
            Action::OpenReport => return self.open_report(),
            Action::Ascii => self.theme.ascii = !self.theme.ascii,
            Action::Mouse => {
                self.terminal.has_mouse = !self.terminal.has_mouse;
                let text = if self.terminal.has_mouse {
                    "the mouse is taken: tabs, wheel"
                } else {
                    "the mouse is the terminal's"
                };
                self.say(text);
                return vec![Effect::Mouse(self.terminal.has_mouse)];
            }
            Action::NextMap => self.drapes.map = picture::next_map(self.drapes.map),
            Action::Enlarge => self.drapes.enlarged = !self.drapes.enlarged,
            Action::Add(part) => self.add_entry(part),
            Action::Edit(part) => self.edit_entry(part),
            Action::Import(Part::Style | Part::Size) => self.import_style(),
            Action::Import(part) => self.import_entries(part),
            Action::Remove(Part::Style | Part::Size) => self.remove_size(),
            Action::Remove(part) => self.remove_entry(part),
            Action::EnlargePieces => self.enlarge_pieces(),
            Action::MarkEdge => self.mark_edge(),
            Action::AddSeam => return self.add_seam(),
            Action::RemoveSeam => return self.remove_seam(),
            Action::FlipSeam => return self.flip_seam(),
            Action::ConfirmSeam => return self.confirm_seam(),
            Action::ProposeSeams => return self.propose_seams(),
            Action::UndoEdit => self.undo_edit(),
            Action::SaveSeams => return self.save_seams(),
            Action::Pause => return self.pause(),
            Action::Cancel => return self.cancel(),
            Action::Retry => return self.retry(),
            Action::Raise => return self.prioritise(1),
            Action::Lower => return self.prioritise(-1),
            Action::Run if self.nav.screen == Screen::Sql => return self.run_query(),
            Action::Run => return self.start_run(),
            Action::Stop => self.stop_run(),
            Action::Help => self.overlay = Some(Overlay::Help(List::of(self.setup.bindings))),
            Action::Palette => self.overlay = Some(Overlay::Palette(List::of(self.setup.bindings))),
            Action::Redraw => return vec![Effect::Clear],
            Action::Quit if self.sql.asked.is_some() => return vec![Effect::StopAsking],
            Action::Quit => return self.quit(),
        }
        vec![]
    }

    pub(super) fn show(&mut self, screen: Screen) {
        if screen == self.nav.screen {
            return;
        }
        match self.nav.trail.iter().position(|seen| *seen == screen) {
            Some(at) => self.nav.trail.truncate(at),
            None => self.nav.trail.push(self.nav.screen),
        }
        self.nav.screen = screen;
    }

    fn open(&mut self) -> Vec<Effect> {
        if self.is_first_start() {
            return self.run(Target::Quickstart);
        }
        if self.cells.focus.job.is_none() {
            self.say("nothing to open here: this cell has no job yet; R runs the study");
        } else {
            self.show(Screen::Results);
        }
        vec![]
    }

    /// Takes back the latest of filter, enlargement and screen; returns whether there was any.
    fn back(&mut self) -> bool {
        let filter = &mut self.nav.filters[self.nav.screen as usize];
        if !filter.is_empty() {
            filter.clear();
        } else if self.drapes.enlarged && matches!(self.nav.screen, Screen::Results | Screen::Compare) {
            self.drapes.enlarged = false;
        } else if self.styles.enlarged && self.nav.screen == Screen::Styles {
            self.styles.enlarged = false;
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

    pub(super) fn ask(&mut self, text: impl Into<String>, effects: Vec<Effect>) {
        self.overlay = Some(Overlay::Question { text: text.into(), effects });
    }

    fn sort(&mut self) {
        match self.nav.screen {
            Screen::Styles => self.say("styles are listed by name, sizes as they came"),
            Screen::Subjects => self.subjects.order.by = self.subjects.order.by.next(entries::SHOWN),
            Screen::Fabrics => self.fabrics.order.by = self.fabrics.order.by.next(),
            Screen::Jobs => self.jobs.order.by = self.jobs.order.by.next(),
            Screen::Compare => self.compare.sorts_contrasts = !self.compare.sorts_contrasts,
            Screen::Reports => self.reports_by_time = !self.reports_by_time,
            Screen::Sql => {
                let filter = self.filter().to_owned();
                if let Some(sheet) = &mut self.sql.sheet {
                    sheet.sort(&filter);
                }
            }
            Screen::Study | Screen::Results => {
                self.chi.order.by = match self.chi.order.by {
                    ChiOrder::Number => ChiOrder::Error,
                    ChiOrder::Error => ChiOrder::Number,
                };
            }
        }
    }

    fn reverse(&mut self) {
        let reversed = match self.nav.screen {
            Screen::Styles => return self.say("styles are listed by name, sizes as they came"),
            Screen::Subjects => &mut self.subjects.order.reversed,
            Screen::Fabrics => &mut self.fabrics.order.reversed,
            Screen::Jobs => &mut self.jobs.order.reversed,
            Screen::Study | Screen::Results => &mut self.chi.order.reversed,
            Screen::Compare => &mut self.compare.sorts_contrasts,
            Screen::Reports => &mut self.reports_by_time,
            Screen::Sql => {
                let filter = self.filter().to_owned();
                return self.sql.sheet.iter_mut().for_each(|sheet| sheet.reverse(&filter));
            }
        };
        *reversed = !*reversed;
    }

    fn copy(&mut self) -> Vec<Effect> {
        let Some((text, what)) = copy::selection(self) else {
            self.say("nothing to copy here");
            return vec![];
        };
        self.say(format!("copied {what}"));
        vec![Effect::Copy(text)]
    }

    fn step_garment(&mut self, step: isize) {
        let Some(garments) = self.data.as_ref().and_then(|data| data.study()).map(|study| &study.garments) else {
            return;
        };
        let at = garments.iter().position(|name| Some(name) == self.cells.focus.garment.as_ref()).unwrap_or(0);
        let Some(next) = stepped(at, step, garments.len()) else { return };
        if next != at {
            self.cells.focus.garment = Some(garments[next].clone());
            self.cells.focus.job = None;
        }
    }

    fn next_study(&mut self) {
        let Some(data) = &self.data else { return };
        let Some(next) = stepped(data.study, 1, data.studies.len()) else { return };
        if next == data.study {
            self.say("there is one study only");
            return;
        }
        self.cells.focus.study = Some(data.studies[next].name.clone());
        (self.cells.focus.garment, self.cells.focus.job, self.cells.place) = (None, None, Place::default());
    }

    fn other_simulator(&mut self) {
        let Some(job) = self.job() else { return };
        match self.same_by_other(job).map(|other| other.id) {
            Some(id) => self.cells.focus.job = Some(id),
            None => self.say("the study has no job of the other simulator here"),
        }
    }

    fn next_stage(&mut self) {
        let stages = self.stages();
        let at = stages.iter().position(|stage| Some(*stage) == self.stage()).unwrap_or(0);
        let next = stepped(at, 1, stages.len()).map(|next| stages[next].to_owned());
        let is_only = stages.len() < 2;
        self.chi.stage = next.or(self.chi.stage.take());
        if is_only {
            self.say("this result was measured at one stage only");
        }
    }

    fn pause(&mut self) -> Vec<Effect> {
        let Some(study) = self.data.as_ref().and_then(|data| data.study()) else { return vec![] };
        let name = study.name.clone();
        vec![Effect::Do(if study.paused { Act::Resume(name) } else { Act::Pause(name) })]
    }

    fn cancel(&mut self) -> Vec<Effect> {
        let Some(job) = self.job() else { return self.no_job() };
        if job.status.is_final() {
            let text = format!("job {} has ended ({}): nothing to cancel", job.id, super::text::status(job.status));
            self.say(text);
            return vec![];
        }
        let text = format!(
            "Cancel job {}, {} {} on {} by {}?",
            job.id,
            job.garment,
            job.size,
            job.subject,
            super::text::sim(job.simulator)
        );
        let effects = vec![Effect::Do(Act::Cancel(job.id))];
        self.ask(text, effects);
        vec![]
    }

    fn retry(&mut self) -> Vec<Effect> {
        let Some(job) = self.job() else { return self.no_job() };
        let id = job.id;
        if let Some(reason) = why_no_retry(job.status) {
            self.say(format!("job {id} is not run again: {reason}"));
            return vec![];
        }
        vec![Effect::Do(Act::Retry(id))]
    }

    fn prioritise(&mut self, step: i64) -> Vec<Effect> {
        let Some(job) = self.job() else { return self.no_job() };
        vec![Effect::Do(Act::Prioritise(job.id, job.priority + step))]
    }

    fn no_job(&mut self) -> Vec<Effect> {
        self.say("no job is selected");
        vec![]
    }

    fn start_run(&mut self) -> Vec<Effect> {
        if self.is_first_start() {
            return self.run(Target::Quickstart);
        }
        let Some(study) = self.data.as_ref().and_then(|data| data.study()) else { return vec![] };
        let target = Target::Study(study.path.clone());
        self.run(target)
    }

    fn run(&mut self, target: Target) -> Vec<Effect> {
        if target == Target::Quickstart && !self.setup.abilities.quickstart {
            self.complain("the quickstart study is not installed here: give `toile run` a folder with a study.toml");
            return vec![];
        }
        if !self.setup.abilities.run {
            self.complain("this workbench is read-only: start it without --readonly to run a study");
            return vec![];
        }
        if self.running.target.is_some() {
            self.say("a run goes on here already; X stops it");
            return vec![];
        }
        self.running.target = Some(target.clone());
        self.say("run started; it goes on in the background");
        vec![Effect::Run(target)]
    }

    fn stop_run(&mut self) {
        if self.running.target.is_none() {
            self.say("no run goes on here");
            return;
        }
        self.ask("Stop the run? Unfinished jobs go back to the queue.", vec![Effect::StopRun]);
    }

    /// Selects a job.
    pub(super) fn select(&mut self, id: JobId) {
        self.cells.focus.job = Some(id);
    }
}

/// An index some steps on, round about; `None` where there is nothing.
pub(super) fn stepped(index: usize, step: isize, len: usize) -> Option<usize> {
    (len > 0).then(|| (index as isize + step).rem_euclid(len as isize) as usize)
}

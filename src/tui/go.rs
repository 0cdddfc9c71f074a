//! Moving about: rows, cells, matches.

use super::act::stepped;
use super::action::{Action, Screen};
use super::picture;
use super::screens;
use super::state::{Place, State};
use study::JobId;

/// Lines that no list has: title, borders, headers, status line.
const FRAME_LINES: u16 = 8;

impl State {
    /// Moves up or down in the pane that has the focus.
    pub(super) fn go(&mut self, action: Action) {
        let page = usize::from(self.terminal.size.height.saturating_sub(FRAME_LINES)).max(2) / 2;
        match (self.nav.screen, self.in_second_pane()) {
            (Screen::Study, false) => self.go_in_grid(action, page),
            (Screen::Subjects | Screen::Fabrics, true) => self.go_in_table(action, page),
            (Screen::Subjects, false) => self.go_in_subjects(action, page),
            (Screen::Fabrics, false) => self.go_in_fabrics(action, page),
            (Screen::Styles, false) => self.go_in_sizes(action, page),
            (Screen::Styles, true) => self.go_in_desk(action, page),
            (Screen::Jobs, false) => self.go_in_jobs(action, page),
            (Screen::Jobs, true) => self.go_in_log(action, page),
            (Screen::Results | Screen::Compare, true) if self.drapes.look.zoom_pct > picture::FRONT.zoom_pct => {
                let steps = match action {
                    Action::Up | Action::PageUp => 1,
                    Action::Down | Action::PageDown => -1,
                    _ => 0,
                };
                self.drapes.look = picture::raised(self.drapes.look, steps);
            }
            (Screen::Compare, _) => {
                self.compare.contrast = moved(self.compare.contrast, self.contrasts().len(), action, page)
            }
            (Screen::Reports, _) => self.reports.row = moved(self.reports.row, self.reports().len(), action, page),
            (Screen::Sql, _) => {
                if let Some(sheet) = &mut self.sql.sheet {
                    sheet.row = moved(sheet.row, sheet.len(), action, page);
                }
            }
            (Screen::Study, true) | (Screen::Results, _) => {
                self.chi.row = moved(self.chi.row, self.chi().len(), action, page);
            }
        }
    }

    fn go_in_grid(&mut self, action: Action, page: usize) {
        let Some(grid) = self.grid() else { return };
        let simulators = grid.simulators.len().max(1);
        let rows = grid.sizes.len() * simulators;
        let row = moved(self.cells.place.size * simulators + self.cells.place.simulator, rows, action, page);
        self.go_to(Place { size: row / simulators, simulator: row % simulators, ..self.cells.place });
    }

    fn go_in_subjects(&mut self, action: Action, page: usize) {
        let selected = self.subject().map(|row| row.id);
        let subjects = self.subjects();
        let at = subjects.iter().position(|row| Some(row.id) == selected).unwrap_or(0);
        self.subjects.chosen = subjects.get(moved(at, subjects.len(), action, page)).map(|row| row.name.clone());
    }

    fn go_in_fabrics(&mut self, action: Action, page: usize) {
        let selected = self.fabric().map(|row| row.fabric.name.clone());
        let fabrics = self.fabrics();
        let at = fabrics.iter().position(|row| Some(&row.fabric.name) == selected.as_ref()).unwrap_or(0);
        self.fabrics.chosen = fabrics.get(moved(at, fabrics.len(), action, page)).map(|row| row.fabric.name.clone());
    }

    /// Scrolls the table of the selected subject or fabric.
    fn go_in_table(&mut self, action: Action, page: usize) {
        let hidden = screens::table_hidden(self);
        self.table_down = moved(self.table_down.min(hidden), hidden + 1, action, page);
    }

    fn go_in_sizes(&mut self, action: Action, page: usize) {
        let selected = self.size_row().map(|row| row.key);
        let sizes = self.sizes();
        let at = sizes.iter().position(|row| Some(row.key) == selected).unwrap_or(0);
        let next = sizes.get(moved(at, sizes.len(), action, page));
        self.styles.selected = next.map(|row| (row.style.clone(), row.size.clone()));
    }

    fn go_in_desk(&mut self, action: Action, page: usize) {
        let lines = self.laid().and_then(Result::ok).map_or(0, |laid| laid.lines().len());
        self.select_line(moved(self.styles.line, lines, action, page));
    }

    fn go_in_jobs(&mut self, action: Action, page: usize) {
        let jobs: Vec<JobId> = self.jobs().iter().map(|job| job.id).collect();
        let at = jobs.iter().position(|id| Some(*id) == self.cells.focus.job);
        let next = at.map_or(0, |at| moved(at, jobs.len(), action, page));
        if let Some(id) = jobs.get(next) {
            self.select(*id);
        }
    }

    fn go_in_log(&mut self, action: Action, page: usize) {
        let lines = self.detail().map_or(0, |detail| detail.log.len());
        let from_top = lines.saturating_sub(1 + self.jobs.log_up);
        self.jobs.log_up = lines.saturating_sub(1 + moved(from_top, lines, action, page));
    }

    /// Moves left or right: subjects, results, or round the drape.
    pub(super) fn sideways(&mut self, step: isize) {
        match (self.nav.screen, self.in_second_pane()) {
            (Screen::Study, _) => {
                let Some(grid) = self.grid() else { return };
                let last = grid.subjects.len().saturating_sub(1);
                let subject = self.cells.place.subject.saturating_add_signed(step).min(last);
                self.go_to(Place { subject, ..self.cells.place });
            }
            (Screen::Results | Screen::Compare, true) => self.drapes.look = picture::turned(self.drapes.look, step),
            (Screen::Sql, _) => self.sql.sheet.iter_mut().for_each(|sheet| sheet.sideways(step)),
            (Screen::Results, false) => self.step_result(step),
            (Screen::Styles, true) => self.step_edge(step),
            (
                Screen::Subjects | Screen::Fabrics | Screen::Styles | Screen::Jobs | Screen::Compare | Screen::Reports,
                _,
            ) => {}
        }
    }

    /// Goes to the next or previous job that has a result.
    fn step_result(&mut self, step: isize) {
        let is_shown = |job: &&study::JobRow| job.status.has_result() || Some(job.id) == self.cells.focus.job;
        let Some(data) = &self.data else { return };
        let jobs: Vec<JobId> = data.jobs.iter().filter(is_shown).map(|job| job.id).collect();
        let at = jobs.iter().position(|id| Some(*id) == self.cells.focus.job).unwrap_or(0);
        if let Some(next) = stepped(at, step, jobs.len()) {
            self.select(jobs[next]);
        }
    }

    /// Selects a cell of the grid and its job, if it has one.
    fn go_to(&mut self, place: Place) {
        self.cells.place = place;
        self.cells.focus.job = self.cell_at(place).and_then(|cell| cell.job);
    }

    /// Goes to the next or previous match of the filter.
    pub(super) fn go_to_match(&mut self, step: isize) {
        if self.filter().is_empty() {
            self.say("no filter is set; / sets one");
            return;
        }
        match self.nav.screen {
            Screen::Study => self.go_to_matching_cell(step),
            Screen::Subjects => {
                let selected = self.subject().map(|row| row.id);
                let subjects = self.subjects();
                let at = subjects.iter().position(|row| Some(row.id) == selected).unwrap_or(0);
                self.subjects.chosen = stepped(at, step, subjects.len()).map(|next| subjects[next].name.clone());
            }
            Screen::Fabrics => {
                let selected = self.fabric().map(|row| row.fabric.name.clone());
                let fabrics = self.fabrics();
                let at = fabrics.iter().position(|row| Some(&row.fabric.name) == selected.as_ref()).unwrap_or(0);
                self.fabrics.chosen = stepped(at, step, fabrics.len()).map(|next| fabrics[next].fabric.name.clone());
            }
            Screen::Styles => {
                let selected = self.size_row().map(|row| row.key);
                let sizes = self.sizes();
                let at = sizes.iter().position(|row| Some(row.key) == selected).unwrap_or(0);
                let next = stepped(at, step, sizes.len()).map(|next| sizes[next]);
                self.styles.selected = next.map(|row| (row.style.clone(), row.size.clone()));
            }
            Screen::Jobs => {
                let jobs: Vec<JobId> = self.jobs().iter().map(|job| job.id).collect();
                let at = jobs.iter().position(|id| Some(*id) == self.cells.focus.job).unwrap_or(0);
                if let Some(next) = stepped(at, step, jobs.len()) {
                    self.select(jobs[next]);
                }
            }
            Screen::Results => self.chi.row = stepped(self.chi.row, step, self.chi().len()).unwrap_or(0),
            Screen::Compare => {
                self.compare.contrast = stepped(self.compare.contrast, step, self.contrasts().len()).unwrap_or(0)
            }
            Screen::Reports => self.reports.row = stepped(self.reports.row, step, self.reports().len()).unwrap_or(0),
            Screen::Sql => {
                if let Some(sheet) = &mut self.sql.sheet {
                    sheet.row = stepped(sheet.row, step, sheet.len()).unwrap_or(0);
                }
            }
        }
    }

    fn go_to_matching_cell(&mut self, step: isize) {
        let places = self.places();
        let at = places.iter().position(|place| *place == self.cells.place).unwrap_or(0);
        let found = (1..=places.len())
            .filter_map(|k| stepped(at, step * k as isize, places.len()))
            .map(|next| places[next])
            .find(|place| self.is_match(*place));
        match found {
            Some(place) => self.go_to(place),
            None => self.say("no cell matches the filter"),
        }
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
}

/// An index after a movement in a list.
fn moved(index: usize, len: usize, action: Action, page: usize) -> usize {
    let last = len.saturating_sub(1);
    let next = match action {
        Action::Up => index.saturating_sub(1),
        Action::Down => index + 1,
        Action::PageUp => index.saturating_sub(page),
        Action::PageDown => index + page,
        Action::First => 0,
        Action::Last => last,
        _ => index,
    };
    next.min(last)
}

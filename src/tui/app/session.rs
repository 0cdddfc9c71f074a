//! Memory of the workbench between starts: screen, selections, filters, orders, queries. Each database has one small
//! file in the state folder. A file that cannot be read gives a fresh start, not an error.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use crate::app::App;
use crate::config::Env;
use crate::keys::screen::Screen;
use crate::screens::fabrics::state::FabricOrder;
use crate::screens::jobs::state::JobOrder;
use crate::screens::measurements::state::ChiOrder;
use crate::screens::order::Order;
use crate::screens::sql::state::Queries;
use crate::screens::subjects::state::SubjectOrder;
use store::JobId;

/// Greatest length of a file's name, bytes.
const LONGEST: usize = 200;

/// State of the workbench that survives from one start to the next.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(default)]
pub struct Session {
    screen: usize,
    study: Option<String>,
    garment: Option<String>,
    job: Option<i64>,
    subject: Option<String>,
    fabric: Option<String>,
    size: Option<(String, String)>,
    marks: Vec<i64>,
    filters: Vec<String>,
    second_pane: Vec<bool>,
    subject_order: Order<SubjectOrder>,
    fabric_order: Order<FabricOrder>,
    job_order: Order<JobOrder>,
    chi_order: Order<ChiOrder>,
    reports_by_time: bool,
    sorts_contrasts: bool,
    differences_only: bool,
    chosen_ascii: Option<bool>,
    chosen_mouse: Option<bool>,
    queries: Queries,
    history: Vec<String>,
}

impl Session {
    pub fn of(app: &App) -> Self {
        let App { state, screens } = app;
        Self {
            screen: state.nav.screen as usize,
            study: state.focus.study.clone(),
            garment: state.focus.garment.clone(),
            job: state.focus.job.map(|job| job.0),
            subject: screens.subjects.chosen.clone(),
            fabric: screens.fabrics.chosen.clone(),
            size: screens.styles.selected.clone(),
            marks: state.marks.iter().map(|job| job.0).collect(),
            filters: state.nav.filters.to_vec(),
            second_pane: state.nav.second_pane.to_vec(),
            subject_order: screens.subjects.order,
            fabric_order: screens.fabrics.order,
            job_order: screens.jobs.order,
            chi_order: state.measurements.order,
            reports_by_time: screens.reports.by_time,
            sorts_contrasts: screens.compare.sorts_by_difference,
            differences_only: screens.compare.differences_only,
            chosen_ascii: state.terminal.chosen_ascii,
            chosen_mouse: state.terminal.chosen_mouse,
            queries: screens.sql.queries(),
            history: screens.sql.history.clone(),
        }
    }

    /// Leaves `ascii` and the mouse alone where the environment sets them.
    pub fn restore(self, app: &mut App) {
        let App { state, screens } = app;
        state.nav.screen = Screen::ALL.get(self.screen).copied().unwrap_or(Screen::Study);
        (state.focus.study, state.focus.garment, state.focus.job) = (self.study, self.garment, self.job.map(JobId));
        (screens.subjects.chosen, screens.fabrics.chosen, screens.styles.selected) =
            (self.subject, self.fabric, self.size);
        state.marks = self.marks.into_iter().map(JobId).collect();
        state.nav.marked_on = state.nav.screen;
        for (filter, kept) in state.nav.filters.iter_mut().zip(self.filters) {
            *filter = kept;
        }
        for (pane, kept) in state.nav.second_pane.iter_mut().zip(self.second_pane) {
            *pane = kept;
        }
        state.nav.second_pane[Screen::Sql as usize] = true;
        (screens.subjects.order, screens.jobs.order, state.measurements.order) =
            (self.subject_order, self.job_order, self.chi_order);
        screens.fabrics.order = self.fabric_order;
        (screens.reports.by_time, screens.compare.sorts_by_difference) = (self.reports_by_time, self.sorts_contrasts);
        screens.compare.differences_only = self.differences_only;
        state.terminal.chosen_ascii = self.chosen_ascii;
        state.theme.ascii |= self.chosen_ascii == Some(true);
        state.terminal.chosen_mouse = self.chosen_mouse;
        state.terminal.has_mouse = self.chosen_mouse.unwrap_or(state.terminal.has_mouse);
        screens.sql.take_queries(self.queries);
        screens.sql.history = self.history;
    }

    /// Returns an empty session where there is no readable file.
    pub fn read(path: &Path) -> Self {
        std::fs::read(path).ok().and_then(|bytes| serde_json::from_slice(&bytes).ok()).unwrap_or_default()
    }

    /// Ignores errors: only a convenience is lost.
    pub fn write(&self, path: &Path) {
        let Some(folder) = path.parent() else { return };
        let Ok(bytes) = serde_json::to_vec_pretty(self) else { return };
        let aside = path.with_extension(format!("{}.tmp", std::process::id()));
        let written = std::fs::create_dir_all(folder).and_then(|()| std::fs::write(&aside, bytes));
        let _ = written.and_then(|()| std::fs::rename(&aside, path));
    }
}

/// Time after a key after which the session is written, so that a crash loses no more than that.
const REST: Duration = Duration::from_secs(1);

/// Writer of the session while the workbench is used.
pub struct Keeper {
    path: Option<PathBuf>,
    written: Session,
    due: Option<Instant>,
}

impl Keeper {
    /// Makes a keeper that knows the session in the file; without a path it keeps nothing.
    pub fn new(path: Option<PathBuf>, written: Session) -> Self {
        Self { path, written, due: None }
    }

    pub fn folder(&self) -> Option<&Path> {
        self.path.as_deref()?.parent()
    }

    pub fn touch(&mut self) {
        self.due.get_or_insert_with(|| Instant::now() + REST);
    }

    /// Time until the session is to be written; `None` where it need not be.
    pub fn left(&self) -> Option<Duration> {
        self.due.map(|due| due.saturating_duration_since(Instant::now()))
    }

    pub fn keep_in_time(&mut self, app: &App) {
        if self.left().is_some_and(|left| left.is_zero()) {
            self.keep(app);
        }
    }

    /// Writes the session if it has changed.
    pub fn keep(&mut self, app: &App) {
        self.due = None;
        let session = Session::of(app);
        if let Some(path) = self.path.as_deref().filter(|_| session != self.written) {
            session.write(path);
            self.written = session;
        }
    }
}

/// Path of the session of a database: in `toile` of the state folder.
pub fn path(database: &Path, env: &Env<'_>) -> Option<PathBuf> {
    let set = |name: &str| env(name).filter(|value| !value.is_empty()).map(PathBuf::from);
    let folder = set("XDG_STATE_HOME").or_else(|| set("HOME").map(|home| home.join(".local").join("state")))?;
    let path = std::path::absolute(database).unwrap_or_else(|_| database.to_owned());
    let name: Vec<char> = path.display().to_string().replace(['/', '\\'], "%").chars().collect();
    // The end of a long path is what differs between databases.
    let name: String = name[name.len().saturating_sub(LONGEST)..].iter().collect();
    Some(folder.join("toile").join(format!("{name}.json")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_cannot_be_read_is_forgotten() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("state/x.json");
        assert_eq!(Session::read(&path), Session::default());
        let queries = Queries { texts: vec!["SELECT 1".into()], at: 0 };
        let session = Session { screen: 3, queries, ..Session::default() };
        session.write(&path);
        assert_eq!(Session::read(&path), session);
        std::fs::write(&path, "{\"screen\": 2, \"new\": []").expect("writable");
        assert_eq!(Session::read(&path), Session::default());
        std::fs::write(&path, "{\"screen\": 2, \"of a newer program\": []}").expect("writable");
        assert_eq!(Session::read(&path).screen, 2);
    }

    #[test]
    fn databases_have_files_of_their_own() {
        let env = |name: &str| (name == "XDG_STATE_HOME").then(|| "/state".to_owned());
        let file_of = |database: &str| path(Path::new(database), &env).expect("a place").display().to_string();
        assert_eq!(file_of("/data/a.sqlite"), "/state/toile/%data%a.sqlite.json");
        assert_ne!(
            file_of(&format!("/{}/a.sqlite", "long".repeat(80))),
            file_of(&format!("/{}/b.sqlite", "long".repeat(80)))
        );
    }
}

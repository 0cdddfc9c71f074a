//! Building and opening reports.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use crate::keys::screen::Screen;
use crate::messages::effect::Effect;
use crate::messages::requests::FileTask;
use crate::screens::reports::state::ReportsScreen;
use crate::screens::state::State;
use crate::widgets::text;
use results::ReportRow;
use store::files::word;

impl ReportsScreen {
    pub fn shown(&self, state: &State) -> Vec<&ReportRow> {
        let filter = state.filter_of(Screen::Reports);
        let passes =
            |row: &&ReportRow| format!("{} {}", row.name, facts(state, row).join(" ")).to_lowercase().contains(&filter);
        let mut rows: Vec<&ReportRow> = self.rows.iter().flatten().filter(passes).collect();
        if self.by_time {
            rows.sort_by_key(|row| -row.written_ms);
        }
        rows
    }

    pub fn selected(&self, state: &State) -> Option<&ReportRow> {
        let rows = self.shown(state);
        rows.get(self.row).or(rows.last()).copied()
    }

    /// Requests the list of reports when the screen is first shown.
    pub fn ask_for_reports(&mut self) -> Option<Effect> {
        if self.rows.is_some() {
            return None;
        }
        self.rows = Some(vec![]);
        Some(Effect::Files(FileTask::ListReports))
    }

    pub fn build(&mut self, state: &mut State) -> Vec<Effect> {
        let Some(study) = state.study() else {
            return state.reply("there is no study yet");
        };
        if let Some(name) = &self.building {
            return state.reply(format!("the report of {name} is being built"));
        }
        let (name, has_results) = (study.name.clone(), study.counts[2] + study.counts[3] > 0);
        if !has_results {
            return state.reply(format!("{name} has no result yet: nothing to report"));
        }
        state.show(Screen::Reports);
        state.say(format!("the report of {name} is being built in the background"));
        self.building = Some(name.clone());
        vec![Effect::Files(FileTask::BuildReport(name))]
    }

    pub fn built(&mut self, state: &mut State, page: Result<PathBuf, String>, rows: Vec<ReportRow>) {
        let name = self.building.take();
        self.part.clear();
        self.rows = Some(rows);
        self.row = self.shown(state).iter().position(|row| Some(&row.name) == name.as_ref()).unwrap_or(0);
        match page {
            Ok(page) => state.say(format!("the report is in {}", page.display())),
            Err(error) => state.complain(error),
        }
    }

    /// Opens the selected report in a browser if there is a display; else copies its address.
    pub fn open(&self, state: &mut State) -> Vec<Effect> {
        let Some(row) = self.selected(state) else {
            return state.reply("no report is here yet: b builds that of the study");
        };
        let address = address(&row.page);
        if is_opened(&address) {
            return state.reply(format!("opened {address}"));
        }
        state.copy(format!("{address}, since no display is here"), address)
    }
}

/// Size of a report's page, number of its files, and time at which it was built.
pub fn facts(state: &State, row: &ReportRow) -> [String; 3] {
    let built = text::date(row.written_ms + state.offset_ms());
    [format!("{} kB", row.bytes.div_ceil(1000)), row.files.to_string(), built]
}

/// Opens an address by the desktop's own program. Returns false where there is no desktop.
fn is_opened(address: &str) -> bool {
    let is_set = |name| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    if !is_set("DISPLAY") && !is_set("WAYLAND_DISPLAY") {
        return false;
    }
    let quiet = || Stdio::null();
    Command::new("xdg-open").arg(address).stdin(quiet()).stdout(quiet()).stderr(quiet()).spawn().is_ok()
}

/// Command that copies the folder of a report's page onto the user's own machine.
pub fn fetching(state: &State, page: &Path) -> String {
    let page = std::path::absolute(page).unwrap_or_else(|_| page.to_owned());
    let folder = page.parent().unwrap_or(&page).display().to_string();
    format!("scp -r {}:{} .", state.setup.login, word(&folder))
}

pub fn address(page: &Path) -> String {
    let page: PathBuf = std::path::absolute(page).unwrap_or_else(|_| page.to_owned());
    format!("file://{}", page.display())
}

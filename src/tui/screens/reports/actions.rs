//! Building and opening reports.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use crate::keys::screen::Screen;
use crate::messages::effect::Effect;
use crate::messages::requests::FileTask;
use crate::screens::state::State;
use results::ReportRow;

impl State {
    /// Reports that pass the filter of their screen.
    #[must_use]
    pub fn reports(&self) -> Vec<&ReportRow> {
        let filter = self.nav.filters[Screen::Reports as usize].to_lowercase();
        let rows = self.reports.rows.iter().flatten();
        let mut rows: Vec<&ReportRow> = rows.filter(|row| row.name.to_lowercase().contains(&filter)).collect();
        if self.reports.by_time {
            rows.sort_by_key(|row| -row.written_ms);
        }
        rows
    }

    /// The selected report.
    #[must_use]
    pub fn report(&self) -> Option<&ReportRow> {
        let rows = self.reports();
        rows.get(self.reports.row).or(rows.last()).copied()
    }

    /// Has the reports listed when the screen is first shown.
    pub fn ask_for_reports(&mut self) -> Option<Effect> {
        if self.reports.rows.is_some() {
            return None;
        }
        self.reports.rows = Some(vec![]);
        Some(Effect::Files(FileTask::ListReports))
    }

    /// Builds the report of the study.
    pub fn build_report(&mut self) -> Vec<Effect> {
        let Some(study) = self.data.as_ref().and_then(|data| data.study()) else {
            self.say("there is no study yet");
            return vec![];
        };
        if let Some(name) = &self.reports.building {
            let text = format!("the report of {name} is being built");
            self.say(text);
            return vec![];
        }
        let (name, has_results) = (study.name.clone(), study.counts[2] + study.counts[3] > 0);
        if !has_results {
            self.say(format!("{name} has no result yet: nothing to report"));
            return vec![];
        }
        self.show(Screen::Reports);
        self.say(format!("the report of {name} is being built in the background"));
        self.reports.building = Some(name.clone());
        vec![Effect::Files(FileTask::BuildReport(name))]
    }

    /// Takes in that a report was built.
    pub fn report_built(&mut self, page: Result<PathBuf, String>, rows: Vec<ReportRow>) {
        let name = self.reports.building.take();
        self.reports.rows = Some(rows);
        self.reports.row = self.reports().iter().position(|row| Some(&row.name) == name.as_ref()).unwrap_or(0);
        match page {
            Ok(page) => self.say(format!("the report is in {}", page.display())),
            Err(error) => self.complain(error),
        }
    }

    /// Opens the selected report in a browser where there is a display; otherwise its address is copied.
    pub fn open_report(&mut self) -> Vec<Effect> {
        let Some(row) = self.report() else {
            self.say("no report is here yet: b builds that of the study");
            return vec![];
        };
        let address = address(&row.page);
        if is_opened(&address) {
            self.say(format!("opened {address}"));
            return vec![];
        }
        self.say(format!("no display here; copied {address}"));
        vec![Effect::Copy(address)]
    }
}

/// Hands an address to the desktop's own program for it, where there is a desktop.
fn is_opened(address: &str) -> bool {
    let is_set = |name| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    if !is_set("DISPLAY") && !is_set("WAYLAND_DISPLAY") {
        return false;
    }
    let quiet = || Stdio::null();
    Command::new("xdg-open").arg(address).stdin(quiet()).stdout(quiet()).stderr(quiet()).spawn().is_ok()
}

/// A page as an address that a browser on this machine opens.
#[must_use]
pub fn address(page: &Path) -> String {
    let page: PathBuf = std::path::absolute(page).unwrap_or_else(|_| page.to_owned());
    format!("file://{}", page.display())
}

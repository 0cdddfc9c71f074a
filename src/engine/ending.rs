//! End of a run: how its jobs ended, in a line, and the signal to a user who looks elsewhere.

use std::collections::BTreeMap;
use std::fmt;

use crate::enqueue::Planned;
use geom::units::mm;
use store::{INSIDE_M, JobFilter, JobId, JobRow, Result, Status, Store, read};

/// Most letters of a notification; desktops cut longer ones.
const LONGEST: usize = 200;

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Ending {
    pub study: String,
    /// Jobs that were to run, by the state that they are in now.
    pub ran: BTreeMap<Status, usize>,
    /// Number of results among them that lie inside the body by more than [`store::INSIDE_M`].
    pub inside: usize,
    /// Number of jobs that had their results before.
    pub as_before: usize,
}

impl Ending {
    pub fn of(store: &Store, study: &str, planned: &[Planned]) -> Result<Self> {
        let jobs = read::jobs(store, &JobFilter { study: Some(study.to_owned()), ..JobFilter::default() })?;
        let rows: BTreeMap<JobId, &JobRow> = jobs.iter().map(|job| (job.id, job)).collect();
        let ran = planned.iter().filter(|job| job.why.will_run()).filter_map(|job| rows.get(&job.id).copied());
        let mut ending = Self::of_rows(study, ran);
        ending.as_before = planned.iter().filter(|job| !job.why.will_run()).count();
        Ok(ending)
    }

    /// Ending of a run that was to make these jobs, and no others.
    pub fn of_rows<'a>(study: &str, jobs: impl Iterator<Item = &'a JobRow>) -> Self {
        let mut ending = Self { study: study.to_owned(), ran: BTreeMap::new(), inside: 0, as_before: 0 };
        for job in jobs {
            *ending.ran.entry(job.status).or_default() += 1;
            ending.inside += usize::from(job.inside().is_some());
        }
        ending
    }
}

impl fmt::Display for Ending {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let words = |status: Status| match status {
            Status::Queued => "left in the queue",
            Status::Running => "run elsewhere",
            Status::Done => "done",
            Status::NotConverged => "not at rest",
            Status::Failed => "failed",
            Status::Cancelled => "cancelled",
        };
        let order =
            [Status::Done, Status::NotConverged, Status::Failed, Status::Cancelled, Status::Running, Status::Queued];
        let mut parts: Vec<String> = order
            .into_iter()
            .filter_map(|status| Some(format!("{} {}", self.ran.get(&status)?, words(status))))
            .collect();
        if self.inside > 0 {
            parts.push(format!("{} more than {:.0} mm inside the body", self.inside, mm(INSIDE_M)));
        }
        if self.as_before > 0 || parts.is_empty() {
            parts.push(format!("{} up to date before", self.as_before));
        }
        write!(f, "{}: {}", self.study, parts.join(", "))
    }
}

/// Control sequences that ring and notify: OSC 9, which iTerm2, kitty, WezTerm, Ghostty and foot show and others ignore;
/// then BEL, by which tmux and most desktops mark the window.
pub fn notification(text: &str) -> String {
    let plain: String = text.chars().filter(|letter| !letter.is_control()).take(LONGEST).collect();
    format!("\x1b]9;{plain}\x07\x07")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_end_is_told_in_numbers() {
        let check = |ran: &[(Status, usize)], inside: usize, as_before: usize, expect: &str| {
            let ending = Ending { study: "tops".into(), ran: ran.iter().copied().collect(), inside, as_before };
            assert_eq!(ending.to_string(), expect);
        };
        check(&[(Status::Failed, 2), (Status::Done, 5)], 0, 0, "tops: 5 done, 2 failed");
        check(&[(Status::Done, 5)], 1, 0, "tops: 5 done, 1 more than 5 mm inside the body");
        check(
            &[(Status::NotConverged, 1), (Status::Queued, 3)],
            0,
            4,
            "tops: 1 not at rest, 3 left in the queue, 4 up to date before",
        );
        check(&[], 0, 12, "tops: 12 up to date before");
        check(&[], 0, 0, "tops: 0 up to date before");
    }

    #[test]
    fn a_text_cannot_end_its_own_sequence() {
        let check = |text: &str, expect: &str| assert_eq!(notification(text), expect);
        check("2 done", "\x1b]9;2 done\x07\x07");
        check("a\x07\x1b]0;b\n", "\x1b]9;a]0;b\x07\x07");
        assert_eq!(notification(&"x".repeat(999)).len(), LONGEST + 6);
    }
}

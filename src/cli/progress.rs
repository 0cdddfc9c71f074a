//! Progress on standard error: bars on a terminal, plain lines elsewhere.

use std::cell::{Cell, OnceCell};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use std::io::IsTerminal;
use std::time::{Duration, Instant};

use indicatif::{MultiProgress, ProgressBar, ProgressStyle};

use super::context::Context;
use super::output::note;
use engine::{Ending, notification};
use fit::Simulator;
use store::{JobFilter, JobId, JobRow, Result, Status, Store, read};

/// Such as `tshirt S ii fem`.
pub fn label(garment: &str, size: &str, subject: &str, simulator: Simulator) -> String {
    format!("{garment} {size} {subject} {}", simulator.as_str())
}

/// A line on standard error about work that goes on for more than a second: in place on a terminal; elsewhere a line for
/// each new part of the work, and every ten seconds.
pub struct Ongoing {
    /// Words before every text.
    head: &'static str,
    is_quiet: bool,
    line: OnceCell<ProgressBar>,
    /// Part that was told last.
    part: Cell<&'static str>,
    /// Time from which the next text of the same part is told.
    next: Cell<Instant>,
    /// Time from which anything is told.
    first: Instant,
}

impl Ongoing {
    /// Time before the first text, and between two of them on a terminal; between two lines elsewhere.
    const SOON: Duration = Duration::from_secs(1);
    const LATER: Duration = Duration::from_secs(10);

    /// Nothing is told yet. Quiet work is never told.
    pub fn new(head: &'static str, is_quiet: bool) -> Self {
        let first = Instant::now() + Self::SOON;
        let (line, part) = (OnceCell::new(), Cell::new(""));
        Self { head, is_quiet, line, part, next: Cell::new(first), first }
    }

    /// Tells how far a part of the work is, if that is due. Work without parts gives an empty one.
    pub fn tell(&self, part: &'static str, text: impl fmt::Display) {
        let now = Instant::now();
        let is_new = now >= self.first && self.part.get() != part;
        if self.is_quiet || !(is_new || now >= self.next.get()) {
            return;
        }
        self.part.set(part);
        let text = format!("{}{text}", self.head);
        if std::io::stderr().is_terminal() {
            self.line.get_or_init(Self::spinner).set_message(text);
            self.next.set(now + Self::SOON);
        } else {
            note(&text);
            self.next.set(now + Self::LATER);
        }
    }

    fn spinner() -> ProgressBar {
        let style = ProgressStyle::with_template("{spinner} {msg} {elapsed}");
        ProgressBar::new_spinner().with_style(style.unwrap_or_else(|_| ProgressStyle::default_spinner()))
    }

    /// Takes the line away from a terminal.
    pub fn end(self) {
        if let Some(line) = self.line.into_inner() {
            line.finish_and_clear();
        }
    }
}

/// Prints the numbers of a run's jobs by their states at its end. On a terminal, rings and notifies where jobs ran.
pub fn tell_end(context: &Context, ending: &Ending) {
    context.say(ending);
    if !context.quiet && !ending.ran.is_empty() && std::io::stderr().is_terminal() {
        eprint!("{}", notification(&format!("toile: {ending}")));
    }
}

const STEPS: u64 = 1000;

pub struct Progress {
    study: String,
    jobs: BTreeSet<JobId>,
    shown: BTreeMap<JobId, Status>,
    bars: Option<Bars>,
    quiet: bool,
}

struct Bars {
    all: MultiProgress,
    total: ProgressBar,
    running: BTreeMap<JobId, ProgressBar>,
    style: ProgressStyle,
}

impl Bars {
    fn new(jobs: usize, colour: bool) -> Self {
        let style = |template: &str, coloured: &str| {
            let style = ProgressStyle::with_template(if colour { coloured } else { template });
            style.unwrap_or_else(|_| ProgressStyle::default_bar()).progress_chars("━╸─")
        };
        let all = MultiProgress::new();
        let total = all.add(ProgressBar::new(jobs as u64));
        total.set_style(style(
            "all jobs {bar:30} {pos}/{len} {elapsed}",
            "all jobs {bar:30.green/dim} {pos}/{len} {elapsed}",
        ));
        let job =
            style("{prefix:20} {bar:30} {percent:>3} % {msg}", "{prefix:20} {bar:30.cyan/dim} {percent:>3} % {msg}");
        Self { all, total, running: BTreeMap::new(), style: job }
    }

    fn show(&mut self, job: &JobRow) {
        let Some(progress) = &job.progress else { return };
        let bar = self.running.entry(job.id).or_insert_with(|| {
            let bar = self.all.add(ProgressBar::new(STEPS).with_style(self.style.clone()));
            bar.set_prefix(label(&job.garment, &job.size, &job.subject, job.simulator));
            bar
        });
        bar.set_position((progress.fraction.clamp(0.0, 1.0) * STEPS as f64) as u64);
        let step = &progress.step;
        bar.set_message(format!(
            "{} {}, residual {:.3}, E {:.3}",
            progress.phase, step.iteration, step.residual, step.e_chi
        ));
    }

    fn end(&mut self, job: &JobRow, line: &str) {
        if let Some(bar) = self.running.remove(&job.id) {
            bar.finish_and_clear();
            self.all.remove(&bar);
        }
        self.total.inc(1);
        // The line is also in the job's log, so it is not lost with the terminal.
        let _ = self.all.println(line);
    }
}

impl Progress {
    pub fn new(context: &Context, study: &str, jobs: BTreeSet<JobId>) -> Self {
        let bars = (!context.quiet && !jobs.is_empty() && std::io::stderr().is_terminal())
            .then(|| Bars::new(jobs.len(), context.colour));
        Self { study: study.to_owned(), jobs, shown: BTreeMap::new(), bars, quiet: context.quiet }
    }

    pub fn show(&mut self, store: &Store) -> Result<()> {
        let filter = JobFilter { study: Some(self.study.clone()), ..JobFilter::default() };
        for job in read::jobs(store, &filter)?.into_iter().filter(|job| self.jobs.contains(&job.id)) {
            if self.shown.get(&job.id).is_some_and(|status| status.is_final()) {
                continue;
            }
            let is_new = self.shown.insert(job.id, job.status) != Some(job.status);
            if let Some(bars) = &mut self.bars {
                bars.show(&job);
            }
            if is_new && job.status.is_final() {
                let line = ended(&job);
                match &mut self.bars {
                    Some(bars) => bars.end(&job, &line),
                    None if !self.quiet => eprintln!("{line}"),
                    None => {}
                }
            } else if is_new && job.status == Status::Running && self.bars.is_none() && !self.quiet {
                eprintln!("job {} {}: started", job.id, label(&job.garment, &job.size, &job.subject, job.simulator));
            }
        }
        Ok(())
    }

    pub fn finish(&mut self) {
        if let Some(bars) = &mut self.bars {
            bars.running.values().for_each(ProgressBar::finish_and_clear);
            bars.total.finish_and_clear();
        }
    }
}

fn ended(job: &JobRow) -> String {
    let what = label(&job.garment, &job.size, &job.subject, job.simulator);
    let took = job.wall_ms.map(|ms| format!(" ({:.1} s)", ms as f64 / 1e3)).unwrap_or_default();
    let how = match (job.status, job.ei, &job.error) {
        (Status::Done, Some(ei), _) => format!("done, EI {ei:.4}"),
        (Status::NotConverged, Some(ei), _) => format!("not at rest, EI {ei:.4}"),
        (status, _, Some(error)) => format!("{}: {error}", status.as_str()),
        (status, ..) => status.as_str().to_owned(),
    };
    let inside = job.inside().map(|words| format!(", {words} the body")).unwrap_or_default();
    format!("job {} {what}: {how}{inside}{took}", job.id)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_is_told_once_and_again_after_a_while() {
        let ongoing = Ongoing::new("making ", false);
        ongoing.tell("pictures", "pictures");
        assert_eq!(ongoing.part.get(), "", "short work is not told");
        let past = Ongoing { first: Instant::now(), ..Ongoing::new("making ", false) };
        past.tell("pictures", "pictures, 1 of 2");
        assert_eq!(past.part.get(), "pictures");
        let next = past.next.get();
        past.tell("pictures", "pictures, 2 of 2");
        assert_eq!(past.next.get(), next, "the same part waits");
        past.tell("pages", "pages");
        assert!(past.part.get() == "pages" && past.next.get() > next);
        let quiet = Ongoing { first: Instant::now(), ..Ongoing::new("", true) };
        quiet.tell("pages", "pages");
        assert_eq!(quiet.part.get(), "");
        past.end();
    }
}

//! The thread that reads the database on request and after changes, and that changes queue and catalogue.

use std::path::Path;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender};
use std::time::{Duration, Instant};

use crate::messages::comments::{CommentDeed, FittingOf};
use crate::messages::message::Message;
use crate::messages::requests::Command;
use crate::messages::snapshot::{Focus, Snapshot};
use crate::threads::reading;
use engine::actions;
use store::comments::{self, Fitting};
use store::owner::Watch;
use store::queue::Interrupted;
use store::{Problem, Status, Store, StudyError, StudyRow, queue};
use wardrobe::seams::write_seams;
use wardrobe::{Deed, Mode, Part, Saved, Strictness, StyleGiven, catalogue};

/// Time between two checks for changes of the database. A check costs microseconds.
const POLL: Duration = Duration::from_millis(250);

pub enum Request {
    Read(Focus),
    Do(Command),
}

/// Reads data on request and whenever the database has changed, and changes queue and catalogue.
pub fn serve(store: Store, asked: &Receiver<Request>, sender: &Sender<Message>) {
    let mut reader = Reader { store, focus: Focus::default(), last: None, rest: POLL, watch: Watch::default() };
    loop {
        let first = match asked.recv_timeout(reader.rest) {
            Ok(request) => Some(request),
            Err(RecvTimeoutError::Timeout) => None,
            Err(RecvTimeoutError::Disconnected) => return,
        };
        let is_wanted = first.is_some();
        // If several readings were requested meanwhile, only the latest is made.
        for request in first.into_iter().chain(asked.try_iter()) {
            match request {
                Request::Read(wanted) => reader.focus = wanted,
                Request::Do(command) => {
                    if sender.send(reader.carry_out(command)).is_err() {
                        return;
                    }
                }
            }
        }
        match reader.recover() {
            Ok(None) => {}
            Ok(Some(text)) | Err(text) => drop(sender.send(Message::Failed(text))),
        }
        let message = match reader.read(is_wanted) {
            Ok(None) => continue,
            Ok(Some(data)) => Message::Data(Box::new(data)),
            Err(error) => Message::Failed(error.to_string()),
        };
        if sender.send(message).is_err() {
            return;
        }
    }
}

struct Reader {
    store: Store,
    focus: Focus,
    last: Option<Reading>,
    rest: Duration,
    /// Heartbeats of other machines' jobs, as seen here.
    watch: Watch,
}

struct Reading {
    version: i64,
    focus: Focus,
    data: Snapshot,
}

impl Reader {
    /// Reads data if `is_wanted` or the database has changed. After a long reading the next check comes later.
    fn read(&mut self, is_wanted: bool) -> Result<Option<Snapshot>, StudyError> {
        let version = self.store.version()?;
        if !is_wanted && self.last.as_ref().is_some_and(|last| last.version == version) {
            return Ok(None);
        }
        let known = self.last.take().filter(|last| last.version == version);
        let start = Instant::now();
        let is_same = |focus: &Focus| (&focus.study, &focus.garment) == (&self.focus.study, &self.focus.garment);
        let data = match known.filter(|known| is_same(&known.focus)) {
            Some(before) => reading::refocused(&self.store, before.data, &self.focus)?,
            None => reading::snapshot(&self.store, &self.focus)?,
        };
        self.rest = POLL.max(2 * start.elapsed());
        let focus = Focus {
            study: data.study().map(|study| study.name.clone()),
            garment: data.grid.as_ref().map(|grid| grid.garment.clone()),
            ..self.focus.clone()
        };
        self.last = Some(Reading { version, focus, data: data.clone() });
        Ok(Some(data))
    }

    /// Puts the jobs of runs that were interrupted back into the queue. Returns a line about them, if there were any.
    fn recover(&mut self) -> Result<Option<String>, String> {
        let is_running = |study: &StudyRow| study.count(Status::Running) > 0;
        if self.last.as_ref().is_some_and(|last| !last.data.studies.iter().any(is_running)) {
            return Ok(None);
        }
        if self.store.is_readonly() {
            self.look_for_interrupted().map_err(|error| error.to_string())?;
            return Ok(None);
        }
        let jobs = queue::recover(&mut self.store, &mut self.watch).map_err(|error| error.to_string())?;
        let told =
            |jobs: usize| format!("a run was interrupted: {jobs} of its jobs wait in the queue again, R goes on");
        Ok((jobs > 0).then(|| told(jobs)))
    }

    /// Has the data read again where a process has ended whose jobs are shown as running: that writes nothing.
    fn look_for_interrupted(&mut self) -> Result<(), StudyError> {
        let interrupted = queue::interrupted(&self.store)?;
        let is_shown = |last: &Reading| {
            let job = |lost: &Interrupted| last.data.job(lost.job);
            interrupted.iter().any(|lost| job(lost).is_some_and(|job| job.status == Status::Running))
        };
        self.last = self.last.take().filter(|last| !is_shown(last));
        Ok(())
    }

    fn carry_out(&mut self, command: Command) -> Message {
        let done = carry_out(&mut self.store, &command).map_err(|error| error.to_string());
        match (command, done) {
            (Command::SaveSeams(style, seams), done) => Message::SeamsSaved(style, seams, done),
            (Command::Comment(of, CommentDeed::Set(change)), Ok(text)) => Message::Commented(of, change, text),
            (command, done) if command.is_from_form() => Message::Saved(done),
            (_, Ok(text)) => Message::Done(text),
            (_, Err(text)) => Message::Failed(text),
        }
    }
}

/// Returns a line that describes the change.
pub fn carry_out(store: &mut Store, command: &Command) -> Result<String, StudyError> {
    match command {
        Command::Save(part, mode, name, given) => {
            let saved = match part {
                Part::Fabric => catalogue::save_fabric(store, *mode, name, None, given)?,
                _ => catalogue::save_subject(store, *mode, name, given)?,
            };
            Ok(format!("{saved}{}", saved.doubts.iter().map(|doubt| format!("; {doubt}")).collect::<String>()))
        }
        Command::Import(part, path) => {
            there(path, &format!("a file of {part}s"))?;
            let saved = catalogue::import(store, *part, std::slice::from_ref(path), Strictness::AllOrNone)?.saved;
            let count = |deed: Deed| saved.iter().filter(|saved| saved.deed == deed).count();
            let changed = count(Deed::Revised) + count(Deed::Restored);
            let doubts = saved.iter().filter(|saved| !saved.doubts.is_empty()).count();
            let doubts = if doubts > 0 { format!("; {doubts} with doubtful values (!)") } else { String::new() };
            Ok(format!(
                "{} {part}s: {} added, {changed} changed, {} as before{doubts}",
                saved.len(),
                count(Deed::Added),
                count(Deed::Unchanged)
            ))
        }
        Command::Remove(part, name) => Ok(catalogue::remove(store, *part, name)?.to_string()),
        Command::ImportStyle(name, given) => import_style(store, name, given),
        Command::SaveSeams(style, seams) => Ok(said(&catalogue::save_seams(store, style, seams)?)),
        Command::WriteSeams(path, before, after) => {
            write_seams(path, before, after)?;
            Ok(format!("{} is written", path.display()))
        }
        Command::Comment(of, deed) => commented(store, of, deed),
        Command::Cancel(ids) => Ok(match (actions::cancel(store, ids)?, &ids[..]) {
            (0, [id]) => format!("job {id} had ended already"),
            (_, [id]) => format!("job {id} is cancelled; r queues it again"),
            (n, _) => format!("{n} of {} jobs are cancelled; r queues them again", ids.len()),
        }),
        Command::Retry(ids) => Ok(match (actions::retry(store, ids)?, &ids[..]) {
            (0, [id]) => format!("job {id} is not run again"),
            (_, [id]) => format!("job {id} is queued again; R runs it"),
            (n, _) => format!("{n} jobs are queued again; R runs them"),
        }),
        Command::Prioritise(id, priority) => {
            actions::set_priority(store, &[*id], *priority)?;
            Ok(format!("job {id} has priority {priority}"))
        }
        Command::Pause(study) => {
            actions::pause(store, study)?;
            Ok(format!("{study} is paused: no new jobs start, running ones go on"))
        }
        Command::Resume(study) => {
            actions::resume(store, study)?;
            Ok(format!("{study} goes on"))
        }
    }
}

/// Returns a line about the change.
fn commented(store: &mut Store, of: &FittingOf, deed: &CommentDeed) -> Result<String, StudyError> {
    let FittingOf { study, garment, subject } = of;
    let fitting = Fitting { study, garment, subject };
    Ok(match deed {
        CommentDeed::Add(remark) => {
            let number = comments::add(store, fitting, remark)?;
            format!("comment {number} of {garment} on {subject} is added; x closes it")
        }
        CommentDeed::Set(change) => {
            comments::edit(store, fitting, change.number, &change.edit)?;
            match change.before {
                Some(_) => format!("comment {} of {garment} on {subject} is changed; u takes it back", change.number),
                None => format!("comment {} of {garment} on {subject} is as it was", change.number),
            }
        }
        CommentDeed::Sign(by) => {
            let round = comments::sign(store, fitting, by)?;
            format!("round {round} of {garment} on {subject} is signed by {by}")
        }
    })
}

/// Adds the styles of a study file; or one style, with proposed seams where none are given; or sizes to a style.
fn import_style(store: &mut Store, name: &str, given: &StyleGiven) -> Result<String, StudyError> {
    if let [(_, path)] = given.patterns.as_slice()
        && path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("toml"))
    {
        return Ok(said(
            &catalogue::import(store, Part::Style, std::slice::from_ref(path), Strictness::AllOrNone)?.saved,
        ));
    }
    for (_, path) in &given.patterns {
        there(path, "a pattern: DXF, a folder of DXF files, GarmentCode JSON, or a study.toml")?;
    }
    given.seams.iter().try_for_each(|path| there(path, "a seam file"))?;
    let is_known = catalogue::sizes(store)?.iter().any(|row| row.style == name);
    let saved = catalogue::save_style(store, if is_known { Mode::Edit } else { Mode::Add }, name, given)?;
    let unsure = catalogue::sizes(store)?.iter().find(|row| row.style == name).map_or(0, |row| row.unconfirmed);
    let proposed = if unsure > 0 { format!("{unsure} seams are proposed, Enter asks; ") } else { String::new() };
    Ok(proposed + &said(&saved))
}

/// Refuses a path at which there is nothing, and says what was wanted there.
fn there(path: &Path, wanted: &str) -> Result<(), StudyError> {
    if path.exists() {
        return Ok(());
    }
    let found = format!("found no file or folder of this name; accepted: the path of {wanted}");
    Err(StudyError::File(vec![Problem::of(path, &found)]))
}

/// Number of entries after the first from which they are counted.
const MANY: usize = 3;

fn said(saved: &[Saved]) -> String {
    match saved {
        [first, rest @ ..] if rest.len() >= MANY => {
            let of = |part: Part| rest.iter().filter(|saved| saved.part == part).count();
            let parts = [Part::Style, Part::Size, Part::Subject, Part::Fabric].map(|part| (part, of(part)));
            let told = parts.into_iter().filter(|(_, count)| *count > 0);
            let told: Vec<String> =
                told.map(|(part, count)| format!("{count} {part}{}", if count == 1 { "" } else { "s" })).collect();
            format!("{first}, with {}", told.join(" and "))
        }
        _ => saved.iter().map(Saved::to_string).collect::<Vec<_>>().join(", "),
    }
}

//! Command lines for effects. The log of them teaches what to type, and can be run again.

use std::path::Path;

use crate::messages::comments::{CommentDeed, FittingOf};
use crate::messages::effect::Effect;
use crate::messages::requests::{Command, FileTask, QueryRequest, Target};
use engine::NewStudy;
use store::JobId;
use store::comments::{Severity, State};
use store::files::word;
use wardrobe::seams::{SeamEdit, SeamStep};
use wardrobe::{Mode, Part, StyleGiven};

/// Command for an effect; `None` if it changes and writes nothing.
pub fn command(effect: &Effect) -> Option<String> {
    match effect {
        Effect::Do(command) => of_command(command),
        Effect::Run(Target::Study(path)) => Some(format!("toile run {}", shown(path))),
        Effect::Run(Target::Quickstart) => Some("toile run quickstart".to_owned()),
        Effect::Round(request) => Some(format!("toile comment round{}", fitting(&request.of))),
        Effect::Files(FileTask::BuildReport(study)) => Some(format!("toile report {}", word(study))),
        Effect::Files(FileTask::CreateStudy(new)) => Some(new_study(new)),
        Effect::Query(QueryRequest::Save(_, name)) => Some(format!("# saved the query {name}")),
        Effect::Query(QueryRequest::Rename(from, to)) => Some(format!("# renamed the query {from} to {to}")),
        Effect::Query(QueryRequest::Rows(sql)) => Some(format!("toile sql {}", word(sql))),
        _ => None,
    }
}

/// True if a later message says that the effect is done or was refused.
pub fn is_awaited(effect: &Effect) -> bool {
    match effect {
        Effect::Do(command) => command.is_from_form(),
        Effect::Files(task) => matches!(task, FileTask::CreateStudy(_) | FileTask::Write(..)),
        Effect::Query(request) => !matches!(request, QueryRequest::Names | QueryRequest::Rows(_)),
        _ => false,
    }
}

/// Path as a word of a command line, relative to the current folder where it lies in it.
fn shown(path: &Path) -> String {
    let here = std::env::current_dir().ok();
    let inside = here.as_deref().and_then(|here| path.strip_prefix(here).ok());
    word(&inside.unwrap_or(path).to_string_lossy())
}

fn of_command(command: &Command) -> Option<String> {
    let part_of = |part: &Part| part.to_string();
    Some(match command {
        Command::Save(part, mode, name, given) => {
            let deed = if *mode == Mode::Add { "add" } else { "edit" };
            let flags = given.iter().map(|(key, value)| format!(" --{} {}", key.replace('_', "-"), word(value)));
            format!("toile {} {deed} {}{}", part_of(part), word(name), flags.collect::<String>())
        }
        Command::Import(part, path) => {
            format!("toile {} import {}", part_of(part), shown(path))
        }
        Command::Remove(part, name) => format!("toile {} rm {}", part_of(part), word(name)),
        Command::ImportStyle(name, given) => style(name, given),
        // Each step of work adds its own command when the seams are saved.
        Command::SaveSeams(..) => return None,
        Command::WriteSeams(path, ..) => format!("# wrote {}", path.display()),
        Command::Comment(of, deed) => comment(of, deed),
        Command::Cancel(jobs) => format!("toile queue cancel{}", numbers(jobs)),
        Command::Retry(jobs) => format!("toile queue retry{}", numbers(jobs)),
        Command::Prioritise(job, step) => format!("# priority of {job} by {step:+}"),
        Command::Pause(study) => format!("toile queue pause {}", word(study)),
        Command::Resume(study) => format!("toile queue resume {}", word(study)),
    })
}

fn fitting(of: &FittingOf) -> String {
    format!(" {} --garment {} --subject {}", word(&of.study), word(&of.garment), word(&of.subject))
}

fn comment(of: &FittingOf, deed: &CommentDeed) -> String {
    let fitting = fitting(of);
    let flag =
        |name: &str, value: Option<&str>| value.map_or_else(String::new, |value| format!(" --{name} {}", word(value)));
    match deed {
        CommentDeed::Add(remark) => {
            let at = format!("{}:{}", remark.side.as_str(), remark.place);
            let action = Some(remark.action.as_str()).filter(|action| !action.is_empty());
            let severity = flag("severity", Some(remark.severity.as_str()));
            format!(
                "toile comment add{fitting} --at {} {}{severity}{}",
                word(&at),
                word(&remark.said),
                flag("action", action)
            )
        }
        CommentDeed::Set(change) => {
            let edit = &change.edit;
            let flags = [
                // Only a round meets a comment.
                flag("status", edit.status.filter(|status| *status != State::Met).map(State::as_str)),
                flag("severity", edit.severity.map(Severity::as_str)),
                flag("text", edit.said.as_deref()),
                flag("action", edit.action.as_deref()),
                flag("owner", edit.owner.as_deref()),
            ];
            format!("toile comment set{fitting} {}{}", change.number, flags.concat())
        }
        CommentDeed::Sign(by) => format!("toile comment sign{fitting}{}", flag("by", Some(by))),
    }
}

fn numbers(jobs: &[JobId]) -> String {
    jobs.iter().map(|job| format!(" {job}")).collect()
}

fn style(name: &str, given: &StyleGiven) -> String {
    let is_study = |path: &Path| path.extension().is_some_and(|ending| ending == "toml");
    if let [(None, path)] = given.patterns.as_slice()
        && is_study(path)
    {
        return format!("toile style import {}", shown(path));
    }
    let mut text = format!("toile style add {}", word(name));
    for (size, path) in &given.patterns {
        let path = path.to_string_lossy();
        let pattern = size.as_ref().map_or_else(|| path.to_string(), |size| format!("{size}={path}"));
        text += &format!(" --pattern {}", word(&pattern));
    }
    if let Some(seams) = &given.seams {
        text += &format!(" --seams {}", shown(seams));
    } else if given.is_proposed {
        text += " --propose";
    }
    text += &given.unit.as_ref().map_or_else(String::new, |unit| format!(" --unit {}", word(unit)));
    text
}

fn new_study(new: &NewStudy) -> String {
    let mut text = format!("toile study new {}", shown(&new.folder.join(&new.name)));
    new.subjects.iter().for_each(|subject| text += &format!(" --subject {}", word(subject)));
    for size in &new.sizes {
        text += &format!(" --wear {}", word(&format!("{}/{}", size.style, size.size)));
    }
    new.outfits.iter().for_each(|outfit| text += &format!(" --outfit {}", word(&outfit.to_string())));
    new.simulators.iter().for_each(|simulator| text += &format!(" --sim {}", simulator.as_str()));
    new.fit.iter().for_each(|fit| text += &format!(" --fit {}", fit.as_str()));
    text + &format!(" --fabric {}", word(&new.fabric))
}

/// Command for a step of work on the seams of a size, `STYLE/SIZE`.
pub fn sewn(size: &str, step: &SeamStep) -> String {
    let told = |words: &[&str]| words.iter().map(|told| format!(" {}", word(told))).collect::<String>();
    let words = match step {
        SeamStep::Written(_) => return format!("# the seams of {size} were written by hand"),
        SeamStep::Edit(SeamEdit::Add { a, b, name, is_eased }) => {
            let name = name.as_ref().map_or_else(String::new, |name| format!(" --name {}", word(name)));
            told(&["add", a, b]) + &name + if *is_eased { " --eased" } else { "" }
        }
        SeamStep::Edit(SeamEdit::Remove { a, b }) => told(&["rm", a, b]),
        SeamStep::Edit(SeamEdit::Flip { a, b }) => told(&["flip", a, b]),
        SeamStep::Edit(SeamEdit::Open { edge }) => told(&["open", edge]),
        SeamStep::Edit(SeamEdit::LeaveOut { piece }) => told(&["leave-out", piece]),
        SeamStep::Edit(SeamEdit::TakeIn { drawn, is_pair }) => {
            told(&["take-in", drawn]) + if *is_pair { " --pair" } else { "" }
        }
        SeamStep::Edit(SeamEdit::Role { piece, role }) => told(&["role", piece, role]),
        SeamStep::Confirm(seam) => told(&["confirm", seam]),
        SeamStep::ConfirmSure => told(&["confirm"]),
        SeamStep::Answer { question, choice } => {
            let letter = u8::try_from(*choice).map_or('?', |choice| (b'a' + choice.min(25)) as char);
            told(&["answer", question, &letter.to_string()])
        }
        SeamStep::Decide(question) => told(&["settle", question]),
        SeamStep::Propose(_) => told(&["propose"]),
    };
    format!("toile style sew {}{words}", word(size))
}

//! `toile job handout|run|merge`: jobs as files, for any scheduler.

use std::path::PathBuf;

use super::args::Job;
use super::context::Context;
use super::run::selection;
use super::{End, Outcome, output};
use engine::{handout, run_job};

pub fn run(context: &Context, command: &Job) -> Outcome {
    match command {
        Job::Handout { study, output, part } => {
            output::folder(output, &["json"])?;
            let mut store = context.store()?;
            let study = context.study(&store, study)?;
            let handed = handout::hand_out(&mut store, &study, &selection(part), output)?;
            let files: Vec<&PathBuf> = handed.iter().filter_map(|handed| handed.file.as_ref()).collect();
            output::text(&files.iter().map(|file| format!("{}\n", file.display())).collect::<String>())?;
            context.say(format_args!("{}: {} jobs, {} handed out", study.name, handed.len(), files.len()));
        }
        Job::Run { file, output, database } => {
            output.as_deref().map(|path| output::kind(path, &[("json", ())])).transpose()?;
            let ran = run_job(file, output.as_deref(), database.as_deref())?;
            output::text(&format!("{}\n", ran.file.display()))?;
            if let Some(error) = ran.error {
                output::tell(&error);
                return Ok(End::JobFailed);
            }
        }
        Job::Merge { results } => {
            let merged = handout::merge(&mut context.store()?, results)?;
            context.say(format_args!(
                "{} results stored, {} failed elsewhere, {} were here, {} are being made here",
                merged.stored.len(),
                merged.failed.len(),
                merged.known.len(),
                merged.running.len()
            ));
        }
    }
    Ok(End::Done)
}

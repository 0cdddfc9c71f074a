//! `toile pattern sew`: a picture of the sewn garment, updated while its seam file is edited.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use signal_hook::consts::SIGINT;

use super::args::{BodyFile, SewFiles};
use super::body::sex_of;
use super::context::Context;
use super::{CliError, End, Outcome, output};
use results::preview::{Care, Hung, Mannequin};
use sim::Fabric;
use spec::patterns::Unit;
use store::StudyError;
use wardrobe::seams::{self, Workpiece};

const LOOK: Duration = Duration::from_millis(100);

/// Sews once, or whenever the seam file changes.
pub fn run(context: &Context, arguments: &SewFiles) -> Outcome {
    output::kind(&arguments.output, &[("png", ())])?;
    let is_left = Arc::new(AtomicBool::new(false));
    if arguments.watch {
        signal_hook::flag::register(SIGINT, is_left.clone())?;
    }
    let seams = seam_file(context, arguments)?;
    let BodyFile { body, body_unit, sex } = &arguments.body;
    let (mannequin, notes) = Mannequin::read(body, body_unit.map(Into::into), sex.map(sex_of))?;
    notes.iter().for_each(|note| context.say(note));
    let cloth = engine::fabric_named(&arguments.fabric)?;
    loop {
        let before = stamp(seams.as_deref());
        let is_stale = || is_left.load(Ordering::Relaxed) || stamp(seams.as_deref()) != before;
        let end = match sewn(context, arguments, seams.as_deref(), &mannequin, &cloth, &is_stale) {
            Err(CliError::Study(StudyError::Interrupted)) => End::Done,
            Err(error) if !arguments.watch => return Err(error),
            Err(error) => {
                output::tell(&error.to_string());
                End::CheckFailed
            }
            Ok(end) => end,
        };
        if !arguments.watch {
            return Ok(end);
        }
        while stamp(seams.as_deref()) == before {
            if is_left.load(Ordering::Relaxed) {
                return Ok(end);
            }
            std::thread::sleep(LOOK);
        }
    }
}

/// Path of the seam file, which is proposed where there is none; `None` for a pattern that holds its seams.
fn seam_file(context: &Context, arguments: &SewFiles) -> Result<Option<PathBuf>, CliError> {
    let cut = &arguments.cut;
    let piece = Workpiece::open(&arguments.file, None, cut.size.as_deref(), cut.unit.map(Unit::from))?;
    if piece.pattern.holds_seams() {
        return Ok(None);
    }
    let beside = arguments.file.with_extension("seams.toml");
    let path = arguments.seams.clone().unwrap_or(beside);
    if !path.exists() {
        let proposed = seams::propose(&arguments.file, &cut.asking(&[]))?;
        if proposed.proposal.is_empty() {
            let told = format!("{}: no piece was recognised; give its seam file", arguments.file.display());
            return Err(CliError::Usage(told));
        }
        let name = arguments.file.file_stem().unwrap_or_default().to_string_lossy();
        let text = proposed.proposal.toml(&name).into_bytes();
        context.write(&path, text)?;
    }
    Ok(Some(path))
}

/// Bytes of the seam file, to tell if it has changed.
fn stamp(seams: Option<&Path>) -> Option<Vec<u8>> {
    std::fs::read(seams?).ok()
}

/// Sews the garment once: writes the picture, prints the outcome and the open questions.
fn sewn(
    context: &Context,
    arguments: &SewFiles,
    seams: Option<&Path>,
    mannequin: &Mannequin,
    cloth: &Fabric,
    is_stale: &dyn Fn() -> bool,
) -> Outcome {
    let started = Instant::now();
    let cut = &arguments.cut;
    let piece = Workpiece::open(&arguments.file, seams, cut.size.as_deref(), cut.unit.map(Unit::from))?;
    let preview = mannequin.dressed_in(&piece, cloth, Care::Glance, is_stale)?;
    let took_ms = started.elapsed().as_millis();
    context.write(&arguments.output, preview.sheet()?)?;
    let hung = match preview.hung {
        Hung::Draped => "sewn and draped coarsely",
        Hung::Undone => "not sewn up",
        Hung::Not => "not placed",
    };
    output::text(&format!("{hung} on {} in {took_ms} ms: {}\n", mannequin.name, arguments.output.display()))?;
    preview.remarks.iter().try_for_each(|remark| output::text(&format!("{remark}\n")))?;
    let undecided = piece.laid_out()?.undecided;
    let (sure, unsure): (Vec<_>, Vec<_>) = undecided.iter().partition(|question| question.is_sure);
    for (index, question) in unsure.iter().enumerate() {
        output::text(&format!("{}. {}\n", index + 1, question.text))?;
        for choice in &question.choices {
            output::text(&format!("   {}\n", choice.label))?;
        }
    }
    if !sure.is_empty() {
        context.say(format_args!("{} proposed seams are sure: `toile pattern seam confirm` takes them", sure.len()));
    }
    Ok(if preview.hung == Hung::Draped { End::Done } else { End::CheckFailed })
}

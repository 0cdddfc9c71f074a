//! Errors of the engine: inputs that it cannot use, and processes that failed.

use std::path::PathBuf;
use std::process::ExitStatus;

use pattern::propose::Unwearable;
use store::{Origin, StudyError};

#[derive(Debug, thiserror::Error)]
pub(crate) enum EngineError {
    #[error("--repeat is for --sim fem: only that starts from a place that can be varied")]
    RepeatWithoutFem,
    #[error("--reach is for one garment and --sim fem: friction carries it along")]
    ReachWithoutFem,
    #[error("--repeat is for one garment; accepted of an outfit: one drape")]
    RepeatOfOutfit,
    #[error("Hybrid-GS drapes one garment at a time; FEM-GS (fem) drapes outfits")]
    HybridOutfit,
    #[error(
        "{}: {reason}; say --seams FILE (`toile pattern propose -o FILE` writes one to edit)",
        pattern.display()
    )]
    Unwearable { pattern: PathBuf, reason: Unwearable },
    #[error(
        "{garment}: sizes `{earlier}` and `{size}` on {subject} have the same inputs, a fault of Toile; nothing is queued"
    )]
    SameInputs { garment: String, earlier: String, size: String, subject: String },
    #[error("no mesh")]
    NoMesh,
    #[error("nothing to measure")]
    NothingToMeasure,
    /// A mesh whose number of measurements differs from that of the pattern.
    #[error(
        "{meshed} measurements on the mesh, {flat} in the flat pattern: the mesh is not that of this pattern and size, a \
         fault of Toile; nothing is stored"
    )]
    OtherCount { meshed: usize, flat: usize },
    #[error(
        "`{meshed}` is {meshed_mm:.2} mm on the mesh, `{flat}` {flat_mm:.2} mm in the flat pattern: the mesh is not that of \
         this pattern and size, a fault of Toile; nothing is stored"
    )]
    OtherLength { meshed: String, meshed_mm: f64, flat: String, flat_mm: f64 },
    #[error("no pose to go to")]
    NoPose,
    #[error("{}: this is no {kind} file: {reason}", file.display())]
    OtherFile { kind: Origin, file: PathBuf, reason: serde_json::Error },
    #[error("{}: format {found}; accepted: {accepted}", file.display())]
    Format { kind: Origin, file: PathBuf, found: u32, accepted: u32 },
    #[error("{}: {reason}", file.display())]
    Content { kind: Origin, file: PathBuf, reason: serde_json::Error },
    /// A result file whose job changed after it was written.
    #[error("{}: its inputs are not those it was made from", file.display())]
    OtherInputs { file: PathBuf },
    #[error(
        "{}: this database has no such job: {garment} {size} on {subject} of study {study}; was it made by another version \
         of the program?",
        file.display()
    )]
    UnknownJob { file: PathBuf, study: String, garment: String, size: String, subject: String },
    #[error("memory_limit_mb = {megabytes}: {reason}")]
    MemoryLimit { megabytes: u32, reason: rustix::io::Errno },
    #[error("took longer than its time limit of {limit_s} s")]
    OutOfTime { limit_s: f64 },
    #[error("needed more than its memory limit of {megabytes} MB")]
    OutOfMemory { megabytes: u32 },
    /// A process that ended without a result.
    #[error("its process ended with {status}: {last_line}")]
    ProcessEnded { status: ExitStatus, last_line: String },
    #[error("{0}")]
    Panic(String),
    /// A result that the database schema refuses.
    #[error("the result cannot be stored: {0}")]
    Unstorable(rusqlite::Error),
    #[error("{program}: {message}")]
    SlurmProgram { program: &'static str, message: String },
    /// Arrays of which Slurm no longer knows anything.
    #[error(
        "{why}; arrays {arrays} were submitted, and neither squeue, sacct nor scontrol says what became of them; \
         start again to go on waiting, nothing is submitted twice"
    )]
    SlurmSilent { why: String, arrays: String },
    /// A job that Slurm ended without a result at every try.
    #[error("{} was submitted {tries} times and has no result; {why}", file.display())]
    SlurmGaveUp { file: PathBuf, tries: u32, why: String },
}

impl EngineError {
    fn origin(&self) -> Origin {
        match self {
            Self::RepeatWithoutFem | Self::ReachWithoutFem | Self::RepeatOfOutfit | Self::HybridOutfit => Origin::Sim,
            Self::Unwearable { .. } => Origin::Pattern,
            Self::SameInputs { .. } => Origin::Queue,
            Self::NoMesh => Origin::Mesh,
            Self::NothingToMeasure | Self::OtherCount { .. } | Self::OtherLength { .. } => Origin::Measure,
            Self::NoPose => Origin::Body,
            Self::OtherFile { kind, .. } | Self::Format { kind, .. } | Self::Content { kind, .. } => *kind,
            Self::OtherInputs { .. } | Self::UnknownJob { .. } => Origin::Merge,
            Self::MemoryLimit { .. } | Self::OutOfTime { .. } | Self::OutOfMemory { .. } => Origin::Limit,
            Self::ProcessEnded { .. } => Origin::Job,
            Self::Panic(_) => Origin::Panic,
            Self::Unstorable(_) => Origin::Store,
            Self::SlurmProgram { .. } | Self::SlurmSilent { .. } | Self::SlurmGaveUp { .. } => Origin::Slurm,
        }
    }
}

impl From<EngineError> for StudyError {
    fn from(error: EngineError) -> Self {
        Self::refused(error.origin(), error)
    }
}

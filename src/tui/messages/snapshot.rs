//! What the screens show of the database at one moment.

use engine::Why;
use results::GarmentWorn;
use sim::Step;
use spec::Inputs;
use store::{ChiRow, EaseRow, Grid, JobId, JobRow, LogLine, MetricsRow, RecommendationRow, StageRow, StudyRow};
use wardrobe::{FabricRow, SizeRow, SubjectRow};

/// What the user looks at; whatever is `None` or gone is chosen when it is read.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Focus {
    /// Name of the study.
    pub study: Option<String>,
    /// Name of the garment within the study.
    pub garment: Option<String>,
    /// Job whose details are wanted.
    pub job: Option<JobId>,
    /// Jobs to compare.
    pub compare: Vec<JobId>,
    /// Subject on whom it is told how the garment sits.
    pub wearer: Option<String>,
}

/// Everything the screens show of the database at one moment.
#[derive(Clone, Debug)]
pub struct Snapshot {
    /// When it was read, ms since 1970 (UTC).
    pub now_ms: i64,
    /// The subjects of the catalogue, by name.
    pub subjects: Vec<SubjectRow>,
    /// The fabrics of the catalogue, by name.
    pub fabrics: Vec<FabricRow>,
    /// The sizes of the styles of the catalogue.
    pub sizes: Vec<SizeRow>,
    /// All studies of the database, by name.
    pub studies: Vec<StudyRow>,
    /// The study looked at, an index into `studies`.
    pub study: usize,
    /// The garment looked at as a grid.
    pub grid: Option<Grid>,
    /// All current jobs of the study.
    pub jobs: Vec<JobRow>,
    /// Ease of all sizes on all subjects of the study.
    pub ease: Vec<EaseRow>,
    /// The job looked at.
    pub detail: Option<Detail>,
    /// The jobs compared, those that are gone left out.
    pub compared: Vec<Compared>,
    /// Which simulator the study's garments are to be trusted to; read for comparisons only.
    pub recommendations: Vec<RecommendationRow>,
    /// How the garment sits on the wearer.
    pub worn: Option<GarmentWorn>,
}

impl Snapshot {
    /// The study looked at; `None` where the database has none.
    #[must_use]
    pub fn study(&self) -> Option<&StudyRow> {
        self.studies.get(self.study)
    }

    /// A job by its number.
    #[must_use]
    pub fn job(&self, id: JobId) -> Option<&JobRow> {
        self.jobs.iter().find(|job| job.id == id)
    }
}

/// What is stored of one job.
#[derive(Clone, Debug)]
pub struct Detail {
    /// Number of the job.
    pub job: JobId,
    /// Measurements of all stages.
    pub chi: Vec<ChiRow>,
    /// Numbers of its result.
    pub metrics: Option<MetricsRow>,
    /// Steps of its simulation.
    pub history: Vec<Step>,
    /// Its log, oldest line first.
    pub log: Vec<LogLine>,
    /// Why the cache did not have it.
    pub why: Why,
    /// Where its inputs came from.
    pub stages: Vec<StageRow>,
}

/// A run as it is compared.
#[derive(Clone, Debug)]
pub struct Compared {
    /// The job as lists show it.
    pub job: JobRow,
    /// Measurements of all stages.
    pub chi: Vec<ChiRow>,
    /// Numbers of its result.
    pub metrics: Option<MetricsRow>,
    /// What it was made of.
    pub inputs: Inputs,
}

//! Contents of the database at one moment, as far as the screens show them.

use engine::Why;
use results::GarmentWorn;
use sim::Step;
use spec::Inputs;
use store::{
    Cell, ChiRow, EaseRow, FitCell, Grid, JobId, JobRow, LogLine, MetricsRow, RecommendationRow, StageRow, StudyRow,
};
use wardrobe::{FabricRow, SizeRow, SubjectRow};

/// The study, garment and jobs that the user looks at. Those that are `None` or gone are chosen when the database is read.
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
    /// Subject on whom the fit of the garment is shown.
    pub wearer: Option<String>,
}

/// Place of a cell in the grid: indices of size, simulator and subject.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Place {
    /// Row of the size, from 0.
    pub size: usize,
    /// Index among the simulators that have jobs.
    pub simulator: usize,
    /// Column of the subject, from 0.
    pub subject: usize,
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
    /// Recommended simulators of the study's garments; read for comparisons only.
    pub recommendations: Vec<RecommendationRow>,
    /// Fit of the garment on the wearer.
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

    /// The grid looked at; `None` where it has no size or no subject.
    #[must_use]
    pub fn grid(&self) -> Option<&Grid> {
        self.grid.as_ref().filter(|grid| !grid.sizes.is_empty() && !grid.subjects.is_empty())
    }

    /// The cell at a place of the grid.
    #[must_use]
    pub fn cell_at(&self, place: Place) -> Option<&Cell> {
        self.grid()?.cells.get(place.size)?.get(place.subject)?.get(place.simulator)
    }

    /// The fit at a place of the grid.
    #[must_use]
    pub fn fit_at(&self, place: Place) -> Option<FitCell> {
        *self.grid()?.fits.get(place.size)?.get(place.subject)?
    }

    /// The place of a job in the grid, where it is of its garment.
    #[must_use]
    pub fn place_of(&self, id: JobId) -> Option<Place> {
        let grid = self.grid()?;
        let job = self.job(id).filter(|job| job.garment == grid.garment)?;
        Some(Place {
            size: grid.sizes.iter().position(|size| *size == job.size)?,
            simulator: grid.simulators.iter().position(|simulator| *simulator == job.simulator)?,
            subject: grid.subjects.iter().position(|subject| *subject == job.subject)?,
        })
    }

    /// The ease that decides the fit of a job.
    #[must_use]
    pub fn ease_of(&self, job: &JobRow) -> Option<&EaseRow> {
        let is_of_job =
            |ease: &&EaseRow| ease.garment == job.garment && ease.size == job.size && ease.subject == job.subject;
        self.ease.iter().filter(is_of_job).find(|ease| ease.decides)
    }

    /// The job of the same size and subject by the other simulator.
    #[must_use]
    pub fn same_by_other(&self, job: &JobRow) -> Option<&JobRow> {
        let is_other = |other: &&JobRow| {
            other.garment == job.garment
                && other.size == job.size
                && other.subject == job.subject
                && other.repeat == job.repeat
                && other.simulator != job.simulator
        };
        self.jobs.iter().find(is_other)
    }
}

/// Stored results, steps and log of one job.
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
    /// Stages of the job, each from the cache or made.
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
    /// Inputs that it was made of.
    pub inputs: Inputs,
}

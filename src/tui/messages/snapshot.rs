//! Data of the database at one moment, for all screens.

use std::collections::BTreeMap;

use engine::Why;
use results::GarmentWorn;
use sim::Step;
use spec::Inputs;
use store::comments::{Comment, Round};
use store::owner::Runner;
use store::{
    Cell, ChiRow, EaseRow, FitCell, Grid, JobId, JobRow, LogLine, MetricsRow, OutfitRow, RecommendationRow, StageRow,
    StudyRow,
};
use wardrobe::{FabricRow, SizeRow, SubjectRow};

/// Study, garment and jobs that screens show. Where one is `None` or gone, reading the database chooses one.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Focus {
    pub study: Option<String>,
    pub garment: Option<String>,
    pub job: Option<JobId>,
    pub compare: Vec<JobId>,
    /// Subject on whom the fit of the garment is shown.
    pub wearer: Option<String>,
}

/// Place of a cell in the grid: indices of size, simulator and subject.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Place {
    pub size: usize,
    /// Index among the simulators that have jobs.
    pub simulator: usize,
    pub subject: usize,
}

/// Everything the screens show of the database at one moment.
#[derive(Clone, Debug)]
pub struct Snapshot {
    /// Time of the reading, since 1970 (UTC).
    pub now_ms: i64,
    /// Offset of the machine's local time from UTC at that time.
    pub offset_ms: i64,
    /// The subjects of the catalogue, by name.
    pub subjects: Vec<SubjectRow>,
    /// The fabrics of the catalogue, by name.
    pub fabrics: Vec<FabricRow>,
    pub sizes: Vec<SizeRow>,
    pub outfits: Vec<OutfitRow>,
    /// All studies of the database, by name.
    pub studies: Vec<StudyRow>,
    /// Index of the shown study in `studies`.
    pub study: usize,
    pub runners: Vec<Runner>,
    /// Fabric of each garment of the shown study, by name.
    pub cloths: BTreeMap<String, String>,
    /// Shown garment; `None` without a study.
    pub grid: Option<Grid>,
    pub jobs: Vec<JobRow>,
    pub ease: Vec<EaseRow>,
    pub detail: Option<Detail>,
    /// Jobs that are compared, without those that are gone.
    pub compared: Vec<Compared>,
    /// Recommended simulators for the study's garments; only read for comparisons.
    pub recommendations: Vec<RecommendationRow>,
    /// Fit of the garment on the wearer; `None` where there is none to show.
    pub worn: Option<GarmentWorn>,
    /// Comments of the study's fittings, by garment, subject and number.
    pub comments: Vec<Comment>,
    /// Last round of each of these fittings.
    pub rounds: Vec<Round>,
}

impl Snapshot {
    /// Returns `None` for a database without studies.
    pub fn study(&self) -> Option<&StudyRow> {
        self.studies.get(self.study)
    }

    pub fn job(&self, id: JobId) -> Option<&JobRow> {
        self.jobs.iter().find(|job| job.id == id)
    }

    /// Leaves out jobs that are gone.
    pub fn jobs_of<'i>(&self, ids: impl Iterator<Item = &'i JobId>) -> Vec<&JobRow> {
        ids.filter_map(|id| self.job(*id)).collect()
    }

    /// Returns `None` where the grid has no size or no subject.
    pub fn grid(&self) -> Option<&Grid> {
        self.grid.as_ref().filter(|grid| !grid.sizes.is_empty() && !grid.subjects.is_empty())
    }

    pub fn cell_at(&self, place: Place) -> Option<&Cell> {
        self.grid()?.cells.get(place.size)?.get(place.subject)?.get(place.simulator)
    }

    /// Returns `None` where the ease is not known.
    pub fn fit_at(&self, place: Place) -> Option<FitCell> {
        *self.grid()?.fits.get(place.size)?.get(place.subject)?
    }

    /// Returns `None` for a job of another garment.
    pub fn place_of(&self, id: JobId) -> Option<Place> {
        let grid = self.grid()?;
        let job = self.job(id).filter(|job| job.garment == grid.garment)?;
        Some(Place {
            size: grid.sizes.iter().position(|size| *size == job.size)?,
            simulator: grid.simulators.iter().position(|simulator| *simulator == job.simulator)?,
            subject: grid.subjects.iter().position(|subject| *subject == job.subject)?,
        })
    }

    /// Ease that decides the fit of a job.
    pub fn ease_of(&self, job: &JobRow) -> Option<&EaseRow> {
        let is_of_job =
            |ease: &&EaseRow| ease.garment == job.garment && ease.size == job.size && ease.subject == job.subject;
        self.ease.iter().filter(is_of_job).find(|ease| ease.decides)
    }

    /// Job of the same size and subject by the other simulator.
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

#[derive(Clone, Debug)]
pub struct Detail {
    pub job: JobId,
    /// Measurements of all stages.
    pub chi: Vec<ChiRow>,
    /// Metrics; `None` without a result.
    pub metrics: Option<MetricsRow>,
    pub history: Vec<Step>,
    /// Log, the oldest line first.
    pub log: Vec<LogLine>,
    pub why: Why,
    /// Stages of the job, each made or from the cache.
    pub stages: Vec<StageRow>,
}

#[derive(Clone, Debug)]
pub struct Compared {
    pub job: JobRow,
    /// Measurements of all stages.
    pub chi: Vec<ChiRow>,
    /// Metrics; `None` without a result.
    pub metrics: Option<MetricsRow>,
    pub inputs: Inputs,
}

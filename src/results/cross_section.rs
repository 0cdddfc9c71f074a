//! Cross sections of stored results: the body with the cloth of several sizes.

use serde::Serialize;

use crate::picture;
use body::Body;
use engine::stages::Model;
use fit::on_body::{Angle, DIRECTIONS, Section, Site, sites};
use geom::V2;
use geom::section::Outline;
use geom::units::{from_mm, mm};
use report::Chart;
use report::chart::{Worn, section_chart};
use store::{InOrigin, JobId, JobRow, Origin, Result, StageKind, Store, StudyError, read};

#[derive(Clone, Debug, PartialEq)]
pub enum CutAt {
    /// At all levels that the garment covers.
    Levels,
    Level(String),
    /// Height above the floor; below the crotch the right leg is cut.
    HeightMm(f64),
}

/// A line of a section. Coordinates are mm from the axis of trunk or limb, towards the subject's right and to the
/// front.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CutLine {
    /// Points in mm; a closed line does not repeat the first.
    pub points: Vec<[f64; 2]>,
    pub closed: bool,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CutCloth {
    pub job: i64,
    pub size: String,
    /// `fem` or `hybrid`.
    pub simulator: String,
    pub lines: Vec<CutLine>,
    /// Directions, degrees from the front towards the subject's right, with the gap from the skin, mm: below 0 inside
    /// the body, `None` without cloth.
    pub gaps: Vec<(f64, Option<f64>)>,
}

impl CutCloth {
    /// Least, mean and greatest gap; `None` where no direction has cloth.
    pub fn gap_mm(&self) -> Option<[f64; 3]> {
        let known: Vec<f64> = self.gaps.iter().filter_map(|(_, gap)| *gap).collect();
        let mean = known.iter().sum::<f64>() / known.len() as f64;
        let least = known.iter().copied().reduce(f64::min)?;
        let greatest = known.iter().copied().reduce(f64::max)?;
        Some([least, mean, greatest])
    }
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CrossSection {
    /// Level, or height in words.
    pub level: String,
    /// Height above the floor.
    pub height_mm: f64,
    /// Middle of the outline of trunk or limb, from which directions are counted, mm.
    pub centre: [f64; 2],
    pub skin: CutLine,
    pub others: Vec<CutLine>,
    pub cloth: Vec<CutCloth>,
}

pub(crate) struct LevelCuts {
    pub level: String,
    pub cuts: Vec<(JobRow, Section)>,
}

/// Cuts results on one body. Leaves out levels that none of them covers.
pub(crate) fn cuts(store: &Store, jobs: &[JobId], at: &CutAt) -> Result<Vec<LevelCuts>> {
    let Some(first) = jobs.first() else { return Ok(Vec::new()) };
    let subject = read::job(store, *first)?.subject;
    let Model { body } = picture::product(store, *first, StageKind::Body)?;
    let wanted = wanted(&body, at)?;
    let mut found: Vec<LevelCuts> = Vec::new();
    for job in jobs {
        let row = read::job(store, *job)?;
        if row.subject != subject {
            let problem = format!(
                "job {} is on {}, job {first} on {subject}; accepted: results on one subject",
                row.id, row.subject
            );
            return Err(StudyError::Refused { what: "section", name: at.words(), problems: vec![problem] });
        }
        let cloth = picture::dressed(store, *job)?.sewn()?.mesh;
        for site in &wanted {
            let Some(section) = Section::cut(site.clone(), &body.mesh, &cloth) else { continue };
            match found.iter_mut().find(|known| known.level == site.level) {
                Some(known) => known.cuts.push((row.clone(), section)),
                None => found.push(LevelCuts { level: site.level.clone(), cuts: vec![(row.clone(), section)] }),
            }
        }
    }
    if found.is_empty() {
        return Err(refused(at, &body));
    }
    if *at == CutAt::Levels {
        found.retain(|level| level.cuts.iter().any(|(_, section)| !section.cloth.is_empty()));
    }
    Ok(found)
}

pub fn sections(store: &Store, jobs: &[JobId], at: &CutAt) -> Result<Vec<CrossSection>> {
    Ok(cuts(store, jobs, at)?.iter().filter_map(plain).collect())
}

/// Draws a chart for each level, with the gaps of the size `written` beside the section.
pub fn drawn(store: &Store, jobs: &[JobId], at: &CutAt, written: Option<&str>) -> Result<Vec<(String, Chart)>> {
    let cuts = cuts(store, jobs, at)?;
    let chart = |level: &LevelCuts| {
        let mut sizes: Vec<Worn<'_>> = Vec::new();
        for (job, section) in &level.cuts {
            let label = format!("{}, {}", job.size, job.simulator.as_str());
            sizes.push(Worn { label, is_written: written == Some(job.size.as_str()), section });
        }
        let (job, section) = level.cuts.first()?;
        let height_mm = mm(section.site.height_m());
        let level_name = level.level.replace('_', " ");
        let title = format!("{} on {}: {level_name}, {height_mm:.0} mm above the floor", job.garment, job.subject);
        Some(section_chart(&title, &sizes).map(|chart| (level.level.clone(), chart)).origin(Origin::Report))
    };
    cuts.iter().filter_map(chart).collect()
}

fn plain(level: &LevelCuts) -> Option<CrossSection> {
    let (_, first) = level.cuts.first()?;
    let cloth = |(job, section): &(JobRow, Section)| CutCloth {
        job: job.id.0,
        size: job.size.clone(),
        simulator: job.simulator.as_str().to_owned(),
        lines: section.cloth.iter().map(line).collect(),
        gaps: section.gaps(DIRECTIONS).into_iter().map(|Angle { deg, gap_m, .. }| (deg, gap_m.map(mm))).collect(),
    };
    Some(CrossSection {
        level: level.level.clone(),
        height_mm: mm(first.site.height_m()),
        centre: place(&first.centre),
        skin: line(&first.skin),
        others: first.others.iter().map(line).collect(),
        cloth: level.cuts.iter().map(cloth).collect(),
    })
}

impl CutAt {
    fn words(&self) -> String {
        match self {
            Self::Levels => "levels".to_owned(),
            Self::Level(level) => level.clone(),
            Self::HeightMm(height_mm) => format!("{height_mm:.0} mm"),
        }
    }
}

fn wanted(body: &Body, at: &CutAt) -> Result<Vec<Site>> {
    match at {
        CutAt::Levels => Ok(sites(body)),
        CutAt::HeightMm(height_mm) => Ok(vec![Site::at(&at.words(), body, from_mm(*height_mm))]),
        CutAt::Level(level) => {
            let mut known = sites(body);
            match known.iter().position(|site| site.level == *level) {
                Some(at) => Ok(vec![known.swap_remove(at)]),
                None => {
                    let known = known.into_iter().map(|site| site.level).collect();
                    Err(StudyError::NotFound { what: "level", name: level.clone(), known })
                }
            }
        }
    }
}

fn refused(at: &CutAt, body: &Body) -> StudyError {
    let top_mm = body.mesh.bounds().map_or(0.0, |(_, high)| mm(high.z));
    let problems = vec![format!("no body there; accepted: heights from 0 to {top_mm:.0} mm")];
    StudyError::Refused { what: "section", name: at.words(), problems }
}

fn line(outline: &Outline) -> CutLine {
    CutLine { points: outline.points.iter().map(place).collect(), closed: outline.closed }
}

fn place(point: &V2) -> [f64; 2] {
    [mm(point.x), mm(point.y)]
}

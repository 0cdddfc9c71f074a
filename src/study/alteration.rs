//! What to change of a pattern so that a size fits somebody: the least change of its handles, and the changed pattern.

use std::collections::BTreeMap;

use serde::Serialize;

use crate::error::{Result, StudyError};
use crate::files::SourceFile;
use crate::patterns;
use crate::run::ease;
use crate::run::pipeline::{self, Fitting, Meshes};
use crate::spec::file::Study;
use crate::spec::versions::FIELD_SPACING_M;
use crate::spec::{self, JobSpec};
use body::Body;
use fit::alter::{Goal, least_change};
use fit::{Simulator, target::Target};
use geom::DistanceField;
use geom::units::{from_mm, mm};
use pattern::dxf::{self, Standard};
use pattern::{Handle, Style, handle};
use sim::Silent;

/// By how much a handle is moved to see what it changes, m.
const STEP_M: f64 = 0.002;
/// How often the change is corrected by what it really does, and its squares weighed anew.
const ROUNDS: usize = 12;
/// Amount below which a handle is as dear as one that does not move, m.
const SMALL_M: f64 = 0.2e-3;
/// Shares of the greatest amount that are tried in turn, where handles cannot move so far.
const LIMITS: [f64; 5] = [1.0, 0.7, 0.5, 0.35, 0.25];
/// Amounts are given in steps of this, as a pattern maker draws them, mm.
const DRAWN_MM: f64 = 0.5;
/// How far inside a band a level is aimed, so that drawn amounts keep it there, m.
const INSIDE_M: f64 = 0.002;

/// What is asked.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Wish {
    /// Garment; needed where the study has several.
    pub garment: Option<String>,
    /// Who is to wear it; needed where the study has several.
    pub subject: Option<String>,
    /// Size that is changed.
    pub size: String,
    /// Least and greatest ease of levels that are not to have that of the intended fit, mm.
    pub targets_mm: BTreeMap<String, [f64; 2]>,
    /// Greatest amount of a handle either way, mm.
    pub limit_mm: f64,
    /// Handles that stay.
    pub without: Vec<Handle>,
    /// Handles with their amounts, mm: then nothing else is changed.
    pub moves_mm: Vec<(Handle, f64)>,
    /// Whether the changed pattern is draped.
    pub is_draped: bool,
}

/// A handle that moves.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MovedHandle {
    /// Its name.
    pub handle: &'static str,
    /// By how much, mm.
    pub amount_mm: f64,
    /// What a positive amount does.
    pub does: &'static str,
}

/// A level before and after.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct AlteredLevel {
    /// Level.
    pub level: String,
    /// Least and greatest ease that is meant, mm.
    pub target_mm: Option<[f64; 2]>,
    /// Ease before, mm.
    pub before_mm: f64,
    /// Ease that the change promises, mm.
    pub promised_mm: f64,
    /// Ease of the pattern as it is written and read again, mm.
    pub achieved_mm: f64,
}

impl AlteredLevel {
    /// Whether what is achieved lies within what is meant.
    #[must_use]
    pub fn is_met(&self) -> bool {
        self.target_mm.is_none_or(|[least, most]| (least - 0.5..=most + 0.5).contains(&self.achieved_mm))
    }
}

/// The changed pattern on the body.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Redraped {
    /// Whether it came to rest.
    pub converged: bool,
    /// Error indicator of its measurements.
    pub ei: f64,
    /// Deepest penetration into the body, mm.
    pub penetration_max_mm: f64,
    /// Hem in front less behind, mm.
    pub hem_front_over_back_mm: Option<f64>,
    /// Greatest pressure, kPa.
    pub most_kpa: Option<f64>,
}

/// A change of a pattern.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Alteration {
    /// Garment.
    pub garment: String,
    /// Subject.
    pub subject: String,
    /// Size that is changed.
    pub size: String,
    /// The handles that move.
    pub moves: Vec<MovedHandle>,
    /// Its levels.
    pub levels: Vec<AlteredLevel>,
    /// Handles that cannot be moved here, and why.
    pub left_out: Vec<String>,
    /// The changed pattern on the body, where that is asked.
    pub drape: Option<Redraped>,
    /// The changed pattern, its seam file, and a sheet of old and new outlines, by file name.
    #[serde(skip)]
    pub files: Vec<(String, Vec<u8>)>,
}

/// Finds the least change that gives every level the ease that is meant, or applies the one that is asked for.
///
/// # Errors
/// [`StudyError::NotFound`] for a garment, subject or size that the study does not have; what body or pattern refuse; a pattern that holds
/// its own seams, which cannot be written again; a handle that cannot move so far.
pub fn alter(study: &Study, wish: &Wish) -> Result<Alteration> {
    let (spec, target) = asked(study, wish)?;
    let seams = spec.seams.as_ref().ok_or_else(|| {
        let message = format!("{}: holds its own seams; accepted: DXF with a seam file", spec.pattern.name);
        StudyError::stage("alter")(message)
    })?;
    let body = pipeline::body(&spec)?;
    let unit = spec.unit.as_deref().and_then(patterns::unit_of);
    let style = pipeline::style(&spec)?;
    let bench = Bench { style: &style, body: &body, target: &target, wish };
    let (moves, left_out) = if wish.moves_mm.is_empty() {
        bench.found()?
    } else {
        (wish.moves_mm.iter().map(|(handle, amount_mm)| (*handle, from_mm(*amount_mm))).collect(), Vec::new())
    };
    let changed = style.moved(&moves).map_err(StudyError::stage("alter"))?;
    let drawn = patterns::pieces(&spec.pattern, Some(&spec.size), unit)?;
    let pieces = handle::redrawn(&drawn, &seams.bytes, &seams.name, &moves).map_err(StudyError::stage("alter"))?;
    let texts = [("Style Name".to_owned(), spec.garment.clone()), ("Units".to_owned(), "METRIC".to_owned())];
    let written = dxf::write_pieces(&pieces, &texts, Standard::Aama);
    let name = format!("{}-{}-{}", spec.garment, spec.size, spec.subject);
    let file = SourceFile { name: format!("{name}.dxf"), bytes: written.into() };
    let again = patterns::read_style(&file, Some(seams), None, None)?;
    let moved = |(handle, amount_m): &(Handle, f64)| MovedHandle {
        handle: handle.as_str(),
        amount_mm: mm(*amount_m),
        does: handle.definition(),
    };
    Ok(Alteration {
        garment: spec.garment.clone(),
        subject: spec.subject.clone(),
        size: spec.size.clone(),
        moves: moves.iter().map(moved).collect(),
        levels: bench.levels(&changed, &again),
        left_out,
        drape: wish.is_draped.then(|| draped(&spec, &again, &body)).transpose()?,
        files: vec![
            (file.name.clone(), file.bytes.to_vec()),
            (format!("{name}.seams.toml"), seams.bytes.to_vec()),
            (format!("{name}.svg"), pattern::drawing::changed_svg(&style, &changed).into_bytes()),
        ],
    })
}

/// The job of what is asked, and the ease that its garment is to have.
fn asked(study: &Study, wish: &Wish) -> Result<(JobSpec, Target)> {
    let jobs = spec::jobs(study);
    let garments: Vec<String> = study.garments.iter().map(|garment| garment.name.clone()).collect();
    let garment = one("garment", wish.garment.as_deref(), garments)?;
    let of_garment = || jobs.iter().filter(|job| job.garment == garment);
    let subject = one("subject", wish.subject.as_deref(), of_garment().map(|job| job.subject.clone()).collect())?;
    let size = one("size", Some(&wish.size), of_garment().map(|job| job.size.clone()).collect())?;
    let found = of_garment().find(|job| job.subject == subject && job.size == size).cloned();
    let entry = study.garments.iter().find(|entry| entry.name == garment);
    let target = entry.map_or_else(Target::default, |entry| entry.target.clone());
    let missing =
        || StudyError::NotFound { what: "job", name: format!("{garment} {size} on {subject}"), known: vec![] };
    Ok((found.ok_or_else(missing)?, target))
}

/// The name that is asked for among those known, whatever its case; the only one where none is asked for.
pub(crate) fn one(what: &'static str, asked: Option<&str>, mut known: Vec<String>) -> Result<String> {
    let mut seen = std::collections::BTreeSet::new();
    known.retain(|name| seen.insert(name.clone()));
    let found = match asked {
        Some(asked) => known.iter().find(|name| name.eq_ignore_ascii_case(asked)).cloned(),
        None if known.len() == 1 => known.first().cloned(),
        None => None,
    };
    found.ok_or_else(|| StudyError::NotFound { what, name: asked.unwrap_or_default().to_owned(), known })
}

/// A style on a body with what is meant.
struct Bench<'a> {
    style: &'a Style,
    body: &'a Body,
    target: &'a Target,
    wish: &'a Wish,
}

/// Handles with their amounts, m, and those that cannot be moved.
type Found = (Vec<(Handle, f64)>, Vec<String>);
/// What a handle changes of every level, m per m.
type Sensitivity = BTreeMap<String, f64>;

impl Bench<'_> {
    /// Ease at every level of a style, m.
    fn eases(&self, style: &Style) -> BTreeMap<String, f64> {
        ease::on(style, self.body).into_iter().map(|ease| (ease.level.clone(), ease.ease_m())).collect()
    }

    /// Least and greatest ease at a level, m.
    fn band_m(&self, level: &str, eases: &BTreeMap<String, f64>) -> Option<[f64; 2]> {
        let is_top = ["chest", "bust"].iter().any(|chest| eases.contains_key(*chest));
        let own = self.wish.targets_mm.get(level).map(|band| band.map(from_mm));
        own.or_else(|| self.target.band_m(level, is_top))
    }

    /// The least change of handles that brings every level into its band. Where a handle cannot move as far as it would, all get
    /// tighter limits.
    fn found(&self) -> Result<Found> {
        let (handles, changes, left_out) = self.sensitivities();
        let mut refused = None;
        for share in LIMITS {
            match self.within(&handles, &changes, share * from_mm(self.wish.limit_mm)) {
                Ok(moves) => return Ok((moves, left_out)),
                Err(error) => refused = Some(error),
            }
        }
        refused.map_or(Ok((Vec::new(), left_out)), Err)
    }

    /// The least change within a limit of every handle, m.
    fn within(&self, handles: &[Handle], changes: &[Sensitivity], limit_m: f64) -> Result<Vec<(Handle, f64)>> {
        let before = self.eases(self.style);
        let limits = vec![[-limit_m, limit_m]; handles.len()];
        let mut amounts: Vec<f64> = vec![0.0; handles.len()];
        for _ in 0..ROUNDS {
            let now = self.eases(&self.moved(handles, &amounts)?);
            let goal = |(level, ease_m): (&String, &f64)| {
                let [least, most] = self.band_m(level, &before)?;
                let inside = INSIDE_M.min(0.25 * (most - least));
                let sensitivity: Vec<f64> =
                    changes.iter().map(|change| change.get(level).copied().unwrap_or(0.0)).collect();
                let done: f64 = sensitivity.iter().zip(&amounts).map(|(s, amount)| s * amount).sum();
                Some(Goal { value: ease_m - done, sensitivity, band: [least + inside, most - inside] })
            };
            let goals: Vec<Goal> = now.iter().filter_map(goal).collect();
            // The least sum of amounts, by squares that weigh as the amounts before: few handles move.
            let scale: Vec<f64> = amounts.iter().map(|amount| (amount.abs() + SMALL_M).sqrt()).collect();
            amounts = least_change(&goals, &limits, &scale).amounts;
        }
        let drawn: Vec<f64> = amounts.iter().map(|m| from_mm((mm(*m) / DRAWN_MM).round() * DRAWN_MM)).collect();
        self.moved(handles, &drawn)?;
        Ok(handles.iter().copied().zip(drawn).filter(|(_, amount_m)| *amount_m != 0.0).collect())
    }

    /// The style with handles moved by their amounts, m.
    fn moved(&self, handles: &[Handle], amounts: &[f64]) -> Result<Style> {
        let all = handles.iter().copied().zip(amounts.iter().copied());
        let moves: Vec<(Handle, f64)> = all.filter(|(_, amount_m)| amount_m.abs() > 1e-6).collect();
        self.style.moved(&moves).map_err(StudyError::stage("alter"))
    }

    /// The handles that can be moved, what each changes of every level (m per m), and what cannot be moved.
    fn sensitivities(&self) -> (Vec<Handle>, Vec<Sensitivity>, Vec<String>) {
        let (mut handles, mut changes, mut left_out) = (Vec::new(), Vec::new(), Vec::new());
        for handle in self.style.handles().into_iter().filter(|handle| !self.wish.without.contains(handle)) {
            let moved = |by_m: f64| self.style.moved(&[(handle, by_m)]).map(|style| self.eases(&style));
            match (moved(STEP_M), moved(-STEP_M)) {
                (Ok(more), Ok(less)) => {
                    let change = |(level, more_m): (&String, &f64)| {
                        Some((level.clone(), (more_m - less.get(level)?) / (2.0 * STEP_M)))
                    };
                    changes.push(more.iter().filter_map(change).collect());
                    handles.push(handle);
                }
                (Err(error), _) | (_, Err(error)) => left_out.push(error.to_string()),
            }
        }
        (handles, changes, left_out)
    }

    /// Every level before, as promised, and as achieved by the pattern that is written.
    fn levels(&self, changed: &Style, again: &Style) -> Vec<AlteredLevel> {
        let (before, promised, achieved) = (self.eases(self.style), self.eases(changed), self.eases(again));
        let level = |(level, before_m): (&String, &f64)| {
            Some(AlteredLevel {
                level: level.clone(),
                target_mm: self.band_m(level, &before).map(|band| band.map(mm)),
                before_mm: mm(*before_m),
                promised_mm: mm(*promised.get(level)?),
                achieved_mm: mm(*achieved.get(level)?),
            })
        };
        before.iter().filter_map(level).collect()
    }
}

/// The changed pattern, draped by FEM-GS as its study drapes it.
fn draped(spec: &JobSpec, style: &Style, body: &Body) -> Result<Redraped> {
    let field = DistanceField::build(&body.mesh, FIELD_SPACING_M).map_err(StudyError::stage("field"))?;
    let meshes = Meshes::of(style, spec.edge_length_m)?;
    let fitting = Fitting {
        body,
        field: &field,
        style,
        meshes: &meshes,
        fabric: &spec.fabric,
        simulator: Simulator::Fem,
        parameters: &spec.parameters,
    };
    let outcome = fitting.outcome(&fitting.simulate(&mut Silent)?)?;
    let hem = outcome.worn.hang.hem.and_then(|hem| Some(mm(hem.front_m? - hem.back_m?)));
    Ok(Redraped {
        converged: outcome.converged,
        ei: outcome.metrics.ei,
        penetration_max_mm: mm(outcome.penetration_max_m),
        hem_front_over_back_mm: hem,
        most_kpa: outcome.worn.pressing.iter().map(|one| one.most_kpa).reduce(f64::max),
    })
}

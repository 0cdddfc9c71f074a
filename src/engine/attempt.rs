//! A garment, or an outfit, on one body, without a study: `toile try`.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

use serde::Serialize;

use crate::error::EngineError;
use crate::faults::{Fault, FaultKind, drape_faults};
use crate::layers::Ensemble;
use crate::outcome::{Measured, Outcome};
use crate::reach::{Moved, Reached, moved};
use crate::stages::{Garb, Meshes};
use crate::tight::TooSmall;
use body::{Body, Pose};
use fit::measure::{self, Metrics};
use fit::{Ease, Simulator};
use geom::units::mm;
use geom::{DistanceField, TriMesh, V3};
use pattern::{Garment, MeasurementKind, Spot, Style};
use render::export::{MeshFormat, Part};
use render::{self, Camera, Frame, Material, Rgb, Scene};
use report::FileNames;
use sim::dressing::Wearer;
use sim::hybrid::Closure;
use sim::{self, Drape, Fabric, Monitor, Progress, quality};
use spec::Parameters;
use spec::bodies::{LengthUnit, Sex, pose_body};
use spec::file::{read_body, read_fabric};
use spec::patterns::{self, Unit};
use spec::versions::FIELD_SPACING_M;
use store::files::SourceFile;
use store::{InOrigin, Origin, Result, StudyError};
use wardrobe::seams::{self, Question};

/// Size of each picture, pixels.
const PICTURE: [u32; 2] = [480, 800];

/// Trial of one or more garments on one body.
#[derive(Clone, Debug, PartialEq)]
pub struct Attempt {
    /// Mesh (OBJ, PLY, STL, GLB) or measurements (TOML, SeamlyMe, Valentina, GarmentCode).
    pub body: PathBuf,
    /// Unit of the mesh, where its height does not tell.
    pub body_unit: Option<LengthUnit>,
    pub sex: Option<Sex>,
    /// Inner garments first.
    pub layers: Vec<AttemptLayer>,
    /// Unit of the patterns, where their files name none.
    pub unit: Option<Unit>,
    /// Allowance of pieces without a sew line, where there is no seam file.
    pub allowance_m: f64,
    /// Numbers of the questions of a proposal of seams, with the letters of the answers.
    pub answers: Vec<(usize, char)>,
    pub simulator: Simulator,
    /// Edge length of the finest mesh.
    pub edge_length_m: f64,
    /// Number of simulations by FEM-GS. All but the first vary the start slightly.
    pub repeat: u32,
    /// `None` for the pose in which the body is built or scanned.
    pub pose: Option<Pose>,
    /// Pose into which FEM-GS then carries the drape of a single garment.
    pub reach: Option<Pose>,
}

#[derive(Clone, Debug, PartialEq)]
pub struct AttemptLayer {
    /// DXF file, folder of DXF files, or GarmentCode specification.
    pub pattern: PathBuf,
    /// Without a seam file a DXF pattern is sewn as proposed.
    pub seams: Option<PathBuf>,
    /// Name of the size, where the pattern has several.
    pub size: Option<String>,
    /// Fabric of the program, or TOML file with one.
    pub fabric: String,
}

/// Columns are those of `v_chi`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TriedChi {
    pub stage: sim::Stage,
    pub measurement_no: u32,
    pub measurement: String,
    pub kind: MeasurementKind,
    pub is_free_edge: bool,
    pub is_controlled: bool,
    pub l2d_mm: f64,
    pub l3d_mm: f64,
    pub chi: f64,
    /// Greatest minus least chi of the repeated simulations.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub chi_spread: Option<f64>,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TriedEase {
    pub level: String,
    pub pattern_girth_mm: f64,
    pub body_girth_mm: f64,
    pub ease_mm: f64,
}

/// Columns are those of `v_gap`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TriedGap {
    pub level: String,
    pub height_mm: f64,
    pub body_girth_mm: f64,
    pub garment_girth_mm: f64,
    pub shortfall_mm: f64,
}

/// Summary of chi. Columns are those of `v_metrics`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TriedErrors {
    pub n: usize,
    pub e_chi: f64,
    pub sd_chi: f64,
    pub ei: f64,
    pub max_abs_error: f64,
}

/// Columns are those of `v_metrics`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TriedCloth {
    pub vertices: usize,
    pub faces: usize,
    pub iterations: u32,
    pub residual: f64,
    pub converged: bool,
    pub penetration_max_mm: f64,
    pub seam_gap_max_mm: f64,
    pub self_crossings: usize,
    /// FEM-GS: principal stretch less 1 that 1 % of the cloth exceeds.
    pub distortion: Option<f64>,
}

/// Columns are those of `v_metrics`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Tried {
    pub garment: String,
    pub size: String,
    pub subject: String,
    pub simulator: String,
    pub fabric: String,
    #[serde(flatten)]
    pub errors: TriedErrors,
    #[serde(flatten)]
    pub cloth: TriedCloth,
    pub wall_ms: u64,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub chi_spread_max: Option<f64>,
    pub chi: Vec<TriedChi>,
    pub ease: Vec<TriedEase>,
    /// Empty for FEM-GS.
    pub gap: Vec<TriedGap>,
    /// Changes caused by the movement into the pose `reach`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reach: Option<Reached>,
    /// Faults of the drape.
    pub problems: Vec<String>,
    /// Guesses that were made about the inputs.
    pub notes: Vec<String>,
    /// Pictures and meshes, by file name.
    #[serde(skip)]
    pub files: Vec<(String, Vec<u8>)>,
}

/// Dresses a body in garments, the inmost first. `progress` receives the phase and the share done. The last result
/// holds the files of all. A drape with faults is no error.
pub fn attempt(asked: &Attempt, progress: &mut dyn FnMut(&str, f64)) -> Result<Vec<Tried>> {
    let started = Instant::now();
    check(asked)?;
    let read = asked.layers.iter().map(|layer| garb(asked, layer)).collect::<Result<Vec<_>>>()?;
    let (garbs, notes): (Vec<Garb>, Vec<Vec<String>>) = read.into_iter().unzip();
    let (upright, guessed) = read_body(&asked.body, asked.body_unit, asked.sex)?;
    let body = asked.pose.map_or_else(|| Ok(upright.clone()), |pose| pose_body(&upright, pose))?;
    let field = DistanceField::build(&body.mesh, FIELD_SPACING_M).origin(Origin::Field)?;
    let parameters = Parameters::default();
    let wearer = Wearer { body: &body, field: &field };
    let ensemble = Ensemble { wearer, garbs: &garbs, simulator: asked.simulator, parameters: &parameters };
    let mut told = Told(progress);
    let drapes = ensemble.dress(&mut told)?;
    let mut all = Vec::new();
    for (number, (garb, notes)) in garbs.iter().zip(notes).enumerate() {
        let outcome = ensemble.outcome(number, &drapes)?;
        let notes = guessed.iter().cloned().chain(notes).chain(outcome.warnings.iter().cloned()).collect();
        let mut tried = Tried::new(asked, garb, outcome);
        tried.problems.splice(0..0, problems(&body, garb.meshes.finest()?, &drapes[number]));
        tried.notes = notes;
        all.push(tried);
    }
    if let ([garb], [tried]) = (&garbs[..], &mut all[..])
        && asked.repeat > 1
    {
        let again = |seed: u32| {
            let mut parameters = Parameters::default();
            parameters.set("fem.seed", seed.into()).origin(Origin::Sim)?;
            Ensemble { parameters: &parameters, ..ensemble }.dress(&mut told)
        };
        let drapes = (1..asked.repeat).map(again).collect::<Result<Vec<_>>>()?;
        spread(tried, garb.meshes.finest()?, &drapes.concat());
    }
    if let Some(last) = all.last_mut() {
        last.files = files("drape", asked.simulator, &Dressed { body: &body, garbs: &garbs, drapes: &drapes })?;
    }
    if let (Some(to), [garb], [tried]) = (asked.reach, &garbs[..], &mut all[..]) {
        let from = asked.pose.unwrap_or_default();
        let Moved { reached, body, drape } = moved(&upright, [from, to], garb, &drapes[0], &mut told)?;
        tried.problems.extend(reached.problems.iter().cloned());
        let dressed = Dressed { body: &body, garbs: &garbs, drapes: &[drape] };
        tried.files.extend(files("reach", asked.simulator, &dressed)?);
        tried.reach = Some(reached);
    }
    for tried in &mut all {
        tried.wall_ms = u64::try_from(started.elapsed().as_millis()).unwrap_or(u64::MAX);
    }
    Ok(all)
}

/// Refuses options that do not go together.
fn check(asked: &Attempt) -> Result<()> {
    let (is_fem, is_outfit) = (asked.simulator == Simulator::Fem, asked.layers.len() > 1);
    if asked.repeat > 1 && !is_fem {
        return Err(EngineError::RepeatWithoutFem.into());
    }
    if asked.reach.is_some() && (!is_fem || is_outfit) {
        return Err(EngineError::ReachWithoutFem.into());
    }
    if is_outfit && asked.repeat > 1 {
        return Err(EngineError::RepeatOfOutfit.into());
    }
    Ok(())
}

/// Returns notes on the guesses made about the garment too.
fn garb(asked: &Attempt, layer: &AttemptLayer) -> Result<(Garb, Vec<String>)> {
    let mut notes = Vec::new();
    let fabric = fabric(&layer.fabric)?;
    let style = style(asked, layer, &mut notes)?;
    let meshes = Arc::new(Meshes::of(&style, asked.edge_length_m)?);
    Ok((Garb { style, meshes, fabric }, notes))
}

impl Tried {
    /// Problems, notes and files are still empty.
    fn new(asked: &Attempt, Garb { style, fabric, .. }: &Garb, outcome: Outcome) -> Self {
        let Metrics { n, e_chi, sd_chi, ei, max_abs_error } = outcome.metrics;
        let gap: Vec<TriedGap> = outcome.closures.iter().map(TriedGap::of).collect();
        let problems = outcome.too_small.iter().map(TooSmall::to_string);
        Self {
            garment: style.name.clone(),
            size: style.size.clone(),
            subject: asked.body.file_stem().unwrap_or_default().to_string_lossy().into_owned(),
            simulator: asked.simulator.as_str().to_owned(),
            fabric: fabric.name.clone(),
            errors: TriedErrors { n, e_chi, sd_chi, ei, max_abs_error },
            cloth: TriedCloth {
                vertices: outcome.vertices,
                faces: outcome.faces,
                iterations: outcome.iterations,
                residual: outcome.residual,
                converged: outcome.converged,
                penetration_max_mm: mm(outcome.penetration_max_m),
                seam_gap_max_mm: mm(outcome.seam_gap_max_m),
                self_crossings: outcome.self_crossings,
                distortion: outcome.distortion,
            },
            wall_ms: 0,
            chi_spread_max: None,
            problems: problems.collect(),
            chi: outcome.measured.into_iter().map(TriedChi::of).collect(),
            ease: outcome.eases.into_iter().map(TriedEase::of).collect(),
            gap,
            reach: None,
            notes: Vec::new(),
            files: Vec::new(),
        }
    }
}

impl TriedChi {
    fn of(measured: Measured) -> Self {
        let Measured { stage, name, kind, is_free_edge, is_controlled, chi } = measured;
        Self {
            stage,
            measurement_no: chi.no,
            measurement: name,
            kind,
            is_free_edge,
            is_controlled,
            l2d_mm: mm(chi.l2d_m),
            l3d_mm: mm(chi.l3d_m),
            chi: chi.chi(),
            chi_spread: None,
        }
    }
}

impl TriedEase {
    fn of(ease: Ease) -> Self {
        Self {
            pattern_girth_mm: mm(ease.pattern_girth_m),
            body_girth_mm: mm(ease.body_girth_m),
            ease_mm: mm(ease.ease_m()),
            level: ease.level,
        }
    }
}

impl TriedGap {
    fn of(closure: &Closure) -> Self {
        Self {
            level: closure.level.clone(),
            height_mm: mm(closure.height_m),
            body_girth_mm: mm(closure.body_girth_m),
            garment_girth_mm: mm(closure.garment_girth_m),
            shortfall_mm: mm(closure.shortfall_m()),
        }
    }
}

/// Adds the range of each chi over repeated simulations, and a problem for each simulation that did not come to rest.
fn spread(tried: &mut Tried, garment: &Garment, drapes: &[Drape]) {
    let others: Vec<_> = drapes.iter().map(|drape| measure::measure(garment, &drape.positions)).collect();
    let last = tried.chi.last().map(|row| row.stage);
    for (index, row) in tried.chi.iter_mut().filter(|row| Some(row.stage) == last).enumerate() {
        let all = others.iter().map(|chis| chis[index].chi());
        let (low, high) = all.fold((row.chi, row.chi), |(low, high), chi| (low.min(chi), high.max(chi)));
        row.chi_spread = Some(high - low);
    }
    tried.chi_spread_max = tried.chi.iter().filter_map(|row| row.chi_spread).reduce(f64::max);
    for (index, drape) in drapes.iter().enumerate().filter(|(_, drape)| !drape.converged) {
        tried.problems.push(format!("repetition {} did not converge: residual {:.4}", index + 2, drape.residual));
    }
}

struct Told<'a>(&'a mut dyn FnMut(&str, f64));

impl Monitor for Told<'_> {
    fn progress(&mut self, progress: &Progress) {
        (self.0)(progress.phase, progress.fraction);
    }
}

/// Fabric of the program by its name, or from a TOML file.
pub fn fabric(name: &str) -> Result<Fabric> {
    let path = Path::new(name);
    if path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("toml")) {
        return read_fabric(path);
    }
    let library = sim::fabric::library();
    let known = library.iter().map(|fabric| fabric.name.clone()).collect();
    let missing = || StudyError::NotFound { what: "fabric", name: name.to_owned(), known };
    library.into_iter().find(|fabric| fabric.name == name).ok_or_else(missing)
}

/// Sewn by its seam file, by its own stitches, or as proposed where the proposal is sure.
fn style(asked: &Attempt, layer: &AttemptLayer, notes: &mut Vec<String>) -> Result<Style> {
    let size = layer.size.as_deref();
    if layer.seams.is_some() || SourceFile::read_pattern(&layer.pattern)?.holds_seams() {
        return patterns::style(&layer.pattern, layer.seams.as_deref(), size, asked.unit);
    }
    let pattern = SourceFile::read_pattern(&layer.pattern)?;
    let (unit, allowance_m) = (asked.unit, asked.allowance_m);
    let how = seams::Asking { size, unit, allowance_m, answers: &asked.answers };
    let seams::ProposalOnPieces { proposal, pieces } = seams::proposal(&pattern, &how)?;
    let unwearable = |reason| EngineError::Unwearable { pattern: layer.pattern.clone(), reason };
    let proposal = proposal.to_drape().map_err(unwearable)?;
    notes.push("sewn as proposed: no seam file was given".to_owned());
    notes.extend(proposal.questions.iter().map(Question::to_string).chain(proposal.notes.iter().cloned()));
    let name = layer.pattern.file_stem().unwrap_or_default().to_string_lossy();
    let text = proposal.toml(&name);
    let mut style = Style::read(&pieces, text.as_bytes(), "the proposal").origin(Origin::Pattern)?;
    if style.measurements.is_empty() {
        style.measure_openings_and_seams();
    }
    Ok(style)
}

/// Names the piece on which a fault is worst: numbers alone do not tell the place.
fn problems(body: &Body, garment: &Garment, drape: &Drape) -> Vec<String> {
    let Drape { converged, residual, penetration_max_m, self_crossings, .. } = *drape;
    let faults = drape_faults(converged, residual, mm(penetration_max_m), self_crossings as i64);
    let with_spot = |fault: Fault| {
        let spot: Option<Spot> = match fault.kind {
            FaultKind::Moves => None,
            FaultKind::Inside => quality::deepest_spot(body, garment, &drape.positions),
            FaultKind::Crosses => quality::crossed_spot(garment, &drape.positions),
        };
        fault.words + &spot.map_or_else(String::new, |spot| format!(", in {spot}"))
    };
    faults.into_iter().map(with_spot).collect()
}

struct Dressed<'a> {
    body: &'a Body,
    garbs: &'a [Garb],
    drapes: &'a [Drape],
}

/// One picture of four views for each stage, and meshes of body and garments. The names of the last stage's files begin
/// with `stem`.
fn files(stem: &str, simulator: Simulator, dressed: &Dressed<'_>) -> Result<Vec<(String, Vec<u8>)>> {
    let Dressed { body, garbs, drapes } = *dressed;
    let garments = garbs.iter().map(|garb| garb.meshes.finest()).collect::<Result<Vec<&Garment>>>()?;
    let mesh = |garment: &Garment, positions: &[V3]| TriMesh {
        positions: positions.to_vec(),
        triangles: garment.triangles.clone(),
    };
    let cloths: Vec<TriMesh> =
        garments.iter().zip(drapes).map(|(garment, drape)| mesh(garment, &drape.positions)).collect();
    let materials: Vec<Material> = (0..cloths.len()).map(|number| material(simulator, number)).collect();
    let mut files = vec![(format!("{stem}.png"), four_views(body, &cloths, &materials)?)];
    let mut names = FileNames::default();
    for (garment, drape) in garments.iter().zip(drapes) {
        if let Some(popup) = drape.earlier.iter().find(|staged| staged.stage == sim::Stage::Popup) {
            let picture = four_views(body, &[mesh(garment, &popup.positions)], &[Material::popup()])?;
            files.push((format!("{}.png", names.part("popup")), picture));
        }
    }
    let colours = |mesh: &TriMesh, colour: Rgb| vec![colour; mesh.positions.len()];
    let names: Vec<String> = match garments.len() {
        1 => vec!["garment".to_owned()],
        count => (1..=count).map(|number| format!("layer_{number}")).collect(),
    };
    let part = |name, mesh, colour, places| Part { name, mesh, colours: colours(mesh, colour), places, values: None };
    let mut parts = vec![part("body", &body.mesh, Material::form().front, None)];
    for (number, garment) in garments.iter().enumerate() {
        parts.push(part(&names[number], &cloths[number], materials[number].front, Some(&garment.rest[..])));
    }
    files.push((format!("{stem}.glb"), MeshFormat::Glb.write(&parts)));
    files.push((format!("{stem}.obj"), MeshFormat::Obj.write(&parts)));
    Ok(files)
}

/// Simulator's usual material for the inmost layer, another colour for each other one.
fn material(simulator: Simulator, number: usize) -> Material {
    match (number, simulator) {
        (0, Simulator::Fem) => Material::fem(),
        (0, Simulator::Hybrid) => Material::hybrid(),
        (1, _) => Material::hybrid(),
        _ => Material::popup(),
    }
}

/// Returns a PNG file.
fn four_views(body: &Body, cloths: &[TriMesh], materials: &[Material]) -> Result<Vec<u8>> {
    let worn = cloths.iter().zip(materials).map(|(cloth, material)| render::Layer::new(cloth, *material));
    let layers = [render::Layer::new(&body.mesh, Material::form())].into_iter().chain(worn).collect();
    let scene = Scene::new(layers).origin(Origin::Render)?;
    let [width, height] = PICTURE;
    let meshes = [&body.mesh].into_iter().chain(cloths);
    let frame = Frame::enclosing(meshes, f64::from(width) / f64::from(height));
    let camera = |view| Camera::new(view, frame);
    render::from_all_sides(&scene, camera, PICTURE).origin(Origin::Render)
}

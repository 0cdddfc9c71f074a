//! Preview of a garment while its seams are edited: sewn and draped coarsely on a body that is kept ready. Colours tell
//! its pieces and seams apart.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::sync::Arc;

use image::RgbaImage;

use crate::figure;
use crate::picture::Look;
use engine::faults::drape_faults;
use engine::stages::{Meshes, Model};
use fit::measure;
use geom::units::mm;
use geom::{DistanceField, TriMesh, V3};
use pattern::check::{Finding, FindingKind};
use pattern::{Garment, Role};
use render::{self, Layer, Material, Rgb, Scene, View};
use sim::fem::{self, Params};
use sim::placement::{Bend, place};
use sim::{Drape, Fabric, Monitor, Progress, SimError};
use spec::bodies::{LengthUnit, Sex};
use spec::file::read_body;
use spec::patterns;
use spec::versions::FIELD_SPACING_M;
use store::{InOrigin, Origin, Result, Store, StudyError, SubjectId};
use wardrobe::seams::workpiece::Workpiece;

/// Edge lengths of the mesh, m: for [`Care::Glance`], then for [`Care::Trial`].
const EDGE_M: f64 = 0.030;
const FINE_EDGE_M: f64 = 0.015;
/// Residual at which a glance ends, and its greatest number of steps after sewing.
const SEEN: f64 = 2.0;
const MOST_STEPS: u32 = 40;
/// For a glance: greatest displacement of a vertex in a step of sewing, m; gap at which seams are welded, m; relative
/// tolerance of a linear solve. They are coarser than the defaults, which halves the time of sewing.
const CLAMP_M: f64 = 0.020;
const WELD_GAP_M: f64 = 0.010;
const TOLERANCE: f64 = 0.2;
/// Size of each view on a sheet, pixels.
const VIEW: [u32; 2] = [480, 640];
/// Half the width of lines: along seams, and along edges in no seam, m.
const SEAM_M: f64 = 0.004;
const FREE_M: f64 = 0.007;

/// Colours of fronts, of backs, and of all other pieces.
const CLOTHS: [Rgb; 3] = [Rgb(0x9c, 0xcf, 0xb5), Rgb(0x58, 0x9a, 0xa8), Rgb(0xd8, 0xc0, 0x8a)];
/// Colours of seams in turn, in the order of the workbench's five colours; then that of edges in no seam.
const SEAMS: [Rgb; 5] =
    [Rgb(0x1f, 0x8a, 0x3c), Rgb(0xa8, 0x3a, 0xa8), Rgb(0x12, 0x9c, 0xac), Rgb(0xb8, 0x4a, 0x2a), Rgb(0x2f, 0x55, 0xc8)];
const FREE: Rgb = Rgb(0xff, 0x20, 0x20);

/// A body kept ready to be dressed again and again.
pub struct Mannequin {
    pub name: String,
    model: Arc<Model>,
    field: DistanceField,
}

impl Mannequin {
    /// Reads measurements or a mesh. `unit` and `sex` are used where the file does not tell them. Returns notes on
    /// guesses too.
    pub fn read(file: &Path, unit: Option<LengthUnit>, sex: Option<Sex>) -> Result<(Self, Vec<String>)> {
        let (body, notes) = read_body(file, unit, sex)?;
        let name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        Ok((Self::new(name, Arc::new(Model { body }))?, notes))
    }

    fn new(name: String, model: Arc<Model>) -> Result<Self> {
        let field = DistanceField::build(&model.body.mesh, FIELD_SPACING_M).origin(Origin::Field)?;
        Ok(Self { name, model, field })
    }
}

pub fn mannequin(store: &Store, id: SubjectId) -> Result<Mannequin> {
    let (name, model) = figure::model(store, id)?;
    Mannequin::new(name, model)
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Care {
    /// Coarse and not wholly at rest.
    Glance,
    /// As fine as the default of a study.
    Trial,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Hung {
    Draped,
    /// Sewing or draping failed; the garment is shown as it was then.
    Undone,
    /// Pieces could not be placed round the body.
    Not,
}

pub struct Preview {
    pub hung: Hung,
    /// Reason why the drape is not complete, and remarks.
    pub remarks: Vec<String>,
    shown: Vec<TriMesh>,
    scene: Scene,
}

impl Mannequin {
    /// Sews a size and drapes it. `is_stale` is called between steps; true ends the work with
    /// [`StudyError::Interrupted`]. A garment that cannot be draped is no error.
    pub fn dressed_in(
        &self,
        piece: &Workpiece,
        cloth: &Fabric,
        care: Care,
        is_stale: &dyn Fn() -> bool,
    ) -> Result<Preview> {
        let style = patterns::read_style(&piece.pattern, piece.seams.as_ref(), Some(&piece.size), piece.unit)?;
        let meshes = match care {
            Care::Glance => Meshes(vec![style.mesh(EDGE_M).origin(Origin::Mesh)?]),
            Care::Trial => Meshes::of(&style, FINE_EDGE_M)?,
        };
        let garment = meshes.finest()?;
        let Hanging { hung, positions, mut remarks } = hang(&meshes, self, cloth, care, is_stale)?;
        let free = free_edges(garment, &piece.open_edges());
        if !free.is_empty() {
            remarks.push("red edges are in no seam".to_owned());
        }
        let is_left_out = |finding: &Finding| finding.kind == FindingKind::UnusedPiece;
        let findings = piece.findings(&style)?.into_iter();
        let left_out: Vec<String> = findings.filter(is_left_out).map(|finding| finding.place).collect();
        if !left_out.is_empty() {
            remarks.push(format!("not sewn in: {}", left_out.join(", ")));
        }
        let positions = positions.unwrap_or_default();
        let pieces = if hung == Hung::Not { vec![] } else { layers(garment, &positions, &free) };
        let mut all = vec![Layer::new(&self.model.body.mesh, Material::form())];
        all.extend(pieces.iter().map(|(mesh, material)| Layer::new(mesh, *material)));
        let scene = Scene::new(all).origin(Origin::Render)?;
        let shown = match hung {
            Hung::Not => vec![self.model.body.mesh.clone()],
            _ => vec![TriMesh { positions, triangles: garment.triangles.clone() }],
        };
        Ok(Preview { hung, remarks, shown, scene })
    }
}

impl Preview {
    /// PNG file with the garment from four sides.
    pub fn sheet(&self) -> Result<Vec<u8>> {
        let camera = |view: View| {
            let look = Look { azimuth_deg: view.azimuth_deg() as i32, zoom_pct: 100, rise_pct: 0 };
            look.camera(&self.shown, VIEW[0], VIEW[1])
        };
        render::from_all_sides(&self.scene, camera, VIEW).origin(Origin::Render)
    }

    /// Garment from any side, so that it fills the picture.
    pub fn picture(&self, look: Look, width: u32, height: u32) -> Result<RgbaImage> {
        let camera = look.camera(&self.shown, width, height);
        render::cutout(&self.scene, &camera, width, height).origin(Origin::Render)
    }
}

/// Monitor that ends a simulation once the cloth can be shown.
struct Glance<'a> {
    seen: Option<Vec<V3>>,
    sewn_at: Option<u32>,
    is_enough: bool,
    care: Care,
    is_stale: &'a dyn Fn() -> bool,
}

impl Monitor for Glance<'_> {
    fn progress(&mut self, progress: &Progress) {
        if progress.phase == "sew" || self.care == Care::Trial {
            return;
        }
        let step = progress.step;
        let sewn_at = *self.sewn_at.get_or_insert(step.iteration);
        self.is_enough = step.residual <= SEEN || step.iteration - sewn_at >= MOST_STEPS;
    }

    fn cancelled(&self) -> bool {
        self.is_enough || (self.is_stale)()
    }

    fn tries_again(&self) -> bool {
        self.care == Care::Trial
    }

    fn wants_snapshot(&mut self) -> bool {
        true
    }

    fn snapshot(&mut self, positions: &[V3]) {
        self.seen = Some(positions.to_vec());
    }
}

struct Hanging {
    hung: Hung,
    positions: Option<Vec<V3>>,
    remarks: Vec<String>,
}

fn hang(meshes: &Meshes, on: &Mannequin, cloth: &Fabric, care: Care, is_stale: &dyn Fn() -> bool) -> Result<Hanging> {
    let garment = meshes.finest()?;
    let mut params = Params { distortion_limit: f64::MAX, ..Params::default() };
    if care == Care::Glance {
        (params.sewing.sewing_clamp_m, params.sewing.weld_gap_m) = (CLAMP_M, WELD_GAP_M);
        params.step.linear_tolerance = TOLERANCE;
    }
    let mut glance = Glance { seen: None, sewn_at: None, is_enough: false, care, is_stale };
    let body = &on.model.body;
    let draped = |positions, remarks| Hanging { hung: Hung::Draped, positions, remarks };
    match fem::simulate(body, &on.field, &meshes.0, cloth, &params, &mut glance) {
        Ok(drape) => {
            let remarks = if care == Care::Trial { told(garment, &drape) } else { vec![] };
            Ok(draped(Some(drape.positions), remarks))
        }
        Err(SimError::Cancelled) if glance.is_enough => Ok(draped(glance.seen, vec![])),
        Err(SimError::Cancelled) => Err(StudyError::Interrupted),
        Err(error) => {
            // A coarser mesh, seen earlier, has other vertices.
            let seen = glance.seen.filter(|seen| seen.len() == garment.rest.len());
            let placed = || place(body, garment, &Bend::default()).ok();
            let positions = seen.or_else(placed);
            let hung = if positions.is_some() { Hung::Undone } else { Hung::Not };
            Ok(Hanging { hung, positions, remarks: vec![error.to_string()] })
        }
    }
}

fn told(garment: &Garment, drape: &Drape) -> Vec<String> {
    let crossings = i64::try_from(drape.self_crossings).unwrap_or(i64::MAX);
    let faults = drape_faults(drape.converged, drape.residual, mm(drape.penetration_max_m), crossings);
    let mut told: Vec<String> = faults.into_iter().map(|fault| fault.words).collect();
    if told.is_empty() {
        told.push("at rest".to_owned());
    }
    let metrics = measure::metrics(&measure::measure(garment, &drape.positions));
    told.extend(metrics.map(|metrics| format!("EI {:.4}", metrics.ei)));
    told
}

/// Border edges of triangles that are in no seam and not meant to be open.
fn free_edges(garment: &Garment, open: &[String]) -> Vec<[usize; 2]> {
    let mut held: BTreeSet<[usize; 2]> = BTreeSet::new();
    let mut hold = |[a, b]: [usize; 2]| held.insert([a.min(b), a.max(b)]);
    for side in garment.seams.iter().flat_map(|seam| seam.stitches().flatten().collect::<Vec<_>>()) {
        hold(side);
    }
    for piece in &garment.pieces {
        let is_open = |name: &String| open.iter().any(|edge| *edge == format!("{}.{name}", piece.id));
        for (_, line) in piece.edges.iter().filter(|(name, _)| is_open(name)) {
            for side in line.windows(2) {
                hold([side[0], side[1]]);
            }
        }
    }
    let mut faces: BTreeMap<[usize; 2], usize> = BTreeMap::new();
    for [a, b, c] in &garment.triangles {
        for [p, q] in [[a, b], [b, c], [c, a]] {
            *faces.entry([*p.min(q), *p.max(q)]).or_default() += 1;
        }
    }
    faces.into_iter().filter(|(side, count)| *count == 1 && !held.contains(side)).map(|(side, _)| side).collect()
}

/// Meshes of cloth, one for each colour of pieces, and lines along seams and free edges.
fn layers(garment: &Garment, positions: &[V3], free: &[[usize; 2]]) -> Vec<(TriMesh, Material)> {
    let mut layers: Vec<(TriMesh, Material)> = Vec::new();
    for (kind, colour) in CLOTHS.into_iter().enumerate() {
        let of_kind = garment.pieces.iter().filter(|piece| cloth_of(piece.role) == kind);
        let triangles: Vec<[usize; 3]> =
            of_kind.flat_map(|piece| garment.triangles[piece.triangles.clone()].to_vec()).collect();
        layers.push((TriMesh { positions: positions.to_vec(), triangles }, Material::cloth(colour)));
    }
    let line = |colour: Rgb| Material { seams: false, ..Material::cloth(colour) };
    for (k, colour) in SEAMS.into_iter().enumerate() {
        let of_colour = garment.seams.iter().skip(k).step_by(SEAMS.len());
        let sides = of_colour.flat_map(|seam| seam.stitches().flatten().collect::<Vec<_>>());
        layers.push((rods(positions, sides, SEAM_M), line(colour)));
    }
    layers.push((rods(positions, free.iter().copied(), FREE_M), line(FREE)));
    layers.retain(|(mesh, _)| !mesh.triangles.is_empty());
    layers
}

/// Index in [`CLOTHS`] of the colour of a piece.
fn cloth_of(role: Role) -> usize {
    use Role::{Back, BodiceBack, BodiceFront, Front, LegBackLeft, LegBackRight, LegFrontLeft, LegFrontRight};
    match role {
        Front | BodiceFront | Role::SkirtFront | LegFrontLeft | LegFrontRight => 0,
        Back | BodiceBack | Role::SkirtBack | LegBackLeft | LegBackRight => 1,
        _ => 2,
    }
}

/// Square rods along edges of triangles; `half_m` is half of their width.
fn rods(positions: &[V3], sides: impl Iterator<Item = [usize; 2]>, half_m: f64) -> TriMesh {
    let mut mesh = TriMesh { positions: vec![], triangles: vec![] };
    for [a, b] in sides.map(|side| side.map(|v| positions[v])) {
        let Some(along) = (b - a).try_normalize(1e-9) else { continue };
        let across = along.cross(&if along.z.abs() < 0.9 { V3::z() } else { V3::x() }).normalize();
        let up = along.cross(&across);
        let first = mesh.positions.len();
        for end in [a, b] {
            for [s, t] in [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]] {
                mesh.positions.push(end + half_m * (s * across + t * up));
            }
        }
        for k in 0..4 {
            let [p, q, r, s] = [k, (k + 1) % 4, 4 + k, 4 + (k + 1) % 4].map(|v| first + v);
            mesh.triangles.extend([[p, q, r], [q, s, r]]);
        }
    }
    mesh
}

//! Pictures of results: stored body and drape, rendered.

mod cloth;
mod maps;
mod order;

pub use cloth::Cloth;
pub use maps::Map;
pub use order::{Order, Shot, Zoom, pictures, turntable};

use std::collections::BTreeMap;
use std::sync::OnceLock;

use image::RgbaImage;

use crate::error::ResultsError;
use body::Levels;
use engine::stages::{Meshes, Model};
use fit::Simulator;
use geom::units::mm;
use geom::{Surface, TriMesh};
use pattern::Garment;
use pattern::garment::Role;
use render::export::{MeshFormat, Part};
use render::{self, Camera, Frame, Layer, Material, Paint, Rgb, Scene, Values, View};
use sim::sewn::Sewn;
use sim::{self, Drape, Fabric};
use store::{InOrigin, JobId, Origin, Result, StageKind, Store, StudyError, Value, cache, read, sql};
use wardrobe::catalogue::read_fabric;

/// Greatest distance in height at which cloth counts as at a level of the body.
const NEAR_M: f64 = 0.02;
/// Depth inside the body to which a gap map shows cloth.
const WITHIN_M: f64 = 0.05;

/// Index of the body's layer in a scene, followed by the cloth and then by the garments under it.
const BODY: usize = 0;
const CLOTH: usize = 1;

/// Number of results kept ready, so that those of a comparison turn quickly.
const SCENES_KEPT: usize = 3;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Look {
    /// Angle about the vertical from the front towards the subject's right.
    pub azimuth_deg: i32,
    /// Enlargement about the picture's middle.
    pub zoom_pct: u32,
    /// Height of the picture's middle above the garment's, in parts of half the garment's height.
    pub rise_pct: i32,
}

impl Look {
    pub(crate) fn camera<'a>(self, meshes: impl IntoIterator<Item = &'a TriMesh>, width: u32, height: u32) -> Camera {
        let Self { azimuth_deg, zoom_pct, rise_pct } = self;
        let frame = Zoom { zoom_pct, rise_pct }.of(Frame::enclosing(meshes, aspect(width, height)));
        Camera { azimuth_deg: f64::from(azimuth_deg), ..Camera::new(View::Front, frame) }
    }
}

/// A result that is ready for pictures: lit once, shown from any side.
struct Stage {
    scene: Scene,
    /// Body and cloth.
    meshes: [TriMesh; 2],
}

pub(crate) struct Dressed {
    simulator: Simulator,
    stage: sim::Stage,
    pub garment: Garment,
    fabric: Fabric,
    /// Heights above the floor, m.
    levels: BTreeMap<&'static str, f64>,
    pub body: TriMesh,
    pub cloth: TriMesh,
    /// Garments beneath; empty unless the garment is a layer of an outfit.
    under: Vec<TriMesh>,
    /// Positions of the garment at earlier stages that the simulator keeps.
    earlier: Vec<sim::Staged>,
    /// Fields of the sewn cloth, which several maps and levels ask for, once it was sewn.
    fields: OnceLock<Fields>,
}

struct Fields {
    stretches_pct: Vec<f64>,
    tensions_n_m: Vec<f64>,
    pressures_kpa: Vec<f64>,
}

impl Fields {
    fn of(sewn: &Sewn<'_>) -> Self {
        Self {
            stretches_pct: sewn.stretches_pct(),
            tensions_n_m: sewn.tensions_n_m(),
            pressures_kpa: sewn.pressures_kpa(),
        }
    }
}

impl Dressed {
    /// `None` where the simulator has no such stage.
    pub fn popup_scene(&self) -> Option<Result<Scene>> {
        let popup = self.earlier.iter().find(|staged| staged.stage == sim::Stage::Popup)?;
        let cloth = TriMesh { positions: popup.positions.clone(), triangles: self.cloth.triangles.clone() };
        let layers = vec![Layer::new(&self.body, Material::form()), Layer::new(&cloth, Material::popup())];
        Some(Scene::new(layers).origin(Origin::Render))
    }

    /// `None` where the simulator keeps no such stage.
    fn at(mut self, stage: sim::Stage) -> Option<Self> {
        if stage != self.stage {
            let place = self.earlier.iter().position(|staged| staged.stage == stage)?;
            self.cloth.positions = self.earlier.swap_remove(place).positions;
            self.stage = stage;
            self.fields = OnceLock::new();
        }
        Some(self)
    }

    /// Material of the cloth: the simulator's colour, but yellow at the stage of pop-up.
    fn material(&self) -> Material {
        match (self.stage, self.simulator) {
            (sim::Stage::Sewn | sim::Stage::Popup, _) => Material::popup(),
            (sim::Stage::Drape, Simulator::Fem) => Material::fem(),
            (sim::Stage::Drape, Simulator::Hybrid) => Material::hybrid(),
        }
    }

    /// Material of the cloth under a map: grey on its wrong side, which shows no values.
    fn material_under(&self, map: Map) -> Material {
        let own = self.material();
        if map.scale().is_some() { Material { back: Rgb(0x6c, 0x70, 0x76), ..own } } else { own }
    }

    /// Cloth welded along its seams.
    pub fn sewn(&self) -> Result<Sewn<'_>> {
        let sewn = Sewn::new(&self.garment, &self.fabric, &self.cloth.positions).origin(Origin::Render)?;
        self.fields.get_or_init(|| Fields::of(&sewn));
        Ok(sewn)
    }

    fn fields(&self) -> Result<&Fields> {
        if let Some(known) = self.fields.get() {
            return Ok(known);
        }
        let sewn = self.sewn()?;
        Ok(self.fields.get_or_init(|| Fields::of(&sewn)))
    }

    /// Values of a map at the vertices of the cloth, in the unit of the map's scale: NaN where a vertex has none. Empty
    /// for a map without values.
    pub fn values(&self, map: Map) -> Result<Vec<f64>> {
        let positions = &self.cloth.positions;
        Ok(match map {
            Map::Plain | Map::Check => vec![],
            Map::Stretch => self.fields()?.stretches_pct.clone(),
            Map::Tension => self.fields()?.tensions_n_m.clone(),
            Map::Chi => maps::chis(&self.garment, positions),
            // Only the drape of FEM-GS is in equilibrium with the body.
            Map::Pressure if (self.simulator, self.stage) != (Simulator::Fem, sim::Stage::Drape) => {
                vec![f64::NAN; positions.len()]
            }
            Map::Pressure => self.fields()?.pressures_kpa.clone(),
            Map::Gap => {
                // The distance field that contact uses ends a few centimetres off the body; a gap may be wider.
                let surface = |mesh| Surface::new(mesh).origin(Origin::Render);
                let skin = surface(&self.body)?;
                let layers = self.under.iter().map(surface).collect::<Result<Vec<_>>>()?;
                let gap_m = |p| {
                    let bare_m = skin.signed_distance(p);
                    layers.iter().fold(bare_m, |least, layer| least.min(layer.nearest_within(p, least.max(0.0)).0))
                };
                positions.iter().map(|p| mm(gap_m(p))).collect()
            }
        })
    }

    /// Lit scene of a map, with the body as a dress form.
    pub fn scene(&self, map: Map) -> Result<Scene> {
        self.scene_in(map, &[], None)
    }

    /// On [`Map::Plain`] the garment is cut from `cloths`, and the body has the colour `skin`.
    fn scene_in(&self, map: Map, cloths: &[Cloth], skin: Option<Rgb>) -> Result<Scene> {
        let (form, paint) = self.look(map, cloths, skin)?;
        let own = [Layer::new(&self.body, form), Layer::new(&self.cloth, self.material_under(map)).painted(paint)];
        let under = self.under.iter().map(|cloth| Layer::new(cloth, Material::under()));
        Scene::new(own.into_iter().chain(under).collect()).origin(Origin::Render)
    }

    /// Shows another map in a scene of this result, without lighting it again.
    pub fn repaint(&self, scene: &mut Scene, map: Map) -> Result<()> {
        let (form, paint) = self.look(map, &[], None)?;
        let painted = scene.paint(BODY, form, Paint::Plain);
        let painted = painted.and_then(|()| scene.paint(CLOTH, self.material_under(map), paint));
        painted.origin(Origin::Render)
    }

    fn look(&self, map: Map, cloths: &[Cloth], skin: Option<Rgb>) -> Result<(Material, Paint)> {
        let values = self.values(map)?;
        let bare = skin.map_or_else(Material::form, Material::skin);
        let cut = |cloths: &[Cloth]| {
            cloth::print(cloths, &self.garment, &self.fabric, self.material().front).map(Paint::Printed)
        };
        Ok(match map.scale() {
            None if map == Map::Check => (bare, cut(&[Cloth::CHECK])?),
            None if !cloths.is_empty() => (bare, cut(cloths)?),
            None => (bare, Paint::Plain),
            Some(scale) => {
                let form = Material::form_under_map();
                // A garment that does not reach round the body lies inside it, and the gap map shows how deep.
                let recede_m = if map == Map::Gap { WITHIN_M } else { form.recede_m };
                (Material { recede_m, ..form }, Paint::Field(Values::Vertices(values), scale))
            }
        })
    }
}

/// Mean tension, N/m, of a result's cloth around the trunk within [`NEAR_M`] of a level of the body; `None` where the
/// level is not known or no cloth lies there.
pub(crate) fn tension_near(worn: &Dressed, level: &str) -> Result<Option<f64>> {
    let Some(height_m) = worn.levels.get(level).copied() else { return Ok(None) };
    let tensions = worn.values(Map::Tension)?;
    let trunk = worn.garment.pieces.iter().filter(|p| !matches!(p.role, Role::SleeveRight | Role::SleeveLeft));
    let near = trunk
        .flat_map(|piece| piece.vertices.clone())
        .filter(|&v| (worn.cloth.positions[v].z - height_m).abs() < NEAR_M);
    let near: Vec<f64> = near.map(|v| tensions[v]).collect();
    Ok((!near.is_empty()).then(|| near.iter().sum::<f64>() / near.len() as f64))
}

fn aspect(width: u32, height: u32) -> f64 {
    f64::from(width.max(1)) / f64::from(height.max(1))
}

/// Results shown last, kept lit so that other views of them are quick.
#[derive(Default)]
pub struct Scenes {
    /// Latest last.
    kept: Vec<Kept>,
}

struct Kept {
    job: JobId,
    map: Map,
    stage: Stage,
}

impl Scenes {
    /// Picture of a result from any side, on transparent ground. The garment fills it, times the enlargement, and the
    /// body is cut off at the edges. Meant for small pictures.
    pub fn look(
        &mut self,
        store: &Store,
        job: JobId,
        look: Look,
        [width, height]: [u32; 2],
        map: Map,
    ) -> Result<RgbaImage> {
        let kept = match self.kept.iter().position(|kept| kept.job == job && kept.map == map) {
            Some(place) => self.kept.remove(place),
            None => Kept { job, map, stage: stage(store, job, map)? },
        };
        if self.kept.len() == SCENES_KEPT {
            self.kept.remove(0);
        }
        let camera = look.camera(&kept.stage.meshes[1..], width, height);
        let picture = render::cutout(&kept.stage.scene, &camera, width, height);
        self.kept.push(kept);
        picture.origin(Origin::Render)
    }
}

/// Writes body and garment of a result as a mesh file. Texture coordinates of the garment are positions in the pattern,
/// m. A map colours it; formats with room for them also have the map's values.
pub fn mesh_file(store: &Store, id: JobId, format: MeshFormat, map: Map) -> Result<Vec<u8>> {
    let dressed = dressed(store, id)?;
    let values = dressed.values(map)?;
    let plain = |mesh: &TriMesh, material: Material| vec![material.front; mesh.positions.len()];
    let scale = map.scale();
    let colours = match &scale {
        Some(scale) => values.iter().map(|value| scale.colour(*value)).collect(),
        None => plain(&dressed.cloth, dressed.material()),
    };
    let label = scale.map(|scale| format!("{}, {}", scale.label, scale.unit));
    let garment = Part {
        name: "garment",
        mesh: &dressed.cloth,
        colours,
        places: Some(&dressed.garment.rest),
        values: label.as_deref().map(|label| (label, values.as_slice())),
    };
    let colours = plain(&dressed.body, Material::form());
    let body = Part { name: "body", mesh: &dressed.body, colours, places: None, values: None };
    Ok(format.write(&[body, garment]))
}

fn stage(store: &Store, id: JobId, map: Map) -> Result<Stage> {
    let dressed = dressed(store, id)?;
    let scene = dressed.scene(map)?;
    Ok(Stage { scene, meshes: [dressed.body, dressed.cloth] })
}

/// Reads a result as draped. Fails with [`StudyError::NotFound`] while there is none, with [`StudyError::Artefact`]
/// when it is no longer stored.
pub(crate) fn dressed(store: &Store, id: JobId) -> Result<Dressed> {
    let job = read::job(store, id)?;
    let model: Model = product(store, id, StageKind::Body)?;
    let Meshes(mut meshes) = product(store, id, StageKind::Mesh)?;
    let drape: Drape = product(store, id, StageKind::Drape)?;
    let fits = |garment: &Garment| garment.rest.len() == drape.positions.len();
    let garment = meshes.pop().filter(fits).ok_or(ResultsError::OtherMesh(id))?;
    let cloth = TriMesh { positions: drape.positions, triangles: garment.triangles.clone() };
    let fabric = fabric_of(store, id)?;
    let Levels { chest_m, underbust_m, waist_m, hip_m, .. } = model.body.levels;
    let levels = [("chest", chest_m), ("underbust", underbust_m), ("waist", waist_m), ("hip", hip_m)].into();
    let (simulator, stage, earlier, body) = (job.simulator, drape.stage, drape.earlier, model.body.mesh);
    let under = read::layers_under(store, id)?.into_iter().filter_map(|layer| worn(store, layer).ok()).collect();
    let fields = OnceLock::new();
    Ok(Dressed { simulator, stage, garment, fabric, levels, body, cloth, under, earlier, fields })
}

fn worn(store: &Store, id: JobId) -> Result<TriMesh> {
    let Meshes(meshes) = product(store, id, StageKind::Mesh)?;
    let drape: Drape = product(store, id, StageKind::Drape)?;
    let triangles = meshes.last().map(|garment| garment.triangles.clone()).unwrap_or_default();
    Ok(TriMesh { positions: drape.positions, triangles })
}

fn fabric_of(store: &Store, id: JobId) -> Result<Fabric> {
    let table = sql::query(store, &format!("SELECT fabric_id FROM job WHERE job_id = {id}"))?;
    match table.rows.first().and_then(|row| row.first()) {
        Some(Value::Integer(fabric)) => read_fabric(&store.reader, *fabric),
        _ => Err(StudyError::NotFound { what: "fabric of job", name: id.to_string(), known: vec![] }),
    }
}

pub(crate) fn product<T: cache::Artefact>(store: &Store, id: JobId, stage: StageKind) -> Result<T> {
    let used = read::stages(store, id)?.into_iter().find(|used| used.stage == stage.as_str());
    let missing = || StudyError::NotFound { what: "result of job", name: id.to_string(), known: vec![] };
    cache::stored(&store.reader, &used.ok_or_else(missing)?.hash)
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that cannot go on should stop")]
mod tests;

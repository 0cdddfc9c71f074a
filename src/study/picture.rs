//! Pictures of results: the stored body and drape, rendered.

use image::RgbaImage;

use super::cache;
use super::error::{Result, StudyError};
use super::inputs::StageKind;
use super::pipeline::{Meshes, Model};
use super::types::JobId;
use super::workspace::Workspace;
use crate::geom::{DistanceField, TriMesh, V2, V3};
use crate::pattern::Garment;
use crate::render::{self, Camera, Frame, Layer, Material, Paint, Scale, Scene, Values, View};
use crate::sim::{Drape, Simulator};
use crate::units::mm;

/// What colours the cloth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Map {
    /// The simulator's own colour.
    Plain,
    /// Stretch: the greatest principal stretch of each triangle; 1 is the pattern's own size.
    Stretch,
    /// Gap between cloth and body, mm.
    Gap,
}

impl Map {
    /// All maps.
    pub const ALL: [Self; 3] = [Self::Plain, Self::Stretch, Self::Gap];

    /// Name on screens and in the command line.
    #[must_use]
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Plain => "plain",
            Self::Stretch => "stretch",
            Self::Gap => "gap",
        }
    }
}

/// Stretch at the ends of its colour scale, from 1.
const STRETCH_REACH: f64 = 0.1;
/// Gap at the end of its colour scale, mm.
const GAP_REACH_MM: f64 = 60.0;

/// A result made ready for pictures: lit once, shown from anywhere.
pub(super) struct Stage {
    scene: Scene,
    /// Body and cloth.
    meshes: [TriMesh; 2],
}

impl Stage {
    /// The frame that holds body and cloth from every view.
    fn frame(&self, aspect: f64) -> Frame {
        Frame::enclosing(&self.meshes, aspect)
    }
}

/// A stored result: the body and the garment on it.
pub(super) struct Dressed {
    simulator: Simulator,
    garment: Garment,
    pub body: TriMesh,
    pub cloth: TriMesh,
}

impl Dressed {
    /// The lit scene of a map and, where values colour the cloth, their scale.
    pub fn scene(&self, map: Map, gap: impl FnOnce() -> Result<DistanceField>) -> Result<(Scene, Option<Scale>)> {
        let material = match self.simulator {
            Simulator::Fem => Material::fem(),
            Simulator::Hybrid => Material::hybrid(),
        };
        let field = match map {
            Map::Plain => None,
            Map::Stretch => {
                let values = stretches(&self.garment, &self.cloth.positions);
                Some((Values::Triangles(values), Scale::diverging(1.0, STRETCH_REACH, "stretch", "")))
            }
            Map::Gap => {
                let field = gap()?;
                let gaps = self.cloth.positions.iter().map(|p| mm(field.value_and_gradient(p).0)).collect();
                Some((Values::Vertices(gaps), Scale::sequential(0.0, GAP_REACH_MM, "gap to the body", "mm")))
            }
        };
        let scale = field.as_ref().map(|(_, scale)| scale.clone());
        let paint = field.map_or(Paint::Plain, |(values, scale)| Paint::Field(values, scale));
        let layers = vec![Layer::new(&self.body, Material::form()), Layer::new(&self.cloth, material).painted(paint)];
        Ok((Scene::new(layers).map_err(StudyError::stage("render"))?, scale))
    }
}

impl Workspace {
    /// A picture of a result. The result last shown is kept ready, so that other views of it come quickly.
    ///
    /// # Errors
    /// [`StudyError::NotFound`] while there is no result; [`StudyError::Artefact`] when it is no longer stored.
    pub fn picture(&self, id: JobId, view: View, width: u32, height: u32, map: Map) -> Result<RgbaImage> {
        self.shot(id, view, (width, height), map, Stage::frame)
    }

    /// [`Workspace::picture`] with the garment as large as it can be, for small pictures: the body is cut off where it
    /// goes beyond.
    ///
    /// # Errors
    /// As there.
    pub fn close_up(&self, id: JobId, view: View, width: u32, height: u32, map: Map) -> Result<RgbaImage> {
        self.shot(id, view, (width, height), map, |stage, aspect| Frame::enclosing(&stage.meshes[1..], aspect))
    }

    /// A picture of what a frame holds, given the picture's width over height.
    fn shot(
        &self,
        id: JobId,
        view: View,
        (width, height): (u32, u32),
        map: Map,
        frame: impl Fn(&Stage, f64) -> Frame,
    ) -> Result<RgbaImage> {
        let mut kept = self.scene.borrow_mut();
        let stage = match kept.take() {
            Some((of, with, stage)) if (of, with) == (id, map) => stage,
            _ => self.stage(id, map)?,
        };
        let frame = frame(&stage, f64::from(width.max(1)) / f64::from(height.max(1)));
        let picture = render::render(&stage.scene, &Camera::new(view, frame), width, height);
        *kept = Some((id, map, stage));
        picture.map_err(StudyError::stage("render"))
    }

    /// [`Workspace::picture`] as a PNG file.
    ///
    /// # Errors
    /// As there.
    pub fn picture_png(&self, id: JobId, view: View, width: u32, height: u32, map: Map) -> Result<Vec<u8>> {
        render::png(&self.picture(id, view, width, height, map)?).map_err(StudyError::stage("render"))
    }

    fn stage(&self, id: JobId, map: Map) -> Result<Stage> {
        let dressed = self.dressed(id)?;
        let (scene, _) = dressed.scene(map, || self.product(id, StageKind::Field))?;
        Ok(Stage { scene, meshes: [dressed.body, dressed.cloth] })
    }

    /// A result as stored.
    ///
    /// # Errors
    /// [`StudyError::NotFound`] while there is no result; [`StudyError::Artefact`] when it is no longer stored.
    pub(super) fn dressed(&self, id: JobId) -> Result<Dressed> {
        let job = self.job(id)?;
        let model: Model = self.product(id, StageKind::Body)?;
        let Meshes(mut meshes) = self.product(id, StageKind::Mesh)?;
        let drape: Drape = self.product(id, StageKind::Drape)?;
        let fits = |garment: &Garment| garment.rest.len() == drape.positions.len();
        let garment = meshes
            .pop()
            .filter(fits)
            .ok_or_else(|| StudyError::stage("store")(format!("the mesh of job {id} does not fit its drape")))?;
        let cloth = TriMesh { positions: drape.positions, triangles: garment.triangles.clone() };
        Ok(Dressed { simulator: job.simulator, garment, body: model.body.mesh, cloth })
    }

    /// A stored product of a job's stage.
    pub(super) fn product<T: cache::Artefact>(&self, id: JobId, stage: StageKind) -> Result<T> {
        let used = self.stages(id)?.into_iter().find(|used| used.stage == stage.as_str());
        let missing = || StudyError::NotFound { what: "result of job", name: id.to_string(), known: vec![] };
        cache::stored(&self.reader, &used.ok_or_else(missing)?.hash)
    }
}

/// Greatest principal stretch of each triangle: the larger singular value of F = Ds Dm^-1 (3x2).
fn stretches(garment: &Garment, positions: &[V3]) -> Vec<f64> {
    let stretch = |[a, b, c]: &[usize; 3]| {
        let (e1, e2): (V2, V2) = (garment.rest[*b] - garment.rest[*a], garment.rest[*c] - garment.rest[*a]);
        let (d1, d2): (V3, V3) = (positions[*b] - positions[*a], positions[*c] - positions[*a]);
        let det = e1.x * e2.y - e1.y * e2.x;
        let (f1, f2) = ((d1 * e2.y - d2 * e1.y) / det, (d2 * e1.x - d1 * e2.x) / det);
        // Eigenvalues of F^T F from its trace and determinant.
        let (p, q, r) = (f1.norm_squared(), f2.norm_squared(), f1.dot(&f2));
        let middle = (p + q) / 2.0;
        (middle + ((p - q).powi(2) / 4.0 + r * r).sqrt()).sqrt()
    };
    garment.triangles.iter().map(stretch).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stretch_is_that_of_the_deformation_and_blind_to_rotation() {
        let rest = vec![V2::new(0.0, 0.0), V2::new(1.0, 0.0), V2::new(0.0, 1.0)];
        let garment = Garment {
            name: String::new(),
            size: String::new(),
            pieces: vec![],
            rest: rest.clone(),
            triangles: vec![[0, 1, 2]],
            seams: vec![],
            measurements: vec![],
            fit_levels: vec![],
            edge_length_m: 1.0,
        };
        let check = |deform: &dyn Fn(V2) -> V3, expected: f64| {
            let positions: Vec<V3> = rest.iter().map(|&p| deform(p)).collect();
            assert!((stretches(&garment, &positions)[0] - expected).abs() < 1e-12);
        };
        check(&|p| V3::new(p.x, p.y, 0.0), 1.0);
        check(&|p| V3::new(0.3, -p.y, p.x), 1.0);
        check(&|p| V3::new(1.2 * p.x, 0.0, 0.9 * p.y), 1.2);
        check(&|p| V3::new(p.x + 0.5 * p.y, p.y, 0.0), (1.125 + (0.125f64 * 0.125 + 0.25).sqrt()).sqrt());
    }
}
